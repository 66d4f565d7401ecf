//! The surface that a shot sees: normal and possible use of every reading.
//!
//! The reciprocal of depth is linear over the picture of a plane, so a least-squares fit over pixels yields the plane through
//! a reading and its neighbours. Neighbours beyond a depth discontinuity are left out. A reading with too few neighbours on
//! its own surface, or on a surface seen nearly edge-on, is a flying pixel: the sensor mixed two depths. Readings beside a
//! discontinuity are real but uncertain: they are fused, but not used for registration.
//!
//! The standard deviation of a reading grows with depth², as for any triangulating sensor, and with 1/cos of the angle at
//! which the surface is seen (C. V. Nguyen, S. Izadi and D. Lovell, "Modeling Kinect sensor noise for improved 3D
//! reconstruction and tracking", 3DIMPVT 2012, also found growth towards grazing angles).

use std::sync::Arc;

use nalgebra::{Matrix3, Point3, Vector3};

use crate::{field_of_view::FieldOfView, scene::SceneCloud, segment::noise_of_picture};
use geometry::{cloud::is_finite, depth_frame::Intrinsics, units::Metres};

/// What a reading is good enough for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Use {
    /// No reading, or a flying pixel.
    #[default]
    None,
    /// On a surface, but beside a depth discontinuity: good enough for fusion.
    Edge,
    /// On a surface with neighbours all around: good enough for registration.
    Surface,
}

/// The readings of a shot with their normals, in camera space.
#[derive(Clone, Debug)]
pub struct ShotSurface {
    /// Size and optics of the picture.
    pub camera: Intrinsics,
    /// The frame itself.
    pub scene: Arc<SceneCloud>,
    /// What of the normals is kept; the rest is computed again where it is used.
    kept: KeptNormals,
    /// What each reading is good enough for.
    pub uses: Vec<Use>,
    /// Standard deviation of a reading's depth at 1 m.
    pub noise_at_1m: Metres,
    /// The region of the picture in which the camera delivers readings.
    pub field_of_view: Option<FieldOfView>,
    /// Number of readings good enough for registration.
    pub num_surface: usize,
}

/// What a shot keeps of its normals. It does not change what they are.
#[derive(Clone, Debug)]
enum KeptNormals {
    /// All of them, for registration, which looks them up many times; as much memory as the points.
    Normals(Vec<Vector3<f32>>),
    /// The cosines of the angles at which the camera sees the readings, for fusion.
    Cosines(Vec<f32>),
    /// Nothing, in an assembled scan.
    Nothing,
}

/// Noise at 1 m to assume if it cannot be measured in the picture.
const NOISE: Metres = Metres(0.0015);
/// Least standard deviation at 1 m, in metres: no depth camera is calibrated better, so that far points weigh less even if
/// they scatter little.
const MIN_NOISE_AT_1M: f64 = 0.001;
/// Window of the fit: pixels between neighbours, and neighbours on each side; 9 × 9 pixels with 25 readings.
const STEP: i64 = 2;
const SIDE: i64 = 2;
/// Readings whose depths differ by this share belong to two surfaces: a plane tilted by 75° changes by less over the window
/// of a 60° camera.
const JUMP: f32 = 0.025;
/// Neighbours on the same surface that a reading needs for fusion, and for registration.
const LEAST_FUSED: usize = 9;
const LEAST_REGISTERED: usize = 22;
/// Least cosine of the angle at which the surface is seen, for fusion (below it is a flying pixel) and for registration.
const LEAST_COSINE_FUSED: f64 = 0.17;
const LEAST_COSINE_REGISTERED: f64 = 0.3;

impl ShotSurface {
    /// Prepares a shot; `None` without rows and columns or without a camera.
    pub fn from_scene(scene: &Arc<SceneCloud>) -> Option<Self> {
        let camera = scene.intrinsics?;
        let grid = scene.cloud.grid?;
        let points = &scene.cloud.points;
        if points.len() != camera.width * camera.height || grid.width != camera.width {
            return None;
        }
        let mut normals = vec![Vector3::zeros(); points.len()];
        let mut uses = vec![Use::None; points.len()];
        // Each is used for all its neighbours.
        let per_z: Vec<f64> = points.iter().map(|p| 1.0 / f64::from(p.z)).collect();
        for row in 0..camera.height {
            for column in 0..camera.width {
                let i = row * camera.width + column;
                if let Some((normal, used)) = plane_at(&camera, points, |i| per_z[i], column, row) {
                    normals[i] = normal;
                    uses[i] = used;
                }
            }
        }
        Some(Self {
            camera,
            scene: Arc::clone(scene),
            kept: KeptNormals::Normals(normals),
            num_surface: uses.iter().filter(|u| **u == Use::Surface).count(),
            uses,
            field_of_view: scene.field_of_view().cloned(),
            noise_at_1m: noise_of_picture(scene).unwrap_or(NOISE),
        })
    }

    /// Keeps of the normals what fusion looks up many times: a third of the memory.
    pub(super) fn keep_cosines(&mut self) {
        let cosines = (0..self.points().len()).map(|i| self.cosine(i));
        self.kept = KeptNormals::Cosines(cosines.collect());
    }

