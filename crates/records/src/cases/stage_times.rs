//! Stage times compared with their budgets.

use std::time::Duration;

use serde::Serialize;

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
