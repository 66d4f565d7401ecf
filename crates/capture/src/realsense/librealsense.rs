//! librealsense 2, loaded at run time, and all unsafe code that calls it.
//!
//! The functions are those of its headers, looked up when the library is loaded.
//!
//! Guarantees to the rest of the crate that C does not give by itself:
//! - the library is never unloaded: it has threads of its own;
//! - every error is read and freed by the call that returned it;
//! - an object is deleted once, after those created from it: fields are in that order;
//! - frames are copied, and the library never holds a pointer into our memory.

#![expect(
    unsafe_code,
    reason = "a C library loaded at run time cannot be called without"
)]

use std::{
    ffi::{CStr, c_char, c_int, c_uint, c_void},
    ptr::{self, NonNull},
    rc::Rc,
    slice,
    time::Duration,
};

use super::header::{
    API_VERSION, CLOCK_TIMES, DEPTH, Delete, ErrorPlace, Handle, NAME, RawIntrinsics,
    SERIAL_NUMBER, STOPPED, VISUAL_PRESET, Z16,
};
use crate::driver_search::driver_functions;

/// Capacity of the frame queue, for a camera and for a file. For a camera only the newest frame counts. For a file none may
/// be lost: after the queue was emptied to stop the library's threads, it has room for all frames that they may still hold,
/// about 12. The library allocates at most 32 frames at a time.
const QUEUE_CAPACITY: [c_int; 2] = [1, 16];
/// More frames than the queue and the library's threads can hold.
const MAX_DRAINED: usize = 64;
/// Upper limit of preset numbers, from 0; a camera has about ten presets.
const MAX_PRESETS: i16 = 100;

driver_functions! {
    rs2_get_error_message: fn(Handle) -> *const c_char;
    rs2_free_error: fn(Handle);
    rs2_create_context: fn(c_int, ErrorPlace) -> Handle;
    rs2_delete_context: fn(Handle);
    rs2_query_devices: fn(Handle, ErrorPlace) -> Handle;
    rs2_delete_device_list: fn(Handle);
    rs2_get_device_count: fn(Handle, ErrorPlace) -> c_int;
    rs2_device_list_contains: fn(Handle, Handle, ErrorPlace) -> c_int;
    rs2_create_device: fn(Handle, c_int, ErrorPlace) -> Handle;
    rs2_context_add_device: fn(Handle, *const c_char, ErrorPlace) -> Handle;
    rs2_delete_device: fn(Handle);
    rs2_supports_device_info: fn(Handle, c_int, ErrorPlace) -> c_int;
    rs2_get_device_info: fn(Handle, c_int, ErrorPlace) -> *const c_char;
    rs2_playback_device_pause: fn(Handle, ErrorPlace);
    rs2_playback_device_set_real_time: fn(Handle, c_int, ErrorPlace);
    rs2_playback_device_set_playback_speed: fn(Handle, f32, ErrorPlace);
    rs2_playback_device_get_current_status: fn(Handle, ErrorPlace) -> c_int;
    rs2_query_sensors: fn(Handle, ErrorPlace) -> Handle;
    rs2_delete_sensor_list: fn(Handle);
    rs2_get_sensors_count: fn(Handle, ErrorPlace) -> c_int;
    rs2_create_sensor: fn(Handle, c_int, ErrorPlace) -> Handle;
    rs2_delete_sensor: fn(Handle);
    rs2_get_depth_scale: fn(Handle, ErrorPlace) -> f32;
    rs2_supports_option: fn(Handle, c_int, ErrorPlace) -> c_int;
    rs2_get_option_range: fn(Handle, c_int, *mut f32, *mut f32, *mut f32, *mut f32, ErrorPlace);
    rs2_get_option_value_description: fn(Handle, c_int, f32, ErrorPlace) -> *const c_char;
    rs2_set_option: fn(Handle, c_int, f32, ErrorPlace);
    rs2_get_stream_profiles: fn(Handle, ErrorPlace) -> Handle;
    rs2_delete_stream_profiles_list: fn(Handle);
    rs2_get_stream_profiles_count: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_stream_profile: fn(Handle, c_int, ErrorPlace) -> Handle;
    rs2_get_stream_profile_data: fn(Handle, *mut c_int, *mut c_int, *mut c_int, *mut c_int, *mut c_int, ErrorPlace);
    rs2_get_video_stream_resolution: fn(Handle, *mut c_int, *mut c_int, ErrorPlace);
    rs2_get_video_stream_intrinsics: fn(Handle, *mut RawIntrinsics, ErrorPlace);
    rs2_create_frame_queue: fn(c_int, ErrorPlace) -> Handle;
    rs2_delete_frame_queue: fn(Handle);
    rs2_try_wait_for_frame: fn(Handle, c_uint, *mut Handle, ErrorPlace) -> c_int;
    rs2_open: fn(Handle, Handle, ErrorPlace);
    rs2_start_queue: fn(Handle, Handle, ErrorPlace);
    rs2_stop: fn(Handle, ErrorPlace);
    rs2_close: fn(Handle, ErrorPlace);
    rs2_get_frame_width: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_frame_height: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_frame_stride_in_bytes: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_frame_bits_per_pixel: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_frame_data_size: fn(Handle, ErrorPlace) -> c_int;
    rs2_get_frame_data: fn(Handle, ErrorPlace) -> *const c_void;
    rs2_get_frame_timestamp: fn(Handle, ErrorPlace) -> f64;
    rs2_get_frame_timestamp_domain: fn(Handle, ErrorPlace) -> c_int;
    rs2_release_frame: fn(Handle);
}

