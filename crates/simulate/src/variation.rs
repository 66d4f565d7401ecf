//! Differences between car models: seeded changes to the standard dimensions.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// The first model seed of other makes, which differ more than the models of one class.
pub const FIRST_OTHER_MAKE: u64 = 1 << 40;

/// Supplies dimensions in a fixed order. Model seed 0 gives the standard ones.
pub(super) struct Variation {
    /// `None` for the standard car.
    random: Option<Pcg64>,
    is_other_make: bool,
}

/// Relative deviation of every dimension for other makes, in either direction.
const OTHER_MAKE: std::ops::Range<f64> = 0.06..0.12;

impl Variation {
    /// Prepares the dimensions of car model `model_seed`; `part` separates the parts of one car.
    pub(super) fn new(model_seed: u64, part: u64) -> Self {
        let random = (model_seed != 0)
            .then(|| Pcg64::seed_from_u64(model_seed.wrapping_mul(64).wrapping_add(part)));
        Self {
            random,
            is_other_make: model_seed >= FIRST_OTHER_MAKE,
        }
    }

    /// Returns a dimension or position within ±6 % of the standard one; for other makes 6 to 12 % off.
    pub(super) fn of(&mut self, standard: f64) -> f64 {
        standard * self.share(0.06, OTHER_MAKE)
    }

    /// Returns an overall dimension within ±2.5 %: cars of one class differ less in size than in styling, and the part must
    /// still fit the picture. For other makes 6 to 12 % off.
    pub(super) fn overall(&mut self, standard: f64) -> f64 {
        standard * self.share(0.025, OTHER_MAKE)
    }

    /// Returns a radius of curvature within ±6 %; for other makes 20 to 40 % off.
    pub(super) fn curvature(&mut self, standard: f64) -> f64 {
        standard * self.share(0.06, 0.2..0.4)
    }

    /// Returns a shift within ±`reach` metres; for other makes one to two times `reach`.
    pub(super) fn shift(&mut self, reach: f64) -> f64 {
        (self.share(1.0, 1.0..2.0) - 1.0) * reach
    }

    /// Returns how far the grid of a sheet has to reach: further for other makes.
    pub(super) fn reach(&self, standard: f64) -> f64 {
        if self.is_other_make {
            standard * (1.0 + OTHER_MAKE.end)
        } else {
            standard
        }
    }

    /// Returns a factor 1 ± up to `spread`; for other makes 1 ± a value from `other_make`.
    fn share(&mut self, spread: f64, other_make: std::ops::Range<f64>) -> f64 {
        let Some(random) = &mut self.random else {
            return 1.0;
        };
        if !self.is_other_make {
            return 1.0 + random.random_range(-spread..spread);
        }
        let off = random.random_range(other_make);
        if random.random_bool(0.5) {
            1.0 + off
        } else {
            1.0 - off
        }
    }
}
