//! What the session keeps of the followed source, and the actions on it.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
};

use super::{parts::FollowedParts, work::LiveStatus};
use crate::inspection::inspected::Inspected;
use capture::{SimulatedSpec, SourceSpec};
use inspection::pipeline::live::{LiveParams, MAX_AVERAGED};

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
