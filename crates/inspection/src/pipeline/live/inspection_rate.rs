//! How many of a camera's frames are inspected, by the frames' own times and numbers.

use std::{collections::VecDeque, time::Duration};

use crate::pipeline::Rejection;

/// Frames that a camera delivered in about a second, and those of them that were inspected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InspectionRate {
    /// Frames that were inspected.
    pub num_inspected: usize,
    /// Frames that the camera delivered.
    pub num_frames: usize,
}

impl InspectionRate {
    /// True if fewer than half of the frames are inspected.
    pub fn is_slow(self) -> bool {
        2 * self.num_inspected < self.num_frames
    }

    /// The refusal of a part that is not judged for it.
    pub fn refusal(self, part: String) -> Rejection {
        let Self {
            num_inspected,
            num_frames,
        } = self;
        Rejection::TooSlow {
            part,
            num_inspected,
            num_frames,
        }
    }
}

/// Time over which frames are counted, unless two inspected ones are further apart.
const WINDOW: Duration = Duration::from_secs(1);
/// Time that a verdict must have waited for a slow computer before the user is warned.
const PATIENCE: Duration = Duration::from_secs(2);

/// Counts the frames of one camera.
#[derive(Debug, Default)]
pub(super) struct InspectionRateMeter {
    /// Times and numbers of the inspected frames of the last second, and of the one before those.
    inspected: VecDeque<(Duration, u64)>,
    /// Since when a verdict has waited while fewer than half of the frames were inspected.
    waits_since: Option<Duration>,
}

impl InspectionRateMeter {
    /// Counts an inspected frame. `number` is counted by the camera, `waits` says whether a verdict on a part waits for further
    /// frames.
    pub(super) fn add(&mut self, at: Duration, number: u64, waits: bool) {
        let before = self.inspected.back().copied();
        if before.is_some_and(|(then, last)| then >= at || last >= number) {
            // The source was opened again, or a clock was set back.
            *self = Self::default();
        }
        self.inspected.push_back((at, number));
        while self.inspected.len() > 2 && self.inspected[1].0 + WINDOW <= at {
            self.inspected.pop_front();
        }
        self.waits_since = if waits && self.slow().is_some() {
            Some(self.waits_since.unwrap_or(at))
        } else {
            None
        };
    }

    /// The rate; `None` before the second frame.
    pub(super) fn rate(&self) -> Option<InspectionRate> {
        let (first, last) = (self.inspected.front()?, self.inspected.back()?);
        let num_inspected = self.inspected.len() - 1;
        (num_inspected > 0).then(|| InspectionRate {
            num_inspected,
            num_frames: usize::try_from(last.1 - first.1).unwrap_or(usize::MAX),
        })
    }

    /// The rate, if fewer than half of the frames are inspected.
    pub(super) fn slow(&self) -> Option<InspectionRate> {
        self.rate().filter(|rate| rate.is_slow())
    }

    /// The rate, if a verdict has waited for it long enough to tell.
    pub(super) fn holds_up(&self) -> Option<InspectionRate> {
        let (last, _) = self.inspected.back()?;
        let waited = last.saturating_sub(self.waits_since?);
        self.slow().filter(|_| waited >= PATIENCE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warnings after each inspected frame of a camera with 30 frames a second, of which one in `step` is inspected.
    fn warnings(step: u64, waits: impl Fn(f64) -> bool) -> Vec<(f64, Option<InspectionRate>)> {
        let mut meter = InspectionRateMeter::default();
        let frames = (0..300).step_by(step as usize).map(|number| {
            let at = Duration::from_secs(number) / 30;
            let seconds = at.as_secs_f64();
            meter.add(at, number, waits(seconds));
            (seconds, meter.holds_up())
        });
        frames.collect()
    }

    #[test]
    fn a_slow_computer_is_named_after_two_seconds_in_which_a_verdict_waits_and_no_longer() {
        let waits = |seconds: f64| (2.0..6.2).contains(&seconds);
        for (seconds, rate) in warnings(15, waits) {
            let expected = InspectionRate {
                num_inspected: 2,
                num_frames: 30,
            };
            let is_warned = (4.0..6.2).contains(&seconds);
            assert_eq!(rate, is_warned.then_some(expected), "after {seconds} s");
        }
        // Half of the frames are enough: no verdict waits.
        assert!(warnings(2, |_| true).iter().all(|(_, rate)| rate.is_none()));
        assert!(
            warnings(15, |_| false)
                .iter()
                .all(|(_, rate)| rate.is_none())
        );
    }

    #[test]
    fn frames_are_counted_from_the_second_on_whether_or_not_they_are_few() {
        let mut meter = InspectionRateMeter::default();
        assert_eq!(meter.rate(), None);
        for number in [0, 2, 3] {
            meter.add(Duration::from_secs(number) / 30, number, false);
        }
        let rate = meter.rate().expect("three frames");
        assert_eq!((rate.num_inspected, rate.num_frames), (2, 3));
        assert!(!rate.is_slow() && meter.slow().is_none());
    }

    #[test]
    fn frames_further_apart_than_the_window_count_from_the_one_before() {
        let of_slow = warnings(90, |_| true);
        let expected = InspectionRate {
            num_inspected: 1,
            num_frames: 90,
        };
        assert!(of_slow[..2].iter().all(|(_, rate)| rate.is_none()));
        assert!(of_slow[2..].iter().all(|(_, rate)| *rate == Some(expected)));
    }

    #[test]
    fn one_stall_of_three_seconds_says_nothing() {
        let mut meter = InspectionRateMeter::default();
        for number in (0..=60).chain(150..300) {
            meter.add(Duration::from_secs(number) / 30, number, true);
            assert_eq!(meter.holds_up(), None, "at frame {number}");
        }
    }

    #[test]
    fn a_source_that_is_opened_again_is_counted_anew() {
        let mut meter = InspectionRateMeter::default();
        for number in 1..8 {
            meter.add(Duration::from_millis(500 * number), 15 * number, true);
        }
        assert!(meter.holds_up().is_some());
        meter.add(Duration::from_secs(9), 1, true);
        assert_eq!((meter.slow(), meter.holds_up()), (None, None));
    }
}
