//! The poses of one method from start to end, with E at each, ready to be drawn and scrubbed.

use std::{
    ops::Range,
    time::{Duration, Instant},
};

use super::pair::Pair;
use geometry::rigid::{self, RigidTransform};
use stages::pose::{
    FitQuality, Iteration, Phase, PoseError, PoseEstimate, PoseMethod, PoseWarning, Stopped,
    Uncertainty, align_to,
};
use ui::{
    language::{advised, described, text},
    user_error::UserError,
    widgets::sentence,
};

/// The run of one method on a pair.
#[derive(Clone, Debug)]
pub struct MethodRun {
    /// The method that ran.
    pub method: PoseMethod,
    /// How long the estimation took.
    pub time: Duration,
    /// The track, or why there is none.
    pub track: Result<Track, PoseError>,
}

/// The poses that a method went through.
#[derive(Clone, Debug)]
pub struct Track {
    /// The pose of every iteration, then the final pose.
    pub poses: Vec<RigidTransform>,
    /// E of eq. 12 at each pose, square metres, measured alike for all methods: [`Pair::e_m2`].
    pub e_m2: Vec<f64>,
    /// Base-10 logarithms of E.
    pub log_e: Vec<f32>,
    /// The iterations of each genetic search.
    pub searches: Vec<Range<usize>>,
    /// Why the method stopped.
    pub stopped: Stopped,
    /// Fit at the final pose.
    pub fit: FitQuality,
    /// Uncertainty of the final pose.
    pub uncertainty: Option<Uncertainty>,
    /// Error of the final pose, where the truth is known.
    pub true_error: Option<rigid::PoseDelta>,
    /// Why the final pose should not be relied upon.
    pub doubts: Vec<PoseWarning>,
}

/// Smallest E plotted, square metres: (10 nm)², below the resolution of `f32` points.
const LEAST_E: f64 = 1e-16;

/// Limit of closest-point searches per track; long tracks are measured over fewer points.
const MOST_SEARCHES: usize = 1_000_000;

/// Runs a method on a pair and measures the time.
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
    /// Runs the method on the pair and records its track.
    pub fn run(method: PoseMethod, pair: &Pair, is_cancelled: &dyn Fn() -> bool) -> Self {
        let (aligned, time) = estimated(method, pair, is_cancelled);
        Self {
            method,
            time,
            track: aligned.map(|estimate| Track::record(&estimate, pair)),
        }
    }
}

impl Track {
    fn record(estimate: &PoseEstimate, pair: &Pair) -> Self {
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
            doubts: warnings(estimate),
            e_m2,
            poses,
        }
    }

    /// E at the final pose, square metres.
    pub fn end_e_m2(&self) -> f64 {
        self.e_m2.last().copied().unwrap_or(f64::INFINITY)
    }

    /// Returns the pose of an iteration, or the final pose beyond the end.
    pub fn pose_at(&self, index: usize) -> RigidTransform {
        let last = self.poses.len().saturating_sub(1);
        self.poses
            .get(index.min(last))
            .copied()
            .unwrap_or_else(RigidTransform::identity)
    }

    /// Describes why and after how many iterations the method stopped, and what that means.
    pub fn ending(&self) -> [String; 2] {
        let num = self.poses.len().saturating_sub(1);
        let is_lost = self
            .true_error
            .is_some_and(|error| error.rotation.degrees() > 5.0);
        match self.stopped {
            Stopped::BelowThreshold => [
                text!("align-ended-below-threshold", count = num),
                text!("align-ended-below-threshold-says"),
            ],
            Stopped::Converged if is_lost => [
                text!("align-ended-elsewhere", count = num),
                text!("align-ended-elsewhere-says"),
            ],
            Stopped::Converged => [
                text!("align-ended-converged", count = num),
                text!("align-ended-converged-says"),
            ],
            Stopped::NoProgress => [
                text!("align-ended-above-threshold", count = num),
                text!("align-ended-above-threshold-says"),
            ],
            Stopped::IterationLimit => [
                text!("align-ended-limit", count = num),
                text!("align-ended-limit-says"),
            ],
        }
    }
}

/// Measures E at every pose; reuses it where the pose did not change, as between generations without progress.
fn e_along(poses: &[RigidTransform], pair: &Pair) -> Vec<f64> {
    let step = (poses.len() * pair.sample.len())
        .div_ceil(MOST_SEARCHES)
        .max(1);
    let last = poses.len().saturating_sub(1);
    let mut all: Vec<f64> = Vec::with_capacity(poses.len());
    for (index, pose) in poses.iter().enumerate() {
        let is_same = index > 0 && index < last && poses[index - 1] == *pose;
        let before = all.last().copied().filter(|_| is_same);
        let step = if index == last { 1 } else { step };
        all.push(before.unwrap_or_else(|| pair.e_m2_over(pose, step)));
    }
    all
}

