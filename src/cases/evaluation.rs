//! A folder of cases inspected one by one, and what it comes to.
//!
//! Cases are shared among workers; the results are in the order of the cases and, but for the times, the same for any
//! number of workers. A case whose scene is damaged is named and left out, the others count.

use std::collections::BTreeSet;

use super::{
    calibration::Calibration,
    confusion::{Confusion, Tally},
    error::CaseError,
    judge::{CaseResult, Found, Truth},
    store::{CaseFolder, CaseList, KeptCase},
};
use crate::{
    geometry::{parallel::map_in_order, rigid::pose_error},
    library::{CloudCheck, Library},
    pipeline::{self, Cancelled, Inspection, Recipe, Unwatched, Watch},
    stages::scene::SceneCloud,
};

/// Inspects cases and holds what is found against the truth.
pub struct CaseJudge<'a> {
    library: &'a Library,
    recipe: &'a Recipe,
    /// The checksum of each reference's cloud.
    clouds: Vec<String>,
}

impl<'a> CaseJudge<'a> {
    /// With this library and recipe.
    pub fn new(library: &'a Library, recipe: &'a Recipe) -> Self {
        let references = library.references.iter();
        let clouds = references.map(|reference| CloudCheck::of_cloud(&reference.cloud).crc32);
        Self {
            library,
            recipe,
            clouds: clouds.collect(),
        }
    }

    /// Inspects the scene of a case.
    pub fn judge(
        &self,
        case: &KeptCase,
        scene: &SceneCloud,
        watch: &dyn Watch,
    ) -> Result<CaseResult, Cancelled> {
        let inspection = pipeline::run(scene, self.library, self.recipe, watch)?;
        let about = &case.meta.about;
        let mut result = CaseResult {
            name: case.name.clone(),
            difficulty: about.difficulty.clone(),
            truth: about.truth.clone(),
            found: Found::from(&inspection.verdict),
            pose_error: None,
            timings: inspection.timings,
        };
        if result.is_guess_right() == Some(true) {
            result.pose_error = self.pose_error(case, &inspection);
        }
        Ok(result)
    }

    fn pose_error(
        &self,
        case: &KeptCase,
        inspection: &Inspection,
    ) -> Option<crate::geometry::rigid::PoseError> {
        let truth = case.meta.about.pose.as_ref()?;
        let found = inspection.pose.as_ref()?.as_ref().ok()?;
        let place = inspection.ranking.entries.first()?.reference;
        let is_of_it = |crc32: &String| self.clouds.get(place) == Some(crc32);
        if !truth.cloud_crc32.as_ref().is_none_or(is_of_it) {
            return None;
        }
        let (low, high) = self.library.references.get(place)?.cloud.bounds()?;
        let middle = nalgebra::center(&low, &high).cast::<f64>();
        Some(pose_error(
            &found.camera_from_part(),
            &truth.camera_from_part,
            &middle,
        ))
    }
}

/// What a folder of cases comes to.
#[derive(Debug, Default)]
pub struct Evaluation {
    /// One result per case that could be read, in the order of the cases.
    pub results: Vec<CaseResult>,
    /// The cases that could not.
    pub problems: Vec<CaseError>,
    /// What was taken for what.
    pub confusion: Confusion,
    /// By what it truly is, in the order of the matrix' rows.
    pub by_truth: Vec<(Truth, Tally)>,
    /// By difficulty, in the order of the words; those without one come first.
    pub by_difficulty: Vec<(Option<String>, Tally)>,
    /// Scores against shares.
    pub calibration: Calibration,
}

impl Evaluation {
    /// Of these results; `order` names the library's parts.
    pub fn of(results: Vec<CaseResult>, problems: Vec<CaseError>, order: &[String]) -> Self {
        let confusion = Confusion::of(&results, order);
        let tally_where =
            |is: &dyn Fn(&CaseResult) -> bool| Tally::of(results.iter().filter(|r| is(r)));
        let rows = confusion.rows.iter();
        let by_truth = rows.map(|row| (row.clone(), tally_where(&|r| r.truth == *row)));
        let words: BTreeSet<Option<String>> =
            results.iter().map(|r| r.difficulty.clone()).collect();
        let by_difficulty = words.into_iter().map(|difficulty| {
            let tally = tally_where(&|r| r.difficulty == difficulty);
            (difficulty, tally)
        });
        Self {
            by_truth: by_truth.collect(),
            by_difficulty: by_difficulty.collect(),
            calibration: Calibration::of(&results),
            confusion,
            problems,
            results,
        }
    }
}

/// Runs all cases by so many workers; `after_each` is called from them.
pub fn evaluate(
    folder: &CaseFolder,
    list: CaseList,
    judge: &CaseJudge<'_>,
    num_workers: usize,
    after_each: &(dyn Fn(&KeptCase) + Sync),
) -> Evaluation {
    let CaseList {
        cases,
        mut problems,
    } = list;
    let inspect = |(): &mut (), place: usize| {
        let case = &cases[place];
        let judged = folder.read_scene(case).map(|scene| {
            let judged = judge.judge(case, &scene, &Unwatched);
            judged.expect("nobody is there to cancel")
        });
        after_each(case);
        judged
    };
    let mut results = Vec::new();
    for judged in map_in_order(cases.len(), num_workers, || (), inspect) {
        match judged {
            Ok(result) => results.push(result),
            Err(problem) => problems.push(problem),
        }
    }
    let references = judge.library.references.iter();
    let order: Vec<String> = references.map(|r| r.name.clone()).collect();
    Evaluation::of(results, problems, &order)
}
