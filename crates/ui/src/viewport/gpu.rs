//! The graphics device shared by the views of a window: pipelines, uploaded sets, and the error of the device.

use std::{
    collections::HashMap,
    sync::{
        Arc, Mutex, Weak,
        atomic::{AtomicU64, Ordering},
    },
};

use eframe::{egui_wgpu::RenderState, wgpu};

use super::{
    composite::Composite,
    eye_dome,
    lines::{self, GpuLines},
    pass,
    points::{self, GpuPoints},
    scene::{LineSet, PointSet},
    style::Colouring,
    targets::{self, TargetLayouts},
};
use geometry::error::{Advice, lock};

/// Why a view cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum ViewError {
    /// No graphics device was found.
    #[error("no graphics device was found ({reason})")]
    #[advice = "Install a Vulkan driver (on Debian mesa-vulkan-drivers), then start Partsight again"]
    NoDevice {
        /// Message of the system.
        reason: String,
    },
    /// The device was lost, for example after a driver update or when a laptop slept.
    #[error("the graphics device was lost ({reason})")]
    #[advice = "Start Partsight again"]
    DeviceLost {
        /// Message of the system.
        reason: String,
    },
    /// The device reported an error, for example for lack of memory.
    #[error("the graphics device reported an error ({reason})")]
    #[advice = "Close other programs that use the graphics device, then start Partsight again"]
    DeviceError {
        /// Message of the device.
        reason: String,
    },
    /// The requested picture is larger than the device can draw, or empty.
    #[error(
        "a picture of {width} × {height} pixels was requested, but the device draws 1 × 1 to {most} × {most}"
    )]
    #[advice = "Ask for a smaller picture"]
    PictureSize {
        /// Requested width, pixels.
        width: u32,
        /// Requested height, pixels.
        height: u32,
        /// Largest side, pixels.
        most: u32,
    },
}

/// A handle on the device for any number of views. Cloning is cheap and shares everything.
///
/// Make one for the window with [`ViewportGpu::of_window`], or one without a window with [`ViewportGpu::headless`].
#[derive(Clone)]
pub struct ViewportGpu(Arc<Shared>);

struct Shared {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    problem: Arc<Mutex<Option<ViewError>>>,
    points: Mutex<HashMap<u64, Weak<GpuPoints>>>,
    lines: Mutex<HashMap<u64, Weak<GpuLines>>>,
    num_uploads: AtomicU64,
}

/// The pipelines and layouts of all passes, made once per device.
pub(super) struct Pipelines {
    pub(super) uniform: wgpu::BindGroupLayout,
    pub(super) targets: TargetLayouts,
    point_table: wgpu::BindGroupLayout,
    /// In the order of [`Colouring::ALL`].
    pub(super) points: [wgpu::RenderPipeline; Colouring::ALL.len()],
    pub(super) lines: wgpu::RenderPipeline,
    pub(super) eye_dome: wgpu::RenderPipeline,
    pub(super) composite: Composite,
}

impl ViewportGpu {
    /// Uses the device that egui draws the window with. Call once, at start, with `CreationContext::wgpu_render_state`.
    pub fn of_window(render_state: &RenderState) -> Self {
        let RenderState {
            device,
            queue,
            target_format,
            ..
        } = render_state;
        Self::new(device.clone(), queue.clone(), *target_format)
    }

    /// Opens a device of its own, for pictures without a window.
    pub fn headless() -> Result<Self, ViewError> {
        let no_device = |reason: String| ViewError::NoDevice { reason };
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let instance = wgpu::Instance::new(descriptor);
        let adapter =
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
                .map_err(|error| no_device(error.to_string()))?;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
                .map_err(|error| no_device(error.to_string()))?;
        Ok(Self::new(device, queue, targets::COLOUR_FORMAT))
    }

    fn new(device: wgpu::Device, queue: wgpu::Queue, window_format: wgpu::TextureFormat) -> Self {
        let problem = Arc::new(Mutex::new(None));
        listen(&device, &problem);
        Self(Arc::new(Shared {
            pipelines: Pipelines::new(&device, window_format),
            device,
            queue,
            problem,
            points: Mutex::default(),
            lines: Mutex::default(),
            num_uploads: AtomicU64::new(0),
        }))
    }

