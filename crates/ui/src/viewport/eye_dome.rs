//! Eye-dome lighting: shades an uncoloured cloud from the depth buffer alone, so that its shape shows.
//!
//! A point cloud has no surface to light. Instead, each pixel is darkened by how far its neighbours lie in front of it: a step
//! in depth gets a dark line on its far side, a hollow turns dark, an open surface stays as it is. After C. Boucheny,
//! "Visualisation scientifique de grands volumes de données : pour une approche perceptive", doctoral thesis, Université
//! Joseph Fourier, Grenoble, 2009. As there, the shade falls off exponentially with the sum of the depth differences.
//! Deviations from the thesis: neighbours on two rings in one pass instead of one ring at several resolutions; differences are
//! a share of the depth, so that a shape is shaded alike near and far; they are clamped below (sensor noise) and above (all
//! edges alike); and a soft light from the upper left is added, with the normal from the slope of the depth over the same
//! neighbours, because a door is too smooth to occlude itself.

use eframe::wgpu;

use super::{
    pass::{self, PassSpec},
    targets::COLOUR_FORMAT,
};

/// Source of the shader.
pub(super) const SHADER: &str = concat!(include_str!("view.wgsl"), include_str!("eye_dome.wgsl"));

/// Makes the pipeline that shades the output of the point pass.
pub(super) fn pipeline(
    device: &wgpu::Device,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    pass::pipeline(
        device,
        &PassSpec {
            label: "view eye dome",
            source: SHADER,
            constants: &[],
            layouts,
            instances: None,
            topology: wgpu::PrimitiveTopology::TriangleList,
            targets: &[COLOUR_FORMAT.into()],
            depth: None,
        },
    )
}
