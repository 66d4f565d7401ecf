//! Aligns two clouds of which nothing else is known: no outline, no view, no start.
//!
//! Lengths follow from the clouds: their extent says how far off a start may be, their spacing how fine the answer
//! can be. Without a start the search tries the target's principal axes all four ways round and rotations spread
//! evenly over SO(3) (M. Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3)", CVPR 2022), each
//! refined on few points; the better ones go on to more points and finer scales.
//!
//! Known limits: a shift between clouds that share less than about half of their surface is only found if it is small
//! against their size, since starts put centre on centre.

use nalgebra::{Isometry3, Point3, Quaternion, Rotation3, Translation3, UnitQuaternion, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    PoseError, PoseEstimate, PoseMethod, RunnerUp,
    global::{EdgePoints, Level, Refined, Search, Source, Target, cost, refine},
    icp::{IcpParams, icp},
    quality::{Tolerance, measure_fit},
};
use crate::{
    geometry::{
        cloud::PointCloud,
        nearest::KdTree,
        nearest_field::NearestField,
        normals::estimate_normals,
        principal::{PrincipalAxes, principal_axes},
        rigid::{RigidTransform, pose_error},
        voxel::downsample,
    },
    units::Metres,
};

/// Rotations tried beside the principal axes: no rotation is further than about 35° from one of them, within what the
/// coarse refinement closes.
const NUM_ROTATIONS: usize = 150;
/// Starts that go on after the coarse refinement.
const NUM_KEPT: usize = 12;
/// Points of the target at most: more do not sharpen the pose, and cost memory.
const MAX_TARGET_POINTS: usize = 150_000;
/// Points of the source used in the last refinement.
const NUM_SOURCE_POINTS: usize = 4_000;
/// Fewer points than this do not fix a pose.
const MIN_POINTS: usize = 10;

/// Aligns the source to the target: `target_from_source`.
///
/// `initial` is a start; without one the global method searches everywhere and ICP begins with no displacement.
pub fn align(
    source: &PointCloud,
    target: &PointCloud,
    method: PoseMethod,
    initial: Option<RigidTransform>,
) -> Result<PoseEstimate, PoseError> {
    let source = finite_points("source", source)?;
    let target = finite_points("target", target)?;
    let source_axes = spanned_axes("source", &source)?;
    let target_axes = spanned_axes("target", &target)?;
    let prepared = PreparedTarget::new(&target);
    match method {
        PoseMethod::Icp => {
            let params = IcpParams::default();
            let step = source.len().div_ceil(params.max_source_points).max(1);
            let thinned: Vec<Point3<f32>> = source.iter().step_by(step).copied().collect();
            let start = initial.unwrap_or_else(RigidTransform::identity);
            let tree = KdTree::new(&target);
            let run = icp(&thinned, &target, &tree, &start, &params)?;
            let refined = Refined {
                target_from_source: run.target_from_source,
                iterations: run.iterations,
                stopped: run.stopped,
            };
            Ok(prepared.estimate(&source, refined, PoseMethod::Icp, None))
        }
        PoseMethod::Global => {
            let starts = match initial {
                Some(start) => vec![start],
                None => starts(&source_axes, &target_axes),
            };
            prepared.search(&source, &starts)
        }
    }
}

fn finite_points(which: &'static str, cloud: &PointCloud) -> Result<Vec<Point3<f32>>, PoseError> {
    let points: Vec<Point3<f32>> = cloud.finite().map(|(_, p)| *p).collect();
    if points.len() < MIN_POINTS {
        return Err(PoseError::TooFewPoints {
            which,
            found: points.len(),
            needed: MIN_POINTS,
        });
    }
    Ok(points)
}

/// The principal axes of points that lie on more than a line.
fn spanned_axes(which: &'static str, points: &[Point3<f32>]) -> Result<PrincipalAxes, PoseError> {
    let axes = principal_axes(points.iter().map(|p| (p.cast(), 1.0)));
    match axes {
        Some(axes) if axes.variances[1] > 1e-6 * axes.variances[0] => Ok(axes),
        other => Err(PoseError::Degenerate {
            which,
            width: other.map_or(0.0, |axes| axes.variances[1].sqrt()),
        }),
    }
}

