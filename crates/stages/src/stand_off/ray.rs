//! Intersects a nozzle's ray with a surface of points with normals.

use nalgebra::{Point3, Vector3};

use crate::reference::{Reference, SPACING_M};
use geometry::{
    cloud::PointCloud,
    nearest::{KdTree, Neighbour},
    nearest_field::NearestField,
    normals::estimate_normals,
    units::Metres,
    voxel::downsample,
};

/// Search range on either side of the expected distance, metres.
const REACH_M: f32 = 0.4;
/// Step along a ray, metres: the side of a cell of the nearest-point field.
const STEP_M: f32 = 0.02;
/// Minimum cosine between ray and reversed normal: 80°.
const MIN_FACING_COSINE: f32 = 0.17;
/// Maximum distance from the surface to the nearest point of the cloud, metres.
const BESIDE_M: f32 = 1.5 * SPACING_M as f32;
/// Radius for estimating the normals of a captured part, which is thinned to the spacing of a reference.
const SEEN_RADIUS: Metres = Metres(4.0 * SPACING_M);

/// A surface of points with unit normals, evenly spaced.
pub struct ReferenceSurface<'a> {
    points: &'a [Point3<f32>],
    normals: &'a [Vector3<f32>],
    tree: &'a KdTree,
    /// Faster than the tree, if available.
    field: Option<&'a NearestField>,
}

impl<'a> ReferenceSurface<'a> {
    /// Returns the surface of an enrolled part, in part space; `None` without normals.
    pub fn of(reference: &'a Reference) -> Option<Self> {
        Some(Self {
            points: &reference.cloud.points,
            normals: reference.cloud.normals.as_ref()?,
            tree: reference.tree(),
            field: Some(reference.field()),
        })
    }

    fn near(&self, at: &Point3<f32>) -> Option<Neighbour> {
        match self.field {
            Some(field) => field.nearest(at),
            None => self.tree.nearest(at, f32::INFINITY),
        }
    }
}

/// The surface of a part as seen by a camera at the origin; camera space.
pub struct SeenSurface {
    points: Vec<Point3<f32>>,
    normals: Vec<Vector3<f32>>,
    tree: KdTree,
}

impl SeenSurface {
    pub fn of(seen: &PointCloud) -> Self {
        let points = downsample(seen, Metres(SPACING_M)).points;
        let tree = KdTree::new(&points);
        let normals = estimate_normals(&points, &tree, SEEN_RADIUS, &Point3::origin());
        Self {
            points,
            normals,
            tree,
        }
    }

    pub fn surface(&self) -> ReferenceSurface<'_> {
        ReferenceSurface {
            points: &self.points,
            normals: &self.normals,
            tree: &self.tree,
            field: None,
        }
    }
}

/// A nozzle position and direction, in the surface's space.
pub struct Ray {
    pub mouth: Point3<f32>,
    /// Unit length.
    pub direction: Vector3<f32>,
}

impl Ray {
    fn at(&self, t: f32) -> Point3<f32> {
        self.mouth + self.direction * t
    }

    /// Returns the distance along the ray and the normal where it enters the surface, nearest to `expected`.
    pub fn intersect(
        &self,
        surface: &ReferenceSurface<'_>,
        expected: f32,
    ) -> Option<(f32, Vector3<f32>)> {
        let num_steps = (2.0 * REACH_M / STEP_M) as usize;
        let mut before: Option<f32> = None;
        let mut best: Option<(f32, Vector3<f32>)> = None;
        for i in 0..=num_steps {
            let t = expected - REACH_M + i as f32 * STEP_M;
            let height = self.height(surface, t);
            if let (Some(above), Some(below)) = (before, height)
                && above > 0.0
                && below <= 0.0
            {
                let t = t - STEP_M * below / (below - above);
                let found = self.settled(surface, t);
                best = [best, found]
                    .into_iter()
                    .flatten()
                    .min_by(|a, b| (a.0 - expected).abs().total_cmp(&(b.0 - expected).abs()));
            }
            before = height;
        }
        best
    }

    /// Returns the height above the surface near the point at `t`, if that surface faces the nozzle.
    fn height(&self, surface: &ReferenceSurface<'_>, t: f32) -> Option<f32> {
        let at = self.at(t);
        let nearest = surface.near(&at)?;
        let normal = surface.normals.get(nearest.index)?;
        let faces = -normal.dot(&self.direction) > MIN_FACING_COSINE;
        faces.then(|| normal.dot(&(at - surface.points[nearest.index])))
    }

    /// Refines the crossing near `t` with the exact nearest points; `None` where the surface ends before it.
    fn settled(&self, surface: &ReferenceSurface<'_>, mut t: f32) -> Option<(f32, Vector3<f32>)> {
        let mut normal = Vector3::zeros();
        // The first step reaches the plane of the nearest point, the second that of the point nearest to the result.
        for _ in 0..2 {
            let nearest = surface.tree.nearest(&self.at(t), f32::INFINITY)?;
            normal = *surface.normals.get(nearest.index)?;
            let slope = normal.dot(&self.direction);
            if -slope <= MIN_FACING_COSINE {
                return None;
            }
            t = normal.dot(&(surface.points[nearest.index] - self.mouth)) / slope;
        }
        let beside = surface.tree.nearest(&self.at(t), BESIDE_M * BESIDE_M);
        beside.map(|_| (t, normal))
    }
}
