//! Errors of a store, worded for the person who chose its address and credentials.
//!
//! The client wraps each error several times. The [connector](super::connector) therefore puts a [`StoreError`] inside, where
//! it still knows the connection and the store's whole answer; [`StoreError::from_object_store`] finds it again.

use std::{error::Error, io};

use hyper::StatusCode;
use rustls::CertificateError;
use tokio::time::error::Elapsed;

use files::{advice_on, words_of};
use geometry::error::Advice;

/// Why a store does not do what it is asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum StoreError {
    /// A variable of the environment cannot be used.
    #[error("{name} {problem}")]
    #[advice = "Correct {name} in the environment"]
    Setting {
        /// The variable.
        name: &'static str,
        /// What is wrong with its value.
        problem: String,
    },
    /// The endpoint is without encryption, which nobody allowed.
    #[error("AWS_ENDPOINT begins with http://, so nothing would be encrypted")]
    #[advice = "Give AWS_ENDPOINT an address that begins with https://, or allow it with AWS_ALLOW_HTTP=true if nobody else can listen on this network"]
    Unencrypted,
    /// The environment has no credentials, and this computer has none from Amazon's cloud.
    #[error("there are no credentials in the environment")]
    #[advice = "Set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY in the environment"]
    NoCredentials,
    /// The host does not answer, or the connection broke.
    #[error("{host} cannot be reached: {cause}")]
    #[advice(CHECK_NETWORK)]
    Unreachable {
        /// Host and port.
        host: String,
        /// The system's message.
        cause: String,
    },
    /// The host's certificate is not to be trusted.
    #[error("{host} cannot prove who it is: {cause}")]
    #[advice = "Check AWS_ENDPOINT and the clock; if the plant has its own authority, name the file with its certificate in SSL_CERT_FILE"]
    Certificate {
        /// Host and port.
        host: String,
        /// What is wrong with the certificate.
        cause: String,
    },
    /// The answer takes too long.
    #[error("no answer in time")]
    #[advice(CHECK_NETWORK)]
    Late,
    /// The store does not know the credentials.
    #[error("the store does not accept the credentials")]
    #[advice = "Check AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_SESSION_TOKEN in the environment"]
    WrongCredentials,
    /// The credentials are known, but not for this.
    #[error("the credentials do not allow this")]
    #[advice = "Ask whoever runs the store for permission to list and read this bucket, and to publish also to write"]
    Forbidden,
    /// The clocks differ too much for a signature.
    #[error("the clocks of this computer and of the store differ too much")]
    #[advice = "Set the clock of this computer"]
    Clock,
    /// The bucket does not exist.
    #[error("there is no such bucket")]
    #[advice = "Check the name behind s3://, and AWS_ENDPOINT in the environment; a bucket is never created"]
    NoSuchBucket,
    /// The bucket is elsewhere.
    #[error("the bucket is in another region, or at another address")]
    #[advice = "Set AWS_REGION to the region of the bucket, and check AWS_ENDPOINT"]
    Elsewhere,
    /// Any other answer that is an error.
    #[error("the store answers {answer}")]
    #[advice = "Try again later; if the answer stays the same, ask whoever runs the store"]
    Answer {
        /// Status, and the code of S3 if there is one.
        answer: String,
    },
    /// The system does not read or write the folder.
    #[error("{cause}")]
    #[advice(match kind {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => advice_on(&(*kind).into()),
        _ => "Check that the folder exists, that its drive or share is connected, and that you may use it",
    })]
    Folder {
        /// The kind of error, which decides on the advice.
        kind: io::ErrorKind,
        /// The system's message.
        cause: String,
    },
    /// Anything else.
    #[error("{cause}")]
    #[advice = "Check the address of the store and the network; the installed library works without the store"]
    Other {
        /// The client's message.
        cause: String,
    },
}

