//! Whether a part's shape fixes its pose, tested by confirming the reference in its own standard view.

use crate::{
    library::EnrolWarning,
    stages::{
        confirm::{ConfirmParams, Scene, confirm},
        rank::{Query, RankParams, rank},
        reference::{Coverage, Reference, seen_around},
        scene::SceneCloud,
        segment::SegmentedPart,
    },
};

/// Margin over another pose below which an inspection rejects the pose.
const LEAST_LEAD: f64 = 0.05;

/// Returns what an inspection of the whole part without noise would find wrong with its pose.
pub(super) fn pose_warning(reference: &Reference, coverage: Coverage) -> Option<EnrolWarning> {
    let view = reference.views.first()?;
    let (_, seen) = seen_around(&reference.cloud, coverage).into_iter().next()?;
    let query = Query {
        plane: &view.plane,
        contour: &view.contour,
        signature: &view.signature,
    };
    let references = std::slice::from_ref(reference);
    let ranking = rank(&query, references, &RankParams::default());
    let scene = Scene {
        scene: &SceneCloud::default(),
        part: &SegmentedPart::whole(&seen),
        query,
    };
    let (confirmed, pose) = confirm(&scene, references, &ranking, &ConfirmParams::default(), 0.0);
    let (found, pose) = (confirmed.entries.first()?, pose.ok()?);
    if let Some(freedom) = pose.uncertainty.and_then(|found| found.freedom) {
        return Some(EnrolWarning::Unconstrained(freedom));
    }
    let rival = found.evidence.map_or(0.0, |evidence| evidence.rival);
    let is_tied = rival > 0.0 && found.score - rival < LEAST_LEAD;
    let other = pose.runner_up.filter(|_| is_tied || pose.is_ambiguous())?;
    let between = pose.target_from_source * other.target_from_source.inverse();
    Some(EnrolWarning::Symmetric {
        degrees: between.rotation.angle().to_degrees().round() as u16,
    })
}
