//! How one car model differs from another: seeded changes to the standard dimensions.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// Model seeds from this one on are cars of other makes, which differ more than the models of one class do.
pub const FIRST_OTHER_MAKE: u64 = 1 << 40;

/// Gives out dimensions in a fixed order. Model seed 0 gives the standard ones.
pub(super) struct Variation {
    /// `None` for the standard car.
    random: Option<Pcg64>,
    is_other_make: bool,
}

/// Cars of other makes are off by this share of every dimension, one way or the other.
const OTHER_MAKE: std::ops::Range<f64> = 0.06..0.12;

impl Variation {
    /// The dimensions of car model `model_seed`; `part` keeps the parts of one car apart.
    pub(super) fn new(model_seed: u64, part: u64) -> Self {
        let random = (model_seed != 0)
            .then(|| Pcg64::seed_from_u64(model_seed.wrapping_mul(64).wrapping_add(part)));
        Self {
            random,
            is_other_make: model_seed >= FIRST_OTHER_MAKE,
        }
    }

    /// A dimension or position within ± 6 % of the standard one; of another make 6 to 12 % off.
    pub(super) fn of(&mut self, standard: f64) -> f64 {
        standard * self.share(0.06, OTHER_MAKE)
    }

    /// An overall dimension, within ± 2.5 %: cars of one class differ less in size than in styling, and the part
    /// still has to fit the camera. Of another make 6 to 12 % off.
    pub(super) fn overall(&mut self, standard: f64) -> f64 {
        standard * self.share(0.025, OTHER_MAKE)
    }

    /// A radius of curvature within ± 6 %; of another make 20 to 40 % off.
    pub(super) fn curvature(&mut self, standard: f64) -> f64 {
        standard * self.share(0.06, 0.2..0.4)
    }

    /// A shift within ± `reach` metres; of another make once to twice as far.
    pub(super) fn shift(&mut self, reach: f64) -> f64 {
        (self.share(1.0, 1.0..2.0) - 1.0) * reach
    }

    /// How far the grid of a sheet has to reach: farther for another make.
    pub(super) fn reach(&self, standard: f64) -> f64 {
        if self.is_other_make {
            standard * (1.0 + OTHER_MAKE.end)
        } else {
            standard
        }
    }

    /// 1 ± up to `spread`; for another make 1 ± something of `other_make`.
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
