//! Finds how the views of a reference may lie over the scene's image: by circular correlation of the outlines, then
//! by the overlap of the images.

use nalgebra::{Isometry2, Matrix2x3, Point2, UnitQuaternion, Vector2, Vector3};
use rustfft::num_complex::Complex;

use super::{Query, RankParams};
use crate::{
    correlation::{CircularCorrelator, RaySpectra},
    project::PlaneImage,
    reference::{Reference, ReferenceView},
    shape_summary::ShapeSummary,
};
use geometry::{
    raster::PointBlocks,
    units::{Metres, Radians},
};

/// A placement of a reference view over the scene's image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagePlacement {
    /// Index of the view within its reference.
    pub view: usize,
    /// Index of the scene's ray that the view's first ray falls on.
    pub lag: usize,
    /// Rotation in the plane from the view to the scene.
    pub turn: Radians,
    /// Root mean square distance between the outlines' samples.
    pub outline_distance: Metres,
    /// Shared area over joint area of the two images, 0..1; `None` if not computed.
    pub overlap: Option<f64>,
}

impl ImagePlacement {
    /// Creates the placement at one lag of a view with `num_rays` rays; `value` is the correlation there and `power`
    /// the sum of both outlines' powers.
    fn at(view: usize, lag: usize, value: Complex<f64>, power: f64, num_rays: usize) -> Self {
        // The turn that maximises Re(e^{-iφ} c) is the argument of c; the maximum is |c|.
        let left = power - 2.0 * value.norm();
        Self {
            view,
            lag,
            turn: Radians(value.arg()),
            outline_distance: Metres((left.max(0.0) / num_rays as f64).sqrt()),
            overlap: None,
        }
    }

    /// Like [`Self::at`], but computes the correlation in double precision from the rays of query and view.
    fn exactly_at(view: usize, lag: usize, [query, seen]: [&[Vector2<f64>]; 2]) -> Self {
        let complex = |ray: &Vector2<f64>| Complex::new(ray.x, ray.y);
        let pairs = query[lag..].iter().chain(query).zip(seen);
        let value = pairs.map(|(q, s)| complex(q) * complex(s).conj()).sum();
        let power = query.iter().chain(seen).map(Vector2::norm_squared).sum();
        Self::at(view, lag, value, power, seen.len())
    }

    /// Returns the score, 0..1.
    pub(super) fn score(&self, params: &RankParams) -> f64 {
        score(self.outline_distance, self.overlap.unwrap_or(0.0), params)
    }
}

/// Ragged edges mislead outlines alone, slim parts mislead areas alone.
fn score(outline_distance: Metres, overlap: f64, params: &RankParams) -> f64 {
    let outline = (-outline_distance.0 / params.outline_tolerance.0).exp();
    (outline * overlap).sqrt()
}

/// Returns an upper bound of the score of any placement of a reference, but for the sampling of the areas.
pub(super) fn most_score(scene: &ShapeSummary, enrolled: &Reference, params: &RankParams) -> f64 {
    let scores = enrolled.summaries().iter().map(|view| {
        let distance = scene.least_outline_distance(view);
        score(distance, scene.most_overlap(view), params)
    });
    scores.fold(0.0, f64::max)
}

/// Recomputes the first placement in double precision: in single precision, a part compared with itself is a few
/// tenths of a millimetre off.
pub(super) fn refine_first(
    placements: &mut [ImagePlacement],
    query: &Query<'_>,
    reference: &Reference,
) {
    if let Some(first) = placements.first_mut() {
        let seen = reference.views[first.view].signature();
        *first = ImagePlacement {
            overlap: first.overlap,
            ..ImagePlacement::exactly_at(first.view, first.lag, [&query.signature.rays, &seen.rays])
        };
    }
}

/// The scene's side of all comparisons, prepared once.
pub(super) struct PlacementSearch<'a> {
    query: &'a Query<'a>,
    params: &'a RankParams,
    correlator: CircularCorrelator,
    strengths: Vec<i32>,
    sample: SparsePixels,
}

impl<'a> PlacementSearch<'a> {
    pub(super) fn new(query: &'a Query<'a>, params: &'a RankParams) -> Self {
        let spectrum = RaySpectra::of([&query.signature.rays[..]]);
        Self {
            query,
            params,
            correlator: CircularCorrelator::new(spectrum),
            strengths: Vec::new(),
            sample: thinned(query.plane),
        }
    }

    pub(super) fn place(&mut self, enrolled: &Reference) -> Vec<ImagePlacement> {
        let mut placements = Vec::with_capacity(2 * enrolled.views.len());
        let correlations = self.correlator.correlate(&enrolled.spectra).enumerate();
        for (view, (values, power)) in correlations {
            let lags = highest_apart(values, &mut self.strengths);
            placements.extend(lags.into_iter().flatten().map(|lag| {
                let value = Complex::new(values[lag].re.into(), values[lag].im.into());
                ImagePlacement::at(view, lag, value, power, values.len())
            }));
        }
        placements.sort_by(|a, b| a.outline_distance.0.total_cmp(&b.outline_distance.0));
        let mut placements = both_ways_round(enrolled, &placements, self.params.num_overlaid);
        for placement in &mut placements {
            let seen = &enrolled.views[placement.view];
            let moved =
                seen.scene_plane_from_view_plane(placement.turn, &self.query.signature.centroid);
            placement.overlap = Some(overlap(&self.sample, seen, &moved));
        }
        placements.sort_by(|a, b| b.score(self.params).total_cmp(&a.score(self.params)));
        placements
    }
}

