//! Addresses of brokers, with the topic prefix of the cell.

use std::{fmt, str::FromStr};

use thiserror::Error;

use crate::host::{HostError, host_and_port};
use geometry::error::Advice;

/// A broker and the topic prefix: `mqtt[s]://[user@]host[:port]/TOPIC_PREFIX`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokerAddress {
    /// True for `mqtts`.
    pub is_encrypted: bool,
    /// Name of the broker's user; none if the broker needs none.
    pub user: Option<String>,
    /// Host name or IP address, IPv6 in brackets.
    pub host: String,
    /// TCP port; by default 1883, or 8883 if encrypted.
    pub port: u16,
    /// Topic prefix, without a slash at either end.
    pub prefix: String,
}

/// Longest topic prefix, bytes: some brokers allow 256 for a whole topic.
const MAX_PREFIX_BYTES: usize = 200;

/// Why a text is not the address of a broker.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[advice = "Give the address as mqtt[s]://[USER@]HOST[:PORT]/PREFIX, such as mqtt://broker/cell7 or mqtts://user@192.168.1.5:8883/hall3/cell7"]
pub enum AddressError {
    /// It does not begin with `mqtt://` or `mqtts://`.
    #[error("the address of the broker does not begin with mqtt:// or mqtts://")]
    Scheme,
    /// It contains a password, which other users of this computer could read in the list of processes.
    #[error(
        "the address contains a password, which everybody who lists the programs of this computer can read"
    )]
    #[advice = "Write the password into a file that only you can read, and name it with --mqtt-password-file"]
    Password,
    /// The host is missing, or is neither a name nor an IP address.
    #[error("{host:?} is not the name or IP address of a broker")]
    Host {
        /// The host as given.
        host: String,
    },
    /// An encrypted connection to an IPv6 address: certificates do not name addresses in brackets.
    #[error("an encrypted connection needs the broker's name, not {host}")]
    #[advice = "Give the name in the broker's certificate"]
    EncryptedIpv6 {
        /// The host as given.
        host: String,
    },
    /// The port is not a number from 1 to 65535.
    #[error("{port:?} is not a port")]
    Port {
        /// The port as given.
        port: String,
    },
    /// It has no topic prefix.
    #[error("the address of the broker has no topic prefix")]
    NoPrefix,
    /// The topic prefix is not valid.
    #[error("{prefix:?} is not a valid topic prefix")]
    #[advice = "Give 1 to {MAX_PREFIX_BYTES} letters, digits and slashes, without +, # and a $ at the beginning, such as mqtt://broker/hall3/cell7"]
    Prefix {
        /// The prefix as given.
        prefix: String,
    },
}

impl FromStr for BrokerAddress {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let (is_encrypted, rest) = if let Some(rest) = text.strip_prefix("mqtts://") {
            (true, rest)
        } else if let Some(rest) = text.strip_prefix("mqtt://") {
            (false, rest)
        } else {
            // Do not show the text: it may contain a password.
            return Err(AddressError::Scheme);
        };
        let (place, prefix) = rest.split_once('/').unwrap_or((rest, ""));
        let (user, place) = match place.rsplit_once('@') {
            Some((user, place)) => (Some(user), place),
            None => (None, place),
        };
        if user.is_some_and(|user| user.contains(':')) {
            return Err(AddressError::Password);
        }
        let found = host_and_port(place, if is_encrypted { 8883 } else { 1883 });
        let (host, port) = found.map_err(|error| match error {
            // What looks like a port is part of a password that contains a slash.
            HostError::Port { .. } if prefix.contains('@') => AddressError::Password,
            HostError::Port { port } => AddressError::Port { port },
            HostError::Host { host } => AddressError::Host { host },
        })?;
        if is_encrypted && host.starts_with('[') {
            let host = host.to_owned();
            return Err(AddressError::EncryptedIpv6 { host });
        }
        if prefix.is_empty() {
            return Err(AddressError::NoPrefix);
        }
        if !is_prefix(prefix) {
            let prefix = prefix.to_owned();
            return Err(AddressError::Prefix { prefix });
        }
        Ok(Self {
            is_encrypted,
            user: user.filter(|user| !user.is_empty()).map(str::to_owned),
            host: host.to_owned(),
            port,
            prefix: prefix.to_owned(),
        })
    }
}

