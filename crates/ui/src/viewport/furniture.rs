//! Lines that many views share: axes, the depth camera's frustum, the nozzle with its stand-off.

use glam::Vec3;

use super::{
    scene::{Line, LineSet, vec3},
    style::Role,
};
use geometry::{depth_frame::Intrinsics, units::Metres};

/// Makes the three axes of a frame, each of the given length; place them with [`LineSet::at`].
pub fn axes(length: Metres) -> LineSet {
    let arm = |direction: Vec3, role| {
        Line::new([Vec3::ZERO, direction * length.0 as f32], role).with_width(3.0)
    };
    LineSet::new([
        arm(Vec3::X, Role::AxisX),
        arm(Vec3::Y, Role::AxisY),
        arm(Vec3::Z, Role::AxisZ),
    ])
}

/// Makes the frustum of the depth camera at the origin, with its picture's edges at `depth`.
pub fn frustum(intrinsics: &Intrinsics, depth: Metres) -> LineSet {
    let corner = |u, v| vec3(&intrinsics.point_at(u, v, depth.0));
    // Pixel centres are at whole numbers: the picture begins half a pixel before the first.
    let (right, bottom) = (
        intrinsics.width as f64 - 0.5,
        intrinsics.height as f64 - 0.5,
    );
    let picture = [
        corner(-0.5, -0.5),
        corner(right, -0.5),
        corner(right, bottom),
        corner(-0.5, bottom),
    ];
    let mut lines: Vec<Line> = picture
        .iter()
        .map(|&at| Line::new([Vec3::ZERO, at], Role::Frustum).with_width(1.5))
        .collect();
    let closed: Vec<Vec3> = picture.into_iter().chain([picture[0]]).collect();
    lines.push(Line::new(closed, Role::Frustum).with_width(1.5));
    LineSet::new(lines)
}

/// Makes the edges of a box from its corners, of which two are joined if their indices differ in one bit.
pub fn box_edges(corners: [Vec3; 8], role: Role) -> impl Iterator<Item = Line> {
    let pairs = (0..8).flat_map(|i| [1, 2, 4].map(|bit| [i, i | bit]));
    let edges = pairs.filter(|[i, k]| i < k);
    edges.map(move |ends| Line::new(ends.map(|i| corners[i]), role))
}

/// Makes the spray nozzle as a cone of 24 sides with its tip at `mouth`, pointing along `direction`, and a dashed line for the
/// stand-off to the surface point `surface`.
pub fn nozzle(mouth: Vec3, direction: Vec3, surface: Vec3) -> LineSet {
    const SIDES: usize = 24;
    /// Length and half width of the drawn cone, metres: about a spray gun's air cap.
    const CONE: (f32, f32) = (0.06, 0.02);
    let direction = direction.try_normalize().unwrap_or(Vec3::Z);
    let (across, along) = direction.any_orthonormal_pair();
    let base = mouth - direction * CONE.0;
    let ring: Vec<Vec3> = (0..=SIDES)
        .map(|i| {
            let (sin, cos) = (i as f32 / SIDES as f32 * std::f32::consts::TAU).sin_cos();
            base + (across * cos + along * sin) * CONE.1
        })
        .collect();
    let sides = ring
        .iter()
        .step_by(SIDES / 4)
        .map(|&at| Line::new([mouth, at], Role::Nozzle));
    let mut lines: Vec<Line> = sides.take(4).collect();
    lines.push(Line::new(ring, Role::Nozzle));
    lines.push(Line::new([mouth, surface], Role::Nozzle).dashed());
    LineSet::new(lines)
}