/// Centre on centre: no turn, principal axes on principal axes, rotations spread evenly.
fn starts(source: &PrincipalAxes, target: &PrincipalAxes) -> Vec<RigidTransform> {
    let about_centres = |turn: UnitQuaternion<f64>| {
        let shift = target.mean - turn * source.mean;
        Isometry3::from_parts(Translation3::from(shift), turn)
    };
    let frame = |axes: &PrincipalAxes| {
        let first: Vector3<f64> = axes.axes.column(0).into_owned();
        let second: Vector3<f64> = axes.axes.column(1).into_owned();
        let matrix = nalgebra::Matrix3::from_columns(&[first, second, first.cross(&second)]);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
    };
    let (of_source, of_target) = (frame(source), frame(target));
    let half_turns = [
        UnitQuaternion::identity(),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI),
    ];
    let along_axes = half_turns.map(|half| about_centres(of_target * half * of_source.inverse()));
    std::iter::once(RigidTransform::identity())
        .chain(along_axes)
        .chain(spread_rotations(NUM_ROTATIONS).map(about_centres))
        .collect()
}

fn spread_rotations(num: usize) -> impl Iterator<Item = UnitQuaternion<f64>> {
    // The constants of the article: irrational ratios for which the spiral covers SO(3) evenly.
    const PHI: f64 = std::f64::consts::SQRT_2;
    const PSI: f64 = 1.533_751_168_755_204_3;
    (0..num).map(move |i| {
        let s = i as f64 + 0.5;
        let (r, big_r) = ((s / num as f64).sqrt(), (1.0 - s / num as f64).sqrt());
        let (alpha, beta) = (
            std::f64::consts::TAU * s / PHI,
            std::f64::consts::TAU * s / PSI,
        );
        let (sin_a, cos_a) = alpha.sin_cos();
        let (sin_b, cos_b) = beta.sin_cos();
        UnitQuaternion::from_quaternion(Quaternion::new(
            big_r * cos_b,
            r * sin_a,
            r * cos_a,
            big_r * sin_b,
        ))
    })
}

fn level(num_surface: usize, scale: f64, max_steps: usize, search: Search) -> Level {
    Level {
        num_surface,
        num_edges: 0,
        scale,
        max_steps,
        search,
    }
}

/// A target with what searching it needs, and the lengths that follow from it.
struct PreparedTarget {
    cloud: PointCloud,
    tree: KdTree,
    field: NearestField,
    edges: EdgePoints,
    /// Distance between neighbouring points, metres.
    spacing: f64,
    /// Standard deviation along the widest axis, metres.
    extent: f64,
}

impl PreparedTarget {
    fn new(points: &[Point3<f32>]) -> Self {
        let all = PointCloud::from_points(points.iter().copied());
        let mut spacing = spacing_of(points);
        let mut cloud = all;
        while cloud.points.len() > MAX_TARGET_POINTS {
            spacing *= 1.3;
            cloud = downsample(&cloud, Metres(spacing));
        }
        let tree = KdTree::new(&cloud.points);
        let centre = principal_axes(cloud.points.iter().map(|p| (p.cast(), 1.0)));
        let viewpoint = centre.map_or(Point3::origin(), |c| c.mean);
        let extent = centre.map_or(0.0, |c| c.variances[0].sqrt());
        // Three spacings reach some thirty neighbours: enough to average the noise of one point.
        cloud.normals = Some(estimate_normals(
            &cloud.points,
            &tree,
            Metres(3.0 * spacing),
            &viewpoint,
        ));
        let cell = (2.0 * spacing).max(extent / 60.0) as f32;
        let field = NearestField::new(&cloud.points, cell, (0.5 * extent) as f32);
        Self {
            tree,
            field,
            edges: EdgePoints::default(),
            spacing,
            extent,
            cloud,
        }
    }

