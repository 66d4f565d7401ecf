//! The camera of the 3-D view: where it stands, how it moves, and how it maps the world to the screen.
//!
//! Pure arithmetic: it takes screen positions and depends on neither egui nor wgpu.
//!
//! The world of the view is the `camera` frame of the product (x right, y down, z forward), so *up* is −y:
//!
//! ```text
//!        up = −y                       yaw 0, pitch 0 is what the depth camera sees (front):
//!          │   z forward                 yaw   turns about up; grows with a drag to the right
//!          │  ╱                          pitch tilts; above 0 the eye looks down
//!  camera  ●╱────── x right            eye = target − distance · forward
//!          │
//!          y down
//! ```
//!
//! The depth is reversed and has no far plane: 1 at the near plane, 0 at infinity, so that `f32` resolves distant things as
//! well as near ones (Reed, "Depth precision visualized", 2015).

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat4, Vec2, Vec3, camera::rh};

use super::bounds::PointBounds;

/// Vertical field of view, close to a Kinect's 43° × 57°, so that the front view looks like the frame.
const VERTICAL_FOV: f32 = 45.0 * PI / 180.0;
/// Rotation for a drag over the whole height of the view: half a turn, so that any side is one drag away.
const TURN_PER_HEIGHT: f32 = PI;
/// Near plane as a share of the distance to the target: small enough to look past a nozzle close to the eye.
const NEAR_PER_DISTANCE: f32 = 0.02;
/// Smallest and largest distance from eye to target, metres: from a screw head to a whole hall.
const DISTANCE_RANGE: (f32, f32) = (0.01, 200.0);
/// Free margin around a fitted box, as a share of the view.
const FIT_MARGIN: f32 = 0.08;

/// Width and height of the view, logical pixels.
pub type ViewSize = Vec2;

/// A standard direction of view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandardView {
    /// As the depth camera sees the scene.
    Front,
    /// From above, with the camera's right on the right.
    Top,
    /// From the camera's right-hand side, with the far side on the right.
    Side,
}

/// What the next view shown is to be fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitRequest {
    /// The part if the scene has one, else everything.
    Focus,
    /// Everything, background included.
    Everything,
}

/// The camera of one view, or of several linked views that share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewCamera {
    /// The point looked at and rotated about, world, metres.
    target: Vec3,
    /// Distance from eye to target, metres.
    distance: f32,
    /// Rotation about up, radians, −π..π.
    yaw: f32,
    /// Tilt, radians, −π/2..π/2; above 0 the eye looks down.
    pitch: f32,
    /// Kept until a view has something to fit to.
    pending_fit: Option<FitRequest>,
    /// True from a fit until a person turns, shifts or zooms.
    is_fitted: bool,
}

impl Default for ViewCamera {
    /// Returns the front view, to be fitted to the first scene shown.
    fn default() -> Self {
        Self {
            target: Vec3::new(0.0, 0.0, 1.5),
            distance: 1.5,
            yaw: 0.0,
            pitch: 0.0,
            pending_fit: Some(FitRequest::Focus),
            is_fitted: false,
        }
    }
}

impl ViewCamera {
    /// The point looked at and rotated about, world, metres.
    pub fn target(&self) -> Vec3 {
        self.target
    }

    /// Distance from eye to target, metres.
    pub fn distance(&self) -> f32 {
        self.distance
    }

    /// Position of the eye, world, metres.
    pub fn eye(&self) -> Vec3 {
        self.target - self.distance * self.forward()
    }

