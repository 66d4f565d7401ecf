//! The move from one checked point to the next.

use super::{
    Arm, ArmPoint, PlacedArm, PointCheck, Way,
    chain::move_time,
    kinematics::{Joints, Solver},
    problem::PointProblem,
};
use geometry::rigid::RigidTransform;

/// Maximum step in which straight moves are checked, metres and radians.
const MAX_STEP_M_RAD: [f64; 2] = [0.05, 0.175];
/// Turn of a joint, radians, over which its speed counts as even, apart from the [`unevenness`]: past a singularity a joint
/// follows an arc tangent, which is nowhere half a percent steeper than on average over so little around its middle.
const EVEN_TURN_RAD: f64 = 0.2;
/// Share of a joint's top speed that is not reached on average over a step which is not examined more closely.
const EASY_SPEED_SHARE: f64 = 0.8;
/// Most halvings of a step: 50 mm become 0.05 mm.
const MAX_HALVINGS: u32 = 10;
/// The greatest speed of a joint is found to this share.
const PEAK_SPEED_ERROR: f64 = 0.05;
/// Differences of joints up to this are ignored, radians.
const SAME_JOINT_RAD: f64 = 1e-4;

/// The times of a run are sums, which are not exact.
const TIME_TOLERANCE_S: f64 = 1e-6;

/// Lowest speed at which the arm moves between strokes, m/s.
pub(super) const MIN_TRAVEL_SPEED_M_S: f64 = 0.01;
/// Maximum step in which joint moves are checked, radians.
const MAX_JOINT_STEP_RAD: f64 = 0.05;

/// One end of a straight move.
pub(super) struct WayEnd {
    pub(super) nozzle: RigidTransform,
    pub(super) joints: Joints,
    pub(super) rail: f64,
}

impl WayEnd {
    /// The end at a checked point; `None` if it is not reached.
    pub(super) fn of(checked: &PointCheck) -> Option<Self> {
        Some(Self {
            nozzle: checked.robot_from_nozzle,
            joints: checked.joints?,
            rail: checked.rail,
        })
    }

    /// The joints nearest to `near` at this share of the straight move to another end; `None` if that pose is not
    /// reached.
    pub(super) fn joints_towards(
        &self,
        end: &Self,
        share: f64,
        placed: &PlacedArm,
        near: &Joints,
    ) -> Option<Joints> {
        let solver = Solver::new(placed, self.rail_towards(end, share));
        nearest(&solver, &self.nozzle_towards(end, share), near)
    }

    fn rail_towards(&self, end: &Self, share: f64) -> f64 {
        self.rail + (end.rail - self.rail) * share
    }

    fn nozzle_towards(&self, end: &Self, share: f64) -> RigidTransform {
        let (from, to) = (&self.nozzle, &end.nozzle);
        nalgebra::Isometry3::from_parts(
            (from.translation.vector.lerp(&to.translation.vector, share)).into(),
            from.rotation.slerp(&to.rotation, share),
        )
    }
}

/// True if the arm may reach `end` by a joint move: with the gun off, and only if the program can name the
/// configuration there. The approach and the retreat are straight.
pub(super) fn may_move_by_joints(arm: &Arm, start: &ArmPoint, end: &ArmPoint) -> bool {
    let is_end_of_program = start.is_stop && end.is_stop;
    arm.maker.is_some() && !start.is_gun_on && !end.is_gun_on && !is_end_of_program
}

/// Finds how the arm moves from one chosen solution to the next, and the problem of that move, if any.
pub(super) fn way_between(
    placed: &PlacedArm,
    from: &WayEnd,
    to: &WayEnd,
    [start, end]: [&ArmPoint; 2],
) -> (Way, Option<PointProblem>) {
    let problem = way_problem(placed, from, to, start.speed);
    if problem.is_none() || start.is_gun_on {
        return (Way::Planned, problem);
    }
    let mut speed = start.speed;
    while speed > MIN_TRAVEL_SPEED_M_S
        && matches!(
            problem,
            Some(PointProblem::TooFast { .. } | PointProblem::RailTooFast { .. })
        )
    {
        speed = (speed / 2.0).max(MIN_TRAVEL_SPEED_M_S);
        if way_problem(placed, from, to, speed).is_none() {
            return (Way::Slower(speed), None);
        }
    }
    if may_move_by_joints(&placed.arm, start, end) && is_joint_move_free(placed, from, to) {
        return (Way::Joints, None);
    }
    (Way::Planned, problem)
}

/// True if gun and arm collide with nothing during a joint move.
fn is_joint_move_free(placed: &PlacedArm, from: &WayEnd, to: &WayEnd) -> bool {
    let num = (apart(&from.joints, &to.joints) / MAX_JOINT_STEP_RAD).ceil();
    (1..num as usize).all(|k| {
        let share = k as f64 / num;
        let solver = Solver::new(placed, from.rail_towards(to, share));
        let joints =
            std::array::from_fn(|i| from.joints[i] + (to.joints[i] - from.joints[i]) * share);
        !solver.collides(&joints)
    })
}

