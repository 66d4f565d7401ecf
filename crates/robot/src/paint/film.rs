//! Computes the film that a path leaves on a surface.
//!
//! Each way with the gun on is cut into steps of an eighth of the jet's depth. A step deposits for its duration what
//! the gun at its middle deposits (midpoint sums of the film growth in `gun.rs`), with the distance and the angle of
//! every point. Points that another part of the surface hides from the mouth get nothing (`shadow.rs`).
//!
//! Known limits: only the side that is painted casts shadows.

use std::f64::consts::{FRAC_PI_6, PI, TAU};

use nalgebra::{Point3, Unit, Vector3};
use serde::Serialize;

use super::{
    coat::Coat,
    error::PaintError,
    region::{KeepOut, are_kept_out},
    shadow::{DISC_RADIUS_SPACINGS, DirectionGrid, Seen, ViewFromAfar},
    surface::{PaintSurface, across, tree_of},
};
use geometry::{
    nearest::KdTree,
    parallel::{map_in_order, num_cores},
};
use inspection::library::{PathPoint, SprayPath};

/// Number of steps in the depth of the jet.
const STEPS_OVER_DEPTH: f64 = 8.0;
/// Steps that are summed together; fixed, so that the sums do not depend on the number of workers.
const STEPS_PER_SUM: usize = 256;
/// Below this share of the target a point is missed.
const MAX_MISSED_SHARE: f64 = 0.1;
/// Above this share of the target a point is painted twice.
const MIN_DOUBLE_SHARE: f64 = 1.8;
/// Bars of the histogram, a tenth of the target each; the last includes all that is thicker.
const NUM_BARS: usize = 20;
/// Angle beyond the tilt limit up to which a surface still counts as paintable: cos 30° is 0.87 of the film.
const PAINTABLE_ANGLE_RAD: f64 = FRAC_PI_6;
/// Step between the tilts that are tried, radians, and number of directions of each.
const TILT_STEP_RAD: f64 = PI / 36.0;
const NUM_TURNS: u32 = 24;
/// The best tilt may be this far from the nearest one tried, radians.
const TILT_SLACK_RAD: f64 = PI / 90.0;

/// The film on a surface.
#[derive(Clone, Debug)]
pub struct Film {
    /// Thickness at each point of the surface, metres.
    pub thickness: Vec<f64>,
    /// True for points that the gun can face with nothing in between, and that are not kept out.
    pub is_paintable: Vec<bool>,
    /// Figures of the film.
    pub figures: FilmFigures,
    /// Figures of the path.
    pub path: PathFigures,
}

/// Figures of a film. Shares are of the paintable area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FilmFigures {
    /// Share of the surface's area that the gun can face with nothing in between, and that is not kept out.
    pub paintable: f64,
    /// Share within the tolerance of the target.
    pub within: f64,
    /// Share with less than a tenth of the target.
    pub missed: f64,
    /// Share with more than 1.8 times the target.
    pub double: f64,
    /// Mean thickness, metres.
    pub mean: f64,
    /// Least thickness, metres.
    pub min: f64,
    /// Greatest thickness, metres.
    pub max: f64,
    /// Shares by thickness, a tenth of the target each; the last includes all that is thicker.
    pub histogram: [f64; NUM_BARS],
}

/// Figures of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PathFigures {
    /// Volume of paint sprayed, cubic metres.
    pub paint: f64,
    /// Share of the sprayed solids that stay on the surface.
    pub landed: f64,
    /// Duration at the path's speeds, seconds.
    pub time: f64,
    /// Length of the nozzle's way, metres.
    pub length: f64,
}

/// A short way with the gun on.
struct Step {
    /// Index of the point of the path before it.
    point: usize,
    nozzle: Point3<f64>,
    /// Axes of the jet: along the fan, across it and along the jet.
    axes: [Vector3<f64>; 3],
    seconds: f64,
}

