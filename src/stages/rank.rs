//! Ranking: how well each reference explains the scene's shape, best first.
//!
//! Default matcher: for every view of a reference the circular correlation of the complex rays L·e^{iΘ} over all lags
//! (by FFT) gives at once the lag, the turn in the plane and the distance that remains between the outlines; the best
//! few views are then laid over the scene's image, openings included, and scored by their overlap. Lengths are
//! metres throughout, so size is evidence.
//!
//! Paper matcher: Algorithm 2 with eq. 7 and 11 and Note 1, as written.

use nalgebra::{Isometry2, Matrix2x3, Point2, UnitQuaternion, Vector2, Vector3};
use rustfft::num_complex::Complex;

use crate::{
    geometry::{
        parallel::{map_in_order, num_cores},
        raster::PointBlocks,
    },
    stages::{
        confirm::Evidence,
        contour::Contour,
        correlation::{CircularCorrelator, RaySpectra},
        pose::PoseEstimate,
        project::PlaneImage,
        reference::{Reference, ReferenceView},
        signature::{FanSignature, LiteralSignature},
    },
    units::{Metres, Radians},
};

/// Which matcher ranks the references.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Matcher {
    /// Circular correlation of complex rays, then overlap of the images.
    #[default]
    Default,
    /// The paper's Algorithm 2, literally.
    Paper,
}

/// Parameters of [`rank`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct RankParams {
    /// Which matcher.
    pub matcher: Matcher,
    /// Placements of each reference that are laid over the scene's image, 1..20. Raising it costs time and helps
    /// near-symmetric parts.
    pub num_overlaid: usize,
    /// Distance of the outlines at which the score has dropped to 1/e, 10..200 mm.
    pub outline_tolerance: Metres,
    /// References from which all cores rank, one otherwise, 1..100 000. Lowering it costs time where starting the
    /// others takes longer than the ranking. `partsight bench scaling` finds the crossover; on two cores two workers
    /// paid from 16 on and four from 32 on, below which a tenth of a millisecond is at stake.
    pub parallel_from: usize,
}

impl Default for RankParams {
    fn default() -> Self {
        Self {
            matcher: Matcher::Default,
            num_overlaid: 6,
            outline_tolerance: Metres::from_mm(60.0),
            parallel_from: 32,
        }
    }
}

/// The scene's shape as the earlier stages found it.
#[derive(Clone, Copy, Debug)]
pub struct Query<'a> {
    /// Binary image.
    pub plane: &'a PlaneImage,
    /// Outline and openings.
    pub contour: &'a Contour,
    /// Signature of the outline.
    pub signature: &'a FanSignature,
}

/// One way of laying a reference view over the scene's image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index of the view within its reference.
    pub view: usize,
    /// Ray of the scene that the view's first ray falls on.
    pub lag: usize,
    /// Turn in the plane from the view to the scene.
    pub turn: Radians,
    /// Root mean square distance between the outlines' samples.
    pub outline_distance: Metres,
    /// Shared area over joint area of the two images, 0..1; `None` if not laid over.
    pub overlap: Option<f64>,
}

/// How well one reference matches.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchEntry {
    /// Index of the reference among those given.
    pub reference: usize,
    /// The reference's name.
    pub part: String,
    /// 0..1, 1 for the same shape.
    pub score: f64,
    /// The matcher's own distance: metres between outlines by default, ‖A - C‖₁ for the paper's.
    pub distance: f64,
    /// Placements, best first; the paper's matcher finds none.
    pub placements: Vec<Placement>,
    /// Where the confirmation put it; `None` if it ranked too low to be tried, or has no cloud. The first's is refined
    /// to the end, the others' as far as it took to see that they are not the first.
    pub pose: Option<PoseEstimate>,
    /// What speaks for and against it at that pose.
    pub evidence: Option<Evidence>,
}

/// All references, best first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatchRanking {
    /// One entry per reference, in descending order of score.
    pub entries: Vec<MatchEntry>,
}

impl MatchRanking {
    /// The best entry of each part, best first: a part may be enrolled by several references.
    pub fn by_part(&self) -> impl Iterator<Item = &MatchEntry> {
        let entries = &self.entries;
        entries.iter().enumerate().filter_map(|(i, entry)| {
            let is_first = entries[..i].iter().all(|before| before.part != entry.part);
            is_first.then_some(entry)
        })
    }

    /// The best entry of a part other than the first.
    pub fn runner_up(&self) -> Option<&MatchEntry> {
        self.by_part().nth(1)
    }
}

