//! Why a program cannot be written.

use std::path::PathBuf;

use super::ProgramFormat;
use crate::{error::Advice, files::FileError, units::Metres};

/// Why a program cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The name of the file does not say which language.
    #[error("{}: the ending names no controller's language", path.display())]
    UnknownEnding {
        /// The file.
        path: PathBuf,
    },
    /// The controller takes no program of that name.
    #[error("{} takes no program called {name:?}", format.title())]
    Name {
        /// The language.
        format: ProgramFormat,
        /// The name.
        name: String,
        /// Most letters of the file's name, with which the programs that it calls are named as well.
        most: usize,
    },
    /// A path without points.
    #[error("the path has no points")]
    NoPoints,
    /// A number that is none.
    #[error("{} is infinite or not a number", if *point == 0 { "the pose of tool or part".into() } else { format!("the pose of point {point}") })]
    NotFinite {
        /// The point, from 1; 0 for tool or part.
        point: usize,
    },
    /// Slower or faster than the controller moves.
    #[error("point {point} asks for {:.1} mm/s, {} takes {:.0} to {:.0}", speed * 1000.0, format.title(), format.speeds()[0] * 1000.0, format.speeds()[1] * 1000.0)]
    Speed {
        /// The language.
        format: ProgramFormat,
        /// The point, from 1.
        point: usize,
        /// Its speed, m/s.
        speed: f64,
    },
    /// More instructions than one program holds, with the gun on.
    #[error("the gun stays on for {found} instructions, a program in {} holds {most} beside its header", format.title())]
    TooMany {
        /// The language.
        format: ProgramFormat,
        /// Instructions needed until the gun closes.
        found: usize,
        /// Instructions that it holds.
        most: usize,
    },
    /// No tool of the controller.
    #[error("{tool:?} is no tool of {}", format.title())]
    Tool {
        /// The language.
        format: ProgramFormat,
        /// What was given.
        tool: String,
    },
    /// The arm moves along a rail, which the language has no words for.
    #[error("{} has no axis for the arm's rail", format.title())]
    Rail {
        /// The language.
        format: ProgramFormat,
    },
    /// No output of the controller.
    #[error("{} has no digital output {output}", format.title())]
    Output {
        /// The language.
        format: ProgramFormat,
        /// The number.
        output: u16,
    },
    /// A length of the settings out of its range.
    #[error("a {name} of {value}, expected {:.0} to {:.0} mm", low.mm(), high.mm())]
    Length {
        /// Which.
        name: &'static str,
        /// What was given.
        value: Metres,
        /// The least.
        low: Metres,
        /// The most.
        high: Metres,
    },
}

impl Advice for ProgramError {
    fn advice(&self) -> String {
        match self {
            Self::File(error) => error.advice(),
            Self::UnknownEnding { .. } => {
                let known = ProgramFormat::ALL.map(|format| format!(".{}", format.ending()));
                format!(
                    "Let the file end in {}, or name the language with --robot-program-format",
                    known.join(", ")
                )
            }
            Self::Name { most, .. } => format!(
                "Name the file with letters A to Z, digits and _, a letter first, at most {most} of them"
            ),
            Self::NoPoints => "Give a path with at least one point".into(),
            Self::NotFinite { .. } => "Check the path, the tool and the calibration".into(),
            Self::Speed { .. } => "Change the speed in the path, or give another with --speed".into(),
            Self::TooMany { .. } => {
                "Plan the path with a larger point_spacing, or close the gun in between: a long path is cut where the gun is off".into()
            }
            Self::Tool { format, .. } => match format.most_tools() {
                Some(most) => format!("Give a number from 1 to {most} with --tool"),
                None => "Give the tool's name on the controller with --tool: letters, digits and _, a letter first".into(),
            },
            Self::Output { format, .. } => {
                let [low, high] = format.outputs();
                format!("Give a number from {low} to {high} with --gun-output")
            }
            Self::Rail { .. } => {
                "Leave out the rail's speed so that it stands still, or write the program for KUKA, FANUC, ABB or Yaskawa".into()
            }
            Self::Length { .. } => "Give a length in millimetres within this range".into(),
        }
    }
}
