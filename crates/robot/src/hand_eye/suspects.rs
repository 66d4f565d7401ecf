//! Pairs that do not belong with the others: a capture of another pose, a typing error.
//!
//! A pair that is far off drags the fit of all pairs towards itself and hides among the residuals. So the fit that most
//! pairs agree with is searched for: from many triples of pairs, each improved by fitting the better half anew a few
//! times (P. J. Rousseeuw and K. Van Driessen, "Computing LTS regression for large data sets", Data Mining and
//! Knowledge Discovery 12, 2006). Pairs that are far off this fit are suspect.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{Equation, HandEyeSolution, LEAST_PAIRS, closed_form, refine, rms};
use geometry::{
    rigid::PoseDelta,
    units::{Metres, Radians},
};

/// With fewer pairs it is not possible to tell which one is wrong.
const LEAST_TO_TELL: usize = 6;
/// Triples tried: with one pair in four wrong, all of them contain a wrong one less than once in 10²³ calls.
const TRIPLES: usize = 100;
/// Times that the better half is fitted anew.
const IMPROVEMENTS: usize = 3;
/// A pair is suspect if it is this many times farther off than the others on average.
const SUSPECT_MIN_RATIO: f64 = 5.0;
/// Smaller deviations are never suspect.
const LEAST: PoseDelta = PoseDelta {
    rotation: Radians(0.002),
    shift: Metres(0.001),
};
/// Metres per radian: a millimetre counts as much as a tenth of a degree.
const LEVER_M_PER_RAD: f64 = 0.57;

/// The suspect pairs, and how well the others agree without them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Suspects {
    /// Indices in ascending order, each with its deviation from the fit of the others.
    pub(super) pairs: Vec<(usize, PoseDelta)>,
    /// Root mean square of the others.
    pub(super) rms: PoseDelta,
}

/// Finds the pairs that are far off what most of the others agree on; `None` if there are none, or if it cannot be
/// told.
pub(super) fn suspects(equations: &[Equation]) -> Option<Suspects> {
    let num = equations.len();
    if num < LEAST_TO_TELL {
        return None;
    }
    let half = num / 2 + 2;
    let mut random = Pcg64::seed_from_u64(7);
    let mut best: Option<(f64, HandEyeSolution)> = None;
    for _ in 0..TRIPLES {
        let mut chosen: Vec<usize> = Vec::with_capacity(LEAST_PAIRS);
        while chosen.len() < LEAST_PAIRS {
            let i = random.random_range(0..num);
            if !chosen.contains(&i) {
                chosen.push(i);
            }
        }
        for _ in 0..=IMPROVEMENTS {
            let Some(found) = closed_form::solve(&picked(equations, &chosen)) else {
                break;
            };
            let fit = found.unknowns;
            let mut order: Vec<(f64, usize)> = equations
                .iter()
                .enumerate()
                .map(|(i, e)| (far(&e.off(&fit)), i))
                .collect();
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            order.truncate(half);
            let sum_sq: f64 = order.iter().map(|(far, _)| far * far).sum();
            if best.as_ref().is_none_or(|(least, _)| sum_sq < *least) {
                best = Some((sum_sq, fit));
            }
            chosen = order.into_iter().map(|(_, i)| i).collect();
        }
    }
    let (sum_sq, mut fit) = best?;
    // The better half is nearer than the average pair, by a factor of two at most.
    let mut scale = 2.0 * (sum_sq / half as f64).sqrt();
    let mut kept: Vec<usize> = Vec::new();
    for _ in 0..IMPROVEMENTS {
        kept = (0..num)
            .filter(|&i| !is_suspect(&equations[i].off(&fit), scale))
            .collect();
        if kept.len() < half {
            return None;
        }
        let rest = picked(equations, &kept);
        fit = refine::refine(&rest, fit).unknowns;
        let sum_sq: f64 = rest.iter().map(|e| far(&e.off(&fit)).powi(2)).sum();
        // The fit of two poses takes up two pairs' worth of residuals.
        scale = (sum_sq / (rest.len() as f64 - 2.0)).sqrt();
    }
    let (others, pairs): (Vec<_>, Vec<_>) = (0..num)
        .map(|i| (i, equations[i].off(&fit)))
        .partition(|(i, _)| kept.contains(i));
    let others: Vec<PoseDelta> = others.into_iter().map(|(_, off)| off).collect();
    (!pairs.is_empty()).then(|| Suspects {
        pairs,
        rms: rms(&others),
    })
}

fn picked(equations: &[Equation], indices: &[usize]) -> Vec<Equation> {
    indices.iter().map(|&i| equations[i]).collect()
}

/// Deviation in metres, with turns converted by [`LEVER_M_PER_RAD`].
fn far(off: &PoseDelta) -> f64 {
    off.shift.0.hypot(LEVER_M_PER_RAD * off.rotation.0)
}

fn is_suspect(off: &PoseDelta, scale: f64) -> bool {
    let counts = off.shift.0 > LEAST.shift.0 || off.rotation.0 > LEAST.rotation.0;
    counts && far(off) > SUSPECT_MIN_RATIO * scale
}
