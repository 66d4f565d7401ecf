//! libOpenNI2, loaded at run time, and all unsafe code that calls it, like libfreenect in `kinect/freenect.rs`.
//!
//! The functions are those of `OniCAPI.h` 2.2, looked up when the library is loaded.
//!
//! Guarantees to the rest of the crate that C does not give by itself:
//! - one [`Context`] at a time in the process, made and used on the library's thread alone (`library_thread`);
//! - the library is never unloaded, because its drivers may have threads;
//! - it never holds a pointer into our memory: frames are copied, and its threads report to a static.
//!
//! While it starts, the library changes the working directory to that of its drivers and back. On Linux its thread has a
//! working directory of its own, so that no other thread resolves a path there in the meantime.

#![expect(
    unsafe_code,
    reason = "a C library loaded at run time cannot be called without"
)]

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    ptr::{self, NonNull},
    sync::Mutex,
    thread,
    time::Duration,
};

use super::header::{
    API_VERSION, DeviceCallbacks, DeviceInfo, Frame, OK, Property, SENSOR_DEPTH, STATE_END_OF_FILE,
    STATE_ERROR, SensorInfo, TIME_OUT, VideoMode,
};
use crate::{
    camera_error::{CameraError, CameraErrorKind},
    camera_library::OPENNI,
    driver_search::driver_functions,
};
use geometry::error::lock;

/// Pause between stopping and destroying a stream. The thread that plays a file iterates over the streams without a lock,
/// continuously while one runs and every 10 ms otherwise; destroying a stream during that crashes it.
const DESTROY_PAUSE: Duration = Duration::from_millis(100);

driver_functions! {
    #[expect(non_snake_case, reason = "the names of the library")]
    oniInitialize: fn(c_int) -> c_int;
    oniShutdown: fn();
    oniGetExtendedError: fn() -> *const c_char;
    oniGetDeviceList: fn(*mut *mut DeviceInfo, *mut c_int) -> c_int;
    oniReleaseDeviceList: fn(*mut DeviceInfo) -> c_int;
    oniRegisterDeviceCallbacks: fn(*mut DeviceCallbacks, *mut c_void, *mut *mut c_void) -> c_int;
    oniUnregisterDeviceCallbacks: fn(*mut c_void);
    oniDeviceOpen: fn(*const c_char, *mut *mut c_void) -> c_int;
    oniDeviceClose: fn(*mut c_void) -> c_int;
    oniDeviceGetSensorInfo: fn(*mut c_void, c_int) -> *const SensorInfo;
    oniDeviceSetProperty: fn(*mut c_void, c_int, *const c_void, c_int) -> c_int;
    oniDeviceCreateStream: fn(*mut c_void, c_int, *mut *mut c_void) -> c_int;
    oniStreamDestroy: fn(*mut c_void);
    oniStreamStart: fn(*mut c_void) -> c_int;
    oniStreamStop: fn(*mut c_void);
    oniStreamGetProperty: fn(*mut c_void, c_int, *mut c_void, *mut c_int) -> c_int;
    oniStreamSetProperty: fn(*mut c_void, c_int, *const c_void, c_int) -> c_int;
    oniWaitForAnyStream: fn(*mut *mut c_void, c_int, *mut c_int, c_int) -> c_int;
    oniStreamReadFrame: fn(*mut c_void, *mut *mut Frame) -> c_int;
    oniFrameRelease: fn(*mut Frame);
}

/// A running library. Dropping it shuts the library down.
pub(super) struct Context {
    functions: &'static Functions,
}

/// Messages of the library about a call that failed, one sentence each; may be empty.
pub(super) type Messages = Vec<String>;

/// A device that is plugged in.
pub(super) struct FoundDevice {
    /// URI by which it is opened. It changes when the device is plugged in again.
    pub(super) uri: String,
    /// Manufacturer and model.
    pub(super) name: String,
}

impl Context {
    /// Starts the library with all its drivers.
    pub(super) fn new(functions: &'static Functions) -> Result<Self, CameraError> {
        // The library counts failed starts too: dropping the context undoes the count.
        let context = Self { functions };
        context
            // SAFETY: takes a number; nobody else starts or stops the library in the meantime.
            .checked(|| unsafe { (functions.oniInitialize)(API_VERSION) })
            .map_err(|messages| {
                OPENNI
                    .error(CameraErrorKind::LibraryNotStarted)
                    .quoting(messages)
            })?;
        Ok(context)
    }

