//! Projects the part's points onto the plane of their first two principal axes, as a binary image (eq. 3 to 6).
//!
//! Deviations from the paper: the third axis points towards the camera and the axes are right-handed, so a left part
//! never looks like a right one; pixels have a fixed metric size, so size remains evidence; small sampling gaps are
//! closed morphologically while real holes stay open; points are weighted by the surface they stand for (depth²), so
//! that the near side of a tilted part, which the camera samples densely, does not bias the axes.
//!
//! ```text
//! plane space: x, y along the first two axes, z towards the camera, origin at the points' mean
//!        y ▲                    image: column grows with x, row grows against y,
//!          │   x                so the picture is the part as the camera sees it, turned
//!          └──►                 in its plane
//! ```

use nalgebra::{
    Isometry3, Matrix3, Point2, Point3, Rotation3, Translation3, UnitQuaternion, Vector3,
};

use crate::segment::SegmentedPart;
use geometry::{
    principal::{PrincipalAxes, principal_axes},
    raster::BinaryImage,
    rigid::RigidTransform,
    units::Metres,
};

/// Parameters of [`project`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct ProjectParams {
    /// Side of a pixel, 1..20 mm. Below the spacing of the points, gaps appear; raising it blurs the outline.
    pub pixel: Metres,
    /// Gaps up to this width are closed, 0..50 mm. Raising it fills narrow real openings.
    pub closed_gap: Metres,
}

impl Default for ProjectParams {
    fn default() -> Self {
        Self {
            pixel: Metres::from_mm(5.0),
            closed_gap: Metres::from_mm(20.0),
        }
    }
}

/// The part as a binary image in the plane of its principal axes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneImage {
    /// Pixels covered by the part are set.
    pub image: BinaryImage,
    /// Height of the surface above the plane (metres, towards the camera) per pixel; NaN where no point fell,
    /// including closed gaps.
    pub heights: Vec<f32>,
    /// Side of a pixel.
    pub pixel: Metres,
    /// Plane coordinates of the centre of pixel (0, 0).
    pub origin: Point2<f64>,
    /// Transform from camera space to plane space.
    pub plane_from_camera: RigidTransform,
    /// Standard deviations along the three axes, metres, descending.
    pub deviations: [f64; 3],
}

impl PlaneImage {
    /// Creates the plane of an image drawn by hand or read from a file, with the centre of the image as origin.
    pub fn from_image(image: BinaryImage, pixel: Metres) -> Self {
        let half = |n: usize| (n as f64 - 1.0) / 2.0 * pixel.0;
        Self {
            heights: vec![0.0; image.pixels.len()],
            origin: Point2::new(-half(image.width), half(image.height)),
            image,
            pixel,
            plane_from_camera: RigidTransform::identity(),
            deviations: [0.0; 3],
        }
    }

    /// Returns the plane coordinates of the centre of a pixel.
    pub fn plane_point(&self, column: f64, row: f64) -> Point2<f64> {
        Point2::new(
            self.origin.x + column * self.pixel.0,
            self.origin.y - row * self.pixel.0,
        )
    }

    /// Returns the column and row of a plane point, not rounded.
    pub fn pixel_of(&self, point: &Point2<f64>) -> (f64, f64) {
        (
            (point.x - self.origin.x) / self.pixel.0,
            (self.origin.y - point.y) / self.pixel.0,
        )
    }
}

/// Reason why no image could be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ProjectError {
    /// The points span no plane.
    NoPlane {
        /// Number of points.
        num_points: usize,
        /// Standard deviation along the second axis, metres.
        #[serde(rename = "width_m")]
        width: f64,
    },
    /// The points extend too far for an image.
    TooLarge {
        /// Extent, metres.
        #[serde(rename = "found_m")]
        found: f64,
        /// Largest extent, metres.
        #[serde(rename = "limit_m")]
        limit: f64,
    },
}

texts::described!(ProjectError: "refusal" by "kind");

/// Unset pixels around the part, so that closing and border following never reach the edge.
const MARGIN: usize = 2;
/// Maximum image side, a bound on memory: 20 m at the default pixel, larger than any part.
const MAX_SIDE: usize = 4096;

/// Projects a part to a binary image, as seen by the camera at the origin of its space.
pub fn project(part: &SegmentedPart, params: &ProjectParams) -> Result<PlaneImage, ProjectError> {
    let points = &part.cloud.points;
    // A pixel at depth z covers an area proportional to z². A cloud around the origin was not seen from there.
    let seen_from_origin = points.iter().all(|p| p.z > 0.1);
    let weight = |_: usize, p: &Point3<f32>| {
        if seen_from_origin {
            f64::from(p.z * p.z)
        } else {
            1.0
        }
    };
    project_weighted(points, weight, &Point3::origin(), params)
}

