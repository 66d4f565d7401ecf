//! Access to a broker: its address, the password and the trusted certificate authorities.

use std::{path::Path, sync::Arc};

use rumqttc::{MqttOptions, TlsConfiguration, Transport};
use rustls::ClientConfig;
use thiserror::Error;

use super::address::BrokerAddress;
use crate::{
    credentials::{CredentialError, read_password, tls_config},
    host::is_loopback,
};
use files::crc32;
use geometry::error::Advice;

/// A broker's address and the credentials for it.
#[derive(Clone)]
pub struct BrokerAccess {
    /// The broker's address.
    pub broker: BrokerAddress,
    password: String,
    tls: Option<Arc<ClientConfig>>,
}

/// Why the access to a broker cannot be set up.
#[derive(Debug, Error, Advice)]
pub enum AccessError {
    /// The password or the certificates cannot be used.
    #[error(transparent)]
    #[advice(transparent)]
    Credential(#[from] CredentialError),
    /// A password was given without a user name.
    #[error("a password is given, but no user")]
    #[advice = "Name the user in the address: mqtt://USER@HOST/PREFIX"]
    NoUser,
    /// Certificates are given for an unencrypted connection.
    #[error("certificates are given, but mqtt:// is not encrypted")]
    #[advice = "Begin the address with mqtts://, or leave --mqtt-ca out"]
    NotEncrypted,
}

impl BrokerAccess {
    /// Reads the password from the first line of its file, and the trusted certificate authorities from a PEM file, or
    /// without a file from the system.
    pub fn new(
        broker: BrokerAddress,
        password_file: Option<&Path>,
        ca_file: Option<&Path>,
    ) -> Result<Self, AccessError> {
        if password_file.is_some() && broker.user.is_none() {
            return Err(AccessError::NoUser);
        }
        if ca_file.is_some() && !broker.is_encrypted {
            return Err(AccessError::NotEncrypted);
        }
        let password = password_file.map(read_password).transpose()?;
        let tls = broker.is_encrypted.then(|| tls_config(ca_file));
        Ok(Self {
            password: password.unwrap_or_default(),
            tls: tls.transpose()?.map(Arc::new),
            broker,
        })
    }

    /// Returns a warning if others on the network can read what is sent.
    pub fn doubt(&self) -> Option<Unencrypted> {
        let is_here = is_loopback(&self.broker.host);
        (!self.broker.is_encrypted && !is_here).then(|| Unencrypted {
            broker: self.broker.clone(),
        })
    }

    /// Options for the client library, without a last will.
    pub(super) fn options(&self) -> MqttOptions {
        let BrokerAddress {
            user, host, port, ..
        } = &self.broker;
        // Use the same client identifier after every start: when the program reconnects, the broker ends a former
        // connection whose loss it has not noticed, so that its last will does not arrive after the new state.
        let id = format!("partsight-{:08x}", crc32(self.broker.prefix.as_bytes()));
        let mut options = MqttOptions::new(id, host, *port);
        options.set_keep_alive(super::link::KEEP_ALIVE);
        options.set_max_packet_size(MAX_PACKET_BYTES, MAX_PACKET_BYTES);
        if let Some(user) = user {
            options.set_credentials(user, &self.password);
        }
        if let Some(tls) = &self.tls {
            let tls = TlsConfiguration::Rustls(Arc::clone(tls));
            options.set_transport(Transport::tls_with_config(tls));
        }
        options
    }
}

/// Far above the size of any message; the client library refuses to send longer ones.
const MAX_PACKET_BYTES: usize = 1 << 20;

/// Others on the network can read what is sent to a broker.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error(
    "the connection to {broker} is not encrypted: anyone along the network path can read and change verdicts, poses and the password"
)]
#[advice = "Use mqtts://, or a separate network for the plant"]
pub struct Unencrypted {
    broker: BrokerAddress,
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn access(address: &str, files: [Option<&Path>; 2]) -> Result<BrokerAccess, AccessError> {
        let [password, ca] = files;
        BrokerAccess::new(address.parse().expect(address), password, ca)
    }

    #[test]
    fn the_password_is_the_first_line_of_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("password");
        for (text, password) in [
            ("secret", "secret"),
            ("two words\r\nmore\n", "two words"),
            ("\u{feff}secret\n", "secret"),
        ] {
            fs::write(&path, text).expect("written");
            let found = access("mqtt://me@broker/cell", [Some(&path), None]).expect(text);
            let login = found.options().credentials().expect("a user");
            assert_eq!(
                (login.username, login.password),
                ("me".into(), password.into())
            );
        }
        for text in ["", "\nsecret"] {
            fs::write(&path, text).expect("written");
            let error = access("mqtt://me@broker/cell", [Some(&path), None])
                .err()
                .expect("empty");
            let is_empty = matches!(
                error,
                AccessError::Credential(CredentialError::NoPassword { .. })
            );
            assert!(is_empty, "{error}");
        }
        let error = access("mqtt://broker/cell", [Some(&path), None])
            .err()
            .expect("whose?");
        assert!(matches!(error, AccessError::NoUser) && error.advice().contains("USER"));
    }

    #[test]
    fn certificates_are_for_encrypted_connections_and_have_to_be_some() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("ca.pem");
        let error = access("mqtt://broker/cell", [None, Some(&path)])
            .err()
            .expect("not encrypted");
        assert!(matches!(error, AccessError::NotEncrypted), "{error}");
        let error = access("mqtts://broker/cell", [None, Some(&path)])
            .err()
            .expect("missing");
        let is_missing = matches!(error, AccessError::Credential(CredentialError::File(_)));
        assert!(is_missing, "{error}");
        fs::write(&path, "no certificate").expect("written");
        let error = access("mqtts://broker/cell", [None, Some(&path)])
            .err()
            .expect("none");
        let is_none = matches!(
            error,
            AccessError::Credential(CredentialError::NoCertificate { .. })
        );
        assert!(is_none, "{error}");
    }

    #[test]
    fn a_connection_that_leaves_the_computer_unencrypted_is_doubted() {
        for (address, is_doubted) in [
            ("mqtt://localhost/cell", false),
            ("mqtt://127.0.0.1/cell", false),
            ("mqtt://[::1]/cell", false),
            ("mqtt://10.0.0.2/cell", true),
            ("mqtt://broker/cell", true),
        ] {
            let found = access(address, [None, None]).expect(address);
            assert_eq!(found.doubt().is_some(), is_doubted, "{address}");
        }
    }
}
