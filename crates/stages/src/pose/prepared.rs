//! A cloud with everything that aligning to it needs, made once: thousands of trial poses are then affordable.

use std::sync::OnceLock;

use nalgebra::Point3;

use super::{
    CloudRole, PoseError, PoseEstimate, PoseMethod, RunnerUp,
    centred::Centred,
    closest::Correspondence,
    edge_points::EdgePoints,
    quality::{Tolerance, measure_fit},
    refine::{AlignmentSource, AlignmentTarget, Level, Refined, SETTLED, Search},
    uncertainty::uncertainty_with,
};
use geometry::{
    cloud::PointCloud,
    nearest::{KdTree, median_spacing},
    nearest_field::NearestField,
    principal::{PrincipalAxes, principal_axes},
    statistics::sample_evenly,
    surface_grid::SurfaceGrid,
    units::Metres,
    voxel::downsample,
};

/// Points of a target at most: more do not sharpen the pose, and cost memory.
const MAX_POINTS: usize = 150_000;
/// Points of the coarse likeness, about: enough to tell within a tenth of its extent where a part is.
const NUM_COARSE: f64 = 2_000.0;
/// How far off a target the coarse field answers, in extents of it: a start is off by less.
const COARSE_BAND: f64 = 0.5;
/// The same for the fine field: three times the scale at which the fine likeness takes over.
const FINE_BAND: f64 = 0.1;
/// Cells of the fields along an extent, at most: coarser ones mistake the nearest point, finer ones take longer to make.
const COARSE_CELLS: f64 = 16.0;
const FINE_CELLS: f64 = 40.0;
/// The same of the wide field.
const WIDE_BAND: f64 = 0.15;
const WIDE_CELLS: f64 = 60.0;
/// The same for borders: what a refinement of the fine likeness looks for.
const EDGE_BAND: f64 = 0.1;
/// Points kept of a target's borders.
const NUM_EDGES: usize = 1000;
/// Points of the source on which the figures of a fit are taken.
const NUM_MEASURED: usize = 2_000;

/// A target with what searching it needs, and the lengths that follow from it.
#[derive(Clone, Debug)]
pub struct PreparedTarget {
    pub(super) centred: Centred,
    /// Of the coarse likeness, which is evenly dense.
    pub(crate) axes: PrincipalAxes,
    fine: CorrespondenceCache,
    coarse: CorrespondenceCache,
    /// A finer field of nearest points that reaches further than the fine likeness's, for Algorithm 3; made when it is
    /// first asked for.
    wide: OnceLock<NearestField>,
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

/// What the figures of an estimate are taken on.
pub(super) struct Measured<'a> {
    /// The source's points, in any order.
    pub(super) surface: &'a [Point3<f32>],
    /// Those of its borders that held the pose.
    pub(super) edges: Vec<Point3<f32>>,
    /// At which the refinement ended.
    pub(super) level: Level,
    /// What a stretch of the borders may be off by, metres.
    pub(super) outline_error: f64,
}

