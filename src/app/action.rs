//! Everything a person or a thread can cause, and the one function that makes it so.

use std::{path::PathBuf, sync::Arc};

use super::{
    answers,
    inspect::{
        self, scan,
        state::InspectAction,
        work::{InspectRequest, Inspected},
    },
    job::{Request, TaskOutcome, Trouble},
    lane::TaskQueue,
    live::{self, LiveAction},
    robot::RobotAction,
    roles::{self, RoleAction},
    shelf::LibraryView,
    shell::message::SceneOrScan,
    shots::{Asked, ScanFiles, ScanOrder, ScanRequest, ShotsAction, ShotsFile},
    source::{CellChoice, SceneSource, file_name},
    state::{
        Event, HelpPage, Notice, NoticeKind, ReinspectionPurpose, Shown, Source, StagePanel, State,
        Workspace,
    },
    worker::TaskEvent,
};
use crate::{
    capture::{Pace, RecordingSpec, SourceSpec, WatchedFrom, WatchedSpec},
    robot::Convention,
    stages::segment::EmptyCell,
};

/// Something that happened.
#[derive(Debug)]
pub enum Action {
    /// Take a scene from the source and inspect it.
    Capture,
    /// Capture from the simulated cell, with this in it.
    UseCell(CellChoice),
    /// Take the scene in front as the empty cell: what stands in it is not taken for a part from now on.
    TakeEmptyCell,
    /// Forget the empty cell.
    ForgetEmptyCell,
    /// Have a person choose a file or folder.
    Ask(DialogRequest),
    /// A person chose it.
    Chosen(DialogRequest, PathBuf),
    /// Open this file, or the scan in this folder, and inspect or enrol it.
    Open(PathBuf),
    /// Use the library that is found without choosing one.
    UseFoundLibrary,
    /// Give up what this lane is at.
    Cancel(TaskQueue),
    /// Bring a workspace to the front.
    GoTo(Workspace),
    /// Fill the middle with a stage.
    Enlarge(StagePanel),
    /// Compare contour and signature with the part at this place of the ranking.
    Candidate(usize),
    /// Close what lies on top: the shortcuts, then an enlarged stage.
    CloseTop,
    /// Change the units.
    SwitchUnits,
    /// Change the colours.
    SwitchTheme,
    /// Open or close the list of shortcuts.
    ToggleHelp,
    /// Take a notice away.
    Dismiss(usize),
    /// Show a notice.
    Notify(Notice),
    /// Close the window.
    Quit,
    /// Tell the robot poses in these numbers.
    UseConvention(Convention),
    /// The next of the conventions.
    NextConvention,
    /// Put the pose on the clipboard, in the convention that was chosen.
    CopyPose,
    /// Of the source and of following it.
    Live(LiveAction),
    /// Of whose window it is.
    Role(RoleAction),
    /// Of the shots of the scan that Inspect shows.
    Shots(ShotsAction),
    /// Of the Inspect workspace.
    Inspect(InspectAction),
    /// Take back what the last notice offers to.
    Undo,
    /// The key at this place of a workspace's own was pressed.
    Press(Workspace, usize),
    /// Cancel what a workspace is at.
    CancelTask(Workspace),
    /// The engineer's view, which a workspace asked for, is there.
    EngineerIn(Workspace),
    /// Show a past inspection that is still in memory.
    ShowPast(Arc<Inspected>),
    /// Of the robot's cell.
    Robot(RobotAction),
    /// A thread has news.
    Hear(TaskQueue, TaskEvent<TaskOutcome>),
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DialogRequest {
    /// A captured scene to open.
    Scene,
    /// The folder of a scan to open.
    Scan,
    /// The file of the poses of a scan.
    ScanPoses,
    /// A frame to add to the scan in front.
    Shot,
    /// The folder of a recording to play.
    Recording,
    /// A folder to watch for captures.
    WatchedFolder,
    /// The folder that the source is recorded in.
    RecordTo,
    /// The folder of another library.
    Library,
    /// The folder that the report of the inspection in front goes to.
    ReportFolder,
    /// Where a picture of the 3-D view is to go.
    Picture,
    /// A scene, a whole cloud or a mesh to enrol.
    Part,
    /// Where the spray path of the inspection in front goes.
    SprayPath,
}

/// What is to be done outside the state.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Have this done, on the lane of the request.
    Post {
        /// Its generation.
        generation: u64,
        /// The request.
        request: Request,
    },
    /// Have this lane give up.
    CancelWork(TaskQueue),
    /// Show the system's dialog.
    ShowDialog(DialogRequest),
    /// Have a workspace do what its key at this place does.
    Press(Workspace, usize),
    /// Have a workspace cancel what it is at.
    CancelTask(Workspace),
    /// Have the workspace in front take this.
    Take(SceneOrScan, String),
    /// Have this done about the robot's cell.
    Robot(RobotAction),
    /// Put this on the clipboard.
    CopyText(String),
    /// Tell every workspace.
    Tell(Event),
    /// Tell this workspace that the engineer's view is there.
    EngineerIn(Workspace),
    /// Close the window.
    Close,
    /// All of this.
    Several(Vec<Effect>),
}

