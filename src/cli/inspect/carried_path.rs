//! `partsight inspect --spray` and `--program`: writes the part's spray path for the robot, as poses or as a program.

use std::path::PathBuf;

use clap::Args;
use nalgebra::Point3;

use crate::cli::{
    Outcome,
    calibrate::no_calibration,
    console::{Advised as _, Console, advised_error, store_a_path},
    input::parse_convention,
    path::no_path,
    program::{ChosenProgram, ProgramOptions, language_help, parse_language},
    robot_file::{self, refuse_inspection},
};
use geometry::units::any_of;
use inspection::{
    library::{Library, LibraryLoad, LibraryPlace, PartMeta, SprayPath},
    pipeline::Inspection,
};
use robot::{
    Convention, RobotFrame,
    program::RobotLanguage,
    spray::{carry, default_path, off_the_part},
};
use stages::{reference::Reference, stand_off::StandOffParams};
use station::{
    Inspected,
    robot_file::{RobotFile, RobotFileContent, file_of_part, remove_previous_of_parts},
};

/// Which file is written for the robot.
#[derive(Debug, Args)]
pub(super) struct CarriedPathChoice {
    /// Write the part's stored spray path, moved to where the part hangs now, in the robot's base frame: .csv or .json.
    /// Needs a calibration and one file. If several parts are accepted, each has a file of its own, as in `path_1.csv`.
    /// Nothing is written if a robot must not act on the result, for instance because the
    /// capture is older than 10 minutes, or if the path does not aim at the part
    #[arg(long, value_name = "FILE")]
    spray: Option<PathBuf>,
    /// Convention of the poses in that file
    #[arg(long, value_name = "CONVENTION", default_value = "matrix", value_parser = parse_convention, requires = "spray")]
    spray_as: Convention,
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

/// A file to write for the part in a capture.
pub(super) struct CarriedPathFile {
    file: PathBuf,
    form: PathForm,
    place: LibraryPlace,
    /// Every reference of the library.
    parts: Vec<PartMeta>,
    is_forced: bool,
}

/// How the path is written.
enum PathForm {
    Poses(Convention),
    Program(Box<ChosenProgram>),
}

impl CarriedPathChoice {
    /// Returns whether a file is to be written, or a robot's pose given, despite doubts.
    pub(super) fn is_forced(&self) -> bool {
        self.options.force
    }

    /// Removes the file of an earlier capture: whatever this capture yields, no robot may act on it.
    pub(super) fn remove_previous(&self) -> anyhow::Result<()> {
        for file in self.program.iter().chain(&self.spray) {
            remove_previous_of_parts(file).advised()?;
        }
        Ok(())
    }

    /// Refuses combinations of options. The parser would refuse them before an earlier file is removed.
    pub(super) fn check(&self, is_scan: bool, is_source: bool) -> anyhow::Result<()> {
        let option = match (&self.program, &self.spray) {
            (Some(_), Some(_)) => {
                return Err(advised_error(
                    "--program and --spray cannot be used together",
                    "Run inspect once for each",
                ));
            }
            (Some(_), None) => Some("--program"),
            (None, Some(_)) => Some("--spray"),
            (None, None) => None,
        };
        match option {
            Some(option) if is_scan => Err(advised_error(
                format!("{option} takes a capture's file, not a scan"),
                "Give one capture",
            )),
            _ if self.is_forced() && is_source => Err(advised_error(
                "--force takes a capture's file or a scan, not a source",
                "Leave it out: what a source delivers is not old, and other doubts need another capture",
            )),
            _ => Ok(()),
        }
    }

