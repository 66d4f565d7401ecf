//! An inspection server that robots and PLCs query over plain TCP.
//!
//! ```text
//! client ─► Protocol::parse ─► Request ─► Server ─► Inspector ─► Found
//!        ◄─ Protocol::write ◄─ Answer  ◄─ the last one, aged ◄──┘
//! ```
//!
//! Each listener and each client, up to a limit, has a thread that talks to the robots; the thread that calls
//! [`Server::run`] does all inspections. There is thus one inspection at a time: triggers queue in order of arrival. A
//! client's next request is read only after its answer is sent, so the queue is never longer than the number of clients.
//! The [`Inspector`] takes a frame of its own for each trigger, captured after the trigger arrived.
//!
//! Two rules here keep a robot from moving to a wrong pose: numbers are sent only with the verdict *accepted*, and an
//! accepted pose older than the limit becomes *stale* (`answer.rs`). Every answer carries a sequence number, which counts
//! the inspections since the start, and the boot number of this start, so that a client that reconnects can tell which
//! inspection it sees. The path of an inspection goes to the client that triggered it, or
//! to one that names its sequence number (`inspections.rs`).
//!
//! Connections are neither encrypted nor authenticated: use a network of the cell's own. Other protocols (`plant`) go
//! through a [`ServerHandle`].

mod answer;
mod client;
#[cfg(feature = "fixtures")]
pub mod fixtures;
mod handle;
mod inspections;
mod listen;
mod protocol;
mod record;
mod request;
mod server;
mod tally;

pub use self::server::bound;
pub use self::{
    answer::{
        Answer, CameraState, CameraStatus, Found, FrameFacts, FrameParts, LibraryStatus, MAX_COUNT,
        MissingPart, OnLineNow, PathStep, PoseKind, Problem, RackPlace, RemainingError,
        VerdictCode,
    },
    handle::ServerHandle,
    listen::{ListenAddress, ListenError, Listener, OpenToNetwork, parse_address},
    protocol::{
        ByteOrder, Parsed, Protocol,
        bad_request::BadRequest,
        binary::{ANSWER_BYTES, MAX_NUMBERS, REQUEST_BYTES, request as binary_request},
    },
    record::{InspectionRecord, InspectionRecorder},
    request::{AskedOrder, ExpectedNumber, ExpectedNumbers, Request, ServoRequest, count_age},
    server::{
        Asked, ClientEvent, ClientNews, ClientSlot, Inspector, ServeError, Server, ServerSettings,
        Unanswered,
    },
    tally::Tally,
};
