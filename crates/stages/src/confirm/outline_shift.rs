//! How far the outline lies off the reference's, stretch by stretch: what another model of a part shows where its
//! surface and the share of it in sight do not.
//!
//! A single point of an outline is off by some pixels: readings are lost there, and noise moves those that are left. The
//! mean over a stretch is not, as long as the part is the reference's: 2 to 4 mm root mean square of all stretches. A
//! part of the same type that is 2 % larger is off by a centimetre at its ends.
//!
//! A clip, a hem seen from the side or readings lost at a gloss put single stretches off by centimetres, on real frames
//! more than on simulated ones. The median over the stretches does not follow them; another model differs all round.
//!
//! Where a surface curves out of sight the outline is no edge of the part and moves with the view, and where the side of
//! a bar comes into sight it is the edge of another face: such points are left out, and so are narrow openings.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use crate::{
    contour::Contour,
    pose::refine::{AlignmentSource, AlignmentTarget, Search},
    reference::ViewCut,
};
use geometry::{rigid::RigidTransform, units::Metres};

/// Side of the squares that cut the outline into stretches, metres.
const STRETCH_M: f64 = 0.15;
/// A stretch with fewer points has no mean.
const LEAST_IN_STRETCH: usize = 4;
/// Fewer stretches than this say nothing about a model.
const LEAST_STRETCHES: usize = 3;
/// Points further off than this belong to something else, metres.
const MAX_DISTANCE_M: f64 = 0.04;
/// Every so many points of a border are a corner of it: some 12 mm.
const STEP: usize = 4;
/// Narrower openings open and close with the distance of the camera, metres.
const MIN_WIDTH_M: f64 = 0.06;
/// Points of the outline further off the reference's surface than this, beyond the noise, are of another face, metres.
const ON_SURFACE_M: f64 = 0.005;
/// Cosine of the angle between the surface and the view from which on an outline is an edge of the part.
const EDGE_MIN_COSINE: f64 = 0.5;

/// How far the stretches of an outline lie off the reference's, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OutlineShift {
    /// Root mean square of the stretches' mean signed distances.
    pub(super) rms: f64,
    /// Median of the stretches' shifts, by length; a stretch's shift is the median of its signed distances.
    pub(super) median: f64,
}

/// The points of a source's outline that are edges of the part, source space: not where the view cut the reference off, nor
/// where a surface curves out of sight, nor of another face.
pub(super) fn edges_of_part(
    source: &AlignmentSource,
    target: &AlignmentTarget<'_>,
    plane_from_part: &RigidTransform,
    target_from_source: &RigidTransform,
    noise_at_1m: Metres,
    cut: &ViewCut,
) -> Vec<Point3<f32>> {
    let camera = target_from_source * Point3::origin();
    let towards = plane_from_part.inverse() * Vector3::z();
    let is_edge = |p: &Point3<f64>| {
        let near = target.nearest(
            Search::Field,
            &p.cast(),
            (MAX_DISTANCE_M * MAX_DISTANCE_M) as f32,
        )?;
        let normal = target
            .cloud
            .normals
            .as_ref()?
            .get(near.index)?
            .cast::<f64>();
        let ray = p - camera;
        let above = (p - target.cloud.points[near.index].cast::<f64>()).dot(&normal);
        let noise = noise_at_1m.0 * ray.norm_squared();
        let square = normal.dot(&ray.normalize()).abs();
        let is_square = square.min(normal.dot(&towards).abs()) >= EDGE_MIN_COSINE;
        Some(is_square && above.abs() <= ON_SURFACE_M + noise)
    };
    let edges = source.edges.iter().filter(|p| {
        let p = target_from_source * p.cast::<f64>();
        // Close to where the view cut the reference off, its border is no edge.
        cut.depth_inside(&p) >= MAX_DISTANCE_M && is_edge(&p) == Some(true)
    });
    edges.copied().collect()
}

