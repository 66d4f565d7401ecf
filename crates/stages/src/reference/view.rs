//! A reference as a virtual camera sees it from one side.

use std::sync::{Arc, OnceLock};

use nalgebra::{Isometry2, Point2, Point3};

use super::{ReferenceParams, viewpoints::visible_from};
use crate::{
    contour::{Contour, find_contour},
    pose::edge_points::EdgePoints,
    project::{PlaneImage, project_weighted},
    signature::{FanSignature, describe},
};
use geometry::{
    cloud::PointCloud,
    raster::{BinaryImage, PackedImage, RunLengthImage},
    rigid::RigidTransform,
    units::{Metres, Radians},
};

/// Pixel size of the packed image, metres: finer than the spacing of the points looked up in it, at a quarter of the
/// memory that every inspection reads.
const PACKED_PIXEL_M: f64 = 0.01;

/// The reference as seen from one side.
#[derive(Clone, Debug)]
pub struct ReferenceView {
    /// Position of the virtual camera, part space.
    pub(super) viewpoint: Point3<f64>,
    /// Transform from part space to this view's plane space.
    pub plane_from_part: RigidTransform,
    /// Side of a pixel of the whole image.
    pixel: Metres,
    /// Plane coordinates of the centre of pixel (0, 0).
    origin: Point2<f64>,
    /// Standard deviations along the three axes, metres, descending.
    deviations: [f64; 3],
    /// The image as packed bits, with pixels of about a centimetre.
    pub pixels: PackedImage,
    /// Area of the set pixels, square metres.
    pub image_area: f64,
    /// Mean of the outline's samples, plane space, metres.
    pub centroid: Point2<f64>,
    /// What ranking does not use. Most references of a large library are never compared more closely.
    details: OnceLock<ViewDetails>,
    /// What the details are made of again; `None` for a flat shape.
    source: Option<ViewSource>,
    /// Outline and openings on the surface, part space; built when a pose is first tried from this view.
    pub(super) edges: OnceLock<EdgePoints>,
}

/// Image, contour and signature of a view.
#[derive(Clone, Debug)]
struct ViewDetails {
    shape: PackedShape,
    signature: FanSignature,
}

/// What a view is made of.
#[derive(Clone, Debug)]
pub(super) struct ViewSource {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) params: Arc<ReferenceParams>,
}

/// Image and contour of a view in a thirtieth of their memory.
#[derive(Clone, Debug, Default)]
struct PackedShape {
    image: RunLengthImage,
    /// The outline, then the openings.
    borders: Box<[PackedBorder]>,
    /// True if the outline's pixels were followed in the other direction.
    is_outline_reversed: bool,
    area: f64,
}

/// A border by the pixels of its points.
#[derive(Clone, Debug)]
struct PackedBorder {
    /// Column and row.
    pixels: Box<[[u16; 2]]>,
    /// NaN where there is none.
    heights: Box<[f32]>,
}

impl PackedShape {
    fn new(plane: &PlaneImage, contour: &Contour) -> Self {
        let borders = contour.borders().map(|border| PackedBorder {
            pixels: (border.points.iter())
                .map(|point| {
                    let (column, row) = plane.pixel_of(point);
                    [column, row].map(|place| place.round() as u16)
                })
                .collect(),
            heights: (border.heights.iter())
                .map(|height| height.unwrap_or(f32::NAN))
                .collect(),
        });
        let borders: Box<[PackedBorder]> = borders.collect();
        let is_in_order = |outline: &PackedBorder| {
            let followed = contour.outline_pixels.iter().copied();
            followed.eq(outline.pixels.iter().copied().map(wide))
        };
        Self {
            image: RunLengthImage::new(&plane.image),
            is_outline_reversed: !borders.first().is_some_and(is_in_order),
            borders,
            area: contour.area,
        }
    }
}

fn wide(pixel: [u16; 2]) -> [u32; 2] {
    pixel.map(u32::from)
}

