//! A Kinect, through libfreenect.
//!
//! Depth is read in the depth camera's own geometry and in millimetres, as computed by the library from the calibration
//! stored in every Kinect; the focal length comes from the same calibration. The other mode in millimetres maps every
//! reading to the colour camera's view, which leaves holes, and colour is not used here. Libraries that deliver only steps
//! of disparity, such as those that play recorded sessions, are converted to millimetres with a typical Kinect's values,
//! with a warning in every capture.
//!
//! Motor and LED are not used. (libfreenect itself lights the LED of the later models, 1473 and Kinect for Windows, while
//! it opens them.) Only one Kinect can be open in a process.

mod freenect;
mod header;
mod raw_depth;
mod session;

use std::{
    ffi::CString,
    path::Path,
    time::{Duration, Instant},
};

use self::{
    freenect::{Context, Device, Failed, Library, num_turns},
    header::{DEPTH_11BIT, DEPTH_MM, DEPTH_MM_MAX, FrameMode},
};
use super::{
    camera_error::{CameraError, CameraErrorKind},
    camera_library::FREENECT,
    error::{CaptureError, CaptureWarning},
    read_timeout::ReadTimeout,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{KinectSpec, SourceListing, SourceSpec},
};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
};

/// An open Kinect whose depth stream runs. Dropping it stops the stream and closes the camera.
pub(super) struct Kinect {
    /// `None` once it is lost or the session has ended.
    device: Option<Device>,
    title: String,
    camera: Intrinsics,
    units: Units,
    /// Number of entries of the recorded session, if the library plays one.
    num_entries: Option<usize>,
    num_frames: u64,
    silence: ReadTimeout,
    warnings: Vec<CaptureWarning>,
}

/// Unit of the values in the library's frames.
enum Units {
    Millimetres,
    /// A step of disparity; the table converts steps to millimetres.
    Steps(Vec<u16>),
}

/// Lists the Kinects that are plugged in, or why there are none, using the environment's or the system's libfreenect.
pub(super) fn list() -> Vec<SourceListing> {
    found_devices().unwrap_or_else(|error| vec![SourceListing::unusable(error)])
}

fn found_devices() -> Result<Vec<SourceListing>, CameraError> {
    let library = FREENECT.find(None, Library::load)?;
    let (context, num_entries) = start(&library)?;
    let num_devices = context.num_devices().map_err(not_opened)?;
    if num_devices == 0 {
        return Err(FREENECT.no_device(None, Vec::new()));
    }
    let can_be_opened = |serial| {
        let spec = KinectSpec {
            serial,
            library: None,
        };
        SourceListing::openable(title(&spec, &library), SourceSpec::Kinect(spec))
    };
    if num_entries.is_some() {
        return Ok(vec![can_be_opened(None)]);
    }
    let serials = context.serials().map_err(not_opened)?;
    let num_closed = num_devices.saturating_sub(serials.len());
    let closed = (0..num_closed).map(|_| SourceListing::unusable(no_permission()));
    Ok(serials
        .into_iter()
        .map(Some)
        .map(can_be_opened)
        .chain(closed)
        .collect())
}

fn title(spec: &KinectSpec, library: &Library) -> String {
    if library.plays_sessions() {
        "Kinect, a recorded session".into()
    } else {
        SourceSpec::Kinect(spec.clone()).title()
    }
}

/// Starts the library. A build that plays recorded sessions terminates the program if there is no session, so check for it
/// first. Returns the context and the session's number of entries.
fn start(library: &Library) -> Result<(Context, Option<usize>), CameraError> {
    let num_entries = library
        .plays_sessions()
        .then(|| session::check(library.file()))
        .transpose()?;
    Ok((Context::new(library)?, num_entries))
}

impl Kinect {
    /// Opens the Kinect with the given serial number, or the first one, and starts its depth stream.
    pub(super) fn open(spec: &KinectSpec) -> Result<Self, CameraError> {
        let library = FREENECT.find(spec.library.as_deref(), Library::load)?;
        let (context, num_entries) = start(&library)?;
        let mut device = open_device(context, num_entries.is_some(), spec.serial.as_deref())?;
        let mode = best_mode(&device.depth_modes()).ok_or_else(no_depth_mode)?;
        let mut warnings = Vec::new();
        let camera = camera_of(&device, &mode).unwrap_or_else(|| {
            let camera = usual_camera(&mode);
            warnings.push(CaptureWarning::AssumedFocalLength { pixels: camera.fx });
            camera
        });
        let units = if mode.format == DEPTH_MM {
            Units::Millimetres
        } else {
            warnings.push(CaptureWarning::AssumedDepthScale);
            Units::Steps(raw_depth::millimetres_by_step())
        };
        device
            .start(mode)
            .map_err(|failed| failed.error(CameraErrorKind::NotStarted))?;
        Ok(Self {
            device: Some(device),
            title: title(spec, &library),
            camera,
            units,
            num_entries,
            num_frames: 0,
            silence: ReadTimeout::default(),
            warnings,
        })
    }

