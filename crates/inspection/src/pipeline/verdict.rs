//! The verdict on a scene, and how it follows from the evidence.

use super::{
    Expected, Inspection, Recipe,
    refusal::Refusal,
    rejection::{Rejection, Unrecognisable, is_like},
};
use geometry::{error::Advice as _, units::Metres};
use stages::{
    confirm::{ConfirmedMatch, ConfirmedRanking, Evidence},
    pose::{PoseError, PoseEstimate},
    rank::Matcher,
};

/// Limits for accepting a verdict.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct AcceptParams {
    /// Least score, 0..1. Raising it turns wrong verdicts into rejections, and some right ones too.
    pub min_score: f64,
    /// Least lead over the next part of another name, and over another pose of the same part, 0..1. The lead is the
    /// difference of their probabilities, given that only one of the two can be right: 0.6 means four times as
    /// probable.
    pub min_margin: f64,
    /// A best guess that scores below this, 0..1, is reported as unknown. Raising it names fewer parts that are half
    /// hidden.
    pub unknown_below: f64,
    /// Least likeness, 0..1, at which a part that is not enrolled is reported as another make of an enrolled one.
    /// Raising it reports more such parts as unknown, and fewer other things as parts.
    pub min_likeness: f64,
    /// How far the surface may bulge or sink from the reference's, 0.5..20 mm root mean square beyond the noise; more
    /// is another model of the part. Raising it accepts other models too, with an approximate pose.
    pub max_relief: Metres,
    /// Share of the reference that may be missing because the camera sees past it, 0.001..0.1; more is another model
    /// of the part, of another size. Raising it accepts other models too, with an approximate pose.
    pub max_missing: f64,
    /// How far stretches of the outline may lie off the reference's, 2..20 mm root mean square; more is another model
    /// of the part. Raising it accepts other models too, with an approximate pose.
    pub max_outline_shift: Metres,
    /// Largest 95 % bound of the translation error, 2..50 mm. Raising it accepts less certain poses: of pieces cut out of real
    /// frames, 15 of the 26 with a bound above 11 mm were off by more than 20 mm, along an edge or a smooth sheet.
    pub max_uncertainty: Metres,
}

impl Default for AcceptParams {
    fn default() -> Self {
        Self {
            min_score: 0.9,
            min_margin: 0.6,
            unknown_below: 0.5,
            min_likeness: 0.6,
            max_relief: Metres::from_mm(4.0),
            max_missing: 0.008,
            max_outline_shift: Metres::from_mm(10.0),
            max_uncertainty: Metres::from_mm(11.0),
        }
    }
}

/// The verdict on a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// A surface was found; this is the best guess for it.
    Part {
        /// Name of the best match.
        part: String,
        /// Its score, 0..1.
        score: f64,
        /// Lead over the next part, 0..1: the difference of their probabilities, given that only one can hang there.
        margin: f64,
        /// Why it is not accepted; `None` if it is.
        rejected: Option<Rejection>,
        /// True if by its shape it may be another model of the part, so that its pose is only approximate.
        is_approximate: bool,
    },
    /// Nothing could be recognised.
    NoPart(Unrecognisable),
}

impl Verdict {
    /// Name of the best guess, accepted or not; of a mirror image, the part that it is the image of. `None` if there is no
    /// part.
    pub fn guess(&self) -> Option<&str> {
        match self {
            Self::Part { part, rejected, .. } => {
                let image_of = rejected.as_ref().and_then(Rejection::image_of);
                Some(image_of.unwrap_or(part))
            }
            Self::NoPart(_) => None,
        }
    }

    /// Score and margin of the best guess.
    pub fn score(&self) -> Option<[f64; 2]> {
        match self {
            Self::Part { score, margin, .. } => Some([*score, *margin]),
            Self::NoPart(_) => None,
        }
    }

    /// Why the verdict is not accepted, and what to do; `None` if it is.
    pub fn complaint(&self) -> Option<[String; 2]> {
        let why = self.refusal()?;
        Some([why.to_string(), why.advice()])
    }

    /// Why the verdict is not accepted, with figures; `None` if it is.
    pub fn refusal(&self) -> Option<Refusal> {
        match self {
            Self::Part { rejected, .. } => rejected.clone().map(Refusal::Rejected),
            Self::NoPart(why) => Some(Refusal::Unrecognisable(why.clone())),
        }
    }

