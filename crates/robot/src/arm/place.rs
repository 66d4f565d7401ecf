//! Suggests where an arm would reach more of a path. Obstacles stay in place, and points with a collision are not
//! reached. Places are compared by what [`check_path`](super::check_path) finds there with the same parameters.

use nalgebra::Translation3;

use super::{
    ArmError, ArmPoint, CheckParams, PlacedArm,
    chain::{UPRIGHT, is_gun_free, tilts_up_to},
    check::{check_unless, ends_of, is_reached},
    kinematics::Solver,
    validate::{PIT_DEPTH_M, validate},
};
use geometry::{
    parallel::{map_each, num_cores},
    statistics::sample_evenly,
};

/// A better place for the base or the rail, and what the arm reaches there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceSuggestion {
    /// Shift of the base, metres along the axes of the path's frame; for a rail, its position as the first number.
    pub shift: [f64; 3],
    /// Number of points without a problem there.
    pub num_reached: usize,
}

/// Points of the path that are sampled to compare places.
const NUM_SAMPLES: usize = 60;
/// Turns of the nozzle that are tried at each sample.
const NUM_TURNS: usize = 8;
/// Most places that are checked in full, the best first, until one reaches every point: a joint may be too fast between
/// points that are all reached.
const NUM_CHECKED: usize = 8;

