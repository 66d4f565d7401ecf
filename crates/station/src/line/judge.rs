//! Whether the frames that show a part show it where the line has carried it, and its pose if so.

use nalgebra::Point3;

use super::Moment;
use crate::motion::timestamp;
use geometry::{
    rigid::RigidTransform,
    statistics::median,
    units::{Metres, Radians},
};
use inspection::pipeline::{
    Inspection,
    live::{PoseTolerance, mean_pose, poses_agree},
};
use robot::line::{LineCalibration, OnLine};
use stages::pose::{PoseEstimate, Uncertainty};

/// Number of frames that must show a part where the line carried it.
pub(super) const MIN_SIGHTINGS: usize = 3;
/// Time from the first to the last of them by the counts, seconds: a part that swings is seen to by then, wherever in its swing
/// it is.
const MIN_SPAN_S: f64 = 0.6;
/// The same without counts: where the speed is only known from the part itself, half a swing passes for another speed.
const MIN_SPAN_UNCOUNTED_S: f64 = 1.0;
/// Frames from longer ago do not count, seconds.
const WINDOW_S: f64 = 3.0;
/// Share of the frames that must agree: of fewer than ten all, since a few frames may meet a swing at like places.
const MIN_AGREEING_SHARE: f64 = 0.9;
/// Share by which a line may become faster or slower, where there are no counts.
const MAX_SPEED_CHANGE_SHARE: f64 = 0.1;
/// Difference of two speeds that is no swing, m/s.
const SPEED_TOLERANCE_M_S: f64 = 0.01;
/// Height of the picture at the part over which a frame is sheared, metres.
const SHEARED_HEIGHT_M: f64 = 1.0;
/// Standard deviations in a 95 % bound.
const BOUND_DEVIATIONS: f64 = 2.0;

/// A part that a frame accepts by itself.
#[derive(Clone, Debug)]
pub(super) struct AcceptedSighting {
    /// Name of the part, and index of the reference in whose coordinates the pose is.
    reference: (String, usize),
    pose: RigidTransform,
    bounds: Uncertainty,
    /// The middle of the part, part space, metres.
    middle: Point3<f64>,
}

/// A pose of a part on the line, and how it goes on from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePose {
    /// Of the pose.
    pub moment: Moment,
    /// The pose at that moment.
    pub camera_from_part: RigidTransform,
    /// How far off it may be.
    pub bounds: Uncertainty,
    /// Speed of the part along the line, m/s, and its 95 % bound.
    pub speed: f64,
    /// 95 % bound of the speed, m/s.
    pub speed_bound: f64,
    /// Way of the line over the way by the counts: 1 while the encoder does not slip.
    pub rate: f64,
}

/// What several frames say of a part.
pub(super) enum Judged {
    /// The line carries it.
    Carried(LinePose),
    /// So many frames have shown it, too few.
    TooFew(usize),
    /// It is not where the line must have carried it.
    Swings,
}

impl AcceptedSighting {
    /// `None` if the frame refuses the part, or its pose has no bounds.
    pub(super) fn of(
        inspection: &Inspection,
        pose: &PoseEstimate,
        middle: Point3<f64>,
    ) -> Option<Self> {
        let name = inspection.verdict.guess()?;
        let first = inspection.ranking.entries.first()?;
        inspection.verdict.is_accepted().then_some(())?;
        Some(Self {
            reference: (name.to_owned(), first.reference),
            pose: pose.camera_from_part(),
            bounds: pose.bounds()?,
            middle,
        })
    }
}

