//! Finds the row spacing and the speed that bring a film to its target.
//!
//! The thickness is inversely proportional to the speed, so each spacing is planned once: the factor on the thickness
//! that brings most of the surface within the tolerance is found exactly, by a window over the sorted thicknesses.

use super::{
    coat::Coat,
    error::PaintError,
    even::Speed,
    film::{Film, simulate},
    plan::planned,
    region::KeepOut,
    surface::PaintSurface,
};
use inspection::library::SprayPath;

/// Spacings to be tried, as shares of the pattern's width at the stand-off, the fastest first.
const SPACING_SHARES: [f64; 4] = [0.4, 0.35, 0.3, 0.25];
/// Share of the paintable area within the tolerance that is good enough.
pub(super) const GOOD_WITHIN: f64 = 0.95;
/// Share of the paintable area that may be lost for a mean nearer to the target.
const MAX_LOST_SHARE: f64 = 0.005;
/// Range of a coat's speed, m/s.
pub(super) const SPEED_RANGE_M_S: [f64; 2] = [0.01, 3.0];

/// A coat with the best spacing and speed, its path and film.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The coat.
    pub coat: Coat,
    /// Its path.
    pub path: SprayPath,
    /// The film of the path.
    pub film: Film,
}

/// Proposes the widest spacing that brings 95 % of the paintable area within the tolerance, else the one that brings
/// most.
pub fn propose(
    surface: &PaintSurface,
    coat: &Coat,
    keep_outs: &[KeepOut],
) -> Result<Proposal, PaintError> {
    coat.check()?;
    let width = coat.gun.width * coat.stand_off / coat.gun.distance;
    let mut best: Option<Proposal> = None;
    for share in SPACING_SHARES {
        let spaced = Coat {
            // In whole millimetres, so that the value shown and stored is the one planned with.
            spacing: (1e3 * share * width).round() / 1e3,
            ..*coat
        };
        let (path, speed) = planned(surface, &spaced, keep_outs, Speed::ToTarget)?;
        let coat = Coat { speed, ..spaced };
        let path = coat.name_in(path);
        let film = simulate(surface, &path, &coat, keep_outs)?;
        let within = film.figures.within;
        if best
            .as_ref()
            .is_none_or(|best| within > best.film.figures.within)
        {
            best = Some(Proposal { coat, path, film });
        }
        if within >= GOOD_WITHIN {
            break;
        }
    }
    best.ok_or(PaintError::NoRows)
}

/// Returns the speed that brings most of a film within the coat's tolerance, m/s.
pub fn best_speed(film: &Film, coat: &Coat) -> f64 {
    let factor = best_factor(&film.thickness, &film.is_paintable, coat);
    (coat.speed / factor).clamp(SPEED_RANGE_M_S[0], SPEED_RANGE_M_S[1])
}

/// Returns the factor on all thicknesses that brings most of the paintable points within the tolerance. If more than
/// enough are within it, the factor moves towards a mean at the target: a film at the upper end of its tolerance wastes
/// paint.
pub(super) fn best_factor(thickness: &[f64], is_paintable: &[bool], coat: &Coat) -> f64 {
    let each = thickness.iter().zip(is_paintable);
    let mut reached: Vec<f64> = each.filter(|(_, is)| **is).map(|(t, _)| *t).collect();
    reached.sort_by(f64::total_cmp);
    let [low, high] = [1.0 - coat.tolerance, 1.0 + coat.tolerance];
    let (mut best, mut factor, mut first) = (0, 1.0, 0);
    for (last, most) in reached.iter().enumerate() {
        while *most > reached[first] * high / low {
            first += 1;
        }
        let num = last + 1 - first;
        if num > best && reached[first] > 0.0 {
            best = num;
            // Both ends are equally far from the limits of the tolerance, as ratios.
            factor = coat.target * (low * high).sqrt() / (reached[first] * most).sqrt();
        }
    }
    let num = reached.len() as f64;
    let share = |factor: f64| {
        let limit = |limit: f64| coat.target * limit / factor;
        let behind = reached.partition_point(|t| *t <= limit(high));
        (behind - reached.partition_point(|t| *t < limit(low))) as f64 / num
    };
    let most = share(factor);
    let enough = (most - MAX_LOST_SHARE).max(most.min(GOOD_WITHIN));
    let mean = reached.iter().sum::<f64>() / num;
    let (mut good, mut wanted) = (factor, coat.target / mean);
    for _ in 0..32 {
        let between = if share(wanted) >= enough {
            wanted
        } else {
            f64::midpoint(good, wanted)
        };
        if share(between) >= enough {
            good = between;
        } else {
            wanted = between;
        }
    }
    good
}

#[cfg(test)]
pub(super) mod tests {
    use std::{path::Path, sync::OnceLock};

    use super::*;
    use crate::paint::built_in_coat;
    use inspection::library::{LibraryFolder, StoredPart};
    use simulate::PartKind;
    use stages::reference::ReferenceParams;

    fn shipped_parts() -> LibraryFolder {
        let folder =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("reference_parts");
        LibraryFolder::open(&folder).expect("the shipped parts")
    }

    /// A shipped part, and what is proposed to paint it with the primer; once for all tests.
    pub(crate) fn proposed(name: &str) -> &'static (StoredPart, Proposal) {
        static PROPOSED: [OnceLock<(StoredPart, Proposal)>; PartKind::ALL.len()] =
            [const { OnceLock::new() }; PartKind::ALL.len()];
        let kind = PartKind::from_name(name).expect("a shipped part");
        PROPOSED[kind as usize].get_or_init(|| {
            let read = shipped_parts().read(name, &ReferenceParams::default());
            let part = read.expect("listed").expect("read");
            let (coverage, side) = (part.meta.coverage, part.meta.side);
            let surface = PaintSurface::of(&part.reference, coverage, side).expect("a surface");
            let coat = built_in_coat("primer").expect("built in").recipe;
            let proposal = propose(&surface, &coat, &[]).expect(name);
            (part, proposal)
        })
    }

    #[test]
    fn a_film_that_is_even_but_at_its_edges_is_brought_to_its_target_in_the_middle() {
        let surface = crate::paint::surface::tests::plate(1.0, 0.6);
        // No paint beyond the edges, so the film is thinner there.
        let coat = Coat {
            overrun: 0.06,
            ..Coat::default()
        };
        let found = propose(&surface, &coat, &[]).expect("proposed");
        let film = &found.film.figures;
        assert!(film.within >= 0.95, "{film:?}");
        assert!((film.mean / coat.target - 1.0).abs() < 0.03, "{film:?}");
    }

    #[test]
    fn the_shipped_parts_are_painted_within_tolerance() {
        let mut names = PartKind::ALL.map(PartKind::name);
        names.sort_unstable();
        assert_eq!(shipped_parts().names().expect("listed"), names);
        for name in names {
            let (_, found) = proposed(name);
            let film = &found.film.figures;
            // Ribs of the grille have flanks that neighbouring ribs hide even from the leaned gun.
            let least = if name == "grille" { 0.94 } else { 0.96 };
            assert!(film.within >= least, "{name}: {film:?}");
            let mean = film.mean / found.coat.target;
            assert!((mean - 1.0).abs() < 0.08, "{name}: {mean}");
        }
    }
}
