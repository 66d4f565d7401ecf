//! Programs for a robot's controller, as written by `inspect --program` and `path export`.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, error::ErrorKind};

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::{parse_nozzle_pose, parse_robot_pose, within},
    robot_file,
};
use geometry::{rigid::RigidTransform, units::any_of};
use inspection::pipeline::parameters::{DisplayUnit, Kind, Parameter, Parameters as _};
use robot::{
    WrittenPose,
    arm::{Arm, Obstacles, PlacedArm, Rail},
    program::{
        ProgramGroup, ProgramParams, ProgramSettings, RobotLanguage, ToolName, TrackingFrame,
    },
};
use station::robot_file::{RobotFile, RobotFileContent};

/// Tool, gun and arm of a program; the command names its file `program`.
#[derive(Debug, Args)]
pub(super) struct ProgramOptions {
    #[arg(long, value_name = "TOOL", requires = "program", help = tool_help())]
    tool: Option<String>,
    /// Pose of the nozzle on the flange, with z in its direction: `kuka X Y Z A B C`, or the 16 numbers of a matrix
    #[arg(long, value_name = "POSE", value_parser = parse_nozzle_pose, allow_hyphen_values = true, requires = "program")]
    nozzle: Option<WrittenPose>,
    /// Check that this arm reaches the path: a name, or a TOML file; needs --nozzle
    #[arg(long, value_name = "ARM", requires_all = ["program", "nozzle"])]
    arm: Option<String>,
    #[command(flatten)]
    cell: CellChoice,
    #[command(flatten)]
    tracking: TrackingChoice,
    #[command(flatten)]
    params: ParamOptions<true>,
    /// Write the file, or give the pose for the robot, despite doubts about part, path, capture or reach; both name them
    #[arg(long)]
    pub(super) force: bool,
}

/// The line that a program follows.
#[derive(Debug, Args)]
struct TrackingChoice {
    #[arg(long, value_name = "N", requires_all = ["program", "tracking_frame"], conflicts_with = "arm", help = tracking_help())]
    tracking: Option<u8>,
    /// Pose of the frame that the line moves, in the calibration's frame, while the part is where the path is: for `inspect`
    /// at the count of the capture, for `path export` as the part passes its standard position. x is the direction of the line
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true, requires = "tracking")]
    tracking_frame: Option<WrittenPose>,
}

fn tool_help() -> String {
    let of = |is_so: fn(ToolName) -> bool| {
        let languages = RobotLanguage::ALL.into_iter();
        let makers = languages.filter(|language| is_so(language.tool));
        any_of(&makers.map(|language| language.maker).collect::<Vec<_>>())
    };
    format!(
        "The tool on the controller: a number for {}, a name for {} and, without --nozzle, for {}",
        of(|tool| matches!(tool, ToolName::Number(_))),
        of(|tool| tool == ToolName::Name),
        of(|tool| tool == ToolName::NameOrNozzle)
    )
}

fn tracking_help() -> String {
    let languages = RobotLanguage::ALL.into_iter();
    let lines = languages.filter_map(|language| {
        let what = language.tracking.as_ref()?.what;
        Some(format!("the {what} ({})", language.maker))
    });
    format!(
        "Follow a line that carries the part: the number of {} on the controller. The reach of an arm is not checked then",
        any_of(&lines.collect::<Vec<_>>())
    )
}

impl TrackingChoice {
    fn frame(&self) -> Option<TrackingFrame> {
        let (number, written) = self.tracking.zip(self.tracking_frame.as_ref())?;
        Some(TrackingFrame {
            number,
            robot_from_frame: written.pose,
        })
    }
}

/// Where an arm stands, and the obstacles besides the part.
#[derive(Debug, Args)]
pub(super) struct CellChoice {
    /// Pose of the arm's base in the calibration's frame; default: the two frames are the same
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true, requires = "arm")]
    pub(super) base: Option<WrittenPose>,
    /// Rail that the arm stands on: its axis in the calibration's frame (x, y, z, -x, -y or -z), its start and end in
    /// mm from where the cell was calibrated and, if the arm moves along it on the path, its maximum speed in mm/s and
    /// acceleration in mm/s², as in y,-2000,2000,1000,2000. Overrides the rail in the arm's file
    #[arg(
        long,
        value_name = "AXIS,FROM,TO[,SPEED[,ACCELERATION]]",
        allow_hyphen_values = true,
        requires = "arm"
    )]
    rail: Option<String>,
    /// TOML file with the boxes and floor of the cell that gun and arm must not run into. The part is checked in any
    /// case
    #[arg(long, value_name = "FILE", requires = "arm")]
    obstacles: Option<PathBuf>,
}

impl CellChoice {
    /// Places an arm in this cell.
    pub(super) fn place(
        &self,
        mut arm: Arm,
        flange_from_nozzle: RigidTransform,
        params: &ProgramParams,
    ) -> anyhow::Result<PlacedArm> {
        if let Some(rail) = &self.rail {
            arm.rail = Some(rail.parse::<Rail>().advised()?);
        }
        let obstacles = self.obstacles.as_deref().map(Obstacles::read);
        let obstacles = obstacles.transpose().advised()?.unwrap_or_default();
        let base = self.base.as_ref();
        let robot_from_base = base.map_or_else(RigidTransform::identity, |base| base.pose);
        Ok(params.place(arm, robot_from_base, flange_from_nozzle, obstacles))
    }
}

