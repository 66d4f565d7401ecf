//! Explanations of a scene whose likeliest surface is no enrolled part, tried one after the other.

use std::{iter, mem};

use super::{
    Inspection, PoseChoice, Recipe,
    mirror::check_mirror_image,
    surface::{InspectionInputs, inspect_again, inspect_surface},
    watch::{Cancelled, Stage},
};
use stages::{
    confirm::CUT_SHARE,
    pose::PoseMethod,
    rank::Matcher,
    segment::{SegmentedPart, other_segments, split, without_bars},
};

/// What may hang there, if the likeliest surface is not accepted as a part.
#[derive(Clone, Copy)]
enum Hypothesis {
    /// A part, and it is another surface of the scene.
    OtherSurface,
    /// The mirror image of a part.
    MirrorImage,
    /// A piece of a part, which looks like a whole one.
    Piece,
    /// A part on a stand, whose bars were taken for some of the part.
    PartOnStand,
    /// One of several parts, which hang so close that they were taken for one.
    OneOfSeveral,
}

/// In the order in which they are tried, until one is accepted. Where several parts may hang, they often touch, and the
/// mirror image of two at once is looked for in vain.
const HYPOTHESES: [Hypothesis; 5] = [
    Hypothesis::OtherSurface,
    Hypothesis::OneOfSeveral,
    Hypothesis::MirrorImage,
    Hypothesis::Piece,
    Hypothesis::PartOnStand,
];

/// Where a smaller share of a surface lies off the best reference, it is one part that is not accepted for another reason.
const MIN_OFF_OF_SEVERAL: f64 = 0.05;
/// Maximum number of other surfaces that are tried.
const MAX_OTHER_SURFACES: usize = 3;
/// A surface replaces the one before only above this score; below it neither is an enrolled part.
pub(super) const MIN_REPLACING_SCORE: f64 = 0.1;

/// Tries the hypotheses on an inspection of the likeliest surface, and keeps what is most likely an enrolled part.
pub(super) fn try_hypotheses(
    inspection: &mut Inspection,
    inputs: &InspectionInputs<'_>,
) -> Result<(), Cancelled> {
    if !is_unexplained(inspection, inputs.recipe) {
        return Ok(());
    }
    let Ok(likeliest) = inspection.segmentation.part.clone() else {
        return Ok(());
    };
    let evidence = inspection.ranking.entries.first().and_then(|e| e.evidence);
    let looks_whole = evidence.is_some_and(|evidence| evidence.cut < CUT_SHARE);
    let has_more = evidence.is_none_or(|evidence| evidence.off > MIN_OFF_OF_SEVERAL);
    let mut one_of_several = None;
    for hypothesis in HYPOTHESES {
        let is_plausible = match hypothesis {
            Hypothesis::OtherSurface | Hypothesis::MirrorImage => true,
            Hypothesis::Piece => looks_whole && !inspection.verdict.is_likeness(),
            Hypothesis::PartOnStand => !inspection.verdict.is_likeness(),
            Hypothesis::OneOfSeveral => has_more && inputs.recipe.max_parts() > 1,
        };
        if !is_plausible {
            continue;
        }
        let whole = matches!(hypothesis, Hypothesis::OneOfSeveral).then(|| inspection.clone());
        hypothesis.attempt(inspection, &likeliest, inputs)?;
        if !is_unexplained(inspection, inputs.recipe) {
            return Ok(());
        }
        // What is not one of several may be another thing as a whole.
        if let Some(whole) = whole {
            one_of_several = Some(mem::replace(inspection, whole));
        }
    }
    if let Some(one) = one_of_several
        && one.best_score() > inspection.best_score()
    {
        *inspection = one;
    }
    Ok(())
}

/// True if nothing is accepted yet, and the recipe does not use the paper's methods, which know only one surface.
fn is_unexplained(inspection: &Inspection, recipe: &Recipe) -> bool {
    let is_ours = recipe.rank.matcher == Matcher::Default
        && recipe.pose == PoseChoice::By(PoseMethod::Global);
    is_ours && !inspection.verdict.is_accepted() && !inspection.ranking.entries.is_empty()
}

impl Hypothesis {
    fn attempt(
        self,
        inspection: &mut Inspection,
        likeliest: &SegmentedPart,
        inputs: &InspectionInputs<'_>,
    ) -> Result<(), Cancelled> {
        let InspectionInputs {
            scene,
            recipe,
            clock,
            ..
        } = *inputs;
        match self {
            Self::OtherSurface => {
                let others = clock.time(Stage::Segment, || {
                    let known = &inspection.segmentation;
                    other_segments(scene, known, &recipe.segment, MAX_OTHER_SURFACES)
                })?;
                let others = others.into_iter().map(Ok);
                try_surfaces(inspection, others, MIN_REPLACING_SCORE, inputs)
            }
            Self::MirrorImage => check_mirror_image(inspection, inputs),
            Self::Piece => {
                let piece = SegmentedPart {
                    is_piece: true,
                    ..likeliest.clone()
                };
                try_surface(inspection, piece, MIN_REPLACING_SCORE, inputs)
            }
            Self::PartOnStand => {
                let mut bare = clock.time(Stage::Segment, || without_bars(scene, likeliest))?;
                let next = || clock.time(Stage::Segment, || bare.next()).transpose();
                try_surfaces(inspection, iter::from_fn(next), MIN_REPLACING_SCORE, inputs)
            }
            Self::OneOfSeveral => {
                let mut pieces =
                    clock.time(Stage::Segment, || split(scene, likeliest, &recipe.segment))?;
                let next = || clock.time(Stage::Segment, || pieces.next()).transpose();
                // A piece that is no part is less than the surface it was cut from.
                let least = recipe.accept.unknown_below;
                try_surfaces(inspection, iter::from_fn(next), least, inputs)
            }
        }
    }
}

/// Tries surfaces until one is accepted.
fn try_surfaces(
    inspection: &mut Inspection,
    surfaces: impl Iterator<Item = Result<SegmentedPart, Cancelled>>,
    least: f64,
    inputs: &InspectionInputs<'_>,
) -> Result<(), Cancelled> {
    for surface in surfaces {
        try_surface(inspection, surface?, least, inputs)?;
        if inspection.verdict.is_accepted() {
            break;
        }
    }
    Ok(())
}

/// Inspects a surface, and keeps it if it is more likely an enrolled part than the present one and scores more than `least`.
pub(super) fn try_surface(
    inspection: &mut Inspection,
    surface: SegmentedPart,
    least: f64,
    inputs: &InspectionInputs<'_>,
) -> Result<(), Cancelled> {
    let min_score = inspection.best_score().max(least);
    let of_same_points = |known: &SegmentedPart| known.indices == surface.indices;
    let found = if inspection
        .segmentation
        .part
        .as_ref()
        .is_ok_and(of_same_points)
    {
        inspect_again(inspection, &surface, inputs, min_score)?
    } else {
        inspect_surface(&surface, inputs, min_score)?
    };
    if found.best_score() > min_score {
        inspection.segmentation.take(surface);
        found.keep(inspection);
    }
    Ok(())
}
