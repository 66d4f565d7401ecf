//! Types and constants of `libfreenect.h` 0.5 and of its dependencies.

use std::{
    ffi::{c_char, c_int, c_long, c_void},
    time::Duration,
};

/// `freenect_device_flags`: only the camera.
pub(super) const DEVICE_CAMERA: c_int = 0x02;
/// `FREENECT_LOG_ERROR`. The next level logs single packets, many per second on a bad cable.
pub(super) const LOG_ERROR: c_int = 1;
/// `LIBUSB_ERROR_INTERRUPTED`: a signal interrupted the wait; not an error.
pub(super) const INTERRUPTED: c_int = -10;
/// `FREENECT_DEPTH_11BIT`: steps of disparity, 11 bits in 16.
pub(super) const DEPTH_11BIT: i32 = 0;
/// `FREENECT_DEPTH_MM`: millimetres, in the depth camera's geometry.
pub(super) const DEPTH_MM: i32 = 5;
/// `FREENECT_DEPTH_MM_MAX_VALUE`: stands for readings that are farther away or invalid.
pub(super) const DEPTH_MM_MAX: u16 = 10_000;

/// `freenect_frame_mode`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameMode {
    reserved: u32,
    resolution: i32,
    /// `DEPTH_11BIT`, `DEPTH_MM` or another.
    pub(super) format: i32,
    bytes: i32,
    /// Columns.
    pub(super) width: i16,
    /// Rows.
    pub(super) height: i16,
    bits: i8,
    padding_bits: i8,
    frames_per_second: i8,
    is_valid: i8,
}

impl FrameMode {
    /// Number of pixels in a frame.
    pub(super) fn num_pixels(&self) -> usize {
        usize::try_from(self.width).unwrap_or(0) * usize::try_from(self.height).unwrap_or(0)
    }

    /// True if a frame has one `u16` per pixel and nothing else.
    pub(super) fn is_sixteen_bit(&self) -> bool {
        self.is_valid != 0
            && self.num_pixels() > 0
            && usize::try_from(self.bytes) == Ok(2 * self.num_pixels())
    }
}

/// `struct timeval`. On macOS its second field has half the width; the low half of ours is in its place.
#[repr(C)]
pub(super) struct TimeVal {
    seconds: c_long,
    microseconds: c_long,
}

impl From<Duration> for TimeVal {
    fn from(duration: Duration) -> Self {
        Self {
            seconds: c_long::try_from(duration.as_secs()).unwrap_or(c_long::MAX),
            // Below a million, and an `i32` fits into a `c_long` on every platform.
            microseconds: c_long::from(duration.subsec_micros() as i32),
        }
    }
}

/// `struct freenect_device_attributes`.
#[repr(C)]
pub(super) struct Attributes {
    /// The next entry, or null.
    pub(super) next: *mut Self,
    /// A C string, or null.
    pub(super) camera_serial: *const c_char,
}

/// `freenect_depth_cb`: device, frame, ticks of the camera's 60 MHz clock.
pub(super) type OnDepth = extern "C" fn(*mut c_void, *mut c_void, u32);
/// `freenect_log_cb`: context, level, message.
pub(super) type OnLog = extern "C" fn(*mut c_void, c_int, *const c_char);
