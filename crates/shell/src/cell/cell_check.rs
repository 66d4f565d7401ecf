//! The check of the cell in the window: the contents of its folder, and the task that takes baselines and makes checks.
//!
//! Frames come from the source in use; everything else is as in `partsight cell`.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::{Timestamp, tz::TimeZone};

use crate::{
    action::Action,
    inspection::{
        camera::Camera,
        source::{Captured, Origin, SceneError, SceneSource},
    },
    notice::Notice,
    session::{Session, Source, UserRole},
    workspace::ShellContext,
};
use capture::SourceSpec;
use files::write_atomically;
use inspection::pipeline::ProgressObserver as _;
use robot::cell_check::{
    CellBaseline, CellCheck, CellCheckError, CellCheckFolder, CellLimits, CellViewError, CellViews,
    USUAL_FRAMES, write_csv,
};
use stages::segment::SegmentParams;
use ui::{
    language::{advised, described, text},
    task::{Running, Task, TaskContext, TaskError, TaskRunner},
    user_error::UserError,
};

/// The baseline and the checks of the cell.
#[derive(Debug)]
pub struct CellChecks {
    /// `None` if nothing can be kept.
    folder: Option<CellCheckFolder>,
    content: CheckFolderContent,
    /// The last check made here, even if it could not be added to the list.
    made: Option<CellCheck>,
    task: Task<CheckAnswer>,
    /// Start of the operator's shift for which the folder was last read.
    shift: Option<Timestamp>,
    /// The warning shown to the operator.
    warning: Option<Notice>,
}

/// Contents of the folder.
#[derive(Clone, Debug, Default)]
pub struct CheckFolderContent {
    /// The baseline, if it is readable.
    pub baseline: Option<Arc<CellBaseline>>,
    /// True if there is a baseline, even an unreadable one.
    pub has_baseline: bool,
    /// All checks, oldest first.
    pub checks: Vec<CellCheck>,
    /// Why baseline or checks are unreadable.
    pub problems: Vec<UserError>,
}

/// Result of the task.
#[derive(Clone, Debug)]
struct CheckAnswer {
    /// The current contents of the folder.
    content: CheckFolderContent,
    /// The check, if one was made.
    made: Option<CellCheck>,
    /// Why the check could not be added to the list.
    problem: Option<UserError>,
    /// Further notices for the user.
    notices: Vec<Notice>,
}

impl CellChecks {
    /// Starts with a folder that has not been read yet.
    pub(super) fn new(folder: Option<CellCheckFolder>, runner: &TaskRunner) -> Self {
        Self {
            folder,
            content: CheckFolderContent::default(),
            made: None,
            task: Task::new("cell check", runner),
            shift: None,
            warning: None,
        }
    }

    /// True if there is a folder for baseline and checks.
    pub fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// The contents of the folder when it was last read.
    pub fn content(&self) -> &CheckFolderContent {
        &self.content
    }

    /// The running work, if any.
    pub fn running(&self) -> Option<&Running> {
        self.task.running()
    }

    /// The last check against the baseline in use.
    pub fn latest(&self) -> Option<&CellCheck> {
        let baseline = self.content.baseline.as_ref()?;
        let last = self.made.iter().chain(self.content.checks.last());
        last.filter(|check| check.baseline == baseline.made_at)
            .max_by_key(|check| check.at)
    }

    #[cfg(test)]
    pub(super) fn run_waiting(&self) -> bool {
        self.task.run_waiting()
    }

    /// Reads the folder, unless the task is busy.
    pub(super) fn read(&mut self) {
        if self.task.running().is_some() {
            return;
        }
        if let Some(folder) = self.folder.clone() {
            let job = move |_: &_| Ok(CheckAnswer::of(&folder));
            self.task.start(text!("robot-reading-checks"), job);
        }
    }

    /// Takes a baseline, which replaces the former one.
    pub(super) fn take_baseline(
        &mut self,
        limits: CellLimits,
        cx: &ShellContext<'_>,
    ) -> Result<(), UserError> {
        let look = Look::of(cx)?;
        if let Some(folder) = self.folder.clone() {
            let job = move |context: &_| take_baseline(&folder, &look, limits, context);
            self.task.start(text!("robot-taking-baseline"), job);
        }
        Ok(())
    }

    /// Compares the current frames with the baseline.
    pub(super) fn check(&mut self, cx: &ShellContext<'_>) -> Result<(), UserError> {
        let look = Look::of(cx)?;
        if let Some(folder) = self.folder.clone() {
            let job = move |context: &_| check(&folder, &look, context);
            self.task.start(text!("robot-checking"), job);
        }
        Ok(())
    }

