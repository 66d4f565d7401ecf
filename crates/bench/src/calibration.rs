//! Fits the score: from the evidence for a reference to the probability that it is the right part at the right pose.
//!
//! Logistic regression with a small ridge penalty by Newton's method (D. R. Cox, "The regression analysis of binary
//! sequences", Journal of the Royal Statistical Society B 20(2), 1958). Every contender of every frame is one sample,
//! so an unknown object is evidence against each part that it resembles. A contender is right if its name is right and
//! its pose is within 5° and 40 mm. Parts of other car models are left out, since a camera cannot tell all of them from
//! the enrolled ones; parts of other makes are never right. The likeness is fitted in the same way: there a contender
//! is right if it is a whole part with the right name, of any model or make.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::suites::{Suite, SuiteResult};
use stages::confirm::{Evidence, FEATURES, TYPE_FEATURES};

/// Keeps the weights finite where the samples are perfectly separable.
const RIDGE: f64 = 1e-4;
/// Largest error of a right pose: degrees and millimetres.
const RIGHT_POSE: [f64; 2] = [5.0, 40.0];

/// The question whose answer a model gives the probability of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Is it this part at this pose? The score.
    Part,
    /// Is it a part of this type? The likeness.
    Type,
}

impl Question {
    /// Returns the names of the features.
    pub fn features(self) -> &'static [&'static str] {
        match self {
            Self::Part => &FEATURES,
            Self::Type => &TYPE_FEATURES,
        }
    }

    fn of(self, evidence: &Evidence) -> Vec<f64> {
        match self {
            Self::Part => evidence.features().to_vec(),
            Self::Type => evidence.type_features().to_vec(),
        }
    }
}

/// One contender of one frame.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Evidence for and against the contender.
    pub evidence: Evidence,
    /// True if the answer is yes.
    pub is_right: bool,
}

/// Collects the contenders of all frames; for [`Question::Type`] only the first of each frame, and only whole parts.
pub fn samples(results: &[SuiteResult], question: Question) -> Vec<Sample> {
    let of_suites = |is_used: fn(Suite) -> bool| {
        let used = results.iter().filter(move |result| is_used(result.suite));
        used.flat_map(|result| result.cases.iter().map(|case| (result.suite, case)))
    };
    match question {
        Question::Part => of_suites(|suite| suite != Suite::OtherModels)
            .flat_map(|(suite, case)| case.contenders.iter().map(move |c| (suite, c)))
            .map(|(suite, contender)| Sample {
                evidence: contender.evidence,
                is_right: !matches!(suite, Suite::OtherMakes | Suite::NoisyMakes)
                    && contender
                        .pose_off
                        .is_some_and(|off| off[0] <= RIGHT_POSE[0] && off[1] <= RIGHT_POSE[1]),
            })
            .collect(),
        // The mirror image of a part is of its type too; it is detected by other means.
        Question::Type => of_suites(|suite| suite != Suite::Mirrored)
            .filter_map(|(_, case)| {
                let first = case.contenders.first()?;
                let is_whole = !first.evidence.is_piece();
                is_whole.then(|| Sample {
                    evidence: first.evidence,
                    is_right: case.expected.as_ref() == Some(&first.part),
                })
            })
            .collect(),
    }
}

/// A fitted logistic model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Model {
    /// The question it answers.
    pub question: Question,
    /// Intercept.
    pub constant: f64,
    /// One weight per feature.
    pub weights: Vec<f64>,
}

impl Model {
    /// Fits a model with the features that are switched on.
    pub fn fit(samples: &[Sample], question: Question, is_on: &[bool]) -> Self {
        let size = is_on.len() + 1;
        let row = |sample: &Sample| {
            let features = question.of(&sample.evidence);
            let on = features.iter().zip(is_on);
            let on = on.map(|(x, is_on)| if *is_on { *x } else { 0.0 });
            DVector::from_iterator(size, std::iter::once(1.0).chain(on))
        };
        let mut weights = DVector::<f64>::zeros(size);
        for _ in 0..50 {
            let mut gradient = -&weights * RIDGE * samples.len() as f64;
            gradient[0] = 0.0;
            let mut hessian = DMatrix::<f64>::identity(size, size) * (RIDGE * samples.len() as f64);
            for sample in samples {
                let x = row(sample);
                let p = logistic(weights.dot(&x));
                gradient += &x * (f64::from(u8::from(sample.is_right)) - p);
                hessian += &x * x.transpose() * (p * (1.0 - p));
            }
            let Some(step) = hessian.cholesky().map(|c| c.solve(&gradient)) else {
                break;
            };
            weights += &step;
            if step.norm() < 1e-8 {
                break;
            }
        }
        Self {
            question,
            constant: weights[0],
            weights: weights.iter().skip(1).copied().collect(),
        }
    }

