//! Surfaces that are inspected at the same time as the likeliest one, where several parts may hang.

use std::{
    collections::VecDeque,
    sync::atomic::{AtomicBool, Ordering},
};

use super::{
    Cancelled, ProgressObserver, Stage, Timings,
    surface::{InspectionInputs, SurfaceResult, inspect_surface},
    watch::StageClock,
};
use geometry::{
    error::guarded,
    parallel::{map_beside, num_cores},
};
use stages::segment::{Segmentation, SegmentedPart, other_segments};

/// What the stages find on surfaces before their turn comes. It depends on the surface alone, so that an inspection is the
/// same on any number of cores.
pub(super) struct SurfacesAhead {
    /// `None` until the scene is segmented.
    waiting: Option<VecDeque<SegmentedPart>>,
    inspected: Vec<(SegmentedPart, SurfaceResult, Timings)>,
    max_parts: usize,
}

/// Tells the threads beside an inspection whether it was cancelled.
struct Beside<'a>(&'a AtomicBool);

impl ProgressObserver for Beside<'_> {
    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl SurfacesAhead {
    /// Inspects up to `max_parts` surfaces at the same time; of one core or part, one.
    pub(super) fn new(max_parts: usize) -> Self {
        Self {
            waiting: None,
            inspected: Vec::new(),
            max_parts,
        }
    }

    /// Runs the stages after segmentation on the part of a segmentation, unless that was done ahead, and on the surfaces that
    /// are likely to come next, on the other cores.
    pub(super) fn inspect(
        &mut self,
        segmentation: &Segmentation,
        part: &SegmentedPart,
        inputs: &InspectionInputs<'_>,
    ) -> Result<SurfaceResult, Cancelled> {
        let known = self.inspected.iter().position(|(known, ..)| known == part);
        if let Some(index) = known {
            let (_, result, timings) = self.inspected.swap_remove(index);
            inputs.clock.add(&timings);
            return Ok(result);
        }
        let next = self.next(segmentation, part, inputs)?;
        let InspectionInputs {
            scene,
            library,
            recipe,
            rack,
            ..
        } = *inputs;
        let is_cancelled = AtomicBool::new(false);
        let inspect_ahead = |i: usize| {
            let watch = Beside(&is_cancelled);
            let inputs = &InspectionInputs {
                scene,
                library,
                recipe,
                clock: &StageClock::start(&watch),
                rack,
            };
            // If the program fails here, it fails again when the surface's turn comes.
            let result = guarded(|| inspect_surface(&next[i], inputs, 0.0)).ok()?;
            Some((result.ok()?, inputs.clock.finish()))
        };
        let (found, ahead) = map_beside(next.len(), inspect_ahead, || {
            let found = inspect_surface(part, inputs, 0.0);
            is_cancelled.store(found.is_err(), Ordering::Relaxed);
            found
        });
        for (part, ahead) in next.into_iter().zip(ahead) {
            if let Some((result, timings)) = ahead {
                self.inspected.push((part, result, timings));
            }
        }
        found
    }

    /// As many surfaces as there are other cores, the likeliest first.
    fn next(
        &mut self,
        segmentation: &Segmentation,
        part: &SegmentedPart,
        inputs: &InspectionInputs<'_>,
    ) -> Result<Vec<SegmentedPart>, Cancelled> {
        let num_others = num_cores().min(self.max_parts) - 1;
        if num_others == 0 {
            return Ok(Vec::new());
        }
        let waiting = if let Some(waiting) = &mut self.waiting {
            waiting
        } else {
            let (scene, params) = (inputs.scene, &inputs.recipe.segment);
            let limit = self.max_parts - 1;
            let others = inputs.clock.time(Stage::Segment, || {
                other_segments(scene, segmentation, params, limit)
            })?;
            self.waiting.insert(others.into())
        };
        waiting.retain(|other| other != part);
        let num_next = num_others.min(waiting.len());
        Ok(waiting.drain(..num_next).collect())
    }
}
