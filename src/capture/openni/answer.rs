//! What calls of the library come to.

use super::header::VideoMode;

/// A call that failed, with what the library says of it.
#[derive(Debug)]
pub(super) struct Failed {
    /// A sentence each; may be empty.
    pub(super) said: Vec<String>,
}

/// Why the library was not started.
pub(super) enum NoContext {
    /// It lacks this function.
    MissingSymbol(&'static str),
    /// It runs already.
    InUse,
    /// It does not start.
    Failed(Failed),
}

/// A device that is plugged in.
pub(super) struct FoundDevice {
    /// What it is opened by. It changes when the device is plugged in again.
    pub(super) uri: String,
    /// Maker and model.
    pub(super) name: String,
}

/// A frame, whole and without gaps between its rows.
pub(super) struct Received {
    /// What it was captured in.
    pub(super) mode: VideoMode,
    /// True if it is not the whole picture of its mode.
    pub(super) is_part: bool,
    /// Row after row.
    pub(super) depth: Vec<u16>,
}
