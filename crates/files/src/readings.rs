//! Turns the numbers of a file into a cloud that keeps the guarantees of [`PointCloud`].

use nalgebra::{Point3, Vector3};

use super::error::FileError;
use super::scalar::Column;
use super::source::Source;
use geometry::cloud::PointCloud;

/// Larger coordinates, in metres, are not readings: some recorders write the largest float, or 1e10, for "none".
/// At 1000 km an `f32` is accurate to 6 cm only; squares of such numbers are far from overflow.
pub(super) const MAX_COORDINATE_M: f32 = 1e6;

/// Marks or drops everything that is not a reading.
///
/// A point is a reading if its coordinates are finite and at most [`MAX_COORDINATE_M`], but not all exactly 0, which many
/// programs write for "no reading". In an organised cloud the other cells become three NaN; in an unorganised cloud the
/// other points are dropped with their attributes. There a (0, 0, 0) with a normal is a point: its frame may be the part's
/// own. Normals are kept only if every reading has one; otherwise the users would have to invent the rest.
pub(super) fn tidy(mut cloud: PointCloud, source: Source<'_>) -> Result<PointCloud, FileError> {
    let found = cloud.points.len();
    let is_organised = cloud.grid.is_some();
    let normals = cloud.normals.as_ref().filter(|_| !is_organised);
    let has_normal = |i: usize| {
        let normal = normals.and_then(|normals| normals.get(i));
        normal.is_some_and(|normal| normal.norm_squared() > 0.0)
    };
    let points = cloud.points.iter().enumerate();
    let is_reading: Vec<bool> = points
        .map(|(i, p)| {
            // NaN fails the comparison too.
            p.iter().all(|c| c.abs() <= MAX_COORDINATE_M)
                && (*p != Point3::origin() || has_normal(i))
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

/// Combines three columns of coordinates into points.
pub(super) fn points_from([x, y, z]: [Column<'_>; 3]) -> Vec<Point3<f32>> {
    let mut points = Vec::with_capacity(x.len);
    let rows = x.f32s().zip(y.f32s()).zip(z.f32s());
    points.extend(rows.map(|((x, y), z)| Point3::new(x, y, z)));
    points
}

/// Combines three columns into normals.
pub(super) fn normals_from(columns: [Column<'_>; 3]) -> Vec<Vector3<f32>> {
    let rows = points_from(columns).into_iter();
    // This collects in place.
    rows.map(|row| row.coords).collect()
}

/// Returns the size of a cloud's point in memory, in bytes.
pub(super) fn point_bytes(has_normal: bool, has_colour: bool, has_label: bool) -> usize {
    let of = |is_there: bool, bytes: usize| if is_there { bytes } else { 0 };
    size_of::<Point3<f32>>()
        + of(has_normal, size_of::<Vector3<f32>>())
        + of(has_colour, size_of::<[u8; 3]>())
        + of(has_label, size_of::<u32>())
}

/// Counts the bytes after the last point; returns 0 if all are padding.
pub(super) fn surplus_of(rest: &[u8]) -> u64 {
    let is_blank = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
    if rest.iter().all(is_blank) {
        return 0;
    }
    rest.len() as u64
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
        // Keep the bits of unit vectors, so that a cloud survives being written and read again.
        if (length - 1.0).abs() < 1e-6 {
            return Some(normal);
        }
        (length.is_finite() && length > 1e-6).then(|| (normal.cast::<f64>() / length).cast())
    });
    unit.collect()
}
