use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::workspaces::paint::RegionUse;
use geometry::rigid::from_euler_zyx;
use inspection::{
    fixtures::{add_reference, copy_library},
    library::{LibraryFolder, PartNaming},
};
use robot::{
    RobotFrame,
    paint::{KeepOut, PathEdit},
};
use shell::{
    inspection::{
        camera::Camera, inspected::inspected_cell, library_cache::LibraryCache, source::CellChoice,
    },
    notice::NoticeKind,
    session::Shown,
    workspace::TestShell,
};
use simulate::{PartKind, Side};
use ui::{parameter_control::ParameterChange, viewport::Role};

/// The workspace in front, without a window; its tasks run when the test asks.
struct Bench {
    paint: PaintState,
    shell: TestShell,
    data: tempfile::TempDir,
}

impl Bench {
    /// With the shipped parts in a folder of their own, and a path planned over the fender.
    fn new() -> Self {
        let data = tempfile::tempdir().expect("a folder");
        let parts = data.path().join("parts");
        copy_library(&parts);
        let mut shell = TestShell::default();
        let shipped = Some(LibraryCache::default().get());
        let library_cache = LibraryCache::new(Some(parts), Camera::default()).with_former(shipped);
        shell.services.library_cache = library_cache;
        shell.session.library = Some(Arc::clone(&shell.services.library_cache.get().shown));
        shell.session.workspace = WorkspaceKind::Paint;
        let coats = Some(data.path().join("coats"));
        let paint = PaintState::new(coats, &TaskRunner::without_threads());
        let mut bench = Self { paint, shell, data };
        let fender = PartName::new("fender").expect("a name");
        bench.run(PaintAction::ChoosePart(fender));
        bench
    }

    fn act(&mut self, action: PaintAction) {
        self.paint.apply(action, &mut self.shell.context());
    }

    /// Does what the window does between frames, and all work.
    fn settle(&mut self) {
        self.paint.update(&mut self.shell.context());
        while self.paint.task.run_waiting()
            || self.paint.storing.run_waiting()
            || self.paint.reach_task.run_waiting()
            || self.paint.writing.run_waiting()
        {
            self.paint.update(&mut self.shell.context());
            let library = self.shell.services.library_cache.get();
            self.shell.session.library = Some(Arc::clone(&library.shown));
            self.paint.update(&mut self.shell.context());
        }
    }

    fn run(&mut self, action: PaintAction) {
        self.act(action);
        self.settle();
    }

    fn planned(&self) -> &Planned {
        self.paint.planned.as_ref().expect("planned")
    }

    fn set(&mut self, key: &'static str, value: f64) {
        self.run(PaintAction::Change(key, ParameterChange::Set(value)));
    }

    /// Calibrates the cell: the camera is at this height above the robot's base and looks along its x axis.
    fn calibrate(&mut self, height: f64) {
        let robot_from_camera = from_euler_zyx([-FRAC_PI_2, 0.0, -FRAC_PI_2, 0.0, 0.0, height]);
        self.shell.session.robot = Some(Arc::new(RobotFrame {
            robot_from_camera,
            name: "cell".into(),
        }));
        self.shell.session.program = ProgramSetup {
            arm: Some("irb4600".into()),
            nozzle: "kuka 0 0 250 0 -45 0".into(),
            ..ProgramSetup::default()
        };
        self.settle();
    }

    /// Acts, and uses the settings of robot programs that this sends, as the window does.
    fn run_set_up(&mut self, action: PaintAction) {
        self.act(action);
        let mut sent = self.shell.sent.iter().rev();
        let setup = sent.find_map(|message| match message {
            Action::UseProgramSetup(setup) => Some(setup.clone()),
            _ => None,
        });
        self.shell.session.program = setup.expect("settings");
        self.settle();
    }

    fn reached(&self) -> Arc<Reach> {
        let reach = self.paint.reach(&self.shell.session).expect("checked");
        Arc::clone(reach.as_ref().expect("an arm"))
    }