impl ReferenceView {
    /// Creates the view of a flat shape.
    pub(super) fn flat(
        viewpoint: Point3<f64>,
        plane: &PlaneImage,
        contour: &Contour,
        signature: FanSignature,
    ) -> Self {
        Self {
            viewpoint,
            plane_from_part: plane.plane_from_camera,
            pixel: plane.pixel,
            origin: plane.origin,
            deviations: plane.deviations,
            pixels: plane
                .image
                .packed((PACKED_PIXEL_M / plane.pixel.0).round() as usize),
            image_area: plane.image.num_set() as f64 * plane.pixel.0.powi(2),
            centroid: signature.centroid,
            details: OnceLock::from(ViewDetails {
                shape: PackedShape::new(plane, contour),
                signature,
            }),
            source: None,
            edges: OnceLock::new(),
        }
    }

    /// Creates the view from a viewpoint; `None` if the cloud has no outline from there. `bounds` are the cloud's.
    pub(super) fn from_viewpoint(
        source: &ViewSource,
        bounds: (Point3<f32>, Point3<f32>),
        viewpoint: &Point3<f64>,
    ) -> Option<Self> {
        let ViewSource { cloud, params } = source;
        let visible = visible_from(cloud, bounds, viewpoint);
        let points: Vec<Point3<f32>> = visible.iter().map(|v| cloud.points[v.0]).collect();
        // The cloud is evenly spaced on the surface, but a camera sees a tilted surface with fewer pixels.
        let weight = |i: usize, _: &Point3<f32>| visible[i].1;
        let plane = project_weighted(&points, weight, viewpoint, &params.project).ok()?;
        let contour = find_contour(&plane, &params.contour).ok()?;
        let signature = describe(&contour, &params.signature).ok()?;
        Some(Self {
            source: Some(source.clone()),
            ..Self::flat(*viewpoint, &plane, &contour, signature)
        })
    }

    fn details(&self) -> &ViewDetails {
        self.details.get_or_init(|| {
            let made = self.source.as_ref().and_then(|source| {
                let bounds = source.cloud.bounds()?;
                let view = Self::from_viewpoint(source, bounds, &self.viewpoint)?;
                view.details.into_inner()
            });
            made.expect("a view can be made again of its cloud")
        })
    }

    /// Drops what ranking does not use; it is made again, in about a millisecond, when first needed.
    pub(super) fn drop_details(&mut self) {
        if self.source.is_some() {
            self.details = OnceLock::new();
        }
    }

    /// Returns the outline's signature.
    pub fn signature(&self) -> &FanSignature {
        &self.details().signature
    }

    /// Replaces the signature, for references that are simulated as signatures only.
    #[must_use]
    pub fn with_signature(&self, signature: FanSignature) -> Self {
        Self {
            centroid: signature.centroid,
            details: OnceLock::from(ViewDetails {
                shape: self.details().shape.clone(),
                signature,
            }),
            source: None,
            ..self.clone()
        }
    }

    /// Drops image and contour, for references that are only ranked.
    pub fn drop_shape(&mut self) {
        self.drop_source();
        if let Some(details) = self.details.get_mut() {
            details.shape = PackedShape::default();
        }
    }

    /// Keeps the details, which can no longer be made again.
    pub(super) fn drop_source(&mut self) {
        self.details();
        self.source = None;
    }

    /// Returns the projection of the visible points, without the heights: those at the borders are in the contour.
    pub fn plane(&self) -> PlaneImage {
        self.plane_of(self.details().shape.image.unpacked())
    }

    /// Returns the projection's geometry, with an image without pixels.
    pub fn empty_plane(&self) -> PlaneImage {
        self.plane_of(BinaryImage::new(0, 0))
    }

    fn plane_of(&self, image: BinaryImage) -> PlaneImage {
        PlaneImage {
            heights: vec![f32::NAN; image.pixels.len()],
            image,
            pixel: self.pixel,
            origin: self.origin,
            plane_from_camera: self.plane_from_part,
            deviations: self.deviations,
        }
    }

    /// Returns outline and openings.
    pub fn contour(&self) -> Contour {
        let plane = self.empty_plane();
        let shape = &self.details().shape;
        let points = |border: &PackedBorder| {
            let pixels = border.pixels.iter();
            let point =
                |[column, row]: &[u16; 2]| plane.plane_point((*column).into(), (*row).into());
            pixels.map(point).collect::<Vec<_>>()
        };
        let heights = |border: &PackedBorder| {
            let heights = border.heights.iter();
            heights.map(|z| z.is_finite().then_some(*z)).collect()
        };
        let mut borders = shape.borders.iter();
        let outline = borders.next();
        let mut outline_pixels: Vec<[u32; 2]> = outline
            .map(|border| border.pixels.iter().copied().map(wide).collect())
            .unwrap_or_default();
        if shape.is_outline_reversed {
            outline_pixels.reverse();
        }
        Contour {
            outline: outline.map(points).unwrap_or_default(),
            openings: borders.map(points).collect(),
            outline_pixels,
            heights: shape.borders.iter().map(heights).collect(),
            area: shape.area,
        }
    }

