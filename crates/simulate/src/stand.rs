//! Stands of the plain cell.

use nalgebra::{Point3, Vector2, Vector3};
use rand::RngExt as _;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::assembly::{Assembly, bounds};
use super::beam::{Section, sweep};
use super::rasteriser::Plane;

/// The stand that holds the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stand {
    /// No stand in sight.
    #[default]
    None,
    /// A post behind the part with a cross bar and two hooks over the part's upper edge.
    Post,
    /// The part stands on the floor, on an edge or on two corners, and the camera looks down at it.
    Floor,
}

/// How far the camera looks down at a part on the floor, in radians.
const LOOKING_DOWN_RAD: std::ops::Range<f64> = 0.0..0.45;

/// Draws the downward direction for a camera that looks down at the floor.
pub(super) fn down_from_above(random: &mut Pcg64) -> Vector3<f64> {
    let (sin, cos) = random.random_range(LOOKING_DOWN_RAD).sin_cos();
    Vector3::new(0.0, cos, sin)
}

/// Returns the floor below a part at its present pose: roughly perpendicular to `down`, rolled in the picture so that it
/// touches the part on both sides of its middle.
pub(super) fn floor_below(hung: &[Point3<f64>], down: &Vector3<f64>) -> Option<Plane> {
    let aside = Vector3::x();
    // Coordinates sideways and down.
    let mut flat: Vec<[f64; 2]> = hung
        .iter()
        .map(|p| [aside.dot(&p.coords), down.dot(&p.coords)])
        .collect();
    flat.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let middle = flat.iter().map(|p| p[0]).sum::<f64>() / flat.len().max(1) as f64;
    let mut lower: Vec<[f64; 2]> = Vec::new();
    for p in flat {
        // Lower side of the convex hull: drop corners above the line between their neighbours.
        while let [.., a, b] = lower[..]
            && (b[0] - a[0]) * (p[1] - a[1]) >= (b[1] - a[1]) * (p[0] - a[0])
        {
            lower.pop();
        }
        lower.push(p);
    }
    let edge = lower.windows(2).find(|edge| edge[1][0] >= middle)?;
    let along = Vector2::new(edge[1][0] - edge[0][0], edge[1][1] - edge[0][1]);
    let along = along.try_normalize(1e-9)?;
    let normal = down * along.x - aside * along.y;
    let reach = hung.iter().map(|p| normal.dot(&p.coords));
    Some(Plane {
        normal,
        offset: reach.fold(f64::NEG_INFINITY, f64::max),
    })
}

/// Builds a post behind the part, a cross bar at its upper edge, and two hooks over that edge.
pub(super) fn post(hung: &[Point3<f64>], floor: &Plane) -> Assembly {
    let mut stand = Assembly::default();
    let Some((low, high)) = bounds(hung) else {
        return stand;
    };
    let x = 0.5 * (low.x + high.x);
    let z = high.z + 0.05;
    let reach = HOOK_REACH * (high.x - low.x);
    let hooks = hooked_edges(hung);
    let bar_y = hooks.iter().map(|p| p.y).fold(low.y + 0.1, f64::min);
    let facing = -Vector3::z();
    let bar = [
        Point3::new(x - reach - 0.05, bar_y, z),
        Point3::new(x + reach + 0.05, bar_y, z),
    ];
    sweep(&mut stand, &bar, ROD, facing);
    add_upright(&mut stand, Point3::new(x, bar_y, z), floor);
    for edge in hooks {
        add_hook(&mut stand, bar_y, z, edge);
    }
    stand
}

/// Builds a bar above parts side by side, two hooks from it over the upper edge of each, and an upright at either end.
pub(super) fn rack(parts: &[Vec<Point3<f64>>], floor: &Plane) -> Assembly {
    const ABOVE: f64 = 0.06;
    const BESIDE: f64 = 0.10;
    let mut stand = Assembly::default();
    let Some((low, high)) = bounds(&parts.concat()) else {
        return stand;
    };
    let hooks: Vec<Point3<f64>> = parts.iter().flat_map(|part| hooked_edges(part)).collect();
    let z = hooks.iter().map(|p| p.z).fold(low.z, f64::max) + 0.05;
    let ends = [low.x - BESIDE, high.x + BESIDE].map(|x| Point3::new(x, low.y - ABOVE, z));
    sweep(&mut stand, &ends, ROD, -Vector3::z());
    for end in ends {
        add_upright(&mut stand, end, floor);
    }
    for edge in hooks {
        add_hook(&mut stand, low.y - ABOVE, z, edge);
    }
    stand
}

/// Distance of a hook from the middle of the part, as a share of the part's width.
const HOOK_REACH: f64 = 0.2;
/// The bar that carries the hooks.
const ROD: Section = Section::Round { radius: 0.012 };

/// Returns the points of the part's upper edge over which its two hooks go: the highest within 2 cm to either side.
fn hooked_edges(hung: &[Point3<f64>]) -> Vec<Point3<f64>> {
    let Some((low, high)) = bounds(hung) else {
        return Vec::new();
    };
    let x = 0.5 * (low.x + high.x);
    let reach = HOOK_REACH * (high.x - low.x);
    let edge_above = |x: f64| {
        hung.iter()
            .filter(|p| (p.x - x).abs() < 0.02)
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .copied()
    };
    [x - reach, x + reach]
        .into_iter()
        .filter_map(edge_above)
        .collect()
}

/// Adds an upright from the floor to `top`.
fn add_upright(stand: &mut Assembly, top: Point3<f64>, floor: &Plane) {
    let foot = Point3::new(top.x, floor.height_at(top.x, top.z), top.z);
    let square = Section::Bar {
        width: 0.04,
        depth: 0.04,
    };
    sweep(stand, &[foot, top], square, -Vector3::z());
}

/// Adds a hook from the bar at height `bar_y` and depth `bar_z` over an upper edge.
fn add_hook(stand: &mut Assembly, bar_y: f64, bar_z: f64, edge: Point3<f64>) {
    let over = Point3::new(edge.x, edge.y - 0.008, edge.z - 0.01);
    let path = [
        Point3::new(edge.x, bar_y, bar_z),
        over,
        over + Vector3::new(0.0, 0.025, -0.012),
    ];
    let wire = Section::Round { radius: 0.006 };
    sweep(stand, &path, wire, Vector3::x());
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;

    use super::*;
    use crate::part::{PartKind, PartModel, Side};

    #[test]
    fn a_part_stands_on_the_floor_to_both_sides_of_its_middle() {
        for (kind, seed) in PartKind::ALL.into_iter().zip(0..) {
            let down = down_from_above(&mut Pcg64::seed_from_u64(seed));
            let hung: Vec<Point3<f64>> = PartModel::new(kind, Side::Left, 0)
                .into_mesh()
                .vertices
                .iter()
                .map(|p| p.cast::<f64>() + Vector3::new(0.1, 0.0, 1.3))
                .collect();
            let floor = floor_below(&hung, &down).expect("a floor");
            let above = |p: &Point3<f64>| floor.offset - floor.normal.dot(&p.coords);
            assert!(hung.iter().all(|p| above(p) > -1e-9), "{kind}");
            let touching = hung.iter().filter(|p| above(p) < 1e-6);
            let middle = hung.iter().map(|p| p.x).sum::<f64>() / hung.len() as f64;
            let (left, right): (Vec<f64>, Vec<f64>) =
                touching.map(|p| p.x).partition(|x| *x < middle);
            assert!(!left.is_empty() && !right.is_empty(), "{kind}");
            assert!(floor.normal.dot(&down) > 0.7, "{kind}: {:?}", floor.normal);
        }
    }
}
