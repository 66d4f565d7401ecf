//! A cloud with everything that aligning to it needs, made once: thousands of trial poses are then affordable.

use std::sync::OnceLock;

use nalgebra::Point3;

use super::{
    PoseError, PoseEstimate, PoseMethod, RunnerUp,
    centred::Centred,
    closest::Correspondence,
    edge_points::EdgePoints,
    quality::{Tolerance, measure_fit},
    refine::{AlignmentSource, AlignmentTarget, Level, Refined, SETTLED, Search},
    uncertainty::uncertainty,
};
use crate::{
    geometry::{
        cloud::PointCloud,
        nearest::KdTree,
        nearest_field::NearestField,
        normals::estimate_normals,
        principal::{PrincipalAxes, principal_axes},
        voxel::downsample,
    },
    units::Metres,
};

/// Points of a target at most: more do not sharpen the pose, and cost memory.
const MAX_POINTS: usize = 150_000;
/// Points of the coarse likeness, about: enough to tell within a tenth of its extent where a part is.
const NUM_COARSE: f64 = 2_000.0;
/// How far off a target the coarse field answers, in extents of it: a start is off by less.
const COARSE_BAND: f64 = 0.5;
/// The same for the fine field: five times the scale at which the fine likeness takes over.
const FINE_BAND: f64 = 0.15;
/// Points of the source on which the figures of a fit are taken.
const NUM_MEASURED: usize = 2_000;

/// A target with what searching it needs, and the lengths that follow from it.
#[derive(Clone, Debug)]
pub struct PreparedTarget {
    pub(super) centred: Centred,
    /// Of the coarse likeness, which is evenly dense.
    pub(super) axes: PrincipalAxes,
    fine: CorrespondenceCache,
    coarse: CorrespondenceCache,
}

/// Points with normals and the ways to find the nearest of them.
#[derive(Clone, Debug)]
struct CorrespondenceCache {
    cloud: PointCloud,
    tree: OnceLock<KdTree>,
    field: NearestField,
    edges: EdgePoints,
    /// Distance between neighbouring points, metres.
    spacing: f64,
}

impl PreparedTarget {
    /// Prepares a cloud; points that are not finite are left out.
    pub fn new(cloud: &PointCloud) -> Result<Self, PoseError> {
        let mut centred = Centred::new("target", cloud)?;
        let extent = centred.extent;
        let all = PointCloud::from_points(std::mem::take(&mut centred.points));
        let tree = KdTree::new(&all.points);
        let mut spacing = spacing_of(&all.points, &tree);
        let mut thinned = all;
        let mut tree = Some(tree);
        while thinned.points.len() > MAX_POINTS {
            spacing *= 1.3;
            thinned = downsample(&thinned, Metres(spacing));
            tree = None;
        }
        let per_point = spacing * (thinned.points.len() as f64 / NUM_COARSE).sqrt();
        let coarse = downsample(&thinned, Metres(per_point.max(spacing)));
        let tree = tree.unwrap_or_else(|| KdTree::new(&thinned.points));
        let cell = (2.0 * spacing).max(extent / 60.0);
        let fine =
            CorrespondenceCache::new(thinned, tree, spacing, cell, FINE_BAND * extent, &centred);
        let axes = principal_axes(coarse.points.iter().map(|p| (p.cast(), 1.0)));
        let axes = axes.unwrap_or(centred.axes);
        let tree = KdTree::new(&coarse.points);
        let spacing = spacing_of(&coarse.points, &tree);
        let cell = extent / 16.0;
        let coarse =
            CorrespondenceCache::new(coarse, tree, spacing, cell, COARSE_BAND * extent, &centred);
        Ok(Self {
            centred,
            axes,
            fine,
            coarse,
        })
    }

    pub(super) fn target(&self) -> AlignmentTarget<'_> {
        self.fine.target()
    }

    /// The same in few points, for what is still far off.
    pub(super) fn coarse_target(&self) -> AlignmentTarget<'_> {
        self.coarse.target()
    }

    /// Standard deviation along the widest axis, metres.
    pub(super) fn extent(&self) -> f64 {
        self.centred.extent
    }

    /// Distance between neighbouring points, metres.
    pub(super) fn spacing(&self) -> f64 {
        self.fine.spacing
    }

    /// The estimate that a refined pose stands for.
    pub(super) fn estimate(
        &self,
        source: &[Point3<f32>],
        refined: Refined,
        method: PoseMethod,
        runner_up: Option<RunnerUp>,
    ) -> PoseEstimate {
        let step = source.len().div_ceil(NUM_MEASURED).max(1);
        let measured = AlignmentSource {
            surface: source.iter().step_by(step).copied().collect(),
            edges: Vec::new(),
        };
        let tolerance = Tolerance {
            base: Metres(3.0 * self.spacing()),
            noise_at_1m: Metres(0.0),
        };
        let (target, pose) = (self.target(), &refined.target_from_source);
        let closest = Correspondence::of_each(&measured.surface, &target, pose, Search::Tree);
        let fit = measure_fit(&measured.surface, &closest, &target, tolerance);
        let uncertainty = uncertainty(&measured, &closest, &target, pose, &self.finest());
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method,
            stopped: refined.stopped,
            iterations: refined.iterations,
            fit,
            uncertainty: Some(uncertainty),
            runner_up,
        }
    }

    /// The last level of a refinement: as fine as the spacing allows.
    pub(super) fn finest(&self) -> Level {
        Level {
            num_surface: NUM_MEASURED,
            num_edges: 0,
            scale: (1.5 * self.spacing()).min(0.1 * self.extent()),
            max_steps: 40,
            settled: SETTLED,
            search: Search::Tree,
        }
    }
}

impl CorrespondenceCache {
    fn new(
        mut cloud: PointCloud,
        tree: KdTree,
        spacing: f64,
        cell: f64,
        band: f64,
        whole: &Centred,
    ) -> Self {
        // Three spacings reach some thirty neighbours: enough to average the noise of one point.
        cloud.normals = Some(estimate_normals(
            &cloud.points,
            &tree,
            Metres(3.0 * spacing),
            &whole.axes.mean,
        ));
        Self {
            field: NearestField::new(&cloud.points, cell as f32, band as f32),
            edges: EdgePoints::default(),
            cloud,
            tree: tree.into(),
            spacing,
        }
    }

    fn target(&self) -> AlignmentTarget<'_> {
        let Self {
            cloud,
            tree,
            field,
            edges,
            spacing,
        } = self;
        AlignmentTarget {
            cloud,
            tree,
            field,
            edges,
            spacing: *spacing,
        }
    }
}

/// The median distance of a point to its nearest neighbour, metres.
fn spacing_of(points: &[Point3<f32>], tree: &KdTree) -> f64 {
    const NUM_ASKED: usize = 500;
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
