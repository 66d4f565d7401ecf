//! Why HTTP cannot be served.

use std::{net::SocketAddr, path::PathBuf};

use thiserror::Error;
use tokio_rustls::rustls;

use super::access::{MAX_LETTERS, MIN_LETTERS};
use files::FileError;
use geometry::error::Advice;
use robot::Convention;
use serve::ServeError;

/// Why HTTP cannot be served.
#[derive(Debug, Error)]
pub enum HttpError {
    /// The system refuses to listen at the address, or refuses a thread.
    #[error(transparent)]
    Serve(#[from] ServeError),
    /// The address is reachable by other computers, and no token is required.
    #[error("{address} is open to the network, but no token is required")]
    OpenWithoutToken {
        /// The address to listen at.
        address: SocketAddr,
    },
    /// The convention of poses was not chosen.
    #[error("HTTP has no convention of its own for poses, and none is chosen")]
    NoConvention,
    /// A file with tokens, a certificate or a key cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The token file has no token.
    #[error("{} has no token", path.display())]
    NoToken {
        /// Path of the file.
        path: PathBuf,
    },
    /// A line of the token file is not a valid token.
    #[error(
        "line {line} of {} is not a token: expected {MIN_LETTERS} to {MAX_LETTERS} printable ASCII letters without \
         blanks",
        path.display()
    )]
    BadToken {
        /// Path of the file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
    },
    /// The file lacks the expected PEM section.
    #[error("{} has no {what} in PEM form: {reason}", path.display())]
    NotPem {
        /// Path of the file.
        path: PathBuf,
        /// `certificate` or `private key`.
        what: &'static str,
        /// The PEM reader's message.
        reason: String,
    },
    /// The certificate and its key do not belong together, or are unusable.
    #[error("the certificate in {} cannot be used with its key: {source}", path.display())]
    BadCertificate {
        /// Path of the certificate file.
        path: PathBuf,
        /// The underlying error.
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
