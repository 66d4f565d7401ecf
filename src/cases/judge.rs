//! What truly hangs there, what was found, and whether the two agree.

use serde::{Deserialize, Serialize};

pub use crate::library::Truth;
use crate::{
    geometry::rigid::PoseError,
    library::Library,
    pipeline::{self, Cancelled, Recipe, Timings, Verdict, Watch},
    stages::scene::SceneCloud,
};

/// What an inspection found, in short.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The best guess; `None` if nothing could be recognised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Its score, 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// Its lead over the next part's score.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Why not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl From<&Verdict> for Found {
    fn from(verdict: &Verdict) -> Self {
        match verdict {
            Verdict::Part {
                part,
                score,
                margin,
                rejected,
                ..
            } => Self {
                part: Some(part.clone()),
                score: Some(*score),
                margin: Some(*margin),
                accepted: rejected.is_none(),
                reason: rejected.as_ref().map(ToString::to_string),
            },
            Verdict::NoPart(reason) => Self {
                reason: Some(reason.to_string()),
                ..Self::default()
            },
        }
    }
}

impl Found {
    /// What it comes to for whoever waits for the answer.
    pub fn answered(&self) -> Answered {
        match &self.part {
            Some(part) if self.accepted => Answered::Part(part.clone()),
            _ => Answered::NotAccepted,
        }
    }
}

/// What a verdict comes to: an accepted part, or a refusal.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Answered {
    /// Accepted as the part of this name.
    Part(String),
    /// Not accepted, or nothing found: the robot stands still.
    NotAccepted,
}

/// Whether an answer is right; the later, the worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// The part was accepted as what it is, or what is no enrolled part was refused.
    Right,
    /// An enrolled part was refused.
    Refused,
    /// Accepted as something that it is not: the robot would paint it wrongly.
    WrongAccepted,
}

impl Judgement {
    /// Holds an answer against the truth.
    pub fn of(truth: &Truth, answered: &Answered) -> Self {
        match (truth, answered) {
            (Truth::Part(is), Answered::Part(found)) if is == found => Self::Right,
            (_, Answered::Part(_)) => Self::WrongAccepted,
            (Truth::Part(_), Answered::NotAccepted) => Self::Refused,
            (Truth::NotEnrolled | Truth::Nothing, Answered::NotAccepted) => Self::Right,
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Refused => "refused",
            Self::WrongAccepted => "wrong and accepted",
        }
    }
}

/// What came out of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseResult {
    /// The case's folder name.
    pub name: String,
    /// How hard it is, in free words.
    pub difficulty: Option<String>,
    /// What it truly is.
    pub truth: Truth,
    /// What was found.
    pub found: Found,
    /// How far the pose is off, the shift taken at the part's middle; only of a right guess whose true pose is known.
    pub pose_error: Option<PoseError>,
    /// How long the stages took.
    pub timings: Timings,
}

impl CaseResult {
    /// Whether the answer is right.
    pub fn judgement(&self) -> Judgement {
        Judgement::of(&self.truth, &self.found.answered())
    }

    /// Whether the best guess, accepted or not, is right; `None` without a guess.
    pub fn is_guess_right(&self) -> Option<bool> {
        let guess = self.found.part.as_deref()?;
        Some(self.truth.part() == Some(guess))
    }
}

/// What an inspection of the scene finds.
pub fn found_in(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn Watch,
) -> Result<Found, Cancelled> {
    let inspection = pipeline::run(scene, library, recipe, watch)?;
    Ok(Found::from(&inspection.verdict))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_accepted_wrong_part_is_wrong_and_accepted() {
        let door = || Truth::Part("door".into());
        let as_door = Answered::Part("door".into());
        let refused = Answered::NotAccepted;
        for (truth, answered, expected) in [
            (door(), &as_door, Judgement::Right),
            (door(), &refused, Judgement::Refused),
            (
                Truth::Part("hood".into()),
                &as_door,
                Judgement::WrongAccepted,
            ),
            (Truth::NotEnrolled, &as_door, Judgement::WrongAccepted),
            (Truth::NotEnrolled, &refused, Judgement::Right),
            (Truth::Nothing, &refused, Judgement::Right),
        ] {
            assert_eq!(Judgement::of(&truth, answered), expected, "{truth:?}");
        }
        let guess = Found {
            part: Some("door".into()),
            ..Found::default()
        };
        assert_eq!(guess.answered(), Answered::NotAccepted);
    }
}
