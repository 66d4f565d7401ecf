//! Evens out the film of a planned path: the speed varies along the strokes (`dwell.rs`), and if that is not enough,
//! strokes with the gun leaned towards steep flanks are added.
//!
//! A flank that the upright gun meets at a flat angle stays thin however slow the gun moves. Where thin points face a
//! gun that leans along or against the rows, or across them to either side, short pieces of further rows are laid, along
//! which the gun leans in its direction of travel: the jet is narrow in that direction, so it meets the flank and little
//! else. Their dwells and those of the path are found together. Pieces that are hardly needed are left out, and of the
//! choices that bring enough of the surface within the tolerance the one with the fewest pieces is taken.
//!
//! Known limits: the pieces of a row are sprayed in its order, with the gun off in between; on most of the added length
//! the gun is off.

use nalgebra::{Point3, Vector3};

use super::{
    coat::Coat,
    dwell::{Goal, Way},
    error::PaintError,
    film::{Deposit, are_paintable, deposits},
    propose::{GOOD_WITHIN, SPEED_RANGE_M_S, best_factor},
    region::KeepOut,
    surface::{PaintSurface, tree_of},
    travel::keep_clear,
};
use geometry::nearest::KdTree;
use inspection::library::{MAX_PATH_POINTS, MAX_SPEED_M_S, PathPoint};

/// Least and greatest dwell of a way: three times and half the coat's speed. Faster ways need so long to change their
/// speed that their neighbours become uneven.
const DWELL_RANGE: [f64; 2] = [1.0 / 3.0, 2.0];
/// Greatest speed of a faster way, m/s: a little less than the least that a controller accepts (Doosan's, 1 m/s). A way may
/// always be faster than the coat by the factor.
const MAX_FASTER_SPEED_M_S: f64 = 0.995;
const ALLOWED_SPEED_FACTOR: f64 = 1.5;
/// Least dwell of a way of an added stroke, from few strokes to many.
const MIN_STROKE_DWELLS: [f64; 3] = [0.5, 0.25, 0.1];
/// Least gain in the share of the surface for which strokes, or more strokes, are added.
const MIN_STROKE_GAIN: f64 = 0.002;
/// Speed of the moves between added strokes, as a multiple of the coat's speed.
const TRAVEL_SPEED_FACTOR: f64 = 4.0;
/// Thin points within a width and a depth of the pattern from the aim that are worth a stroke.
const MIN_THIN_POINTS: usize = 2;
/// Least distance of the leaned gun from the surface, as a share of the stand-off: beside a flank it dips below the rows.
/// With 0.59 or more, programs of the shipped grille and radiator support leave less even films.
const MIN_CLEARANCE_SHARE: f64 = 0.58;
/// The film that is found differs by rounding from the one that is simulated.
const ROUNDING_MARGIN: f64 = 0.001;

/// A path and the dwells of its ways.
struct Dwelled {
    points: Vec<PathPoint>,
    dwells: Vec<f64>,
    share: f64,
}

/// The speed of a path.
#[derive(Clone, Copy, Debug)]
pub(super) enum Speed {
    /// A given one, m/s.
    Given(f64),
    /// The one that brings the film to the coat's target.
    ToTarget,
}