/// Ranks all references.
pub fn rank(query: &Query<'_>, references: &[Reference], params: &RankParams) -> MatchRanking {
    let num_workers = if references.len() < params.parallel_from {
        1
    } else {
        num_cores()
    };
    rank_by(num_workers, query, references, params)
}

/// As [`rank`], by so many workers; the ranking is the same for any number.
pub fn rank_by(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
) -> MatchRanking {
    let mut entries: Vec<MatchEntry> = match params.matcher {
        Matcher::Default => rank_by_overlap(num_workers, query, references, params),
        Matcher::Paper => rank_literally(num_workers, query, references),
    };
    // A stable sort: equal scores keep the library's order.
    entries.sort_by(|a, b| b.score.total_cmp(&a.score));
    if let Some(first) = entries.first_mut() {
        refine_first(&mut first.placements, query, &references[first.reference]);
        first.distance = match (params.matcher, first.placements.first()) {
            (Matcher::Default, Some(placement)) => placement.outline_distance.0,
            _ => first.distance,
        };
    }
    MatchRanking { entries }
}

fn rank_literally(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
) -> Vec<MatchEntry> {
    let of_query = LiteralSignature::of(&query.contour.outline_pixels);
    let score = |(): &mut (), reference: usize| {
        let literal = references[reference].literal();
        let distance = literal.distance(&of_query);
        (distance, distance / literal.norm().max(f64::MIN_POSITIVE))
    };
    let distances = map_in_order(references.len(), num_workers, || (), score);
    let least = distances.iter().map(|d| d.0).fold(f64::INFINITY, f64::min);
    distances
        .into_iter()
        .enumerate()
        .map(|(reference, (distance, relative))| MatchEntry {
            reference,
            part: references[reference].name.clone(),
            // The paper takes the least distance (eq. 11) whatever its size: the score only has to keep that order.
            score: (1.0 - relative).clamp(0.0, 1.0) * 0.5
                + 0.5 * (least / distance.max(f64::MIN_POSITIVE)).min(1.0),
            distance,
            placements: Vec::new(),
            pose: None,
            evidence: None,
        })
        .collect()
}

fn rank_by_overlap(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
) -> Vec<MatchEntry> {
    let entry = |placer: &mut Placer<'_>, reference: usize| {
        let enrolled = &references[reference];
        let placements = placer.place(enrolled);
        MatchEntry {
            reference,
            part: enrolled.name.clone(),
            score: placements.first().map_or(0.0, |p| p.score(params)),
            distance: placements
                .first()
                .map_or(f64::INFINITY, |p| p.outline_distance.0),
            placements,
            pose: None,
            evidence: None,
        }
    };
    let prepare = || Placer::new(query, params);
    map_in_order(references.len(), num_workers, prepare, entry)
}

/// The ways of laying one reference over the scene, best first; for a matcher that finds none itself.
pub fn place(query: &Query<'_>, reference: &Reference, params: &RankParams) -> Vec<Placement> {
    let mut placements = Placer::new(query, params).place(reference);
    refine_first(&mut placements, query, reference);
    placements
}

/// Single precision leaves some tenths of a millimetre of a part that is compared with itself; further off it tells.
fn refine_first(placements: &mut [Placement], query: &Query<'_>, reference: &Reference) {
    if let Some(first) = placements.first_mut() {
        let seen = &reference.views[first.view].signature;
        *first = Placement {
            overlap: first.overlap,
            ..Placement::exactly_at(first.view, first.lag, [&query.signature.rays, &seen.rays])
        };
    }
}

impl Placement {
    /// At one lag of a view with `num_rays` rays, where the correlation is `value`; `power` is that of both outlines.
    fn at(view: usize, lag: usize, value: Complex<f64>, power: f64, num_rays: usize) -> Self {
        // The turn that maximises Re(e^{-iφ} c) is the argument of c, and |c| is what it reaches.
        let left = power - 2.0 * value.norm();
        Self {
            view,
            lag,
            turn: Radians(value.arg()),
            outline_distance: Metres((left.max(0.0) / num_rays as f64).sqrt()),
            overlap: None,
        }
    }

    /// The same in double precision, from the rays of query and view.
    fn exactly_at(view: usize, lag: usize, [query, seen]: [&[Vector2<f64>]; 2]) -> Self {
        let complex = |ray: &Vector2<f64>| Complex::new(ray.x, ray.y);
        let pairs = query[lag..].iter().chain(query).zip(seen);
        let value = pairs.map(|(q, s)| complex(q) * complex(s).conj()).sum();
        let power = query.iter().chain(seen).map(Vector2::norm_squared).sum();
        Self::at(view, lag, value, power, seen.len())
    }

