//! The whole inspection: every stage in order, every intermediate result kept, each stage timed.
//!
//! The window, the command line and the tests are three callers of [`run`].

mod identity;
pub mod live;
mod mirror;
mod named_recipe;
pub mod parameters;
mod recipe_error;
mod recipe_folder;
mod refusal;
mod rejection;
pub mod scan;
mod surface;
mod unsound;
mod verdict;
mod watch;

use crate::{
    error::{Fault, guarded},
    library::Library,
    stages::{
        confirm::{CUT_SHARE, ConfirmParams, ConfirmedRanking},
        contour::{Contour, ContourParams},
        pose::{PoseError, PoseEstimate, PoseMethod, icp::IcpParams, icp_ga::IcpGaParams},
        project::{PlaneImage, ProjectParams},
        rank::{Matcher, RankParams},
        reference::{Reference, ReferenceParams},
        scene::SceneCloud,
        segment::{
            Bars, NoPart, PointLabel, SegmentParams, Segmentation, SegmentedPart, other_segments,
            segment, without_bars,
        },
        signature::{FanSignature, SignatureParams},
        stand_off::StandOffParams,
    },
    units::Metres,
};

use self::{
    mirror::check_mirror_image, surface::inspect_surface, unsound::refuse_unsound,
    watch::StageClock,
};
pub use self::{
    mirror::{MirrorTally, OnlyMirrored},
    named_recipe::{BUILT_IN, MAX_NOTES, NamedRecipe, RecipeBlock, RecipeFile, RecipeLabel},
    recipe_error::RecipeError,
    recipe_folder::{RecipeFolder, RecipeList, Replace, open_recipe},
    refusal::{Refusal, RefusalKind},
    rejection::{Rejection, Unrecognisable},
    verdict::{AcceptParams, Verdict},
    watch::{Cancelled, ProgressObserver, Stage, Timings, Unwatched},
};

/// All parameters of an inspection.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Recipe {
    /// Segmentation.
    pub segment: SegmentParams,
    /// Projection.
    pub project: ProjectParams,
    /// Contour.
    pub contour: ContourParams,
    /// Signature.
    pub signature: SignatureParams,
    /// Ranking.
    pub rank: RankParams,
    /// Confirmation of the best few.
    pub confirm: ConfirmParams,
    /// ICP.
    pub icp: IcpParams,
    /// ICP-GA.
    pub icp_ga: IcpGaParams,
    /// Acceptance.
    pub accept: AcceptParams,
    /// The nozzle's stand-off, worked out from the pose where it is shown.
    pub stand_off: StandOffParams,
    /// How the pose is estimated.
    pub pose: PoseChoice,
}

impl Recipe {
    /// What references are prepared with: they are compared fairly only with scenes that were projected, outlined and
    /// described with the same parameters.
    pub fn reference_params(&self) -> ReferenceParams {
        ReferenceParams {
            project: self.project.clone(),
            contour: self.contour.clone(),
            signature: self.signature.clone(),
        }
    }
}

/// Whether and how an inspection estimates the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PoseChoice {
    /// Stop after the ranking: the verdict rests on the outline alone.
    Skip,
    /// By this method.
    By(PoseMethod),
}

impl Default for PoseChoice {
    fn default() -> Self {
        Self::By(PoseMethod::Global)
    }
}

/// What an inspection found, stage by stage. A stage that could not run leaves the later ones empty.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Segmentation.
    pub segmentation: Segmentation,
    /// Binary image.
    pub plane: Option<PlaneImage>,
    /// Outline and openings.
    pub contour: Option<Contour>,
    /// Signature.
    pub signature: Option<FanSignature>,
    /// References, best first; after a pose was confirmed, in the order of the confirmed score.
    pub ranking: ConfirmedRanking,
    /// The pose of the first-ranked part, if asked for.
    pub pose: Option<Result<PoseEstimate, PoseError>>,
    /// The verdict.
    pub verdict: Verdict,
    /// How long each stage took.
    pub timings: Timings,
}

