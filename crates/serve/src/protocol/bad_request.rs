//! Why bytes are not a request.

use thiserror::Error;

use super::{
    ByteOrder,
    binary::{MAX_REQUEST_BYTES, REQUEST_BYTES, VERSION},
    plain,
};
use geometry::error::Advice;

/// Why bytes are not a request. The client gets this as an answer and is disconnected, because the start of the next
/// request is unknown.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
pub enum BadRequest {
    /// The request is longer than any valid one.
    #[error("the request is longer than {limit} bytes")]
    #[advice(SEND_REQUEST)]
    TooLong {
        /// Maximum length, bytes.
        limit: usize,
    },
    /// The request did not end in time.
    #[error("the request was not complete after {seconds} s")]
    #[advice = "Send the complete request, with its terminator"]
    Incomplete {
        /// How long its end was waited for, seconds.
        seconds: u64,
    },
    /// The word is not a request.
    #[error("not a request: {found:?}")]
    #[advice(SEND_REQUEST)]
    Unknown {
        /// The text found, in printable characters.
        found: String,
    },
    /// The text after the word of a request is no number that is allowed there.
    #[error("not understood: {found:?}")]
    #[advice = "Send TRIGGER alone, or with PART, PLACE=PART, ENC=COUNT, ENC=COUNT@MILLISECONDS (0 to 10000, since it was read) or ORDER=\"A 17\"; PATH or PART alone, or with numbers from 1"]
    NoNumber {
        /// The text found, in printable characters.
        found: String,
    },
    /// The order or serial number behind the word of a request cannot be read.
    #[error("not an order or a serial number: {found:?}")]
    #[advice(SEND_ORDER)]
    BadOrder {
        /// The text found, in printable characters.
        found: String,
    },
    /// An order is named, and parts as well.
    #[error("an order is given, and numbers of parts as well")]
    #[advice(SEND_ORDER)]
    OrderAndParts,
    /// The numbers of a robot that servoes are not the pose of its flange.
    #[error("not a pose of the flange: {why}")]
    #[advice = "Send SERVO with the number of the part and the pose of the flange, without tool, in the base frame and the convention of this port"]
    BadPose {
        /// Why not.
        why: String,
    },
    /// The frame does not begin with the expected bytes.
    #[error("the frame does not begin with PSRQ")]
    #[advice = "Begin the frame with the bytes 50 53 52 51"]
    Magic,
    /// The frame has another version, or the other byte order.
    #[error("the frame has version {found}, expected {VERSION}")]
    #[advice(if found.swap_bytes() == VERSION {
        let other = match order {
            ByteOrder::Little => "binary-be",
            ByteOrder::Big => "binary",
        };
        format!("The other byte order: listen with {other}")
    } else {
        "Update the older of the two programs".into()
    })]
    Version {
        /// The version found.
        found: u16,
        /// The byte order in which it was read.
        order: ByteOrder,
    },
    /// The frame's length field is not the length of a request.
    #[error(
        "the frame gives its length as {found} bytes, expected {REQUEST_BYTES} to {MAX_REQUEST_BYTES}, in steps of 4"
    )]
    #[advice = "Send the length of the whole frame with its checksum"]
    Length {
        /// The length found.
        found: u16,
    },
    /// The frame was corrupted, or its sender computes the checksum differently.
    #[error("the frame's checksum is {found:08x}, expected {expected:08x}")]
    #[advice = "Calculate CRC-32 (ISO 3309, as in ZIP) over all bytes before the checksum"]
    Checksum {
        /// The checksum found.
        found: u32,
        /// The checksum computed from the frame's bytes.
        expected: u32,
    },
    /// The request is not the expected XML.
    #[error("not the expected XML: {found:?}")]
    #[advice = "Send <Robot><Request>TRIGGER</Request><Point>0</Point></Robot>"]
    NotXml {
        /// The text found, in printable characters.
        found: String,
    },
}

/// Number of characters of a bad request that are shown.
const MAX_SHOWN_CHARS: usize = 40;

impl BadRequest {
    pub(super) fn unknown(found: &[u8]) -> Self {
        let found = shown(found);
        Self::Unknown { found }
    }

    pub(super) fn no_number(found: &[u8]) -> Self {
        let found = shown(found);
        Self::NoNumber { found }
    }

    pub(super) fn bad_order(found: &[u8]) -> Self {
        let found = shown(found);
        Self::BadOrder { found }
    }

    pub(super) fn no_real(found: &[u8]) -> Self {
        let why = format!("{:?} is no number", shown(found));
        Self::BadPose { why }
    }

    pub(super) fn not_xml(found: &[u8]) -> Self {
        let found = shown(found);
        Self::NotXml { found }
    }

    /// The reason word in an answer.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::TooLong { .. } => "too_long",
            Self::Incomplete { .. } => "incomplete",
            Self::Unknown { .. } => "unknown_request",
            Self::NoNumber { .. } => "no_point",
            Self::BadOrder { .. } | Self::OrderAndParts => "bad_order",
            Self::BadPose { .. } => "bad_pose",
            Self::Magic => "magic",
            Self::Version { .. } => "version",
            Self::Length { .. } => "length",
            Self::Checksum { .. } => "checksum",
            Self::NotXml { .. } => "not_xml",
        }
    }
}

fn shown(bytes: &[u8]) -> String {
    plain(&String::from_utf8_lossy(bytes), MAX_SHOWN_CHARS)
}

const SEND_REQUEST: &str =
    "Send TRIGGER, STATUS, LAST, PATH, PART or SERVO, in the protocol of this port";
const SEND_ORDER: &str = "Send the order once and without numbers of parts; in ascii and urscript, one with blanks in double quotes: ORDER=\"A 17\"";
