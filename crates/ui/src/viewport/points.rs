//! Points on the GPU: each point set is uploaded once as a table; this pass draws it as discs.
//!
//! Each point is a camera-facing triangle around a disc that the shader cuts out: half the work of a quad, and cheaper than an
//! instance per point, which drivers handle one by one. The shader finds the point from the vertex index. The table is a
//! texture because every backend lets a vertex shader read one. A point takes 16 bytes: its position, its role and its
//! deviation, so that another colouring needs only another pipeline and no upload.
//!
//! The table holds the points in [`NUM_SAMPLES`] random samples, one after the other, each in the set's own order. Drawing the
//! first few samples draws an even share of the cloud without choosing or sorting anything in a frame, which keeps a slow
//! device fluid while the camera moves. Within a sample neighbours stay neighbours, which suits the caches.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::wgpu;
use glam::{Mat4, Vec4};

use super::{
    pass::{self, PassSpec},
    scene::PointSet,
    style::Colouring,
    targets::{CLOSENESS_FORMAT, COLOUR_FORMAT, DEPTH_FORMAT},
};

/// Source of the shader.
pub(super) const SHADER: &str = concat!(include_str!("view.wgsl"), include_str!("points.wgsl"));

/// Number of random samples that a set is divided into.
pub(super) const NUM_SAMPLES: usize = 8;

/// Points per row of a table; `ROW` in points.wgsl.
const ROW: usize = 2048;

/// Maximum number of points per table: 2048 rows, 64 MiB, which every device allows.
const POINTS_PER_TABLE: usize = 2048 * ROW;

/// The upper 24 bits of [`GpuPoint::role_and_deviation`] for a point without deviation; `NO_DEVIATION` in points.wgsl.
const NO_DEVIATION: i32 = -(1 << 23);

/// One texel of the table; decoded by `point_at` in points.wgsl.
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
    pub(super) diameter: f32,
    pub(super) padding: [f32; 3],
}

/// Points of a set in the layout of a GPU table, ready to copy.
#[derive(Debug)]
pub(super) struct PackedTable {
    /// Whole rows; the last one is padded.
    texels: Vec<GpuPoint>,
    sample_ends: [u32; NUM_SAMPLES],
}

/// Packs all finite points of the set.
pub(super) fn pack(set: &PointSet) -> Arc<[PackedTable]> {
    let num_points = set.positions().len();
    let starts = (0..num_points).step_by(POINTS_PER_TABLE);
    let tables = starts.map(|start| {
        let end = num_points.min(start + POINTS_PER_TABLE);
        let (mut texels, sample_ends) = in_samples(set, start..end);
        texels.resize(texels.len().div_ceil(ROW).max(1) * ROW, GpuPoint::default());
        PackedTable {
            texels,
            sample_ends,
        }
    });
    tables.collect()
}

/// The uploaded points of one set.
pub(super) struct GpuPoints {
    tables: Vec<Table>,
}

struct Table {
    group: wgpu::BindGroup,
    /// End of each sample, in points from the start of the table.
    sample_ends: [u32; NUM_SAMPLES],
}

impl GpuPoints {
    /// Copies a packed set to the GPU.
    pub(super) fn upload(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layout: &wgpu::BindGroupLayout,
        packed: &[PackedTable],
    ) -> Self {
        let tables = packed.iter().map(|table| {
            let texels = upload_table(device, queue, &table.texels);
            let resources = [wgpu::BindingResource::TextureView(&texels)];
            Table {
                group: pass::bind(device, "view points", layout, &resources),
                sample_ends: table.sample_ends,
            }
        });
        Self {
            tables: tables.collect(),
        }
    }

    /// Draws the first `num_samples` samples; the pipeline and bind groups 0 and 1 must be set.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, num_samples: usize) {
        for table in &self.tables {
            let num_points = table.sample_ends[num_samples.clamp(1, NUM_SAMPLES) - 1];
            pass.set_bind_group(2, &table.group, &[]);
            pass.draw(0..3 * num_points, 0..1);
        }
    }
}

fn upload_table(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texels: &[GpuPoint],
) -> wgpu::TextureView {
    let num_rows = texels.len() / ROW;
    let size = wgpu::Extent3d {
        width: ROW as u32,
        height: num_rows as u32,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("view points"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let rows = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((ROW * size_of::<GpuPoint>()) as u32),
        rows_per_image: None,
    };
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(texels),
        rows,
        size,
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Returns the finite points of a range, sample after sample, and where each sample ends.
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

/// Assigns a point to a sample independently of rows and columns: the top bits of a multiplicative hash (Knuth, The Art of
/// Computer Programming 3, section 6.4) after one fold.
fn sample_of(index: usize) -> usize {
    let mixed = (index as u32).wrapping_mul(0x9e37_79b1);
    let folded = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    (folded >> 29) as usize % NUM_SAMPLES
}

fn gpu_point(set: &PointSet, index: usize) -> GpuPoint {
    // 24 bits of micrometres reach ±8.3 m.
    let micrometres = set.deviation(index).map_or(NO_DEVIATION, |d| {
        ((d * 1e6) as i32).clamp(NO_DEVIATION + 1, -NO_DEVIATION - 1)
    });
    GpuPoint {
        position: set.positions()[index],
        role_and_deviation: (micrometres << 8) as u32 | set.role(index) as u32,
    }
}

/// Makes the pipeline that draws points with one colouring.
pub(super) fn pipeline(
    device: &wgpu::Device,
    layouts: &[&wgpu::BindGroupLayout],
    colouring: Colouring,
) -> wgpu::RenderPipeline {
    pass::pipeline(
        device,
        &PassSpec {
            label: "view points",
            source: SHADER,
            constants: &[("colouring", f64::from(colouring as u32))],
            layouts,
            instances: None,
            topology: wgpu::PrimitiveTopology::TriangleList,
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
    use crate::viewport::style::Role;

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
