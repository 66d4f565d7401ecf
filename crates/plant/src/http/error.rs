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
#[derive(Debug, Error, Advice)]
pub enum HttpError {
    /// The system refuses to listen at the address, or refuses a thread.
    #[error(transparent)]
    #[advice(transparent)]
    Serve(#[from] ServeError),
    /// The address is reachable by other computers, and no token is required.
    #[error("{address} is open to the network, but no token is required")]
    #[advice = "Write a token into a file and name it with --http-token-file, or give the port alone, which only this computer reaches"]
    OpenWithoutToken {
        /// The address to listen at.
        address: SocketAddr,
    },
    /// The convention of poses was not chosen.
    #[error("HTTP has no convention of its own for poses, and none is chosen")]
    #[advice("Choose with --as: {}", Convention::ALL.map(Convention::name).join(", "))]
    NoConvention,
    /// A file with tokens, a certificate or a key cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The token file has no token.
    #[error("{} has no token", path.display())]
    #[advice(WRITE_TOKENS)]
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
    #[advice(WRITE_TOKENS)]
    BadToken {
        /// Path of the file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
    },
    /// The file lacks the expected PEM section.
    #[error("{} has no {what} in PEM form: {reason}", path.display())]
    #[advice = "Give a file with a {what} between -----BEGIN and -----END lines"]
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
    #[advice = "Give the certificate with --http-cert, its chain behind it in the same file, and the key that it was made for with --http-key"]
    BadCertificate {
        /// Path of the certificate file.
        path: PathBuf,
        /// The underlying error.
        source: rustls::Error,
    },
}

const WRITE_TOKENS: &str = "Write one token on each line; openssl rand -hex 32 makes one";