/// Judges a part by the frames that accept it, the last of which is the present one. `line_speed` is that of the parts before
/// it, m/s, if it is known.
pub(super) fn judge(
    line: &LineCalibration,
    accepted: &[(Moment, &AcceptedSighting)],
    line_speed: Option<f64>,
) -> Judged {
    let Some(&(now, last)) = accepted.last() else {
        return Judged::TooFew(0);
    };
    let since = |moment: &Moment| now.at.as_secs_f64() - moment.at.as_secs_f64();
    let same: Vec<&(Moment, &AcceptedSighting)> = (accepted.iter())
        .filter(|(moment, one)| one.reference == last.reference && since(moment) <= WINDOW_S)
        .collect();
    let is_counted = same.iter().all(|(moment, _)| moment.count.is_some());
    let needed = if is_counted {
        MIN_SPAN_S
    } else {
        MIN_SPAN_UNCOUNTED_S
    };
    if same.len() < MIN_SIGHTINGS || since(&same[0].0) < needed {
        // The last one is still missing, if it is only time that is.
        return Judged::TooFew(same.len().min(MIN_SIGHTINGS - 1));
    }
    let bound = median(same.iter().map(|(_, one)| one.bounds.shift.0)).unwrap_or_default();
    let deviation = bound / BOUND_DEVIATIONS;
    let along = |one: &AcceptedSighting| (one.pose * one.middle).coords.dot(&line.direction);
    let timed = Slope::fit(
        same.iter()
            .map(|(moment, one)| (-since(moment), along(one))),
    );
    let (speed, speed_deviation) = (timed.slope, deviation / timed.spread);
    let count = |moment: &Moment| moment.count.unwrap_or_default() - now.count.unwrap_or_default();
    let way = |moment: &Moment| count(moment) * line.way_per_count.0;
    let mut rate = 1.0;
    if is_counted {
        let counted = Slope::fit(same.iter().map(|(moment, one)| (way(moment), along(one))));
        let seen_deviation = deviation / counted.spread;
        let slip_deviation = line.slip.hypot(line.scale_bound) / BOUND_DEVIATIONS;
        let off = counted.slope - 1.0;
        if off.abs() > 3.0 * seen_deviation.hypot(slip_deviation) {
            return Judged::Swings;
        }
        // The part of the difference that is more likely slip than noise.
        let share = slip_deviation.powi(2) / (slip_deviation.powi(2) + seen_deviation.powi(2));
        rate += off * if share.is_finite() { share } else { 0.0 };
    } else if let Some(expected) = line_speed {
        let tolerance =
            3.0 * speed_deviation + MAX_SPEED_CHANGE_SHARE * expected.abs() + SPEED_TOLERANCE_M_S;
        if (speed - expected).abs() > tolerance {
            return Judged::Swings;
        }
    }
    let ways = same.iter().map(|(moment, _)| {
        if is_counted {
            rate * way(moment)
        } else {
            -speed * since(moment)
        }
    });
    // All sightings, carried to now.
    let carried: Vec<_> = (same.iter().zip(ways))
        .map(|((_, one), way)| (line.carried(&one.pose, -way), Some(one.bounds)))
        .collect();
    let turn = median(same.iter().map(|(_, one)| one.bounds.turn.0)).unwrap_or_default();
    let tolerance = PoseTolerance {
        shift: Metres(2.0 * bound),
        turn: Radians(2.0 * turn),
    };
    let poses: Vec<RigidTransform> = carried.iter().map(|(pose, _)| *pose).collect();
    let Some(mean) = mean_pose(&poses, &last.middle, tolerance) else {
        return Judged::Swings;
    };
    let bounds = Uncertainty {
        shift: Metres(bound),
        turn: Radians(turn),
        freedom: None,
    };
    let mean = (mean.camera_from_part, Some(bounds));
    let agrees =
        |one: &&(RigidTransform, Option<Uncertainty>)| poses_agree(one, &mean, &last.middle);
    let num_agreeing = carried.iter().filter(agrees).count();
    if num_agreeing < MIN_SIGHTINGS
        || (num_agreeing as f64) < MIN_AGREEING_SHARE * same.len() as f64
    {
        return Judged::Swings;
    }
    Judged::Carried(LinePose {
        moment: now,
        camera_from_part: mean.0,
        bounds,
        speed,
        speed_bound: BOUND_DEVIATIONS * speed_deviation,
        rate,
    })
}

impl LinePose {
    /// With the bounds of a frame in whose exposure the line moved by this way, metres: half of it by which the part may have
    /// been seen too early or too late, and the shear over the height of the picture.
    #[must_use]
    pub(super) fn smeared(mut self, way: f64) -> Self {
        self.bounds.shift.0 = self.bounds.shift.0.hypot(0.5 * way);
        self.bounds.turn.0 = self.bounds.turn.0.hypot(way / SHEARED_HEIGHT_M);
        self
    }

    /// Where the part with this number is at that moment.
    pub(super) fn on_line(&self, number: u32, line: &LineCalibration) -> OnLine {
        let count = self.moment.count;
        let bounds = match count {
            Some(_) => self.counted(self.bounds, line),
            None => self.bounds,
        };
        OnLine {
            number,
            count: count.map(|count| line.counter.shown(count.round() as i64)),
            at: timestamp(self.moment.at),
            bound_mm: bounds.shift.mm(),
            speed_mm_s: 1000.0 * self.speed,
        }
    }

    /// The pose at another count, without beginning again, with its bounds; `None` if the count of this one is not known.
    pub fn at_count(
        &self,
        count: f64,
        line: &LineCalibration,
    ) -> Option<(RigidTransform, Uncertainty)> {
        let counts = self.rate * (count - self.moment.count?);
        let bounds = self.counted(self.bounds, line);
        Some(line.pose_at((&self.camera_from_part, bounds), counts, line.slip))
    }

    /// Bounds of a pose at a count: what the count was when the frame was exposed is known as well as the camera's delay.
    pub(super) fn counted(&self, bounds: Uncertainty, line: &LineCalibration) -> Uncertainty {
        Uncertainty {
            shift: Metres(bounds.shift.0.hypot(self.speed * line.delay_bound)),
            ..bounds
        }
    }

    /// The pose at another time by the camera's clock, in seconds from this one, with its bounds.
    pub fn after(&self, seconds: f64, line: &LineCalibration) -> (RigidTransform, Uncertainty) {
        let way = self.speed * seconds;
        let way_bound = (self.speed_bound * seconds).hypot(MAX_SPEED_CHANGE_SHARE * way);
        (
            line.carried(&self.camera_from_part, way),
            line.widened(self.bounds, way, way_bound),
        )
    }
}

/// A straight line through points by least squares.
struct Slope {
    slope: f64,
    /// Root of the sum of the squared distances of the points from their mean: the standard deviation of the slope is that of a
    /// point divided by it.
    spread: f64,
}

impl Slope {
    fn fit(points: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let num = points.clone().count().max(1) as f64;
        let sum = points
            .clone()
            .fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x, sum.1 + y));
        let (mean_x, mean_y) = (sum.0 / num, sum.1 / num);
        let (mut xx, mut xy) = (0.0, 0.0);
        for (x, y) in points {
            xx += (x - mean_x) * (x - mean_x);
            xy += (x - mean_x) * (y - mean_y);
        }
        Self {
            slope: if xx > 0.0 { xy / xx } else { 0.0 },
            spread: xx.sqrt(),
        }
    }
}
