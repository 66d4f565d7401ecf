//! Generates any number of simulated references.
//!
//! The first 64 are the eight parts of eight models of the car, each enrolled from a frontal capture. All further ones
//! are *perturbed signatures* of these: the ray lengths vary by a few per cent around the outline, the packed pixels are
//! those of the original, and there is no cloud. They are not real parts, but ranking does the same work for them. Ten
//! thousand take about 1 GB.

use std::sync::Mutex;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::ScalingError;
use geometry::error::lock;
use inspection::{
    library::{EnrolParams, enrol_part},
    pipeline::{Cancelled, ProgressObserver},
};
use simulate::{PartKind, Side};
use stages::{
    paper::LiteralReference,
    rank::Matcher,
    reference::{Reference, ReferenceView},
};

/// Number of car models whose parts are really enrolled. The tests rank as well what is made of fewer.
pub(super) const NUM_MODELS: u64 = if cfg!(test) { 2 } else { 8 };

/// The parts enrolled so far, without clouds: they are the same for every matcher.
static ENROLLED: Mutex<Vec<Reference>> = Mutex::new(Vec::new());

/// Enrols the unperturbed parts.
pub(super) fn originals(
    most: usize,
    watch: &dyn ProgressObserver,
) -> Result<Vec<Reference>, ScalingError> {
    let mut enrolled = lock(&ENROLLED);
    let all = (0..NUM_MODELS).flat_map(|model| PartKind::ALL.map(|kind| (kind, model)));
    for (kind, model) in all.take(most).skip(enrolled.len()) {
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        let original = enrol_part(kind, Side::Left, model, &EnrolParams::default())?;
        enrolled.push(original.without_cloud());
    }
    Ok(enrolled.iter().take(most).cloned().collect())
}

/// Returns an original, or a perturbed copy of one with only the data that this matcher uses.
pub(super) fn nth_reference(originals: &[Reference], index: usize, matcher: Matcher) -> Reference {
    let original = &originals[index % originals.len()];
    if index < originals.len() {
        return original.clone();
    }
    let mut random = Pcg64::seed_from_u64(index as u64);
    let swing = ScaleCurve::new(&mut random);
    let mut copy = original.clone();
    copy.name = format!("{}_{index}", original.name);
    match matcher {
        Matcher::Default => {
            let views = original.views.iter().map(|view| perturb(view, &swing));
            copy = copy.with_views(views.collect());
            copy.summaries();
            copy.views.iter_mut().for_each(ReferenceView::drop_shape);
        }
        Matcher::Paper => {
            let mut signature = original.literal().signature.clone();
            let num = signature.lengths.len();
            for (k, length) in signature.lengths.iter_mut().enumerate() {
                *length *= swing.at(k, num);
            }
            copy = copy.with_literal(LiteralReference::new(signature));
            copy.views.clear();
        }
    }
    copy
}

/// A factor that varies a few times around the outline.
struct ScaleCurve {
    waves: [[f64; 2]; 4],
}

impl ScaleCurve {
    fn new(random: &mut Pcg64) -> Self {
        let mut wave = || {
            [
                random.random_range(-0.02..0.02),
                random.random_range(0.0..std::f64::consts::TAU),
            ]
        };
        Self {
            waves: [wave(), wave(), wave(), wave()],
        }
    }

    fn at(&self, k: usize, num: usize) -> f64 {
        let turn = std::f64::consts::TAU * k as f64 / num.max(1) as f64;
        let waves = self.waves.iter().zip(1..);
        1.0 + waves
            .map(|([height, phase], times)| height * (f64::from(times) * turn + phase).cos())
            .sum::<f64>()
    }
}

fn perturb(view: &ReferenceView, swing: &ScaleCurve) -> ReferenceView {
    let mut signature = view.signature().clone();
    let num = signature.rays.len();
    for (k, ray) in signature.rays.iter_mut().enumerate() {
        *ray *= swing.at(k, num);
    }
    view.with_signature(signature)
}
