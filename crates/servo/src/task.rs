//! What servoing moves where: the camera's place, the target, and the error between them.

use nalgebra::{Point3, Translation3};

use crate::{Look, Twist};
use geometry::{
    error::Advice,
    rigid::{PoseDelta, RigidTransform, is_finite},
    units::{Metres, Radians},
};
use inspection::{
    library::SprayPath,
    pipeline::live::{ConsensusParams, mean_pose},
};
use robot::{calibration::CameraPlace, spray::nozzle_frames};
use stages::stand_off::StandOffParams;

/// Where the part should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The camera sees the part at this pose. With the camera in the cell, the arm holds the part.
    ///
    /// The identity is the part's standard position: that of its enrolment. A recorded pose is one that was inspected where
    /// the camera should stand.
    SeenAt {
        /// The pose, `camera_from_part`.
        camera_from_part: RigidTransform,
    },
    /// The nozzle stands at a pose relative to the part, which hangs in the cell.
    Nozzle {
        /// The pose: origin at the mouth, z towards the part.
        part_from_nozzle: RigidTransform,
        /// The nozzle on the flange.
        flange_from_nozzle: RigidTransform,
        /// Bounds of the calibration, 95 %, where the part is: how far the camera's place may shift and turn it.
        calibration: PoseDelta,
    },
}

impl Target {
    /// The part's standard position.
    pub fn standard_position() -> Self {
        Self::SeenAt {
            camera_from_part: RigidTransform::identity(),
        }
    }

    /// The camera pose at which frames of a part were taken: their mean, or `None` if fewer than half of the looks are ones to
    /// move by, or agree.
    pub fn recorded(looks: &[Look], middle: &Point3<f64>) -> Option<Self> {
        let seen = looks.iter().filter_map(|look| look.seen.as_ref().ok());
        let poses: Vec<RigidTransform> = seen.map(|seen| seen.camera_from_part).collect();
        let mean = mean_pose(&poses, middle, ConsensusParams::default().tolerance)?;
        (2 * mean.num_agreeing >= looks.len()).then_some(Self::SeenAt {
            camera_from_part: mean.camera_from_part,
        })
    }

    /// The first point of a spray path, with the nozzle as the path has it.
    pub fn path_start(
        path: &SprayPath,
        flange_from_nozzle: RigidTransform,
        calibration: PoseDelta,
        band: &StandOffParams,
    ) -> Result<Self, TaskError> {
        let first = path.points()[0];
        let stand_off = first.stand_off.unwrap_or(band.taught);
        if !(band.nearest..=band.farthest).contains(&stand_off) {
            return Err(TaskError::StandOff {
                stand_off,
                nearest: band.nearest,
                farthest: band.farthest,
            });
        }
        Ok(Self::Nozzle {
            part_from_nozzle: nozzle_frames(path)[0],
            flange_from_nozzle,
            calibration,
        })
    }
}

/// Why a task cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum TaskError {
    /// The path starts nearer to the part than it can be sprayed from, or farther.
    #[error("the path starts {stand_off} from the part; {nearest} to {farthest} coat well")]
    #[advice = "Plan the path again at a stand-off within the band, or change the band (stand_off.nearest, stand_off.farthest)"]
    StandOff {
        /// Stand-off of the first point.
        stand_off: Metres,
        /// Near end of the band.
        nearest: Metres,
        /// Far end of the band.
        farthest: Metres,
    },
    /// A pose of the task is not finite.
    #[error("{what} is not finite")]
    #[advice = "Measure the pose again, and enter it anew"]
    NotFinite {
        /// The pose.
        what: &'static str,
    },
}

/// Where the flange should go by one look at the part, and how far it is from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The flange when the target is reached.
    pub robot_from_flange: RigidTransform,
    /// Control frame on the flange.
    pub flange_from_control: RigidTransform,
    /// Difference from the control frame to the goal frame where the flange was at the look.
    pub error: Twist,
}

/// A part to servo to.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Name of the part.
    pub part: String,
    /// Reference in whose coordinates its pose is.
    pub reference: String,
    /// Middle of that reference, part space, metres.
    pub middle: Point3<f64>,
    /// The camera's place, as calibrated.
    pub camera: CameraPlace,
    /// Where the part should be.
    pub target: Target,
}

impl Task {
    /// Returns the task if its poses are finite.
    pub fn checked(self) -> Result<Self, TaskError> {
        let mut poses = vec![("the camera's place", *self.camera.mount_from_camera())];
        match self.target {
            Target::SeenAt { camera_from_part } => poses.push(("the target", camera_from_part)),
            Target::Nozzle {
                part_from_nozzle,
                flange_from_nozzle,
                ..
            } => poses.extend([
                ("the target", part_from_nozzle),
                ("the nozzle on the flange", flange_from_nozzle),
            ]),
        }
        let wrong = poses.iter().find(|(_, pose)| !is_finite(pose));
        if let Some((what, _)) = wrong {
            return Err(TaskError::NotFinite { what });
        }
        if !self.middle.coords.iter().all(|x| x.is_finite()) {
            return Err(TaskError::NotFinite {
                what: "the middle of the part",
            });
        }
        Ok(self)
    }

