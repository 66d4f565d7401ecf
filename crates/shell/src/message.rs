//! Messages from the workspaces to the shell, and events from the shell to the workspaces.

use std::sync::Arc;

use super::{
    notice::{Notice, NoticeTopic},
    session::{ReinspectionPurpose, RememberedCell, Source, WorkspaceKind},
};
use crate::{
    action::Action,
    cell::{AnswerSetup, ProgramSetup, ServoSettings},
    inspection::{
        inspected::{InspectJob, Inspected},
        library_cache::LibraryView,
        scan_choice::ScanOrder,
        source::SceneOrScan,
    },
};
use inspection::pipeline::NamedRecipe;
use records::history::{HungId, NewEntry, TraceChange, Traceability};
use robot::RobotFrame;

/// A request of a workspace to the shell.
#[derive(Clone, Debug)]
pub enum Message {
    /// Show a notice.
    Notify(Notice),
    /// Remove this notice, if it is still shown.
    Retract(Notice),
    /// Remove the notices about this.
    RemoveNotices(NoticeTopic),
    /// Remove the offer to undo from the workspace's notices.
    WithdrawUndo,
    /// Copy this to the clipboard.
    CopyText(String),
    /// Carry out this action, if the role permits it.
    Act(Action),
    /// Take scenes from this source from the next capture on.
    UseSource(Source),
    /// Use this recipe from now on.
    UseRecipe(Arc<NamedRecipe>),
    /// Use this calibration of the robot's cell, with the robot frame that it gives.
    UseCalibration(RememberedCell, Option<Arc<RobotFrame>>),
    /// Answer robots with these settings.
    UseAnswering(AnswerSetup),
    /// Write robot programs for this arm and gun.
    UseProgramSetup(ProgramSetup),
    /// Servo with these settings.
    UseServoSettings(ServoSettings),
    /// The library was changed: use it. If Live is on, it starts over; else inspect `saved`, or the scene in front unless
    /// another inspection is running.
    LibraryChanged {
        /// The changed library.
        library: Arc<LibraryView>,
        /// The saved scene or scan, if it can be inspected and nothing newer was captured.
        saved: Option<SceneOrScan>,
    },
    /// Inspect this, and show the result.
    Inspect {
        /// Description for the user.
        title: String,
        /// The scene or scan to inspect.
        job: InspectJob,
        /// Purpose of the inspection.
        purpose: ReinspectionPurpose,
        /// The hung part, if this is another inspection of it; `None` for something new.
        hung: Option<HungId>,
        /// Traceability of that part.
        trace: Traceability,
    },
    /// Inspect the scene in front again, as a new inspection.
    InspectShown {
        /// Description for the user.
        title: String,
    },
    /// Show a past inspection in Inspect.
    ShowPast(Arc<Inspected>),
    /// Ask for the engineer's view; [`Event::EngineerIn`] follows once it is granted.
    AskEngineer,
}

/// An event that the shell sends to workspaces.
#[derive(Clone, Debug)]
pub enum Event {
    /// A scene was inspected.
    Inspected {
        /// The parts of the frame, at least one.
        parts: Vec<Arc<Inspected>>,
        /// Purpose of the inspection.
        purpose: ReinspectionPurpose,
    },
    /// A part left the followed source before its verdict counted, or following stopped before.
    Left(Box<NewEntry>),
    /// The traceability of this part, which has been recorded, changed after its verdict.
    TracedLate(HungId, TraceChange),
    /// The poses of these shots were not found: the user has to choose their file.
    PosesWanted(ScanOrder),
    /// Ask the user where to save the report of the inspection in front.
    Export,
    /// Esc was pressed with nothing on top of the workspaces.
    Escape,
    /// The engineer's view, requested by this workspace, was granted.
    EngineerIn,
    /// The user says that this part, the one on the screen, was recognised wrongly.
    WrongPart(HungId),
    /// The user wants to undo what the last notice of this workspace offers to undo.
    Undo(WorkspaceKind),
}