impl Functions {
    /// Makes a call that may fail and passes it the place for its error; returns the library's message as the error.
    fn checked<T>(&self, call: impl FnOnce(ErrorPlace) -> T) -> Result<T, String> {
        let mut error: Handle = ptr::null_mut();
        let result = call(&raw mut error);
        if error.is_null() {
            return Ok(result);
        }
        // SAFETY: an error that the call made for its caller; its message lives as long as the error.
        let message = unsafe { text((self.rs2_get_error_message)(error)) };
        // SAFETY: the error is the caller's, and freed once; the message was copied.
        unsafe { (self.rs2_free_error)(error) };
        let message = message.unwrap_or_default();
        let lines: Vec<&str> = message.lines().map(str::trim).collect();
        Err(lines.join(" "))
    }

    /// Makes a call that creates an object.
    fn made(
        &self,
        delete: Delete,
        call: impl FnOnce(ErrorPlace) -> Handle,
    ) -> Result<Object, String> {
        let handle = NonNull::new(self.checked(call)?).ok_or("no reason given")?;
        Ok(Object { handle, delete })
    }

    /// Reads an integer of an object.
    fn number(
        &self,
        of: &Object,
        read: unsafe extern "C" fn(Handle, ErrorPlace) -> c_int,
    ) -> Result<c_int, String> {
        // SAFETY: the object lives, and is of the kind that the caller's function reads.
        self.checked(|error| unsafe { read(of.handle(), error) })
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

/// An object of the library. Dropping it deletes it.
struct Object {
    handle: NonNull<c_void>,
    delete: Delete,
}

impl Object {
    fn handle(&self) -> Handle {
        self.handle.as_ptr()
    }
}

impl Drop for Object {
    fn drop(&mut self) {
        // SAFETY: made for us, deleted once, and no longer used.
        unsafe { (self.delete)(self.handle()) };
    }
}

/// A running library.
#[derive(Clone)]
pub(super) struct Context {
    functions: &'static Functions,
    object: Rc<Object>,
}

impl Context {
    /// Starts the library.
    pub(super) fn new(functions: &'static Functions) -> Result<Self, String> {
        let object = functions.made(functions.rs2_delete_context, |error| {
            // SAFETY: takes a number.
            unsafe { (functions.rs2_create_context)(API_VERSION, error) }
        })?;
        Ok(Self {
            functions,
            object: Rc::new(object),
        })
    }

    /// Lists the devices that are plugged in, whether they can be opened or not.
    pub(super) fn devices(&self) -> Result<DeviceList, String> {
        let functions = self.functions;
        let object = functions.made(functions.rs2_delete_device_list, |error| {
            // SAFETY: the context lives.
            unsafe { (functions.rs2_query_devices)(self.object.handle(), error) }
        })?;
        Ok(DeviceList {
            num: functions.number(&object, functions.rs2_get_device_count)?,
            object,
            context: self.clone(),
        })
    }

    /// Opens a recorded file.
    pub(super) fn open_file(&self, path: &CStr) -> Result<Device, String> {
        let functions = self.functions;
        let object = functions.made(functions.rs2_delete_device, |error| {
            // SAFETY: the context lives, and the path is a C string that lives during the call.
            unsafe {
                (functions.rs2_context_add_device)(self.object.handle(), path.as_ptr(), error)
            }
        })?;
        Ok(Device {
            object,
            is_file: true,
            context: self.clone(),
        })
    }
}

/// The devices that were plugged in at one time.
pub(super) struct DeviceList {
    num: c_int,
    object: Object,
    context: Context,
}

impl DeviceList {
    /// Opens one device after the other.
    pub(super) fn open_each(&self) -> impl Iterator<Item = Result<Device, String>> {
        (0..self.num).map(|index| self.open(index))
    }

    fn open(&self, index: c_int) -> Result<Device, String> {
        let functions = self.context.functions;
        let object = functions.made(functions.rs2_delete_device, |error| {
            // SAFETY: the list lives and has that many devices.
            unsafe { (functions.rs2_create_device)(self.object.handle(), index, error) }
        })?;
        Ok(Device {
            object,
            is_file: false,
            context: self.context.clone(),
        })
    }
}

/// A camera, or a file that is played.
pub(super) struct Device {
    object: Object,
    is_file: bool,
    context: Context,
}

impl Device {
    /// Manufacturer and model.
    pub(super) fn name(&self) -> Option<String> {
        self.info(NAME)
    }

    /// The serial number printed on the camera.
    pub(super) fn serial_number(&self) -> Option<String> {
        self.info(SERIAL_NUMBER)
    }

    fn info(&self, info: c_int) -> Option<String> {
        let (functions, device) = (self.context.functions, self.object.handle());
        let is_supported = functions.checked(|error| {
            // SAFETY: the device lives.
            unsafe { (functions.rs2_supports_device_info)(device, info, error) != 0 }
        });
        if !is_supported.ok()? {
            return None;
        }
        let value = functions.checked(|error| {
            // SAFETY: the device lives; the text is its own and copied.
            unsafe { text((functions.rs2_get_device_info)(device, info, error)) }
        });
        value.ok().flatten().filter(|text| !text.is_empty())
    }

    /// Returns the device's first sensor with depth; `None` if there is none.
    pub(super) fn depth_sensor(self) -> Result<Option<Sensor>, String> {
        let functions = self.context.functions;
        let sensors = functions.made(functions.rs2_delete_sensor_list, |error| {
            // SAFETY: the device lives.
            unsafe { (functions.rs2_query_sensors)(self.object.handle(), error) }
        })?;
        let mut error = None;
        for index in 0..functions.number(&sensors, functions.rs2_get_sensors_count)? {
            let object = functions.made(functions.rs2_delete_sensor, |error| {
                // SAFETY: the list lives and has that many sensors.
                unsafe { (functions.rs2_create_sensor)(sensors.handle(), index, error) }
            })?;
            match depth_modes(functions, &object) {
                Ok((_, modes)) if modes.is_empty() => {}
                Ok((profiles, modes)) => {
                    return Ok(Some(Sensor {
                        modes,
                        profiles,
                        object,
                        device: self,
                    }));
                }
                Err(message) => error = Some(message),
            }
        }
        error.map_or(Ok(None), Err)
    }

    fn set_real_time(&self, is_real_time: c_int) -> Result<(), String> {
        let functions = self.context.functions;
        functions.checked(|error| {
            // SAFETY: the device lives.
            unsafe {
                (functions.rs2_playback_device_set_real_time)(
                    self.object.handle(),
                    is_real_time,
                    error,
                );
            }
        })
    }
}

/// A sensor's mode with 16-bit depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DepthMode {
    /// Columns.
    pub(super) width: c_int,
    /// Rows.
    pub(super) height: c_int,
    /// Frames per second.
    pub(super) rate: c_int,
    /// Index among the sensor's profiles.
    pub(super) index: c_int,
}

/// Returns the profiles of a sensor, and the depth modes among them.
fn depth_modes(functions: &Functions, sensor: &Object) -> Result<(Object, Vec<DepthMode>), String> {
    let profiles = functions.made(functions.rs2_delete_stream_profiles_list, |error| {
        // SAFETY: the sensor lives.
        unsafe { (functions.rs2_get_stream_profiles)(sensor.handle(), error) }
    })?;
    let mut modes = Vec::new();
    for index in 0..functions.number(&profiles, functions.rs2_get_stream_profiles_count)? {
        let profile = profile_at(functions, &profiles, index)?;
        let (mut stream, mut format, mut index, mut id, mut rate) = (0, 0, 0, 0, 0);
        functions.checked(|error| {
            // SAFETY: the profile lives as long as the list; the others are places to write numbers to.
            unsafe {
                (functions.rs2_get_stream_profile_data)(
                    profile,
                    &raw mut stream,
                    &raw mut format,
                    &raw mut index,
                    &raw mut id,
                    &raw mut rate,
                    error,
                );
            }
        })?;
        if (stream, format) != (DEPTH, Z16) {
            continue;
        }
        let (mut width, mut height) = (0, 0);
        functions.checked(|error| {
            // SAFETY: as above; depth is a video stream.
            unsafe {
                (functions.rs2_get_video_stream_resolution)(
                    profile,
                    &raw mut width,
                    &raw mut height,
                    error,
                );
            }
        })?;
        modes.push(DepthMode {
            width,
            height,
            rate,
            index,
        });
    }
    Ok((profiles, modes))
}

/// Returns a profile, which lives as long as the list.
fn profile_at(functions: &Functions, profiles: &Object, index: c_int) -> Result<Handle, String> {
    functions.checked(|error| {
        // SAFETY: the list lives and has that many profiles.
        unsafe { (functions.rs2_get_stream_profile)(profiles.handle(), index, error) }
    })
}

/// A sensor with depth.
pub(super) struct Sensor {
    modes: Vec<DepthMode>,
    profiles: Object,
    object: Object,
    device: Device,
}

impl Sensor {
    /// The sensor's depth modes, at least one.
    pub(super) fn modes(&self) -> &[DepthMode] {
        &self.modes
    }

