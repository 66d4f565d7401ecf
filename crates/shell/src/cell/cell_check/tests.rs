use std::fs;

use super::*;
use crate::{
    cell::{CheckAction, RobotAction, RobotCell, RobotDialog, RobotPage},
    inspection::source::ScanFiles,
    source::inspect,
    state::State,
    workspace::TestShell,
};
use geometry::units::Metres;
use robot::cell_check::CellFinding;
use stages::fixtures::save_fender_view;

/// The page of the check without a window or threads.
struct Bench {
    robot: RobotCell,
    shell: TestShell,
    folder: tempfile::TempDir,
}

impl Bench {
    /// Opens the page and reads its folder, which does not exist yet.
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let kept = CellCheckFolder::at(folder.path().join("cell"));
        let mut bench = Self {
            robot: RobotCell::new(Some(kept), &TaskRunner::without_threads()),
            shell: TestShell::default(),
            folder,
        };
        bench.apply(RobotAction::Toggle);
        bench.edit(|dialog| dialog.page = RobotPage::Check);
        assert!(bench.work(), "the folder is read");
        bench
    }

    fn apply(&mut self, action: RobotAction) {
        self.robot.apply(action, &mut self.shell.context());
    }

    fn edit(&mut self, change: impl FnOnce(&mut RobotDialog)) {
        let mut dialog = self.dialog().clone();
        change(&mut dialog);
        self.apply(RobotAction::Edit(Box::new(dialog)));
    }

    /// Runs the waiting work; false if there is none.
    fn work(&mut self) -> bool {
        let has_worked = self.checks().run_waiting();
        self.robot.update(&mut self.shell.context());
        has_worked
    }

    /// Carries out an action of the check and runs its work; false if there is none.
    fn check(&mut self, action: CheckAction) -> bool {
        self.apply(RobotAction::Check(action));
        self.work()
    }

    /// Uses a file as the source: a fender, captured after the camera moved back by `back` metres.
    fn look_from(&mut self, noise: u64, back: f64) {
        let path = self.folder.path().join(format!("{noise}.pcd"));
        save_fender_view(&path, noise, back);
        self.shell.session.source = Source::File(path);
    }

    fn checks(&self) -> &CellChecks {
        self.robot.checks()
    }

    fn dialog(&self) -> &RobotDialog {
        self.robot.dialog().expect("open")
    }

    fn problem(&self) -> &UserError {
        self.dialog().problem.as_ref().expect("problem")
    }

    /// Switches to the operator's role and runs the work that this starts.
    fn become_operators(&mut self) {
        self.shell.session.role = UserRole::Operator;
        self.shell.sent.clear();
        assert!(!self.work(), "only asked for");
        assert!(self.work(), "the folder is read");
    }
}

#[test]
fn without_a_baseline_there_is_nothing_to_compare_with() {
    let mut bench = Bench::new();
    assert!(!bench.checks().content().has_baseline);
    assert!(bench.checks().content().problems.is_empty());
    bench.look_from(1, 0.0);
    assert!(bench.check(CheckAction::Check));
    assert!(bench.problem().what.contains("no baseline"));
    assert!(bench.checks().latest().is_none());
    // A source that cannot be used is refused before any work starts.
    bench.shell.session.source = Source::Scan(ScanFiles::of_folder("scan".into()));
    assert!(!bench.check(CheckAction::TakeBaseline));
    assert!(bench.problem().what.contains("scan"));
    bench.shell.session.source = Source::File("missing.pcd".into());
    assert!(bench.check(CheckAction::TakeBaseline));
    assert!(bench.problem().what.contains("missing.pcd"));
    assert!(!bench.folder.path().join("cell").exists());
}

#[test]
fn a_camera_that_moved_is_found_listed_exported_and_told_the_operator() {
    let mut bench = Bench::new();
    bench.look_from(1, 0.0);
    assert!(bench.check(CheckAction::TakeBaseline));
    let baseline = bench.checks().content().baseline.clone().expect("taken");
    assert!(baseline.is_simulated && baseline.num_frames == 1 && baseline.num_planes() > 0);
    assert!(bench.checks().latest().is_none());
    bench.look_from(2, 0.0);
    assert!(bench.check(CheckAction::Check));
    let still = bench.checks().latest().cloned().expect("a check");
    assert_eq!(still.finding, CellFinding::InPlace, "{still:?}");
    assert!(still.is_simulated);
    bench.become_operators();
    assert!(bench.shell.notices().is_empty());

    bench.shell.session.role = UserRole::Engineer;
    bench.look_from(3, 0.02);
    assert!(bench.check(CheckAction::Check));
    let moved = bench.checks().latest().cloned().expect("a check");
    assert_eq!(moved.finding, CellFinding::CameraMoved, "{moved:?}");
    assert!((moved.shift_m[2] - 0.02).abs() < 0.004, "{moved:?}");
    assert!(bench.shell.notices().is_empty(), "the page says it");
    let listed = bench.checks().content().checks.iter();
    let listed: Vec<CellFinding> = listed.map(|check| check.finding).collect();
    assert_eq!(listed, [still.finding, moved.finding]);

    let table = bench.folder.path().join("checks.csv");
    assert!(bench.check(CheckAction::Export(table.clone())));
    let table = fs::read_to_string(table).expect("written");
    assert_eq!(table.lines().count(), 3, "{table}");
    assert!(table.contains(",camera_moved,1,true,"), "{table}");

    bench.apply(RobotAction::Close);
    bench.become_operators();
    let [warning] = bench.shell.notices()[..] else {
        panic!("{:?}", bench.shell.notices());
    };
    assert!(warning.contains("the camera moved, simulated"), "{warning}");
    assert!(!bench.work(), "once in a shift");

    bench.shell.session.role = UserRole::Engineer;
    bench.look_from(4, 0.0);
    assert!(bench.check(CheckAction::Check));
    let sent = &bench.shell.sent;
    let is_taken_away = |action: &Action| matches!(action, Action::Retract(_));
    assert!(sent.iter().any(is_taken_away), "{sent:?}");
}

