//! How far the frames of a scan, each by itself and at the robot's pose of its camera, disagree about where the part is.
//!
//! The frames' surfaces can be aligned to each other with poses that disagree along them: the part in each frame shows it.
//! Errors that differ from frame to frame average out. A drift does not: if the arm warms up or the calibration slips, the
//! poses move steadily from frame to frame, and only the first or the last one may be right. So the placements are split
//! into a line over the frames' numbers (least squares) and the scatter about it. A single frame that is far off widens the
//! scatter, so that it may hide the line, but counts by itself.
//!
//! Known limit: the steps of a drift that is no line, such as a slip of the calibration between two frames, count less.

use nalgebra::{Point3, Vector3};

use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};
use stages::pose::{PoseEstimate, Uncertainty};

/// Where one frame by itself puts a part, from where all frames together put it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// Number of the frame's shot.
    number: usize,
    /// Motion of the middle of the part, base frame, metres.
    shift: Vector3<f64>,
    /// Rotation vector, base frame, radians.
    turn: Vector3<f64>,
    /// Bounds of the frame's own pose.
    bounds: Uncertainty,
}

impl Placement {
    /// Compares a frame's own pose with that of all frames. `middle` is the middle of the part, base frame. `None` without
    /// bounds of the own pose.
    pub(super) fn of(
        number: usize,
        base_from_camera: &RigidTransform,
        own: &PoseEstimate,
        part_from_base: &RigidTransform,
        middle: &Point3<f64>,
    ) -> Option<Self> {
        let moved = base_from_camera * own.camera_from_part() * part_from_base;
        Some(Self {
            number,
            shift: moved * middle - middle,
            turn: moved.rotation.scaled_axis(),
            bounds: own.bounds()?,
        })
    }
}

/// Returns how far the placements are from the pose of all frames beyond what their own bounds explain: the farthest by
/// itself, or the end of their drift. `numbers` are the numbers of the first and last frame that was used.
pub(super) fn disagreement(placements: &[Placement], numbers: [usize; 2]) -> PoseDelta {
    let of = |value: fn(&Placement) -> Vector3<f64>, bound: fn(&Placement) -> f64| {
        let beyond = placements.iter().map(|p| value(p).norm() - bound(p));
        let farthest = beyond.fold(0.0, f64::max);
        let values: Vec<(f64, Vector3<f64>)> = placements
            .iter()
            .map(|p| (p.number as f64, value(p)))
            .collect();
        let mut bounds: Vec<f64> = placements.iter().map(bound).collect();
        bounds.sort_by(f64::total_cmp);
        let explained = bounds.get(bounds.len() / 2);
        let drift = explained.and_then(|explained| drift(&values, *explained, numbers));
        drift.unwrap_or(0.0).max(farthest)
    };
    PoseDelta {
        shift: Metres(of(|p| p.shift, |p| p.bounds.shift.0)),
        rotation: Radians(of(|p| p.turn, |p| p.bounds.turn.0)),
    }
}

/// Least squared length of a drift at its end, as a multiple of the mean that scatter alone gives.
const MIN_SIGNIFICANCE: f64 = 2.0;
/// Square of the length that a vector of three normal variables of variance 1 keeps below in 95 of 100 cases.
const WITHIN_95_SQ: f64 = 7.81;

/// Returns the length at the end of a line through values at these numbers, with the 95 % bound of the mean's scatter about
/// it; `None` if it is no longer than `explained`, or no longer than scatter explains.
fn drift(values: &[(f64, Vector3<f64>)], explained: f64, numbers: [usize; 2]) -> Option<f64> {
    let num = values.len() as f64;
    let mean_number = values.iter().map(|(number, _)| number).sum::<f64>() / num;
    let mean = values.iter().map(|(_, value)| value).sum::<Vector3<f64>>() / num;
    let from_mean = || values.iter().map(|(number, v)| (number - mean_number, v));
    let square: f64 = from_mean().map(|(t, _)| t * t).sum();
    if values.len() < 2 || square <= 0.0 {
        return None;
    }
    let slope = from_mean().map(|(t, v)| v * t).sum::<Vector3<f64>>() / square;
    let ends = numbers.map(|number| number as f64 - mean_number);
    let length = ends.map(|t| (mean + slope * t).norm());
    let length = length[0].max(length[1]);
    let rest = from_mean().map(|(t, v)| (v - mean - slope * t).norm_squared());
    // Two values lie on their line.
    let variance = rest.sum::<f64>() / (num - 2.0).max(1.0);
    let by_scatter_sq = variance * (ends[0] * ends[0]).max(ends[1] * ends[1]) / square;
    let is_drift = length > explained && length * length > MIN_SIGNIFICANCE * by_scatter_sq;
    is_drift.then(|| length.hypot((WITHIN_95_SQ / 3.0 * variance / num).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The drift of values along y, one for each frame, millimetres.
    fn drift_mm(values: &[f64], explained: f64) -> Option<f64> {
        let values: Vec<(f64, Vector3<f64>)> = values
            .iter()
            .enumerate()
            .map(|(k, mm)| (k as f64, Vector3::new(0.0, mm / 1e3, 0.0)))
            .collect();
        let found = drift(
            &values,
            explained / 1e3,
            [0, values.len().saturating_sub(1)],
        );
        found.map(|metres| metres * 1e3)
    }

    #[test]
    fn values_on_a_line_drift_as_far_as_its_end() {
        for values in [&[-9.0, 9.0][..], &[-9.0, 0.0, 9.0], &[-9.0, -3.0, 3.0, 9.0]] {
            let found = drift_mm(values, 3.0).expect("a drift");
            assert!((found - 9.0).abs() < 1e-9, "{found}");
        }
        // The end of the line counts, not how far it is from the mean.
        let found = drift_mm(&[-4.0, 2.0, 8.0], 3.0).expect("a drift");
        assert!((found - 8.0).abs() < 1e-9, "{found}");
        assert_eq!(drift_mm(&[-9.0, 9.0], 10.0), None);
        assert_eq!(drift_mm(&[], 0.0).or(drift_mm(&[5.0], 0.0)), None);
    }

    #[test]
    fn scatter_is_no_drift_but_adds_to_one() {
        assert_eq!(drift_mm(&[4.0, -4.0, 4.0, -4.0], 0.0), None);
        assert_eq!(drift_mm(&[0.0, 20.0, 0.0, 0.0], 0.0), None);
        // The line ends at 10.8; the rest has a sum of squares of 10.8, over two frames more than a line needs. The scatter
        // of the mean of four is below the square root of 7.81 / 3 · 5.4 / 4 in 95 of 100 cases.
        let found = drift_mm(&[-9.0, -6.0, 3.0, 12.0], 3.0).expect("a drift");
        let expected = 10.8_f64.hypot((7.81_f64 / 3.0 * 5.4 / 4.0).sqrt());
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}
