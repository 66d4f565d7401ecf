//! The fit of a line to poses of a part that passed and the counts at which it was seen.
//!
//! The positions x of the part's middle are x = a + s·c for the counts c: three straight lines by weighted least squares, with
//! one slope for each axis. Direction and scale are those of s. Errors across and along the line differ, since the outline
//! gives one and the surface the other, so each has its own scatter.

use nalgebra::{Point3, Unit, Vector3};

use super::{Counter, DEFAULT_EXPOSURE_S, DEFAULT_SLIP, LineCalibration};
use geometry::{
    error::Advice,
    rigid::RigidTransform,
    statistics::median,
    units::{Metres, Radians},
};
use inspection::pipeline::live::{PoseTolerance, mean_pose};

/// A pose of a part that passed, and the count at which it was seen.
#[derive(Clone, Debug, PartialEq)]
pub struct CountedPose {
    /// Name for people, such as that of the frame.
    pub name: String,
    /// What the counter showed.
    pub count: i64,
    /// The pose.
    pub camera_from_part: RigidTransform,
    /// 95 % bound of the error of the part's middle, if it is known.
    pub bound: Option<Metres>,
}

/// Fewest poses that a line is fitted to.
pub const MIN_POSES: usize = 5;
/// Shortest way between the first and the last pose, metres.
const MIN_WAY_M: f64 = 0.2;
/// Greatest turn of a pose from their mean.
const MAX_TURN: Radians = Radians(0.026);
/// Greatest root mean square distance from the line, metres.
const MAX_RESIDUAL_M: f64 = 0.005;
/// Greatest distance of a pose from the line, metres.
const MAX_OFF_M: f64 = 0.015;
/// Error of a pose without a bound, metres.
pub(super) const DEFAULT_BOUND_M: f64 = 0.004;
/// Way between two poses by which a count that was reset is told from one that slips, metres.
const TELLING_WAY_M: f64 = 0.02;
/// 95 % bounds in standard deviations.
pub(super) const BOUND_DEVIATIONS: f64 = 2.0;

/// Why no line can be fitted to poses and counts.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum LineFitError {
    /// Too few poses.
    #[error("{found} poses of the part with a count, at least {MIN_POSES} are needed")]
    #[advice = "Let the part pass slowly, and take {MIN_POSES} frames or more that show it whole, each with its count"]
    TooFew {
        /// Their number.
        found: usize,
    },
    /// The counts do not change.
    #[error("the counts do not change: all are {count}")]
    #[advice = "Check that the encoder is connected and the controller reads its counter, and let the line run"]
    NoCounts {
        /// The count.
        count: i64,
    },
    /// The counts rise and fall.
    #[error("{name}: the counts rise before it and fall to it, or the other way round")]
    #[advice = "Let the line run in one direction only, and give the frames in the order in which they were taken"]
    BothWays {
        /// The pose at which they turn.
        name: String,
    },
    /// The counter was reset on the way.
    #[error("{name}: the count jumps from {from} to {to} although the part moved on by {:.0} mm only", way.mm())]
    #[advice = "Let the counter run on: switch off its reset at a part or a trigger, and check --counter-bits"]
    Reset {
        /// The pose after the reset.
        name: String,
        /// The count before it.
        from: i64,
        /// The count after it.
        to: i64,
        /// Way of the part between the two.
        way: Metres,
    },
    /// The part moved too little.
    #[error("the part moved by {:.0} mm, at least {:.0} mm are needed", way.mm(), 1000.0 * MIN_WAY_M)]
    #[advice = "Take frames from where the part has just come in whole to where it is about to leave"]
    TooShort {
        /// Way between the first and the last pose.
        way: Metres,
    },
    /// The part turned.
    #[error("{name}: the part is turned by {:.1}° from its other poses", turn.degrees())]
    #[advice(LET_RUN_EVENLY)]
    Turned {
        /// The pose that is turned most.
        name: String,
        /// By how much.
        turn: Radians,
    },
    /// Too few poses of the part after the line was stopped.
    #[error(
        "{found} poses of the part after the line was stopped, at least {} are needed",
        super::MIN_STOPPED
    )]
    #[advice(
        "Stop the line with the part still wholly in sight, take {} frames or more of it, each with its count, and give each with --stop",
        super::MIN_STOPPED
    )]
    TooFewStopped {
        /// Their number.
        found: usize,
    },
    /// The line has moved between the frames that were taken after it was stopped.
    #[error("{name}: the line was not stopped: the count goes on from {from} to {to}")]
    #[advice = "Give with --stop only frames that were taken after the line had come to rest"]
    NotStopped {
        /// The pose at which the count has changed.
        name: String,
        /// The count of the first pose after the stop.
        from: i64,
        /// The count at this one.
        to: i64,
    },
    /// Frames cannot be so late, or early.
    #[error("the frames before the stop would be {:.0} ms late, within {:.0} ms", 1000.0 * delay, 1000.0 * bound)]
    #[advice = "Check --speed, that each count was read when its frame arrived, and that the part did not swing when the line stopped"]
    Delay {
        /// How late they would be, seconds.
        delay: f64,
        /// 95 % bound of that, seconds.
        bound: f64,
    },
    /// The poses do not lie on a line by their counts.
    #[error("the part swung, or was not carried by the line that the encoder counts: it is {:.1} mm off the line (rms), {name} {:.1} mm", rms.mm(), off.mm())]
    #[advice(LET_RUN_EVENLY)]
    Off {
        /// Root mean square distance from the line.
        rms: Metres,
        /// The pose that is farthest from it.
        name: String,
        /// Its distance.
        off: Metres,
    },
}

