//! Inspects one scene after the other: shows, records, exports and reports each.

use std::{
    collections::VecDeque,
    fmt::Display,
    mem,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

use nalgebra::Point3;

use super::carried_path::CarriedPathFile;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, marked_simulated},
    input::{OpenedScene, before, warn_of},
    output::OutputFormat,
    plant::Publisher,
    record::HistoryRecorder,
};
use geometry::error::{Advice, guarded};
use inspection::{
    library::Library,
    pipeline::{Inspection, MirrorTally, NamedRecipe, Unwatched, live::refuse_moving, run_all},
};
use records::{
    history::{HungId, NewEntry, Traceability},
    report::{InspectionLine, Picture, ReportFolder, frame_pictures},
};
use robot::{RobotFrame, line::OnLine};
use serve::Found;
use stages::{
    reference::Reference,
    scene::{EmptyCell, SceneCloud},
};
use station::{CameraScenes, Inspected, LineTracker, Moment, PartFollower, Subject};

/// State shared by all files or frames of a call.
pub(super) struct InspectSession {
    pub(super) library: Library,
    pub(super) recipe: NamedRecipe,
    pub(super) trace: Traceability,
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    /// The scenes of the source.
    pub(super) scenes: CameraScenes,
    pub(super) robot: Option<RobotFrame>,
    /// True to give a robot's pose and file despite doubts.
    pub(super) is_forced: bool,
    pub(super) carried: Option<CarriedPathFile>,
    pub(super) format: OutputFormat,
    pub(super) report: Option<ReportFolder>,
    pub(super) recording: Option<HistoryRecorder>,
    /// Set for a source whose frames show one part after the other.
    pub(super) followed: Option<PartFollower<KeptInspection>>,
    /// Set for a source whose parts a line carries.
    pub(super) line: Option<LineTracker<KeptInspection>>,
    pub(super) publisher: Option<Publisher>,
    pub(super) mirrored: MirrorTally,
    /// Frames of a followed source that are not shown yet, in order.
    pub(super) waiting: VecDeque<InspectedFrame>,
    /// Accepted frames of a source without another one that shows whether the part hangs still.
    pub(super) num_unchecked: usize,
}

/// An inspected scene to show. Whether an accepted part hangs still may only be known a few frames later.
pub(super) struct InspectedFrame {
    path: PathBuf,
    scene: Arc<SceneCloud>,
    subject: Subject,
    /// Of its parts, at least one.
    parts: Vec<Inspection>,
    /// Where each is on a line; empty without one.
    on_line: Vec<Option<OnLine>>,
    /// Time of the frame, by the camera.
    at: Duration,
    /// When it was captured, of a source.
    captured: Option<Instant>,
}

/// An inspection to store and publish once its verdict counts.
pub(super) struct KeptInspection {
    /// Entry for the history.
    entry: Option<NewEntry>,
    /// Result for the broker.
    found: Option<Found>,
}

/// A scene to inspect. The report is named after the path.
pub(super) struct Opened<'a> {
    pub(super) path: &'a Path,
    pub(super) scene: SceneCloud,
    pub(super) subject: Subject,
    /// When it was captured, of a source.
    pub(super) captured: Option<Instant>,
}

