//! The sides of a part, and which of them is the outside.
//!
//! A part that is known all around, such as a mesh, is painted from one side of its thinnest extent. Outer panels bulge
//! outwards, and their flanges, ribs and linings are behind them, so more of the rays that come in evenly from all
//! directions above a place reach it outside than inside. A ray is hidden if it comes in above the surface's own slope
//! and below its horizon, as over terrain: R. Yokoyama, M. Shirasawa, R. J. Pike, "Visualizing Topography by Openness",
//! Photogrammetric Engineering & Remote Sensing 68(3), 2002. Heights and slopes suffice for this, so neither the winding of
//! the triangles nor the thickness of the sheet matters. An open sheet has normals on one side only; they must agree.
//!
//! Known limits: flat sheets, and parts that are as open from both sides, have no outside; a liner, whose hollow side is
//! painted, is taken for a panel unless it is an open sheet.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use geometry::principal::principal_axes;

/// A side of a part as it was enrolled, seen by a camera in front of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Towards the camera: -z.
    Front,
    /// Away from the camera: z.
    Back,
    /// -x.
    Left,
    /// x.
    Right,
    /// -y.
    Top,
    /// y.
    Bottom,
}

impl Side {
    /// Every side, each before its opposite.
    pub const ALL: [Self; 6] = [
        Self::Front,
        Self::Back,
        Self::Left,
        Self::Right,
        Self::Top,
        Self::Bottom,
    ];

    /// Returns the name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }

    /// Returns the side of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|side| side.name() == name)
    }

    /// Returns the unit vector from the part towards this side, part space.
    pub fn direction(self) -> Vector3<f64> {
        match self {
            Self::Front => -Vector3::z(),
            Self::Back => Vector3::z(),
            Self::Left => -Vector3::x(),
            Self::Right => Vector3::x(),
            Self::Top => -Vector3::y(),
            Self::Bottom => Vector3::y(),
        }
    }

    /// Returns the side nearest to a direction.
    pub fn nearest(direction: &Vector3<f64>) -> Self {
        let along = |side: Self| side.direction().dot(direction);
        let all = Self::ALL.into_iter();
        let nearest = all.max_by(|a, b| along(*a).total_cmp(&along(*b)));
        nearest.unwrap_or(Self::Front)
    }
}

/// Cells of the map of heights along the part's longest extent.
const NUM_CELLS: f64 = 64.0;
/// Side of a cell in mean distances of the points, at least.
const MIN_CELL_SPACINGS: f64 = 1.5;
/// Directions in which the horizon of a cell is found.
const NUM_TURNS: usize = 16;
/// Nearest cells that count for a horizon, in cells: nearer ones differ by where their points are.
const MIN_HORIZON_CELLS: f64 = 2.0;
/// Least cosine between the side and the normal of a cell whose rays are counted; 80°, steeper slopes are uncertain.
const MIN_UPRIGHT_COSINE: f64 = 0.17;
/// Least difference of the shares of hidden rays by which one side is the outside.
const MIN_HIDDEN_SHARE_DIFFERENCE: f64 = 0.004;
/// A side has no surface of its own if less than this share of the points faces it.
const MIN_FACING_SHARE: f64 = 0.05;

/// Returns which side of a part that is known all around is its outside, from evenly spaced points with normals; if that is
/// not clear, the two sides of its thinnest extent.
pub fn outer_side(points: &[Point3<f64>], normals: &[Vector3<f64>]) -> Result<Side, [Side; 2]> {
    let Some(axes) = principal_axes(points.iter().map(|p| (*p, 1.0))) else {
        return Err([Side::Front, Side::Back]);
    };
    let [u, v, thinnest] = [0, 1, 2].map(|axis| axes.axes.column(axis).into_owned());
    let sides = [thinnest, -thinnest].map(|axis| Side::nearest(&axis));
    let from = |axis: Vector3<f64>| {
        let in_axes = |vector: Vector3<f64>| [u, v, axis].map(|along| along.dot(&vector));
        let all = points.iter().zip(normals);
        let all = all.map(|(p, n)| (in_axes(p - axes.mean), in_axes(*n)));
        hidden(&all.collect::<Vec<_>>())
    };
    let difference = from(-thinnest) - from(thinnest);
    let facing = normals.iter().filter(|n| n.dot(&thinnest) > 0.0).count();
    let facing = facing as f64 / normals.len().max(1) as f64;
    let is_against_normals = |is_first: bool| {
        let facing = if is_first { facing } else { 1.0 - facing };
        facing < MIN_FACING_SHARE
    };
    if difference.abs() < MIN_HIDDEN_SHARE_DIFFERENCE || is_against_normals(difference > 0.0) {
        return Err(sides);
    }
    Ok(sides[usize::from(difference < 0.0)])
}

