//! Runs Live on the simulated cell for minutes and measures whether the rate holds, the memory grows or the window's thread is
//! blocked.

use std::{
    thread,
    time::{Duration, Instant},
};

use serde::Serialize;

use crate::{
    process_usage::ProcessUsage,
    processor_time::{ProcessorWatch, cpu_wait_seconds},
    window_cost::SIZE,
};
use app::{WindowOptions, headless::HeadlessWindow};
use geometry::statistics::quantile;
use shell::{
    action::Action,
    source::live::{LiveAction, LiveStatus},
};
use ui::viewport::ViewError;

/// Measurements of one stretch of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LiveSample {
    /// End of the stretch, seconds from the beginning.
    pub until_s: f64,
    /// Frames per second that arrived.
    pub captured_per_s: f64,
    /// Frames per second that were inspected.
    pub inspected_per_s: f64,
    /// Median time from a frame's arrival to its verdict over the last frames, milliseconds.
    pub latency_ms: f64,
    /// Number of frames that the window drew.
    pub num_drawn: usize,
    /// Median processor time of the window's thread in a frame that shows a new result, milliseconds.
    pub busy_p50_ms: f64,
    /// 95th percentile of the same.
    pub busy_p95_ms: f64,
    /// Longest time that the window's thread was busy with one frame, milliseconds of elapsed time.
    pub longest_ms: f64,
    /// Part of that time in which the thread was ready but waited for a free core; `None` if the system does not report it.
    pub longest_waited_ms: Option<f64>,
    /// Memory of the process at the end, megabytes; `None` if the system does not report it.
    pub memory_mb: Option<f64>,
}

/// Refresh interval of a display.
const TICK: Duration = Duration::from_micros(16_667);

/// Follows the simulated line in a window without a display, and reports every stretch to `observer` as it ends.
pub fn live_stretches(
    num_stretches: usize,
    stretch: Duration,
    mut observer: impl FnMut(&LiveSample),
) -> Result<Vec<LiveSample>, ViewError> {
    let mut window = HeadlessWindow::open(SIZE, WindowOptions::default())?;
    window.settle();
    window.act(Action::Live(LiveAction::Toggle));
    let begun = Instant::now();
    let mut stretches: Vec<LiveSample> = Vec::new();
    let mut before = (0, 0);
    for number in 1..=num_stretches as u32 {
        let end = begun + stretch * number;
        let (busy, longest) = draw_until(&mut window, end);
        let status = window.window().state().session.live.status.clone();
        let now = status.as_ref().map_or(before, seen);
        let share = |share| quantile(busy.iter().copied(), share).unwrap_or(0.0);
        let latency = status.and_then(|status| status.latency);
        let per_second = |num: u64| num as f64 / stretch.as_secs_f64();
        let found = LiveSample {
            until_s: begun.elapsed().as_secs_f64(),
            captured_per_s: per_second(now.0 - before.0),
            inspected_per_s: per_second(now.1 - before.1),
            latency_ms: latency.map_or(0.0, |latency| latency.as_secs_f64() * 1e3),
            num_drawn: busy.len(),
            busy_p50_ms: share(0.5),
            busy_p95_ms: share(0.95),
            longest_ms: longest.whole_s * 1e3,
            longest_waited_ms: longest.waited_s.map(|waited| waited * 1e3),
            memory_mb: ProcessUsage::now().map(|usage| usage.memory_mb),
        };
        before = now;
        observer(&found);
        stretches.push(found);
    }
    Ok(stretches)
}

/// Number of frames that arrived and that were inspected since following began.
fn seen(status: &LiveStatus) -> (u64, u64) {
    (
        status.num_inspected + status.num_dropped,
        status.num_inspected,
    )
}

/// Time of the window's thread for one frame.
#[derive(Clone, Copy, Default)]
struct UiThreadTime {
    /// Elapsed time, seconds.
    whole_s: f64,
    /// Part of it spent waiting for a core, seconds.
    waited_s: Option<f64>,
}

/// Draws frames at a display's rate. Returns the processor times of the frames with a new result, milliseconds, and the
/// longest frame.
fn draw_until(window: &mut HeadlessWindow, end: Instant) -> (Vec<f64>, UiThreadTime) {
    let mut busy = Vec::new();
    let mut longest = UiThreadTime::default();
    while Instant::now() < end {
        let before = window.generation();
        let waited_before = cpu_wait_seconds();
        let (began, watch) = (Instant::now(), ProcessorWatch::start());
        window.draw(Vec::new());
        let busy_s = watch.elapsed().as_secs_f64();
        let whole_s = began.elapsed().as_secs_f64();
        if whole_s > longest.whole_s {
            let waited = cpu_wait_seconds().zip(waited_before);
            let waited_s = waited.map(|(now, before)| now - before);
            longest = UiThreadTime { whole_s, waited_s };
        }
        if window.generation() != before {
            busy.push(busy_s * 1e3);
        }
        // Not measured: keeps the queue of a slow device from filling the memory.
        window.wait();
        thread::sleep(TICK.saturating_sub(began.elapsed()));
    }
    (busy, longest)
}
