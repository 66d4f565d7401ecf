//! The actions of the window outside the workspaces, and the function that applies them.

use std::path::{self, PathBuf};

use super::{
    message::Event,
    notice::{Notice, NoticeTopic},
    roles::{self, RoleAction},
    session::{Source, WorkspaceKind},
    state::State,
};
use crate::{
    cell::RobotAction,
    frame::closing::Closing,
    inspection::{inspected::SceneOrScan, scan_choice::ScanFiles, source::CellChoice},
    source::live::{self, LiveAction},
};
use capture::{Pace, RecordingSpec, SourceSpec, WatchedFrom, WatchedSpec};
use robot::Convention;
use ui::language::{Language, text};

/// An action of the user or of the shell itself.
#[derive(Debug)]
pub enum Action {
    /// Take a scene from the source and inspect it.
    Capture,
    /// Capture from the simulated cell with this content.
    UseCell(CellChoice),
    /// Take the scene in front as the empty cell, so that nothing in it is taken for a part from now on.
    TakeEmptyCell,
    /// Discard the empty cell.
    ForgetEmptyCell,
    /// Ask the user to choose a file or folder.
    Ask(DialogRequest),
    /// The user chose this file or folder.
    Chosen(DialogRequest, PathBuf),
    /// Open this file, or the scan in this folder, and inspect or enrol it.
    Open(PathBuf),
    /// Use the library that is found when none is chosen.
    UseFoundLibrary,
    /// Cancel the running inspection.
    CancelInspection,
    /// Bring a workspace to the front.
    GoTo(WorkspaceKind),
    /// Show the part on the screen in History, so that the user can set its actual part.
    WrongPart,
    /// Ask where to save the report of the inspection in front.
    Export,
    /// Close what is on top: the shortcuts, then an enlarged stage.
    CloseTop,
    /// Switch the units.
    SwitchUnits,
    /// Switch the colours.
    SwitchTheme,
    /// Use another language.
    Speak(Language),
    /// Open or close the list of shortcuts.
    ToggleHelp,
    /// Remove the notice at this index.
    Dismiss(usize),
    /// Remove all notices.
    DismissAll,
    /// Open the file of the notice at this index again, as the notice offers.
    Reread(usize),
    /// Show a notice.
    Notify(Notice),
    /// Close the window.
    Quit,
    /// Close the window, discarding unsaved data.
    CloseAnyway,
    /// Keep the window open.
    StayOpen,
    /// Show, copy and write poses in this convention.
    UseConvention(Convention),
    /// An action on the followed source.
    Live(LiveAction),
    /// An action on the roles.
    Role(RoleAction),
    /// Undo what the last notice offers to undo.
    Undo,
    /// The key at this index of a workspace's own keys was pressed.
    Press(WorkspaceKind, usize),
    /// Cancel the running work of a workspace.
    CancelTask(WorkspaceKind),
    /// The engineer's view, requested by a workspace, was granted.
    EngineerIn(WorkspaceKind),
    /// An action on the robot's cell.
    Robot(RobotAction),
}

/// A choice of a file or folder by the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DialogRequest {
    /// A captured scene to open.
    Scene,
    /// The folder of a scan to open.
    Scan,
    /// The folder of a recording to play.
    Recording,
    /// A folder to watch for captures.
    WatchedFolder,
    /// The folder to record the source into.
    RecordTo,
    /// The folder of another library.
    Library,
    /// A scene, a whole cloud or a mesh to enrol.
    Part,
}

/// Work to be done outside the state.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Show the system's dialog.
    ShowDialog(DialogRequest),
    /// Perform the key at this index of a workspace's own keys.
    Press(WorkspaceKind, usize),
    /// Cancel the running work of a workspace.
    CancelTask(WorkspaceKind),
    /// Hand a scene or scan with this title to the workspace in front.
    Take(SceneOrScan, String),
    /// Inspect this file, or enrol it if Enrol is in front.
    TakeFile(PathBuf),
    /// Carry out an action on the robot's cell.
    Robot(RobotAction),
    /// Send an event to every workspace.
    Tell(Event),
    /// Tell this workspace that the engineer's view was granted.
    EngineerIn(WorkspaceKind),
    /// Close the window.
    Close,
}