    /// Unit viewing direction, world.
    pub fn forward(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch)
    }

    /// Unit direction to the right of the screen, world. Always level, even when looking straight down.
    pub fn right(&self) -> Vec3 {
        Vec3::new(self.yaw.cos(), 0.0, -self.yaw.sin())
    }

    /// Unit direction to the top of the screen, world.
    pub fn up(&self) -> Vec3 {
        self.right().cross(self.forward())
    }

    /// Orbits about the target; `drag` is the pointer's motion in logical pixels, y down.
    pub fn orbit(&mut self, drag: Vec2, size: ViewSize) {
        let turn = drag * (TURN_PER_HEIGHT / size.y.max(1.0));
        self.turn(turn.x, turn.y);
    }

    /// Orbits about the target by angles in radians: `right` about up, `down` towards looking from above.
    pub fn turn(&mut self, right: f32, down: f32) {
        self.change(|camera| {
            camera.yaw = (camera.yaw + right + PI).rem_euclid(2.0 * PI) - PI;
            camera.pitch = (camera.pitch + down).clamp(-FRAC_PI_2, FRAC_PI_2);
        });
    }

    /// Shifts eye and target so that the target plane follows the pointer's motion `drag`, logical pixels.
    pub fn pan(&mut self, drag: Vec2, size: ViewSize) {
        let metres_per_pixel = self.distance / focal(size);
        self.change(|camera| {
            camera.target += (camera.up() * drag.y - camera.right() * drag.x) * metres_per_pixel;
        });
    }

    /// Zooms in by `factor` (above 1) or out (below 1), keeping the point under the cursor in place.
    ///
    /// The eye moves along the ray through the cursor, so this holds at any depth.
    pub fn zoom_at(&mut self, factor: f32, cursor: Vec2, size: ViewSize) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        let (least, most) = DISTANCE_RANGE;
        let distance = (self.distance / factor).clamp(least, most);
        let shrink = distance / self.distance;
        let on_target_plane = self.eye() + self.ray(cursor, size) * self.distance;
        self.change(|camera| {
            camera.target = on_target_plane + (camera.target - on_target_plane) * shrink;
            camera.distance = distance;
        });
    }

    /// Turns to a standard direction, keeping target and distance.
    pub fn look(&mut self, view: StandardView) {
        let (yaw, pitch) = match view {
            StandardView::Front => (0.0, 0.0),
            StandardView::Top => (0.0, FRAC_PI_2),
            StandardView::Side => (-FRAC_PI_2, 0.0),
        };
        (self.yaw, self.pitch) = (yaw, pitch);
    }

    /// Moves eye and target, without turning, so that the box just fills the view.
    pub fn fit(&mut self, bounds: &PointBounds, size: ViewSize) {
        let (right, up, forward) = (self.right(), self.up(), self.forward());
        let half = size / (2.0 * focal(size)) * (1.0 - FIT_MARGIN);
        let centre = bounds.centre();
        // At distance d a corner has depth d + z; it is inside the view if |x| ≤ half.x · (d + z).
        let needed = bounds.corners().map(|corner| {
            let offset = corner - centre;
            let (x, y, z) = (offset.dot(right), offset.dot(up), offset.dot(forward));
            (x.abs() / half.x).max(y.abs() / half.y) - z
        });
        let (least, most) = DISTANCE_RANGE;
        let distance = needed.fold(least, f32::max).min(most);
        self.change(|camera| {
            camera.target = centre;
            camera.distance = distance;
            camera.pending_fit = None;
        });
        self.is_fitted = true;
    }

    /// True if nobody has turned, shifted or zoomed since the last fit.
    pub fn is_fitted(&self) -> bool {
        self.is_fitted
    }

    /// Requests a fit by the next view shown, so that the caller need not know its size.
    pub fn request_fit(&mut self, request: FitRequest) {
        self.pending_fit = Some(request);
    }

    /// The fit that was requested and not yet done.
    pub fn pending_fit(&self) -> Option<FitRequest> {
        self.pending_fit
    }

    /// Distance of the near plane from the eye, metres.
    pub fn near(&self) -> f32 {
        self.distance * NEAR_PER_DISTANCE
    }

    /// Transform from world to clip space; the depth is `near / z`, with z in metres along the viewing direction.
    pub fn clip_from_world(&self, size: ViewSize) -> Mat4 {
        let view = rh::view::look_to_mat4(self.eye(), self.forward(), self.up());
        let aspect = size.x.max(1.0) / size.y.max(1.0);
        rh::proj::directx::perspective_infinite_reverse(VERTICAL_FOV, aspect, self.near()) * view
    }

    /// Projects a world point to logical pixels from the top left, y down; `None` if it is nearer than the near plane.
    pub fn screen_from_world(&self, point: Vec3, size: ViewSize) -> Option<Vec2> {
        let offset = point - self.eye();
        let z = offset.dot(self.forward());
        (z > self.near()).then(|| {
            let seen = Vec2::new(offset.dot(self.right()), -offset.dot(self.up())) / z;
            size / 2.0 + seen * focal(size)
        })
    }

    /// Direction through a screen position, world; its component along the viewing direction is one metre.
    pub fn ray(&self, cursor: Vec2, size: ViewSize) -> Vec3 {
        let seen = (cursor - size / 2.0) / focal(size);
        self.forward() + self.right() * seen.x - self.up() * seen.y
    }

    /// Applies a change, unless it makes the camera non-finite.
    fn change(&mut self, apply: impl FnOnce(&mut Self)) {
        let before = *self;
        apply(self);
        self.is_fitted = false;
        if !(self.target.is_finite() && self.distance.is_finite()) {
            *self = before;
        }
    }
}

/// Focal length: logical pixels per metre at a distance of one metre.
pub fn focal(size: ViewSize) -> f32 {
    size.y.max(1.0) / (2.0 * (VERTICAL_FOV / 2.0).tan())
}

#[cfg(test)]
mod tests;
