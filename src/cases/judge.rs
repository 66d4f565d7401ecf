//! The truth of a case, what an inspection found, and whether the two agree.

use serde::{Deserialize, Serialize};

pub use crate::library::Truth;
use crate::{
    geometry::rigid::PoseDelta,
    history::{Record, StoredVerdict},
    pipeline::{Timings, Verdict},
};

/// The verdict of an inspection, as cases store it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundVerdict {
    /// The best guess; `None` if nothing could be recognised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Its score, 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// Its margin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Whether the best guess was accepted.
    pub accepted: bool,
    /// Why it was not accepted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl From<&Verdict> for FoundVerdict {
    fn from(verdict: &Verdict) -> Self {
        Self {
            part: verdict.guess().map(str::to_owned),
            score: verdict.score().map(|[score, _]| score),
            margin: verdict.score().map(|[_, margin]| margin),
            accepted: verdict.is_accepted(),
            reason: verdict.complaint().map(|[why, _]| why),
        }
    }
}

impl From<&Record> for FoundVerdict {
    fn from(Record { summary, detail }: &Record) -> Self {
        Self {
            part: detail.nearest.clone(),
            score: summary.score.map(|[score, _]| score),
            margin: summary.score.map(|[_, margin]| margin),
            accepted: summary.verdict == StoredVerdict::Accepted,
            // With enrolled names, as in a verdict: the stored sentence has the titles of that time.
            reason: detail.refusal.as_ref().map(|refusal| {
                let why = refusal.why.as_ref();
                why.map_or_else(|| refusal.reason.clone(), ToString::to_string)
            }),
        }
    }
}

impl FoundVerdict {
    /// The accepted part, or the refusal.
    pub fn answered(&self) -> CaseAnswer {
        match &self.part {
            Some(part) if self.accepted => CaseAnswer::Part(part.clone()),
            _ => CaseAnswer::NotAccepted,
        }
    }

    /// In English, with the reason of a refusal.
    pub fn words(&self) -> String {
        let guess = match (&self.part, self.score) {
            (Some(part), Some(score)) if self.accepted => {
                return format!("accepted as {part} at {score:.2}");
            }
            (Some(part), Some(score)) => Some(format!("best guess {part} at {score:.2}")),
            _ => None,
        };
        // A high score alone does not say why it is refused.
        let words: Vec<String> = guess.into_iter().chain(self.reason.clone()).collect();
        if words.is_empty() {
            return "nothing found".into();
        }
        words.join(": ")
    }
}

/// An accepted part, or a refusal.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum CaseAnswer {
    /// Accepted as the part of this name.
    Part(String),
    /// Not accepted, or nothing found: the robot does not move.
    NotAccepted,
}

/// Whether an answer is right, from the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseOutcome {
    /// An enrolled part was accepted under its name, or anything else was refused.
    Right,
    /// An enrolled part was refused.
    Refused,
    /// Accepted as another part: the robot would paint it wrongly.
    WrongAccepted,
}

impl CaseOutcome {
    /// Compares an answer with the truth.
    pub fn of(truth: &Truth, answered: &CaseAnswer) -> Self {
        match (truth, answered) {
            (Truth::Part(is), CaseAnswer::Part(found)) if is == found => Self::Right,
            (_, CaseAnswer::Part(_)) => Self::WrongAccepted,
            (Truth::Part(_), CaseAnswer::NotAccepted) => Self::Refused,
            (Truth::NotEnrolled | Truth::Nothing, CaseAnswer::NotAccepted) => Self::Right,
        }
    }

    /// In English.
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Refused => "refused",
            Self::WrongAccepted => "false accept",
        }
    }
}

/// The result of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseResult {
    /// The case's folder name.
    pub name: String,
    /// See [`CaseDescription::difficulty`](super::CaseDescription::difficulty).
    pub difficulty: Option<String>,
    /// What it truly is.
    pub truth: Truth,
    /// What was found.
    pub found: FoundVerdict,
    /// Pose error, the shift at the middle of the part; only of a right guess whose true pose is known.
    pub pose_error: Option<PoseDelta>,
    /// Times of the stages.
    pub timings: Timings,
}

impl CaseResult {
    /// Whether the answer is right.
    pub fn judgement(&self) -> CaseOutcome {
        CaseOutcome::of(&self.truth, &self.found.answered())
    }

    /// Whether the best guess, accepted or not, is right; `None` without a guess.
    pub fn is_guess_right(&self) -> Option<bool> {
        let guess = self.found.part.as_deref()?;
        Some(self.truth.part() == Some(guess))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_accepted_wrong_part_is_wrong_and_accepted() {
        let door = || Truth::Part("door".into());
        let as_door = CaseAnswer::Part("door".into());
        let refused = CaseAnswer::NotAccepted;
        for (truth, answered, expected) in [
            (door(), &as_door, CaseOutcome::Right),
            (door(), &refused, CaseOutcome::Refused),
            (
                Truth::Part("hood".into()),
                &as_door,
                CaseOutcome::WrongAccepted,
            ),
            (Truth::NotEnrolled, &as_door, CaseOutcome::WrongAccepted),
            (Truth::NotEnrolled, &refused, CaseOutcome::Right),
            (Truth::Nothing, &refused, CaseOutcome::Right),
        ] {
            assert_eq!(CaseOutcome::of(&truth, answered), expected, "{truth:?}");
        }
        let guess = FoundVerdict {
            part: Some("door".into()),
            ..FoundVerdict::default()
        };
        assert_eq!(guess.answered(), CaseAnswer::NotAccepted);
    }
}
