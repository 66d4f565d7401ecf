//! The scene: the points of a capture, in camera space.
//!
//! A depth frame becomes an organised cloud on the rays of its camera. For an organised cloud without a camera, the
//! intrinsics are fitted to the points, because x/z of a pinhole camera is linear in the column; later stages use the
//! camera to predict what it would see at a given place. A capture saved as bare points (PLY, XYZ) has lost its rows
//! and columns but not its viewpoint: it is arranged into a picture again, so that it can be inspected in the same way.

mod empty_cell;
mod picture;

use std::sync::{Arc, OnceLock};

use nalgebra::Point3;

pub use self::empty_cell::{EmptyCell, EmptyCellError};
use self::picture::organised;
pub use super::reduce::SceneParams;
use super::{
    field_of_view::FieldOfView,
    reduce::{reduced_depths, reduced_points},
};
use capture::Image;
use files::FileContent;
use geometry::{
    cloud::{Grid, PointCloud, is_finite},
    depth_frame::{DepthFrame, Intrinsics},
    error::{Fault, guarded},
    pinhole_fit::fit_pinhole,
    rays::Rays,
};

/// The points of one capture, in camera space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneCloud {
    /// The points, organised if they come from one frame.
    pub cloud: PointCloud,
    /// The camera, if the cloud is organised and a pinhole model fits it.
    pub intrinsics: Option<Intrinsics>,
    /// Meaning of the edge of an organised cloud.
    pub edge: PictureEdge,
    /// The capture of the empty cell by the same camera, if there is one.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// The field of view found in other frames of the same camera.
    pub known_view: Option<Arc<FieldOfView>>,
    /// Metres per unit of the depth image that the points come from, if it was not reduced.
    pub metres_per_unit: Option<f64>,
    /// The original capture, if the picture was reduced.
    pub reduced: Option<Reduced>,
    /// The program fault that prevented making the scene, which is then empty.
    pub fault: Option<Fault>,
    /// Computed on first use.
    #[doc(hidden)]
    pub field_of_view: OnceLock<FieldOfView>,
}

/// The original of a reduced scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// The capture with all its readings.
    pub original: Arc<Image>,
    /// Side in readings of a block that became one reading, at least 2.
    pub block_side: usize,
}

impl SceneCloud {
    /// Creates a scene; the edge of an organised cloud is taken as the end of the camera's view.
    pub fn new(cloud: PointCloud, intrinsics: Option<Intrinsics>) -> Self {
        Self {
            cloud,
            intrinsics,
            ..Self::default()
        }
    }

    /// Returns the field of view; `None` if the scene is not organised, or if its picture was put around its points.
    pub fn field_of_view(&self) -> Option<&FieldOfView> {
        let grid = self.cloud.grid.filter(|_| self.edge == PictureEdge::View)?;
        Some(self.field_of_view.get_or_init(|| {
            let points = &self.cloud.points;
            let is_reading = |i: usize| points.get(i).is_some_and(is_finite);
            let of_cell = self.empty_cell.as_ref().map(|cell| cell.field_of_view());
            FieldOfView::from_readings(grid, is_reading, of_cell.or(self.known_view.as_deref()))
        }))
    }

    /// Sets the field of view found in other frames of the same camera.
    pub fn set_known_view(&mut self, known: Option<Arc<FieldOfView>>) {
        self.known_view = known;
        self.field_of_view = OnceLock::new();
    }

