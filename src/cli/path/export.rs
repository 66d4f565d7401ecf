//! `partsight path export`: writes the stored path of a part in its standard position as a program for the robot's
//! controller.

use crate::cli::input::parse_name;
use std::path::PathBuf;

use clap::Args;

use super::stored_path;
use crate::cli::{
    LibraryChoice, Outcome,
    calibrate::{CalibrationChoice, no_calibration},
    console::{Advised as _, Console},
    program::{ProgramOptions, language_help, parse_language},
    read_part,
};
use geometry::rigid::RigidTransform;
use inspection::library::PartName;
use robot::{
    program::RobotLanguage,
    spray::{carry, off_the_part},
};
use stages::stand_off::StandOffParams;
use station::robot_file::{RobotFile, remove_previous};

/// Write the stored path of a part, hung as it was enrolled, as a program for the robot's controller
#[derive(Debug, Args)]
pub(super) struct ExportArgs {
    /// Name of the part
    #[arg(value_parser = parse_name)]
    part: PartName,
    #[arg(long = "as", value_name = "FORMAT", value_parser = parse_language, help = language_help())]
    language: Option<&'static RobotLanguage>,
    /// File of the program, which is named like it. An earlier program of that name is removed first
    #[arg(id = "program", long = "output", short = 'o', value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    options: ProgramOptions,
    #[command(flatten)]
    calibration: CalibrationChoice,
}

pub(super) fn run(
    choice: &LibraryChoice,
    args: &ExportArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let name = &args.part;
    // Whatever happens next, no robot may run an earlier program for this one.
    remove_previous(&args.output).advised()?;
    let Some(frame) = args.calibration.frame(console)? else {
        return Err(no_calibration("a program"));
    };
    let program = args.options.open(&args.output, args.language)?;
    let place = choice.open(console)?;
    let path = stored_path(&place, name)?;
    let part = read_part(&place, name)?;
    // In the standard position, part space is the camera frame.
    let standard = RigidTransform::identity();
    let params = StandOffParams::default();
    let carried = carry(&path, &standard, &part.reference.cloud, &params);
    let file = RobotFile {
        file: &args.output,
        content: program.content(),
        carried: &carried,
        frame: &frame,
        part: name.as_str(),
        part_cloud: &part.reference.cloud,
        coverage: part.meta.coverage,
        side: part.meta.side,
        path: Some(&path),
        off: off_the_part(&path, &part.reference),
        capture: None,
        beside: &[],
        camera_from_part: standard,
        is_stored: true,
        is_simulated: part.meta.simulated,
        is_forced: args.options.force,
    };
    program.write(&file, console)
}
