//! The window without a display, drawn frame by frame into a texture as on a desktop.
//!
//! A frame does everything that it does on a desktop: the panels run, their shapes become triangles, buffers are filled, the
//! passes are recorded and submitted. Only presenting the picture is left out. Used to measure the cost of frames (crate
//! `bench`) and to test that they do no unnecessary work.

use std::{thread, time::Instant};

use eframe::{
    egui_wgpu::{
        Renderer, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup,
        WgpuSetupCreateNew,
    },
    wgpu,
};
use egui::{Event, FullOutput, RawInput, Rect, Vec2};

use super::{
    window::{Window, WindowOptions},
    workspaces::inspect::WorkCounts,
};
use shell::{
    action::Action,
    workspace::{ShellContext, Workspace},
};
use ui::viewport::ViewError;

/// Format of the target texture.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A window without a display.
pub struct HeadlessWindow {
    ctx: egui::Context,
    window: Window,
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    target: wgpu::TextureView,
    size: [u32; 2],
    began: Instant,
    #[cfg(test)]
    closes: bool,
    #[cfg(test)]
    says: Vec<String>,
}

impl HeadlessWindow {
    /// Opens the window on any available device; `size` in logical pixels.
    pub fn open(size: [u32; 2], options: WindowOptions) -> Result<Self, ViewError> {
        let no_device = |reason: String| ViewError::NoDevice { reason };
        let setup = WgpuSetup::CreateNew(WgpuSetupCreateNew::without_display_handle());
        let instance = pollster::block_on(setup.new_instance());
        let configuration = WgpuConfiguration {
            wgpu_setup: setup,
            ..WgpuConfiguration::default()
        };
        let made = eframe::egui_wgpu::RenderState::create(
            &configuration,
            &instance,
            None,
            RendererOptions::default(),
        );
        let mut render_state =
            pollster::block_on(made).map_err(|error| no_device(error.to_string()))?;
        render_state.target_format = FORMAT;
        let ctx = egui::Context::default();
        let window = Window::new(&ctx, Some(&render_state), options)
            .map_err(|error| no_device(error.to_string()))?;
        let (device, queue) = (render_state.device.clone(), render_state.queue.clone());
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        Ok(Self {
            renderer: Renderer::new(&device, FORMAT, RendererOptions::default()),
            target: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            ctx,
            window,
            device,
            queue,
            size,
            began: Instant::now(),
            #[cfg(test)]
            closes: false,
            #[cfg(test)]
            says: Vec::new(),
        })
    }

    /// The window that is drawn.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Number of the result in front.
    pub fn generation(&self) -> Option<u64> {
        let shown = self.window.state().session.shown.as_ref();
        shown.map(|shown| shown.generation)
    }

    /// Work done by its frames so far.
    pub fn counts(&self) -> WorkCounts {
        self.window.counts()
    }

    /// Draws frames until no work is running; false if that took more than a minute.
    pub fn settle(&mut self) -> bool {
        let begun = Instant::now();
        loop {
            self.frame(Vec::new());
            if self.window.is_idle() {
                break;
            }
            if begun.elapsed().as_secs() > 60 {
                return false;
            }
            thread::sleep(std::time::Duration::from_millis(5));
        }
        for _ in 0..3 {
            self.frame(Vec::new());
        }
        true
    }

    /// Carries out an action that the user could cause.
    pub fn act(&mut self, action: Action) {
        self.window.act(action, &self.ctx);
    }

    /// Runs `act` on the workspace of this type.
    pub fn with<W: Workspace, R>(
        &mut self,
        act: impl FnOnce(&mut W, &mut ShellContext<'_>) -> R,
    ) -> Option<R> {
        self.window.with(&self.ctx, act)
    }

    /// Draws one frame with these input events, and waits until the device has drawn it, as with a display that takes one
    /// picture after the other.
    pub fn frame(&mut self, events: Vec<Event>) {
        self.draw(events);
        self.wait();
    }

    /// Waits until the device has drawn everything.
    pub fn wait(&self) {
        // Fails for a lost device, which draws nothing to wait for.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// Draws one frame with these input events; the device may still draw it afterwards.
    pub fn draw(&mut self, events: Vec<Event>) {
        let [width, height] = self.size;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(
                egui::Pos2::ZERO,
                Vec2::new(width as f32, height as f32),
            )),
            time: Some(self.began.elapsed().as_secs_f64()),
            events,
            ..RawInput::default()
        };
        let Self { ctx, window, .. } = self;
        let output = ctx.run_ui(input, |ui| {
            let ctx = ui.ctx().clone();
            window.fetch(&ctx);
            window.show(ui);
        });
        #[cfg(test)]
        tests::read_output(self, &output);
        self.submit(output);
    }

    fn submit(&mut self, mut output: FullOutput) {
        let screen = ScreenDescriptor {
            size_in_pixels: self.size,
            pixels_per_point: output.pixels_per_point,
        };
        let Self {
            device,
            queue,
            renderer,
            ..
        } = self;
        #[expect(clippy::iter_over_hash_type, reason = "each texture is on its own")]
        for (id, images) in output.textures_delta.set.drain() {
            for image in images {
                renderer.update_texture(device, queue, id, &image);
            }
        }
        let triangles = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let before = renderer.update_buffers(device, queue, &mut encoder, &triangles, &screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..wgpu::RenderPassDescriptor::default()
            })
            .forget_lifetime();
        renderer.render(&mut pass, &triangles, &screen);
        drop(pass);
        queue.submit(before.into_iter().chain([encoder.finish()]));
        #[expect(clippy::iter_over_hash_type, reason = "each texture is on its own")]
        for id in output.textures_delta.free.drain() {
            renderer.free_texture(&id);
        }
    }
}

#[cfg(test)]
mod tests;