    /// Shows an inspection of this part in Inspect.
    fn recognise(&mut self, kind: PartKind) {
        self.shell.session.shown = Some(Shown::new(
            1,
            Arc::new(inspected_cell(CellChoice::Part(kind, Side::Left), 1)),
        ));
        self.settle();
    }

    fn folder(&self) -> LibraryFolder {
        LibraryFolder::open(&self.data.path().join("parts")).expect("opened")
    }

    /// Loads the library again after it was changed.
    fn reload(&mut self) {
        let loaded = self.shell.services.library_cache.reload();
        let loaded = loaded.expect("loaded");
        self.shell.session.library = Some(Arc::clone(&loaded.shown));
        self.settle();
    }

    /// A keep-out in the middle of the part.
    fn hole(&self) -> KeepOut {
        KeepOut::Sphere {
            centre: self.planned().surface.middle,
            radius: 0.1,
        }
    }

    fn stored(&self) -> Option<SprayPath> {
        self.folder().spray_path("fender").expect("read")
    }
}

#[test]
fn a_changed_parameter_gives_another_path_and_undo_the_former() {
    let mut bench = Bench::new();
    let first = Arc::clone(&bench.planned().path);
    bench.set("spacing", 40.0);
    let closer = Arc::clone(&bench.planned().path);
    assert!(closer.points().len() > first.points().len());
    assert!(bench.paint.design.is_coat_changed());
    bench.set("spacing", 5000.0);
    assert!(
        bench.shell.notices()[0].contains("cannot be"),
        "out of range"
    );
    assert_eq!(bench.planned().path, closer);
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().path, first);
    bench.run(PaintAction::Redo);
    assert_eq!(bench.planned().path, closer);
    bench.run(PaintAction::Change("spacing", ParameterChange::Reset));
    assert_eq!(bench.planned().path, first);
    assert!(!bench.paint.design.is_coat_changed());
}

#[test]
fn a_proposal_changes_the_coat_in_one_step_and_brings_more_within_the_tolerance() {
    let mut bench = Bench::new();
    bench.set("speed", 150.0);
    let before = bench.planned().film.figures.clone();
    bench.run(PaintAction::Propose);
    let after = &bench.planned().film.figures;
    assert!(after.within > before.within + 0.2, "{before:?} {after:?}");
    assert_eq!(bench.planned().coat, bench.paint.design.coat);
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().film.figures, before);
}

#[test]
fn regions_are_left_out_of_path_and_figures_and_areas_add_up() {
    let mut bench = Bench::new();
    let whole = bench.planned().film.path.paint;
    let middle = bench.planned().surface.middle;
    let square = |x: f64| {
        let corners = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]];
        let at = corners.map(|[u, v]| middle + nalgebra::Vector3::new(x + u, v, 0.0));
        at.to_vec()
    };
    let hole = KeepOut::Polygon {
        corners: square(0.0),
    };
    bench.run(PaintAction::Add(vec![hole]));
    let planned = bench.planned();
    assert!(planned.film.path.paint < 0.97 * whole);
    // A keep-out counts neither as missed nor as painted.
    assert!(
        planned.film.figures.missed < 0.02,
        "{:?}",
        planned.film.figures
    );
    bench.run(PaintAction::Clear);
    let area = |x| KeepOut::Outside {
        areas: vec![square(x)],
    };
    bench.run(PaintAction::Add(vec![area(-0.15)]));
    let one = bench.planned().film.path.paint;
    bench.run(PaintAction::Add(vec![area(0.15)]));
    let two = bench.planned().film.path.paint;
    assert_eq!(bench.paint.design.regions.len(), 1);
    assert!(one < 0.6 * whole && two > 1.5 * one, "{one} {two} {whole}");
    assert!(bench.paint.unsaved().is_some());
}

