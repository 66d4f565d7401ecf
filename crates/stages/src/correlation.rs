//! Auto- and cross-correlation (eq. 7), circular for the default matcher and linear for the paper's.

use std::sync::{Arc, LazyLock, Mutex};

use nalgebra::Vector2;
use rustfft::{Fft, FftDirection, FftNum, FftPlanner, num_complex::Complex};

use crate::signature::LiteralSignature;
use geometry::error::lock;

/// The rays of one or several outlines as complex numbers x + iy, transformed for the circular correlation.
///
/// Stored contiguously, because the ranking reads all of them, and in single precision, which resolves about a
/// micrometre in rays of metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaySpectra {
    num_rays: usize,
    /// Discrete Fourier transforms, one outline after the other.
    pub(super) values: Vec<Complex<f32>>,
    /// Sum of the squared ray lengths of each outline, square metres.
    pub powers: Vec<f64>,
}

impl RaySpectra {
    /// Transforms outlines with the same number of rays, metres.
    pub fn of<'a>(outlines: impl IntoIterator<Item = &'a [Vector2<f64>]>) -> Self {
        let complex = |r: &Vector2<f64>| Complex::new(r.x as f32, r.y as f32);
        let mut all = Self::default();
        for rays in outlines {
            all.num_rays = rays.len();
            all.values.extend(rays.iter().map(complex));
            all.powers
                .push(rays.iter().map(Vector2::norm_squared).sum());
        }
        all.values.shrink_to_fit();
        all.powers.shrink_to_fit();
        if all.num_rays > 0 {
            planned(&PLANNER, all.num_rays, FftDirection::Forward).process(&mut all.values);
        }
        all
    }
}

/// A cached planner for one precision: planning takes as long as dozens of transforms.
type FftPlanCache<T> = LazyLock<Mutex<FftPlanner<T>>>;
static PLANNER: FftPlanCache<f32> = LazyLock::new(|| Mutex::new(FftPlanner::new()));
static EXACT_PLANNER: FftPlanCache<f64> = LazyLock::new(|| Mutex::new(FftPlanner::new()));

/// Returns the transform of `length` values.
fn planned<T: FftNum>(
    planner: &FftPlanCache<T>,
    length: usize,
    direction: FftDirection,
) -> Arc<dyn Fft<T>> {
    // A planner that panicked while planning has at worst lost a plan.
    let mut planner = lock(planner);
    planner.plan_fft(length, direction)
}

/// Circular correlation of one outline's rays with those of others, using their spectra:
/// `out[lag] = Σ query[k + lag] · conj(reference[k])`.
pub struct CircularCorrelator {
    query: RaySpectra,
    inverse: Arc<dyn Fft<f32>>,
    scratch: Vec<Complex<f32>>,
    values: Vec<Complex<f32>>,
}

impl CircularCorrelator {
    /// Creates a correlator for the first outline of `query`, which must have at least one ray.
    pub fn new(mut query: RaySpectra) -> Self {
        // Compensates for the scale of the unnormalised forward and inverse transforms.
        let scale = 1.0 / query.num_rays as f32;
        query.values.iter_mut().for_each(|value| *value *= scale);
        let inverse = planned(&PLANNER, query.num_rays, FftDirection::Inverse);
        Self {
            scratch: vec![Complex::default(); inverse.get_inplace_scratch_len()],
            values: Vec::new(),
            inverse,
            query,
        }
    }

    /// Returns, per outline, the correlation at every lag and the sum of both powers; nothing if the number of rays
    /// differs from the query's.
    pub fn correlate(
        &mut self,
        references: &RaySpectra,
    ) -> impl Iterator<Item = (&[Complex<f32>], f64)> {
        let num_rays = self.query.num_rays;
        self.values.clear();
        if references.num_rays == num_rays {
            for reference in references.values.chunks_exact(num_rays) {
                let pairs = self.query.values.iter().zip(reference);
                self.values.extend(pairs.map(|(q, r)| q * r.conj()));
            }
            self.inverse
                .process_with_scratch(&mut self.values, &mut self.scratch);
        }
        let power = self.query.powers[0];
        let powers = references.powers.iter().map(move |p| power + p);
        self.values.chunks_exact(num_rays).zip(powers)
    }
}

/// Linear correlation of real signals (eq. 7), zero-padded: `f.len() + g.len() - 1` values, starting at the lag where
/// the end of `f` meets the start of `g`.
pub fn linear_correlation(f: &[f64], g: &[f64]) -> Vec<f64> {
    if f.is_empty() || g.is_empty() {
        return Vec::new();
    }
    let num_lags = f.len() + g.len() - 1;
    let size = num_lags.next_power_of_two();
    let forward = planned(&EXACT_PLANNER, size, FftDirection::Forward);
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
    planned(&EXACT_PLANNER, size, FftDirection::Inverse).process(&mut product);
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

        #[test]
        fn circular_correlation_is_the_sum_over_the_circle(
            rays in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 16),
            other in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 16),
        ) {
            let vectors = |v: &[(f64, f64)]| v.iter().map(|&(x, y)| Vector2::new(x, y)).collect::<Vec<_>>();
            let (rays_of_query, rays_of_other) = (vectors(&rays), vectors(&other));
            let spectra = RaySpectra::of([&rays_of_query[..], &rays_of_other[..]]);
            let mut correlator = CircularCorrelator::new(RaySpectra::of([&rays_of_query[..]]));
            let correlations: Vec<_> = correlator.correlate(&spectra).collect();
            let power = |rays: &[Vector2<f64>]| rays.iter().map(Vector2::norm_squared).sum::<f64>();
            let (values, powers) = correlations[1];
            prop_assert!((powers - power(&rays_of_query) - power(&rays_of_other)).abs() < 1e-12);
            for lag in 0..16 {
                let slow: Complex<f64> = (0..16)
                    .map(|k| {
                        let (q, r) = (rays[(k + lag) % 16], other[k]);
                        Complex::new(q.0, q.1) * Complex::new(r.0, -r.1)
                    })
                    .sum();
                let fast = values[lag];
                let fast = Complex::new(f64::from(fast.re), f64::from(fast.im));
                prop_assert!((fast - slow).norm() < 1e-5, "{fast} {slow}");
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
