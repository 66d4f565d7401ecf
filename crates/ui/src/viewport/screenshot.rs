//! Draws a scene off screen and reads the picture back. Works without a window.

use std::{fmt, sync::mpsc};

use eframe::wgpu;
use image::RgbaImage;

use super::{
    camera::ViewCamera,
    gpu::{ViewError, ViewportGpu},
    points::NUM_SAMPLES,
    renderer::{Frame, ViewRenderer},
    scene::ViewScene,
    style::ViewStyle,
};

/// A snapshot of a view, to be drawn later on any thread. Cheap to clone.
#[derive(Clone)]
pub struct ViewShot {
    /// Device that draws it.
    pub gpu: ViewportGpu,
    /// Camera at that moment.
    pub camera: ViewCamera,
    /// Scene at that moment.
    pub scene: ViewScene,
    /// Style at that moment.
    pub style: ViewStyle,
    /// Width and height, physical pixels.
    pub size: [u32; 2],
    /// Factor on line widths, 1 for a plain screen.
    pub pixels_per_point: f32,
}

impl ViewShot {
    /// Draws its points and lines, without labels and colour scale, which belong to the window.
    ///
    /// A pending fit of the camera is done first. Blocks until the picture is ready.
    pub fn take(&self) -> Result<RgbaImage, ViewError> {
        let gpu = &self.gpu;
        let [width, height] = self.size;
        let most = gpu.device().limits().max_texture_dimension_2d;
        if !(1..=most).contains(&width) || !(1..=most).contains(&height) {
            return Err(ViewError::PictureSize {
                width,
                height,
                most,
            });
        }
        let mut frame = Frame {
            camera: self.camera,
            scene: self.scene.clone(),
            style: self.style.clone(),
            size: glam::Vec2::new(width as f32, height as f32) / self.pixels_per_point.max(0.1),
            target: self.size,
            num_samples: NUM_SAMPLES,
        };
        super::navigation::fit_if_pending(&mut frame.camera, &self.scene, frame.size);
        let mut renderer = ViewRenderer::default();
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.draw(gpu, &frame, &mut encoder);
        let read = renderer
            .picture()
            .map(|picture| read_back(gpu, picture, encoder));
        match (gpu.problem(), read) {
            (None, Some(Some(image))) => Ok(image),
            (Some(problem), _) => Err(problem),
            (None, _) => Err(ViewError::DeviceError {
                reason: "the picture could not be read back".into(),
            }),
        }
    }
}

impl fmt::Debug for ViewShot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ViewShot")
            .field("camera", &self.camera)
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

fn read_back(
    gpu: &ViewportGpu,
    picture: &wgpu::Texture,
    mut encoder: wgpu::CommandEncoder,
) -> Option<RgbaImage> {
    const BYTES_PER_PIXEL: u32 = 4;
    let (width, height) = (picture.width(), picture.height());
    let row = (width * BYTES_PER_PIXEL) as usize;
    let padded_row = (width * BYTES_PER_PIXEL).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("view screenshot"),
        size: u64::from(padded_row) * u64::from(height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        picture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_row),
                rows_per_image: None,
            },
        },
        picture.size(),
    );
    gpu.queue().submit([encoder.finish()]);
    let (sender, receiver) = mpsc::channel();
    buffer
        .slice(..)
        .map_async(wgpu::MapMode::Read, move |result| {
            // The receiver is gone only if waiting failed, which is reported there.
            drop(sender.send(result));
        });
    gpu.device()
        .poll(wgpu::PollType::wait_indefinitely())
        .ok()?;
    receiver.try_recv().ok()?.ok()?;
    let mapped = buffer.slice(..).get_mapped_range().ok()?;
    let pixels = mapped
        .chunks_exact(padded_row as usize)
        .flat_map(|padded| &padded[..row])
        .copied();
    RgbaImage::from_raw(width, height, pixels.collect())
}
