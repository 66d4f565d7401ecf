//! Everything a person or a thread can cause, and the one function that makes it so.

use std::{path::PathBuf, sync::Arc};

use super::{
    answers,
    inspect::{self, scan, state::InspectAction, work::Inspected},
    job::{Request, TaskOutcome},
    lane::TaskQueue,
    live::{self, LiveAction},
    robot::RobotAction,
    roles::{self, RoleAction},
    shell::message::SceneOrScan,
    shots::{ScanFiles, ShotsAction, ShotsFile},
    source::CellChoice,
    state::{Event, HelpPage, Notice, NoticeKind, Source, StagePanel, State, Workspace},
    worker::TaskEvent,
};
use crate::{
    capture::{Pace, RecordingSpec, SourceSpec, WatchedFrom, WatchedSpec},
    robot::Convention,
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
    /// Cancel what the inspector is at.
    CancelInspection,
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
        Action::Capture => return state.capture(),
        Action::UseCell(choice) => {
            state.source = Source::Cell(choice);
            return live::source_changed(state);
        }
        Action::TakeEmptyCell => state.take_empty_cell(),
        Action::ForgetEmptyCell => {
            state.empty_cell = None;
            notify(state, Notice::done("The empty cell is forgotten"));
            live::restart_consensus(state);
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
            state.open_library();
        }
        Action::CancelInspection => state.inspector.cancel(),
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
        Action::ShowPast(inspected) => state.show_past(inspected),
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
            state.capture()
        }
        DialogRequest::Scan => {
            state.source = Source::Scan(ScanFiles::of_folder(path));
            state.capture()
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
            state.open_library();
            None
        }
        DialogRequest::ReportFolder => export(state, path),
        DialogRequest::Picture => {
            state.inspect.picture_to = Some(path);
            None
        }
        DialogRequest::SprayPath => inspect::state::write_spray_path(state, path),
    }
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

    #[test]
    fn captures_are_enrolled_while_the_workspace_is_in_front_and_inspected_otherwise() {
        let mut state = State::default();
        for action in [Action::Capture, Action::Open("door.pcd".into())] {
            assert!(apply(&mut state, action).is_none());
            assert!(state.inspector.running().is_some());
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
