//! Compares the outline of a scene with that of one enrolled part: overlaid at the best lag, ray by ray, and by auto- and
//! cross-correlation.
//!
//! The two matchers use the correlation in different ways, so their figures differ:
//! - the default one correlates the rays as complex numbers L·e^{iΘ} around the circle. The strongest lag says how far
//!   one outline is shifted along the other, the phase there how far it is turned; the distance that remains between
//!   the outlines decides. A is the part with itself, C with the scene, both by their modulus and from their own
//!   strongest lag on, so that a turn is no difference;
//! - the paper's correlates L, and the folded Θ, along a line padded with zeros (eq. 7), and decides by ‖A − C‖₁ over
//!   both (eq. 11).

use shell::inspection::figures::{PlaneLine, SignatureCurves, closed, plain};
use stages::{
    correlation::{CircularCorrelator, RaySpectra},
    paper::linear_correlation,
    rank::{ImagePlacement, Matcher, Query},
    reference::{Reference, ReferenceView},
    signature::LiteralSignature,
};

/// The unit of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisQuantity {
    /// Metres.
    Length,
    /// Radians.
    Angle,
    /// Pixels of the binary image.
    Pixels,
}

/// The comparison of a scene's outline with that of an enrolled part.
#[derive(Debug)]
pub struct OutlineComparison {
    /// Title of the part, with the reference where the part has several.
    pub title: String,
    /// The matcher whose figures these are.
    pub matcher: Matcher,
    /// `None` if no lag was found.
    pub overlay: Option<Overlay>,
    /// L, then Θ.
    pub traces: [Trace; 2],
    /// Auto- and cross-correlation: one of the rays, or one of L and one of Θ.
    pub correlations: Vec<Correlation>,
    /// ‖A − C‖₁, summed over the correlations.
    pub l1: f64,
    /// `l1` divided by ‖A‖₁.
    pub relative_l1: f64,
}

/// Two overlaid outlines in the scene's plane space.
#[derive(Debug)]
pub struct Overlay {
    /// The scene's outline, closed.
    pub query: PlaneLine,
    /// The part's outline, placed, closed.
    pub reference: PlaneLine,
    /// Lines between corresponding samples that lie apart.
    pub joins: Vec<[[f32; 2]; 2]>,
    /// Centroid of both.
    pub centroid: [f32; 2],
    /// Smallest and largest coordinates.
    pub bounds: [[f32; 2]; 2],
    /// Ray of the scene that the part's first ray falls on.
    pub lag: usize,
    /// Rays of the scene.
    pub num_rays: usize,
    /// Turn from the part to the scene, radians, in (−π, π].
    pub turn: f64,
    /// Root mean square distance between the samples, metres.
    pub distance: f64,
}

/// One curve of the signatures: of the scene and of the part.
#[derive(Debug)]
pub struct Trace {
    /// L or Θ.
    pub name: &'static str,
    /// Unit of its values.
    pub measure: AxisQuantity,
    /// The scene's values.
    pub query: Vec<f32>,
    /// The part's values, shifted by the lag where there is one.
    pub reference: Vec<f32>,
}

/// What is correlated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correlated {
    /// Rays, m²; a lag counts rays.
    Rays,
    /// L, px²; a lag counts pixels of the contour.
    Lengths,
    /// Θ, rad²; a lag counts pixels of the contour.
    Angles,
}

/// A (the part with itself) and C (the part with the scene).
#[derive(Debug)]
pub struct Correlation {
    /// What is correlated.
    pub of: Correlated,
    /// A per lag.
    pub auto: Vec<f32>,
    /// C per lag.
    pub cross: Vec<f32>,
    /// Lag of the first value.
    pub first_lag: i64,
    /// ‖A − C‖₁.
    pub l1: f64,
}

/// Samples closer than this are not joined, metres: about a pixel of the image.
const LEAST_JOIN: f64 = 0.005;
/// Limit of joins; more cannot be told apart in a picture.
const NUM_JOINS: usize = 128;
/// Limit of values per curve; more are finer than any picture shows.
const MAX_VALUES: usize = 1200;

impl OutlineComparison {
    /// Compares the outlines; `placement` is the best one of the default matcher.
    pub fn of(
        title: &str,
        query: &Query<'_>,
        reference: &Reference,
        placement: Option<&ImagePlacement>,
        matcher: Matcher,
    ) -> Self {
        let placed = placement.and_then(|p| Some((p, reference.views.get(p.view)?)));
        let overlay = placed.map(|(placement, view)| Overlay::of(query, view, placement));
        let (traces, correlations) = match matcher {
            Matcher::Default => of_rays(query, placed),
            Matcher::Paper => as_written(query, reference),
        };
        let l1 = correlations.iter().map(|c| c.l1).sum::<f64>();
        let norm = correlations.iter().flat_map(|c| &c.auto);
        let norm = norm.map(|value| f64::from(value.abs())).sum::<f64>();
        Self {
            title: title.to_owned(),
            matcher,
            overlay,
            traces,
            relative_l1: l1 / norm.max(f64::MIN_POSITIVE),
            correlations: correlations.into_iter().map(Correlation::thinned).collect(),
            l1,
        }
    }
}