const LET_RUN_EVENLY: &str = "Hang the part so that it does not swing, start the line gently, and take the frames while it runs evenly; check that each count belongs to its frame";

/// Fits the line. `middle` is the middle of the part, part space, metres; `counter` how its counts begin again. The name of the
/// part and the time are the caller's.
pub fn fit(
    poses: &[CountedPose],
    middle: &Point3<f64>,
    counter: Counter,
) -> Result<LineCalibration, LineFitError> {
    let found = poses.len();
    if found < MIN_POSES {
        return Err(LineFitError::TooFew { found });
    }
    check_turns(poses)?;
    let places: Vec<Vector3<f64>> = (poses.iter())
        .map(|pose| (pose.camera_from_part * middle).coords)
        .collect();
    let counts = continued(poses, &places, counter)?;
    let weights: Vec<f64> = (poses.iter())
        .map(|pose| pose.bound.map_or(DEFAULT_BOUND_M, |bound| bound.0))
        .map(|bound| bound.max(1e-4).powi(-2))
        .collect();
    let total: f64 = weights.iter().sum();
    let mean_count = weighted(&weights, &counts).sum::<f64>() / total;
    let mean_place = weighted(&weights, &places).sum::<Vector3<f64>>() / total;
    let from_mean: Vec<f64> = counts.iter().map(|count| count - mean_count).collect();
    let spread: f64 = (weights.iter().zip(&from_mean))
        .map(|(weight, count)| weight * count * count)
        .sum();
    let slope: Vector3<f64> = (weights.iter().zip(&from_mean).zip(&places))
        .map(|((weight, count), place)| (place - mean_place) * (weight * count))
        .sum::<Vector3<f64>>()
        / spread;
    let per_count = slope.norm();
    let way = per_count * (counts[found - 1] - counts[0]).abs();
    if !(way >= MIN_WAY_M) {
        return Err(LineFitError::TooShort { way: Metres(way) });
    }
    let direction = Unit::new_normalize(slope);
    let off: Vec<Vector3<f64>> = (from_mean.iter().zip(&places))
        .map(|(count, place)| place - mean_place - slope * *count)
        .collect();
    let rms = (off.iter().map(Vector3::norm_squared).sum::<f64>() / found as f64).sqrt();
    let (worst, farthest) = (off.iter().map(Vector3::norm).enumerate())
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or_default();
    if rms > MAX_RESIDUAL_M || farthest > MAX_OFF_M {
        return Err(LineFitError::Off {
            rms: Metres(rms),
            name: poses[worst].name.clone(),
            off: Metres(farthest),
        });
    }
    // Of the scatter per unit of weight, that along the line makes the scale wrong, that across it the direction.
    let along: f64 = (weights.iter().zip(&off))
        .map(|(weight, off)| weight * off.dot(&direction).powi(2))
        .sum();
    let all: f64 = (weights.iter().zip(&off))
        .map(|(weight, off)| weight * off.norm_squared())
        .sum();
    let free = (found - 2) as f64;
    let bound = |scatter: f64| BOUND_DEVIATIONS * (scatter / free / spread).sqrt() / per_count;
    Ok(LineCalibration {
        direction,
        direction_bound: Radians(bound(all - along)),
        way_per_count: Metres(per_count),
        scale_bound: bound(along),
        counter,
        residual: Metres(rms),
        num_poses: found,
        way: Metres(way),
        part: String::new(),
        made_at: jiff::Timestamp::UNIX_EPOCH,
        slip: DEFAULT_SLIP,
        exposure: DEFAULT_EXPOSURE_S,
        delay: 0.0,
        delay_bound: 0.0,
    })
}

fn weighted<'a, T: Copy + std::ops::Mul<f64, Output = T>>(
    weights: &'a [f64],
    values: &'a [T],
) -> impl Iterator<Item = T> + 'a {
    weights
        .iter()
        .zip(values)
        .map(|(weight, value)| *value * *weight)
}

