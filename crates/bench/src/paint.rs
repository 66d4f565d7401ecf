//! Spray paths and films of enrolled parts: the planned path compared with two plain ones of the same gun, the film on
//! a part that hangs elsewhere, and the effect of a pose error.
//!
//! The plain paths are straight rows over the part's bounding box, at the stand-off above the surface and pointing
//! along the part's side direction, and the contour pattern. All three run at the speed that brings most of the surface
//! within the tolerance.

use std::time::Instant;

use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use serde::Serialize;

use geometry::{rigid::RigidTransform, units::Metres};
use inspection::library::{PathPoint, SprayPath};
use robot::{
    paint::{
        Coat, Film, FilmFigures, PaintError, PaintSurface, PathFigures, Pattern, Proposal,
        best_speed, propose, simulate,
    },
    program::ProgramParams,
    spray::carry,
};
use stages::{reference::Reference, stand_off::StandOffParams};

/// Pose of the part for the comparison with its standard position: axis, turn in degrees, shift in metres.
const HUNG_AXIS: [f64; 3] = [0.3, 1.0, 0.2];
const HUNG_TURN: f64 = 15.0;
const HUNG_SHIFT: [f64; 3] = [0.06, -0.05, 0.062];
/// Pose errors, degrees and metres.
const POSE_ERRORS: [[f64; 2]; 2] = [[0.5, 0.005], [1.0, 0.01]];

/// A path over a part and its film.
#[derive(Clone, Debug, Serialize)]
pub struct PaintTrial {
    /// How the path was planned.
    pub way: &'static str,
    /// Planning time, including the simulations it needs, seconds.
    pub seconds: f64,
    /// Number of points of the path.
    pub num_points: usize,
    /// Number of uninterrupted strokes.
    pub num_rows: usize,
    /// Row spacing, metres.
    pub spacing: f64,
    /// Gun speed, m/s.
    pub speed: f64,
    /// Figures of the path.
    pub path: PathFigures,
    /// Figures of the film.
    pub film: FilmFigures,
}

/// Effect of a pose error on the film: the worst over errors about three axes.
#[derive(Clone, Debug, Serialize)]
pub struct PoseCost {
    /// Rotation error, degrees.
    pub turn_deg: f64,
    /// Shift along the rotation axis, metres.
    pub shift_m: f64,
    /// The film against that without the error.
    #[serde(flatten)]
    pub film: FilmChange,
}

/// Film of a path with errors, against that without: the worst of several errors.
#[derive(Clone, Debug, Serialize)]
pub struct FilmChange {
    /// Smallest share of the surface within the tolerance.
    pub least_within: f64,
    /// Relative change of the mean thickness.
    pub mean_change: f64,
    /// 95th percentile of the thickness change, as a share of the target.
    pub change_95: f64,
    /// Largest thickness change at a point, as a share of the target.
    pub most_change: f64,
}

/// Results of painting one part.
#[derive(Clone, Debug, Serialize)]
pub struct PaintedPart {
    /// Name of the part.
    pub name: String,
    /// Number of surface points.
    pub num_surface_points: usize,
    /// Spacing of the surface points, metres.
    pub surface_spacing: f64,
    /// The trials, the planned path first.
    pub trials: Vec<PaintTrial>,
    /// Largest thickness change where the part hangs turned and shifted, as a share of the target.
    pub hung_change: f64,
    /// Effects of pose errors.
    pub pose_costs: Vec<PoseCost>,
    /// Effect of a nozzle that is tilted everywhere as far as a robot program may tilt it by default: the worst of four
    /// directions.
    pub tilt_cost: FilmChange,
    /// Surface of the part, for pictures.
    #[serde(skip)]
    pub surface: PaintSurface,
    /// Film of the planned path, for pictures.
    #[serde(skip)]
    pub film: Film,
}

