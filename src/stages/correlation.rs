//! Auto- and cross-correlation (eq. 7), circular for the default matcher and linear for the paper's.

use nalgebra::Vector2;
use rustfft::{FftPlanner, num_complex::Complex};

use crate::stages::signature::LiteralSignature;

/// Discrete Fourier transform of rays taken as complex numbers x + iy.
pub fn spectrum(rays: &[Vector2<f64>]) -> Vec<Complex<f64>> {
    let mut values: Vec<Complex<f64>> = rays.iter().map(|r| Complex::new(r.x, r.y)).collect();
    FftPlanner::new()
        .plan_fft_forward(values.len())
        .process(&mut values);
    values
}

/// Circular correlation of equally long complex signals, by their spectra:
/// `out[lag] = Σ query[k + lag] · conj(reference[k])`.
pub struct CircularCorrelator {
    inverse: std::sync::Arc<dyn rustfft::Fft<f64>>,
    scratch: Vec<Complex<f64>>,
    /// The correlation at every lag after [`Self::correlate`].
    pub values: Vec<Complex<f64>>,
}

impl CircularCorrelator {
    /// For signals of `length` samples.
    pub fn new(length: usize) -> Self {
        let inverse = FftPlanner::new().plan_fft_inverse(length);
        Self {
            scratch: vec![Complex::default(); inverse.get_inplace_scratch_len()],
            values: vec![Complex::default(); length],
            inverse,
        }
    }

    /// Fills `values`. Both spectra have the length given at the start.
    pub fn correlate(&mut self, query: &[Complex<f64>], reference: &[Complex<f64>]) {
        let scale = 1.0 / self.values.len() as f64;
        for ((value, q), r) in self.values.iter_mut().zip(query).zip(reference) {
            *value = q * r.conj() * scale;
        }
        self.inverse
            .process_with_scratch(&mut self.values, &mut self.scratch);
    }
}

/// Linear correlation of real signals (eq. 7), zero-padded: `f.len() + g.len() - 1` values, from the lag at which
/// the end of `f` meets the start of `g` on.
pub fn linear_correlation(f: &[f64], g: &[f64]) -> Vec<f64> {
    if f.is_empty() || g.is_empty() {
        return Vec::new();
    }
    let num_lags = f.len() + g.len() - 1;
    let size = num_lags.next_power_of_two();
    let mut planner = FftPlanner::new();
    let forward = planner.plan_fft_forward(size);
    // Correlation is convolution with f reversed. Both signals are real, so one transform carries the two.
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
    planner.plan_fft_inverse(size).process(&mut product);
    product
        .iter()
        .take(num_lags)
        .map(|c| c.re / size as f64)
        .collect()
}

/// What the paper's offline stage keeps of a part: its signature and [L|Θ]_A, the signature's auto-correlation.
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
    /// Algorithm 1, step 7.
    pub fn new(signature: &LiteralSignature) -> Self {
        Self {
            lengths_auto: linear_correlation(&signature.lengths, &signature.lengths),
            angles_auto: linear_correlation(&signature.angles, &signature.angles),
            signature: signature.clone(),
        }
    }

    /// Algorithm 2: ‖A - C‖₁ over lengths and angles (eq. 11) with A = corr(reference, reference) and
    /// C = corr(reference, query), the shorter of each padded with zeros (Note 1). A part compared with itself is 0.
    pub fn distance(&self, query: &LiteralSignature) -> f64 {
        l1_distance(
            &self.lengths_auto,
            &linear_correlation(&self.signature.lengths, &query.lengths),
        ) + l1_distance(
            &self.angles_auto,
            &linear_correlation(&self.signature.angles, &query.angles),
        )
    }

    /// ‖A‖₁: the distance from a query that is nothing at all.
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

        #[test]
        fn circular_correlation_is_the_sum_over_the_circle(
            rays in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 16),
            other in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 16),
        ) {
            let vectors = |v: &[(f64, f64)]| v.iter().map(|&(x, y)| Vector2::new(x, y)).collect::<Vec<_>>();
            let mut correlator = CircularCorrelator::new(16);
            correlator.correlate(&spectrum(&vectors(&rays)), &spectrum(&vectors(&other)));
            for lag in 0..16 {
                let slow: Complex<f64> = (0..16)
                    .map(|k| {
                        let (q, r) = (rays[(k + lag) % 16], other[k]);
                        Complex::new(q.0, q.1) * Complex::new(r.0, -r.1)
                    })
                    .sum();
                prop_assert!((correlator.values[lag] - slow).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn a_part_compared_with_itself_has_distance_zero() {
        let signature = LiteralSignature {
            lengths: vec![1.0, 3.0, 2.0],
            angles: vec![0.1, 0.2, 1.5],
        };
        let reference = LiteralReference::new(&signature);
        assert!(reference.distance(&signature).abs() < 1e-12);
        assert!(reference.norm() > 1.0);
    }
}
