//! Flat regions with rounded outlines and openings, as signed distances.
//!
//! A region is a function that returns the distance of a point from the region's edge, negative inside. Regions are combined
//! by taking the larger or the smaller distance. The result is exact at the edge and a lower bound elsewhere, which is
//! enough for trimming a sheet.

use nalgebra::{Point2, Vector2};

/// A corner of an outline: u and v where the straight edges would meet, and the radius that rounds it.
pub(super) type Corner = (f64, f64, f64);

/// A region in the sheet's own flat coordinates, in metres.
pub(super) struct Region(Box<dyn Fn(Point2<f64>) -> f64>);

impl Region {
    /// The inside of a closed outline, given in either direction; the last corner joins the first.
    pub(super) fn outline(corners: &[Corner]) -> Self {
        let edges = edges(&rounded(corners));
        Self(Box::new(move |p| distance_to_polygon(&edges, p)))
    }

    /// Like [`Region::outline`], from the right half of a shape that is symmetric about u = 0.
    ///
    /// The corners run from top to bottom; the left half is added in reverse order.
    pub(super) fn symmetric_outline(right_half: &[Corner]) -> Self {
        let left_half = right_half.iter().rev().map(|&(u, v, r)| (-u, v, r));
        let corners: Vec<Corner> = right_half.iter().copied().chain(left_half).collect();
        Self::outline(&corners)
    }

    /// A disc.
    pub(super) fn disc(centre: (f64, f64), radius: f64) -> Self {
        let centre = Point2::new(centre.0, centre.1);
        Self(Box::new(move |p| (p - centre).norm() - radius))
    }

    /// A rectangle with rounded corners. `size` is width and height.
    pub(super) fn slot(centre: (f64, f64), size: (f64, f64), radius: f64) -> Self {
        let centre = Point2::new(centre.0, centre.1);
        let half = Vector2::new(size.0 / 2.0 - radius, size.1 / 2.0 - radius);
        Self(Box::new(move |p| {
            let beyond = (p - centre).abs() - half;
            beyond.sup(&Vector2::zeros()).norm() + beyond.max().min(0.0) - radius
        }))
    }

    /// Subtracts `opening` from this region.
    pub(super) fn minus(self, opening: Self) -> Self {
        Self(Box::new(move |p| self.0(p).max(-opening.0(p))))
    }

    /// Intersects two regions.
    pub(super) fn and(self, other: Self) -> Self {
        Self(Box::new(move |p| self.0(p).max(other.0(p))))
    }

    /// Adds the region's mirror image about u = 0.
    pub(super) fn on_both_sides(self) -> Self {
        Self(Box::new(move |p| {
            self.0(p).min(self.0(Point2::new(-p.x, p.y)))
        }))
    }

    /// Returns the signed distance to the edge in metres, negative inside.
    pub(super) fn distance(&self, u: f64, v: f64) -> f64 {
        self.0(Point2::new(u, v))
    }

    /// Returns the depth of a pressed recess: 1 well inside, 0 outside, with a smooth shoulder of this width (in metres)
    /// inside the edge.
    pub(super) fn pressing(&self, u: f64, v: f64, shoulder: f64) -> f64 {
        smooth_step(-self.distance(u, v) / shoulder)
    }
}

/// Rises smoothly from 0 at t ≤ 0 to 1 at t ≥ 1.
pub(super) fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns max(0, t) with the kink at 0 rounded over ±`radius`: a bend line of a pressed sheet.
pub(super) fn bend(t: f64, radius: f64) -> f64 {
    if t <= -radius {
        0.0
    } else if t >= radius {
        t
    } else {
        (t + radius).powi(2) / (4.0 * radius)
    }
}