/// More notices than this push the oldest out.
const MAX_NOTICES: usize = 4;

/// Carries out an action.
pub fn apply(state: &mut State, action: Action) -> Option<Effect> {
    let action = roles::permitted(state, action)?;
    match action {
        Action::Capture => return Some(capture(state)),
        Action::UseCell(choice) => {
            state.source = Source::Cell(choice);
            return live::source_changed(state);
        }
        Action::TakeEmptyCell => return take_empty_cell(state),
        Action::ForgetEmptyCell => {
            state.empty_cell = None;
            notify(state, Notice::done("The empty cell is forgotten"));
            return live::restart_consensus(state);
        }
        Action::Ask(DialogRequest::Scene) if state.workspace == Workspace::Enrol => {
            return Some(Effect::ShowDialog(DialogRequest::Part));
        }
        Action::Ask(ask) => return Some(Effect::ShowDialog(ask)),
        Action::Chosen(ask, path) => return chosen(state, ask, path),
        Action::Open(path) if path.is_dir() => return chosen(state, DialogRequest::Scan, path),
        Action::Open(path) => return chosen(state, DialogRequest::Scene, path),
        Action::UseFoundLibrary => {
            state.chosen_library = None;
            return Some(open_library(state));
        }
        Action::Cancel(TaskQueue::Live) => return None,
        Action::Cancel(lane) => {
            state.works.remove(&lane);
            return Some(Effect::CancelWork(lane));
        }
        Action::GoTo(workspace) => state.workspace = workspace,
        Action::Enlarge(panel) => state.enlarged = Some(panel),
        Action::Candidate(place) => state.candidate = place,
        Action::CloseTop => {
            if state.help == HelpPage::Open {
                state.help = HelpPage::Closed;
            } else {
                state.enlarged = None;
            }
        }
        Action::SwitchUnits => state.units = state.units.other(),
        Action::UseConvention(convention) => state.convention = convention,
        Action::NextConvention => {
            let all = Convention::ALL;
            let place = all.iter().position(|known| *known == state.convention);
            state.convention = all[place.map_or(0, |place| (place + 1) % all.len())];
        }
        Action::SwitchTheme => state.theme = state.theme.other(),
        Action::ToggleHelp => {
            state.help = match state.help {
                HelpPage::Closed => HelpPage::Open,
                HelpPage::Open => HelpPage::Closed,
            }
        }
        Action::Dismiss(place) => {
            if place < state.notices.len() {
                state.notices.remove(place);
            }
        }
        Action::Notify(notice) => notify(state, notice),
        Action::Quit => return Some(Effect::Close),
        Action::CopyPose => {
            let shown = state.shown.as_ref()?;
            let Some(numbered) = inspect::numbered(state, &shown.inspected) else {
                notify(state, no_pose());
                return None;
            };
            let title = numbered.pose.convention.title();
            let what = format!("Copied {} in the numbers of {title}", numbered.name);
            notify(state, Notice::done(what));
            return Some(Effect::CopyText(inspect::clipboard_text(&numbered)));
        }
        Action::Role(action) => return roles::apply(state, action),
        Action::Live(action) => return live::apply(state, action),
        Action::Shots(action) => return scan::apply(state, action),
        Action::Inspect(action) => return inspect::state::apply(state, action),
        Action::Undo => return Some(Effect::Tell(Event::Undo)),
        Action::Press(workspace, place) => return Some(Effect::Press(workspace, place)),
        Action::CancelTask(workspace) => return Some(Effect::CancelTask(workspace)),
        Action::EngineerIn(workspace) => return Some(Effect::EngineerIn(workspace)),
        Action::ShowPast(inspected) => return show_past(state, inspected),
        Action::Robot(action) => return Some(Effect::Robot(action)),
        Action::Hear(lane, news) => return answers::hear(state, lane, news),
    }
    None
}

