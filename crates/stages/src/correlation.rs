//! Circular correlation of outlines, for the default matcher. The paper's (eq. 7) is linear: [`crate::paper`].

use std::sync::{Arc, LazyLock, Mutex};

use nalgebra::Vector2;
use rustfft::{Fft, FftDirection, FftNum, FftPlanner, num_complex::Complex};

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
pub(crate) type FftPlanCache<T> = LazyLock<Mutex<FftPlanner<T>>>;
static PLANNER: FftPlanCache<f32> = LazyLock::new(|| Mutex::new(FftPlanner::new()));

/// Returns the transform of `length` values.
pub(crate) fn planned<T: FftNum>(
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
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
}