/// Finds the ranges of iterations in which the genetic algorithm searched.
fn searches(iterations: &[Iteration]) -> Vec<Range<usize>> {
    let mut index = 0;
    let stretches = iterations.chunk_by(|a, b| a.phase == b.phase);
    let stretches = stretches.map(|stretch| {
        let first = index;
        index += stretch.len();
        (stretch[0].phase, first..index)
    });
    let genetic = stretches.filter(|(phase, _)| *phase == Phase::Genetic);
    genetic.map(|(_, stretch)| stretch).collect()
}

/// Words an error with advice that can be followed in the window.
pub(super) fn in_the_window(error: &PoseError) -> UserError {
    let advice = match error {
        PoseError::OneSidedPairs { .. } | PoseError::NoOverlap { .. } => {
            text!("align-nearer-or-same-part")
        }
        other => advised(other),
    };
    UserError {
        what: sentence(&described(error)),
        advice,
    }
}

/// The doubt about a pose and, if it is another one, that the pose is unconstrained, as its uncertainty shows.
fn warnings(estimate: &PoseEstimate) -> Vec<PoseWarning> {
    let doubt = estimate.doubt();
    let freedom = estimate.uncertainty.and_then(|bounds| bounds.freedom);
    let loose = freedom.map(|freedom| PoseWarning::Loose { freedom });
    doubt
        .into_iter()
        .chain(loose.filter(|_| loose != doubt))
        .collect()
}

/// Words a doubt about the pose at the end of a track, with advice.
pub(super) fn doubted(doubt: &PoseWarning, track: &Track) -> UserError {
    let advice = match doubt {
        PoseWarning::Ambiguous { .. } => text!("align-which-way-round"),
        PoseWarning::Loose { .. } => {
            text!("align-look-for-edge")
        }
        PoseWarning::Unsettled { .. } => text!("align-other-method"),
        // Source and target do show the same part.
        PoseWarning::LittleOverlap { .. } if track.true_error.is_some() => {
            text!("align-nearer-start")
        }
        PoseWarning::LittleOverlap { .. } | PoseWarning::OffScale(_) => advised(doubt),
    };
    UserError {
        what: sentence(&described(doubt)),
        advice,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::units::{Metres, Radians};
    use stages::pose::{Axis, FreeMotion, RunnerUp};

    #[test]
    fn an_ambiguous_pose_that_is_unconstrained_too_says_both() {
        let freedom = FreeMotion::Slide(Axis::Long);
        let mut estimate = PoseEstimate {
            target_from_source: RigidTransform::identity(),
            method: PoseMethod::Global,
            stopped: Stopped::Converged,
            iterations: Vec::new(),
            fit: FitQuality {
                e_m2: 0.0012,
                rms_m: 0.0025,
                overlap: 0.89,
                sight: None,
            },
            uncertainty: Some(Uncertainty {
                shift: Metres(f64::INFINITY),
                turn: Radians(f64::INFINITY),
                freedom: Some(freedom),
            }),
            runner_up: Some(RunnerUp {
                target_from_source: RigidTransform::identity(),
                ratio: 1.03,
            }),
            scale: None,
        };
        let loose = PoseWarning::Loose { freedom };
        let ambiguous = PoseWarning::Ambiguous { ratio: 1.03 };
        assert_eq!(warnings(&estimate), [ambiguous, loose]);
        estimate.runner_up = None;
        assert_eq!(warnings(&estimate), [loose]);
        estimate.uncertainty = None;
        assert!(warnings(&estimate).is_empty());
    }
    #[test]
    fn the_end_of_a_method_is_called_by_what_happened() {
        let ended = |stopped, true_error| {
            let track = Track {
                poses: vec![RigidTransform::identity(); 58],
                e_m2: Vec::new(),
                log_e: Vec::new(),
                searches: Vec::new(),
                stopped,
                fit: FitQuality {
                    e_m2: 0.0012,
                    rms_m: 0.0025,
                    overlap: 0.89,
                    sight: None,
                },
                uncertainty: None,
                true_error,
                doubts: Vec::new(),
            };
            let [what, says] = track.ending();
            assert!(!says.is_empty(), "{what}");
            what
        };
        let astray = rigid::PoseDelta {
            rotation: Radians::from_degrees(20.0),
            shift: Metres(0.0),
        };
        for (stopped, true_error, expected) in [
            (
                Stopped::BelowThreshold,
                None,
                "Threshold reached: E < 1e-6 m², 57 iterations",
            ),
            (Stopped::Converged, None, "Converged after 57 iterations"),
            (
                Stopped::Converged,
                Some(astray),
                "Converged elsewhere after 57 iterations",
            ),
            (
                Stopped::NoProgress,
                None,
                "Threshold not reached: best of 57 iterations",
            ),
            (
                Stopped::IterationLimit,
                None,
                "Maximum number of iterations: 57",
            ),
        ] {
            assert_eq!(ended(stopped, true_error), expected);
        }
    }
}
