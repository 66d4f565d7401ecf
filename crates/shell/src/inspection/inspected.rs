//! Inspects a scene or a scan and prepares what the panels draw, in a task.

use std::{
    collections::HashSet,
    sync::Arc,
    time::{Instant, SystemTime},
};

use image::RgbImage;
use jiff::Timestamp;
use nalgebra::Point3;

use super::{
    figures::StageFigures,
    library_cache::{LibraryCache, LibraryView},
    scene_figure::{SceneFigure, SceneFigureInput, deviations, deviations_at},
    source::{Captured, Origin, SceneOrScan, SceneSource},
};
use crate::inspection::{
    scan::{FuseError, FusedShots, Steps, Then, fuse, marked},
    source::{ScanOrder, ScanRequest},
};
use capture::CaptureWarning;
use geometry::{cloud::PointCloud, rigid::RigidTransform};
use inspection::{
    library::Library,
    pipeline::{
        Inspection, NamedRecipe, ProgressObserver, Recipe, Verdict,
        live::{LiveVerdict, MotionState},
        run_all,
        scan::{ScanInspection, run_scan, unseen_points},
    },
};
use records::history::{HungId, NewEntry, Traceability};
use robot::{
    FrameName, RobotFrame,
    spray::{CarriedPath, OffThePart, carry},
};
use stages::{
    reference::Reference,
    scan::part::require_two_to_show_part,
    scene::SceneCloud,
    stand_off::{StandOff, StandOffError, stand_off},
};
use station::{self, LibraryNames, Subject, age_doubt};
use ui::{
    task::TaskError,
    viewport::{PointSet, Role},
};

/// What to inspect, and with which recipe.
#[derive(Clone, Debug)]
pub enum InspectJob {
    /// A scene.
    Scene(InspectRequest),
    /// The shots of a scan together.
    Scan(ScanRequest),
}

/// A scene to take and inspect.
#[derive(Clone, Debug)]
pub struct InspectRequest {
    /// The source to take the scene from.
    pub source: SceneSource,
    /// All parameters of the inspection.
    pub recipe: Arc<NamedRecipe>,
}

/// A scene with everything found in it.
#[derive(Clone, Debug)]
pub struct Inspected {
    /// Origin of the scene.
    pub origin: Origin,
    /// When it was inspected.
    pub at: Timestamp,
    /// When the scene was captured.
    pub captured_at: SystemTime,
    /// The inspected scene.
    pub scene: Arc<SceneCloud>,
    /// The recipe used.
    pub recipe: Arc<NamedRecipe>,
    /// The results of all stages.
    pub inspection: Inspection,
    /// Data of the stage pictures.
    pub figures: StageFigures,
    /// The library that it was compared with.
    pub library: Arc<LibraryView>,
    /// Problems found while reading the scene.
    pub warnings: Vec<CaptureWarning>,
    /// Middle of the best reference's extent, part frame, metres.
    pub middle: Option<Point3<f64>>,
    /// The nozzle's stand-off over the best reference at its pose; `None` unless the verdict is accepted.
    pub stand_off: Option<Result<StandOff, StandOffError>>,
    /// The part's stored spray path, carried to the found pose; `None` if none is stored or the verdict is not accepted.
    pub spray: Option<CarriedPath>,
    /// Cloud that the part of the spray path was enrolled with, part frame, metres; empty without a path.
    pub part_cloud: Arc<PointCloud>,
    /// Whether the spray path does not aim at that part.
    pub off_the_part: Option<OffThePart>,
    /// Data of the 3-D view.
    pub view: SceneFigure,
    /// State of following the source, if this is one of its frames.
    pub followed: Option<LiveFrameContext>,
    /// The scan that was inspected, if it is one; `scene` is then its first shot.
    pub scan: Option<InspectedScan>,
    /// What was inspected, as records name it.
    pub subject: Subject,
    /// The robot frame: from the scan itself, else from the calibration of the cell in use then; `None` if there was none.
    pub robot: Option<Arc<RobotFrame>>,
    /// The entry for the history.
    pub entry: NewEntry,
}

impl Inspected {
    /// The hung part that it belongs to.
    pub fn hung(&self) -> &HungId {
        &self.entry.record.summary.hung
    }