/// Evens out a path that was planned at 1 m/s, and brings it to its speed; returns both. `rows` lays rows along a
/// direction with the jet against another one.
pub(super) fn evened(
    surface: &PaintSurface,
    coat: &Coat,
    keep_outs: &[KeepOut],
    along: &Vector3<f64>,
    points: Vec<PathPoint>,
    speed: Speed,
    rows: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Result<Vec<Vec<PathPoint>>, PaintError>,
) -> Result<(Vec<PathPoint>, f64), PaintError> {
    if let Speed::Given(speed) = speed
        && coat.acceleration <= 0.0
    {
        return Ok((at_speed(points, speed, |_| 1.0), speed));
    }
    let is_wanted = are_paintable(surface, coat, keep_outs);
    let left = deposits(surface, &points, coat);
    let upright: Vec<&Deposit> = left.iter().collect();
    let film = film_of(&left, surface.points.len());
    let goal = Goal {
        level: coat.target / best_factor(&film, &is_wanted, coat),
        is_wanted,
        tolerance: coat.tolerance,
    };
    let speed = match speed {
        Speed::Given(speed) => speed,
        Speed::ToTarget => (goal.level / coat.target).clamp(SPEED_RANGE_M_S[0], SPEED_RANGE_M_S[1]),
    };
    if coat.acceleration <= 0.0 || !goal.is_wanted.contains(&true) {
        return Ok((at_speed(points, speed, |_| 1.0), speed));
    }
    // Of a path at 1 m/s.
    let acceleration = coat.acceleration / (speed * speed);
    let fastest = (MAX_FASTER_SPEED_M_S / speed)
        .max(ALLOWED_SPEED_FACTOR)
        .min(MAX_SPEED_M_S / speed);
    let with_dwells = |points: Vec<PathPoint>, deposits: &[&Deposit], start: &[f64]| {
        let (ways, which) = ways_of(&points, DWELL_RANGE, fastest);
        let mut dwells = vec![1.0; ways.len()];
        for (way, start) in which.iter().zip(start) {
            dwells[*way] = start.max(DWELL_RANGE[0]);
        }
        let (dwells, share) = goal.improve(&ways, deposits, &which, Some(acceleration), dwells);
        Dwelled {
            points,
            dwells,
            share,
        }
    };
    let mut best = with_dwells(points.clone(), &upright, &vec![1.0; upright.len()]);
    let (ways, which) = ways_of(&points, DWELL_RANGE, fastest);
    let flanks = if best.share < GOOD_WITHIN + ROUNDING_MARGIN {
        let film = goal.film(&upright, &which, &best.dwells);
        flank_rows(surface, coat, &goal, &film, along, rows)?
    } else {
        Vec::new()
    };
    let joined = flanks.concat();
    let added = deposits(surface, &joined, coat);
    let all: Vec<&Deposit> = left.iter().chain(&added).collect();
    let each = dwells_of_all(&goal, (&ways, &which, &best.dwells), &joined, &all);
    for least in MIN_STROKE_DWELLS {
        let chosen = chosen(&flanks, &each[upright.len()..], least, coat);
        if chosen.which.is_empty() {
            continue;
        }
        let (before, last) = points.split_at(points.len() - 1);
        let mut tail = keep_clear([last, &chosen.points[..]].concat(), surface, coat);
        for point in tail.iter_mut().filter(|point| !point.is_gun_on) {
            point.speed = Some(TRAVEL_SPEED_FACTOR.min(fastest));
        }
        let path = [before, &tail[..]].concat();
        if path.len() > MAX_PATH_POINTS {
            break;
        }
        let kept = chosen.which.iter().map(|i| upright.len() + i);
        let kept: Vec<usize> = (0..upright.len()).chain(kept).collect();
        let sprayed: Vec<&Deposit> = kept.iter().map(|i| all[*i]).collect();
        let start: Vec<f64> = kept.iter().map(|i| each[*i]).collect();
        let found = with_dwells(path, &sprayed, &start);
        if found.share > best.share + MIN_STROKE_GAIN {
            best = found;
        }
        if best.share >= GOOD_WITHIN + ROUNDING_MARGIN {
            break;
        }
    }
    let Dwelled { points, dwells, .. } = best;
    // The last point has no way.
    let dwell = |i: usize| dwells.get(i).copied().unwrap_or(1.0);
    Ok((at_speed(points, speed, dwell), speed))
}

/// The sum of all deposits.
fn film_of(deposits: &[Deposit], num_points: usize) -> Vec<f64> {
    let mut film = vec![0.0; num_points];
    for (point, thickness) in deposits.iter().flatten() {
        film[*point as usize] += f64::from(*thickness);
    }
    film
}

/// Brings a path that was planned at 1 m/s to its speed.
fn at_speed(
    mut points: Vec<PathPoint>,
    speed: f64,
    dwell: impl Fn(usize) -> f64,
) -> Vec<PathPoint> {
    for (i, point) in points.iter_mut().enumerate() {
        let own = point.speed.map(|own| own * speed / dwell(i));
        point.speed = own.map(|own| own.min(MAX_SPEED_M_S));
    }
    points
}

/// Rows along which the gun leans, on where it aims at flanks that are too thin in a film.
fn flank_rows(
    surface: &PaintSurface,
    coat: &Coat,
    goal: &Goal,
    film: &[f64],
    along: &Vector3<f64>,
    rows: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Result<Vec<Vec<PathPoint>>, PaintError>,
) -> Result<Vec<Vec<PathPoint>>, PaintError> {
    let lean = coat.flank_lean.min(coat.tilt_limit);
    let all = tree_of(&surface.points);
    let mut flanks: Vec<Vec<PathPoint>> = Vec::new();
    let across = surface.side.cross(along);
    for direction in [across, -across, *along, -along] {
        let towards = surface.side * lean.cos() + direction * lean.sin();
        // None if the gun does not lean.
        let thin = thin_points(surface, goal, film, &towards);
        if thin.len() >= MIN_THIN_POINTS {
            let rows = rows(&direction, &towards)?;
            let thin = (tree_of(&thin), thin);
            flanks.extend(rows.into_iter().map(|row| aimed(row, &thin, &all, coat)));
        }
    }
    flanks.retain(|row| row.iter().any(|point| point.is_gun_on));
    Ok(flanks)
}

