//! Finds the best joints for the points of a path, and the problems that are left.
//!
//! The cheapest chain of candidates is found with the nozzle as the path has it, and again with tilts near points that
//! are missed. The tilts of each chain are smoothed as long as fewer points are missed; a stretch whose smoothing makes
//! any point worse keeps its tilts. The chain that misses fewer points is the result.

use std::ops::Range;

use super::{
    ArmError, ArmPoint, CheckParams, PlacedArm, PointCheck, Way,
    chain::{
        Candidate, UPRIGHT, angle_of, candidates_of, free_chain, is_free, nozzle_at, test_all,
        tilts_up_to, turns_of,
    },
    kinematics::Solver,
    path::num_bad,
    problem::PointProblem,
    rail_plan::rail_positions,
    slowing::slow_moves,
    smooth_tilts::smooth_tilts,
    way::{WayEnd, way_between},
};
use geometry::parallel::{map_each, num_cores};

/// Points on either side of a problem at which the nozzle may tilt as well, so that it tilts gradually.
const NUM_TILTED_BESIDE: usize = 8;

/// Checks the points; a rail moves along them, or stands still if that is better.
pub(super) fn check_points(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<Vec<PointCheck>, ArmError> {
    let rails = rail_positions(placed, points, params, is_cancelled)?;
    let checked = check_on(is_cancelled, placed, points, params, &rails)?;
    let moving = placed.arm.moving_rail();
    let Some((rail, _)) = moving.filter(|_| num_bad(&checked) > 0) else {
        return Ok(checked);
    };
    // The positions of the rail are chosen without regard to speeds.
    let at = params.rail.clamp(rail.range[0], rail.range[1]);
    let rails = vec![at; points.len()];
    let still = check_on(is_cancelled, placed, points, params, &rails)?;
    Ok(fewer_bad(still, checked))
}

/// Checks the points with the rail at these positions.
fn check_on(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    rails: &[f64],
) -> Result<Vec<PointCheck>, ArmError> {
    let check = Check {
        is_cancelled,
        placed,
        solvers: rails
            .iter()
            .map(|rail| Solver::new(placed, *rail))
            .collect(),
        rails,
        points,
        params,
    };
    let solvers = &check.solvers;
    let mut candidates: Vec<Vec<Candidate>> = Vec::with_capacity(points.len());
    for (solver, point) in solvers.iter().zip(points) {
        check.go_on()?;
        candidates.push(candidates_of(solver, point, params.num_turns, &[UPRIGHT]));
    }
    let checked = check.cheapest(&mut candidates)?;
    if params.max_tilt <= 0.0 || num_bad(&checked) == 0 {
        return Ok(checked);
    }
    let tilts = tilts_up_to(params.max_tilt);
    // A tilt is of no use where gun or arm collide with every one.
    let collides = |i: usize| matches!(checked[i].problem, Some(PointProblem::Collision { .. }));
    let may_help = map_each(points.len(), num_cores(), |i| {
        let is_hopeless = || {
            collides(i)
                && (is_cancelled() || !is_free(&solvers[i], &points[i], params.num_turns, &tilts))
        };
        checked[i].problem.is_some() && !is_hopeless()
    });
    check.go_on()?;
    if !may_help.contains(&true) {
        return Ok(checked);
    }
    let may_tilt = beside(&may_help);
    for (i, (solver, point)) in solvers.iter().zip(points).enumerate() {
        if may_tilt[i] {
            check.go_on()?;
            candidates[i].extend(candidates_of(solver, point, params.num_turns, &tilts));
            // Most of them collide as well: chains that were to find that out one by one would take longer.
            if collides(i) {
                test_all(&mut candidates[i], solver, point, params.num_turns);
            }
        }
    }
    let tilted = check.cheapest(&mut candidates)?;
    Ok(fewer_bad(tilted, checked))
}

/// The points at which the nozzle may tilt for the sake of these.
fn beside(these: &[bool]) -> Vec<bool> {
    let near = (0..these.len())
        .map(|i| i.saturating_sub(NUM_TILTED_BESIDE)..these.len().min(i + NUM_TILTED_BESIDE + 1));
    near.map(|near| these[near].contains(&true)).collect()
}

/// Whether a check misses fewer points than another, and none that the other reaches.
fn is_better(one: &[PointCheck], other: &[PointCheck]) -> bool {
    let mut both = one.iter().zip(other);
    num_bad(one) < num_bad(other)
        && both.all(|(one, other)| one.problem.is_none() || other.problem.is_some())
}

/// Returns the check that misses fewer points; the second if both miss as many.
fn fewer_bad(one: Vec<PointCheck>, other: Vec<PointCheck>) -> Vec<PointCheck> {
    if num_bad(&one) < num_bad(&other) {
        one
    } else {
        other
    }
}

/// The parts of a path between the middles of the stretches at which the nozzle may not tilt.
fn sections(may_tilt: &[bool]) -> impl Iterator<Item = Range<usize>> {
    let mut ends = Vec::new();
    let mut first = 0;
    for stretch in may_tilt.chunk_by(|a, b| a == b) {
        if !stretch[0] {
            ends.push(first + stretch.len() / 2);
        }
        first += stretch.len();
    }
    ends.push(first);
    let mut begin = 0;
    ends.into_iter()
        .map(move |end| std::mem::replace(&mut begin, end)..end)
}

/// The joints chosen at every point; none where there are none.
type Chosen = Vec<Option<Candidate>>;

/// What a check of points needs.
struct Check<'a> {
    is_cancelled: &'a (dyn Fn() -> bool + Sync),
    placed: &'a PlacedArm,
    /// One per point, for the rail's position there.
    solvers: Vec<Solver<'a>>,
    rails: &'a [f64],
    points: &'a [ArmPoint],
    params: &'a CheckParams<'a>,
}

