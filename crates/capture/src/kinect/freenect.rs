//! libfreenect, loaded at run time, and all unsafe code that calls it.
//!
//! The functions are those of `libfreenect.h` 0.5, looked up when the library is loaded. Those of motor, LED and microphones
//! are not looked up.
//!
//! Guarantees to the rest of the crate that C does not give by itself:
//! - one [`Context`] at a time in the process, since the builds that play recorded sessions have global state;
//! - the library is never unloaded: it, and libusb below it, may have threads and handlers of their own;
//! - it never holds a pointer into our memory: a frame is copied inside its callback, which only runs inside
//!   [`Device::receive`], on the same thread.

#![expect(
    unsafe_code,
    reason = "a C library loaded at run time cannot be called without"
)]

use std::{
    cell::{Cell, RefCell},
    ffi::{CStr, OsStr, c_char, c_double, c_int, c_void},
    ptr::{self, NonNull},
    sync::{
        Mutex, MutexGuard, TryLockError,
        atomic::{AtomicUsize, Ordering},
    },
    time::Duration,
};

use super::header::{
    Attributes, DEVICE_CAMERA, FrameMode, INTERRUPTED, LOG_ERROR, OnDepth, OnLog, TimeVal,
};
use crate::{
    camera_error::{CameraError, CameraErrorKind},
    camera_library::FREENECT,
    driver_search::{LoadError, driver_functions},
};

/// Maximum number of log lines kept per call.
const MAX_LOG_LINES: usize = 8;

driver_functions! {
    freenect_init: fn(*mut *mut c_void, *mut c_void) -> c_int;
    freenect_shutdown: fn(*mut c_void) -> c_int;
    freenect_select_subdevices: fn(*mut c_void, c_int);
    freenect_num_devices: fn(*mut c_void) -> c_int;
    freenect_open_device: fn(*mut c_void, *mut *mut c_void, c_int) -> c_int;
    freenect_open_device_by_camera_serial: fn(*mut c_void, *mut *mut c_void, *const c_char) -> c_int;
    freenect_close_device: fn(*mut c_void) -> c_int;
    freenect_get_depth_mode_count: fn() -> c_int;
    freenect_get_depth_mode: fn(c_int) -> FrameMode;
    freenect_set_depth_mode: fn(*mut c_void, FrameMode) -> c_int;
    freenect_set_depth_callback: fn(*mut c_void, OnDepth);
    freenect_start_depth: fn(*mut c_void) -> c_int;
    freenect_stop_depth: fn(*mut c_void) -> c_int;
    freenect_process_events_timeout: fn(*mut c_void, *mut TimeVal) -> c_int;
    freenect_set_log_level: fn(*mut c_void, c_int);
    freenect_set_log_callback: fn(*mut c_void, OnLog);
    ? freenect_list_device_attributes: fn(*mut c_void, *mut *mut Attributes) -> c_int;
    ? freenect_free_device_attributes: fn(*mut Attributes);
    ? freenect_camera_to_world: fn(*mut c_void, c_int, c_int, c_int, *mut c_double, *mut c_double);
}

type List = unsafe extern "C" fn(*mut c_void, *mut *mut Attributes) -> c_int;
type ContextDeleter = unsafe extern "C" fn(*mut Attributes);

impl Functions {
    fn list(&self) -> Option<(List, ContextDeleter)> {
        self.freenect_list_device_attributes
            .zip(self.freenect_free_device_attributes)
    }
}

/// Number of calls that processed events of a recorded session, which is a global state of the library that plays it.
static NUM_TURNS: AtomicUsize = AtomicUsize::new(0);

/// A library, loaded until the process ends.
pub(super) struct Library {
    functions: &'static Functions,
    file: String,
}

impl Library {
    /// Loads the library of that name or path.
    pub(super) fn load(name: &OsStr) -> Result<Self, LoadError> {
        Ok(Self {
            functions: Functions::load(name)?,
            file: name.to_string_lossy().into_owned(),
        })
    }

    /// Name or path by which it was loaded.
    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// True for a build that plays recorded sessions, which cannot list serial numbers.
    pub(super) fn plays_sessions(&self) -> bool {
        self.functions.list().is_none()
    }
}

/// Number of calls that processed events of the recorded session since its library was loaded.
pub(super) fn num_turns() -> usize {
    NUM_TURNS.load(Ordering::Relaxed)
}

/// The lock on the process's only context.
static CLAIM: Mutex<()> = Mutex::new(());

/// A running library without an open device.
pub(super) struct Context {
    functions: &'static Functions,
    handle: NonNull<c_void>,
    _claim: MutexGuard<'static, ()>,
}

