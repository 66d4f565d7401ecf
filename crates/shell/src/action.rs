//! The actions of the window outside the workspaces, and their effects outside its state.

use std::path::PathBuf;

use crate::{
    cell::RobotAction,
    inspection::source::{CellChoice, SceneOrScan},
    message::Event,
    notice::Notice,
    rack::RackAction,
    roles::RoleAction,
    session::WorkspaceKind,
    source::live::LiveAction,
    trace::orders::ExpectAction,
};
use robot::Convention;
use ui::language::Language;

/// An action of the user or of the shell itself.
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
    /// Show the part on the screen in History, so that the user can set its actual part.
    WrongPart,
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
    /// Have this done outside the state, which does not change.
    Make(Effect),
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