    /// Lists the devices that are plugged in, whether they can be opened or not.
    pub(super) fn devices(&self) -> Result<Vec<FoundDevice>, Messages> {
        let (mut first, mut num) = (ptr::null_mut(), 0);
        // SAFETY: the library runs; both are places to write to.
        self.checked(|| unsafe {
            (self.functions.oniGetDeviceList)(&raw mut first, &raw mut num)
        })?;
        let devices = (0..usize::try_from(num).unwrap_or(0)).map(|index| {
            // SAFETY: the list is the library's, holds `num` devices, and lives until it is released below.
            let info = unsafe { &*first.add(index) };
            let [vendor, name] = [&info.vendor, &info.name].map(text);
            FoundDevice {
                uri: text(&info.uri),
                name: format!("{vendor} {name}").trim().to_owned(),
            }
        });
        let devices = devices.collect();
        // SAFETY: the list as it was given, once.
        unsafe { (self.functions.oniReleaseDeviceList)(first) };
        Ok(devices)
    }

    /// Opens the device or the recorded file, and creates its depth stream.
    pub(super) fn open(self, uri: &CStr) -> Result<Device, Messages> {
        let functions = self.functions;
        *lock(&REPORTED) = Reported {
            uri: uri.to_string_lossy().into_owned(),
            ..Reported::NOTHING
        };
        let mut callbacks = DeviceCallbacks {
            connected: on_connected,
            disconnected: on_disconnected,
            state: on_state,
        };
        let mut handle = ptr::null_mut();
        // SAFETY: the library runs and copies the functions, which belong to this program and outlive it; `handle` is a
        // place to write a pointer to.
        self.checked(|| unsafe {
            (functions.oniRegisterDeviceCallbacks)(
                &raw mut callbacks,
                ptr::null_mut(),
                &raw mut handle,
            )
        })?;
        // From here on, dropping `device` undoes every step.
        let mut device = Device {
            callbacks: handle,
            handle: ptr::null_mut(),
            stream: ptr::null_mut(),
            reported: &REPORTED,
            context: self,
        };
        let mut handle = ptr::null_mut();
        // SAFETY: the library runs, the text ends with 0, and `handle` is a place to write a pointer to.
        let opened = device
            .context
            .checked(|| unsafe { (functions.oniDeviceOpen)(uri.as_ptr(), &raw mut handle) });
        // If opening fails, the library returns a handle without a device; do not keep it.
        opened?;
        device.handle = NonNull::new(handle).ok_or_else(Messages::new)?.as_ptr();
        let (of, mut stream) = (device.handle, ptr::null_mut());
        // SAFETY: the device is open, and `stream` is a place to write a pointer to.
        device.context.checked(|| unsafe {
            (functions.oniDeviceCreateStream)(of, SENSOR_DEPTH, &raw mut stream)
        })?;
        device.stream = NonNull::new(stream).ok_or_else(Messages::new)?.as_ptr();
        Ok(device)
    }

    /// Calls the library and collects its messages on failure, which it stores per thread.
    fn checked(&self, call: impl FnOnce() -> c_int) -> Result<(), Messages> {
        if call() == OK {
            return Ok(());
        }
        // SAFETY: takes nothing; the text ends with 0 and lives until this thread's next call.
        let message = unsafe {
            let message = (self.functions.oniGetExtendedError)();
            (!message.is_null()).then(|| CStr::from_ptr(message).to_string_lossy().into_owned())
        };
        let message = message.unwrap_or_default();
        let lines = message
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty());
        Err(lines.map(str::to_owned).collect())
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: the library was started once, and a `Device` drops its context last.
        unsafe { (self.functions.oniShutdown)() };
    }
}

