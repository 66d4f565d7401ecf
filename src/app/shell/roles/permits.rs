//! What the operator's view permits.

use super::{Action, RoleAction, WorkspaceKind};
use crate::app::shell::{
    action::DialogRequest,
    live::LiveAction,
    robot::{CheckAction, RobotAction},
};

/// True for workspaces that cannot change anything verdicts depend on.
pub(in crate::app) fn is_operators(workspace: WorkspaceKind) -> bool {
    match workspace {
        WorkspaceKind::Inspect | WorkspaceKind::History => true,
        WorkspaceKind::Enrol
        | WorkspaceKind::Compare
        | WorkspaceKind::Align
        | WorkspaceKind::Paint => false,
    }
}

/// True for actions that change recipe, thresholds, library or cell, and for those of the engineer's workspaces.
///
/// Lists every action, so that each new one needs a decision.
pub(super) fn needs_engineer(action: &Action) -> bool {
    match action {
        Action::GoTo(workspace) | Action::Press(workspace, _) => !is_operators(*workspace),
        Action::Ask(ask) | Action::Chosen(ask, _) => asks_for_engineer(*ask),
        Action::Role(action) => matches!(
            action,
            RoleAction::SetPin | RoleAction::RemovePin | RoleAction::LockAfter(_)
        ),
        // Verdicts depend on the averaging of depth.
        Action::Live(action) => matches!(action, LiveAction::Average(_)),
        Action::Robot(action) => !matches!(
            action,
            RobotAction::Close | RobotAction::Check(CheckAction::Cancel)
        ),
        // The robot's controller expects a certain convention.
        Action::UseConvention(_)
        | Action::TakeEmptyCell
        | Action::ForgetEmptyCell
        | Action::UseFoundLibrary => true,
        Action::Capture
        | Action::UseCell(_)
        | Action::Open(_)
        | Action::CancelInspection
        | Action::CancelTask(_)
        | Action::EngineerIn(_)
        | Action::Export
        | Action::CloseTop
        | Action::SwitchUnits
        | Action::SwitchTheme
        | Action::Speak(_)
        | Action::ToggleHelp
        | Action::Dismiss(_)
        | Action::Reread(_)
        | Action::Notify(_)
        | Action::Quit
        | Action::CloseAnyway
        | Action::StayOpen
        | Action::Undo => false,
    }
}

fn asks_for_engineer(ask: DialogRequest) -> bool {
    match ask {
        DialogRequest::Library | DialogRequest::Part => true,
        DialogRequest::Scene
        | DialogRequest::Scan
        | DialogRequest::Recording
        | DialogRequest::WatchedFolder
        | DialogRequest::RecordTo => false,
    }
}