/// The numbers of a program as options, each made from its row of the table: all of them if a program is written, else those
/// that matter to the check of an arm.
#[derive(Debug)]
pub(super) struct ParamOptions<const IS_WRITTEN: bool>(pub(super) ProgramParams);

impl<const IS_WRITTEN: bool> Args for ParamOptions<IS_WRITTEN> {
    fn augment_args(command: Command) -> Command {
        let rows = ProgramParams::ALL.iter();
        let rows = rows.filter(|row| IS_WRITTEN || row.group != ProgramGroup::Program);
        command.args(rows.map(|row| match row.group {
            _ if !IS_WRITTEN => argument(row),
            ProgramGroup::Program | ProgramGroup::Moves => argument(row).requires("program"),
            ProgramGroup::Arm => argument(row).requires("arm"),
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<const IS_WRITTEN: bool> FromArgMatches for ParamOptions<IS_WRITTEN> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut options = Self(ProgramParams::default());
        options.update_from_arg_matches(matches)?;
        Ok(options)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        for row in ProgramParams::ALL {
            // A command that writes no program has fewer options.
            if let Ok(Some(value)) = matches.try_get_one::<f64>(row.key) {
                row.set(&mut self.0, *value)
                    .map_err(|error| clap::Error::raw(ErrorKind::ValueValidation, error))?;
            }
        }
        Ok(())
    }
}

/// Makes the option of a number.
fn argument(row: &'static Parameter<ProgramParams>) -> Arg {
    let Kind::Number(number) = &row.kind else {
        unreachable!("{} is a number", row.key);
    };
    let [least, most] = number.range;
    let help = format!(
        "{} ({}) [default: {}]",
        row.help,
        row.range_text(),
        row.value(&ProgramParams::default())
    );
    // clap keeps names for as long as the program runs.
    let name: &'static str = row.key.replace('_', "-").leak();
    Arg::new(row.key)
        .long(name)
        .help(help)
        .value_name(match number.unit {
            DisplayUnit::Millimetres => "MM",
            DisplayUnit::MillimetresPerSecond => "MM/S",
            DisplayUnit::Degrees => "DEG",
            _ => "N",
        })
        .allow_negative_numbers(true)
        .value_parser(move |text: &str| {
            let value = within(text, &(least..=most))?;
            if number.decimals == 0 && value.fract() != 0.0 {
                return Err(format!("expected a whole number, {least} to {most}"));
            }
            Ok(value)
        })
}

/// Parses the name of a language.
pub(super) fn parse_language(name: &str) -> Result<&'static RobotLanguage, String> {
    RobotLanguage::by_name(name).ok_or_else(|| {
        let names = RobotLanguage::ALL.map(|language| language.name);
        format!("expected one of {}", names.join(", "))
    })
}

/// Describes the option that chooses the language.
pub(super) fn language_help() -> String {
    let names = RobotLanguage::ALL.map(|language| language.name);
    format!(
        "Language of the program, if the file's ending does not give it: {}",
        any_of(&names)
    )
}

/// Language, tool and arm of a program to write.
pub(super) struct ChosenProgram {
    language: &'static RobotLanguage,
    settings: ProgramSettings,
    arm: Option<PlacedArm>,
}

impl ProgramOptions {
    /// Prepares a program in this format, or in that of the file's ending. The ending must not be that of another
    /// language.
    pub(super) fn open(
        &self,
        file: &Path,
        language: Option<&'static RobotLanguage>,
    ) -> anyhow::Result<ChosenProgram> {
        let language = match (language, RobotLanguage::from_file(file)) {
            (Some(language), Ok(other)) if language != other => {
                return Err(advised_error(
                    format!(
                        "{} was requested as {}, but its ending is that of {}",
                        file.display(),
                        language.title,
                        other.title
                    ),
                    format!(
                        "End the file's name in .{}, or choose the language {}",
                        language.ending, other.name
                    ),
                ));
            }
            (Some(language), _) => language,
            (None, of_file) => of_file.advised()?,
        };
        let nozzle = self.nozzle.as_ref().map(|written| written.pose);
        let arm = self.arm.as_deref().map(Arm::named).transpose().advised()?;
        let arm = arm.zip(nozzle);
        let arm = arm.map(|(arm, nozzle)| self.cell.place(arm, nozzle, &self.params.0));
        let arm = arm.transpose()?;
        Ok(ChosenProgram {
            language,
            settings: ProgramSettings {
                tool: self.tool.clone(),
                flange_from_nozzle: nozzle,
                tracking: self.tracking.frame(),
                params: self.params.0,
            },
            arm,
        })
    }
}

impl ChosenProgram {
    /// What the file of the program contains.
    pub(super) fn content(&self) -> RobotFileContent<'_> {
        RobotFileContent::Program {
            language: self.language,
            settings: &self.settings,
            arm: self.arm.as_ref(),
        }
    }

    /// Writes a file with this content, unless there are doubts and it is not forced.
    pub(super) fn write(&self, file: &RobotFile<'_>, console: &Console) -> anyhow::Result<Outcome> {
        if robot_file::write(file, console)?.is_none() {
            return Ok(Outcome::NotAccepted);
        }
        let base = self.arm.as_ref().map(|arm| arm.robot_from_base);
        if base.is_some_and(|base| base != RigidTransform::identity()) {
            console.note(&"  its poses are in the frame of the calibration; --base only affects the check. If the controller's frame moves with the base, calibrate the cell again and leave --base out");
        }
        Ok(Outcome::Accepted)
    }
}
