//! What the operator's view lets through.

use super::{Action, RoleAction, WorkspaceKind};
use crate::app::shell::{
    action::DialogRequest,
    live::LiveAction,
    robot::{CheckAction, RobotAction},
};

/// True for the workspaces in which nothing can be changed that verdicts rest on.
pub(in crate::app) fn is_operators(workspace: WorkspaceKind) -> bool {
    match workspace {
        WorkspaceKind::Inspect | WorkspaceKind::History => true,
        WorkspaceKind::Enrol
        | WorkspaceKind::Compare
        | WorkspaceKind::Align
        | WorkspaceKind::Paint => false,
    }
}

/// True for what changes recipe, thresholds, library or cell, and for what only the engineer's workspaces do.
///
/// Every action is named: a new one has to be thought about.
pub(super) fn needs_engineer(action: &Action) -> bool {
    match action {
        Action::GoTo(workspace) | Action::Press(workspace, _) => !is_operators(*workspace),
        Action::Ask(ask) | Action::Chosen(ask, _) => asks_for_engineer(*ask),
        Action::Role(action) => matches!(
            action,
            RoleAction::SetPin | RoleAction::RemovePin | RoleAction::LockAfter(_)
        ),
        // Averaged depth is part of what a verdict rests on.
        Action::Live(action) => matches!(action, LiveAction::Average(_)),
        Action::Robot(action) => !matches!(
            action,
            RobotAction::Close | RobotAction::Check(CheckAction::Cancel)
        ),
        // The robot's controller expects one of them.
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
