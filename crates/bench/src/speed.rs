//! Stage times compared with their budgets.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use geometry::statistics::quantile;
use inspection::pipeline::Timings;

/// Times of one stage over many inspections.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StageTimes {
    /// Name of the stage as in reports, or of two that share a budget.
    pub stage: &'static str,
    /// Median, milliseconds.
    pub median_ms: f64,
    /// 95th percentile, milliseconds.
    pub p95_ms: f64,
    /// Budget of the design, milliseconds.
    pub budget_ms: f64,
}

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

/// Returns medians and 95th percentiles per stage; empty without timings.
pub fn stage_times(timings: &[Timings]) -> Vec<StageTimes> {
    type Pick = fn(&Timings) -> Duration;
    let columns: [(&'static str, f64, Pick); 6] = [
        ("segment", 2.5, |t| t.segment),
        ("project", 0.5, |t| t.project),
        ("contour", 0.3, |t| t.contour),
        ("signature + rank", 0.2, |t| t.signature + t.rank),
        ("pose", 8.0, |t| t.pose),
        ("total", 12.0, |t| t.total),
    ];
    columns
        .into_iter()
        .filter_map(|(stage, budget_ms, of)| {
            let ms = || timings.iter().map(|t| of(t).as_secs_f64() * 1e3);
            Some(StageTimes {
                stage,
                median_ms: quantile(ms(), 0.5)?,
                p95_ms: quantile(ms(), 0.95)?,
                budget_ms,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
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
