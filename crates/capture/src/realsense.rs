//! RealSense cameras, and the files that librealsense records, through librealsense 2.
//!
//! Depth is read as the camera sends it, in its own geometry with its lens distortion, not aligned to colour, in the unit
//! that the camera reports. The preferred mode is 848×480 pixels at 30 frames per second, where the cameras of the D400
//! family work best, then 640×480, then the largest that is not slow.
//!
//! Known limits: distortion is read if [`Distortion`] can represent it: Brown-Conrady, and modified Brown-Conrady without
//! its tangential part. Other models are refused. librealsense reads files itself; we only check beforehand that a file is
//! complete.

mod file;
mod header;
mod librealsense;

use std::{
    cmp::Reverse,
    ffi::{CString, c_int},
    fmt::Display,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use jiff::Timestamp;

use self::{
    header::RawIntrinsics,
    librealsense::{Context, DepthMode, Device, Functions, Received, Sensor, Stream},
};
use super::{
    camera_error::{CameraError, CameraErrorKind, only},
    camera_library::REALSENSE,
    error::CaptureError,
    read_timeout::ReadTimeout,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{Pace, RealsenseSpec, SourceListing, SourceSpec},
};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
};

/// Preferred modes, best first: columns, rows, frames per second.
const PREFERRED_MODES: [(c_int, c_int, c_int); 2] = [(848, 480, 30), (640, 480, 30)];
/// Of equally large modes, the one closest to this rate is chosen, frames per second.
const PREFERRED_FPS: c_int = 30;
/// Frame rate below which a mode is used only if there is no other, frames per second.
const MIN_FPS: c_int = 15;

/// An open camera or file whose depth stream runs. Dropping it stops the stream and closes the camera.
pub(super) struct Realsense {
    /// `None` once it is lost or has ended.
    stream: Option<Stream>,
    title: String,
    /// Path of the file that is played, if any.
    file: Option<PathBuf>,
    camera: Intrinsics,
    metres_per_unit: f64,
    num_frames: u64,
    silence: ReadTimeout,
}

/// Opens the camera with the given serial number, the first camera, or the file, and starts its depth stream.
pub(super) fn open(spec: &RealsenseSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    let Some(path) = spec.file() else {
        return Ok(Box::new(Realsense::open(spec)?));
    };
    file::check(path)?;
    let opened = Realsense::open(spec).map_err(|error| file::not_played(error, path))?;
    Ok(Box::new(opened))
}

/// The cameras that are plugged in, or why there is none.
pub(super) fn list() -> Vec<SourceListing> {
    let listed = start(None).and_then(|context| {
        let devices = context.devices().map_err(not_opened)?;
        let listed = devices.open_each().map(|device| {
            let listing = device.map_err(not_opened).and_then(listing_of);
            listing.unwrap_or_else(SourceListing::unusable)
        });
        let listed: Vec<SourceListing> = listed.collect();
        if listed.is_empty() {
            return Err(REALSENSE.no_device(None, Vec::new()));
        }
        Ok(listed)
    });
    listed.unwrap_or_else(|error| vec![SourceListing::unusable(error)])
}

fn listing_of(device: Device) -> Result<SourceListing, CameraError> {
    let title = title(&device);
    let spec = RealsenseSpec {
        device: device.serial_number(),
        ..RealsenseSpec::default()
    };
    depth_sensor(device, &title)?;
    Ok(SourceListing::openable(title, SourceSpec::Realsense(spec)))
}

/// Model and serial number.
fn title(device: &Device) -> String {
    let name = device.name().unwrap_or_else(|| "RealSense".into());
    match device.serial_number() {
        Some(serial) => format!("{name} {serial}"),
        None => name,
    }
}

/// Starts the library at `library`, or the one of the environment or the system.
fn start(library: Option<&Path>) -> Result<Context, CameraError> {
    let functions = REALSENSE.find(library, Functions::load)?;
    Context::new(functions).map_err(|message| {
        REALSENSE
            .error(CameraErrorKind::LibraryNotStarted)
            .quoting([message])
    })
}

fn not_opened(message: String) -> CameraError {
    REALSENSE
        .error(CameraErrorKind::NotOpened)
        .quoting([message])
}

