//! Verdicts and the state of the cell over MQTT 3.1.1.
//!
//! ```text
//! Server ─► InspectionRecord ─► MqttLink: queue ─► InspectionMessage ─► PREFIX/inspection
//! Camera ─► CameraStatus ─────►           state ─► StateMessage ──────► PREFIX/state, retained
//! ```
//!
//! A thread of its own holds the connection to the broker, and connects again with growing pauses. Inspections wait in a
//! queue of at most [`MAX_UNSENT`]; nobody who inspects ever waits for the broker. One message is on its way at a time:
//! the next one goes out once the broker has acknowledged it (`QoS` 1), so that they arrive in order, and after an outage
//! at most one of them arrives twice. Its sequence and boot number tell.
//!
//! A message is written when it goes out, by [`crate::serve::InspectionRecord`]: a pose that has become too old in the
//! queue is not sent.

mod access;
mod address;
mod link;
mod message;
mod news;

pub use self::{
    access::{AccessError, BrokerAccess, Unencrypted},
    address::{AddressError, BrokerAddress},
    link::{LinkSubject, MAX_UNSENT, MqttLink, PoseFormat},
    message::{
        InspectionMessage, LibraryMessage, MESSAGE_SCHEMA, PoseMessage, StateMessage,
        messages_schema,
    },
    news::{LinkError, LinkNews, LinkTrouble, Unsent},
};