    /// True if the arm holds the part.
    pub fn is_part_held(&self) -> bool {
        matches!(
            (&self.camera, &self.target),
            (CameraPlace::Fixed { .. }, Target::SeenAt { .. })
        )
    }

    /// What the calibration may add to the error at the end: nothing if the camera sees the target itself.
    pub fn calibration_bounds(&self) -> PoseDelta {
        match self.target {
            Target::SeenAt { .. } => PoseDelta {
                shift: Metres(0.0),
                rotation: Radians(0.0),
            },
            Target::Nozzle { calibration, .. } => calibration,
        }
    }

    /// The part's pose in what it is fixed to: base frame, or flange if the arm holds it. It stays the same while the part
    /// does not move there.
    pub fn part_in_place(
        &self,
        robot_from_flange: &RigidTransform,
        camera_from_part: &RigidTransform,
    ) -> RigidTransform {
        let robot_from_part = self.robot_from_part(robot_from_flange, camera_from_part);
        if self.is_part_held() {
            robot_from_flange.inverse() * robot_from_part
        } else {
            robot_from_part
        }
    }

    /// The part's pose that the camera sees with the arm at a pose; inverse of [`Self::part_in_place`].
    pub(crate) fn seen_from(
        &self,
        robot_from_flange: &RigidTransform,
        in_place: &RigidTransform,
    ) -> RigidTransform {
        match &self.camera {
            CameraPlace::Fixed { robot_from_camera } if self.is_part_held() => {
                robot_from_camera.inverse() * robot_from_flange * in_place
            }
            CameraPlace::Fixed { robot_from_camera } => robot_from_camera.inverse() * in_place,
            CameraPlace::OnFlange {
                flange_from_camera, ..
            } => (robot_from_flange * flange_from_camera).inverse() * in_place,
        }
    }

    /// The part's pose in the base frame.
    pub fn robot_from_part(
        &self,
        robot_from_flange: &RigidTransform,
        camera_from_part: &RigidTransform,
    ) -> RigidTransform {
        match &self.camera {
            CameraPlace::Fixed { robot_from_camera } => robot_from_camera * camera_from_part,
            CameraPlace::OnFlange {
                flange_from_camera, ..
            } => robot_from_flange * flange_from_camera * camera_from_part,
        }
    }

    /// Where the flange should go, from the arm's pose when the frame was taken and the pose of the part in that frame.
    pub fn goal(
        &self,
        robot_from_flange: &RigidTransform,
        camera_from_part: &RigidTransform,
    ) -> Goal {
        // Camera axes at a point of camera space.
        let at = |point: Point3<f64>| Translation3::from(point.coords);
        let (flange_from_control, control_from_goal) = match (&self.camera, &self.target) {
            (
                CameraPlace::OnFlange {
                    flange_from_camera, ..
                },
                Target::SeenAt {
                    camera_from_part: wanted,
                },
            ) => {
                let wanted_middle = at(wanted * self.middle);
                let camera_from_goal = camera_from_part * wanted.inverse() * wanted_middle;
                (
                    flange_from_camera * wanted_middle,
                    wanted_middle.inverse() * camera_from_goal,
                )
            }
            (
                CameraPlace::Fixed { robot_from_camera },
                Target::SeenAt {
                    camera_from_part: wanted,
                },
            ) => {
                let middle = at(camera_from_part * self.middle);
                let camera_from_goal = wanted * camera_from_part.inverse() * middle;
                (
                    robot_from_flange.inverse() * robot_from_camera * middle,
                    middle.inverse() * camera_from_goal,
                )
            }
            (
                _,
                Target::Nozzle {
                    part_from_nozzle,
                    flange_from_nozzle,
                    ..
                },
            ) => {
                let robot_from_part = self.robot_from_part(robot_from_flange, camera_from_part);
                let robot_from_goal = robot_from_part * part_from_nozzle;
                let robot_from_nozzle = robot_from_flange * flange_from_nozzle;
                (
                    *flange_from_nozzle,
                    robot_from_nozzle.inverse() * robot_from_goal,
                )
            }
        };
        let robot_from_control = robot_from_flange * flange_from_control;
        Goal {
            robot_from_flange: robot_from_control
                * control_from_goal
                * flange_from_control.inverse(),
            flange_from_control,
            error: Twist::from_transform(&control_from_goal),
        }
    }

    /// Error that the flange would have at a pose, by an earlier goal.
    pub(crate) fn error_at(robot_from_flange: &RigidTransform, goal: &Goal) -> Twist {
        let control = robot_from_flange * goal.flange_from_control;
        let wanted = goal.robot_from_flange * goal.flange_from_control;
        Twist::from_transform(&(control.inverse() * wanted))
    }
}

#[cfg(test)]
pub(crate) mod tests;
