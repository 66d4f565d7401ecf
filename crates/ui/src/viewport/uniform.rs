//! Values shared by all shaders of one view: sizes, ranges and the colours of the theme.

use bytemuck::{Pod, Zeroable};
use egui::Color32;

use super::{
    camera::{ViewCamera, ViewSize, focal},
    style::{Role, SCALE_STOPS, ViewStyle},
};

/// Opacity of a line behind a surface: visible, but not mistaken for one in front.
const HIDDEN_LINE_OPACITY: f32 = 0.4;

/// `View` in view.wgsl, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct ViewUniform {
    size: [f32; 2],
    height_range: [f32; 2],
    pixels_per_point: f32,
    focal: f32,
    near: f32,
    eye_dome: f32,
    deviation_range: f32,
    hidden_line_opacity: f32,
    padding: [f32; 2],
    background: [f32; 4],
    roles: [[f32; 4]; Role::ALL.len()],
    height_scale: [[f32; 4]; SCALE_STOPS],
    deviation_scale: [[f32; 4]; SCALE_STOPS],
}

impl ViewUniform {
    /// `size` in logical pixels, `target` in physical ones, `height_range` in metres above the camera.
    pub(super) fn new(
        camera: &ViewCamera,
        style: &ViewStyle,
        height_range: [f32; 2],
        size: ViewSize,
        target: [u32; 2],
    ) -> Self {
        let colours = &style.colours;
        let pixels_per_point = target[1] as f32 / size.y.max(1.0);
        Self {
            size: target.map(|side| side as f32),
            height_range,
            pixels_per_point,
            focal: focal(size) * pixels_per_point,
            near: camera.near(),
            eye_dome: style.eye_dome,
            deviation_range: (style.deviation_range.0 as f32).max(1e-9),
            hidden_line_opacity: HIDDEN_LINE_OPACITY,
            padding: [0.0; 2],
            background: rgba(colours.background),
            roles: colours.roles.map(|role| {
                let [red, green, blue, _] = rgba(role.colour);
                [red, green, blue, role.weight]
            }),
            height_scale: colours.height_scale.map(rgba),
            deviation_scale: colours.deviations(style.scale_words).map(rgba),
        }
    }
}

/// sRGB values 0..1: the view is drawn in the same space as egui's own colours.
fn rgba(colour: Color32) -> [f32; 4] {
    colour.to_array().map(|channel| f32::from(channel) / 255.0)
}