    /// Returns the mirrored scene: x negated, and each row of an organised cloud reversed.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let turned = |p: &Point3<f32>| Point3::new(-p.x, p.y, p.z);
        // Copy row by row into memory of the right size: growing it takes several times as long.
        let mut points = Vec::with_capacity(self.cloud.points.len());
        match self.cloud.grid {
            Some(Grid { width, .. }) => {
                for row in self.cloud.points.chunks(width.max(1)) {
                    points.extend(row.iter().rev().map(turned));
                }
            }
            None => points.extend(self.cloud.points.iter().map(turned)),
        }
        let cloud = PointCloud {
            points,
            grid: self.cloud.grid,
            is_simulated: self.cloud.is_simulated,
            ..PointCloud::default()
        };
        let intrinsics = self.intrinsics.map(Intrinsics::mirrored);
        let view = self.field_of_view();
        // The empty cell is only used before the part is found.
        Self {
            edge: self.edge,
            field_of_view: view.map_or_else(OnceLock::new, |view| view.mirrored().into()),
            ..Self::new(cloud, intrinsics)
        }
    }
}

/// Meaning of the edge of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureEdge {
    /// The camera's view ends; the scene continues.
    #[default]
    View,
    /// The points end: the picture was put around them.
    Points,
}

/// Number of points sampled from a mesh to align it.
const MESH_POINTS: usize = 16_000;

/// Returns all points of a file's content; a mesh is sampled evenly, `None` if it has no area.
pub fn cloud_of(opened: FileContent) -> Option<PointCloud> {
    match opened {
        FileContent::Cloud(cloud) => Some(cloud),
        FileContent::Depth(frame) => Some(scene_from_image(Image::Depth(frame)).cloud),
        FileContent::Mesh(mesh) => mesh.sample_evenly(MESH_POINTS, 1),
    }
}

/// As [`scene_from_image`], for a depth frame, but panics on a fault.
pub fn scene_from_frame(frame: &DepthFrame) -> SceneCloud {
    match SceneParams::default().block_side(grid_of(&frame.intrinsics)) {
        1 => full_scene(frame),
        _ => scene_from_image(Image::Depth(frame.clone())),
    }
}

fn grid_of(camera: &Intrinsics) -> Grid {
    Grid {
        width: camera.width,
        height: camera.height,
    }
}

/// Like [`scene_from_frame`], but with a point for every pixel.
pub fn full_scene(frame: &DepthFrame) -> SceneCloud {
    let scale = frame.metres_per_unit as f32;
    let metres = |units: &u16| match units {
        0 => f32::NAN,
        units => f32::from(*units) * scale,
    };
    SceneCloud {
        metres_per_unit: Some(frame.metres_per_unit),
        ..scene_of_depths(frame, frame.intrinsics, frame.depth.iter().map(metres))
    }
}

fn scene_of_depths(
    frame: &DepthFrame,
    camera: Intrinsics,
    mut depths: impl Iterator<Item = f32>,
) -> SceneCloud {
    let given = &frame.intrinsics;
    assert_eq!(
        frame.depth.len(),
        given.width * given.height,
        "a frame holds width × height readings"
    );
    let rays = Rays::of(&camera);
    let mut points = Vec::with_capacity(camera.width * camera.height);
    for v in 0..camera.height {
        rays.append_row(v, depths.by_ref().take(camera.width), &mut points);
    }
    let cloud = PointCloud {
        points,
        grid: Some(grid_of(&camera)),
        is_simulated: frame.is_simulated,
        ..PointCloud::default()
    };
    SceneCloud::new(cloud, Some(camera))
}

/// Converts a capture to a scene in which each block of `side` × `side` readings becomes one. Unorganised points
/// give an empty scene.
///
/// # Panics
/// If `side` is 0.
pub fn reduced_scene(original: Arc<Image>, side: usize) -> SceneCloud {
    let scene = match &*original {
        Image::Depth(frame) => {
            let grid = grid_of(&frame.intrinsics);
            let depths = reduced_depths(&frame.depth, grid, side, frame.metres_per_unit as f32);
            let camera = frame.intrinsics.in_blocks(side);
            scene_of_depths(frame, camera, depths.into_iter())
        }
        Image::Cloud(cloud) => {
            let grid = cloud.grid.unwrap_or(Grid {
                width: 0,
                height: 0,
            });
            let coarse = Grid {
                width: grid.width / side,
                height: grid.height / side,
            };
            let reduced = PointCloud {
                points: reduced_points(&cloud.points, grid, side),
                grid: Some(coarse),
                is_simulated: cloud.is_simulated,
                surplus_bytes: cloud.surplus_bytes,
                ..PointCloud::default()
            };
            picture_of(reduced, coarse)
        }
    };
    SceneCloud {
        reduced: Some(Reduced {
            original,
            block_side: side,
        }),
        ..scene
    }
}

