//! What is read of the bytes that a client sent.

use super::bad_request::BadRequest;
use crate::serve::answer::Request;

/// What the bytes that have come so far begin with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parsed {
    /// Bytes at their beginning that are done with.
    pub used: usize,
    /// The request there, or why it is none; `None` if it is not complete.
    pub request: Option<Result<Request, BadRequest>>,
}

impl Parsed {
    /// More has to come.
    pub(super) const PARTIAL: Self = Self {
        used: 0,
        request: None,
    };

    /// Bytes that mean nothing.
    pub(super) fn skipped(used: usize) -> Self {
        Self {
            used,
            request: None,
        }
    }

    /// A request in these first bytes, or why there is none.
    pub(super) fn read(used: usize, request: Result<Request, BadRequest>) -> Self {
        Self {
            used,
            request: Some(request),
        }
    }

    /// Bytes that cannot become a request.
    pub(super) fn bad(why: BadRequest) -> Self {
        Self::read(0, Err(why))
    }
}

/// True for what may stand between two requests: ends of lines, blanks, and the zeros behind a text of a PLC.
pub(super) fn is_filler(byte: u8) -> bool {
    byte == 0 || byte.is_ascii_whitespace()
}
