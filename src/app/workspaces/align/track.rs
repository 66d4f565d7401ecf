//! The way of one method from its start to its end, with E at every pose: ready to be drawn and scrubbed.

use std::{
    ops::Range,
    time::{Duration, Instant},
};

use super::pair::Pair;
use crate::{
    app::{
        language::{results, text},
        ui::widgets::sentence,
        user_error::UserError,
    },
    geometry::rigid::{self, RigidTransform},
    stages::pose::{
        FitQuality, Iteration, Phase, PoseError, PoseEstimate, PoseMethod, PoseWarning, Stopped,
        Uncertainty, align_to,
    },
};

/// What one method made of a pair.
#[derive(Clone, Debug)]
pub struct MethodRun {
    /// The method.
    pub method: PoseMethod,
    /// How long the estimation took.
    pub time: Duration,
    /// Its way, or why there is none.
    pub track: Result<Track, UserError>,
}

/// A method's way.
#[derive(Clone, Debug)]
pub struct Track {
    /// The pose of every iteration, and last the one it ended at.
    pub poses: Vec<RigidTransform>,
    /// E of eq. 12 at each of them, square metres, measured alike for all methods: [`Pair::e_m2`].
    pub e_m2: Vec<f64>,
    /// Their base-10 logarithms.
    pub log_e: Vec<f32>,
    /// The iterations in which the genetic algorithm searched.
    pub searches: Vec<Range<usize>>,
    /// Why it ended.
    pub stopped: Stopped,
    /// How well the end fits.
    pub fit: FitQuality,
    /// How far off the end may be.
    pub uncertainty: Option<Uncertainty>,
    /// How far the end is from the truth, where that is known.
    pub true_error: Option<rigid::PoseDelta>,
    /// Why the end should not be relied upon.
    pub doubt: Option<UserError>,
}

/// Nothing that `f32` points resolve is smaller: E of 1e-16 m² is 10 nm.
const LEAST_E: f64 = 1e-16;

/// A way is measured with at most so many searches for a closest point: a long one on fewer points.
const MOST_SEARCHES: usize = 1_000_000;

/// Runs a method on a pair, and takes the time.
pub(super) fn estimated(
    method: PoseMethod,
    pair: &Pair,
    is_cancelled: &dyn Fn() -> bool,
) -> (Result<PoseEstimate, PoseError>, Duration) {
    let clock = Instant::now();
    let prepared = pair.prepared.as_ref().map_err(|error| *error);
    let aligned = prepared
        .and_then(|target| align_to(&pair.source, target, &method.into(), None, is_cancelled));
    (aligned, clock.elapsed())
}

impl MethodRun {
    /// Runs the method on the pair, and follows its way.
    pub fn of(method: PoseMethod, pair: &Pair, is_cancelled: &dyn Fn() -> bool) -> Self {
        let (aligned, time) = estimated(method, pair, is_cancelled);
        let track = match aligned {
            Ok(estimate) => Ok(Track::of(&estimate, pair)),
            Err(error) => Err(in_the_window(&error)),
        };
        Self {
            method,
            time,
            track,
        }
    }
}

impl Track {
    fn of(estimate: &PoseEstimate, pair: &Pair) -> Self {
        let end = estimate.target_from_source;
        let steps = estimate.iterations.iter();
        let mut poses: Vec<RigidTransform> = steps.map(|step| step.target_from_source).collect();
        poses.push(end);
        let e_m2 = e_along(&poses, pair);
        let log_e: Vec<f32> = e_m2.iter().map(|e| e.max(LEAST_E).log10() as f32).collect();
        Self {
            log_e,
            searches: searches(&estimate.iterations),
            stopped: estimate.stopped,
            fit: estimate.fit,
            uncertainty: estimate.uncertainty,
            true_error: pair.true_error(&end),
            doubt: estimate.doubt().map(|doubt| doubted(&doubt, pair)),
            e_m2,
            poses,
        }
    }

    /// E at the end, square metres.
    pub fn end_e_m2(&self) -> f64 {
        self.e_m2.last().copied().unwrap_or(f64::INFINITY)
    }

    /// The pose of an iteration; beyond the end that of the end.
    pub fn pose_at(&self, place: usize) -> RigidTransform {
        let last = self.poses.len().saturating_sub(1);
        self.poses
            .get(place.min(last))
            .copied()
            .unwrap_or_else(RigidTransform::identity)
    }

    /// How it stopped, in words.
    pub fn ending(&self) -> String {
        let num = self.poses.len().saturating_sub(1);
        let is_lost = self
            .true_error
            .filter(|error| error.rotation.degrees() > 5.0);
        match (self.stopped, is_lost) {
            (Stopped::BelowTarget, _) => {
                text!("align-ended-below-target", count = num)
            }
            (Stopped::Converged, Some(_)) => {
                text!("align-ended-elsewhere", count = num)
            }
            (Stopped::Converged, None) => text!("align-ended-settled", count = num),
            (Stopped::NoProgress, _) => {
                text!("align-ended-gave-up", count = num)
            }
            (Stopped::IterationLimit, _) => text!("align-ended-moving", count = num),
        }
    }
}

/// E at every pose. Where a pose is the one before, as between generations without progress, so is its E.
fn e_along(poses: &[RigidTransform], pair: &Pair) -> Vec<f64> {
    let step = (poses.len() * pair.sample.len())
        .div_ceil(MOST_SEARCHES)
        .max(1);
    let last = poses.len().saturating_sub(1);
    let mut all: Vec<f64> = Vec::with_capacity(poses.len());
    for (place, pose) in poses.iter().enumerate() {
        let is_same = place > 0 && place < last && poses[place - 1] == *pose;
        let before = all.last().copied().filter(|_| is_same);
        let step = if place == last { 1 } else { step };
        all.push(before.unwrap_or_else(|| pair.e_m2_over(pose, step)));
    }
    all
}

/// The stretches in which the genetic algorithm searched.
fn searches(iterations: &[Iteration]) -> Vec<Range<usize>> {
    let mut place = 0;
    let stretches = iterations.chunk_by(|a, b| a.phase == b.phase);
    let stretches = stretches.map(|stretch| {
        let first = place;
        place += stretch.len();
        (stretch[0].phase, first..place)
    });
    let genetic = stretches.filter(|(phase, _)| *phase == Phase::Genetic);
    genetic.map(|(_, stretch)| stretch).collect()
}

/// The error with advice that can be followed in the window.
pub(super) fn in_the_window(error: &PoseError) -> UserError {
    let advice = match error {
        PoseError::OneSidedPairs { .. } | PoseError::NoOverlap { .. } => {
            text!("align-nearer-or-same-part")
        }
        other => results::pose_error_advice(other),
    };
    UserError {
        what: sentence(&results::pose_error(error)),
        advice,
    }
}

fn doubted(doubt: &PoseWarning, pair: &Pair) -> UserError {
    let advice = match doubt {
        PoseWarning::Ambiguous { .. } => text!("align-which-way-round"),
        PoseWarning::Loose { .. } => {
            text!("align-look-for-edge")
        }
        PoseWarning::Unsettled { .. } => text!("align-other-method"),
        // They do show the same.
        PoseWarning::LittleOverlap { .. } if pair.truth.is_some() => {
            text!("align-nearer-start")
        }
        PoseWarning::LittleOverlap { .. } => text!("results-little-overlap-advice"),
    };
    UserError {
        what: sentence(&results::pose_warning(doubt)),
        advice,
    }
}
