//! Carries out the actions of the window outside the workspaces.

use std::path::{self, PathBuf};

use crate::{
    action::{Action, DialogRequest, Event},
    cell::AnswerSetup,
    help::{self, Help},
    inspection::source::ScanFiles,
    notice::{Notice, NoticeKind},
    rack::{self, RackAction},
    roles,
    session::{ReinspectionPurpose, Source, WorkspaceKind},
    source::live::{self, LiveAction},
    state::{Closing, State, notify, remove_notices},
    trace::expecting,
};
use capture::{Pace, RecordingSpec, SourceSpec, WatchedFrom, WatchedSpec};
use ui::language::text;

/// Carries out an action; returns it, or the one that follows from it, if it reaches beyond the state.
pub fn apply(state: &mut State, action: Action) -> Option<Action> {
    let action = roles::permitted(state, action)?;
    match action {
        Action::Capture => return state.capture(),
        Action::UseCell(choice) => {
            state.inspector.former_source = None;
            state.session.source = Source::Cell(choice);
            return live::source_changed(state);
        }
        Action::SelectPart(index) => state.select_part(index),
        Action::TakeEmptyCell => state.take_empty_cell(),
        Action::ForgetEmptyCell => {
            state.session.empty_cell = None;
            notify(state, Notice::done(text!("shell-empty-cell-discarded")));
            live::restart_consensus(state);
        }
        Action::Ask(DialogRequest::Scene) if state.session.workspace == WorkspaceKind::Enrol => {
            return Some(Action::Ask(DialogRequest::Part));
        }
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
            return Some(Action::Tell(Event::WrongPart(part)));
        }
        Action::CloseTop if state.help.is_some() => state.help = None,
        Action::CloseTop => return Some(Action::Tell(Event::Escape)),
        Action::SwitchUnits => state.session.units = state.session.units.other(),
        Action::UseConvention(convention) => state.session.convention = convention,
        Action::SwitchTheme => state.session.theme = state.session.theme.other(),
        Action::Speak(language) => {
            state.session.language = language;
            state.session.chosen_language = Some(language);
        }
        Action::ToggleHelp => state.help = state.help.is_none().then(Help::default),
        Action::EditHelp(help) => state.help = state.help.is_some().then_some(help),
        Action::Dismiss(index) => {
            take_notice(state, index);
        }
        Action::DismissAll => state.notices.clear(),
        Action::Reread(index) => {
            let path = take_notice(state, index)?.in_millimetres;
            return path.map(Action::TakeFile);
        }
        Action::Notify(notice) => notify(state, notice),
        Action::Retract(notice) => state.notices.retain(|known| *known != notice),
        Action::RemoveNotices(topic) => remove_notices(state, topic),
        Action::WithdrawUndo(workspace) => withdraw_undo(state, workspace),
        Action::CloseAnyway => {
            state.closing = Closing::Confirmed;
            return Some(Action::Close);
        }
        Action::StayOpen => state.closing = Closing::No,
        Action::Rack(action) => rack::apply(state, action),
        Action::Expect(action) => expecting::apply(state, action),
        Action::Role(action) => return roles::apply(state, action),
        Action::Live(action) => return live::apply(state, action),
        Action::UseSource(source) => state.session.source = source,
        Action::UseRecipe(recipe) => state.session.recipe = recipe,
        Action::UseCalibration(cell, robot) => state.use_calibration(cell, robot),
        Action::UseAnswering(setup) => return use_answering(state, setup),
        Action::UseProgramSetup(setup) => state.session.program = setup,
        Action::UseServoSettings(setup) => state.session.servo = setup,
        Action::ShowPaintTab(tab) => state.session.paint_tab = tab,
        Action::LibraryChanged { library, saved } => state.library_changed(&library, saved),
        Action::Inspect {
            title,
            job,
            purpose,
            hung,
            trace,
        } => state.inspect_again_as(title, job, purpose, hung, trace),
        Action::InspectShown { title } => state.inspect_shown(&title, ReinspectionPurpose::New),
        Action::ShowPast(inspected) => state.show_past(inspected),
        Action::Ask(_)
        | Action::Press(..)
        | Action::CancelTask(_)
        | Action::Take(..)
        | Action::TakeFile(_)
        | Action::Robot(_)
        | Action::Tell(_)
        | Action::AskEngineer(_)
        | Action::CopyText(_)
        | Action::Close => return Some(action),
    }
    None
}

