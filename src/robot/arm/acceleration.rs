//! The accelerations that joints and rail need along a path at its speed.
//!
//! The acceleration of a joint at a point is the second difference of its angle q over the nearest points that are at
//! least [`WINDOW`] before and behind it, 2 · ((q₊ - q) / t₊ - (q - q₋) / t₋) / (t₊ + t₋): the mean acceleration over
//! that time, however unevenly the points are spaced. Points closer together would only add noise. In a corner the
//! whole change happens at the point itself. So if the difference would be too large within the window, the joints
//! exactly one window before and behind the point are computed on the straight moves there, and the larger result
//! counts. For the rail only the points are used: between them it may accelerate evenly.
//!
//! No window extends past the ends of the path, past a turn on the spot, for which the arm takes its time, or past a
//! point that cannot be reached from the one before.
//!
//! Known limits: nothing is checked within a window of the ends. Of a move that takes longer than the window only its
//! two ends are examined closely.

use std::f64::consts::PI;

use super::{
    ArmPoint, PlacedArm, PointCheck,
    chain::move_time,
    kinematics::Joints,
    problem::PointProblem,
    way::{WayEnd, apart},
};

/// Seconds; a corner at 200 mm/s takes as long if the controller rounds it by 5 mm on both sides.
const WINDOW: f64 = 0.05;
/// The arm stops for a turn on the spot if a joint turns by this much, radians.
const TURN: f64 = 0.01;
/// The times of a path are sums, which are not exact.
const EXACT: f64 = 1e-6;

/// Marks the points of a checked path around which a joint or the rail cannot accelerate as much as needed. An earlier
/// problem of a point is kept, unless it is a singularity nearby.
pub(super) fn check_accelerations(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &mut [PointCheck],
) {
    let moving = placed.arm.moving_rail();
    let is_rail = moving.is_some_and(|(rail, _)| rail.acceleration.is_some());
    if placed.arm.accelerations.is_none() && !is_rail {
        return;
    }
    let mut found = Vec::with_capacity(checked.len());
    while found.len() < checked.len() {
        let begin = found.len();
        let run = Run::new(placed, &points[begin..], &checked[begin..]);
        found.extend((0..run.times.len()).map(|here| run.problem_at(here)));
    }
    for (point, problem) in checked.iter_mut().zip(found) {
        let is_open = matches!(point.problem, None | Some(PointProblem::NearSingularity(_)));
        if is_open && problem.is_some() {
            point.problem = problem;
        }
    }
}

/// Points that are passed one after the other without a stop.
struct Run<'a> {
    placed: &'a PlacedArm,
    /// Begins with the first of them; may continue after the last.
    points: &'a [ArmPoint],
    checked: &'a [PointCheck],
    /// Time of the nozzle at each point, seconds from the first.
    times: Vec<f64>,
}

impl<'a> Run<'a> {
    fn new(placed: &'a PlacedArm, points: &'a [ArmPoint], checked: &'a [PointCheck]) -> Self {
        let pairs = points.windows(2).zip(checked.windows(2));
        let steps = pairs.map_while(|(points, checked)| seconds_between(points, checked));
        let mut now = 0.0;
        let later = steps.map(|seconds| {
            now += seconds;
            now
        });
        Self {
            placed,
            points,
            checked,
            times: std::iter::once(0.0).chain(later).collect(),
        }
    }

    /// The problem around a point, if any.
    fn problem_at(&self, here: usize) -> Option<PointProblem> {
        let now = self.times[here];
        let before = self.times.partition_point(|time| *time <= now - WINDOW);
        let before = before.checked_sub(1)?;
        let behind = self.times.partition_point(|time| *time < now + WINDOW);
        let times = [now - self.times[before], self.times.get(behind)? - now];
        let places = [before, here, behind];
        let of_joint = self.joint_problem(places, times);
        of_joint.or_else(|| self.rail_problem(places, times))
    }

    fn joint_problem(
        &self,
        [before, here, behind]: [usize; 3],
        times: [f64; 2],
    ) -> Option<PointProblem> {
        let limits = self.placed.arm.accelerations?;
        let joints = |place: usize| self.checked[place].joints;
        let middle = joints(here)?;
        let mean = Excess::of(
            [&joints(before)?, &middle, &joints(behind)?],
            times,
            &limits,
        )?;
        if mean.share * (times[0] + times[1]) <= 2.0 * WINDOW {
            return None;
        }
        let now = self.times[here];
        let early = self.joints_at(before, now - WINDOW, before + 1);
        let late = self.joints_at(behind - 1, now + WINDOW, behind - 1);
        let close = early
            .zip(late)
            .and_then(|(early, late)| Excess::of([&early, &middle, &late], [WINDOW; 2], &limits));
        let worst = close.filter(|close| close.share > mean.share);
        let worst = worst.unwrap_or(mean);
        (worst.share > 1.0 + EXACT).then_some(PointProblem::JointAcceleration {
            joint: worst.joint + 1,
            acceleration: worst.acceleration,
            limit: limits[worst.joint],
        })
    }

    fn rail_problem(&self, places: [usize; 3], times: [f64; 2]) -> Option<PointProblem> {
        let (rail, _) = self.placed.arm.moving_rail()?;
        let limit = rail.acceleration?;
        let rails = places.map(|place| self.checked[place].rail);
        let acceleration = second_difference(rails, times).abs();
        let is_too_much = acceleration > limit * (1.0 + EXACT);
        is_too_much.then_some(PointProblem::RailAcceleration {
            acceleration,
            limit,
        })
    }

    /// The joints at a time during the move from one point to the next, nearest to those at `near`.
    fn joints_at(&self, from: usize, time: f64, near: usize) -> Option<Joints> {
        let end = |place: usize| WayEnd::of(&self.points[place], &self.checked[place]);
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
    let is_turn = move_time(nozzles[0], nozzles[1], from.speed).is_none() && moved >= TURN;
    let shift = nozzles[1].translation.vector - nozzles[0].translation.vector;
    let is_passed = !is_other_way && !is_turn && moved <= PI;
    is_passed.then(|| shift.norm() / from.speed)
}