    fn captured(&mut self, depth: Vec<u16>) -> Captured {
        self.num_frames += 1;
        self.silence.restart();
        let image = Image::Depth(DepthFrame {
            intrinsics: self.camera,
            metres_per_unit: 0.001,
            depth,
            is_simulated: false,
        });
        let name = format!("Kinect frame {}", self.num_frames);
        Captured {
            warnings: self.warnings.clone(),
            ..Captured::now(self.num_frames, name, image)
        }
    }

    /// Closes the camera.
    fn end(&mut self, reason: CameraError) -> Result<NextCapture, CaptureError> {
        self.device = None;
        Err(reason.into())
    }
}

impl DepthSource for Kinect {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let start = Instant::now();
        let mut waited = Duration::ZERO;
        loop {
            // Stop before the end: beyond it, the library would also print a message to the program's output.
            if self.num_entries.is_some_and(|num| num_turns() >= num) {
                self.device = None;
            }
            let Some(device) = &mut self.device else {
                return Ok(NextCapture::End);
            };
            let received = device.receive(wait.saturating_sub(waited));
            let depth = received.map(|values| values.map(|values| self.units.millimetres(values)));
            let turn = start.elapsed().saturating_sub(waited);
            waited += turn;
            match depth {
                Ok(Some(depth)) => return Ok(NextCapture::Captured(self.captured(depth))),
                Ok(None) if self.num_entries.is_some() => {}
                Ok(None) => {
                    if let Some(seconds) = self.silence.add(turn) {
                        return self.end(FREENECT.error(CameraErrorKind::NoFrames { seconds }));
                    }
                }
                // The end of a session and a lost camera have the same code.
                Err(_) if self.num_entries.is_some() => {
                    self.device = None;
                    return Ok(NextCapture::End);
                }
                Err(failed) => return self.end(failed.error(CameraErrorKind::Disconnected)),
            }
            if waited >= wait {
                return Ok(NextCapture::NotYet);
            }
        }
    }
}

impl Units {
    /// Converts a frame to millimetres; 0 means no reading.
    fn millimetres(&self, values: &[u16]) -> Vec<u16> {
        match self {
            Self::Millimetres => values
                .iter()
                .map(|&mm| if mm < DEPTH_MM_MAX { mm } else { 0 })
                .collect(),
            Self::Steps(table) => values
                .iter()
                .map(|&step| table.get(usize::from(step)).copied().unwrap_or(0))
                .collect(),
        }
    }
}

fn open_device(
    context: Context,
    plays_session: bool,
    serial: Option<&str>,
) -> Result<Device, CameraError> {
    let num_devices = context.num_devices().map_err(not_opened)?;
    if num_devices == 0 {
        return Err(FREENECT.no_device(None, Vec::new()));
    }
    let Some(serial) = serial else {
        return context.open(None).map_err(not_opened);
    };
    let found = context.serials().map_err(not_opened)?;
    // A session has one camera, whose serial number is unknown.
    if !plays_session && !found.iter().any(|one| one == serial) {
        if found.len() < num_devices {
            return Err(no_permission());
        }
        return Err(FREENECT.no_device(Some(serial), found));
    }
    let serial = CString::new(serial).ok();
    context.open(serial.as_deref()).map_err(not_opened)
}

fn no_depth_mode() -> CameraError {
    FREENECT.unsuitable(
        "the Kinect offers depth in none of the supported formats (millimetres, 11 bits)",
        format!(
            "Install another build of libfreenect ({})",
            FREENECT.install
        ),
    )
}

/// Udev rules that let a user open a Kinect, under the names used by distributions and by our own package.
const UDEV_RULES: [&str; 6] = [
    "/lib/udev/rules.d/60-libfreenect0.5.rules",
    "/usr/lib/udev/rules.d/60-libfreenect.rules",
    "/etc/udev/rules.d/51-kinect.rules",
    "/etc/udev/rules.d/66-kinect.rules",
    "/usr/lib/udev/rules.d/55-partsight-cameras.rules",
    "/etc/udev/rules.d/55-partsight-cameras.rules",
];

