//! The best of the poses found: refined to the end, with what speaks for another one.

use super::{GlobalSearch, NEARLY_SETTLED, PoseTrial};
use crate::pose::{
    MIN_POINTS, PoseError, PoseEstimate, PoseMethod, RunnerUp,
    closest::Correspondence,
    prepared::Measured,
    quality::{Tolerance, measure_fit},
    refine::{Costs, Level, Search},
};
use geometry::{statistics::median, units::Metres};

/// Minimum of the last scale, in standard deviations of the noise.
const NOISE_PER_SCALE: f64 = 2.5;
/// Root mean square distance of pairs below which they are the same points, in spacings.
const SAME_POINTS: f64 = 0.3;
/// What ends the last level of clouds that share no point: a share of its scale.
const SETTLED_ENOUGH: f64 = 0.005;

impl GlobalSearch<'_> {
    /// Share of the source that lies on the target.
    pub(super) fn overlap(&self, trial: &PoseTrial) -> f64 {
        let some = &self.source.surface[..self.source.surface.len().min(500)];
        let tolerance = Tolerance {
            base: Metres(3.0 * self.prepared.spacing() + 2.0 * self.noise(trial)),
            noise_at_1m: Metres(0.0),
        };
        let pose = &trial.refined.target_from_source;
        let target = self.prepared.target();
        let closest = Correspondence::of_each(some, &target, pose, Search::Field);
        measure_fit(some, &closest, &target, tolerance).overlap
    }

    /// The best, refined to the end.
    pub(super) fn refine_best(
        &self,
        finished: Vec<PoseTrial>,
        outline_error: f64,
    ) -> Result<PoseEstimate, PoseError> {
        let mut finished = finished.into_iter();
        let mut best = finished.next().ok_or_else(|| self.no_overlap(0))?;
        let target = self.prepared.target();
        let noise = self.noise(&best);
        let finest = self.prepared.finest();
        // The surface alone may tell what the edges of a view do not, and the edges what a sheet does not.
        let evidence = |costs: &Costs| [costs.surface, costs.surface + costs.edges[0]];
        let runner_up = finished
            .map(|trial| {
                let pairs = evidence(&trial.costs)
                    .into_iter()
                    .zip(evidence(&best.costs));
                let ratios = pairs.map(|(other, best)| other / best.max(f64::MIN_POSITIVE));
                RunnerUp {
                    target_from_source: trial.refined.target_from_source,
                    ratio: ratios.fold(1.0, f64::max),
                }
            })
            .min_by(|a, b| a.ratio.total_cmp(&b.ratio));
        let finest = Level {
            scale: finest.scale.max(NOISE_PER_SCALE * noise),
            settled: SETTLED_ENOUGH,
            ..finest
        };
        // Most of the way on a third of the points.
        let levels = [
            Level {
                num_surface: finest.num_surface / 3,
                settled: NEARLY_SETTLED,
                ..finest
            },
            finest,
        ];
        if (self.is_cancelled)() {
            return Err(PoseError::Cancelled);
        }
        best.refine(&self.source, &target, &levels);
        let mut edges = self.source.edges.clone();
        let mut level = finest;
        let last = best.refined.iterations.last();
        if last.is_some_and(|last| last.e_m2.sqrt() < SAME_POINTS * self.prepared.spacing()) {
            // Copies of the same points: they locate the cloud better than any edge.
            edges.clear();
            level = Level {
                num_edges: 0,
                ..self.prepared.finest()
            };
            best.refine(&self.source, &target, &[level]);
        }
        let num_pairs = best.refined.iterations.last().map_or(0, |i| i.num_pairs);
        if num_pairs < MIN_POINTS {
            return Err(self.no_overlap(num_pairs));
        }
        let measured = Measured {
            surface: self.all_points,
            edges,
            level,
            outline_error,
        };
        let method = PoseMethod::Global;
        Ok(self
            .prepared
            .estimate(measured, best.refined, method, runner_up))
    }

    /// Standard deviation of the source's distance to the target's surface where it lies on it, metres: from the
    /// median, so that what lies elsewhere does not count.
    fn noise(&self, trial: &PoseTrial) -> f64 {
        let some = &self.source.surface[..self.source.surface.len().min(500)];
        let target = self.prepared.target();
        let pose = &trial.refined.target_from_source;
        let closest = Correspondence::of_each(some, &target, pose, Search::Field);
        let reach_sq = (0.05 * self.prepared.extent()).powi(2);
        let on_surface = closest
            .iter()
            .filter_map(|c| c.on_surface(&target, reach_sq));
        1.48 * median(on_surface.map(|on| on.off.abs())).unwrap_or(0.0)
    }

    fn no_overlap(&self, found: usize) -> PoseError {
        PoseError::NoOverlap {
            found,
            needed: MIN_POINTS,
            reach: Metres(0.5 * self.prepared.extent()),
        }
    }
}
