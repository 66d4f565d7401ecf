//! The cell's calibration: where the camera sits, fixed in the cell or on the robot's flange, and how that was found.
//!
//! A camera fixed in the cell has a constant `robot_from_camera`. A camera on the flange moves with the arm, so a
//! capture needs the arm's pose as well: `robot_from_camera = robot_from_flange · flange_from_camera`. A cell that
//! always captures from one pose of the arm stores it in its calibration; otherwise every capture brings its own.

mod error;
mod file;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    FrameName, RobotFrame,
    hand_eye::{CalibrationBounds, HandEye, Mount},
};
use files::crc32;
use geometry::{
    error::Advice,
    rigid::{PoseDelta, RigidTransform, row_major},
    units::{Metres, Radians},
};

pub use self::{
    error::CalibrationError,
    file::{ReadCalibration, SCHEMA_VERSION, default_path},
};

/// Least and greatest distance of camera or flange from the origin of the robot's base: no cell is larger, and none sits nearer.
pub const CELL_DISTANCES: [Metres; 2] = [Metres(0.02), Metres(20.0)];

/// Where the camera of a cell sits, and how that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct CellCalibration {
    /// Name of the cell; may be empty.
    pub name: String,
    /// Notes for people; may be empty.
    pub notes: String,
    /// Where the camera sits.
    pub camera: CameraPlace,
    /// How that was found.
    pub origin: Origin,
    /// When that was found.
    pub made_at: Timestamp,
}

/// Where a camera sits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraPlace {
    /// Fixed in the cell.
    Fixed {
        /// Transform from the camera frame to the robot's base frame.
        robot_from_camera: RigidTransform,
    },
    /// On the robot's flange.
    OnFlange {
        /// Transform from the camera frame to the flange frame.
        flange_from_camera: RigidTransform,
        /// `robot_from_flange` at every capture; none if each capture brings its own.
        capture_pose: Option<RigidTransform>,
    },
}

/// How the camera's place was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Origin {
    /// A person entered the numbers.
    ByHand,
    /// It was computed from pairs of robot and camera poses.
    HandEye(CalibrationFit),
}

/// The figures by which a person judges a hand-eye calibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibrationFit {
    /// Name of the file of pairs.
    pub pairs_file: String,
    /// Number of pairs used.
    pub num_pairs: usize,
    /// Pairs of the file that were not used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Root mean square distance of the target from where it should have been seen, millimetres.
    pub rms_mm: f64,
    /// The same for its rotation, degrees.
    pub rms_degrees: f64,
    /// The largest distance, millimetres.
    pub worst_mm: f64,
    /// The pair with the largest distance.
    pub worst_pair: String,
    /// Bound of the camera's position error in 95 of 100 cases, millimetres, where the targets stood; none if
    /// unconstrained.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound_mm: Option<f64>,
    /// The same for its rotation, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound_degrees: Option<f64>,
    /// Doubts about the pairs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<String>,
}

impl CalibrationFit {
    /// Extracts the figures of a solved calibration, rounded to a micrometre and 1/10 000 of a degree.
    pub fn of(solved: &HandEye, pairs_file: String, left_out: Vec<String>) -> Self {
        let rounded = |value: f64, unit: f64| (value / unit).round() * unit;
        let mm = |off: &PoseDelta| rounded(off.shift.mm(), 0.001);
        let worst = solved.residuals.worst();
        let CalibrationBounds { shift, turn } = solved.bounds;
        let finite = |value: f64, unit: f64| Some(rounded(value, unit)).filter(|x| x.is_finite());
        Self {
            pairs_file,
            num_pairs: solved.residuals.pairs.len(),
            left_out,
            rms_mm: mm(&solved.residuals.rms),
            rms_degrees: rounded(solved.residuals.rms.rotation.degrees(), 1e-4),
            worst_mm: mm(&worst.off),
            worst_pair: worst.name.clone(),
            bound_mm: finite(shift.mm(), 0.001),
            bound_degrees: finite(turn.degrees(), 1e-4),
            doubts: solved.doubts.iter().map(ToString::to_string).collect(),
        }
    }
}

impl Origin {
    /// Describes the origin in words, for people.
    pub fn describe(&self) -> String {
        match self {
            Self::ByHand => "entered by hand".into(),
            Self::HandEye(fit) => format!(
                "hand-eye calibration of {} pairs from {}: {:.2} mm and {:.3}° rms, worst {:.2} mm ({})",
                fit.num_pairs,
                fit.pairs_file,
                fit.rms_mm,
                fit.rms_degrees,
                fit.worst_mm,
                fit.worst_pair
            ),
        }
    }
}

/// The camera is on the flange, and the arm's pose at the capture is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[error("the camera is on the robot's flange, and the arm's pose at the capture is not known")]
#[advice = "Give the arm's pose with --robot-pose, or store the one that captures are taken from: partsight calibrate capture-pose"]
pub struct NoRobotPose;

/// A shift that is probably in another unit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, Advice)]
#[advice = "Check the unit of the convention (partsight report --conventions), and enter the pose again if it is wrong"]
pub enum UnitDoubt {
    /// Too far for metres.
    #[error("{name} shifts by {:.0} m: these look like millimetres given as metres", distance.0)]
    TooFar {
        /// The transform.
        name: &'static str,
        /// Length of its shift.
        distance: Metres,
    },
    /// Too near for millimetres.
    #[error("{name} shifts by {:.2} mm only: these look like metres given as millimetres", distance.mm())]
    TooNear {
        /// The transform.
        name: &'static str,
        /// Length of its shift.
        distance: Metres,
    },
}

