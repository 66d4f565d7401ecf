//! Processor time, which others at work on the machine do not lengthen.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

/// Processor time of this thread so far, seconds; `None` where there is no /proc.
fn thread_seconds() -> Option<f64> {
    // Linux brings the figure up to date when the thread gives way.
    thread::yield_now();
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds / 1e9)
}

/// Processor time of all threads of this process so far, seconds, in steps of ten milliseconds: with a software driver
/// the drawing is in it. `None` where there is no /proc.
pub fn process_seconds() -> Option<f64> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name, in brackets, may hold spaces; user and system time are the 12th and 13th fields after it.
    let fields = stat.rsplit(')').next()?.split_whitespace();
    let ticks = fields
        .skip(11)
        .take(2)
        .filter_map(|ticks| ticks.parse::<f64>().ok());
    Some(ticks.sum::<f64>() / TICKS_PER_SECOND)
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