    /// Sets the hung part that it belongs to, and the traceability of that part.
    pub fn set_part(&mut self, hung: HungId, trace: Traceability) {
        self.entry.record.detail.line = self.line(&trace);
        let summary = &mut self.entry.record.summary;
        (summary.hung, summary.trace) = (hung, trace);
    }

    /// The entry for the history with this traceability.
    pub fn entry_of(&self, trace: Traceability) -> NewEntry {
        let mut entry = self.entry.clone();
        entry.record.detail.line = self.line(&trace);
        entry.record.summary.trace = trace;
        entry
    }

    /// Sets where the scene came from.
    #[cfg(any(test, feature = "fixtures"))]
    pub fn set_origin(&mut self, origin: Origin) {
        self.subject = origin.subject(self.subject.source.clone());
        self.origin = origin;
    }

    /// Sets when the scene was captured, if it was not just taken.
    pub fn set_captured_at(&mut self, at: SystemTime) {
        self.captured_at = at;
        self.subject.currency = age_doubt(at);
        self.entry.record.detail.line = self.line(self.trace());
    }

    /// Returns what is recorded of this inspection, with poses in this robot frame.
    pub fn as_recorded<'a>(
        &'a self,
        subject: &'a Subject,
        robot: Option<&'a RobotFrame>,
    ) -> station::Inspected<'a> {
        station::Inspected {
            subject,
            scene: &self.scene,
            inspection: &self.inspection,
            recipe: &self.recipe,
            robot,
            is_forced: false,
            on_line: None,
        }
    }

    /// The line of JSON, as the commands write it, when it was inspected.
    fn line(&self, trace: &Traceability) -> String {
        let robot = self.robot.as_deref();
        self.as_recorded(&self.subject, robot).line(trace)
    }

    /// Number of readings of the same scene that both take for the part.
    pub(crate) fn num_shared(&self, other: &Self) -> usize {
        let [Ok(own), Ok(others)] = [self, other].map(|one| &one.inspection.segmentation.part)
        else {
            return 0;
        };
        let own: HashSet<u32> = own.indices.iter().copied().collect();
        let others = others.indices.iter();
        others.filter(|index| own.contains(index)).count()
    }

    /// Title of the part that the verdict names, whichever of its references was found; `None` without a part.
    pub fn part_title(&self) -> Option<&str> {
        let Verdict::Part { part, .. } = &self.inspection.verdict else {
            return None;
        };
        Some(self.library.title_of(part))
    }

    /// Traceability of the part.
    pub fn trace(&self) -> &Traceability {
        &self.entry.record.summary.trace
    }

    /// True for a frame of a followed source whose verdict does not count.
    pub fn is_open(&self) -> bool {
        let followed = self.followed.as_ref();
        followed.is_some_and(|followed| followed.standing.counted().is_none())
    }

    /// Returns what to inspect for the same inspection again: all shots of a scan, else the scene.
    pub fn again(&self) -> SceneOrScan {
        match &self.scan {
            Some(scan) => SceneOrScan::Scan(ScanOrder::Known(scan.fused.choice.clone())),
            None => SceneOrScan::Scene(SceneSource::AtHand(
                Arc::clone(&self.scene),
                self.origin.clone(),
            )),
        }
    }
}

/// The scan of an inspection.
#[derive(Clone, Debug)]
pub struct InspectedScan {
    /// Its shots, put together.
    pub fused: Arc<FusedShots>,
    /// The robot frame with the camera's pose of the first shot, by the poses of the scan.
    pub robot: Arc<RobotFrame>,
    /// Surface of the recognised part that no shot has seen, camera frame, and its share, 0..1.
    pub unseen: Option<(PointSet, f64)>,
}

/// State of following a source at one of its frames.
#[derive(Clone, Debug)]
pub struct LiveFrameContext {
    /// Whether the scene moves.
    pub stillness: MotionState,
    /// The verdict so far.
    pub standing: LiveVerdict,
}