    /// Returns the probability of being right.
    pub fn probability(&self, evidence: &Evidence) -> f64 {
        let features = self.question.of(evidence);
        let sum: f64 = self.weights.iter().zip(features).map(|(w, x)| w * x).sum();
        logistic(self.constant + sum)
    }

    /// Returns the mean of -ln(probability of the true answer) over the samples.
    pub fn log_loss(&self, samples: &[Sample]) -> f64 {
        let loss = samples.iter().map(|sample| {
            let p = self.probability(&sample.evidence);
            let p = if sample.is_right { p } else { 1.0 - p };
            -p.max(1e-9).ln()
        });
        loss.sum::<f64>() / samples.len().max(1) as f64
    }

    /// Counts the wrong samples at or above a threshold, and the right ones below it.
    pub fn errors(&self, samples: &[Sample], threshold: f64) -> [usize; 2] {
        let mut errors = [0; 2];
        for sample in samples {
            let is_above = self.probability(&sample.evidence) >= threshold;
            match (sample.is_right, is_above) {
                (false, true) => errors[0] += 1,
                (true, false) => errors[1] += 1,
                _ => {}
            }
        }
        errors
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// The verdicts whose score falls into one band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ScoreBand {
    /// Lower end of the band.
    pub from: f64,
    /// Mean score in the band.
    pub mean_score: f64,
    /// Number of best guesses in the band.
    pub num: usize,
    /// Number of right ones among them.
    pub num_right: usize,
}

/// Counts how often the best guesses were right, by score. The score is calibrated if that share equals it.
pub fn bands(results: &[SuiteResult]) -> Vec<ScoreBand> {
    const ENDS: [f64; 8] = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99];
    let cases: Vec<(f64, bool)> = results
        .iter()
        .flat_map(|result| &result.cases)
        .filter(|case| !case.contenders.is_empty())
        .map(|case| {
            (
                case.score,
                case.found.is_some() && case.found == case.expected,
            )
        })
        .collect();
    ENDS.iter()
        .enumerate()
        .map(|(i, &from)| {
            let to = ENDS.get(i + 1).copied().unwrap_or(f64::INFINITY);
            let inside: Vec<_> = cases.iter().filter(|c| c.0 >= from && c.0 < to).collect();
            ScoreBand {
                from,
                mean_score: inside.iter().map(|c| c.0).sum::<f64>() / inside.len().max(1) as f64,
                num: inside.len(),
                num_right: inside.iter().filter(|c| c.1).count(),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn the_weights_that_made_the_samples_are_found_again() {
        let truth = Model {
            constant: 6.0,
            question: Question::Part,
            weights: vec![-2.0, -1.0, -1.5, -2.0],
        };
        let mut random = Pcg64::seed_from_u64(8);
        let samples: Vec<Sample> = (0..20_000)
            .map(|_| {
                let evidence = Evidence {
                    off: random.random_range(0.0..0.2),
                    missing: random.random_range(0.0..0.4),
                    hidden: 0.0,
                    beyond: 0.0,
                    seen_m2: random.random_range(0.01..0.1),
                    edge_m: random.random_range(0.05..0.5),
                    shape: 1.0,
                    close: None,
                    outside: random.random_range(0.0..0.5),
                    relief_m: random.random_range(0.0..0.01),
                    outline_m: random.random_range(0.0..0.04),
                    outline_shift_m: None,
                    outline_median_m: None,
                    cut: 0.0,
                    facing: 1.0,
                };
                Sample {
                    evidence,
                    is_right: random.random::<f64>() < truth.probability(&evidence),
                }
            })
            .collect();
        let found = Model::fit(&samples, Question::Part, &[true; FEATURES.len()]);
        for (found, truth) in found.weights.iter().zip(truth.weights) {
            assert!((found - truth).abs() < 0.15, "{found} instead of {truth}");
        }
        assert!((found.constant - truth.constant).abs() < 0.3);
    }
}
