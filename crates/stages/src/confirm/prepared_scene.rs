//! The scene's side of all comparisons: what is compared with every reference is prepared once.

use nalgebra::{Point3, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    ConfirmParams, Scene, THIRD,
    candidate::ReferenceCandidate,
    evidence::facing_view,
    local_normal::LocalNormals,
    outline_ends::{Outline, outline_of},
    outline_shift::{edges_of_part, outline_shift},
    piece_search::{
        HIGH_SCORE, NUM_PAIRS, NUM_PAIRS_FOR_A_HIGH_SCORE, NUM_PAIRS_OF_A_WHOLE, PieceSample,
    },
};
use crate::{
    pose::{
        RunnerUp, ScaleEstimate,
        closest::Correspondence,
        quality::{NUM_LOOKED_FOR, Tolerance},
        refine::{AlignmentSource, Search, refine},
        scale::scale,
        uncertainty::uncertainty,
    },
    rank::{MatchEntry, NUM_CERTAIN},
    reference::{Reference, border::BorderPoint},
};
use geometry::parallel::num_cores;

/// The scene's side of all comparisons, prepared once.
pub(super) struct PreparedScene<'a> {
    pub(super) scene: &'a Scene<'a>,
    /// Whether it is searched for as a piece.
    pub(super) is_piece: bool,
    pub(super) source: AlignmentSource,
    pub(super) centre: Point3<f64>,
    outline: Outline,
    /// `None` if a whole part is in sight, and whole ones are enrolled.
    pub(super) piece: Option<PieceSample>,
    /// Number of pairs of its border that are looked up.
    num_pairs: usize,
    pub(super) tolerance: Tolerance,
    /// Number of threads that share the references; does not affect the result.
    pub(super) num_workers: usize,
}

/// References that are cut off and looked at whatever they rank.
const MOST_CUT_REFERENCES: usize = 8;

impl<'a> PreparedScene<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        references: &[Reference],
        params: &ConfirmParams,
        least_score: f64,
    ) -> Self {
        let outline = outline_of(scene);
        let source = thinned_source(scene, &outline, params.seed);
        let are_whole = || {
            references
                .iter()
                .all(|reference| reference.cut.is_nothing())
        };
        let is_piece = scene.part.is_piece || outline.cut_share >= CUT_SHARE;
        let num_pairs = num_pairs(scene, least_score);
        let piece = (is_piece || !are_whole()).then(|| {
            let border = oriented_border(scene, &outline);
            PieceSample::new(&source.surface, border, num_pairs, params.seed)
        });
        Self {
            is_piece,
            scene,
            centre: centre_of(&source.surface),
            source,
            outline,
            piece,
            num_pairs,
            tolerance: Tolerance {
                base: params.tolerance,
                noise_at_1m: scene.part.noise_at_1m,
            },
            num_workers: num_cores(),
        }
    }

    /// Thins the part anew, and draws other pairs of its border.
    pub(super) fn draw_again(&mut self, seed: u64) {
        self.source = thinned_source(self.scene, &self.outline, seed);
        self.centre = centre_of(&self.source.surface);
        if let Some(piece) = self.piece.take() {
            let surface = &self.source.surface;
            self.piece = Some(PieceSample::new(
                surface,
                piece.border,
                self.num_pairs,
                seed,
            ));
        }
    }

    /// Length of the outline that is the part's own, metres.
    pub(super) fn own_m(&self) -> f64 {
        self.outline.own.len() as f64 * self.scene.query.plane.pixel.0
    }

    /// Share of the outline where only the view ends.
    pub(super) fn cut_share(&self) -> f64 {
        self.outline.cut_share
    }

    /// What is laid onto a reference as a piece; `None` where both are whole.
    pub(super) fn piece_for(&self, reference: &Reference) -> Option<&PieceSample> {
        let is_piece = self.is_piece || !reference.cut.is_nothing();
        self.piece.as_ref().filter(|_| is_piece)
    }

    /// Puts the entries that are to be looked at to the front, and counts them.
    pub(super) fn select_entries(
        &self,
        entries: &mut [&MatchEntry],
        references: &[Reference],
        params: &ConfirmParams,
    ) -> usize {
        if self.is_piece {
            // The outline of a piece says little, so all that are sure to have ranked high are looked at.
            return params.num_references.max(NUM_CERTAIN).min(entries.len());
        }
        let mut num = params.num_references.min(entries.len());
        let most = num + MOST_CUT_REFERENCES;
        for i in params.num_references..entries.len() {
            let is_cut = !references[entries[i].reference].cut.is_nothing();
            if is_cut && num < most {
                entries[num..=i].rotate_right(1);
                num += 1;
            }
        }
        num
    }

    /// Returns the candidate refined to the end; `None` if its reference has nothing to align with.
    pub(super) fn finished(
        &self,
        reference: &Reference,
        candidate: &ReferenceCandidate,
    ) -> Option<ReferenceCandidate> {
        let mut candidate = candidate.clone();
        let start = candidate.refined.target_from_source;
        let allowed = reference.turned_onto_itself(&start);
        let allowed = allowed.into_iter().find(|turned| {
            self.scene.rack.allows_turn(reference, turned)
                && !self.competes(reference, &start, turned)
        });
        if let Some(turned) = allowed {
            let runner_up = &mut candidate.runner_up;
            runner_up
                .take_if(|other| !self.competes(reference, &other.target_from_source, &turned));
            candidate.view = facing_view(reference, &turned);
            candidate.refined.target_from_source = turned;
        }
        let target = reference.target(candidate.view)?;
        let start = candidate.refined.target_from_source;
        candidate
            .refined
            .append(refine(&self.source, &target, &start, &THIRD));
        let (source, pose) = (&self.source, &candidate.refined.target_from_source);
        let closest = Correspondence::of_each(&source.surface, &target, pose, Search::Tree);
        candidate.uncertainty = Some(uncertainty(source, &closest, &target, pose, &THIRD[2], 1));
        (candidate.fit, candidate.evidence) =
            self.evaluate(reference, candidate.view, pose, &closest, NUM_LOOKED_FOR);
        let mut turned = reference.turned_onto_itself(pose).into_iter();
        if let Some(turned) = turned.find(|turned| self.competes(reference, turned, pose)) {
            candidate.runner_up = Some(RunnerUp {
                target_from_source: turned,
                ratio: 1.0,
            });
        }
        let view = &reference.views[candidate.view];
        let edges = self.edges_of_part(reference, &candidate)?;
        let shift = outline_shift(&edges, &view.contour(), &view.plane_from_part, pose);
        candidate.evidence.outline_shift_m = shift.map(|shift| shift.rms);
        candidate.evidence.outline_median_m = shift.map(|shift| shift.median);
        Some(candidate)
    }

    /// Returns how much larger or smaller the part is than its reference at a candidate's pose.
    pub(super) fn scale(
        &self,
        reference: &Reference,
        candidate: &ReferenceCandidate,
    ) -> Option<ScaleEstimate> {
        let edges = self.edges_of_part(reference, candidate)?;
        let target = reference.target(candidate.view)?;
        let pose = &candidate.refined.target_from_source;
        scale(
            &self.source,
            &edges,
            &target,
            pose,
            self.scene.part.noise_at_1m,
        )
    }

    /// Returns those points of the outline that are edges of the part.
    fn edges_of_part(
        &self,
        reference: &Reference,
        candidate: &ReferenceCandidate,
    ) -> Option<Vec<Point3<f32>>> {
        Some(edges_of_part(
            &self.source,
            &reference.target(candidate.view)?,
            &reference.views[candidate.view].plane_from_part,
            &candidate.refined.target_from_source,
            self.scene.part.noise_at_1m,
            &reference.cut,
        ))
    }
}

