//! What the settings keep of the robot: what its programs are written for, how it is servoed, and how it is answered.

use std::{
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::inspection::report_files::ProgramTarget;
use files::file_name;
use geometry::{oriented_box::OrientedBox, rigid::RigidTransform, units::Metres};
use inspection::pipeline::parameters::Parameters as _;
use records::history::ServoTargetKind;
use robot::{
    Convention,
    arm::{ARM_NAMES, Arm, ArmError, Obstacles},
    parse_nozzle,
    program::{ProgramParams, ProgramSettings, RobotLanguage},
};
use serve::{ListenAddress, ListenError, Listener, PoseKind, Protocol};
use servo::{ServoError, ServoParams, simulated::StreamProtocol};
use ui::{
    language::{text, what_and_advice},
    user_error::UserError,
};

/// The arm, the nozzle and the gun that robot programs are written for, and the obstacles that they avoid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProgramSetup {
    /// Name or TOML file of the arm; `None`: reach is not checked.
    pub arm: Option<String>,
    /// Pose of the nozzle on the flange, as typed: `kuka X Y Z A B C`, or the 16 numbers of a matrix.
    pub nozzle: String,
    /// Pose of the arm's base in the frame of the calibration, as KUKA writes it: X, Y, Z in mm, then A, B, C in degrees.
    pub base: [f64; 6],
    /// The rail that the arm stands on, as typed: axis, from, to and, if it moves along the path, top speed and acceleration,
    /// such as `y,-2000,2000,1000,2000`; empty: the rail of the arm's file.
    pub rail: String,
    /// TOML file with the boxes of the cell and its floor; `None`: only the part is an obstacle.
    pub obstacles: Option<String>,
    /// The tool on the controller; empty: the controller's first.
    pub tool: String,
    /// The numbers.
    #[serde(flatten)]
    pub params: ProgramParams,
}

impl ProgramSetup {
    /// Valid values of the number of `base` at this index.
    pub fn base_range(index: usize) -> RangeInclusive<f64> {
        if index < 3 {
            -100_000.0..=100_000.0
        } else {
            -180.0..=180.0
        }
    }

    /// Replaces each number out of its range, as a file may contain, by its default; returns the keys of the replaced ones.
    ///
    /// NaN never equals itself, so that settings would be written and the reach checked without end.
    pub(crate) fn replace_unusable(&mut self) -> Vec<&'static str> {
        let default = ProgramParams::default();
        let mut replaced = Vec::new();
        for row in ProgramParams::ALL {
            let value = row.value(&self.params);
            if row.set(&mut self.params, value).is_err() {
                row.copy(&default, &mut self.params);
                replaced.push(row.key);
            }
        }
        for (index, value) in self.base.iter_mut().enumerate() {
            if !Self::base_range(index).contains(value) {
                *value = 0.0;
                replaced.push("base");
            }
        }
        replaced.dedup();
        replaced
    }

    /// Title of the arm, or the name of its file, which is not read because the window asks every frame.
    pub fn arm_title(&self) -> Option<String> {
        let arm = self.arm.as_deref()?;
        let known = ARM_NAMES.contains(&arm).then(|| Arm::named(arm));
        Some(match known {
            Some(Ok(arm)) => arm.name,
            Some(Err(_)) | None => file_name(Path::new(arm)),
        })
    }

    /// Name of the file of obstacles.
    pub fn obstacles_title(&self) -> Option<String> {
        let file = self.obstacles.as_deref()?;
        Some(file_name(Path::new(file)))
    }

    /// Reads the boxes and the floor of the cell.
    fn boxes(&self) -> Result<Obstacles, UserError> {
        let file = self.obstacles.as_deref().map(Path::new);
        let read = file.map(Obstacles::read).transpose();
        let read = read.map_err(|error| UserError::of(&error))?;
        Ok(read.unwrap_or_default())
    }

    /// Loads an arm and puts it on the rail.
    fn arm_on_rail(&self, name: &str) -> Result<Arm, ArmError> {
        let mut arm = Arm::named(name)?;
        if !self.rail.trim().is_empty() {
            arm.rail = Some(self.rail.parse()?);
        }
        Ok(arm)
    }

    /// Parses the pose of the nozzle on the flange; `None` if nothing was typed.
    fn flange_from_nozzle(&self) -> Result<Option<RigidTransform>, UserError> {
        if self.nozzle.trim().is_empty() {
            return Ok(None);
        }
        let written =
            parse_nozzle(&self.nozzle).map_err(|error| UserError::from(what_and_advice(&error)))?;
        Ok(Some(written.pose))
    }

    /// Why the nozzle's pose cannot be used: it is wrong, or missing although there is an arm.
    pub fn nozzle_error(&self) -> Option<UserError> {
        match self.flange_from_nozzle() {
            Ok(None) if self.arm.is_some() => Some(UserError {
                what: text!("program-no-nozzle"),
                advice: text!("program-no-nozzle-advice"),
            }),
            Ok(_) => None,
            Err(error) => Some(error),
        }
    }

    /// Returns the settings of a program, and the arm whose reach is checked. The part is not among its obstacles yet.
    pub fn target(&self) -> Result<ProgramTarget, UserError> {
        if let Some(error) = self.nozzle_error() {
            return Err(error);
        }
        let tool = self.tool.trim();
        let flange_from_nozzle = self.flange_from_nozzle()?;
        let arm = match self.arm.as_deref().zip(flange_from_nozzle) {
            None => None,
            Some((name, flange_from_nozzle)) => {
                let arm = self.arm_on_rail(name);
                let base = Convention::Kuka.read(&self.base);
                Some(self.params.place(
                    arm.map_err(|error| UserError::of(&error))?,
                    base.map_err(|error| UserError::of(&error))?,
                    flange_from_nozzle,
                    self.boxes()?,
                ))
            }
        };
        let settings = ProgramSettings {
            tool: (!tool.is_empty()).then(|| tool.to_owned()),
            flange_from_nozzle,
            tracking: None,
            params: self.params,
        };
        Ok(ProgramTarget { settings, arm })
    }
}