/// Plans, simulates and compares the paths of an enrolled part.
pub fn paint_part(
    reference: &Reference,
    surface: PaintSurface,
    coat: &Coat,
) -> Result<PaintedPart, PaintError> {
    let start = Instant::now();
    let found = propose(&surface, coat, &[])?;
    let planned = PaintTrial::of("planned", start, &found.coat, &found.path, &found.film);
    let start = Instant::now();
    let straight = straight_rows(&surface, &found.coat).ok_or(PaintError::NoRows)?;
    let first = simulate(&surface, &straight, &found.coat, &[])?;
    let speed = best_speed(&first, &found.coat);
    let slowed = Coat {
        speed,
        ..found.coat
    };
    let straight = straight_rows(&surface, &slowed).ok_or(PaintError::NoRows)?;
    let film = simulate(&surface, &straight, &slowed, &[])?;
    let plain = PaintTrial::of("straight rows", start, &slowed, &straight, &film);
    let start = Instant::now();
    let rings = Coat {
        pattern: Pattern::Contour,
        ..*coat
    };
    let rings = propose(&surface, &rings, &[])?;
    let rings = PaintTrial::of("contour", start, &rings.coat, &rings.path, &rings.film);
    let pose_costs = POSE_ERRORS.map(|error| pose_cost(&surface, &found, error));
    let tilt = ProgramParams::default().max_tilt.0;
    let along = surface.longest;
    let across = surface.side.cross(&along);
    let tilted = [along, -along, across, -across].map(|towards| {
        let points = found.path.points().iter().map(|point| {
            let axis = Unit::new_normalize(point.direction.cross(&towards));
            let turn = UnitQuaternion::from_axis_angle(&axis, tilt);
            let aim = *point.direction * point.stand_off.map_or(0.0, |distance| distance.0);
            PathPoint {
                nozzle: point.nozzle + aim - turn * aim,
                direction: turn * point.direction,
                fan: point.fan.map(|fan| turn * fan),
                ..*point
            }
        });
        points.collect()
    });
    let tilt_cost = film_change(&surface, tilted, &found)?;
    Ok(PaintedPart {
        name: reference.name.clone(),
        num_surface_points: surface.points.len(),
        surface_spacing: surface.spacing,
        trials: vec![planned, plain, rings],
        hung_change: hung_change(reference, &surface, &found)?,
        pose_costs: pose_costs.into_iter().collect::<Result<_, _>>()?,
        tilt_cost,
        film: found.film,
        surface,
    })
}

impl PaintTrial {
    fn of(way: &'static str, start: Instant, coat: &Coat, path: &SprayPath, film: &Film) -> Self {
        Self {
            way,
            seconds: start.elapsed().as_secs_f64(),
            num_points: path.points().len(),
            num_rows: path.strokes().len(),
            spacing: coat.spacing,
            speed: coat.speed,
            path: film.path,
            film: film.figures.clone(),
        }
    }
}

/// Plans straight rows at even distances over the bounding box, back and forth; the nozzle is above the nearest surface
/// point.
fn straight_rows(surface: &PaintSurface, coat: &Coat) -> Option<SprayPath> {
    let w = surface.side;
    let axes = [surface.longest, w.cross(&surface.longest), w];
    let flat: Vec<[f64; 3]> = surface
        .points
        .iter()
        .map(|p| axes.map(|axis| axis.dot(&(p - surface.middle))))
        .collect();
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
        flat.iter().map(|p| p[axis]).reduce(pick).unwrap_or(0.0)
    };
    let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|pick| [0, 1].map(|axis| bound(axis, pick)));
    let height = |at: [f64; 2]| {
        let far = |p: &&[f64; 3]| (p[0] - at[0]).powi(2) + (p[1] - at[1]).powi(2);
        flat.iter()
            .min_by(|a, b| far(a).total_cmp(&far(b)))
            .map_or(0.0, |p| p[2])
    };
    let num_gaps = ((high[1] - low[1]) / coat.spacing).ceil();
    let first = 0.5 * (low[1] + high[1] - num_gaps * coat.spacing);
    let ends = [low[0] - coat.overrun, high[0] + coat.overrun];
    let num = ((ends[1] - ends[0]) / coat.point_spacing).ceil() as usize;
    let mut points = Vec::new();
    for row in 0..=num_gaps as usize {
        let v = first + row as f64 * coat.spacing;
        for k in 0..=num {
            let share = k as f64 / num as f64;
            let share = if row % 2 == 0 { share } else { 1.0 - share };
            let u = ends[0] + (ends[1] - ends[0]) * share;
            let at = [u, v, height([u, v]) + coat.stand_off];
            points.push(PathPoint {
                nozzle: surface.middle + axes[0] * at[0] + axes[1] * at[1] + axes[2] * at[2],
                direction: Unit::new_normalize(-w),
                stand_off: Some(Metres(coat.stand_off)),
                is_gun_on: k < num,
                speed: Some(coat.speed),
                fan: Some(Unit::new_normalize(axes[1])),
            });
        }
    }
    SprayPath::new(points)
}

fn moved(surface: &PaintSurface, by: &RigidTransform) -> PaintSurface {
    PaintSurface {
        points: surface.points.iter().map(|p| by * p).collect(),
        normals: surface.normals.iter().map(|n| by * n).collect(),
        side: by * surface.side,
        longest: by * surface.longest,
        middle: by * surface.middle,
        ..surface.clone()
    }
}

