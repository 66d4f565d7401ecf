//! OpenNI 2 cameras (Asus Xtion, PrimeSense, Orbbec Astra) and the `.oni` files that OpenNI records, through libOpenNI2.
//!
//! Depth is read in the depth camera's own geometry, in the largest mode that is not slow. The camera is a pinhole with the
//! field of view that OpenNI reports and its axis in the middle of the picture; OpenNI has no distortion.
//!
//! Drivers of OpenNI mirror the picture by default. Mirroring is switched off; where that is impossible, as in files, the
//! picture is mirrored back. A device that does not report its mirroring is refused, and so are cropped pictures.
//!
//! Known limits: a file stores only the mirroring at its start, so that if it was switched during the recording, all frames
//! after that are wrong. libOpenNI2 reads files itself; we only check beforehand that a file is complete.

mod file;
mod header;
mod library_thread;
mod oni;

use std::{
    ffi::CString,
    io,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use self::{
    header::{
        Cropping, DEPTH_1_MM, DEPTH_100_UM, DEVICE_REGISTRATION, DEVICE_REPEAT, DEVICE_SPEED,
        STREAM_CROPPING, STREAM_HORIZONTAL_VIEW, STREAM_MIRRORING, STREAM_MODE,
        STREAM_VERTICAL_VIEW, VideoMode,
    },
    oni::{Context, Device, FoundDevice, Functions, Messages, Received},
};
use super::{
    camera_error::{CameraError, CameraErrorKind, quoted},
    camera_library::OPENNI,
    error::CaptureError,
    read_timeout::ReadTimeout,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{OpenNiSpec, Pace, SourceListing, SourceSpec},
};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
};

/// Frame rate below which a mode is used only if there is no other, frames per second.
const MIN_FPS: i32 = 15;
/// Longest path of a file that OpenNI stores, bytes.
const MAX_PATH_BYTES: usize = 255;
/// How long to wait for a camera before checking whether it is still there.
const CAMERA_WAIT: Duration = Duration::from_millis(50);
/// The same for a file. Each wait requests a frame; giving up too early would request two at once, of which OpenNI keeps
/// only the second.
const FILE_WAIT: Duration = Duration::from_secs(1);

/// The camera or file that is open on the library's thread. Dropping it closes that.
struct Source {
    title: String,
    /// False once it is lost or has ended: the thread has closed it then, and may have another one open.
    is_open: bool,
}

/// An open camera or file whose depth stream runs. Dropping it stops the stream and closes the camera.
struct OpenNi {
    device: Device,
    title: String,
    /// Path of the file that is played, if any.
    file: Option<PathBuf>,
    mode: VideoMode,
    camera: Intrinsics,
    metres_per_unit: f64,
    is_mirrored: bool,
    num_frames: u64,
    silence: ReadTimeout,
}

/// Opens the camera or the file and starts its depth stream.
pub(super) fn open(spec: &OpenNiSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    if let Some(path) = spec.file() {
        file::check(path)?;
    }
    let spec = spec.clone();
    let opened = library_thread::run(move |opened| {
        let source = OpenNi::open(&spec, opened.is_some())?;
        let title = source.title.clone();
        *opened = Some(source);
        Ok(title)
    });
    let title = opened.unwrap_or_else(|error| Err(no_thread(&error)))?;
    Ok(Box::new(Source {
        title,
        is_open: true,
    }))
}

/// The cameras that are plugged in, or why there is none.
pub(super) fn list() -> Vec<SourceListing> {
    let found = library_thread::run(|opened| found_devices(&start(None, opened.is_some())?));
    match found.unwrap_or_else(|error| Err(no_thread(&error))) {
        Ok(devices) => devices.into_iter().map(can_be_opened).collect(),
        Err(error) => vec![SourceListing::unusable(error)],
    }
}

fn no_thread(error: &io::Error) -> CameraError {
    OPENNI
        .error(CameraErrorKind::LibraryNotStarted)
        .quoting([error.to_string()])
}

/// Finds at least one device.
fn found_devices(context: &Context) -> Result<Vec<FoundDevice>, CameraError> {
    let devices = context.devices().map_err(not_opened)?;
    if devices.is_empty() {
        return Err(OPENNI.no_device(None, Vec::new()));
    }
    Ok(devices)
}

/// Starts the library, unless it runs already.
fn start(library: Option<&Path>, is_running: bool) -> Result<Context, CameraError> {
    let functions = OPENNI.find(library, Functions::load)?;
    if is_running {
        return Err(OPENNI.error(CameraErrorKind::InUse));
    }
    Context::new(functions)
}