    fn target(&self) -> Target<'_> {
        let Self {
            cloud,
            tree,
            field,
            edges,
            ..
        } = self;
        Target {
            cloud,
            tree,
            field,
            edges,
            spacing: self.spacing,
        }
    }

    fn search(
        &self,
        source: &[Point3<f32>],
        starts: &[RigidTransform],
    ) -> Result<PoseEstimate, PoseError> {
        let target = self.target();
        let mut surface: Vec<Point3<f32>> = source
            .iter()
            .step_by((source.len() / NUM_SOURCE_POINTS).max(1))
            .copied()
            .collect();
        surface.shuffle(&mut Pcg64::seed_from_u64(1));
        let source_points = Source {
            surface,
            edges: Vec::new(),
        };
        // From what a start is off by, halving, down to the spacing.
        let finest = (1.5 * self.spacing).min(0.1 * self.extent);
        let coarse = [
            level(120, 0.35 * self.extent, 5, Search::Field),
            level(200, 0.15 * self.extent, 5, Search::Field),
        ];
        let middle = [
            level(600, 0.1 * self.extent, 8, Search::Field),
            level(600, 0.05 * self.extent, 8, Search::Field),
        ];
        let mut fine = Vec::new();
        let mut scale = 0.03 * self.extent;
        while scale > finest {
            fine.push(level(1500, scale, 10, Search::Field));
            scale *= 0.5;
        }
        fine.push(level(NUM_SOURCE_POINTS, finest, 20, Search::Tree));

        let limit = 0.2 * self.extent;
        let run = |start: &RigidTransform, levels: &[Level], limit: f64| {
            let refined = refine(&source_points, &target, start, levels);
            let last = &levels[levels.len() - 1];
            let cost = cost(
                &source_points,
                &target,
                &refined.target_from_source,
                last,
                limit,
            );
            (cost, refined)
        };
        let best_of = |tried: &mut Vec<(f64, Refined)>, num: usize| {
            tried.sort_by(|a, b| a.0.total_cmp(&b.0));
            tried.truncate(num);
        };
        let mut tried: Vec<(f64, Refined)> =
            starts.iter().map(|s| run(s, &coarse, limit)).collect();
        best_of(&mut tried, NUM_KEPT);
        let further =
            |tried: &[(f64, Refined)], levels: &[Level], limit: f64| -> Vec<(f64, Refined)> {
                tried
                    .iter()
                    .map(|(_, before)| {
                        let (cost, mut after) = run(&before.target_from_source, levels, limit);
                        after
                            .iterations
                            .splice(0..0, before.iterations.iter().copied());
                        (cost, after)
                    })
                    .collect()
            };
        let mut tried = further(&tried, &middle, limit / 2.0);
        best_of(&mut tried, NUM_KEPT);
        let centre = principal_axes(source_points.surface.iter().map(|p| (p.cast(), 1.0)))
            .map_or(Point3::origin(), |axes| axes.mean);
        let mut tried = self.distinct(tried, &centre);
        tried.truncate(3);
        let mut tried = further(&tried, &fine, limit / 4.0);
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));

        let mut tried = self.distinct(tried, &centre).into_iter();
        let Some((best_cost, best)) = tried.next() else {
            return Err(self.no_overlap(0));
        };
        let num_pairs = best.iterations.last().map_or(0, |i| i.num_pairs);
        if num_pairs < MIN_POINTS {
            return Err(self.no_overlap(num_pairs));
        }
        let runner_up = tried.next().map(|(cost, refined)| RunnerUp {
            target_from_source: refined.target_from_source,
            ratio: cost / best_cost.max(f64::MIN_POSITIVE),
        });
        Ok(self.estimate(&source_points.surface, best, PoseMethod::Global, runner_up))
    }

    fn no_overlap(&self, found: usize) -> PoseError {
        PoseError::NoOverlap {
            found,
            needed: MIN_POINTS,
            reach: Metres(0.5 * self.extent),
        }
    }

    /// Of poses that a refinement would close, the first.
    fn distinct(&self, sorted: Vec<(f64, Refined)>, centre: &Point3<f64>) -> Vec<(f64, Refined)> {
        let mut kept: Vec<(f64, Refined)> = Vec::new();
        for candidate in sorted {
            let is_new = kept.iter().all(|k| {
                let apart = pose_error(
                    &k.1.target_from_source,
                    &candidate.1.target_from_source,
                    centre,
                );
                apart.rotation.degrees() > 5.0 || apart.shift.0 > 0.1 * self.extent
            });
            if is_new {
                kept.push(candidate);
            }
        }
        kept
    }

    fn estimate(
        &self,
        source: &[Point3<f32>],
        refined: Refined,
        method: PoseMethod,
        runner_up: Option<RunnerUp>,
    ) -> PoseEstimate {
        let step = (source.len() / NUM_SOURCE_POINTS).max(1);
        let measured: Vec<Point3<f32>> = source.iter().step_by(step).copied().collect();
        let tolerance = Tolerance {
            base: Metres(3.0 * self.spacing),
            noise_at_1m: Metres(0.0),
        };
        let fit = measure_fit(
            &measured,
            &self.target(),
            &refined.target_from_source,
            tolerance,
            Search::Tree,
        );
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method,
            stopped: refined.stopped,
            iterations: refined.iterations,
            fit,
            runner_up,
        }
    }
}

