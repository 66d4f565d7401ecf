//! Programs for a robot's controller: the part's spray path as linear moves with speed, blending and gun.
//!
//! Each language is a [`RobotLanguage`], a table in a file of its own that says how it writes poses, speeds, accelerations,
//! blends and the gun, and by which manual.
//!
//! Every program does the same: gun off; a joint move to the approach point, which is behind the first point along the
//! nozzle; the path; gun off; a linear move away. A point's gun state and speed apply on the way to the next point. All
//! poses are `robot_from_nozzle` in the frame of the calibration: the robot's base frame, unless the arm was checked with
//! its base elsewhere.
//!
//! The gun switches while the robot moves, where the language can: in the middle of the blend at the point, where the move to
//! it ends, or as the blend or the next move begins; otherwise the robot stops there. The film of the program follows from
//! [`Program::motion`].
//!
//! If an arm was checked to reach the path, and the controller is of the arm's maker, the points also name the
//! configuration that was checked, so that the controller takes no other (`configuration`).
//!
//! A rail that moves along the path is the first external axis of every position, in millimetres. Poses stay in the base
//! frame, which does not move along.
//!
//! Programs of LS and JBI hold 9999 instructions. A longer path is cut where the gun is off into several programs, called by
//! a main program. Their names contain a checksum of the whole: on a controller that still has parts of an earlier path, or
//! lacks some, the call fails, so no robot follows one path with the end of another.
//!
//! The frame may move with a line, where the language can: then every move is linear, since the controller follows the line
//! along straight ways only, and the arm's reach is not checked.
//!
//! Known limits: nothing here was tried on a controller. If the configuration is not known, LS and JBI name the usual one (no
//! flip, elbow up, front), and the other programs leave it to the controller.

mod configuration;
mod error;
mod language;
mod motion;
mod prepare;
mod save;
mod settings;
mod steps;
mod text;

#[cfg(test)]
mod tests;

use jiff::Timestamp;

use self::language::Step;
use crate::{
    FrameName,
    arm::{PathCheck, PlacedArm, Way},
};
use geometry::{
    rigid::{RigidTransform, is_finite},
    units::{Metres, counted},
};
use inspection::pipeline::parameters::{DisplayUnit, Kind, Parameters as _};

pub use self::{
    error::ProgramError,
    language::{RobotLanguage, ToolName},
    motion::MotionPiece,
    prepare::{arm_points, check_reach, program_points},
    save::{ProgramTexts, remove_previous_program},
    settings::{ProgramGroup, ProgramParams, ProgramSettings, TrackingFrame},
};

/// One pose of the nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgramPoint {
    /// Pose of the tool in the robot's base frame: origin at the nozzle's mouth, z towards the part.
    pub robot_from_nozzle: RigidTransform,
    /// True if the gun sprays on the way to the next point.
    pub is_gun_on: bool,
    /// Speed on the way to the next point, m/s; none for [`ProgramParams::speed`].
    pub speed: Option<f64>,
}

/// Joint speed of the first move, as a share of the maximum.
const JOINT_SPEED_SHARE: f64 = 0.1;
/// Acceleration of linear moves where the path has none, m/s²: the default of `URScript`, which is low for any arm.
const DEFAULT_ACCELERATION_M_S2: f64 = 1.2;

/// A path to be written as a program, and the content of its header.
#[derive(Clone, Debug)]
pub struct Program<'a> {
    /// The points, in order.
    pub points: &'a [ProgramPoint],
    /// The settings.
    pub settings: &'a ProgramSettings,
    /// Acceleration that the path was planned for, m/s²; none if unknown.
    pub acceleration: Option<f64>,
    /// The film that the program leaves, in words; none if unknown.
    pub film: Option<&'a str>,
    /// The arm, and the result of its check; none if no arm was checked.
    pub reach: Option<&'a (PlacedArm, PathCheck)>,
    /// Name of the part.
    pub part: &'a str,
    /// Name of the capture; none for the standard position.
    pub scene: Option<&'a str>,
    /// The part's pose in the robot's base frame.
    pub robot_from_part: RigidTransform,
    /// Where the robot's frame comes from.
    pub calibration: &'a FrameName,
    /// True if the scene, or the enrolled part, was simulated.
    pub is_simulated: bool,
    /// Reasons against writing the program, which were overridden.
    pub doubts: &'a [String],
    /// What was not checked.
    pub unchecked: &'a [String],
    /// When the program was made.
    pub at: Timestamp,
}

/// Text in the header of every program, which identifies it as ours.
const MARK: &str = "Partsight robot program";

