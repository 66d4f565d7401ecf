//! The 3-D view: point clouds, lines and labels, moved and measured with the mouse.
//!
//! ```text
//! ViewScene   what is shown: PointSet, LineSet, TextLabel   scene, furniture   (data, made by the caller)
//! ViewStyle   how it looks: colours by role, scales, sizes   style              (data, from the theme)
//! ViewCamera  from where                                     camera             (pure; share it to link views)
//!     │
//!     ▼
//! Viewport::ui ─► ViewportResponse: picked, drawn             widget, navigation, picking, drawing, measure, legend
//!     │
//!     ▼
//! points ─► eye dome ─► lines ─► picture ─► window           renderer and one file per pass, each with its .wgsl
//! ```
//!
//! A view at rest costs one copy of its finished picture: it is redrawn only when camera, scene, style or size change, and
//! points are uploaded only for a set not seen before.
//!
//! | with | does |
//! | --- | --- |
//! | left drag, arrow keys | rotate; with a box or lasso as the tool a left drag draws it |
//! | right, middle or Shift + left drag, Shift + arrow keys, two fingers | pan |
//! | wheel, pinch, + and − | zoom at the cursor |
//! | F, Shift + F | fit the part, fit everything |
//! | Z, Y, X | look along that axis: front, top, side |
//! | M, Esc | measure between two clicked points, stop measuring |
//!
//! Keys go to the focused view, or to the one under the pointer if nothing has the focus.

pub mod bounds;
pub mod camera;
mod composite;
mod detail;
mod direction;
pub mod drawing;
mod eye_dome;
pub mod furniture;
mod gpu;
mod legend;
mod lines;
mod measure;
mod navigation;
mod pass;
mod picking;
mod points;
mod renderer;
pub mod scene;
mod screenshot;
pub mod style;
mod targets;
mod uniform;
mod widget;

pub use self::{
    camera::{FitRequest, StandardView, ViewCamera},
    direction::ViewDirection,
    drawing::{Drawing, DrawnShape, seen_at},
    gpu::{ViewError, ViewportGpu},
    legend::colour_keys,
    measure::Measurement,
    picking::PickedPoint,
    scene::{Line, LineSet, PointSet, TextLabel, ViewScene, vec3},
    screenshot::ViewShot,
    style::{Colouring, Legend, Role, RoleColour, ScaleWords, ViewColours, ViewStyle},
    widget::{ViewTool, Viewport, ViewportResponse},
};

#[cfg(test)]
mod shader_tests;