/// Follows a straight move from one chosen solution to the next, and returns its problem, if any.
pub(super) fn way_problem(
    placed: &PlacedArm,
    start: &WayEnd,
    end: &WayEnd,
    speed: f64,
) -> Option<PointProblem> {
    let (from, to) = (&start.nozzle, &end.nozzle);
    let distance = (to.translation.vector - from.translation.vector).norm();
    let angle = from.rotation.angle_to(&to.rotation);
    let ride = (end.rail - start.rail).abs();
    let num = (distance.max(ride) / MAX_STEP_M_RAD[0]).max(angle / MAX_STEP_M_RAD[1]);
    let num = num.ceil().max(1.0);
    let allowed = move_time(from, to, speed);
    let mut problem = rail_problem(&placed.arm, ride, allowed);
    let allowed = allowed.map(|time| time / num);
    let mut at = start.joints;
    for k in 1..=num as usize {
        let share = k as f64 / num;
        let solver = Solver::new(placed, start.rail_towards(end, share));
        let near = if k == num as usize {
            end.joints
        } else {
            let pose = start.nozzle_towards(end, share);
            let Some(nearest) = nearest(&solver, &pose, &at) else {
                return problem.or(Some(PointProblem::OutOfReach));
            };
            // A collision precedes all other problems, but the arm stops at a limit before it collides. The ends of the
            // move are points, which are tested already.
            if outside(&solver, &nearest).is_none()
                && let Some(collision) = solver.collision(&nearest)
            {
                return Some(collision);
            }
            nearest
        };
        problem = problem.or_else(|| step_problem(&solver, &at, &near, allowed));
        if k == num as usize {
            problem = problem.or_else(|| arrival_problem(&solver, start, end, &at));
        }
        if let Some(seconds) = allowed.filter(|_| problem.is_none()) {
            let step = Step {
                shares: [(k - 1) as f64 / num, share],
                joints: [at, near],
                seconds,
            };
            if !step.is_easy(&placed.arm) {
                problem = peak_problem(placed, [start, end], step);
            }
        }
        at = near;
    }
    problem
}

/// A step of a straight move.
struct Step {
    /// Where it begins and ends, as shares of the move.
    shares: [f64; 2],
    /// The solutions there.
    joints: [Joints; 2],
    seconds: f64,
}

impl Step {
    /// True if no joint can be too fast anywhere within the step: they turn little, and on average well below their top
    /// speeds.
    fn is_easy(&self, arm: &Arm) -> bool {
        let [from, to] = &self.joints;
        let unevenness = unevenness(arm, &[from, to]);
        (0..6).all(|i| {
            let turn = (to[i] - from[i]).abs();
            let most = EASY_SPEED_SHARE * arm.speeds[i] * self.seconds;
            turn <= EVEN_TURN_RAD && turn * unevenness <= most
        })
    }
}

/// How much faster a joint may be at one of these solutions than at another for the same motion of the nozzle: speeds
/// grow with the reciprocal of the distance from a singularity. Infinite if one is passed.
fn unevenness(arm: &Arm, solutions: &[&Joints]) -> f64 {
    let shapes = solutions.iter().map(|joints| arm.shape(joints));
    let range = shapes.fold([[f64::INFINITY, f64::NEG_INFINITY]; 3], |range, shape| {
        std::array::from_fn(|i| [range[i][0].min(shape[i]), range[i][1].max(shape[i])])
    });
    let each = range.into_iter().map(|[low, high]| {
        if low * high <= 0.0 {
            f64::INFINITY
        } else {
            (low / high).max(high / low)
        }
    });
    each.fold(1.0, f64::max)
}