fn not_started(message: String) -> CameraError {
    REALSENSE
        .error(CameraErrorKind::NotStarted)
        .quoting([message])
}

fn disconnected(message: Option<String>) -> CameraError {
    REALSENSE
        .error(CameraErrorKind::Disconnected)
        .quoting(message)
}

impl Realsense {
    fn open(spec: &RealsenseSpec) -> Result<Self, CameraError> {
        let context = start(spec.library.as_deref())?;
        let file = spec.file().map(Path::to_path_buf);
        let (title, (sensor, mode)) = if let Some(path) = &file {
            let title = SourceSpec::Realsense(spec.clone()).title();
            let depth = depth_sensor(open_file(&context, path)?, &title)?;
            (title, depth)
        } else {
            open_camera(&context, spec.device.as_deref())?
        };
        if let Some(preset) = &spec.preset {
            set_preset(&sensor, preset, &title)?;
        }
        // A preset may change the unit.
        let scale = sensor.depth_scale().map_err(not_opened)?;
        let metres_per_unit = metres_per_unit(scale, &title)?;
        let camera = sensor.intrinsics(&mode).map_err(not_opened)?;
        let camera = camera_of(&camera, &title)?;
        if file.is_some() {
            let paced = match speed(spec.pace, mode.rate) {
                Some(speed) => sensor.play_as_taken(speed),
                None => sensor.play_as_asked(),
            };
            paced.map_err(not_opened)?;
        }
        let stream = sensor.start(mode).map_err(not_started)?;
        Ok(Self {
            stream: Some(stream),
            title,
            file,
            camera,
            metres_per_unit,
            num_frames: 0,
            silence: ReadTimeout::default(),
        })
    }

    fn captured(&mut self, received: Received) -> Captured {
        self.num_frames += 1;
        self.silence.restart();
        // Frames of a file have their time of recording.
        let recorded_at = received.captured_at.filter(|_| self.file.is_some());
        let recorded_at = recorded_at.and_then(|ms| Timestamp::from_millisecond(ms as i64).ok());
        let image = Image::Depth(DepthFrame {
            intrinsics: self.camera,
            metres_per_unit: self.metres_per_unit,
            depth: received.depth,
            is_simulated: false,
        });
        let name = format!("RealSense frame {}", self.num_frames);
        Captured {
            taken_at: recorded_at.unwrap_or_else(geometry::clock::now),
            ..Captured::now(self.num_frames, name, image)
        }
    }

    /// Handles a wait of `turn` without a frame. In every second of silence the library is asked once whether the camera is
    /// still there.
    fn silent(&mut self, turn: Duration) -> Result<NextCapture, CaptureError> {
        let seconds_before = self.silence.seconds();
        let timeout = self.silence.add(turn);
        let is_to_ask = self.file.is_none() && self.silence.seconds() > seconds_before;
        if let Some(stream) = self.stream.as_ref().filter(|_| is_to_ask) {
            match stream.is_connected() {
                Ok(true) => {}
                Ok(false) => return self.end(disconnected(None)),
                Err(message) => return self.end(disconnected(Some(message))),
            }
        }
        match timeout {
            Some(seconds) => self.end(REALSENSE.error(CameraErrorKind::NoFrames { seconds })),
            None => Ok(NextCapture::NotYet),
        }
    }

    /// Closes the camera.
    fn end(&mut self, reason: CameraError) -> Result<NextCapture, CaptureError> {
        self.stream = None;
        let reason = match &self.file {
            Some(path) => file::not_played(reason, path),
            None => reason,
        };
        Err(reason.into())
    }
}

impl DepthSource for Realsense {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let Some(stream) = &self.stream else {
            return Ok(NextCapture::End);
        };
        // Query this before the wait: frames before the end of a file are then in the queue.
        let is_stopped = stream.is_stopped();
        let is_at_end = is_stopped && self.num_frames > 0;
        let start = Instant::now();
        match stream.receive(if is_at_end { Duration::ZERO } else { wait }) {
            Ok(Some(received)) => Ok(NextCapture::Captured(self.captured(received))),
            Ok(None) if is_at_end => {
                self.stream = None;
                Ok(NextCapture::End)
            }
            // A file may have long pauses.
            Ok(None) if self.file.is_some() && !is_stopped => Ok(NextCapture::NotYet),
            Ok(None) => self.silent(start.elapsed()),
            Err(message) => self.end(disconnected(Some(message))),
        }
    }
}

