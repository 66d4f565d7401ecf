//! How one car model differs from another: seeded changes to the standard dimensions.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// Gives out dimensions in a fixed order. Model seed 0 gives the standard ones.
pub(super) struct Variation {
    /// `None` for the standard car.
    random: Option<Pcg64>,
}

impl Variation {
    /// The dimensions of car model `model_seed`; `part` keeps the parts of one car apart.
    pub(super) fn new(model_seed: u64, part: u64) -> Self {
        let random = (model_seed != 0)
            .then(|| Pcg64::seed_from_u64(model_seed.wrapping_mul(64).wrapping_add(part)));
        Self { random }
    }

    /// A dimension or position within ± 6 % of the standard one.
    pub(super) fn of(&mut self, standard: f64) -> f64 {
        standard * self.share(0.06)
    }

    /// An overall dimension, within ± 2.5 %: cars of one class differ less in size than in styling, and the part
    /// still has to fit the camera.
    pub(super) fn overall(&mut self, standard: f64) -> f64 {
        standard * self.share(0.025)
    }

    /// A shift within ± `reach` metres.
    pub(super) fn shift(&mut self, reach: f64) -> f64 {
        (self.share(1.0) - 1.0) * reach
    }

    fn share(&mut self, spread: f64) -> f64 {
        match &mut self.random {
            Some(random) => 1.0 + random.random_range(-spread..spread),
            None => 1.0,
        }
    }
}
