//! From the numbers of a file to a cloud that keeps the promises of [`PointCloud`].

use nalgebra::{Point3, Vector3};

use super::error::FileError;
use super::source::Source;
use crate::geometry::cloud::PointCloud;

/// Coordinates beyond this, in metres, are no readings: some recorders write the largest float, or 1e10, for "none".
/// At 1000 km an `f32` is good to 6 cm only, and squares of such numbers stay far from overflow.
pub(super) const MAX_COORDINATE: f32 = 1e6;

/// Turns what the file says into readings.
///
/// A point is a reading if its coordinates are finite and below [`MAX_COORDINATE`]. In an organised cloud every other
/// cell becomes three NaN, and so does an exact (0, 0, 0), by which some recorders mean "no reading"; in an
/// unorganised cloud every other point is dropped with its attributes. Normals are kept only if every reading has
/// one: half a set would have to be made up by whoever uses it.
pub(super) fn tidy(mut cloud: PointCloud, source: Source<'_>) -> Result<PointCloud, FileError> {
    let found = cloud.points.len();
    let is_organised = cloud.grid.is_some();
    let is_reading: Vec<bool> = cloud
        .points
        .iter()
        .map(|p| {
            // NaN fails the comparison too.
            p.iter().all(|c| c.abs() <= MAX_COORDINATE) && !(is_organised && *p == Point3::origin())
        })
        .collect();
    if !is_reading.contains(&true) {
        return Err(FileError::NoPoints {
            path: source.path.to_owned(),
            found,
        });
    }
    if is_organised {
        for (point, _) in cloud
            .points
            .iter_mut()
            .zip(&is_reading)
            .filter(|(_, is)| !**is)
        {
            *point = Point3::new(f32::NAN, f32::NAN, f32::NAN);
        }
    } else {
        retain(&mut cloud.points, &is_reading);
        if let Some(normals) = &mut cloud.normals {
            retain(normals, &is_reading);
        }
        if let Some(colours) = &mut cloud.colours {
            retain(colours, &is_reading);
        }
        if let Some(labels) = &mut cloud.labels {
            retain(labels, &is_reading);
        }
    }
    cloud.normals = cloud
        .normals
        .and_then(|normals| unit_normals(normals, &cloud.points));
    Ok(cloud)
}

/// The points of three coordinate columns.
pub(super) fn points_from(x: &[f32], y: &[f32], z: &[f32]) -> Vec<Point3<f32>> {
    let rows = x.iter().zip(y).zip(z);
    rows.map(|((&x, &y), &z)| Point3::new(x, y, z)).collect()
}

fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| keep.next().is_some_and(|keep| *keep));
}

fn unit_normals(normals: Vec<Vector3<f32>>, points: &[Point3<f32>]) -> Option<Vec<Vector3<f32>>> {
    if normals.len() != points.len() {
        return None;
    }
    let unit = normals.into_iter().zip(points).map(|(normal, point)| {
        if point.x.is_nan() {
            return Some(Vector3::repeat(f32::NAN));
        }
        let length = normal.cast::<f64>().norm();
        // One that is a unit vector already keeps its bits, so that a cloud survives being written and read.
        if (length - 1.0).abs() < 1e-6 {
            return Some(normal);
        }
        (length.is_finite() && length > 1e-6).then(|| (normal.cast::<f64>() / length).cast())
    });
    unit.collect()
}