/// Converts a capture to a scene. A picture finer than the method needs is reduced.
///
/// Pixels without a reading become NaN. An organised cloud keeps its grid and gets a fitted camera. An unorganised cloud
/// that a single camera at the origin can have seen is arranged into a picture of its own density; any other stays unchanged.
pub fn scene_from_image(image: Image) -> SceneCloud {
    guarded(|| scene_with(image, &SceneParams::default())).unwrap_or_else(|fault| SceneCloud {
        fault: Some(fault),
        ..SceneCloud::default()
    })
}

/// Like [`scene_from_image`], with the given parameters; does not catch faults.
pub fn scene_with(image: Image, params: &SceneParams) -> SceneCloud {
    let grid = match &image {
        Image::Depth(frame) => Some(grid_of(&frame.intrinsics)),
        Image::Cloud(cloud) => cloud.grid,
    };
    match (grid.map_or(1, |grid| params.block_side(grid)), image) {
        (1, Image::Depth(frame)) => full_scene(&frame),
        (1, Image::Cloud(cloud)) => match cloud.grid {
            Some(grid) => picture_of(cloud, grid),
            None => organised(&cloud).unwrap_or_else(|| SceneCloud::new(cloud, None)),
        },
        (side, image) => reduced_scene(Arc::new(image), side),
    }
}

/// As [`scene_from_image`], for a cloud.
pub fn scene_from_cloud(cloud: PointCloud) -> SceneCloud {
    scene_from_image(Image::Cloud(cloud))
}

