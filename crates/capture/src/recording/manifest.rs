//! The manifest of a recording: a JSON line about the recording, then one for each frame.

use std::{
    fs,
    path::{Component, Path},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::error::CaptureError;
use files::{DepthCamera, parse_json, read_bytes};
use geometry::sixteen_numbers::SixteenNumbers;
use simulate::FrameTruth;

pub(super) const MANIFEST: &str = "recording.jsonl";
/// Version of the format that is written; newer ones are refused.
pub(super) const VERSION: u32 = 1;

/// The first line of the manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    pub(super) partsight_recording: u32,
    /// Title of the recorded source.
    pub(super) title: String,
    /// The source specification that was opened.
    pub(super) source: String,
    pub(super) simulated: bool,
    pub(super) started_at: Timestamp,
}

/// A frame's line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FrameLine {
    pub(super) file: String,
    pub(super) bytes: u64,
    pub(super) crc32: u32,
    pub(super) taken_at: Timestamp,
    pub(super) name: String,
    pub(super) simulated: bool,
    /// Camera of a depth image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) camera: Option<DepthCamera>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) truth: Option<FrameTruth>,
    /// Pose of the arm that carries the camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) robot_from_flange: Option<SixteenNumbers>,
}

/// Content of a manifest.
#[derive(Debug)]
pub(super) struct Manifest {
    pub(super) header: Header,
    /// The frames with complete lines, except those at the end whose files are incomplete.
    pub(super) frames: Vec<FrameLine>,
    /// True if something follows the last complete frame.
    pub(super) is_cut_off: bool,
}

/// Reads the manifest of the recording in this folder.
pub(super) fn read(folder: &Path) -> Result<Manifest, CaptureError> {
    let path = folder.join(MANIFEST);
    let bytes = read_bytes(&path)?;
    // Anything after the last line end is an incomplete line.
    let whole = bytes.iter().rposition(|&byte| byte == b'\n');
    let (whole, rest) = bytes.split_at(whole.map_or(0, |end| end + 1));
    let mut lines = whole.split_inclusive(|&byte| byte == b'\n');
    let header = read_header(&path, lines.next().unwrap_or(rest))?;
    let mut frames = Vec::new();
    let mut is_cut_off = !rest.is_empty();
    for line in lines {
        match serde_json::from_slice::<FrameLine>(line) {
            Ok(frame) if is_right_here(&frame.file) => frames.push(frame),
            // After a power failure a file may end in bytes that were never written.
            _ => {
                is_cut_off = true;
                break;
            }
        }
    }
    let is_whole = |frame: &FrameLine| {
        fs::metadata(folder.join(&frame.file)).is_ok_and(|file| file.len() == frame.bytes)
    };
    while frames.last().is_some_and(|frame| !is_whole(frame)) {
        is_cut_off = true;
        frames.pop();
    }
    Ok(Manifest {
        header,
        frames,
        is_cut_off,
    })
}

fn read_header(path: &Path, line: &[u8]) -> Result<Header, CaptureError> {
    let damaged = |error: serde_json::Error| CaptureError::DamagedRecording {
        path: path.to_owned(),
        what: format!("line 1: {error}"),
    };
    parse_json(path, line, VERSION, damaged)
}

/// True for the name of a file directly in the recording's folder.
fn is_right_here(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!(components.next(), Some(Component::Normal(_))) && components.next().is_none()
}
