//! aravis, loaded at run time, and all unsafe code that calls it.
//!
//! The functions are those of the headers of aravis 0.8.26, and three of GLib, which are found through aravis because it
//! depends on GLib. All are looked up when the library is loaded, so that a missing one is reported then.
//!
//! Guarantees to the rest of the crate that C does not give by itself:
//! - the library is never unloaded: it has threads of its own;
//! - the list of devices is read under a lock, because the next search frees its strings;
//! - a buffer belongs either to the stream or to one [`Frame`], which borrows the device and returns the buffer.

#![expect(
    unsafe_code,
    reason = "a C library loaded at run time cannot be called without"
)]

use std::{
    ffi::{CStr, CString, c_char, c_int, c_uint, c_void},
    ops::Range,
    ptr::{self, NonNull},
    slice,
    sync::Mutex,
    time::Duration,
};

use crate::driver_search::driver_functions;
use geometry::error::lock;

/// `ARV_BUFFER_STATUS_SUCCESS`.
const SUCCESS: c_int = 0;
/// Number of buffers that the library may fill while another is being read.
const NUM_BUFFERS: usize = 4;
/// Larger frames are refused before buffers are allocated; enough for points of 22 million pixels.
const MAX_FRAME_BYTES: usize = 256 << 20;

/// A `GObject`: an `ArvCamera`, `ArvDevice`, `ArvStream` or `ArvBuffer`.
type Object = *mut c_void;
/// Where a call stores its error.
type ErrorPlace = *mut *mut GError;

/// `GError`.
#[repr(C)]
struct GError {
    domain: u32,
    code: c_int,
    message: *mut c_char,
}

driver_functions! {
    arv_update_device_list: fn();
    arv_get_n_devices: fn() -> c_uint;
    arv_get_device_id: fn(c_uint) -> *const c_char;
    arv_get_device_address: fn(c_uint) -> *const c_char;
    arv_camera_new: fn(*const c_char, ErrorPlace) -> Object;
    arv_camera_get_device: fn(Object) -> Object;
    arv_camera_is_gv_device: fn(Object) -> c_int;
    arv_gv_device_is_controller: fn(Object) -> c_int;
    arv_camera_dup_available_pixel_formats_as_strings: fn(Object, *mut c_uint, ErrorPlace) -> *mut *const c_char;
    arv_camera_is_feature_available: fn(Object, *const c_char, ErrorPlace) -> c_int;
    arv_camera_get_string: fn(Object, *const c_char, ErrorPlace) -> *const c_char;
    arv_camera_set_string: fn(Object, *const c_char, *const c_char, ErrorPlace);
    arv_camera_get_float: fn(Object, *const c_char, ErrorPlace) -> f64;
    arv_camera_get_integer: fn(Object, *const c_char, ErrorPlace) -> i64;
    arv_camera_get_boolean: fn(Object, *const c_char, ErrorPlace) -> c_int;
    arv_camera_get_payload: fn(Object, ErrorPlace) -> c_uint;
    arv_camera_create_stream: fn(Object, *mut c_void, *mut c_void, ErrorPlace) -> Object;
    arv_camera_start_acquisition: fn(Object, ErrorPlace);
    arv_camera_stop_acquisition: fn(Object, ErrorPlace);
    arv_stream_push_buffer: fn(Object, Object);
    arv_stream_timeout_pop_buffer: fn(Object, u64) -> Object;
    arv_stream_try_pop_buffer: fn(Object) -> Object;
    arv_buffer_new_allocate: fn(usize) -> Object;
    arv_buffer_get_status: fn(Object) -> c_int;
    arv_buffer_get_system_timestamp: fn(Object) -> u64;
    arv_buffer_get_data: fn(Object, *mut usize) -> *const c_void;
    arv_buffer_get_n_parts: fn(Object) -> c_uint;
    arv_buffer_get_part_pixel_format: fn(Object, c_uint) -> u32;
    arv_buffer_get_part_data: fn(Object, c_uint, *mut usize) -> *const c_void;
    arv_buffer_get_part_region: fn(Object, c_uint, *mut c_int, *mut c_int, *mut c_int, *mut c_int);
    arv_buffer_get_part_padding: fn(Object, c_uint, *mut c_int, *mut c_int);
    g_object_unref: fn(Object);
    g_error_free: fn(*mut GError);
    g_free: fn(*mut c_void);
}

