//! Addresses of databases.

use std::{fmt, str::FromStr};

use thiserror::Error;

use crate::host::{HostError, host_and_port, is_loopback};
use geometry::error::Advice;

/// A database: `postgres://USER@HOST[:PORT]/NAME[?sslmode=disable|verify-full]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DatabaseAddress {
    /// Name of the database user.
    pub user: String,
    /// Host name or IP address, IPv6 without brackets.
    pub host: String,
    /// TCP port; 5432 by default.
    pub port: u16,
    /// Name of the database.
    pub name: String,
    /// True if the connection is encrypted and the server must show a valid certificate. By default true unless the host is
    /// this computer.
    pub is_encrypted: bool,
}

/// Longest name of a user or a database, bytes: the server truncates longer ones.
const MAX_NAME_BYTES: usize = 63;

/// Why a text is not the address of a database.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[advice = "Give an address such as postgres://cell7@database.plant.example/partsight"]
pub enum DatabaseAddressError {
    /// It does not begin with `postgres://` or `postgresql://`.
    #[error("the address of the database does not begin with postgres://")]
    Scheme,
    /// It contains a password, which other users of this computer could read in the list of processes.
    #[error(
        "the address contains a password, which everybody who lists the programs of this computer can read"
    )]
    #[advice = "Write the password into a file that only you can read, and name it with --database-password-file"]
    Password,
    /// It has no user name.
    #[error("the address names no user")]
    NoUser,
    /// The host is missing, or is neither a name nor an IP address.
    #[error("{host:?} is not the name or IP address of a database server")]
    Host {
        /// The host as given.
        host: String,
    },
    /// The port is not a number from 1 to 65535.
    #[error("{port:?} is not a port")]
    Port {
        /// The port as given.
        port: String,
    },
    /// The name of the user or the database has a character that is not allowed, or a wrong length.
    #[error("{name:?} is not a valid name of a user or a database")]
    #[advice = "Give 1 to {MAX_NAME_BYTES} letters, digits and -_. such as postgres://cell7@database/partsight"]
    Name {
        /// The name as given.
        name: String,
    },
    /// It has an option other than `sslmode`.
    #[error("the address has an unknown option: {option:?}")]
    #[advice(LEAVE_OPTIONS_OUT)]
    Option {
        /// Name of the option.
        option: String,
    },
    /// The `sslmode` is unknown, or would not protect the connection.
    #[error("sslmode={mode} is not supported")]
    #[advice(LEAVE_OPTIONS_OUT)]
    SslMode {
        /// The mode as given.
        mode: String,
    },
}

const LEAVE_OPTIONS_OUT: &str = "Leave the options out, or give sslmode=verify-full (encrypted, the server shows a certificate) or sslmode=disable (not encrypted)";

impl FromStr for DatabaseAddress {
    type Err = DatabaseAddressError;

    fn from_str(text: &str) -> Result<Self, DatabaseAddressError> {
        let rest = text.strip_prefix("postgres://");
        let rest = rest.or_else(|| text.strip_prefix("postgresql://"));
        // Do not show the text: it may contain a password.
        let rest = rest.ok_or(DatabaseAddressError::Scheme)?;
        let (rest, options) = rest.split_once('?').unwrap_or((rest, ""));
        let (place, name) = rest.split_once('/').unwrap_or((rest, ""));
        // An `@` after the user belongs to a password that contains a `/` or `?`.
        if name.contains('@') || options.contains('@') {
            return Err(DatabaseAddressError::Password);
        }
        let (user, place) = place.rsplit_once('@').unwrap_or(("", place));
        if user.contains(':') {
            return Err(DatabaseAddressError::Password);
        }
        if user.is_empty() {
            return Err(DatabaseAddressError::NoUser);
        }
        let (host, port) = host_and_port(place, 5432).map_err(|error| match error {
            HostError::Host { host } => DatabaseAddressError::Host { host },
            HostError::Port { port } => DatabaseAddressError::Port { port },
        })?;
        for name in [user, name] {
            if !is_name(name) {
                let name = name.to_owned();
                return Err(DatabaseAddressError::Name { name });
            }
        }
        Ok(Self {
            user: user.to_owned(),
            host: host.trim_matches(['[', ']']).to_owned(),
            port,
            name: name.to_owned(),
            is_encrypted: is_encrypted(options)?.unwrap_or(!is_loopback(host)),
        })
    }
}