fn check_turns(poses: &[CountedPose]) -> Result<(), LineFitError> {
    let all: Vec<RigidTransform> = poses.iter().map(|pose| pose.camera_from_part).collect();
    let tolerance = PoseTolerance {
        shift: Metres(f64::INFINITY),
        turn: MAX_TURN,
    };
    let Some(mean) = mean_pose(&all, &Point3::origin(), tolerance) else {
        return Ok(());
    };
    let turns = poses.iter().map(|pose| {
        let turn = pose.camera_from_part.rotation;
        (turn.angle_to(&mean.camera_from_part.rotation), pose)
    });
    match turns.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((turn, pose)) if turn > MAX_TURN.0 => Err(LineFitError::Turned {
            name: pose.name.clone(),
            turn: Radians(turn),
        }),
        _ => Ok(()),
    }
}

/// The counts without beginning again, which only rise or only fall.
fn continued(
    poses: &[CountedPose],
    places: &[Vector3<f64>],
    counter: Counter,
) -> Result<Vec<f64>, LineFitError> {
    let first = poses[0].count;
    let mut counts = vec![first];
    for pose in &poses[1..] {
        let last = counts[counts.len() - 1];
        counts.push(counter.continued(last, pose.count));
    }
    let steps: Vec<i64> = counts.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let Some(forward) = steps.iter().find(|step| **step != 0) else {
        return Err(LineFitError::NoCounts { count: first });
    };
    // Roughly: only a part that goes back has a negative way.
    let along = places[places.len() - 1] - places[0];
    let along = along.try_normalize(0.0).unwrap_or_default();
    let ways: Vec<f64> = (places.windows(2))
        .map(|pair| (pair[1] - pair[0]).dot(&along))
        .collect();
    // A reset shows as a step that is not in proportion to the way.
    let rates = steps
        .iter()
        .zip(&ways)
        .filter(|(_, way)| way.abs() > TELLING_WAY_M);
    let usual = median(rates.map(|(step, way)| *step as f64 / way));
    for (k, (step, way)) in steps.iter().zip(&ways).enumerate() {
        let expected = usual.unwrap_or_default() * way;
        let is_jump = way.abs() > TELLING_WAY_M && (*step as f64 - expected).abs() > expected.abs();
        if is_jump {
            return Err(LineFitError::Reset {
                name: poses[k + 1].name.clone(),
                from: poses[k].count,
                to: poses[k + 1].count,
                way: Metres(*way),
            });
        }
    }
    if let Some(k) = steps.iter().position(|step| step * forward.signum() < 0) {
        return Err(LineFitError::BothWays {
            name: poses[k + 1].name.clone(),
        });
    }
    Ok(counts.into_iter().map(|count| count as f64).collect())
}

#[cfg(test)]
mod tests {
    use nalgebra::Translation3;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use geometry::rigid::{from_euler_zyx, pose_error};

    const PER_COUNT_M: f64 = 0.00013;

    fn truth() -> Unit<Vector3<f64>> {
        Unit::new_normalize(Vector3::new(-1.0, 0.04, 0.11))
    }

    fn middle() -> Point3<f64> {
        Point3::new(0.1, -0.1, 1.3)
    }

    /// Poses of a part that passes, `step` metres apart, with errors of the middle of about `noise` metres along each axis, and
    /// counts from `first`.
    fn poses(num: usize, step: f64, noise: f64, first: i64, seed: u64) -> Vec<CountedPose> {
        let mut random = Pcg64::seed_from_u64(seed);
        let hung = from_euler_zyx([0.1, -0.05, 0.2, 0.6, 0.0, 0.7]);
        let mut draw = |width: f64| width * 3.0_f64.sqrt() * random.random_range(-1.0..1.0);
        (0..num)
            .map(|k| {
                let way = step * k as f64;
                let [x, y, z] = std::array::from_fn(|_| draw(noise));
                let [a, b, c] = std::array::from_fn(|_| draw(0.002));
                let off = Translation3::new(x, y, z)
                    * Translation3::from(truth().into_inner() * way)
                    * hung;
                let turn = from_euler_zyx([a, b, c, 0.0, 0.0, 0.0]);
                let about_middle = Translation3::from(middle().coords) * turn;
                CountedPose {
                    name: format!("frame {k}"),
                    count: first + (way / PER_COUNT_M).round() as i64,
                    camera_from_part: off * about_middle * Translation3::from(-middle().coords),
                    bound: Some(Metres(2.0 * noise.max(1e-4))),
                }
            })
            .collect()
    }

    fn fitted(poses: &[CountedPose]) -> Result<LineCalibration, LineFitError> {
        fit(poses, &middle(), Counter::Bits32)
    }

