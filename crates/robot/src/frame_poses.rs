//! A file with the pose of each frame: the camera's, or that of the flange that carries it.
//!
//! ```json
//! {"frames": {"a.png": {"world_from_camera": [16 numbers, row by row, metres]},
//!             "b.png": {"base_from_flange": [16 numbers]}}}
//! ```
//!
//! The camera's pose is called `world_from_camera` or `base_from_camera`, the flange's `base_from_flange` or
//! `robot_from_flange`. Other fields are ignored. A flange's pose needs the cell's hand-eye calibration.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use serde::Deserialize;

use super::calibration::{CameraPlace, CellCalibration};
use files::{FileError, read_text};
use geometry::{
    error::Advice,
    rigid::{RigidTransform, from_row_major},
};

/// Name of the file in a folder of frames.
pub const FRAME_POSES: &str = "poses.json";

/// The pose given for a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FramePose {
    /// Transform from the camera frame to the robot's base frame.
    Camera(RigidTransform),
    /// Transform from the flange frame to the robot's base frame.
    Flange(RigidTransform),
}

impl FramePose {
    /// Returns the camera's pose for the frame called `frame`. A flange's pose needs the calibration of a camera on the
    /// flange.
    pub fn base_from_camera(
        &self,
        frame: &str,
        calibration: Option<&CellCalibration>,
    ) -> Result<RigidTransform, FramePosesError> {
        match self {
            Self::Camera(pose) => Ok(*pose),
            Self::Flange(base_from_flange) => {
                let camera = calibration.map(|calibration| calibration.camera);
                match camera {
                    Some(CameraPlace::OnFlange {
                        flange_from_camera, ..
                    }) => Ok(base_from_flange * flange_from_camera),
                    Some(CameraPlace::Fixed { .. }) => Err(FramePosesError::CameraIsFixed {
                        frame: frame.to_owned(),
                    }),
                    None => Err(FramePosesError::NoCalibration {
                        frame: frame.to_owned(),
                    }),
                }
            }
        }
    }
}

/// Why a file gives no pose for a frame.
#[derive(Debug, thiserror::Error, Advice)]
pub enum FramePosesError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The file is not JSON of the expected form.
    #[error("{}: {found}, expected {{\"frames\": {{\"NAME.png\": {{\"world_from_camera\": [16 numbers]}}}}}}", path.display())]
    #[advice = "Write one entry per frame, as partsight help scan shows"]
    Format {
        /// The file.
        path: PathBuf,
        /// The first error in it.
        found: String,
    },
    /// An entry is not a pose.
    #[error("{}: {frame}: {found}", path.display())]
    #[advice(found.advice())]
    Entry {
        /// The file.
        path: PathBuf,
        /// The frame.
        frame: String,
        /// What is wrong with it.
        found: EntryProblem,
    },
    /// The file has no entry for some frames.
    #[error("{}: no pose for {}", path.display(), listed(frames, *num_frames))]
    #[advice = "Add the poses of these frames to the file, or move the frames out of the folder"]
    Missing {
        /// The file.
        path: PathBuf,
        /// The frames without a pose.
        frames: Vec<String>,
        /// Number of all frames.
        num_frames: usize,
    },
    /// A flange's pose was given without a calibration.
    #[error(
        "{frame}: the pose is the flange's, but no calibration says where the camera sits on it"
    )]
    #[advice = "Give the hand-eye calibration with --scan-calibration, or make one: partsight calibrate hand-eye pairs.csv --mount eye-in-hand"]
    NoCalibration {
        /// The frame.
        frame: String,
    },
    /// A flange's pose was given, but the calibration is that of a fixed camera.
    #[error(
        "{frame}: the pose is the flange's, but according to the calibration the camera stands in the cell"
    )]
    #[advice = "Give the calibration of the camera on the flange (--mount eye-in-hand), or the camera's own poses as world_from_camera"]
    CameraIsFixed {
        /// The frame.
        frame: String,
    },
}

