//! What the window knows: plain data, without any type of the user interface.

use std::{collections::BTreeMap, path::PathBuf, sync::Arc};

use super::{
    action::Effect,
    align::AlignState,
    compare::CompareState,
    enrol::EnrolState,
    history::HistoryState,
    inspect::{state::InspectState, work::Inspected},
    job::{Request, Trouble},
    lane::Lane,
    live::{self, LiveState},
    robot::RobotState,
    roles::RoleState,
    shelf::LibraryShown,
    source::CellChoice,
    unit_system::UnitSystem,
};
use crate::{
    capture::SourceSpec,
    pipeline::{Recipe, Stage},
    robot::{Convention, RobotFrame},
    stages::segment::EmptyCell,
};

/// Everything that the panels read. Only [`apply`](super::action::apply) changes it.
#[derive(Debug, Default)]
pub struct State {
    /// What Capture takes a scene from.
    pub source: Source,
    /// What the camera saw without a part, if that was taken.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// The last result.
    pub shown: Option<Shown>,
    /// What is being worked on, by whom; while a scene is, the result shown is old.
    pub works: BTreeMap<Lane, Work>,
    /// The workspace in front.
    pub workspace: Workspace,
    /// Units that lengths and angles are shown in.
    pub units: UnitSystem,
    /// Colours.
    pub theme: ThemeChoice,
    /// In which numbers the robot is told a pose.
    pub convention: Convention,
    /// Where the camera stands in the robot's base frame, if the cell is calibrated.
    pub robot: Option<Arc<RobotFrame>>,
    /// The cell's calibration, and the dialog about it.
    pub cell: RobotState,
    /// What a person should know, oldest first.
    pub notices: Vec<Notice>,
    /// The stage that fills the middle, if one is enlarged.
    pub enlarged: Option<StagePanel>,
    /// Place in the ranking of the part that contour and signature are compared with; 0 is the best.
    pub candidate: usize,
    /// Whether the list of shortcuts is open.
    pub help: HelpPage,
    /// Scenes opened last, the newest first.
    pub recent: Vec<PathBuf>,
    /// The library's folder that a person chose in the window.
    pub chosen_library: Option<PathBuf>,
    /// The library in use, once loaded.
    pub library: Option<Arc<LibraryShown>>,
    /// The parameters that scenes are inspected with.
    pub recipe: Arc<Recipe>,
    /// How many frames of the simulated cell were asked for.
    pub num_captures: u64,
    /// The generation of the newest request.
    pub generation: u64,
    /// Whose window it is.
    pub roles: RoleState,
    /// Of the source that is followed.
    pub live: LiveState,
    /// Of the Inspect workspace.
    pub inspect: InspectState,
    /// Of the Enrol workspace.
    pub enrol: EnrolState,
    /// Of the Compare workspace.
    pub compare: CompareState,
    /// Of the Align workspace.
    pub align: AlignState,
    /// Of the History workspace.
    pub history: HistoryState,
}

impl State {
    /// True while the result shown is not what was asked for last.
    pub fn is_old(&self) -> bool {
        self.works.contains_key(&Lane::Inspect) && self.shown.is_some()
    }

    /// The work that the window tells of: the front workspace's own, else any.
    pub fn work(&self) -> Option<(Lane, &Work)> {
        let own = self.workspace.lane();
        let all = self.works.iter().map(|(lane, work)| (*lane, work));
        // Quickly done, and not to be given up half-way.
        // A source is followed until it is no longer wanted, which has a button of its own.
        let quick = [
            Lane::Write,
            Lane::Library,
            Lane::Live,
            Lane::History,
            Lane::Robot,
        ];
        let mut all = all.filter(|(lane, _)| !quick.contains(lane));
        let own = own.and_then(|own| self.works.get_key_value(&own).map(|(l, w)| (*l, w)));
        own.or_else(|| all.next())
    }

    /// Writes down that the work has begun, and has it done; whatever its lane was at is given up.
    pub(super) fn begin(&mut self, what: impl Into<String>, request: Request) -> Effect {
        let lane = request.lane();
        // First: this request's generation is the newest behind this.
        let stop = matches!(request, Request::Inspect(_)).then(|| live::give_way(self));
        self.generation += 1;
        let work = Work {
            generation: self.generation,
            what: what.into(),
            stage: None,
            progress: None,
        };
        self.works.insert(lane, work);
        let post = Effect::Post {
            generation: self.generation,
            request,
        };
        match stop.flatten() {
            Some(stop) => Effect::Several(vec![stop, post]),
            None => post,
        }
    }
}

