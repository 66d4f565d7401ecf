//! What holds the part.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::beam::{Section, sweep};
use super::rasteriser::Plane;

/// What holds the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stand {
    /// Nothing in sight.
    #[default]
    None,
    /// A post behind the part with a cross bar and two hooks over the part's upper edge.
    Post,
}

/// A post behind the part, a cross bar at its upper edge, two hooks over that edge.
pub(super) fn post(hung: &[Point3<f64>], floor: &Plane) -> Assembly {
    let mut stand = Assembly::default();
    let Some(&first) = hung.first() else {
        return stand;
    };
    let (low, high) = hung
        .iter()
        .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let x = 0.5 * (low.x + high.x);
    let z = high.z + 0.05;
    let reach = 0.2 * (high.x - low.x);
    // The upper edge where a hook takes hold: the highest point within 2 cm to either side.
    let edge_above = |x: f64| {
        hung.iter()
            .filter(|p| (p.x - x).abs() < 0.02)
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .copied()
    };
    let hooks: Vec<Point3<f64>> = [x - reach, x + reach]
        .into_iter()
        .filter_map(edge_above)
        .collect();
    let bar_y = hooks.iter().map(|p| p.y).fold(low.y + 0.1, f64::min);
    let facing = -Vector3::z();
    let rod = Section::Round { radius: 0.012 };
    let bar = [
        Point3::new(x - reach - 0.05, bar_y, z),
        Point3::new(x + reach + 0.05, bar_y, z),
    ];
    sweep(&mut stand, &bar, rod, facing);
    let upright = [
        Point3::new(x, floor.height_at(x, z), z),
        Point3::new(x, bar_y, z),
    ];
    let square = Section::Bar {
        width: 0.04,
        depth: 0.04,
    };
    sweep(&mut stand, &upright, square, facing);
    let wire = Section::Round { radius: 0.006 };
    for edge in hooks {
        let over = Point3::new(edge.x, edge.y - 0.008, edge.z - 0.01);
        let path = [
            Point3::new(edge.x, bar_y, z),
            over,
            over + Vector3::new(0.0, 0.025, -0.012),
        ];
        sweep(&mut stand, &path, wire, Vector3::x());
    }
    stand
}
