//! Live on the simulated cell for minutes: is the rate held, does the memory grow, is the window's thread ever busy?

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use serde::Serialize;

use super::{HeadlessWindow, Pace};
use crate::{
    app::{
        shell::{
            action::Action,
            live::{LiveAction, LiveStatus},
        },
        ui::viewport::ViewError,
        window::WindowOptions,
    },
    bench::{cpu_wait_seconds, quantile},
};

/// What one stretch of time was like.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LiveSample {
    /// When it ended, seconds from the beginning.
    pub until_s: f64,
    /// Frames a second that came, and that were inspected.
    pub captured_per_s: f64,
    /// The same of those inspected.
    pub inspected_per_s: f64,
    /// From a frame's arrival to its verdict, median of the last ones, milliseconds.
    pub latency_ms: f64,
    /// Frames that the window drew.
    pub num_drawn: usize,
    /// Processor time of the window's thread in a frame that shows a new result, median, milliseconds.
    pub busy_p50_ms: f64,
    /// The same, 95th percentile.
    pub busy_p95_ms: f64,
    /// The longest that the window's thread was away, milliseconds of the clock.
    pub longest_ms: f64,
    /// How much of that it could have gone on, and waited for a core that others had; `None` where the system does not
    /// tell.
    pub longest_waited_ms: Option<f64>,
    /// Memory of the process at the end, megabytes; `None` where the system does not tell.
    pub memory_mb: Option<f64>,
}

/// The window's size, logical pixels.
const SIZE: [u32; 2] = [1440, 900];
/// How often a display shows a picture.
const TICK: Duration = Duration::from_micros(16_667);

/// Follows the simulated line in a window without a display, and tells of every stretch as it ends.
pub fn live_stretches(
    num_stretches: usize,
    stretch: Duration,
    mut told: impl FnMut(&LiveSample),
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
            memory_mb: memory_mb(),
        };
        before = now;
        told(&found);
        stretches.push(found);
    }
    Ok(stretches)
}

/// Frames that came and frames that were inspected since following began.
fn seen(status: &LiveStatus) -> (u64, u64) {
    (
        status.num_inspected + status.num_dropped,
        status.num_inspected,
    )
}

/// A frame of the window's thread.
#[derive(Clone, Copy, Default)]
struct UiThreadTime {
    /// By the clock, seconds.
    whole_s: f64,
    /// Of that, how long it waited for a core.
    waited_s: Option<f64>,
}

/// Draws as a display would have it; the busy times of the frames with a new result, milliseconds, and the longest frame.
fn draw_until(window: &mut HeadlessWindow, end: Instant) -> (Vec<f64>, UiThreadTime) {
    let mut busy = Vec::new();
    let mut longest = UiThreadTime::default();
    let generation = |window: &HeadlessWindow| {
        let shown = window.window().state().session.shown.as_ref();
        shown.map(|shown| shown.generation)
    };
    while Instant::now() < end {
        let before = generation(window);
        let waited_before = cpu_wait_seconds();
        let began = Instant::now();
        let time = window.frame(Vec::new(), Pace::Ahead);
        let whole_s = began.elapsed().as_secs_f64();
        if whole_s > longest.whole_s {
            let waited = cpu_wait_seconds().zip(waited_before);
            let waited_s = waited.map(|(now, before)| now - before);
            longest = UiThreadTime { whole_s, waited_s };
        }
        if generation(window) != before {
            busy.push(time.busy * 1e3);
        }
        // Outside the time taken: a device that is behind must not fill the memory.
        window.wait();
        thread::sleep(TICK.saturating_sub(began.elapsed()));
    }
    (busy, longest)
}

/// Memory of this process that is in use, megabytes.
fn memory_mb() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}
