//! Moves with the gun off, kept clear of the part.
//!
//! Rows and rings keep their stand-off along the smoothed surface, but ribs may rise above it, and the straight moves
//! between rows may come nearer, around a bend or from one raster to the next. Points and moves with the gun off are
//! lifted along the side where the surface is too near. A way may begin or end at a stroke that is itself nearer: it must
//! spray from there, so the way has its distance at that end, and at least half of each millimetre from it more. The
//! distance to the nearest point grows by no more than the nozzle moves, so lifting repeatedly by the missing distance
//! ends at the least lift that is clear. Lifted points that a straight move does not need are removed again.
//!
//! Known limits: moves are only kept clear of the part, not of what holds it, and only the mouth of the gun is
//! considered.

use nalgebra::{Point3, Unit, Vector3};

use super::{
    coat::Coat,
    surface::{PaintSurface, tree_of},
};
use geometry::nearest::KdTree;
use inspection::library::PathPoint;

/// Distance from the surface that moves with the gun off keep, as a share of the stand-off.
pub(super) const CLEARANCE_SHARE: f64 = 0.65;
/// Distance of the samples of a move, as a share of the stand-off.
const SAMPLE_SHARE: f64 = 0.1;
/// Distance gained from the surface per distance from the end of a stroke that is nearer to it.
const RISE_SLOPE: f64 = 0.5;
/// Most rounds of lifting: lifted moves may come too near elsewhere, fewer each time.
const MAX_ROUNDS: usize = 6;
/// Least increase of a lift, metres.
const MIN_LIFT_M: f64 = 0.001;

struct Clearance {
    tree: KdTree,
    side: Vector3<f64>,
    /// Distance to be kept, metres.
    kept: f64,
    step: f64,
}

/// A point of the path, or one inserted in between.
struct Stop {
    point: PathPoint,
    is_inserted: bool,
}

/// A place where a way with the gun off begins or ends, and its distance from the surface.
type End = (Point3<f64>, f64);

/// Inserts and lifts points where a way with the gun off comes too near to the surface. The first and the last point
/// stay where they are, as do those at which the gun is switched.
pub(super) fn keep_clear(
    points: Vec<PathPoint>,
    surface: &PaintSurface,
    coat: &Coat,
) -> Vec<PathPoint> {
    let clearance = Clearance {
        tree: tree_of(&surface.points),
        side: surface.side,
        kept: CLEARANCE_SHARE * coat.stand_off,
        step: SAMPLE_SHARE * coat.stand_off,
    };
    let stops = points.into_iter().map(|point| Stop {
        point,
        is_inserted: false,
    });
    let mut stops: Vec<Stop> = stops.collect();
    for _ in 0..MAX_ROUNDS {
        let before = stops.len();
        stops = clearance.lifted(stops, coat);
        if stops.len() == before {
            break;
        }
    }
    clearance.without_needless(&stops)
}

impl Clearance {
    /// Distance to the nearest point of the surface.
    fn distance(&self, p: &Point3<f64>) -> f64 {
        let found = self.tree.nearest(&p.cast(), f32::INFINITY);
        found.map_or(f64::INFINITY, |found| f64::from(found.distance_sq).sqrt())
    }

    /// For each stop the nearest ends of ways with the gun off before and behind it; the stop itself if it is one.
    fn ends_of(&self, stops: &[Stop]) -> Vec<[End; 2]> {
        let is_sprayed = |i: usize| stops[i].point.is_gun_on;
        let own = (0..stops.len()).map(|i| {
            let is_end = i == 0 || i + 1 == stops.len() || is_sprayed(i) || is_sprayed(i - 1);
            let at = stops[i].point.nozzle;
            is_end.then(|| (at, self.distance(&at)))
        });
        let mut before: Vec<Option<End>> = own.collect();
        let mut behind = before.clone();
        for i in 1..before.len() {
            before[i] = before[i].or(before[i - 1]);
        }
        for i in (1..behind.len()).rev() {
            behind[i - 1] = behind[i - 1].or(behind[i]);
        }
        // The first and the last stop are ends, so that none is without.
        let both = before.into_iter().zip(behind);
        both.filter_map(|(before, behind)| Some([before?, behind?]))
            .collect()
    }

    /// Distance to be kept at `p` on a way between `ends`, which may themselves be nearer, as in a corner to be
    /// sprayed.
    fn wanted(&self, p: &Point3<f64>, ends: &[End; 2]) -> f64 {
        let near = ends.map(|(end, distance)| distance + RISE_SLOPE * (p - end).norm());
        near.into_iter().fold(self.kept, f64::min)
    }

    /// The least lift with which a place is clear, metres.
    fn lift(&self, start: &Point3<f64>, ends: &[End; 2]) -> f64 {
        let mut lift = 0.0;
        loop {
            let p = start + self.side * lift;
            let missing = self.wanted(&p, ends) - self.distance(&p);
            if missing <= 1e-6 {
                return lift;
            }
            lift += missing.max(MIN_LIFT_M);
        }
    }

    /// Shares of the way between two points that are too near, each with the lift that it needs.
    fn too_near(&self, a: &Point3<f64>, b: &Point3<f64>, ends: &[End; 2]) -> Vec<(f64, f64)> {
        let num = ((b - a).norm() / self.step).ceil() as usize;
        let samples = (1..num).filter_map(|k| {
            let share = k as f64 / num as f64;
            let lift = self.lift(&(a + (b - a) * share), ends);
            (lift > 0.0).then_some((share, lift))
        });
        samples.collect()
    }

