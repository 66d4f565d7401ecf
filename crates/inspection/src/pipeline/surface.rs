//! The stages after segmentation, for one surface of a scene.

use super::{
    Inspection, PoseChoice, Recipe,
    rejection::Unrecognisable,
    verdict::{Verdict, verdict},
    watch::{Cancelled, Stage, StageClock},
};
use crate::library::Library;
use stages::{
    confirm::{ConfirmedRanking, Scene, confirm},
    contour::{Contour, find_contour},
    locate::{Located, locate},
    pose::{AlignParams, PoseError, PoseEstimate, PoseMethod},
    project::{PlaneImage, project},
    rack::Rack,
    rank::{Matcher, Query, place, rank},
    scene::SceneCloud,
    segment::SegmentedPart,
    signature::{FanSignature, describe},
};

/// What every surface of a scene is inspected with.
#[derive(Clone, Copy)]
pub(super) struct InspectionInputs<'a> {
    pub(super) scene: &'a SceneCloud,
    pub(super) library: &'a Library,
    pub(super) recipe: &'a Recipe,
    pub(super) clock: &'a StageClock<'a>,
    /// Where parts may hang in the scene.
    pub(super) rack: &'a Rack,
}

/// Results of the stages after segmentation, for one surface.
#[derive(Default)]
pub(super) struct SurfaceResult {
    plane: Option<PlaneImage>,
    contour: Option<Contour>,
    signature: Option<FanSignature>,
    pub(super) ranking: ConfirmedRanking,
    pose: Option<Result<PoseEstimate, PoseError>>,
    pub(super) verdict: Option<Verdict>,
}

impl SurfaceResult {
    pub(super) fn best_score(&self) -> f64 {
        self.ranking.entries.first().map_or(0.0, |e| e.score)
    }

    pub(super) fn keep(self, inspection: &mut Inspection) {
        let Self {
            plane,
            contour,
            signature,
            ranking,
            pose,
            verdict,
        } = self;
        inspection.plane = plane;
        inspection.contour = contour;
        inspection.signature = signature;
        inspection.ranking = ranking;
        inspection.pose = pose;
        if let Some(verdict) = verdict {
            inspection.verdict = verdict;
        }
    }
}

/// Runs the stages after segmentation on one surface. A score below `least_score` is of no use to the caller.
pub(super) fn inspect_surface(
    part: &SegmentedPart,
    inputs: &InspectionInputs<'_>,
    least_score: f64,
) -> Result<SurfaceResult, Cancelled> {
    inspect_from(SurfaceResult::default(), part, inputs, least_score)
}

/// As [`inspect_surface`], of a surface of which an inspection of the same points knows image, contour and signature.
pub(super) fn inspect_again(
    known: &Inspection,
    part: &SegmentedPart,
    inputs: &InspectionInputs<'_>,
    least_score: f64,
) -> Result<SurfaceResult, Cancelled> {
    let surface = SurfaceResult {
        plane: known.plane.clone(),
        contour: known.contour.clone(),
        signature: known.signature.clone(),
        ..SurfaceResult::default()
    };
    inspect_from(surface, part, inputs, least_score)
}

fn inspect_from(
    mut surface: SurfaceResult,
    part: &SegmentedPart,
    inputs: &InspectionInputs<'_>,
    least_score: f64,
) -> Result<SurfaceResult, Cancelled> {
    let recognised = recognise(&mut surface, part, inputs, least_score)?;
    surface.verdict = Some(match recognised {
        Ok(()) => verdict(&surface.ranking, surface.pose.as_ref(), inputs.recipe),
        Err(reason) => Verdict::NoPart(reason),
    });
    Ok(surface)
}

/// Runs the stages that `inspection` has no result of, and stores each.
fn recognise(
    inspection: &mut SurfaceResult,
    part: &SegmentedPart,
    inputs: &InspectionInputs<'_>,
    least_score: f64,
) -> Result<Result<(), Unrecognisable>, Cancelled> {
    let InspectionInputs {
        scene,
        library,
        recipe,
        clock,
        rack,
    } = *inputs;
    let plane = match inspection.plane.take() {
        Some(known) => Ok(known),
        None => clock.time(Stage::Project, || project(part, &recipe.project))?,
    };
    let plane = match plane {
        Ok(plane) => inspection.plane.insert(plane),
        Err(error) => return Ok(Err(error.into())),
    };
    let contour = match inspection.contour.take() {
        Some(known) => Ok(known),
        None => clock.time(Stage::Contour, || find_contour(plane, &recipe.contour))?,
    };
    let contour = match contour {
        Ok(contour) => inspection.contour.insert(contour),
        Err(error) => return Ok(Err(error.into())),
    };
    let signature = match inspection.signature.take() {
        Some(known) => Ok(known),
        None => clock.time(Stage::Signature, || describe(contour, &recipe.signature))?,
    };
    let signature = match signature {
        Ok(signature) => inspection.signature.insert(signature),
        Err(error) => return Ok(Err(error.into())),
    };
    let query = Query {
        plane,
        contour,
        signature,
    };
    let references = &library.references;
    let expected = recipe.expected.parts().iter();
    let expected: Vec<String> = expected.map(|part| part.name.clone()).collect();
    let mut ranking = clock.time(Stage::Rank, || rank(&query, references, &recipe.rank))?;
    let Some(first) = ranking.entries.first_mut() else {
        return Ok(Err(Unrecognisable::EmptyLibrary));
    };
    match recipe.pose {
        PoseChoice::Skip => inspection.ranking = ConfirmedRanking::unexamined(&ranking),
        PoseChoice::By(method @ (PoseMethod::Icp | PoseMethod::IcpGa)) => {
            let reference = &references[first.reference];
            let is_cancelled = || clock.is_cancelled();
            let params = AlignParams {
                method,
                icp: recipe.icp.clone(),
                icp_ga: recipe.icp_ga.clone(),
            };
            let scene = Scene {
                scene,
                part,
                query,
                rack,
                expected: &expected,
            };
            let located = clock.time(Stage::Pose, || {
                locate(&scene, reference, &params, &is_cancelled)
            })?;
            if located == Err(PoseError::Cancelled) {
                return Err(Cancelled);
            }
            // The matcher decides the order; the score of the first is the fit at its pose.
            let mut confirmed = ConfirmedRanking::unexamined(&ranking);
            for entry in &mut confirmed.entries {
                entry.score = 0.0;
            }
            confirmed.entries[0].is_examined = true;
            if let Ok(Located { pose, rival }) = &located {
                confirmed.entries[0].score = pose.fit.score();
                confirmed.entries[0].rival = *rival;
                confirmed.entries[0].pose = Some(pose.clone());
            }
            inspection.ranking = confirmed;
            inspection.pose = Some(located.map(|located| located.pose));
        }
        PoseChoice::By(PoseMethod::Global) => {
            let mut params = recipe.confirm.clone();
            if recipe.rank.matcher == Matcher::Paper {
                // Keep the choice of the paper's matcher: place only that reference.
                params.num_references = 1;
                first.placements = place(&query, &references[first.reference], &recipe.rank);
            }
            let scene = Scene {
                scene,
                part,
                query,
                rack,
                expected: &expected,
            };
            let (ranking, pose) = clock.time(Stage::Pose, || {
                confirm(&scene, references, &ranking, &params, least_score)
            })?;
            inspection.ranking = ranking;
            inspection.pose = Some(pose);
        }
    }
    Ok(Ok(()))
}
