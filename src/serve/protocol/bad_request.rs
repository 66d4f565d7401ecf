//! Why bytes are no request.

use thiserror::Error;

use super::{ByteOrder, binary::VERSION, plain};
use crate::error::Advice;

/// Why bytes are no request. The client is told, and its connection closed: where the next request begins is not known.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BadRequest {
    /// Longer than any request.
    #[error("a request longer than {limit} bytes")]
    TooLong {
        /// Bytes that a request may have.
        limit: usize,
    },
    /// It began and did not end in time.
    #[error("a request that was not complete after {seconds} s")]
    Incomplete {
        /// How long it was waited for.
        seconds: u64,
    },
    /// Another word.
    #[error("no request: {found:?}")]
    Unknown {
        /// What was found, in printable letters.
        found: String,
    },
    /// The number behind `PATH` is none.
    #[error("no number of a point: {found:?}")]
    NoPoint {
        /// What was found, in printable letters.
        found: String,
    },
    /// A frame that begins with something else.
    #[error("the frame does not begin with PSRQ")]
    Magic,
    /// A frame of another version, or of the other byte order.
    #[error("a frame of version {found}, expected {}", VERSION)]
    Version {
        /// The version found.
        found: u16,
        /// The byte order in which it was read.
        order: ByteOrder,
    },
    /// A frame whose length is not that of a request.
    #[error("a frame that gives its length as {found} bytes, expected {expected}")]
    Length {
        /// The length found.
        found: u16,
        /// That of a request.
        expected: u16,
    },
    /// A frame that was changed on its way, or whose sender counts the checksum otherwise.
    #[error("the frame's checksum is {found:08x}, expected {expected:08x}")]
    Checksum {
        /// The checksum found.
        found: u32,
        /// That of its bytes.
        expected: u32,
    },
    /// Not the XML that is expected.
    #[error("not the expected XML: {found:?}")]
    NotXml {
        /// What was found, in printable letters.
        found: String,
    },
}

/// Letters of a wrong request that are shown.
const SHOWN: usize = 40;

impl BadRequest {
    pub(super) fn unknown(found: &[u8]) -> Self {
        let found = shown(found);
        Self::Unknown { found }
    }

    pub(super) fn no_point(found: &[u8]) -> Self {
        let found = shown(found);
        Self::NoPoint { found }
    }

    pub(super) fn not_xml(found: &[u8]) -> Self {
        let found = shown(found);
        Self::NotXml { found }
    }

    /// The word for it in an answer.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::TooLong { .. } => "too_long",
            Self::Incomplete { .. } => "incomplete",
            Self::Unknown { .. } => "unknown_request",
            Self::NoPoint { .. } => "no_point",
            Self::Magic => "magic",
            Self::Version { .. } => "version",
            Self::Length { .. } => "length",
            Self::Checksum { .. } => "checksum",
            Self::NotXml { .. } => "not_xml",
        }
    }
}

fn shown(bytes: &[u8]) -> String {
    plain(&String::from_utf8_lossy(bytes), SHOWN)
}

impl Advice for BadRequest {
    fn advice(&self) -> String {
        match self {
            Self::TooLong { .. } | Self::Unknown { .. } => {
                "Send TRIGGER, STATUS, LAST or PATH, in the protocol of this port".into()
            }
            Self::Incomplete { .. } => "Send the request whole, with its end".into(),
            Self::NoPoint { .. } => "Send PATH, or PATH and the number of a point from 1".into(),
            Self::Magic => "Begin the frame with the bytes 50 53 52 51".into(),
            Self::Version { found, order } => {
                let other = match order {
                    ByteOrder::Little => "binary-be",
                    ByteOrder::Big => "binary",
                };
                if found.swap_bytes() == VERSION {
                    format!("The other byte order: listen with {other}")
                } else {
                    "Update the older of the two programs".into()
                }
            }
            Self::Length { .. } => "Send the length of the whole frame with its checksum".into(),
            Self::Checksum { .. } => {
                "Count CRC-32 (ISO 3309, as ZIP) over all bytes before the checksum".into()
            }
            Self::NotXml { .. } => {
                "Send <Robot><Request>TRIGGER</Request><Point>0</Point></Robot>".into()
            }
        }
    }
}