/// Finds the dwells of a path and of further rows together, at any speed; returns those of the ways with the gun on.
fn dwells_of_all(
    goal: &Goal,
    (ways, which, dwells): (&[Way], &[usize], &[f64]),
    joined: &[PathPoint],
    deposits: &[&Deposit],
) -> Vec<f64> {
    // At no dwell at all a way is left out.
    let (added, on) = ways_of(joined, [0.0, DWELL_RANGE[1]], f64::INFINITY);
    let start = added.iter().map(|way| way.bounds[0]);
    let start: Vec<f64> = dwells.iter().copied().chain(start).collect();
    let on = on.iter().map(|way| ways.len() + way);
    let which: Vec<usize> = which.iter().copied().chain(on).collect();
    let dwells = if added.is_empty() {
        start
    } else {
        let all = [ways, &added[..]].concat();
        goal.improve(&all, deposits, &which, None, start).0
    };
    which.iter().map(|way| dwells[*way]).collect()
}

/// The ways of a path, and the indices of those with the gun on, whose dwells get these bounds and which are sprayed at
/// most at `fastest`.
fn ways_of(points: &[PathPoint], [least, most]: [f64; 2], fastest: f64) -> (Vec<Way>, Vec<usize>) {
    let mut on = Vec::new();
    let each = points.windows(2).enumerate().map(|(i, pair)| {
        let length = (pair[1].nozzle - pair[0].nozzle).norm();
        let is_on = pair[0].is_gun_on && length > 0.0;
        if is_on {
            on.push(i);
        }
        let speed = pair[0].speed.unwrap_or(1.0);
        let bounds = [least.max(speed / fastest).min(most), most];
        Way {
            length,
            speed,
            is_gun_on: is_on,
            bounds,
        }
    });
    (each.collect(), on)
}

/// Points that are too thin and face a jet against `towards` better than an upright one.
fn thin_points(
    surface: &PaintSurface,
    goal: &Goal,
    film: &[f64],
    towards: &Vector3<f64>,
) -> Vec<Point3<f64>> {
    let least = goal.level * (1.0 - goal.tolerance);
    let is_thin = |i: usize| {
        let normal = surface.normals[i];
        goal.is_wanted[i] && film[i] < least && normal.dot(towards) > normal.dot(&surface.side)
    };
    let all = 0..surface.points.len();
    all.filter(|i| is_thin(*i))
        .map(|i| surface.points[i])
        .collect()
}

/// Leaves the gun of a row on only where it aims at thin points and is not too near to any point of the surface.
fn aimed(
    mut row: Vec<PathPoint>,
    (tree, thin): &(KdTree, Vec<Point3<f64>>),
    all: &KdTree,
    coat: &Coat,
) -> Vec<PathPoint> {
    let scale = coat.stand_off / coat.gun.distance;
    let [width, depth] = [coat.gun.width, coat.gun.depth].map(|extent| extent * scale);
    for i in 0..row.len() {
        let (own, next) = (row[i], row[(i + 1).min(row.len() - 1)]);
        let middle = nalgebra::center(&own.nozzle, &next.nozzle);
        let aim = middle + own.direction.into_inner() * coat.stand_off;
        let mut num = 0;
        if let Some(fan) = own.fan.filter(|_| own.is_gun_on) {
            tree.within(&aim.cast(), width.max(depth) as f32, |found| {
                let off = thin[found.index] - aim;
                let beside = fan.dot(&off);
                let is_near = beside.abs() < width && (off - *fan * beside).norm() < depth;
                num += usize::from(is_near);
            });
        }
        let near_sq = (MIN_CLEARANCE_SHARE * coat.stand_off).powi(2) as f32;
        let is_clear = [own, next]
            .iter()
            .all(|p| all.nearest(&p.nozzle.cast(), near_sq).is_none());
        row[i].is_gun_on &= num >= MIN_THIN_POINTS && is_clear;
    }
    row
}

/// Pieces of rows.
#[derive(Default)]
struct Chosen {
    points: Vec<PathPoint>,
    /// Indices of the sprayed ways among those of all rows.
    which: Vec<usize>,
}