    /// Metres per unit of depth.
    pub(super) fn depth_scale(&self) -> Result<f32, String> {
        let functions = self.functions();
        functions.checked(|error| {
            // SAFETY: the sensor lives.
            unsafe { (functions.rs2_get_depth_scale)(self.object.handle(), error) }
        })
    }

    /// The intrinsics of a mode.
    pub(super) fn intrinsics(&self, mode: &DepthMode) -> Result<RawIntrinsics, String> {
        let functions = self.functions();
        let profile = profile_at(functions, &self.profiles, mode.index)?;
        let mut intrinsics = RawIntrinsics::default();
        functions.checked(|error| {
            // SAFETY: the profile lives as long as the list, and the place has the type that is written.
            unsafe {
                (functions.rs2_get_video_stream_intrinsics)(profile, &raw mut intrinsics, error);
            }
        })?;
        Ok(intrinsics)
    }

    /// Numbers and names of the visual presets; empty without that option.
    pub(super) fn presets(&self) -> Result<Vec<(f32, String)>, String> {
        let (functions, sensor) = (self.functions(), self.object.handle());
        let has_presets = functions.checked(|error| {
            // SAFETY: the sensor lives; it is a container of options, like every sensor.
            unsafe { (functions.rs2_supports_option)(sensor, VISUAL_PRESET, error) != 0 }
        })?;
        if !has_presets {
            return Ok(Vec::new());
        }
        let (mut first, mut last, mut step, mut usual) = (0.0, 0.0, 0.0, 0.0);
        functions.checked(|error| {
            // SAFETY: as above; the others are places to write numbers to.
            unsafe {
                (functions.rs2_get_option_range)(
                    sensor,
                    VISUAL_PRESET,
                    &raw mut first,
                    &raw mut last,
                    &raw mut step,
                    &raw mut usual,
                    error,
                );
            }
        })?;
        let numbers = (0..MAX_PRESETS).map(f32::from);
        let numbers = numbers.filter(|number| (first..=last).contains(number));
        let name = |number| {
            functions.checked(|error| {
                // SAFETY: as above; the text is the sensor's and copied.
                unsafe {
                    text((functions.rs2_get_option_value_description)(
                        sensor,
                        VISUAL_PRESET,
                        number,
                        error,
                    ))
                }
            })
        };
        let named = numbers.map(|number| name(number).map(|name| Some((number, name?))));
        named.filter_map(Result::transpose).collect()
    }