/// Suggests the name of a program, with the ending that the arm's maker uses, else the robot that the convention belongs to.
pub fn program_file_name(part: &str, setup: &ProgramSetup, convention: Convention) -> String {
    // The titles of arms begin with the maker.
    let arm = setup.arm_title().unwrap_or_default();
    let maker = arm.split(' ').next().unwrap_or_default();
    let [default, ..] = RobotLanguage::ALL;
    let all = || RobotLanguage::ALL.into_iter();
    let of_arm = all().find(|language| language.maker.eq_ignore_ascii_case(maker));
    let language = of_arm
        .or_else(|| all().find(|language| language.convention == convention))
        .unwrap_or(default);
    format!("{part}.{}", language.ending)
}

/// What is servoed: the part, its target, the robot, and limits. Arm, nozzle and obstacles are those of [`ProgramSetup`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ServoSettings {
    /// Name of the part; `None`: the first of the library.
    pub part: Option<String>,
    /// What is to be reached; a simulated robot is always brought to the standard position.
    pub target: ServoTargetKind,
    /// Frames of the part, taken where the camera should stand, for a recorded camera pose.
    pub seen_as: Vec<PathBuf>,
    /// Protocol of the robot; `None`: a simulated one.
    pub robot: Option<StreamProtocol>,
    /// Its address, as typed: `IP:PORT` of this computer, or `IP` of Universal Robots.
    pub address: String,
    /// Greatest speed, mm/s.
    pub speed: f64,
    /// Greatest error at the end with its bounds, mm.
    pub tolerance: f64,
    /// Least distance from part and obstacles, mm.
    pub clearance: f64,
    /// Box of the base frame that flange, camera and nozzle never leave.
    pub volume: Option<OrientedBox>,
    /// True if each step waits until it is allowed.
    pub in_steps: bool,
}

impl Default for ServoSettings {
    fn default() -> Self {
        let params = ServoParams::default();
        Self {
            part: None,
            target: ServoTargetKind::StandardPosition,
            seen_as: Vec::new(),
            robot: None,
            address: String::new(),
            speed: 1000.0 * params.limits.speed,
            tolerance: params.tolerance.shift.mm(),
            clearance: params.clearance.mm(),
            volume: None,
            in_steps: false,
        }
    }
}

impl ServoSettings {
    /// The parameters with these limits.
    pub fn params(&self) -> Result<ServoParams, ServoError> {
        let [tolerance, clearance] = [self.tolerance, self.clearance].map(Metres::from_mm);
        ServoParams::limited(self.speed, tolerance, clearance)
    }

    /// Replaces each number out of its range, as a file may contain, by its default; returns the keys of the replaced ones.
    pub(crate) fn replace_unusable(&mut self) -> Vec<&'static str> {
        let default = Self::default();
        let mut replaced = Vec::new();
        for (key, value, range, usual) in [
            (
                "speed",
                &mut self.speed,
                ServoParams::SPEEDS_MM_S,
                default.speed,
            ),
            (
                "tolerance",
                &mut self.tolerance,
                ServoParams::TOLERANCES_MM,
                default.tolerance,
            ),
            (
                "clearance",
                &mut self.clearance,
                ServoParams::CLEARANCES_MM,
                default.clearance,
            ),
        ] {
            if !range.contains(&*value) {
                *value = usual;
                replaced.push(key);
            }
        }
        if self.volume.is_some_and(|volume| !volume.is_sound()) {
            self.volume = None;
            replaced.push("volume");
        }
        replaced
    }
}

/// The default port, as in `partsight serve`.
const PORT: u16 = 30100;

/// Whether and where robots are answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct AnswerSetup {
    /// Whether robots are answered.
    pub is_on: bool,
    /// Protocol and address to listen on.
    pub at: ListenAddress,
    /// Which pose the robots get.
    pub pose: PoseKind,
    /// The convention of the poses, where the protocol does not fix it.
    pub convention: Convention,
}

