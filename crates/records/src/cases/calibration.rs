//! Calibration of the score: are nine in ten of the guesses with a score near 0.9 right?
//!
//! The guesses are sorted by score into bins of equal width. In each bin the share of right guesses is compared with the
//! mean score (the reliability diagram of M. H. DeGroot and S. E. Fienberg, "The Comparison and Evaluation of
//! Forecasters", The Statistician 32, 1983). The summary is the expected calibration error of M. P. Naeini, G. F.
//! Cooper and M. Hauskrecht, "Obtaining Well Calibrated Probabilities Using Bayesian Binning", AAAI 2015:
//! Σ |share right - mean score| · guesses in the bin / all guesses.
//!
//! Known limit: a bin with few guesses is not reliable, so each bin states their number.

use serde::Serialize;

use super::judge::CaseResult;

/// Number of bins between 0 and 1.
const NUM_BINS: usize = 10;

/// Guesses with scores in one range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ScoreBin {
    /// Lower end of the range, inclusive.
    pub from: f64,
    /// Upper end of the range; exclusive, except in the last bin.
    pub to: f64,
    /// Number of guesses.
    pub num: usize,
    /// Number of right guesses.
    pub num_right: usize,
    /// Mean score of the guesses; 0 without a guess.
    pub mean_score: f64,
}

impl ScoreBin {
    /// Returns the share of right guesses, 0..1; `None` without a guess.
    pub fn share_right(&self) -> Option<f64> {
        (self.num > 0).then(|| self.num_right as f64 / self.num as f64)
    }
}

/// How well the scores are calibrated.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Calibration {
    /// All bins, in ascending order.
    pub bins: Vec<ScoreBin>,
    /// Expected calibration error, 0..1; `None` without a guess.
    pub expected_error: Option<f64>,
}

impl Calibration {
    /// Bins the best guesses, accepted or not. The guess for a scene without an enrolled part is wrong.
    pub fn of<'a>(results: impl IntoIterator<Item = &'a CaseResult>) -> Self {
        let guesses = results.into_iter().filter_map(|result| {
            let score = result.found.score.filter(|score| score.is_finite())?;
            Some((score.clamp(0.0, 1.0), result.is_guess_right()?))
        });
        Self::of_guesses(guesses)
    }

    fn of_guesses(guesses: impl Iterator<Item = (f64, bool)>) -> Self {
        let edge = |bin: usize| bin as f64 / NUM_BINS as f64;
        let mut bins: Vec<ScoreBin> = (0..NUM_BINS)
            .map(|bin| ScoreBin {
                from: edge(bin),
                to: edge(bin + 1),
                ..ScoreBin::default()
            })
            .collect();
        for (score, is_right) in guesses {
            let index = ((score * NUM_BINS as f64) as usize).min(NUM_BINS - 1);
            let bin = &mut bins[index];
            bin.num += 1;
            bin.num_right += usize::from(is_right);
            // Holds the sum until all are counted.
            bin.mean_score += score;
        }
        let total: usize = bins.iter().map(|bin| bin.num).sum();
        let mut error = 0.0;
        for bin in &mut bins {
            if let Some(share) = bin.share_right() {
                bin.mean_score /= bin.num as f64;
                error += (share - bin.mean_score).abs() * bin.num as f64;
            }
        }
        Self {
            bins,
            expected_error: (total > 0).then(|| error / total as f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_that_are_right_as_often_as_they_say_have_no_error() {
        // Of the guesses at each score, the share that the score predicts is right, to the nearest whole number.
        let guesses = (0..20).flat_map(|step| {
            let score = (f64::from(step) + 0.5) / 20.0;
            (0..40).map(move |i| (score, f64::from(i) + 0.5 < score * 40.0))
        });
        let calibration = Calibration::of_guesses(guesses);
        assert!(calibration.bins.iter().all(|bin| bin.num == 80));
        assert!(calibration.expected_error.expect("guesses") < 1e-9);
    }

    #[test]
    fn the_error_is_the_mean_distance_weighted_by_guesses() {
        // Three at 1.0 of which one is wrong, and one at 0.25 that is right.
        let guesses = [(1.0, true), (1.0, false), (1.0, true), (0.25, true)];
        let calibration = Calibration::of_guesses(guesses.into_iter());
        let last = calibration.bins[9];
        assert_eq!((last.num, last.num_right), (3, 2));
        assert!((last.mean_score - 1.0).abs() < 1e-12);
        let expected = (3.0 * (1.0 / 3.0) + 0.75) / 4.0;
        let found = calibration.expected_error.expect("guesses");
        assert!((found - expected).abs() < 1e-12, "{found}");
    }

    #[test]
    fn every_score_is_in_exactly_one_bin_and_edges_belong_to_the_upper_one() {
        for (score, bin) in [(0.0, 0), (0.1, 1), (0.999, 9), (1.0, 9), (0.5, 5)] {
            let bins = Calibration::of_guesses([(score, true)].into_iter()).bins;
            let found: Vec<usize> = (0..10).filter(|&i| bins[i].num == 1).collect();
            assert_eq!(found, [bin], "{score}");
        }
        assert_eq!(
            Calibration::of_guesses(std::iter::empty()).expected_error,
            None
        );
    }
}