/// Why an entry is not a pose.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum EntryProblem {
    /// None of the known fields.
    #[error("neither world_from_camera nor base_from_flange")]
    #[advice = "Give world_from_camera, or base_from_flange together with a calibration"]
    NoPose,
    /// Both the camera's and the flange's pose, which may contradict each other.
    #[error("both a camera pose and a flange pose")]
    #[advice = "Leave one of them out"]
    TwoPoses,
    /// Not 16 numbers.
    #[error("{found} numbers, expected the 16 of a 4×4 matrix")]
    #[advice(ROW_AFTER_ROW)]
    Count {
        /// Number of numbers.
        found: usize,
    },
    /// The numbers are written column by column.
    #[error("the matrix ends with its shift: it is written column by column, expected row by row")]
    #[advice(ROW_AFTER_ROW)]
    ColumnByColumn,
    /// The matrix also stretches or mirrors.
    #[error("the matrix is not rigid: it stretches, mirrors or does not end in 0 0 0 1")]
    #[advice = "Write a rotation and a shift with at least 4 decimals; check rows against columns, and axes for a mirrored one"]
    NotRigid,
    /// Farther from the base than any robot reaches; probably millimetres.
    #[error("the camera is {metres:.0} m from the robot's base, expected metres")]
    #[advice = "Divide the shift by 1000: it looks like millimetres"]
    FarAway {
        /// Distance from the base in metres.
        metres: f64,
    },
}

const ROW_AFTER_ROW: &str = "Write the 16 numbers of the matrix row after row";

/// Number of frames listed by name; the others are only counted.
const MAX_NAMES_SHOWN: usize = 3;

