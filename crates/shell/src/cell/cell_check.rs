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
mod tests;