    /// Why the best guess is not accepted; `None` also if there is no part.
    pub fn rejected(&self) -> Option<&Rejection> {
        match self {
            Self::Part { rejected, .. } => rejected.as_ref(),
            Self::NoPart(_) => None,
        }
    }

    /// True if what hangs there is not enrolled, or fits only as a mirror image.
    pub fn is_unknown(&self) -> bool {
        matches!(self.rejected(), Some(Rejection::Unknown { .. })) || self.is_mirrored()
    }

    /// True if a part can be named, accepted or not: something unknown that is like no enrolled part has no name, and its
    /// pose belongs to nothing.
    pub fn is_named(&self) -> bool {
        match self {
            Self::Part {
                score,
                rejected: Some(Rejection::Unknown { .. }),
                ..
            } => is_like(*score),
            Self::Part { .. } => true,
            Self::NoPart(_) => false,
        }
    }

    /// True if it fits an enrolled part only as its mirror image.
    pub fn is_mirrored(&self) -> bool {
        self.rejected().and_then(Rejection::image_of).is_some()
    }

    /// True if it resembles an enrolled part: another model or make of it, or its mirror image.
    pub(super) fn is_likeness(&self) -> bool {
        matches!(
            self.rejected(),
            Some(Rejection::AnotherModel { .. } | Rejection::AnotherMake { .. })
        ) || self.is_mirrored()
    }

    /// True if it may be another model of the part, so that the pose is only approximate.
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

impl Inspection {
    /// Returns the pose of the first reference, if one was asked for and found.
    pub fn found_pose(&self) -> Option<&PoseEstimate> {
        self.pose.as_ref()?.as_ref().ok()
    }
}

/// Derives the verdict from the ranking and the pose.
pub(super) fn verdict(
    ranking: &ConfirmedRanking,
    pose: Option<&Result<PoseEstimate, PoseError>>,
    recipe: &Recipe,
) -> Verdict {
    let Some(best) = ranking.entries.first() else {
        return Verdict::NoPart(Unrecognisable::EmptyLibrary);
    };
    let accept = &recipe.accept;
    let (margin, next) = margin(best, ranking, &recipe.expected);
    let unlike = best.evidence.map_or(0.0, |e| model_deviation(&e, accept));
    let other_model = best.evidence.filter(|_| unlike > 1.0);
    let found = pose.and_then(|pose| pose.as_ref().ok());
    let uncertainty = found.and_then(|pose| pose.uncertainty);
    let lead_over_rival = lead(best.score, best.rival);
    let freedom = uncertainty.and_then(|uncertainty| uncertainty.freedom);
    let too_uncertain = uncertainty.filter(|found| found.shift > accept.max_uncertainty);
    let rejected = match pose {
        Some(Err(error)) => Some(Rejection::NoPose(*error)),
        None if recipe.rank.matcher == Matcher::Paper => Some(Rejection::Unconfirmed {
            part: best.part.clone(),
        }),
        _ if best.score < accept.min_score => Some(too_low(best, accept)),
        _ if margin < accept.min_margin => next.map(|next| Rejection::SmallMargin {
            part: best.part.clone(),
            other: next.part.clone(),
            margin,
            threshold: accept.min_margin,
        }),
        Some(_) if lead_over_rival < accept.min_margin => Some(Rejection::AmbiguousPose {
            part: best.part.clone(),
            margin: lead_over_rival,
            threshold: accept.min_margin,
        }),
        _ if freedom.is_some() => freedom.map(|freedom| Rejection::Unconstrained {
            part: best.part.clone(),
            freedom,
        }),
        _ if too_uncertain.is_some() => too_uncertain.map(|found| Rejection::Uncertain {
            part: best.part.clone(),
            shift: found.shift,
            limit: accept.max_uncertainty,
            frames_disagree: false,
        }),
        _ => other_model.map(|evidence| Rejection::AnotherModel {
            part: best.part.clone(),
            relief: Metres(evidence.relief_m),
            outline: Metres(evidence.outline_shift_m.unwrap_or(0.0)),
            missing: evidence.missing,
        }),
    };
    // With wrong numbers of the camera the part looks like another model, or its pose uncertain: they come first, lest
    // somebody enrols what they show.
    let off_scale = found.and_then(PoseEstimate::off_scale);
    let rejected = match (rejected, off_scale) {
        (
            Some(
                Rejection::AnotherModel { .. }
                | Rejection::AnotherMake { .. }
                | Rejection::Uncertain { .. }
                | Rejection::LowScore { .. },
            ),
            Some(off),
        ) => Some(Rejection::OffScale {
            part: best.part.clone(),
            off,
        }),
        (rejected, _) => rejected,
    };
    Verdict::Part {
        part: best.part.clone(),
        score: best.score,
        margin,
        rejected,
        is_approximate: other_model.is_some()
            || best
                .evidence
                .is_some_and(|evidence| may_be_another_model(&evidence, accept)),
    }
}

/// The least lead over a part of another name, 0..1, and that part.
///
/// A part that is not expected is compared with an expected one more closely. Only then: where nothing is expected, a part
/// of which a twin is enrolled is refused rather than taken for its twin in a few ties of a thousand.
fn margin<'a>(
    best: &ConfirmedMatch,
    ranking: &'a ConfirmedRanking,
    expected: &Expected,
) -> (f64, Option<&'a ConfirmedMatch>) {
    let others = ranking.by_part().skip(1).map(|other| {
        let closer = match (&best.evidence, &other.evidence) {
            (Some(own), Some(others)) if expected.prefers(&best.part, &other.part) => {
                own.lead_over(others)
            }
            _ => None,
        };
        let lead = lead(best.score, other.score);
        (closer.map_or(lead, |closer| closer.max(lead)), other)
    });
    let rival = others.min_by(|(a, _), (b, _)| a.total_cmp(b));
    // For a mirror image, the part that it mirrors comes first, even if another one scores higher.
    match rival {
        Some((lead, rival)) => (lead.max(0.0), Some(rival)),
        None => (lead(best.score, 0.0).max(0.0), None),
    }
}