/// Minimum number of points sampled to find the plane.
const NUM_PLANE_POINTS: usize = 16_000;

/// Projects points to a binary image, weighted by `weight(index, point)` and seen from `viewpoint`.
pub fn project_weighted(
    points: &[Point3<f32>],
    weight: impl Fn(usize, &Point3<f32>) -> f64,
    viewpoint: &Point3<f64>,
    params: &ProjectParams,
) -> Result<PlaneImage, ProjectError> {
    let no_plane = |width| ProjectError::NoPlane {
        num_points: points.len(),
        width,
    };
    // Eq. 4 and 5. A sample of a large cloud gives the plane equally well.
    let step = (points.len() / NUM_PLANE_POINTS).max(1);
    let weighted = points
        .iter()
        .enumerate()
        .step_by(step)
        .map(|(i, p)| (p.cast::<f64>(), weight(i, p)));
    let principal = principal_axes(weighted).ok_or_else(|| no_plane(0.0))?;
    let deviations = principal.variances.map(f64::sqrt);
    // A strip one pixel wide has no shape.
    if deviations[1] < params.pixel.0 {
        return Err(no_plane(deviations[1]));
    }
    let plane_from_camera = plane_frame(&principal, viewpoint);
    rasterise(points, plane_from_camera, deviations, params)
}

/// Returns the frame of eq. 6 with fixed signs: third axis towards the viewpoint, right-handed.
fn plane_frame(principal: &PrincipalAxes, viewpoint: &Point3<f64>) -> RigidTransform {
    let towards_camera: Vector3<f64> = viewpoint - principal.mean;
    let mut third: Vector3<f64> = principal.axes.column(2).into_owned();
    if third.dot(&towards_camera) < 0.0 {
        third = -third;
    }
    let first: Vector3<f64> = principal.axes.column(0).into_owned();
    let second = third.cross(&first);
    // The rows of plane_from_camera are the axes in camera space.
    let rotation = Matrix3::from_rows(&[first.transpose(), second.transpose(), third.transpose()]);
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Isometry3::from_parts(
        Translation3::from(-(rotation * principal.mean.coords)),
        rotation,
    )
}