impl AnswerSetup {
    /// Where a server with these settings listens, and in which convention it answers.
    pub fn listener(&self) -> Result<Listener, ListenError> {
        Listener::new(self.at, Some(self.convention))
    }

    /// True if robots would read other numbers from these settings than from `other`.
    pub(super) fn changes_poses(&self, other: &Self) -> bool {
        let convention = |setup: &Self| setup.listener().ok().map(|listener| listener.convention);
        self.pose != other.pose || convention(self) != convention(other)
    }
}

impl Default for AnswerSetup {
    fn default() -> Self {
        Self {
            is_on: false,
            at: ListenAddress {
                protocol: Protocol::Ascii,
                address: ([127, 0, 0, 1], PORT).into(),
            },
            pose: PoseKind::default(),
            convention: Convention::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use robot::parse_written_pose;
    use ui::language::Language;

    #[test]
    fn the_title_of_an_arm_is_had_without_its_file() {
        let title = |arm: &str| {
            let setup = ProgramSetup {
                arm: Some(arm.into()),
                ..ProgramSetup::default()
            };
            setup.arm_title().expect("a title")
        };
        assert_eq!(title("gp25"), Arm::named("gp25").expect("known").name);
        assert_eq!(title("no such folder/cell_3.toml"), "cell_3.toml");
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("arm.toml");
        std::fs::write(&file, "name = \"Cell 3\"\n").expect("written");
        assert_eq!(title(&file.display().to_string()), "arm.toml");
        assert_eq!(ProgramSetup::default().arm_title(), None);
    }

    #[test]
    fn a_program_has_the_ending_of_the_arms_maker_else_of_the_convention() {
        let name = |arm: Option<&str>, convention| {
            let setup = ProgramSetup {
                arm: arm.map(str::to_owned),
                ..ProgramSetup::default()
            };
            program_file_name("door", &setup, convention)
        };
        for (arm, expected) in [
            ("kr6-r900", "door.src"),
            ("m-20ia", "door.ls"),
            ("irb2600", "door.mod"),
            ("irb4600", "door.mod"),
            ("gp25", "door.jbi"),
        ] {
            assert_eq!(name(Some(arm), Convention::Kuka), expected);
        }
        assert_eq!(name(Some("cell.toml"), Convention::Abb), "door.mod");
        assert_eq!(name(None, Convention::Doosan), "door.drl");
    }

    #[test]
    fn what_is_wrong_with_the_nozzle_is_said_in_the_language_of_the_window() {
        let setup = ProgramSetup {
            nozzle: "kuka 0 0 0.25 0 45 0".into(),
            ..ProgramSetup::default()
        };
        Language::German.make_current();
        let error = setup.nozzle_error();
        Language::English.make_current();
        let error = error.expect("a nozzle that no gun has");
        assert!(
            error.what.starts_with("die Düse ist 0.250 mm "),
            "{error:?}"
        );
        assert!(error.advice.starts_with("Ihre Position"), "{error:?}");
    }

    #[test]
    fn the_base_is_that_of_the_same_numbers_on_the_command_line() {
        let placed = |base: [f64; 6]| {
            let setup = ProgramSetup {
                arm: Some("gp25".into()),
                nozzle: "kuka 0 0 250 0 45 0".into(),
                base,
                ..ProgramSetup::default()
            };
            let target = setup.target().expect("an arm that is placed");
            target.arm.expect("an arm").robot_from_base
        };
        // Exactly, or the program's header names a base that differs from the calibration's.
        assert_eq!(placed([0.0; 6]), RigidTransform::identity());
        let written = parse_written_pose("kuka 1200 -400.5 30 90 0 180").expect("a pose");
        assert_eq!(
            placed([1200.0, -400.5, 30.0, 90.0, 0.0, 180.0]),
            written.pose
        );
    }

    #[test]
    fn the_rail_that_is_written_is_the_arms_and_a_wrong_one_is_refused() {
        let on = |rail: &str| {
            let setup = ProgramSetup {
                arm: Some("gp25".into()),
                nozzle: "kuka 0 0 250 0 45 0".into(),
                rail: rail.into(),
                ..ProgramSetup::default()
            };
            let target = setup.target()?;
            Ok::<_, UserError>(target.arm.expect("an arm").arm.rail)
        };
        assert_eq!(on(" ").expect("no rail"), None);
        let rail = on("y,-2000,1500,800").expect("a rail").expect("a rail");
        assert_eq!((rail.range, rail.speed), ([-2.0, 1.5], Some(0.8)));
        let rail = on("y,-2000,1500,800,2500").expect("a rail");
        assert_eq!(rail.expect("a rail").acceleration, Some(2.5));
        let error = on("sideways").expect_err("no rail");
        assert!(error.what.contains("sideways"), "{}", error.what);
    }
}
