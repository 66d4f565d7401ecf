//! Regions that are kept out of the paint.

use nalgebra::Point3;

use super::error::PaintError;

/// Where no paint is to go, part space, metres.
#[derive(Clone, Debug, PartialEq)]
pub enum KeepOut {
    /// What is within a sphere.
    Sphere {
        /// Its middle.
        centre: Point3<f64>,
        /// Its radius.
        radius: f64,
    },
    /// What lies behind or before a polygon, seen from where the part is painted.
    Polygon {
        /// Its corners in order; the last is joined to the first.
        corners: Vec<Point3<f64>>,
    },
}

impl KeepOut {
    /// Refuses a region that encloses nothing.
    pub(super) fn check(&self) -> Result<(), PaintError> {
        let bad = |what| Err(PaintError::BadRegion { what });
        let finite = |p: &Point3<f64>| p.coords.iter().all(|x| x.is_finite());
        match self {
            Self::Sphere { centre, radius } => {
                if !(finite(centre) && *radius > 0.0 && radius.is_finite()) {
                    return bad("a sphere without a radius");
                }
            }
            Self::Polygon { corners } => {
                if corners.len() < 3 || !corners.iter().all(finite) {
                    return bad("a polygon of less than three corners");
                }
            }
        }
        Ok(())
    }
}

/// Keep-out regions as a map sees them.
pub(super) struct KeepOuts<'a> {
    regions: &'a [KeepOut],
    /// Of each polygon the corners in map coordinates; empty for spheres.
    corners: Vec<Vec<[f64; 2]>>,
}

impl<'a> KeepOuts<'a> {
    pub(super) fn new(
        regions: &'a [KeepOut],
        map_from_part: impl Fn(&Point3<f64>) -> [f64; 3],
    ) -> Self {
        let flat = |p: &Point3<f64>| {
            let [u, v, _] = map_from_part(p);
            [u, v]
        };
        let corners = regions.iter().map(|region| match region {
            KeepOut::Sphere { .. } => Vec::new(),
            KeepOut::Polygon { corners } => corners.iter().map(flat).collect(),
        });
        Self {
            corners: corners.collect(),
            regions,
        }
    }

    /// Distance to the nearest region, below 0 within it; infinite without any.
    pub(super) fn distance(&self, p: &Point3<f64>, at: [f64; 2]) -> f64 {
        let each = self.regions.iter().zip(&self.corners);
        let each = each.map(|(region, corners)| match region {
            KeepOut::Sphere { centre, radius } => (p - centre).norm() - radius,
            KeepOut::Polygon { .. } => from_polygon(corners, at),
        });
        each.fold(f64::INFINITY, f64::min)
    }
}

/// Distance to a polygon, below 0 within it.
fn from_polygon(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let (mut nearest, mut is_inside) = (f64::INFINITY, false);
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (along, to) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let length_sq = along[0] * along[0] + along[1] * along[1];
        let share = if length_sq > 0.0 {
            ((to[0] * along[0] + to[1] * along[1]) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        nearest = nearest.min((to[0] - share * along[0]).hypot(to[1] - share * along[1]));
        if (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / along[1] * along[0] {
            is_inside = !is_inside;
        }
    }
    if is_inside { -nearest } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_regions_are_signed() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for (at, expected) in [([0.5, 0.25], -0.25), ([2.0, 0.5], 1.0), ([-3.0, -4.0], 5.0)] {
            assert!((from_polygon(&square, at) - expected).abs() < 1e-12);
        }
        let sphere = KeepOut::Sphere {
            centre: Point3::new(1.0, 0.0, 0.0),
            radius: 0.25,
        };
        let regions = [sphere];
        let keep_outs = KeepOuts::new(&regions, |p| [p.x, p.y, p.z]);
        assert!((keep_outs.distance(&Point3::origin(), [0.0; 2]) - 0.75).abs() < 1e-12);
        assert!(
            KeepOuts::new(&[], |p| [p.x, p.y, p.z])
                .distance(&Point3::origin(), [0.0; 2])
                .is_infinite()
        );
    }
}