impl CameraPlace {
    /// Returns the transform whose unit of length is doubtful, if there is one.
    pub fn unit_doubt(&self) -> Option<UnitDoubt> {
        let on_flange = [Metres(0.002), Metres(3.0)];
        let doubt = |name, transform: &RigidTransform, [least, most]: [Metres; 2]| {
            let distance = Metres(transform.translation.vector.norm());
            // A shift of exactly zero was not measured: it stands for two frames that are the same.
            if distance.0 > 0.0 && distance < least {
                return Some(UnitDoubt::TooNear { name, distance });
            }
            (distance > most).then_some(UnitDoubt::TooFar { name, distance })
        };
        let camera = self.mount().camera_transform();
        match self {
            Self::Fixed { robot_from_camera } => doubt(camera, robot_from_camera, CELL_DISTANCES),
            Self::OnFlange {
                flange_from_camera,
                capture_pose,
            } => doubt(camera, flange_from_camera, on_flange)
                .or_else(|| doubt("robot_from_flange", capture_pose.as_ref()?, CELL_DISTANCES)),
        }
    }

    /// The place of a camera with this transform to its mount.
    pub fn on(mount: Mount, mount_from_camera: RigidTransform) -> Self {
        match mount {
            Mount::EyeToHand => Self::Fixed {
                robot_from_camera: mount_from_camera,
            },
            Mount::EyeInHand => Self::OnFlange {
                flange_from_camera: mount_from_camera,
                capture_pose: None,
            },
        }
    }

    /// What the camera is fixed to.
    pub fn mount(&self) -> Mount {
        match self {
            Self::Fixed { .. } => Mount::EyeToHand,
            Self::OnFlange { .. } => Mount::EyeInHand,
        }
    }

    /// Returns `robot_from_camera` or `flange_from_camera`.
    pub fn mount_from_camera(&self) -> &RigidTransform {
        match self {
            Self::Fixed { robot_from_camera } => robot_from_camera,
            Self::OnFlange {
                flange_from_camera, ..
            } => flange_from_camera,
        }
    }
}

impl CellCalibration {
    /// Returns the transform from the camera frame to the robot's base frame; `given` is `robot_from_flange` at this
    /// capture.
    pub fn robot_from_camera(
        &self,
        given: Option<&RigidTransform>,
    ) -> Result<RigidTransform, NoRobotPose> {
        match &self.camera {
            CameraPlace::Fixed { robot_from_camera } => Ok(*robot_from_camera),
            CameraPlace::OnFlange {
                flange_from_camera,
                capture_pose,
            } => {
                let robot_from_flange = given.or(capture_pose.as_ref()).ok_or(NoRobotPose)?;
                Ok(robot_from_flange * flange_from_camera)
            }
        }
    }

    /// Returns the robot frame of this capture; `given` is `robot_from_flange` there.
    pub fn frame(&self, given: Option<&RigidTransform>) -> Result<RobotFrame, NoRobotPose> {
        Ok(RobotFrame {
            robot_from_camera: self.robot_from_camera(given)?,
            name: self.frame_name(),
        })
    }

    /// How far off the camera's place is at most, 95 %, where the targets stood; none if it was entered by hand, or is not
    /// bounded.
    pub fn bounds(&self) -> Option<PoseDelta> {
        let Origin::HandEye(fit) = &self.origin else {
            return None;
        };
        Some(PoseDelta {
            shift: Metres::from_mm(fit.bound_mm?),
            rotation: Radians::from_degrees(fit.bound_degrees?),
        })
    }

    /// Its name and identity, for people.
    pub fn frame_name(&self) -> FrameName {
        let identity = self.identity();
        match &*self.name {
            "" => FrameName::Unnamed(identity),
            name => FrameName::Named(format!("{name} ({identity})")),
        }
    }

    /// Eight hexadecimal digits that identify its transforms: equal for the same camera in the same place.
    pub fn identity(&self) -> String {
        // Tenths of micrometres: reading a file back changes much less.
        let text: Vec<String> = self
            .matrices()
            .into_iter()
            .map(|(name, transform)| numbers_text(name, &row_major(transform), 7))
            .collect();
        format!("{:08x}", crc32(text.concat().as_bytes()))
    }

    /// Its transforms, with their names.
    fn matrices(&self) -> Vec<(&'static str, &RigidTransform)> {
        match &self.camera {
            CameraPlace::Fixed { robot_from_camera } => {
                vec![("robot_from_camera", robot_from_camera)]
            }
            CameraPlace::OnFlange {
                flange_from_camera,
                capture_pose,
            } => {
                let arm = capture_pose.iter().map(|pose| ("robot_from_flange", pose));
                let camera = std::iter::once(("flange_from_camera", flange_from_camera));
                camera.chain(arm).collect()
            }
        }
    }
}

/// Writes a matrix as the text of which the checksum is taken.
fn numbers_text(name: &str, numbers: &[f64; 16], decimals: usize) -> String {
    let unit = 10_f64.powi(-(decimals as i32));
    let mut text = name.to_owned();
    for number in numbers {
        // Adding 0 turns -0 into 0.
        let rounded = (number / unit).round() * unit + 0.0;
        // Writing to memory does not fail.
        let _ = write!(text, " {rounded:.decimals$}");
    }
    text
}
