//! `partsight inspect --program`: writes the part's spray path as a program for the robot's controller.

use std::path::PathBuf;

use clap::Args;
use nalgebra::Point3;

use super::spray::check_placed_part;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error, store_a_path},
    program::{ProgramFile, ProgramOptions, ProgramSubject, language_help, parse_language},
    robot_file::refuse_inspection,
};
use geometry::units::any_of;
use inspection::library::{Library, LibraryLoad, LibraryPlace, PartMeta};
use robot::{RobotFrame, program::RobotLanguage, spray::carry};
use station::{Inspected, robot_file::remove_previous_of_parts};

/// Whether and how a program is written.
#[derive(Debug, Args)]
pub(super) struct ProgramChoice {
    #[arg(long, value_name = "FILE", help = program_help())]
    program: Option<PathBuf>,
    #[arg(long, value_name = "FORMAT", value_parser = parse_language, requires = "program", help = language_help())]
    robot_program_format: Option<&'static RobotLanguage>,
    #[command(flatten)]
    options: ProgramOptions,
}

/// Describes `--program`.
fn program_help() -> String {
    let endings = RobotLanguage::ENDINGS.map(|ending| format!(".{ending}"));
    format!(
        "Write the part's stored spray path as a program for the robot's controller, named like the file: {}. Needs a calibration and one file. If several parts are accepted, each has a program of its own, as in paint_1.src. Nothing is written if a robot must not act on the result, for instance because the capture is older than 10 minutes, if the path does not aim at the part, if --arm does not reach every point, or if the program would leave a worse film than planned",
        any_of(&endings)
    )
}

/// A program to write for the part in a capture.
pub(super) struct CapturedProgram {
    file: ProgramFile,
    place: LibraryPlace,
    /// Every reference of the library.
    parts: Vec<PartMeta>,
}

impl ProgramChoice {
    /// Returns whether a program is requested.
    pub(super) fn is_wanted(&self) -> bool {
        self.program.is_some()
    }

    /// Returns whether a file is to be written, or a robot's pose given, despite doubts.
    pub(super) fn is_forced(&self) -> bool {
        self.options.force
    }

    /// Removes the program of an earlier capture: whatever this capture yields, no robot may run it.
    pub(super) fn remove_previous(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.program {
            remove_previous_of_parts(file).advised()?;
        }
        Ok(())
    }

    /// Prepares writing the program, if it is requested and possible.
    pub(super) fn start(
        &self,
        files: &[PathBuf],
        frame: Option<&RobotFrame>,
        place: LibraryPlace,
        load: &LibraryLoad,
    ) -> anyhow::Result<Option<CapturedProgram>> {
        let Some(file) = &self.program else {
            return Ok(None);
        };
        check_placed_part("--program", files, frame)?;
        Ok(Some(CapturedProgram {
            file: self.options.open(file, self.robot_program_format)?,
            place,
            parts: load.parts.clone(),
        }))
    }
}

impl CapturedProgram {
    /// Carries the path and writes the program, unless there is a reason against it. `beside` is what else hangs there, and
    /// `number` that of one of several parts, each of which has a file of its own.
    pub(super) fn write(
        &self,
        seen: &Inspected<'_>,
        beside: &[&[Point3<f32>]],
        number: Option<usize>,
        library: &Library,
        frame: &RobotFrame,
        console: &Console,
    ) -> anyhow::Result<Outcome> {
        let inspection = seen.inspection;
        let pose = inspection.found_pose();
        let first = inspection.ranking.entries.first();
        let part = inspection.segmentation.part.as_ref().ok();
        let (Some((pose, first)), Some(part)) = (pose.zip(first), part) else {
            return Ok(refuse_inspection("program", seen, console));
        };
        let meta = &self.parts[first.reference];
        let name = &meta.name;
        let Some(path) = self.place.spray_path(name.as_str()).advised()? else {
            // A part that was only the nearest need not have a path.
            if !inspection.verdict.is_accepted() {
                return Ok(refuse_inspection("program", seen, console));
            }
            return Err(advised_error(
                format!("{name} has no spray path, so there is nothing to write a program from"),
                store_a_path(name.as_str()),
            ));
        };
        let camera_from_part = pose.camera_from_part();
        let carried = carry(
            &path,
            &camera_from_part,
            &part.cloud,
            &seen.recipe.stand_off,
        );
        let subject = ProgramSubject {
            part: name,
            reference: &library.references[first.reference],
            coverage: meta.coverage,
            side: meta.side,
            path: &path,
            capture: Some(*seen),
            beside,
            camera_from_part,
            is_simulated: meta.simulated || seen.subject.is_simulated,
        };
        let file = match number {
            Some(number) => &self.file.of_part(number),
            None => &self.file,
        };
        file.write(&carried, &subject, frame, console)
    }
}
