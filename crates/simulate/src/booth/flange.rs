//! Pose of the camera on the robot's flange: rolled, tilted, and so near that the picture often cuts the part.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt as _};
use rand_pcg::Pcg64;

use super::field_of_view::FieldOfView;
use crate::{
    assembly::middle_of_box,
    rasteriser::{Rendering, SurfaceLabel},
};
use geometry::{
    depth_frame::Intrinsics, distortion::Distortion, mesh::TriangleMesh, rigid::RigidTransform,
};

/// Depth of the part's middle, in metres.
const DISTANCE_M: std::ops::Range<f64> = 0.8..1.5;
/// Least depth of any point of the part, in metres: the sensor's range begins at half a metre.
const NEAREST_M: f64 = 0.52;
/// Share of a cut part that stays in the picture.
const CUT_SHARE: std::ops::Range<f64> = 0.27..1.0;
/// Share of frames that show the whole part, if it fits.
const WHOLE: f64 = 0.25;
/// Largest rotation of the part about its x and y axes relative to the camera, in radians.
const MAX_TURN_RAD: f64 = 0.52;

/// Orientation of camera and part.
pub(super) struct Flange {
    pub(super) camera_from_world: UnitQuaternion<f64>,
    /// The rotation alone.
    pub(super) camera_from_part: UnitQuaternion<f64>,
}

impl Flange {
    pub(super) fn draw(random: &mut Pcg64) -> Self {
        let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        let roll = drawn_roll(random);
        // Straight ahead, or looking down.
        let looks_down = if random.random_bool(0.3) {
            random.random_range(-0.05..0.12)
        } else {
            random.random_range(0.0..0.87)
        };
        let roll_of_camera = about(Vector3::z_axis(), roll);
        let camera_from_world = roll_of_camera * about(Vector3::x_axis(), looks_down);
        // A part leans on its stand so that it faces the robot, upright or on another edge.
        let mounted = if random.random_bool(0.7) {
            random.random_range(-0.2..0.2)
        } else {
            drawn_roll(random)
        };
        let pitch = random.random_range(-MAX_TURN_RAD..MAX_TURN_RAD);
        let yaw = random.random_range(-MAX_TURN_RAD..MAX_TURN_RAD);
        let camera_from_part = about(Vector3::z_axis(), roll + mounted)
            * about(Vector3::x_axis(), pitch)
            * about(Vector3::y_axis(), yaw);
        Self {
            camera_from_world,
            camera_from_part,
        }
    }

    /// Places the part in front of the camera: all of it in the field of view, or cut to a drawn share.
    ///
    /// `seen` are points of its surface, rotated like the part, about its origin.
    pub(super) fn place(
        &self,
        seen: &[Point3<f64>],
        field: &FieldOfView,
        camera: &Intrinsics,
        random: &mut Pcg64,
    ) -> RigidTransform {
        let nearest = seen.iter().map(|p| p.z).fold(0.0, f64::min);
        let mut distance = f64::max(random.random_range(DISTANCE_M), NEAREST_M - nearest);
        let is_whole = random.random_bool(WHOLE);
        let cut_share = random.random_range(CUT_SHARE);
        let wished = if is_whole { 0.999 } else { cut_share };
        let direction = random.random_range(-PI..PI);
        let how_far = random.random::<f64>();
        let (sin, cos) = f64::sin_cos(direction);

        // Start with the middle of the visible points in the middle of the field of view.
        let [middle_u, middle_v] = field.middle(camera);
        let centred = |distance: f64| {
            let aim = camera.point_at(middle_u, middle_v, distance);
            let middle = middle_of_box(seen);
            Vector3::new(aim.x - middle.x, aim.y - middle.y, distance)
        };
        let share = |shift: &Vector3<f64>| {
            let is_inside = |p: &&Point3<f64>| {
                let p = *p + shift;
                let pixel = camera.pixel_of(&p);
                pixel.is_some_and(|(u, v)| is_in_picture(camera, u, v) && field.contains(u, v, p.z))
            };
            seen.iter().filter(is_inside).count() as f64 / seen.len().max(1) as f64
        };
        while distance < DISTANCE_M.end
            && share(&centred(distance)) < CUT_SHARE.start.max(0.9 * wished)
        {
            distance += 0.05;
        }
        let start = centred(distance);
        let shifted = |by: f64| start + Vector3::new(cos, sin, 0.0) * by;
        let (mut low, mut high) = (0.0, 2.0);
        for _ in 0..11 {
            let middle = f64::midpoint(low, high);
            if share(&shifted(middle)) >= wished {
                low = middle;
            } else {
                high = middle;
            }
        }
        // A cut part is cut to the drawn share; a whole one is placed anywhere up to the border.
        let by = if is_whole { how_far * low } else { low };
        RigidTransform::from_parts(Translation3::from(shifted(by)), self.camera_from_part)
    }
}

/// Draws a roll: upright, on either side or upside down with some scatter, or any other.
fn drawn_roll(random: &mut impl Rng) -> f64 {
    if random.random_bool(0.2) {
        return random.random_range(-PI..PI);
    }
    let quarters = match random.random_range(0..20) {
        0..11 => 0.0,
        11..15 => 1.0,
        15..19 => -1.0,
        _ => 2.0,
    };
    quarters * FRAC_PI_2 + random.random_range(-0.14..0.14)
}

fn is_in_picture(camera: &Intrinsics, u: f64, v: f64) -> bool {
    u >= 0.0 && v >= 0.0 && u < camera.width as f64 && v < camera.height as f64
}

/// Returns points of the surface that a camera sees of a rotated part, even over the picture, about the part's origin.
pub(super) fn seen_surface(
    part: &TriangleMesh,
    camera_from_part: &UnitQuaternion<f64>,
) -> Vec<Point3<f64>> {
    const DEPTH: f64 = 1.2;
    // Wide enough for every part, and so coarse that a few thousand points remain.
    let small = Intrinsics {
        width: 200,
        height: 200,
        fx: 90.0,
        fy: 90.0,
        cx: 99.5,
        cy: 99.5,
        distortion: Distortion::NONE,
    };
    let pose = RigidTransform::from_parts(Translation3::new(0.0, 0.0, DEPTH), *camera_from_part);
    let mut rendering = Rendering::new(small);
    rendering.draw_mesh(part, &pose, SurfaceLabel::Part);
    let hit = rendering.labels.iter().zip(&rendering.depth).enumerate();
    hit.filter(|(_, (label, _))| **label == SurfaceLabel::Part)
        .map(|(pixel, (_, &z))| {
            let (u, v) = (pixel % small.width, pixel / small.width);
            small.point_at(u as f64, v as f64, f64::from(z)) - Vector3::z() * DEPTH
        })
        .collect()
}