#[test]
fn a_stored_path_can_be_taken_back_and_the_former_is_there_again() {
    let mut bench = Bench::new();
    assert_eq!(bench.stored(), None);
    bench.run(PaintAction::Store);
    let first = bench.stored().expect("stored");
    assert!(bench.planned().is_stored);
    bench.set("spacing", 50.0);
    assert!(!bench.planned().is_stored);
    bench.run(PaintAction::Store);
    assert!(!bench.stored().expect("stored").is_as_written(&first));
    bench.run(PaintAction::Undo);
    assert!(bench.stored().expect("stored").is_as_written(&first));
    bench.run(PaintAction::Show(ShownPath::Stored));
    let num = bench.planned().path.points().len();
    assert_eq!(Some(num), bench.stored().map(|path| path.points().len()));
    // Undo the spacing, then the first storing.
    bench.run(PaintAction::Undo);
    bench.run(PaintAction::Undo);
    assert_eq!(bench.stored(), None);
    bench.run(PaintAction::Redo);
    assert!(bench.stored().is_some());
}

#[test]
fn the_notice_of_a_stored_path_takes_it_back_whatever_was_changed_since() {
    let mut bench = Bench::new();
    bench.run(PaintAction::Store);
    let first = bench.stored().expect("stored");
    bench.set("spacing", 50.0);
    bench.run(PaintAction::Store);
    let offers = |bench: &Bench| {
        let mut sent = bench.shell.sent.iter().rev();
        sent.find_map(|action| match action {
            Action::Notify(notice) => Some(notice.kind),
            _ => None,
        })
    };
    let by = WorkspaceKind::Paint;
    assert_eq!(offers(&bench), Some(NoticeKind::Undoable(by)));
    bench.set("spacing", 60.0);
    let coat = bench.paint.design.coat;
    let mut undo = |by| {
        let event = Event::Undo(by);
        bench.paint.on_event(&event, &mut bench.shell.context());
        bench.settle();
        (bench.stored(), offers(&bench))
    };
    // What another workspace offers to undo is not meant.
    let (stored, _) = undo(WorkspaceKind::Enrol);
    assert!(!stored.expect("stored").is_as_written(&first));
    let (stored, offer) = undo(by);
    assert!(stored.expect("stored").is_as_written(&first));
    assert_eq!(offer, Some(NoticeKind::Done));
    assert_eq!(bench.paint.design.coat, coat);
    bench.run(PaintAction::Redo);
    assert!(!bench.stored().expect("stored").is_as_written(&first));
}

#[test]
fn a_part_that_cannot_be_painted_says_why_and_the_former_path_stays() {
    let mut bench = Bench::new();
    let before = Arc::clone(&bench.planned().path);
    let everything = KeepOut::Sphere {
        centre: bench.planned().surface.middle,
        radius: 5.0,
    };
    bench.run(PaintAction::Add(vec![everything]));
    let failed = bench.paint.failed.clone().expect("a reason");
    assert!(!failed.advice.is_empty());
    assert_eq!(bench.planned().path, before);
    assert!(bench.paint.is_old(&bench.shell.session));
    bench.run(PaintAction::Undo);
    assert_eq!(bench.paint.failed, None);
}

#[test]
fn nothing_of_another_part_is_shown_under_the_name_of_the_part_to_paint() {
    let mut bench = Bench::new();
    bench.act(PaintAction::Scrub(3.0));
    let lid = PartName::new("trunk_lid").expect("a name");
    bench.act(PaintAction::ChoosePart(lid.clone()));
    assert_eq!(bench.paint.part(&bench.shell.session), Some(&lid));
    assert!(bench.paint.planned.is_none());
    // While it is planned, and if that is cancelled.
    bench.paint.update(&mut bench.shell.context());
    assert!(bench.paint.is_planning() && bench.paint.planned.is_none());
    assert_eq!((bench.paint.time, bench.paint.duration()), (0.0, 0.0));
    // The part itself is in sight first, and stays.
    assert!(bench.paint.unpainted.is_none() && bench.paint.task.run_waiting_until(1));
    bench.paint.update(&mut bench.shell.context());
    let unpainted = |bench: &Bench| {
        let unpainted = bench.paint.unpainted.as_ref();
        unpainted.map(|part| (part.part.clone(), part.points.positions().len() > 500))
    };
    assert!(bench.paint.is_planning() && bench.paint.planned.is_none());
    assert_eq!(unpainted(&bench), Some((lid.clone(), true)));
    bench.paint.cancel();
    bench.settle();
    assert!(bench.paint.planned.is_none() && bench.paint.is_old(&bench.shell.session));
    assert_eq!(unpainted(&bench), Some((lid.clone(), true)));
    bench.run(PaintAction::ChoosePart(lid.clone()));
    assert_eq!(
        (bench.planned().part.clone(), unpainted(&bench)),
        (lid.clone(), None)
    );
    assert!(!bench.paint.is_old(&bench.shell.session));
    bench.act(PaintAction::Undo);
    assert!(bench.paint.planned.is_none());
    // Why one part has no path is no reason for another.
    bench.settle();
    let everything = KeepOut::Sphere {
        centre: bench.planned().surface.middle,
        radius: 5.0,
    };
    bench.run(PaintAction::Add(vec![everything]));
    assert!(bench.paint.failed.is_some());
    bench.act(PaintAction::ChoosePart(lid));
    assert_eq!(bench.paint.failed, None);
}

