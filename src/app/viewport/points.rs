//! Points on the GPU: a buffer per point set, uploaded once, and the pass that draws it as discs.
//!
//! Each point is an instance of one camera-facing quad that the shader cuts round. A point takes 16 bytes, with its
//! role and deviation beside the position, so that another colouring is another uniform and no upload.
//!
//! The buffer holds the points in [`NUM_SAMPLES`] random samples, one after the other, each in the set's own order:
//! drawing the first few samples draws an even share of the cloud, which keeps a slow device fluent while the eye
//! moves, and nothing is chosen or sorted in a frame. Within a sample neighbours stay neighbours, as caches like it.

use bytemuck::{Pod, Zeroable};
use eframe::wgpu::{self, util::DeviceExt as _};
use glam::{Mat4, Vec4};

use super::{
    pass::{self, PassSpec},
    scene::PointSet,
    targets::{CLOSENESS_FORMAT, COLOUR_FORMAT, DEPTH_FORMAT},
};

/// The text of the shader.
pub(super) const SHADER: &str = concat!(include_str!("view.wgsl"), include_str!("points.wgsl"));

/// Into how many random samples a set is divided.
pub(super) const NUM_SAMPLES: usize = 8;

/// Most points of one buffer: 64 MiB, which every device allows.
const POINTS_PER_BUFFER: usize = 4 << 20;

/// The upper 24 bits of [`GpuPoint::role_and_deviation`] for a point without deviation; `NO_DEVIATION` in points.wgsl.
const NO_DEVIATION: i32 = -(1 << 23);

/// `GpuPoint` in points.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct GpuPoint {
    position: [f32; 3],
    role_and_deviation: u32,
}

/// `Points` in points.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct PointsUniform {
    pub(super) clip_from_set: Mat4,
    pub(super) height_from_set: Vec4,
    pub(super) colouring: u32,
    pub(super) size_unit: u32,
    pub(super) diameter: f32,
    pub(super) padding: f32,
}

/// The points of one set.
pub(super) struct GpuPoints {
    chunks: Vec<Chunk>,
}

struct Chunk {
    buffer: wgpu::Buffer,
    /// Where each sample ends, points from the start of the buffer.
    sample_ends: [u32; NUM_SAMPLES],
}

impl GpuPoints {
    /// Copies a set to the GPU, without the points that are not finite.
    pub(super) fn upload(device: &wgpu::Device, set: &PointSet) -> Self {
        let num_points = set.positions().len();
        let starts = (0..num_points).step_by(POINTS_PER_BUFFER);
        let chunks = starts.map(|start| {
            let end = num_points.min(start + POINTS_PER_BUFFER);
            let (points, sample_ends) = in_samples(set, start..end);
            let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("view points"),
                contents: bytemuck::cast_slice(&points),
                usage: wgpu::BufferUsages::VERTEX,
            });
            Chunk {
                buffer,
                sample_ends,
            }
        });
        Self {
            chunks: chunks.collect(),
        }
    }

    /// Draws the first `num_samples` samples with the pipeline and groups already set.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, num_samples: usize) {
        for chunk in &self.chunks {
            let num_points = chunk.sample_ends[num_samples.clamp(1, NUM_SAMPLES) - 1];
            if num_points > 0 {
                pass.set_vertex_buffer(0, chunk.buffer.slice(..));
                pass.draw(0..4, 0..num_points);
            }
        }
    }
}

/// The finite points of a range, sample after sample, and where each sample ends.
fn in_samples(
    set: &PointSet,
    range: std::ops::Range<usize>,
) -> (Vec<GpuPoint>, [u32; NUM_SAMPLES]) {
    let is_shown = |i: &usize| set.positions()[*i].iter().all(|x| x.is_finite());
    let mut ends = [0_u32; NUM_SAMPLES];
    for i in range.clone().filter(is_shown) {
        ends[sample_of(i)] += 1;
    }
    let mut next = [0_u32; NUM_SAMPLES];
    let mut total = 0;
    for (next, end) in next.iter_mut().zip(&mut ends) {
        *next = total;
        total += *end;
        *end = total;
    }
    let mut points = vec![GpuPoint::default(); total as usize];
    for i in range.filter(is_shown) {
        let slot = &mut next[sample_of(i)];
        points[*slot as usize] = gpu_point(set, i);
        *slot += 1;
    }
    (points, ends)
}

/// A number that has nothing to do with rows and columns: the top bits of a multiplicative hash (Knuth, The Art of
/// Computer Programming 3, section 6.4) after one fold.
fn sample_of(index: usize) -> usize {
    let mixed = (index as u32).wrapping_mul(0x9e37_79b1);
    let folded = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    (folded >> 29) as usize % NUM_SAMPLES
}

fn gpu_point(set: &PointSet, index: usize) -> GpuPoint {
    // 24 bits of micrometres reach ± 8.3 m.
    let micrometres = set.deviation(index).map_or(NO_DEVIATION, |d| {
        ((d * 1e6) as i32).clamp(NO_DEVIATION + 1, -NO_DEVIATION - 1)
    });
    GpuPoint {
        position: set.positions()[index],
        role_and_deviation: (micrometres << 8) as u32 | set.role(index) as u32,
    }
}

/// The pass that draws points.
pub(super) fn pipeline(
    device: &wgpu::Device,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    const ATTRIBUTES: [wgpu::VertexAttribute; 2] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32];
    pass::pipeline(
        device,
        &PassSpec {
            label: "view points",
            source: SHADER,
            layouts,
            instances: Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<GpuPoint>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &ATTRIBUTES,
            }),
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            targets: &[COLOUR_FORMAT.into(), CLOSENESS_FORMAT.into()],
            depth: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                // Reversed: 1 is near, 0 infinitely far.
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::viewport::style::Role;

    #[test]
    fn samples_are_even_and_hold_every_finite_point_once() {
        let mut positions: Vec<[f32; 3]> = (0..10_000).map(|i| [i as f32, 0.0, 1.0]).collect();
        positions[17] = [f32::NAN; 3];
        let set = PointSet::new(positions, Role::Part);
        let (points, ends) = in_samples(&set, 0..10_000);
        assert_eq!(points.len(), 9_999);
        let mut seen: Vec<usize> = points.iter().map(|p| p.position[0] as usize).collect();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq((0..10_000).filter(|i| *i != 17)));
        let starts = std::iter::once(0).chain(ends);
        for (start, end) in starts.zip(ends) {
            assert!((1_100..1_400).contains(&(end - start)), "{ends:?}");
        }
    }

    #[test]
    fn role_and_deviation_survive_the_packing() {
        let positions = vec![[0.0; 3]; 4];
        let set = PointSet::new(positions, Role::Moving).with_deviations([
            0.0012,
            -0.0034,
            f32::NAN,
            -90.0,
        ]);
        let unpacked: Vec<(u32, i32)> = (0..4)
            .map(|i| gpu_point(&set, i).role_and_deviation)
            .map(|packed| (packed & 0xff, packed as i32 >> 8))
            .collect();
        let role = Role::Moving as u32;
        let expected = [
            (role, 1200),
            (role, -3400),
            (role, NO_DEVIATION),
            (role, NO_DEVIATION + 1),
        ];
        for ((role, value), (expected_role, expected_value)) in unpacked.into_iter().zip(expected) {
            assert_eq!(role, expected_role);
            assert!((value - expected_value).abs() <= 1);
        }
    }
}