    /// 0..1. Outlines alone are fooled by ragged edges, areas alone by slim parts.
    fn score(&self, params: &RankParams) -> f64 {
        let outline = (-self.outline_distance.0 / params.outline_tolerance.0).exp();
        (outline * self.overlap.unwrap_or(0.0)).sqrt()
    }
}

/// The scene's side of all comparisons, prepared once.
struct Placer<'a> {
    query: &'a Query<'a>,
    params: &'a RankParams,
    correlator: CircularCorrelator,
    strengths: Vec<i32>,
    sample: Thinned,
}

impl<'a> Placer<'a> {
    fn new(query: &'a Query<'a>, params: &'a RankParams) -> Self {
        let spectrum = RaySpectra::of([&query.signature.rays[..]]);
        Self {
            query,
            params,
            correlator: CircularCorrelator::new(spectrum),
            strengths: Vec::new(),
            sample: thinned(query.plane),
        }
    }

    fn place(&mut self, enrolled: &Reference) -> Vec<Placement> {
        let mut placements = Vec::with_capacity(2 * enrolled.views.len());
        let correlations = self.correlator.correlate(&enrolled.spectra).enumerate();
        for (view, (values, power)) in correlations {
            let lags = highest_apart(values, &mut self.strengths);
            placements.extend(lags.into_iter().flatten().map(|lag| {
                let value = Complex::new(values[lag].re.into(), values[lag].im.into());
                Placement::at(view, lag, value, power, values.len())
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

/// Half of the places for the best placement and its like, half for the best that is turned far from it: sorted by
/// distance alone, the views of a near-symmetric part would fill the list with the same mistake.
fn both_ways_round(enrolled: &Reference, sorted: &[Placement], num: usize) -> Vec<Placement> {
    const FAR_TURN: f64 = std::f64::consts::FRAC_PI_3;
    let attitude = |p: &Placement| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), p.turn.0);
        turn * enrolled.views[p.view].plane_from_part.rotation
    };
    let Some(best) = sorted.first().map(attitude) else {
        return Vec::new();
    };
    // Of unit quaternions the scalar product is the cosine of half the angle between them.
    let least_near = (FAR_TURN / 2.0).cos();
    let (near, far): (Vec<Placement>, Vec<Placement>) = sorted
        .iter()
        .partition(|p| attitude(p).coords.dot(&best.coords).abs() > least_near);
    let num_far = far.len().min(num / 2);
    near.into_iter()
        .take(num - num_far)
        .chain(far.into_iter().take(num_far))
        .collect()
}

/// The lag of the greatest value, and that of the greatest other peak at least a sixteenth of the circle away: a
/// near-symmetric part fits almost as well half a turn off. `twice_around` is scratch memory.
fn highest_apart(correlation: &[Complex<f32>], twice_around: &mut Vec<i32>) -> [Option<usize>; 2] {
    let n = correlation.len();
    // The bits of floats that are not negative are in the order of the floats, and a maximum of whole numbers is
    // taken by vectors.
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
        let place = peaks.position(|strength| strength == highest);
        place.map(|place| (behind + 1 + place) % n)
    });
    [first, second]
}

/// Spacing of the points at which two images are compared, metres.
const OVERLAP_SPACING: f64 = 0.03;

/// Set places of an image on a coarse grid, with the area that each stands for.
struct Thinned {
    points: PointBlocks,
    area_each: f64,
}

fn thinned(plane: &PlaneImage) -> Thinned {
    let step = ((OVERLAP_SPACING / plane.pixel.0).round() as usize).max(1);
    let image = &plane.image;
    let rows = (0..image.height).step_by(step);
    let places = rows.flat_map(|row| {
        (0..image.width)
            .step_by(step)
            .map(move |column| (row, column))
    });
    let set = places.filter(|(row, column)| image.pixels[row * image.width + column] != 0);
    let point = |(row, column)| plane.plane_point(column as f64, row as f64).cast();
    Thinned {
        points: set.map(point).collect(),
        area_each: (step as f64 * plane.pixel.0).powi(2),
    }
}

/// Shared area over joint area of the scene's image and a view laid over it.
fn overlap(
    scene: &Thinned,
    seen: &ReferenceView,
    scene_plane_from_view_plane: &Isometry2<f64>,
) -> f64 {
    // Straight from scene plane to pixels of the view: this decides what ranking costs.
    let view_plane_from_scene = scene_plane_from_view_plane.inverse();
    let pixel = |x: f64, y: f64| {
        let plane = &seen.plane;
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
