//! One verdict from those on the last frames.
//!
//! A frame's verdict is a guess with a probability. Frames of one still scene share a systematic error, so their
//! agreement is no proof, but their disagreement is a warning: a part is accepted only if nearly every frame accepts
//! it, none accepts another, and their poses lie together. The score is the lower median, which is the score of an
//! actual frame.
//!
//! Of a computer that inspects few frames, fewer are enough if they are far apart and all say the same: while nothing moves between
//! them, frames in quick succession would add little. None of them may show the part still coming to rest, as one among many may.

use std::{collections::VecDeque, time::Duration};

use nalgebra::Point3;

use super::mean_pose::{MeanPose, PoseTolerance, mean_pose};
use crate::pipeline::{AcceptParams, Inspection, Rejection, Verdict};
use geometry::{
    rigid::RigidTransform,
    statistics::lower_median,
    units::{Metres, Radians},
};

/// When frames agree.
#[derive(Clone, Debug, PartialEq)]
pub struct ConsensusParams {
    /// Maximum number of frames that the verdict rests on, 1..60. Raising it makes verdict and pose steadier and
    /// slower to change.
    pub num_frames: usize,
    /// Minimum number of frames that it rests on, 1..=`num_frames`. Raising it makes the user wait longer.
    pub least_frames: usize,
    /// Fewer than `least_frames`, but at least two, are enough if the first and the last are this far apart and all agree, 0.3..5 s.
    /// Raising it makes the user of a slow computer wait longer.
    pub least_span: Duration,
    /// Share of the frames that must agree, 0.5..1. Lowering it accepts parts that some frames reject.
    pub least_share: f64,
    /// How far poses may lie apart to be averaged.
    pub tolerance: PoseTolerance,
}

impl Default for ConsensusParams {
    fn default() -> Self {
        Self {
            num_frames: 10,
            least_frames: 5,
            least_span: Duration::from_millis(900),
            least_share: 0.8,
            tolerance: PoseTolerance {
                shift: Metres::from_mm(6.0),
                turn: Radians::from_degrees(1.5),
            },
        }
    }
}

/// A verdict that rests on several frames.
#[derive(Clone, Debug, PartialEq)]
pub struct ConsensusVerdict {
    /// The verdict; score and margin are medians.
    pub verdict: Verdict,
    /// Frames that it rests on.
    pub num_frames: usize,
    /// Frames that agree with it.
    pub num_agreeing: usize,
    /// Mean of the poses that agree; `None` if no part was named or no pose was asked for.
    pub pose: Option<MeanPose>,
}

impl ConsensusVerdict {
    /// True if all of these frames say what it says: they accept the part, or refuse it for one kind of reason.
    fn is_unanimous(&self, frames: &[&FrameVerdict]) -> bool {
        let kind_of = |verdict: &Verdict| verdict.refusal().map(|why| why.kind());
        let kind = kind_of(&self.verdict);
        let mut kinds = frames.iter().map(|frame| kind_of(&frame.verdict));
        self.num_agreeing == self.num_frames && kinds.all(|of_frame| of_frame == kind)
    }
}

/// The result of one frame.
#[derive(Clone, Debug)]
struct FrameVerdict {
    at: Duration,
    verdict: Verdict,
    /// The reference in whose coordinates the pose is.
    reference: Option<String>,
    camera_from_part: Option<RigidTransform>,
    /// Middle of the part, part space, metres.
    middle: Point3<f64>,
}

/// The results of the last frames of a scene, as long as it does not move.
#[derive(Debug)]
pub struct Consensus {
    params: ConsensusParams,
    frames: VecDeque<FrameVerdict>,
}

impl Consensus {
    /// Creates a consensus without frames.
    pub fn new(params: ConsensusParams) -> Self {
        Self {
            params,
            frames: VecDeque::new(),
        }
    }

    /// Forgets every frame, because the scene has moved.
    pub fn clear(&mut self) {
        self.frames.clear();
    }

