//! Draws one view into its own picture, and only when something visible has changed.
//!
//! ```text
//! points ─► colour, near / z ─► eye dome ─► picture ◄─ lines          composite: picture ─► window
//! └──────────── only when camera, scene, style or size changed ──────┘            each frame of the window
//! ```

use std::sync::Arc;

use eframe::wgpu;
use glam::{Mat4, Vec3, Vec4};

use super::{
    camera::{ViewCamera, ViewSize},
    composite::BoundPicture,
    gpu::ViewportGpu,
    lines::{GpuLines, LinesUniform},
    pass::Uniform,
    points::{GpuPoints, NUM_SAMPLES, PointsUniform},
    scene::ViewScene,
    style::{Colouring, ViewStyle},
    targets::Targets,
    uniform::ViewUniform,
};

/// The inputs of one picture.
#[derive(Clone)]
pub(super) struct Frame {
    pub(super) camera: ViewCamera,
    pub(super) scene: ViewScene,
    pub(super) style: ViewStyle,
    /// Size of the view, logical pixels.
    pub(super) size: ViewSize,
    /// Size of the picture, pixels.
    pub(super) target: [u32; 2],
    /// How many of the [`NUM_SAMPLES`] random samples of each point set are drawn.
    pub(super) num_samples: usize,
}

/// Everything that the picture depends on: equal keys mean equal pictures.
#[derive(Clone, Debug, PartialEq)]
struct PictureKey {
    view: ViewUniform,
    points: Vec<(u64, PointsUniform)>,
    colourings: Vec<Colouring>,
    lines: Vec<(u64, LinesUniform)>,
    num_samples: usize,
}

/// The GPU resources of one view.
#[derive(Default)]
pub(super) struct ViewRenderer {
    drawn: Option<PictureKey>,
    held: Option<GpuBuffers>,
    points: Vec<Arc<GpuPoints>>,
    lines: Vec<Arc<GpuLines>>,
    set_uniforms: Vec<Uniform>,
    num_pictures: u64,
}

struct GpuBuffers {
    targets: Targets,
    bound: BoundPicture,
    view: Uniform,
}

impl ViewRenderer {
    /// Records the drawing of the frame, unless the picture already shows it.
    pub(super) fn draw(
        &mut self,
        gpu: &ViewportGpu,
        frame: &Frame,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let key = PictureKey::of(frame);
        if self.drawn.as_ref() == Some(&key) {
            return;
        }
        self.hold(gpu, frame.target);
        self.hold_sets(gpu, frame, &key);
        self.write_uniforms(gpu, &key);
        if let Some(held) = &self.held {
            self.record(gpu, held, encoder, &key);
            self.num_pictures += 1;
        }
        self.drawn = Some(key);
    }

    /// Sets where in the window the picture goes, and how many window pixels one of its pixels is wide.
    pub(super) fn place(&mut self, gpu: &ViewportGpu, origin: [i32; 2], pixel_side: u32) {
        if let Some(held) = &mut self.held {
            held.bound.place(gpu.queue(), origin, pixel_side);
        }
    }

    /// Draws the picture into egui's own pass.
    pub(super) fn composite(&self, gpu: &ViewportGpu, pass: &mut wgpu::RenderPass<'static>) {
        if let Some(held) = &self.held {
            gpu.pipelines().composite.draw(pass, &held.bound);
        }
    }

    /// The finished picture, once drawn.
    pub(super) fn picture(&self) -> Option<&wgpu::Texture> {
        self.held.as_ref().map(|held| &held.targets.picture_texture)
    }

    /// Number of times the picture was redrawn.
    pub(super) fn num_pictures(&self) -> u64 {
        self.num_pictures
    }

    fn hold(&mut self, gpu: &ViewportGpu, size: [u32; 2]) {
        if self
            .held
            .as_ref()
            .is_some_and(|held| held.targets.size == size)
        {
            return;
        }
        let (device, pipelines) = (gpu.device(), gpu.pipelines());
        let targets = Targets::new(device, &pipelines.targets, size);
        let bound = pipelines.composite.bind(device, &targets.picture);
        let view = Uniform::new::<ViewUniform>(device, "view", &pipelines.uniform);
        self.held = Some(GpuBuffers {
            targets,
            bound,
            view,
        });
    }

    fn hold_sets(&mut self, gpu: &ViewportGpu, frame: &Frame, key: &PictureKey) {
        let has_same = |drawn: &PictureKey| drawn.generations().eq(key.generations());
        if self.drawn.as_ref().is_some_and(has_same) {
            return;
        }
        // Get the new ones before dropping the old, so that sets in both are not freed in between.
        self.points = frame
            .scene
            .points
            .iter()
            .map(|set| gpu.points(set))
            .collect();
        self.lines = frame.scene.lines.iter().map(|set| gpu.lines(set)).collect();
    }

