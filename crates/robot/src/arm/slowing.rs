//! Slows the moves of a path where joints or rail cannot accelerate as much as needed, or are too fast with the gun on.
//!
//! The moves before and behind a point that needs too much acceleration are slowed until it needs no more than allowed:
//! with the gun off on both, the faster one first. Where the gun is switched, the move with the gun off is slowed alone
//! if that helps. With the gun on, the one or both that help most are slowed in small steps. A move with the gun on that
//! is too fast for a joint or the rail is slowed by its excess. (With the gun off, [`way_between`](super::way::way_between)
//! has slowed it already.) With the gun on, moves are slowed only as far as the film stays within its tolerance
//! ([`FilmRoom`]); if that is not enough, they keep their speeds.

use super::{
    ArmPoint, CheckParams, FilmRoom, PlacedArm, PointCheck, Way,
    acceleration::{as_passed, check_accelerations, problem_around, problems_of},
    kinematics::Solver,
    problem::PointProblem,
    way::{MIN_TRAVEL_SPEED_M_S, WayEnd, way_problem},
};

/// Relative changes of speed up to this are ignored.
const SAME_SPEED_SHARE: f64 = 1e-6;
/// Most rounds of slowing moves: each slows those around a corner, then those before and behind them.
const MAX_ROUNDS: usize = 60;
/// Least factor by which a move is slowed in a round.
const MIN_SLOWING: f64 = 1.03;
/// Greatest factor by which a move with the gun on is slowed in a round: paint is lost with every step.
const MAX_SPRAYING_STEP: f64 = 1.1;
/// Least speed of a move with the gun on, as a share of the planned speed: where the jet passes the part, the film sets
/// no limit.
const MIN_SPRAYING_SHARE: f64 = 1.0 / 3.0;
/// Slowing moves helps if a point then needs at most this share of the acceleration.
const HELPED_SHARE: f64 = 0.995;

/// Slows moves where a joint or the rail cannot follow, then marks the points at which it still cannot.
pub(super) fn slow_moves(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &mut [PointCheck],
    params: &CheckParams<'_>,
) {
    let may_spray_longer = |i: usize| points[i].is_gun_on && params.film.is_some();
    let is_singular = |point: &PointCheck| {
        let solver = Solver::new(placed, point.rail);
        let joints = point.joints.as_ref();
        joints.is_some_and(|joints| solver.singularity(joints).is_some())
    };
    let may_slow = |to: &usize| {
        let point = &checked[*to];
        may_spray_longer(to - 1) && is_too_fast(point) && !is_singular(point)
    };
    let mut slowing = Slowing {
        placed,
        points,
        film: params.film,
        first: usize::from(params.approach.is_some()),
        may_spray_longer: (0..points.len()).map(may_spray_longer).collect(),
        too_fast: (1..points.len()).filter(may_slow).collect(),
    };
    let before = checked.to_vec();
    loop {
        slowing.run(checked);
        check_accelerations(placed, &as_passed(points, checked), checked);
        let in_vain = slowing.sprayed_in_vain(checked);
        if in_vain.is_empty() {
            return;
        }
        for from in in_vain {
            slowing.may_spray_longer[from] = false;
            slowing.too_fast.retain(|to| *to != from + 1);
        }
        checked.clone_from_slice(&before);
    }
}

/// Slows the moves of a checked path.
struct Slowing<'a> {
    placed: &'a PlacedArm,
    points: &'a [ArmPoint],
    film: Option<&'a FilmRoom>,
    /// Index of the point at which the film's path begins.
    first: usize,
    /// For each point, whether the move from it may be slowed with the gun on.
    may_spray_longer: Vec<bool>,
    /// Points to which a move with the gun on is too fast, and which would be reached by a slower one.
    too_fast: Vec<usize>,
}

