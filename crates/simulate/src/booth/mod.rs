//! A paint booth: a depth camera on the robot's flange looks at a part on a stand of tubes.
//!
//! Modelled on depth frames of a real paint shop. It is harder than the plain cell: the picture often cuts the part,
//! readings end inside the picture, tubes and clamps touch the part, and walls have ribs, frames and columns.
//!
//! ```text
//! flange ─► camera_from_part, camera_from_world ─┬─► trestle ─┐
//! field_of_view ─┐                               └─► walls ───┴─► Cell ─► Rendering ─┐
//! gloss ─────────┴─► registered_camera ────────────────────────────────────────────► DepthFrame
//! ```
//!
//! World space: origin at the camera, x level, y down, z level and away from the camera.

mod arrange;
mod field_of_view;
mod flange;
mod gloss;
mod registered_camera;
mod trestle;
mod walls;

pub(super) use arrange::{CAMERA, arrange};

#[cfg(test)]
mod tests;
