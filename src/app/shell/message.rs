//! What workspaces and shell tell each other.

use std::sync::Arc;

use super::{
    notice::Notice,
    program_setup::ProgramSetup,
    robot::AnswerSetup,
    session::{RememberedCell, Source, WorkspaceKind},
};
use crate::{
    app::inspection::{
        inspected::{InspectJob, Inspected, SceneOrScan},
        library_cache::LibraryView,
        scan_choice::ScanOrder,
    },
    history::{HungId, NewEntry, Traceability},
    pipeline::NamedRecipe,
    robot::{Convention, RobotFrame},
};

/// What a workspace asks of the shell.
#[derive(Clone, Debug)]
pub enum Message {
    /// Show a notice.
    Notify(Notice),
    /// Take this notice away, if it is still shown.
    Retract(Notice),
    /// No notice offers any more to take something back.
    WithdrawUndo,
    /// Put this on the clipboard.
    CopyText(String),
    /// Bring this workspace to the front.
    GoTo(WorkspaceKind),
    /// Take scenes from here at the next capture.
    UseSource(Source),
    /// Have a person choose the folder of a scan, and take it as if it were captured.
    OpenScan,
    /// Inspect scenes with this recipe from now on.
    UseRecipe(Arc<NamedRecipe>),
    /// Use this calibration of the robot's cell, with where the camera stands by it.
    UseCalibration(RememberedCell, Option<Arc<RobotFrame>>),
    /// Answer robots that ask like this.
    UseAnswering(AnswerSetup),
    /// Tell the robot poses in these numbers.
    UseConvention(Convention),
    /// Write robot programs for this arm and gun.
    UseProgramSetup(ProgramSetup),
    /// Record the source that is followed, or no longer.
    ToggleRecording,
    /// The library was changed: use it, and inspect what was saved, else the scene in front unless another one is being
    /// inspected.
    LibraryChanged {
        /// The library as it is now.
        library: Arc<LibraryView>,
        /// What was saved in it, if it can be inspected.
        saved: Option<SceneOrScan>,
    },
    /// Inspect this, and show the result.
    Inspect {
        /// What is being done, for a person.
        title: String,
        /// What to inspect.
        job: InspectJob,
        /// What for.
        purpose: ReinspectionPurpose,
        /// The part in the history, if this is an inspection of it.
        hung: Option<HungId>,
        /// Serial number, order and operator of the inspection that is made again.
        trace: Traceability,
    },
    /// Inspect the scene in front once more, as an inspection of its own.
    InspectShown {
        /// What is being done, for a person.
        title: String,
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
    /// Other shots of the scan that Inspect shows.
    Shots,
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
    /// A part left the source that is followed before its verdict counted.
    Left(Box<NewEntry>),
    /// The poses of these shots were not found: a person has to name their file.
    PosesWanted(ScanOrder),
    /// Ask where the report of the inspection in front goes.
    Export,
    /// Esc was pressed while nothing lay over the workspaces.
    Escape,
    /// The engineer's view, which this workspace asked for, is there.
    EngineerIn,
    /// A person takes back what the last notice offered to.
    Undo,
}
