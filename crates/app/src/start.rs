//! Opens the window, or explains why it cannot be opened.

use std::{
    cell::OnceCell,
    env,
    rc::Rc,
    time::{Duration, Instant},
};

use eframe::NativeOptions;

use super::window::{Window, WindowOptions};
use geometry::error::Advice;
use shell::settings;
use ui::{
    language::language_of_system,
    viewport::{ViewError, ViewportGpu},
};

/// Why the window could not be opened or stayed closed.
#[derive(Debug, thiserror::Error, Advice)]
pub enum WindowError {
    /// No desktop to open a window on.
    #[error("there is no display to open a window on")]
    #[advice = "Start Partsight from a desktop session, or over SSH with ssh -X; neither DISPLAY nor WAYLAND_DISPLAY is set"]
    NoDisplay,
    /// The desktop refused to open the window.
    #[error("the window could not be opened ({reason})")]
    #[advice = "Check that DISPLAY or WAYLAND_DISPLAY names a running desktop, and that the package libxkbcommon-x11-0 is installed"]
    Refused {
        /// Message of the system.
        reason: String,
    },
    /// The graphics device was lost while the window was open.
    #[error("the graphics device was lost while the window was open ({reason})")]
    #[advice = "Start Partsight again; no enrolled part and no written file is lost"]
    DeviceLost {
        /// Message of the system.
        reason: String,
    },
    /// No graphics driver can draw the window.
    #[error("there is no graphics driver that can draw the window ({reason})")]
    #[advice(if cfg!(windows) {
        "Install the driver of the graphics card from its maker. If it has one, set the environment variable WGPU_BACKEND to vulkan or gl and start Partsight again"
    } else {
        "Install a Vulkan driver: on Debian and Ubuntu the package mesa-vulkan-drivers"
    })]
    NoAdapter {
        /// Message of the system.
        reason: String,
    },
}

/// Default size of the window, logical pixels.
const SIZE: [f32; 2] = [1440.0, 900.0];
/// Minimum size, logical pixels; below it the contents would be cut off.
const MIN_SIZE: [f32; 2] = [960.0, 640.0];

/// Minimum time that a window must have been open to be reopened after its device was lost.
const WORTH_REOPENING: Duration = Duration::from_secs(30);

/// Opens the window and returns when the user closes it. Reopens it if its graphics device is lost.
pub fn run(given: WindowOptions) -> Result<(), WindowError> {
    // Without either variable the window cannot be shown; asking the system would only take time.
    if cfg!(all(unix, not(target_os = "macos"))) && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")
    {
        return Err(WindowError::NoDisplay);
    }
    let mut given = WindowOptions {
        language: given.language.or_else(|| Some(language_of_system())),
        ..given
    };
    let mut is_reopened = false;
    loop {
        let opened = Instant::now();
        let closed = open(given.clone(), is_reopened);
        // After a driver reset the device is available again; a device lost soon after opening would be lost again and again.
        let was_lost = matches!(closed, Err(WindowError::DeviceLost { .. }));
        if !was_lost || opened.elapsed() < WORTH_REOPENING {
            return closed;
        }
        // The settings remember what was open last.
        given.scene = None;
        is_reopened = true;
    }
}

/// Opens one window and returns when it is closed.
fn open(given: WindowOptions, is_reopened: bool) -> Result<(), WindowError> {
    let size = given.settings.as_deref().and_then(settings::window_size);
    let options = NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Partsight")
            .with_app_id("partsight")
            .with_inner_size(size.unwrap_or(SIZE))
            .with_min_inner_size(MIN_SIZE),
        renderer: eframe::Renderer::Wgpu,
        ..NativeOptions::default()
    };
    let gpu = Rc::new(OnceCell::new());
    let of_window = Rc::clone(&gpu);
    let opened = eframe::run_native(
        "partsight",
        options,
        Box::new(move |cc| {
            let mut window = Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), given)?;
            if is_reopened {
                window.tell_of_lost_device();
            }
            if let Ok(gpu) = window.gpu() {
                // The cell is empty: the window is created only once.
                let _ = of_window.set(gpu.clone());
            }
            Ok(Box::new(window) as Box<dyn eframe::App>)
        }),
    );
    opened.map_err(|error| match error {
        eframe::Error::Wgpu(error) => WindowError::NoAdapter {
            reason: error.to_string(),
        },
        // The original message is only about the library that failed.
        eframe::Error::WinitEventLoop(_) => WindowError::Refused {
            reason: "the desktop does not answer".into(),
        },
        error => WindowError::Refused {
            reason: error.to_string(),
        },
    })?;
    match gpu.get().and_then(ViewportGpu::problem) {
        Some(ViewError::DeviceLost { reason }) => Err(WindowError::DeviceLost { reason }),
        _ => Ok(()),
    }
}

fn is_set(variable: &str) -> bool {
    env::var_os(variable).is_some_and(|value| !value.is_empty())
}
