//! Reads single files as captures.

use std::path::Path;

use super::{
    error::{CaptureError, CaptureWarning},
    source::Image,
};
use files::{self, FileContent, FileError, FileWarning, file_name};
use geometry::cloud::PointCloud;

/// A file ending of scenes that is also common for logs and settings beside them.
const LOG_ENDING: &str = "txt";

/// True if a file of this name may be a capture: a known ending, and not hidden.
pub fn may_be_capture(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy());
    let is_known = ending.is_some_and(|found| {
        let mut endings = files::SCENE_ENDINGS.iter();
        endings.any(|ending| *ending != LOG_ENDING && found.eq_ignore_ascii_case(ending))
    });
    is_known && !file_name(path).starts_with('.')
}

/// Reads a capture from a file. A file without any reading is an image without points: the camera was covered.
pub fn read_image(path: &Path) -> Result<(Image, Vec<CaptureWarning>), CaptureError> {
    image_of(files::open(path), path)
}

/// As [`read_image`], for a file that is already open.
pub(super) fn image_of(
    opened: Result<FileContent, FileError>,
    path: &Path,
) -> Result<(Image, Vec<CaptureWarning>), CaptureError> {
    let opened = match opened {
        Ok(opened) => opened,
        Err(FileError::NoPoints { .. }) => {
            return Ok((Image::Cloud(PointCloud::default()), Vec::new()));
        }
        Err(error) => return Err(error.into()),
    };
    let warnings = opened.warnings_as_capture();
    let image = match opened {
        FileContent::Cloud(cloud) => Image::Cloud(cloud),
        FileContent::Depth(frame) => Image::Depth(frame),
        FileContent::Mesh(_) => {
            let path = path.to_owned();
            return Err(if warnings.contains(&FileWarning::CaptureWithFaces) {
                CaptureError::CaptureWithFaces { path }
            } else {
                CaptureError::MeshIsNoCapture { path }
            });
        }
    };
    Ok((image, warnings.into_iter().map(Into::into).collect()))
}