/// What follows from the file or folder that was chosen.
fn chosen(state: &mut State, ask: DialogRequest, path: PathBuf) -> Option<Effect> {
    match ask {
        DialogRequest::Scene | DialogRequest::Part => {
            state.source = Source::File(path);
            Some(capture(state))
        }
        DialogRequest::Scan => {
            state.source = Source::Scan(ScanFiles::of_folder(path));
            Some(capture(state))
        }
        DialogRequest::ScanPoses => scan::apply(state, ShotsAction::Chosen(ShotsFile::Poses, path)),
        DialogRequest::Shot => scan::apply(state, ShotsAction::Chosen(ShotsFile::Shot, path)),
        DialogRequest::Recording => {
            let spec = SourceSpec::Recording(RecordingSpec {
                folder: path,
                pace: Some(Pace::AsTaken),
                camera: None,
            });
            live::apply(state, LiveAction::Use(spec))
        }
        DialogRequest::WatchedFolder => {
            let spec = SourceSpec::Watched(WatchedSpec {
                folder: path,
                from: WatchedFrom::default(),
            });
            live::apply(state, LiveAction::Use(spec))
        }
        DialogRequest::RecordTo => live::apply(state, LiveAction::Record(path)),
        DialogRequest::Library => {
            state.chosen_library = Some(path);
            Some(open_library(state))
        }
        DialogRequest::ReportFolder => export(state, path),
        DialogRequest::Picture => {
            state.inspect.picture_to = Some(path);
            None
        }
        DialogRequest::SprayPath => inspect::state::write_spray_path(state, path),
    }
}

/// Asks for a scene from the source: to be inspected, or to be enrolled while that is in front. To be inspected it is a
/// single one, and ends following the source.
pub(super) fn capture(state: &mut State) -> Effect {
    let (source, what) = match &state.session.source {
        Source::Cell(choice) => {
            state.num_captures += 1;
            let source = SceneSource::Cell {
                choice: *choice,
                number: state.num_captures,
            };
            (SceneOrScan::Scene(source), "Capturing".to_owned())
        }
        Source::File(path) => (
            SceneOrScan::Scene(SceneSource::File(path.clone())),
            format!("Opening {}", file_name(path)),
        ),
        Source::Scan(files) => {
            let order = ScanOrder::Open(files.clone());
            let what = order.title();
            (SceneOrScan::Scan(order), what)
        }
        Source::Camera(spec) => {
            let what = match **spec {
                SourceSpec::Watched(_) => "Waiting for a new file".to_owned(),
                _ => "Capturing".to_owned(),
            };
            let source = SceneSource::Camera(spec.clone());
            (SceneOrScan::Scene(source), what)
        }
    };
    if state.workspace == Workspace::Enrol {
        return Effect::Take(source, what);
    }
    let source = match source {
        SceneOrScan::Scene(source) => source,
        SceneOrScan::Scan(order) => return scan::begin(state, order, Asked::first()),
    };
    let source = match &state.empty_cell {
        Some(cell) => SceneSource::Before(Arc::clone(cell), Box::new(source)),
        None => source,
    };
    let recipe = Arc::clone(&state.recipe);
    state.begin(what, Request::Inspect(InspectRequest { source, recipe }))
}