/// Takes the scene and inspects all its parts, in the order of [`run_all`]; at least one.
pub fn inspect_all(
    request: &InspectRequest,
    library_cache: &LibraryCache,
    watch: &dyn ProgressObserver,
) -> Result<Vec<Inspected>, TaskError> {
    let loaded = library_cache.get();
    if watch.is_cancelled() {
        return Err(TaskError::Cancelled);
    }
    let taken = request
        .source
        .take(library_cache.camera(), &|| watch.is_cancelled());
    let Captured {
        scene,
        origin,
        warnings,
    } = taken?;
    let fitted = loaded.fitting(&request.recipe, watch);
    let fitted = fitted.ok_or(TaskError::Cancelled)?;
    let prepared = |inspection| {
        let found = FinishedInspection {
            inspection,
            scene: Arc::clone(&scene),
            origin: origin.clone(),
            warnings: warnings.clone(),
            recipe: Arc::clone(&request.recipe),
            followed: None,
            scan: None,
            source: request.source.in_words(),
            robot: library_cache.robot(),
        };
        found.prepared(&fitted, &loaded.shown)
    };
    let found = run_all(&scene, &fitted, &request.recipe, watch)?;
    Ok(found.into_iter().map(prepared).collect())
}

/// Puts the shots of a scan together and inspects them; the inner error says why they cannot be put together.
pub fn inspect_scan(
    request: &ScanRequest,
    library_cache: &LibraryCache,
    steps: &Steps<'_>,
) -> Result<Result<Inspected, FuseError>, TaskError> {
    let begun = Instant::now();
    let loaded = library_cache.get();
    let fused = match fuse(request, Then::Inspect, steps) {
        Ok(fused) => Arc::new(fused.ok_or(TaskError::Cancelled)?),
        Err(error) => return Ok(Err(error)),
    };
    if let Err(error) = require_two_to_show_part(&fused.scan) {
        return Ok(Err(error.into()));
    }
    let fitted = loaded.fitting(&request.recipe, steps);
    let fitted = fitted.ok_or(TaskError::Cancelled)?;
    let ScanInspection {
        mut inspection,
        first,
        base_from_part,
        ..
    } = run_scan(&fused.scan, &fitted, &request.recipe, steps)?;
    inspection.timings.total = begun.elapsed();
    let shot = fused.scan.shots.get(first).ok_or(TaskError::Cancelled)?;
    let found = FinishedInspection {
        scene: Arc::clone(&shot.scene),
        origin: fused.origin(),
        warnings: Vec::new(),
        recipe: Arc::clone(&request.recipe),
        inspection,
        followed: None,
        source: fused.title(),
        robot: Some(Arc::new(RobotFrame {
            robot_from_camera: shot.base_from_camera,
            name: FrameName::OfScan,
        })),
        scan: Some(FoundScan {
            fused,
            first,
            base_from_part,
        }),
    };
    Ok(Ok(found.prepared(&fitted, &loaded.shown)))
}

/// An inspection, before the data of the panels is prepared.
pub struct FinishedInspection {
    pub scene: Arc<SceneCloud>,
    pub origin: Origin,
    pub warnings: Vec<CaptureWarning>,
    pub recipe: Arc<NamedRecipe>,
    pub inspection: Inspection,
    pub followed: Option<LiveFrameContext>,
    /// Name of the source for the history.
    pub source: String,
    /// The robot frame, if the cell is calibrated.
    pub robot: Option<Arc<RobotFrame>>,
    /// The scan that was inspected, if it is one.
    pub scan: Option<FoundScan>,
}

/// The scan of an inspection, before the data of the panels is prepared.
pub struct FoundScan {
    fused: Arc<FusedShots>,
    /// Index of the shot whose camera the pose refers to.
    first: usize,
    base_from_part: Option<RigidTransform>,
}

impl FoundScan {
    /// The part's points in the camera frame, each with its index among all points.
    fn part(&self) -> impl Iterator<Item = (usize, Point3<f32>)> {
        let figure = &self.fused.figure;
        let points = figure.positions.iter().zip(&self.fused.scan.cloud.is_part);
        let of_part = points.enumerate().filter(|(_, (_, is_part))| **is_part);
        of_part.map(|(place, (at, _))| (place, Point3::from(*at)))
    }

    /// Returns the surface of the recognised part that no shot has seen, and its share.
    fn unseen(
        &self,
        inspection: &Inspection,
        reference: &Reference,
        recipe: &Recipe,
    ) -> Option<(PointSet, f64)> {
        let base_from_part = self.base_from_part?;
        if !inspection.verdict.is_accepted() {
            return None;
        }
        let scan = &self.fused.scan;
        let places = unseen_points(scan, reference, &base_from_part, recipe.confirm.tolerance);
        let share = places.len() as f64 / reference.cloud.points.len().max(1) as f64;
        let view_from_part = (self.fused.figure.camera_from_base * base_from_part).cast::<f32>();
        let points = places.iter().map(|place| {
            let at = view_from_part * reference.cloud.points[*place];
            [at.x, at.y, at.z]
        });
        Some((marked(points.collect(), Role::Unseen)?, share))
    }
}

