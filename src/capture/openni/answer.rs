//! Results of the library's calls.

use super::header::VideoMode;

/// A call that failed, with the library's messages.
#[derive(Debug)]
pub(super) struct Failed {
    /// One sentence each; may be empty.
    pub(super) said: Vec<String>,
}

/// Why the library was not started.
pub(super) enum NoContext {
    /// The library lacks this function.
    MissingSymbol(&'static str),
    /// The library is running already.
    InUse,
    /// The library does not start.
    Failed(Failed),
}

/// A device that is plugged in.
pub(super) struct FoundDevice {
    /// URI by which it is opened. It changes when the device is plugged in again.
    pub(super) uri: String,
    /// Manufacturer and model.
    pub(super) name: String,
}

/// A complete frame without padding.
pub(super) struct Received {
    /// Mode in which it was captured.
    pub(super) mode: VideoMode,
    /// True if it is only a part of its mode's picture.
    pub(super) is_part: bool,
    /// Depth values, row by row.
    pub(super) depth: Vec<u16>,
}