/// The scene in front becomes the empty cell.
fn take_empty_cell(state: &mut State) -> Option<Effect> {
    let shown = state.shown.as_ref()?;
    let inspection = &shown.inspected.inspection;
    if inspection.verdict.is_accepted() {
        let hangs_there = Notice {
            kind: NoticeKind::Look,
            what: "This is no empty cell: a part hangs in it, and would not be found any more"
                .into(),
            advice: "Take the part away, capture, and take the empty cell then".into(),
        };
        notify(state, hangs_there);
        return None;
    }
    let stands_there = inspection.segmentation.part.is_ok();
    match EmptyCell::of(&shown.inspected.scene) {
        Ok(cell) => {
            state.empty_cell = Some(Arc::new(cell));
            let what = "The empty cell is taken: from the next capture on, what stands in it is not taken for a part";
            let taken = if stands_there {
                Notice {
                    kind: NoticeKind::Look,
                    what: "The empty cell is taken, with something as large as a part in it".into(),
                    advice: "If that is a part: Source, Forget the empty cell; then take it away and capture first".into(),
                }
            } else {
                Notice::done(what)
            };
            notify(state, taken);
            live::restart_consensus(state)
        }
        Err(error) => {
            notify(state, Trouble::of(&error).into());
            None
        }
    }
}

/// Asks for the library that was chosen.
fn open_library(state: &mut State) -> Effect {
    let chosen = state.chosen_library.clone();
    state.begin("Opening the library", Request::Library(chosen))
}

/// Writes the report of the inspection in front, with a picture of its view where that is in sight.
fn export(state: &mut State, folder: PathBuf) -> Option<Effect> {
    if state.workspace == Workspace::Inspect && state.shown.is_some() {
        // The view hands its picture over with the next frame.
        state.inspect.report_to = Some(folder);
        return None;
    }
    inspect::state::write_report(state, folder, None)
}

fn no_pose() -> Notice {
    Notice {
        kind: NoticeKind::Look,
        what: "There is no pose to copy: the part was not accepted".into(),
        advice: "Do as the card says, and capture again".into(),
    }
}

/// Inspects the scene in front again: something that its result rests on has changed.
pub(super) fn inspect_again(state: &mut State) -> Option<Effect> {
    if state.is_live() {
        return live::restart_consensus(state);
    }
    let request = inspection_of_shown(state)?;
    Some(state.inspect("Inspecting again", request, ReinspectionPurpose::Repeated))
}

/// The scene in front, to be inspected with what holds now.
pub(super) fn inspection_of_shown(state: &State) -> Option<Request> {
    let shown = state.shown.as_ref()?;
    Some(scan::inspection_again(&state.session, &shown.inspected))
}

/// Uses the library that was changed, and inspects what was saved in it, else the scene in front.
pub(super) fn library_changed(
    state: &mut State,
    library: &Arc<LibraryView>,
    saved: Option<SceneOrScan>,
) -> Option<Effect> {
    answers::use_library(state, library);
    let is_busy = state.works.contains_key(&TaskQueue::Inspect);
    let request = match saved {
        Some(SceneOrScan::Scene(source)) => {
            let recipe = Arc::clone(&state.recipe);
            Some(Request::Inspect(InspectRequest { source, recipe }))
        }
        Some(SceneOrScan::Scan(order)) => {
            Some(Request::InspectScan(ScanRequest::of(order, &state.session)))
        }
        None if is_busy => None,
        None => inspection_of_shown(state),
    };
    let purpose = ReinspectionPurpose::New;
    Some(state.inspect("Inspecting again", request?, purpose))
}

/// Shows a past inspection that is still in memory.
fn show_past(state: &mut State, inspected: Arc<Inspected>) -> Option<Effect> {
    state.generation += 1;
    state.candidate = 0;
    state.shown = Some(Shown {
        generation: state.generation,
        inspected,
        is_past: true,
        session: None,
    });
    state.workspace = Workspace::Inspect;
    live::stop_live(state)
}

