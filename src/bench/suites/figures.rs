//! What a suite came to in figures: accepted where enough is in sight, poses and their bounds, segmentation, time.

use serde::Serialize;

use super::{Suite, SuiteCase, SuiteResult};
use crate::bench::speed::quantile;

/// From this share of the part in sight on it is meant to be accepted.
const ENOUGH_IN_SIGHT: f64 = 0.4;
/// A segmentation this good leaves the outline alone.
const GOOD_IOU: f64 = 0.9;

/// The figures of one suite. Shares of nothing are left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteFigures {
    /// The suite.
    pub suite: Suite,
    /// Frames with at least 40 % of an enrolled part in sight.
    pub num_in_sight: usize,
    /// Of these the ones named rightly.
    pub num_in_sight_right: usize,
    /// Of these the ones named rightly and accepted.
    pub num_in_sight_accepted: usize,
    /// Of all frames those accepted as what they are not.
    pub num_wrong_accepted: usize,
    /// Of all frames those named rightly and accepted.
    pub num_accepted: usize,
    /// Of these the ones within 2° and 10 mm.
    pub num_accepted_well_placed: usize,
    /// Of these the ones whose pose has bounds.
    pub num_bounded: usize,
    /// Of these the ones whose pose is within both bounds.
    pub num_bounds_hold: usize,
    /// Of the frames that show the part, the intersection over union of what was taken for it: median.
    pub iou_median: Option<f64>,
    /// The 5 % quantile of the same.
    pub iou_p05: Option<f64>,
    /// Share of these frames at 0.9 and more.
    pub iou_good: Option<f64>,
    /// Time of an inspection, milliseconds: median.
    pub median_ms: Option<f64>,
    /// 95 % quantile.
    pub p95_ms: Option<f64>,
    /// Longest.
    pub max_ms: Option<f64>,
}

impl SuiteFigures {
    /// Of the cases of a suite.
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
