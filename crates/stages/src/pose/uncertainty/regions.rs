//! Pairs that err together, region by region.

use std::collections::BTreeMap;

use nalgebra::{Matrix6, Point3, Vector3, Vector6};

/// Pairs by region.
pub(super) struct Regions {
    middle: Vector3<f64>,
    /// Side of a region, metres.
    side: f64,
    by_place: BTreeMap<[i32; 6], Region>,
}

#[derive(Default)]
struct Region {
    weight: f64,
    /// Σ w r
    pull: f64,
    /// Σ w J
    lever: Vector6<f64>,
    /// Σ w r J
    moment: Vector6<f64>,
}

impl Regions {
    pub(super) fn new(middle: Vector3<f64>, side: f64) -> Self {
        Self {
            middle,
            side: side.max(f64::MIN_POSITIVE),
            by_place: BTreeMap::new(),
        }
    }

    /// Adds a pair, by its place and the side that it is on.
    pub(super) fn add(
        &mut self,
        at: &Point3<f64>,
        facing: Option<&Vector3<f64>>,
        change: &Vector6<f64>,
        off: f64,
        weight: f64,
    ) {
        let cell = ((at.coords - self.middle) / self.side).map(|x| x.floor() as i32);
        // Six sides and what lies between.
        let facing = facing.map_or(Vector3::zeros(), |f| f.map(|x| (1.2 * x).round() as i32));
        let key = [cell.x, cell.y, cell.z, facing.x, facing.y, facing.z];
        let region = self.by_place.entry(key).or_default();
        region.weight += weight;
        region.pull += weight * off;
        region.lever += change * weight;
        region.moment += change * (weight * off);
    }

    /// True without pairs.
    pub(super) fn is_empty(&self) -> bool {
        self.by_place.is_empty()
    }

    /// Σ G Gᵀ of the pulls G = Σ w r J of each region: M where a region's pairs err each by itself.
    pub(super) fn scatter(&self) -> Matrix6<f64> {
        let num = self.by_place.len() as f64;
        let moments = self
            .by_place
            .values()
            .map(|r| r.moment * r.moment.transpose());
        // The fit of six parameters reduces the residuals: correct for the lost degrees of freedom.
        moments.sum::<Matrix6<f64>>() * (num / (num - 6.0).max(1.0))
    }

    /// Their share of M, if the mean distance of a region has at least this standard deviation besides what is seen.
    pub(super) fn spread(&self, at_least: f64) -> Matrix6<f64> {
        let regions = || self.by_place.values().filter(|region| region.weight > 0.0);
        let weight_sum: f64 = regions().map(|region| region.weight).sum();
        let squares = regions().map(|region| region.pull * region.pull / region.weight);
        // The fit of the pose reduces these residuals as well; half of its six parameters count here.
        let num = regions().count() as f64;
        let seen_sq =
            squares.sum::<f64>() / weight_sum.max(f64::MIN_POSITIVE) * num / (num - 3.0).max(1.0);
        let levers = regions().map(|region| region.lever * region.lever.transpose());
        levers.sum::<Matrix6<f64>>() * (seen_sq + at_least * at_least)
    }
}
