//! Refused requests.

use axum::http::StatusCode;
use thiserror::Error;

use geometry::error::Advice;

/// Maximum size of a body, bytes. That of a trigger has some fifty.
pub(super) const MAX_BODY_BYTES: usize = 1024;

/// Why a request is refused.
#[derive(Clone, Copy, Debug, Error, Advice)]
pub(super) enum Refusal {
    #[error("no token was sent, or a wrong one")]
    #[advice = "Send a line of the file of --http-token-file as Authorization: Bearer TOKEN"]
    WrongToken,
    #[error("the request comes from a web page")]
    #[advice = "Ask from a program, by 127.0.0.1 or localhost; a page needs a token: start the server with --http-token-file"]
    WebPage,
    #[error("there is no such path")]
    #[advice = "GET /v1/openapi.json lists the paths"]
    NoSuchPath,
    #[error("the path does not support this method")]
    #[advice = "POST /v1/trigger, and GET the other paths"]
    WrongMethod,
    #[error("the body does not say which parts are expected")]
    #[advice = "Send no body, or the numbers of up to 8 expected parts, and of their places: {{\"expected\": [3, 5], \"places\": [1, 2]}}; \
        or, instead, an order, a serial number or both: {{\"order\": \"4711\", \"serial\": \"TL-1\"}}; on a line, a count, and how long ago \
        it was read (0 to 10000 ms): {{\"count\": 123456, \"count_age_ms\": 40}}"]
    BadBody,
    #[error("the request does not say whose path is wanted")]
    #[advice = "Give the sequence number of your trigger's answer: GET /v1/path?sequence=41"]
    NoSequence,
    #[error("the request was not complete after {seconds} s")]
    #[advice = "Send the complete request, with its body"]
    Incomplete { seconds: u64 },
    #[error("the body is longer than {} bytes", MAX_BODY_BYTES)]
    #[advice = "Send no body; with a trigger, one of up to 1024 bytes"]
    TooLong,
}

impl Refusal {
    /// The reason word in an answer.
    pub(super) fn reason(self) -> &'static str {
        match self {
            Self::WrongToken => "wrong_token",
            Self::WebPage => "web_page",
            Self::NoSuchPath => "unknown_request",
            Self::WrongMethod => "wrong_method",
            Self::BadBody => "bad_body",
            Self::NoSequence => "no_trigger",
            Self::Incomplete { .. } => "incomplete",
            Self::TooLong => "too_long",
        }
    }

    pub(super) fn status(self) -> StatusCode {
        match self {
            Self::WrongToken => StatusCode::UNAUTHORIZED,
            Self::WebPage => StatusCode::FORBIDDEN,
            Self::NoSuchPath => StatusCode::NOT_FOUND,
            Self::WrongMethod => StatusCode::METHOD_NOT_ALLOWED,
            Self::BadBody | Self::NoSequence => StatusCode::BAD_REQUEST,
            Self::Incomplete { .. } => StatusCode::REQUEST_TIMEOUT,
            Self::TooLong => StatusCode::PAYLOAD_TOO_LARGE,
        }
    }
}
