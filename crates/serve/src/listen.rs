//! Listen addresses: a protocol, an IP address and a port.

use std::{
    fmt,
    net::{IpAddr, Ipv4Addr, SocketAddr},
    str::FromStr,
};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::protocol::{Protocol, binary::MAX_NUMBERS};
use geometry::error::Advice;
use robot::Convention;
use texts::{Described, Message};

/// A protocol and the address to listen at, written `ascii=30100` or `eki=192.168.1.10:54600`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ListenAddress {
    /// The protocol spoken there.
    pub protocol: Protocol,
    /// The address; port 0 means any free port.
    pub address: SocketAddr,
}

/// Why a listen address cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
pub enum ListenError {
    /// The text is not of the form `PROTOCOL=ADDRESS`.
    #[error("{text:?} is not a protocol and port")]
    #[advice(WRITE_PORT)]
    Unreadable {
        /// The text as given.
        text: String,
    },
    /// The word before the equals sign is not a protocol.
    #[error("{found:?} is not a protocol, expected one of {}", Protocol::ALL.map(Protocol::name).join(", "))]
    #[advice(WRITE_PORT)]
    UnknownProtocol {
        /// The word as given.
        found: String,
    },
    /// The text after the equals sign is not an address.
    #[error("{found:?} is neither a port nor an IP address with a port")]
    #[advice = "Give a port from 1 to 65535, or the address of this computer's network card with it, for example 192.168.1.10:30100"]
    NoAddress {
        /// The text as given.
        found: String,
    },
    /// The protocol does not fix the convention, and none was chosen.
    #[error("{} has no convention of its own for poses, and none is chosen", protocol.name())]
    #[advice = "Choose with --as, for example --as fanuc; partsight report --conventions lists them"]
    NoConvention {
        /// The protocol that needs a convention.
        protocol: Protocol,
    },
    /// The convention has more numbers than a binary frame can hold.
    #[error("{} has {} numbers, but a frame of {} has room for {}", convention.title(), convention.names().len(), protocol.name(), MAX_NUMBERS)]
    #[advice = "Choose another with --as, for example kuka or quaternion-xyzw"]
    TooManyNumbers {
        /// The binary protocol.
        protocol: Protocol,
        /// The convention that does not fit.
        convention: Convention,
    },
}

const WRITE_PORT: &str = "Write PROTOCOL=PORT, for example ascii=30100, or PROTOCOL=IP:PORT";

impl FromStr for ListenAddress {
    type Err = ListenError;

    fn from_str(text: &str) -> Result<Self, ListenError> {
        let unreadable = || ListenError::Unreadable {
            text: text.to_owned(),
        };
        let (name, place) = text.split_once('=').ok_or_else(unreadable)?;
        let mut all = Protocol::ALL.into_iter();
        let protocol = all.find(|protocol| protocol.name() == name);
        let protocol = protocol.ok_or_else(|| ListenError::UnknownProtocol {
            found: name.to_owned(),
        })?;
        let address = parse_address(place)?;
        Ok(Self { protocol, address })
    }
}

/// Parses a port, which listens on localhost only, or an IP address with a port.
pub fn parse_address(text: &str) -> Result<SocketAddr, ListenError> {
    let own = |port| SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), port);
    let port = text.parse().ok().map(own);
    let address = port.or_else(|| text.parse().ok());
    address.ok_or_else(|| ListenError::NoAddress {
        found: text.to_owned(),
    })
}

impl TryFrom<String> for ListenAddress {
    type Error = ListenError;

    fn try_from(text: String) -> Result<Self, ListenError> {
        text.parse()
    }
}

impl From<ListenAddress> for String {
    fn from(at: ListenAddress) -> Self {
        at.to_string()
    }
}

/// Writes the form that [`FromStr`] reads.
impl fmt::Display for ListenAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.protocol.name(), self.address)
    }
}

/// A listen address and the convention of the poses sent there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listener {
    /// Protocol and address.
    pub at: ListenAddress,
    /// Convention of the poses sent there.
    pub convention: Convention,
}

