//! What the operator's view permits.

use super::{Action, RoleAction, WorkspaceKind};
use crate::{
    action::DialogRequest,
    cell::{CheckAction, RobotAction},
    source::live::LiveAction,
    trace::orders::ExpectAction,
};

/// True for workspaces that cannot change anything verdicts depend on.
pub(crate) fn is_operators(workspace: WorkspaceKind) -> bool {
    match workspace {
        WorkspaceKind::Inspect | WorkspaceKind::History => true,
        WorkspaceKind::Enrol
        | WorkspaceKind::Compare
        | WorkspaceKind::Align
        | WorkspaceKind::Paint
        | WorkspaceKind::Servo => false,
    }
}

/// True for actions that change recipe, thresholds, library or cell, and for those of the engineer's workspaces; with a PIN,
/// also for those that change the source.
///
/// Lists every action, so that each new one needs a decision.
pub(super) fn needs_engineer(action: &Action, has_pin: bool) -> bool {
    match action {
        Action::GoTo(workspace) | Action::Press(workspace, _) => {
            !is_operators(*workspace)
        }
        Action::Ask(ask) | Action::Chosen(ask, _) => asks_for_engineer(*ask, has_pin),
        Action::Role(action) => matches!(
            action,
            RoleAction::SetPin | RoleAction::RemovePin | RoleAction::LockAfter(_)
        ),
        // Choosing another source changes what is captured next; an opened file becomes the source.
        Action::Live(LiveAction::Use(_) | LiveAction::SetUp(Some(_)))
        | Action::UseCell(_)
        | Action::Open(_)
        | Action::Take(..) | Action::TakeFile(_) => has_pin,
        Action::Robot(action) => !matches!(
            action,
            RobotAction::Close | RobotAction::Check(CheckAction::Cancel)
        ),
        // The robot's controller expects a certain convention.
        Action::UseConvention(_)
        | Action::Rack(_)
        | Action::TakeEmptyCell
        | Action::ForgetEmptyCell
        | Action::UseFoundLibrary
        | Action::EngineerIn(_)
        // Otherwise an order would not be compared with what hangs there.
        | Action::Expect(ExpectAction::CloseOrders)
        // Verdicts depend on the averaging of depth.
        | Action::Live(LiveAction::Average(_)) => true,
        Action::Live(_)
        | Action::Expect(ExpectAction::Parts(_))
        | Action::Capture
        | Action::CancelInspection
        | Action::SelectPart(_)
        | Action::CancelTask(_)
        | Action::Tell(_)
        | Action::Close
        // What workspaces send: the operator's may, and the others' are the engineer's.
        | Action::Retract(_)
        | Action::RemoveNotices(_)
        | Action::WithdrawUndo(_)
        | Action::CopyText(_)
        | Action::UseSource(_)
        | Action::UseRecipe(_)
        | Action::UseCalibration(..)
        | Action::UseAnswering(_)
        | Action::UseProgramSetup(_)
        | Action::UseServoSettings(_)
        | Action::LibraryChanged { .. }
        | Action::Inspect { .. }
        | Action::InspectShown { .. }
        | Action::ShowPast(_)
        | Action::CloseTop
        | Action::SwitchUnits
        | Action::SwitchTheme
        | Action::Speak(_)
        | Action::ToggleHelp
        | Action::Dismiss(_)
        | Action::DismissAll
        | Action::Reread(_)
        | Action::Notify(_)
        | Action::CloseAnyway
        | Action::StayOpen
        | Action::WrongPart => false,
    }
}

fn asks_for_engineer(ask: DialogRequest, has_pin: bool) -> bool {
    match ask {
        DialogRequest::Library
        | DialogRequest::Part
        | DialogRequest::Orders
        | DialogRequest::Rack
        | DialogRequest::SaveRack => true,
        DialogRequest::Scene
        | DialogRequest::Scan
        | DialogRequest::Recording
        | DialogRequest::WatchedFolder => has_pin,
        DialogRequest::RecordTo => false,
    }
}
