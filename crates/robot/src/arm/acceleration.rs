//! The accelerations that joints and rail need along a path at its speed.
//!
//! The acceleration of a joint at a point is the second difference of its angle q over the nearest points that are at
//! least [`WINDOW_S`] before and behind it, 2 · ((q₊ - q) / t₊ - (q - q₋) / t₋) / (t₊ + t₋): the mean acceleration over
//! that time, however unevenly the points are spaced. Points closer together would only add noise. In a corner the
//! whole change happens at the point itself. So if the difference would be too large within the window, the joints
//! exactly one window before and behind the point are computed on the straight moves there, and the larger result
//! counts.
//!
//! For the rail only the points are used: between them it may accelerate evenly. Over a long move that mean is of little use,
//! so a move of the rail between two points that begins or ends at a standstill also needs at least the acceleration
//! that brings it there in time ([`least_acceleration`]), even if it begins a window early and ends a window late.
//!
//! No window extends past the ends of the path, past a point where the arm stops, past a turn on the spot, for which it
//! takes its time, or past a point that cannot be reached from the one before.
//!
//! Known limits: nothing is checked within a window of those ends. Of a move that takes longer than the window only its
//! two ends are examined closely for the joints.

use std::f64::consts::PI;

use super::{
    ArmPoint, PlacedArm, PointCheck, Way,
    chain::move_time,
    kinematics::Joints,
    problem::PointProblem,
    way::{WayEnd, apart},
};

/// Seconds; a corner at 200 mm/s takes as long if the controller rounds it by 5 mm on both sides.
pub(super) const WINDOW_S: f64 = 0.05;
/// The arm stops for a turn on the spot if a joint turns by this much, radians.
const STOP_TURN_RAD: f64 = 0.01;
/// The times of a path are sums, which are not exact.
const TIME_TOLERANCE_S: f64 = 1e-6;
/// Shorter moves of the rail count as standing still, metres.
const STILL_RAIL_M: f64 = 1e-6;

/// Returns the points with the speeds and stops of the moves found.
pub(super) fn as_passed(points: &[ArmPoint], checked: &[PointCheck]) -> Vec<ArmPoint> {
    let mut passed = points.to_vec();
    for (i, point) in checked.iter().enumerate().skip(1) {
        match point.way {
            Way::Planned => {}
            Way::Slower(speed) | Way::SlowerSpraying(speed) => passed[i - 1].speed = speed,
            Way::Joints => {
                passed[i - 1].is_stop = true;
                passed[i].is_stop = true;
            }
        }
    }
    passed
}

/// Marks the points of a checked path around which a joint or the rail cannot accelerate as much as needed. An earlier
/// problem of a point is kept, unless it is a singularity nearby.
pub(super) fn check_accelerations(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &mut [PointCheck],
) {
    let found = problems_of(placed, points, checked);
    for (point, problem) in checked.iter_mut().zip(found) {
        let is_open = matches!(
            point.problem,
            None | Some(PointProblem::NearSingularity { .. })
        );
        if is_open && problem.is_some() {
            point.problem = problem;
        }
    }
}

/// The problem of acceleration around each point, if any.
pub(super) fn problems_of(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &[PointCheck],
) -> Vec<Option<PointProblem>> {
    let mut found: Vec<Option<PointProblem>> = vec![None; checked.len()];
    if !placed.arm.limits_accelerations() {
        return found;
    }
    for (first, run) in runs_of(placed, points, checked) {
        for here in 0..run.times.len() {
            let problem = &mut found[first + here];
            *problem = problem.take().or_else(|| run.problem_at(here));
        }
    }
    found
}

/// The runs of a path, each with the index of its first point. A stop ends one run and begins the next.
pub(super) fn runs_of<'a>(
    placed: &'a PlacedArm,
    points: &'a [ArmPoint],
    checked: &'a [PointCheck],
) -> impl Iterator<Item = (usize, Run<'a>)> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let first = next;
        let run = (first < checked.len())
            .then(|| Run::new(placed, &points[first..], &checked[first..]))?;
        let last = first + run.times.len() - 1;
        let goes_on = last > first && points[last].is_stop;
        next = if goes_on { last } else { last + 1 };
        Some((first, run))
    })
}