impl InspectSession {
    pub(super) fn inspect(
        &mut self,
        path: &Path,
        opened: OpenedScene,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        match opened {
            Ok((mut scene, warnings)) => {
                warn_of(path, &warnings, console);
                let name = path.display().to_string();
                before(&mut scene, self.empty_cell.as_ref(), &name, console);
                let subject = Subject::of_file(path, scene.cloud.is_simulated);
                self.frame(path, console, |one, console| {
                    one.inspect_scene(
                        Opened {
                            path,
                            scene,
                            subject,
                            captured: None,
                        },
                        console,
                    )
                })
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
        guarded(|| inspect(self, console)).unwrap_or_else(|fault| {
            if let Some(publisher) = &mut self.publisher {
                publisher.failed(&fault);
            }
            let shown = format!("{}: {fault}", path.display());
            self.unreadable(path, &fault, &shown, console)
        })
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

    /// Inspects a scene, and shows, records, exports and reports the result. Of a followed source, it may show earlier frames
    /// and this one later.
    pub(super) fn inspect_scene(
        &mut self,
        opened: Opened<'_>,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let mut frame = self.inspected(opened)?;
        for part in &frame.parts {
            self.mirrored.add(&part.verdict);
        }
        if let Some(mut line) = self.line.take() {
            let kept = self.on_line(&mut frame, &mut line, console);
            self.line = Some(line);
            let line = self.show(&frame, console);
            for kept in kept {
                self.keep(kept, console);
            }
            let pictures = self.pictures(&frame);
            self.write_report(&frame.path, &line, pictures)?;
            return Ok(self.outcome(&frame));
        }
        if self.followed.is_some() {
            // Earlier frames first: the part that they show may be recorded now.
            let before = self.show_settled(&frame.parts, console)?;
            self.follow(&frame, console);
            let last = frame.parts.clone();
            self.waiting.push_back(frame);
            // Paths and programs are only written for files.
            return Ok(before.max(self.show_settled(&last, console)?));
        }
        let line = self.show(&frame, console);
        let outcome = self.outcome(&frame);
        let pictures = self.pictures(&frame);
        // After the verdict is shown, which must not wait for it, and before the exports, any of which may fail.
        for part in &frame.parts {
            let part = self.record(&frame, &frame.subject, part);
            let kept = self.kept(&frame, &part, HungId::new());
            self.keep(kept, console);
        }
        let written = self.write_robot_file(&frame, console);
        if written.is_none() {
            self.write_report(&frame.path, &line, pictures)?;
        }
        // A refused part keeps its outcome even if its program was forced.
        Ok(written.map_or(outcome, |written| outcome.max(written)))
    }

    /// Refuses the parts of a frame that do not count on the line. Returns what to store and publish.
    fn on_line(
        &self,
        frame: &mut InspectedFrame,
        line: &mut LineTracker<KeptInspection>,
        console: &Console,
    ) -> Vec<KeptInspection> {
        let capture = frame.subject.capture.as_ref();
        let moment = Moment {
            at: capture.map_or(Duration::ZERO, |capture| line.exposed_at(capture.taken_at)),
            count: None,
        };
        let mut parts = mem::take(&mut frame.parts);
        let (followed, kept) = line.see(
            moment,
            &mut parts,
            |part| middle_of(part, &self.library),
            |_, part, on_line| {
                let part = Inspected {
                    on_line,
                    ..self.record(frame, &frame.subject, part)
                };
                self.kept(frame, &part, HungId::new())
            },
        );
        let on_line = followed.iter().map(|one| one.on_line(line.line()));
        (frame.parts, frame.on_line) = (parts, on_line.collect());
        let parts = frame.parts.iter().zip(&frame.on_line).zip(&followed);
        for ((part, on_line), _) in parts.filter(|(_, one)| one.is_new) {
            if let Some(here) = on_line {
                console.note(&format_args!(
                    "{} is part {} on the line, at {:.0} mm/s",
                    part.verdict.guess().unwrap_or_default(),
                    here.number,
                    here.speed_mm_s
                ));
            }
        }
        kept
    }

    fn outcome(&self, frame: &InspectedFrame) -> Outcome {
        Outcome::accepted_if(self.recipe.is_met(&frame.parts))
    }

    /// Inspects a frame beyond those asked for, which only shows whether the parts of earlier ones hang still.
    pub(super) fn check_waiting(
        &mut self,
        opened: Opened<'_>,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let frame = self.inspected(opened)?;
        self.show_settled(&frame.parts, console)
    }

    fn inspected(&mut self, opened: Opened<'_>) -> anyhow::Result<InspectedFrame> {
        let Opened {
            path,
            scene,
            subject,
            captured,
        } = opened;
        let mut scene = Arc::new(scene);
        if let (Some(followed), Some(capture)) = (&mut self.followed, &subject.capture) {
            scene = followed.look(scene, capture.taken_at);
        }
        let mut parts = run_all(&scene, &self.library, &self.recipe, &Unwatched)?;
        if let Some(followed) = &mut self.followed {
            followed.refuse_if_moving(&mut parts);
        }
        Ok(InspectedFrame {
            path: path.to_owned(),
            scene,
            subject,
            parts,
            on_line: Vec::new(),
            at: (self.followed.as_ref()).map_or(Duration::ZERO, PartFollower::at),
            captured,
        })
    }

    /// Shows the frames whose verdicts count now that the last frame had these inspections.
    fn show_settled(
        &mut self,
        last: &[Inspection],
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let mut outcome = Outcome::Accepted;
        while let Some(frame) = self.waiting.front_mut() {
            let mut accepted = frame
                .parts
                .iter_mut()
                .filter(|part| part.verdict.is_accepted());
            let is_settled = accepted.all(|part| {
                let middle = middle_of(part, &self.library);
                (self.followed.as_ref())
                    .is_none_or(|followed| followed.settle(part, frame.at, last, middle))
            });
            if !is_settled {
                break;
            }
            outcome = outcome.max(self.show_first(console)?);
        }
        Ok(outcome)
    }

    /// Shows the frames that no later one follows, unless the output cannot be written. Before a camera, a part that is not
    /// known to hang still is refused; of a recording, it stays unknown.
    pub(super) fn show_waiting(
        &mut self,
        is_replayed: bool,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let mut outcome = Outcome::Accepted;
        while let Some(frame) = self.waiting.front_mut() {
            if is_replayed {
                frame.subject.is_motion_unchecked = true;
            } else {
                frame.parts.iter_mut().for_each(refuse_moving);
            }
            outcome = outcome.max(self.show_first(console)?);
        }
        Ok(outcome)
    }

    /// Shows the first frame that waits, whose verdict is settled, and stores and publishes it with that verdict if it
    /// represents a part.
    fn show_first(&mut self, console: &mut Console) -> anyhow::Result<Outcome> {
        let Some(frame) = self.waiting.pop_front() else {
            return Ok(Outcome::Accepted);
        };
        if let Some(mut followed) = self.followed.take() {
            followed.settled(frame.at, |index, hung| {
                let part = self.record(&frame, &frame.subject, &frame.parts[index]);
                self.kept(&frame, &part, hung)
            });
            self.followed = Some(followed);
        }
        if console.is_writable() {
            let line = self.show(&frame, console);
            let pictures = self.pictures(&frame);
            self.write_report(&frame.path, &line, pictures)?;
        }
        Ok(self.outcome(&frame))
    }

    /// Shows an inspection, and returns its line of JSON.
    fn show(&mut self, frame: &InspectedFrame, console: &mut Console) -> String {
        let subject = &frame.subject;
        let file_says_simulated = subject.capture.is_none() && subject.is_simulated;
        // The table has no room for the mark; reports and history have it.
        let shown = match self.format {
            OutputFormat::Card => marked_simulated(&subject.scene, file_says_simulated),
            _ => subject.scene.clone(),
        };
        let parts = frame.parts.iter();
        let mut parts: Vec<Inspected<'_>> = parts
            .map(|part| self.record(frame, subject, part))
            .collect();
        for (part, on_line) in parts.iter_mut().zip(&frame.on_line) {
            part.on_line = *on_line;
        }
        let accepted = parts
            .iter()
            .filter(|one| one.inspection.verdict.is_accepted());
        let num_unchecked = accepted.filter(|_| subject.is_motion_unchecked).count();
        let line = Inspected::line_of_all(&parts, &self.trace);
        (self.format).inspected(&shown, &line, &parts, &self.library, console);
        self.num_unchecked += num_unchecked;
        line
    }

    /// The inspection of a frame, or what several frames show, as it is recorded.
    fn record<'a>(
        &'a self,
        frame: &'a InspectedFrame,
        subject: &'a Subject,
        inspection: &'a Inspection,
    ) -> Inspected<'a> {
        Inspected {
            subject,
            scene: &frame.scene,
            inspection,
            recipe: &self.recipe,
            robot: self.robot.as_ref(),
            is_forced: self.is_forced,
            on_line: None,
        }
    }

    fn pictures(&self, frame: &InspectedFrame) -> Option<Vec<Picture>> {
        let parts: Vec<&Inspection> = frame.parts.iter().collect();
        (self.report.as_ref()).map(|_| frame_pictures(&frame.scene, &parts, 0))
    }

    /// Returns what to store and publish of an inspection.
    fn kept(
        &self,
        frame: &InspectedFrame,
        inspected: &Inspected<'_>,
        hung: HungId,
    ) -> KeptInspection {
        KeptInspection {
            entry: (self.recording.as_ref()).map(|recording| recording.entry(inspected, hung)),
            found: (self.publisher.as_ref())
                .zip(frame.captured)
                .map(|(publisher, captured)| publisher.found(inspected, captured)),
        }
    }

    /// Stores and publishes what the frames of a followed source show, up to this one, of parts that hung there.
    fn follow(&mut self, frame: &InspectedFrame, console: &Console) {
        if self.recording.is_none() && self.publisher.is_none() {
            return;
        }
        let Some(mut followed) = self.followed.take() else {
            return;
        };
        let kept = followed.take(
            &frame.scene,
            frame.parts.clone(),
            |part| middle_of(part, &self.library),
            &self.recipe,
            |inspection, hung, is_still| {
                let subject = Subject {
                    is_motion_unchecked: !is_still,
                    ..frame.subject.clone()
                };
                let part = self.record(frame, &subject, inspection);
                self.kept(frame, &part, hung)
            },
        );
        self.followed = Some(followed);
        for kept in kept {
            self.keep(kept, console);
        }
    }

    /// Writes the path of each accepted part for a robot, or says why there is none for the first; `None` if no such file is
    /// wanted. If one cannot be written, it says so and goes on.
    fn write_robot_file(&self, frame: &InspectedFrame, console: &Console) -> Option<Outcome> {
        let (robot, carried) = (self.robot.as_ref()?, self.carried.as_ref()?);
        let accepted = frame.parts.iter().filter(|part| part.verdict.is_accepted());
        let num_files = accepted.count().max(1);
        let mut outcome = Outcome::Accepted;
        // Accepted ones come first.
        for (index, part) in frame.parts.iter().enumerate().take(num_files) {
            let number = (num_files > 1).then_some(index + 1);
            let others = (frame.parts.iter().enumerate()).filter(|(other, _)| *other != index);
            let beside: Vec<_> = others.filter_map(|(_, part)| part.readings()).collect();
            let (seen, library) = (self.record(frame, &frame.subject, part), &self.library);
            let written = carried.write(&seen, &beside, number, library, robot, console);
            outcome = outcome.max(written.unwrap_or_else(|error| {
                console.error(&error);
                Outcome::CouldNotRun
            }));
        }
        Some(outcome)
    }

    /// Writes line and pictures of an inspection, if there is a folder for them.
    fn write_report(
        &mut self,
        path: &Path,
        line: &str,
        pictures: Option<Vec<Picture>>,
    ) -> anyhow::Result<()> {
        if let (Some(report), Some(pictures)) = (&mut self.report, pictures) {
            report.write(path, line, &pictures).advised()?;
        }
        Ok(())
    }

    /// Passes an inspection to the history and to the publisher.
    pub(super) fn keep(&mut self, kept: KeptInspection, console: &Console) {
        if let (Some(recording), Some(entry)) = (&mut self.recording, kept.entry) {
            recording.add(entry, console);
        }
        if let (Some(publisher), Some(found)) = (&mut self.publisher, kept.found) {
            publisher.publish(found);
        }
    }
}

/// Middle of the named part, part space, metres.
fn middle_of(inspection: &Inspection, library: &Library) -> Option<Point3<f64>> {
    let reference = inspection.best_reference(library);
    reference.and_then(Reference::middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_at_which_the_program_fails_is_unreadable_and_the_next_one_comes() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut session = InspectSession {
            library: Library::default(),
            recipe: NamedRecipe::default(),
            trace: Traceability::default(),
            empty_cell: None,
            scenes: CameraScenes::default(),
            robot: None,
            is_forced: false,
            carried: None,
            format: OutputFormat::Card,
            report: Some(ReportFolder::make(folder.path()).expect("made")),
            recording: None,
            followed: None,
            line: None,
            publisher: None,
            mirrored: MirrorTally::default(),
            waiting: VecDeque::new(),
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
            let opened = Opened {
                path: Path::new("b.pcd"),
                scene: SceneCloud::default(),
                subject: Subject::of_scene("b.pcd".into(), "file".into(), false),
                captured: None,
            };
            one.inspect_scene(opened, console)
        });
        assert_eq!(sound.expect("inspected"), Outcome::NotAccepted);
    }
}
