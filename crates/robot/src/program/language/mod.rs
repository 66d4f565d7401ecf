//! The controllers' languages, and the steps of a program that they write. Each language is one file with a table of what it
//! is, can and allows, its writer and, for the tests, its reader. A new one is a file like them and an entry in
//! [`RobotLanguage::ALL`].

mod drl;
mod jbi;
mod krl;
mod ls;
mod rapid;
mod urscript;

use std::{fmt, ops::RangeInclusive};

#[cfg(test)]
pub(super) use self::{drl::DRL, jbi::JBI, krl::KRL, ls::LS, rapid::RAPID, urscript::URSCRIPT};
use super::{Program, configuration::Posture, text::Lines};
use crate::{
    Convention,
    arm::{Arm, Joints},
};
use geometry::rigid::RigidTransform;

/// A controller's language.
pub struct RobotLanguage {
    /// Name on the command line.
    pub name: &'static str,
    /// Name shown to people.
    pub title: &'static str,
    /// Maker of the robots.
    pub maker: &'static str,
    /// Ending of its files, without the dot.
    pub ending: &'static str,
    /// Convention of its poses.
    pub convention: Convention,
    /// How it names the tool whose origin is the nozzle's mouth.
    pub tool: ToolName,
    /// Slowest and fastest speed, m/s.
    pub(super) speeds: [f64; 2],
    /// Numbers of its digital outputs.
    pub(super) outputs: RangeInclusive<u16>,
    /// Greatest blend radius at a point where the gun switches, metres; 0 if the robot has to stop there.
    pub(super) max_switching_blend: f64,
    /// Share of a blend after which the gun switches: 0 at its beginning, 0.5 in its middle.
    pub(super) switches_at: f64,
    /// Name of the rail's axis; none if the language has no external axes.
    pub(super) rail_axis: Option<&'static str>,
    /// Writes the configuration of an arm of this maker, or returns none if the language cannot express it; none if it has
    /// no words for configurations.
    pub(super) configuration: Option<fn(&Posture) -> Option<String>>,
    /// Most letters of a program's name.
    pub(super) max_name: usize,
    /// Words that no program can have as its name, separated by spaces.
    pub(super) reserved: &'static [&'static str],
    /// Whether case matters in them.
    pub(super) is_case_sensitive: bool,
    /// How its programs follow a line; none if that is not known.
    pub tracking: Option<Tracking>,
    /// How a path that is too long for one program is cut; none if programs are unlimited.
    pub(super) calls: Option<Calls>,
    /// Most letters of a comment, without the sign that begins it.
    pub(super) comment_width: usize,
    /// End of a line.
    pub(super) line_end: &'static str,
    /// Writes the steps with these comments as a program of this name.
    pub(super) write: fn(&Program<'_>, &[Step], &[String], &str) -> Lines,
    /// What the tests know of it.
    #[cfg(test)]
    pub(super) reader: super::tests::read::Reader,
}

/// How a language names the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolName {
    /// By a number from 1 to this one.
    Number(u8),
    /// By a name.
    Name,
    /// By a name, unless the program sets the nozzle's pose as its tool.
    NameOrNozzle,
    /// Not at all: the program sets the nozzle's pose as its tool, or uses the active one.
    Active,
}

impl ToolName {
    /// The tool if none is given.
    pub(super) fn standard(self) -> &'static str {
        match self {
            Self::Number(_) => "1",
            Self::Name | Self::NameOrNozzle | Self::Active => "tool1",
        }
    }

    /// Whether a program names its tool.
    pub(super) fn is_named(self, sets_nozzle: bool) -> bool {
        match self {
            Self::Number(_) | Self::Name => true,
            Self::NameOrNozzle => !sets_nozzle,
            Self::Active => false,
        }
    }
}

/// What moves the frame that follows a line.
pub struct Tracking {
    /// Its name, before its number.
    pub what: &'static str,
    /// Its numbers.
    pub(super) numbers: RangeInclusive<u8>,
}

/// How a long path is cut into programs that a main program calls.
pub(super) struct Calls {
    /// Most instructions of one program.
    pub(super) max_instructions: usize,
    /// Instructions for a switch of the gun besides the move.
    pub(super) num_switch_instructions: usize,
    /// Writes the program of this name, the last argument, that calls the programs of these names, the second one.
    pub(super) write: fn(&Program<'_>, &[String], &[String], &str) -> Lines,
}

/// One step of a program.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Step {
    /// Pose of the nozzle at its end, in the robot's base frame.
    pub(super) to: RigidTransform,
    /// Configuration of the arm there, in the controller's notation; none if not checked or not known.
    pub(super) configuration: Option<String>,
    /// Position of the rail that moves along the path, metres; none without one.
    pub(super) rail: Option<f64>,
    pub(super) motion: Motion,
}

/// Kind of move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// Joint move, slow, with the gun off; gun state from its end on, if it changes there.
    Joints(Option<bool>),
    /// Linear move.
    Line(Line),
}

/// A linear move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Speed, m/s.
    pub(super) speed: f64,
    /// Blend radius at its end, metres; 0 to stop at the point.
    pub(super) blend: f64,
    /// Gun state from its end on, if it changes there.
    pub(super) gun: Option<bool>,
}

impl Step {
    /// Gun state from its end on, if it changes there.
    pub(super) fn gun(&self) -> Option<bool> {
        match self.motion {
            Motion::Joints(gun) => gun,
            Motion::Line(line) => line.gun,
        }
    }

    pub(super) fn num_instructions(&self, calls: &Calls) -> usize {
        let is_switch = self.gun().is_some();
        1 + usize::from(is_switch) * calls.num_switch_instructions
    }
}

impl RobotLanguage {
    /// Every language; the first is the default.
    pub const ALL: [&'static Self; 6] = [
        &krl::KRL,
        &ls::LS,
        &rapid::RAPID,
        &urscript::URSCRIPT,
        &jbi::JBI,
        &drl::DRL,
    ];

    /// Endings of the files of all languages, without the dot.
    pub const ENDINGS: [&'static str; Self::ALL.len()] = {
        let mut endings = [""; Self::ALL.len()];
        let mut i = 0;
        while i < endings.len() {
            endings[i] = Self::ALL[i].ending;
            i += 1;
        }
        endings
    };

    /// Finds a language by its [`name`](Self::name).
    pub fn by_name(name: &str) -> Option<&'static Self> {
        Self::ALL.into_iter().find(|language| language.name == name)
    }

    /// The configuration of an arm with these joints in the controller's notation; `None` if it is not certain.
    pub(super) fn configuration_of(&self, arm: &Arm, joints: &Joints) -> Option<String> {
        let write = self.configuration?;
        if arm.maker != Some(self.convention) {
            return None;
        }
        write(&Posture::of(arm, joints))
    }

    /// True for a reserved word, and for a name that every controller already has.
    pub(super) fn is_reserved(&self, name: &str) -> bool {
        let mut words = self.reserved.iter().flat_map(|words| words.split(' '));
        if self.is_case_sensitive {
            words.any(|word| word == name)
        } else {
            words.any(|word| word.eq_ignore_ascii_case(name))
        }
    }
}

impl PartialEq for RobotLanguage {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for RobotLanguage {}

impl fmt::Debug for RobotLanguage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