/// Tries the base up to a metre away along x and y and half a metre up or down, in steps of 200 and 250 mm. Returns the
/// place that reaches most points, if it reaches more than `num_reached`. `progress` receives the number of places
/// examined and of all places. Returns [`ArmError::Cancelled`] soon after `is_cancelled` returns true.
pub fn suggest_base(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    num_reached: usize,
    progress: &dyn Fn(usize, usize),
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Option<PlaceSuggestion>, ArmError> {
    let mut shifts = Vec::new();
    for z in -2..=2 {
        for y in -5..=5 {
            for x in -5..=5 {
                let [x, y, z] = [x, y, z].map(f64::from);
                shifts.push([0.2 * x, 0.2 * y, 0.25 * z]);
            }
        }
    }
    let at = |[x, y, z]: [f64; 3]| {
        let placed = PlacedArm {
            robot_from_base: Translation3::new(x, y, z) * placed.robot_from_base,
            ..placed.clone()
        };
        (placed, params.rail)
    };
    let search = Search {
        points,
        params,
        num_reached,
        progress,
        is_cancelled,
    };
    search.best(shifts, at)
}

/// As [`suggest_base`], for a position of the rail, every 100 mm; `None` without a rail, or with one that moves along
/// the path.
pub fn suggest_rail(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    num_reached: usize,
    progress: &dyn Fn(usize, usize),
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Option<PlaceSuggestion>, ArmError> {
    let Some(rail) = placed.arm.rail.filter(|rail| rail.speed.is_none()) else {
        return Ok(None);
    };
    let shifts = rail.positions(0.1).into_iter().map(|at| [at, 0.0, 0.0]);
    let search = Search {
        points,
        params,
        num_reached,
        progress,
        is_cancelled,
    };
    search.best(shifts.collect(), |[rail, ..]| (placed.clone(), rail))
}

/// The common arguments of both searches.
struct Search<'a> {
    points: &'a [ArmPoint],
    params: &'a CheckParams<'a>,
    num_reached: usize,
    progress: &'a dyn Fn(usize, usize),
    is_cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Search<'_> {
    /// Finds the best of these places; `at` returns the arm and the rail's position at a place.
    fn best(
        &self,
        shifts: Vec<[f64; 3]>,
        at: impl Fn([f64; 3]) -> (PlacedArm, f64),
    ) -> Result<Option<PlaceSuggestion>, ArmError> {
        let (here, rail) = at([0.0; 3]);
        let solver = Solver::new(&here, rail);
        // Where the gun collides, it does so wherever the arm stands.
        if self.num_gun_free(&solver)? <= self.num_reached {
            return Ok(None);
        }
        let mut sample = self.sample();
        sample.retain(|point| is_gun_free(&solver, point, NUM_TURNS, &[UPRIGHT]));
        // The arm may stand on a box already, or in front of the part's cloud.
        let known = solver.in_column();
        let shifts: Vec<[f64; 3]> = shifts
            .into_iter()
            .filter(|shift| {
                let (placed, rail) = at(*shift);
                let solver = Solver::new(&placed, rail);
                let is_above_floor = solver
                    .foot_below_floor()
                    .is_none_or(|below| below <= PIT_DEPTH_M);
                is_above_floor && solver.in_column().iter().all(|hit| known.contains(hit))
            })
            .collect();
        let total = shifts.len() + NUM_CHECKED;
        let mut ranked = Vec::with_capacity(shifts.len());
        for shift in shifts {
            (self.progress)(ranked.len(), total);
            let (placed, rail) = at(shift);
            let num = self.num_reached_of(&sample, &placed, rail)?;
            let distance: f64 = shift.iter().map(|x| x * x).sum();
            ranked.push((num, distance, shift));
        }
        // Most points first, then the shortest shift.
        ranked.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.total_cmp(&b.1)));
        let mut found: Option<PlaceSuggestion> = None;
        let num_places = ranked.len();
        for (k, (_, _, shift)) in ranked.into_iter().take(NUM_CHECKED).enumerate() {
            (self.progress)(num_places + k, total);
            let (placed, rail) = at(shift);
            let params = CheckParams {
                rail,
                ..*self.params
            };
            let check = check_unless(self.is_cancelled, &placed, self.points, &params)?;
            let num_reached = check.num_reached();
            if num_reached > found.map_or(self.num_reached, |found| found.num_reached) {
                found = Some(PlaceSuggestion { shift, num_reached });
            }
            if num_reached == self.points.len() {
                break;
            }
        }
        Ok(found)
    }

    /// Number of points at which the gun is clear of all obstacles in some orientation that the check allows: no place
    /// reaches more.
    fn num_gun_free(&self, solver: &Solver<'_>) -> Result<usize, ArmError> {
        let &Self {
            points,
            params,
            is_cancelled,
            ..
        } = self;
        let mut tilts = vec![UPRIGHT];
        if params.max_tilt > 0.0 {
            tilts.extend(tilts_up_to(params.max_tilt));
        }
        let free = map_each(points.len(), num_cores(), |i| {
            !is_cancelled() && is_gun_free(solver, &points[i], params.num_turns, &tilts)
        });
        if is_cancelled() {
            return Err(ArmError::Cancelled);
        }
        Ok(free.into_iter().filter(|is_free| *is_free).count())
    }

    /// Points to compare places with: some of the path, and the ends of its program.
    fn sample(&self) -> Vec<ArmPoint> {
        let ends = self.params.approach;
        let ends = ends.and_then(|distance| ends_of(self.points, distance));
        let path = sample_evenly(self.points, NUM_SAMPLES).copied();
        path.chain(ends.into_iter().flatten()).collect()
    }

    /// Number of sampled points that are reached.
    fn num_reached_of(
        &self,
        sample: &[ArmPoint],
        placed: &PlacedArm,
        rail: f64,
    ) -> Result<usize, ArmError> {
        validate(placed, self.points, self.params)?;
        let solvers: Vec<Solver<'_>> = rails(placed, rail)
            .into_iter()
            .map(|rail| Solver::new(placed, rail))
            .collect();
        let mut num = 0;
        for point in sample {
            if (self.is_cancelled)() {
                return Err(ArmError::Cancelled);
            }
            let mut at = solvers.iter();
            num += usize::from(at.any(|solver| is_reached(solver, point, NUM_TURNS)));
        }
        Ok(num)
    }
}

/// Positions of the rail to compare a place with: this one or, if the rail moves along the path, one per half of the
/// reach.
fn rails(placed: &PlacedArm, rail: f64) -> Vec<f64> {
    match placed.arm.moving_rail() {
        Some((moving, _)) => moving.positions(placed.arm.reach() / 2.0),
        None => vec![rail],
    }
}
