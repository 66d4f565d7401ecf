//! Rate of events.

use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

/// The rate of the last few events, for display: steady, and gone when events stop.
#[derive(Clone, Debug, Default)]
pub struct FrameRate {
    times: VecDeque<Instant>,
}

/// Number of events over which the rate is averaged: one second of a camera.
const WINDOW_EVENTS: usize = 31;
/// There is no rate after this time without an event.
const MAX_GAP: Duration = Duration::from_secs(3);

impl FrameRate {
    /// Counts an event.
    pub fn came(&mut self, at: Instant) {
        if self.times.len() == WINDOW_EVENTS {
            self.times.pop_front();
        }
        self.times.push_back(at);
    }

    /// Events per second; `None` before the second event, and after a while without events.
    pub fn per_second(&self, now: Instant) -> Option<f64> {
        let (first, last) = (self.times.front()?, self.times.back()?);
        let num_gaps = self.times.len().checked_sub(1).filter(|&n| n > 0)?;
        // A slow source may pause longer than that: allow ten of its average intervals.
        let gap = (*last - *first) / num_gaps as u32;
        if now.saturating_duration_since(*last) > MAX_GAP.max(10 * gap) {
            return None;
        }
        let seconds = (*last - *first).as_secs_f64();
        (seconds > 0.0).then(|| num_gaps as f64 / seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_last_second_and_ends_with_the_events() {
        let start = Instant::now();
        let mut rate = FrameRate::default();
        assert_eq!(rate.per_second(start), None);
        for k in 0..10 {
            rate.came(start + Duration::from_millis(500 * k));
        }
        let mut at = start + Duration::from_secs(5);
        for _ in 0..40 {
            at += Duration::from_millis(40);
            rate.came(at);
        }
        let found = rate.per_second(at).unwrap();
        assert!((found - 25.0).abs() < 1e-6, "{found}");
        assert_eq!(rate.per_second(at + Duration::from_secs(4)), None);
    }

    #[test]
    fn a_slow_source_keeps_its_rate_between_its_events() {
        let start = Instant::now();
        let mut rate = FrameRate::default();
        for k in 0..3 {
            rate.came(start + Duration::from_secs(10 * k));
        }
        let found = rate.per_second(start + Duration::from_secs(29)).unwrap();
        assert!((found - 0.1).abs() < 1e-9);
    }
}
