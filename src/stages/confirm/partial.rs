//! Starts for a part of which only a piece is seen.
//!
//! The centroid and the rays of a piece are not those of the part, so the ranking's placements are off. Here the
//! piece's own outline points are laid onto each view of a reference from evenly spread turns, and pulled onto its
//! outline by iterated closest points in the plane (eq. 12 in two dimensions) with weights that shrink, after
//! H. G. Barrow, J. M. Tenenbaum, R. C. Bolles and H. C. Wolf, "Parametric correspondence and chamfer matching", IJCAI
//! 1977, whose distance image we use: it answers every closest point with one look-up.

use nalgebra::{Isometry2, Point2, UnitComplex, Vector2};

use crate::{
    geometry::outline_field::OutlineField,
    stages::reference::{Reference, ReferenceView},
};

/// Turns tried, evenly around: a closest-point search closes half of what lies between two.
const NUM_TURNS: usize = 14;
/// Shifts tried along the piece's two axes, shares of its deviation there: a closest-point search slides slowly along
/// a long edge, and the centroid of a piece is off by up to a quarter of the deviation for every tenth that is gone.
const SHIFTS: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [0.45, 0.0],
    [-0.45, 0.0],
    [0.0, 0.45],
    [0.0, -0.45],
];
/// Scales of the weights, metres, from what a centroid is off by to what the outline is known to.
const FIRST_SCALES: [f64; 3] = [0.12, 0.08, 0.05];
/// For those that are pulled further.
const LAST_SCALES: [f64; 4] = [0.045, 0.03, 0.02, 0.02];
/// Starts of a reference that are pulled further.
const NUM_PULLED: usize = 120;
/// Points of the piece's outline that are laid on.
const NUM_POINTS: usize = 48;
/// Points of the piece's area that must find the reference's.
const NUM_INNER: usize = 80;
/// What a point of the piece beyond the reference costs, in squared distances of the outline, metres.
const BESIDE: f64 = 0.05;
/// Distances of the outline beyond this count as this, metres.
const FAR: f64 = 0.04;
/// Starts kept of a reference.
const NUM_STARTS: usize = 60;

/// A piece of a part in plane space.
pub(super) struct Piece {
    outline: Vec<Point2<f64>>,
    inner: Vec<Point2<f64>>,
    centre: Point2<f64>,
    /// Standard deviations along the axes of its plane.
    deviations: Vector2<f64>,
}

impl Piece {
    pub(super) fn new(
        own: impl ExactSizeIterator<Item = Point2<f64>>,
        area: &[Point2<f64>],
    ) -> Option<Self> {
        let thin = |n: usize, of: usize| n.div_ceil(of).max(1);
        let step = thin(own.len(), NUM_POINTS);
        let outline: Vec<Point2<f64>> = own.step_by(step).collect();
        let inner: Vec<Point2<f64>> = area
            .iter()
            .step_by(thin(area.len(), NUM_INNER))
            .copied()
            .collect();
        if outline.len() < 8 || inner.is_empty() {
            return None;
        }
        let sum = inner.iter().fold(Vector2::zeros(), |s, p| s + p.coords);
        let centre = Point2::from(sum / inner.len() as f64);
        let squares = inner
            .iter()
            .map(|p| (p - centre).component_mul(&(p - centre)));
        let variances = squares.sum::<Vector2<f64>>() / inner.len() as f64;
        Some(Self {
            centre,
            deviations: variances.map(f64::sqrt),
            outline,
            inner,
        })
    }

    /// Ways of laying the piece onto the views of a reference: view, `view_plane_from_scene_plane`, best first.
    pub(super) fn starts(&self, reference: &Reference) -> Vec<(usize, Isometry2<f64>)> {
        let mut laid: Vec<(f64, usize, Isometry2<f64>)> = Vec::new();
        for (number, view) in reference.views.iter().enumerate() {
            for turn in 0..NUM_TURNS {
                let turn = turn as f64 / NUM_TURNS as f64 * std::f64::consts::TAU;
                for shift in SHIFTS {
                    let shift = Vector2::from(shift).component_mul(&self.deviations);
                    let rotation = UnitComplex::new(turn);
                    let onto = view.signature.centroid - rotation * (self.centre + shift);
                    let at = Isometry2::from_parts(onto.into(), rotation);
                    let at = self.pulled(view, &at, &FIRST_SCALES);
                    laid.push((self.cost(view, &at), number, at));
                }
            }
        }
        laid.sort_by(|a, b| a.0.total_cmp(&b.0));
        laid.truncate(NUM_PULLED);
        for (cost, number, at) in &mut laid {
            let view = &reference.views[*number];
            *at = self.pulled(view, at, &LAST_SCALES);
            *cost = self.cost(view, at);
        }
        laid.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut kept: Vec<(usize, Isometry2<f64>)> = Vec::new();
        for (_, number, at) in laid {
            let is_known = |k: &(usize, Isometry2<f64>)| {
                k.0 == number
                    && (k.1 * self.centre - at * self.centre).norm() < 0.02
                    && k.1.rotation.angle_to(&at.rotation).abs() < 0.1
            };
            if !kept.iter().any(is_known) {
                kept.push((number, at));
            }
            if kept.len() == NUM_STARTS {
                break;
            }
        }
        kept
    }

