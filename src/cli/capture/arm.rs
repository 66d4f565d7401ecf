//! Pose of the arm that carries the camera, while frames are recorded.

use std::{
    collections::VecDeque,
    io::{self, BufRead as _},
    path::{Path, PathBuf},
    time::Instant,
};

use clap::Args;

use crate::cli::{
    console::{Advised as _, Console, advised_error},
    input::parse_robot_pose,
};
use capture::Captured;
use geometry::rigid::RigidTransform;
use robot::{WrittenPose, pairs::read_arm_poses, parse_written_pose};

/// Options about the arm that carries the camera.
#[derive(Debug, Args)]
pub(super) struct ArmChoice {
    /// With a camera on the flange: the flange pose for all frames, as `kuka X Y Z A B C`, or the 16 numbers of a
    /// matrix
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true, conflicts_with = "robot_poses")]
    robot_pose: Option<WrittenPose>,
    /// With a camera on the flange: file with the flange pose of each frame, one per line, and the convention in a line
    /// `# robot: kuka`; or - for standard input, where each line takes one frame. partsight scan needs these poses
    #[arg(long, value_name = "FILE")]
    robot_poses: Option<PathBuf>,
}

/// Where the arm's pose of each frame comes from.
pub(super) enum ArmPoseSource {
    /// No poses are given.
    Unknown,
    /// The same pose for all frames.
    Still(RigidTransform),
    /// One pose after another.
    Listed(VecDeque<RigidTransform>),
    /// Poses typed in or written by another program; holds one that has no frame yet, and when it came.
    Typed(Option<(RigidTransform, Instant)>),
}

/// What to do with a frame.
pub(super) enum FramePoseResult {
    /// Record it, at this pose of the arm.
    Record(Option<RigidTransform>),
    /// Ignore it: it was taken before the arm reached the pose.
    TooEarly,
    /// Stop: there are no more poses.
    End,
}

impl ArmPoseSource {
    pub(super) fn of(choice: &ArmChoice) -> anyhow::Result<Self> {
        Ok(match (&choice.robot_pose, &choice.robot_poses) {
            (Some(written), _) => Self::Still(written.pose),
            (None, Some(file)) if file == Path::new("-") => Self::Typed(None),
            (None, Some(file)) => {
                let (poses, _) = read_arm_poses(file, None).advised()?;
                let poses = poses.into_iter().map(|pose| pose.robot_from_flange);
                Self::Listed(poses.collect())
            }
            (None, None) => Self::Unknown,
        })
    }

    /// Returns the number of poses left, if known.
    pub(super) fn num_left(&self) -> Option<u64> {
        match self {
            Self::Listed(poses) => Some(poses.len() as u64),
            _ => None,
        }
    }

    /// Returns the pose for a frame; `is_live` is true for a camera, whose frames may be older than the pose.
    pub(super) fn pose_for(
        &mut self,
        captured: &Captured,
        is_live: bool,
        console: &Console,
    ) -> anyhow::Result<FramePoseResult> {
        Ok(match self {
            Self::Unknown => FramePoseResult::Record(None),
            Self::Still(pose) => FramePoseResult::Record(Some(*pose)),
            Self::Listed(poses) => match poses.pop_front() {
                Some(pose) => FramePoseResult::Record(Some(pose)),
                None => FramePoseResult::End,
            },
            Self::Typed(waiting) => {
                let (pose, since) = if let Some(typed) = waiting.take() {
                    typed
                } else {
                    console.note(&"Move the arm, then write its pose; an empty line ends");
                    let Some(pose) = next_line()? else {
                        return Ok(FramePoseResult::End);
                    };
                    (pose, Instant::now())
                };
                if is_live && captured.arrived < since {
                    *waiting = Some((pose, since));
                    FramePoseResult::TooEarly
                } else {
                    FramePoseResult::Record(Some(pose))
                }
            }
        })
    }
}

/// Reads the next pose from standard input; `None` at its end or after an empty line.
fn next_line() -> anyhow::Result<Option<RigidTransform>> {
    let mut line = String::new();
    let num_bytes = io::stdin().lock().read_line(&mut line).map_err(|error| {
        advised_error(
            format!("standard input cannot be read: {error}"),
            "Give the poses in a file",
        )
    })?;
    if num_bytes == 0 || line.trim().is_empty() {
        return Ok(None);
    }
    parse_written_pose(&line)
        .advised()
        .map(|written| Some(written.pose))
}
