//! Inspects one scene after the other: shows, records, exports and reports each.

use std::{fmt::Display, path::Path, sync::Arc, time::Instant};

use super::carried_path::CarriedPathFile;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, marked_simulated},
    input::{OpenedScene, before, warn_of},
    output::OutputFormat,
    plant::Publisher,
    record::HistoryRecorder,
};
use geometry::error::{Advice, Fault, guarded};
use inspection::pipeline::{Inspection, MirrorTally, SurfaceVerdict};
use records::{
    history::{HungId, NewEntry, Traceability},
    report::{InspectionLine, Picture, ReportFolder, frame_pictures},
};
use serve::Found;
use stages::scene::{EmptyCell, SceneCloud};
use station::{CameraScenes, Inspected, InspectedScene, SceneToInspect, Settled, Station, Subject};

/// State shared by all files or frames of a call.
pub(super) struct InspectSession {
    pub(super) station: Station<KeptInspection>,
    pub(super) trace: Traceability,
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    /// The scenes of the source.
    pub(super) scenes: CameraScenes,
    pub(super) carried: Option<CarriedPathFile>,
    pub(super) format: OutputFormat,
    pub(super) report: Option<ReportFolder>,
    pub(super) recording: Option<HistoryRecorder>,
    pub(super) publisher: Option<Publisher>,
    pub(super) mirrored: MirrorTally,
    /// Accepted frames of a source without another one that shows whether the part hangs still.
    pub(super) num_unchecked: usize,
}

/// An inspection to store and publish once its verdict counts.
pub(super) struct KeptInspection {
    /// Entry for the history.
    entry: Option<NewEntry>,
    /// Result for the broker.
    found: Option<Found>,
}

impl KeptInspection {
    fn new(
        recording: Option<&HistoryRecorder>,
        publisher: Option<&Publisher>,
        part: &Inspected<'_>,
        hung: HungId,
        captured_at: Option<Instant>,
    ) -> Self {
        Self {
            entry: recording.map(|recording| recording.entry(part, hung)),
            found: (publisher.zip(captured_at))
                .map(|(publisher, captured_at)| publisher.found(part, captured_at)),
        }
    }
}

impl InspectSession {
    pub(super) fn inspect(
        &mut self,
        path: &Path,
        opened: OpenedScene,
        more: Vec<SceneCloud>,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        match opened {
            Ok((mut scene, warnings)) => {
                warn_of(path, &warnings, console);
                let name = path.display().to_string();
                before(&mut scene, self.empty_cell.as_ref(), &name, console);
                let subject = Subject::of_file(path, scene.cloud.is_simulated);
                let scene = SceneToInspect {
                    path: path.to_owned(),
                    scene,
                    subject,
                    captured_at: None,
                    more,
                    watched: None,
                };
                self.frame(path, console, |one, console| one.next(scene, console))
            }
            // The message names the file.
            Err(error) => self.unreadable(path, &error, &error, console),
        }
    }

    /// Inspects one of many frames: a fault of the program there becomes an error of that frame, and the next one
    /// follows.
    pub(super) fn frame(
        &mut self,
        path: &Path,
        console: &mut Console,
        inspect: impl FnOnce(&mut Self, &mut Console) -> anyhow::Result<Outcome>,
    ) -> anyhow::Result<Outcome> {
        guarded(|| inspect(self, console))
            .unwrap_or_else(|fault| self.failed(path, &fault, console))
    }

    /// Reports a scene at which the program failed.
    fn failed(
        &mut self,
        path: &Path,
        fault: &Fault,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        if let Some(publisher) = &mut self.publisher {
            publisher.failed(fault);
        }
        let shown = format!("{}: {fault}", path.display());
        self.unreadable(path, fault, &shown, console)
    }