    /// Keeps nothing of the normals.
    pub(super) fn drop_normals(&mut self) {
        self.kept = KeptNormals::Nothing;
    }

    /// Returns the unit normal towards the camera; zero where there is no use of the reading.
    pub fn normal(&self, i: usize) -> Vector3<f32> {
        if let KeptNormals::Normals(normals) = &self.kept {
            return normals[i];
        }
        let width = self.camera.width;
        let points = self.points();
        let per_z = |i: usize| 1.0 / f64::from(points[i].z);
        let plane = plane_at(&self.camera, points, per_z, i % width, i / width);
        plane.map_or_else(Vector3::zeros, |(normal, _)| normal)
    }

    /// Returns the cosine of the angle at which the camera sees a reading.
    fn cosine(&self, i: usize) -> f32 {
        if let KeptNormals::Cosines(cosines) = &self.kept {
            return cosines[i];
        }
        let p = &self.points()[i].coords;
        -self.normal(i).dot(p) / p.norm()
    }

    /// Returns the points, row by row; NaN where there is no reading.
    pub fn points(&self) -> &[Point3<f32>] {
        &self.scene.cloud.points
    }

    /// Returns the standard deviation of a reading along its surface's normal, in metres.
    pub(super) fn sigma(&self, i: usize) -> f64 {
        let z = f64::from(self.points()[i].z);
        let cosine = f64::from(self.cosine(i));
        self.noise_at_1m.0.max(MIN_NOISE_AT_1M) * z * z / cosine.max(0.1)
    }

    /// Returns column and row of the pixel that shows a camera point; `None` outside the picture.
    pub fn pixel(&self, at: &Point3<f64>) -> Option<(i64, i64)> {
        let (u, v) = self.camera.pixel_of(at)?;
        // The cast truncates, so adding a half rounds.
        let (u, v) = (u + 0.5, v + 0.5);
        let is_inside =
            u >= 0.0 && v >= 0.0 && u < self.camera.width as f64 && v < self.camera.height as f64;
        is_inside.then_some((u as i64, v as i64))
    }

    /// Returns the index of the reading at a column and row; `None` outside the picture or without a reading.
    pub fn reading(&self, column: i64, row: i64) -> Option<usize> {
        let i = self.place(column, row)?;
        is_finite(&self.points()[i]).then_some(i)
    }

    /// Returns the index of the reading at a column and row that is good enough for registration.
    pub(super) fn surface_reading(&self, column: i64, row: i64) -> Option<usize> {
        let i = self.place(column, row)?;
        (self.uses[i] == Use::Surface).then_some(i)
    }

    fn place(&self, column: i64, row: i64) -> Option<usize> {
        let is_inside = column >= 0
            && row >= 0
            && column < self.camera.width as i64
            && row < self.camera.height as i64;
        is_inside.then(|| row as usize * self.camera.width + column as usize)
    }
}

