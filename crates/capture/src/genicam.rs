//! A GenICam camera (GigE Vision, USB3 Vision), through aravis.
//!
//! Depth comes as `Coord3D_C16`, points as `Coord3D_ABC32f`. The meaning of their values is read from the camera (`scan3d`)
//! or, for depth, from a file like those that accompany depth images. `Mono16` is used as depth only on request, because
//! most cameras send grey values in it.
//!
//! Only the pixel format, the acquisition mode and the selectors needed for reading are set; exposure, region and
//! everything else stay as configured in the camera.

mod aravis;
mod scan3d;

use std::{
    ffi::CString,
    net::IpAddr,
    sync::Arc,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use self::{
    aravis::{Device, FoundDevice, Frame, Functions},
    scan3d::{Decoder, FOCAL_LENGTH, Scan3d},
};
use super::{
    camera_error::{CameraError, CameraErrorKind, only},
    camera_library::ARAVIS,
    error::{CaptureError, CaptureWarning},
    read_timeout::ReadTimeout,
    source::{Captured, DepthSource, Image, NextCapture, SkippedCapture},
    spec::{GenicamFormat, GenicamSpec, SourceListing, SourceSpec},
};
use files::DepthCamera;

/// A camera that sends nothing for this long is lost. It exceeds the 5 s or so after which the library notices that a GigE
/// camera is gone, which gives the better message.
const MAX_SILENCE: Duration = Duration::from_secs(8);

/// An open camera whose stream runs. Dropping it stops the stream and closes the camera.
pub(super) struct Genicam {
    /// `None` once it is lost.
    device: Option<Device>,
    title: String,
    format: GenicamFormat,
    decoder: Decoder,
    /// Number of frames, complete or not.
    num_frames: u64,
    silence: ReadTimeout,
    warnings: Vec<CaptureWarning>,
}

/// Lists the cameras that answer, or why there are none, using the environment's or the system's aravis. Takes about a
/// second, the time cameras have to answer.
pub(super) fn list() -> Vec<SourceListing> {
    let listing = |device: FoundDevice| {
        let spec = SourceSpec::Genicam(GenicamSpec {
            device: Some(device.id),
            ..GenicamSpec::default()
        });
        SourceListing::openable(spec.title(), spec)
    };
    let found = ARAVIS.find(None, Functions::load);
    let error = match found.map(Functions::devices) {
        Ok(devices) if devices.is_empty() => ARAVIS.no_device(None, Vec::new()),
        Ok(devices) => return devices.into_iter().map(listing).collect(),
        Err(error) => error,
    };
    vec![SourceListing::unusable(error)]
}

/// Returns the ID of the requested camera, or of the first that answers.
fn find_device(aravis: &Functions, wanted: Option<&str>) -> Result<String, CameraError> {
    // Search even if an address is given: the library keeps cameras that are gone until the next search.
    let found = aravis.devices();
    let Some(wanted) = wanted else {
        let first = found.into_iter().next();
        let first = first.ok_or_else(|| ARAVIS.no_device(None, Vec::new()))?;
        return Ok(first.id);
    };
    let asked = found
        .iter()
        .find(|device| device.id == wanted || device.address.as_deref() == Some(wanted));
    match asked {
        Some(device) => Ok(device.id.clone()),
        // A camera behind a router is not found by the search, but may be reachable.
        None if wanted.parse::<IpAddr>().is_ok() => Ok(wanted.to_owned()),
        None => {
            let found: Vec<String> = found.into_iter().map(|device| device.id).collect();
            let wanted = (!found.is_empty()).then_some(wanted);
            Err(ARAVIS.no_device(wanted, found))
        }
    }
}

/// Chooses the pixel format: the requested one, else depth if its numbers are known, else points.
fn choose(
    asked: Option<GenicamFormat>,
    offered: &[String],
    knows_camera: bool,
) -> Result<GenicamFormat, CameraError> {
    let is_offered = |format: &GenicamFormat| offered.iter().any(|name| name == format.name());
    if let Some(format) = asked {
        return if is_offered(&format) {
            Ok(format)
        } else {
            Err(ARAVIS.unsuitable(
                format!(
                    "the camera does not offer {}{}",
                    format.name(),
                    only(offered)
                ),
                "Leave the source's format option out, or name one that the camera offers",
            ))
        };
    }
    let preferred = if knows_camera {
        [GenicamFormat::Coord3dC16, GenicamFormat::Coord3dAbc32f]
    } else {
        [GenicamFormat::Coord3dAbc32f, GenicamFormat::Coord3dC16]
    };
    preferred
        .into_iter()
        .find(is_offered)
        .ok_or_else(|| {
            ARAVIS.unsuitable(
                format!("the camera offers no depth{}", only(offered)),
                "Use a 3-D camera; if its Mono16 is depth, say so and give its numbers: genicam,format=Mono16,camera=FILE",
            )
        })
}

impl Genicam {
    /// Opens the camera with the given ID, or the first that answers, and starts its stream.
    pub(super) fn open(spec: &GenicamSpec) -> Result<Self, CaptureError> {
        let file = spec.camera.as_deref().map(DepthCamera::read).transpose()?;
        let aravis = ARAVIS.find(spec.library.as_deref(), Functions::load)?;
        let id = find_device(aravis, spec.device.as_deref())?;
        let mut device = aravis.open(&id).map_err(not_opened)?;
        if !device.has_control() {
            return Err(ARAVIS.error(CameraErrorKind::Busy).into());
        }
        // A camera with several sensors or maps reports the formats of the selected one; others have no such node.
        let _ = device.set(c"ComponentSelector", c"Range");
        let offered = device.pixel_formats().map_err(not_opened)?;
        let knows_camera = file.is_some() || device.has(FOCAL_LENGTH).map_err(not_opened)?;
        let format = choose(spec.format, &offered, knows_camera)?;
        let name = CString::new(format.name()).unwrap_or_default();
        device.set(c"PixelFormat", &name).map_err(not_opened)?;
        let nodes = Scan3d::read(&device, format).map_err(not_opened)?;
        let (decoder, mut warnings) = nodes.decoder(format, file)?;
        let doubt = file.and_then(|camera| camera.intrinsics.doubt());
        warnings.extend(doubt.map(|doubt| CaptureWarning::File(doubt.into())));
        if device.has(c"AcquisitionMode").map_err(not_opened)? {
            let set = device.set(c"AcquisitionMode", c"Continuous");
            set.map_err(not_opened)?;
        }
        device
            .start()
            .map_err(|message| ARAVIS.error(CameraErrorKind::NotStarted).quoting([message]))?;
        let spec = GenicamSpec {
            device: Some(id),
            ..spec.clone()
        };
        Ok(Self {
            device: Some(device),
            title: spec.title(),
            format,
            decoder,
            num_frames: 0,
            silence: ReadTimeout::with_limit(MAX_SILENCE),
            warnings,
        })
    }

    /// Converts a frame into a capture, or into a frame that is skipped and counted.
    fn next_of(&self, frame: &Frame<'_>) -> NextCapture {
        let name = format!("GenICam frame {}", self.num_frames);
        let part = || {
            let part = frame.part(self.format.number());
            part.ok_or_else(|| format!("it has no picture, or several, in {}", self.format.name()))
        };
        let image = frame
            .whole()
            .map_err(str::to_owned)
            .and_then(|()| self.decoder.image(part()?));
        match image {
            Ok(image) => NextCapture::Captured(self.captured(name, frame, image)),
            Err(what) => NextCapture::Skipped(SkippedCapture {
                name,
                error: Arc::new(ARAVIS.error(CameraErrorKind::BadFrame { what }).into()),
            }),
        }
    }

    fn captured(&self, name: String, frame: &Frame<'_>, image: Image) -> Captured {
        let taken_at = Timestamp::from_nanosecond(i128::from(frame.received_at()));
        Captured {
            taken_at: taken_at.unwrap_or_else(|_| geometry::clock::now()),
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

fn not_opened(message: String) -> CameraError {
    ARAVIS.error(CameraErrorKind::NotOpened).quoting([message])
}

fn disconnected(message: Option<String>) -> CameraError {
    ARAVIS.error(CameraErrorKind::Disconnected).quoting(message)
}

impl DepthSource for Genicam {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn is_simulated(&self) -> bool {
        self.decoder.is_simulated()
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let start = Instant::now();
        let Some(device) = &self.device else {
            return Ok(NextCapture::End);
        };
        if let Some(frame) = device.receive(wait) {
            self.silence.restart();
            self.num_frames += 1;
            return Ok(self.next_of(&frame));
        }
        let timeout = self.silence.add(start.elapsed());
        if !device.has_control() {
            return self.end(disconnected(None));
        }
        let Some(seconds) = timeout else {
            return Ok(NextCapture::NotYet);
        };
        // An unplugged camera does not answer either.
        let reason = match device.frame_bytes() {
            Ok(_) => ARAVIS.error(CameraErrorKind::NoFrames { seconds }),
            Err(message) => disconnected(Some(message)),
        };
        self.end(reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_preferred_where_its_numbers_are_known_and_mono16_is_never_guessed() {
        use GenicamFormat::{Coord3dAbc32f, Coord3dC16, Mono16};
        let offered =
            |names: &[&str]| -> Vec<String> { names.iter().map(|&name| name.to_owned()).collect() };
        let both = ["Mono8", "Mono16", "Coord3D_C16", "Coord3D_ABC32f"];
        for (asked, names, knows_camera, expected) in [
            (None, &both[..], true, Coord3dC16),
            (None, &both[..], false, Coord3dAbc32f),
            (None, &both[..3], false, Coord3dC16),
            (None, &both[3..], true, Coord3dAbc32f),
            (Some(Mono16), &both[..], true, Mono16),
        ] {
            let chosen = choose(asked, &offered(names), knows_camera).expect("offered");
            assert_eq!(chosen, expected, "{names:?} {knows_camera}");
        }
        let refused = choose(None, &offered(&both[..2]), true).expect_err("grey values");
        assert!(
            refused.to_string().contains("only Mono8, Mono16"),
            "{refused}"
        );
        let refused = choose(Some(Mono16), &offered(&both[..1]), true).expect_err("not offered");
        assert!(
            refused.to_string().contains("does not offer Mono16"),
            "{refused}"
        );
    }
}
