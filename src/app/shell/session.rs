//! What the workspaces share. They read it; the shell alone changes it.

use std::{path::PathBuf, sync::Arc};

use serde::{Deserialize, Serialize};

use super::{
    current_trace::CurrentTrace,
    live::LiveState,
    message::ReinspectionPurpose,
    program_setup::ProgramSetup,
    robot::AnswerSetup,
    shift::{ShiftParts, ShiftStarts},
};
pub use crate::app::ui::theme::ThemeChoice;
use crate::{
    app::{
        inspection::{
            inspected::{InspectJob, InspectRequest, Inspected, SceneOrScan},
            library_cache::LibraryView,
            scan_choice::{ScanFiles, ScanOrder, ScanRequest},
            source::CellChoice,
            unit_system::UnitSystem,
        },
        language::{Language, text},
        user_error::UserError,
    },
    capture::SourceSpec,
    pipeline::NamedRecipe,
    robot::{Convention, RobotFrame},
    stages::scene::EmptyCell,
};

/// What the workspaces share.
#[derive(Debug, Default)]
pub struct Session {
    /// What Capture takes a scene from.
    pub source: Source,
    /// What the camera saw without a part, if that was taken.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// Scenes opened last, the newest first.
    pub recent: Vec<PathBuf>,
    /// The last result.
    pub shown: Option<Shown>,
    /// What the inspector is at.
    pub inspecting: Option<Inspecting>,
    /// Why the last run of the inspector came to no result.
    pub failed: Option<UserError>,
    /// Of the source that is followed.
    pub live: LiveState,
    /// The library in use, once loaded.
    pub library: Option<Arc<LibraryView>>,
    /// The library's folder that a person chose in the window.
    pub chosen_library: Option<PathBuf>,
    /// The parameters that scenes are inspected with.
    pub recipe: Arc<NamedRecipe>,
    /// In which numbers the robot is told a pose.
    pub convention: Convention,
    /// The arm and the gun of robot programs.
    pub program: ProgramSetup,
    /// Where the camera stands in the robot's base frame, if the cell is calibrated.
    pub robot: Option<Arc<RobotFrame>>,
    /// Whether robots that ask are answered, and where.
    pub answering: AnswerSetup,
    /// Which calibration of the robot's cell is used.
    pub cell: RememberedCell,
    /// Where the user's own calibration is; none: nowhere, and nothing is written.
    pub usual_cell: Option<PathBuf>,
    /// Units that lengths and angles are shown in.
    pub units: UnitSystem,
    /// Colours.
    pub theme: ThemeChoice,
    /// The language that the window speaks.
    pub language: Language,
    /// The one that was chosen in it; none: the system's.
    pub chosen_language: Option<Language>,
    /// Whose window it is.
    pub role: UserRole,
    /// What the next inspection is of.
    pub trace: CurrentTrace,
    /// When shifts start.
    pub shift_starts: ShiftStarts,
    /// The parts of this shift, while it is the operator's.
    pub shift: ShiftParts,
    /// The workspace in front.
    pub workspace: WorkspaceKind,
}

impl Session {
    /// The order to inspect something by the recipe and the calibration in use.
    pub fn inspect_job(&self, source: SceneOrScan) -> InspectJob {
        match source {
            SceneOrScan::Scene(source) => InspectJob::Scene(InspectRequest {
                source,
                recipe: Arc::clone(&self.recipe),
            }),
            SceneOrScan::Scan(order) => InspectJob::Scan(self.scan_request(order)),
        }
    }

    /// The order to put shots together by the calibration and the recipe in use.
    pub fn scan_request(&self, order: ScanOrder) -> ScanRequest {
        ScanRequest {
            order,
            calibration: self.calibration_path(),
            recipe: Arc::clone(&self.recipe),
        }
    }

    /// True while the operator's view takes the place of the bars, the rail and the panels of Inspect.
    pub fn is_operator_view(&self) -> bool {
        self.role == UserRole::Operator && self.workspace == WorkspaceKind::Inspect
    }

    /// True while the result shown is not what was asked for last.
    pub fn is_old(&self) -> bool {
        self.inspecting.is_some() && self.shown.is_some()
    }

    /// Where the camera stood in the robot's base frame: a scan says so itself, else the cell's calibration does.
    pub fn robot_of<'a>(&'a self, inspected: &'a Inspected) -> Option<&'a Arc<RobotFrame>> {
        match &inspected.scan {
            Some(scan) => Some(&scan.robot),
            None => self.robot.as_ref(),
        }
    }

    /// The file of the calibration in use, also while it is being loaded.
    pub fn calibration_path(&self) -> Option<PathBuf> {
        match &self.cell {
            RememberedCell::Usual => self.usual_cell.clone().filter(|path| path.exists()),
            RememberedCell::Forgotten => None,
            RememberedCell::File(path) => Some(path.clone()),
        }
    }
}

/// Which calibration a window starts with.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RememberedCell {
    /// The user's own, if there is one.
    #[default]
    Usual,
    /// None: a person had it forgotten.
    Forgotten,
    /// The one in this file.
    File(PathBuf),
}

/// What the inspector is at.
#[derive(Clone, Debug)]
pub struct Inspecting {
    /// What is being done, for a person.
    pub title: String,
    /// What for.
    pub purpose: ReinspectionPurpose,
}

/// Where Capture takes a scene from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// The simulated cell.
    Cell(CellChoice),
    /// A file, read again at each capture.
    File(PathBuf),
    /// The shots of a scan, read again at each capture.
    Scan(ScanFiles),
    /// A camera, a recording, a watched folder, or the simulated cell as somebody has set it up.
    Camera(Box<SourceSpec>),
}

impl Default for Source {
    fn default() -> Self {
        Self::Cell(CellChoice::default())
    }
}

/// A result, and the number by which what was made for it is known.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Another one for each result.
    pub generation: u64,
    /// The result.
    pub inspected: Arc<Inspected>,
    /// True if it was taken out of the history.
    pub is_past: bool,
    /// Of a frame among others: which session of following it belongs to.
    pub session: Option<u64>,
}

/// The workspaces that the rail lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WorkspaceKind {
    /// The operator's: which part is it, and is it accepted?
    #[default]
    Inspect,
    /// New parts.
    Enrol,
    /// The engineer's: why was this taken for that?
    Compare,
    /// Methods of pose estimation side by side.
    Align,
    /// Spray paths over enrolled parts, and their film.
    Paint,
    /// What was inspected before.
    History,
}

impl WorkspaceKind {
    /// Every workspace, in the order of the rail and of the number keys.
    pub const ALL: [Self; 6] = [
        Self::Inspect,
        Self::Enrol,
        Self::Compare,
        Self::Align,
        Self::Paint,
        Self::History,
    ];

    /// What a person calls it.
    pub fn title(self) -> String {
        match self {
            Self::Inspect => text!("shell-inspect"),
            Self::Enrol => text!("shell-enrol"),
            Self::Compare => text!("shell-compare"),
            Self::Align => text!("shell-align"),
            Self::Paint => text!("shell-paint"),
            Self::History => text!("shell-history"),
        }
    }
}

/// Who stands before the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UserRole {
    /// Watches verdicts, captures, exports.
    Operator,
    /// May change everything.
    #[default]
    Engineer,
}

impl UserRole {
    /// What a person calls it.
    pub fn title(self) -> String {
        match self {
            Self::Operator => text!("shell-operator"),
            Self::Engineer => text!("shell-engineer"),
        }
    }
}