fn listed(frames: &[String], num_frames: usize) -> String {
    let num = frames.len();
    let shown = frames[..num.min(MAX_NAMES_SHOWN)].join(", ");
    let rest = match num.saturating_sub(MAX_NAMES_SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{shown}{rest} ({num} of {num_frames} frames)")
}

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 4 << 20;
/// Tolerance for a rigid matrix: people copy at least four decimals.
const COPY_TOLERANCE: f64 = 1e-3;
/// Greatest distance of a camera from the robot's base, metres.
const MAX_DISTANCE_M: f64 = 50.0;

#[derive(Deserialize)]
struct PoseFile {
    frames: BTreeMap<String, Entry>,
}

#[derive(Deserialize)]
struct Entry {
    #[serde(default, alias = "base_from_camera")]
    world_from_camera: Option<Vec<f64>>,
    #[serde(default, alias = "robot_from_flange")]
    base_from_flange: Option<Vec<f64>>,
}

impl Entry {
    fn pose(self) -> Result<FramePose, EntryProblem> {
        match (self.world_from_camera, self.base_from_flange) {
            (Some(numbers), None) => matrix(&numbers).map(FramePose::Camera),
            (None, Some(numbers)) => matrix(&numbers).map(FramePose::Flange),
            (Some(_), Some(_)) => Err(EntryProblem::TwoPoses),
            (None, None) => Err(EntryProblem::NoPose),
        }
    }
}

fn matrix(numbers: &[f64]) -> Result<RigidTransform, EntryProblem> {
    let found = numbers.len();
    let Ok(numbers) = <&[f64; 16]>::try_from(numbers) else {
        return Err(EntryProblem::Count { found });
    };
    let Some(pose) = from_row_major(numbers, COPY_TOLERANCE) else {
        let across: [f64; 16] = std::array::from_fn(|i| numbers[i % 4 * 4 + i / 4]);
        return Err(match from_row_major(&across, COPY_TOLERANCE) {
            Some(_) => EntryProblem::ColumnByColumn,
            None => EntryProblem::NotRigid,
        });
    };
    let metres = pose.translation.vector.norm();
    if metres > MAX_DISTANCE_M {
        return Err(EntryProblem::FarAway { metres });
    }
    Ok(pose)
}

/// Reads the poses of the frames called `names`, in their order; entries of other frames are ignored.
pub fn read_frame_poses(path: &Path, names: &[String]) -> Result<Vec<FramePose>, FramePosesError> {
    let text = read_text(path, MAX_BYTES)?;
    let file: PoseFile = serde_json::from_str(&text).map_err(|error| FramePosesError::Format {
        path: path.to_owned(),
        found: error.to_string(),
    })?;
    let mut entries = file.frames;
    let (mut poses, mut missing) = (Vec::new(), Vec::new());
    for name in names {
        let Some(entry) = entries.remove(name) else {
            missing.push(name.clone());
            continue;
        };
        let pose = entry.pose().map_err(|found| FramePosesError::Entry {
            path: path.to_owned(),
            frame: name.clone(),
            found,
        })?;
        poses.push(pose);
    }
    if !missing.is_empty() {
        return Err(FramePosesError::Missing {
            path: path.to_owned(),
            frames: missing,
            num_frames: names.len(),
        });
    }
    Ok(poses)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::Origin;
    use geometry::rigid::{from_euler_zyx, row_major};

    fn read(text: &str) -> Result<Vec<FramePose>, FramePosesError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(FRAME_POSES);
        std::fs::write(&path, text).expect("written");
        read_frame_poses(&path, &["a.png".into(), "b.png".into()])
    }

    fn entries(a: &str, b: &str) -> String {
        format!(
            r#"{{"reference": 1, "frames": {{"a.png": {a}, "b.png": {b}, "z.png": {{"part": 1}}}}}}"#
        )
    }

    fn numbers(pose: &RigidTransform) -> String {
        format!("{:?}", row_major(pose))
    }

    const FINE: &str =
        r#"{"world_from_camera": [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1], "seen": 0.5}"#;

    #[test]
    fn camera_and_flange_poses_are_read_by_either_name() {
        let arm = from_euler_zyx([0.1, -0.3, 2.0, 0.9, -0.2, 1.4]);
        let flange = format!(r#"{{"robot_from_flange": {}}}"#, numbers(&arm));
        let poses = read(&entries(FINE, &flange)).expect("two poses");
        let [FramePose::Camera(camera), pose] = poses[..] else {
            panic!("a camera's pose, and another");
        };
        assert!((camera.translation.vector.z - 3.0).abs() < 1e-12);
        let flange_from_camera = from_euler_zyx([0.0, 0.0, 1.5, 0.05, 0.0, 0.1]);
        let calibration = |camera| CellCalibration {
            name: String::new(),
            notes: String::new(),
            camera,
            origin: Origin::ByHand,
            made_at: jiff::Timestamp::UNIX_EPOCH,
        };
        let on_flange = calibration(CameraPlace::OnFlange {
            flange_from_camera,
            capture_pose: None,
        });
        let found = pose
            .base_from_camera("b.png", Some(&on_flange))
            .expect("a camera");
        assert!(
            (found.to_homogeneous() - (arm * flange_from_camera).to_homogeneous()).norm() < 1e-9
        );
        let fixed = calibration(CameraPlace::Fixed {
            robot_from_camera: arm,
        });
        for (known, expected) in [
            (None, "no calibration"),
            (Some(&fixed), "stands in the cell"),
        ] {
            let error = pose
                .base_from_camera("b.png", known)
                .expect_err("no camera");
            assert!(error.to_string().contains(expected), "{error}");
        }
    }

    #[test]
    fn what_is_no_pose_is_refused_in_words() {
        let column_by_column = r#"{"world_from_camera": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}"#;
        let mirrored = r#"{"world_from_camera": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}"#;
        let millimetres = r#"{"world_from_camera": [1,0,0,900, 0,1,0,0, 0,0,1,0, 0,0,0,1]}"#;
        for (entry, expected) in [
            ("{}", "neither world_from_camera"),
            (r#"{"world_from_camera": [1,2,3]}"#, "3 numbers"),
            (column_by_column, "column by column"),
            (mirrored, "not rigid"),
            (millimetres, "900 m from"),
        ] {
            let error = read(&entries(FINE, entry)).expect_err(entry);
            assert!(error.to_string().contains(expected), "{error}");
            assert!(error.to_string().contains("b.png"), "{error}");
            assert!(!error.advice().is_empty());
        }
        let error = read(r#"{"frames": {"z.png": {}}}"#).expect_err("nothing of these");
        assert!(error.to_string().contains("2 of 2 frames"), "{error}");
        let error = read("[]").expect_err("a list");
        assert!(matches!(error, FramePosesError::Format { .. }), "{error}");
    }
}
