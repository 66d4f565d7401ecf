//! The positions of a rail that moves along a path.
//!
//! Positions every 100 mm (farther apart on rails of more than 10 m) are tried at every point: which of the arm's eight
//! configurations reach it from there, within the joints' limits, not singular and clear of all obstacles. Dynamic
//! programming over point, position and configuration then finds the cheapest run of the rail. The rail stands still,
//! or moves from one position to another over as many points as that takes: at constant speed or, if its limit of
//! acceleration is known, accelerating evenly from standstill and slowing down again. The cost, in positions moved, is:
//!
//! - for a move its length, a little more at half the top speed and more at the full one, plus [`START_COST`]: few, slow
//!   moves win;
//! - [`GUN_COST`] times as much while the gun is on, so that the rail tends to stand still along a stroke;
//! - up to [`BORDER_COST`] over the whole path for standing at a position whose neighbour does not reach the point.
//!
//! A missed point, a move too fast for the rail and a change of configuration each cost more than all of that. So if
//! some run of the rail reaches every point with one configuration, the cheapest such run between these positions is
//! found; of a move past more than [`MAX_EXAMINED`] points only that many, and the last, are examined. The run is a
//! proposal: afterwards every point and the way to it are checked with the rail in its place.
//!
//! Known limits: joint speeds are not considered. Near the border of its reach an arm may be too slow, which the check
//! then reports.

use super::{
    ArmError, ArmPoint, CheckParams, PlacedArm,
    chain::{NUM_CONFIGURATIONS, UPRIGHT, angle_of, move_time, nozzle_at, turns_of},
    kinematics::Solver,
};
use geometry::parallel::{map_each, num_cores};

/// Distance of two positions, metres, and their largest number.
const POSITION_STEP_M: f64 = 0.1;
const MAX_POSITIONS: f64 = 100.0;
/// Turns of the nozzle that are tried for a round jet.
const NUM_TURNS: usize = 8;
/// Speeds of a move as shares of the top speed, and the cost per position at each.
const SPEED_COSTS: [(f64, f64); 3] = [(0.25, 1.0), (0.5, 1.25), (1.0, 1.5)];
/// Costs of a move, see the module's documentation.
const START_COST: f64 = 4.0;
const GUN_COST: f64 = 4.0;
const BORDER_COST: f64 = 4.0;
/// Costs of a missed point, and of a jump: a move too fast for the rail, or a change of configuration. One jump is
/// better than a missed point, two are not. All other costs together are less.
const MISSED_COST: f64 = 1e7;
const JUMP_COST: f64 = 0.9 * MISSED_COST;
/// Points examined, evenly, between the ends of a move: a slow rail passes thousands on its way.
const MAX_EXAMINED: usize = 100;

