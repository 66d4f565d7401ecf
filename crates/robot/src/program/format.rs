//! The controllers' languages and their limits.

use std::path::Path;

use super::ProgramError;
use crate::Convention;

/// A controller's language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramFormat {
    /// KUKA Robot Language, one `.src` without `.dat`.
    Krl,
    /// FANUC's teach pendant program in ASCII form.
    Ls,
    /// ABB's RAPID module.
    Rapid,
    /// Universal Robots' script.
    UrScript,
    /// Yaskawa's job (INFORM).
    Jbi,
    /// Doosan Robot Language.
    Drl,
}

/// File endings of all formats, in their order, without the dot.
pub const PROGRAM_ENDINGS: [&str; 6] = ["src", "ls", "mod", "script", "jbi", "drl"];

impl ProgramFormat {
    /// Every format.
    pub const ALL: [Self; 6] = [
        Self::Krl,
        Self::Ls,
        Self::Rapid,
        Self::UrScript,
        Self::Jbi,
        Self::Drl,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Krl => "krl",
            Self::Ls => "ls",
            Self::Rapid => "rapid",
            Self::UrScript => "urscript",
            Self::Jbi => "jbi",
            Self::Drl => "drl",
        }
    }

    /// The name shown to people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Krl => "KUKA KRL",
            Self::Ls => "FANUC LS",
            Self::Rapid => "ABB RAPID",
            Self::UrScript => "URScript",
            Self::Jbi => "Yaskawa JBI",
            Self::Drl => "Doosan DRL",
        }
    }

    /// The ending of its files, without the dot.
    pub fn ending(self) -> &'static str {
        PROGRAM_ENDINGS[self as usize]
    }

    /// Finds the format by the file's ending.
    pub fn of(path: &Path) -> Result<Self, ProgramError> {
        let ending = path.extension().unwrap_or_default();
        let found = Self::ALL.into_iter();
        let mut found = found.filter(|format| ending.eq_ignore_ascii_case(format.ending()));
        found.next().ok_or_else(|| ProgramError::UnknownEnding {
            path: path.to_owned(),
        })
    }

    /// The convention of its poses.
    pub fn convention(self) -> Convention {
        match self {
            Self::Krl => Convention::Kuka,
            Self::Ls => Convention::Fanuc,
            Self::Rapid => Convention::Abb,
            Self::UrScript => Convention::UniversalRobots,
            Self::Jbi => Convention::Yaskawa,
            Self::Drl => Convention::Doosan,
        }
    }

    /// Most letters of a program's name; a RAPID procedure is called `run_` plus the name.
    pub(super) fn longest_name(self) -> usize {
        match self {
            Self::Krl => 24,
            Self::Rapid => 28,
            Self::Ls => 36,
            Self::Jbi => 32,
            Self::UrScript | Self::Drl => 64,
        }
    }

    /// Most instructions of one program; none if unlimited.
    pub(super) fn most_lines(self) -> Option<usize> {
        match self {
            Self::Ls | Self::Jbi => Some(9999),
            _ => None,
        }
    }

    /// Slowest and fastest speed, m/s.
    pub(super) fn speeds(self) -> [f64; 2] {
        match self {
            Self::Krl | Self::Ls => [0.001, 2.0],
            Self::Rapid => [0.001, 5.0],
            Self::UrScript => [0.001, 3.0],
            Self::Jbi => [0.001, 1.5],
            Self::Drl => [0.001, 1.0],
        }
    }

    /// Largest blend radius at a point where the gun switches, metres; 0 if the robot has to stop there.
    pub(super) fn switching_blend(self) -> f64 {
        match self {
            // The gun switches where the blend begins.
            Self::UrScript => 0.005,
            Self::Drl => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// Where within a blend the gun switches: 0 at its beginning, 0.5 in its middle.
    pub(super) fn switches_at(self) -> f64 {
        if self == Self::UrScript { 0.0 } else { 0.5 }
    }

    /// First and last number of its digital outputs.
    pub(super) fn outputs(self) -> [u16; 2] {
        match self {
            Self::Krl | Self::Jbi => [1, 4096],
            Self::Ls => [1, 512],
            Self::Rapid => [0, 9999],
            Self::UrScript => [0, 7],
            Self::Drl => [1, 16],
        }
    }

    /// Name of the rail's axis; none if the language has no external axes.
    pub(super) fn rail_axis(self) -> Option<&'static str> {
        match self {
            Self::Krl | Self::Ls => Some("E1"),
            Self::Rapid => Some("eax_a"),
            Self::Jbi => Some("BC, base axis 1"),
            Self::UrScript | Self::Drl => None,
        }
    }

    /// Largest number of a tool; none if tools have names.
    pub(super) fn most_tools(self) -> Option<u8> {
        match self {
            Self::Krl => Some(16),
            Self::Ls => Some(10),
            Self::Jbi => Some(63),
            _ => None,
        }
    }
}
