//! Counts of a server's inspections since its start.

use std::time::Duration;

use super::answer::VerdictCode;

/// Number of inspected parts by verdict, and how long their triggers waited.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    verdicts: [u64; Self::VERDICTS.len()],
    num_triggers: u64,
    within: [u64; Self::BOUNDS_S.len()],
    sum: Duration,
}

impl Tally {
    /// The verdicts that are counted.
    pub const VERDICTS: [VerdictCode; 5] = [
        VerdictCode::Accepted,
        VerdictCode::Refused,
        VerdictCode::NoPart,
        VerdictCode::Stale,
        VerdictCode::Error,
    ];

    /// Upper bounds of the waiting times that are counted, seconds. An inspection takes about 10 ms, waiting for a Kinect's
    /// frame 30 to 70 ms, and `--frame-timeout` is 5 s by default.
    pub const BOUNDS_S: [f64; 9] = [0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0];

    /// Counts the parts of a frame by their verdicts; `waited` is the time from the trigger to the verdicts.
    pub(super) fn add(&mut self, verdicts: impl Iterator<Item = VerdictCode>, waited: Duration) {
        for verdict in verdicts {
            for (count, counted) in self.verdicts.iter_mut().zip(Self::VERDICTS) {
                *count += u64::from(verdict == counted);
            }
        }
        self.num_triggers += 1;
        for (count, bound) in self.within.iter_mut().zip(Self::BOUNDS_S) {
            *count += u64::from(waited.as_secs_f64() <= bound);
        }
        self.sum += waited;
    }

    /// Number of inspected parts by verdict.
    pub fn by_verdict(&self) -> impl Iterator<Item = (VerdictCode, u64)> {
        Self::VERDICTS.into_iter().zip(self.verdicts)
    }

    /// For each of [`Self::BOUNDS_S`], how many triggers waited no longer than that.
    pub fn waited_within(&self) -> impl Iterator<Item = (f64, u64)> {
        Self::BOUNDS_S.into_iter().zip(self.within)
    }

    /// Number of all triggers that were inspected.
    pub fn num_triggers(&self) -> u64 {
        self.num_triggers
    }

    /// Total waiting time of all triggers, seconds.
    pub fn waited_s(&self) -> f64 {
        self.sum.as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_counts_once_and_each_trigger_in_every_bound_that_it_kept() {
        let mut tally = Tally::default();
        let mut add =
            |verdicts: &[VerdictCode], waited| tally.add(verdicts.iter().copied(), waited);
        add(&[VerdictCode::Accepted], Duration::from_millis(50));
        add(
            &[VerdictCode::Accepted, VerdictCode::Refused],
            Duration::from_millis(300),
        );
        add(&[VerdictCode::Stale], Duration::from_mins(1));
        let counts: Vec<u64> = tally.by_verdict().map(|(_, count)| count).collect();
        assert_eq!(counts, [2, 1, 0, 1, 0]);
        let within: Vec<u64> = tally.waited_within().map(|(_, count)| count).collect();
        assert_eq!(within, [0, 1, 1, 1, 2, 2, 2, 2, 2]);
        assert_eq!(tally.num_triggers(), 3);
        assert!((tally.waited_s() - 60.35).abs() < 1e-9);
    }
}