fn rasterise(
    points: &[Point3<f32>],
    plane_from_camera: RigidTransform,
    deviations: [f64; 3],
    params: &ProjectParams,
) -> Result<PlaneImage, ProjectError> {
    // Eq. 3, in f32: coordinates are within metres of the mean, and a pixel is millimetres. A matrix takes half the
    // operations of a quaternion.
    let turn: Matrix3<f32> = plane_from_camera
        .rotation
        .to_rotation_matrix()
        .into_inner()
        .cast();
    let shift: Vector3<f32> = plane_from_camera.translation.vector.cast();
    // Computed twice, for the extent and for the pixels: storing the points would take longer.
    let in_plane = || points.iter().map(|p| turn * p + shift);
    let mut low = [f32::INFINITY; 2];
    let mut high = [f32::NEG_INFINITY; 2];
    for p in in_plane() {
        for (axis, x) in [p.x, p.y].into_iter().enumerate() {
            // No coordinate is NaN: `min` and `max` would spend most of their time on that.
            low[axis] = if x < low[axis] { x } else { low[axis] };
            high[axis] = if x > high[axis] { x } else { high[axis] };
        }
    }
    let pixel = params.pixel.0;
    let radius = (params.closed_gap.0 / pixel / 2.0).round() as usize;
    let margin = MARGIN + radius;
    let side = |axis: usize| f64::from(high[axis] - low[axis]) / pixel + (2 * margin + 2) as f64;
    let (width, height) = (side(0), side(1));
    if !(width.max(height) <= MAX_SIDE as f64) {
        return Err(ProjectError::TooLarge {
            found: width.max(height) * pixel,
            limit: MAX_SIDE as f64 * pixel,
        });
    }
    let origin = Point2::new(
        f64::from(low[0]) - margin as f64 * pixel,
        f64::from(high[1]) + margin as f64 * pixel,
    );
    let mut image = BinaryImage::new(width as usize, height as usize);
    let mut heights = vec![f32::NAN; image.pixels.len()];
    let per_pixel = (1.0 / pixel) as f32;
    let (left, top) = (origin.x as f32, origin.y as f32);
    for p in in_plane() {
        // By way of 32 bits: the processor converts to them in one instruction.
        let column = ((p.x - left) * per_pixel + 0.5) as i32 as usize;
        let row = ((top - p.y) * per_pixel + 0.5) as i32 as usize;
        let i = row * image.width + column;
        image.pixels[i] = 1;
        heights[i] = p.z;
    }
    image.close(radius);
    Ok(PlaneImage {
        image,
        heights,
        pixel: params.pixel,
        origin,
        plane_from_camera,
        deviations,
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use geometry::cloud::PointCloud;

    /// A tilted plate of 1.0 × 0.4 m with a window near one corner, 1.2 m in front of the camera.
    fn plate() -> Vec<Point3<f32>> {
        let tilt = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.4);
        (0..250 * 100)
            .map(|i| {
                (
                    f64::from(i % 250) * 0.004 - 0.5,
                    f64::from(i / 250) * 0.004 - 0.2,
                )
            })
            .filter(|(x, y)| !((0.2..0.4).contains(x) && (0.0..0.16).contains(y)))
            .map(|(x, y)| (tilt * Point3::new(x, y, 0.0) + Vector3::new(0.05, 0.02, 1.2)).cast())
            .collect()
    }

    fn part(points: Vec<Point3<f32>>) -> SegmentedPart {
        SegmentedPart::whole(&PointCloud::from_points(points))
    }

    fn projected(points: Vec<Point3<f32>>) -> PlaneImage {
        project(&part(points), &ProjectParams::default()).expect("a plate")
    }

    #[test]
    fn the_plane_faces_the_camera_and_is_right_handed() {
        let plane = projected(plate());
        let camera = plane.plane_from_camera * Point3::origin();
        assert!(camera.z > 1.0, "the camera is at {camera}");
        let rotation = plane.plane_from_camera.rotation.to_rotation_matrix();
        assert!((rotation.matrix().determinant() - 1.0).abs() < 1e-9);
        assert!(plane.deviations[0] > plane.deviations[1] && plane.deviations[2] < 1e-3);
    }

    #[test]
    fn the_picture_has_the_plates_area_and_its_window_stays_open() {
        let plane = projected(plate());
        let area = plane.image.num_set() as f64 * plane.pixel.0.powi(2);
        assert!((area - (0.4 - 0.032)).abs() < 0.02, "{area} m²");
        // Every set pixel, transformed back to camera space, is close to a point of the plate.
        let camera_from_plane = plane.plane_from_camera.inverse();
        let tree = geometry::nearest::KdTree::new(&plate());
        for (i, _) in plane
            .image
            .pixels
            .iter()
            .enumerate()
            .filter(|(_, p)| **p == 1)
        {
            let at = plane.plane_point(
                (i % plane.image.width) as f64,
                (i / plane.image.width) as f64,
            );
            let back = camera_from_plane * Point3::new(at.x, at.y, 0.0);
            let nearest = tree.nearest(&back.cast(), f32::INFINITY).expect("points");
            assert!(nearest.distance_sq.sqrt() < 0.015);
        }
    }

    #[test]
    fn a_mirrored_part_gives_the_mirrored_picture_not_the_same_one() {
        let mirrored = plate()
            .iter()
            .map(|p| Point3::new(-p.x, p.y, p.z))
            .collect();
        // The product of the two skews keeps its sign when the image is turned by 180°, as the axes may be, and
        // changes it when the image is mirrored.
        let handedness = |plane: &PlaneImage| {
            let width = plane.image.width;
            let set = plane
                .image
                .pixels
                .iter()
                .enumerate()
                .filter(|(_, p)| **p == 1);
            let skews = set.fold((0.0, 0.0), |sum, (i, _)| {
                let at = plane.plane_point((i % width) as f64, (i / width) as f64);
                (sum.0 + at.x.powi(3), sum.1 + at.y.powi(3))
            });
            skews.0 * skews.1
        };
        let (one, other) = (
            handedness(&projected(plate())),
            handedness(&projected(mirrored)),
        );
        assert!(one * other < 0.0, "{one} and {other} are of one hand");
    }

    #[test]
    fn what_spans_no_plane_or_too_much_is_named() {
        let line = (0..500)
            .map(|i| Point3::new(i as f32 * 0.002, 0.0, 1.0))
            .collect();
        let spot = vec![Point3::new(0.0, 0.0, 1.0); 500];
        for points in [line, spot, Vec::new()] {
            let found = project(&part(points), &ProjectParams::default());
            assert!(matches!(found, Err(ProjectError::NoPlane { .. })));
        }
        let wide = (0..10_000)
            .map(|i| Point3::new((i % 100) as f32, (i / 100) as f32, 500.0))
            .collect();
        let found = project(&part(wide), &ProjectParams::default());
        assert!(
            matches!(found, Err(ProjectError::TooLarge { .. })),
            "{found:?}"
        );
    }
}
