//! Regions in which the averages exceed their noise.
//!
//! A part has thousands of patches, so the limit follows from how many there are: with it, a part without a deviation has a
//! region in as few cases as was asked for. The number of places in which an average exceeds a limit by chance is the expected
//! Euler characteristic of a smooth random field (R. J. Adler, "The geometry of random fields", 1981; K. J. Worsley and others,
//! "A unified statistical approach for determining significant signals in images of cerebral activation", Human Brain Mapping
//! 4(1), 1996). We take that instead of a false discovery rate (Y. Benjamini and Y. Hochberg, "Controlling the false discovery
//! rate", Journal of the Royal Statistical Society B 57(1), 1995): a good part must hardly ever be refused.

use super::{DeviationRegion, RegionKind, patches::Patches, surface::Surface};
use geometry::units::Metres;

/// Mean square of the slope of the averages over a patch of radius 1, along an axis, for a noise of 1: half of the integral of the
/// squared slope of the weights (π³/8) over that of their squares (3·π/8 - 2/π).
const SLOPE_SQ: f64 = 3.58;
/// Limits between which the one is sought, standard deviations.
const FACTORS: [f64; 2] = [2.0, 12.0];
/// A region is where the average is at least this share of that in its middle.
const REGION_SHARE: f64 = 0.5;
/// Distance from a region within which a smaller deviation is of the same damage, metres: its flank, or the rim that taking the form
/// away has made.
const SAME_DAMAGE_M: f64 = 0.04;
/// Share of a region's deviation up to which one to the other side may be its rim.
const RIM_MAX_SHARE: f64 = 0.4;

/// Returns how many standard deviations an average must exceed.
pub(super) fn limit_factor(surface: &Surface<'_>, scales: &[Patches], false_alarms: f64) -> f64 {
    let fields = scales.iter().map(|patches| {
        let num_seen = patches.offs.iter().filter(|off| off.is_finite()).count() as f64;
        AveragedField {
            slopes: num_seen * surface.node_area * SLOPE_SQ / patches.radius.powi(2),
            num_averages: num_seen,
        }
    });
    factor_of(&fields.collect::<Vec<_>>(), false_alarms)
}

/// Averages of a noise of 1 over the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct AveragedField {
    /// Integral over the surface of the mean square of their slope along an axis.
    pub(super) slopes: f64,
    /// Number of places where they are taken.
    pub(super) num_averages: f64,
}

impl AveragedField {
    /// At most so many places exceed a limit to either side by chance: the Euler characteristic, or, where the averages are taken
    /// at a few places, their number times the probability of each.
    pub(super) fn num_beyond(self, factor: f64) -> f64 {
        let density = (-0.5 * factor * factor).exp() / std::f64::consts::TAU.sqrt();
        let of_field = self.slopes * density * factor / std::f64::consts::TAU;
        let of_each = self.num_averages * density / factor;
        2.0 * of_field.min(of_each)
    }
}

/// The limit beyond which these fields have so many places by chance.
pub(super) fn factor_of(fields: &[AveragedField], num_places: f64) -> f64 {
    let expected = |factor: f64| -> f64 {
        let each = fields.iter().map(|field| field.num_beyond(factor));
        each.sum()
    };
    let [mut low, mut high] = FACTORS;
    // To a millionth of a standard deviation.
    for _ in 0..24 {
        let middle = f64::midpoint(low, high);
        if expected(middle) > num_places {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Returns the regions that exceed the limit over at least `min_area` (square metres), the clearest first.
pub(super) fn regions(
    surface: &Surface<'_>,
    scales: &[Patches],
    factor: f64,
    min_area: f64,
) -> Vec<DeviationRegion> {
    // Node, scale, and how often the average there exceeds its limit.
    let mut peaks: Vec<(usize, usize, f64)> = Vec::new();
    for node in 0..surface.points.len() {
        let of_scales = scales.iter().enumerate().map(|(scale, patches)| {
            let times = patches.offs[node].abs() / (factor * patches.noises[node]);
            (node, scale, times)
        });
        let largest = of_scales
            .filter(|peak| peak.2 >= 1.0)
            .max_by(|a, b| a.2.total_cmp(&b.2));
        peaks.extend(largest);
    }
    peaks.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
    let mut found = Vec::new();
    // Of each node, the deviation that it is part of.
    let mut explained: Vec<Option<f64>> = vec![None; surface.points.len()];
    for (node, scale, _) in peaks {
        let patches = &scales[scale];
        let off = patches.offs[node];
        let is_explained = explained[node].is_some_and(|by: f64| {
            let is_rim = off.abs() < RIM_MAX_SHARE * by.abs();
            is_rim || (off > 0.0) == (by > 0.0)
        });
        if is_explained {
            continue;
        }
        let least = REGION_SHARE * off.abs();
        let nodes = surface.connected(node, |near| {
            let here = patches.offs[near];
            here.abs() >= least && (here > 0.0) == (off > 0.0)
        });
        for of_region in &nodes {
            surface.around(*of_region, SAME_DAMAGE_M, |near| {
                explained[near].get_or_insert(off);
            });
        }
        let area_m2 = nodes.len() as f64 * surface.node_area;
        if area_m2 < min_area {
            continue;
        }
        // The deepest that a patch of any size shows for certain: a large one levels a small dent.
        let mut deepest = off;
        for of_region in &nodes {
            for patches in scales {
                let here = patches.offs[*of_region];
                let is_certain = here.abs() >= factor * patches.noises[*of_region];
                if is_certain && (here > 0.0) == (off > 0.0) && here.abs() > deepest.abs() {
                    deepest = here;
                }
            }
        }
        let noise = patches.noises[node];
        found.push(DeviationRegion {
            kind: if off > 0.0 {
                RegionKind::Bump
            } else {
                RegionKind::Dent
            },
            area_m2,
            off: Some(Metres(deepest)),
            centre: surface.middle(&nodes),
            limit: Metres(factor * noise),
            noise: Metres(noise),
            points: nodes.iter().map(|node| surface.points[*node]).collect(),
        });
    }
    found
}
