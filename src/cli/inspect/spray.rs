//! `partsight inspect --spray`: writes the part's spray path for the robot.

use std::path::PathBuf;

use clap::Args;
use jiff::Timestamp;

use crate::{
    cli::{
        Outcome,
        console::{Advised as _, Console, advised_error, store_a_path},
        input::parse_convention,
        program::against_seen,
    },
    library::{Library, LibraryLoad, LibraryPlace, PartName},
    pipeline::Inspection,
    robot::{
        Convention, RobotFrame,
        spray::{SprayExport, carry, default_path, off_the_part, remove_previous_export},
    },
    stages::stand_off::StandOffParams,
    units::counted,
};

/// Whether and how the spray path is written.
#[derive(Debug, Args)]
pub(super) struct SprayChoice {
    /// Write the part's stored spray path, moved to where the part hangs now, in the robot's base frame: .csv or .json.
    /// Needs a calibration and one file; nothing is written if the part is not accepted
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
    /// Name of each reference of the library, and whether it is simulated.
    parts: Vec<(PartName, bool)>,
}

/// The inspection whose part the path is carried to.
pub(super) struct SprayResult<'a> {
    pub(super) scene: &'a str,
    pub(super) inspection: &'a Inspection,
    pub(super) library: &'a Library,
    pub(super) params: &'a StandOffParams,
}

impl SprayChoice {
    /// Removes the path of an earlier capture: whatever this capture yields, it must not be mistaken for its own.
    pub(super) fn remove_previous(&self) -> anyhow::Result<()> {
        if let Some(file) = &self.spray {
            remove_previous_export(file).advised()?;
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
    ) -> anyhow::Result<Option<SprayFile>> {
        let Some(file) = &self.spray else {
            return Ok(None);
        };
        check_placed_part("--spray", files, frame)?;
        Ok(Some(SprayFile {
            file: file.clone(),
            convention: self.spray_as,
            place,
            parts: names_of(load),
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

/// Returns the name of each reference of the library, and whether it is simulated.
pub(super) fn names_of(load: &LibraryLoad) -> Vec<(PartName, bool)> {
    let parts = load.parts.iter();
    parts
        .map(|meta| (meta.name.clone(), meta.simulated))
        .collect()
}

impl SprayFile {
    /// Carries the path and writes it; nothing is written for a part that was not accepted.
    pub(super) fn write(
        &self,
        seen: &SprayResult<'_>,
        frame: &RobotFrame,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let SprayResult {
            scene,
            inspection,
            library,
            params,
        } = seen;
        let pose = inspection.found_pose();
        let first = inspection.ranking.entries.first();
        let found = pose.zip(first).filter(|_| inspection.verdict.is_accepted());
        let part = inspection.segmentation.part.as_ref().ok();
        let (Some((pose, first)), Some(part)) = (found, part) else {
            console.note(&"no spray path was written: the part was not accepted with a pose");
            return Ok(Outcome::NotAccepted);
        };
        let reference = &library.references[first.reference];
        let (name, is_simulated) = &self.parts[first.reference];
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
        let carried = carry(&path, &pose.camera_from_part(), &part.cloud, params);
        let export = SprayExport {
            path: &carried,
            part: name.as_str(),
            scene,
            frame,
            convention: self.convention,
            params,
            is_stored,
            is_simulated: *is_simulated,
            at: Timestamp::now(),
        };
        export.save(&self.file).advised()?;
        console.note(&format_args!(
            "{}: {} as {}; {}",
            self.file.display(),
            counted(carried.points.len(), "point", "points"),
            self.convention.title(),
            against_seen(&carried)
        ));
        if let Some(off) = off_the_part(&path, reference) {
            console.warn(&off, &off);
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