impl Context {
    /// Starts the library with cameras only.
    pub(super) fn new(library: &Library) -> Result<Self, CameraError> {
        let functions = library.functions;
        let claim = match CLAIM.try_lock() {
            Ok(claim) => claim,
            Err(TryLockError::Poisoned(claim)) => claim.into_inner(),
            Err(TryLockError::WouldBlock) => return Err(FREENECT.error(CameraErrorKind::InUse)),
        };
        let mut context = ptr::null_mut();
        // SAFETY: `context` is a place to write a pointer to; null asks the library for a libusb context of its own.
        let code = unsafe { (functions.freenect_init)(&raw mut context, ptr::null_mut()) };
        let context = NonNull::new(context).filter(|_| code >= 0).ok_or_else(|| {
            let message = format!("USB error {code}");
            FREENECT
                .error(CameraErrorKind::LibraryNotStarted)
                .quoting([message])
        })?;
        // SAFETY: the context is initialised; the callback may be called from here on, and needs nothing else.
        unsafe {
            (functions.freenect_set_log_callback)(context.as_ptr(), on_log);
            (functions.freenect_set_log_level)(context.as_ptr(), LOG_ERROR);
            (functions.freenect_select_subdevices)(context.as_ptr(), DEVICE_CAMERA);
        }
        Ok(Self {
            functions,
            handle: context,
            _claim: claim,
        })
    }

    /// Number of cameras that are plugged in, whether they can be opened or not.
    pub(super) fn num_devices(&self) -> Result<usize, Failed> {
        // SAFETY: the context is initialised.
        let num =
            checked(|| unsafe { (self.functions.freenect_num_devices)(self.handle.as_ptr()) })?;
        Ok(num as usize)
    }

    /// Serial numbers of the cameras that could be queried. Empty if the library cannot list them.
    pub(super) fn serials(&self) -> Result<Vec<String>, Failed> {
        let Some((list, free)) = self.functions.list() else {
            return Ok(Vec::new());
        };
        let mut first = ptr::null_mut();
        // SAFETY: the context is initialised, and `first` is a place to write a pointer to.
        checked(|| unsafe { list(self.handle.as_ptr(), &raw mut first) })?;
        let mut serials = Vec::new();
        let mut next = first;
        // SAFETY: the list is the library's, ends with null, and lives until it is freed below.
        while let Some(attributes) = unsafe { next.as_ref() } {
            if !attributes.camera_serial.is_null() {
                // SAFETY: a C string that lives as long as its list.
                let serial = unsafe { CStr::from_ptr(attributes.camera_serial) };
                serials.push(serial.to_string_lossy().into_owned());
            }
            next = attributes.next;
        }
        // SAFETY: the list as it was given, once.
        unsafe { free(first) };
        Ok(serials)
    }

    /// Opens the camera with that serial number, or the first one.
    pub(super) fn open(self, serial: Option<&CStr>) -> Result<Device, Failed> {
        let mut device = ptr::null_mut();
        let (functions, context) = (self.functions, self.handle.as_ptr());
        let opened = checked(|| match serial {
            // SAFETY: the context is initialised, `device` is a place to write a pointer to, the string ends with 0.
            Some(serial) => unsafe {
                (functions.freenect_open_device_by_camera_serial)(
                    context,
                    &raw mut device,
                    serial.as_ptr(),
                )
            },
            // SAFETY: as above.
            None => unsafe { (functions.freenect_open_device)(context, &raw mut device, 0) },
        });
        // A half-opened device is closed by the shutdown of its context.
        opened?;
        let device = NonNull::new(device).ok_or(Failed {
            code: -1,
            log: Vec::new(),
        })?;
        let inbox = FrameSlot::default();
        Ok(Device {
            context: self,
            handle: device,
            inbox,
            is_streaming: false,
        })
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: the context was initialised and is no longer used: a `Device` owns its context and drops it last.
        unsafe { (self.functions.freenect_shutdown)(self.handle.as_ptr()) };
    }
}

/// An open camera. Dropping it stops the stream, closes the camera and shuts the library down, in this order.
pub(super) struct Device {
    context: Context,
    handle: NonNull<c_void>,
    inbox: FrameSlot,
    is_streaming: bool,
}

/// Where the callback stores a frame.
#[derive(Default)]
struct FrameSlot {
    depth: Vec<u16>,
    is_new: bool,
}

impl Device {
    /// The camera's modes with one `u16` per pixel.
    pub(super) fn depth_modes(&self) -> Vec<FrameMode> {
        let functions = self.context.functions;
        // SAFETY: takes nothing, and gives a number.
        let num = unsafe { (functions.freenect_get_depth_mode_count)() };
        (0..num)
            // SAFETY: takes an index below the count, and gives a structure by value.
            .map(|index| unsafe { (functions.freenect_get_depth_mode)(index) })
            .filter(FrameMode::is_sixteen_bit)
            .collect()
    }

    /// The x and y, in millimetres, that the library computes for a pixel at `depth_mm`; `None` if it cannot.
    pub(super) fn point_mm(&self, column: i32, row: i32, depth_mm: i32) -> Option<(f64, f64)> {
        let camera_to_world = self.context.functions.freenect_camera_to_world?;
        let (device, mut x, mut y) = (self.handle.as_ptr(), 0.0, 0.0);
        // SAFETY: the device is open; `x` and `y` are places to write a number to.
        unsafe { camera_to_world(device, column, row, depth_mm, &raw mut x, &raw mut y) };
        Some((x, y))
    }