#[test]
fn the_former_path_of_a_part_stays_and_is_marked_until_the_next_is_there() {
    let mut bench = Bench::new();
    let before = Arc::clone(&bench.planned().path);
    assert!(!bench.paint.is_old(&bench.shell.session));
    let closer = PaintAction::Change("spacing", ParameterChange::Set(40.0));
    bench.act(closer);
    bench.paint.update(&mut bench.shell.context());
    assert_eq!(bench.planned().path, before);
    assert!(bench.paint.is_old(&bench.shell.session));
    // A path that was not planned for these parameters is not stored with the part.
    bench.paint.cancel();
    bench.settle();
    assert!(bench.paint.is_old(&bench.shell.session));
    bench.run(PaintAction::Store);
    assert_eq!(bench.stored(), None);
    let fender = PartName::new("fender").expect("a name");
    bench.run(PaintAction::ChoosePart(fender));
    assert_ne!(bench.planned().path, before);
    assert!(!bench.paint.is_old(&bench.shell.session));
}

#[test]
fn a_coat_is_kept_by_name_and_chosen_again() {
    let mut bench = Bench::new();
    bench.set("spacing", 45.0);
    for name in ["", "primer", "a/b"] {
        bench.act(PaintAction::Name(Some(name.into())));
        bench.act(PaintAction::SaveCoat);
        assert!(bench.paint.naming.is_some(), "{name:?}");
    }
    bench.act(PaintAction::Name(Some("booth_3".into())));
    bench.shell.sent.clear();
    bench.act(PaintAction::SaveCoat);
    assert_eq!(bench.paint.naming, None);
    // The complaints about the other names are removed.
    assert!(matches!(
        bench.shell.sent[..],
        [Action::RemoveNotices(NoticeTopic::CoatName), ..]
    ));
    assert!(!bench.paint.design.is_coat_changed());
    assert!(bench.paint.coats.contains(&"booth_3".to_owned()));
    bench.run(PaintAction::ChooseCoat("clear_coat".into()));
    assert!((bench.paint.design.coat.spacing - 0.045).abs() > 1e-6);
    bench.run(PaintAction::ChooseCoat("booth_3".into()));
    assert!((bench.paint.design.coat.spacing - 0.045).abs() < 1e-9);
    bench.act(PaintAction::ChooseCoat("no_such".into()));
    assert!(
        bench
            .shell
            .notices()
            .last()
            .is_some_and(|n| n.contains("no_such"))
    );
}

#[test]
fn the_gun_is_scrubbed_stepped_and_played_to_the_end() {
    let mut bench = Bench::new();
    let end = bench.paint.duration();
    assert!(end > 5.0);
    bench.act(PaintAction::Step(1));
    let course = &bench.planned().course;
    let begins: Vec<f64> = course.strokes.iter().map(|s| course.times(*s)[0]).collect();
    assert!((bench.paint.time - begins[0]).abs() < 1e-9);
    bench.act(PaintAction::Step(1));
    assert!((bench.paint.time - begins[1]).abs() < 1e-9);
    bench.act(PaintAction::Step(-1));
    assert!((bench.paint.time - begins[0]).abs() < 1e-9);
    bench.act(PaintAction::Scrub(end - 0.1));
    bench.act(PaintAction::TogglePlay);
    bench.act(PaintAction::Advance(0.05));
    assert_eq!(bench.paint.playback, Playback::Playing);
    bench.act(PaintAction::Advance(0.2));
    assert_eq!(bench.paint.playback, Playback::Paused);
    assert!((bench.paint.time - end).abs() < 1e-9);
    bench.act(PaintAction::TogglePlay);
    assert!(bench.paint.time.abs() < 1e-9, "from the beginning");
}

