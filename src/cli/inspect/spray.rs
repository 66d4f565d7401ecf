//! `partsight inspect --spray`: writes the part's spray path for the robot.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::{
    cli::{
        Outcome,
        console::{Advised as _, Console, advised_error, store_a_path},
        input::parse_convention,
        program::{advice_on_path, against_seen},
    },
    library::{Library, LibraryLoad, LibraryPlace, PartName},
    pipeline::Inspection,
    robot::{
        Convention, RobotFrame,
        program::{clock_ahead_of_file, is_stale_file},
        spray::{SprayExport, carry, default_path, off_the_part, remove_previous_export},
    },
    stages::stand_off::StandOffParams,
    units::counted,
};

/// Whether and how the spray path is written.
#[derive(Debug, Args)]
pub(super) struct SprayChoice {
    /// Write the part's stored spray path, moved to where the part hangs now, in the robot's base frame: .csv or .json.
    /// Needs a calibration and one file. Nothing is written if the part is not accepted, if another pose fits nearly as
    /// well, if the capture is older than 10 minutes or dated later than now, or if the path does not aim at the part
    #[arg(long, value_name = "FILE", group = "robot_file")]
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
    is_forced: bool,
}

/// The inspection whose part the path is carried to.
pub(super) struct SprayResult<'a> {
    pub(super) scene: &'a str,
    pub(super) inspection: &'a Inspection,
    pub(super) library: &'a Library,
    pub(super) params: &'a StandOffParams,
}

impl SprayChoice {
    /// Returns whether a spray path is requested.
    pub(super) fn is_wanted(&self) -> bool {
        self.spray.is_some()
    }

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
            parts: names_of(load),
            is_forced,
        }))
    }
}

/// Returns the reasons why the pose found in a capture may not be that of the part now. A capture dated later than now is
/// not among them: it has advice of its own.
pub(super) fn doubts_of(scene: &str, is_ambiguous: bool) -> Vec<String> {
    let scene = Path::new(scene);
    let is_old = clock_ahead_of_file(scene).is_none() && is_stale_file(scene);
    let all = [
        (is_ambiguous, "another pose of the part fits nearly as well"),
        (is_old, "the capture is more than 10 minutes old"),
    ];
    let doubts = all.into_iter().filter(|(is_doubt, _)| *is_doubt);
    doubts.map(|(_, doubt)| doubt.to_owned()).collect()
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
        let mut doubts = doubts_of(scene, pose.is_ambiguous());
        let ahead = clock_ahead_of_file(Path::new(scene));
        if let Some(ahead) = &ahead {
            doubts.insert(0, ahead.to_string());
        }
        let off = off_the_part(&path, reference);
        if let Some(off) = &off {
            doubts.insert(0, off.to_string());
        }
        if let (false, Some(doubt)) = (self.is_forced, doubts.first()) {
            console.note(&format_args!("no spray path was written: {doubt}"));
            let advice = advice_on_path(off.as_ref(), ahead.as_ref(), name);
            let advice = advice.unwrap_or_else(|| "Capture all of the part again".to_owned());
            console.note(&format_args!("  to do: {advice}; --force writes it anyway"));
            return Ok(Outcome::NotAccepted);
        }
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
            doubts: &doubts,
            at: crate::clock::now(),
        };
        export.save(&self.file).advised()?;
        console.note(&format_args!(
            "{}: {} as {}; {}",
            self.file.display(),
            counted(carried.points.len(), "point", "points"),
            self.convention.title(),
            against_seen(&carried)
        ));
        for doubt in &doubts {
            console.note(&format_args!("warning: written by --force: {doubt}"));
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