impl Overlay {
    fn of(query: &Query<'_>, view: &ReferenceView, placement: &ImagePlacement) -> Self {
        let scene = query.signature;
        let moved = view.scene_plane_from_view_plane(placement.turn, &scene.centroid);
        let num_rays = scene.rays.len();
        let step = (num_rays / NUM_JOINS).max(1);
        let joins = (0..num_rays).step_by(step).filter_map(|ray| {
            let of_view = (ray + num_rays - placement.lag % num_rays) % num_rays;
            let from = scene.centroid + scene.rays.get(ray)?;
            let to = moved * (view.centroid + view.signature().rays.get(of_view)?);
            ((to - from).norm() > LEAST_JOIN).then(|| [plain(&from), plain(&to)])
        });
        let outline = closed(&query.contour.outline, &nalgebra::Isometry2::identity());
        let reference = closed(&view.contour().outline, &moved);
        let mut bounds = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
        for point in outline.iter().chain(&reference) {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(point[axis]);
                bounds[1][axis] = bounds[1][axis].max(point[axis]);
            }
        }
        let circles = (placement.turn.0 / std::f64::consts::TAU).round();
        Self {
            joins: joins.collect(),
            query: outline,
            reference,
            centroid: plain(&scene.centroid),
            bounds,
            lag: placement.lag,
            num_rays,
            turn: placement.turn.0 - circles * std::f64::consts::TAU,
            distance: placement.outline_distance.0,
        }
    }
}

impl Trace {
    fn new(name: &'static str, measure: AxisQuantity, query: &[f32], reference: &[f32]) -> Self {
        Self {
            name,
            measure,
            query: every(query),
            reference: every(reference),
        }
    }
}

impl Correlation {
    fn new(of: Correlated, auto: &[f64], cross: &[f64], first_lag: i64) -> Self {
        let num = auto.len().max(cross.len());
        let at = |values: &[f64], i: usize| values.get(i).copied().unwrap_or(0.0);
        // Eq. (11), the shorter padded with zeros (Note 1).
        let l1 = (0..num).map(|i| (at(auto, i) - at(cross, i)).abs()).sum();
        let narrow =
            |values: &[f64]| -> Vec<f32> { (0..num).map(|i| at(values, i) as f32).collect() };
        let (auto, cross) = (narrow(auto), narrow(cross));
        Self {
            of,
            auto,
            cross,
            first_lag,
            l1,
        }
    }

    /// Drops values too fine for a picture, after the sums are computed.
    fn thinned(self) -> Self {
        Self {
            auto: every(&self.auto),
            cross: every(&self.cross),
            ..self
        }
    }
}

/// The default matcher's figures.
fn of_rays(
    query: &Query<'_>,
    placed: Option<(&ImagePlacement, &ReferenceView)>,
) -> ([Trace; 2], Vec<Correlation>) {
    let scene = query.signature;
    let own = SignatureCurves::of(&scene.lengths(), &scene.angles());
    let other =
        placed.and_then(|(placement, view)| SignatureCurves::placed(view, placement, scene));
    let (lengths, angles) = other.map_or_else(Default::default, |c| (c.lengths, c.angles));
    let traces = [
        Trace::new("L", AxisQuantity::Length, &own.lengths, &lengths),
        Trace::new("Θ", AxisQuantity::Angle, &own.angles, &angles),
    ];
    let num = scene.rays.len();
    let same_num = |(_, view): &(_, &ReferenceView)| view.signature().rays.len() == num && num > 0;
    let Some((placement, view)) = placed.filter(same_num) else {
        return (traces, Vec::new());
    };
    let part = RaySpectra::of([&view.signature().rays[..]]);
    // From half a circle before the given lag to half a circle after it, per ray.
    let half = num / 2;
    let around = |with: RaySpectra, lag: usize| -> Vec<f64> {
        let mut correlator = CircularCorrelator::new(with);
        let values = correlator
            .correlate(&part)
            .next()
            .map_or(&[][..], |(values, _)| values);
        let ahead = values.iter().cycle().skip(lag + num - half);
        ahead
            .take(num)
            .map(|c| f64::from(c.norm()) / num as f64)
            .collect()
    };
    let auto = around(part.clone(), 0);
    let cross = around(RaySpectra::of([&scene.rays[..]]), placement.lag % num);
    (
        traces,
        vec![Correlation::new(
            Correlated::Rays,
            &auto,
            &cross,
            -(half as i64),
        )],
    )
}

