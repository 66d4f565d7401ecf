//! How late a camera gives its frames: the poses of a part that passed lag behind its counts, those after the line was stopped do not.

use nalgebra::Point3;

use super::{
    CountedPose, LineCalibration, LineFitError,
    fit::{BOUND_DEVIATIONS, DEFAULT_BOUND_M},
};

/// Fewest poses after the line was stopped.
pub const MIN_STOPPED: usize = 3;
/// Longest delay, seconds.
pub(super) const MAX_DELAY_S: f64 = 2.0;
/// Share by which the speed that a person gives may be wrong.
const SPEED_BOUND: f64 = 0.05;
/// Counts by which an encoder at rest may go on, in way of the line, metres.
const REST_M: f64 = 0.001;

impl LineCalibration {
    /// With the delay of the camera. The line was fitted to the poses of a part that passed with this speed, m/s, whose counts
    /// were read when their frames arrived; then it was stopped, and the same part was seen again. `middle` is the part's middle,
    /// part space, metres.
    pub fn with_delay(
        self,
        passed: &[CountedPose],
        stopped: &[CountedPose],
        middle: &Point3<f64>,
        speed: f64,
    ) -> Result<Self, LineFitError> {
        let found = stopped.len();
        if found < MIN_STOPPED {
            return Err(LineFitError::TooFewStopped { found });
        }
        let mut last = passed.first().map_or(0, |pose| pose.count);
        let begin = last;
        // How far each part is from where its count puts it, along the line, and its way by the counts.
        let mut off = |pose: &CountedPose| {
            last = self.counter.continued(last, pose.count);
            let way = (last - begin) as f64 * self.way_per_count.0;
            let place = (pose.camera_from_part * middle).coords;
            (place.dot(&self.direction) - way, way)
        };
        let moving: Vec<(f64, f64)> = passed.iter().map(&mut off).collect();
        let standing: Vec<(f64, f64)> = stopped.iter().map(&mut off).collect();
        let moved = (standing.iter().zip(stopped))
            .find(|((_, way), _)| (way - standing[0].1).abs() > REST_M);
        if let Some((_, pose)) = moved {
            return Err(LineFitError::NotStopped {
                name: pose.name.clone(),
                from: stopped[0].count,
                to: pose.count,
            });
        }
        let (before, after) = (Mean::new(&moving), Mean::new(&standing));
        let free = (before.num + after.num - 2.0).max(1.0);
        let scatter = ((before.squares + after.squares) / free).sqrt();
        let noise = BOUND_DEVIATIONS * scatter * (1.0 / before.num + 1.0 / after.num).sqrt();
        // Frames of a part at rest all show it in the same place, and their poses are off alike.
        let bounds = stopped.iter().map(|pose| pose.bound);
        let bounds = bounds.map(|bound| bound.map_or(DEFAULT_BOUND_M, |bound| bound.0));
        let alike = bounds.fold(0.0, f64::max);
        let way = after.way - before.way;
        let scale = way * self.scale_bound.hypot(self.slip);
        // Along the direction of a rising count.
        let velocity = speed * moving.last().map_or(1.0, |(_, way)| way.signum());
        let delay = (after.off - before.off) / velocity;
        let bound = (noise.hypot(alike).hypot(scale) / speed).hypot(SPEED_BOUND * delay);
        if !(-bound..=MAX_DELAY_S).contains(&delay) || bound > MAX_DELAY_S {
            return Err(LineFitError::Delay { delay, bound });
        }
        Ok(Self {
            delay: delay.max(0.0),
            delay_bound: bound,
            ..self
        })
    }
}

/// Means over poses.
struct Mean {
    num: f64,
    off: f64,
    way: f64,
    /// Sum of the squared distances from the mean.
    squares: f64,
}

impl Mean {
    fn new(poses: &[(f64, f64)]) -> Self {
        let num = poses.len().max(1) as f64;
        let off = poses.iter().map(|(off, _)| off).sum::<f64>() / num;
        Self {
            num,
            off,
            way: poses.iter().map(|(_, way)| way).sum::<f64>() / num,
            squares: poses.iter().map(|(one, _)| (one - off).powi(2)).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::line::{Counter, fit};
    use geometry::{error::Advice as _, rigid::RigidTransform};

    const PER_COUNT_M: f64 = 0.0001;

    /// Poses of a part that passes at 0.15 m/s, counted `delay` seconds too late, and then stands still.
    fn poses(delay: f64, sign: f64, seed: u64) -> (Vec<CountedPose>, Vec<CountedPose>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut pose = |way: f64, counted: f64, name: String| {
            let mut noise = || 0.001 * 3.0_f64.sqrt() * random.random_range(-1.0..1.0);
            let place = Vector3::new(-0.3 + way + noise(), noise(), 1.2 + noise());
            CountedPose {
                name,
                count: 70_000 + (sign * counted / PER_COUNT_M).round() as i64,
                camera_from_part: RigidTransform::translation(place.x, place.y, place.z),
                bound: None,
            }
        };
        let passing = (0..12).map(|k| 0.045 * f64::from(k));
        let passed = passing
            .map(|way| pose(way, way + 0.15 * delay, format!("passing {way}")))
            .collect();
        let stopped = (0..5).map(|k| pose(0.55, 0.55, format!("stopped {k}")));
        (passed, stopped.collect())
    }

    fn measured(
        passed: &[CountedPose],
        stopped: &[CountedPose],
    ) -> Result<LineCalibration, LineFitError> {
        let middle = Point3::origin();
        let line = fit(passed, &middle, Counter::Bits16).expect("fitted");
        line.with_delay(passed, stopped, &middle, 0.15)
    }

    #[test]
    fn the_delay_is_within_its_bound_in_19_of_20_cases_whichever_way_the_counts_go() {
        let (mut num_within, num) = (0, 200_u32);
        for seed in 0..num {
            let sign = if seed % 2 == 0 { 1.0 } else { -1.0 };
            let delay = 0.02 * f64::from(seed % 10);
            let (mut passed, mut stopped) = poses(delay, sign, u64::from(seed));
            for pose in passed.iter_mut().chain(&mut stopped) {
                pose.count = Counter::Bits16.shown(pose.count).into();
            }
            let line = measured(&passed, &stopped).expect("measured");
            assert!(line.delay_bound < 0.06, "{}", line.delay_bound);
            num_within += i32::from((line.delay - delay).abs() <= line.delay_bound);
        }
        assert!(num_within >= 190, "{num_within} of {num}");
    }

    #[test]
    fn a_line_that_goes_on_and_frames_that_are_early_are_refused_with_what_to_do() {
        let (passed, stopped) = poses(0.1, 1.0, 3);
        let refused = |passed: &[CountedPose], stopped: &[CountedPose]| {
            let why = measured(passed, stopped).expect_err("refused");
            assert!(!why.advice().is_empty() && !why.to_string().is_empty());
            why
        };
        let few = refused(&passed, &stopped[..2]);
        assert_eq!(few, LineFitError::TooFewStopped { found: 2 });
        let mut moving = stopped.clone();
        moving[3].count += 50;
        let went_on = refused(&passed, &moving);
        assert!(
            matches!(&went_on, LineFitError::NotStopped { name, .. } if name == "stopped 3"),
            "{went_on}"
        );
        let (early, standing) = poses(-0.5, 1.0, 3);
        let early = refused(&early, &standing);
        assert!(matches!(early, LineFitError::Delay { .. }), "{early}");
    }
}
