//! Certificate and key of HTTPS.

use std::{path::Path, sync::Arc};

use tokio_rustls::{
    TlsAcceptor,
    rustls::{
        ServerConfig,
        crypto::ring,
        pki_types::{CertificateDer, PrivateKeyDer, pem, pem::PemObject as _},
    },
};

use super::error::HttpError;
use files::read_limited;

/// Maximum size of a PEM file; a chain of certificates takes a few kilobytes.
const MAX_PEM_BYTES: u64 = 1 << 20;

/// Certificate and key for encrypted connections with TLS 1.2 and 1.3.
#[derive(Clone)]
pub struct Tls {
    pub(super) acceptor: TlsAcceptor,
}

impl Tls {
    /// Loads the certificate with its chain, and the private key, from PEM files.
    pub fn load(certificate: &Path, key: &Path) -> Result<Self, HttpError> {
        let not_pem = |path: &Path, what, error: &pem::Error| HttpError::NotPem {
            path: path.to_owned(),
            what,
            reason: error.to_string(),
        };
        let bytes = read_limited(certificate, MAX_PEM_BYTES)?;
        let chain = CertificateDer::pem_slice_iter(&bytes).collect::<Result<Vec<_>, _>>();
        let chain = match chain {
            Ok(chain) if chain.is_empty() => Err(pem::Error::NoItemsFound),
            chain => chain,
        };
        let chain = chain.map_err(|error| not_pem(certificate, "certificate", &error))?;
        let bytes = read_limited(key, MAX_PEM_BYTES)?;
        let secret = PrivateKeyDer::from_pem_slice(&bytes);
        let secret = secret.map_err(|error| not_pem(key, "private key", &error))?;
        let unusable = |source| HttpError::BadCertificate {
            path: certificate.to_owned(),
            source,
        };
        let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
            .with_safe_default_protocol_versions()
            .map_err(unusable)?
            .with_no_client_auth();
        let mut config = config.with_single_cert(chain, secret).map_err(unusable)?;
        config.alpn_protocols = vec![b"http/1.1".to_vec()];
        Ok(Self {
            acceptor: TlsAcceptor::from(Arc::new(config)),
        })
    }
}