/// Maximum number of notices; the oldest is dropped for another.
const MAX_NOTICES: usize = 4;

/// Carries out an action.
pub fn apply(state: &mut State, action: Action) -> Option<Effect> {
    let action = roles::permitted(state, action)?;
    match action {
        Action::Capture => return state.capture(),
        Action::UseCell(choice) => {
            state.inspector.former_source = None;
            state.session.source = Source::Cell(choice);
            return live::source_changed(state);
        }
        Action::TakeEmptyCell => state.take_empty_cell(),
        Action::ForgetEmptyCell => {
            state.session.empty_cell = None;
            notify(state, Notice::done(text!("shell-empty-cell-discarded")));
            live::restart_consensus(state);
        }
        Action::Ask(DialogRequest::Scene) if state.session.workspace == WorkspaceKind::Enrol => {
            return Some(Effect::ShowDialog(DialogRequest::Part));
        }
        Action::Ask(ask) => return Some(Effect::ShowDialog(ask)),
        Action::Chosen(ask, path) => return chosen(state, ask, path),
        Action::Open(path) if path.is_dir() => return chosen(state, DialogRequest::Scan, path),
        Action::Open(path) => return chosen(state, DialogRequest::Scene, path),
        Action::UseFoundLibrary => state.open_library(None),
        Action::CancelInspection => state.cancel_inspection(),
        Action::GoTo(workspace) => {
            state.session.workspace = workspace;
            if workspace == WorkspaceKind::Inspect {
                live::show_unseen(state);
            }
        }
        Action::WrongPart => {
            let part = state.session.current_result()?.hung().clone();
            state.session.workspace = WorkspaceKind::History;
            return Some(Effect::Tell(Event::WrongPart(part)));
        }
        Action::Export => return Some(Effect::Tell(Event::Export)),
        Action::CloseTop => {
            if state.is_help_open {
                state.is_help_open = false;
            } else {
                return Some(Effect::Tell(Event::Escape));
            }
        }
        Action::SwitchUnits => state.session.units = state.session.units.other(),
        Action::UseConvention(convention) => state.session.convention = convention,
        Action::SwitchTheme => state.session.theme = state.session.theme.other(),
        Action::Speak(language) => {
            state.session.language = language;
            state.session.chosen_language = Some(language);
        }
        Action::ToggleHelp => state.is_help_open = !state.is_help_open,
        Action::Dismiss(place) => {
            if place < state.notices.len() {
                state.notices.remove(place);
            }
        }
        Action::DismissAll => state.notices.clear(),
        Action::Reread(place) => {
            if place < state.notices.len() {
                let notice = state.notices.remove(place);
                return notice.in_millimetres.map(Effect::TakeFile);
            }
        }
        Action::Notify(notice) => notify(state, notice),
        Action::Quit => return Some(Effect::Close),
        Action::CloseAnyway => {
            state.closing = Closing::Confirmed;
            return Some(Effect::Close);
        }
        Action::StayOpen => state.closing = Closing::No,
        Action::Role(action) => return roles::apply(state, action),
        Action::Live(action) => return live::apply(state, action),
        Action::Undo => return Some(Effect::Tell(Event::Undo)),
        Action::Press(workspace, place) => return Some(Effect::Press(workspace, place)),
        Action::CancelTask(workspace) => return Some(Effect::CancelTask(workspace)),
        Action::EngineerIn(workspace) => return Some(Effect::EngineerIn(workspace)),
        Action::Robot(action) => return Some(Effect::Robot(action)),
    }
    None
}

/// Handles the file or folder that was chosen.
fn chosen(state: &mut State, ask: DialogRequest, path: PathBuf) -> Option<Effect> {
    // The path is remembered, and the next start may be in another working folder.
    let path = path::absolute(&path).unwrap_or(path);
    match ask {
        DialogRequest::Scene | DialogRequest::Part => state.open(Source::File(path)),
        DialogRequest::Scan => state.open(Source::Scan(ScanFiles::of_folder(path))),
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
            state.open_library(Some(path));
            None
        }
    }
}

/// Removes the notices about this.
pub fn remove_notices(state: &mut State, topic: NoticeTopic) {
    state.notices.retain(|notice| notice.topic != topic);
}

