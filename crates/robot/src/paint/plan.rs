//! Plans a spray path over the side of a part.
//!
//! Rows ([`lay_rows`]) run there and back over the smoothed surface, or rings ([`lay_rings`]) around it. The gun stands
//! off along the smoothed normal, leans no farther than the coat allows, and turns its fan across the row. Its speed
//! moves the jet over the surface at the coat's speed: around an outer curve the nozzle has the longer way and moves
//! faster. Between rows the nozzle keeps clear of the part ([`keep_clear`]). Then the speed is varied and strokes are
//! added so that the film becomes even ([`evened`]).
//!
//! One layer is painted, as seen from the side; of folded sheet the upper one.

use nalgebra::{Point3, Unit, Vector3};

use super::{
    coat::{Coat, Pattern, RowDirection},
    error::PaintError,
    even::{Speed, evened},
    height_map::HeightMap,
    region::{KeepOut, KeepOuts},
    rings::lay_rings,
    rows::{RowPlace, lay_rows},
    surface::PaintSurface,
    travel::keep_clear,
};
use geometry::units::Metres;
use inspection::library::{MAX_PATH_POINTS, PathPoint, SprayPath};

/// Greatest ratio of the nozzle's speed to the jet's speed over the surface, and the reverse: tight curves would
/// otherwise stop the gun.
const MAX_SPEED_RATIO: f64 = 4.0;

/// Plans the path of a coat over a surface without the keep-out regions.
pub fn plan(
    surface: &PaintSurface,
    coat: &Coat,
    keep_outs: &[KeepOut],
) -> Result<SprayPath, PaintError> {
    let (path, _) = planned(surface, coat, keep_outs, Speed::Given(coat.speed))?;
    Ok(coat.name_in(path))
}

/// Plans the path of a coat at this speed, which it also returns.
pub(super) fn planned(
    surface: &PaintSurface,
    coat: &Coat,
    keep_outs: &[KeepOut],
    speed: Speed,
) -> Result<(SprayPath, f64), PaintError> {
    coat.check()?;
    for region in keep_outs {
        region.check()?;
    }
    let coat = &Coat {
        speed: 1.0,
        ..*coat
    };
    let along = row_direction(surface, coat);
    let mut points = laid(surface, coat, keep_outs, &along, None)?.concat();
    if coat.pattern == Pattern::CrossHatch {
        let across = surface.side.cross(&along);
        points.extend(laid(surface, coat, keep_outs, &across, None)?.concat());
    }
    let points = keep_clear(points, surface, coat);
    if points.len() > MAX_PATH_POINTS {
        return Err(PaintError::TooLong);
    }
    if points.is_empty() {
        return Err(PaintError::NoRows);
    }
    let raster = Coat {
        pattern: Pattern::Raster,
        ..*coat
    };
    let rows = |along: &Vector3<f64>, towards: &Vector3<f64>| {
        laid(surface, &raster, keep_outs, along, Some(towards))
    };
    let (points, speed) = evened(surface, coat, keep_outs, &along, points, speed, rows)?;
    let path = SprayPath::new(points).ok_or(PaintError::NoRows)?;
    Ok((path, speed))
}

/// Direction of the rows, perpendicular to the side.
fn row_direction(surface: &PaintSurface, coat: &Coat) -> Vector3<f64> {
    if coat.direction == RowDirection::Principal {
        return surface.longest;
    }
    let wanted = Vector3::new(coat.angle.cos(), coat.angle.sin(), 0.0);
    let flat = wanted - surface.side * surface.side.dot(&wanted);
    flat.try_normalize(1e-3).unwrap_or(surface.longest)
}

/// The rows of one raster, or all rings. With `towards`, the jet is against this direction everywhere, instead of
/// following the surface.
fn laid(
    surface: &PaintSurface,
    coat: &Coat,
    regions: &[KeepOut],
    along: &Vector3<f64>,
    towards: Option<&Vector3<f64>>,
) -> Result<Vec<Vec<PathPoint>>, PaintError> {
    let axes = HeightMap::axes_of(surface, along);
    let inside = KeepOuts::new(regions, |p| HeightMap::in_axes(surface, &axes, p));
    let map = HeightMap::new(surface, axes, coat, &inside)?;
    let is_raster = coat.pattern != Pattern::Contour;
    let rows = if is_raster {
        lay_rows(&map, &inside, coat)
    } else {
        lay_rings(&map, &inside, coat)
    };
    let (mut all, mut found) = (Vec::new(), 0);
    for (k, mut row) in rows.into_iter().enumerate() {
        if is_raster && k % 2 == 1 {
            row.reverse();
        }
        let points = path_of_row(&map, &row, coat, &surface.side, towards);
        found += points.len();
        if found > MAX_PATH_POINTS {
            return Err(PaintError::TooLong);
        }
        all.push(points);
    }
    Ok(all)
}