#[test]
fn a_baseline_is_replaced_only_by_who_says_so() {
    let mut bench = Bench::new();
    bench.look_from(1, 0.0);
    bench.edit(|dialog| dialog.limits.shift = Metres::from_mm(30.0));
    assert!(bench.check(CheckAction::TakeBaseline));
    let first = bench.checks().content().baseline.clone().expect("taken");
    assert!((first.limits.shift.mm() - 30.0).abs() < 1e-9);
    bench.look_from(2, 0.02);
    assert!(bench.check(CheckAction::Check));
    let found = bench.checks().latest().map(|check| check.finding);
    assert_eq!(found, Some(CellFinding::InPlace), "within 30 mm");
    // The first press only asks; turning the page withdraws the question.
    assert!(!bench.check(CheckAction::TakeBaseline));
    assert!(bench.dialog().question.is_some());
    bench.edit(|dialog| dialog.page = RobotPage::InUse);
    assert!(bench.dialog().question.is_none());
    bench.edit(|dialog| dialog.page = RobotPage::Check);
    assert!(bench.work());
    let known = bench.checks().content().baseline.clone().expect("kept");
    assert_eq!(known.made_at, first.made_at);
    assert!(!bench.check(CheckAction::TakeBaseline));
    assert!(bench.check(CheckAction::TakeBaseline));
    assert!(bench.dialog().question.is_none());
    let second = bench.checks().content().baseline.clone().expect("taken");
    assert!(second.made_at > first.made_at);
    // A check against another baseline does not count for this one.
    assert!(bench.checks().latest().is_none());
    assert_eq!(bench.checks().content().checks.len(), 1);
}

#[test]
fn a_folder_that_cannot_be_written_says_so_and_the_finding_is_shown() {
    let mut bench = Bench::new();
    let lock = bench.folder.path().join("cell/.lock");
    fs::create_dir_all(&lock).expect("made");
    bench.look_from(1, 0.0);
    assert!(bench.check(CheckAction::TakeBaseline));
    assert!(!bench.problem().advice.is_empty());
    assert!(bench.checks().content().baseline.is_none());
    fs::remove_dir(&lock).expect("removed");
    assert!(bench.check(CheckAction::TakeBaseline));
    assert_eq!(bench.dialog().problem, None);
    fs::remove_file(&lock).expect("the lock of whoever wrote last");
    fs::create_dir(&lock).expect("made");
    assert!(bench.check(CheckAction::Check));
    assert!(!bench.problem().what.is_empty());
    let found = bench.checks().latest().map(|check| check.finding);
    assert_eq!(found, Some(CellFinding::InPlace));
    assert!(bench.checks().content().checks.is_empty());
}

#[test]
fn a_camera_gives_several_frames_and_can_be_given_up() {
    let mut bench = Bench::new();
    let spec = "simulated,fps=1000:fender".parse().expect("a source");
    bench.shell.session.source = Source::Camera(Box::new(spec));
    bench.apply(RobotAction::Check(CheckAction::TakeBaseline));
    assert!(bench.checks().running().is_some());
    bench.apply(RobotAction::Check(CheckAction::Cancel));
    assert!(bench.checks().running().is_none());
    bench.work();
    assert!(!bench.folder.path().join("cell").exists());
    // Closing the dialog cancels as well.
    bench.apply(RobotAction::Check(CheckAction::TakeBaseline));
    bench.apply(RobotAction::Close);
    assert!(bench.checks().running().is_none());
    bench.work();
    assert!(!bench.folder.path().join("cell").exists());
    bench.apply(RobotAction::Toggle);
    assert!(bench.check(CheckAction::TakeBaseline));
    let baseline = bench.checks().content().baseline.clone().expect("taken");
    assert_eq!(baseline.num_frames, USUAL_FRAMES);
    assert!(bench.check(CheckAction::Check));
    let check = bench.checks().latest().expect("a check");
    assert_eq!(check.finding, CellFinding::InPlace, "{check:?}");
    assert_eq!(check.num_frames, USUAL_FRAMES);
}

#[test]
fn of_the_simulated_cell_the_frame_in_front_is_looked_at() {
    let mut session = Session::default();
    let number = |session: &Session| match source(session).expect("a source") {
        SceneSource::Cell { number, .. } => number,
        other => panic!("{other:?}"),
    };
    assert_eq!(number(&session), 1, "before the first capture");
    let mut state = State::default();
    for _ in 0..2 {
        state.capture();
        assert!(state.inspector.run_waiting());
        inspect::update(&mut state);
    }
    assert_eq!(number(&state.session), 2);
    // A followed source counts as a camera.
    session.live.is_on = true;
    let followed = source(&session).expect("a source");
    assert!(matches!(followed, SceneSource::Camera(_)), "{followed:?}");
}
