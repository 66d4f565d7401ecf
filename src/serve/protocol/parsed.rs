//! The result of parsing a client's bytes.

use super::bad_request::BadRequest;
use crate::serve::answer::Request;

/// The result of parsing the start of a client's bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parsed {
    /// Number of bytes at the start that were used up.
    pub used: usize,
    /// The request, or why the bytes are none; `None` if it is incomplete.
    pub request: Option<Result<Request, BadRequest>>,
}

impl Parsed {
    /// More bytes are needed.
    pub(super) const PARTIAL: Self = Self {
        used: 0,
        request: None,
    };

    /// Filler that is skipped.
    pub(super) fn skipped(used: usize) -> Self {
        Self {
            used,
            request: None,
        }
    }

    /// A request in the first `used` bytes, or why they are none.
    pub(super) fn read(used: usize, request: Result<Request, BadRequest>) -> Self {
        Self {
            used,
            request: Some(request),
        }
    }

    /// The bytes cannot become a request.
    pub(super) fn bad(why: BadRequest) -> Self {
        Self::read(0, Err(why))
    }
}

/// True for bytes allowed between requests: line ends, blanks, and the zeros with which PLCs pad texts.
pub(super) fn is_filler(byte: u8) -> bool {
    byte == 0 || byte.is_ascii_whitespace()
}