/// The share of the rays from all directions above a surface that do not reach it; points and normals with the height as
/// the third coordinate.
fn hidden(points: &[([f64; 3], [f64; 3])]) -> f64 {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
        let all = points.iter().map(|(p, _)| p[axis]);
        all.reduce(pick).unwrap_or(0.0)
    };
    let low = [0, 1].map(|axis| bound(axis, f64::min));
    let extent = [0, 1].map(|axis| bound(axis, f64::max) - low[axis]);
    let spacing = (extent[0] * extent[1] / points.len().max(1) as f64).sqrt();
    let cell = (extent[0].max(extent[1]) / NUM_CELLS).max(MIN_CELL_SPACINGS * spacing);
    if cell <= 0.0 {
        return 0.0;
    }
    let size = extent.map(|extent| (extent / cell) as usize + 1);
    // The highest point of each cell, and its normal.
    let mut tops: Vec<Option<(f64, [f64; 3])>> = vec![None; size[0] * size[1]];
    for (p, normal) in points {
        let [column, row] = [0, 1].map(|axis| ((p[axis] - low[axis]) / cell) as usize);
        let top = &mut tops[row * size[0] + column];
        if top.is_none_or(|(height, _)| p[2] > height) {
            *top = Some((p[2], *normal));
        }
    }
    let at = |column: f64, row: f64| {
        let inside = |x: f64, axis: usize| (0.0..size[axis] as f64).contains(&x);
        let is_inside = inside(column, 0) && inside(row, 1);
        is_inside.then(|| tops[row as usize * size[0] + column as usize])
    };
    let (mut sum, mut num) = (0.0, 0.0);
    for (i, top) in tops.iter().enumerate() {
        let Some((height, [nx, ny, nz])) = *top else {
            continue;
        };
        if nz.abs() < MIN_UPRIGHT_COSINE {
            continue;
        }
        let [column, row] = [i % size[0], i / size[0]].map(|cell| cell as f64 + 0.5);
        for turn in 0..NUM_TURNS {
            let (sin, cos) = (TAU * turn as f64 / NUM_TURNS as f64).sin_cos();
            let slope = -(nx * cos + ny * sin) / nz;
            let (mut steepest, mut step) = (slope, MIN_HORIZON_CELLS);
            while let Some(other) = at(column + step * cos, row + step * sin) {
                if let Some((other, _)) = other {
                    steepest = steepest.max((other - height) / (step * cell));
                }
                step += 1.0;
            }
            // Rays are even in the sine of their angle above the plane.
            sum += steepest.atan().sin() - slope.atan().sin();
            num += 1.0;
        }
    }
    sum / f64::max(num, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both faces of a sheet of this thickness, 1.2 by 0.8 m, whose outside has these heights, turned by an angle about
    /// its long axis; x right, y down, z away, the outside up.
    fn shell(
        thickness: f64,
        angle: f64,
        height: impl Fn(f64, f64) -> f64,
    ) -> (Vec<Point3<f64>>, Vec<Vector3<f64>>) {
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), angle);
        let faces = [(0.0, -1.0), (thickness, 1.0)];
        let each = faces.into_iter().flat_map(|(below, facing)| {
            let height = &height;
            (0..120).flat_map(move |i| {
                (0..80).map(move |j| {
                    let (x, z) = (0.01 * f64::from(i) - 0.6, 0.01 * f64::from(j) - 0.4);
                    let at = Point3::new(x, below - height(x, z), z);
                    let step = 1e-4;
                    let [dx, dz] = [
                        (height(x + step, z) - height(x - step, z)) / (2.0 * step),
                        (height(x, z + step) - height(x, z - step)) / (2.0 * step),
                    ];
                    let normal = Vector3::new(dx, 1.0, dz).normalize();
                    (turn * at, turn * (normal * facing))
                })
            })
        });
        each.unzip()
    }

    #[test]
    fn a_bulging_shell_is_outside_where_it_bulges_however_it_lies() {
        // 10 mm and 80 mm over 1.2 m.
        for bulge in [0.01, 0.08] {
            for thickness in [0.0008, 0.02] {
                for angle in [-0.02, 0.0, 0.02, 0.4] {
                    let dome = |x: f64, z: f64| -bulge * (x * x + z * z) / 0.36;
                    let (points, normals) = shell(thickness, angle, dome);
                    assert_eq!(outer_side(&points, &normals), Ok(Side::Top), "{bulge}");
                    // Upside down, and inside out.
                    let turned: Vec<Point3<f64>> =
                        points.iter().map(|p| -p.coords).map(Point3::from).collect();
                    assert_eq!(outer_side(&turned, &normals), Ok(Side::Bottom), "{bulge}");
                }
            }
        }
    }

    #[test]
    fn a_flange_behind_a_flat_panel_shows_its_inside() {
        let flanged = |x: f64, z: f64| {
            let is_edge = x.abs() > 0.58 || z.abs() > 0.38;
            if is_edge { -0.03 } else { 0.0 }
        };
        let (points, normals) = shell(0.001, 0.0, flanged);
        assert_eq!(outer_side(&points, &normals), Ok(Side::Top));
    }

    #[test]
    fn a_flat_sheet_and_one_wound_against_its_bulge_have_no_clear_outside() {
        for angle in [0.0, 0.3] {
            let (points, normals) = shell(0.015, angle, |_, _| 0.0);
            let sides = outer_side(&points, &normals).expect_err("flat");
            assert!(sides.contains(&Side::Top) && sides.contains(&Side::Bottom));
        }
        let (points, normals) = shell(0.001, 0.0, |x, z| -0.08 * (x * x + z * z));
        let half = points.len() / 2;
        assert_eq!(outer_side(&points[..half], &normals[..half]), Ok(Side::Top));
        let wound: Vec<Vector3<f64>> = normals[..half].iter().map(|n| -n).collect();
        assert!(outer_side(&points[..half], &wound).is_err());
    }

    #[test]
    fn every_side_has_its_name_and_direction() {
        for side in Side::ALL {
            assert_eq!(Side::named(side.name()), Some(side));
            assert_eq!(Side::nearest(&side.direction()), side);
        }
        for pair in Side::ALL.chunks(2) {
            assert_eq!(pair[0].direction(), -pair[1].direction());
        }
    }
}
