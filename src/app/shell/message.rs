//! What workspaces and shell tell each other.

use std::sync::Arc;

use super::{
    notice::Notice,
    session::{RememberedCell, WorkspaceKind},
};
use crate::{
    app::inspect::work::{InspectRequest, Inspected},
    pipeline::Recipe,
    robot::RobotFrame,
};

/// What a workspace asks of the shell.
#[derive(Clone, Debug)]
pub enum Message {
    /// Show a notice.
    Notify(Notice),
    /// Take this notice away, if it is still shown.
    Retract(Notice),
    /// Put this on the clipboard.
    CopyText(String),
    /// Bring this workspace to the front.
    GoTo(WorkspaceKind),
    /// Inspect scenes with this recipe from now on.
    UseRecipe(Arc<Recipe>),
    /// Use this calibration of the robot's cell, with where the camera stands by it.
    UseCalibration(RememberedCell, Option<Arc<RobotFrame>>),
    /// Inspect this, and show the result.
    Inspect {
        /// What is being done, for a person.
        title: String,
        /// What to inspect.
        request: InspectRequest,
        /// What for.
        purpose: ReinspectionPurpose,
    },
    /// Inspect the scene in front once more, as an inspection of its own.
    InspectShown {
        /// What is being done, for a person.
        title: &'static str,
    },
    /// Show a past inspection in the Inspect workspace.
    ShowPast(Arc<Inspected>),
    /// Ask for the engineer's view; once it is there, [`Event::EngineerIn`] answers.
    AskEngineer,
}

/// What a scene is inspected for. It comes back with the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReinspectionPurpose {
    /// An inspection of its own.
    #[default]
    New,
    /// The scene in front once more: something else has changed that the result rests on.
    Repeated,
    /// A past inspection once more.
    Past,
}

/// What the shell tells a workspace.
#[derive(Clone, Debug)]
pub enum Event {
    /// A scene was inspected.
    Inspected {
        /// The result.
        inspected: Arc<Inspected>,
        /// What it was inspected for.
        purpose: ReinspectionPurpose,
    },
    /// The engineer's view, which this workspace asked for, is there.
    EngineerIn,
}