/// Keeps the best placement and those of similar orientation, and fills half of the list with the best at a very different
/// orientation: sorted by distance alone, the views of a near-symmetric part could fill the list with the same error.
fn both_ways_round(
    enrolled: &Reference,
    sorted: &[ImagePlacement],
    num: usize,
) -> Vec<ImagePlacement> {
    const FAR_TURN_RAD: f64 = std::f64::consts::FRAC_PI_3;
    let attitude = |p: &ImagePlacement| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), p.turn.0);
        turn * enrolled.views[p.view].plane_from_part.rotation
    };
    let Some(best) = sorted.first().map(attitude) else {
        return Vec::new();
    };
    // The dot product of unit quaternions is the cosine of half the angle between them.
    let least_near = (FAR_TURN_RAD / 2.0).cos();
    let (near, far): (Vec<ImagePlacement>, Vec<ImagePlacement>) = sorted
        .iter()
        .partition(|p| attitude(p).coords.dot(&best.coords).abs() > least_near);
    let num_far = far.len().min(num / 2);
    near.into_iter()
        .take(num - num_far)
        .chain(far.into_iter().take(num_far))
        .collect()
}

/// Returns the lag of the highest value, and that of the highest other peak at least a sixteenth of the circle away: a
/// near-symmetric part fits almost as well half a turn off. `twice_around` is scratch memory.
fn highest_apart(correlation: &[Complex<f32>], twice_around: &mut Vec<i32>) -> [Option<usize>; 2] {
    let n = correlation.len();
    // The bits of non-negative floats sort like the floats, and an integer maximum is vectorised.
    let strength = |c: &Complex<f32>| c.norm_sqr().to_bits() as i32;
    twice_around.clear();
    twice_around.extend(correlation.iter().map(strength));
    twice_around.extend_from_within(..);
    let mut around = twice_around[..n].iter().copied();
    let highest = around.clone().fold(0, i32::max);
    let first = around.position(|strength| strength == highest);
    let second = first.and_then(|first| {
        let behind = first + n / 16;
        let apart = twice_around[behind..=first + n - n / 16].windows(3);
        let peak = |w: &[i32]| if w[1] >= w[0].max(w[2]) { w[1] } else { -1 };
        let mut peaks = apart.map(peak);
        let highest = peaks.clone().fold(0, i32::max);
        let index = peaks.position(|strength| strength == highest);
        index.map(|index| (behind + 1 + index) % n)
    });
    [first, second]
}

/// Spacing of the points at which two images are compared, metres.
const OVERLAP_SPACING_M: f64 = 0.03;

/// Set pixels of an image on a coarse grid, with the area of each.
struct SparsePixels {
    points: PointBlocks,
    area_each: f64,
}

fn thinned(plane: &PlaneImage) -> SparsePixels {
    let step = ((OVERLAP_SPACING_M / plane.pixel.0).round() as usize).max(1);
    let image = &plane.image;
    let rows = (0..image.height).step_by(step);
    let places = rows.flat_map(|row| {
        (0..image.width)
            .step_by(step)
            .map(move |column| (row, column))
    });
    let set = places.filter(|(row, column)| image.pixels[row * image.width + column] != 0);
    let point = |(row, column)| plane.plane_point(column as f64, row as f64).cast();
    SparsePixels {
        points: set.map(point).collect(),
        area_each: (step as f64 * plane.pixel.0).powi(2),
    }
}

/// Returns the shared area over the joint area of the scene's image and a view laid over it.
fn overlap(
    scene: &SparsePixels,
    seen: &ReferenceView,
    scene_plane_from_view_plane: &Isometry2<f64>,
) -> f64 {
    // Map directly from the scene plane to pixels of the view: this dominates the cost of ranking.
    let view_plane_from_scene = scene_plane_from_view_plane.inverse();
    let plane = seen.empty_plane();
    let pixel = |x: f64, y: f64| {
        let (column, row) = plane.pixel_of(&(view_plane_from_scene * Point2::new(x, y)));
        Vector2::new(column, row)
    };
    let origin = pixel(0.0, 0.0);
    let axes = [pixel(1.0, 0.0) - origin, pixel(0.0, 1.0) - origin, origin];
    let pixel_from_point = Matrix2x3::from_columns(&axes).cast();
    let num_shared = seen.pixels.num_set_at(&scene.points, &pixel_from_point);
    let shared = num_shared as f64 * scene.area_each;
    let scene_area = scene.points.num() as f64 * scene.area_each;
    let joint = scene_area + seen.image_area - shared;
    if joint > 0.0 { shared / joint } else { 0.0 }
}
