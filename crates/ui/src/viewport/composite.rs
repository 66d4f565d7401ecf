//! The pass that draws the finished picture of a view into egui's own pass.

use bytemuck::{Pod, Zeroable};
use eframe::wgpu;

use super::pass::{self, PassSpec};

/// Source of the shader.
pub(super) const SHADER: &str = include_str!("composite.wgsl");

/// `CompositeUniform` in composite.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct CompositeUniform {
    origin: [i32; 2],
    pixel_side: u32,
    padding: u32,
}

/// Size of the uniform in bytes, to be compared with the shader's.
#[cfg(test)]
pub(super) const PLACEMENT_SIZE: usize = size_of::<CompositeUniform>();

/// The pass, for one format of the window.
pub(super) struct Composite {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

/// A picture bound for this pass.
pub(super) struct BoundPicture {
    placement: wgpu::Buffer,
    written: Option<CompositeUniform>,
    group: wgpu::BindGroup,
}

impl BoundPicture {
    /// Sets the picture's top left corner in the window, physical pixels, and the side of one of its pixels in window pixels.
    pub(super) fn place(&mut self, queue: &wgpu::Queue, origin: [i32; 2], pixel_side: u32) {
        let placement = CompositeUniform {
            origin,
            pixel_side,
            padding: 0,
        };
        if self.written != Some(placement) {
            queue.write_buffer(&self.placement, 0, bytemuck::bytes_of(&placement));
            self.written = Some(placement);
        }
    }
}

impl Composite {
    pub(super) fn new(device: &wgpu::Device, window_format: wgpu::TextureFormat) -> Self {
        let layout = pass::layout(device, "view composite", &[pass::PICTURE, pass::UNIFORM]);
        let pipeline = pass::pipeline(
            device,
            &PassSpec {
                label: "view composite",
                source: SHADER,
                constants: &[("is_linear", f64::from(u8::from(window_format.is_srgb())))],
                layouts: &[&layout],
                instances: None,
                topology: wgpu::PrimitiveTopology::TriangleList,
                targets: &[window_format.into()],
                depth: None,
            },
        );
        Self { layout, pipeline }
    }

    pub(super) fn bind(&self, device: &wgpu::Device, picture: &wgpu::TextureView) -> BoundPicture {
        let placement = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view placement"),
            size: size_of::<CompositeUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let resources = [
            wgpu::BindingResource::TextureView(picture),
            placement.as_entire_binding(),
        ];
        BoundPicture {
            group: pass::bind(device, "view composite", &self.layout, &resources),
            placement,
            written: None,
        }
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'static>, picture: &BoundPicture) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &picture.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
