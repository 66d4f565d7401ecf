//! The whole inspection: every stage in order, every intermediate result kept, each stage timed.
//!
//! The window, the command line and the tests are three callers of [`run`].

use std::time::{Duration, Instant};

use crate::{
    error::Advice,
    library::Library,
    stages::{
        contour::{Contour, ContourError, ContourParams},
        pose::{PoseError, PoseEstimate, PoseMethod},
        project::{PlaneImage, ProjectError, ProjectParams},
        rank::{MatchRanking, Matcher, RankParams},
        scene::SceneCloud,
        segment::{NoPart, SegmentParams, Segmentation},
        signature::{FanSignature, SignatureError, SignatureParams},
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
    /// Acceptance.
    pub accept: AcceptParams,
    /// How the pose is estimated; `None` to stop after the ranking.
    pub pose: Option<PoseMethod>,
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
            min_score: 0.8,
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
