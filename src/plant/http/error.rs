//! Why HTTP cannot be served.

use std::{net::SocketAddr, path::PathBuf};

use thiserror::Error;
use tokio_rustls::rustls;

use crate::{error::Advice, files::FileError, robot::Convention, serve::ServeError};

/// Why HTTP cannot be served.
#[derive(Debug, Error)]
pub enum HttpError {
    /// The system does not let it listen, or gives no thread.
    #[error(transparent)]
    Serve(#[from] ServeError),
    /// Others than this computer would reach it, and nothing would keep them out.
    #[error("{address} is open to the network, and no token is asked for")]
    OpenWithoutToken {
        /// Where it would listen.
        address: SocketAddr,
    },
    /// The convention of poses was not chosen.
    #[error("HTTP does not say in which numbers the robot expects a pose")]
    NoConvention,
    /// A file with tokens, a certificate or a key cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file without a token.
    #[error("{} has no token", path.display())]
    NoToken {
        /// The file.
        path: PathBuf,
    },
    /// A line that is no token.
    #[error(
        "line {line} of {} is no token: expected {min_letters} to {max_letters} printable ASCII letters without blanks",
        path.display()
    )]
    BadToken {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// Letters of the shortest token.
        min_letters: usize,
        /// Letters of the longest.
        max_letters: usize,
    },
    /// A file without what it should hold in PEM.
    #[error("{} has no {what} in PEM: {reason}", path.display())]
    NotPem {
        /// The file.
        path: PathBuf,
        /// `certificate` or `private key`.
        what: &'static str,
        /// What the reader says.
        reason: String,
    },
    /// Certificate and key cannot be used together, or at all.
    #[error("the certificate in {} cannot be used with its key: {source}", path.display())]
    BadCertificate {
        /// The file of the certificate.
        path: PathBuf,
        /// What rustls says.
        source: rustls::Error,
    },
}

impl Advice for HttpError {
    fn advice(&self) -> String {
        match self {
            Self::Serve(error) => error.advice(),
            Self::OpenWithoutToken { .. } => {
                "Write a token into a file and name it with --http-token-file, or give the port alone, which only this computer reaches".into()
            }
            Self::NoConvention => {
                let names = Convention::ALL.map(Convention::name);
                format!("Choose with --as: {}", names.join(", "))
            }
            Self::File(error) => error.advice(),
            Self::NoToken { .. } | Self::BadToken { .. } => {
                "Write one token on each line; openssl rand -hex 32 makes one".into()
            }
            Self::NotPem { what, .. } => {
                format!("Give a file with a {what} between -----BEGIN and -----END lines")
            }
            Self::BadCertificate { .. } => {
                "Give the certificate with --http-cert, its chain behind it in the same file, and the key that it was made for with --http-key".into()
            }
        }
    }
}