/// The shift of the part's edges in the plane of a view; `None` if too little of the outline can be compared.
pub(super) fn outline_shift(
    edges: &[Point3<f32>],
    contour: &Contour,
    plane_from_part: &RigidTransform,
    target_from_source: &RigidTransform,
) -> Option<OutlineShift> {
    let reference = Borders::of(contour);
    let mut offs: Vec<([i32; 3], f64)> = Vec::with_capacity(edges.len());
    for p in edges {
        let p = target_from_source * p.cast::<f64>();
        let at = (plane_from_part * p).xy();
        if let Some((normal, off)) = reference.off(&at) {
            // The two sides of a narrow part are two stretches.
            let side = normal.y.atan2(normal.x) / std::f64::consts::FRAC_PI_2;
            let square = at / STRETCH_M;
            let stretch = [
                square.x.floor() as i32,
                square.y.floor() as i32,
                (side.round() as i32).rem_euclid(4),
            ];
            offs.push((stretch, off));
        }
    }
    offs.sort_by_key(|off| off.0);
    let (mut sum, mut num) = (0.0, 0);
    let mut shifts: Vec<(f64, usize)> = Vec::new();
    for stretch in offs.chunk_by_mut(|a, b| a.0 == b.0) {
        let n = stretch.len();
        if n >= LEAST_IN_STRETCH {
            let mean = stretch.iter().map(|off| off.1).sum::<f64>() / n as f64;
            sum += n as f64 * mean * mean;
            num += n;
            stretch.sort_by(|a, b| a.1.total_cmp(&b.1));
            let middle = f64::midpoint(stretch[(n - 1) / 2].1, stretch[n / 2].1);
            shifts.push((middle.abs(), n));
        }
    }
    (shifts.len() >= LEAST_STRETCHES).then(|| OutlineShift {
        rms: (sum / num as f64).sqrt(),
        median: median_by_length(shifts, num),
    })
}

/// The shift that half of the outline's `num` points do not exceed.
fn median_by_length(mut shifts: Vec<(f64, usize)>, num: usize) -> f64 {
    shifts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut num_before = 0;
    let reaches_half = |(_, n): &&(f64, usize)| {
        num_before += n;
        2 * num_before >= num
    };
    shifts
        .iter()
        .find(reaches_half)
        .map_or(0.0, |found| found.0)
}

/// Outline and openings of a reference in the plane of a view.
struct Borders {
    /// Two neighbours of a border each.
    pieces: Vec<Piece>,
}

/// A straight piece of a border.
struct Piece {
    from: Point2<f64>,
    along: Vector2<f64>,
    /// One over the squared length: there is a division per piece, not per question.
    per_length_sq: f64,
    /// Whether its border is wide enough to be followed at any distance.
    is_wide: bool,
}

impl Borders {
    fn of(contour: &Contour) -> Self {
        let mut pieces = Vec::new();
        let openings = contour.openings.iter();
        let borders = std::iter::once((&contour.outline, true));
        for (border, is_wide) in borders.chain(openings.map(|o| (o, width(o) >= MIN_WIDTH_M))) {
            let corners: Vec<Point2<f64>> = border.iter().step_by(STEP).copied().collect();
            let next = corners.iter().cycle().skip(1);
            pieces.extend(corners.iter().zip(next).map(|(from, to)| Piece {
                from: *from,
                along: to - from,
                per_length_sq: 1.0 / (to - from).norm_squared().max(1e-12),
                is_wide,
            }));
        }
        Self { pieces }
    }

    /// The normal of the closest border, and how far a point lies off it along that; `None` where that is far, or no
    /// border to be followed.
    fn off(&self, at: &Point2<f64>) -> Option<(Vector2<f64>, f64)> {
        let apart = |piece: &Piece| {
            let from_start = at - piece.from;
            let share = from_start.dot(&piece.along) * piece.per_length_sq;
            from_start - piece.along * share.clamp(0.0, 1.0)
        };
        let (mut nearest, mut least_sq) = (None, f64::INFINITY);
        for piece in &self.pieces {
            let distance_sq = apart(piece).norm_squared();
            if distance_sq < least_sq {
                (nearest, least_sq) = (Some(piece), distance_sq);
            }
        }
        let piece = nearest?;
        let apart = apart(piece);
        let along = piece.along.try_normalize(1e-9)?;
        let normal = Vector2::new(along.y, -along.x);
        (piece.is_wide && apart.norm() < MAX_DISTANCE_M).then(|| (normal, apart.dot(&normal)))
    }
}

