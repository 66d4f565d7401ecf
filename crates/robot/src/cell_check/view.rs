//! One frame of the cell: a part in front of wall and floor.

use nalgebra::Point3;

use geometry::{
    cloud::PointCloud, plane::Plane, principal::principal_axes, rigid::RigidTransform,
    units::Metres,
};
use stages::{
    scene::SceneCloud,
    segment::{NoPart, PointLabel, SegmentParams, segment},
};

/// Reach of a patch from its middle, in standard deviations of its points: its edge if they are evenly spread.
const PATCH_REACH: f64 = 1.7;

/// One frame of the cell: a part in front of wall and floor.
#[derive(Clone, Debug)]
pub struct CellView {
    /// Points of the part, camera space.
    pub(super) part: PointCloud,
    /// Wall and floor, if they were found.
    pub(super) background: Vec<PlanePatch>,
    pub(super) noise_at_1m: Metres,
}

/// The visible part of a plane. Beyond it the plane's direction is uncertain: of a floor often only a strip is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlanePatch {
    pub(super) plane: Plane,
    /// The ends of its two axes, camera space.
    pub(super) ends: [Point3<f64>; 4],
}

impl PlanePatch {
    /// Fits a patch to points on a plane; `None` for fewer than three.
    fn new(points: impl Iterator<Item = (Point3<f64>, f64)> + Clone) -> Option<Self> {
        let principal = principal_axes(points)?;
        let ends = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].map(|(axis, sign)| {
            let reach = sign * PATCH_REACH * principal.variances[axis].sqrt();
            principal.mean + reach * principal.axes.column(axis)
        });
        Self::through(ends)
    }

    /// The patch with these ends of its axes; `None` if they lie on a line.
    pub(super) fn through(ends: [Point3<f64>; 4]) -> Option<Self> {
        let plane = Plane::through(&ends[0], &ends[1], &ends[2])?.facing(&Point3::origin());
        Some(Self { plane, ends })
    }

    /// The patch after this motion.
    pub(super) fn carried(&self, moved: &RigidTransform) -> Self {
        let normal = moved.rotation * self.plane.normal;
        Self {
            plane: Plane {
                normal,
                offset: self.plane.offset - normal.dot(&moved.translation.vector),
            },
            ends: self.ends.map(|end| moved * end),
        }
    }

    /// Largest distance of another plane from the ends of the patch.
    pub(super) fn distance_to(&self, other: &Plane) -> Metres {
        let distances = self.ends.iter().map(|end| other.signed_distance(end).abs());
        Metres(distances.fold(0.0, f64::max))
    }
}

/// The frames of a baseline or of a check.
#[derive(Clone, Debug)]
pub struct CellViews {
    params: SegmentParams,
    /// One view per frame, in order.
    pub views: Vec<CellView>,
    /// True if a frame was simulated.
    pub is_simulated: bool,
}

impl CellViews {
    /// Starts without frames; `params` select the part in each.
    pub fn new(params: &SegmentParams) -> Self {
        Self {
            params: params.clone(),
            views: Vec::new(),
            is_simulated: false,
        }
    }

    /// Finds the part in the next frame.
    pub fn add(&mut self, scene: &SceneCloud) -> Result<(), NoPart> {
        self.views.push(CellView::from_scene(scene, &self.params)?);
        self.is_simulated |= scene.cloud.is_simulated;
        Ok(())
    }
}

impl CellView {
    /// Finds the part in a frame.
    pub fn from_scene(scene: &SceneCloud, params: &SegmentParams) -> Result<Self, NoPart> {
        let segmentation = segment(scene, params);
        let part = segmentation.part?;
        let points = scene.cloud.points.iter().zip(&segmentation.labels);
        let background = (0..segmentation.planes.len()).filter_map(|plane| {
            let on_it = points.clone().filter(|&(_, label)| {
                matches!(label, PointLabel::Background(number) if usize::from(*number) == plane)
            });
            PlanePatch::new(on_it.map(|(point, _)| (point.cast(), 1.0)))
        });
        Ok(Self {
            background: background.collect(),
            part: part.cloud,
            noise_at_1m: part.noise_at_1m,
        })
    }
}