impl Listener {
    /// Uses the protocol's own convention, or else the chosen one.
    pub fn new(at: ListenAddress, chosen: Option<Convention>) -> Result<Self, ListenError> {
        let protocol = at.protocol;
        let convention = protocol.own_convention().or(chosen);
        let convention = convention.ok_or(ListenError::NoConvention { protocol })?;
        if matches!(protocol, Protocol::Binary(_)) && convention.names().len() > MAX_NUMBERS {
            return Err(ListenError::TooManyNumbers {
                protocol,
                convention,
            });
        }
        Ok(Self { at, convention })
    }

    /// Returns a warning if other computers can reach the address.
    pub fn doubt(&self) -> Option<OpenToNetwork> {
        let is_open = !self.at.address.ip().is_loopback();
        is_open.then_some(OpenToNetwork { at: self.at })
    }
}

/// A listener is reachable by other computers without encryption.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub struct OpenToNetwork {
    at: ListenAddress,
}

impl Described for OpenToNetwork {
    fn message(&self) -> Message {
        Message::new("open-to-network").with("at", &*self.at.to_string())
    }
}

texts::display!(OpenToNetwork);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::ByteOrder;

    fn read(text: &str) -> ListenAddress {
        text.parse()
            .unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn a_port_alone_is_reached_by_this_computer_only() {
        for (text, protocol, address) in [
            ("ascii=30100", Protocol::Ascii, "127.0.0.1:30100"),
            (
                "binary=0",
                Protocol::Binary(ByteOrder::Little),
                "127.0.0.1:0",
            ),
            (
                "binary-be=10.0.0.2:2000",
                Protocol::Binary(ByteOrder::Big),
                "10.0.0.2:2000",
            ),
            ("eki=[::1]:54600", Protocol::Eki, "[::1]:54600"),
            (
                "urscript=0.0.0.0:30102",
                Protocol::UrScript,
                "0.0.0.0:30102",
            ),
        ] {
            let found = read(text);
            assert_eq!(
                (found.protocol, found.address.to_string().as_str()),
                (protocol, address)
            );
            assert_eq!(read(&found.to_string()), found);
            let listener = Listener::new(found, Some(Convention::Fanuc)).expect("spoken");
            let is_open = !address.starts_with("127.") && !address.starts_with("[::1]");
            assert_eq!(listener.doubt().is_some(), is_open, "{text}");
        }
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        for (text, words) in [
            ("30100", "not a protocol and port"),
            ("", "not a protocol and port"),
            (
                "modbus=502",
                "is not a protocol, expected one of ascii, binary",
            ),
            ("ascii=", "is neither a port"),
            ("ascii=70000", "is neither a port"),
            ("ascii=robot:30100", "is neither a port"),
            ("ascii=-1", "is neither a port"),
        ] {
            let error = text.parse::<ListenAddress>().expect_err(text);
            assert!(error.to_string().contains(words), "{text}: {error}");
            assert!(error.advice().contains("30100"));
        }
    }

    #[test]
    fn the_numbers_are_those_of_the_protocol_or_have_to_be_chosen() {
        let of = |text, chosen| Listener::new(read(text), chosen).map(|found| found.convention);
        let chosen = Some(Convention::Abb);
        assert_eq!(of("ascii=1", chosen), Ok(Convention::Abb));
        assert_eq!(of("binary=1", chosen), Ok(Convention::Abb));
        assert_eq!(of("eki=1", chosen), Ok(Convention::Kuka));
        assert_eq!(of("urscript=1", None), Ok(Convention::UniversalRobots));
        assert_eq!(
            of("ascii=1", Some(Convention::Matrix)),
            Ok(Convention::Matrix)
        );
        let error = of("ascii=1", None).expect_err("open");
        assert!(error.advice().contains("--as"), "{error}");
        let error = of("binary-be=1", Some(Convention::Matrix)).expect_err("16");
        assert!(error.to_string().contains("16 numbers"), "{error}");
    }
}
