//! Times of whole inspections, compared with an earlier run.

use serde::{Deserialize, Serialize};

use geometry::statistics::quantile;
use inspection::pipeline::Timings;

/// Times of whole inspections of one set of frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetTimes {
    /// Name of the suite, or `files`.
    pub set: String,
    /// Number of inspections.
    pub num_frames: usize,
    /// Median, milliseconds.
    pub median_ms: f64,
    /// 95th percentile, milliseconds.
    pub p95_ms: f64,
    /// Maximum, milliseconds.
    pub longest_ms: f64,
}

impl SetTimes {
    /// Summarises these inspections; `None` if there are none.
    pub fn of(set: &str, timings: &[Timings]) -> Option<Self> {
        let ms = || timings.iter().map(|t| t.total.as_secs_f64() * 1e3);
        Some(Self {
            set: set.to_owned(),
            num_frames: timings.len(),
            median_ms: quantile(ms(), 0.5)?,
            p95_ms: quantile(ms(), 0.95)?,
            longest_ms: quantile(ms(), 1.0)?,
        })
    }

    /// Returns the ratios to the other times: median, 95th percentile, maximum.
    pub fn against(&self, other: &Self) -> [f64; 3] {
        [
            self.median_ms / other.median_ms,
            self.p95_ms / other.p95_ms,
            self.longest_ms / other.longest_ms,
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn sets_are_compared_by_ratios() {
        let of = |ms: &[u64]| {
            let timings = ms.iter().map(|&ms| Timings {
                total: Duration::from_millis(ms),
                ..Timings::default()
            });
            SetTimes::of("booth", &timings.collect::<Vec<_>>())
        };
        let (old, new) = (of(&[10, 20, 40]).unwrap(), of(&[10, 10, 60]).unwrap());
        assert_eq!(new.num_frames, 3);
        for (ratio, expected) in new.against(&old).into_iter().zip([0.5, 1.5, 1.5]) {
            assert!((ratio - expected).abs() < 1e-9, "{ratio}");
        }
        assert_eq!(of(&[]), None);
    }
}