    /// Adds the result of the frame taken at `at`. `middle` is the middle of the named part, part space, metres.
    pub fn add(&mut self, at: Duration, inspection: &Inspection, middle: Option<Point3<f64>>) {
        let pose = inspection.found_pose();
        self.frames.push_back(FrameVerdict {
            at,
            verdict: inspection.verdict.clone(),
            reference: inspection.reference().map(ToOwned::to_owned),
            camera_from_part: pose.map(stages::pose::PoseEstimate::camera_from_part),
            middle: middle.unwrap_or_else(Point3::origin),
        });
        while self.frames.len() > self.params.num_frames.max(1) {
            self.frames.pop_front();
        }
    }

    /// Number of frames from `since` on, and the number needed.
    pub fn gathered(&self, since: Duration) -> (usize, usize) {
        let num = self.frames.iter().filter(|frame| frame.at >= since).count();
        (num, self.least_frames())
    }

    fn least_frames(&self) -> usize {
        self.params
            .least_frames
            .clamp(1, self.params.num_frames.max(1))
    }

    /// The verdict of the frames from `since` on; `None` while they are too few. Where few are enough, only those from `rested`
    /// on count.
    pub fn agreed(
        &self,
        since: Duration,
        rested: Duration,
        accept: &AcceptParams,
    ) -> Option<ConsensusVerdict> {
        let mut frames: Vec<&FrameVerdict> = self
            .frames
            .iter()
            .filter(|frame| frame.at >= since)
            .collect();
        let is_enough = frames.len() >= self.least_frames();
        if !is_enough {
            frames.retain(|frame| frame.at >= rested);
        }
        if !is_enough && !self.spans(&frames) {
            return None;
        }
        let agreed = self.agreed_by(&frames, accept)?;
        (is_enough || agreed.is_unanimous(&frames)).then_some(agreed)
    }

    /// True if the first and the last frame are far enough apart for few frames to be enough.
    fn spans(&self, frames: &[&FrameVerdict]) -> bool {
        let ends = frames.first().zip(frames.last());
        let span = ends.map(|(first, last)| last.at.saturating_sub(first.at));
        frames.len() >= 2 && span.is_some_and(|span| span >= self.params.least_span)
    }

    /// The verdict of these frames.
    fn agreed_by(
        &self,
        frames: &[&FrameVerdict],
        accept: &AcceptParams,
    ) -> Option<ConsensusVerdict> {
        let num_frames = frames.len();
        let needed = (self.params.least_share * num_frames as f64).ceil() as usize;
        let Some(name) = most_named(frames) else {
            return nothing_named(frames);
        };
        let naming: Vec<&FrameVerdict> = frames
            .iter()
            .copied()
            .filter(|frame| named(&frame.verdict).is_some_and(|(part, ..)| part == name))
            .collect();
        let num_empty = frames
            .iter()
            .filter(|frame| named(&frame.verdict).is_none())
            .count();
        if num_empty > naming.len() {
            return nothing_named(frames);
        }
        let of = |pick: fn(&Verdict) -> Option<f64>| {
            lower_median(naming.iter().filter_map(|frame| pick(&frame.verdict))).unwrap_or(0.0)
        };
        let score = of(|verdict| named(verdict).map(|(_, score, _)| score));
        let margin = of(|verdict| named(verdict).map(|(_, _, margin)| margin));
        let num_accepting = naming
            .iter()
            .filter(|frame| frame.verdict.is_accepted())
            .count();
        let is_contradicted = frames.iter().any(|frame| {
            frame.verdict.is_accepted()
                && named(&frame.verdict).is_some_and(|(part, ..)| part != name)
        });
        // The mean replaces the last frame's pose, so only poses of its reference count: each reference has its own
        // coordinates.
        let last = naming.last();
        let poses: Vec<RigidTransform> = naming
            .iter()
            .filter(|frame| last.is_some_and(|last| last.reference == frame.reference))
            .filter_map(|frame| frame.camera_from_part)
            .collect();
        let middle = last.map_or_else(Point3::origin, |frame| frame.middle);
        let pose = mean_pose(&poses, &middle, self.params.tolerance);
        let in_place = pose.map(|pose| pose.num_agreeing);

        let undecided = |num_agreeing: usize| Rejection::Undecided {
            part: name.to_owned(),
            num_agreeing,
            num_frames,
            needed,
        };
        let rejected = if num_accepting < needed || is_contradicted {
            // A reason that most frames share is more useful than the fact that they do not all agree.
            let mut complaints = naming.iter().filter_map(|frame| frame.verdict.rejected());
            let num_rejecting = naming.len() - num_accepting;
            let last = complaints.next_back().cloned();
            let is_common = num_rejecting >= needed && !is_contradicted;
            Some(
                last.filter(|_| is_common)
                    .or_else(|| almost_equal(frames, name, needed))
                    .unwrap_or_else(|| undecided(num_accepting)),
            )
        } else if score < accept.min_score || margin < accept.min_margin {
            Some(undecided(num_accepting))
        } else if in_place.is_some_and(|num| num < needed) {
            Some(Rejection::PosesApart {
                part: name.to_owned(),
                num_agreeing: in_place.unwrap_or(0),
                num_frames,
                needed,
            })
        } else {
            None
        };
        let num_approximate = naming
            .iter()
            .filter(|frame| frame.verdict.is_approximate())
            .count();
        let is_approximate = 2 * num_approximate >= naming.len();
        let num_agreeing = match &rejected {
            None => num_accepting.min(in_place.unwrap_or(num_accepting)),
            Some(_) => naming.len(),
        };
        Some(ConsensusVerdict {
            verdict: Verdict::Part {
                part: name.to_owned(),
                score,
                margin,
                rejected,
                is_approximate,
            },
            num_frames,
            num_agreeing,
            pose,
        })
    }
}

