//! The camera of a depth image, as the JSON beside it says.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::FileError;
use super::source::read_bytes;
use crate::capture::frame::{DepthFrame, Intrinsics};

/// The camera of a depth image, as the JSON beside it says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthCamera {
    /// The camera itself.
    #[serde(flatten)]
    pub intrinsics: Intrinsics,
    /// Metres that one unit of the image stands for, above 0.
    pub metres_per_unit: f64,
    /// True of a simulated camera.
    #[serde(
        default,
        rename = "simulated",
        skip_serializing_if = "std::ops::Not::not"
    )]
    pub is_simulated: bool,
}

impl DepthCamera {
    /// The camera that took a frame.
    pub fn of(frame: &DepthFrame) -> Self {
        Self {
            intrinsics: frame.intrinsics,
            metres_per_unit: frame.metres_per_unit,
            is_simulated: frame.is_simulated,
        }
    }

    /// Reads the JSON; what it says can be a camera.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let bad = |found: String| FileError::BadIntrinsics {
            path: path.to_owned(),
            found,
        };
        let camera: Self =
            serde_json::from_slice(&read_bytes(path)?).map_err(|error| bad(error.to_string()))?;
        camera.checked().map_err(bad)
    }

    /// The same again if it can be a camera, else what is wrong.
    pub(crate) fn checked(self) -> Result<Self, String> {
        let Self {
            intrinsics,
            metres_per_unit,
            ..
        } = self;
        if !(intrinsics.fx > 0.0 && intrinsics.fy > 0.0 && metres_per_unit > 0.0) {
            return Err("fx, fy and metres_per_unit must be above 0".into());
        }
        if !(intrinsics.fx + intrinsics.fy + intrinsics.cx + intrinsics.cy + metres_per_unit)
            .is_finite()
        {
            return Err("a number is not finite".into());
        }
        Ok(self)
    }

    /// The frame of these depths, which make a picture of `size` pixels; else what is wrong.
    pub(crate) fn frame(self, size: (usize, usize), depth: Vec<u16>) -> Result<DepthFrame, String> {
        let Intrinsics { width, height, .. } = self.intrinsics;
        if (width, height) != size {
            return Err(format!(
                "{width}×{height} pixels, where the image has {}×{}",
                size.0, size.1
            ));
        }
        Ok(DepthFrame {
            intrinsics: self.intrinsics,
            metres_per_unit: self.metres_per_unit,
            depth,
            is_simulated: self.is_simulated,
        })
    }
}