fn open_file(context: &Context, path: &Path) -> Result<Device, CameraError> {
    let name = CString::new(path.to_string_lossy().into_owned());
    let name = name.map_err(|error| not_opened(error.to_string()))?;
    context.open_file(&name).map_err(not_opened)
}

/// Opens the depth sensor of the camera with that serial number, or of the first camera that has one. Also returns the
/// camera's title.
fn open_camera(
    context: &Context,
    serial: Option<&str>,
) -> Result<(String, (Sensor, DepthMode)), CameraError> {
    let devices = context.devices().map_err(not_opened)?;
    let (mut found, mut error) = (Vec::new(), None);
    for device in devices.open_each() {
        let device = match device {
            Ok(device) => device,
            // It may be the requested one.
            Err(message) => {
                error = Some(not_opened(message));
                continue;
            }
        };
        let its_serial = device.serial_number();
        if serial.is_some() && its_serial.as_deref() != serial {
            found.extend(its_serial);
            continue;
        }
        let title = title(&device);
        match depth_sensor(device, &title) {
            Ok(depth) => return Ok((title, depth)),
            Err(reason) if serial.is_some() => return Err(reason),
            // A depth camera that does not open matters more than one without depth.
            Err(reason) if matches!(reason.kind, CameraErrorKind::NoDepth { .. }) => {
                error = error.or(Some(reason));
            }
            Err(reason) => error = Some(reason),
        }
    }
    Err(error.unwrap_or_else(|| {
        let wanted = serial.filter(|_| !found.is_empty());
        REALSENSE.no_device(wanted, found)
    }))
}

/// Returns the device's depth sensor, with its best mode.
fn depth_sensor(device: Device, title: &str) -> Result<(Sensor, DepthMode), CameraError> {
    let sensor = device.depth_sensor().map_err(not_opened)?;
    let mode = sensor.as_ref().and_then(|sensor| best_mode(sensor.modes()));
    let depth = sensor.zip(mode);
    depth.ok_or_else(|| {
        let title = title.to_owned();
        REALSENSE.error(CameraErrorKind::NoDepth { title })
    })
}

/// Chooses the best mode with a valid size.
fn best_mode(modes: &[DepthMode]) -> Option<DepthMode> {
    let worth = |mode: &&DepthMode| {
        let size = (mode.width, mode.height, mode.rate);
        let preference = PREFERRED_MODES
            .iter()
            .rev()
            .position(|wanted| *wanted == size);
        let num_pixels = i64::from(mode.width) * i64::from(mode.height);
        let off_rate = Reverse((mode.rate - PREFERRED_FPS).abs());
        (preference, mode.rate >= MIN_FPS, num_pixels, off_rate)
    };
    let modes = modes
        .iter()
        .filter(|mode| mode.width > 0 && mode.height > 0);
    modes.max_by_key(worth).copied()
}

fn set_preset(sensor: &Sensor, preset: &str, title: &str) -> Result<(), CameraError> {
    let presets = sensor.presets().map_err(not_opened)?;
    let asked = presets
        .iter()
        .find(|(_, name)| name.eq_ignore_ascii_case(preset));
    let Some((number, _)) = asked else {
        let offered: Vec<String> = presets.into_iter().map(|(_, name)| name).collect();
        let advice = if offered.is_empty() {
            "Leave the source's preset option out"
        } else {
            "Leave the source's preset option out, or name one that the camera has"
        };
        let what = format!("{title} has no preset {preset:?}{}", only(&offered));
        return Err(REALSENSE.unsuitable(what, advice));
    };
    sensor.set_preset(*number).map_err(not_opened)
}

/// Converts the unit by way of its decimal form: 0.001 instead of the nearest binary fraction.
fn metres_per_unit(scale: f32, title: &str) -> Result<f64, CameraError> {
    let metres: f64 = scale.to_string().parse().unwrap_or(f64::NAN);
    if metres > 0.0 && metres.is_finite() {
        return Ok(metres);
    }
    Err(impossible(
        title,
        format_args!("a unit of depth of {scale} m"),
    ))
}

