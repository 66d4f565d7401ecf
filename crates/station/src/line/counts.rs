//! The counts of an encoder as a controller sends them, and the counts in between.

use std::{collections::VecDeque, time::Duration};

use super::Moment;
use robot::line::Counter;

/// The last counts and when they were read.
#[derive(Clone, Debug, Default)]
pub struct CountLog {
    counter: Counter,
    readings: VecDeque<(Duration, i64)>,
}

/// Most readings that are kept.
const MAX_READINGS: usize = 64;
/// Time beyond the last reading, and between two, over which the count is taken to go on evenly.
const MAX_GAP: Duration = Duration::from_secs(2);

impl CountLog {
    /// No counts of this counter yet.
    pub fn new(counter: Counter) -> Self {
        Self {
            counter,
            readings: VecDeque::new(),
        }
    }

    /// Takes in a count that was read at this time, by the camera's clock, and returns it without beginning again.
    pub fn read(&mut self, at: Duration, count: i64) -> i64 {
        let last = self.readings.back();
        let count = last.map_or(count, |(_, last)| self.counter.continued(*last, count));
        if last.is_none_or(|(last, _)| at > *last) {
            self.readings.push_back((at, count));
        }
        if self.readings.len() > MAX_READINGS {
            self.readings.pop_front();
        }
        count
    }

    /// The time and the count then, if they can be told. `speed` is that of the line in counts per second, if it is known.
    pub fn moment(&self, at: Duration, speed: Option<f64>) -> Moment {
        Moment {
            at,
            count: self.count_at(at, speed),
        }
    }

    fn count_at(&self, at: Duration, speed: Option<f64>) -> Option<f64> {
        let next = self.readings.partition_point(|(read, _)| *read < at);
        let seconds = |from: Duration| at.as_secs_f64() - from.as_secs_f64();
        let between = |a: (Duration, i64), b: (Duration, i64)| {
            let apart = b.0.checked_sub(a.0).filter(|apart| *apart <= MAX_GAP)?;
            let rate = (b.1 - a.1) as f64 / apart.as_secs_f64();
            Some(a.1 as f64 + rate * seconds(a.0))
        };
        let reading = |index: usize| self.readings.get(index).copied();
        if let (Some(before), Some(after)) = (next.checked_sub(1).and_then(reading), reading(next))
        {
            return between(before, after);
        }
        // Before the first or beyond the last.
        let nearest = reading(next).or_else(|| self.readings.back().copied())?;
        if seconds(nearest.0).abs() > MAX_GAP.as_secs_f64() {
            return None;
        }
        if seconds(nearest.0) == 0.0 {
            return Some(nearest.1 as f64);
        }
        let last_two = next.checked_sub(2).and_then(reading);
        let evenly = last_two.and_then(|before| between(before, nearest));
        evenly.or_else(|| Some(nearest.1 as f64 + speed? * seconds(nearest.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn counts_between_and_shortly_beyond_the_readings_are_known() {
        let mut log = CountLog::new(Counter::Bits16);
        assert_eq!(log.moment(at(0), Some(10.0)).count, None);
        assert_eq!(log.read(at(1000), 65_000), 65_000);
        assert_eq!(log.moment(at(1000), None).count, Some(65_000.0));
        assert_eq!(log.moment(at(1500), Some(200.0)).count, Some(65_100.0));
        assert_eq!(log.moment(at(1500), None).count, None);
        assert_eq!(log.read(at(2000), 264), 65_800);
        let close = |ms: u64, count: f64| {
            let found = log.moment(at(ms), None).count.expect("known");
            assert!((found - count).abs() < 1e-6, "{found}");
        };
        close(1500, 65_400.0);
        close(2000, 65_800.0);
        close(2500, 66_200.0);
        assert_eq!(log.moment(at(4500), None).count, None, "too long ago");
    }
}
