//! Regions that get no paint.

use nalgebra::Point3;

use super::{error::PaintError, height_map::HeightMap, surface::PaintSurface};

/// A region that gets no paint, part space, metres.
#[derive(Clone, Debug, PartialEq)]
pub enum KeepOut {
    /// Everything within a sphere.
    Sphere {
        /// Centre of the sphere.
        centre: Point3<f64>,
        /// Radius of the sphere.
        radius: f64,
    },
    /// Everything in front of or behind a polygon, seen from the side that is painted.
    Polygon {
        /// Corners in order; the last is joined to the first.
        corners: Vec<Point3<f64>>,
    },
    /// Everything outside all of these polygons, seen likewise: only they are painted.
    Outside {
        /// Corners of each polygon.
        areas: Vec<Vec<Point3<f64>>>,
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
            Self::Outside { areas } => {
                let is_area = |corners: &Vec<_>| corners.len() >= 3 && corners.iter().all(finite);
                if areas.is_empty() || !areas.iter().all(is_area) {
                    return bad("an area to be painted of less than three corners");
                }
            }
        }
        Ok(())
    }

    /// Returns whether the region touches the surface, even only between its points.
    pub fn touches(&self, surface: &PaintSurface) -> bool {
        let mut distances = distances(surface, std::slice::from_ref(self));
        distances.any(|distance| distance < surface.spacing)
    }
}

/// Keep-out regions with their polygons in map coordinates.
pub(super) struct KeepOuts<'a> {
    regions: &'a [KeepOut],
    /// For each region its polygons, with corners in map coordinates; a sphere has none.
    polygons: Vec<Vec<Vec<[f64; 2]>>>,
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
        let flat = |corners: &Vec<Point3<f64>>| corners.iter().map(flat).collect();
        let polygons = regions.iter().map(|region| match region {
            KeepOut::Sphere { .. } => Vec::new(),
            KeepOut::Polygon { corners } => vec![flat(corners)],
            KeepOut::Outside { areas } => areas.iter().map(flat).collect(),
        });
        Self {
            polygons: polygons.collect(),
            regions,
        }
    }

    /// Distance to the nearest region, below 0 inside; infinite without regions.
    pub(super) fn distance(&self, p: &Point3<f64>, at: [f64; 2]) -> f64 {
        let each = self.regions.iter().zip(&self.polygons);
        let each = each.map(|(region, polygons)| {
            let distances = polygons.iter().map(|corners| from_polygon(corners, at));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            match region {
                KeepOut::Sphere { centre, radius } => (p - centre).norm() - radius,
                KeepOut::Polygon { .. } => nearest,
                KeepOut::Outside { .. } => -nearest,
            }
        });
        each.fold(f64::INFINITY, f64::min)
    }
}

/// Returns for each point of a surface whether it is in one of the regions.
pub(super) fn are_kept_out(surface: &PaintSurface, regions: &[KeepOut]) -> Vec<bool> {
    let distances = distances(surface, regions);
    distances.map(|distance| distance < 0.0).collect()
}

/// Distance of each point of a surface to the nearest region, below 0 inside.
fn distances(surface: &PaintSurface, regions: &[KeepOut]) -> impl Iterator<Item = f64> {
    let axes = HeightMap::axes_of(surface, &surface.longest);
    let in_axes = move |p: &Point3<f64>| HeightMap::in_axes(surface, &axes, p);
    let regions = KeepOuts::new(regions, in_axes);
    surface.points.iter().map(move |p| {
        let [u, v, _] = in_axes(p);
        regions.distance(p, [u, v])
    })
}

/// Distance to a polygon, below 0 inside.
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
    fn what_is_beside_every_area_to_be_painted_is_kept_out() {
        let surface = crate::paint::surface::tests::plate(1.0, 0.6);
        let square = |x: f64| {
            let corners = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]];
            corners.map(|[u, v]| Point3::new(x + u, v, 0.0)).to_vec()
        };
        let areas = vec![square(-0.3), square(0.3)];
        let hole = KeepOut::Sphere {
            centre: Point3::new(0.3, 0.0, 0.0),
            radius: 0.05,
        };
        let kept = are_kept_out(&surface, &[KeepOut::Outside { areas }, hole]);
        for (p, is_kept_out) in surface.points.iter().zip(kept) {
            let is_in = (p.x.abs() - 0.3).abs() < 0.0999 && p.y.abs() < 0.0999;
            let is_beside = (p.x.abs() - 0.3).abs() > 0.1001 || p.y.abs() > 0.1001;
            let is_hole = (p.x - 0.3).hypot(p.y) < 0.0499;
            assert!(!(is_beside || is_hole) || is_kept_out, "{p}");
            let is_far_from_hole = (p.x - 0.3).hypot(p.y) > 0.0501;
            assert!(!(is_in && is_far_from_hole && is_kept_out), "{p}");
        }
    }

    #[test]
    fn a_region_touches_the_surface_that_it_reaches_if_only_between_the_points() {
        let surface = crate::paint::surface::tests::plate(1.0, 0.6);
        let between = surface.points[0] + 0.3 * surface.spacing * surface.longest;
        for (centre, radius, expected) in [
            (Point3::origin(), 0.1, true),
            (between, 0.001, true),
            (Point3::new(0.0, 0.0, 1.3), 0.1, false),
            (Point3::new(0.0, 0.0, 1.3), 1.31, true),
        ] {
            let sphere = KeepOut::Sphere { centre, radius };
            assert_eq!(sphere.touches(&surface), expected, "{centre} {radius}");
        }
    }

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