/// The median distance of a point to its nearest neighbour, metres.
fn spacing_of(points: &[Point3<f32>]) -> f64 {
    const NUM_ASKED: usize = 500;
    let tree = KdTree::new(points);
    let step = (points.len() / NUM_ASKED).max(1);
    let mut distances: Vec<f32> = points
        .iter()
        .enumerate()
        .step_by(step)
        .filter_map(|(i, p)| tree.nearest_other(p, i).map(|n| n.distance_sq.sqrt()))
        // Twins say nothing about spacing.
        .filter(|d| *d > 0.0)
        .collect();
    if distances.is_empty() {
        return 1e-6;
    }
    let middle = distances.len() / 2;
    f64::from(*distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use rand::RngExt as _;

    use super::*;
    use crate::geometry::rigid::from_euler_zyx;

    /// A bent sheet with a notch: nothing about it is symmetric, and its points lie on no lattice that could slide
    /// onto itself.
    fn sheet() -> PointCloud {
        let mut rng = Pcg64::seed_from_u64(7);
        let points: Vec<Point3<f32>> = (0..5000)
            .map(|_| (rng.random::<f32>(), 0.8 * rng.random::<f32>()))
            .filter(|(u, v)| !(*u > 0.6 && *v > 0.5))
            .map(|(u, v)| Point3::new(u, v, 0.3 * u * u + 0.1 * (5.0 * v).sin() * u))
            .collect();
        PointCloud::from_points(points)
    }

    fn moved(cloud: &PointCloud, by: &RigidTransform) -> PointCloud {
        PointCloud::from_points(cloud.points.iter().map(|p| (by * p.cast::<f64>()).cast()))
    }

    #[test]
    fn a_displaced_copy_is_found_from_anywhere_both_ways_round() {
        let target = sheet();
        for start in [
            [1.57, 0.0, 0.0, 0.8, 0.0, 0.5],
            [3.1, 1.2, -2.0, -0.4, 0.7, 0.1],
            [0.2, -1.4, 2.9, 0.1, -0.6, 2.0],
        ] {
            let truth = from_euler_zyx(start);
            for truth in [truth, truth.inverse()] {
                let source = moved(&target, &truth.inverse());
                let found = align(&source, &target, PoseMethod::Global, None).expect("a pose");
                let centre = truth.inverse() * Point3::new(0.5, 0.3, 0.1);
                let error = pose_error(&found.target_from_source, &truth, &centre);
                assert!(
                    error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
                    "{error:?} from {start:?}"
                );
                assert!(!found.is_ambiguous());
            }
        }
    }

    #[test]
    fn the_same_clouds_give_the_same_bits() {
        let target = sheet();
        let source = moved(&target, &from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]));
        let run = || align(&source, &target, PoseMethod::Global, None).expect("a pose");
        assert_eq!(run(), run());
    }

    #[test]
    fn clouds_that_fix_no_pose_get_a_named_error() {
        let sheet = sheet();
        let line = PointCloud::from_points((0..100).map(|i| Point3::new(i as f32, 0.0, 0.0)));
        let spot = PointCloud::from_points((0..100).map(|_| Point3::new(1.0, 2.0, 3.0)));
        let few =
            PointCloud::from_points((0..3).map(|i| Point3::new(i as f32, (i * i) as f32, 0.0)));
        let empty = PointCloud::default();
        for method in [PoseMethod::Global, PoseMethod::Icp] {
            for bad in [&line, &spot] {
                assert!(matches!(
                    align(bad, &sheet, method, None),
                    Err(PoseError::Degenerate {
                        which: "source",
                        ..
                    })
                ));
                assert!(matches!(
                    align(&sheet, bad, method, None),
                    Err(PoseError::Degenerate {
                        which: "target",
                        ..
                    })
                ));
            }
            for bad in [&few, &empty] {
                assert!(matches!(
                    align(bad, &sheet, method, None),
                    Err(PoseError::TooFewPoints {
                        which: "source",
                        ..
                    })
                ));
                assert!(matches!(
                    align(&sheet, bad, method, None),
                    Err(PoseError::TooFewPoints {
                        which: "target",
                        ..
                    })
                ));
            }
        }
    }
}