/// Creates the entry of an inspection for the history, as one of a part of its own.
pub fn entry_of(
    inspected: &station::Inspected<'_>,
    origin: &Origin,
    library: &LibraryView,
    trace: Traceability,
    picture: Option<&RgbImage>,
) -> NewEntry {
    let names = LibraryNames {
        identity: &library.identity,
        title_of: &|name| library.title_of(name).to_owned(),
    };
    let mut entry = inspected.entry(HungId::new(), trace, names, picture);
    // An origin without a JSON form cannot be opened again anyway.
    entry.record.detail.origin = serde_json::to_string(origin).ok();
    entry
}

/// What was inspected, as records name it, and when it was captured.
fn subject_of(
    origin: &Origin,
    source: String,
    scan: Option<&FoundScan>,
    is_followed: bool,
) -> (Subject, SystemTime) {
    let of_scan = scan.map(|found| found.fused.choice.set.captured_at);
    let captured_at = of_scan.unwrap_or_else(|| origin.captured_at());
    let mut subject = origin.subject(source).captured_at(captured_at);
    // A source that is followed shows in several frames whether the part moves.
    subject.is_motion_unchecked |= subject.capture.is_some() && !is_followed;
    if let Some(found) = scan {
        subject = subject.with_scan(&found.fused.scan, found.first);
    }
    (subject, captured_at)
}

impl FinishedInspection {
    /// Prepares the data of the panels; goes through every point.
    pub fn prepared(self, library: &Library, shown: &Arc<LibraryView>) -> Inspected {
        let Self {
            scene,
            origin,
            warnings,
            recipe,
            inspection,
            followed,
            source,
            robot,
            scan,
        } = self;
        let best = inspection.best_reference(library);
        // What is not of its type is not compared with the part.
        let found = inspection.verdict.identification();
        let compared = best.filter(|_| found.is_of_type());
        let deviations = compared.map_or_else(Vec::new, |reference| match &scan {
            Some(found) => {
                let num = found.fused.figure.positions.len();
                deviations_at(num, found.part(), &inspection, reference)
            }
            None => deviations(&scene, &inspection, reference),
        });
        let seen_by_all = scan
            .as_ref()
            .map(|found| PointCloud::from_points(found.part().map(|(_, point)| point)));
        let middle = inspection.middle(library);
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        // No stand-off or path for a part that was not recognised.
        let sprayed = best.zip(pose).filter(|_| inspection.verdict.is_accepted());
        let stand_off = sprayed.map(|(reference, pose)| {
            stand_off(reference, &pose.camera_from_part(), &recipe.stand_off)
        });
        let path = inspection.ranking.entries.first();
        let path = path.and_then(|first| shown.spray_paths.get(first.reference)?.as_ref());
        let spray = sprayed.zip(path).and_then(|((_, pose), stored)| {
            let seen = match &seen_by_all {
                Some(cloud) => cloud,
                None => &inspection.segmentation.part.as_ref().ok()?.cloud,
            };
            let hangs = pose.camera_from_part();
            Some(carry(&stored.path, &hangs, seen, &recipe.stand_off))
        });
        let carried_onto = best.filter(|_| spray.is_some());
        let view = SceneFigure::of(&SceneFigureInput {
            scene: &scene,
            scan: scan.as_ref().map(|found| &found.fused.figure),
            inspection: &inspection,
            reference: compared,
            middle: compared.and(middle),
            deviations: &deviations,
            stand_off: stand_off.as_ref().and_then(|found| found.as_ref().ok()),
            spray: spray.as_ref(),
        });
        let mut figures = StageFigures::of(&scene, &inspection, library, shown);
        if let (Some(found), Some(part)) = (&scan, &seen_by_all) {
            figures.num_points = found.fused.figure.positions.len();
            figures.num_part = part.points.len();
        }
        let (subject, captured_at) = subject_of(&origin, source, scan.as_ref(), followed.is_some());
        let recorded = station::Inspected {
            subject: &subject,
            scene: &scene,
            inspection: &inspection,
            recipe: &recipe,
            robot: robot.as_deref(),
            is_forced: false,
            on_line: None,
        };
        let picture = figures.segmentation.as_ref();
        let entry = entry_of(&recorded, &origin, shown, Traceability::default(), picture);
        let scan = scan
            .zip(robot.as_ref())
            .map(|(found, robot)| InspectedScan {
                unseen: best.and_then(|best| found.unseen(&inspection, best, &recipe)),
                fused: found.fused,
                robot: Arc::clone(robot),
            });
        Inspected {
            captured_at,
            at: entry.record.summary.at,
            origin,
            scene,
            recipe,
            inspection,
            figures,
            library: Arc::clone(shown),
            warnings,
            middle,
            stand_off,
            spray,
            part_cloud: carried_onto.map_or_else(Arc::default, |best| Arc::clone(&best.cloud)),
            off_the_part: path.and_then(|path| path.off),
            view,
            followed,
            scan,
            subject,
            robot,
            entry,
        }
    }
}