/// Shows a notice.
pub fn notify(state: &mut State, mut notice: Notice) {
    let covered = state.notices.iter();
    let num_covered: usize = covered.map(|known| known.num_covered_by(&notice)).sum();
    notice.num_more += num_covered;
    state.notices.retain(|known| !known.gives_way_to(&notice));
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
        state.session.workspace = WorkspaceKind::Enrol;
        for action in [Action::Capture, Action::Open("door.pcd".into())] {
            let effect = apply(&mut state, action);
            assert!(
                matches!(effect, Some(Effect::Take(SceneOrScan::Scene(_), _))),
                "{effect:?}"
            );
        }
    }

    #[test]
    fn a_relative_path_is_remembered_from_the_root_on() {
        use crate::settings::Settings;
        let here = std::env::current_dir().expect("a folder");
        let mut state = State::default();
        apply(&mut state, Action::Open("door.pcd".into()));
        let remembered = Settings::of(&state, None).source;
        assert_eq!(remembered, Source::File(here.join("door.pcd")));
        apply(&mut state, Action::Open("src".into()));
        let scan = ScanFiles::of_folder(here.join("src"));
        let remembered = Settings::of(&state, None).source;
        assert_eq!(remembered, Source::Scan(scan));
        let watched = Action::Chosen(DialogRequest::WatchedFolder, "captures".into());
        apply(&mut state, watched);
        let remembered = Settings::of(&state, None).source;
        let Some(SourceSpec::Watched(spec)) = remembered.followed() else {
            panic!("{remembered:?}");
        };
        assert_eq!(spec.folder, here.join("captures"));
        let library = Action::Chosen(DialogRequest::Library, "src".into());
        apply(&mut state, library);
        assert!(state.inspector.run_waiting());
        crate::source::inspector::update(&mut state);
        let remembered = Settings::of(&state, None).library;
        assert_eq!(remembered, Some(here.join("src")));
    }

    #[test]
    fn escape_closes_the_shortcuts_before_the_enlarged_stage() {
        let mut state = State::default();
        apply(&mut state, Action::ToggleHelp);
        assert!(apply(&mut state, Action::CloseTop).is_none());
        assert!(!state.is_help_open);
        let effect = apply(&mut state, Action::CloseTop);
        assert!(matches!(effect, Some(Effect::Tell(Event::Escape))));
    }

    #[test]
    fn only_the_latest_notices_stay_and_none_twice() {
        let mut state = State::default();
        for number in [0, 1, 2, 3, 4, 5, 5] {
            apply(
                &mut state,
                Action::Notify(Notice::look(number.to_string(), "")),
            );
        }
        let what: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
        assert_eq!(what, ["2", "3", "4", "5"]);
        apply(&mut state, Action::Dismiss(0));
        apply(&mut state, Action::Dismiss(9));
        assert_eq!(state.notices.len(), 3);
    }

    #[test]
    fn troubles_with_one_way_out_are_one_notice_that_counts_them() {
        let mut state = State::default();
        let unread = |file: &str| Notice::look(format!("{file} ends early"), "Copy it again");
        for file in ["a.png", "b.png", "b.png", "c.png"] {
            apply(&mut state, Action::Notify(unread(file)));
        }
        let other = Notice::look("no camera", "Plug it in");
        apply(&mut state, Action::Notify(other));
        let shown = state.notices.iter();
        let shown: Vec<_> = shown.map(|n| (n.what.as_str(), n.num_more)).collect();
        assert_eq!(shown, [("c.png ends early", 2), ("no camera", 0)]);
        apply(&mut state, Action::DismissAll);
        assert!(state.notices.is_empty());
    }

    #[test]
    fn a_success_replaces_the_former_one_and_a_topic_has_one_notice() {
        let mut state = State::default();
        let port =
            |number: u8| Notice::look(format!("port {number}"), "").about(NoticeTopic::Answering);
        for notice in [
            Notice::undoable("Saved"),
            port(1),
            Notice::undoable("Undone: Saved"),
            port(2),
            Notice::done("Saved again"),
        ] {
            apply(&mut state, Action::Notify(notice));
        }
        let what: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
        assert_eq!(what, ["port 2", "Saved again"]);
        remove_notices(&mut state, NoticeTopic::Answering);
        assert_eq!(state.notices.len(), 1);
    }
}