/// The pose of the gun at one point of a row.
struct Stance {
    surface: Point3<f64>,
    nozzle: Point3<f64>,
    normal: Vector3<f64>,
    is_gun_on: bool,
}

fn path_of_row(
    map: &HeightMap,
    row: &[RowPlace],
    coat: &Coat,
    side: &Vector3<f64>,
    towards: Option<&Vector3<f64>>,
) -> Vec<PathPoint> {
    let stances: Vec<Stance> = evenly(map, row, coat.point_spacing)
        .into_iter()
        .map(|place| {
            let spot = map.spot(place.at);
            let upright = || leaning(&spot.normal, side, coat.tilt_limit);
            let normal = towards.copied().unwrap_or_else(upright);
            Stance {
                surface: spot.at,
                nozzle: spot.at + normal * coat.stand_off,
                normal,
                is_gun_on: place.is_gun_on,
            }
        })
        .collect();
    let each = (0..stances.len()).map(|i| {
        let own = &stances[i];
        let (before, after) = (
            &stances[i.saturating_sub(1)],
            &stances[(i + 1).min(stances.len() - 1)],
        );
        let tangent = after.surface - before.surface;
        let scaling = (after.nozzle - own.nozzle).norm() / (after.surface - own.surface).norm();
        let scaling = if scaling.is_finite() { scaling } else { 1.0 };
        let scaling = scaling.clamp(MAX_SPEED_RATIO.recip(), MAX_SPEED_RATIO);
        PathPoint {
            nozzle: own.nozzle,
            direction: Unit::new_normalize(-own.normal),
            stand_off: Some(Metres(coat.stand_off)),
            is_gun_on: own.is_gun_on,
            speed: Some(coat.speed * scaling),
            fan: Unit::try_new(own.normal.cross(&tangent), 1e-9),
        }
    });
    each.collect()
}

/// Distributes points evenly along the surface, with one wherever the gun changes. A point has the gun state of the way
/// to the next one; it is off at the last.
fn evenly(map: &HeightMap, row: &[RowPlace], spacing: f64) -> Vec<RowPlace> {
    let spots: Vec<Point3<f64>> = row.iter().map(|place| map.spot(place.at).at).collect();
    let mut points = Vec::new();
    let mut start = 0;
    while start + 1 < row.len() {
        let is_gun_on = row[start].is_gun_on && row[start + 1].is_gun_on;
        let mut end = start + 1;
        while end + 1 < row.len() && (row[end].is_gun_on && row[end + 1].is_gun_on) == is_gun_on {
            end += 1;
        }
        let mut lengths = vec![0.0];
        for i in start..end {
            lengths.push(lengths[i - start] + (spots[i + 1] - spots[i]).norm());
        }
        let total = lengths[end - start];
        let num = (total / spacing).ceil().max(1.0) as usize;
        let mut next = 0;
        for k in 0..num {
            let wanted = total * k as f64 / num as f64;
            while next + 2 < lengths.len() && lengths[next + 1] <= wanted {
                next += 1;
            }
            let share = (wanted - lengths[next]) / (lengths[next + 1] - lengths[next]);
            let (a, b) = (row[start + next].at, row[start + next + 1].at);
            points.push(RowPlace {
                at: [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis])),
                is_gun_on,
            });
        }
        start = end;
    }
    if let Some(last) = row.last() {
        points.push(RowPlace {
            is_gun_on: false,
            ..*last
        });
    }
    points
}

/// Limits the angle of a normal from the side.
fn leaning(normal: &Vector3<f64>, side: &Vector3<f64>, limit: f64) -> Vector3<f64> {
    let cosine = normal.dot(side).clamp(-1.0, 1.0);
    if cosine.acos() <= limit {
        return *normal;
    }
    let beside = (normal - side * cosine).try_normalize(1e-9);
    beside.map_or(*side, |beside| side * limit.cos() + beside * limit.sin())
}

#[cfg(test)]
mod tests;
