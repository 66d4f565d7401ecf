//! What is kept of the followed source, and the actions on it.

use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex,
        mpsc::{Receiver, SyncSender, sync_channel},
    },
};

use super::{
    parts::FollowedParts,
    work::{LiveAnswer, LiveRecord, LiveStatus, MAX_UNREAD},
};
use crate::{
    inspection::{inspected::Inspected, library_cache::LibraryCache},
    notice::Notice,
};
use capture::{SimulatedSpec, SourceSpec};
use inspection::pipeline::live::{LiveParams, MAX_AVERAGED};
use ui::task::{Task, TaskRunner};

/// State of the followed source.
#[derive(Debug, Default)]
pub struct LiveState {
    /// True while a source is followed; otherwise frames are captured one by one on demand.
    pub is_on: bool,
    /// The latest status, once there is one.
    pub status: Option<LiveStatus>,
    /// When a verdict counts, and over how many frames depth is averaged.
    pub params: LiveParams,
    /// The folder that the source is being recorded into, if it is.
    pub recording: Option<PathBuf>,
    /// Settings of the simulated cell while its dialog is open.
    pub setup: Option<SimulatedSpec>,
    /// The parts that hang before it.
    pub(crate) parts: Arc<Mutex<FollowedParts>>,
    /// The parts of the latest frame, if another workspace was in front and nothing newer has been shown since.
    pub unseen: Vec<Arc<Inspected>>,
}

/// Actions on the followed source.
#[derive(Clone, Debug)]
pub enum LiveAction {
    /// Start or stop following the source.
    Toggle,
    /// Use this source from now on.
    Use(SourceSpec),
    /// Average depth over this many frames.
    Average(usize),
    /// Record the source into a new folder inside this one.
    Record(PathBuf),
    /// Ask where to record, or stop recording.
    ToggleRecording,
    /// Open the dialog that sets up the simulated cell with these settings, or close it.
    SetUp(Option<SimulatedSpec>),
}

impl LiveState {
    /// Starts without following anything; depth will be averaged over `num_frames` frames.
    pub fn averaging(num_frames: usize) -> Self {
        let mut own = Self::default();
        own.params.average = num_frames.clamp(1, MAX_AVERAGED);
        own
    }
}

/// Follows the source.
#[derive(Debug)]
pub struct Follower {
    /// The inspections to be recorded, of every job. Dropped before the task, whose job may wait until they are read.
    pub(super) records: Receiver<LiveRecord>,
    pub(super) recorder: SyncSender<LiveRecord>,
    pub(super) task: Task<LiveAnswer>,
    pub(super) library_cache: LibraryCache,
    /// Incremented when following starts with another view; within one session the 3-D view keeps its camera.
    pub(super) session: u64,
    /// Incremented when following starts over: what came before is only recorded.
    pub(super) run: u64,
    /// The notice shown while the source is lost.
    pub(super) lost: Option<Notice>,
    /// The parts of the newest capture of a watched folder, to be inspected again.
    pub(super) again: Vec<Arc<Inspected>>,
}

impl Follower {
    /// Starts without following anything.
    pub fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        let (recorder, records) = sync_channel(MAX_UNREAD);
        Self {
            records,
            recorder,
            task: Task::new("live", runner),
            library_cache: library_cache.clone(),
            session: 0,
            run: 0,
            lost: None,
            again: Vec::new(),
        }
    }

    /// True while nothing is followed and the camera is closed.
    pub fn is_idle(&self) -> bool {
        self.task.running().is_none()
    }
}
