//! The common folder format of RGB-D sequences: `depth.txt` has a time and a depth image per line.
//!
//! Source: J. Sturm, N. Engelhard, F. Endres, W. Burgard and D. Cremers, "A Benchmark for the Evaluation of RGB-D SLAM
//! Systems", IROS 2012, and the file formats on the benchmark's page: lines of `timestamp filename`, comments after `#`,
//! time in seconds since 1970, 16-bit PNG with 5000 units per metre. A folder without an `intrinsics.json` is assumed to
//! have the camera that the benchmark uses where none was calibrated.

use std::path::Path;

use jiff::Timestamp;

use super::replay::{Content, Frames, RecordedFrame};
use crate::error::{CaptureError, CaptureWarning};
use files::{
    DepthCamera, StoredOrientation, Turn, depth_png::FOLDER_CAMERA, file_name, read_limited,
    shortened, stays_inside,
};
use geometry::depth_frame::Intrinsics;

pub(super) const LIST: &str = "depth.txt";

/// Limits of a list: lines (nine hours of frames) and bytes.
const MAX_LINES: usize = 1_000_000;
const MAX_LIST_BYTES: u64 = 256 << 20;

const ASSUMED: DepthCamera = DepthCamera {
    intrinsics: Intrinsics::KINECT,
    metres_per_unit: 1.0 / 5000.0,
    is_simulated: false,
    stored: StoredOrientation {
        is_mirrored: false,
        turn: Turn::None,
    },
};

pub(super) fn frames(folder: &Path, camera: Option<&Path>) -> Result<Frames, CaptureError> {
    let beside = folder.join(FOLDER_CAMERA);
    let mut warnings = Vec::new();
    let camera = match camera {
        Some(given) => DepthCamera::read(given)?,
        None if beside.exists() => DepthCamera::read(&beside)?,
        None => {
            warnings.push(CaptureWarning::AssumedCamera { missing: beside });
            ASSUMED
        }
    };
    let doubt = camera.intrinsics.doubt();
    warnings.extend(doubt.map(|doubt| CaptureWarning::File(doubt.into())));
    let path = folder.join(LIST);
    let bytes = read_limited(&path, MAX_LIST_BYTES)?;
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().map(str::trim).enumerate();
    let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let frames = lines.map(|(at, line)| {
        let wrong = |expected: &str| CaptureError::DamagedRecording {
            path: path.clone(),
            what: format!(
                "line {}: expected {expected}, found {:?}",
                at + 1,
                shortened(line)
            ),
        };
        let words = line.split_once(|c: char| c.is_whitespace() || c == ',');
        let (time, image) = words.ok_or_else(|| wrong("a time and a file"))?;
        let image = image.trim();
        if !stays_inside(Path::new(image)) {
            return Err(wrong("a file inside the sequence's own folder"));
        }
        if at >= MAX_LINES {
            return Err(wrong("at most a million lines"));
        }
        Ok(RecordedFrame {
            name: image.to_owned(),
            path: folder.join(image),
            taken_at: seconds_since_1970(time),
            is_simulated: false,
            truth: None,
            robot_from_flange: None,
            content: Content::Depth(camera),
        })
    });
    Ok(Frames {
        title: format!("Sequence {}", file_name(folder)),
        is_simulated: false,
        in_order: frames.collect::<Result<_, _>>()?,
        warnings,
    })
}

/// Parses the digits: a floating-point number has a resolution of only 0.2 µs for times of today.
fn seconds_since_1970(text: &str) -> Option<Timestamp> {
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    let digits = fraction.get(..9).unwrap_or(fraction);
    let nanoseconds: i32 = format!("{digits:0<9}").parse().ok()?;
    Timestamp::new(whole.parse().ok()?, nanoseconds).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_exact_to_the_last_digit() {
        let time = seconds_since_1970("1305031102.160407").unwrap();
        assert_eq!(time.as_nanosecond(), 1_305_031_102_160_407_000);
        assert_eq!(seconds_since_1970("7").unwrap().as_second(), 7);
        assert_eq!(
            seconds_since_1970("1.0000000019").unwrap().as_nanosecond(),
            1_000_000_001
        );
        assert!(seconds_since_1970("noon").is_none());
    }
}