    fn lifted(&self, stops: Vec<Stop>, coat: &Coat) -> Vec<Stop> {
        let ends = self.ends_of(&stops);
        let mut all: Vec<Stop> = Vec::with_capacity(stops.len());
        for (i, mut next) in stops.into_iter().enumerate() {
            let [before, behind] = ends[i];
            if before != behind {
                let lift = self.lift(&next.point.nozzle, &ends[i]);
                if lift > 0.0 {
                    next.point.nozzle += self.side * lift;
                    next.point.stand_off = None;
                }
            }
            if let Some(last) = all.last().filter(|last| !last.point.is_gun_on) {
                let (a, b) = (last.point, next.point);
                let ends = [ends[i - 1][0], behind];
                for (share, lift) in self.too_near(&a.nozzle, &b.nozzle, &ends) {
                    let jet = a.direction.lerp(&b.direction, share);
                    let direction = Unit::try_new(jet, 1e-3).unwrap_or(a.direction);
                    // A fan stays perpendicular to the jet, which turns on the way.
                    let fan = if share < 0.5 { a.fan } else { b.fan };
                    let across = fan.map(|fan| *fan - *direction * direction.dot(&fan));
                    let point = PathPoint {
                        nozzle: a.nozzle + (b.nozzle - a.nozzle) * share + self.side * lift,
                        direction,
                        stand_off: None,
                        is_gun_on: false,
                        speed: Some(coat.speed),
                        fan: across.and_then(|across| Unit::try_new(across, 1e-3)),
                    };
                    all.push(Stop {
                        point,
                        is_inserted: true,
                    });
                }
            }
            all.push(next);
        }
        all
    }

    fn without_needless(&self, stops: &[Stop]) -> Vec<PathPoint> {
        let ends = self.ends_of(stops);
        let mut all: Vec<PathPoint> = Vec::with_capacity(stops.len());
        for (i, stop) in stops.iter().enumerate() {
            if stop.is_inserted
                && let (Some(before), Some(after)) = (all.last(), stops.get(i + 1))
                && self
                    .too_near(&before.nozzle, &after.point.nozzle, &ends[i])
                    .is_empty()
            {
                continue;
            }
            all.push(stop.point);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{Pattern, plan, surface::tests::grid};
    use stages::reference::Coverage;

    /// Least distance from the surface of the moves with the gun off, as a share of the stand-off, sampled every 5 mm.
    fn least_clearance(surface: &PaintSurface, points: &[PathPoint], coat: &Coat) -> f64 {
        let mut least = f64::INFINITY;
        for pair in points.windows(2).filter(|pair| !pair[0].is_gun_on) {
            let way = pair[1].nozzle - pair[0].nozzle;
            let num = (way.norm() / 0.005).ceil() as usize;
            for k in 0..=num {
                let p = pair[0].nozzle + way * (k as f64 / num.max(1) as f64);
                let nearest = surface.points.iter().map(|q| (q - p).norm());
                least = nearest.fold(least, f64::min);
            }
        }
        least / coat.stand_off
    }

    fn hatched(tilt_limit: f64) -> Coat {
        Coat {
            pattern: Pattern::CrossHatch,
            tilt_limit,
            flank_lean: 0.0,
            ..Coat::default()
        }
    }

    #[test]
    fn from_one_raster_to_the_next_the_way_goes_over_a_bent_part_and_not_through_it() {
        // Three quarters of a half pipe, painted on the outside.
        let surface = grid(61, 81, Coverage::OneSide, |i, j| {
            let (x, angle) = (0.8 * i - 0.4, 2.4 * (j - 0.5));
            let normal = Vector3::new(0.0, angle.sin(), angle.cos());
            (Point3::from(normal * 0.25 + Vector3::x() * x), normal)
        });
        let coat = hatched(1.2);
        let path = plan(&surface, &coat, &[]).expect("planned");
        let least = least_clearance(&surface, path.points(), &coat);
        assert!(least > 0.6, "{least}");
        // Without the lifted points the path goes through the part.
        let plain = path.points().iter().filter(|p| p.stand_off.is_some());
        let plain: Vec<PathPoint> = plain.copied().collect();
        assert!(plain.len() < path.points().len());
        assert!(least_clearance(&surface, &plain, &coat) < 0.5);
        // Lifted points never spray, and are few.
        let num_lifted = path.points().len() - plain.len();
        assert!(num_lifted < 20, "{num_lifted}");
    }

    #[test]
    fn over_a_wide_opening_and_around_an_l_nothing_needs_lifting() {
        let coat = hatched(0.8);
        for is_l in [false, true] {
            let surface = grid(101, 101, Coverage::OneSide, |i, j| {
                let (x, y) = (i - 0.5, j - 0.5);
                // Points that are not on the part are moved to its edge.
                let (x, y) = if is_l && x > -0.1 && y > -0.1 {
                    (-0.1, y)
                } else if !is_l && x.abs() < 0.2 && y.abs() < 0.2 {
                    (0.2 * x.signum(), y)
                } else {
                    (x, y)
                };
                (Point3::new(x, y, 0.0), Vector3::z())
            });
            let path = plan(&surface, &coat, &[]).expect("planned");
            assert!(path.points().iter().all(|p| p.stand_off.is_some()));
            let least = least_clearance(&surface, path.points(), &coat);
            assert!(least > 0.99, "{least}");
        }
    }
}
