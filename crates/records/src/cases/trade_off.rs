//! The cost of a threshold on the score: raising it refuses more parts, lowering it accepts more wrong ones.
//!
//! Known limit: only the score counts here; the verdict's other rules (margin, mirror image, a piece only) refuse more.

use serde::Serialize;

use super::judge::{CaseResult, Truth};

/// Steps from threshold 0 to 1.
const NUM_STEPS: usize = 50;

/// The counts at one threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThresholdCounts {
    /// The least score that is accepted.
    pub threshold: f64,
    /// Number of cases that would be accepted as another part.
    pub num_wrong_accepted: usize,
    /// Number of enrolled parts that would not be accepted under their name.
    pub num_refused: usize,
}

/// False accepts and wrong refusals over all thresholds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TradeOff {
    /// Number of cases.
    pub num_cases: usize,
    /// Number of cases that show an enrolled part.
    pub num_enrolled: usize,
    /// The counts by threshold, from 0 to 1.
    pub steps: Vec<ThresholdCounts>,
}

impl TradeOff {
    /// Counts these results at every threshold.
    pub fn of<'a>(results: impl IntoIterator<Item = &'a CaseResult>) -> Self {
        let guesses: Vec<BestMatch> = results.into_iter().map(BestMatch::of).collect();
        let step = |index: usize| {
            let threshold = index as f64 / NUM_STEPS as f64;
            let is_accepted = |guess: &&BestMatch| guess.score.is_some_and(|s| s >= threshold);
            let accepted = || guesses.iter().filter(is_accepted);
            let num_right = accepted().filter(|guess| guess.is_right).count();
            ThresholdCounts {
                threshold,
                num_wrong_accepted: accepted().count() - num_right,
                num_refused: num_enrolled(&guesses) - num_right,
            }
        };
        Self {
            num_cases: guesses.len(),
            num_enrolled: num_enrolled(&guesses),
            steps: (0..=NUM_STEPS).map(step).collect(),
        }
    }
}

fn num_enrolled(guesses: &[BestMatch]) -> usize {
    guesses.iter().filter(|guess| guess.is_enrolled).count()
}

/// A best guess, accepted or not.
struct BestMatch {
    /// `None` if nothing was recognised.
    score: Option<f64>,
    is_right: bool,
    is_enrolled: bool,
}

impl BestMatch {
    fn of(result: &CaseResult) -> Self {
        Self {
            score: result.found.part.as_ref().and(result.found.score),
            is_right: result.is_guess_right() == Some(true),
            is_enrolled: matches!(result.truth, Truth::Part(_)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::FoundVerdict;
    use inspection::pipeline::Timings;

    fn result(truth: Truth, part: Option<&str>, score: f64) -> CaseResult {
        CaseResult {
            name: "case".into(),
            difficulty: None,
            truth,
            found: FoundVerdict {
                part: part.map(Into::into),
                score: part.map(|_| score),
                ..FoundVerdict::default()
            },
            pose_error: None,
            timings: Timings::default(),
        }
    }

    #[test]
    fn a_higher_threshold_refuses_more_and_accepts_less_that_is_wrong() {
        let door = || Truth::Part("door".into());
        let results = [
            result(door(), Some("door"), 0.9),
            result(door(), Some("door"), 0.5),
            result(door(), Some("hood"), 0.7),
            result(Truth::NotEnrolled, Some("door"), 0.3),
            result(Truth::Nothing, None, 0.0),
        ];
        let trade_off = TradeOff::of(&results);
        assert_eq!((trade_off.num_cases, trade_off.num_enrolled), (5, 3));
        let at = |threshold: f64| {
            let step = trade_off.steps.iter().find(|s| s.threshold >= threshold);
            step.map(|s| (s.num_wrong_accepted, s.num_refused))
        };
        assert_eq!(at(0.0), Some((2, 1)));
        assert_eq!(at(0.4), Some((1, 1)));
        assert_eq!(at(0.6), Some((1, 2)));
        assert_eq!(at(0.8), Some((0, 2)));
        assert_eq!(at(1.0), Some((0, 3)));
    }

    #[test]
    fn no_case_costs_nothing() {
        let none = TradeOff::of(&[]);
        assert!(
            none.steps
                .iter()
                .all(|s| s.num_refused + s.num_wrong_accepted == 0)
        );
    }
}