/// Chooses the ways that dwell at least this long, with their leads.
fn chosen(rows: &[Vec<PathPoint>], dwells: &[f64], least: f64, coat: &Coat) -> Chosen {
    let lead = (coat.lead / coat.point_spacing).ceil() as usize;
    let mut chosen = Chosen::default();
    let mut next = 0;
    for row in rows {
        let mut row = row.clone();
        for i in 0..row.len().saturating_sub(1) {
            let is_way = row[i].is_gun_on && row[i + 1].nozzle != row[i].nozzle;
            row[i].is_gun_on = is_way && dwells[next] >= least;
            if row[i].is_gun_on {
                chosen.which.push(next);
            }
            next += usize::from(is_way);
        }
        let Some(first) = row.iter().position(|point| point.is_gun_on) else {
            continue;
        };
        let last = row.iter().rposition(|point| point.is_gun_on);
        let end = last.map_or(row.len(), |last| (last + 2 + lead).min(row.len()));
        chosen.points.extend(&row[first.saturating_sub(lead)..end]);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{RowDirection, plan, propose, simulate, surface::tests::grid};
    use stages::reference::Coverage;

    /// A plate with a groove along x, 60 mm wide and 30 mm deep, whose flanks are 65° steep.
    fn grooved() -> PaintSurface {
        let (half, depth, slope) = (0.03, 0.03, 65.0_f64.to_radians());
        let flank = depth / slope.sin();
        grid(121, 101, Coverage::OneSide, |i, j| {
            let (x, along) = (0.6 * i - 0.3, 0.5 * j - 0.25);
            let on = (along.abs() - half).clamp(0.0, flank);
            let y = (along.abs() - on + on * slope.cos()) * along.signum();
            let normal = if on > 0.0 && on < flank {
                Vector3::new(0.0, -along.signum() * slope.sin(), slope.cos())
            } else {
                Vector3::z()
            };
            (Point3::new(x, y, on * slope.sin()), normal)
        })
    }

    fn without_lean() -> Coat {
        Coat {
            flank_lean: 0.0,
            ..Coat::default()
        }
    }

    #[test]
    fn a_steep_flank_is_painted_by_strokes_that_lean_towards_it() {
        let surface = grooved();
        let upright = propose(&surface, &without_lean(), &[]).expect("proposed");
        let coat = Coat {
            flank_lean: 35.0_f64.to_radians(),
            ..Coat::default()
        };
        let leaned = propose(&surface, &coat, &[]).expect("proposed");
        let within = [&upright, &leaned].map(|found| found.film.figures.within);
        assert!(
            within[0] < GOOD_WITHIN && within[1] > within[0] + 0.01,
            "{within:?}"
        );
        // To both flanks.
        for sign in [1.0, -1.0] {
            let is_leaned = |point: &&PathPoint| {
                let angle = (sign * point.direction.y).asin().to_degrees();
                point.is_gun_on && (angle - 35.0).abs() < 2.0
            };
            let num = [&upright, &leaned].map(|found| {
                let points = found.path.points().iter();
                points.filter(is_leaned).count()
            });
            assert!(num[0] == 0 && num[1] > 4, "{num:?}");
        }
        // The gun keeps clear of the part.
        for point in leaned.path.points() {
            let ways = surface.points.iter().map(|p| (p - point.nozzle).norm());
            assert!(ways.fold(f64::INFINITY, f64::min) > 0.45 * leaned.coat.stand_off);
        }
    }

    #[test]
    fn the_proposed_coat_plans_the_proposed_path() {
        let surface = grooved();
        let found = propose(&surface, &Coat::default(), &[]).expect("proposed");
        assert_eq!(
            plan(&surface, &found.coat, &[]).expect("planned"),
            found.path
        );
        let film = simulate(&surface, &found.path, &found.coat, &[]).expect("simulated");
        assert_eq!(film.thickness, found.film.thickness);
    }

    #[test]
    fn the_gun_accelerates_along_its_strokes_no_more_than_the_coat_allows() {
        let surface = grooved();
        for acceleration in [1.0, 4.0] {
            // Rows across the groove.
            let coat = Coat {
                acceleration,
                direction: RowDirection::Angle,
                angle: std::f64::consts::FRAC_PI_2,
                ..without_lean()
            };
            let path = plan(&surface, &coat, &[]).expect("planned");
            let points = path.points();
            let mut changes = 0;
            for three in points.windows(3) {
                let [a, b, c] = three else { continue };
                let squared = [a, b].map(|point| point.speed.expect("set").powi(2));
                let way = 0.5 * ((b.nozzle - a.nozzle).norm() + (c.nozzle - b.nozzle).norm());
                let change = (squared[1] - squared[0]).abs();
                assert!(
                    change <= 2.0 * acceleration * way + 1e-9,
                    "{change} in {way}"
                );
                changes += usize::from(change > 1e-6);
            }
            assert!(changes > 10, "{changes}");
        }
        let coat = Coat {
            acceleration: 0.0,
            ..Coat::default()
        };
        let path = plan(&surface, &coat, &[]).expect("planned");
        let ends = path.points().iter().filter(|point| point.nozzle.y < -0.1);
        for point in ends {
            assert!((point.speed.expect("set") - coat.speed).abs() < 0.02);
        }
    }
}