    /// Writes the checks to a table.
    pub(super) fn export(&mut self, path: PathBuf) {
        if let Some(folder) = self.folder.clone() {
            let job = move |_: &_| export(&folder, &path);
            self.task.start(text!("robot-writing-checks"), job);
        }
    }

    /// Cancels the running work.
    pub(super) fn cancel(&mut self) {
        self.task.cancel();
    }

    /// Polls the task; returns what went wrong. Reads the folder at the start of an operator's shift.
    pub(super) fn update(&mut self, cx: &mut ShellContext<'_>) -> Option<UserError> {
        self.watch_shift(cx.session);
        match self.task.poll()? {
            Ok(answer) => self.receive(answer, cx),
            Err(error) => Some(error),
        }
    }

    fn receive(&mut self, answer: CheckAnswer, cx: &mut ShellContext<'_>) -> Option<UserError> {
        let CheckAnswer {
            content,
            made,
            problem,
            notices,
        } = answer;
        self.content = content;
        self.made = made.or(self.made.take());
        for notice in notices {
            cx.notify(notice);
        }
        self.warn(cx);
        problem
    }

    /// Reads the folder once per shift of an operator, because a command may have made the check.
    fn watch_shift(&mut self, session: &Session) {
        if session.role != UserRole::Operator {
            self.shift = None;
            return;
        }
        if self.folder.is_none() || self.task.running().is_some() {
            return;
        }
        let [since, _] = session.shift_starts.around(&geometry::clock::zoned_now());
        let since = since.map(|since| since.timestamp());
        if self.shift != since {
            self.shift = since;
            self.read();
        }
    }

    /// Warns an operator if the last check found that something moved; removes a warning that no longer holds.
    fn warn(&mut self, cx: &mut ShellContext<'_>) {
        let moved = self.latest().filter(|check| check.finding.has_moved());
        let warning = moved.map(|check| {
            let finding = marked(described(&check.finding), check.is_simulated);
            Notice::look(
                text!(
                    "robot-moved",
                    time = shown_time(check.at),
                    finding = finding
                ),
                text!("robot-moved-advice"),
            )
        });
        if self.warning != warning
            && let Some(former) = self.warning.take()
        {
            cx.send(Action::Retract(former));
        }
        if let (UserRole::Operator, Some(warning)) = (cx.session.role, warning) {
            cx.notify(warning.clone());
            self.warning = Some(warning);
        }
    }
}

/// Formats a moment in local time.
pub(super) fn shown_time(at: Timestamp) -> String {
    let at = at.to_zoned(TimeZone::system());
    at.strftime("%Y-%m-%d %H:%M").to_string()
}

/// Marks a text as simulated if no camera was read.
pub(super) fn marked(text: String, is_simulated: bool) -> String {
    if is_simulated {
        text!("shell-of-simulator", name = text)
    } else {
        text
    }
}

/// The source to look at, and how to find the part in it.
struct Look {
    source: SceneSource,
    params: SegmentParams,
    camera: Camera,
}

impl Look {
    fn of(cx: &ShellContext<'_>) -> Result<Self, UserError> {
        Ok(Self {
            source: source(cx.session)?,
            params: cx.session.recipe.segment.clone(),
            camera: cx.services.library_cache.camera().clone(),
        })
    }

    /// Takes the frames and finds the part in them; also returns notices about problems.
    fn views(
        &self,
        context: &TaskContext<CheckAnswer>,
    ) -> Result<(CellViews, Vec<Notice>), TaskError> {
        let is_cancelled = || context.is_cancelled();
        let frames: Vec<Captured> = match &self.source {
            SceneSource::Camera(spec) => {
                let num = num_frames(spec);
                context.progress(0, num);
                let came = |done| context.progress(done, num);
                let frames = self.camera.frames(spec, num, &is_cancelled, &came);
                let frames = frames.map_err(SceneError::from)?;
                frames.into_iter().map(Into::into).collect()
            }
            source => vec![source.take(&self.camera, &is_cancelled)?],
        };
        let mut views = CellViews::new(&self.params);
        let mut notices = Vec::new();
        for Captured {
            scene,
            origin,
            warnings,
        } in &frames
        {
            context.check()?;
            views.add(scene).map_err(|why| UserError {
                what: format!("{}: {}", origin.shown_title(), described(&why)),
                advice: advised(&why),
            })?;
            let errors = warnings.iter().map(UserError::of);
            notices.extend(errors.map(Notice::from));
        }
        Ok((views, notices))
    }
}

