use std::sync::OnceLock;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::pose::edge_points::EdgePoints;
use geometry::{
    cloud::PointCloud, nearest::KdTree, nearest_field::NearestField, normals::estimate_normals,
};

const SPACING: f64 = 0.008;
const LEVEL: Level = Level {
    num_surface: 1500,
    num_edges: 256,
    scale: 0.01,
    max_steps: 15,
    settled: 0.005,
    search: Search::Tree,
};

/// A surface over a sheet of 1 m by 0.6 m about the origin.
type Shape = fn(f64, f64) -> [f64; 3];

const FLAT: Shape = |x, y| [x, y, 0.0];

/// A part of a tube of 0.3 m radius, along x.
const TUBE: Shape = |x, y| [x, 0.3 * (y / 0.3).sin(), 0.3 - 0.3 * (y / 0.3).cos()];

/// A part of a ball of 1 m radius.
const BALL: Shape = |x, y| [x, y, 1.0 - (1.0 - x * x - y * y).sqrt()];

/// Bent both ways, one end more than the other: no motion carries it along itself.
const PRESSED: Shape = |x, y| {
    let bump = 0.05 * (-((x - 0.2).powi(2) + (y + 0.1).powi(2)) / 0.02).exp();
    [x, y, 0.2 * x * x * x + 0.3 * y * y + bump]
};

fn normal(random: &mut Pcg64) -> f64 {
    let mut uniform = || random.random::<f64>() - 0.5;
    (0..12).map(|_| uniform()).sum()
}

fn at(shape: Shape, x: f64, y: f64) -> Point3<f32> {
    Point3::from(shape(x, y)).cast()
}

/// The rim, a point every 15 mm, beginning with the long side at the top.
fn rim(shape: Shape) -> Vec<Point3<f32>> {
    let corners = [
        [-0.5, -0.3],
        [0.5, -0.3],
        [0.5, 0.3],
        [-0.5, 0.3],
        [-0.5, -0.3],
    ];
    let sides = corners.windows(2).flat_map(|ends| {
        let length = f64::hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
        let num = (length / 0.015).round() as usize;
        let along = |i: usize, axis: usize| {
            ends[0][axis] + (ends[1][axis] - ends[0][axis]) * i as f64 / num as f64
        };
        (0..num)
            .map(move |i| [along(i, 0), along(i, 1)])
            .collect::<Vec<_>>()
    });
    sides.map(|[x, y]| at(shape, x, y)).collect()
}

/// The bounds of a sheet that lies on itself, its points and its target's with 1 mm of noise, with some of its rim seen.
fn bounds(shape: Shape, is_seen: impl Fn(&Point3<f32>) -> bool) -> Uncertainty {
    let mut random = Pcg64::seed_from_u64(11);
    let mut noisy = |p: Point3<f32>| p + Vector3::z() * (0.001 * normal(&mut random)) as f32;
    let grid = |step: f64, aside: f64| {
        let (columns, rows) = ((1.0 / step) as usize, (0.6 / step) as usize);
        (0..columns * rows).map(move |i| {
            let (x, y) = ((i % columns) as f64 * step, (i / columns) as f64 * step);
            at(shape, x - 0.5 + aside, y - 0.3 + aside)
        })
    };
    let points: Vec<Point3<f32>> = grid(SPACING, 0.0).map(&mut noisy).collect();
    let tree = KdTree::new(&points);
    let mut cloud = PointCloud::from_points(points);
    let towards = Point3::new(0.0, 0.0, -5.0);
    let radius = Metres(3.0 * SPACING);
    cloud.normals = Some(estimate_normals(&cloud.points, &tree, radius, &towards));
    let field = NearestField::new(&cloud.points, 0.02, 0.06);
    let edges = EdgePoints::new(&rim(shape), 256);
    let target = AlignmentTarget {
        cloud: &cloud,
        tree: &OnceLock::from(tree),
        field: &field,
        edges: &edges,
        spacing: SPACING,
    };
    let mut surface: Vec<Point3<f32>> = grid(0.02, 0.003).map(&mut noisy).collect();
    surface.truncate(LEVEL.num_surface);
    let edges = rim(shape).into_iter().filter(is_seen).map(&mut noisy);
    let source = AlignmentSource {
        edges: edges.collect(),
        surface,
    };
    let pose = RigidTransform::identity();
    let closest = Correspondence::of_each(&source.surface, &target, &pose, Search::Tree);
    uncertainty(&source, &closest, &target, &pose, &LEVEL, 1)
}

#[test]
fn a_sheet_is_held_by_its_rim_or_by_its_shape() {
    for (name, found) in [
        ("flat, with its rim", bounds(FLAT, |_| true)),
        ("tube, with its rim", bounds(TUBE, |_| true)),
        ("pressed, without its rim", bounds(PRESSED, |_| false)),
    ] {
        assert_eq!(found.freedom, None, "{name}: {found:?}");
        assert!(found.shift.mm() < 8.0, "{name}: {found:?}");
        assert!(found.turn.degrees() < 1.0, "{name}: {found:?}");
    }
}

#[test]
fn a_shape_that_fits_on_itself_elsewhere_is_unconstrained_without_its_rim() {
    let flat = bounds(FLAT, |_| false).freedom;
    assert!(
        matches!(
            flat,
            Some(FreeMotion::Slide(Axis::Long | Axis::Short) | FreeMotion::Turn(Axis::Normal))
        ),
        "{flat:?}"
    );
    let tube = bounds(TUBE, |_| false).freedom;
    assert!(
        matches!(
            tube,
            Some(FreeMotion::Slide(Axis::Long | Axis::Short) | FreeMotion::Turn(Axis::Long))
        ),
        "{tube:?}"
    );
    let ball = bounds(BALL, |_| false);
    assert!(!ball.is_held(), "{ball:?}");
}

#[test]
fn a_cut_sheet_slides_along_the_only_edge_in_view() {
    let long = bounds(FLAT, |p| p.y < -0.29 && p.x.abs() < 0.45);
    assert_eq!(
        long.freedom,
        Some(FreeMotion::Slide(Axis::Long)),
        "{long:?}"
    );
    let short = bounds(FLAT, |p| p.x < -0.49 && p.y.abs() < 0.25);
    assert_eq!(
        short.freedom,
        Some(FreeMotion::Slide(Axis::Short)),
        "{short:?}"
    );
    // A corner holds it.
    let corner = bounds(FLAT, |p| p.x < -0.49 || p.y < -0.29);
    assert_eq!(corner.freedom, None, "{corner:?}");
}

#[test]
fn a_length_is_within_its_quantile_in_95_of_100_draws() {
    let mut random = Pcg64::seed_from_u64(3);
    for deviations in [[1.0, 1.0, 1.0], [1.0, 0.1, 0.0], [3.0, 1.0, 0.5]] {
        let covariance = Matrix3::from_diagonal(&Vector3::from(deviations.map(|d| d * d)));
        let limit = within_95(&covariance);
        let num = (0..4000)
            .filter(|_| {
                let drawn = Vector3::from(deviations.map(|d| d * normal(&mut random)));
                drawn.norm() <= limit
            })
            .count();
        assert!((3740..3860).contains(&num), "{num} of 4000: {deviations:?}");
    }
}