fn num_pairs(scene: &Scene<'_>, least_score: f64) -> usize {
    if scene.part.is_piece {
        NUM_PAIRS_OF_A_WHOLE
    } else if least_score >= HIGH_SCORE {
        NUM_PAIRS_FOR_A_HIGH_SCORE
    } else {
        NUM_PAIRS
    }
}

/// Thins part and edges at random, so that any first n of them are spread over the part.
pub(super) fn thinned_source(scene: &Scene<'_>, outline: &Outline, seed: u64) -> AlignmentSource {
    let mut rng = Pcg64::seed_from_u64(seed);
    let points = &scene.part.cloud.points;
    let wanted = THIRD[2].num_surface;
    let mut surface: Vec<Point3<f32>> = points
        .iter()
        .step_by((points.len() / wanted).max(1))
        .copied()
        .collect();
    surface.shuffle(&mut rng);
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    let mut edges: Vec<Point3<f32>> = outline
        .own
        .iter()
        .step_by((outline.own.len() / 300).max(1))
        .map(|p| (camera_from_plane * p).cast())
        .collect();
    edges.shuffle(&mut rng);
    AlignmentSource { surface, edges }
}

/// An outline of which more than this share is not the part's own is that of a piece.
pub const CUT_SHARE: f64 = 0.04;
/// Points of the border that get a normal.
const NUM_ORIENTED: usize = 80;

/// The part's own border with the surface's normals, camera space.
fn oriented_border(scene: &Scene<'_>, outline: &Outline) -> Vec<BorderPoint> {
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    let normals = LocalNormals::new(scene);
    let step = outline.own.len().div_ceil(NUM_ORIENTED).max(1);
    let points = outline.own.iter().zip(&outline.along).step_by(step);
    points
        .filter_map(|(at, along)| {
            let at = camera_from_plane * at;
            let normal = normals.at(&at)?;
            let along = (camera_from_plane * along).cast::<f32>();
            // Along the border, and in the surface.
            let along = (along - normal * along.dot(&normal)).try_normalize(0.3)?;
            Some(BorderPoint {
                at: at.cast(),
                along,
                normal,
            })
        })
        .collect()
}

pub(super) fn centre_of(points: &[Point3<f32>]) -> Point3<f64> {
    let sum = points
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f64>, p| {
            sum + p.coords.cast::<f64>()
        });
    Point3::from(sum / points.len().max(1) as f64)
}
