//! Progress, times and cancellation of an inspection.

use std::{
    cell::Cell,
    time::{Duration, Instant},
};

use stages::scan::Unwatched;

/// How long each stage took, over all surfaces of the scene that were tried.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Segmentation.
    pub segment: Duration,
    /// Projection.
    pub project: Duration,
    /// Contour.
    pub contour: Duration,
    /// Signature.
    pub signature: Duration,
    /// Ranking.
    pub rank: Duration,
    /// Confirmation and pose.
    pub pose: Duration,
    /// From the scene's points to the verdict, or from the verdict on the part before. Stages that ran beside those of an
    /// earlier part are not in it, so that the totals of a frame's parts add up to the time that it took.
    pub total: Duration,
}

/// A stage of an inspection, as reported to a [`ProgressObserver`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Segmentation.
    Segment,
    /// Projection.
    Project,
    /// Contour.
    Contour,
    /// Signature.
    Signature,
    /// Ranking.
    Rank,
    /// Pose.
    Pose,
}

/// Follows an inspection and can cancel it.
pub trait ProgressObserver {
    /// Called when a stage begins.
    fn begins(&self, _stage: Stage) {}
    /// Returns true once the inspection should stop.
    fn is_cancelled(&self) -> bool {
        false
    }
}

impl ProgressObserver for Unwatched {}

/// The caller cancelled the inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the inspection was cancelled")]
pub struct Cancelled;

/// Times stages, reports them to the observer and stops between them when cancelled.
pub(super) struct StageClock<'a> {
    watch: &'a dyn ProgressObserver,
    started: Instant,
    timings: Cell<Timings>,
}

impl<'a> StageClock<'a> {
    pub(super) fn start(watch: &'a dyn ProgressObserver) -> Self {
        Self {
            watch,
            started: Instant::now(),
            timings: Cell::default(),
        }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }

    pub(super) fn time<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> Result<T, Cancelled> {
        if self.watch.is_cancelled() {
            return Err(Cancelled);
        }
        self.watch.begins(stage);
        let begun = Instant::now();
        let output = work();
        let mut timings = self.timings.get();
        *match stage {
            Stage::Segment => &mut timings.segment,
            Stage::Project => &mut timings.project,
            Stage::Contour => &mut timings.contour,
            Stage::Signature => &mut timings.signature,
            Stage::Rank => &mut timings.rank,
            Stage::Pose => &mut timings.pose,
        } += begun.elapsed();
        self.timings.set(timings);
        Ok(output)
    }

    /// Adds stages that ran on another thread beside an earlier part.
    pub(super) fn add(&self, done: &Timings) {
        let mut timings = self.timings.get();
        timings.segment += done.segment;
        timings.project += done.project;
        timings.contour += done.contour;
        timings.signature += done.signature;
        timings.rank += done.rank;
        timings.pose += done.pose;
        self.timings.set(timings);
    }

    pub(super) fn finish(&self) -> Timings {
        Timings {
            total: self.started.elapsed(),
            ..self.timings.get()
        }
    }
}
