//! Processor time, which other load on the machine does not lengthen.

use std::{
    fs,
    time::{Duration, Instant},
};

#[cfg(target_os = "linux")]
use rustix::time::{ClockId, clock_gettime};

/// Returns the processor time of this thread so far, seconds; `None` where the system does not report it.
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

/// Returns the processor time of all threads of this process so far, seconds, including drawing by a software driver;
/// `None` where the system does not report it.
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

/// Returns how long this thread has been runnable but waiting for a core so far, seconds; `None` where the system does
/// not report it.
pub fn cpu_wait_seconds() -> Option<f64> {
    // Nanoseconds running, nanoseconds waiting, number of time slices.
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let waited: f64 = text.split_whitespace().nth(1)?.parse().ok()?;
    Some(waited / 1e9)
}

/// Measures the processor time of the thread that started it, or wall-clock time where the system reports none.
#[derive(Clone, Copy, Debug)]
pub struct ProcessorWatch {
    begun: Instant,
    thread_seconds: Option<f64>,
}

impl ProcessorWatch {
    /// Starts measuring.
    pub fn start() -> Self {
        Self {
            begun: Instant::now(),
            thread_seconds: thread_seconds(),
        }
    }

    /// Returns the time since the start; call it on the same thread.
    pub fn elapsed(&self) -> Duration {
        match (self.thread_seconds, thread_seconds()) {
            (Some(before), Some(now)) => Duration::from_secs_f64((now - before).max(0.0)),
            _ => self.begun.elapsed(),
        }
    }
}