impl StoreError {
    /// The cause of the client's error.
    pub(super) fn from_object_store(error: &object_store::Error) -> Self {
        let mut innermost: &(dyn Error + 'static) = error;
        loop {
            let found = innermost;
            if let Some(known) = found.downcast_ref::<Self>() {
                return known.clone();
            }
            if found.is::<Elapsed>() {
                return Self::Late;
            }
            // The connector leaves none: it is a folder's.
            if let Some(error) = found.downcast_ref::<io::Error>() {
                return Self::Folder {
                    kind: error.kind(),
                    cause: words_of(error),
                };
            }
            match found.source() {
                Some(source) => innermost = source,
                None => break,
            }
        }
        // On one line, without the XML that stores answer with.
        let cause = innermost.to_string();
        let cause = cause.split("<?xml").next().unwrap_or_default();
        let words: Vec<&str> = cause.split_whitespace().collect();
        let cause = words.join(" ").trim_end_matches([':', ' ']).to_owned();
        Self::Other { cause }
    }

    /// Of a connection that was not opened, or broke.
    pub(super) fn of_connection(host: &str, error: &(dyn Error + 'static)) -> Self {
        let host = host.to_owned();
        let mut cause = error;
        loop {
            if let Some(rustls::Error::InvalidCertificate(why)) =
                cause.downcast_ref::<rustls::Error>()
            {
                let cause = words_of_certificate(why);
                return Self::Certificate { host, cause };
            }
            let system = cause.downcast_ref::<io::Error>();
            if system.is_some_and(|error| error.kind() == io::ErrorKind::TimedOut) {
                return Self::Late;
            }
            // An error of the system hides the one that it was made of from `source`.
            cause = match (system.and_then(io::Error::get_ref), cause.source()) {
                (Some(inner), _) => inner,
                (None, Some(source)) => source,
                (None, None) => break,
            };
        }
        // The system's number of its message helps nobody.
        let cause = cause.to_string();
        let cause = cause.split(" (os error").next().unwrap_or_default();
        Self::Unreachable {
            host,
            cause: cause.to_owned(),
        }
    }

    /// Of a store's answer; `None` if the client understands it: that nothing is there, or something already, or that it
    /// must try again.
    pub(super) fn of_answer(status: StatusCode, body: &[u8]) -> Option<Self> {
        let body = String::from_utf8_lossy(body);
        let code = body.split_once("<Code>");
        let code = code.and_then(|(_, rest)| rest.split_once("</Code>"));
        let code = code.map_or("", |(code, _)| code);
        Some(match (status.as_u16(), code) {
            (_, "NoSuchBucket") => Self::NoSuchBucket,
            (_, "RequestTimeTooSkewed") => Self::Clock,
            (_, "PermanentRedirect" | "AuthorizationHeaderMalformed")
            | (301 | 302 | 307 | 308, _) => Self::Elsewhere,
            (
                _,
                "InvalidAccessKeyId" | "SignatureDoesNotMatch" | "InvalidToken" | "ExpiredToken",
            )
            | (401, _) => Self::WrongCredentials,
            (403, _) => Self::Forbidden,
            (304 | 404 | 408 | 409 | 412 | 416 | 429, _) => return None,
            (_, "") => Self::Answer {
                answer: status.to_string(),
            },
            (_, code) => Self::Answer {
                answer: format!("{status}, {code}"),
            },
        })
    }
}

fn words_of_certificate(error: &CertificateError) -> String {
    match error {
        CertificateError::UnknownIssuer => {
            "no authority that this computer trusts signed its certificate".into()
        }
        CertificateError::Expired | CertificateError::ExpiredContext { .. } => {
            "its certificate has expired".into()
        }
        CertificateError::NotValidForName | CertificateError::NotValidForNameContext { .. } => {
            "its certificate is for another name".into()
        }
        other => format!("its certificate cannot be used: {other}"),
    }
}

const CHECK_NETWORK: &str = "Check the network, and AWS_ENDPOINT in the environment; the installed library works without the store";

#[cfg(test)]
mod tests {
    use object_store::client::{HttpError, HttpErrorKind};

    use super::*;

    fn text_of(error: &StoreError) -> String {
        let text = format!("{error}; {}", error.advice());
        for internal in ["Error {", "Generic", "os error", "Kind", "<", "retries"] {
            assert!(!text.contains(internal), "{text}");
        }
        text
    }

    #[test]
    fn the_answers_of_a_store_are_told_in_words_with_what_to_do() {
        for (status, code, words) in [
            (404, "NoSuchBucket", "no such bucket"),
            (403, "InvalidAccessKeyId", "AWS_ACCESS_KEY_ID"),
            (
                403,
                "SignatureDoesNotMatch",
                "does not accept the credentials",
            ),
            (401, "", "does not accept the credentials"),
            (
                403,
                "AccessDenied",
                "Ask whoever runs the store for permission",
            ),
            (403, "RequestTimeTooSkewed", "Set the clock"),
            (301, "PermanentRedirect", "AWS_REGION"),
            (400, "AuthorizationHeaderMalformed", "AWS_REGION"),
            (503, "SlowDown", "503 Service Unavailable, SlowDown"),
            (500, "", "500 Internal Server Error; Try again later"),
        ] {
            let status = StatusCode::from_u16(status).expect("a status");
            let body = format!("<?xml version=\"1.0\"?><Error><Code>{code}</Code></Error>");
            let error = StoreError::of_answer(status, body.as_bytes()).expect(code);
            let text = text_of(&error);
            assert!(text.contains(words), "{text}");
        }
        for status in [404, 409, 412] {
            let status = StatusCode::from_u16(status).expect("a status");
            assert_eq!(
                StoreError::of_answer(status, b"<Code>NoSuchKey</Code>"),
                None
            );
        }
    }

    #[test]
    fn a_cause_is_found_however_deep_it_lies() {
        let wrapped = |source: HttpError| object_store::Error::Generic {
            store: "S3",
            source: Box::new(io_like(source)),
        };
        let denied = HttpError::new(HttpErrorKind::Unknown, StoreError::Forbidden);
        assert_eq!(
            StoreError::from_object_store(&wrapped(denied)),
            StoreError::Forbidden
        );
        let full = object_store::Error::Generic {
            store: "LocalFileSystem",
            source: Box::new(io::Error::from(io::ErrorKind::StorageFull)),
        };
        let text = text_of(&StoreError::from_object_store(&full));
        assert_eq!(
            text,
            "the disk is full; Make room on the disk, or choose another one"
        );
        let other = object_store::Error::Generic {
            store: "S3",
            source: "unexpected\n  answer: <?xml?><Error/>".into(),
        };
        let text = text_of(&StoreError::from_object_store(&other));
        assert!(text.starts_with("unexpected answer; "), "{text}");
    }

    /// An error around another one.
    fn io_like(source: HttpError) -> impl Error + Send + Sync {
        #[derive(Debug, thiserror::Error)]
        #[error("Error performing GET in 1 ms, after 2 retries")]
        struct Outer {
            source: HttpError,
        }
        Outer { source }
    }

    #[test]
    fn a_connection_that_fails_names_the_host_and_the_reason() {
        let refused = io::Error::from_raw_os_error(111);
        let error = StoreError::of_connection("minio:9000", &refused);
        assert!(text_of(&error).starts_with("minio:9000 cannot be reached: "));
        let certificate = rustls::Error::InvalidCertificate(CertificateError::UnknownIssuer);
        let error = StoreError::of_connection(
            "minio:9000",
            &io::Error::other(io::Error::other(certificate)),
        );
        assert!(text_of(&error).contains("SSL_CERT_FILE"), "{error}");
        let late = io::Error::from(io::ErrorKind::TimedOut);
        assert_eq!(StoreError::of_connection("minio", &late), StoreError::Late);
    }
}