    fn pulled(&self, view: &ReferenceView, at: &Isometry2<f64>, scales: &[f64]) -> Isometry2<f64> {
        let field = view.outline_field();
        scales
            .iter()
            .fold(*at, |at, scale| self.step(field, &at, *scale))
    }

    /// How badly the piece lies on a view, square metres.
    fn cost(&self, view: &ReferenceView, at: &Isometry2<f64>) -> f64 {
        let field = view.outline_field();
        let limit_sq = FAR * FAR;
        let off = self.outline.iter().map(|p| {
            let moved = at * p;
            field
                .nearest(&moved)
                .map_or(limit_sq, |n| (n - moved).norm_squared().min(limit_sq))
        });
        let outline_cost = off.sum::<f64>() / self.outline.len() as f64;
        let is_beside = |p: &&Point2<f64>| {
            let (column, row) = view.plane.pixel_of(&(at * *p));
            let (column, row) = (column.round() as i64, row.round() as i64);
            !view.plane.image.is_set(column, row)
        };
        let beside = self.inner.iter().filter(is_beside).count() as f64 / self.inner.len() as f64;
        outline_cost + beside * BESIDE * BESIDE
    }

    /// One weighted step of iterated closest points, in closed form.
    fn step(&self, field: &OutlineField, at: &Isometry2<f64>, scale: f64) -> Isometry2<f64> {
        let mut sums = (0.0, Vector2::zeros(), Vector2::zeros());
        let pairs: Vec<(f64, Vector2<f64>, Vector2<f64>)> = self
            .outline
            .iter()
            .filter_map(|p| {
                let moved = at * p;
                let nearest = field.nearest(&moved)?;
                let weight = (-(nearest - moved).norm_squared() / (scale * scale)).exp();
                sums.0 += weight;
                sums.1 += moved.coords * weight;
                sums.2 += nearest.coords * weight;
                Some((weight, moved.coords, nearest.coords))
            })
            .collect();
        if sums.0 < 1e-3 {
            return *at;
        }
        let (from, to) = (sums.1 / sums.0, sums.2 / sums.0);
        let (mut cos, mut sin) = (0.0, 0.0);
        for (weight, p, q) in &pairs {
            let (p, q) = (p - from, q - to);
            cos += weight * p.dot(&q);
            sin += weight * (p.x * q.y - p.y * q.x);
        }
        let rotation = UnitComplex::new(sin.atan2(cos));
        let shift = to - rotation * from;
        Isometry2::from_parts(shift.into(), rotation) * at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bench::suites::Suite, library::EnrolParams};

    #[test]
    fn two_thirds_of_an_outline_fall_back_nearly_onto_the_whole() {
        let libraries = crate::bench::suites::SuiteLibraries::enrol(&EnrolParams::default());
        let libraries = libraries.expect("the standard parts");
        let reference = &libraries.of(Suite::Placed).references[4];
        let view = &reference.views[0];
        let moved = Isometry2::new(Vector2::new(0.3, -0.1), 2.0);
        // What lies left of a line, seen at another place.
        let is_seen = |p: &&Point2<f64>| p.x < view.signature.centroid.x + 0.2;
        let outline: Vec<Point2<f64>> = view
            .contour
            .outline
            .iter()
            .filter(is_seen)
            .copied()
            .collect();
        let image = &view.plane.image;
        let area: Vec<Point2<f64>> = (0..image.width * image.height)
            .step_by(7)
            .filter(|i| image.pixels[*i] != 0)
            .map(|i| {
                view.plane
                    .plane_point((i % image.width) as f64, (i / image.width) as f64)
            })
            .filter(|p| is_seen(&p))
            .map(|p| moved * p)
            .collect();
        let own: Vec<Point2<f64>> = outline.iter().map(|p| moved * p).collect();
        let piece = Piece::new(own.iter().copied(), &area).expect("a piece");
        let starts = piece.starts(reference);
        let off = |(view, at): &(usize, Isometry2<f64>)| {
            let field = reference.views[*view].outline_field();
            let off = own.iter().map(|p| {
                let laid = at * p;
                field.nearest(&laid).map_or(1.0, |n| (n - laid).norm())
            });
            off.sum::<f64>() / own.len() as f64
        };
        // Within what the refinement in space closes.
        let least = starts.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(least < 0.03, "{least} m");
    }
}
