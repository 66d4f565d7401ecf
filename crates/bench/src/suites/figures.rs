//! Figures of a suite: acceptance rate, pose errors and bounds, segmentation, time.

use serde::Serialize;

use super::{Suite, SuiteCase, SuiteResult};
use geometry::statistics::quantile;

/// Visible share of the part from which on it should be accepted.
const ENOUGH_IN_SIGHT: f64 = 0.4;
/// Intersection over union from which on a segmentation leaves the outline intact.
const GOOD_IOU: f64 = 0.9;

/// Figures of one suite. Quantities without cases are `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteFigures {
    /// The suite.
    pub suite: Suite,
    /// Frames with at least 40 % of an enrolled part in sight.
    pub num_in_sight: usize,
    /// Of the frames in sight, those named correctly.
    pub num_in_sight_right: usize,
    /// Of the frames in sight, those named correctly and accepted.
    pub num_in_sight_accepted: usize,
    /// Of all frames, the false accepts.
    pub num_wrong_accepted: usize,
    /// Of all frames, those named correctly and accepted.
    pub num_accepted: usize,
    /// Of the accepted frames, those within 2° and 10 mm.
    pub num_accepted_well_placed: usize,
    /// Of the accepted frames, those whose pose has bounds.
    pub num_bounded: usize,
    /// Of the accepted frames, those whose pose error is within both bounds.
    pub num_bounds_hold: usize,
    /// Median intersection over union, over the frames that show the part.
    pub iou_median: Option<f64>,
    /// 5th percentile of the intersection over union.
    pub iou_p05: Option<f64>,
    /// Share of the frames with an intersection over union of at least 0.9.
    pub iou_good: Option<f64>,
    /// Median time of an inspection, milliseconds.
    pub median_ms: Option<f64>,
    /// 95th percentile of the time, milliseconds.
    pub p95_ms: Option<f64>,
    /// Longest time, milliseconds.
    pub max_ms: Option<f64>,
}

impl SuiteFigures {
    /// Computes the figures of a suite.
    pub fn of(result: &SuiteResult) -> Self {
        let is_in_sight =
            |c: &SuiteCase| c.expected.is_some() && c.visible_share >= ENOUGH_IN_SIGHT;
        let is_accepted = |c: &SuiteCase| c.accepted && c.expected.is_some() && c.is_right();
        let ious = || result.cases.iter().filter_map(|case| case.part_iou);
        let num_good = ious().filter(|iou| *iou >= GOOD_IOU).count();
        let num_ious = ious().count();
        Self {
            suite: result.suite,
            num_in_sight: result.num(is_in_sight),
            num_in_sight_right: result.num(|c| is_in_sight(c) && c.is_right()),
            num_in_sight_accepted: result.num(|c| is_in_sight(c) && is_accepted(c)),
            num_wrong_accepted: result.num(SuiteCase::is_wrong_accepted),
            num_accepted: result.num(is_accepted),
            num_accepted_well_placed: result.num(|c| is_accepted(c) && c.is_well_placed()),
            num_bounded: result.num(|c| is_accepted(c) && c.bounds.is_some()),
            num_bounds_hold: result
                .num(|c| is_accepted(c) && c.bounds.is_some_and(|bounds| bounds.hold())),
            iou_median: quantile(ious(), 0.5),
            iou_p05: quantile(ious(), 0.05),
            iou_good: (num_ious > 0).then(|| num_good as f64 / num_ious as f64),
            median_ms: result.ms_quantile(0.5),
            p95_ms: result.ms_quantile(0.95),
            max_ms: result.ms_quantile(1.0),
        }
    }
}
