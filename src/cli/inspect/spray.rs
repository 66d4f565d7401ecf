//! `partsight inspect --spray`: writes the part's spray path for the robot.

use std::path::PathBuf;

use clap::Args;

use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error, store_a_path},
    input::parse_convention,
    robot_file,
};
use inspection::library::{Library, LibraryLoad, LibraryPlace, PartMeta};
use robot::{
    Convention, RobotFrame,
    spray::{carry, default_path, off_the_part},
};
use station::{
    Inspected,
    robot_file::{RobotFile, RobotFileContent, file_of_part, remove_previous_of_parts},
};

/// Whether and how the spray path is written.
#[derive(Debug, Args)]
pub(super) struct SprayChoice {
    /// Write the part's stored spray path, moved to where the part hangs now, in the robot's base frame: .csv or .json.
    /// Needs a calibration and one file. If several parts are accepted, each has a file of its own, as in `path_1.csv`.
    /// Nothing is written if a robot must not act on the result, for instance because the
    /// capture is older than 10 minutes, or if the path does not aim at the part
    #[arg(long, value_name = "FILE")]
    spray: Option<PathBuf>,
    /// Convention of the poses in that file
    #[arg(long, value_name = "CONVENTION", default_value = "matrix", value_parser = parse_convention, requires = "spray")]
    spray_as: Convention,
}

/// A spray path to write.
pub(super) struct SprayFile {
    file: PathBuf,
    convention: Convention,
    place: LibraryPlace,
    /// Every reference of the library.
    parts: Vec<PartMeta>,
    is_forced: bool,
}

impl SprayChoice {
    /// Returns whether a spray path is requested.
    pub(super) fn is_wanted(&self) -> bool {
        self.spray.is_some()
    }

    /// Removes the path of an earlier capture: whatever this capture yields, it must not be mistaken for its own.
    pub(super) fn remove_previous(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.spray {
            remove_previous_of_parts(file).advised()?;
        }
        Ok(())
    }

    /// Prepares writing the path, if it is requested and possible.
    pub(super) fn start(
        &self,
        files: &[PathBuf],
        frame: Option<&RobotFrame>,
        place: LibraryPlace,
        load: &LibraryLoad,
        is_forced: bool,
    ) -> anyhow::Result<Option<SprayFile>> {
        let Some(file) = &self.spray else {
            return Ok(None);
        };
        check_placed_part("--spray", files, frame)?;
        Ok(Some(SprayFile {
            file: file.clone(),
            convention: self.spray_as,
            place,
            parts: load.parts.clone(),
            is_forced,
        }))
    }
}

/// Refuses an option that writes a carried path if there are several captures or no calibration.
pub(super) fn check_placed_part(
    option: &str,
    files: &[PathBuf],
    frame: Option<&RobotFrame>,
) -> anyhow::Result<()> {
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
        return Err(advised_error(
            format!("{option} needs to know where the camera sits in the robot's cell"),
            "Name a calibration with --calibration, or make one: partsight calibrate",
        ));
    }
    Ok(())
}

impl SprayFile {
    /// Carries the path and writes it, unless there is a reason against it. `number` is that of one of several parts, each of
    /// which has a file of its own.
    pub(super) fn write(
        &self,
        seen: &Inspected<'_>,
        number: Option<usize>,
        library: &Library,
        frame: &RobotFrame,
        console: &Console,
    ) -> anyhow::Result<Outcome> {
        let (inspection, params) = (seen.inspection, &seen.recipe.stand_off);
        let pose = inspection.found_pose();
        let first = inspection.ranking.entries.first();
        let part = inspection.segmentation.part.as_ref().ok();
        let (Some((pose, first)), Some(part)) = (pose.zip(first), part) else {
            return Ok(robot_file::refuse_inspection("spray path", seen, console));
        };
        let reference = &library.references[first.reference];
        let meta = &self.parts[first.reference];
        let name = &meta.name;
        let stored = self.place.spray_path(name.as_str()).advised()?;
        if let (None, Some(other)) = (&stored, inspection.other_reference()) {
            let part = &first.part;
            return Err(advised_error(
                format!(
                    "{other}, one more reference of {part}, has no spray path: that of {part} is in other coordinates"
                ),
                store_a_path(other),
            ));
        }
        let is_stored = stored.is_some();
        let Some(path) = stored.or_else(|| default_path(reference, params)) else {
            return Err(advised_error(
                format!("{name} has neither a spray path nor a surface to start on"),
                store_a_path(name.as_str()),
            ));
        };
        let camera_from_part = pose.camera_from_part();
        let carried = carry(&path, &camera_from_part, &part.cloud, params);
        let of_part = number.map(|number| file_of_part(&self.file, number));
        let file = RobotFile {
            file: of_part.as_ref().unwrap_or(&self.file),
            content: RobotFileContent::Poses {
                convention: self.convention,
                params,
            },
            carried: &carried,
            frame,
            part: name.as_str(),
            part_cloud: &reference.cloud,
            coverage: meta.coverage,
            side: meta.side,
            path: Some(&path),
            off: off_the_part(&path, reference),
            capture: Some(*seen),
            beside: &[],
            camera_from_part,
            is_stored,
            is_simulated: meta.simulated || seen.subject.is_simulated,
            is_forced: self.is_forced,
        };
        if robot_file::write(&file, console)?.is_none() {
            return Ok(Outcome::NotAccepted);
        }
        if !is_stored {
            console.note(&format_args!(
                "note: {name} has no spray path: the only point is a start in front of its middle. {}",
                store_a_path(name.as_str())
            ));
        }
        Ok(Outcome::Accepted)
    }
}