/// Difference of the probabilities of two candidates of which only one can be right, from the probability of each
/// alone.
fn lead(score: f64, next: f64) -> f64 {
    let odds = |score: f64| score / (1.0 - score).max(f64::EPSILON);
    let (first, second) = (odds(score), odds(next));
    (first - second) / (1.0 + first + second)
}

/// Largest deviation from the reference as a share of its limit; above 1 it is another model of the part.
pub(super) fn model_deviation(evidence: &Evidence, accept: &AcceptParams) -> f64 {
    let outline = evidence.outline_shift_m.unwrap_or(0.0) / accept.max_outline_shift.0;
    let surface = surface_deviations(evidence, accept);
    surface.into_iter().fold(outline, f64::max)
}

/// Relief and missing surface as shares of their limits.
fn surface_deviations(evidence: &Evidence, accept: &AcceptParams) -> [f64; 2] {
    // The rim is known to a few millimetres only, and a smaller piece has more rim for its area.
    let in_sight = (1.0 - evidence.outside) * (1.0 - evidence.hidden);
    [
        evidence.relief_m / accept.max_relief.0,
        evidence.missing / accept.max_missing * in_sight.sqrt(),
    ]
}

/// Mean share above which a pose is approximate. Three in five of the other models that are accepted exceed it; of
/// the enrolled parts, one in nine real frames and one in a hundred simulated ones.
const APPROXIMATE_MIN_SHARE: f64 = 0.5;
/// Limit of the outline's median shift, as a share of the limit of its root mean square. The median is about 2 mm for
/// enrolled parts and 4 mm for other models.
const MEDIAN_LIMIT_SHARE: f64 = 0.3;

/// True if an accepted part may still be another model: relief, missing surface and outline exceed half of their
/// limits on average.
///
/// A single one means little. In real frames, single stretches of the outline are off by centimetres and up to 1 % of
/// the surface is missing at the right pose; another model differs all round, and in more than one way.
fn may_be_another_model(evidence: &Evidence, accept: &AcceptParams) -> bool {
    let median_limit = MEDIAN_LIMIT_SHARE * accept.max_outline_shift.0;
    let outline = evidence.outline_median_m.map(|shift| shift / median_limit);
    let surface = surface_deviations(evidence, accept);
    let shares: Vec<f64> = surface.into_iter().chain(outline).collect();
    shares.iter().sum::<f64>() > APPROXIMATE_MIN_SHARE * shares.len() as f64
}

