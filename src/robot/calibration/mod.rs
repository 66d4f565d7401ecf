//! The cell's calibration: where the camera sits, beside the robot or on its flange, and how that is known.
//!
//! A camera in the cell stays where it is: `robot_from_camera`. A camera on the flange moves with the arm, so that a
//! capture needs the arm's pose as well: `robot_from_camera = robot_from_flange · flange_from_camera`. A cell that always
//! captures from one pose of the arm has it in its file; otherwise every capture brings its own.

mod error;
mod file;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    RobotFrame,
    hand_eye::{CalibrationBounds, HandEye, Mount},
};
use crate::{
    error::Advice,
    files::crc32,
    geometry::rigid::{PoseDelta, RigidTransform, row_major},
    units::Metres,
};

pub use self::{
    error::CalibrationError,
    file::{Loaded, SCHEMA_VERSION, default_path},
};

/// Where the camera of a cell sits, and how that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct CellCalibration {
    /// What people call the cell; may be empty.
    pub name: String,
    /// Whatever is worth remembering; may be empty.
    pub notes: String,
    /// Where the camera sits.
    pub camera: CameraPlace,
    /// How that is known.
    pub origin: Origin,
    /// When it was.
    pub made_at: Timestamp,
}

/// Where a camera sits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraPlace {
    /// In the cell, where it stays.
    Fixed {
        /// Takes the camera's frame to the robot's base frame.
        robot_from_camera: RigidTransform,
    },
    /// On the robot's flange.
    OnFlange {
        /// Takes the camera's frame to the flange's.
        flange_from_camera: RigidTransform,
        /// Where the arm stands at every capture; none if each capture says so itself.
        capture_pose: Option<RigidTransform>,
    },
}

/// How the camera's place is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Origin {
    /// A person entered the numbers.
    ByHand,
    /// It was calculated from pairs of robot and camera poses.
    HandEye(CalibrationFit),
}

/// A hand-eye calibration, in the figures that a person judges it by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibrationFit {
    /// The file of the pairs.
    pub pairs_file: String,
    /// Pairs used.
    pub num_pairs: usize,
    /// Pairs of the file that were left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Root mean square of how far the target was seen from where it should have been, millimetres.
    pub rms_mm: f64,
    /// The same of its turn, degrees.
    pub rms_degrees: f64,
    /// The largest distance, millimetres.
    pub worst_mm: f64,
    /// The pair with it.
    pub worst_pair: String,
    /// The camera's place is off by less in 95 of 100 cases, millimetres where the targets stood; none if not held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound_mm: Option<f64>,
    /// The same of its turn, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound_degrees: Option<f64>,
    /// What was doubtful about the pairs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<String>,
}

impl CalibrationFit {
    /// What is to be remembered of a solved calibration; figures are rounded to a micrometre and 1/10 000 of a degree.
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
    /// In words, for people.
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

/// A camera on the flange, and nobody said where the flange was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the camera is on the robot's flange, and the arm's pose at the capture is not known")]
pub struct NoRobotPose;

impl Advice for NoRobotPose {
    fn advice(&self) -> String {
        "Give the arm's pose with --robot-pose, or store the one that captures are taken from: partsight calibrate capture-pose".into()
    }
}

/// Distances in another unit than was meant, most likely.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum UnitDoubt {
    /// Metres were needed.
    #[error("{name} shifts by {:.0} m: these look like millimetres given as metres", distance.0)]
    TooFar {
        /// The transform.
        name: &'static str,
        /// How far it shifts.
        distance: Metres,
    },
    /// Millimetres were needed.
    #[error("{name} shifts by {:.2} mm only: these look like metres given as millimetres", distance.mm())]
    TooNear {
        /// The transform.
        name: &'static str,
        /// How far it shifts.
        distance: Metres,
    },
}

impl Advice for UnitDoubt {
    fn advice(&self) -> String {
        "Check the unit of the convention (partsight report --conventions), and enter the pose again if it is wrong".into()
    }
}

impl CameraPlace {
    /// What makes the unit of its lengths doubtful, if anything does.
    pub fn unit_doubt(&self) -> Option<UnitDoubt> {
        // No cell is larger, and no camera or flange sits as near to the robot's base.
        let in_cell = [Metres(0.02), Metres(20.0)];
        let on_flange = [Metres(0.002), Metres(3.0)];
        let doubt = |name, transform: &RigidTransform, [least, most]: [Metres; 2]| {
            let distance = Metres(transform.translation.vector.norm());
            // Nothing at all was not measured: it stands for a frame that is the same.
            if distance.0 > 0.0 && distance < least {
                return Some(UnitDoubt::TooNear { name, distance });
            }
            (distance > most).then_some(UnitDoubt::TooFar { name, distance })
        };
        let camera = self.mount().camera_transform();
        match self {
            Self::Fixed { robot_from_camera } => doubt(camera, robot_from_camera, in_cell),
            Self::OnFlange {
                flange_from_camera,
                capture_pose,
            } => doubt(camera, flange_from_camera, on_flange)
                .or_else(|| doubt("robot_from_flange", capture_pose.as_ref()?, in_cell)),
        }
    }

    /// The camera as it is fixed to this mount.
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

    /// What it is fixed to.
    pub fn mount(&self) -> Mount {
        match self {
            Self::Fixed { .. } => Mount::EyeToHand,
            Self::OnFlange { .. } => Mount::EyeInHand,
        }
    }

    /// `robot_from_camera` or `flange_from_camera`.
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
    /// Takes the camera's frame to the robot's base frame; `given` is `robot_from_flange` at this capture.
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

    /// The camera's frame for this capture; `given` is `robot_from_flange` at it.
    pub fn frame(&self, given: Option<&RigidTransform>) -> Result<RobotFrame, NoRobotPose> {
        Ok(RobotFrame {
            robot_from_camera: self.robot_from_camera(given)?,
            name: self.shown_with_identity(),
        })
    }

    /// Its name and identity, for people.
    pub fn shown_with_identity(&self) -> String {
        format!("{} ({})", self.shown_name(), self.identity())
    }

    /// Eight hexadecimal digits by which its numbers are known: the same for the same camera at the same place.
    pub fn identity(&self) -> String {
        // Tenths of micrometres: what reading a file back changes is far below them.
        let text: Vec<String> = self
            .matrices()
            .into_iter()
            .map(|(name, transform)| numbers_text(name, &row_major(transform), 7))
            .collect();
        format!("{:08x}", crc32(text.concat().as_bytes()))
    }

    /// Its transforms by name.
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

    /// Its name, or what stands for it where it has none.
    pub fn shown_name(&self) -> &str {
        if self.name.is_empty() {
            "unnamed cell"
        } else {
            &self.name
        }
    }
}

/// A matrix as text, to be known by its checksum.
fn numbers_text(name: &str, numbers: &[f64; 16], decimals: usize) -> String {
    let unit = 10_f64.powi(-(decimals as i32));
    let mut text = name.to_owned();
    for number in numbers {
        // Adding 0 takes the sign off a zero.
        let rounded = (number / unit).round() * unit + 0.0;
        // Writing to memory does not fail.
        let _ = write!(text, " {rounded:.decimals$}");
    }
    text
}
