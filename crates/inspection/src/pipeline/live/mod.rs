//! Live: one verdict from many frames of one camera.
//!
//! ```text
//! frame ─► MotionDetector ─► DepthAverage ─► pipeline::run_all ─► spots_of ─► Consensus ─► LiveVerdict ─► HungParts
//!          does it move?      less noise      each frame          each part    one verdict of many         one inspection per part
//! ```
//!
//! A verdict on a part that swings or is just being hung is useless to a robot. So every frame is inspected, but no
//! verdict counts until nothing has moved for a while and the last frames agree.
//!
//! Both go by the frames' own times. Where the computer inspects only some of a camera's frames, a detector of its own sees the
//! others too, so that few frames suffice and none hides a motion.

mod average;
mod consensus;
mod hung;
mod inspection_rate;
mod mean_pose;
mod spots;
mod steady;
mod two_frames;

use std::{sync::Arc, time::Duration};

use nalgebra::Point3;

use self::inspection_rate::InspectionRateMeter;
pub use self::{
    average::{DepthAverage, MAX_AVERAGED},
    consensus::{Consensus, ConsensusParams, ConsensusVerdict},
    hung::{FrameRole, HungFrame, HungParts, Left},
    inspection_rate::InspectionRate,
    mean_pose::{MeanPose, PoseTolerance, mean_pose},
    spots::{nothing_there, spots_of},
    steady::{MotionDetector, MotionState, SceneMotion, SteadyParams},
    two_frames::{poses_agree, refuse_moving, refuse_unless_again},
};
use super::{AcceptParams, Inspection, Rejection, Verdict};
use stages::{field_of_view::FieldOfView, scene::SceneCloud};

/// Parameters for following a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveParams {
    /// When the scene counts as still.
    pub steady: SteadyParams,
    /// Frames that depth is averaged over, 1..=[`MAX_AVERAGED`]; 1 turns averaging off. Raising it lowers the noise
    /// and takes a few milliseconds more per frame.
    pub average: usize,
    /// When frames agree.
    pub consensus: ConsensusParams,
}

impl Default for LiveParams {
    fn default() -> Self {
        Self {
            steady: SteadyParams::default(),
            average: 1,
            consensus: ConsensusParams::default(),
        }
    }
}

/// The verdict on the scene after a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LiveVerdict {
    /// No verdict counts: something moves, or too few frames were seen to rule that out.
    #[default]
    Open,
    /// The scene is still, but more frames are needed.
    Gathering {
        /// Frames so far.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// A verdict that counts.
    Counted(Box<ConsensusVerdict>),
}

impl LiveVerdict {
    /// The verdict that counts, if there is one.
    pub fn counted(&self) -> Option<&ConsensusVerdict> {
        match self {
            Self::Counted(agreed) => Some(agreed),
            Self::Open | Self::Gathering { .. } => None,
        }
    }
}

/// Follows one camera. The same frames at the same times always lead to the same verdicts.
#[derive(Debug)]
pub struct LiveTracker {
    /// Sees the frames of a source whose every frame is passed to [`look`](Self::look).
    steady: MotionDetector,
    motion: SceneMotion,
    /// Within this time after the scene came to rest, a part may still move a little.
    spell: Duration,
    rate: InspectionRateMeter,
    average: DepthAverage,
    consensus_params: ConsensusParams,
    /// That of each spot where a part may hang.
    consensus: Vec<Consensus>,
    last_at: Duration,
    /// The camera's field of view, as far as the frames showed it.
    field_of_view: Option<Arc<FieldOfView>>,
}

impl LiveTracker {
    /// Creates a tracker that has seen no frame.
    pub fn new(params: &LiveParams) -> Self {
        Self {
            steady: MotionDetector::new(params.steady.clone()),
            motion: SceneMotion::default(),
            spell: params.steady.spell(),
            rate: InspectionRateMeter::default(),
            average: DepthAverage::over(params.average),
            consensus_params: params.consensus.clone(),
            consensus: Vec::new(),
            last_at: Duration::ZERO,
            field_of_view: None,
        }
    }

    /// Whether the scene moves, judging by the frames so far.
    pub fn stillness(&self) -> MotionState {
        self.motion.state
    }

    /// Frames that the depth of the next scene is averaged over.
    pub fn num_averaged(&self) -> usize {
        self.average.num_frames()
    }

    /// The camera's field of view, as far as the frames showed it.
    pub fn known_view(&self) -> Option<Arc<FieldOfView>> {
        self.field_of_view.clone()
    }