/// The problem of acceleration around one point, if any; only the points are considered that have an influence on it.
pub(super) fn problem_around(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &[PointCheck],
    here: usize,
) -> Option<PointProblem> {
    let seconds =
        |from: usize| seconds_between(&points[from..=from + 1], &checked[from..=from + 1]);
    // The rail is examined a window before the move to the point, too.
    let (mut first, mut passed) = (here, 0.0);
    while first > 0 && passed <= WINDOW_S && !points[first].is_stop {
        let Some(seconds) = seconds(first - 1) else {
            break;
        };
        if first < here {
            passed += seconds;
        }
        first -= 1;
    }
    let (mut end, mut passed) = (here + 1, 0.0);
    while end < points.len() && passed <= WINDOW_S {
        passed += seconds(end - 1).unwrap_or(f64::INFINITY);
        end += 1;
    }
    Run::new(placed, &points[first..end], &checked[first..end]).problem_at(here - first)
}

/// Points that are passed one after the other without a stop.
pub(super) struct Run<'a> {
    placed: &'a PlacedArm,
    /// Begins with the first of them; may continue after the last.
    checked: &'a [PointCheck],
    /// Time of the nozzle at each point, seconds from the first.
    pub(super) times: Vec<f64>,
}

impl<'a> Run<'a> {
    fn new(placed: &'a PlacedArm, points: &'a [ArmPoint], checked: &'a [PointCheck]) -> Self {
        let pairs = points.windows(2).zip(checked.windows(2));
        let steps = pairs.map_while(|(points, checked)| seconds_between(points, checked));
        let stop = points.iter().skip(1).position(|point| point.is_stop);
        let num_steps = stop.map_or(points.len(), |before| before + 1);
        let mut now = 0.0;
        let later = steps.take(num_steps).map(|seconds| {
            now += seconds;
            now
        });
        Self {
            placed,
            checked,
            times: std::iter::once(0.0).chain(later).collect(),
        }
    }

    /// The nearest points that are at least a window before and behind a point; none beyond the run.
    pub(super) fn around(&self, here: usize) -> [Option<usize>; 2] {
        let now = self.times[here];
        let before = self.times.partition_point(|time| *time <= now - WINDOW_S);
        let behind = self.times.partition_point(|time| *time < now + WINDOW_S);
        let is_within = behind < self.times.len();
        [before.checked_sub(1), is_within.then_some(behind)]
    }

    /// The problem around a point, or of the rail on the way to it, if any.
    fn problem_at(&self, here: usize) -> Option<PointProblem> {
        let around = match self.around(here) {
            [Some(before), Some(behind)] => {
                let now = self.times[here];
                let times = [now - self.times[before], self.times[behind] - now];
                let indices = [before, here, behind];
                let of_joint = self.joint_problem(indices, times);
                of_joint.or_else(|| self.rail_problem(indices, times))
            }
            _ => None,
        };
        around.or_else(|| self.rail_way_problem(here))
    }

    fn joint_problem(
        &self,
        [before, here, behind]: [usize; 3],
        times: [f64; 2],
    ) -> Option<PointProblem> {
        let limits = self.placed.arm.accelerations?;
        let joints = |index: usize| self.checked[index].joints;
        let middle = joints(here)?;
        let mean = Excess::of(
            [&joints(before)?, &middle, &joints(behind)?],
            times,
            &limits,
        )?;
        if mean.share * (times[0] + times[1]) <= 2.0 * WINDOW_S {
            return None;
        }
        let now = self.times[here];
        let early = self.joints_at(before, now - WINDOW_S, before + 1);
        let late = self.joints_at(behind - 1, now + WINDOW_S, behind - 1);
        let close = early
            .zip(late)
            .and_then(|(early, late)| Excess::of([&early, &middle, &late], [WINDOW_S; 2], &limits));
        let worst = close.filter(|close| close.share > mean.share);
        let worst = worst.unwrap_or(mean);
        (worst.share > 1.0 + TIME_TOLERANCE_S).then_some(PointProblem::JointAcceleration {
            joint: worst.joint + 1,
            acceleration: worst.acceleration,
            limit: limits[worst.joint],
        })
    }

    fn rail_problem(&self, indices: [usize; 3], times: [f64; 2]) -> Option<PointProblem> {
        let (rail, _) = self.placed.arm.moving_rail()?;
        let limit = rail.acceleration?;
        let rails = indices.map(|index| self.checked[index].rail);
        let acceleration = second_difference(rails, times).abs();
        let is_too_much = acceleration > limit * (1.0 + TIME_TOLERANCE_S);
        is_too_much.then_some(PointProblem::RailAcceleration {
            acceleration,
            limit,
        })
    }

