//! What a frame of the window costs, at rest and while the view is turned.

use egui::{Event, Modifiers, PointerButton, Pos2, Vec2};
use serde::Serialize;

use super::speed::quantile;
use crate::app::{
    WindowOptions,
    headless::{FrameTime, HeadlessWindow, Pace, process_seconds},
    viewport::ViewError,
};

/// Times over many frames, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameCost {
    /// What happens in the frames.
    pub what: &'static str,
    /// Frames measured.
    pub num_frames: usize,
    /// Processor time of the window's thread, median.
    pub busy_p50_ms: f64,
    /// The same, 95th percentile.
    pub busy_p95_ms: f64,
    /// Processor time of all threads, mean: with a software driver the drawing is in it. `None` where the system does
    /// not tell.
    pub all_threads_mean_ms: Option<f64>,
    /// From frame to frame with the device waited for, median; `None` where it is not.
    pub paced_p50_ms: Option<f64>,
    /// Share of the points that was drawn in the last frame, 0..1.
    pub detail: f64,
}

/// What the frames cost, and of what window.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowCost {
    /// Points of the scene shown.
    pub num_points: usize,
    /// Logical pixels.
    pub size: [u32; 2],
    /// At rest, turning, and turning behind a display.
    pub frames: Vec<FrameCost>,
}

/// The window's size, logical pixels.
const SIZE: [u32; 2] = [1440, 900];

/// Opens the Inspect workspace without a display and measures `num_frames` frames of each kind.
pub fn window_cost(num_frames: usize, options: WindowOptions) -> Result<WindowCost, ViewError> {
    let mut window = HeadlessWindow::open(SIZE, options)?;
    window.settle();
    let shown = window.window().state().shown.as_ref();
    let num_points = shown.map_or(0, |shown| shown.inspected.figures.num_points);
    let mut costs = vec![frames(
        "at rest",
        &mut window,
        num_frames,
        Pace::Ahead,
        |_| Vec::new(),
    )];

    let middle = Pos2::new(SIZE[0] as f32 * 0.4, SIZE[1] as f32 * 0.45);
    let button = |pressed| Event::PointerButton {
        pos: middle,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for (what, pace) in [
        ("turning", Pace::Ahead),
        ("turning, each frame waited for", Pace::InStep),
    ] {
        window.frame(
            vec![Event::PointerMoved(middle), button(true)],
            Pace::InStep,
        );
        // The hand goes to and fro.
        let hand = |i: usize| {
            let swing = (i as f32 * 0.12).sin() * 260.0;
            vec![Event::PointerMoved(middle + Vec2::new(swing, swing * 0.3))]
        };
        costs.push(frames(what, &mut window, num_frames, pace, hand));
        window.frame(vec![button(false)], Pace::InStep);
    }
    Ok(WindowCost {
        num_points,
        size: SIZE,
        frames: costs,
    })
}

fn frames(
    what: &'static str,
    window: &mut HeadlessWindow,
    num_frames: usize,
    pace: Pace,
    events: impl Fn(usize) -> Vec<Event>,
) -> FrameCost {
    /// Frames in which caches fill and the view learns how slow the device is.
    const NUM_FIRST: usize = 12;
    let mut draw = |i| {
        let time = window.frame(events(i), pace);
        // Outside the time taken: a device that is behind must not fill the memory.
        window.wait();
        time
    };
    for i in 1..=NUM_FIRST {
        draw(i);
    }
    let before = process_seconds();
    let times: Vec<FrameTime> = (1..=num_frames).map(|i| draw(i + NUM_FIRST)).collect();
    let spent = process_seconds().zip(before).map(|(now, then)| now - then);
    let busy = |share| quantile(times.iter().map(|t| t.busy * 1e3), share).unwrap_or(0.0);
    let whole = quantile(times.iter().map(|t| t.whole * 1e3), 0.5);
    FrameCost {
        what,
        num_frames: times.len(),
        busy_p50_ms: busy(0.5),
        busy_p95_ms: busy(0.95),
        all_threads_mean_ms: spent.map(|s| s * 1e3 / num_frames.max(1) as f64),
        paced_p50_ms: whole.filter(|_| pace == Pace::InStep),
        detail: f64::from(window.window().detail_of_view()),
    }
}
