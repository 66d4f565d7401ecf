//! The verdict on a scene, and why it is not another.

use super::{Inspection, Recipe};
use crate::{
    error::Advice,
    stages::{
        contour::ContourError, pose::PoseError, project::ProjectError, rank::Matcher,
        segment::NoPart, signature::SignatureError,
    },
};

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
                "Turn the part so that its face looks at the camera and capture again; if both names stand for the same part, \
                 remove one of them from the library"
                    .into()
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

/// What the results of all stages come to.
pub(super) fn verdict(inspection: &Inspection, recipe: &Recipe) -> Verdict {
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