/// Converts a string that ends with NUL or fills its array.
fn text(chars: &[c_char; 256]) -> String {
    let bytes = chars.iter().map(|&c| c as u8).take_while(|&byte| byte != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

/// Gives this thread a working directory of its own, initially the common one.
pub(super) fn use_own_working_folder() {
    #[cfg(target_os = "linux")]
    {
        const CLONE_FS: c_int = 0x200;
        unsafe extern "C" {
            fn unshare(flags: c_int) -> c_int;
        }
        // SAFETY: takes a number and changes only what this thread shares. If it is forbidden, nothing changes.
        let _ = unsafe { unshare(CLONE_FS) };
    }
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

/// An open device with its depth stream. Dropping it stops the stream, closes the device and shuts the library down.
pub(super) struct Device {
    callbacks: *mut c_void,
    /// Null until it is open.
    handle: *mut c_void,
    /// Null until it is created.
    stream: *mut c_void,
    reported: &'static Mutex<Reported>,
    context: Context,
}

impl Device {
    /// The device's depth modes.
    pub(super) fn modes(&self) -> Vec<VideoMode> {
        // SAFETY: the device is open; the result is null, or lives as long as the device.
        let sensor = unsafe {
            (self.context.functions.oniDeviceGetSensorInfo)(self.handle, SENSOR_DEPTH).as_ref()
        };
        let Some(sensor) = sensor.filter(|sensor| !sensor.modes.is_null()) else {
            return Vec::new();
        };
        (0..usize::try_from(sensor.num_modes).unwrap_or(0))
            // SAFETY: there are `num_modes` of them.
            .map(|index| unsafe { *sensor.modes.add(index) })
            .collect()
    }

    /// Sets a property of the device; fails if the device lacks it or rejects the value.
    pub(super) fn set_device<T: Property>(
        &self,
        property: c_int,
        value: T,
    ) -> Result<(), Messages> {
        let set = self.context.functions.oniDeviceSetProperty;
        let (value, size) = (&raw const value, size_of::<T>() as c_int);
        self.context
            // SAFETY: the device is open, and the value has the given size.
            .checked(|| unsafe { set(self.handle, property, value.cast(), size) })
    }

    /// Sets a property of the stream; fails if the stream lacks it or rejects the value.
    pub(super) fn set<T: Property>(&self, property: c_int, value: T) -> Result<(), Messages> {
        let set = self.context.functions.oniStreamSetProperty;
        let (value, size) = (&raw const value, size_of::<T>() as c_int);
        self.context
            // SAFETY: there is a stream, and the value has the given size.
            .checked(|| unsafe { set(self.stream, property, value.cast(), size) })
    }

    /// Reads a property of the stream; `None` if it is not available.
    pub(super) fn get<T: Property>(&self, property: c_int) -> Option<T> {
        let get = self.context.functions.oniStreamGetProperty;
        let (mut value, mut size) = (T::default(), size_of::<T>() as c_int);
        let place = (&raw mut value).cast();
        // SAFETY: there is a stream; the place has the given size, and any bits are a value of the type.
        let code = unsafe { get(self.stream, property, place, &raw mut size) };
        (code == OK && size == size_of::<T>() as c_int).then_some(value)
    }

    /// Starts the stream.
    pub(super) fn start(&self) -> Result<(), Messages> {
        self.context
            // SAFETY: there is a stream.
            .checked(|| unsafe { (self.context.functions.oniStreamStart)(self.stream) })
    }

    /// Waits for about `wait` at most, and returns the newest frame, if any.
    pub(super) fn receive(&self, wait: Duration) -> Result<Option<Received>, Messages> {
        let functions = self.context.functions;
        let (mut stream, mut index) = (self.stream, 0);
        let wait_ms = c_int::try_from(wait.as_millis()).unwrap_or(c_int::MAX);
        let mut has_timed_out = false;
        let waited = self.context.checked(|| {
            // SAFETY: there is one stream, and `index` is a place to write a number to.
            let code = unsafe {
                (functions.oniWaitForAnyStream)(&raw mut stream, 1, &raw mut index, wait_ms)
            };
            has_timed_out = code == TIME_OUT;
            if has_timed_out { OK } else { code }
        });
        waited?;
        if has_timed_out {
            return Ok(None);
        }
        let mut frame = ptr::null_mut();
        self.context
            // SAFETY: there is a stream with a frame, and `frame` is a place to write a pointer to.
            .checked(|| unsafe { (functions.oniStreamReadFrame)(self.stream, &raw mut frame) })?;
        // SAFETY: null, or a frame that is ours until it is released.
        let received = unsafe { frame.as_ref() }.map(copied);
        if !frame.is_null() {
            // SAFETY: the frame as it was given, once; it was copied.
            unsafe { (functions.oniFrameRelease)(frame) };
        }
        received.transpose()
    }

    /// True once the device was unplugged or reported an error.
    pub(super) fn is_lost(&self) -> bool {
        lock(self.reported).is_lost
    }

    /// True once a file has ended. Its last frame may still have to be received.
    pub(super) fn is_at_end(&self) -> bool {
        lock(self.reported).is_at_end
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        let functions = self.context.functions;
        // SAFETY: each was created, is no longer used, and is released once; the library accepts that a stream was never
        // started, and that the device is unplugged.
        unsafe {
            if !self.stream.is_null() {
                (functions.oniStreamStop)(self.stream);
                thread::sleep(DESTROY_PAUSE);
                (functions.oniStreamDestroy)(self.stream);
            }
            if !self.handle.is_null() {
                (functions.oniDeviceClose)(self.handle);
            }
            (functions.oniUnregisterDeviceCallbacks)(self.callbacks);
        }
    }
}

/// Copies a frame of 16 bits per pixel; fails if its sizes are inconsistent.
fn copied(frame: &Frame) -> Result<Received, Messages> {
    let size = |number: c_int| usize::try_from(number).unwrap_or(0);
    let (width, height) = (size(frame.width), size(frame.height));
    let (stride, num_bytes) = (size(frame.stride), size(frame.num_bytes));
    let needed = height
        .checked_sub(1)
        .and_then(|rows| rows.checked_mul(stride)?.checked_add(2 * width));
    let is_whole = width > 0 && stride >= 2 * width && needed.is_some_and(|n| n <= num_bytes);
    if frame.data.is_null() || !is_whole {
        let message = format!(
            "a frame of {width}×{height} pixels, {stride} bytes a row and {num_bytes} in all"
        );
        return Err(vec![message]);
    }
    let mut depth = vec![0_u16; width * height];
    for (row, pixels) in depth.chunks_exact_mut(width).enumerate() {
        // SAFETY: the last row ends within the frame's bytes, as was checked; bytes are copied, because the data need
        // not be aligned for more.
        unsafe {
            let from = frame.data.cast::<u8>().add(row * stride);
            ptr::copy_nonoverlapping(from, pixels.as_mut_ptr().cast::<u8>(), 2 * width);
        }
    }
    let is_whole_picture = frame.is_cropped == 0
        && frame.width == frame.mode.width
        && frame.height == frame.mode.height;
    Ok(Received {
        mode: frame.mode,
        is_part: !is_whole_picture,
        depth,
    })
}

/// What the library's threads have reported about the open device.
struct Reported {
    uri: String,
    is_lost: bool,
    is_at_end: bool,
}

impl Reported {
    const NOTHING: Self = Self {
        uri: String::new(),
        is_lost: false,
        is_at_end: false,
    };
}

static REPORTED: Mutex<Reported> = Mutex::new(Reported::NOTHING);

/// Applies a report about the open device, and ignores those about others.
fn report(info: *const DeviceInfo, note: impl FnOnce(&mut Reported)) {
    // SAFETY: null, or a structure that lives for the duration of the call.
    let Some(info) = (unsafe { info.as_ref() }) else {
        return;
    };
    let mut reported = lock(&REPORTED);
    if reported.uri == text(&info.uri) {
        note(&mut reported);
    }
}

extern "C" fn on_connected(_info: *const DeviceInfo, _cookie: *mut c_void) {}

extern "C" fn on_disconnected(info: *const DeviceInfo, _cookie: *mut c_void) {
    report(info, |reported| reported.is_lost = true);
}

extern "C" fn on_state(info: *const DeviceInfo, state: c_int, _cookie: *mut c_void) {
    report(info, |reported| match state {
        STATE_ERROR => reported.is_lost = true,
        STATE_END_OF_FILE => reported.is_at_end = true,
        _ => {}
    });
}
