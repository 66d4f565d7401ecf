//! The surface to be painted: points, normals and the area that each point stands for.
//!
//! A part is painted from one direction, the *side*: the mean normal of what was seen or, if the part is known all
//! around, its outside along its thinnest extent ([`outer_side`]), unless a person chose another. Only points that face
//! the side are painted in one go; a part enrolled from one view has no others.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use super::error::PaintError;
use geometry::{
    cloud::PointCloud,
    nearest::{KdTree, median_spacing},
    principal::principal_axes,
};
use inspection::library::{Side, outer_side};
use stages::reference::{Coverage, Reference};

/// Fewest points of a surface.
const MIN_POINTS: usize = 50;
/// Smallest extent of a part, metres.
const MIN_EXTENT_M: f64 = 0.03;
/// Largest extent of a part, metres; a larger one is probably in another unit.
const MAX_EXTENT_M: f64 = 10.0;
/// Least cosine between the side and the normal of a point that belongs to it: 80°.
const MIN_FACING_COS: f64 = 0.17;
/// Least cosine between a chosen side and the part's thinnest extent for the part to be painted along that extent: 60°.
/// The nearest side of any direction is within 55°.
const MIN_ALONG_COS: f64 = 0.5;
/// An open sheet has less than this share of its points on one side.
const MIN_SIDE_SHARE: f64 = 0.05;
/// Radius over which normals are averaged, in spacings of the points.
const SMOOTHING_SPACINGS: f64 = 2.5;

/// The side of a part to be painted, part space, metres.
#[derive(Clone, Debug)]
pub struct PaintSurface {
    /// The points, about evenly spaced.
    pub points: Vec<Point3<f64>>,
    /// Unit normals, averaged over a few points, towards the gun.
    pub normals: Vec<Vector3<f64>>,
    /// Area that each point stands for, square metres.
    pub point_area: f64,
    /// Distance between neighbouring points.
    pub spacing: f64,
    /// Unit vector from the part towards the gun's side.
    pub side: Vector3<f64>,
    /// The first principal axis, perpendicular to `side`.
    pub longest: Vector3<f64>,
    /// Mean of all points of the part.
    pub middle: Point3<f64>,
    /// The sides of the part that were enrolled.
    pub coverage: Coverage,
}

impl PaintSurface {
    /// The surface of an enrolled part, seen from a chosen side or from its own.
    pub fn of(
        reference: &Reference,
        coverage: Coverage,
        side: Option<Side>,
    ) -> Result<Self, PaintError> {
        Self::of_cloud(&reference.cloud, coverage, side)
    }

    /// The surface of a part that was enrolled with this cloud.
    pub fn of_cloud(
        cloud: &PointCloud,
        coverage: Coverage,
        side: Option<Side>,
    ) -> Result<Self, PaintError> {
        let normals = cloud.normals.as_ref().ok_or(PaintError::NoNormals)?;
        let points: Vec<Point3<f64>> = cloud.points.iter().map(|p| p.cast()).collect();
        let normals: Vec<Vector3<f64>> = normals.iter().map(|n| n.cast()).collect();
        Self::new(&points, &normals, coverage, side)
    }

    /// The side to be painted of points with outward unit normals; the part's own side if none is chosen.
    pub fn new(
        points: &[Point3<f64>],
        normals: &[Vector3<f64>],
        coverage: Coverage,
        side: Option<Side>,
    ) -> Result<Self, PaintError> {
        let num_bad = points
            .iter()
            .zip(normals)
            .filter(|(p, n)| {
                !p.coords.iter().all(|x| x.is_finite()) || !((n.norm() - 1.0).abs() < 0.1)
            })
            .count();
        if num_bad > 0 || points.len() != normals.len() {
            let num_bad = num_bad + points.len().abs_diff(normals.len());
            return Err(PaintError::NotFinite { num_bad });
        }
        check_size(points)?;
        let axes = principal_axes(points.iter().map(|p| (*p, 1.0)));
        let axes = axes.ok_or(PaintError::TooFew {
            found: points.len(),
        })?;
        let thinnest = axes.axes.column(2).into_owned();
        let side = side_of((points, normals), &thinnest, coverage, side)?;
        let turned: Vec<Vector3<f64>>;
        let mut normals = normals;
        if coverage == Coverage::AllAround && are_turned(points, normals, &axes.mean, &side) {
            turned = normals.iter().map(|n| -n).collect();
            normals = &turned;
        }
        let chosen: Vec<usize> = (0..points.len())
            .filter(|i| normals[*i].dot(&side) > MIN_FACING_COS)
            .collect();
        if chosen.len() < MIN_POINTS {
            return Err(PaintError::TooFew {
                found: chosen.len(),
            });
        }
        let points: Vec<Point3<f64>> = chosen.iter().map(|i| points[*i]).collect();
        let stored: Vec<Point3<f32>> = points.iter().map(|p| p.cast()).collect();
        let tree = KdTree::new(&stored);
        let spacing = median_spacing(&stored, &tree);
        let normals = smoothed(
            &stored,
            &tree,
            &chosen,
            normals,
            SMOOTHING_SPACINGS * spacing,
        );
        let first: Vector3<f64> = axes.axes.column(0).into_owned();
        let longest = (first - side * side.dot(&first)).try_normalize(1e-6);
        let longest = longest.unwrap_or_else(|| across(&side));
        // The sign of a principal axis is free; the rows of one part always begin at the same end.
        let largest = longest.iamax();
        Ok(Self {
            longest: longest * longest[largest].signum(),
            point_area: area_of_point(&points, &normals, &side, spacing),
            middle: axes.mean,
            points,
            normals,
            spacing,
            side,
            coverage,
        })
    }

