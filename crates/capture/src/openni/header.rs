//! Types and constants of `OniCTypes.h`, `OniCEnums.h` and `OniCProperties.h` 2.2.

use std::ffi::{c_char, c_int, c_void};

/// `ONI_API_VERSION` of 2.2.
pub(super) const API_VERSION: c_int = 2002;
/// `ONI_STATUS_OK`.
pub(super) const OK: c_int = 0;
/// `ONI_STATUS_TIME_OUT`: nothing arrived in time; not an error.
pub(super) const TIME_OUT: c_int = 102;
/// `ONI_SENSOR_DEPTH`.
pub(super) const SENSOR_DEPTH: c_int = 3;
/// `ONI_PIXEL_FORMAT_DEPTH_1_MM`.
pub(super) const DEPTH_1_MM: c_int = 100;
/// `ONI_PIXEL_FORMAT_DEPTH_100_UM`.
pub(super) const DEPTH_100_UM: c_int = 101;
/// `ONI_DEVICE_STATE_ERROR`.
pub(super) const STATE_ERROR: c_int = 1;
/// `ONI_DEVICE_STATE_EOF`: the end of a file.
pub(super) const STATE_END_OF_FILE: c_int = 3;

/// `ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION`, a `c_int`: 0 is off.
pub(super) const DEVICE_REGISTRATION: c_int = 5;
/// `ONI_DEVICE_PROPERTY_PLAYBACK_SPEED`, an `f32`: 1 as recorded, -1 one frame per wait.
pub(super) const DEVICE_SPEED: c_int = 100;
/// `ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED`, a `c_int`.
pub(super) const DEVICE_REPEAT: c_int = 101;
/// `ONI_STREAM_PROPERTY_CROPPING`, a [`Cropping`].
pub(super) const STREAM_CROPPING: c_int = 0;
/// `ONI_STREAM_PROPERTY_HORIZONTAL_FOV`, an `f32` in radians.
pub(super) const STREAM_HORIZONTAL_VIEW: c_int = 1;
/// `ONI_STREAM_PROPERTY_VERTICAL_FOV`, an `f32` in radians.
pub(super) const STREAM_VERTICAL_VIEW: c_int = 2;
/// `ONI_STREAM_PROPERTY_VIDEO_MODE`, a [`VideoMode`].
pub(super) const STREAM_MODE: c_int = 3;
/// `ONI_STREAM_PROPERTY_MIRRORING`, a `c_int`.
pub(super) const STREAM_MIRRORING: c_int = 7;

/// Type of a property: every bit pattern of its size is a valid value.
pub(super) trait Property: Copy + Default {}

impl Property for c_int {}
impl Property for f32 {}
impl Property for VideoMode {}
impl Property for Cropping {}

/// `OniVideoMode`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct VideoMode {
    /// `DEPTH_1_MM` or another.
    pub(super) format: c_int,
    /// Columns.
    pub(super) width: c_int,
    /// Rows.
    pub(super) height: c_int,
    /// Frames per second.
    pub(super) rate: c_int,
}

/// `OniCropping`.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub(super) struct Cropping {
    /// Not 0 if only a part of the picture is sent.
    pub(super) is_enabled: c_int,
    left: c_int,
    top: c_int,
    width: c_int,
    height: c_int,
}

/// `OniSensorInfo`.
#[repr(C)]
pub(super) struct SensorInfo {
    sensor: c_int,
    /// Number of `modes`.
    pub(super) num_modes: c_int,
    /// Pointer to the first mode.
    pub(super) modes: *const VideoMode,
}

/// `OniDeviceInfo`; its strings end with NUL.
#[repr(C)]
pub(super) struct DeviceInfo {
    /// URI by which the device is opened.
    pub(super) uri: [c_char; 256],
    /// Manufacturer.
    pub(super) vendor: [c_char; 256],
    /// Model.
    pub(super) name: [c_char; 256],
    usb_vendor: u16,
    usb_product: u16,
}

/// `OniFrame`.
#[repr(C)]
pub(super) struct Frame {
    /// Size of `data`, bytes.
    pub(super) num_bytes: c_int,
    /// Rows of `stride` bytes each.
    pub(super) data: *const c_void,
    sensor: c_int,
    timestamp: u64,
    number: c_int,
    /// Number of columns sent.
    pub(super) width: c_int,
    /// Number of rows sent.
    pub(super) height: c_int,
    /// Mode in which it was captured.
    pub(super) mode: VideoMode,
    /// Not 0 if it is a part of the picture.
    pub(super) is_cropped: c_int,
    left: c_int,
    top: c_int,
    /// Distance between the starts of two rows, bytes.
    pub(super) stride: c_int,
}

/// `OniDeviceInfoCallback`.
pub(super) type OnDevice = extern "C" fn(*const DeviceInfo, *mut c_void);
/// `OniDeviceStateCallback`.
pub(super) type OnState = extern "C" fn(*const DeviceInfo, c_int, *mut c_void);

/// `OniDeviceCallbacks`.
#[repr(C)]
pub(super) struct DeviceCallbacks {
    /// A device was plugged in.
    pub(super) connected: OnDevice,
    /// A device was unplugged.
    pub(super) disconnected: OnDevice,
    /// A device's state changed.
    pub(super) state: OnState,
}
