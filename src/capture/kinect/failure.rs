//! Failures of the library's calls.

use std::ffi::c_int;

/// Why no context was created.
#[derive(Clone, Copy)]
pub(super) enum NoContext {
    /// The library lacks this function.
    MissingSymbol(&'static str),
    /// Another context exists already.
    InUse,
    /// `freenect_init` returned this code.
    Failed(c_int),
}

/// A call that returned a negative code.
#[derive(Debug)]
pub(super) struct Failed {
    /// The returned code; libusb's, or -1.
    pub(super) code: i32,
    /// What the library logged during the call, one line each.
    pub(super) said: Vec<String>,
}