#[test]
fn a_stroke_moved_by_hand_stays_until_another_path_is_planned_and_undo_brings_it_back() {
    let mut bench = Bench::new();
    let planned = Arc::clone(&bench.planned().path);
    let by = nalgebra::Vector3::new(0.0, 0.03, 0.0);
    bench.run(PaintAction::Edit(PathEdit::Stroke { stroke: 2, by }));
    let moved = Arc::clone(&bench.planned().path);
    assert_ne!(moved, planned);
    assert!(bench.paint.unsaved().is_some());
    bench.set("spacing", 50.0);
    assert!(bench.paint.design.edits.is_empty());
    assert!(
        bench
            .shell
            .notices()
            .iter()
            .any(|notice| notice.contains("by hand"))
    );
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().path, moved);
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().path, planned);
}

#[test]
fn the_reference_that_was_recognised_is_painted_and_never_another_part() {
    let mut bench = Bench::new();
    add_reference(&bench.data.path().join("parts"), "fender", "fender_b");
    // No part is chosen yet.
    bench.act(PaintAction::Undo);
    let choice = CellChoice::Part(PartKind::Fender, Side::Left);
    let mut inspected = inspected_cell(choice, 1);
    "fender_b".clone_into(&mut inspected.inspection.ranking.entries[0].enrolled_as);
    bench.shell.session.shown = Some(Shown::new(1, Arc::new(inspected)));
    bench.reload();
    assert_eq!(bench.planned().part.as_str(), "fender_b");
    let name = |name: &str| PartName::new(name).expect("a name");
    let own = bench.folder().remove(&name("fender")).expect("removed");
    bench.reload();
    assert_eq!(bench.planned().part.as_str(), "fender_b");
    bench.folder().remove(&name("fender_b")).expect("removed");
    bench.reload();
    assert_eq!(bench.paint.part(&bench.shell.session), None);
    assert!(bench.paint.planned.is_none() && !bench.paint.is_planning());
    bench.folder().restore(&own).expect("restored");
    bench.reload();
    assert_eq!(bench.planned().part.as_str(), "fender");
    // Without a recognised part it is the first.
    bench.shell.session.shown = None;
    let first = bench.paint.part(&bench.shell.session);
    let library = bench.shell.session.library.as_ref().expect("loaded");
    assert_eq!(first, Some(&library.parts[0].name));
}

#[test]
fn what_is_drawn_stays_with_its_part_whichever_is_recognised_next() {
    let mut bench = Bench::new();
    // No part is chosen yet.
    bench.run(PaintAction::Undo);
    bench.recognise(PartKind::Fender);
    assert_eq!(bench.planned().part.as_str(), "fender");
    let hole = bench.hole();
    bench.run(PaintAction::Add(vec![hole]));
    bench.recognise(PartKind::FrontDoor);
    assert_eq!(bench.planned().part.as_str(), "fender");
    assert_eq!(bench.paint.design.regions.len(), 1);
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().part.as_str(), "front_door");
    assert!(bench.paint.design.regions.is_empty());
    let by = nalgebra::Vector3::new(0.0, 0.03, 0.0);
    bench.run(PaintAction::Edit(PathEdit::Stroke { stroke: 2, by }));
    bench.recognise(PartKind::Fender);
    assert_eq!(bench.planned().part.as_str(), "front_door");
    assert_eq!(bench.paint.design.edits.len(), 1);
    assert!(bench.shell.notices().is_empty());
    // Choosing another part drops it.
    let fender = PartName::new("fender").expect("a name");
    bench.run(PaintAction::ChoosePart(fender));
    assert!(!bench.paint.design.is_drawn_on());
    assert_eq!(
        bench.shell.notices(),
        ["What was drawn on Front door, left in Paint was dropped"]
    );
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().part.as_str(), "front_door");
    assert_eq!(bench.paint.design.edits.len(), 1);
}

