//! What the window knows: plain data, without any type of the user interface.

use std::{
    collections::BTreeMap,
    ops::{Deref, DerefMut},
};

pub use super::shell::{
    message::{Event, ReinspectionPurpose},
    notice::{Notice, NoticeKind},
    session::{Session, Shown, Source, ThemeChoice, WorkspaceKind as Workspace},
};
use super::{
    action::Effect,
    inspect::state::InspectState,
    job::Request,
    lane::TaskQueue,
    live::Follower,
    roles::RoleState,
    shelf::LibraryCache,
    shell::{inspector::Inspector, task::TaskRunner},
};
use crate::pipeline::Stage;

/// Everything that the panels read. Only [`apply`](super::action::apply) changes it.
#[derive(Debug)]
pub struct State {
    /// What the workspaces share.
    pub session: Session,
    /// Captures, opens and inspects; meanwhile the result shown is old.
    pub inspector: Inspector,
    /// Follows the source.
    pub follower: Follower,
    /// What else is being worked on, by whom.
    pub works: BTreeMap<TaskQueue, Work>,
    /// What a person should know, oldest first.
    pub notices: Vec<Notice>,
    /// The stage that fills the middle, if one is enlarged.
    pub enlarged: Option<StagePanel>,
    /// Place in the ranking of the part that contour and signature are compared with; 0 is the best.
    pub candidate: usize,
    /// Whether the list of shortcuts is open.
    pub help: HelpPage,
    /// The generation of the newest request.
    pub generation: u64,
    /// Whose window it is.
    pub roles: RoleState,
    /// Of the Inspect workspace.
    pub inspect: InspectState,
}

impl Deref for State {
    type Target = Session;

    fn deref(&self) -> &Session {
        &self.session
    }
}

impl DerefMut for State {
    fn deref_mut(&mut self) -> &mut Session {
        &mut self.session
    }
}

#[cfg(test)]
impl Default for State {
    fn default() -> Self {
        Self::new(&TaskRunner::without_threads(), &LibraryCache::default())
    }
}

impl State {
    /// Before the first capture.
    pub fn new(runner: &TaskRunner, shelf: &LibraryCache) -> Self {
        Self {
            session: Session::default(),
            inspector: Inspector::new(runner, shelf),
            follower: Follower::new(runner, shelf),
            works: BTreeMap::new(),
            notices: Vec::new(),
            enlarged: None,
            candidate: 0,
            help: HelpPage::default(),
            generation: 0,
            roles: RoleState::default(),
            inspect: InspectState::default(),
        }
    }

    /// Writes down that the work has begun, and has it done; whatever its lane was at is given up.
    pub(super) fn begin(&mut self, what: impl Into<String>, request: Request) -> Effect {
        self.generation += 1;
        let work = Work {
            generation: self.generation,
            what: what.into(),
            stage: None,
            progress: None,
        };
        self.works.insert(request.lane(), work);
        Effect::Post {
            generation: self.generation,
            request,
        }
    }
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

/// Whether the list of shortcuts is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HelpPage {
    /// Not open.
    #[default]
    Closed,
    /// Open.
    Open,
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
