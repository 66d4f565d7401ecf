//! The whole inspection: every stage in order, every intermediate result kept, each stage timed.
//!
//! The window, the command line and the tests are three callers of [`run`].

use std::time::{Duration, Instant};

use crate::{
    error::Advice,
    library::Library,
    stages::{
        confirm::{ConfirmParams, Scene, UNCONFIRMED, confirm},
        contour::{Contour, ContourError, ContourParams, find_contour},
        pose::{
            PoseError, PoseEstimate, PoseMethod,
            icp::{IcpParams, locate_by_icp},
        },
        project::{PlaneImage, ProjectError, ProjectParams, project},
        rank::{MatchRanking, Matcher, Query, RankParams, place, rank},
        scene::SceneCloud,
        segment::{NoPart, SegmentParams, Segmentation, SegmentedPart, segment},
        signature::{FanSignature, SignatureError, SignatureParams, describe},
    },
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
    /// Acceptance.
    pub accept: AcceptParams,
    /// How the pose is estimated.
    pub pose: PoseChoice,
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

/// When a verdict counts.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct AcceptParams {
    /// Least score, 0..1. Raising it turns wrong verdicts into rejections, and some right ones too.
    pub min_score: f64,
    /// Least lead over the next part, 0..1.
    pub min_margin: f64,
}

impl Default for AcceptParams {
    fn default() -> Self {
        Self {
            min_score: 0.85,
            min_margin: 0.05,
        }
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
    pub ranking: MatchRanking,
    /// The pose of the first-ranked part, if asked for.
    pub pose: Option<Result<PoseEstimate, PoseError>>,
    /// The verdict.
    pub verdict: Verdict,
    /// How long each stage took.
    pub timings: Timings,
}

/// The verdict on a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// There is a part, and this is the best guess.
    Part {
        /// Name of the best match.
        part: String,
        /// Its score, 0..1.
        score: f64,
        /// Lead over the next part's score.
        margin: f64,
        /// `None` when accepted, else why not.
        rejected: Option<Rejection>,
    },
    /// Nothing to recognise.
    NoPart(Unrecognisable),
}

/// Why a best guess was not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The score is too low.
    #[error("the best match, {part}, scores {score:.2}, below the threshold of {threshold:.2}")]
    LowScore {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
        /// Least score.
        threshold: f64,
    },
    /// Another part fits nearly as well.
    #[error(
        "{part} and {other} fit almost equally well (margin {margin:.2}, needed {threshold:.2})"
    )]
    SmallMargin {
        /// Best match.
        part: String,
        /// Next match.
        other: String,
        /// Lead.
        margin: f64,
        /// Least lead.
        threshold: f64,
    },
    /// The paper's matcher was asked alone.
    #[error(
        "{part} is the nearest outline; the paper's matcher alone cannot tell it from an unknown part"
    )]
    Unconfirmed {
        /// Best match.
        part: String,
    },
    /// The pose could not be estimated.
    #[error("no pose was found: {0}")]
    NoPose(#[from] PoseError),
}

/// Why nothing could be recognised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unrecognisable {
    /// Segmentation left nothing.
    #[error(transparent)]
    NoPart(#[from] NoPart),
    /// No projection.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// No contour.
    #[error(transparent)]
    Contour(#[from] ContourError),
    /// No signature.
    #[error(transparent)]
    Signature(#[from] SignatureError),
    /// Nothing is enrolled.
    #[error("no part is enrolled in the library")]
    EmptyLibrary,
}

impl Advice for Rejection {
    fn advice(&self) -> String {
        match self {
            Self::LowScore { .. } => {
                "Check that this part is enrolled, that nothing covers it, and capture again".into()
            }
            Self::SmallMargin { .. } => {
                "Turn the part so that its face looks at the camera and capture again".into()
            }
            Self::Unconfirmed { .. } => "Have the pose estimated too, with --pose global".into(),
            Self::NoPose(error) => error.advice(),
        }
    }
}

impl Advice for Unrecognisable {
    fn advice(&self) -> String {
        match self {
            Self::NoPart(error) => error.advice(),
            Self::Project(error) => error.advice(),
            Self::Contour(error) => error.advice(),
            Self::Signature(error) => error.advice(),
            Self::EmptyLibrary => "Enrol a part first: partsight enrol FILE --name NAME".into(),
        }
    }
}

/// How long each stage took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Segmentation.
    pub segment: Duration,
    /// Projection.
    pub project: Duration,
    /// Contour.
    pub contour: Duration,
    /// Signature.
    pub signature: Duration,
    /// Ranking.
    pub rank: Duration,
    /// Pose, confirmation of the best few included.
    pub pose: Duration,
    /// From the scene's points to the verdict.
    pub total: Duration,
}

/// The stages, as progress is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Segmentation.
    Segment,
    /// Projection.
    Project,
    /// Contour.
    Contour,
    /// Signature.
    Signature,
    /// Ranking.
    Rank,
    /// Pose.
    Pose,
}