/// The camera reports impossible numbers.
fn impossible(title: &str, numbers: impl Display) -> CameraError {
    REALSENSE.unsuitable(
        format!("{title} reports impossible intrinsics: {numbers}"),
        "Restore the camera's factory calibration with its maker's RealSense Viewer",
    )
}

/// Converts the intrinsics, if [`Intrinsics`] can represent them.
fn camera_of(raw: &RawIntrinsics, title: &str) -> Result<Intrinsics, CameraError> {
    let bad = || {
        let numbers = format!(
            "{}×{} pixels, focal lengths {} and {}, centre {} and {}, distortion {:?}",
            raw.width, raw.height, raw.fx, raw.fy, raw.ppx, raw.ppy, raw.coeffs
        );
        impossible(title, numbers)
    };
    let size = |number: c_int| usize::try_from(number).ok().filter(|&size| size > 0);
    let camera = Intrinsics {
        width: size(raw.width).ok_or_else(bad)?,
        height: size(raw.height).ok_or_else(bad)?,
        fx: f64::from(raw.fx),
        fy: f64::from(raw.fy),
        cx: f64::from(raw.ppx),
        cy: f64::from(raw.ppy),
        distortion: lens(raw).map_err(|model| {
            REALSENSE.unsuitable(
                format!(
                    "{title} gives the distortion of its depth image by the {model} model, which Partsight does not read"
                ),
                "Use a camera whose depth image is not distorted, such as one of the D400 family",
            )
        })?,
    };
    let numbers = [camera.fx, camera.fy, camera.cx, camera.cy];
    let is_camera = numbers.iter().all(|number| number.is_finite())
        && camera.fx > 0.0
        && camera.fy > 0.0
        && camera.distortion.is_finite()
        && camera.is_invertible();
    if is_camera { Ok(camera) } else { Err(bad()) }
}

/// Converts the distortion; the error names a model that cannot be represented. The models are those of `rs2_distortion`.
fn lens(raw: &RawIntrinsics) -> Result<Distortion, &'static str> {
    let [k1, k2, p1, p2, k3] = raw.coeffs.map(f64::from);
    let brown_conrady = Distortion {
        k1,
        k2,
        p1,
        p2,
        k3,
        ..Distortion::NONE
    };
    let is_radial = p1 == 0.0 && p2 == 0.0;
    match raw.model {
        0 => Ok(Distortion::NONE),
        // Its tangential part is evaluated at the point moved by the radial part.
        1 if is_radial => Ok(brown_conrady),
        1 => Err("modified Brown-Conrady"),
        // Many cameras report this model with zero distortion.
        2 if brown_conrady.is_none() => Ok(Distortion::NONE),
        2 => Err("inverse Brown-Conrady"),
        3 => Err("F-Theta"),
        4 => Ok(brown_conrady),
        5 => Err("Kannala-Brandt"),
        _ => Err("unknown"),
    }
}

