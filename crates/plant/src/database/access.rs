//! Access to a database: its address, the password and the trusted certificate authorities.

use std::{path::Path, time::Duration};

use thiserror::Error;
use tokio_postgres::{Config, config::SslMode};
use tokio_postgres_rustls::MakeRustlsConnect;

use super::address::DatabaseAddress;
use crate::{
    credentials::{CredentialError, read_password, tls_config},
    host::is_loopback,
};
use geometry::error::Advice;

/// Timeout of a connection attempt.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);
/// A server that silently disappears is noticed after about this long.
const SILENCE: Duration = Duration::from_secs(30);

/// A database's address and the credentials for it.
#[derive(Clone)]
pub struct DatabaseAccess {
    /// The database's address.
    pub address: DatabaseAddress,
    password: Option<String>,
    pub(super) tls: Option<MakeRustlsConnect>,
}

/// Why the access to a database cannot be set up.
#[derive(Debug, Error, Advice)]
pub enum DatabaseAccessError {
    /// The password or the certificates cannot be used.
    #[error(transparent)]
    #[advice(transparent)]
    Credential(#[from] CredentialError),
    /// Certificates are given for an unencrypted connection.
    #[error("certificates are given, but the connection to the database is not encrypted")]
    #[advice = "Add ?sslmode=verify-full to the address, or leave --database-ca out"]
    NotEncrypted,
}

impl DatabaseAccess {
    /// Reads the password from the first line of its file, and the trusted certificate authorities from a PEM file, or
    /// without a file from the system.
    pub fn new(
        address: DatabaseAddress,
        password_file: Option<&Path>,
        ca_file: Option<&Path>,
    ) -> Result<Self, DatabaseAccessError> {
        if ca_file.is_some() && !address.is_encrypted {
            return Err(DatabaseAccessError::NotEncrypted);
        }
        let password = password_file.map(read_password).transpose()?;
        let tls = address.is_encrypted.then(|| tls_config(ca_file));
        Ok(Self {
            password,
            tls: tls.transpose()?.map(MakeRustlsConnect::new),
            address,
        })
    }

    /// Returns a warning if others on the network can read what is sent.
    pub fn doubt(&self) -> Option<UnencryptedDatabase> {
        let DatabaseAddress {
            host, is_encrypted, ..
        } = &self.address;
        (!is_encrypted && !is_loopback(host)).then(|| UnencryptedDatabase {
            database: self.address.clone(),
        })
    }

    /// Configuration for the client library.
    pub(super) fn config(&self) -> Config {
        let DatabaseAddress {
            user,
            host,
            port,
            name,
            is_encrypted,
        } = &self.address;
        let mut config = Config::new();
        config
            .user(user)
            .host(host)
            .port(*port)
            .dbname(name)
            .application_name("partsight")
            .connect_timeout(CONNECT_TIMEOUT)
            .keepalives_idle(SILENCE / 2)
            .tcp_user_timeout(SILENCE)
            .ssl_mode(if *is_encrypted {
                SslMode::Require
            } else {
                SslMode::Disable
            });
        if let Some(password) = &self.password {
            config.password(password);
        }
        config
    }
}

/// Others on the network can read what is sent to a database.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error(
    "the connection to {database} is not encrypted: anyone along the network path can read and change inspections"
)]
#[advice = "Leave sslmode=disable out, or use a separate network for the plant"]
pub struct UnencryptedDatabase {
    database: DatabaseAddress,
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn certificates_are_for_encrypted_connections_and_an_open_one_is_doubted() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("password");
        fs::write(&file, "secret\nmore\n").expect("written");
        let address = |text: &str| text.parse::<DatabaseAddress>().expect("an address");
        let here = address("postgres://me@localhost/parts");
        let access = DatabaseAccess::new(here.clone(), Some(&file), None).expect("usable");
        assert_eq!(access.config().get_password(), Some(&b"secret"[..]));
        assert_eq!(access.doubt(), None);
        let error = DatabaseAccess::new(here, None, Some(&file));
        let error = error.err().expect("not encrypted");
        assert!(
            matches!(error, DatabaseAccessError::NotEncrypted),
            "{error}"
        );
        let open = address("postgres://me@database/parts?sslmode=disable");
        let access = DatabaseAccess::new(open, None, None).expect("usable");
        let doubt = access.doubt().expect("anybody reads it");
        assert!(!doubt.to_string().contains("me@"), "{doubt}");
        let sealed = address("postgres://me@database/parts");
        let error = DatabaseAccess::new(sealed, None, Some(&file));
        let error = error.err().expect("no certificate");
        assert!(error.to_string().contains("certificate"), "{error}");
    }
}