    /// Sets the visual preset with that number.
    pub(super) fn set_preset(&self, number: f32) -> Result<(), String> {
        let functions = self.functions();
        functions.checked(|error| {
            // SAFETY: the sensor lives, and is a container of options.
            unsafe {
                (functions.rs2_set_option)(self.object.handle(), VISUAL_PRESET, number, error);
            }
        })
    }

    /// Makes a file play each frame as soon as it is requested.
    pub(super) fn play_as_asked(&self) -> Result<(), String> {
        self.device.set_real_time(0)
    }

    /// Makes a file play with its pauses, `speed` times as fast.
    pub(super) fn play_as_taken(&self, speed: f32) -> Result<(), String> {
        self.device.set_real_time(1)?;
        let functions = self.functions();
        functions.checked(|error| {
            // SAFETY: the device lives.
            unsafe {
                (functions.rs2_playback_device_set_playback_speed)(
                    self.device.object.handle(),
                    speed,
                    error,
                );
            }
        })
    }

    /// Starts the depth stream in a mode.
    pub(super) fn start(self, mode: DepthMode) -> Result<Stream, String> {
        let functions = self.functions();
        let profile = profile_at(functions, &self.profiles, mode.index)?;
        let most_waiting = QUEUE_CAPACITY[usize::from(self.device.is_file)];
        let queue = functions.made(functions.rs2_delete_frame_queue, |error| {
            // SAFETY: takes a number.
            unsafe { (functions.rs2_create_frame_queue)(most_waiting, error) }
        })?;
        let sensor = self.object.handle();
        // SAFETY: the sensor lives, and the profile as long as the list of its profiles.
        functions.checked(|error| unsafe { (functions.rs2_open)(sensor, profile, error) })?;
        // From here on, dropping `stream` undoes every step.
        let stream = Stream {
            queue,
            mode,
            sensor: self,
        };
        functions.checked(|error| {
            // SAFETY: the sensor is open; the queue is deleted after the stream was stopped.
            unsafe { (functions.rs2_start_queue)(sensor, stream.queue.handle(), error) }
        })?;
        Ok(stream)
    }