    fn write_uniforms(&mut self, gpu: &ViewportGpu, key: &PictureKey) {
        let num_sets = key.points.len() + key.lines.len();
        while self.set_uniforms.len() < num_sets {
            let uniform =
                Uniform::new::<PointsUniform>(gpu.device(), "view set", &gpu.pipelines().uniform);
            self.set_uniforms.push(uniform);
        }
        if let Some(held) = &self.held {
            held.view.write(gpu.queue(), &key.view);
        }
        let (for_points, for_lines) = self.set_uniforms.split_at(key.points.len());
        for (uniform, (_, value)) in for_points.iter().zip(&key.points) {
            uniform.write(gpu.queue(), value);
        }
        for (uniform, (_, value)) in for_lines.iter().zip(&key.lines) {
            uniform.write(gpu.queue(), value);
        }
    }

    fn record(
        &self,
        gpu: &ViewportGpu,
        held: &GpuBuffers,
        encoder: &mut wgpu::CommandEncoder,
        key: &PictureKey,
    ) {
        let (pipelines, targets) = (gpu.pipelines(), &held.targets);
        let (for_points, for_lines) = self.set_uniforms.split_at(self.points.len());

        let mut pass = begin(
            encoder,
            "view points",
            &[&targets.colour, &targets.closeness],
            Some(&targets.depth),
        );
        pass.set_bind_group(0, &held.view.group, &[]);
        let colourings = key.colourings.iter();
        for ((points, uniform), colouring) in self.points.iter().zip(for_points).zip(colourings) {
            pass.set_pipeline(&pipelines.points[*colouring as usize]);
            pass.set_bind_group(1, &uniform.group, &[]);
            points.draw(&mut pass, key.num_samples);
        }
        drop(pass);

        let mut pass = begin(
            encoder,
            "view eye dome and lines",
            &[&targets.picture],
            None,
        );
        pass.set_pipeline(&pipelines.eye_dome);
        pass.set_bind_group(0, &held.view.group, &[]);
        pass.set_bind_group(1, &targets.unshaded_group, &[]);
        pass.draw(0..3, 0..1);
        pass.set_pipeline(&pipelines.lines);
        pass.set_bind_group(2, &targets.closeness_group, &[]);
        for (lines, uniform) in self.lines.iter().zip(for_lines) {
            pass.set_bind_group(1, &uniform.group, &[]);
            lines.draw(&mut pass);
        }
    }
}

/// Begins a pass that clears its targets: colours to transparent, depth to infinity.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    colours: &[&wgpu::TextureView],
    depth: Option<&wgpu::TextureView>,
) -> wgpu::RenderPass<'a> {
    let colours: Vec<_> = colours
        .iter()
        .map(|&view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        })
        .collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &colours,
        depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}

impl PictureKey {
    /// Numbers of the point sets, then of the line sets; no two sets have the same.
    fn generations(&self) -> impl Iterator<Item = u64> {
        let points = self.points.iter().map(|(generation, _)| *generation);
        points.chain(self.lines.iter().map(|(generation, _)| *generation))
    }

    fn of(frame: &Frame) -> Self {
        let Frame {
            camera,
            scene,
            style,
            size,
            target,
            num_samples,
        } = frame;
        let clip_from_world = camera.clip_from_world(*size);
        // Draw fewer points larger, but not large enough to cover the same area: filling costs time too.
        let growth = (NUM_SAMPLES as f32 / *num_samples as f32).powf(0.25);
        let diameter = style.point_size.0 as f32 * growth;
        let points = scene.points.iter().map(|set| {
            let uniform = PointsUniform {
                clip_from_set: clip_from_world * set.world_from_set,
                height_from_set: height_from(&set.world_from_set),
                diameter,
                padding: [0.0; 3],
            };
            (set.generation(), uniform)
        });
        let lines = scene.lines.iter().map(|set| {
            let clip_from_set = clip_from_world * set.world_from_set;
            (set.generation(), LinesUniform { clip_from_set })
        });
        Self {
            view: ViewUniform::new(camera, style, height_range(scene), *size, *target),
            points: points.collect(),
            colourings: scene
                .points
                .iter()
                .map(|set| set.colouring.unwrap_or(style.colouring))
                .collect(),
            lines: lines.collect(),
            num_samples: *num_samples,
        }
    }
}

/// Up is −y, so the height is the negated second row of the transform.
fn height_from(world_from_set: &Mat4) -> Vec4 {
    -world_from_set.row(1)
}

/// Height above the camera at the low and the high end of the height scale, metres.
pub(super) fn height_range(scene: &ViewScene) -> [f32; 2] {
    let height = |point: Vec3| -point.y;
    scene.focus().map_or([0.0, 1.0], |bounds| {
        [height(bounds.high), height(bounds.low)]
    })
}
