//! Racks that are inspected with an expectation: the right one, one with another part, one with a part more, and one part
//! alone of those that hang there.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::Serialize;

use super::{Suite, SuiteFrame, rack::rack_cases};
use geometry::parallel::on_one_core;
use inspection::{
    library::Library,
    pipeline::{Expected, Inspection, Recipe, Rejection, Unwatched, run_all},
};
use stages::scene::scene_from_frame;

/// How an expectation differs from what hangs on the rack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Expectation {
    /// Every enrolled part that hangs there.
    Right,
    /// One of them is replaced by another enrolled part.
    Wrong,
    /// One more enrolled part than hangs there.
    Missing,
    /// One of those that hang there alone.
    One,
}

impl Expectation {
    /// All of them; the frames of a suite have them in turn.
    pub const ALL: [Self; 4] = [Self::Right, Self::Wrong, Self::Missing, Self::One];

    /// Returns the name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::Missing => "missing",
            Self::One => "one of them",
        }
    }
}

/// The verdicts on the racks of one kind of expectation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ExpectationFigures {
    /// The expectation.
    pub expectation: Expectation,
    /// Number of frames.
    pub num_frames: usize,
    /// Number of parts on them that were accepted as another one, or though nothing enrolled hangs there.
    pub num_wrong_accepted: usize,
    /// Number of frames that were called as expected.
    pub num_met: usize,
    /// Number of frames with the right verdict: as expected; the replaced part is named with the one that is expected
    /// instead; the absent part is missing; the one part is accepted, and it is as expected only if nothing else hangs there.
    pub num_right: usize,
}

impl ExpectationFigures {
    /// Creates the figures of each expectation, without frames.
    pub fn none() -> [Self; 4] {
        Expectation::ALL.map(|expectation| Self {
            expectation,
            num_frames: 0,
            num_wrong_accepted: 0,
            num_met: 0,
            num_right: 0,
        })
    }
}

/// Inspects the racks of a suite on one core, each with one of the expectations in turn; adds the verdicts to `figures`, and
/// calls `after_each` after each frame.
pub fn add_expected_racks(
    suite: Suite,
    frames: &[SuiteFrame],
    library: &Library,
    recipe: &Recipe,
    figures: &mut [ExpectationFigures; 4],
    mut after_each: impl FnMut(),
) {
    for (index, frame) in frames.iter().enumerate() {
        figures[index % Expectation::ALL.len()].add(suite, frame, library, recipe);
        after_each();
    }
}

impl ExpectationFigures {
    fn add(&mut self, suite: Suite, frame: &SuiteFrame, library: &Library, recipe: &Recipe) {
        let shot = frame.shot(suite);
        let hung = shot
            .things
            .iter()
            .filter_map(|thing| thing.expected.clone());
        let mut names: Vec<String> = hung.collect();
        let absent = (library.references.iter().map(|reference| &reference.name))
            .filter(|name| !names.contains(name));
        let absent: Vec<&String> = absent.collect();
        let mut random = Pcg64::seed_from_u64(shot.seed);
        let absent = absent[random.random_range(0..absent.len())].clone();
        let mut replaced = None;
        match self.expectation {
            Expectation::Right => {}
            Expectation::Wrong => {
                let index = random.random_range(0..names.len());
                replaced = Some(std::mem::replace(&mut names[index], absent.clone()));
            }
            Expectation::Missing => names.push(absent.clone()),
            Expectation::One => {
                let one = random.random_range(0..names.len());
                names.swap(0, one);
            }
        }
        let mut recipe = recipe.clone();
        let num_expected = match self.expectation {
            Expectation::One => 1,
            _ => names.len(),
        };
        let parts = names[..num_expected]
            .iter()
            .map(|name| name.as_str().into());
        let expected = Expected::new(parts.collect(), Some(&recipe.rack), |_| true);
        recipe.expected = expected.expect("up to 6 parts");
        let scene = scene_from_frame(&shot.frame);
        let found = on_one_core(|| run_all(&scene, library, &recipe, &Unwatched));
        let found = found.expect("not cancelled");
        let all: Vec<&Inspection> = found.iter().collect();
        let is_met = recipe.expected.is_met(&all);
        let is_right = match &replaced {
            None => match self.expectation {
                Expectation::Missing => {
                    let missing = recipe.expected.missing(&all);
                    missing.iter().any(|part| part.name == absent)
                }
                Expectation::One => {
                    let mut accepted = all.iter().filter(|one| one.verdict.is_accepted());
                    let is_found = accepted.any(|one| one.verdict.guess() == Some(&names[0]));
                    is_found && is_met == (names.len() == 1)
                }
                Expectation::Right | Expectation::Wrong => is_met,
            },
            Some(replaced) => all.iter().any(|one| {
                matches!(one.verdict.rejected(), Some(Rejection::WrongPart { part, expected })
                    if part == replaced && *expected == absent)
            }),
        };
        self.num_frames += 1;
        self.num_met += usize::from(is_met);
        self.num_right += usize::from(is_right);
        let cases = rack_cases(&shot, found).into_iter();
        self.num_wrong_accepted += cases.filter(|(case, _)| case.is_wrong_accepted()).count();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suites::{SuiteLibraries, TUNING_SEED};

    #[test]
    fn right_wrong_missing_and_surplus_parts_are_told_apart() {
        let libraries = SuiteLibraries::shared();
        let suite = Suite::RackApart;
        let frames = suite.frames(4, TUNING_SEED);
        let mut figures = ExpectationFigures::none();
        let (library, recipe) = (libraries.for_suite(suite), Recipe::default());
        let mut num = 0;
        add_expected_racks(suite, &frames, library, &recipe, &mut figures, || num += 1);
        assert_eq!(num, 4);
        for (figures, is_met) in figures.iter().zip([1, 0, 0, 0]) {
            let nums = [
                figures.num_frames,
                figures.num_wrong_accepted,
                figures.num_met,
                figures.num_right,
            ];
            assert_eq!(nums, [1, 0, is_met, 1], "{figures:?}");
        }
    }
}