/// Returns the source of the frames. If the simulated cell is not followed, this is the shown frame of it.
fn source(session: &Session) -> Result<SceneSource, UserError> {
    match &session.source {
        Source::Camera(spec) => Ok(SceneSource::Camera(spec.clone())),
        Source::File(path) => Ok(SceneSource::File(path.clone())),
        Source::Cell(choice) if session.is_live() => {
            let followed = SourceSpec::Simulated(choice.followed());
            Ok(SceneSource::Camera(Box::new(followed)))
        }
        Source::Cell(choice) => {
            let shown = session.shown.as_ref().filter(|shown| !shown.is_past);
            let (choice, number) = match shown.map(|shown| &shown.inspected.origin) {
                Some(Origin::Simulated { choice, number }) => (*choice, *number),
                _ => (*choice, 1),
            };
            Ok(SceneSource::Cell { choice, number })
        }
        Source::Scan(_) => Err(UserError {
            what: text!("robot-check-of-scan"),
            advice: text!("robot-check-of-scan-advice"),
        }),
    }
}

/// Number of frames to take; only one from a watched folder, where the next may never come.
fn num_frames(spec: &SourceSpec) -> usize {
    match spec {
        SourceSpec::Watched(_) => 1,
        SourceSpec::Simulated(_)
        | SourceSpec::SimulatedRobot(_)
        | SourceSpec::Recording(_)
        | SourceSpec::Kinect(_)
        | SourceSpec::Genicam(_)
        | SourceSpec::OpenNi(_)
        | SourceSpec::Realsense(_) => USUAL_FRAMES,
    }
}

impl CheckAnswer {
    /// Reads the folder.
    fn of(folder: &CellCheckFolder) -> Self {
        Self {
            content: CheckFolderContent::read(folder),
            made: None,
            problem: None,
            notices: Vec::new(),
        }
    }
}

impl CheckFolderContent {
    fn read(folder: &CellCheckFolder) -> Self {
        let mut content = Self {
            has_baseline: true,
            ..Self::default()
        };
        match folder.baseline() {
            Ok(baseline) => content.baseline = Some(Arc::new(baseline)),
            Err(CellCheckError::NoBaseline { .. }) => content.has_baseline = false,
            Err(error) => content.problems.push(UserError::of(&error)),
        }
        match folder.checks() {
            Ok(checks) => content.checks = checks,
            Err(error) => content.problems.push(UserError::of(&error)),
        }
        content
    }
}

fn take_baseline(
    folder: &CellCheckFolder,
    look: &Look,
    limits: CellLimits,
    context: &TaskContext<CheckAnswer>,
) -> Result<CheckAnswer, TaskError> {
    let (taken, notices) = look.views(context)?;
    let baseline = CellBaseline::new(
        &taken.views,
        limits,
        taken.is_simulated,
        geometry::clock::now(),
    );
    let baseline = baseline.map_err(|error| in_words(&error))?;
    // A cancelled run saves nothing.
    context.check()?;
    let saved = folder.save(&baseline);
    saved.map_err(|error| UserError::of(&error))?;
    Ok(CheckAnswer {
        notices,
        ..CheckAnswer::of(folder)
    })
}

fn check(
    folder: &CellCheckFolder,
    look: &Look,
    context: &TaskContext<CheckAnswer>,
) -> Result<CheckAnswer, TaskError> {
    let baseline = folder.baseline().map_err(|error| match error {
        CellCheckError::NoBaseline { .. } => no_baseline(),
        error => UserError::of(&error),
    })?;
    let (taken, notices) = look.views(context)?;
    let made = baseline.check(&taken.views, taken.is_simulated, geometry::clock::now());
    let made = made.map_err(|error| in_words(&error))?;
    context.check()?;
    // Show the check even if it cannot be added to the list.
    let problem = folder.add(&made).err().map(|error| UserError::of(&error));
    Ok(CheckAnswer {
        made: Some(made),
        problem,
        notices,
        ..CheckAnswer::of(folder)
    })
}

fn export(folder: &CellCheckFolder, path: &Path) -> Result<CheckAnswer, TaskError> {
    let checks = folder.checks().map_err(|error| UserError::of(&error))?;
    let written = write_atomically(path, |writer| write_csv(writer, &checks));
    written.map_err(|error| UserError::of(&error))?;
    let done = text!(
        "robot-checks-written",
        count = checks.len(),
        path = path.display().to_string()
    );
    Ok(CheckAnswer {
        notices: vec![Notice::done(done)],
        ..CheckAnswer::of(folder)
    })
}

/// The error that there is nothing to compare with.
pub(super) fn no_baseline() -> UserError {
    UserError {
        what: text!("robot-no-baseline"),
        advice: text!("robot-no-baseline-advice"),
    }
}

fn in_words(error: &CellViewError) -> UserError {
    UserError {
        what: described(error),
        advice: advised(error),
    }
}

#[cfg(test)]
mod tests {
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
}
