//! Inspects the frames of a suite and counts the results.

use serde::Serialize;

use super::{Suite, SuiteCase, SuiteFrame, rack::rack_cases};
use geometry::{parallel::on_one_core, statistics::quantile};
use inspection::{
    library::Library,
    pipeline::{Inspection, Recipe, Unwatched, run, run_all},
};
use stages::scene::{SceneCloud, scene_from_frame};

/// Results of a suite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteResult {
    /// The suite.
    pub suite: Suite,
    /// One case per frame; of a rack, one per thing that hangs there and per surplus inspection.
    pub cases: Vec<SuiteCase>,
}

impl SuiteResult {
    /// Counts the cases that satisfy a predicate.
    pub fn num(&self, is_so: impl Fn(&SuiteCase) -> bool) -> usize {
        self.cases.iter().filter(|case| is_so(case)).count()
    }

    /// Returns the median time of an inspection, milliseconds.
    pub fn median_ms(&self) -> Option<f64> {
        self.ms_quantile(0.5)
    }

    /// Returns a quantile (0..1) of the time of an inspection, milliseconds.
    pub fn ms_quantile(&self, share: f64) -> Option<f64> {
        quantile(self.cases.iter().filter_map(|case| case.total_ms), share)
    }

    /// Returns a quantile (0..1) of the pose errors: degrees and millimetres, each on its own.
    pub fn pose_off_quantile(&self, share: f64) -> Option<[f64; 2]> {
        let of = |part: usize| {
            let offs = self.cases.iter().filter_map(SuiteCase::pose_off);
            quantile(offs.map(|off| off[part]), share)
        };
        Some([of(0)?, of(1)?])
    }

    /// Returns what was taken for what, how often and how often accepted, the worst first.
    pub fn confusions(&self) -> Vec<ConfusionEntry> {
        let mut confusions: Vec<ConfusionEntry> = Vec::new();
        let is_wrong = |case: &&SuiteCase| !case.is_right() || case.is_wrong_accepted();
        for case in self.cases.iter().filter(is_wrong) {
            let known = confusions
                .iter_mut()
                .find(|c| c.subject == case.subject && c.found == case.found);
            let accepted = usize::from(case.accepted);
            match known {
                Some(known) => {
                    known.num += 1;
                    known.num_accepted += accepted;
                }
                None => confusions.push(ConfusionEntry {
                    subject: case.subject.clone(),
                    found: case.found.clone(),
                    num: 1,
                    num_accepted: accepted,
                    first_seed: case.seed,
                }),
            }
        }
        confusions.sort_by_key(|c| std::cmp::Reverse((c.num_accepted, c.num)));
        confusions
    }
}

/// One confusion.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ConfusionEntry {
    /// Name of what hung in the cell.
    pub subject: String,
    /// The name found; `None` for nothing.
    pub found: Option<String>,
    /// Number of occurrences.
    pub num: usize,
    /// Number of accepted ones among them.
    pub num_accepted: usize,
    /// Seed of the first such frame.
    pub first_seed: u64,
}

/// A frame that was inspected.
#[derive(Debug)]
pub struct InspectedFrame {
    /// What the camera saw.
    pub scene: SceneCloud,
    /// Its cases, each with its inspection; without one if the thing was not inspected.
    pub cases: Vec<(SuiteCase, Option<Inspection>)>,
}

/// Inspects the frames of a suite on one core, and calls `after_each` with each. On a rack, as many parts may be accepted as it
/// has places.
pub fn run_suite(
    suite: Suite,
    frames: &[SuiteFrame],
    library: &Library,
    recipe: &Recipe,
    mut after_each: impl FnMut(&InspectedFrame),
) -> SuiteResult {
    let mut cases = Vec::with_capacity(frames.len());
    for frame in frames {
        let shot = frame.shot(suite);
        let scene = scene_from_frame(&shot.frame);
        let inspected = match frame {
            SuiteFrame::Cell(_) => {
                let inspection = on_one_core(|| run(&scene, library, recipe, &Unwatched));
                let inspection = inspection.expect("not cancelled");
                let case = SuiteCase::of(&shot, &shot.things[0], Some(&inspection));
                vec![(case, Some(inspection))]
            }
            SuiteFrame::Rack(rack) => {
                let mut recipe = recipe.clone();
                recipe.segment.max_parts = rack.places.len();
                let found = on_one_core(|| run_all(&scene, library, &recipe, &Unwatched));
                rack_cases(&shot, found.expect("not cancelled"))
            }
        };
        let inspected = InspectedFrame {
            scene,
            cases: inspected,
        };
        after_each(&inspected);
        cases.extend(inspected.cases.into_iter().map(|(case, _)| case));
    }
    SuiteResult { suite, cases }
}