/// Returns the largest thickness change where the part hangs turned and shifted and its path is carried along.
fn hung_change(
    reference: &Reference,
    surface: &PaintSurface,
    standard: &Proposal,
) -> Result<f64, PaintError> {
    let Proposal { coat, path, film } = standard;
    let turn = UnitQuaternion::from_axis_angle(
        &Unit::new_normalize(Vector3::from(HUNG_AXIS)),
        HUNG_TURN.to_radians(),
    );
    let shift = Vector3::from(HUNG_SHIFT) + surface.middle.coords - turn * surface.middle.coords;
    let hung = Isometry3::from_parts(Translation3::from(shift), turn);
    let carried = carry(path, &hung, &reference.cloud, &StandOffParams::default());
    let points = carried
        .points
        .iter()
        .zip(path.points())
        .map(|(carried, point)| PathPoint {
            nozzle: carried.mouth(),
            direction: Unit::new_normalize(carried.direction()),
            stand_off: point.stand_off,
            is_gun_on: carried.is_gun_on,
            speed: carried.speed,
            fan: (!carried.is_round)
                .then(|| Unit::new_normalize(carried.camera_from_nozzle * Vector3::x())),
        });
    let carried = SprayPath::new(points.collect()).ok_or(PaintError::NoRows)?;
    let hung_film = simulate(&moved(surface, &hung), &carried, coat, &[])?;
    Ok(changes(film, &hung_film, coat)
        .into_iter()
        .fold(0.0, f64::max))
}

/// Returns the thickness change at each paintable point, as a share of the target.
fn changes(before: &Film, after: &Film, coat: &Coat) -> Vec<f64> {
    let each = before
        .thickness
        .iter()
        .zip(&after.thickness)
        .zip(&before.is_paintable);
    each.filter(|(_, is)| **is)
        .map(|((a, b), _)| (a - b).abs() / coat.target)
        .collect()
}

fn pose_cost(
    surface: &PaintSurface,
    standard: &Proposal,
    [turn_deg, shift_m]: [f64; 2],
) -> Result<PoseCost, PaintError> {
    let across = surface.side.cross(&surface.longest);
    let wrong = [surface.longest, across, surface.side].map(|axis| {
        let axis = Unit::new_normalize(axis);
        let turn = UnitQuaternion::from_axis_angle(&axis, turn_deg.to_radians());
        let about = surface.middle.coords;
        let shift = *axis * shift_m + about - turn * about;
        let wrong = Isometry3::from_parts(Translation3::from(shift), turn);
        let points = standard.path.points().iter().map(|point| PathPoint {
            nozzle: wrong * point.nozzle,
            direction: wrong * point.direction,
            fan: point.fan.map(|fan| wrong * fan),
            ..*point
        });
        points.collect()
    });
    Ok(PoseCost {
        turn_deg,
        shift_m,
        film: film_change(surface, wrong, standard)?,
    })
}

/// Simulates paths with errors, and returns the worst of their films against that without.
fn film_change(
    surface: &PaintSurface,
    wrong: impl IntoIterator<Item = Vec<PathPoint>>,
    standard: &Proposal,
) -> Result<FilmChange, PaintError> {
    let mut cost = FilmChange {
        least_within: 1.0,
        mean_change: 0.0,
        change_95: 0.0,
        most_change: 0.0,
    };
    for points in wrong {
        let wrong = SprayPath::new(points).ok_or(PaintError::NoRows)?;
        let film = simulate(surface, &wrong, &standard.coat, &[])?;
        let mut changes = changes(&standard.film, &film, &standard.coat);
        changes.sort_by(f64::total_cmp);
        let at = |share: f64| changes[((changes.len() - 1) as f64 * share) as usize];
        cost.least_within = cost.least_within.min(film.figures.within);
        cost.mean_change = cost
            .mean_change
            .max((film.figures.mean / standard.film.figures.mean - 1.0).abs());
        cost.change_95 = cost.change_95.max(at(0.95));
        cost.most_change = cost.most_change.max(at(1.0));
    }
    Ok(cost)
}

/// Projects the points onto the side view: to the right and up, metres.
pub fn seen_from_side(surface: &PaintSurface) -> Vec<[f64; 2]> {
    let across = surface.side.cross(&surface.longest);
    let of =
        |p: &Point3<f64>| [surface.longest, across].map(|axis| axis.dot(&(p - surface.middle)));
    surface.points.iter().map(of).collect()
}
