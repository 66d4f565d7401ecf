//! A Kinect.

use super::{error::CaptureError, source::DepthSource, spec::KinectSpec};

/// Opens a Kinect.
pub(super) fn open(_spec: &KinectSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    Err(CaptureError::NoThread {
        source: std::io::ErrorKind::Unsupported.into(),
    })
}