    /// Name, interface and driver of the graphics adapter, for people.
    pub fn adapter(&self) -> String {
        let wgpu::AdapterInfo {
            name,
            backend,
            driver,
            driver_info,
            ..
        } = self.0.device.adapter_info();
        let words = format!("{name}, {backend:?}, {driver} {driver_info}");
        words.trim_end_matches([',', ' ']).to_owned()
    }

    /// The first error of the device, or its loss. Views then show it as text.
    pub fn problem(&self) -> Option<ViewError> {
        lock(&self.0.problem).clone()
    }

    /// Returns true once the device is lost.
    pub fn is_lost(&self) -> bool {
        // The device reports its loss only when polled.
        let _ = self.0.device.poll(wgpu::PollType::Poll);
        matches!(self.problem(), Some(ViewError::DeviceLost { .. }))
    }

    /// Number of sets uploaded so far.
    pub fn num_uploads(&self) -> u64 {
        self.0.num_uploads.load(Ordering::Relaxed)
    }

    pub(super) fn device(&self) -> &wgpu::Device {
        &self.0.device
    }

    pub(super) fn queue(&self) -> &wgpu::Queue {
        &self.0.queue
    }

    pub(super) fn pipelines(&self) -> &Pipelines {
        &self.0.pipelines
    }

    /// Returns the set on the GPU, uploading it unless a view already holds it.
    pub(super) fn points(&self, set: &PointSet) -> Arc<GpuPoints> {
        held(&self.0.points, set.generation(), || {
            let Shared {
                device,
                queue,
                pipelines,
                ..
            } = &*self.0;
            self.0.num_uploads.fetch_add(1, Ordering::Relaxed);
            GpuPoints::upload(device, queue, &pipelines.point_table, &set.to_upload())
        })
    }

    /// Like [`Self::points`], for lines.
    pub(super) fn lines(&self, set: &LineSet) -> Arc<GpuLines> {
        held(&self.0.lines, set.generation(), || {
            self.0.num_uploads.fetch_add(1, Ordering::Relaxed);
            GpuLines::upload(&self.0.device, set)
        })
    }
}

impl Pipelines {
    fn new(device: &wgpu::Device, window_format: wgpu::TextureFormat) -> Self {
        let uniform = pass::layout(device, "view uniform", &[pass::UNIFORM]);
        let targets = TargetLayouts::new(device);
        let point_table = pass::layout(device, "view points", &[pass::TABLE]);
        Self {
            points: Colouring::ALL.map(|colouring| {
                points::pipeline(device, &[&uniform, &uniform, &point_table], colouring)
            }),
            lines: lines::pipeline(device, &[&uniform, &uniform, &targets.closeness]),
            eye_dome: eye_dome::pipeline(device, &[&uniform, &targets.unshaded]),
            composite: Composite::new(device, window_format),
            uniform,
            targets,
            point_table,
        }
    }
}

/// Records the first error of the device. Without these callbacks wgpu panics on any error.
fn listen(device: &wgpu::Device, problem: &Arc<Mutex<Option<ViewError>>>) {
    let on_lost = Arc::clone(problem);
    device.set_device_lost_callback(move |_, reason| {
        // A loss explains all earlier errors. A device dropped on purpose also lands here, but then nobody asks.
        *lock(&on_lost) = Some(ViewError::DeviceLost { reason });
    });
    let on_error = Arc::clone(problem);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        lock(&on_error).get_or_insert(ViewError::DeviceError {
            reason: error.to_string(),
        });
    }));
}

/// Returns the entry of this number, making it if nobody holds it any more; drops entries that nobody holds.
fn held<T>(all: &Mutex<HashMap<u64, Weak<T>>>, number: u64, make: impl FnOnce() -> T) -> Arc<T> {
    let mut all = lock(all);
    if let Some(found) = all.get(&number).and_then(Weak::upgrade) {
        return found;
    }
    all.retain(|_, entry| entry.strong_count() > 0);
    let made = Arc::new(make());
    all.insert(number, Arc::downgrade(&made));
    made
}