/// How wide an opening is, metres: twice its area over its length, which is the width of a slot.
fn width(opening: &[Point2<f64>]) -> f64 {
    let next = opening.iter().cycle().skip(1);
    let (mut twice_area, mut length) = (0.0, 0.0_f64);
    for (a, b) in opening.iter().zip(next) {
        twice_area += a.x * b.y - a.y * b.x;
        length += (b - a).norm();
    }
    twice_area.abs() / length.max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::edge_points::EdgePoints;
    use geometry::{cloud::PointCloud, nearest_field::NearestField};

    /// The outline of a sheet of these lengths, a point a centimetre.
    fn rim(width: f64, height: f64) -> Vec<Point3<f32>> {
        let num = |length: f64| (length / 0.01).round() as usize;
        let walk = |from: [f64; 2], to: [f64; 2], n: usize| {
            (0..n).map(move |i| {
                let t = i as f64 / n as f64;
                let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * t);
                Point3::new(at[0] as f32, at[1] as f32, 1.0)
            })
        };
        let (x, y) = (width / 2.0, height / 2.0);
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y], [-x, -y]];
        let sides = corners.windows(2).zip([width, height, width, height]);
        sides
            .flat_map(|(ends, length)| walk(ends[0], ends[1], num(length)))
            .collect()
    }

    /// A sheet of 1 m by 0.6 m with a slot, seen with these lengths and its slot this much aside.
    fn shift_of(width: f64, height: f64, slot_aside: f32) -> Option<OutlineShift> {
        let surface = (0..100 * 60).map(|i| {
            let (x, y) = ((i % 100) as f32, (i / 100) as f32);
            Point3::new(x * 0.01 - 0.5, y * 0.01 - 0.3, 1.0)
        });
        let mut cloud = PointCloud::from_points(surface);
        cloud.normals = Some(vec![-Vector3::z(); cloud.points.len()]);
        let field = NearestField::new(&cloud.points, 0.01, 0.06);
        let edges = EdgePoints::new(&rim(1.0, 0.6), 400);
        let target = AlignmentTarget {
            cloud: &cloud,
            tree: &std::sync::OnceLock::new(),
            field: &field,
            edges: &edges,
            spacing: 0.01,
        };
        let flat = |rim: Vec<Point3<f32>>| rim.iter().map(|p| p.xy().cast()).collect();
        let contour = Contour {
            outline: flat(rim(1.0, 0.6)),
            openings: vec![flat(rim(0.4, 0.03))],
            outline_pixels: Vec::new(),
            heights: Vec::new(),
            area: 0.588,
        };
        let slot = rim(0.4, 0.03).into_iter();
        let slot = slot.map(|p| p + Vector3::new(0.0, slot_aside, 0.0));
        let source = AlignmentSource {
            surface: Vec::new(),
            edges: rim(width, height).into_iter().chain(slot).collect(),
        };
        let (same, noise) = (RigidTransform::identity(), Metres::from_mm(1.5));
        let cut = ViewCut::default();
        let edges = edges_of_part(&source, &target, &same, &same, noise, &cut);
        outline_shift(&edges, &contour, &same, &same)
    }

    #[test]
    fn a_larger_sheet_is_off_by_how_much_its_edges_are_and_the_same_one_by_nothing() {
        let same = shift_of(1.0, 0.6, 0.0).expect("an outline");
        assert!(same.rms < 1e-3 && same.median < 1e-3, "{same:?}");
        // Both ends by 10 mm, the long sides not at all: the short ones are three eighths of the outline.
        let wider = shift_of(1.02, 0.6, 0.0).expect("an outline");
        assert!(
            (wider.rms - 0.010 * 0.375_f64.sqrt()).abs() < 1e-3,
            "{wider:?}"
        );
        assert!(shift_of(0.0, 0.0, 0.0).is_none());
    }

    #[test]
    fn the_median_is_off_where_most_of_the_outline_is() {
        let at_the_ends = shift_of(1.03, 0.6, 0.0).expect("an outline");
        assert!(at_the_ends.median < 1e-3, "{at_the_ends:?}");
        let all_round = shift_of(1.03, 0.63, 0.0).expect("an outline");
        assert!((all_round.median - 0.015).abs() < 1e-3, "{all_round:?}");
    }

    #[test]
    fn a_long_stretch_counts_as_much_as_its_points_are() {
        assert!(median_by_length(vec![(9.0, 1), (1.0, 5), (8.0, 2)], 8) < 1.5);
        assert!(median_by_length(vec![(1.0, 2), (9.0, 5), (2.0, 2)], 9) > 8.5);
    }

    #[test]
    fn a_narrow_opening_says_nothing() {
        assert!(shift_of(1.0, 0.6, 0.012).expect("an outline").rms < 1e-3);
    }
}