/// How a caller follows and stops an inspection.
pub trait Watch {
    /// A stage begins.
    fn begins(&self, _stage: Stage) {}
    /// True when the caller has lost interest.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody is watching.
pub struct Unwatched;

impl Watch for Unwatched {}

/// The caller cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the inspection was cancelled")]
pub struct Cancelled;

/// Inspects a scene: which enrolled part is it, and where?
///
/// With nothing enrolled or nothing found the inspection still holds what the stages before made.
pub fn run(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn Watch,
) -> Result<Inspection, Cancelled> {
    let clock = StageClock::start(watch);
    let segmentation = clock.time(Stage::Segment, || segment(scene, &recipe.segment))?;
    let mut inspection = Inspection {
        plane: None,
        contour: None,
        signature: None,
        ranking: MatchRanking::default(),
        pose: None,
        verdict: Verdict::NoPart(Unrecognisable::EmptyLibrary),
        timings: Timings::default(),
        segmentation,
    };
    let recognised = match inspection.segmentation.part.clone() {
        Ok(part) => recognise(&mut inspection, &part, scene, library, recipe, &clock)?,
        Err(no_part) => Err(no_part.into()),
    };
    inspection.verdict = match recognised {
        Ok(()) => verdict(&inspection, recipe),
        Err(reason) => Verdict::NoPart(reason),
    };
    inspection.timings = clock.finish();
    Ok(inspection)
}

/// The stages after segmentation; each leaves its result in the inspection.
fn recognise(
    inspection: &mut Inspection,
    part: &SegmentedPart,
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    clock: &StageClock<'_>,
) -> Result<Result<(), Unrecognisable>, Cancelled> {
    let plane = match clock.time(Stage::Project, || project(part, &recipe.project))? {
        Ok(plane) => inspection.plane.insert(plane),
        Err(error) => return Ok(Err(error.into())),
    };
    let contour = match clock.time(Stage::Contour, || find_contour(plane, &recipe.contour))? {
        Ok(contour) => inspection.contour.insert(contour),
        Err(error) => return Ok(Err(error.into())),
    };
    let signature = match clock.time(Stage::Signature, || describe(contour, &recipe.signature))? {
        Ok(signature) => inspection.signature.insert(signature),
        Err(error) => return Ok(Err(error.into())),
    };
    let query = Query {
        plane,
        contour,
        signature,
    };
    let references = &library.references;
    inspection.ranking = clock.time(Stage::Rank, || rank(&query, references, &recipe.rank))?;
    let Some(first) = inspection.ranking.entries.first() else {
        return Ok(Err(Unrecognisable::EmptyLibrary));
    };
    match recipe.pose {
        PoseChoice::Skip => {}
        PoseChoice::By(PoseMethod::Icp) => {
            let reference = &references[first.reference];
            let locate = || locate_by_icp(part, reference, scene, &recipe.icp);
            let pose = clock.time(Stage::Pose, locate)?;
            // The order is the matcher's; what the first is worth shows at its pose.
            for entry in &mut inspection.ranking.entries {
                entry.score *= UNCONFIRMED;
            }
            inspection.ranking.entries[0].score = pose.as_ref().map_or(0.0, |p| p.fit.score());
            inspection.pose = Some(pose);
        }
        PoseChoice::By(PoseMethod::Global) => {
            let mut ranking = std::mem::take(&mut inspection.ranking);
            let mut params = recipe.confirm.clone();
            if recipe.rank.matcher == Matcher::Paper {
                // The paper's choice stands: only that one is put in its place.
                params.num_references = 1;
                let first = &mut ranking.entries[0];
                first.placements = place(&query, &references[first.reference], &recipe.rank);
            }
            let scene = Scene { scene, part, query };
            let (ranking, pose) = clock.time(Stage::Pose, || {
                confirm(&scene, references, ranking, &params)
            })?;
            inspection.ranking = ranking;
            inspection.pose = Some(pose);
        }
    }
    Ok(Ok(()))
}

fn verdict(inspection: &Inspection, recipe: &Recipe) -> Verdict {
    let Some(best) = inspection.ranking.entries.first() else {
        return Verdict::NoPart(Unrecognisable::EmptyLibrary);
    };
    let accept = &recipe.accept;
    let next = inspection.ranking.entries.get(1);
    let margin = best.score - next.map_or(0.0, |n| n.score);
    let part = best.part.clone();
    let rejected = match (&inspection.pose, next) {
        (Some(Err(error)), _) => Some(Rejection::NoPose(*error)),
        (None, _) if recipe.rank.matcher == Matcher::Paper => {
            Some(Rejection::Unconfirmed { part: part.clone() })
        }
        _ if best.score < accept.min_score => Some(Rejection::LowScore {
            part: part.clone(),
            score: best.score,
            threshold: accept.min_score,
        }),
        (_, Some(next)) if margin < accept.min_margin => Some(Rejection::SmallMargin {
            part: part.clone(),
            other: next.part.clone(),
            margin,
            threshold: accept.min_margin,
        }),
        _ => None,
    };
    Verdict::Part {
        part,
        score: best.score,
        margin,
        rejected,
    }
}

/// Times stages, tells the watch about them and stops between them when cancelled.
struct StageClock<'a> {
    watch: &'a dyn Watch,
    started: Instant,
    timings: std::cell::Cell<Timings>,
}

impl<'a> StageClock<'a> {
    fn start(watch: &'a dyn Watch) -> Self {
        Self {
            watch,
            started: Instant::now(),
            timings: std::cell::Cell::default(),
        }
    }

    fn time<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> Result<T, Cancelled> {
        if self.watch.is_cancelled() {
            return Err(Cancelled);
        }
        self.watch.begins(stage);
        let begun = Instant::now();
        let output = work();
        let mut timings = self.timings.get();
        *match stage {
            Stage::Segment => &mut timings.segment,
            Stage::Project => &mut timings.project,
            Stage::Contour => &mut timings.contour,
            Stage::Signature => &mut timings.signature,
            Stage::Rank => &mut timings.rank,
            Stage::Pose => &mut timings.pose,
        } = begun.elapsed();
        self.timings.set(timings);
        Ok(output)
    }

    fn finish(&self) -> Timings {
        Timings {
            total: self.started.elapsed(),
            ..self.timings.get()
        }
    }
}