/// Returns the rail's position at every point, metres; `params.rail` if it does not move along the path. Returns
/// [`ArmError::Cancelled`] soon after `is_cancelled` returns true.
pub(super) fn rail_positions(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<f64>, ArmError> {
    let Some((rail, speed)) = placed.arm.moving_rail() else {
        return Ok(vec![params.rail; points.len()]);
    };
    let [low, high] = rail.range;
    let positions = rail.positions(POSITION_STEP_M.max((high - low) / MAX_POSITIONS));
    let solvers: Vec<Solver<'_>> = positions
        .iter()
        .map(|position| Solver::new(placed, *position))
        .collect();
    let reached = map_each(points.len(), num_cores(), |i| {
        if is_cancelled() {
            return None;
        }
        let at = solvers.iter();
        let reached = at.map(|solver| configurations(solver, &points[i]));
        Some(reached.collect::<Vec<u8>>())
    });
    let reached: Option<Vec<Vec<u8>>> = reached.into_iter().collect();
    let mut now = 0.0;
    let times = points.iter().enumerate().map(|(i, point)| {
        if let Some(before) = i.checked_sub(1).map(|before| &points[before]) {
            let (from, to) = (&before.robot_from_nozzle, &point.robot_from_nozzle);
            // A turn on the spot takes as long as the joints need; do not count on that time.
            now += move_time(from, to, before.speed).unwrap_or(0.0);
        }
        now
    });
    Plan {
        times: times.collect(),
        is_gun_on: points.iter().map(|point| point.is_gun_on).collect(),
        reached: reached.ok_or(ArmError::Cancelled)?,
        positions,
        speed,
        acceleration: rail.acceleration,
    }
    .run(is_cancelled)
    .ok_or(ArmError::Cancelled)
}

/// The configurations that reach a point at some turn of the nozzle, a bit for each.
fn configurations(solver: &Solver<'_>, point: &ArmPoint) -> u8 {
    // A fan keeps its orientation between two points, so only configurations that reach the point in this one count.
    let num_turns = if point.is_turn_free { NUM_TURNS } else { 1 };
    let mut found = 0;
    for turn in turns_of(point, num_turns) {
        let pose = nozzle_at(point, UPRIGHT, angle_of(turn, num_turns));
        for joints in solver.solutions(&pose, None) {
            let bit = solver.arm.configuration_bit(&joints);
            let is_reached = found & bit == 0
                && solver.beyond_limit(&joints).is_none()
                && solver.singularity(&joints).is_none()
                && !solver.collides(&joints);
            if is_reached {
                found |= bit;
            }
        }
    }
    found
}

/// Input of the search for a run of the rail.
struct Plan {
    /// Time of the nozzle at each point, seconds.
    times: Vec<f64>,
    is_gun_on: Vec<bool>,
    /// For each point and position, the configurations that reach it.
    reached: Vec<Vec<u8>>,
    /// Evenly spaced, metres.
    positions: Vec<f64>,
    /// Top speed, m/s.
    speed: f64,
    /// Greatest acceleration, m/s²; none if not known.
    acceleration: Option<f64>,
}

/// Point, position and configuration.
type State = (usize, usize, usize);

/// The previous state, packed: a long path on a long rail has millions of states.
type Before = (u32, u8, u8);

/// For each state of a point, the cost of the cheapest run to it, and the previous state.
type Costs = Vec<[(f64, Option<Before>); NUM_CONFIGURATIONS]>;

impl Plan {
    /// Returns the position of the rail at every point; `None` soon after `is_cancelled` returns true.
    fn run(mut self, is_cancelled: &dyn Fn() -> bool) -> Option<Vec<f64>> {
        let num = self.times.len();
        // A point that no rail position reaches is lost anyway; do not let it constrain the rail.
        for here in &mut self.reached {
            if here.iter().all(|found| *found == 0) {
                here.fill(u8::MAX);
            }
        }
        let borders: Vec<Vec<f64>> = self.reached.iter().map(|here| border(here)).collect();
        let own = |(point, position, configuration): State| {
            let is_reached = self.reached[point][position] & (1 << configuration) != 0;
            if is_reached {
                BORDER_COST / num as f64 * borders[point][position]
            } else {
                MISSED_COST
            }
        };
        let nothing = [(f64::INFINITY, None); NUM_CONFIGURATIONS];
        let mut costs: Vec<Costs> = vec![vec![nothing; self.positions.len()]; num];
        for (position, here) in costs[0].iter_mut().enumerate() {
            for (configuration, cost) in here.iter_mut().enumerate() {
                cost.0 = own((0, position, configuration));
            }
        }
        for point in 0..num - 1 {
            if is_cancelled() {
                return None;
            }
            let (least, cheapest) = least_of(&costs[point]);
            for position in 0..self.positions.len() {
                for configuration in 0..NUM_CONFIGURATIONS {
                    let (cost, _) = costs[point][position][configuration];
                    let next = (point + 1, position, configuration);
                    let from = (point, position, configuration);
                    relax(&mut costs, next, cost + own(next), from);
                    // A jump, from the cheapest state.
                    let from = (point, cheapest.0, cheapest.1);
                    relax(&mut costs, next, least + JUMP_COST + own(next), from);
                }
                // A run that has already jumped may as well jump to the end of the move.
                let is_cheap = |(cost, _): &(f64, Option<Before>)| *cost < least + JUMP_COST / 2.0;
                if !costs[point][position].iter().any(is_cheap) {
                    continue;
                }
                for (end, to, passing, way) in self.moves(point, position) {
                    for configuration in 0..NUM_CONFIGURATIONS {
                        let (cost, _) = costs[point][position][configuration];
                        let next = (end, to, configuration);
                        if passing & (1 << configuration) != 0 {
                            let from = (point, position, configuration);
                            relax(&mut costs, next, cost + way + own(next), from);
                        }
                    }
                }
            }
        }
        Some(self.back(&costs))
    }

    /// All moves from a position at a point: the point and the position at the end, the configurations that reach every
    /// point in between, and the cost.
    fn moves(
        &self,
        point: usize,
        position: usize,
    ) -> impl Iterator<Item = (usize, usize, u8, f64)> {
        let others = (0..self.positions.len()).filter(move |to| *to != position);
        let all = others.flat_map(|to| SPEED_COSTS.map(|pace| (to, pace)));
        all.filter_map(move |(to, (pace, price))| {
            let way = (self.positions[to] - self.positions[position]).abs();
            let arrives = self.times[point] + self.seconds_for(way, pace * self.speed);
            // Sums of times are not exact.
            let end = self.times.partition_point(|time| *time < arrives - 1e-9);
            if end <= point || end >= self.times.len() {
                return None;
            }
            let mut passing = self.reached[end][to];
            let every = (end - point).div_ceil(MAX_EXAMINED);
            // Examine the last point too: one that the move misses for being late is at its end.
            let last = (every > 1).then_some(end - 1);
            for between in (point + 1..end).step_by(every).chain(last) {
                if passing == 0 {
                    return None;
                }
                let share = self.share(way, point, end, between);
                let at = position as f64 + (to as f64 - position as f64) * share;
                let here = &self.reached[between];
                passing &= here[at.floor() as usize] & here[at.ceil() as usize];
            }
            let is_spraying = self.is_gun_on[point..end].contains(&true);
            let length = position.abs_diff(to) as f64;
            let cost = (START_COST + length * price) * if is_spraying { GUN_COST } else { 1.0 };
            Some((end, to, passing, cost))
        })
    }

    /// Seconds of a move of `way` metres at this speed.
    fn seconds_for(&self, way: f64, speed: f64) -> f64 {
        match self.acceleration {
            None => way / speed,
            // It slows down before it reaches this speed.
            Some(acceleration) if way * acceleration < speed * speed => {
                2.0 * (way / acceleration).sqrt()
            }
            Some(acceleration) => way / speed + speed / acceleration,
        }
    }

    /// The share, 0..1, of a move of `way` metres that is done at a point between its ends.
    fn share(&self, way: f64, from: usize, to: usize, between: usize) -> f64 {
        let all = self.times[to] - self.times[from];
        let passed = self.times[between] - self.times[from];
        match self.acceleration {
            _ if all <= 0.0 => 0.0,
            Some(acceleration) if way > 0.0 => {
                (ridden(way, all, passed, acceleration) / way).clamp(0.0, 1.0)
            }
            _ => passed / all,
        }
    }

    /// The positions of the cheapest run.
    fn back(&self, costs: &[Costs]) -> Vec<f64> {
        let last = costs.len() - 1;
        let (_, (position, configuration)) = least_of(&costs[last]);
        let mut at = (last, position, configuration);
        let mut run = vec![self.positions[position]; costs.len()];
        while let (_, Some((point, position, configuration))) = costs[at.0][at.1][at.2] {
            let from = (
                point as usize,
                usize::from(position),
                usize::from(configuration),
            );
            let (start, end) = (self.positions[from.1], self.positions[at.1]);
            let way = (end - start).abs();
            for (i, place) in run[from.0..at.0].iter_mut().enumerate() {
                *place = start + (end - start) * self.share(way, from.0, at.0, from.0 + i);
            }
            at = from;
        }
        run
    }
}

/// Metres ridden after `passed` of `all` seconds of a move from standstill to standstill, at the lowest top speed
/// possible.
fn ridden(way: f64, all: f64, passed: f64, acceleration: f64) -> f64 {
    // all = way / top + top / acceleration
    let root = (all * all - 4.0 * way / acceleration).max(0.0).sqrt();
    let top = 2.0 * way / (all + root);
    let ramp = top / acceleration;
    let left = all - passed;
    if passed < ramp {
        acceleration * passed * passed / 2.0
    } else if left < ramp {
        way - acceleration * left * left / 2.0
    } else {
        top * (passed - ramp / 2.0)
    }
}

/// How near each position is to the border of those that reach a point: 1 next to it, 0.5 one farther, 0 elsewhere.
fn border(here: &[u8]) -> Vec<f64> {
    let is_missed = |position: usize| here.get(position).is_some_and(|found| *found == 0);
    let all = (0..here.len()).map(|at| {
        let within =
            |steps: usize| is_missed(at + steps) || at.checked_sub(steps).is_some_and(is_missed);
        if within(1) {
            1.0
        } else if within(2) {
            0.5
        } else {
            0.0
        }
    });
    all.collect()
}

/// The cheapest state of a point.
fn least_of(costs: &Costs) -> (f64, (usize, usize)) {
    let mut least = (f64::INFINITY, (0, 0));
    for (position, here) in costs.iter().enumerate() {
        for (configuration, (cost, _)) in here.iter().enumerate() {
            if *cost < least.0 {
                least = (*cost, (position, configuration));
            }
        }
    }
    least
}

fn relax(costs: &mut [Costs], to: State, cost: f64, from: State) {
    let known = &mut costs[to.0][to.1][to.2];
    if cost < known.0 {
        *known = (cost, Some((from.0 as u32, from.1 as u8, from.2 as u8)));
    }
}

#[cfg(test)]
mod tests;
