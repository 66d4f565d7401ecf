//! Which inspection of a rack is of which thing, and what only racks are counted for.

use nalgebra::Point3;
use serde::Serialize;

use super::{Suite, SuiteCase, SuiteResult, SuiteShot, SuiteThing, Surplus, enrolment_pose};
use geometry::statistics::quantile;
use inspection::pipeline::Inspection;
use simulate::SurfaceLabel;
use stages::segment::PointLabel;

/// Share of the inspected readings that must show things for the inspection to be of one.
const LEAST_SHARE_OF_THINGS: f64 = 0.5;

/// Creates the cases of a rack: one per thing, from left to right, then one per surplus inspection.
///
/// Of several inspections of a thing, the accepted one counts, and of these the one with most readings of it.
pub(super) fn rack_cases(
    shot: &SuiteShot,
    found: Vec<Inspection>,
) -> Vec<(SuiteCase, Option<Inspection>)> {
    let mut found: Vec<_> = found
        .into_iter()
        .map(|inspection| {
            let nums = num_readings(shot, &inspection);
            let thing = thing_of(shot, &inspection, &nums);
            let num = thing.map_or(0, |thing| nums[thing]);
            (thing, num, inspection)
        })
        .collect();
    found.sort_by_key(|(_, num, inspection)| {
        std::cmp::Reverse((inspection.verdict.is_accepted(), *num))
    });
    let mut of_things: Vec<Option<Inspection>> = shot.things.iter().map(|_| None).collect();
    let mut surplus = Vec::new();
    for (thing, _, inspection) in found {
        let (why, name) = match thing {
            Some(thing) if of_things[thing].is_none() => {
                of_things[thing] = Some(inspection);
                continue;
            }
            Some(thing) => (Surplus::Again, format!("{} again", shot.things[thing].name)),
            None => (Surplus::Nothing, "nothing".to_owned()),
        };
        let thing = SuiteThing {
            name,
            expected: None,
            label: SurfaceLabel::Background,
            truth: None,
        };
        let case = SuiteCase {
            surplus: Some(why),
            ..SuiteCase::of(shot, &thing, Some(&inspection))
        };
        surplus.push((case, Some(inspection)));
    }
    let things = shot.things.iter().zip(of_things);
    let cases = things
        .map(|(thing, inspection)| (SuiteCase::of(shot, thing, inspection.as_ref()), inspection));
    cases.chain(surplus).collect()
}

/// Counts the inspected readings that show each thing.
fn num_readings(shot: &SuiteShot, inspection: &Inspection) -> Vec<usize> {
    let taken = shot.labels.iter().zip(&inspection.segmentation.labels);
    let taken = taken.filter(|(_, taken_for)| **taken_for == PointLabel::Part);
    let mut nums = vec![0; shot.things.len()];
    for (label, _) in taken {
        if let SurfaceLabel::RackPart(thing) = label {
            nums[usize::from(*thing)] += 1;
        }
    }
    nums
}

/// Returns which thing was inspected: the one nearest to an accepted part, otherwise the one with most of the readings.
fn thing_of(shot: &SuiteShot, inspection: &Inspection, nums: &[usize]) -> Option<usize> {
    let taken = inspection.segmentation.labels.iter();
    let num_taken = taken.filter(|label| **label == PointLabel::Part).count();
    let num_of_things: usize = nums.iter().sum();
    if num_of_things == 0 || (num_of_things as f64) < LEAST_SHARE_OF_THINGS * num_taken as f64 {
        return None;
    }
    let things = 0..shot.things.len();
    let accepted = inspection
        .found_pose()
        .filter(|_| inspection.verdict.is_accepted());
    let Some(pose) = accepted else {
        return things.max_by_key(|thing| nums[*thing]);
    };
    let middle = enrolment_pose() * Point3::origin();
    let distance = |thing: usize| {
        let truth = shot.things[thing].camera_from_reference();
        truth.map_or(f64::INFINITY, |truth| {
            (pose.camera_from_part() * middle - truth * middle).norm()
        })
    };
    things.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
}

/// What only racks are counted for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RackFigures {
    /// The suite.
    pub suite: Suite,
    /// Number of frames.
    pub num_frames: usize,
    /// Number of enrolled parts.
    pub num_parts: usize,
    /// Of these, those that were not inspected.
    pub num_parts_missed: usize,
    /// Number of acceptances of a part, or other thing, of which another inspection was accepted too.
    pub num_accepted_again: usize,
    /// Number of acceptances where nothing hangs.
    pub num_nothing_accepted: usize,
    /// Number of objects and parts that are not enrolled.
    pub num_unknown: usize,
    /// Of these, those whose verdict is unknown, or mirror image.
    pub num_unknown_told: usize,
    /// Of these, those that were not inspected.
    pub num_unknown_missed: usize,
    /// Number of surplus inspections that were not accepted.
    pub num_surplus_refused: usize,
    /// Median time of a frame, milliseconds.
    pub median_ms: Option<f64>,
}