/// Computes the film that the gun of a coat leaves on a surface along a path, and compares it with the coat's target
/// where paint is wanted.
pub fn simulate(
    surface: &PaintSurface,
    path: &SprayPath,
    coat: &Coat,
    keep_outs: &[KeepOut],
) -> Result<Film, PaintError> {
    coat.check()?;
    for region in keep_outs {
        region.check()?;
    }
    let (steps, time, length) = steps_of(path.points(), coat);
    if steps.is_empty() {
        return Err(PaintError::NeverSprays);
    }
    let jet = Jet::new(surface, coat);
    let num_sums = steps.len().div_ceil(STEPS_PER_SUM);
    let sums = map_in_order(
        num_sums,
        num_cores(),
        || jet.scratch(),
        |scratch, which| {
            let end = steps.len().min((which + 1) * STEPS_PER_SUM);
            let mut sum = vec![0.0; surface.points.len()];
            for step in &steps[which * STEPS_PER_SUM..end] {
                jet.spray(step, scratch, |index, film| sum[index] += film);
            }
            sum
        },
    );
    let mut thickness = vec![0.0; surface.points.len()];
    for sum in sums {
        thickness
            .iter_mut()
            .zip(sum)
            .for_each(|(all, part)| *all += part);
    }
    let is_paintable = are_paintable(surface, coat, keep_outs);
    let seconds_on: f64 = steps.iter().map(|step| step.seconds).sum();
    let stays = thickness.iter().sum::<f64>() * surface.point_area;
    Ok(Film {
        figures: FilmFigures::of(&thickness, &is_paintable, coat)?,
        path: PathFigures {
            paint: coat.gun.flow * seconds_on,
            landed: stays / (coat.gun.flow * coat.gun.solids * seconds_on),
            time,
            length,
        },
        thickness,
        is_paintable,
    })
}

/// Returns for each point of the surface whether a gun within the tilt limit can face it with nothing in between, and it
/// is not kept out.
pub(super) fn are_paintable(
    surface: &PaintSurface,
    coat: &Coat,
    keep_outs: &[KeepOut],
) -> Vec<bool> {
    let least = (coat.tilt_limit + PAINTABLE_ANGLE_RAD).cos();
    let kept_out = are_kept_out(surface, keep_outs);
    let is_wanted = |i: &usize| surface.normals[*i].dot(&surface.side) >= least && !kept_out[*i];
    let mut waiting: Vec<usize> = (0..surface.points.len()).filter(is_wanted).collect();
    let mut are_paintable = vec![false; surface.points.len()];
    let least = (PAINTABLE_ANGLE_RAD + TILT_SLACK_RAD).cos();
    for direction in tilts(&surface.side, coat.tilt_limit) {
        let faces = |i: &usize| surface.normals[*i].dot(&direction) >= least;
        if !waiting.iter().any(faces) {
            continue;
        }
        let view = ViewFromAfar::new(surface, &direction);
        waiting.retain(|i| {
            are_paintable[*i] = faces(i) && view.sees(*i, coat.stand_off);
            !are_paintable[*i]
        });
    }
    are_paintable
}

/// Directions towards guns that are tilted by at most the limit, the upright one first.
fn tilts(side: &Vector3<f64>, limit: f64) -> impl Iterator<Item = Vector3<f64>> {
    let x = across(side);
    let y = side.cross(&x);
    let num_rings = (limit / TILT_STEP_RAD).ceil();
    let rings = (1..=num_rings as usize).map(move |ring| limit * ring as f64 / num_rings);
    let turns = (0..NUM_TURNS).map(|turn| TAU * f64::from(turn) / f64::from(NUM_TURNS));
    let leaned = rings.flat_map(move |tilt| turns.clone().map(move |turn| (tilt, turn)));
    let side = *side;
    let leaned = leaned.map(move |(tilt, turn)| {
        side * tilt.cos() + (x * turn.cos() + y * turn.sin()) * tilt.sin()
    });
    std::iter::once(side).chain(leaned)
}

/// What the gun leaves on its way from one point of a path to the next: points of the surface, each with its thickness,
/// metres.
pub(super) type Deposit = Vec<(u32, f32)>;