impl Functions {
    /// Makes a call that may fail and passes it the place for its error; returns the library's message as the error.
    fn checked<T>(&self, call: impl FnOnce(ErrorPlace) -> T) -> Result<T, String> {
        let mut error: *mut GError = ptr::null_mut();
        let result = call(&raw mut error);
        // SAFETY: null, or an error that the call made for its caller.
        let Some(GError { message, .. }) = (unsafe { error.as_ref() }) else {
            return Ok(result);
        };
        // SAFETY: the message of an error is a C string that lives as long as the error.
        let message = unsafe { text(*message) };
        // SAFETY: the error is the caller's, and freed once.
        unsafe { (self.g_error_free)(error) };
        Err(message.unwrap_or_default())
    }
}

/// Copies a C string; `None` for null.
///
/// # Safety
/// The pointer is null, or a C string that lives during the call.
unsafe fn text(string: *const c_char) -> Option<String> {
    // SAFETY: as the caller promises.
    let string = (!string.is_null()).then(|| unsafe { CStr::from_ptr(string) })?;
    Some(string.to_string_lossy().into_owned())
}

/// A camera that answered the search.
pub(super) struct FoundDevice {
    /// ID by which it is opened.
    pub(super) id: String,
    /// Its IP address, or the location of a USB camera.
    pub(super) address: Option<String>,
}

impl Functions {
    /// Searches every network interface and USB for cameras. Takes about a second, the time cameras have to answer.
    pub(super) fn devices(&self) -> Vec<FoundDevice> {
        static SEARCH: Mutex<()> = Mutex::new(());
        let _guard = lock(&SEARCH);
        // SAFETY: takes nothing; the library locks what it changes.
        unsafe { (self.arv_update_device_list)() };
        // SAFETY: as above.
        let num = unsafe { (self.arv_get_n_devices)() };
        (0..num)
            .filter_map(|index| {
                // SAFETY: an index below the number; the text lives until the next search, which waits for the guard.
                let id = unsafe { text((self.arv_get_device_id)(index)) }?;
                // SAFETY: as above.
                let address = unsafe { text((self.arv_get_device_address)(index)) };
                Some(FoundDevice { id, address })
            })
            .collect()
    }

    /// Opens the camera with that ID or address.
    pub(super) fn open(&'static self, id: &str) -> Result<Device, String> {
        let id = CString::new(id).map_err(|error| error.to_string())?;
        let camera = self.checked(|error| {
            // SAFETY: a C string that lives during the call.
            unsafe { (self.arv_camera_new)(id.as_ptr(), error) }
        })?;
        Ok(Device {
            functions: self,
            camera: NonNull::new(camera).ok_or("no reason given")?,
            stream: None,
            buffer_bytes: 0,
        })
    }
}

/// An open camera. Dropping it stops the stream and closes the camera.
pub(super) struct Device {
    functions: &'static Functions,
    camera: NonNull<c_void>,
    stream: Option<NonNull<c_void>>,
    /// Size of each of the stream's buffers.
    buffer_bytes: usize,
}

impl Device {
    /// False if another program controls a GigE camera, or if it no longer answers the library's heartbeat.
    pub(super) fn has_control(&self) -> bool {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        // SAFETY: the camera is open.
        if unsafe { (functions.arv_camera_is_gv_device)(camera) } == 0 {
            return true;
        }
        // SAFETY: the camera is open, and its device, which stays the camera's, is one of GigE Vision.
        unsafe {
            let device = (functions.arv_camera_get_device)(camera);
            (functions.arv_gv_device_is_controller)(device) != 0
        }
    }