impl PreparedTarget {
    /// Prepares a cloud; points that are not finite are left out.
    pub fn new(cloud: &PointCloud) -> Result<Self, PoseError> {
        let mut centred = Centred::new(CloudRole::Target, cloud)?;
        let extent = centred.extent;
        let all = PointCloud::from_points(std::mem::take(&mut centred.points));
        let tree = KdTree::new(&all.points);
        let mut spacing = median_spacing(&all.points, &tree);
        let mut thinned = all;
        let mut tree = Some(tree);
        while thinned.points.len() > MAX_POINTS {
            spacing *= 1.3;
            thinned = downsample(&thinned, Metres(spacing));
            tree = None;
        }
        let tree = tree.unwrap_or_else(|| KdTree::new(&thinned.points));
        let grid = SurfaceGrid::new(&thinned.points);
        let edges = EdgePoints::of_ends(&grid.ends(), grid.side(), NUM_EDGES, EDGE_BAND * extent);
        thinned.normals = Some(grid.normals());
        let per_point = spacing * (thinned.points.len() as f64 / NUM_COARSE).sqrt();
        let coarse = downsample(&thinned, Metres(per_point.max(spacing)));
        let axes = principal_axes(coarse.points.iter().map(|p| (p.cast(), 1.0)));
        let axes = axes.unwrap_or(centred.axes);
        let cell = (2.0 * spacing).max(extent / FINE_CELLS);
        let field = NearestField::new(&thinned.points, cell as f32, (FINE_BAND * extent) as f32);
        let fine = CorrespondenceCache {
            cloud: thinned,
            tree: tree.into(),
            field,
            edges,
            spacing,
        };
        let tree = KdTree::new(&coarse.points);
        let (cell, band) = (extent / COARSE_CELLS, COARSE_BAND * extent);
        let coarse = CorrespondenceCache {
            spacing: median_spacing(&coarse.points, &tree),
            field: NearestField::new(&coarse.points, cell as f32, band as f32),
            tree: tree.into(),
            edges: EdgePoints::default(),
            cloud: coarse,
        };
        Ok(Self {
            centred,
            axes,
            fine,
            coarse,
            wide: OnceLock::new(),
        })
    }

    /// The target with a field that answers further off.
    pub(crate) fn wide_target(&self) -> AlignmentTarget<'_> {
        let extent = self.extent();
        let field = self.wide.get_or_init(|| {
            let cell = (2.0 * self.spacing()).max(extent / WIDE_CELLS);
            let points = &self.fine.cloud.points;
            NearestField::new(points, cell as f32, (WIDE_BAND * extent) as f32)
        });
        AlignmentTarget {
            field,
            ..self.target()
        }
    }

    pub(super) fn target(&self) -> AlignmentTarget<'_> {
        self.fine.target()
    }

    /// The same in few points, for what is still far off.
    pub(crate) fn coarse_target(&self) -> AlignmentTarget<'_> {
        self.coarse.target()
    }

    /// Standard deviation along the widest axis, metres.
    pub(crate) fn extent(&self) -> f64 {
        self.centred.extent
    }

    /// Distance between neighbouring points, metres.
    pub(super) fn spacing(&self) -> f64 {
        self.fine.spacing
    }

    /// The estimate that a refined pose stands for.
    pub(super) fn estimate(
        &self,
        measured: Measured<'_>,
        refined: Refined,
        method: PoseMethod,
        runner_up: Option<RunnerUp>,
    ) -> PoseEstimate {
        let Measured {
            surface,
            edges,
            level,
            outline_error,
        } = measured;
        let source = AlignmentSource {
            surface: sample_evenly(surface, NUM_MEASURED).copied().collect(),
            edges,
        };
        let tolerance = Tolerance {
            base: Metres(3.0 * self.spacing()),
            noise_at_1m: Metres(0.0),
        };
        let (target, pose) = (self.target(), &refined.target_from_source);
        let closest = Correspondence::of_each(&source.surface, &target, pose, Search::Tree);
        let fit = measure_fit(&source.surface, &closest, &target, tolerance);
        let uncertainty =
            uncertainty_with(&source, &closest, &target, pose, &level, (outline_error, 1));
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method,
            stopped: refined.stopped,
            iterations: refined.iterations,
            fit,
            uncertainty: Some(uncertainty),
            runner_up,
            scale: None,
        }
    }

    /// The last level of a refinement: as fine as the spacing allows.
    pub(super) fn finest(&self) -> Level {
        Level {
            num_surface: NUM_MEASURED,
            num_edges: usize::MAX,
            scale: (1.5 * self.spacing()).min(0.1 * self.extent()),
            max_steps: 40,
            settled: SETTLED,
            search: Search::Tree,
        }
    }
}

impl CorrespondenceCache {
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