    fn functions(&self) -> &'static Functions {
        self.device.context.functions
    }
}

/// A frame without padding.
pub(super) struct Received {
    /// Depth values, row by row.
    pub(super) depth: Vec<u16>,
    /// Time of capture, milliseconds since 1970; `None` if only the camera's own clock is known.
    pub(super) captured_at: Option<f64>,
}

/// A running depth stream. Dropping it stops the stream and closes the camera.
pub(super) struct Stream {
    queue: Object,
    mode: DepthMode,
    sensor: Sensor,
}

impl Stream {
    /// Waits for about `wait` at most, and returns the next frame. Fails if the frame's sizes are inconsistent or do not
    /// match the mode.
    pub(super) fn receive(&self, wait: Duration) -> Result<Option<Received>, String> {
        let frame = self.next_frame(wait)?;
        frame.map(|frame| self.copied(&frame)).transpose()
    }

    fn next_frame(&self, wait: Duration) -> Result<Option<Object>, String> {
        let functions = self.sensor.functions();
        let wait_ms = c_uint::try_from(wait.as_millis()).unwrap_or(c_uint::MAX);
        let mut frame: Handle = ptr::null_mut();
        functions.checked(|error| {
            // SAFETY: the queue lives, and `frame` is a place to write a pointer to.
            unsafe {
                (functions.rs2_try_wait_for_frame)(
                    self.queue.handle(),
                    wait_ms,
                    &raw mut frame,
                    error,
                )
            }
        })?;
        Ok(NonNull::new(frame).map(|handle| Object {
            handle,
            delete: functions.rs2_release_frame,
        }))
    }