/// Returns the problem of the joint that is fastest in proportion to its top speed anywhere within a step. The step is
/// halved until the joints turn evenly, or no joint can be faster than the fastest one found and its top speed: within a
/// half, a speed may change by as much as it differs from that of the other half, and by the [`unevenness`].
fn peak_problem(
    placed: &PlacedArm,
    [start, end]: [&WayEnd; 2],
    step: Step,
) -> Option<PointProblem> {
    let mut worst = (1.0, None);
    let mut left = vec![(step, MAX_HALVINGS)];
    while let Some((step, num_halvings)) = left.pop() {
        let Step {
            shares,
            joints: [from, to],
            seconds,
        } = step;
        let share = f64::midpoint(shares[0], shares[1]);
        let near = std::array::from_fn(|i| f64::midpoint(from[i], to[i]));
        let solver = Solver::new(placed, start.rail_towards(end, share));
        let Some(middle) = nearest(&solver, &start.nozzle_towards(end, share), &near) else {
            return Some(PointProblem::OutOfReach);
        };
        if let Some((joint, angle)) = outside(&solver, &middle) {
            let joint = joint + 1;
            return Some(PointProblem::JointLimit { joint, angle });
        }
        let half = 0.5 * seconds;
        let unevenness = unevenness(&placed.arm, &[&from, &middle, &to]);
        let mut is_settled = true;
        for i in 0..6 {
            let turns = [middle[i] - from[i], to[i] - middle[i]].map(f64::abs);
            let [most, least] = [turns[0].max(turns[1]), turns[0].min(turns[1])];
            let top = placed.arm.speeds[i];
            if most >= SAME_JOINT_RAD && most / half > worst.0 * top * (1.0 + TIME_TOLERANCE_S) {
                let kept = [&from, &middle, &to].map(|at| placed.arm.configuration(at));
                let problem = if kept[0] == kept[1] && kept[1] == kept[2] {
                    PointProblem::TooFast {
                        joint: i + 1,
                        speed: most / half,
                    }
                } else {
                    PointProblem::ConfigurationChange
                };
                worst = (most / half / top, Some(problem));
            }
            // The two halves may turn a joint in opposite directions.
            let change = (to[i] - 2.0 * middle[i] + from[i]).abs().max(most - least);
            let bound = unevenness * (most + change) / half / top;
            let enough = worst.0
                * if worst.1.is_some() {
                    1.0 + PEAK_SPEED_ERROR
                } else {
                    1.0
                };
            is_settled &= most <= EVEN_TURN_RAD && (bound <= enough || most < SAME_JOINT_RAD);
        }
        if !is_settled && num_halvings > 0 {
            let step = |shares, joints| Step {
                shares,
                joints,
                seconds: half,
            };
            let halves = [
                step([share, shares[1]], [middle, to]),
                step([shares[0], share], [from, middle]),
            ];
            left.extend(halves.map(|step| (step, num_halvings - 1)));
        }
    }
    worst.1
}

/// Largest difference of a joint, radians.
pub(super) fn apart(a: &Joints, b: &Joints) -> f64 {
    let all = a.iter().zip(b);
    all.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The joints nearest to `at` that reach a pose.
pub(super) fn nearest(solver: &Solver<'_>, pose: &RigidTransform, at: &Joints) -> Option<Joints> {
    let solutions = solver.solutions(pose, Some(at)).into_iter();
    solutions.min_by(|a, b| apart(a, at).total_cmp(&apart(b, at)))
}

/// Returns the problem of a straight move from `at`, shortly before its end, that does not arrive with the joints
/// chosen there. However slow the move, the controller neither changes the configuration nor turns a joint once around.
fn arrival_problem(
    solver: &Solver<'_>,
    start: &WayEnd,
    end: &WayEnd,
    at: &Joints,
) -> Option<PointProblem> {
    /// Least difference of two solutions that are not singular, radians.
    const OTHER_MIN_RAD: f64 = 0.01;
    // Several solutions meet at a singularity, which is a problem of its own.
    let ends = [&start.joints, &end.joints];
    if ends
        .iter()
        .any(|joints| solver.singularity(joints).is_some())
    {
        return None;
    }
    let arrives = nearest(solver, &end.nozzle, at)?;
    if apart(&arrives, &end.joints) < OTHER_MIN_RAD {
        return None;
    }
    let beyond = outside(solver, &arrives).map(|(joint, angle)| PointProblem::JointLimit {
        joint: joint + 1,
        angle,
    });
    Some(beyond.unwrap_or(PointProblem::ConfigurationChange))
}

/// Checks that the rail can ride this far in `allowed` seconds; unlimited if `None`.
fn rail_problem(arm: &Arm, ride: f64, allowed: Option<f64>) -> Option<PointProblem> {
    let (_, fastest) = arm.moving_rail()?;
    let speed = ride / allowed?;
    (speed > fastest * (1.0 + TIME_TOLERANCE_S)).then_some(PointProblem::RailTooFast { speed })
}

/// Returns the problem of a short step between two solutions that may take `allowed` seconds; unlimited if `None`.
fn step_problem(
    solver: &Solver<'_>,
    at: &Joints,
    near: &Joints,
    allowed: Option<f64>,
) -> Option<PointProblem> {
    if let Some((joint, angle)) = outside(solver, near) {
        return Some(PointProblem::JointLimit {
            joint: joint + 1,
            angle,
        });
    }
    let time = allowed.unwrap_or(f64::INFINITY);
    let is_too_fast = |i: &usize| {
        let moved = (near[*i] - at[*i]).abs();
        moved / time > solver.arm.speeds[*i] && moved >= SAME_JOINT_RAD
    };
    let i = (0..6).find(is_too_fast)?;
    Some(
        if solver.arm.configuration(near) == solver.arm.configuration(at) {
            PointProblem::TooFast {
                joint: i + 1,
                speed: (near[i] - at[i]).abs() / time,
            }
        } else {
            PointProblem::ConfigurationChange
        },
    )
}

/// The first joint outside its limits, and its angle.
pub(super) fn outside(solver: &Solver<'_>, joints: &Joints) -> Option<(usize, f64)> {
    let limits = solver.arm.limits.iter().zip(joints).enumerate();
    let mut beyond = limits.filter(|(_, ([low, high], angle))| {
        !(low - SAME_JOINT_RAD..=high + SAME_JOINT_RAD).contains(*angle)
    });
    beyond.next().map(|(i, (_, angle))| (i, *angle))
}