fn not_opened(messages: Messages) -> CameraError {
    OPENNI.error(CameraErrorKind::NotOpened).quoting(messages)
}

fn not_started(messages: Messages) -> CameraError {
    OPENNI.error(CameraErrorKind::NotStarted).quoting(messages)
}

fn disconnected(messages: Messages) -> CameraError {
    OPENNI
        .error(CameraErrorKind::Disconnected)
        .quoting(messages)
}

fn can_be_opened(found: FoundDevice) -> SourceListing {
    let title = title(&found);
    let spec = OpenNiSpec {
        device: Some(found.uri),
        ..OpenNiSpec::default()
    };
    SourceListing::openable(title, SourceSpec::OpenNi(spec))
}

fn title(found: &FoundDevice) -> String {
    if found.name.is_empty() {
        format!("OpenNI camera {}", found.uri)
    } else {
        format!("{} {}", found.name, found.uri)
    }
}

impl OpenNi {
    fn open(spec: &OpenNiSpec, is_running: bool) -> Result<Self, CameraError> {
        let context = start(spec.library.as_deref(), is_running)?;
        let (device, title) = match spec.file() {
            Some(path) => (
                open_file(context, path)?,
                SourceSpec::OpenNi(spec.clone()).title(),
            ),
            None => open_camera(context, spec.device.as_deref())?,
        };
        let mode = device.get::<VideoMode>(STREAM_MODE).unwrap_or_default();
        let unsuitable =
            |what: &str, advice: &str| OPENNI.unsuitable(format!("{title} {what}"), advice);
        let metres_per_unit = metres_per_unit(&mode).ok_or_else(|| {
            unsuitable(
                "offers depth neither in millimetres nor in tenths of a millimetre",
                "Record it again in millimetres, or update the camera's driver",
            )
        })?;
        let camera = camera_of(&device, &mode).ok_or_else(|| {
            unsuitable(
                "does not report its field of view",
                "Update the camera's driver: without the field of view, readings cannot be placed in space",
            )
        })?;
        let is_mirrored = is_mirrored(&device).ok_or_else(|| {
            unsuitable(
                "does not report whether its picture is mirrored",
                "Update the camera's driver, and record again with it: a mirrored picture gives wrong poses",
            )
        })?;
        let file = spec.file().map(Path::to_path_buf);
        if file.is_some() {
            let speed = speed(spec.pace, mode.rate);
            let set = device.set_device(DEVICE_SPEED, speed);
            set.and_then(|()| device.set_device(DEVICE_REPEAT, 0))
                .map_err(not_started)?;
        }
        device.start().map_err(not_started)?;
        Ok(Self {
            device,
            title,
            file,
            mode,
            camera,
            metres_per_unit,
            is_mirrored,
            num_frames: 0,
            silence: ReadTimeout::default(),
        })
    }

    /// Waits for a frame once. An error ends the source.
    fn turn(&mut self, wait: Duration) -> Result<NextCapture, CameraError> {
        let device = &self.device;
        if device.is_lost() {
            return Err(self.interrupted(disconnected(Messages::new())));
        }
        // Query this before the wait: frames before the end of a file have then arrived.
        let is_at_end = device.is_at_end();
        let start = Instant::now();
        let received = device.receive(if is_at_end { Duration::ZERO } else { wait });
        let is_mirrored = is_mirrored(device);
        match received {
            Ok(Some(received)) => {
                let mode = received.mode;
                if received.is_part {
                    Err(OPENNI.unsuitable(
                        format!("{} sends only a part of its picture", self.title),
                        "Switch cropping off, and record the whole picture again",
                    ))
                } else if (mode.width, mode.height, mode.format)
                    != (self.mode.width, self.mode.height, self.mode.format)
                    || is_mirrored != Some(self.is_mirrored)
                {
                    Err(OPENNI.unsuitable(
                        format!(
                            "the picture of {} has changed its size, unit or mirroring",
                            self.title
                        ),
                        "Leave the camera's settings as they are while it runs or records, then open it again",
                    ))
                } else {
                    Ok(NextCapture::Captured(self.captured(received)))
                }
            }
            Ok(None) if is_at_end => Ok(NextCapture::End),
            Ok(None) => match self.silence.add(start.elapsed()) {
                Some(seconds) => {
                    Err(self.interrupted(OPENNI.error(CameraErrorKind::NoFrames { seconds })))
                }
                None => Ok(NextCapture::NotYet),
            },
            Err(messages) => Err(self.interrupted(disconnected(messages))),
        }
    }