    #[test]
    fn direction_and_scale_are_within_their_bounds_in_19_of_20_cases() {
        let (mut num_direction, mut num_scale, num) = (0, 0, 200);
        for seed in 0..num {
            let line = fitted(&poses(12, 0.05, 0.001, 5000, seed)).expect("fitted");
            let turned = line.direction.angle(&truth());
            num_direction += i32::from(turned <= line.direction_bound.0);
            let off = (line.way_per_count.0 / PER_COUNT_M - 1.0).abs();
            num_scale += i32::from(off <= line.scale_bound);
            assert!(line.direction_bound.0 < 0.01 && line.scale_bound < 0.01);
        }
        assert!(num_direction >= 180, "{num_direction} of {num}");
        assert!(num_scale >= 180, "{num_scale} of {num}");
    }

    #[test]
    fn a_pose_at_another_count_is_within_bounds_that_grow() {
        let seen = poses(12, 0.05, 0.001, 5000, 3);
        let line = fitted(&seen).expect("fitted");
        let last = &seen[11];
        let bounds = stages::pose::Uncertainty {
            shift: Metres(0.004),
            turn: Radians(0.005),
            freedom: None,
        };
        let mut before = 0.0;
        for way in [0.0, 0.5, 1.0, 2.0] {
            let from = (&last.camera_from_part, bounds);
            let (pose, bounds) = line.pose_at(from, way / PER_COUNT_M, 0.002);
            let carried = Translation3::from(truth().into_inner() * way) * last.camera_from_part;
            let off = pose_error(&pose, &carried, &middle());
            assert!(
                off.shift <= bounds.shift,
                "{} beyond {}",
                off.shift,
                bounds.shift
            );
            assert!(bounds.shift.0 >= 0.004 && bounds.shift.0 > before);
            before = bounds.shift.0;
        }
    }

    #[test]
    fn a_counter_that_begins_again_or_falls_is_read_as_one_that_goes_on() {
        let plain = fitted(&poses(12, 0.05, 0.0, 5000, 1)).expect("fitted");
        let mut short = poses(12, 0.05, 0.0, 64_000, 1);
        for pose in &mut short {
            pose.count = Counter::Bits16.shown(pose.count).into();
        }
        assert!(short[11].count < short[0].count);
        let again = fit(&short, &middle(), Counter::Bits16).expect("fitted");
        assert!((again.way_per_count.0 - plain.way_per_count.0).abs() < 1e-9);
        let mut falling = poses(12, 0.05, 0.0, 5000, 1);
        for pose in &mut falling {
            pose.count = 10_000 - pose.count;
        }
        let falling = fitted(&falling).expect("fitted");
        assert!((falling.direction.into_inner() + plain.direction.into_inner()).norm() < 1e-6);
    }

    #[test]
    fn what_does_not_determine_the_line_is_refused_with_what_to_do() {
        let good = poses(12, 0.05, 0.0005, 5000, 1);
        let after = |change: &dyn Fn(&mut Vec<CountedPose>)| {
            let mut poses = good.clone();
            change(&mut poses);
            let why = fitted(&poses).expect_err("refused");
            assert!(!why.advice().is_empty() && !why.to_string().is_empty());
            why
        };
        let why = after(&|poses| poses.truncate(MIN_POSES - 1));
        assert_eq!(why, LineFitError::TooFew { found: 4 });
        let short = fitted(&poses(12, 0.01, 0.0005, 5000, 1));
        assert!(
            matches!(short, Err(LineFitError::TooShort { .. })),
            "{short:?}"
        );
        let why = after(&|poses| {
            for pose in poses {
                pose.count = 7;
            }
        });
        assert_eq!(why, LineFitError::NoCounts { count: 7 });
        let why = after(&|poses| poses.swap(5, 6));
        assert!(matches!(why, LineFitError::BothWays { .. }), "{why}");
        let why = after(&|poses| {
            for pose in &mut poses[6..] {
                pose.count -= 6000;
            }
        });
        assert!(
            matches!(&why, LineFitError::Reset { name, .. } if name == "frame 6"),
            "{why}"
        );
        let why = after(&|poses| {
            poses[4].camera_from_part *= from_euler_zyx([0.0, 0.0, 0.08, 0.0, 0.0, 0.0]);
        });
        assert!(
            matches!(&why, LineFitError::Turned { name, .. } if name == "frame 4"),
            "{why}"
        );
        let why = after(&|poses| {
            for (k, pose) in poses.iter_mut().enumerate() {
                let swing = 0.012 * (k as f64 * 1.3).sin();
                pose.camera_from_part.translation.x += swing;
            }
        });
        assert!(matches!(why, LineFitError::Off { .. }), "{why}");
    }
}
