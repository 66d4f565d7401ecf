//! The true label of a case, the verdict, and whether the two agree.

use serde::{Deserialize, Serialize};

use crate::history::{Record, StoredVerdict};
use geometry::rigid::PoseDelta;
pub use inspection::library::Truth;
use inspection::pipeline::{Timings, Verdict};
use texts::{Described, Message};

/// A verdict as cases store it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundVerdict {
    /// The best guess; `None` if nothing could be recognised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// The guess's score, 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// The guess's margin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// True if the best guess was accepted.
    pub accepted: bool,
    /// Why the guess was not accepted.
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
            reason: detail.refusal.as_ref().map(ToString::to_string),
        }
    }
}

impl FoundVerdict {
    /// Returns the accepted part, or the refusal.
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
        // A high score alone does not explain the refusal.
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
    /// A part of this name was accepted.
    Part(String),
    /// The part was not accepted, or nothing was found: the robot does not move.
    NotAccepted,
}

/// Whether an answer is right, from best to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseOutcome {
    /// An enrolled part was accepted under its name, or anything else was refused.
    Right,
    /// An enrolled part was refused.
    Refused,
    /// Another part was accepted: the robot would paint it wrongly.
    WrongAccepted,
}

impl CaseOutcome {
    /// Compares an answer with the true label.
    pub fn new(truth: &Truth, answered: &CaseAnswer) -> Self {
        match (truth, answered) {
            (Truth::Part(is), CaseAnswer::Part(found)) if is == found => Self::Right,
            (_, CaseAnswer::Part(_)) => Self::WrongAccepted,
            (Truth::Part(_), CaseAnswer::NotAccepted) => Self::Refused,
            (Truth::NotEnrolled | Truth::Nothing, CaseAnswer::NotAccepted) => Self::Right,
        }
    }
}

impl Described for CaseOutcome {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::Right => "outcome-right",
            Self::Refused => "outcome-refused",
            Self::WrongAccepted => "outcome-wrong-accepted",
        })
    }
}

texts::display!(CaseOutcome);

/// The result of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseResult {
    /// The case's folder name.
    pub name: String,
    /// See [`CaseDescription::difficulty`](super::CaseDescription::difficulty).
    pub difficulty: Option<String>,
    /// The true label.
    pub truth: Truth,
    /// The verdict.
    pub found: FoundVerdict,
    /// Pose error, with the shift at the middle of the part; only for a right guess whose true pose is known.
    pub pose_error: Option<PoseDelta>,
    /// Times of the stages.
    pub timings: Timings,
}

impl CaseResult {
    /// Compares the answer with the true label.
    pub fn judgement(&self) -> CaseOutcome {
        CaseOutcome::new(&self.truth, &self.found.answered())
    }

    /// Returns true if the best guess, accepted or not, is right; `None` without a guess.
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
            assert_eq!(CaseOutcome::new(&truth, answered), expected, "{truth:?}");
        }
        let guess = FoundVerdict {
            part: Some("door".into()),
            ..FoundVerdict::default()
        };
        assert_eq!(guess.answered(), CaseAnswer::NotAccepted);
    }
}
