//! A server that robots and PLCs ask for an inspection over plain TCP.
//!
//! ```text
//! client ─► Protocol::parse ─► Request ─► Server ─► Inspector ─► Found
//!        ◄─ Protocol::write ◄─ Answer  ◄─ the last one, aged ◄──┘
//! ```
//!
//! A thread for each listener and for each client, up to a limit, speaks with the robots; one thread inspects, that of
//! [`Server::run`]. So there is one inspection at a time: triggers wait in the order in which they came, and a client
//! waits for its answer before its next request is read, so that no more wait than there are clients. Each trigger is
//! answered from a frame of its own, captured after it arrived ([`Camera`]).
//!
//! Two rules keep a robot from moving by a wrong pose, both in `answer.rs`: numbers go out with the verdict *accepted*
//! only, and an accepted pose older than the limit becomes *stale*. Every answer has a sequence number, which counts the
//! inspections since the start, and the boot number of this start, so that a client that connects again knows what it
//! sees.
//!
//! Connections are neither encrypted nor authenticated: the network has to be the cell's own. Other protocols
//! (`plant`) ask by a [`ServerHandle`].

mod answer;
mod camera;
mod client;
mod finder;
mod handle;
mod listen;
mod protocol;
mod record;
mod server;
mod tally;

#[cfg(feature = "plant")]
pub(crate) use self::server::bound;
pub use self::{
    answer::{
        Answer, CameraState, CameraStatus, Found, MAX_COUNT, PathStep, Request, Trouble,
        VerdictCode,
    },
    camera::{Camera, NewFrame, NoFrame},
    finder::{FrameOrigin, NumberedPart, PartFinder, PoseKind},
    handle::ServerHandle,
    listen::{ListenAddress, ListenError, Listener, OpenToNetwork, parse_address},
    protocol::{
        ByteOrder, Protocol,
        bad_request::BadRequest,
        binary::{ANSWER_BYTES, MAX_NUMBERS, REQUEST_BYTES, request as binary_request},
        parsed::Parsed,
    },
    record::{InspectionRecord, InspectionRecorder},
    server::{
        Asked, ClientEvent, ClientNews, ClientSlot, Inspector, ServeError, Server, ServerSettings,
    },
    tally::Tally,
};
