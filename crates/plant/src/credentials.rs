//! Credentials of a client of another system: a password from a file, and trusted certificate authorities.

use std::{path::Path, sync::Arc};

use rustls::{
    ClientConfig, RootCertStore,
    crypto::ring,
    pki_types::{CertificateDer, pem::PemObject as _},
};
use thiserror::Error;

use files::{FileError, read_limited, read_text};
use geometry::error::Advice;

/// A password is one short line.
const MAX_PASSWORD_BYTES: u64 = 4096;
/// About four times the size of a system's whole certificate store.
const MAX_CA_BYTES: u64 = 1 << 20;

/// Why a password or certificates cannot be used.
#[derive(Debug, Error, Advice)]
pub enum CredentialError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The password file is empty.
    #[error("{path}: the file holds no password")]
    #[advice = "Write the password in the file's first line"]
    NoPassword {
        /// Path of the file.
        path: String,
    },
    /// The certificate file has no certificate.
    #[error("{path}: the file holds no certificate in PEM form")]
    #[advice = "Give the certificate of the authority that signed the server's, as PEM"]
    NoCertificate {
        /// Path of the file.
        path: String,
    },
    /// The system's certificate store is empty.
    #[error("this system has no certificates to verify a server with")]
    #[advice = "Name the certificate of the authority that signed the server's (--mqtt-ca, --database-ca)"]
    NoSystemCertificates,
    /// The TLS library rejects the configuration.
    #[error("encrypted connections cannot be prepared: {source}")]
    #[advice = "Report this with the message"]
    Tls {
        /// The underlying error.
        source: rustls::Error,
    },
}

/// Reads a password: the first line of a file.
pub(super) fn read_password(path: &Path) -> Result<String, CredentialError> {
    let text = match read_text(path, MAX_PASSWORD_BYTES) {
        Err(FileError::Empty { .. }) => String::new(),
        text => text?,
    };
    match text.lines().next() {
        Some(line) if !line.is_empty() => Ok(line.to_owned()),
        _ => Err(CredentialError::NoPassword {
            path: path.display().to_string(),
        }),
    }
}

/// TLS configuration that trusts the certificate authorities in a PEM file, or without a file those of the system.
pub(super) fn tls_config(ca_file: Option<&Path>) -> Result<ClientConfig, CredentialError> {
    let roots = if let Some(path) = ca_file {
        let bytes = read_limited(path, MAX_CA_BYTES)?;
        let found = CertificateDer::pem_slice_iter(&bytes);
        let mut roots = RootCertStore::empty();
        roots.add_parsable_certificates(found.filter_map(Result::ok));
        if roots.is_empty() {
            return Err(CredentialError::NoCertificate {
                path: path.display().to_string(),
            });
        }
        roots
    } else {
        let roots = system_roots();
        if roots.is_empty() {
            return Err(CredentialError::NoSystemCertificates);
        }
        roots
    };
    client_config(roots).map_err(|source| CredentialError::Tls { source })
}

/// Certificate authorities that the system trusts, or those in the file that `SSL_CERT_FILE` names.
pub(super) fn system_roots() -> RootCertStore {
    let mut roots = RootCertStore::empty();
    roots.add_parsable_certificates(rustls_native_certs::load_native_certs().certs);
    roots
}

/// TLS 1.2 and 1.3, for servers whose certificate one of these authorities has signed.
pub(super) fn client_config(roots: RootCertStore) -> Result<ClientConfig, rustls::Error> {
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()?;
    Ok(config.with_root_certificates(roots).with_no_client_auth())
}