    fn captured(&mut self, received: Received) -> Captured {
        self.num_frames += 1;
        self.silence.restart();
        let mut depth = received.depth;
        if self.is_mirrored {
            let rows = depth.chunks_exact_mut(self.camera.width);
            rows.for_each(<[u16]>::reverse);
        }
        let image = Image::Depth(DepthFrame {
            intrinsics: self.camera,
            metres_per_unit: self.metres_per_unit,
            depth,
            is_simulated: false,
        });
        let name = format!("OpenNI frame {}", self.num_frames);
        Captured::now(self.num_frames, name, image)
    }

    /// The reason for which nothing more comes. If a file cannot be played on, it is damaged.
    fn interrupted(&self, reason: CameraError) -> CameraError {
        match &self.file {
            Some(path) => OPENNI.file_unusable(
                path,
                format!("nothing can be read after frame {}", self.num_frames),
            ),
            None => reason,
        }
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CameraError> {
        let start = Instant::now();
        loop {
            let left = wait.saturating_sub(start.elapsed());
            let next = match self.file {
                Some(_) => self.turn(FILE_WAIT)?,
                None => self.turn(left.min(CAMERA_WAIT))?,
            };
            if !matches!(next, NextCapture::NotYet) || start.elapsed() >= wait {
                return Ok(next);
            }
        }
    }
}

impl DepthSource for Source {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        if !self.is_open {
            return Ok(NextCapture::End);
        }
        let next = library_thread::run(move |opened| {
            let next = opened
                .as_mut()
                .map_or(Ok(NextCapture::End), |source| source.next(wait));
            if matches!(next, Err(_) | Ok(NextCapture::End)) {
                *opened = None;
            }
            next
        });
        let next = next.unwrap_or_else(|error| Err(no_thread(&error)));
        self.is_open = !matches!(next, Err(_) | Ok(NextCapture::End));
        Ok(next?)
    }
}

impl Drop for Source {
    fn drop(&mut self) {
        if self.is_open {
            // Without its thread the library does not run.
            let _ = library_thread::run(|opened| *opened = None);
        }
    }
}

/// Opens a recorded file.
fn open_file(context: Context, path: &Path) -> Result<Device, CameraError> {
    let name = path.to_string_lossy();
    if name.len() > MAX_PATH_BYTES {
        let what = format!("OpenNI opens paths of at most {MAX_PATH_BYTES} bytes");
        return Err(OPENNI.file_unusable(path, what));
    }
    open_device(context, &name).map_err(|messages| {
        let message = quoted(messages.first().map(String::as_str));
        OPENNI.file_unusable(path, format!("OpenNI cannot read it{message}"))
    })
}

/// Opens the camera with that URI, or the first one, in its best mode. Also returns its title.
fn open_camera(context: Context, uri: Option<&str>) -> Result<(Device, String), CameraError> {
    let devices = found_devices(&context)?;
    let chosen = match uri {
        Some(uri) => devices.iter().find(|device| device.uri == uri),
        None => devices.first(),
    };
    let Some(chosen) = chosen else {
        let found = devices.into_iter().map(|device| device.uri).collect();
        return Err(OPENNI.no_device(uri, found));
    };
    let device = open_device(context, &chosen.uri).map_err(not_opened)?;
    // Not every device has all these settings or needs them; what it reports afterwards is checked.
    if let Some(mode) = best_mode(&device.modes()) {
        let _ = device.set(STREAM_MODE, mode);
    }
    let _ = device.set_device(DEVICE_REGISTRATION, 0);
    let _ = device.set(STREAM_CROPPING, Cropping::default());
    let _ = device.set(STREAM_MIRRORING, 0);
    Ok((device, title(chosen)))
}

fn open_device(context: Context, uri: &str) -> Result<Device, Messages> {
    // URIs with a NUL inside were refused before, as no file or device has such a name.
    let uri = CString::new(uri).map_err(|error| vec![error.to_string()])?;
    context.open(&uri)
}

/// The largest mode that is not slow; of equal ones that in millimetres, which has a longer range than tenths.
fn best_mode(modes: &[VideoMode]) -> Option<VideoMode> {
    let modes = modes.iter().filter(|mode| metres_per_unit(mode).is_some());
    let worth = |mode: &&VideoMode| {
        let num_pixels = i64::from(mode.width) * i64::from(mode.height);
        let is_millimetres = mode.format == DEPTH_1_MM;
        (mode.rate >= MIN_FPS, num_pixels, is_millimetres, mode.rate)
    };
    modes.max_by_key(worth).copied()
}

