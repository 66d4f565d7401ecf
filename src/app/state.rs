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
    live::{self, LiveState},
    roles::RoleState,
};
use crate::pipeline::Stage;

/// Everything that the panels read. Only [`apply`](super::action::apply) changes it.
#[derive(Debug, Default)]
pub struct State {
    /// What the workspaces share.
    pub session: Session,
    /// What is being worked on, by whom; while a scene is, the result shown is old.
    pub works: BTreeMap<TaskQueue, Work>,
    /// What a person should know, oldest first.
    pub notices: Vec<Notice>,
    /// The stage that fills the middle, if one is enlarged.
    pub enlarged: Option<StagePanel>,
    /// Place in the ranking of the part that contour and signature are compared with; 0 is the best.
    pub candidate: usize,
    /// Whether the list of shortcuts is open.
    pub help: HelpPage,
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
    /// What the newest inspection that was asked for is for: its generation, and the purpose.
    pub purpose: (u64, ReinspectionPurpose),
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

impl State {
    /// True while the result shown is not what was asked for last.
    pub fn is_old(&self) -> bool {
        self.works.contains_key(&TaskQueue::Inspect) && self.shown.is_some()
    }

    /// The work that the window tells of: the front workspace's own, else any.
    pub fn work(&self) -> Option<(TaskQueue, &Work)> {
        let own = self.workspace.lane();
        let all = self.works.iter().map(|(lane, work)| (*lane, work));
        // Quickly done, and not to be given up half-way.
        // A source is followed until it is no longer wanted, which has a button of its own.
        let quick = [TaskQueue::Write, TaskQueue::Live];
        let mut all = all.filter(|(lane, _)| !quick.contains(lane));
        let own = own.and_then(|own| self.works.get_key_value(&own).map(|(l, w)| (*l, w)));
        own.or_else(|| all.next())
    }

    /// Writes down that the work has begun, and has it done; whatever its lane was at is given up.
    pub(super) fn begin(&mut self, what: impl Into<String>, request: Request) -> Effect {
        let lane = request.lane();
        // First: this request's generation is the newest behind this.
        let stop = matches!(request, Request::Inspect(_) | Request::InspectScan(_))
            .then(|| live::stop_live(self));
        self.generation += 1;
        let work = Work {
            generation: self.generation,
            what: what.into(),
            stage: None,
            progress: None,
        };
        self.works.insert(lane, work);
        if lane == TaskQueue::Inspect {
            self.inspect.shots.started(None);
        }
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

impl State {
    /// Has a scene or a scan inspected for this.
    pub(super) fn inspect(
        &mut self,
        what: impl Into<String>,
        request: Request,
        purpose: ReinspectionPurpose,
    ) -> Effect {
        let effect = self.begin(what, request);
        self.purpose = (self.generation, purpose);
        effect
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

impl Workspace {
    /// Who works for it.
    pub fn lane(self) -> Option<TaskQueue> {
        match self {
            Self::Inspect => Some(TaskQueue::Inspect),
            Self::Enrol | Self::Compare | Self::Align | Self::History => None,
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
