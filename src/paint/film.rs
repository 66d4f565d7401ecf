//! Computes the film that a path leaves on a surface.
//!
//! Each way with the gun on is cut into steps of an eighth of the jet's depth. A step deposits for its duration what
//! the gun at its middle deposits (midpoint sums of the film growth in `gun.rs`), with the distance and the angle of
//! every point. Points that another part of the surface hides from the mouth get nothing (`shadow.rs`).
//!
//! Known limits: only the side that is painted casts shadows.

use nalgebra::{Point3, Unit, Vector3};
use serde::Serialize;

use super::{
    coat::Coat,
    error::PaintError,
    region::{KeepOut, are_kept_out},
    shadow::{DISC, DirectionGrid, Seen},
    surface::PaintSurface,
};
use crate::{
    geometry::{
        nearest::KdTree,
        parallel::{map_in_order, num_cores},
    },
    library::{PathPoint, SprayPath},
};

/// Number of steps in the depth of the jet.
const STEPS_OVER_DEPTH: f64 = 8.0;
/// Steps that are summed together; fixed, so that the sums do not depend on the number of workers.
const STEPS_PER_SUM: usize = 256;
/// Below this share of the target a point is missed.
const MISSED_BELOW: f64 = 0.1;
/// Above this share of the target a point is painted twice.
const DOUBLE_ABOVE: f64 = 1.8;
/// Bars of the histogram, a tenth of the target each; the last includes all that is thicker.
const NUM_BARS: usize = 20;
/// Angle beyond the tilt limit up to which a surface still counts as reachable: cos 30° is 0.87 of the film.
const FACED_WITHIN: f64 = std::f64::consts::FRAC_PI_6;

/// The film on a surface.
#[derive(Clone, Debug)]
pub struct Film {
    /// Thickness at each point of the surface, metres.
    pub thickness: Vec<f64>,
    /// True for points that the gun can face and that are not kept out.
    pub is_reachable: Vec<bool>,
    /// Figures of the film.
    pub figures: FilmFigures,
    /// Figures of the path.
    pub path: PathFigures,
}

/// Figures of a film. Shares are of the reachable area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FilmFigures {
    /// Share of the surface's area that the gun can face and that is not kept out.
    pub reachable: f64,
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
    let (steps, time, length) = steps_of(path, coat);
    if steps.is_empty() {
        return Err(PaintError::NeverSprays);
    }
    let stored: Vec<Point3<f32>> = surface.points.iter().map(|p| p.cast()).collect();
    let tree = KdTree::new(&stored);
    let num_sums = steps.len().div_ceil(STEPS_PER_SUM);
    let sums = map_in_order(
        num_sums,
        num_cores(),
        || {
            let grid = DirectionGrid::new(coat.gun.spread(), surface.spacing, coat.stand_off);
            (grid, Vec::new())
        },
        |scratch, which| {
            let end = steps.len().min((which + 1) * STEPS_PER_SUM);
            let mut sum = vec![0.0; surface.points.len()];
            for step in &steps[which * STEPS_PER_SUM..end] {
                spray(surface, &tree, step, coat, scratch, &mut sum);
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
    let least = (coat.tilt_limit + FACED_WITHIN).cos();
    let kept_out = are_kept_out(surface, keep_outs);
    let wanted = surface.normals.iter().zip(kept_out);
    let is_reachable: Vec<bool> = wanted
        .map(|(n, is_kept_out)| n.dot(&surface.side) >= least && !is_kept_out)
        .collect();
    let seconds_on: f64 = steps.iter().map(|step| step.seconds).sum();
    let stays = thickness.iter().sum::<f64>() * surface.point_area;
    Ok(Film {
        figures: FilmFigures::of(&thickness, &is_reachable, coat)?,
        path: PathFigures {
            paint: coat.gun.flow * seconds_on,
            landed: stays / (coat.gun.flow * coat.gun.solids * seconds_on),
            time,
            length,
        },
        thickness,
        is_reachable,
    })
}

/// Steps with the gun on; seconds and metres of the whole path.
fn steps_of(path: &SprayPath, coat: &Coat) -> (Vec<Step>, f64, f64) {
    let (mut steps, mut time, mut length) = (Vec::new(), 0.0, 0.0);
    for pair in path.points().windows(2) {
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
            steps.push(step_at(a, b, share, seconds / num as f64));
        }
    }
    (steps, time, length)
}

fn step_at(a: &PathPoint, b: &PathPoint, share: f64, seconds: f64) -> Step {
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
    let fan = fan.unwrap_or_else(|| super::surface::across(&jet));
    Step {
        nozzle: a.nozzle + (b.nozzle - a.nozzle) * share,
        axes: [fan, jet.cross(&fan), jet],
        seconds,
    }
}

/// Adds the paint of one step; `grid` and `seen` are scratch.
fn spray(
    surface: &PaintSurface,
    tree: &KdTree,
    step: &Step,
    coat: &Coat,
    (grid, seen): &mut (DirectionGrid, Vec<Seen>),
    sum: &mut [f64],
) {
    let spread = coat.gun.spread();
    // At twice the stand-off the jet is thin, and the surface there is another part.
    let reach = 2.0 * coat.stand_off;
    let aim = step.nozzle + step.axes[2] * coat.stand_off;
    let radius = reach
        .min(coat.stand_off * spread[0].max(0.5) * 1.5)
        .max(coat.stand_off * spread[0]);
    // Discs beside the jet may reach into it.
    let beside = DISC * surface.spacing;
    let in_jet = |v: &Vector3<f64>| Vector3::from(step.axes.map(|axis| axis.dot(v)));
    seen.clear();
    tree.within(&aim.cast(), radius as f32, |found| {
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
        let growth = coat
            .gun
            .film_growth(&point.at, -point.at.dot(&point.normal));
        if growth > 0.0 && !grid.hides(seen, point) {
            sum[point.index] += growth * step.seconds;
        }
    }
}

impl FilmFigures {
    fn of(thickness: &[f64], is_reachable: &[bool], coat: &Coat) -> Result<Self, PaintError> {
        let reached: Vec<f64> = thickness
            .iter()
            .zip(is_reachable)
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
            reachable: num / thickness.len() as f64,
            within: share(&|t| (t - 1.0).abs() <= coat.tolerance),
            missed: share(&|t| t < MISSED_BELOW),
            double: share(&|t| t > DOUBLE_ABOVE),
            mean: reached.iter().sum::<f64>() / num,
            min: reached.iter().copied().fold(f64::INFINITY, f64::min),
            max: reached.iter().copied().fold(0.0, f64::max),
            histogram,
        })
    }
}

#[cfg(test)]
mod tests;