/// Where Capture takes a scene from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// The simulated cell.
    Cell(CellChoice),
    /// A file, read again at each capture.
    File(PathBuf),
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
    /// The generation of the request that it answers.
    pub generation: u64,
    /// The result.
    pub inspected: Arc<Inspected>,
    /// True if it was taken out of the history.
    pub is_past: bool,
    /// Of a frame among others: which session of following it belongs to.
    pub session: Option<u64>,
}

/// A request at work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Work {
    /// Its generation.
    pub generation: u64,
    /// What is being done, for a person.
    pub what: String,
    /// The stage begun last.
    pub stage: Option<Stage>,
    /// How many of how many are done.
    pub progress: Option<(usize, usize)>,
}

/// The workspaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Workspace {
    /// The operator's: which part is it, and is it accepted?
    #[default]
    Inspect,
    /// New parts.
    Enrol,
    /// The engineer's: why was this taken for that?
    Compare,
    /// Methods of pose estimation side by side.
    Align,
    /// What was inspected before.
    History,
}

impl Workspace {
    /// Every workspace, in the order of the rail and of the number keys.
    pub const ALL: [Self; 5] = [
        Self::Inspect,
        Self::Enrol,
        Self::Compare,
        Self::Align,
        Self::History,
    ];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Inspect => "Inspect",
            Self::Enrol => "Enrol",
            Self::Compare => "Compare",
            Self::Align => "Align",
            Self::History => "History",
        }
    }

    /// Who works for it.
    pub fn lane(self) -> Option<Lane> {
        match self {
            Self::Inspect => Some(Lane::Inspect),
            Self::Enrol => Some(Lane::Enrol),
            Self::Compare => Some(Lane::Compare),
            Self::Align => Some(Lane::Align),
            Self::History => None,
        }
    }
}

/// Colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThemeChoice {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

impl ThemeChoice {
    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Dark => "Dark",
            Self::Light => "Light",
        }
    }

    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Dark,
        }
    }
}

/// Whether the list of shortcuts is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HelpPage {
    /// Not open.
    #[default]
    Closed,
    /// Open.
    Open,
}

/// What a notice is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something deserves a look.
    #[default]
    Look,
    /// Something was done.
    Done,
    /// Something was done that can be taken back.
    Undoable,
}

/// Something that a person should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What it is about.
    pub kind: NoticeKind,
    /// What happened.
    pub what: String,
    /// What to do about it; may be empty.
    pub advice: String,
}

impl Notice {
    /// Something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            what: what.into(),
            advice: String::new(),
        }
    }

    /// Something was done that can be taken back.
    pub fn undoable(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Undoable,
            ..Self::done(what)
        }
    }
}

impl From<Trouble> for Notice {
    fn from(Trouble { what, advice }: Trouble) -> Self {
        Self {
            kind: NoticeKind::Look,
            what,
            advice,
        }
    }
}

/// The pictures of the stage strip, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StagePanel {
    /// What every point was taken for.
    Segmentation,
    /// The part in its own plane.
    BinaryImage,
    /// Outline, openings, centroid and rays.
    Contour,
    /// Lengths and angles of the rays.
    Signature,
    /// The enrolled parts, best first.
    Ranking,
    /// E per iteration.
    Alignment,
}

impl StagePanel {
    /// Every picture, in order.
    pub const ALL: [Self; 6] = [
        Self::Segmentation,
        Self::BinaryImage,
        Self::Contour,
        Self::Signature,
        Self::Ranking,
        Self::Alignment,
    ];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Segmentation => "Segmentation",
            Self::BinaryImage => "Binary image",
            Self::Contour => "Contour",
            Self::Signature => "Signatures",
            Self::Ranking => "Ranking",
            Self::Alignment => "Alignment",
        }
    }

    /// The panel that shows what a stage of the pipeline does.
    pub fn of(stage: Stage) -> Self {
        match stage {
            Stage::Segment => Self::Segmentation,
            Stage::Project => Self::BinaryImage,
            Stage::Contour => Self::Contour,
            Stage::Signature => Self::Signature,
            Stage::Rank => Self::Ranking,
            Stage::Pose => Self::Alignment,
        }
    }
}