    /// Returns the transform, in the plane, from view-plane space to a scene's plane space that rotates by `turn` and
    /// moves the view's centroid to the scene's.
    pub fn scene_plane_from_view_plane(
        &self,
        turn: Radians,
        scene_centroid: &Point2<f64>,
    ) -> Isometry2<f64> {
        let rotation = nalgebra::UnitComplex::new(turn.0);
        let shift = scene_centroid - rotation * self.centroid;
        Isometry2::from_parts(shift.into(), rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::{fs, path::Path, sync::LazyLock};

    use files::FileContent;

    use super::super::{Coverage, Reference};
    use crate::reference::ReferenceParams;

    /// The shipped parts, prepared once.
    fn shipped_references() -> &'static [Reference] {
        static PREPARED: LazyLock<Vec<Reference>> = LazyLock::new(|| {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference_parts");
            let parts = fs::read_dir(folder).expect("a folder");
            let clouds = parts.map(|part| part.expect("a part").path().join("cloud.ply"));
            let prepared = clouds.filter(|path| path.is_file()).map(|path| {
                let Ok(FileContent::Cloud(cloud)) = files::open(&path) else {
                    panic!("{} is no cloud", path.display());
                };
                let params = ReferenceParams::default();
                let reference = Reference::prepare("part", cloud, Coverage::OneSide, &params);
                reference.expect("an outline")
            });
            prepared.collect()
        });
        assert_eq!(PREPARED.len(), 8);
        &PREPARED
    }

    #[test]
    fn a_view_unpacks_to_the_image_and_the_contour_that_it_was_made_of() {
        let params = ReferenceParams::default();
        for reference in shipped_references() {
            let bounds = reference.cloud.bounds().expect("points");
            for view in &reference.views {
                let visible = visible_from(&reference.cloud, bounds, &view.viewpoint);
                let points: Vec<Point3<f32>> = visible
                    .iter()
                    .map(|v| reference.cloud.points[v.0])
                    .collect();
                let weight = |i: usize, _: &Point3<f32>| visible[i].1;
                let plane = project_weighted(&points, weight, &view.viewpoint, &params.project);
                let plane = plane.expect("a plane");
                let contour = find_contour(&plane, &params.contour).expect("a contour");
                assert_eq!(view.contour(), contour, "{}", reference.name);
                let unpacked = view.plane();
                assert_eq!(unpacked.image, plane.image);
                assert_eq!(
                    (unpacked.origin, unpacked.pixel, unpacked.plane_from_camera),
                    (plane.origin, plane.pixel, plane.plane_from_camera)
                );
            }
        }
    }

    #[test]
    fn in_a_large_library_the_details_of_a_view_are_made_again_the_same_when_needed() {
        for reference in shipped_references() {
            let kept = reference.clone().for_library_of(8);
            assert!(kept.views.iter().all(|view| view.details.get().is_some()));
            let compact = reference.clone().for_library_of(2000);
            assert!(
                compact
                    .views
                    .iter()
                    .all(|view| view.details.get().is_none())
            );
            assert_eq!(compact.summaries(), reference.summaries());
            for (view, expected) in compact.views.iter().zip(&reference.views) {
                assert_eq!(view.centroid, expected.signature().centroid);
                assert_eq!(view.contour(), expected.contour());
                assert_eq!(view.plane().image, expected.plane().image);
                assert_eq!(view.signature(), expected.signature());
            }
        }
    }

    #[test]
    fn the_views_of_a_reference_take_less_memory_than_its_points() {
        for reference in shipped_references() {
            let of_view = |view: &ReferenceView| {
                let shape = &view.details().shape;
                let borders = shape.borders.iter();
                let points: usize = borders.map(|border| border.pixels.len()).sum();
                8 * points + shape.image.num_bytes()
            };
            let num_bytes: usize = reference.views.iter().map(of_view).sum();
            assert!(num_bytes < 120_000, "{}: {num_bytes}", reference.name);
        }
    }
}