    /// Reports an input that is not a scene; `shown` is the error as text for people.
    pub(super) fn unreadable(
        &mut self,
        path: &Path,
        error: &impl Advice,
        shown: &dyn Display,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let name = path.display().to_string();
        let line = InspectionLine::unreadable(&name, shown).to_json();
        self.format.unreadable(&name, &line, console);
        console.advise(&format_args!("error: {shown}"), &error.advice());
        if let Some(report) = &mut self.report {
            report.write(path, &line, &[]).advised()?;
        }
        Ok(Outcome::CouldNotRun)
    }

    /// Inspects a scene, and shows, records, exports and reports what counts now.
    pub(super) fn next(
        &mut self,
        scene: SceneToInspect,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        self.stand(console, |station, entry| station.next(scene, entry))
    }

    /// Inspects a frame beyond those asked for, which only shows whether the parts of earlier ones hang still.
    pub(super) fn check(
        &mut self,
        scene: SceneToInspect,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        self.stand(console, |station, entry| station.check(scene, entry))
    }

    /// Ends the source.
    pub(super) fn end(
        &mut self,
        is_replayed: bool,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        self.stand(console, |station, entry| station.end(is_replayed, entry))
    }

    /// Shows, records, exports and reports what the station returns.
    fn stand(
        &mut self,
        console: &mut Console,
        step: impl FnOnce(
            &mut Station<KeptInspection>,
            &dyn Fn(&Inspected<'_>, HungId, Option<Instant>) -> KeptInspection,
        ) -> Settled<KeptInspection>,
    ) -> anyhow::Result<Outcome> {
        let (recording, publisher) = (self.recording.as_ref(), self.publisher.as_ref());
        let Settled { scenes, recorded } = step(&mut self.station, &|part, hung, captured_at| {
            KeptInspection::new(recording, publisher, part, hung, captured_at)
        });
        // A fault at one of several scenes takes no other with it.
        let shown: Vec<Result<String, Fault>> = (scenes.iter())
            .map(|scene| guarded(|| self.show(scene, console)))
            .collect();
        // After the verdict is shown, which must not wait for it, and before the exports, any of which may fail.
        for kept in recorded {
            self.keep(kept, console);
        }
        let mut outcome = Outcome::Accepted;
        for (scene, shown) in scenes.iter().zip(shown) {
            let written = match shown {
                Ok(line) => guarded(|| self.export(scene, &line, console)),
                Err(fault) => Err(fault),
            };
            let written = written.unwrap_or_else(|fault| self.failed(&scene.path, &fault, console));
            outcome = outcome.max(written?);
        }
        Ok(outcome)
    }

    /// Writes what is wanted of a scene to files. Returns what came of it.
    fn export(
        &mut self,
        scene: &InspectedScene,
        line: &str,
        console: &Console,
    ) -> anyhow::Result<Outcome> {
        let is_good = |part: &Inspection| {
            let surface = part.surface.as_ref();
            surface.is_none_or(|surface| surface.verdict == SurfaceVerdict::Ok)
        };
        let is_met =
            self.station.setup().recipe.is_met(&scene.parts) && scene.parts.iter().all(is_good);
        let outcome = Outcome::accepted_if(is_met);
        if let Some(written) = self.write_robot_file(scene, console) {
            // A refused part keeps its outcome even if its program was forced.
            return Ok(outcome.max(written));
        }
        self.write_report(scene, line)?;
        Ok(outcome)
    }

    /// Shows an inspected scene. Returns its line of JSON.
    fn show(&mut self, scene: &InspectedScene, console: &mut Console) -> String {
        for part in &scene.parts {
            self.mirrored.add(&part.verdict);
        }
        let subject = &scene.subject;
        let parts = self.station.parts(scene);
        for (part, _) in (parts.iter().zip(&scene.followed)).filter(|(_, followed)| followed.is_new)
        {
            if let Some(here) = part.on_line {
                console.note(&format_args!(
                    "{} is part {} on the line, at {:.0} mm/s",
                    part.inspection.verdict.guess().unwrap_or_default(),
                    here.number,
                    here.speed_mm_s
                ));
            }
        }
        let accepted = (scene.parts.iter()).filter(|part| part.verdict.is_accepted());
        self.num_unchecked += accepted.filter(|_| subject.is_motion_unchecked).count();
        let line = Inspected::line_of_all(&parts, &self.trace);
        let file_says_simulated = subject.capture.is_none() && subject.is_simulated;
        // The table has no room for the mark; reports and history have it.
        let shown = match self.format {
            OutputFormat::Card => marked_simulated(&subject.scene, file_says_simulated),
            _ => subject.scene.clone(),
        };
        let library = &self.station.setup().library;
        (self.format).inspected(&shown, &line, &parts, library, console);
        line
    }

    /// Writes the path of each accepted part for a robot, or says why there is none for the first; `None` if no such file is
    /// wanted. If one cannot be written, it says so and goes on.
    fn write_robot_file(&self, scene: &InspectedScene, console: &Console) -> Option<Outcome> {
        let setup = self.station.setup();
        let (robot, carried) = (setup.robot.as_ref()?, self.carried.as_ref()?);
        let parts = self.station.parts(scene);
        let accepted = scene.parts.iter().filter(|part| part.verdict.is_accepted());
        let num_files = accepted.count().max(1);
        let mut outcome = Outcome::Accepted;
        // Accepted ones come first.
        for (index, part) in parts.iter().enumerate().take(num_files) {
            let number = (num_files > 1).then_some(index + 1);
            let others = (scene.parts.iter().enumerate()).filter(|(other, _)| *other != index);
            let beside: Vec<_> = others.filter_map(|(_, part)| part.readings()).collect();
            let written = carried.write(part, &beside, number, &setup.library, robot, console);
            outcome = outcome.max(written.unwrap_or_else(|error| {
                console.error(&error);
                Outcome::CouldNotRun
            }));
        }
        Some(outcome)
    }

    /// Writes line and pictures of an inspected scene, if there is a folder for them.
    fn write_report(&mut self, scene: &InspectedScene, line: &str) -> anyhow::Result<()> {
        if let Some(report) = &mut self.report {
            let parts: Vec<&Inspection> = scene.parts.iter().collect();
            let pictures: Vec<Picture> = frame_pictures(&scene.scene, &parts, 0);
            report.write(&scene.path, line, &pictures).advised()?;
        }
        Ok(())
    }

    /// Passes an inspection to the history and to the publisher.
    fn keep(&mut self, kept: KeptInspection, console: &Console) {
        if let (Some(recording), Some(entry)) = (&mut self.recording, kept.entry) {
            recording.add(entry, console);
        }
        if let (Some(publisher), Some(found)) = (&mut self.publisher, kept.found) {
            publisher.publish(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use station::{Following, StationSetup};

    #[test]
    fn a_frame_at_which_the_program_fails_is_unreadable_and_the_next_one_comes() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut session = InspectSession {
            station: Station::new(StationSetup::default(), Following::Independent),
            trace: Traceability::default(),
            empty_cell: None,
            scenes: CameraScenes::default(),
            carried: None,
            format: OutputFormat::Card,
            report: Some(ReportFolder::make(folder.path()).expect("made")),
            recording: None,
            publisher: None,
            mirrored: MirrorTally::default(),
            num_unchecked: 0,
        };
        let mut console = Console::new();
        let failed = session.frame(Path::new("a.pcd"), &mut console, |_, _| {
            panic!("no ray for this pixel")
        });
        assert_eq!(failed.expect("it goes on"), Outcome::CouldNotRun);
        let kept = std::fs::read_to_string(folder.path().join("a.report.json")).expect("its line");
        assert!(
            kept.contains("unreadable") && kept.contains("no ray for this pixel"),
            "{kept}"
        );
        let sound = session.frame(Path::new("b.pcd"), &mut console, |one, console| {
            let scene = SceneToInspect {
                path: "b.pcd".into(),
                scene: SceneCloud::default(),
                subject: Subject::of_scene("b.pcd".into(), "file".into(), false),
                captured_at: None,
                more: Vec::new(),
                watched: None,
            };
            one.next(scene, console)
        });
        assert_eq!(sound.expect("inspected"), Outcome::NotAccepted);
    }
}