#[test]
fn what_is_drawn_follows_a_renamed_part_and_is_dropped_if_that_is_enrolled_anew_or_removed() {
    let mut bench = Bench::new();
    let name = |name: &str| PartName::new(name).expect("a name");
    let hole = bench.hole();
    bench.run(PaintAction::Add(vec![hole]));
    let wing = PartNaming {
        name: name("wing"),
        title: "Wing".into(),
        notes: String::new(),
    };
    let renamed = bench.folder().rename(&name("fender"), &wing);
    renamed.expect("renamed");
    bench.reload();
    assert_eq!(bench.planned().part, wing.name);
    assert_eq!(bench.paint.design.regions.len(), 1);
    assert!(bench.shell.notices().is_empty());

    // Another cloud under the same name.
    let former = bench.folder().remove(&wing.name).expect("removed");
    let renamed = bench.folder().rename(&name("front_door"), &wing);
    renamed.expect("renamed");
    bench.reload();
    assert_eq!(bench.planned().part, wing.name);
    assert!(!bench.paint.design.is_drawn_on());
    let dropped = "What was drawn on Wing in Paint was dropped";
    assert_eq!(bench.shell.notices(), [dropped]);
    // It comes back with the former cloud only.
    bench.run(PaintAction::Undo);
    assert!(!bench.paint.design.is_drawn_on());
    assert_eq!(bench.shell.notices(), [dropped; 2]);
    bench.run(PaintAction::Redo);
    let hole = bench.hole();
    bench.run(PaintAction::Add(vec![hole]));
    bench.folder().restore(&former).expect("restored");
    bench.reload();
    assert!(!bench.paint.design.is_drawn_on());
    assert_eq!(bench.shell.notices(), [dropped; 3]);

    let hole = bench.hole();
    bench.run(PaintAction::Add(vec![hole]));
    let former = bench.folder().remove(&wing.name).expect("removed");
    bench.reload();
    assert_ne!(bench.planned().part, wing.name);
    assert!(!bench.paint.design.is_drawn_on());
    bench.folder().restore(&former).expect("restored");
    bench.reload();
    bench.run(PaintAction::Undo);
    assert_eq!(bench.planned().part, wing.name);
    assert_eq!(bench.paint.design.regions.len(), 1);
}

#[test]
fn escape_gives_the_drag_back_to_the_view() {
    let mut bench = Bench::new();
    let lasso = PaintTool::Outline(ui::viewport::DrawnShape::Lasso, RegionUse::KeepOut);
    bench.act(PaintAction::Use(lasso));
    let Bench { paint, shell, .. } = &mut bench;
    paint.on_event(&Event::Escape, &mut shell.context());
    assert_eq!(bench.paint.tool, PaintTool::Look);
}

#[test]
fn what_the_arm_does_not_reach_is_named_shown_and_never_exported() {
    let mut bench = Bench::new();
    // Neither an arm nor a calibration, so no result.
    assert!(bench.paint.reach(&bench.shell.session).is_none());
    bench.calibrate(1.2);
    let reach = bench.reached();
    let all = bench.planned().path.points().len();
    assert_eq!(reach.check.points.len(), all);
    assert_eq!(reach.check.num_reached(), all, "{:?}", reach.reasons());
    let file = bench.data.path().join("paint.src");
    bench.run(PaintAction::Chosen(PaintFile::Program, file.clone()));
    let text = std::fs::read_to_string(&file).expect("written");
    assert!(
        text.contains("fender") && text.contains("SIMULATED"),
        "{text}"
    );
    // The part hangs too high.
    bench.calibrate(2.5);
    let reach = bench.reached();
    let missed = all - reach.check.num_reached();
    assert!(missed > 0);
    let reasons = reach.reasons();
    assert_eq!(reasons.iter().map(|(_, num)| num).sum::<usize>(), missed);
    bench.run(PaintAction::Scrub(0.0));
    bench.run(PaintAction::ShowUnreached);
    let (course, time) = (&bench.planned().course, bench.paint.time);
    let shown = course
        .seconds
        .iter()
        .position(|at| (at - time).abs() < 1e-9);
    let shown = shown.expect("a point of the path");
    assert!(reach.check.points[shown].problem.is_some());
    // Refused before a file is chosen.
    bench.act(PaintAction::Ask(PaintFile::Program));
    assert!(!bench.shell.services.dialogs.is_open());
    let refusals = |bench: &Bench| {
        let notices = bench.shell.notices().into_iter();
        notices
            .filter(|notice| notice.contains("No program was written"))
            .count()
    };
    assert_eq!(refusals(&bench), 1);
    // Writing is refused, and no earlier program may be left to run.
    bench.run(PaintAction::Chosen(PaintFile::Program, file.clone()));
    assert!(!file.exists());
    assert_eq!(refusals(&bench), 2);
}