/// Removes the notice at this index.
fn take_notice(state: &mut State, index: usize) -> Option<Notice> {
    (index < state.notices.len()).then(|| state.notices.remove(index))
}

/// Removes the offer to undo from the notices of this workspace.
fn withdraw_undo(state: &mut State, workspace: WorkspaceKind) {
    for notice in &mut state.notices {
        if notice.kind == NoticeKind::Undoable(workspace) {
            notice.kind = NoticeKind::Done;
        }
    }
}

/// Answers robots with these settings. Follows the source once they are answered: without frames no trigger could be.
fn use_answering(state: &mut State, setup: AnswerSetup) -> Option<Action> {
    let session = &mut state.session;
    let was_on = std::mem::replace(&mut session.answering, setup).is_on;
    let can_follow = !session.is_live() && session.source.followed().is_some();
    if setup.is_on && !was_on && can_follow {
        return live::apply(state, LiveAction::Toggle);
    }
    None
}

/// Handles the file or folder that was chosen.
fn chosen(state: &mut State, ask: DialogRequest, path: PathBuf) -> Option<Action> {
    // The path is remembered, and the next start may be in another working folder.
    let path = path::absolute(&path).unwrap_or(path);
    match ask {
        DialogRequest::Scene | DialogRequest::Part => return state.open(Source::File(path)),
        DialogRequest::Scan => return state.open(Source::Scan(ScanFiles::of_folder(path))),
        DialogRequest::Recording => {
            let spec = SourceSpec::Recording(RecordingSpec {
                folder: path,
                pace: Some(Pace::AsTaken),
                camera: None,
            });
            return live::apply(state, LiveAction::Use(spec));
        }
        DialogRequest::WatchedFolder => {
            let spec = SourceSpec::Watched(WatchedSpec {
                folder: path,
                from: WatchedFrom::default(),
            });
            return live::apply(state, LiveAction::Use(spec));
        }
        DialogRequest::Rack => rack::apply(state, RackAction::Open(path)),
        DialogRequest::SaveRack => rack::apply(state, RackAction::Save(path)),
        DialogRequest::RecordTo => return live::apply(state, LiveAction::Record(path)),
        DialogRequest::Library => state.open_library(Some(path)),
        DialogRequest::Orders => expecting::use_orders(state, path),
        DialogRequest::ProblemReport => help::report::write(state, path),
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{inspection::source::SceneOrScan, notice::NoticeTopic};

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
                matches!(effect, Some(Action::Take(SceneOrScan::Scene(_), _))),
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
        crate::source::inspect::update(&mut state);
        let remembered = Settings::of(&state, None).library;
        assert_eq!(remembered, Some(here.join("src")));
    }

    #[test]
    fn escape_closes_help_before_the_enlarged_stage() {
        let mut state = State::default();
        apply(&mut state, Action::ToggleHelp);
        assert!(apply(&mut state, Action::CloseTop).is_none());
        assert!(state.help.is_none());
        let effect = apply(&mut state, Action::CloseTop);
        assert!(matches!(effect, Some(Action::Tell(Event::Escape))));
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
    fn problems_with_one_way_out_are_one_notice_that_counts_them() {
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
            Notice::undoable("Saved", WorkspaceKind::Enrol),
            port(1),
            Notice::undoable("Undone: Saved", WorkspaceKind::Paint),
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
