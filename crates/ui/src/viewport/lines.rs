//! Lines on the GPU: each line set is uploaded once as a buffer of segments; this pass draws them.
//!
//! A segment is one instance, widened on the screen to its width in pixels, with a smooth edge. It is compared with the depth
//! of the points and drawn faintly where a surface hides it, so that axes inside a part can be found.
//!
//! Known limits: lines do not hide one another, and the dashes of a polyline start anew at each corner.

use bytemuck::{Pod, Zeroable};
use eframe::wgpu::{self, util::DeviceExt as _};
use glam::Mat4;

use super::{
    pass::{self, PassSpec},
    scene::LineSet,
    targets::COLOUR_FORMAT,
};

/// Source of the shader.
pub(super) const SHADER: &str = concat!(include_str!("view.wgsl"), include_str!("lines.wgsl"));

/// `DASHED` in lines.wgsl.
const DASHED: u32 = 1 << 8;

/// `GpuSegment` in lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct GpuSegment {
    start: [f32; 3],
    width: f32,
    end: [f32; 3],
    role_and_stroke: u32,
}

/// `Lines` in lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct LinesUniform {
    pub(super) clip_from_set: Mat4,
}

/// The uploaded segments of one set.
pub(super) struct GpuLines {
    buffer: wgpu::Buffer,
    num_segments: u32,
}

impl GpuLines {
    /// Copies a set to the GPU, skipping segments with a non-finite end.
    pub(super) fn upload(device: &wgpu::Device, set: &LineSet) -> Self {
        let segments: Vec<GpuSegment> = set
            .lines()
            .iter()
            .flat_map(|line| {
                let dashed = if line.is_dashed { DASHED } else { 0 };
                let ends = line
                    .points
                    .windows(2)
                    .filter(|ends| ends.iter().all(|p| p.is_finite()));
                ends.map(move |ends| GpuSegment {
                    start: ends[0].to_array(),
                    width: line.width,
                    end: ends[1].to_array(),
                    role_and_stroke: line.role as u32 | dashed,
                })
            })
            .collect();
        Self {
            buffer: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("view lines"),
                contents: bytemuck::cast_slice(&segments),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            num_segments: segments.len() as u32,
        }
    }

    /// Draws all segments; pipeline and bind groups must be set.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.num_segments > 0 {
            pass.set_vertex_buffer(0, self.buffer.slice(..));
            pass.draw(0..4, 0..self.num_segments);
        }
    }
}

/// Makes the pipeline that draws lines.
pub(super) fn pipeline(
    device: &wgpu::Device,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Uint32];
    pass::pipeline(
        device,
        &PassSpec {
            label: "view lines",
            source: SHADER,
            constants: &[],
            layouts,
            instances: Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<GpuSegment>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &ATTRIBUTES,
            }),
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            targets: &[wgpu::ColorTargetState {
                format: COLOUR_FORMAT,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            }],
            depth: None,
        },
    )
}
