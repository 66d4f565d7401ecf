//! Algorithm 2: parts are compared by the correlation of their signatures.

use std::sync::{LazyLock, Mutex};

use rustfft::{FftDirection, FftPlanner, num_complex::Complex};

use crate::{
    correlation::{FftPlanCache, planned},
    signature::LiteralSignature,
};

static PLANNER: FftPlanCache<f64> = LazyLock::new(|| Mutex::new(FftPlanner::new()));

/// Linear correlation of real signals (eq. 7), zero-padded: `f.len() + g.len() - 1` values, starting at the lag where
/// the end of `f` meets the start of `g`.
pub fn linear_correlation(f: &[f64], g: &[f64]) -> Vec<f64> {
    if f.is_empty() || g.is_empty() {
        return Vec::new();
    }
    let num_lags = f.len() + g.len() - 1;
    let size = num_lags.next_power_of_two();
    let forward = planned(&PLANNER, size, FftDirection::Forward);
    // Correlation is convolution with f reversed. Both signals are real, so one transform serves both.
    let mut both = vec![Complex::default(); size];
    for (slot, &value) in both.iter_mut().zip(f.iter().rev()) {
        slot.re = value;
    }
    for (slot, &value) in both.iter_mut().zip(g) {
        slot.im = value;
    }
    forward.process(&mut both);
    let mut product: Vec<Complex<f64>> = (0..size)
        .map(|k| {
            let (a, b) = (both[k], both[(size - k) % size].conj());
            let f = (a + b) * 0.5;
            let g = (a - b) * Complex::new(0.0, -0.5);
            f * g
        })
        .collect();
    planned(&PLANNER, size, FftDirection::Inverse).process(&mut product);
    product
        .iter()
        .take(num_lags)
        .map(|c| c.re / size as f64)
        .collect()
}

/// Data of a part from the paper's offline stage: its signature and [L|Θ]_A, the signature's auto-correlation.
#[derive(Clone, Debug, PartialEq)]
pub struct LiteralReference {
    /// The reference's own signature.
    pub signature: LiteralSignature,
    /// Auto-correlation of the ray lengths.
    pub lengths_auto: Vec<f64>,
    /// Auto-correlation of the folded ray angles.
    pub angles_auto: Vec<f64>,
}

impl LiteralReference {
    /// Computes the auto-correlation (Algorithm 1, step 7).
    pub fn new(signature: LiteralSignature) -> Self {
        Self {
            lengths_auto: linear_correlation(&signature.lengths, &signature.lengths),
            angles_auto: linear_correlation(&signature.angles, &signature.angles),
            signature,
        }
    }

    /// Returns the distance of Algorithm 2: ‖A - C‖₁ over lengths and angles (eq. 11) with A = corr(reference, reference)
    /// and C = corr(reference, query), the shorter of each padded with zeros (Note 1). 0 for a part compared with itself.
    pub fn distance(&self, query: &LiteralSignature) -> f64 {
        l1_distance(
            &self.lengths_auto,
            &linear_correlation(&self.signature.lengths, &query.lengths),
        ) + l1_distance(
            &self.angles_auto,
            &linear_correlation(&self.signature.angles, &query.angles),
        )
    }

    /// Returns ‖A‖₁, the distance from an empty query.
    pub fn norm(&self) -> f64 {
        l1_distance(&self.lengths_auto, &[]) + l1_distance(&self.angles_auto, &[])
    }
}

fn l1_distance(a: &[f64], b: &[f64]) -> f64 {
    let at = |values: &[f64], i: usize| values.get(i).copied().unwrap_or(0.0);
    (0..a.len().max(b.len()))
        .map(|i| (at(a, i) - at(b, i)).abs())
        .sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn linear_correlation_is_the_sum_over_all_overlaps(
            f in prop::collection::vec(-5.0_f64..5.0, 1..40),
            g in prop::collection::vec(-5.0_f64..5.0, 1..40),
        ) {
            let fast = linear_correlation(&f, &g);
            prop_assert_eq!(fast.len(), f.len() + g.len() - 1);
            for (i, value) in fast.iter().enumerate() {
                let lag = i as i64 - (f.len() as i64 - 1);
                let slow: f64 = (0..f.len() as i64)
                    .filter(|m| (0..g.len() as i64).contains(&(m + lag)))
                    .map(|m| f[m as usize] * g[(m + lag) as usize])
                    .sum();
                prop_assert!((value - slow).abs() < 1e-9, "{value} {slow}");
            }
        }
    }

    #[test]
    fn a_part_compared_with_itself_has_distance_zero() {
        let signature = LiteralSignature {
            lengths: vec![1.0, 3.0, 2.0],
            angles: vec![0.1, 0.2, 1.5],
        };
        let reference = LiteralReference::new(signature.clone());
        assert!(reference.distance(&signature).abs() < 1e-12);
        assert!(reference.norm() > 1.0);
    }
}