/// Playback speed, relative to the recording, for a file recorded at `rate` frames per second; `None` to deliver each frame
/// as soon as it is requested.
fn speed(pace: Option<Pace>, rate: c_int) -> Option<f32> {
    match pace {
        Some(Pace::AsTaken) => Some(1.0),
        Some(Pace::PerSecond(wanted)) => Some((wanted / f64::from(rate.max(1))) as f32),
        Some(Pace::Step) | None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAW: RawIntrinsics = RawIntrinsics {
        width: 848,
        height: 480,
        ppx: 424.5,
        ppy: 239.25,
        fx: 421.5,
        fy: 421.0,
        model: 4,
        coeffs: [0.0; 5],
    };

    fn mode(width: c_int, height: c_int, rate: c_int) -> DepthMode {
        DepthMode {
            width,
            height,
            rate,
            index: 0,
        }
    }

    #[test]
    fn the_size_at_which_cameras_are_best_is_taken_then_the_largest_that_is_not_slow() {
        let modes = [
            mode(1280, 720, 6),
            mode(640, 480, 30),
            mode(848, 480, 30),
            mode(848, 480, 90),
            mode(1280, 720, 30),
        ];
        assert_eq!(best_mode(&modes), Some(modes[2]));
        assert_eq!(best_mode(&modes[..2]), Some(modes[1]));
        assert_eq!(best_mode(&modes[3..]), Some(modes[4]));
        let modes = [
            mode(1024, 768, 5),
            mode(480, 270, 15),
            mode(480, 270, 60),
            mode(424, 240, 30),
            mode(0, 480, 30),
        ];
        assert_eq!(best_mode(&modes), Some(modes[1]));
        assert_eq!(best_mode(&modes[..1]), Some(modes[0]));
        assert_eq!(best_mode(&modes[4..]), None);
    }

    #[test]
    fn a_lens_is_read_as_librealsense_projects_points() {
        // `rs2_project_point_to_pixel` of the point (0.5, -0.3, 1).
        let seen = |model: c_int, coeffs: [f32; 5]| {
            let raw = RawIntrinsics {
                model,
                coeffs,
                ..RAW
            };
            let camera = camera_of(&raw, "it").expect("a lens that is read");
            let point = nalgebra::Point3::new(0.5, -0.3, 1.0);
            camera.pixel_of(&point).expect("in front")
        };
        let (x, y, r2) = (0.5_f64, -0.3_f64, 0.34_f64);
        let [k1, k2, p1, p2, k3] = [0.1, -0.05, 0.001, -0.002, 0.01];
        let factor = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        let tangential = [
            2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y),
        ];
        let expected = |x: f64, y: f64| (x * 421.5 + 424.5, y * 421.0 + 239.25);
        let whole = [0.1, -0.05, 0.001, -0.002, 0.01];
        let radial = [0.1, -0.05, 0.0, 0.0, 0.01];
        for (model, coeffs, (u, v)) in [
            (0, whole, expected(x, y)),
            (1, radial, expected(x * factor, y * factor)),
            (2, [0.0; 5], expected(x, y)),
            (
                4,
                whole,
                expected(x * factor + tangential[0], y * factor + tangential[1]),
            ),
        ] {
            let found = seen(model, coeffs);
            // The camera's numbers have seven digits.
            assert!(
                (found.0 - u).hypot(found.1 - v) < 1e-4,
                "{model}: {found:?}"
            );
        }
        for (model, words) in [
            (1, "modified Brown-Conrady"),
            (2, "inverse Brown-Conrady"),
            (3, "F-Theta"),
            (5, "Kannala-Brandt"),
            (9, "unknown"),
        ] {
            let raw = RawIntrinsics {
                model,
                coeffs: whole,
                ..RAW
            };
            let error = camera_of(&raw, "It").expect_err("not read");
            assert!(error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn numbers_that_no_camera_has_are_refused() {
        let folding = [-0.5, 0.0, 0.0, 0.0, 0.0];
        for raw in [
            RawIntrinsics { width: 0, ..RAW },
            RawIntrinsics { height: -1, ..RAW },
            RawIntrinsics { fx: 0.0, ..RAW },
            RawIntrinsics { fy: -1.0, ..RAW },
            RawIntrinsics {
                fy: f32::NAN,
                ..RAW
            },
            RawIntrinsics {
                ppx: f32::INFINITY,
                ..RAW
            },
            RawIntrinsics {
                coeffs: [f32::NAN; 5],
                ..RAW
            },
            RawIntrinsics {
                coeffs: folding,
                ..RAW
            },
        ] {
            let error = camera_of(&raw, "It").expect_err("no camera");
            let is_bad = error.to_string().contains("impossible intrinsics");
            assert!(is_bad, "{error}");
        }
        for scale in [0.0, -0.001, f32::NAN, f32::INFINITY] {
            assert!(metres_per_unit(scale, "It").is_err(), "{scale}");
        }
        let [millimetre, quarter] = [0.001, 0.00025].map(|scale| metres_per_unit(scale, "It"));
        assert_eq!(millimetre.ok(), Some(0.001));
        assert_eq!(quarter.ok(), Some(0.00025));
    }

    #[test]
    fn a_file_is_played_at_the_pace_that_is_asked_for() {
        for (pace, expected) in [
            (None, None),
            (Some(Pace::Step), None),
            (Some(Pace::AsTaken), Some(1.0)),
            (Some(Pace::PerSecond(15.0)), Some(0.5)),
        ] {
            assert_eq!(speed(pace, 30), expected);
        }
    }
}
