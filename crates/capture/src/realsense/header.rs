//! Types and constants of librealsense's headers `librealsense2/h/*.h`, which have not changed within version 2.

use std::ffi::{c_int, c_void};

/// The oldest version 2, encoded as in the header. A library accepts programs made for its own minor version or an older
/// one.
pub(super) const API_VERSION: c_int = 20_000;
/// `RS2_CAMERA_INFO_NAME`.
pub(super) const NAME: c_int = 0;
/// `RS2_CAMERA_INFO_SERIAL_NUMBER`.
pub(super) const SERIAL_NUMBER: c_int = 1;
/// `RS2_STREAM_DEPTH`.
pub(super) const DEPTH: c_int = 1;
/// `RS2_FORMAT_Z16`: 16 bits per pixel.
pub(super) const Z16: c_int = 1;
/// `RS2_OPTION_VISUAL_PRESET`.
pub(super) const VISUAL_PRESET: c_int = 12;
/// `RS2_PLAYBACK_STATUS_STOPPED`: a file has not started to play, or has ended.
pub(super) const STOPPED: c_int = 3;
/// `RS2_TIMESTAMP_DOMAIN_SYSTEM_TIME` and `RS2_TIMESTAMP_DOMAIN_GLOBAL_TIME`: milliseconds since 1970. In the remaining
/// domain, times count from the camera's start.
pub(super) const CLOCK_TIMES: [c_int; 2] = [1, 2];

/// `rs2_context`, `rs2_device`, `rs2_frame` and so on.
pub(super) type Handle = *mut c_void;
/// Where a call stores its error.
pub(super) type ErrorPlace = *mut Handle;
/// Deletes an object.
pub(super) type Delete = unsafe extern "C" fn(Handle);

/// `rs2_intrinsics`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RawIntrinsics {
    /// Columns.
    pub(super) width: c_int,
    /// Rows.
    pub(super) height: c_int,
    /// Column of the optical axis; pixel centres are at integers.
    pub(super) ppx: f32,
    /// Row of the optical axis.
    pub(super) ppy: f32,
    /// Focal length along the rows, pixels.
    pub(super) fx: f32,
    /// Focal length along the columns, pixels.
    pub(super) fy: f32,
    /// `rs2_distortion`.
    pub(super) model: c_int,
    /// Coefficients of the distortion; their meaning depends on the model.
    pub(super) coeffs: [f32; 5],
}
