//! The actions of the window outside the workspaces, and the events that it sends to them.

use std::{path::PathBuf, sync::Arc};

use crate::{
    cell::{AnswerSetup, ProgramSetup, RobotAction, ServoSettings},
    help::Help,
    inspection::{
        inspected::{InspectJob, Inspected},
        library_cache::LibraryView,
        source::{CellChoice, ScanOrder, SceneOrScan},
    },
    notice::{Notice, NoticeTopic},
    rack::RackAction,
    roles::RoleAction,
    session::{PaintTab, ReinspectionPurpose, RememberedCell, Source, WorkspaceKind},
    source::live::LiveAction,
    trace::orders::ExpectAction,
};
use inspection::{library::Truth, pipeline::NamedRecipe};
use records::history::{HungId, NewEntry, TraceChange, Traceability};
use robot::{Convention, RobotFrame};
use ui::language::Language;

/// An action of the user, of a workspace or of the shell itself.
#[derive(Clone, Debug)]
pub enum Action {
    /// Take a scene from the source and inspect it.
    Capture,
    /// Capture from the simulated cell with this content.
    UseCell(CellChoice),
    /// Show the part at this index of the frame in front.
    SelectPart(usize),
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
    /// Ask the operator what the part on the screen really is.
    WrongPart,
    /// Close what is on top: Help, then an enlarged stage.
    CloseTop,
    /// Switch the units.
    SwitchUnits,
    /// Switch the colours.
    SwitchTheme,
    /// Use another language.
    Speak(Language),
    /// Open or close Help.
    ToggleHelp,
    /// Show this in Help, while it is open.
    EditHelp(Help),
    /// Remove the notice at this index.
    Dismiss(usize),
    /// Remove all notices.
    DismissAll,
    /// Open the file of the notice at this index again, as the notice offers.
    Reread(usize),
    /// Show a notice.
    Notify(Notice),
    /// Close the window, discarding unsaved data.
    CloseAnyway,
    /// Keep the window open.
    StayOpen,
    /// Show, copy and write poses in this convention.
    UseConvention(Convention),
    /// An action on what is expected.
    Expect(ExpectAction),
    /// An action on the followed source.
    Live(LiveAction),
    /// An action on the rack.
    Rack(RackAction),
    /// An action on the roles.
    Role(RoleAction),
    /// Perform the key at this index of a workspace's own keys.
    Press(WorkspaceKind, usize),
    /// Cancel the running work of a workspace.
    CancelTask(WorkspaceKind),
    /// Hand a scene or scan with this title to the workspace in front.
    Take(SceneOrScan, String),
    /// Inspect this file, or enrol it if Enrol is in front.
    TakeFile(PathBuf),
    /// An action on the robot's cell.
    Robot(RobotAction),
    /// Send an event to every workspace.
    Tell(Event),
    /// Ask for the engineer's view, and tell this workspace once it is granted.
    AskEngineer(WorkspaceKind),
    /// Close the window, unless something would be lost.
    Close,
    /// Remove this notice, if it is still shown.
    Retract(Notice),
    /// Remove the notices about this.
    RemoveNotices(NoticeTopic),
    /// Remove the offer to undo from the notices of this workspace.
    WithdrawUndo(WorkspaceKind),
    /// Copy this to the clipboard.
    CopyText(String),
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
    /// Show this tab of Paint.
    ShowPaintTab(PaintTab),
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
    /// The file of a rack to use.
    Rack,
    /// The file to write the rack in use to.
    SaveRack,
    /// The table of orders.
    Orders,
    /// The file to write a problem report to.
    ProblemReport,
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
    /// The operator says that this part, the one on the screen, was recognised wrongly.
    WrongPart(HungId),
    /// The operator says what a part really is.
    Labelled {
        /// The part.
        part: HungId,
        /// What it really is.
        label: Truth,
        /// Its true label before.
        former: Option<Truth>,
    },
    /// Show the statistics of the part of this name, which a trend will refuse.
    Drift(String),
    /// The user wants to undo what the last notice of this workspace offers to undo.
    Undo(WorkspaceKind),
}