/// Returns a closed polygon with every corner rounded.
fn rounded(corners: &[Corner]) -> Vec<Point2<f64>> {
    let at = |i: usize| {
        let (u, v, _) = corners[i % corners.len()];
        Point2::new(u, v)
    };
    let mut polygon = Vec::new();
    for i in 0..corners.len() {
        let corner = at(i);
        let to_last = at(i + corners.len() - 1) - corner;
        let to_next = at(i + 1) - corner;
        let (last_length, next_length) = (to_last.norm(), to_next.norm());
        let (a, b) = (to_last / last_length, to_next / next_length);
        let half_angle = a.dot(&b).clamp(-1.0, 1.0).acos() / 2.0;
        // Neighbouring curves may each use half of their shared edge.
        let longest = 0.5 * last_length.min(next_length);
        let tangent = (corners[i].2 / half_angle.tan()).min(longest);
        if tangent < 1e-4 || half_angle > 1.56 {
            polygon.push(corner);
            continue;
        }
        // A quadratic Bézier between the tangent points: not an arc, but as round to the eye, and its points stay in order.
        let (start, end) = (corner + a * tangent, corner + b * tangent);
        let num_steps = 8;
        for step in 0..=num_steps {
            let t = f64::from(step) / f64::from(num_steps);
            let first = start + (corner - start) * t;
            let second = corner + (end - corner) * t;
            polygon.push(first + (second - first) * t);
        }
    }
    polygon
}

/// One edge of a polygon, prepared for many distance queries.
struct Edge {
    start: Point2<f64>,
    along: Vector2<f64>,
    /// 1 / length².
    inverse_length_sq: f64,
}

fn edges(polygon: &[Point2<f64>]) -> Vec<Edge> {
    (0..polygon.len())
        .map(|i| {
            let along = polygon[(i + 1) % polygon.len()] - polygon[i];
            Edge {
                start: polygon[i],
                along,
                inverse_length_sq: 1.0 / along.norm_squared().max(1e-18),
            }
        })
        .collect()
}

/// Returns the signed distance to a closed polygon, negative inside (even-odd rule).
fn distance_to_polygon(edges: &[Edge], p: Point2<f64>) -> f64 {
    let mut nearest_sq = f64::INFINITY;
    let mut sign = 1.0;
    for edge in edges {
        let to_p = p - edge.start;
        let share = (to_p.dot(&edge.along) * edge.inverse_length_sq).clamp(0.0, 1.0);
        nearest_sq = nearest_sq.min((to_p - edge.along * share).norm_squared());
        let starts_below = to_p.y >= 0.0;
        let ends_below = to_p.y >= edge.along.y;
        if starts_below != ends_below {
            // The horizontal line through p crosses the edge: is it to the right of p?
            let right = to_p.x * edge.along.y < edge.along.x * to_p.y;
            if right == (edge.along.y > 0.0) {
                sign = -sign;
            }
        }
    }
    sign * nearest_sq.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_outline_measures_distance_inside_and_outside() {
        let square = Region::outline(&[
            (0.0, 0.0, 0.0),
            (1.0, 0.0, 0.0),
            (1.0, 1.0, 0.0),
            (0.0, 1.0, 0.0),
        ]);
        assert!((square.distance(0.5, 0.4) + 0.4).abs() < 1e-12);
        assert!((square.distance(2.0, 0.5) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_opening_is_outside_and_its_edge_is_at_zero() {
        let ring = Region::disc((0.0, 0.0), 1.0).minus(Region::disc((0.0, 0.0), 0.5));
        assert!(ring.distance(0.0, 0.0) > 0.0);
        assert!(ring.distance(0.7, 0.0) < 0.0);
        assert!(ring.distance(0.5, 0.0).abs() < 1e-12);
    }

    #[test]
    fn a_rounded_corner_stays_inside_its_sharp_one() {
        let round = Region::outline(&[
            (0.0, 0.0, 0.2),
            (1.0, 0.0, 0.2),
            (1.0, 1.0, 0.2),
            (0.0, 1.0, 0.2),
        ]);
        assert!(round.distance(0.01, 0.01) > 0.0);
        assert!(round.distance(0.5, 0.01) < 0.0);
    }
}