/// Inspects a scene: which enrolled part is it, and where?
///
/// With nothing enrolled or nothing found the inspection still holds what the stages before made. A panic in a stage is
/// a verdict too: no part, and why.
pub fn run(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<Inspection, Cancelled> {
    let ran = match &scene.fault {
        Some(fault) => Err(fault.clone()),
        None => guarded(|| inspect(scene, library, recipe, watch)),
    };
    let mut inspection = ran.unwrap_or_else(|fault| {
        let num_points = scene.cloud.points.len();
        Ok(Inspection::broken_off(fault, num_points))
    })?;
    refuse_unsound(&mut inspection, scene);
    Ok(inspection)
}

fn inspect(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<Inspection, Cancelled> {
    let clock = StageClock::start(watch);
    let segmentation = clock.time(Stage::Segment, || segment(scene, &recipe.segment))?;
    let mut inspection = Inspection {
        segmentation,
        plane: None,
        contour: None,
        signature: None,
        ranking: ConfirmedRanking::default(),
        pose: None,
        verdict: Verdict::NoPart(Unrecognisable::EmptyLibrary),
        timings: Timings::default(),
    };
    let part = inspection.segmentation.part.as_ref();
    let first = part.map(|part| inspect_surface(part, scene, library, recipe, 0.0, &clock));
    match first.map_err(|no_part| *no_part) {
        Ok(first) => {
            first?.keep(&mut inspection);
            let evidence = inspection.ranking.entries.first().and_then(|e| e.evidence);
            let looks_whole = evidence.is_some_and(|evidence| evidence.cut < CUT_SHARE);
            if should_try_alternatives(&inspection, recipe) {
                let likeliest = inspection.segmentation.part.clone();
                try_other_segments(&mut inspection, scene, library, recipe, &clock)?;
                if should_try_alternatives(&inspection, recipe) {
                    check_mirror_image(&mut inspection, scene, library, recipe, &clock)?;
                }
                if let Ok(likeliest) = &likeliest {
                    if is_nothing_like_it(&inspection, recipe) && looks_whole {
                        let piece = SegmentedPart {
                            is_piece: true,
                            ..likeliest.clone()
                        };
                        try_segment(&mut inspection, piece, scene, library, recipe, &clock)?;
                    }
                    if is_nothing_like_it(&inspection, recipe) {
                        try_without_bars(
                            &mut inspection,
                            likeliest,
                            scene,
                            library,
                            recipe,
                            &clock,
                        )?;
                    }
                }
            }
        }
        Err(no_part) => inspection.verdict = Verdict::NoPart(no_part.into()),
    }
    inspection.timings = clock.finish();
    Ok(inspection)
}

/// Of the other surfaces so many are looked at.
const MAX_OTHERS: usize = 3;

/// Below this score one surface is as little an enrolled part as another: the first stays.
const WORTH_CHANGING: f64 = 0.1;

/// True if the part may be another of the surfaces in the scene. The paper knows only one.
fn should_try_alternatives(inspection: &Inspection, recipe: &Recipe) -> bool {
    let is_ours = recipe.rank.matcher == Matcher::Default
        && recipe.pose == PoseChoice::By(PoseMethod::Global);
    let is_accepted = matches!(inspection.verdict, Verdict::Part { rejected: None, .. });
    is_ours && !is_accepted && !inspection.ranking.entries.is_empty()
}

/// True if neither an enrolled part nor one that is like it, such as its mirror image, was found.
fn is_nothing_like_it(inspection: &Inspection, recipe: &Recipe) -> bool {
    should_try_alternatives(inspection, recipe) && !inspection.verdict.is_likeness()
}

/// Looks at the next largest surfaces too, and keeps the one that is most likely an enrolled part.
fn try_other_segments(
    inspection: &mut Inspection,
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    clock: &StageClock<'_>,
) -> Result<(), Cancelled> {
    let others = clock.time(Stage::Segment, || {
        other_segments(scene, &inspection.segmentation, &recipe.segment, MAX_OTHERS)
    })?;
    for part in others {
        try_segment(inspection, part, scene, library, recipe, clock)?;
        if inspection.verdict.is_accepted() {
            break;
        }
    }
    Ok(())
}

/// Inspects a surface, and keeps it if it is more likely an enrolled part than what was taken for the part.
fn try_segment(
    inspection: &mut Inspection,
    part: SegmentedPart,
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    clock: &StageClock<'_>,
) -> Result<(), Cancelled> {
    let least = inspection.best_score().max(WORTH_CHANGING);
    let found = inspect_surface(&part, scene, library, recipe, least, clock)?;
    if found.best_score() > least {
        inspection.segmentation.take(part);
        found.keep(inspection);
    }
    Ok(())
}

/// Looks at a surface without any bars: they may be a stand's.
fn try_without_bars(
    inspection: &mut Inspection,
    surface: &SegmentedPart,
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    clock: &StageClock<'_>,
) -> Result<(), Cancelled> {
    let mut num_before = 0;
    for bars in [Bars::All, Bars::AllButSlats] {
        let bare = clock.time(Stage::Segment, || without_bars(scene, surface, bars))?;
        let Some(bare) = bare.filter(|bare| bare.indices.len() != num_before) else {
            continue;
        };
        num_before = bare.indices.len();
        try_segment(inspection, bare, scene, library, recipe, clock)?;
        if inspection.verdict.is_accepted() {
            break;
        }
    }
    Ok(())
}

impl Inspection {
    /// Of a scene at which the program itself failed.
    fn broken_off(fault: Fault, num_points: usize) -> Self {
        Self {
            segmentation: Segmentation {
                labels: vec![PointLabel::NoReading; num_points],
                planes: Vec::new(),
                clusters: Vec::new(),
                noise_at_1m: Metres(0.0),
                part: Err(NoPart::TooFewPoints {
                    found: 0,
                    needed: 0,
                }),
            },
            plane: None,
            contour: None,
            signature: None,
            ranking: ConfirmedRanking::default(),
            pose: None,
            verdict: Verdict::NoPart(Unrecognisable::Fault(fault)),
            timings: Timings::default(),
        }
    }

    /// True if what was taken for the part reaches the picture's edge, so that some of it may be missing.
    pub fn touches_edge(&self) -> bool {
        let part = self.segmentation.part.as_ref();
        part.is_ok_and(|part| part.touches_edge)
    }

    /// The name of the reference that was ranked first: the pose is in its coordinates.
    pub fn reference(&self) -> Option<&str> {
        let best = self.ranking.entries.first()?;
        Some(&best.enrolled_as)
    }

    /// The same, if that is not the part's own but one more of the part: it has coordinates, and so a standard position,
    /// of its own.
    pub fn other_reference(&self) -> Option<&str> {
        let best = self.ranking.entries.first()?;
        self.reference().filter(|name| *name != best.part)
    }

    /// The reference that was ranked first, in the library that was inspected with.
    pub fn best_reference<'a>(&self, library: &'a Library) -> Option<&'a Reference> {
        let best = self.ranking.entries.first()?;
        library.references.get(best.reference)
    }

    fn best_score(&self) -> f64 {
        self.ranking.entries.first().map_or(0.0, |e| e.score)
    }
}
