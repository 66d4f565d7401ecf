//! Verdicts and the state of the cell over MQTT 3.1.1.
//!
//! ```text
//! Server ─► InspectionRecord ─► MqttLink: queue ─► InspectionMessage ─► PREFIX/inspection
//! Camera ─► CameraStatus ─────►           state ─► StateMessage ──────► PREFIX/state, retained
//! ```
//!
//! A thread of its own holds the connection to the broker, and reconnects with growing pauses. Inspections are queued, at
//! most [`MAX_UNSENT`]; inspecting never waits for the broker. One message is in flight at a time: the next is sent once
//! the broker has acknowledged it (`QoS` 1). Messages therefore arrive in order, and after an outage at most one arrives
//! twice; its sequence and boot number identify it.
//!
//! A message is written when it is sent, from a [`serve::InspectionRecord`]: a pose that has become too old in the
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
    news::{LinkError, LinkNews, LinkProblem, Unsent},
};
