//! Slows the moves of a path where joints or rail cannot accelerate as much as needed.
//!
//! The moves before and behind a point that needs too much are slowed until it needs no more than allowed: with the gun
//! off on both, the faster one first. Where the gun is switched, the move with the gun off is slowed alone if that
//! helps. With the gun on, the one or both that help most are slowed in small steps, and only as far as the film stays
//! within its tolerance ([`FilmRoom`]). If the point still needs too much, they keep their speeds.

use super::{
    ArmPoint, CheckParams, FilmRoom, PlacedArm, PointCheck,
    acceleration::{as_passed, check_accelerations, problem_around, problems_of},
    problem::PointProblem,
    way::{MIN_TRAVEL_SPEED_M_S, Way},
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

/// Slows moves where a joint or the rail cannot accelerate as much as needed, then marks the points around which it still
/// cannot.
pub(super) fn keep_accelerations(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &mut [PointCheck],
    params: &CheckParams<'_>,
) {
    let mut slowing = Slowing {
        placed,
        points,
        film: params.film,
        first: usize::from(params.approach.is_some()),
        may_spray_longer: points
            .iter()
            .map(|point| point.is_gun_on && params.film.is_some())
            .collect(),
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
}

impl Slowing<'_> {
    fn run(&self, checked: &mut [PointCheck]) {
        for _ in 0..MAX_ROUNDS {
            let passed = as_passed(self.points, checked);
            let found = problems_of(self.placed, &passed, checked);
            if !self.slow_down(&passed, checked, &found) {
                break;
            }
        }
    }

    /// Moves slowed with the gun on, next to points that still need too much.
    fn sprayed_in_vain(&self, checked: &[PointCheck]) -> Vec<usize> {
        let is_bad = |point: &PointCheck| {
            let problem = point.problem.as_ref();
            problem.is_some_and(PointProblem::is_acceleration)
        };
        let moves = checked.windows(2).enumerate();
        let in_vain = moves.filter(|(from, ends)| {
            matches!(ends[1].way, Way::SlowerSpraying(_))
                && self.may_spray_longer[*from]
                && ends.iter().any(is_bad)
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
            let Some(excess) = problem.as_ref().and_then(excess_of) else {
                continue;
            };
            for (from, speed) in self.slower(&mut trial, checked, here, excess) {
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
        let step = excess.clamp(MIN_SLOWING, MAX_SPRAYING_STEP);
        let spraying = on.into_iter().filter(|from| self.may_spray_longer[*from]);
        let spraying: Vec<(usize, f64)> = spraying
            .map(|from| {
                let least = self.points[from].speed * MIN_SPRAYING_SHARE;
                (from, (passed[from].speed / step).max(least))
            })
            .collect();
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
            problem.as_ref().and_then(excess_of).unwrap_or_default()
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
}

/// How many times the acceleration allowed is needed; `None` for other problems.
fn excess_of(problem: &PointProblem) -> Option<f64> {
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
        _ => None,
    }
}
