//! Eye-dome lighting: gives an uncoloured cloud its shape, from nothing but the depth buffer.
//!
//! A point cloud has no surface to light. Instead, each pixel is darkened by how far its neighbours stand before it:
//! a step in depth gets a dark line on its far side, a hollow turns dark, an open surface stays as it is. After C.
//! Boucheny, "Visualisation scientifique de grands volumes de données : pour une approche perceptive", doctoral thesis,
//! Université Joseph Fourier, Grenoble, 2009. As he has it, the shade falls off exponentially with the sum of what
//! stands in front. Our deviations: neighbours on two rings in one pass in place of one ring at several resolutions;
//! differences count as a share of the depth, so that the same shape shades alike near and far; they are cut below (the
//! sensor's noise) and above (an edge is an edge); and a soft light from the upper left is added, on the normal that
//! the slope of the depth over the same neighbours gives, because a door is too smooth to occlude itself.

use eframe::wgpu;

use super::{
    pass::{self, PassSpec},
    targets::COLOUR_FORMAT,
};

/// The text of the shader.
pub(super) const SHADER: &str = concat!(include_str!("view.wgsl"), include_str!("eye_dome.wgsl"));

/// The pass that shades what the point pass has drawn.
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