/// The figures of the paper's matcher: L in pixels and Θ in one quadrant, per pixel of the contour, without a lag.
fn as_written(query: &Query<'_>, reference: &Reference) -> ([Trace; 2], Vec<Correlation>) {
    let scene = LiteralSignature::of(&query.contour.outline_pixels);
    let part = reference.literal();
    let own = SignatureCurves::of(&scene.lengths, &scene.angles);
    let other = SignatureCurves::of(&part.signature.lengths, &part.signature.angles);
    let first_lag = 1 - part.signature.lengths.len() as i64;
    let correlated = |of, auto: &[f64], of_part: &[f64], of_scene: &[f64]| {
        let cross = linear_correlation(of_part, of_scene);
        Correlation::new(of, auto, &cross, first_lag)
    };
    let correlations = vec![
        correlated(
            Correlated::Lengths,
            &part.lengths_auto,
            &part.signature.lengths,
            &scene.lengths,
        ),
        correlated(
            Correlated::Angles,
            &part.angles_auto,
            &part.signature.angles,
            &scene.angles,
        ),
    ];
    let traces = [
        Trace::new("L", AxisQuantity::Pixels, &own.lengths, &other.lengths),
        Trace::new("Θ", AxisQuantity::Angle, &own.angles, &other.angles),
    ];
    (traces, correlations)
}

/// At most [`MAX_VALUES`] of the values, evenly spaced.
fn every(values: &[f32]) -> Vec<f32> {
    let step = values.len().div_ceil(MAX_VALUES).max(1);
    values.iter().step_by(step).copied().collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use geometry::{raster::BinaryImage, units::Metres};
    use stages::{
        contour::{Contour, ContourParams, find_contour},
        project::PlaneImage,
        rank::{RankParams, place},
        signature::{FanSignature, SignatureParams, describe},
    };

    /// An L-shaped plate, turned in its plane.
    fn plate(turn: f64) -> (PlaneImage, Contour, FanSignature) {
        let side = 320;
        let mut image = BinaryImage::new(side, side);
        for row in 0..side {
            for column in 0..side {
                let x = column as f64 * 0.005 - 0.8;
                let y = 0.8 - row as f64 * 0.005;
                let a = x * turn.cos() + y * turn.sin();
                let b = y * turn.cos() - x * turn.sin();
                let inside = a.abs() < 0.4 && b.abs() < 0.25 && !(a > 0.0 && b > 0.05);
                image.pixels[row * side + column] = u8::from(inside);
            }
        }
        let plane = PlaneImage::from_image(image, Metres(0.005));
        let contour = find_contour(&plane, &ContourParams::default()).expect("a shape");
        let signature = describe(&contour, &SignatureParams::default()).expect("an outline");
        (plane, contour, signature)
    }

    fn enrolled(turn: f64) -> Reference {
        let (plane, contour, signature) = plate(turn);
        Reference::from_plane("plate", &plane, &contour, signature)
    }

    fn compared(turn: f64, matcher: Matcher) -> OutlineComparison {
        let (plane, contour, signature) = plate(turn);
        let query = Query {
            plane: &plane,
            contour: &contour,
            signature: &signature,
        };
        let reference = enrolled(0.0);
        let placements = place(&query, &reference, &RankParams::default());
        OutlineComparison::of("Plate", &query, &reference, placements.first(), matcher)
    }

    #[test]
    fn a_query_compared_with_itself_has_no_lag_and_no_difference() {
        for matcher in [Matcher::Default, Matcher::Paper] {
            let same = compared(0.0, matcher);
            let overlay = same.overlay.as_ref().expect("placed");
            assert_eq!(overlay.lag, 0);
            assert!(overlay.turn.abs() < 1e-9 && overlay.distance < 1e-6);
            assert!(overlay.joins.is_empty());
            assert!(
                same.relative_l1 < 1e-9,
                "{} of {matcher:?}",
                same.relative_l1
            );
            for trace in &same.traces {
                for (a, b) in trace.query.iter().zip(&trace.reference) {
                    assert!((a - b).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn turning_the_query_moves_the_lag_and_the_turn_and_leaves_the_outlines_on_each_other() {
        let quarter = compared(TAU / 4.0, Matcher::Default);
        let overlay = quarter.overlay.as_ref().expect("placed");
        assert!((overlay.turn - TAU / 4.0).abs() < 0.02, "{}", overlay.turn);
        assert!(overlay.distance < 0.006, "{}", overlay.distance);
        // The paper's matcher finds no lag: to it, the rotated plate is a different one.
        assert!(quarter.relative_l1 < 0.01, "{}", quarter.relative_l1);
        let literal = compared(0.6, Matcher::Paper);
        assert!(literal.relative_l1 > quarter.relative_l1 * 2.0);
        let away = compared(0.6, Matcher::Default);
        let lag = away.overlay.as_ref().expect("placed").lag;
        assert_ne!(lag, 0);
    }

    #[test]
    fn the_papers_figures_add_up_to_the_papers_distance() {
        let (plane, contour, signature) = plate(0.4);
        let query = Query {
            plane: &plane,
            contour: &contour,
            signature: &signature,
        };
        let reference = enrolled(0.0);
        let figures = OutlineComparison::of("Plate", &query, &reference, None, Matcher::Paper);
        let expected = reference
            .literal()
            .distance(&LiteralSignature::of(&contour.outline_pixels));
        assert!((figures.l1 - expected).abs() < 1e-9 * expected);
        assert!(figures.overlay.is_none() && figures.correlations.len() == 2);
        let zero = figures.correlations[0].first_lag;
        assert_eq!(zero, 1 - reference.literal().signature.lengths.len() as i64);
    }
}