    /// Names of the pixel formats that the camera offers at present.
    pub(super) fn pixel_formats(&self) -> Result<Vec<String>, String> {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        let mut num: c_uint = 0;
        let names = functions.checked(|error| {
            // SAFETY: the camera is open; `num` is a place to write a number to.
            unsafe {
                (functions.arv_camera_dup_available_pixel_formats_as_strings)(
                    camera,
                    &raw mut num,
                    error,
                )
            }
        })?;
        if names.is_null() {
            return Ok(Vec::new());
        }
        // SAFETY: an array of that many C strings, which belong to the camera.
        let formats = unsafe { slice::from_raw_parts(names, num as usize) };
        // SAFETY: as above.
        let formats = formats.iter().filter_map(|&name| unsafe { text(name) });
        let formats = formats.collect();
        // SAFETY: the array is the caller's, freed once; its strings were copied.
        unsafe { (functions.g_free)(names.cast()) };
        Ok(formats)
    }

    /// True if the camera has a node of that name that is available at present.
    pub(super) fn has(&self, node: &CStr) -> Result<bool, String> {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        functions.checked(|error| {
            // SAFETY: the camera is open, the string lives during the call.
            unsafe {
                (functions.arv_camera_is_feature_available)(camera, node.as_ptr(), error) != 0
            }
        })
    }

    /// Reads a number; `None` without such a node.
    pub(super) fn number(&self, node: &CStr) -> Result<Option<f64>, String> {
        let functions = self.functions;
        let read = self.read(node, |camera, node, error| {
            // SAFETY: the camera is open, the string lives during the call.
            unsafe { (functions.arv_camera_get_float)(camera, node, error) }
        });
        // Some cameras have integer nodes where the standard has floating-point ones.
        read.or_else(|message| {
            let whole = self.read(node, |camera, node, error| {
                // SAFETY: as above.
                unsafe { (functions.arv_camera_get_integer)(camera, node, error) }
            });
            whole
                .map(|value| value.map(|value| value as f64))
                .or(Err(message))
        })
    }

    /// Reads a boolean; `None` without such a node.
    pub(super) fn flag(&self, node: &CStr) -> Result<Option<bool>, String> {
        self.read(node, |camera, node, error| {
            // SAFETY: the camera is open, the string lives during the call.
            unsafe { (self.functions.arv_camera_get_boolean)(camera, node, error) != 0 }
        })
    }

    /// Reads an enumeration or a string; `None` without such a node.
    pub(super) fn text(&self, node: &CStr) -> Result<Option<String>, String> {
        let text = self.read(node, |camera, node, error| {
            // SAFETY: the camera is open, the string lives during the call; the result is the camera's and copied.
            unsafe { text((self.functions.arv_camera_get_string)(camera, node, error)) }
        });
        text.map(Option::flatten)
    }

    fn read<T>(
        &self,
        node: &CStr,
        read: impl FnOnce(Object, *const c_char, ErrorPlace) -> T,
    ) -> Result<Option<T>, String> {
        if !self.has(node)? {
            return Ok(None);
        }
        let value = self
            .functions
            .checked(|error| read(self.camera.as_ptr(), node.as_ptr(), error));
        value.map(Some)
    }

    /// Sets an enumeration or a string.
    pub(super) fn set(&self, node: &CStr, value: &CStr) -> Result<(), String> {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        functions.checked(|error| {
            // SAFETY: the camera is open, the strings live during the call.
            unsafe {
                (functions.arv_camera_set_string)(camera, node.as_ptr(), value.as_ptr(), error);
            }
        })
    }

    /// Asks the camera for the size of a frame, bytes. Fails if it does not answer, which may take some seconds.
    pub(super) fn frame_bytes(&self) -> Result<usize, String> {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        let num = functions.checked(|error| {
            // SAFETY: the camera is open.
            unsafe { (functions.arv_camera_get_payload)(camera, error) }
        });
        num.map(|num| num as usize)
    }

