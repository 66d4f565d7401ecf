//! The verdict on a scene, and why it is not another.

use super::Recipe;
use crate::{
    error::Advice,
    stages::{
        confirm::Evidence,
        contour::ContourError,
        pose::{PoseError, PoseEstimate},
        project::ProjectError,
        rank::{MatchEntry, MatchRanking, Matcher},
        segment::NoPart,
        signature::SignatureError,
    },
    units::Metres,
};

/// When a verdict counts.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct AcceptParams {
    /// Least score, 0..1. Raising it turns wrong verdicts into rejections, and some right ones too.
    pub min_score: f64,
    /// Least lead over the next part of another name, 0..1.
    pub min_margin: f64,
    /// A best guess below this score, 0..1, is not named: what hangs there is more likely unknown. Raising it names
    /// fewer parts that are half hidden.
    pub unknown_below: f64,
    /// How far the surface may bulge or sink from the reference's, 0.5..20 mm root mean square beyond the noise; more
    /// is another model of the part. Raising it accepts other models too, at a pose that is only about right.
    pub max_relief: Metres,
    /// Share of the reference that the camera may look past, 0.001..0.1; more is another model of the part, of another
    /// size. Raising it accepts other models too, at a pose that is only about right.
    pub max_missing: f64,
    /// How far stretches of the outline may lie off the reference's, 2..20 mm root mean square; more is another model of
    /// the part. Raising it accepts other models too, at a pose that is only about right.
    pub max_outline_shift: Metres,
}

impl Default for AcceptParams {
    fn default() -> Self {
        Self {
            min_score: 0.9,
            min_margin: 0.05,
            unknown_below: 0.5,
            max_relief: Metres::from_mm(4.0),
            max_missing: 0.008,
            max_outline_shift: Metres::from_mm(10.0),
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
        /// True if it may be another model of the part, as far as its shape tells: its pose is then only about right.
        is_approximate: bool,
    },
    /// Nothing to recognise.
    NoPart(Unrecognisable),
}

impl Verdict {
    /// True if something hangs there that is nothing enrolled.
    pub fn is_unknown(&self) -> bool {
        let rejected = match self {
            Self::Part { rejected, .. } => rejected.as_ref(),
            Self::NoPart(_) => None,
        };
        matches!(
            rejected,
            Some(Rejection::Unknown { .. } | Rejection::Mirrored { .. })
        )
    }

    /// True if it may be another model of the part, so that the pose is only about right.
    pub fn is_approximate(&self) -> bool {
        matches!(
            self,
            Self::Part {
                is_approximate: true,
                ..
            }
        )
    }