/// Shows a notice.
pub(super) fn notify(state: &mut State, notice: Notice) {
    // The same again says nothing new.
    state.notices.retain(|known| *known != notice);
    state.notices.push(notice);
    let num_over = state.notices.len().saturating_sub(MAX_NOTICES);
    state.notices.drain(..num_over);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::{job::answer, shelf::LibraryCache, worker::JobContext},
        pipeline::{ProgressObserver, Stage},
    };

    fn posted(effect: Option<Effect>) -> (u64, Request) {
        match effect {
            Some(Effect::Post {
                generation,
                request,
            }) => (generation, request),
            other => panic!("expected a request, found {other:?}"),
        }
    }

    struct DetachedContext;

    impl ProgressObserver for DetachedContext {}

    impl JobContext<TaskOutcome> for DetachedContext {
        fn progress(&self, _done: usize, _total: usize) {}
        fn publish_partial(&self, _outcome: TaskOutcome) {}
        fn stands(&self, _outcome: TaskOutcome) {}
        fn wants_more(&self) -> bool {
            true
        }
    }

    fn done(generation: u64, outcome: TaskOutcome) -> Action {
        let news = TaskEvent::Done {
            generation,
            outcome,
        };
        Action::Hear(TaskQueue::Inspect, news)
    }

    fn trouble() -> Trouble {
        Trouble {
            what: "broken".into(),
            advice: "mend it".into(),
        }
    }

    #[test]
    fn a_result_stays_and_is_old_until_the_next_is_there() {
        let mut state = State::default();
        let (generation, request) = posted(apply(&mut state, Action::Capture));
        assert!(!state.is_old() && state.works.contains_key(&TaskQueue::Inspect));
        let first = answer(request, &LibraryCache::default(), &DetachedContext).expect("answered");
        apply(&mut state, done(generation, first));
        assert!(state.shown.is_some() && state.works.is_empty());
        assert!(matches!(
            apply(&mut state, Action::CopyPose),
            Some(Effect::CopyText(_))
        ));
        apply(&mut state, Action::TakeEmptyCell);
        assert!(state.empty_cell.is_none(), "a part hangs there");
        let said = state.notices.last().map(|notice| notice.what.clone());
        assert!(said.is_some_and(|said| said.contains("no empty cell")));

        apply(&mut state, Action::Capture);
        assert!(state.is_old());
        assert!(matches!(
            apply(&mut state, Action::Cancel(TaskQueue::Inspect)),
            Some(Effect::CancelWork(TaskQueue::Inspect))
        ));
        assert!(!state.is_old() && state.shown.is_some());
    }

    #[test]
    fn news_of_an_older_request_are_thrown_away() {
        let mut state = State::default();
        let (older, _) = posted(apply(&mut state, Action::Capture));
        let (newer, _) = posted(apply(&mut state, Action::Open("b.pcd".into())));
        apply(&mut state, done(older, Err(trouble())));
        assert!(state.notices.is_empty() && state.works.contains_key(&TaskQueue::Inspect));
        let begins = TaskEvent::Begins {
            generation: newer,
            stage: Stage::Contour,
        };
        apply(&mut state, Action::Hear(TaskQueue::Inspect, begins));
        assert_eq!(
            state.work().and_then(|(_, work)| work.stage),
            Some(Stage::Contour)
        );
        apply(&mut state, done(newer, Err(trouble())));
        assert_eq!(state.notices.len(), 1);
        assert!(state.works.is_empty() && state.shown.is_none());
    }

    #[test]
    fn captures_are_enrolled_while_the_workspace_is_in_front_and_inspected_otherwise() {
        let mut state = State::default();
        for action in [Action::Capture, Action::Open("door.pcd".into())] {
            let (_, request) = posted(apply(&mut state, action));
            assert_eq!(request.lane(), TaskQueue::Inspect);
        }
        state.workspace = Workspace::Enrol;
        for action in [Action::Capture, Action::Open("door.pcd".into())] {
            let effect = apply(&mut state, action);
            assert!(
                matches!(effect, Some(Effect::Take(SceneOrScan::Scene(_), _))),
                "{effect:?}"
            );
        }
    }

    #[test]
    fn escape_closes_the_shortcuts_before_the_enlarged_stage() {
        let mut state = State::default();
        apply(&mut state, Action::Enlarge(StagePanel::Contour));
        apply(&mut state, Action::ToggleHelp);
        apply(&mut state, Action::CloseTop);
        assert_eq!(
            (state.help, state.enlarged),
            (HelpPage::Closed, Some(StagePanel::Contour))
        );
        apply(&mut state, Action::CloseTop);
        assert_eq!(state.enlarged, None);
    }

    #[test]
    fn only_the_latest_notices_stay_and_none_twice() {
        let mut state = State::default();
        for number in [0, 1, 2, 3, 4, 5, 5] {
            apply(&mut state, Action::Notify(Notice::done(number.to_string())));
        }
        let what: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
        assert_eq!(what, ["2", "3", "4", "5"]);
        apply(&mut state, Action::Dismiss(0));
        apply(&mut state, Action::Dismiss(9));
        assert_eq!(state.notices.len(), 3);
    }
}
