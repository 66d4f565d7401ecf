//! Events of the connection, and its errors.

use std::io;

use rumqttc::{ConnectReturnCode, ConnectionError};
use thiserror::Error;

use super::address::BrokerAddress;
use files::words_of;
use geometry::error::{Advice, Fault};

/// An event of the connection, to be shown to the operator.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkNews {
    /// Connected to the broker, for the first time or again.
    Connected {
        /// Inspections that were queued.
        num_waiting: usize,
        /// Inspections dropped since the start.
        num_dropped: u64,
    },
    /// The connection is lost; reported once until it is back.
    Lost(LinkProblem),
}

/// Why there is no connection.
#[derive(Clone, Debug, PartialEq, Error, Advice)]
pub enum LinkProblem {
    /// The broker does not answer.
    #[error("{broker} cannot be reached: {cause}")]
    #[advice = "Check the broker and the network; inspections continue, and the connection is retried"]
    Unreachable {
        /// The broker.
        broker: BrokerAddress,
        /// The system's message.
        cause: String,
    },
    /// The broker refuses the login.
    #[error("{broker} refuses the connection: {cause}")]
    #[advice = "Check the user in --mqtt, --mqtt-password-file and the broker's list of users; the connection is retried"]
    Refused {
        /// The broker.
        broker: BrokerAddress,
        /// The reason it gave.
        cause: &'static str,
    },
    /// The encrypted connection cannot be established.
    #[error("no encrypted connection to {broker}: {cause}")]
    #[advice = "Check that --mqtt names the host in the broker's certificate, and --mqtt-ca the authority that signed it"]
    Tls {
        /// The broker.
        broker: BrokerAddress,
        /// The TLS library's message.
        cause: String,
    },
    /// An existing connection broke.
    #[error("the connection to {broker} was lost: {cause}")]
    #[advice = "Check the broker and the network, and that no other program publishes under this topic prefix; the connection is retried"]
    Broken {
        /// The broker.
        broker: BrokerAddress,
        /// The client library's message.
        cause: String,
    },
    /// The program itself failed.
    #[error(transparent)]
    #[advice(transparent)]
    Fault(#[from] Fault),
}

impl LinkProblem {
    pub(super) fn from_connection(error: ConnectionError, broker: &BrokerAddress) -> Self {
        let broker = broker.clone();
        match error {
            ConnectionError::Io(error) => Self::Unreachable {
                broker,
                cause: words_of(&error),
            },
            ConnectionError::NetworkTimeout => Self::Unreachable {
                broker,
                cause: "nothing answers".into(),
            },
            ConnectionError::ConnectionRefused(code) => Self::Refused {
                broker,
                cause: match code {
                    ConnectReturnCode::BadUserNamePassword | ConnectReturnCode::NotAuthorized => {
                        "the user or the password is wrong, or the user may not connect"
                    }
                    ConnectReturnCode::BadClientId => "it rejects the client identifier",
                    ConnectReturnCode::RefusedProtocolVersion => "it does not speak MQTT 3.1.1",
                    ConnectReturnCode::ServiceUnavailable | ConnectReturnCode::Success => {
                        "it is not available"
                    }
                },
            },
            ConnectionError::Tls(error) => Self::Tls {
                broker,
                cause: error.to_string(),
            },
            ConnectionError::MqttState(error) => Self::Broken {
                broker,
                cause: error.to_string(),
            },
            error => Self::Broken {
                broker,
                cause: error.to_string(),
            },
        }
    }
}

/// The system refuses a thread for a link.
#[derive(Debug, Error, Advice)]
#[error("the thread for MQTT cannot be started: {source}")]
#[advice = "Close other programs and start again"]
pub struct LinkError {
    pub(super) source: io::Error,
}

/// Some inspections were still unsent at the end of the program.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error("inspections that did not reach {broker}: {num}")]
#[advice = "Look them up in the history: partsight history list"]
pub struct Unsent {
    pub(super) num: u64,
    pub(super) broker: BrokerAddress,
}