/// Reads from the options whether to encrypt; `None` if they do not specify it.
fn is_encrypted(options: &str) -> Result<Option<bool>, DatabaseAddressError> {
    let mut found = None;
    for option in options.split('&').filter(|option| !option.is_empty()) {
        match option.split_once('=').unwrap_or((option, "")) {
            ("sslmode", "disable") => found = Some(false),
            ("sslmode", "require" | "verify-ca" | "verify-full") => found = Some(true),
            ("sslmode", mode) => {
                let mode = mode.to_owned();
                return Err(DatabaseAddressError::SslMode { mode });
            }
            ("password", _) => return Err(DatabaseAddressError::Password),
            (option, _) => {
                let option = option.to_owned();
                return Err(DatabaseAddressError::Option { option });
            }
        }
    }
    Ok(found)
}

fn is_name(name: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || "-_.@".contains(c);
    (1..=MAX_NAME_BYTES).contains(&name.len()) && name.chars().all(is_letter)
}

/// Without the user, as shown in messages.
impl fmt::Display for DatabaseAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            host, port, name, ..
        } = self;
        if host.contains(':') {
            write!(f, "postgres://[{host}]:{port}/{name}")
        } else {
            write!(f, "postgres://{host}:{port}/{name}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_its_parts_and_is_encrypted_unless_it_is_here() {
        for (text, user, host, port, name, is_encrypted) in [
            ("postgres://me@db/parts", "me", "db", 5432, "parts", true),
            ("postgresql://me@db:11/p", "me", "db", 11, "p", true),
            (
                "postgres://me@localhost/p",
                "me",
                "localhost",
                5432,
                "p",
                false,
            ),
            ("postgres://a@b@[::1]:9/p", "a@b", "::1", 9, "p", false),
            (
                "postgres://me@db/p?sslmode=disable",
                "me",
                "db",
                5432,
                "p",
                false,
            ),
            (
                "postgres://me@127.0.0.1/p?sslmode=require",
                "me",
                "127.0.0.1",
                5432,
                "p",
                true,
            ),
            (
                "postgres://me@db/p?sslmode=verify-full",
                "me",
                "db",
                5432,
                "p",
                true,
            ),
        ] {
            let read: DatabaseAddress = text.parse().expect(text);
            assert_eq!((read.user.as_str(), read.host.as_str()), (user, host));
            let rest = (read.port, read.name.as_str(), read.is_encrypted);
            assert_eq!(rest, (port, name, is_encrypted), "{text}");
        }
        let shown: DatabaseAddress = "postgres://me@[::1]/p".parse().expect("an address");
        assert_eq!(shown.to_string(), "postgres://[::1]:5432/p");
    }

    #[test]
    fn nonsense_is_refused_with_what_to_do_and_no_password_is_shown() {
        let long = format!("postgres://me@db/{}", "x".repeat(MAX_NAME_BYTES + 1));
        for (text, words) in [
            ("db/parts", "does not begin"),
            ("mysql://me:secret@db/parts", "does not begin"),
            ("postgres://me:secret@db/parts", "password"),
            ("postgres://me:sec/secret@db/parts", "password"),
            ("postgres://me:sec?secret@db/parts", "password"),
            ("postgres://me@db/parts?password=secret", "password"),
            ("postgres://db/parts", "names no user"),
            ("postgres://@db/parts", "names no user"),
            ("postgres://me@/parts", "not the name or IP"),
            ("postgres://me@a b/parts", "not the name or IP"),
            ("postgres://me@db:0/parts", "not a port"),
            ("postgres://me@db:70000/parts", "not a port"),
            ("postgres://me@db", "not a valid name of a user"),
            ("postgres://me@db/", "not a valid name of a user"),
            ("postgres://me@db/a/b", "not a valid name of a user"),
            ("postgres://me@db/a\nb", "not a valid name of a user"),
            ("postgres://m e@db/a", "not a valid name of a user"),
            ("postgres://me@db/a?sslmode=prefer", "not supported"),
            ("postgres://me@db/a?sslmode", "not supported"),
            ("postgres://me@db/a?host=b", "\"host\""),
            (&long, "not a valid name of a user"),
        ] {
            let error = text.parse::<DatabaseAddress>().expect_err(text);
            assert!(error.to_string().contains(words), "{text}: {error}");
            assert!(!error.advice().is_empty());
            assert!(!error.to_string().contains("secret"));
        }
    }
}
