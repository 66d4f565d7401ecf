//! Processor time, which others at work on the machine do not lengthen.

use std::{
    fs,
    time::{Duration, Instant},
};

#[cfg(target_os = "linux")]
use rustix::time::{ClockId, clock_gettime};

/// Processor time of this thread so far, seconds; `None` where the system does not tell.
#[cfg_attr(
    target_os = "linux",
    expect(
        clippy::unnecessary_wraps,
        reason = "elsewhere the system does not tell"
    )
)]
fn thread_seconds() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return Some(seconds(ClockId::ThreadCPUTime));
    #[cfg(not(target_os = "linux"))]
    None
}

/// Processor time of all threads of this process so far, seconds: with a software driver the drawing is in it. `None`
/// where the system does not tell.
pub fn process_seconds() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return Some(seconds(ClockId::ProcessCPUTime));
    #[cfg(not(target_os = "linux"))]
    None
}

#[cfg(target_os = "linux")]
fn seconds(clock: ClockId) -> f64 {
    let now = clock_gettime(clock);
    now.tv_sec as f64 + now.tv_nsec as f64 / 1e9
}

/// Seconds that this thread could have run so far, and waited for a core that others had; `None` where the system does
/// not tell.
pub fn cpu_wait_seconds() -> Option<f64> {
    // Nanoseconds run, nanoseconds waited, turns taken.
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let waited: f64 = text.split_whitespace().nth(1)?.parse().ok()?;
    Some(waited / 1e9)
}

/// Counts the processor time of the thread that started it; the clock's where the system does not tell.
#[derive(Clone, Copy, Debug)]
pub struct ProcessorWatch {
    begun: Instant,
    thread_seconds: Option<f64>,
}

impl ProcessorWatch {
    /// Begins to count.
    pub fn start() -> Self {
        Self {
            begun: Instant::now(),
            thread_seconds: thread_seconds(),
        }
    }

    /// What was spent since the start, to be asked on the same thread.
    pub fn elapsed(&self) -> Duration {
        match (self.thread_seconds, thread_seconds()) {
            (Some(before), Some(now)) => Duration::from_secs_f64((now - before).max(0.0)),
            _ => self.begun.elapsed(),
        }
    }
}