    /// True if the part was named and accepted.
    pub fn is_accepted(&self) -> bool {
        matches!(self, Self::Part { rejected: None, .. })
    }
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
    /// Only a piece of it is seen, and that is too little.
    #[error(
        "only a piece of {part} is in sight ({:.0} % of it hidden, {:.0} % beyond the picture); it scores {score:.2}, below the threshold of {threshold:.2}",
        hidden * 100.0,
        outside * 100.0
    )]
    Piece {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
        /// Least score.
        threshold: f64,
        /// Share hidden by something nearer.
        hidden: f64,
        /// Share beyond the picture.
        outside: f64,
    },
    /// It would be seen too little to be told from something else.
    #[error("what may be {part} is hardly in sight: seen nearly edge-on, or cut off on most sides")]
    HardlySeen {
        /// Best match.
        part: String,
        /// Its score.
        score: f64,
    },
    /// Of its type, but of another car model.
    #[error(
        "it is like {part}, but not the same: its surface is off by {relief}, its outline by {outline}, and {:.1} % of it is missing; another model, the pose is approximate",
        missing * 100.0
    )]
    AnotherModel {
        /// Best match.
        part: String,
        /// Root mean square of how far patches of the surface are off.
        relief: Metres,
        /// Root mean square of how far stretches of the outline are off.
        outline: Metres,
        /// Share of the reference that is not there, 0..1.
        missing: f64,
    },
    /// Nothing enrolled is like it.
    #[error("unknown: nothing enrolled is like it; the nearest, {nearest}, scores {score:.2}")]
    Unknown {
        /// Best match.
        nearest: String,
        /// Its score.
        score: f64,
    },
    /// Its mirror image is enrolled.
    #[error(
        "it looks like the mirror image of {part} (which scores {score:.2}): the part of the other side of the car"
    )]
    Mirrored {
        /// The part whose mirror image it looks like.
        part: String,
        /// How well the mirror image fits.
        score: f64,
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
    /// It moves, or moved a moment ago.
    #[error("{part} does not hang still yet")]
    NotSteady {
        /// Best match.
        part: String,
    },
    /// It hangs still, and too few frames were seen since.
    #[error("{part} hangs still, and {num_frames} of {needed} frames were inspected since")]
    FewFrames {
        /// Best match.
        part: String,
        /// Frames so far.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// Frames of a scene that does not move say different things.
    #[error("{num_agreeing} of {num_frames} frames accept {part}, {needed} are needed")]
    Undecided {
        /// The part that most frames name.
        part: String,
        /// Frames that accept it.
        num_agreeing: usize,
        /// Frames in all.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
    /// Frames of a scene that does not move put the part in different places.
    #[error(
        "the poses of {part} lie together in {num_agreeing} of {num_frames} frames, {needed} are needed"
    )]
    PosesApart {
        /// The part.
        part: String,
        /// Frames whose poses lie together.
        num_agreeing: usize,
        /// Frames in all.
        num_frames: usize,
        /// Frames needed.
        needed: usize,
    },
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
            Self::Piece { .. } => {
                "Take away what stands before the part, or hang it further inside the picture, and capture again".into()
            }
            Self::HardlySeen { .. } => {
                "Turn the part so that its face looks at the camera, all of it inside the picture, and capture again".into()
            }
            Self::AnotherModel { part, .. } => format!(
                "If this one is to be painted too, enrol it as one more reference of {part}"
            ),
            Self::Unknown { .. } => {
                "Enrol the part if it is to be painted; if it is enrolled, turn its face to the camera and capture again".into()
            }
            Self::Mirrored { .. } => {
                "Enrol the part of this side under a name of its own, and do not paint it with the other side's path".into()
            }
            Self::Unconfirmed { .. } => "Have the pose estimated too, with --pose global".into(),
            Self::NoPose(error) => error.advice(),
            Self::NotSteady { .. } => "Let the part hang still for a second".into(),
            Self::FewFrames { .. } => "Wait a moment".into(),
            Self::Undecided { .. } => {
                "Wait a moment; if it stays so, turn the part's face to the camera and take away what stands before it".into()
            }
            Self::PosesApart { .. } => {
                "Hang the part so that nothing can swing, and wait a moment; if it stays so, turn its face to the camera".into()
            }
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
pub(super) fn verdict(
    ranking: &MatchRanking,
    pose: Option<&Result<PoseEstimate, PoseError>>,
    recipe: &Recipe,
) -> Verdict {
    let Some(best) = ranking.entries.first() else {
        return Verdict::NoPart(Unrecognisable::EmptyLibrary);
    };
    let accept = &recipe.accept;
    let next = ranking.runner_up();
    let margin = best.score - next.map_or(0.0, |n| n.score);
    let unlike = best.evidence.map_or(0.0, |e| unlikeness(&e, accept));
    let other_model = best.evidence.filter(|_| unlike > 1.0);
    let rejected = match (pose, best.evidence) {
        (Some(Err(error)), _) => Some(Rejection::NoPose(*error)),
        (None, _) if recipe.rank.matcher == Matcher::Paper => Some(Rejection::Unconfirmed {
            part: best.part.clone(),
        }),
        _ if best.score < accept.min_score => Some(too_low(best, accept)),
        _ if margin < accept.min_margin => next.map(|next| Rejection::SmallMargin {
            part: best.part.clone(),
            other: next.part.clone(),
            margin,
            threshold: accept.min_margin,
        }),
        _ => other_model.map(|evidence| Rejection::AnotherModel {
            part: best.part.clone(),
            relief: Metres(evidence.relief_m),
            outline: Metres(evidence.outline_shift_m.unwrap_or(0.0)),
            missing: evidence.missing,
        }),
    };
    Verdict::Part {
        part: best.part.clone(),
        score: best.score,
        margin,
        rejected,
        is_approximate: unlike > MAY_BE_ANOTHER,
    }
}

/// From this share of what another model is refused at, a pose is called approximate: four fifths of the other models
/// reach it, and one in thirty of the enrolled ones.
const MAY_BE_ANOTHER: f64 = 0.55;

/// How much speaks for a part of the same type that is not this one; above 1 it is one.
fn unlikeness(evidence: &Evidence, accept: &AcceptParams) -> f64 {
    let relief = evidence.relief_m / accept.max_relief.0;
    let missing = evidence.missing / accept.max_missing;
    let outline = evidence.outline_shift_m.unwrap_or(0.0) / accept.max_outline_shift.0;
    relief.max(missing).max(outline)
}

/// Of what is hardly seen, more than this score is a good fit.
const WORTH_NAMING: f64 = 0.3;
/// A piece is one of which at least this share is hidden or beyond the picture.
const PIECE: f64 = 0.05;

/// Why a score is too low: nobody knows the part, or too little of it is seen.
fn too_low(best: &MatchEntry, accept: &AcceptParams) -> Rejection {
    let (part, score, threshold) = (best.part.clone(), best.score, accept.min_score);
    match best.evidence {
        Some(evidence) if !evidence.is_seen() && score > WORTH_NAMING => {
            Rejection::HardlySeen { part, score }
        }
        Some(_) if score < accept.unknown_below => Rejection::Unknown {
            nearest: part,
            score,
        },
        Some(Evidence {
            hidden, outside, ..
        }) if hidden + outside >= PIECE => Rejection::Piece {
            part,
            score,
            threshold,
            hidden,
            outside,
        },
        _ => Rejection::LowScore {
            part,
            score,
            threshold,
        },
    }
}