    /// Describes what of the part is painted, for people.
    pub fn scope(&self) -> String {
        match self.coverage {
            Coverage::OneSide => {
                "only the side that the camera saw when the part was enrolled".into()
            }
            Coverage::AllAround => format!(
                "the {} of the part, which is known all around",
                self.painted_side().name()
            ),
            Coverage::SeveralSides => {
                "what faces one side of the part, which was enrolled from several".into()
            }
        }
    }

    /// The side of the part as it was enrolled that is nearest to the painted one.
    pub fn painted_side(&self) -> Side {
        Side::nearest(&self.side)
    }
}

/// A unit vector perpendicular to `axis`.
pub(super) fn across(axis: &Vector3<f64>) -> Vector3<f64> {
    let other = if axis.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    (other - axis * axis.dot(&other)).normalize()
}

/// A search tree of points.
pub(super) fn tree_of(points: &[Point3<f64>]) -> KdTree {
    let stored: Vec<Point3<f32>> = points.iter().map(|p| p.cast()).collect();
    KdTree::new(&stored)
}

fn check_size(points: &[Point3<f64>]) -> Result<(), PaintError> {
    let found = points.len();
    if found < MIN_POINTS {
        return Err(PaintError::TooFew { found });
    }
    let first = points[0];
    let (low, high) = points
        .iter()
        .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let extent = (high - low).amax();
    if !(MIN_EXTENT_M..=MAX_EXTENT_M).contains(&extent) {
        return Err(PaintError::Extent { metres: extent });
    }
    Ok(())
}

/// The direction from which the part is painted: along its thinnest extent or what was seen, if the chosen side is about
/// there.
fn side_of(
    (points, normals): (&[Point3<f64>], &[Vector3<f64>]),
    thinnest: &Vector3<f64>,
    coverage: Coverage,
    side: Option<Side>,
) -> Result<Vector3<f64>, PaintError> {
    let is_closed = coverage == Coverage::AllAround;
    let axis = if is_closed {
        *thinnest
    } else {
        let mean: Vector3<f64> = normals.iter().sum::<Vector3<f64>>() / normals.len() as f64;
        // Normals that cancel out mean a folded surface, or one seen from all around.
        if mean.norm() < 0.2 {
            return Err(PaintError::Folded);
        }
        mean.normalize()
    };
    let direction = match side {
        Some(side) => side.direction(),
        None if is_closed => outer_side(points, normals)
            .map_err(|sides| PaintError::SideUnclear { sides })?
            .direction(),
        None => return Ok(axis),
    };
    let along = direction.dot(&axis);
    Ok(match along {
        _ if along >= MIN_ALONG_COS => axis,
        _ if is_closed && along <= -MIN_ALONG_COS => -axis,
        _ => direction,
    })
}

/// True if the normals of a part that is known all around point into it, or those of an open sheet away from its side.
fn are_turned(
    points: &[Point3<f64>],
    normals: &[Vector3<f64>],
    middle: &Point3<f64>,
    side: &Vector3<f64>,
) -> bool {
    let facing = normals.iter().filter(|n| n.dot(side) > 0.0).count();
    let facing = facing as f64 / normals.len().max(1) as f64;
    if !(MIN_SIDE_SHARE..=1.0 - MIN_SIDE_SHARE).contains(&facing) {
        return facing < MIN_SIDE_SHARE;
    }
    // Three times the volume, over the area of a point (divergence theorem).
    let all = points.iter().zip(normals);
    all.map(|(p, n)| n.dot(&(p - middle))).sum::<f64>() < 0.0
}

