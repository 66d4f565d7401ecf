//! Errors of writing a program.

use std::path::PathBuf;

use super::{RobotLanguage, ToolName};
use files::FileError;
use geometry::{error::Advice, units::any_of};

/// Why a program cannot be written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ProgramError {
    /// The file cannot be written.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The file's ending is not that of a controller's language.
    #[error("{}: the ending does not stand for a controller's language", path.display())]
    #[advice(
        "End the file's name in {}, or choose the language with --robot-program-format (path export: --as)",
        RobotLanguage::ENDINGS.map(|ending| format!(".{ending}")).join(", ")
    )]
    UnknownEnding {
        /// The file.
        path: PathBuf,
    },
    /// The controller does not accept a program of this name.
    #[error("{} does not accept a program named {name:?}", language.title)]
    #[advice = "Name the file with letters A to Z, digits and _, a letter first, at most {most} of them"]
    Name {
        /// The language.
        language: &'static RobotLanguage,
        /// The name.
        name: String,
        /// Most letters of the file's name, from which the names of called programs are made.
        most: usize,
    },
    /// The name is a word of the language.
    #[error("{name} is a reserved word of {}, so no program can have this name", language.title)]
    #[advice = "Give the file another name, for example paint_{name}"]
    Reserved {
        /// The language.
        language: &'static RobotLanguage,
        /// The name.
        name: String,
    },
    /// The path has no points.
    #[error("the path has no points")]
    #[advice = "Give a path with at least one point"]
    NoPoints,
    /// A pose has a number that is not finite.
    #[error("{} is infinite or not a number", if *point == 0 { "the pose of tool, part or frame".into() } else { format!("the pose of point {point}") })]
    #[advice = "Check the path, the tool and the calibration"]
    NotFinite {
        /// The point, from 1; 0 for tool, part or frame.
        point: usize,
    },
    /// A speed outside the controller's range.
    #[error("point {point} asks for {:.1} mm/s, but {} accepts {:.0} to {:.0}", speed * 1000.0, language.title, language.speeds[0] * 1000.0, language.speeds[1] * 1000.0)]
    #[advice = "Change the speed in the path, or give another with --speed"]
    Speed {
        /// The language.
        language: &'static RobotLanguage,
        /// The point, from 1.
        point: usize,
        /// Its speed, m/s.
        speed: f64,
    },
    /// More instructions between two places with the gun off than one program holds.
    #[error("the gun stays on for {found} instructions, but a program in {} holds at most {most} besides its header", language.title)]
    #[advice = "Plan the path with a larger point_spacing, or close the gun in between: a long path is cut where the gun is off"]
    TooMany {
        /// The language.
        language: &'static RobotLanguage,
        /// Instructions until the gun closes.
        found: usize,
        /// Instructions that a program holds beside its header.
        most: usize,
    },
    /// Not a tool of the controller.
    #[error("{tool:?} is not a tool of {}", language.title)]
    #[advice(match language.tool {
        ToolName::Number(most) => format!("Give a number from 1 to {most} with --tool"),
        _ => "Give the tool's name on the controller with --tool: letters, digits and _, a letter first".into(),
    })]
    Tool {
        /// The language.
        language: &'static RobotLanguage,
        /// The tool given.
        tool: String,
    },
    /// A tool was given, but the program sets the nozzle's pose as its tool, or uses the active one.
    #[error("a program in {} does not use the tool {tool:?}: it uses the pose of the nozzle{}", language.title, if language.tool == ToolName::Active { ", or the active TCP" } else { "" })]
    #[advice(if language.tool == ToolName::Active {
        "Leave out the tool (--tool). Give the nozzle's pose (--nozzle), or activate the TCP on the controller"
    } else {
        "Leave out the tool (--tool), or the nozzle's pose (--nozzle) to use the controller's tool"
    })]
    UnusedTool {
        /// The language.
        language: &'static RobotLanguage,
        /// The tool given.
        tool: String,
    },
    /// The arm moves along a rail, but the language has no axis for it.
    #[error("{} has no axis for the arm's rail", language.title)]
    #[advice(
        "Leave out the rail's speed so that it stands still, or write the program for {}",
        makers(|language| language.rail_axis.is_some())
    )]
    Rail {
        /// The language.
        language: &'static RobotLanguage,
    },
    /// The arm changes its configuration in a joint move, which the language cannot name for this arm.
    #[error("on the way to point {point} {arm} changes its configuration, which a program in {} cannot name", language.title)]
    #[advice = "Write the program for the controller of the arm's maker, or move the arm's base until no such move is needed"]
    Configuration {
        /// The language.
        language: &'static RobotLanguage,
        /// The point, from 1.
        point: usize,
        /// Name of the arm.
        arm: String,
    },
    /// No program in the language follows a line.
    #[error("no program in {} is written for a frame that moves with a line", language.title)]
    #[advice(
        "Write it for {}, or leave --tracking out and stop the line while the robot works",
        makers(|language| language.tracking.is_some())
    )]
    NoTracking {
        /// The language.
        language: &'static RobotLanguage,
    },
    /// Not a number of what moves such a frame.
    #[error("{} has no {} {number} that moves a frame", language.title, language.tracking.as_ref().map_or("", |tracking| tracking.what))]
    #[advice(match &language.tracking {
        Some(tracking) => {
            let numbers = &tracking.numbers;
            format!("Give a number from {} to {} with --tracking", numbers.start(), numbers.end())
        }
        None => String::new(),
    })]
    TrackingNumber {
        /// The language.
        language: &'static RobotLanguage,
        /// The number given.
        number: u8,
    },
    /// An arm was checked to reach the path where the part stands, but it will follow the part.
    #[error("whether an arm that follows a line reaches the path is not checked")]
    #[advice = "Leave out --arm, and run the program without paint on a slow line first; or leave out --tracking, for a part that stands still"]
    TrackedReach,
    /// The path is too long, and a program that follows a line is not split.
    #[error("the path takes {found} instructions, but a program in {} holds at most {most}, and one that follows a line is not split", language.title)]
    #[advice = "Plan the path with a larger point_spacing"]
    TrackedTooMany {
        /// The language.
        language: &'static RobotLanguage,
        /// Instructions of the path.
        found: usize,
        /// Instructions that a program holds.
        most: usize,
    },
    /// Not a digital output of the controller.
    #[error("{} has no digital output {output}", language.title)]
    #[advice("Give a number from {} to {} with --gun-output", language.outputs.start(), language.outputs.end())]
    Output {
        /// The language.
        language: &'static RobotLanguage,
        /// Number of the output.
        output: u16,
    },
    /// A length of the settings is out of its range.
    #[error("a {name} of {value:.1} mm, expected {} to {} mm", range[0], range[1])]
    #[advice = "Give a length in millimetres within this range"]
    Length {
        /// Name of the length.
        name: &'static str,
        /// The value given, mm.
        value: f64,
        /// Least and greatest value, mm.
        range: [f64; 2],
    },
}

/// The makers of the controllers whose language `has` something.
fn makers(has: fn(&RobotLanguage) -> bool) -> String {
    let languages = RobotLanguage::ALL.into_iter();
    let makers = languages.filter(|language| has(language));
    let makers: Vec<&str> = makers.map(|language| language.maker).collect();
    any_of(&makers)
}
