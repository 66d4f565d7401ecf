//! A reference as a virtual camera sees it from one side.

use std::sync::OnceLock;

use nalgebra::{Isometry2, Point2, Point3};

use super::{ReferenceParams, viewpoints::visible_from};
use crate::{
    geometry::{cloud::PointCloud, raster::PackedImage, rigid::RigidTransform},
    stages::{
        contour::{Contour, find_contour},
        pose::edge_points::EdgePoints,
        project::{PlaneImage, project_weighted},
        signature::{FanSignature, describe},
    },
    units::Radians,
};

/// Pixel size of the packed image, metres: finer than the spacing of the points looked up in it, at a quarter of the
/// memory that every inspection reads.
const PACKED_PIXEL: f64 = 0.01;

/// The reference as seen from one side.
#[derive(Clone, Debug)]
pub struct ReferenceView {
    /// Position of the virtual camera, part space.
    pub(super) viewpoint: Point3<f64>,
    /// Transform from part space to this view's plane space.
    pub plane_from_part: RigidTransform,
    /// The projection of the visible points.
    pub plane: PlaneImage,
    /// The image as packed bits, with pixels of about a centimetre.
    pub pixels: PackedImage,
    /// Area of the set pixels, square metres.
    pub image_area: f64,
    /// Outline and openings.
    pub contour: Contour,
    /// The outline's signature.
    pub signature: FanSignature,
    /// Outline and openings on the surface, part space; built when a pose is first tried from this view.
    pub(super) edges: OnceLock<EdgePoints>,
}

impl ReferenceView {
    pub(super) fn new(
        viewpoint: Point3<f64>,
        plane: PlaneImage,
        contour: Contour,
        signature: FanSignature,
    ) -> Self {
        Self {
            viewpoint,
            edges: OnceLock::new(),
            pixels: plane
                .image
                .packed((PACKED_PIXEL / plane.pixel.0).round() as usize),
            image_area: plane.image.num_set() as f64 * plane.pixel.0.powi(2),
            plane_from_part: plane.plane_from_camera,
            plane,
            contour,
            signature,
        }
    }

    pub(super) fn from_viewpoint(
        cloud: &PointCloud,
        bounds: (Point3<f32>, Point3<f32>),
        viewpoint: &Point3<f64>,
        params: &ReferenceParams,
    ) -> Option<Self> {
        let visible = visible_from(cloud, bounds, viewpoint);
        let points: Vec<Point3<f32>> = visible.iter().map(|v| cloud.points[v.0]).collect();
        // The cloud is evenly spaced on the surface, but a camera sees a tilted surface with fewer pixels.
        let weight = |i: usize, _: &Point3<f32>| visible[i].1;
        let plane = project_weighted(&points, weight, viewpoint, &params.project).ok()?;
        let contour = find_contour(&plane, &params.contour).ok()?;
        let signature = describe(&contour, &params.signature).ok()?;
        Some(Self::new(*viewpoint, plane, contour, signature))
    }

    /// Returns the transform, in the plane, from view-plane space to a scene's plane space that rotates by `turn` and
    /// moves the view's centroid to the scene's.
    pub fn scene_plane_from_view_plane(
        &self,
        turn: Radians,
        scene_centroid: &Point2<f64>,
    ) -> Isometry2<f64> {
        let rotation = nalgebra::UnitComplex::new(turn.0);
        let shift = scene_centroid - rotation * self.signature.centroid;
        Isometry2::from_parts(shift.into(), rotation)
    }
}