    /// Prepares writing the file, if one is requested and possible.
    pub(super) fn start(
        &self,
        files: &[PathBuf],
        frame: Option<&RobotFrame>,
        place: LibraryPlace,
        load: &LibraryLoad,
    ) -> anyhow::Result<Option<CarriedPathFile>> {
        let (option, file) = match (&self.program, &self.spray) {
            (Some(file), _) => ("--program", file),
            (None, Some(file)) => ("--spray", file),
            (None, None) => return Ok(None),
        };
        if files.is_empty() {
            return Err(advised_error(
                format!("{option} takes a capture's file, not a source"),
                "Record a capture and give its file: partsight capture --source SOURCE --frames 1 --out DIR",
            ));
        }
        if files.len() > 1 {
            return Err(advised_error(
                format!("{option} writes the path of a single part"),
                "Give one capture",
            ));
        }
        if frame.is_none() {
            return Err(no_calibration(option));
        }
        Ok(Some(CarriedPathFile {
            file: file.clone(),
            form: if self.program.is_some() {
                PathForm::Program(Box::new(
                    self.options.open(file, self.robot_program_format)?,
                ))
            } else {
                PathForm::Poses(self.spray_as)
            },
            place,
            parts: load.parts.clone(),
            is_forced: self.is_forced(),
        }))
    }
}

impl CarriedPathFile {
    /// Carries the path and writes it, unless there is a reason against it. `beside` is what else hangs there, and `number`
    /// that of one of several parts, each of which has a file of its own.
    pub(super) fn write(
        &self,
        seen: &Inspected<'_>,
        beside: &[&[Point3<f32>]],
        number: Option<usize>,
        library: &Library,
        frame: &RobotFrame,
        console: &Console,
    ) -> anyhow::Result<Outcome> {
        let (inspection, params) = (seen.inspection, &seen.recipe.stand_off);
        let (what, content) = match &self.form {
            PathForm::Poses(convention) => {
                let convention = *convention;
                ("spray path", RobotFileContent::Poses { convention, params })
            }
            PathForm::Program(program) => ("program", program.content()),
        };
        let pose = inspection.found_pose();
        let first = inspection.ranking.entries.first();
        let part = inspection.segmentation.part.as_ref().ok();
        let (Some((pose, first)), Some(part)) = (pose.zip(first), part) else {
            return Ok(refuse_inspection(what, seen, console));
        };
        let reference = &library.references[first.reference];
        let meta = &self.parts[first.reference];
        let name = meta.name.as_str();
        let stored = self.place.spray_path(name).advised()?;
        let is_stored = stored.is_some();
        let path = match (stored, &self.form) {
            (Some(path), _) => path,
            (None, PathForm::Poses(_)) => start_in_front(name, inspection, reference, params)?,
            // A part that was only the nearest need not have a path.
            (None, PathForm::Program(_)) if !inspection.verdict.is_accepted() => {
                return Ok(refuse_inspection(what, seen, console));
            }
            (None, PathForm::Program(_)) => return Err(no_path(name)),
        };
        let camera_from_part = pose.camera_from_part();
        let carried = carry(&path, &camera_from_part, &part.cloud, params);
        let of_part = number.map(|number| file_of_part(&self.file, number));
        let file = RobotFile {
            file: of_part.as_ref().unwrap_or(&self.file),
            content,
            carried: &carried,
            frame,
            part: name,
            part_cloud: &reference.cloud,
            coverage: meta.coverage,
            side: meta.side,
            path: Some(&path),
            off: off_the_part(&path, reference),
            capture: Some(*seen),
            beside,
            camera_from_part,
            is_stored,
            is_simulated: meta.simulated || seen.subject.is_simulated,
            is_forced: self.is_forced,
        };
        if let PathForm::Program(program) = &self.form {
            return program.write(&file, console);
        }
        if robot_file::write(&file, console)?.is_none() {
            return Ok(Outcome::NotAccepted);
        }
        if !is_stored {
            console.note(&format_args!(
                "note: {name} has no spray path: the only point is a start in front of its middle. {}",
                store_a_path(name)
            ));
        }
        Ok(Outcome::Accepted)
    }
}

/// The path of a part without a stored one: a start in front of its middle.
fn start_in_front(
    name: &str,
    inspection: &Inspection,
    reference: &Reference,
    params: &StandOffParams,
) -> anyhow::Result<SprayPath> {
    if let Some(other) = inspection.other_reference() {
        let part = &reference.name;
        return Err(advised_error(
            format!(
                "{other}, one more reference of {part}, has no spray path: that of {part} is in other coordinates"
            ),
            store_a_path(other),
        ));
    }
    default_path(reference, params).ok_or_else(|| {
        advised_error(
            format!("{name} has neither a spray path nor a surface to start on"),
            store_a_path(name),
        )
    })
}