/// A frame of the simulated cell, inspected now with the built-in recipe; what one inspection finds serves every later call.
#[cfg(any(test, feature = "fixtures"))]
pub fn inspected_cell(choice: super::source::CellChoice, number: u64) -> Inspected {
    static KNOWN: std::sync::Mutex<Vec<((super::source::CellChoice, u64), Inspected)>> =
        std::sync::Mutex::new(Vec::new());
    let mut known = geometry::error::lock(&KNOWN);
    let place = known.iter().position(|(of, _)| *of == (choice, number));
    let place = place.unwrap_or_else(|| {
        let request = InspectRequest {
            source: SceneSource::Cell { choice, number },
            recipe: Arc::default(),
        };
        let watch = ::inspection::pipeline::Unwatched;
        let parts = inspect_all(&request, &LibraryCache::default(), &watch);
        known.push(((choice, number), parts.expect("inspected").remove(0)));
        known.len() - 1
    });
    let mut inspected = known[place].1.clone();
    drop(known);
    let now = geometry::clock::now();
    (inspected.at, inspected.captured_at) = (now, now.into());
    inspected.entry.record.summary.at = now;
    inspected.set_part(HungId::new(), Traceability::default());
    inspected
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspection::source::CellChoice;
    use inspection::fixtures::shipped_library;

    #[test]
    fn the_line_in_the_history_has_the_part_that_it_is_of_and_the_pose_for_the_robot() {
        let library_cache = LibraryCache::default();
        library_cache.use_robot(Some(Arc::new(RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell 1".into(),
        })));
        let request = InspectRequest {
            source: SceneSource::Cell {
                choice: CellChoice::InTurn,
                number: 1,
            },
            recipe: Arc::default(),
        };
        let parts = inspect_all(&request, &library_cache, &::inspection::pipeline::Unwatched);
        let mut inspected = parts.expect("inspected").remove(0);
        let trace = Traceability {
            serial: "4711".into(),
            ..Traceability::default()
        };
        inspected.set_part(HungId::new(), trace.clone());
        for entry in [inspected.entry.clone(), inspected.entry_of(trace)] {
            let line = serde_json::from_str::<serde_json::Value>(&entry.record.detail.line);
            let line = line.expect("JSON");
            assert_eq!(line["scene"], "simulated frame 1");
            assert_eq!(
                (&line["simulated"], &line["serial"]),
                (&true.into(), &"4711".into())
            );
            assert_eq!(line["robot"]["calibration"], "cell 1");
            assert_eq!(line["recipe"]["identity"], *inspected.recipe.identity());
        }
    }

    #[test]
    fn a_captured_frame_comes_back_inspected() {
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let Verdict::Part { part, rejected, .. } = &inspected.inspection.verdict else {
            panic!("no part");
        };
        assert_eq!((part.as_str(), rejected), ("front_door", &None));
        let library = shipped_library();
        let best = inspected.inspection.best_reference(&library).expect("one");
        let found = deviations(&inspected.scene, &inspected.inspection, best);
        let known = found.iter().filter(|d| d.is_finite());
        let mean = known.clone().sum::<f32>() / known.clone().count() as f32;
        assert!(known.count() > 10_000 && mean.abs() < 0.002, "{mean}");
    }
}