/// The area of a point, the same for all since they are evenly spaced. In the plane perpendicular to the side, the area
/// of each square is corrected for the slope and divided by the number of points in it; the median counts, since few
/// squares are cut by an edge.
fn area_of_point(
    points: &[Point3<f64>],
    normals: &[Vector3<f64>],
    side: &Vector3<f64>,
    spacing: f64,
) -> f64 {
    let square = 4.0 * spacing;
    let u = across(side);
    let v = side.cross(&u);
    let of = |p: &Point3<f64>| [u, v].map(|axis| (axis.dot(&p.coords) / square).floor() as i64);
    let mut num_in: BTreeMap<[i64; 2], f64> = BTreeMap::new();
    for p in points {
        *num_in.entry(of(p)).or_default() += 1.0;
    }
    let each = points.iter().zip(normals).map(|(p, n)| {
        let slope = n.dot(side).max(MIN_FACING_COS);
        square * square / slope / num_in[&of(p)]
    });
    let mut areas: Vec<f64> = each.collect();
    areas.sort_by(f64::total_cmp);
    areas[areas.len() / 2]
}

/// Normals of the chosen points, averaged over those within a radius.
fn smoothed(
    points: &[Point3<f32>],
    tree: &KdTree,
    chosen: &[usize],
    normals: &[Vector3<f64>],
    radius: f64,
) -> Vec<Vector3<f64>> {
    let mut around = Vec::new();
    let each = points.iter().zip(chosen).map(|(p, own)| {
        around.clear();
        tree.within(p, radius as f32, |found| around.push(found.index));
        // The search returns points in any order; sum them in a fixed one.
        around.sort_unstable();
        let sum: Vector3<f64> = around.iter().map(|i| normals[chosen[*i]]).sum();
        sum.try_normalize(1e-9).unwrap_or(normals[*own])
    });
    each.collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A surface of `columns` by `rows` points; `at` takes both places as 0..1.
    pub(in crate::paint) fn grid(
        columns: usize,
        rows: usize,
        coverage: Coverage,
        at: impl Fn(f64, f64) -> (Point3<f64>, Vector3<f64>),
    ) -> PaintSurface {
        let share = |i: usize, num: usize| i as f64 / (num - 1) as f64;
        let each =
            (0..columns * rows).map(|i| at(share(i % columns, columns), share(i / columns, rows)));
        let (points, normals): (Vec<_>, Vec<_>) = each.unzip();
        PaintSurface::new(&points, &normals, coverage, None).expect("a surface")
    }

    /// A plate around the origin that faces z, with points every 10 mm.
    pub(in crate::paint) fn plate(length: f64, width: f64) -> PaintSurface {
        let num = |extent: f64| (extent / 0.01).round() as usize + 1;
        grid(num(length), num(width), Coverage::OneSide, |i, j| {
            let at = Point3::new(length * (i - 0.5), width * (j - 0.5), 0.0);
            (at, Vector3::z())
        })
    }

    #[test]
    fn a_plate_has_its_spacing_side_and_area() {
        let surface = plate(1.0, 0.6);
        assert!((surface.spacing - 0.01).abs() < 1e-6);
        assert!((surface.side - Vector3::z()).norm() < 1e-9);
        assert!((surface.longest - Vector3::x()).norm() < 1e-6);
        let area = surface.point_area * surface.points.len() as f64;
        assert!((area / 0.6 - 1.0).abs() < 0.05, "{area}");
    }

    #[test]
    fn what_cannot_be_painted_is_refused_by_name() {
        let new = |points: &[Point3<f64>], normals: &[Vector3<f64>]| {
            PaintSurface::new(points, normals, Coverage::OneSide, None).expect_err("refused")
        };
        let surface = plate(0.5, 0.5);
        let (points, mut normals) = (surface.points.clone(), surface.normals.clone());
        assert!(matches!(
            new(&points[..10], &normals[..10]),
            PaintError::TooFew { found: 10 }
        ));
        assert!(matches!(
            new(&points, &normals[1..]),
            PaintError::NotFinite { num_bad: 1 }
        ));
        let tiny: Vec<Point3<f64>> = points.iter().map(|p| p / 100.0).collect();
        assert!(matches!(new(&tiny, &normals), PaintError::Extent { .. }));
        let huge: Vec<Point3<f64>> = points.iter().map(|p| p * 1000.0).collect();
        assert!(matches!(new(&huge, &normals), PaintError::Extent { .. }));
        let mut bad = points.clone();
        bad[7].x = f64::NAN;
        assert!(matches!(
            new(&bad, &normals),
            PaintError::NotFinite { num_bad: 1 }
        ));
        normals.iter_mut().skip(1).step_by(2).for_each(|n| *n = -*n);
        assert_eq!(new(&points, &normals), PaintError::Folded);
    }
}