impl RackFigures {
    /// Computes the figures of a suite; `None` if it shows no racks.
    pub fn of(result: &SuiteResult) -> Option<Self> {
        result.suite.rack()?;
        let is_part = |c: &SuiteCase| c.expected.is_some();
        let is_unknown = |c: &SuiteCase| c.expected.is_none() && c.surplus.is_none();
        let is_missed = |c: &SuiteCase| c.timings.is_none();
        let frames = || result.cases.chunk_by(|a, b| a.seed == b.seed);
        let ms = frames().map(|cases| cases.iter().filter_map(|case| case.total_ms).sum());
        Some(Self {
            suite: result.suite,
            num_frames: frames().count(),
            num_parts: result.num(is_part),
            num_parts_missed: result.num(|c| is_part(c) && is_missed(c)),
            num_accepted_again: result.num(|c| c.accepted && c.surplus == Some(Surplus::Again)),
            num_nothing_accepted: result.num(|c| c.accepted && c.surplus == Some(Surplus::Nothing)),
            num_unknown: result.num(is_unknown),
            num_unknown_told: result.num(|c| is_unknown(c) && c.is_unknown),
            num_unknown_missed: result.num(|c| is_unknown(c) && is_missed(c)),
            num_surplus_refused: result.num(|c| c.surplus.is_some() && !c.accepted),
            median_ms: quantile(ms, 0.5),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suites::{MEASURING_SEED, SuiteLibraries, TUNING_SEED, run_suite};
    use inspection::pipeline::{Recipe, Unwatched, run_all};
    use stages::scene::scene_from_frame;

    #[test]
    fn every_thing_on_a_rack_is_a_case() {
        let libraries = SuiteLibraries::shared();
        for suite in [Suite::RackEqual, Suite::RackMirrored, Suite::RackOnBar] {
            let frames = suite.frames(2, TUNING_SEED);
            let library = libraries.for_suite(suite);
            let result = run_suite(suite, &frames, library, &Recipe::default(), |frame| {
                for (case, inspection) in &frame.cases {
                    assert_eq!(case.timings.is_some(), inspection.is_some());
                }
            });
            let figures = RackFigures::of(&result).expect("racks");
            let num_unknown = if suite == Suite::RackMirrored { 2 } else { 0 };
            assert_eq!(figures.num_frames, 2);
            assert_eq!(
                (figures.num_parts, figures.num_unknown),
                (5 - num_unknown, num_unknown),
                "{suite:?}"
            );
            let is_placed = |case: &&SuiteCase| case.is_right() && case.is_well_placed();
            let num_placed = result.cases.iter().filter(is_placed).count();
            assert_eq!(num_placed, figures.num_parts, "{suite:?}");
            assert_eq!(result.num(SuiteCase::is_wrong_accepted), 0, "{suite:?}");
            for case in result.cases.iter().filter(|c| c.surplus.is_none()) {
                let is_left = !case.subject.ends_with("_right");
                assert_eq!(case.expected.is_some(), is_left, "{case:?}");
            }
        }
    }

    #[test]
    fn a_stool_beside_large_parts_is_told_as_unknown_and_the_bar_that_they_hang_on_is_not() {
        let libraries = SuiteLibraries::shared();
        for (suite, index) in [(Suite::RackForeign, 1), (Suite::RackOnBar, 0)] {
            let frames = suite.frames(2, MEASURING_SEED);
            let library = libraries.for_suite(suite);
            let recipe = Recipe::default();
            let result = run_suite(suite, &frames[index..=index], library, &recipe, |_| {});
            let stools = result.cases.iter().filter(|case| case.subject == "stool");
            assert_eq!(stools.clone().count(), index);
            assert!(stools.clone().all(|case| case.is_unknown), "{result:?}");
            assert_eq!(result.num(|case| case.surplus.is_some()), 0, "{result:?}");
        }
    }

    #[test]
    fn a_second_acceptance_and_one_where_nothing_hangs_are_false_accepts() {
        let suite = Suite::RackApart;
        let mut shot = suite.frames(1, TUNING_SEED)[0].shot(suite);
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 2;
        let scene = scene_from_frame(&shot.frame);
        let libraries = SuiteLibraries::shared();
        let found = run_all(&scene, libraries.for_suite(suite), &recipe, &Unwatched);
        let found = found.expect("not cancelled");
        let result = |shot: &SuiteShot, found: &[Inspection]| {
            let cases = rack_cases(shot, found.to_vec());
            let cases = cases.into_iter().map(|(case, _)| case).collect();
            SuiteResult { suite, cases }
        };
        let right = result(&shot, &found);
        assert_eq!(right.num(|c| c.is_right() && c.accepted), 2);
        assert_eq!(right.cases.len(), 2);

        let missed = result(&shot, &found[1..]);
        assert_eq!(
            [&missed.cases[0].found, &missed.cases[1].found],
            [&None, &right.cases[1].found]
        );
        assert_eq!(RackFigures::of(&missed).expect("racks").num_parts_missed, 1);

        let twice = result(&shot, &[found.clone(), found.clone()].concat());
        let figures = RackFigures::of(&twice).expect("racks");
        assert_eq!(twice.num(SuiteCase::is_wrong_accepted), 2);
        assert_eq!(
            (figures.num_accepted_again, figures.num_nothing_accepted),
            (2, 0)
        );

        // Another name is wrong, however near it is.
        for thing in &mut shot.things {
            thing.expected = Some("another".into());
        }
        assert_eq!(result(&shot, &found).num(SuiteCase::is_wrong_accepted), 2);

        shot.labels.fill(SurfaceLabel::Wall);
        let nothing = result(&shot, &found);
        let figures = RackFigures::of(&nothing).expect("racks");
        assert_eq!(nothing.num(SuiteCase::is_wrong_accepted), 2);
        assert_eq!(
            (figures.num_accepted_again, figures.num_nothing_accepted),
            (0, 2)
        );
        assert_eq!(figures.num_parts_missed, 2);
    }
}