/// Converts an organised cloud to a scene.
fn picture_of(cloud: PointCloud, grid: Grid) -> SceneCloud {
    let camera = fit_pinhole(&cloud.points, grid);
    SceneCloud::new(cloud, camera)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;
    use geometry::distortion::Distortion;

    fn tilted_wall() -> DepthFrame {
        let intrinsics = Intrinsics::KINECT;
        let depth = (0..intrinsics.width * intrinsics.height)
            .map(|i| (8000 + (i % 640) * 3 + (i / 640) * 2) as u16)
            .collect();
        DepthFrame {
            intrinsics,
            metres_per_unit: 0.0002,
            depth,
            is_simulated: false,
        }
    }

    #[test]
    fn points_fall_back_onto_the_pixels_they_came_from() {
        let mut frame = tilted_wall();
        frame.depth[12_345] = 0;
        let scene = scene_from_frame(&frame);
        assert!(scene.cloud.points[12_345].z.is_nan());
        for (i, p) in scene.cloud.finite() {
            let (u, v) = frame.intrinsics.pixel_of(&p.cast()).expect("in front");
            assert!((u - (i % 640) as f64).abs() < 1e-3 && (v - (i / 640) as f64).abs() < 1e-3);
        }
    }

    #[test]
    #[expect(
        clippy::excessive_precision,
        clippy::unreadable_literal,
        reason = "as OpenCV prints them"
    )]
    fn behind_a_lens_points_lie_on_the_rays_that_opencv_undistorts_to() {
        let mut frame = tilted_wall();
        frame.intrinsics.distortion = Distortion {
            k1: -0.28,
            k2: 0.07,
            p1: 0.0007,
            p2: -0.0003,
            k3: 0.01,
            ..Distortion::NONE
        };
        let scene = scene_from_frame(&frame);
        // cv2.undistortPoints of OpenCV 5.0.0.
        let expected: [([usize; 2], [f32; 2]); 5] = [
            ([0, 0], [-0.745798537, -0.560043476]),
            ([639, 0], [0.747765217, -0.561041324]),
            ([320, 240], [0.000952381, 0.000952379]),
            ([100, 400], [-0.454699858, 0.332314015]),
            ([639, 479], [0.745451299, 0.557815179]),
        ];
        for ([u, v], [x, y]) in expected {
            let p = scene.cloud.points[v * 640 + u];
            let off = Vector2::new(p.x / p.z - x, p.y / p.z - y).norm();
            assert!(off < 1e-6, "{u}, {v}: {p} is off by {off}");
        }
        let camera = scene.intrinsics.expect("a camera");
        for (i, p) in scene.cloud.finite().step_by(97) {
            let (u, v) = camera.pixel_of(&p.cast()).expect("in front");
            assert!((u - (i % 640) as f64).abs() < 1e-3 && (v - (i / 640) as f64).abs() < 1e-3);
        }
        // Also in the mirrored scene.
        let mirrored = scene.mirrored();
        let camera = mirrored.intrinsics.expect("a camera");
        for (i, p) in mirrored.cloud.finite().step_by(97) {
            let (u, v) = camera.pixel_of(&p.cast()).expect("in front");
            assert!((u - (i % 640) as f64).abs() < 1e-3 && (v - (i / 640) as f64).abs() < 1e-3);
        }
    }

    #[test]
    fn a_mirrored_scene_has_its_rows_turned_round_and_mirrored_again_it_is_the_same() {
        let mut frame = tilted_wall();
        frame.depth[12_345] = 0;
        let scene = scene_from_frame(&frame);
        let mirrored = scene.mirrored();
        let bits = |scene: &SceneCloud| -> Vec<[u32; 3]> {
            let points = scene.cloud.points.iter();
            points.map(|p| [p.x, p.y, p.z].map(f32::to_bits)).collect()
        };
        let (before, there) = (&scene.cloud.points, &mirrored.cloud.points);
        assert_eq!(there.len(), before.len());
        for (at, opposite) in [(0, 639), (640 * 7 + 3, 640 * 7 + 636)] {
            let p = before[at];
            assert_eq!(there[opposite], Point3::new(-p.x, p.y, p.z));
        }
        assert_eq!(bits(&mirrored.mirrored()), bits(&scene));
        // Unorganised points keep their order.
        let loose = PointCloud::from_points(before.iter().copied());
        let loose = SceneCloud::new(loose, None);
        let turned = loose.mirrored().cloud.points;
        let first = loose.cloud.points[0];
        assert_eq!(turned[0], Point3::new(-first.x, first.y, first.z));
    }

    /// A tilted plane in front of a camera of 2560×1920 pixels with lens distortion.
    fn fine_plane() -> (DepthFrame, geometry::plane::Plane) {
        let intrinsics = Intrinsics {
            width: 2560,
            height: 1920,
            fx: 2100.0,
            fy: 2100.0,
            cx: 1300.0,
            cy: 900.0,
            distortion: Distortion {
                k1: 0.05,
                p1: 0.001,
                ..Distortion::NONE
            },
        };
        let at = |x, y, z| Point3::new(x, y, z);
        let corners = [at(0.0, 0.0, 1.5), at(1.0, 0.0, 2.0), at(0.0, 1.0, 1.2)];
        let plane = geometry::plane::Plane::through(&corners[0], &corners[1], &corners[2]);
        let plane = plane.expect("a plane");
        let rays = full_scene(&DepthFrame {
            intrinsics,
            metres_per_unit: 1.0,
            depth: vec![1; 2560 * 1920],
            is_simulated: false,
        });
        let depth = rays.cloud.points.iter().map(|ray| {
            let z = -plane.offset / plane.normal.dot(&ray.coords.cast());
            (z / 0.00005 + 0.5) as u16
        });
        let frame = DepthFrame {
            intrinsics,
            metres_per_unit: 0.00005,
            depth: depth.collect(),
            is_simulated: false,
        };
        (frame, plane)
    }

    #[test]
    fn a_fine_picture_is_reduced_onto_exact_rays() {
        let (frame, plane) = fine_plane();
        let from_frame = scene_from_frame(&frame);
        let from_cloud = scene_from_cloud(full_scene(&frame).cloud);
        for scene in [&from_frame, &from_cloud] {
            let grid = scene.cloud.grid.expect("rows and columns");
            assert_eq!((grid.width, grid.height), (640, 480));
            assert_eq!(scene.cloud.num_finite(), grid.num_cells());
            for p in &scene.cloud.points {
                let off = plane.signed_distance(&p.cast()).abs();
                assert!(off < 0.000_03, "{p} is {off} m off the plane");
            }
        }
        let camera = from_frame.intrinsics.expect("a camera");
        for (i, p) in from_frame.cloud.finite().step_by(97) {
            let (u, v) = camera.pixel_of(&p.cast()).expect("in front");
            assert!((u - (i % 640) as f64).abs() < 1e-3 && (v - (i / 640) as f64).abs() < 1e-3);
            let off = (p - from_cloud.cloud.points[i]).norm();
            assert!(off < 0.000_05, "a cloud gives another point, {off} m off");
        }
        let reduced = from_frame.reduced.expect("what it was reduced from");
        assert_eq!(reduced.block_side, 4);
        assert!(*reduced.original == Image::Depth(frame));
    }

    #[test]
    fn the_camera_is_found_again_from_the_points_alone() {
        let scene = scene_from_frame(&tilted_wall());
        let camera = scene_from_cloud(scene.cloud)
            .intrinsics
            .expect("a pinhole camera");
        let truth = Intrinsics::KINECT;
        for (found, expected) in [
            (camera.fx, truth.fx),
            (camera.fy, truth.fy),
            (camera.cx, truth.cx),
            (camera.cy, truth.cy),
        ] {
            assert!(
                (found - expected).abs() < 0.05,
                "{found} instead of {expected}"
            );
        }
    }

    #[test]
    fn a_capture_exported_as_bare_points_becomes_a_picture_again() {
        let scene = scene_from_frame(&tilted_wall());
        // In reverse order: only the positions are left.
        let points: Vec<_> = scene.cloud.points.iter().rev().copied().collect();
        let again = scene_from_cloud(PointCloud::from_points(points));
        let (camera, grid) = (
            again.intrinsics.expect("a camera"),
            again.cloud.grid.expect("a grid"),
        );
        assert!(again.cloud.num_finite() as f64 > 0.9 * grid.num_cells() as f64);
        for (i, p) in again.cloud.finite() {
            let (u, v) = camera.pixel_of(&p.cast()).expect("in front");
            assert!(
                (u - (i % grid.width) as f64).abs() <= 0.51
                    && (v - (i / grid.width) as f64).abs() <= 0.51
            );
        }
    }

    #[test]
    fn stray_points_zeros_and_copies_leave_the_picture_as_it_was() {
        let scene = scene_from_frame(&tilted_wall());
        let points: Vec<_> = scene.cloud.finite().map(|(_, p)| *p).collect();
        let arranged = |points: Vec<Point3<f32>>| {
            let scene = scene_from_cloud(PointCloud::from_points(points));
            let readings: Vec<_> = scene.cloud.finite().map(|(i, p)| (i, *p)).collect();
            (scene.cloud.grid, scene.intrinsics, readings)
        };
        let expected = arranged(points.clone());
        assert!(expected.0.is_some());
        let with = |num: usize, stray: [f32; 3]| {
            let strays = std::iter::repeat_n(Point3::from(stray), num);
            points.iter().copied().chain(strays).collect::<Vec<_>>()
        };
        for (num, stray) in [
            (1, [3.0, 0.0, 0.5]),
            (100, [0.0, -9.0, 0.5]),
            (1, [0.0, 0.0, -0.5]),
            (300, [0.1, 0.0, 0.03]),
            (100_000, [0.0; 3]),
        ] {
            assert!(arranged(with(num, stray)) == expected, "{num} of {stray:?}");
        }
        let twice = points.iter().chain(&points).copied().collect();
        assert!(arranged(twice) == expected, "every point twice");
        // Too many for stray points.
        for stray in [[3.0, 0.0, 0.5], [0.0, 0.0, -0.5]] {
            assert_eq!(arranged(with(1000, stray)).0, None, "{stray:?}");
        }
    }

    #[test]
    fn a_cloud_seen_from_all_around_stays_without_a_picture() {
        let points = (0..20_000).map(|i| {
            let (a, b) = (i as f32 * 0.0917, i as f32 / 20_000.0 * 2.0 - 1.0);
            let r = (1.0 - b * b).sqrt();
            Point3::new(0.3 * r * a.cos(), 0.3 * b, 1.5 + 0.3 * r * a.sin())
        });
        let scene = scene_from_cloud(PointCloud::from_points(points));
        assert_eq!((scene.cloud.grid, scene.intrinsics), (None, None));
    }

    #[test]
    fn a_sliver_thinner_than_any_number_is_no_picture() {
        for [across, down] in [
            [1e-42_f32, 1.0],
            [1.0, 1e-42],
            [1e-42, 1e-42],
            [1e-20, 1e-20],
        ] {
            let points = (0..2000).map(|i| {
                let along = |span: f32| span * (i % 40) as f32 / 40.0;
                Point3::new(along(across), along(down), 1.0)
            });
            let scene = scene_from_cloud(PointCloud::from_points(points));
            assert_eq!(
                (scene.cloud.grid, scene.fault),
                (None, None),
                "{across}, {down}"
            );
            assert_eq!(scene.cloud.points.len(), 2000);
        }
    }

    #[test]
    fn a_grid_that_no_camera_took_has_no_intrinsics() {
        let grid = Grid {
            width: 40,
            height: 30,
        };
        let points = (0..1200)
            .map(|i| Point3::new((i * 7 % 40) as f32, (i * 11 % 30) as f32, 1.0))
            .collect();
        let cloud = PointCloud {
            points,
            grid: Some(grid),
            ..PointCloud::default()
        };
        assert_eq!(scene_from_cloud(cloud).intrinsics, None);
    }

    #[test]
    fn files_changed_at_random_make_scenes_or_are_refused() {
        use rand::{RngExt as _, SeedableRng as _};

        let depth = (0..32 * 24_u16).map(|i| 900 + i % 400);
        let cloud = scene_from_frame(&geometry::fixtures::small_frame(32, depth)).cloud;
        let (mut pcd, mut ply) = (Vec::new(), Vec::new());
        files::write_pcd(&mut pcd, &cloud).expect("written");
        files::write_ply(&mut ply, &cloud).expect("written");
        let mut random = rand_pcg::Pcg64::seed_from_u64(5);
        let mut num_scenes = 0;
        for number in 0..2000 {
            let mut bytes = if number % 2 == 0 {
                pcd.clone()
            } else {
                ply.clone()
            };
            for _ in 0..random.random_range(1..=8) {
                let at = random.random_range(0..bytes.len());
                bytes[at] = random.random();
            }
            let opened = files::open_bytes("changed".as_ref(), &bytes);
            if let Ok(files::FileContent::Cloud(cloud)) = opened {
                let scene = scene_from_cloud(cloud);
                assert_eq!(scene.fault, None, "number {number}");
                num_scenes += 1;
            }
        }
        assert!(num_scenes > 500, "{num_scenes} scenes");
    }
}