    fn copied(&self, frame: &Object) -> Result<Received, String> {
        let functions = self.sensor.functions();
        let number = |read| {
            let number = functions.number(frame, read)?;
            Ok::<_, String>(usize::try_from(number).unwrap_or(0))
        };
        let width = number(functions.rs2_get_frame_width)?;
        let height = number(functions.rs2_get_frame_height)?;
        let stride = number(functions.rs2_get_frame_stride_in_bytes)?;
        let num_bits = number(functions.rs2_get_frame_bits_per_pixel)?;
        let num_bytes = number(functions.rs2_get_frame_data_size)?;
        let data = functions.checked(|error| {
            // SAFETY: the frame lives.
            unsafe { (functions.rs2_get_frame_data)(frame.handle(), error) }
        })?;
        let needed = height
            .checked_sub(1)
            .and_then(|rows| rows.checked_mul(stride)?.checked_add(2 * width));
        let DepthMode {
            width: columns,
            height: rows,
            ..
        } = self.mode;
        let is_of_mode =
            usize::try_from(columns) == Ok(width) && usize::try_from(rows) == Ok(height);
        let is_whole = num_bits == 16 && width > 0 && stride >= 2 * width && !data.is_null();
        let Some(needed) = needed.filter(|&n| is_of_mode && is_whole && n <= num_bytes) else {
            return Err(format!(
                "a frame of {width}×{height} pixels of {num_bits} bits, {stride} bytes a row and {num_bytes} in all, expected {columns}×{rows} pixels of 16 bits"
            ));
        };
        // SAFETY: the frame has `num_bytes` from there, no fewer than these, and lives until the end of the call.
        let bytes = unsafe { slice::from_raw_parts(data.cast::<u8>(), needed) };
        let rows = bytes.chunks(stride);
        let pixels = rows.flat_map(|row| row[..2 * width].chunks_exact(2));
        Ok(Received {
            depth: pixels
                .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
                .collect(),
            captured_at: self.captured_at(frame)?,
        })
    }

    fn captured_at(&self, frame: &Object) -> Result<Option<f64>, String> {
        let functions = self.sensor.functions();
        let clock = functions.number(frame, functions.rs2_get_frame_timestamp_domain)?;
        if !CLOCK_TIMES.contains(&clock) {
            return Ok(None);
        }
        let time = functions.checked(|error| {
            // SAFETY: the frame lives.
            unsafe { (functions.rs2_get_frame_timestamp)(frame.handle(), error) }
        });
        time.map(Some)
    }

    /// True for a file that has ended or has not started yet. Its last frames may still have to be received.
    pub(super) fn is_stopped(&self) -> bool {
        let device = &self.sensor.device;
        let functions = self.sensor.functions();
        // For a camera this would be an error, and thus an exception in the library, at every frame.
        device.is_file
            && functions
                .number(
                    &device.object,
                    functions.rs2_playback_device_get_current_status,
                )
                .is_ok_and(|status| status == STOPPED)
    }

    /// True while the camera is plugged in.
    pub(super) fn is_connected(&self) -> Result<bool, String> {
        let device = &self.sensor.device;
        let functions = self.sensor.functions();
        let plugged_in = device.context.devices()?;
        functions.checked(|error| {
            // SAFETY: the list and the device live.
            unsafe {
                (functions.rs2_device_list_contains)(
                    plugged_in.object.handle(),
                    device.object.handle(),
                    error,
                ) != 0
            }
        })
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        let (functions, sensor) = (self.sensor.functions(), self.sensor.object.handle());
        if self.sensor.device.is_file {
            // A thread of the library may wait for room in the queue, and stopping would wait for that thread. In real-time
            // mode no further thread starts to wait, and emptying the queue makes room for those that do.
            let _ = self.sensor.device.set_real_time(1);
            for _ in 0..MAX_DRAINED {
                if !matches!(self.next_frame(Duration::ZERO), Ok(Some(_))) {
                    break;
                }
            }
        }
        // An error here means that the stream was not started, or that the camera is gone.
        // SAFETY: the sensor lives; its queue is deleted afterwards.
        let _ = functions.checked(|error| unsafe { (functions.rs2_stop)(sensor, error) });
        // SAFETY: the sensor lives.
        let _ = functions.checked(|error| unsafe { (functions.rs2_close)(sensor, error) });
        if self.sensor.device.is_file {
            // The thread that reads the file still has work from both, and deleting the device during it ends the program.
            // Pausing waits for that thread.
            let _ = functions.checked(|error| {
                // SAFETY: the device lives.
                unsafe {
                    (functions.rs2_playback_device_pause)(
                        self.sensor.device.object.handle(),
                        error,
                    );
                }
            });
        }
    }
}