/// `None` if depth is neither in millimetres nor in tenths of one.
fn metres_per_unit(mode: &VideoMode) -> Option<f64> {
    match mode.format {
        DEPTH_1_MM => Some(0.001),
        DEPTH_100_UM => Some(0.0001),
        _ => None,
    }
}

fn is_mirrored(device: &Device) -> Option<bool> {
    device.get::<i32>(STREAM_MIRRORING).map(|value| value != 0)
}

fn camera_of(device: &Device, mode: &VideoMode) -> Option<Intrinsics> {
    let horizontal = device.get(STREAM_HORIZONTAL_VIEW)?;
    let vertical = device.get(STREAM_VERTICAL_VIEW)?;
    pinhole(mode, horizontal, vertical)
}

/// The pinhole camera with these fields of view, in radians from edge to edge; `None` if they are implausible.
fn pinhole(mode: &VideoMode, horizontal: f32, vertical: f32) -> Option<Intrinsics> {
    let focal = |size: usize, view: f32| {
        let is_view = view > 0.05 && view < 3.0;
        (is_view && size > 0).then(|| size as f64 / 2.0 / (f64::from(view) / 2.0).tan())
    };
    let width = usize::try_from(mode.width).ok()?;
    let height = usize::try_from(mode.height).ok()?;
    Some(Intrinsics {
        width,
        height,
        fx: focal(width, horizontal)?,
        fy: focal(height, vertical)?,
        // Pixel centres are at integers, so that a mirrored picture has the same camera.
        cx: (width as f64 - 1.0) / 2.0,
        cy: (height as f64 - 1.0) / 2.0,
        distortion: Distortion::NONE,
    })
}

/// Playback speed for a file recorded at `rate` frames per second. If negative, OpenNI delivers a frame per wait.
fn speed(pace: Option<Pace>, rate: i32) -> f32 {
    match pace {
        Some(Pace::AsTaken) => 1.0,
        Some(Pace::PerSecond(wanted)) => (wanted / f64::from(rate.max(1))) as f32,
        Some(Pace::Step) | None => -1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(format: i32, width: i32, height: i32, rate: i32) -> VideoMode {
        VideoMode {
            format,
            width,
            height,
            rate,
        }
    }

    #[test]
    fn the_largest_mode_that_is_read_and_not_slow_is_taken() {
        let shifts = 102;
        let fast = mode(DEPTH_1_MM, 640, 480, 30);
        let modes = [
            mode(DEPTH_1_MM, 320, 240, 60),
            mode(DEPTH_100_UM, 640, 480, 30),
            fast,
            mode(shifts, 1280, 1024, 30),
            mode(DEPTH_1_MM, 1280, 1024, 7),
        ];
        assert_eq!(best_mode(&modes), Some(fast));
        assert_eq!(best_mode(&modes[4..]), Some(modes[4]));
        assert_eq!(best_mode(&modes[3..4]), None);
    }

    #[test]
    fn the_edges_of_the_picture_are_at_the_ends_of_the_view() {
        let xtion = mode(DEPTH_1_MM, 640, 480, 30);
        let camera = pinhole(&xtion, 1.0, 0.8).expect("a camera");
        for (u, v, x, y) in [(-0.5, 239.5, -0.5_f64, 0.0), (319.5, 479.5, 0.0, 0.4_f64)] {
            let seen = camera.point_at(u, v, 2.0);
            assert!((seen.x - 2.0 * x.tan()).abs() < 1e-6, "{seen}");
            assert!((seen.y - 2.0 * y.tan()).abs() < 1e-6, "{seen}");
        }
        assert_eq!(camera.mirrored(), camera);
        for view in [0.0, -1.0, 3.2, f32::NAN, f32::INFINITY] {
            assert_eq!(pinhole(&xtion, view, 0.8), None);
            assert_eq!(pinhole(&xtion, 1.0, view), None);
        }
        assert_eq!(pinhole(&mode(DEPTH_1_MM, 0, 480, 30), 1.0, 0.8), None);
    }

    #[test]
    fn a_file_is_played_at_the_pace_that_is_asked_for() {
        for (pace, expected) in [
            (None, -1.0),
            (Some(Pace::Step), -1.0),
            (Some(Pace::AsTaken), 1.0),
            (Some(Pace::PerSecond(15.0)), 0.5),
        ] {
            assert!((speed(pace, 30) - expected).abs() < 1e-6);
        }
    }
}