/// Computes what each way with the gun on leaves on a surface, in the order of the path. Their sum is the film.
pub(super) fn deposits(surface: &PaintSurface, points: &[PathPoint], coat: &Coat) -> Vec<Deposit> {
    let (steps, ..) = steps_of(points, coat);
    let ways: Vec<&[Step]> = steps.chunk_by(|a, b| a.point == b.point).collect();
    let jet = Jet::new(surface, coat);
    map_in_order(
        ways.len(),
        num_cores(),
        || (jet.scratch(), vec![0.0; surface.points.len()]),
        |(scratch, sum), which| {
            let mut reached = Vec::new();
            for step in ways[which] {
                jet.spray(step, scratch, |index, film| {
                    if sum[index] <= 0.0 {
                        reached.push(index);
                    }
                    sum[index] += film;
                });
            }
            let taken = |index| (index as u32, std::mem::take(&mut sum[index]) as f32);
            reached.into_iter().map(taken).collect::<Deposit>()
        },
    )
}

/// Steps with the gun on; seconds and metres of the whole path.
fn steps_of(points: &[PathPoint], coat: &Coat) -> (Vec<Step>, f64, f64) {
    let (mut steps, mut time, mut length) = (Vec::new(), 0.0, 0.0);
    for (point, pair) in points.windows(2).enumerate() {
        let [a, b] = pair else { continue };
        let way = (b.nozzle - a.nozzle).norm();
        let seconds = way / a.speed.unwrap_or(coat.speed);
        time += seconds;
        length += way;
        if !a.is_gun_on || seconds <= 0.0 {
            continue;
        }
        let distance = a.stand_off.map_or(coat.stand_off, |d| d.0);
        let depth = coat.gun.depth * distance / coat.gun.distance;
        let num = (way / depth * STEPS_OVER_DEPTH).ceil().max(1.0) as usize;
        for k in 0..num {
            let share = (k as f64 + 0.5) / num as f64;
            let (nozzle, axes) = gun_at(a, b, share);
            steps.push(Step {
                point,
                nozzle,
                axes,
                seconds: seconds / num as f64,
            });
        }
    }
    (steps, time, length)
}

/// Nozzle and axes of the jet on the way from one point to another.
fn gun_at(a: &PathPoint, b: &PathPoint, share: f64) -> (Point3<f64>, [Vector3<f64>; 3]) {
    let between = |a: &Vector3<f64>, b: &Vector3<f64>| a + (b - a) * share;
    let jet = between(&a.direction, &b.direction);
    let jet = Unit::try_new(jet, 1e-9).unwrap_or(a.direction).into_inner();
    let fan = match (a.fan, b.fan) {
        // The sign of a fan is arbitrary.
        (Some(a), Some(b)) => between(&a, &(b.into_inner() * a.dot(&b).signum())),
        (Some(fan), None) | (None, Some(fan)) => fan.into_inner(),
        (None, None) => jet.cross(&(b.nozzle - a.nozzle)),
    };
    let fan = (fan - jet * jet.dot(&fan)).try_normalize(1e-9);
    let fan = fan.unwrap_or_else(|| across(&jet));
    let nozzle = a.nozzle + (b.nozzle - a.nozzle) * share;
    (nozzle, [fan, jet.cross(&fan), jet])
}

/// A gun over a surface.
struct Jet<'a> {
    surface: &'a PaintSurface,
    coat: &'a Coat,
    tree: KdTree,
    /// Corners of a box around the surface.
    corners: [Point3<f64>; 8],
}

impl<'a> Jet<'a> {
    fn new(surface: &'a PaintSurface, coat: &'a Coat) -> Self {
        Self {
            surface,
            coat,
            tree: tree_of(&surface.points),
            corners: corners_of(surface),
        }
    }

    fn scratch(&self) -> (DirectionGrid, Vec<Seen>) {
        let Self { surface, coat, .. } = self;
        let grid = DirectionGrid::new(coat.gun.spread(), surface.spacing, coat.stand_off);
        (grid, Vec::new())
    }

