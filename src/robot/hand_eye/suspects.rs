//! Pairs that do not belong to the others: a capture of another pose, a slip of the pen.
//!
//! One pair that is far off drags a fit of all towards itself and hides among the residuals. So the fit is looked for
//! that most pairs agree with: from many triples of pairs, each improved by fitting the better half anew a few times
//! (P. J. Rousseeuw and K. Van Driessen, "Computing LTS regression for large data sets", Data Mining and Knowledge
//! Discovery 12, 2006). What is far off that one is suspect.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{Equation, HandEyeSolution, LEAST_PAIRS, closed_form, refine, rms};
use crate::{
    geometry::rigid::PoseDelta,
    units::{Metres, Radians},
};

/// With fewer pairs nobody can say which one is wrong.
const LEAST_TO_TELL: usize = 6;
/// Triples that are tried: with one pair in four wrong, all of them hit a wrong one once in 10²⁵ calls.
const TRIPLES: usize = 100;
/// Times that the better half is fitted anew.
const IMPROVEMENTS: usize = 3;
/// A pair so many times further off than the others are on average is suspect.
const FACTOR: f64 = 5.0;
/// Nobody looks for the cause of less than this.
const LEAST: PoseDelta = PoseDelta {
    rotation: Radians(0.002),
    shift: Metres(0.001),
};
/// A millimetre counts as much as a tenth of a degree.
const LEVER: f64 = 0.57;

/// Pairs that are suspect, and how well the others agree without them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Suspects {
    /// Indices, in order.
    pub(super) pairs: Vec<usize>,
    /// How far each of them is off what the others say.
    pub(super) off: Vec<PoseDelta>,
    /// Of the others.
    pub(super) rms: PoseDelta,
}

/// The pairs that are far off what most of the others say; `None` if there is none, or if no one can tell.
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
    // The better half is nearer than an average pair: by a factor of two at most.
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
        // Two poses are fitted: so many pairs' worth of residuals are gone.
        scale = (sum_sq / (rest.len() as f64 - 2.0)).sqrt();
    }
    let pairs: Vec<usize> = (0..num).filter(|i| !kept.contains(i)).collect();
    let off = |i: &usize| equations[*i].off(&fit);
    let kept: Vec<PoseDelta> = kept.iter().map(off).collect();
    (!pairs.is_empty()).then(|| Suspects {
        off: pairs.iter().map(off).collect(),
        pairs,
        rms: rms(&kept),
    })
}

fn picked(equations: &[Equation], indices: &[usize]) -> Vec<Equation> {
    indices.iter().map(|&i| equations[i]).collect()
}

/// How far off, metres.
fn far(off: &PoseDelta) -> f64 {
    off.shift.0.hypot(LEVER * off.rotation.0)
}

fn is_suspect(off: &PoseDelta, scale: f64) -> bool {
    let counts = off.shift.0 > LEAST.shift.0 || off.rotation.0 > LEAST.rotation.0;
    counts && far(off) > FACTOR * scale
}
