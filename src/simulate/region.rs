//! Flat regions with rounded outlines and openings, as signed distances.
//!
//! A region answers one question: how far is this point from my edge, negative inside. Regions are cut out of
//! one another by taking the larger or the smaller distance. Such a combination is exact at the edge and a lower
//! bound elsewhere, which is all that trimming a sheet needs.

use nalgebra::{Point2, Vector2};

/// A corner of an outline: where the straight edges would meet, and the radius that rounds it.
pub(super) type Corner = (f64, f64, f64);

/// A region of the sheet's own flat coordinates, metres.
pub(super) struct Region(Box<dyn Fn(Point2<f64>) -> f64>);

impl Region {
    /// The inside of a closed outline; the last corner joins the first. Either direction.
    pub(super) fn outline(corners: &[Corner]) -> Self {
        let polygon = rounded(corners);
        Self(Box::new(move |p| distance_to_polygon(&polygon, p)))
    }

    /// As [`Region::outline`], from the right half of a shape that is the same on both sides of u = 0.
    ///
    /// The corners run from the top to the bottom; the left half is added in the opposite order.
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

    /// A rectangle with rounded corners: width, height and corner radius.
    pub(super) fn slot(centre: (f64, f64), size: (f64, f64), radius: f64) -> Self {
        let centre = Point2::new(centre.0, centre.1);
        let half = Vector2::new(size.0 / 2.0 - radius, size.1 / 2.0 - radius);
        Self(Box::new(move |p| {
            let beyond = (p - centre).abs() - half;
            beyond.sup(&Vector2::zeros()).norm() + beyond.max().min(0.0) - radius
        }))
    }

    /// What is in this region and not in `opening`.
    pub(super) fn minus(self, opening: Self) -> Self {
        Self(Box::new(move |p| self.0(p).max(-opening.0(p))))
    }

    /// What is in both regions.
    pub(super) fn and(self, other: Self) -> Self {
        Self(Box::new(move |p| self.0(p).max(other.0(p))))
    }

    /// The region together with its mirror image about u = 0.
    pub(super) fn on_both_sides(self) -> Self {
        Self(Box::new(move |p| {
            self.0(p).min(self.0(Point2::new(-p.x, p.y)))
        }))
    }

    /// Signed distance to the edge, metres, negative inside.
    pub(super) fn distance(&self, u: f64, v: f64) -> f64 {
        self.0(Point2::new(u, v))
    }

    /// 1 well inside, 0 outside, with a smooth shoulder of the given width inside the edge: the shape of a
    /// pressed recess.
    pub(super) fn pressing(&self, u: f64, v: f64, shoulder: f64) -> f64 {
        smooth_step(-self.distance(u, v) / shoulder)
    }
}

/// 0 up to 0, 1 from 1 on, and a smooth S in between.
pub(super) fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// max(0, t), with the kink at 0 rounded over ± `radius`: a bend line of a pressed sheet.
pub(super) fn bend(t: f64, radius: f64) -> f64 {
    if t <= -radius {
        0.0
    } else if t >= radius {
        t
    } else {
        (t + radius).powi(2) / (4.0 * radius)
    }
}

/// A closed polygon with every corner replaced by an arc.
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
        // Neighbouring arcs may use half of their shared edge each.
        let longest = 0.5 * last_length.min(next_length);
        let tangent = (corners[i].2 / half_angle.tan()).min(longest);
        if tangent < 1e-4 || half_angle > 1.56 {
            polygon.push(corner);
            continue;
        }
        // A quadratic Bézier between the tangent points: no arc, but as round to the eye and never out of order.
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

/// Signed distance to a closed polygon, negative inside (even-odd rule).
fn distance_to_polygon(polygon: &[Point2<f64>], p: Point2<f64>) -> f64 {
    let mut nearest_sq = f64::INFINITY;
    let mut sign = 1.0;
    let mut b = polygon[polygon.len() - 1];
    for &a in polygon {
        let edge = b - a;
        let to_p = p - a;
        let along = (to_p.dot(&edge) / edge.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        nearest_sq = nearest_sq.min((to_p - edge * along).norm_squared());
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + edge.x * (p.y - a.y) / edge.y {
            sign = -sign;
        }
        b = a;
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