impl Slowing<'_> {
    fn run(&self, checked: &mut [PointCheck]) {
        for _ in 0..MAX_ROUNDS {
            let passed = as_passed(self.points, checked);
            let mut found = problems_of(self.placed, &passed, checked);
            for to in &self.too_fast {
                let problem = self.speed_problem(&passed, checked, *to);
                found[*to] = problem.or(found[*to].take());
            }
            if !self.slow_down(&passed, checked, &found) {
                break;
            }
        }
        let passed = as_passed(self.points, checked);
        for to in &self.too_fast {
            checked[*to].problem = self.speed_problem(&passed, checked, *to);
        }
    }

    /// The problem of the move to a point at its speed in `passed`.
    fn speed_problem(
        &self,
        passed: &[ArmPoint],
        checked: &[PointCheck],
        to: usize,
    ) -> Option<PointProblem> {
        let [start, end] = [to - 1, to].map(|i| WayEnd::of(&checked[i]));
        way_problem(self.placed, &start?, &end?, passed[to - 1].speed)
    }

    /// Moves slowed with the gun on to points that are still missed, or next to points that still need too much.
    fn sprayed_in_vain(&self, checked: &[PointCheck]) -> Vec<usize> {
        let needs_too_much = |point: &PointCheck| {
            let problem = point.problem.as_ref();
            problem.is_some_and(PointProblem::is_acceleration)
        };
        let moves = checked.windows(2).enumerate();
        let in_vain = moves.filter(|(from, ends)| {
            let is_missed = if self.too_fast.contains(&(from + 1)) {
                ends[1].problem.is_some()
            } else {
                ends.iter().any(needs_too_much)
            };
            let is_slower = matches!(ends[1].way, Way::SlowerSpraying(_));
            is_slower && self.may_spray_longer[*from] && is_missed
        });
        in_vain.map(|(from, _)| from).collect()
    }

    /// Slows moves before and behind points with these problems; returns false if none can be slower.
    fn slow_down(
        &self,
        passed: &[ArmPoint],
        checked: &mut [PointCheck],
        found: &[Option<PointProblem>],
    ) -> bool {
        let mut speeds: Vec<f64> = passed.iter().map(|point| point.speed).collect();
        let mut trial = passed.to_vec();
        for (here, problem) in found.iter().enumerate() {
            let Some(problem) = problem else { continue };
            let Some(excess) = self.excess_of(problem) else {
                continue;
            };
            let slower = if problem.is_acceleration() {
                self.slower(&mut trial, checked, here, excess)
            } else {
                vec![self.sprayed_slower(passed, here - 1, excess)]
            };
            for (from, speed) in slower {
                speeds[from] = speeds[from].min(speed);
            }
        }
        self.limit_to_film(&mut speeds);
        let mut is_slower = false;
        for (from, speed) in speeds.into_iter().enumerate() {
            let is_changed = (speed / passed[from].speed - 1.0).abs() > SAME_SPEED_SHARE;
            if is_changed
                && let Some(to) = checked.get_mut(from + 1)
                && to.way != Way::Joints
            {
                to.way = if !passed[from].is_gun_on {
                    Way::Slower(speed)
                } else if speed < self.points[from].speed {
                    Way::SlowerSpraying(speed)
                } else {
                    Way::Planned
                };
                is_slower |= speed < passed[from].speed;
            }
        }
        is_slower
    }

    /// The moves to slow around a point that needs `excess` times the acceleration allowed, and their speeds. Other speeds
    /// are tried in `passed`, which has its own again afterwards.
    fn slower(
        &self,
        passed: &mut [ArmPoint],
        checked: &[PointCheck],
        here: usize,
        excess: f64,
    ) -> Vec<(usize, f64)> {
        let around = here.saturating_sub(1)..(here + 1).min(passed.len() - 1);
        let (on, off): (Vec<usize>, Vec<usize>) = around.partition(|from| passed[*from].is_gun_on);
        let fastest = off.iter().map(|from| passed[*from].speed);
        let fastest = fastest.fold(0.0, f64::max);
        let speed = (fastest / excess.max(MIN_SLOWING)).max(MIN_TRAVEL_SPEED_M_S);
        let with_gun_off: Vec<(usize, f64)> = off.into_iter().map(|from| (from, speed)).collect();
        if on.is_empty() {
            return with_gun_off;
        }
        let step = excess.min(MAX_SPRAYING_STEP);
        let spraying = on.into_iter().filter(|from| self.may_spray_longer[*from]);
        let spraying = spraying.map(|from| self.sprayed_slower(passed, from, step));
        let spraying: Vec<(usize, f64)> = spraying.collect();
        let mut needed = |slower: &[(usize, f64)]| {
            let own = slower.iter().map(|(from, _)| passed[*from].speed);
            let own: Vec<f64> = own.collect();
            for (from, speed) in slower {
                passed[*from].speed = passed[*from].speed.min(*speed);
            }
            let problem = problem_around(self.placed, passed, checked, here);
            for ((from, _), speed) in slower.iter().zip(own) {
                passed[*from].speed = speed;
            }
            let excess = problem.and_then(|problem| self.excess_of(&problem));
            excess.unwrap_or_default()
        };
        let helps = |needed: f64| needed <= HELPED_SHARE * excess;
        if helps(needed(&with_gun_off)) {
            return with_gun_off;
        }
        let each = spraying.iter().map(|one| vec![*one]);
        let both = [&spraying[..], &with_gun_off].concat();
        let choices = each.chain([both]).map(|slower| (needed(&slower), slower));
        let best = choices.min_by(|a, b| a.0.total_cmp(&b.0));
        let best = best.filter(|(needed, _)| helps(*needed));
        best.map_or_else(Vec::new, |(_, slower)| slower)
    }

    /// A move slowed with the gun on by a factor, and its speed.
    fn sprayed_slower(&self, passed: &[ArmPoint], from: usize, factor: f64) -> (usize, f64) {
        let least = self.points[from].speed * MIN_SPRAYING_SHARE;
        let speed = passed[from].speed / factor.max(MIN_SLOWING);
        (from, speed.max(least))
    }

    /// Raises the speeds with the gun on until the film has room for the longer times.
    fn limit_to_film(&self, speeds: &mut [f64]) {
        let Some(film) = self.film else { return };
        let planned = self.points[self.first..].iter();
        let path = speeds[self.first..].iter_mut().zip(planned);
        let mut longer: Vec<f64> = path
            .map(|(speed, planned)| {
                if planned.is_gun_on {
                    planned.speed / *speed - 1.0
                } else {
                    0.0
                }
            })
            .collect();
        film.limit(&mut longer);
        let path = speeds.iter_mut().zip(self.points).skip(self.first);
        for ((speed, planned), longer) in path.zip(longer) {
            if planned.is_gun_on {
                *speed = planned.speed / (1.0 + longer);
            }
        }
    }

    /// How many times the speed or acceleration allowed is needed; `None` for other problems.
    fn excess_of(&self, problem: &PointProblem) -> Option<f64> {
        match problem {
            PointProblem::JointAcceleration {
                acceleration,
                limit,
                ..
            }
            | PointProblem::RailAcceleration {
                acceleration,
                limit,
            } => Some(acceleration / limit),
            PointProblem::TooFast { joint, speed } => {
                Some(speed / self.placed.arm.speeds[joint - 1])
            }
            PointProblem::RailTooFast { speed } => {
                let (_, top) = self.placed.arm.moving_rail()?;
                Some(speed / top)
            }
            _ => None,
        }
    }
}

fn is_too_fast(point: &PointCheck) -> bool {
    matches!(
        point.problem,
        Some(PointProblem::TooFast { .. } | PointProblem::RailTooFast { .. })
    )
}