    /// Starts the stream.
    pub(super) fn start(&mut self) -> Result<(), String> {
        assert!(self.stream.is_none(), "started once");
        let num_bytes = self.frame_bytes()?;
        if num_bytes == 0 || num_bytes > MAX_FRAME_BYTES {
            return Err(format!(
                "its frames have {num_bytes} bytes, expected 1 to {MAX_FRAME_BYTES}"
            ));
        }
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        let stream = functions.checked(|error| {
            // SAFETY: the camera is open; without a callback there is no data to pass to it.
            unsafe {
                (functions.arv_camera_create_stream)(
                    camera,
                    ptr::null_mut(),
                    ptr::null_mut(),
                    error,
                )
            }
        })?;
        let stream = NonNull::new(stream).ok_or("it has no stream")?;
        self.stream = Some(stream);
        self.buffer_bytes = num_bytes;
        for _ in 0..NUM_BUFFERS {
            // SAFETY: a new buffer, which is given to the stream at once.
            unsafe {
                let buffer = (functions.arv_buffer_new_allocate)(num_bytes);
                (functions.arv_stream_push_buffer)(stream.as_ptr(), buffer);
            }
        }
        functions.checked(|error| {
            // SAFETY: the camera is open.
            unsafe { (functions.arv_camera_start_acquisition)(camera, error) };
        })
    }

    /// Returns the newest frame, complete or not, waiting at most `wait` for the first.
    pub(super) fn receive(&self, wait: Duration) -> Option<Frame<'_>> {
        let (functions, stream) = (self.functions, self.stream?);
        let frame = |buffer: Object| {
            let buffer = NonNull::new(buffer)?;
            Some(Frame {
                device: self,
                stream,
                buffer,
            })
        };
        let microseconds = u64::try_from(wait.as_micros()).unwrap_or(u64::MAX);
        // SAFETY: the stream is open; a buffer that comes back is the caller's.
        let first =
            unsafe { (functions.arv_stream_timeout_pop_buffer)(stream.as_ptr(), microseconds) };
        let mut newest = frame(first)?;
        loop {
            // SAFETY: as above.
            let next = unsafe { (functions.arv_stream_try_pop_buffer)(stream.as_ptr()) };
            match frame(next) {
                Some(newer) => newest = newer,
                None => return Some(newest),
            }
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        let (functions, camera) = (self.functions, self.camera.as_ptr());
        if let Some(stream) = self.stream {
            // Stopping a camera that is gone would block.
            if self.has_control() {
                // Nothing can be done about an error of a camera that is being closed.
                let _ = functions.checked(|error| {
                    // SAFETY: the camera is open.
                    unsafe { (functions.arv_camera_stop_acquisition)(camera, error) };
                });
            }
            // SAFETY: the stream is ours and no longer used: a `Frame` borrows the device.
            unsafe { (functions.g_object_unref)(stream.as_ptr()) };
        }
        // SAFETY: the camera is ours and no longer used.
        unsafe { (functions.g_object_unref)(camera) };
    }
}

/// A filled buffer. Dropping it returns it to the stream.
pub(super) struct Frame<'a> {
    device: &'a Device,
    stream: NonNull<c_void>,
    buffer: NonNull<c_void>,
}

/// An image within a frame.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    /// Pixels per row.
    pub(super) width: usize,
    /// Number of rows.
    pub(super) height: usize,
    /// Bytes of padding after each row.
    pub(super) row_padding: usize,
    /// The bytes received; possibly fewer or more than the pixels need.
    pub(super) bytes: &'a [u8],
}