#[test]
fn another_base_is_checked_written_and_an_undoable_step() {
    let mut bench = Bench::new();
    bench.calibrate(1.2);
    let (usual, all) = (bench.shell.session.program.clone(), bench.reached());
    let with_base = |base: [f64; 6]| ProgramSetup {
        base,
        ..usual.clone()
    };
    // Turned about the vertical, the arm reaches the same points.
    let turned = with_base([0.0, 0.0, 0.0, 30.0, 0.0, 0.0]);
    bench.run_set_up(PaintAction::SetUp(turned.clone()));
    assert_eq!(bench.reached().check.num_reached(), all.check.num_reached());
    let file = bench.data.path().join("paint.src");
    bench.run(PaintAction::Chosen(PaintFile::Program, file.clone()));
    let text = std::fs::read_to_string(&file).expect("written");
    assert!(text.contains("frame: that of the calibration"), "{text}");
    // Too far from the part.
    let far = with_base([-1800.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    bench.run_set_up(PaintAction::SetUp(far.clone()));
    let reach = bench.reached();
    assert!(reach.check.num_reached() < all.check.num_reached());
    let better = reach.base.expect("a better base");
    assert!(better.shift[0] > 0.0 && reach.rail.is_none(), "{better:?}");
    let mut moved = far.clone();
    for (value, metres) in moved.base.iter_mut().zip(better.shift) {
        *value += 1000.0 * metres;
    }
    bench.run_set_up(PaintAction::SetUp(moved.clone()));
    assert_eq!(bench.reached().check.num_reached(), better.num_reached);
    // Nothing else is undone.
    bench.shell.session.program.params.gun_output = 7;
    let with_output = |mut setup: ProgramSetup| {
        setup.params.gun_output = 7;
        setup
    };
    for (action, wanted) in [
        (PaintAction::Undo, far),
        (PaintAction::Undo, turned.clone()),
        (PaintAction::Undo, usual.clone()),
        (PaintAction::Redo, turned),
    ] {
        bench.act(action);
        let Some(Action::UseProgramSetup(setup)) = bench.shell.sent.last() else {
            panic!("{:?}", bench.shell.sent);
        };
        bench.shell.session.program = setup.clone();
        assert_eq!(bench.shell.session.program, with_output(wanted));
    }
    assert_eq!(bench.paint.can_undo(), [true, true]);
}

#[test]
fn a_notice_that_no_program_can_be_written_goes_once_the_settings_change() {
    let mut bench = Bench::new();
    bench.calibrate(1.2);
    bench.shell.session.program.nozzle = String::new();
    bench.settle();
    bench.act(PaintAction::Ask(PaintFile::Program));
    let Some(Action::Notify(notice)) = bench.shell.sent.last() else {
        panic!("{:?}", bench.shell.sent);
    };
    assert_eq!(notice.topic, NoticeTopic::Program);
    let missing = bench.shell.session.program.nozzle_error();
    let missing = Notice::from(missing.expect("no nozzle"));
    bench.shell.sent.clear();
    let setup = ProgramSetup {
        nozzle: "kuka 0 0 250 0 -45 0".into(),
        ..bench.shell.session.program.clone()
    };
    bench.act(PaintAction::SetUp(setup));
    // Also the one of Inspect.
    let [
        Action::RemoveNotices(NoticeTopic::Program),
        Action::Retract(gone),
        Action::UseProgramSetup(_),
    ] = &bench.shell.sent[..]
    else {
        panic!("{:?}", bench.shell.sent);
    };
    assert_eq!(*gone, missing);
}

#[test]
fn boxes_of_the_cell_are_kept_clear_of_named_and_drawn() {
    let mut bench = Bench::new();
    bench.calibrate(1.2);
    let edges = |reach: &Reach| {
        let lines = reach.lines.lines().iter();
        lines.filter(|line| line.role == Role::Rest).count()
    };
    let reach = bench.reached();
    assert_eq!((reach.check.num_collisions(), edges(&reach)), (0, 0));
    // The box is in front of the part, where the gun is.
    let file = bench.data.path().join("boxes.toml");
    let text =
        "[[box]]\nname = \"hanger\"\ncentre_mm = [1000, 0, 1200]\nsize_mm = [300, 2000, 2000]\n";
    std::fs::write(&file, text).expect("written");
    bench.shell.session.program.obstacles = Some(file.display().to_string());
    bench.settle();
    let reach = bench.reached();
    assert!(reach.check.num_collisions() > 0);
    let mut reasons = reach.reasons().into_iter();
    assert!(reasons.any(|(reason, _)| reason.ends_with("too near to the box hanger")));
    assert_eq!(edges(&reach), 12);
    let program = bench.data.path().join("paint.src");
    bench.run(PaintAction::Chosen(PaintFile::Program, program.clone()));
    assert!(!program.exists());
    // An invalid or missing file is not taken for an empty cell.
    let empty = bench.data.path().join("empty.toml");
    std::fs::write(&empty, "").expect("written");
    for file in [empty, bench.data.path().join("none.toml")] {
        bench.shell.session.program.obstacles = Some(file.display().to_string());
        bench.settle();
        let reach = bench.paint.reach(&bench.shell.session).expect("an answer");
        let error = reach.as_ref().expect_err("no boxes");
        assert!(!error.advice.is_empty(), "{error:?}");
    }
}

#[test]
fn a_rail_that_moves_is_placed_along_the_path_and_a_wrong_one_is_refused() {
    let mut bench = Bench::new();
    bench.calibrate(1.2);
    let still = bench.reached();
    assert_eq!(still.rail_range, None);
    bench.shell.session.program.rail = "y,-1000,1000,500".into();
    bench.settle();
    let moving = bench.reached();
    let [low, high] = moving.rail_range.expect("it moves");
    assert!(-1.0 <= low && low <= high && high <= 1.0, "{low} {high}");
    assert!(moving.check.num_reached() >= still.check.num_reached());
    bench.shell.session.program.rail = "y,1000".into();
    bench.settle();
    let reach = bench.paint.reach(&bench.shell.session).expect("an answer");
    let error = reach.as_ref().expect_err("no rail");
    assert!(error.what.contains("y,1000"), "{error:?}");
}

#[test]
fn an_arm_without_its_nozzle_says_what_is_missing() {
    let mut bench = Bench::new();
    bench.calibrate(1.2);
    bench.shell.session.program.nozzle = "kuka 0 0".into();
    bench.settle();
    for nozzle in ["kuka 0 0", "", "thing 1 2 3 4 5 6"] {
        bench.shell.session.program.nozzle = nozzle.into();
        bench.settle();
        let session = &bench.shell.session;
        let reach = bench.paint.reach(session).expect("an answer");
        let error = reach.as_ref().expect_err("no nozzle");
        assert!(
            !error.what.is_empty() && !error.advice.is_empty(),
            "{nozzle}"
        );
    }
    bench.shell.session.program.arm = Some("no_such.toml".into());
    bench.shell.session.program.nozzle = "kuka 0 0 250 0 -45 0".into();
    bench.settle();
    let reach = bench.paint.reach(&bench.shell.session);
    assert!(reach.is_some_and(Result::is_err));
}