    /// The problem of the rail on the way to a point, if it stands still before or behind that way.
    fn rail_way_problem(&self, here: usize) -> Option<PointProblem> {
        let (rail, top) = self.placed.arm.moving_rail()?;
        let limit = rail.acceleration?;
        let from = here.checked_sub(1)?;
        let way = |a: usize, b: usize| (self.checked[b].rail - self.checked[a].rail).abs();
        let [before, _] = self.around(from);
        let [_, behind] = self.around(here);
        let is_start = before.is_some_and(|before| way(before, from) < STILL_RAIL_M);
        let is_end = behind.is_some_and(|behind| way(here, behind) < STILL_RAIL_M);
        let num_ramps = f64::from(u8::from(is_start) + u8::from(is_end));
        let time = self.times[here] - self.times[from] + num_ramps * WINDOW_S;
        let acceleration = least_acceleration(way(from, here), time, top, num_ramps)?;
        (acceleration > limit * (1.0 + TIME_TOLERANCE_S)).then_some(
            PointProblem::RailAcceleration {
                acceleration,
                limit,
            },
        )
    }

    /// The joints at a time during the move from one point to the next, nearest to those at `near`.
    fn joints_at(&self, from: usize, time: f64, near: usize) -> Option<Joints> {
        let end = |index: usize| WayEnd::of(&self.checked[index]);
        let (start, end) = (end(from)?, end(from + 1)?);
        let share = (time - self.times[from]) / (self.times[from + 1] - self.times[from]);
        start.joints_towards(&end, share, self.placed, &self.checked[near].joints?)
    }
}

/// The joint that is farthest beyond its limit of acceleration, or nearest to it.
#[derive(Clone, Copy)]
struct Excess {
    /// Index from 0.
    joint: usize,
    /// rad/s²
    acceleration: f64,
    /// Acceleration divided by its limit.
    share: f64,
}

impl Excess {
    fn of(
        [before, here, behind]: [&Joints; 3],
        times: [f64; 2],
        limits: &[f64; 6],
    ) -> Option<Self> {
        let all = (0..6).map(|joint| {
            let angles = [before[joint], here[joint], behind[joint]];
            let acceleration = second_difference(angles, times).abs();
            Self {
                joint,
                acceleration,
                share: acceleration / limits[joint],
            }
        });
        all.max_by(|a, b| a.share.total_cmp(&b.share))
    }
}

/// The least acceleration, m/s², for a way in a time at a top speed, with one ramp, from or to a standstill, or two;
/// `None` if it does not move, or not in time at any acceleration.
fn least_acceleration(way: f64, time: f64, top: f64, num_ramps: f64) -> Option<f64> {
    if way < STILL_RAIL_M {
        return None;
    }
    // Accelerating all the time if the top speed allows it; otherwise time = way / top + ramps / 2 · top / acceleration.
    let speed = top.min(2.0 * way / time);
    let left = time - way / speed;
    (left > 0.0).then(|| num_ramps / 2.0 * speed / left)
}

/// The mean second derivative of a value before, at and behind a moment; `times` are the seconds between.
fn second_difference([before, here, behind]: [f64; 3], times: [f64; 2]) -> f64 {
    2.0 * ((behind - here) / times[1] - (here - before) / times[0]) / (times[0] + times[1])
}

/// Seconds from a point to the next; `None` if the arm stops for a turn on the spot, or cannot move there.
fn seconds_between(points: &[ArmPoint], checked: &[PointCheck]) -> Option<f64> {
    let [from, to] = points else { return None };
    let [left, reached] = checked else {
        return None;
    };
    let moved = apart(&left.joints?, &reached.joints?);
    let is_other_way = matches!(
        reached.problem,
        Some(
            PointProblem::OutOfReach
                | PointProblem::JointLimit { .. }
                | PointProblem::ConfigurationChange
        )
    );
    let nozzles = [from, to].map(|point| &point.robot_from_nozzle);
    let is_turn = move_time(nozzles[0], nozzles[1], from.speed).is_none() && moved >= STOP_TURN_RAD;
    let shift = nozzles[1].translation.vector - nozzles[0].translation.vector;
    let is_passed = !is_other_way && !is_turn && moved <= PI;
    is_passed.then(|| shift.norm() / from.speed)
}