/// Wildcards are not allowed, nor is `$` at the start, which marks the broker's own topics.
fn is_prefix(prefix: &str) -> bool {
    let is_bad = |c: char| matches!(c, '+' | '#') || c.is_control();
    prefix.len() <= MAX_PREFIX_BYTES
        && !prefix.starts_with('$')
        && !prefix.contains(is_bad)
        && prefix.split('/').all(|level| !level.is_empty())
}

/// Without the topic prefix, as shown in messages.
impl fmt::Display for BrokerAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_encrypted { "mqtts" } else { "mqtt" };
        write!(f, "{scheme}://{}:{}", self.host, self.port)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_its_parts() {
        for (text, user, host, port, prefix) in [
            ("mqtt://broker/cell7", None, "broker", 1883, "cell7"),
            ("mqtts://broker/a/b", None, "broker", 8883, "a/b"),
            ("mqtt://me@10.0.0.2:11/c", Some("me"), "10.0.0.2", 11, "c"),
            ("mqtt://me@[::1]/c", Some("me"), "[::1]", 1883, "c"),
            ("mqtt://a@b@[fe80::1]:9/c", Some("a@b"), "[fe80::1]", 9, "c"),
        ] {
            let read: BrokerAddress = text.parse().expect(text);
            assert_eq!(read.is_encrypted, text.starts_with("mqtts"));
            assert_eq!(read.user.as_deref(), user, "{text}");
            let rest = (read.host.as_str(), read.port, read.prefix.as_str());
            assert_eq!(rest, (host, port, prefix), "{text}");
        }
    }

    #[test]
    fn nonsense_is_refused_with_what_to_do() {
        let long = format!("mqtt://broker/{}", "x".repeat(MAX_PREFIX_BYTES + 1));
        for (text, words) in [
            ("broker/cell", "does not begin"),
            ("http://broker/cell", "does not begin"),
            ("tcp://me:secret@broker/cell", "does not begin"),
            ("me:secret@broker/cell", "does not begin"),
            ("mqtt://me:secret@broker/cell", "password"),
            ("mqtt://me:secret/1@broker/cell", "password"),
            ("mqtt:///cell", "not the name"),
            ("mqtt://a b/cell", "not the name"),
            ("mqtt://[::1/cell", "not the name"),
            ("mqtt://[nonsense]/cell", "not the name"),
            ("mqtt://::1/cell", "not the name"),
            ("mqtts://[::1]/cell", "name, not"),
            ("mqtt://broker:0/cell", "not a port"),
            ("mqtt://broker:70000/cell", "not a port"),
            ("mqtt://broker:/cell", "not a port"),
            ("mqtt://broker", "no topic prefix"),
            ("mqtt://broker/", "no topic prefix"),
            ("mqtt://broker/a//b", "not a valid topic prefix"),
            ("mqtt://broker/a/", "not a valid topic prefix"),
            ("mqtt://broker/+/a", "not a valid topic prefix"),
            ("mqtt://broker/a/#", "not a valid topic prefix"),
            ("mqtt://broker/$SYS", "not a valid topic prefix"),
            ("mqtt://broker/a\nb", "not a valid topic prefix"),
            (&long, "not a valid topic prefix"),
        ] {
            let error = text.parse::<BrokerAddress>().expect_err(text);
            assert!(error.to_string().contains(words), "{text}: {error}");
            assert!(!error.advice().is_empty());
            assert!(!error.to_string().contains("secret"));
        }
        for text in ["broker/cell", "mqtt://broker"] {
            let advice = text.parse::<BrokerAddress>().expect_err(text).advice();
            let form = "mqtt[s]://[USER@]HOST[:PORT]/PREFIX";
            assert!(advice.contains(form), "{text}: {advice}");
        }
    }
}
