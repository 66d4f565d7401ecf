//! What a call of the library comes to when it fails.

use std::ffi::c_int;

/// Why no context was made.
#[derive(Clone, Copy)]
pub(super) enum NoContext {
    /// The library lacks this function.
    MissingSymbol(&'static str),
    /// There is one already.
    InUse,
    /// `freenect_init` returned this.
    Failed(c_int),
}

/// A call that returned a negative code.
#[derive(Debug)]
pub(super) struct Failed {
    /// The code; libusb's, or -1.
    pub(super) code: i32,
    /// What the library said meanwhile, a sentence each.
    pub(super) said: Vec<String>,
}