impl Check<'_> {
    fn go_on(&self) -> Result<(), ArmError> {
        if (self.is_cancelled)() {
            Err(ArmError::Cancelled)
        } else {
            Ok(())
        }
    }

    /// The result for the cheapest chain of these candidates, with tilts smoothed as often as fewer points are then missed.
    fn cheapest(&self, candidates: &mut [Vec<Candidate>]) -> Result<Vec<PointCheck>, ArmError> {
        let (solvers, num_turns) = (&self.solvers, self.params.num_turns);
        let is_cancelled = self.is_cancelled;
        let chain = free_chain(solvers, self.points, candidates, num_turns, is_cancelled);
        let chain = chain.ok_or(ArmError::Cancelled)?;
        let chosen = chain.into_iter().zip(candidates.iter());
        let chosen = chosen.map(|(index, here)| index.map(|index| here[index]));
        let mut chosen: Chosen = chosen.collect();
        let mut checked = self.check_chosen(&chosen)?;
        while let Some(smoother) = self.smoother(&chosen, &checked)? {
            (chosen, checked) = smoother;
        }
        Ok(checked)
    }

    /// The same joints with smoothed tilts around points at which joints cannot follow, wherever fewer points are then
    /// missed, and the result for them; `None` if that is nowhere.
    fn smoother(
        &self,
        chosen: &[Option<Candidate>],
        checked: &[PointCheck],
    ) -> Result<Option<(Chosen, Vec<PointCheck>)>, ArmError> {
        let is_bad = |point: &PointCheck| {
            let problem = point.problem.as_ref();
            problem.is_some_and(|problem| problem.is_of_joints() || problem.is_acceleration())
        };
        let is_bad: Vec<bool> = checked.iter().map(is_bad).collect();
        let may_help = self.params.max_tilt > 0.0 && self.placed.arm.accelerations.is_some();
        if !may_help || !is_bad.contains(&true) {
            return Ok(None);
        }
        let may_tilt = beside(&is_bad);
        let (placed, solvers, points) = (self.placed, &self.solvers, self.points);
        let mut smooth = chosen.to_vec();
        smooth_tilts(
            placed,
            solvers,
            points,
            checked,
            &mut smooth,
            &may_tilt,
            self.params,
        );
        let found = self.check_chosen(&smooth)?;
        let mut is_any = false;
        for section in sections(&may_tilt) {
            if is_better(&found[section.clone()], &checked[section.clone()]) {
                is_any = true;
            } else {
                smooth[section.clone()].copy_from_slice(&chosen[section]);
            }
        }
        if !is_any {
            return Ok(None);
        }
        let found = self.check_chosen(&smooth)?;
        Ok(is_better(&found, checked).then_some((smooth, found)))
    }

    /// The result for these joints at every point; `None` where there are none.
    fn check_chosen(&self, chosen: &[Option<Candidate>]) -> Result<Vec<PointCheck>, ArmError> {
        let Self {
            placed,
            points,
            params,
            ..
        } = self;
        let mut checked: Vec<PointCheck> = Vec::with_capacity(points.len());
        for (i, (point, candidate)) in points.iter().zip(chosen).enumerate() {
            self.go_on()?;
            let (solver, rail) = (&self.solvers[i], self.rails[i]);
            let Some(candidate) = candidate else {
                checked.push(PointCheck {
                    robot_from_nozzle: point.robot_from_nozzle,
                    rail,
                    problem: Some(why_not(solver, point, params.num_turns)),
                    ..PointCheck::default()
                });
                continue;
            };
            let turn = angle_of(candidate.turn, params.num_turns);
            let singular = solver.singularity(&candidate.joints);
            let before = i.checked_sub(1).and_then(|before| {
                let end = WayEnd::of(&checked[before])?;
                Some((end, &points[before]))
            });
            let robot_from_nozzle = nozzle_at(point, candidate.tilt, turn);
            let to = WayEnd {
                nozzle: robot_from_nozzle,
                joints: candidate.joints,
                rail,
            };
            // A collision precedes all other problems.
            let here = if candidate.is_collision == Some(true) {
                solver.collision(&candidate.joints)
            } else {
                None
            };
            let (way, on_the_way) = match before {
                Some((from, start)) if here.is_none() => {
                    way_between(placed, &from, &to, [start, point])
                }
                _ => (Way::Planned, None),
            };
            let problem = here.or(on_the_way);
            let near_singularity = || {
                let singularity = singular?;
                Some(PointProblem::NearSingularity { singularity })
            };
            checked.push(PointCheck {
                joints: Some(candidate.joints),
                robot_from_nozzle,
                turn,
                tilt: candidate.tilt[0].hypot(candidate.tilt[1]),
                rail,
                way,
                problem: problem.or_else(near_singularity),
            });
        }
        slow_moves(placed, points, &mut checked, params);
        Ok(checked)
    }
}

/// Returns why a point has no candidate.
fn why_not(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> PointProblem {
    let mut nearest: Option<(f64, PointProblem)> = None;
    for turn in turns_of(point, num_turns) {
        for joints in solver.solutions(&nozzle_at(point, UPRIGHT, angle_of(turn, num_turns)), None)
        {
            let Some((joint, angle)) = solver.beyond_limit(&joints) else {
                continue;
            };
            let [low, high] = solver.arm.limits[joint];
            let excess = (low - angle).max(angle - high);
            if nearest.as_ref().is_none_or(|(least, _)| excess < *least) {
                let joint = joint + 1;
                nearest = Some((excess, PointProblem::JointLimit { joint, angle }));
            }
        }
    }
    nearest.map_or(PointProblem::OutOfReach, |(_, problem)| problem)
}