impl Frame<'_> {
    /// `Ok` if all its packets arrived, else what is wrong.
    pub(super) fn whole(&self) -> Result<(), &'static str> {
        // SAFETY: the buffer is ours.
        match unsafe { (self.device.functions.arv_buffer_get_status)(self.buffer.as_ptr()) } {
            SUCCESS => Ok(()),
            3 => Err("it did not arrive in time"),
            4 => Err("packets are missing"),
            5 => Err("a packet has a wrong number"),
            6 => Err("it is larger than the camera announced"),
            8 => Err("it was broken off"),
            _ => Err("it was not filled"),
        }
    }

    /// When this computer received it, nanoseconds since 1970.
    pub(super) fn received_at(&self) -> u64 {
        // SAFETY: the buffer is ours.
        unsafe { (self.device.functions.arv_buffer_get_system_timestamp)(self.buffer.as_ptr()) }
    }

    /// Returns the image with a pixel format, given by its number in the Pixel Format Naming Convention. `None` if there is
    /// none, or several: one of them may be grey values.
    pub(super) fn part(&self, format: u32) -> Option<Part<'_>> {
        let (functions, buffer) = (self.device.functions, self.buffer.as_ptr());
        // SAFETY: the buffer is ours, here and below.
        let num = unsafe { (functions.arv_buffer_get_n_parts)(buffer) };
        let mut indices = (0..num).filter(|&index| {
            // SAFETY: an index below the number.
            unsafe { (functions.arv_buffer_get_part_pixel_format)(buffer, index) == format }
        });
        let index = indices.next().filter(|_| indices.next().is_none())?;
        let (mut x, mut y, mut width, mut height) = (0, 0, 0, 0);
        let (mut row_padding, mut end_padding) = (0, 0);
        let (mut num_received, mut num_bytes) = (0, 0);
        // SAFETY: as above; all are places to write a number to.
        let (all, bytes) = unsafe {
            (functions.arv_buffer_get_part_region)(
                buffer,
                index,
                &raw mut x,
                &raw mut y,
                &raw mut width,
                &raw mut height,
            );
            (functions.arv_buffer_get_part_padding)(
                buffer,
                index,
                &raw mut row_padding,
                &raw mut end_padding,
            );
            (
                (functions.arv_buffer_get_data)(buffer, &raw mut num_received),
                (functions.arv_buffer_get_part_data)(buffer, index, &raw mut num_bytes),
            )
        };
        let all = NonNull::new(all.cast_mut().cast::<u8>())?;
        let offset = bytes.addr().checked_sub(all.addr().get())?;
        let range = within(
            offset,
            num_bytes,
            num_received.min(self.device.buffer_bytes),
        )?;
        // SAFETY: the library owns the buffer's bytes from `all` on, and does not write into a buffer that is not in the
        // stream.
        let received = unsafe { slice::from_raw_parts(all.as_ptr(), range.end) };
        Some(Part {
            width: usize::try_from(width).ok()?,
            height: usize::try_from(height).ok()?,
            row_padding: usize::try_from(row_padding).ok()?,
            bytes: received.get(range)?,
        })
    }
}

/// Range of a part within the received bytes. Start and size come from the camera, and the library does not check them
/// against its buffer; what was not received is cut off.
fn within(start: usize, num_bytes: usize, num_received: usize) -> Option<Range<usize>> {
    let end = start.saturating_add(num_bytes).min(num_received);
    (start <= end).then_some(start..end)
}

impl Drop for Frame<'_> {
    fn drop(&mut self) {
        // SAFETY: the buffer is ours and returns to the stream that it came from, which the device keeps alive.
        unsafe {
            (self.device.functions.arv_stream_push_buffer)(
                self.stream.as_ptr(),
                self.buffer.as_ptr(),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_ends_where_what_came_ends_whatever_the_camera_says() {
        assert_eq!(within(0, 100, 100), Some(0..100));
        assert_eq!(within(20, 30, 100), Some(20..50));
        assert_eq!(within(20, 1 << 40, 100), Some(20..100));
        assert_eq!(within(20, usize::MAX, 100), Some(20..100));
        assert_eq!(within(100, 1, 100), Some(100..100));
        assert_eq!(within(1 << 40, 1, 100), None);
    }
}