fn no_permission() -> CameraError {
    let rule = UDEV_RULES
        .into_iter()
        .find(|rule| Path::new(rule).is_file());
    FREENECT.error(CameraErrorKind::NoPermission { rule })
}

/// Classifies the failure to open a camera. The library returns -1 for every failure and logs the reason as a line that
/// ends with libusb's code or contains its name.
fn not_opened(failed: Failed) -> CameraError {
    let has = |code: i32, name: &str| {
        let end = format!(": {code}");
        let mut lines = failed.log.iter();
        failed.code == code || lines.any(|line| line.ends_with(&end) || line.contains(name))
    };
    if has(-3, "LIBUSB_ERROR_ACCESS") {
        no_permission()
    } else if has(-6, "LIBUSB_ERROR_BUSY") {
        FREENECT.error(CameraErrorKind::Busy)
    } else if has(-4, "LIBUSB_ERROR_NO_DEVICE") {
        failed.error(CameraErrorKind::Disconnected)
    } else {
        failed.error(CameraErrorKind::NotOpened)
    }
}

/// Prefers millimetres computed by the library over steps of disparity.
fn best_mode(modes: &[FrameMode]) -> Option<FrameMode> {
    let of_format = |format| modes.iter().find(|mode| mode.format == format).copied();
    of_format(DEPTH_MM).or_else(|| of_format(DEPTH_11BIT))
}

/// The intrinsics that the library uses; `None` if it does not reveal them.
fn camera_of(device: &Device, mode: &FrameMode) -> Option<Intrinsics> {
    // Far enough that rounding to whole millimetres does not matter, and within the range of a C int.
    let far_mm = 1_000_000;
    let (width, height) = (i32::from(mode.width), i32::from(mode.height));
    let (left, top) = device.point_mm(0, 0, far_mm)?;
    let (right, bottom) = device.point_mm(width, height, far_mm)?;
    let far_mm = f64::from(far_mm);
    let fx = far_mm * f64::from(width) / (right - left);
    let fy = far_mm * f64::from(height) / (bottom - top);
    let is_camera = |focal: f64| focal > 0.2 * f64::from(width) && focal < 5.0 * f64::from(width);
    (is_camera(fx) && is_camera(fy)).then(|| Intrinsics {
        cx: -left * fx / far_mm,
        cy: -top * fy / far_mm,
        fx,
        fy,
        ..usual_camera(mode)
    })
}

/// The intrinsics of a typical Kinect.
fn usual_camera(mode: &FrameMode) -> Intrinsics {
    let (width, height) = (f64::from(mode.width), f64::from(mode.height));
    let focal = raw_depth::FOCAL_LENGTH_PIXELS * width / 640.0;
    Intrinsics {
        width: usize::try_from(mode.width).unwrap_or(0),
        height: usize::try_from(mode.height).unwrap_or(0),
        fx: focal,
        fy: focal,
        // As in libfreenect's `freenect_camera_to_world`.
        cx: width / 2.0,
        cy: height / 2.0,
        distortion: Distortion::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Recovery;

    #[test]
    fn the_log_of_the_library_gives_the_reason() {
        for (line, expected) in [
            ("Could not open camera: -3", "does not allow"),
            ("Could not open camera: -4", "was lost"),
            (
                "Failed to claim camera interface: LIBUSB_ERROR_BUSY",
                "another program",
            ),
            (
                "Failed to detach camera kernel driver: LIBUSB_ERROR_ACCESS",
                "does not allow",
            ),
            (
                "freenect_camera_init(): Failed to fetch const shift for device",
                "cannot be opened: freenect_camera_init()",
            ),
        ] {
            let error = not_opened(Failed {
                code: -1,
                log: vec![line.into(), "Failed to open camera subdevice".into()],
            });
            assert!(error.to_string().contains(expected), "{line}: {error}");
            assert_eq!(error.recovery(), Recovery::Reopen);
        }
    }

    #[test]
    fn what_is_beyond_the_range_is_no_reading() {
        let values = [0, 1234, 9_999, 10_000, u16::MAX];
        assert_eq!(
            Units::Millimetres.millimetres(&values),
            [0, 1234, 9_999, 0, 0]
        );
        let steps = Units::Steps(raw_depth::millimetres_by_step()).millimetres(&[802, 2047, 2048]);
        assert_eq!(steps[1..], [0, 0]);
        assert!((1200..1205).contains(&steps[0]));
    }
}