    /// Starts the depth stream in one of [`Self::depth_modes`].
    pub(super) fn start(&mut self, mode: FrameMode) -> Result<(), Failed> {
        assert!(mode.is_sixteen_bit(), "a mode of `depth_modes`");
        self.stop();
        self.inbox.depth.resize(mode.num_pixels(), 0);
        let (functions, device) = (self.context.functions, self.handle.as_ptr());
        // SAFETY: the device is open and no stream runs; the mode is one that the library gave.
        checked(|| unsafe { (functions.freenect_set_depth_mode)(device, mode) })?;
        // SAFETY: the device is open; the callback is a function of this program, so it outlives it.
        unsafe { (functions.freenect_set_depth_callback)(device, on_depth) };
        // SAFETY: the device is open and has its mode.
        checked(|| unsafe { (functions.freenect_start_depth)(device) })?;
        self.is_streaming = true;
        Ok(())
    }

    /// Lets the library process events for about `wait`, and returns the newest complete frame, row by row.
    pub(super) fn receive(&mut self, wait: Duration) -> Result<Option<&[u16]>, Failed> {
        let mut wait = TimeVal::from(wait);
        self.inbox.is_new = false;
        let (functions, context) = (self.context.functions, self.context.handle.as_ptr());
        if functions.list().is_none() {
            NUM_TURNS.fetch_add(1, Ordering::Relaxed);
        }
        RECEIVING.set(&raw mut self.inbox);
        // SAFETY: the context is initialised and its device open; `wait` is a timeval. The callback finds the inbox,
        // which nothing else touches until the call has returned.
        let outcome = checked(|| unsafe {
            (functions.freenect_process_events_timeout)(context, &raw mut wait)
        });
        RECEIVING.set(ptr::null_mut());
        match outcome {
            // Deliver a frame that came before an error first; the error persists and is returned by the next call.
            _ if self.inbox.is_new => Ok(Some(&self.inbox.depth)),
            Err(failed) if failed.code != INTERRUPTED => Err(failed),
            _ => Ok(None),
        }
    }

    fn stop(&mut self) {
        if self.is_streaming {
            // SAFETY: the device is open. If the library has stopped the stream itself, the call does nothing.
            unsafe { (self.context.functions.freenect_stop_depth)(self.handle.as_ptr()) };
            self.is_streaming = false;
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.stop();
        // SAFETY: the device is open, has no stream, and is no longer used.
        unsafe { (self.context.functions.freenect_close_device)(self.handle.as_ptr()) };
    }
}

thread_local! {
    /// Slot of the device that is receiving on this thread, or null.
    static RECEIVING: Cell<*mut FrameSlot> = const { Cell::new(ptr::null_mut()) };
    /// What the library has logged during the current call on this thread.
    static LOG: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Callback for a complete frame.
extern "C" fn on_depth(_device: *mut c_void, depth: *mut c_void, _ticks: u32) {
    // SAFETY: either null or set by `receive`, which waits for this call to end and touches nothing meanwhile.
    let Some(inbox) = (unsafe { RECEIVING.get().as_mut() }) else {
        return;
    };
    if depth.is_null() {
        return;
    }
    let num_bytes = size_of_val(inbox.depth.as_slice());
    // SAFETY: the inbox has the size of a frame in the current mode, and the library completed such a frame; that recorded
    // frames are complete was checked before. Bytes are copied, because the source need not be aligned for more.
    unsafe {
        ptr::copy_nonoverlapping(
            depth.cast::<u8>(),
            inbox.depth.as_mut_ptr().cast::<u8>(),
            num_bytes,
        );
    }
    inbox.is_new = true;
}

/// Callback for a log line.
extern "C" fn on_log(_context: *mut c_void, _level: c_int, message: *const c_char) {
    if message.is_null() {
        return;
    }
    // SAFETY: a C string that lives for the duration of the call.
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy();
    // The thread-local is missing only while the thread ends; then nobody reads it.
    let _ = LOG.try_with(|lines| {
        if let Ok(mut lines) = lines.try_borrow_mut()
            && lines.len() < MAX_LOG_LINES
        {
            lines.push(message.trim().to_owned());
        }
    });
}

/// A call that returned a negative code.
#[derive(Debug)]
pub(super) struct Failed {
    /// The returned code; libusb's, or -1.
    pub(super) code: i32,
    /// What the library logged during the call, one line each.
    pub(super) log: Vec<String>,
}

impl Failed {
    /// The error, with the first line of the log.
    pub(super) fn error(self, kind: CameraErrorKind) -> CameraError {
        FREENECT.error(kind).quoting(self.log)
    }
}

/// Calls the library and collects what it logs. A negative code is an error.
fn checked(call: impl FnOnce() -> c_int) -> Result<c_int, Failed> {
    LOG.take();
    let code = call();
    if code >= 0 {
        return Ok(code);
    }
    Err(Failed {
        code,
        log: LOG.take(),
    })
}