    /// Takes in a frame and returns the scene to inspect: the frame itself, or its average with the previous ones
    /// while nothing moves. `at` is the camera's time, from any origin. `watched` is what a detector that saw all of the
    /// camera's frames knows after this one; without it, every frame must be passed here.
    pub fn look(
        &mut self,
        mut scene: Arc<SceneCloud>,
        at: Duration,
        watched: Option<SceneMotion>,
    ) -> Arc<SceneCloud> {
        if self.field_of_view.is_some() && scene.known_view.is_none() {
            Arc::make_mut(&mut scene).set_known_view(self.field_of_view.clone());
        }
        self.field_of_view =
            FieldOfView::remembered(self.field_of_view.take(), scene.field_of_view());
        let run = self.motion.run;
        self.motion = watched.unwrap_or_else(|| {
            self.steady.see(&scene, at);
            self.steady.motion()
        });
        self.last_at = at;
        if self.motion.run != run {
            self.average.clear();
            self.consensus.clear();
        }
        self.average.add(&scene, at);
        if let MotionState::Steady { since, .. } = self.motion.state {
            self.average.forget_before(since);
            self.average.mean().unwrap_or(scene)
        } else {
            scene
        }
    }

    /// Takes in what the scene last returned by [`look`](Self::look) shows at a spot, see [`spots_of`], and overwrites its
    /// verdict: with the verdict and mean pose of all frames, or with the reason why its own verdict does not count. `middle`
    /// is the middle of the named part, part space, metres.
    pub fn judge(
        &mut self,
        spot: usize,
        inspection: &mut Inspection,
        middle: Option<Point3<f64>>,
        accept: &AcceptParams,
    ) -> LiveVerdict {
        while self.consensus.len() <= spot {
            self.consensus
                .push(Consensus::new(self.consensus_params.clone()));
        }
        let consensus = &mut self.consensus[spot];
        consensus.add(self.last_at, inspection, middle);
        let standing = match self.motion.state {
            MotionState::Watching | MotionState::Moving => LiveVerdict::Open,
            MotionState::Steady { since, .. } => {
                if let Some(agreed) = consensus.agreed(since, since + self.spell, accept) {
                    LiveVerdict::Counted(Box::new(unless_out_of_line(agreed, inspection)))
                } else {
                    let (num_frames, needed) = consensus.gathered(since);
                    LiveVerdict::Gathering { num_frames, needed }
                }
            }
        };
        standing.overwrite_verdict(inspection);
        standing
    }

    /// Counts the frame that was judged. `number` is counted by the camera; `waits` says whether a verdict on a part waits for
    /// further frames.
    pub fn judged(&mut self, number: u64, waits: bool) {
        self.rate.add(self.last_at, number, waits);
    }

    /// How many of the camera's frames are inspected; `None` before the second one.
    pub fn inspection_rate(&self) -> Option<InspectionRate> {
        self.rate.rate()
    }

    /// The rate, if fewer than half of the camera's frames are inspected.
    pub fn slow(&self) -> Option<InspectionRate> {
        self.rate.slow()
    }

    /// The rate, if a verdict has waited two seconds or longer because fewer than half of the camera's frames are inspected.
    pub fn held_up_by(&self) -> Option<InspectionRate> {
        self.rate.holds_up()
    }
}

impl LiveVerdict {
    /// Overwrites the verdict, so that a single frame's is not mistaken for one that counts.
    fn overwrite_verdict(&self, inspection: &mut Inspection) {
        match self {
            Self::Counted(agreed) => {
                inspection.verdict = agreed.verdict.clone();
                let best = inspection.ranking.entries.first();
                if best.map(|best| best.part.as_str()) != agreed.verdict.guess() {
                    // This frame's pose is that of another part.
                    inspection.pose = None;
                } else if let (Some(Ok(pose)), Some(mean)) = (&mut inspection.pose, &agreed.pose) {
                    pose.target_from_source = mean.camera_from_part.inverse();
                }
            }
            Self::Open | Self::Gathering { .. } => {
                if let Verdict::Part { part, rejected, .. } = &mut inspection.verdict
                    && rejected.is_none()
                {
                    let part = part.clone();
                    *rejected = Some(match *self {
                        Self::Gathering { num_frames, needed } => Rejection::FewFrames {
                            part,
                            num_frames,
                            needed,
                        },
                        _ => Rejection::NotSteady { part },
                    });
                }
            }
        }
    }
}

/// Rejects the agreed verdict if this frame is one of the few that name another part or find no pose, because the
/// rest of its inspection would belong to something else.
fn unless_out_of_line(mut agreed: ConsensusVerdict, inspection: &Inspection) -> ConsensusVerdict {
    let best = inspection.ranking.entries.first();
    if let Verdict::Part {
        part,
        rejected: rejected @ None,
        ..
    } = &mut agreed.verdict
    {
        let is_in_line =
            best.is_some_and(|best| best.part == *part) && !matches!(inspection.pose, Some(Err(_)));
        if !is_in_line {
            *rejected = Some(Rejection::Undecided {
                part: part.clone(),
                num_agreeing: agreed.num_agreeing,
                num_frames: agreed.num_frames,
                needed: agreed.num_frames,
            });
        }
    }
    agreed
}

#[cfg(test)]
mod tests;