/// Score above which a part that is hardly seen fits well enough to be named.
const HARDLY_SEEN_MIN_SCORE: f64 = 0.3;
/// Share hidden or beyond the picture from which a part counts as a piece.
const PIECE_MIN_UNSEEN_SHARE: f64 = 0.05;

/// The reason for a score that is too low: the part is not enrolled, or too little of it is in sight.
fn too_low(best: &ConfirmedMatch, accept: &AcceptParams) -> Rejection {
    let (part, score, threshold) = (best.part.clone(), best.score, accept.min_score);
    match best.evidence {
        Some(evidence) if !evidence.is_seen() && score > HARDLY_SEEN_MIN_SCORE => {
            Rejection::HardlySeen { part, score }
        }
        Some(evidence)
            if score < accept.unknown_below && evidence.likeness() >= accept.min_likeness =>
        {
            Rejection::AnotherMake {
                part,
                likeness: evidence.likeness(),
            }
        }
        Some(_) if score < accept.unknown_below => Rejection::Unknown {
            nearest: part,
            score,
        },
        Some(Evidence {
            hidden, outside, ..
        }) if hidden + outside >= PIECE_MIN_UNSEEN_SHARE => Rejection::Piece {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lead_is_the_difference_of_probabilities_of_which_one_is_right() {
        // Without a rival the lead is the score.
        assert!((lead(0.97, 0.0) - 0.97).abs() < 1e-12);
        assert!(lead(0.9, 0.9).abs() < 1e-12);
        // Odds of 32 and 9 to 1: the first is right three times in four.
        assert!((lead(0.97, 0.9) - (32.333 - 9.0) / 42.333).abs() < 1e-4);
        assert!(lead(1.0, 0.99) > 0.99);
        assert!(lead(0.5, 0.9) < 0.0);
    }

    #[test]
    fn something_unknown_is_named_only_if_it_is_like_an_enrolled_part() {
        let found = |score, rejected| Verdict::Part {
            part: "fender".into(),
            score,
            margin: 0.0,
            rejected,
            is_approximate: false,
        };
        let unknown = |score| {
            let nearest = "fender".into();
            found(score, Some(Rejection::Unknown { nearest, score }))
        };
        assert!(!unknown(0.01).is_named() && unknown(0.05).is_named());
        assert!(found(0.97, None).is_named());
        assert!(!Verdict::NoPart(Unrecognisable::EmptyLibrary).is_named());
    }

    /// A good fit of a whole part, with these shares of the limits: relief, missing, and median of the outline.
    fn evidence(relief: f64, missing: f64, median: Option<f64>) -> Evidence {
        let accept = AcceptParams::default();
        let limit = accept.max_outline_shift.0;
        Evidence {
            off: 0.0,
            beyond: 0.0,
            seen_m2: 0.5,
            edge_m: 3.0,
            missing: missing * accept.max_missing,
            hidden: 0.0,
            outside: 0.0,
            relief_m: relief * accept.max_relief.0,
            outline_m: 0.003,
            // Single stretches are off by centimetres.
            outline_shift_m: median.map(|_| 0.95 * limit),
            outline_median_m: median.map(|share| share * MEDIAN_LIMIT_SHARE * limit),
            cut: 0.0,
            facing: 1.0,
            shape: 1.0,
            close: None,
        }
    }

    #[test]
    fn a_pose_is_approximate_by_several_differences_and_not_by_one() {
        let accept = AcceptParams::default();
        let is = |relief, missing, median| {
            let evidence = evidence(relief, missing, median);
            assert!(model_deviation(&evidence, &accept) <= 1.0, "{evidence:?}");
            may_be_another_model(&evidence, &accept)
        };
        assert!(!is(0.0, 0.0, Some(0.6)), "single stretches are off");
        assert!(!is(0.0, 0.95, Some(0.5)), "a corner is missing");
        assert!(!is(0.95, 0.0, Some(0.5)), "it bulges");
        assert!(is(0.2, 0.5, Some(1.2)), "a little of each");
        assert!(is(0.0, 0.0, Some(1.6)), "the outline is off all round");
        // Without an outline the other two decide.
        assert!(!is(0.2, 0.7, None) && is(0.4, 0.7, None));
    }
}