impl Program<'_> {
    /// Acceleration of linear moves, m/s².
    fn line_acceleration(&self) -> f64 {
        self.acceleration.unwrap_or(DEFAULT_ACCELERATION_M_S2)
    }

    fn check(&self, language: &'static RobotLanguage, name: &str) -> Result<(), ProgramError> {
        let most = language.max_name;
        if name.len() > most || !text::is_identifier(name) {
            return Err(ProgramError::Name {
                language,
                name: name.to_owned(),
                most,
            });
        }
        if language.is_reserved(name) {
            return Err(ProgramError::Reserved {
                language,
                name: name.to_owned(),
            });
        }
        let settings = self.settings;
        self.check_lengths()?;
        let output = settings.params.gun_output;
        if !language.outputs.contains(&output) {
            return Err(ProgramError::Output { language, output });
        }
        let tool = self.tool(language);
        let is_tool = match language.tool {
            ToolName::Number(most) => {
                (tool.parse::<u8>()).is_ok_and(|tool| (1..=most).contains(&tool))
            }
            _ => text::is_identifier(&tool) && tool.len() <= 32,
        };
        if !is_tool {
            return Err(ProgramError::Tool { language, tool });
        }
        let is_named = language
            .tool
            .is_named(settings.flange_from_nozzle.is_some());
        if !is_named && settings.tool.is_some() {
            return Err(ProgramError::UnusedTool { language, tool });
        }
        self.check_tracking(language)?;
        self.check_path(language)
    }

    /// Refuses a length of the moves that is out of its range.
    fn check_lengths(&self) -> Result<(), ProgramError> {
        let params = &self.settings.params;
        for row in ProgramParams::ALL {
            if let Kind::Number(number) = &row.kind
                && number.unit == DisplayUnit::Millimetres
                && row.group != ProgramGroup::Arm
            {
                let (value, range) = (row.value(params), number.range);
                if !(range[0]..=range[1]).contains(&value) {
                    let name = row.key;
                    return Err(ProgramError::Length { name, value, range });
                }
            }
        }
        Ok(())
    }

    fn check_tracking(&self, language: &'static RobotLanguage) -> Result<(), ProgramError> {
        let Some(TrackingFrame { number, .. }) = self.settings.tracking else {
            return Ok(());
        };
        let Some(tracking) = &language.tracking else {
            return Err(ProgramError::NoTracking { language });
        };
        if !tracking.numbers.contains(&number) {
            return Err(ProgramError::TrackingNumber { language, number });
        }
        if self.reach.is_some() {
            return Err(ProgramError::TrackedReach);
        }
        Ok(())
    }

    /// Checks the points, apart from the settings that only the text contains.
    fn check_path(&self, language: &'static RobotLanguage) -> Result<(), ProgramError> {
        let settings = self.settings;
        if self.points.is_empty() {
            return Err(ProgramError::NoPoints);
        }
        let [low, high] = language.speeds;
        for (i, point) in self.points.iter().enumerate() {
            if !is_finite(&point.robot_from_nozzle) {
                return Err(ProgramError::NotFinite { point: i + 1 });
            }
            let speed = point.speed.unwrap_or(settings.params.speed);
            if !(low..=high).contains(&speed) {
                return Err(ProgramError::Speed {
                    language,
                    point: i + 1,
                    speed,
                });
            }
        }
        let is_sound =
            settings.flange_from_nozzle.iter().all(is_finite) && is_finite(&self.robot_from_part);
        let tracking = settings.tracking.as_ref();
        let is_sound = is_sound && tracking.is_none_or(|frame| is_finite(&frame.robot_from_frame));
        if !is_sound {
            return Err(ProgramError::NotFinite { point: 0 });
        }
        if let Some((arm, check)) = self.reach
            && let Some(index) = check.points.iter().position(|p| p.way == Way::Joints)
            && !self.names_configurations(language)
        {
            return Err(ProgramError::Configuration {
                language,
                point: index + 1,
                arm: arm.arm.name.clone(),
            });
        }
        if self.moves_on_rail() && language.rail_axis.is_none() {
            return Err(ProgramError::Rail { language });
        }
        Ok(())
    }

    /// True if the language can express the configuration of the checked arm at every point that it reaches. Otherwise the
    /// program gives no configuration at all: with some of them, the controller might turn a joint by a full turn in between.
    fn names_configurations(&self, language: &RobotLanguage) -> bool {
        self.reach.is_some_and(|(arm, check)| {
            let all = check.points.iter().chain(check.ends.iter().flatten());
            let mut joints = all.filter_map(|point| point.joints);
            joints.all(|joints| language.configuration_of(&arm.arm, &joints).is_some())
        })
    }

    /// A pose of the robot's base frame in the frame of the program.
    fn in_frame(&self, robot_from_nozzle: &RigidTransform) -> RigidTransform {
        match &self.settings.tracking {
            Some(frame) => frame.robot_from_frame.inverse() * robot_from_nozzle,
            None => *robot_from_nozzle,
        }
    }

    /// Top speed of the rail that moves the arm along the path, m/s; none if no rail moves.
    fn rail_speed(&self) -> Option<f64> {
        let (arm, _) = self.reach?;
        arm.arm.moving_rail().map(|(_, speed)| speed)
    }

    /// Whether a rail moves the arm along the path.
    fn moves_on_rail(&self) -> bool {
        self.rail_speed().is_some()
    }

    /// The tool's number or name on the controller.
    fn tool(&self, language: &RobotLanguage) -> String {
        let given = self.settings.tool.clone();
        given.unwrap_or_else(|| language.tool.standard().into())
    }

    /// The frame that a line moves, and when it has to begin.
    fn tracking_in_words(&self, language: &RobotLanguage) -> Option<String> {
        let frame = self.settings.tracking.as_ref()?;
        let begins = match self.scene {
            Some(_) => "with the count at which the part was seen",
            None => "as the part passes its standard position",
        };
        Some(format!(
            "frame: moves with the line by {} {}, which begins {begins}, then at {}",
            language.tracking.as_ref()?.what,
            frame.number,
            language.convention.write(&frame.robot_from_frame).line()
        ))
    }

    /// The header's lines, of any length.
    fn header(&self, language: &RobotLanguage, steps: &[Step]) -> Vec<String> {
        let convention = language.convention;
        let seen = match self.scene {
            Some(scene) => format!("scene: {scene}"),
            None => "standard position".into(),
        };
        let mut lines = vec![MARK.to_owned(), format!("part: {}", self.part), seen];
        if self.is_simulated {
            lines.push("SIMULATED: not seen by a camera".into());
        }
        for doubt in self.doubts {
            lines.push(format!("FORCED: {doubt}"));
        }
        lines.push(format!("made: {:.0}", self.at));
        lines.push(format!("calibration: {}", self.calibration));
        lines.push(format!(
            "robot_from_part: {}",
            convention.write(&self.robot_from_part).line()
        ));
        let tool = self.tool(language);
        lines.push(match &self.settings.flange_from_nozzle {
            Some(tool) => format!("flange_from_nozzle: {}", convention.write(tool).line()),
            None if language.tool == ToolName::Active => {
                "tool: the active TCP at the nozzle mouth, z towards the part".into()
            }
            None => format!("tool: {tool}, at the nozzle mouth, z towards the part"),
        });
        lines.extend(self.tracking_in_words(language));
        let base = self.reach.map(|(arm, _)| arm.robot_from_base);
        lines.extend((self.settings.tracking.is_none()).then(|| {
            match base.filter(|base| *base != RigidTransform::identity()) {
                Some(base) => format!(
                    "frame: that of the calibration, with the base of the arm at {}",
                    convention.write(&base).line()
                ),
                None => "frame: robot base".into(),
            }
        }));
        if let Some(axis) = language.rail_axis.filter(|_| self.moves_on_rail()) {
            lines.push(format!(
                "rail: {axis}, mm, 0 where the cell was calibrated, coupled to the arm; the frame does not move with it"
            ));
        }
        if let Some((arm, check)) = self.reach {
            if let Some((num, most)) = check.tilted() {
                lines.push(format!(
                    "nozzle: tilted at {} by up to {:.1} degrees, where the arm could not otherwise follow the path",
                    counted(num, "point", "points"),
                    most.to_degrees()
                ));
            }
            let [num_slower, num_by_joints, num_slower_spraying] = check.changed_moves();
            if num_slower + num_by_joints > 0 {
                lines.push(format!(
                    "moves with the gun off: {num_slower} slower than in the path, {num_by_joints} by joints"
                ));
            }
            if num_slower_spraying > 0 {
                lines.push(format!(
                    "moves with the gun on: {num_slower_spraying} slower than in the path, for speeds and accelerations"
                ));
            }
            let is_named = steps.first().is_some_and(|s| s.configuration.is_some());
            let configuration = if is_named {
                "in the configuration that was checked"
            } else {
                "its configuration is not named here"
            };
            lines.push(format!("arm: {}, {configuration}", arm.arm.name));
            let obstacles = &arm.obstacles;
            let boxes = match obstacles.file() {
                Some(file) => format!("part, arm and {file}"),
                None => "part and arm, without boxes or floor".into(),
            };
            lines.push(format!(
                "checked: reach, and collisions with {boxes}, clearance {}, gun radius {}",
                Metres(obstacles.clearance),
                Metres(arm.checked_gun_radius())
            ));
        }
        for unchecked in self.unchecked {
            lines.push(format!("{unchecked}: not checked"));
        }
        lines.push(format!(
            "{}, gun: output {}",
            counted(self.points.len(), "point", "points"),
            self.settings.params.gun_output
        ));
        lines.push(match self.film {
            Some(film) => format!("film: {film}"),
            None => "film: not computed, because the path names no coat".into(),
        });
        lines.push("Begin where the arm reaches the first pose freely.".into());
        lines
    }
}
