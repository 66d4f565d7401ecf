//! Regions in which the averages exceed their noise.
//!
//! A part has thousands of patches, so the limit follows from how many there are: with it, a part without a deviation has a
//! region in as few cases as was asked for (C. E. Bonferroni, "Teoria statistica delle classi e calcolo delle probabilità",
//! 1936). We take that instead of a false discovery rate (Y. Benjamini and Y. Hochberg, "Controlling the false discovery rate",
//! Journal of the Royal Statistical Society B 57(1), 1995): a good part must hardly ever be refused.

use super::{
    DeviationRegion, RegionKind,
    patches::{Patches, normal_above},
    surface::Surface,
};
use geometry::units::Metres;

/// Overlapping patches exceed a limit in more places than patches side by side: measured in their number.
const OVERLAPPING_PER_PATCH: f64 = 3.0;
/// A region is where the average is at least this share of that in its middle.
const REGION_SHARE: f64 = 0.5;
/// Distance from a region within which a smaller deviation is of the same damage, metres: its flank, or the rim that taking the form
/// away has made.
const SAME_DAMAGE_M: f64 = 0.04;
/// Share of a region's deviation up to which one to the other side may be its rim.
const RIM_MAX_SHARE: f64 = 0.4;

/// Returns how many standard deviations an average must exceed.
pub(super) fn limit_factor(surface: &Surface<'_>, scales: &[Patches], false_alarms: f64) -> f64 {
    let patches = scales.iter().map(|patches| {
        let num_seen = patches.offs.iter().filter(|off| off.is_finite()).count();
        num_seen as f64 * surface.node_area / (std::f64::consts::PI * patches.radius.powi(2))
    });
    let num_trials = 2.0 * OVERLAPPING_PER_PATCH * patches.sum::<f64>().max(1.0);
    normal_above(false_alarms / num_trials)
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