    /// Calls `add` with each point of the surface that one step paints, and its thickness.
    fn spray(
        &self,
        step: &Step,
        (grid, seen): &mut (DirectionGrid, Vec<Seen>),
        mut add: impl FnMut(usize, f64),
    ) {
        let Self {
            surface,
            coat,
            tree,
            corners,
        } = self;
        let spread = coat.gun.spread();
        // Paint flies on until it meets the surface, however far the path is from it.
        let depths = corners.map(|corner| step.axes[2].dot(&(corner - step.nozzle)));
        let depth = depths.into_iter().fold(0.0, f64::max);
        // Discs beside the jet may reach into it.
        let beside = DISC_RADIUS_SPACINGS * surface.spacing;
        // The smallest ball around the jet down to that depth: through the mouth if the jet is narrow.
        let slope = spread[0].max(spread[1]);
        let middle = depth * (0.5 * (1.0 + slope * slope)).min(1.0);
        let radius = middle.max(depth * slope) + beside;
        let ball = step.nozzle + step.axes[2] * middle;
        let in_jet = |v: &Vector3<f64>| Vector3::from(step.axes.map(|axis| axis.dot(v)));
        seen.clear();
        tree.within(&ball.cast(), radius as f32, |found| {
            let at = in_jet(&(surface.points[found.index] - step.nozzle));
            if at.z > 0.0 && (0..2).all(|axis| at[axis].abs() <= spread[axis] * at.z + beside) {
                seen.push(Seen {
                    index: found.index,
                    at,
                    normal: in_jet(&surface.normals[found.index]),
                });
            }
        });
        grid.sort(seen);
        for point in seen.iter() {
            let facing = -point.at.dot(&point.normal);
            let growth = coat.gun.film_growth(&point.at, facing);
            if growth > 0.0 && !grid.hides(seen, point, f64::INFINITY) {
                add(point.index, growth * step.seconds);
            }
        }
    }
}

/// Corners of the box around a surface along its side and its longest axis.
fn corners_of(surface: &PaintSurface) -> [Point3<f64>; 8] {
    let third = surface.side.cross(&surface.longest);
    let axes = [surface.side, surface.longest, third];
    let ranges = axes.map(|axis| {
        let each = surface.points.iter();
        let each = each.map(|point| axis.dot(&(point - surface.middle)));
        each.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            [low.min(at), high.max(at)]
        })
    });
    std::array::from_fn(|corner| {
        let each = axes.iter().zip(ranges).enumerate();
        let shifts = each.map(|(axis, (along, range))| along * range[(corner >> axis) & 1]);
        surface.middle + shifts.sum::<Vector3<f64>>()
    })
}

impl FilmFigures {
    fn of(thickness: &[f64], is_paintable: &[bool], coat: &Coat) -> Result<Self, PaintError> {
        let reached: Vec<f64> = thickness
            .iter()
            .zip(is_paintable)
            .filter(|(_, is)| **is)
            .map(|(t, _)| *t)
            .collect();
        if reached.is_empty() {
            return Err(PaintError::TooFew { found: 0 });
        }
        let num = reached.len() as f64;
        let share = |is: &dyn Fn(f64) -> bool| {
            reached.iter().filter(|t| is(**t / coat.target)).count() as f64 / num
        };
        let mut histogram = [0.0; NUM_BARS];
        for t in &reached {
            let bar = (t / coat.target * 10.0) as usize;
            histogram[bar.min(NUM_BARS - 1)] += 1.0 / num;
        }
        Ok(Self {
            paintable: num / thickness.len() as f64,
            within: share(&|t| (t - 1.0).abs() <= coat.tolerance),
            missed: share(&|t| t < MAX_MISSED_SHARE),
            double: share(&|t| t > MIN_DOUBLE_SHARE),
            mean: reached.iter().sum::<f64>() / num,
            min: reached.iter().copied().fold(f64::INFINITY, f64::min),
            max: reached.iter().copied().fold(0.0, f64::max),
            histogram,
        })
    }
}

#[cfg(test)]
mod tests;