/// The verdict where most frames name no part: that of the last such frame.
fn nothing_named(frames: &[&FrameVerdict]) -> Option<ConsensusVerdict> {
    let mut empty = frames
        .iter()
        .filter(|frame| named(&frame.verdict).is_none());
    let num_agreeing = empty.clone().count();
    Some(ConsensusVerdict {
        verdict: empty.next_back()?.verdict.clone(),
        num_frames: frames.len(),
        num_agreeing,
        pose: None,
    })
}

/// The rejection for frames that disagree because two parts fit almost equally well: at least one frame was rejected for this, and
/// at least `needed` frames fit that explanation.
fn almost_equal(frames: &[&FrameVerdict], name: &str, needed: usize) -> Option<Rejection> {
    let pair_of = |verdict: &Verdict| match verdict.rejected() {
        Some(Rejection::SmallMargin { part, other, .. }) if part == name => Some(other.clone()),
        Some(Rejection::SmallMargin { part, other, .. }) if other == name => Some(part.clone()),
        _ => None,
    };
    let other = frames.iter().find_map(|frame| pair_of(&frame.verdict))?;
    let of_pair = frames.iter().filter(|frame| {
        let accepts = named(&frame.verdict).is_some_and(|(part, ..)| {
            frame.verdict.is_accepted() && (part == name || part == other)
        });
        accepts || pair_of(&frame.verdict).as_ref() == Some(&other)
    });
    if of_pair.count() < needed {
        return None;
    }
    let margins = frames
        .iter()
        .filter_map(|frame| match frame.verdict.rejected() {
            Some(Rejection::SmallMargin {
                margin, threshold, ..
            }) => Some((*margin, *threshold)),
            _ => None,
        });
    let threshold = margins.clone().map(|(_, threshold)| threshold).next()?;
    Some(Rejection::SmallMargin {
        part: name.to_owned(),
        margin: lower_median(margins.map(|(margin, _)| margin))?,
        threshold,
        other,
    })
}

fn named(verdict: &Verdict) -> Option<(&str, f64, f64)> {
    match verdict {
        Verdict::Part {
            part,
            score,
            margin,
            ..
        } => Some((part, *score, *margin)),
        Verdict::NoPart(_) => None,
    }
}

/// The part that most frames name; of several, the one named first.
fn most_named<'a>(frames: &[&'a FrameVerdict]) -> Option<&'a str> {
    let names = frames.iter().filter_map(|frame| named(&frame.verdict));
    let names: Vec<&str> = names.map(|(part, ..)| part).collect();
    let count = |name: &str| names.iter().filter(|other| **other == name).count();
    let mut most: Option<(usize, &str)> = None;
    for name in &names {
        let num = count(name);
        if most.is_none_or(|(known, _)| num > known) {
            most = Some((num, name));
        }
    }
    most.map(|(_, name)| name)
}

#[cfg(test)]
mod tests;