/// Fits the normal at a reading and decides its use; `None` for a flying pixel, and where there is no reading. `per_z` is
/// 1/z of a reading.
fn plane_at(
    camera: &Intrinsics,
    points: &[Point3<f32>],
    per_z: impl Fn(usize) -> f64,
    column: usize,
    row: usize,
) -> Option<(Vector3<f32>, Use)> {
    let middle = points[row * camera.width + column];
    if !is_finite(&middle) {
        return None;
    }
    let middle_per_z = per_z(row * camera.width + column);
    // Sums of the least-squares fit of 1/z - 1/z₀ = a·du + b·dv + c, over the readings on the same surface.
    let (mut num, mut su, mut sv, mut suu, mut suv, mut svv) =
        (0_usize, 0.0, 0.0, 0.0, 0.0, 0.0_f64);
    let (mut sw, mut suw, mut svw) = (0.0, 0.0, 0.0_f64);
    for dv in -SIDE..=SIDE {
        let v = row as i64 + dv * STEP;
        if v < 0 || v >= camera.height as i64 {
            continue;
        }
        for du in -SIDE..=SIDE {
            let u = column as i64 + du * STEP;
            if u < 0 || u >= camera.width as i64 {
                continue;
            }
            let i = v as usize * camera.width + u as usize;
            let z = points[i].z;
            // False without a reading, too.
            if !((z - middle.z).abs() < JUMP * middle.z) {
                continue;
            }
            let (u, v) = ((du * STEP) as f64, (dv * STEP) as f64);
            let w = per_z(i) - middle_per_z;
            num += 1;
            su += u;
            sv += v;
            suu += u * u;
            suv += u * v;
            svv += v * v;
            sw += w;
            suw += u * w;
            svw += v * w;
        }
    }
    if num < LEAST_FUSED {
        return None;
    }
    let matrix = Matrix3::new(suu, suv, su, suv, svv, sv, su, sv, num as f64);
    let [a, b, c] = (matrix.try_inverse()? * Vector3::new(suw, svw, sw)).into();
    let at_axis = middle_per_z + c - a * (column as f64 - camera.cx) - b * (row as f64 - camera.cy);
    let normal = -Vector3::new(a * camera.fx, b * camera.fy, at_axis).try_normalize(1e-12)?;
    let ray = middle.coords.cast::<f64>();
    let cosine = -normal.dot(&ray) / ray.norm();
    if !(cosine > LEAST_COSINE_FUSED) {
        return None;
    }
    let used = if num >= LEAST_REGISTERED && cosine > LEAST_COSINE_REGISTERED {
        Use::Surface
    } else {
        Use::Edge
    };
    Some((normal.cast(), used))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::scene_from_frame;
    use geometry::depth_frame::DepthFrame;

    /// A board 1 m away, turned by some 30°, in front of a wall 2 m away.
    fn board_before_wall() -> (SceneCloud, Vector3<f64>) {
        let camera = Intrinsics::KINECT;
        let normal = Vector3::new(0.5, 0.1, -0.86).normalize();
        let depth = (0..camera.width * camera.height).map(|i| {
            let (u, v) = ((i % camera.width) as f64, (i / camera.width) as f64);
            let ray = camera.point_at(u, v, 1.0).coords;
            let is_board = (200.0..440.0).contains(&u) && (140.0..340.0).contains(&v);
            let z = if is_board {
                -normal.z / -normal.dot(&ray)
            } else {
                2.0
            };
            (z / 0.0001).round() as u16
        });
        let frame = DepthFrame {
            intrinsics: camera,
            metres_per_unit: 0.0001,
            depth: depth.collect(),
            is_simulated: true,
        };
        (scene_from_frame(&frame), normal)
    }

    #[test]
    fn a_tilted_board_has_its_own_normal_and_its_rim_is_not_registered_with() {
        let (scene, normal) = board_before_wall();
        let surface = ShotSurface::from_scene(&Arc::new(scene)).expect("a picture");
        let at = |column: usize, row: usize| row * 640 + column;
        let inside = at(320, 240);
        assert_eq!(surface.uses[inside], Use::Surface);
        let off = surface.normal(inside).cast::<f64>().angle(&normal);
        assert!(off.to_degrees() < 0.5, "off by {}", off.to_degrees());
        assert_eq!(surface.uses[at(201, 240)], Use::Edge);
        let rim = surface.normal(at(201, 240)).cast::<f64>().angle(&normal);
        assert!(rim.to_degrees() < 2.0, "off by {}", rim.to_degrees());
    }

    #[test]
    fn readings_between_two_surfaces_are_flying_pixels() {
        let (mut scene, _) = board_before_wall();
        let camera = Intrinsics::KINECT;
        // A column of readings between board and wall, as from a sensor that mixes both depths.
        for row in 150..330 {
            let z = 1.5 + 0.01 * f64::from(row % 7);
            let p = camera.point_at(199.0, f64::from(row), z);
            scene.cloud.points[row as usize * 640 + 199] = p.cast();
        }
        let surface = ShotSurface::from_scene(&Arc::new(scene)).expect("a picture");
        assert!((150..330).all(|row| surface.uses[row * 640 + 199] == Use::None));
    }

    #[test]
    fn a_surface_seen_further_away_or_edge_on_is_less_certain() {
        let (scene, _) = board_before_wall();
        let surface = ShotSurface::from_scene(&Arc::new(scene)).expect("a picture");
        let (board, wall) = (
            surface.sigma(240 * 640 + 320),
            surface.sigma(20 * 640 + 320),
        );
        assert!(wall > 3.0 * board, "{wall} {board}");
    }

    #[test]
    fn normals_are_the_same_to_the_bit_whatever_is_kept_of_them() {
        let (scene, _) = board_before_wall();
        let kept = ShotSurface::from_scene(&Arc::new(scene)).expect("a picture");
        let (mut cosines, mut dropped) = (kept.clone(), kept.clone());
        cosines.keep_cosines();
        dropped.drop_normals();
        let num_bytes = |surface: &ShotSurface| match &surface.kept {
            KeptNormals::Normals(all) => size_of_val(all.as_slice()),
            KeptNormals::Cosines(all) => size_of_val(all.as_slice()),
            KeptNormals::Nothing => 0,
        };
        let found = [&kept, &cosines, &dropped].map(num_bytes);
        assert_eq!(found, [12, 4, 0].map(|each| each * 640 * 480));
        let bits = |surface: &ShotSurface, i: usize| {
            let normal = surface.normal(i);
            let normal = [normal.x, normal.y, normal.z].map(f32::to_bits);
            (normal, surface.sigma(i).to_bits())
        };
        let used = (0..640 * 480).filter(|i| kept.uses[*i] != Use::None);
        let used: Vec<usize> = used.step_by(7).collect();
        assert!(used.len() > 30_000, "{} readings", used.len());
        for i in used {
            assert_eq!(bits(&cosines, i), bits(&kept, i));
            assert_eq!(bits(&dropped, i), bits(&kept, i));
        }
    }

    #[test]
    fn a_cloud_without_a_picture_has_no_surface() {
        assert!(ShotSurface::from_scene(&Arc::default()).is_none());
    }
}
