//! The settings of a program: tool, gun, moves, and how the arm is checked.

use serde::{Deserialize, Serialize};

use crate::arm::{Arm, CheckParams, GUN_RADIUS_M, Obstacles, PlacedArm};
use geometry::{
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use inspection::{
    number_parameter as number,
    pipeline::parameters::{Parameter, Parameters},
};

/// Settings of the cell and of the moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramSettings {
    /// The tool on the controller: a number or a name, whichever the language has; none if the program sets or uses another.
    /// Default: 1, or `tool1`.
    pub tool: Option<String>,
    /// Pose of the nozzle on the flange. Some languages set it as the tool; otherwise the controller's tool applies.
    pub flange_from_nozzle: Option<RigidTransform>,
    /// The frame of a line that carries the part, in which the path is written; none for a part that stands still.
    pub tracking: Option<TrackingFrame>,
    /// The numbers.
    pub params: ProgramParams,
}

/// A frame of the controller that moves with a line, by the line's encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingFrame {
    /// Number on the controller of what moves it; see [`RobotLanguage`](super::RobotLanguage).
    pub number: u8,
    /// Where it is, in the robot's base frame, while the part hangs where the path is carried to. The line moves along its x.
    pub robot_from_frame: RigidTransform,
}

/// The numbers of a program and of the check of its arm. Their table has names, ranges and help of each; the options of the
/// commands and the fields of the window are made from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProgramParams {
    /// Number of the digital output that opens the gun, 0..9999; most controllers have fewer.
    pub gun_output: u16,
    /// Radius of the gun around the line from the flange to the nozzle's mouth, 1..1000 mm; the check uses at most half the
    /// gun's length.
    pub gun_radius: Metres,
    /// Minimum distance of gun and arm from part, boxes and floor, 0..1000 mm.
    pub clearance: Metres,
    /// Speed where the path sets none, 0.001..5 m/s; most controllers allow less.
    pub speed: f64,
    /// Distance of the approach point behind the first point, and of the end behind the last, 10..1000 mm.
    pub approach: Metres,
    /// Radius within which the robot may cut a corner, 0..100 mm; at most 0.45 of the distance to the neighbouring
    /// points.
    pub blend: Metres,
    /// Maximum tilt of the nozzle about the point that it aims at, 0..30°; used only where a checked arm cannot otherwise
    /// follow the path.
    pub max_tilt: Radians,
}

impl Default for ProgramParams {
    fn default() -> Self {
        Self {
            gun_output: 1,
            gun_radius: Metres(GUN_RADIUS_M),
            clearance: Metres(Obstacles::default().clearance),
            speed: 0.25,
            approach: Metres(0.1),
            blend: Metres(0.005),
            // This hardly changes how much of the film is within a tolerance of 20 %.
            max_tilt: Radians::from_degrees(10.0),
        }
    }
}

/// What a number applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramGroup {
    /// A program, as it is written.
    Program,
    /// The moves, as they are written and checked.
    Moves,
    /// The check of an arm.
    Arm,
}

impl Parameters for ProgramParams {
    type Group = ProgramGroup;
    #[rustfmt::skip]
    const ALL: &'static [Parameter<Self>] = &[
        number!(gun_output, "Output that opens the gun", ProgramGroup::Program, Fold, None, [0.0, 9999.0], 0,
            "Number of the digital output that opens the gun"),
        number!(gun_radius, "Radius of the gun", ProgramGroup::Arm, Fold, Millimetres, [1.0, 1000.0], 1,
            "Radius of the gun around the line from the flange to the nozzle's mouth; at most half the gun's length is used"),
        number!(clearance, "Clearance of gun and arm", ProgramGroup::Arm, Fold, Millimetres, [0.0, 1000.0], 1,
            "Minimum distance of gun and arm from part, boxes and floor"),
        number!(speed, "Speed where the path has none", ProgramGroup::Moves, Fold, MillimetresPerSecond, [1.0, 5000.0], 1,
            "Speed of the nozzle where the path sets none"),
        number!(approach, "Approach and retreat", ProgramGroup::Moves, Fold, Millimetres, [10.0, 1000.0], 1,
            "Distance of the approach points from the path's first and last point"),
        number!(blend, "Blending radius", ProgramGroup::Program, Fold, Millimetres, [0.0, 100.0], 1,
            "Radius within which the robot may cut corners"),
        number!(max_tilt, "Tilt of the gun where needed, up to", ProgramGroup::Arm, Fold, Degrees, [0.0, 30.0], 1,
            "Maximum tilt of the nozzle about the point that it aims at; used only where the arm cannot otherwise follow the path"),
    ];
}

impl ProgramParams {
    /// Places an arm in its cell, with the gun and the clearance of these numbers.
    pub fn place(
        &self,
        arm: Arm,
        robot_from_base: RigidTransform,
        flange_from_nozzle: RigidTransform,
        mut obstacles: Obstacles,
    ) -> PlacedArm {
        obstacles.clearance = self.clearance.0;
        PlacedArm {
            arm,
            robot_from_base,
            flange_from_nozzle,
            gun_radius: self.gun_radius.0,
            obstacles,
        }
    }

    /// How the arm of a program with these numbers is checked: with its approach point and its end.
    pub fn check_params(&self) -> CheckParams<'static> {
        CheckParams {
            max_tilt: self.max_tilt.0,
            approach: Some(self.approach.0),
            ..CheckParams::default()
        }
    }
}
