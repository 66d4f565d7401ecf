//! Inspects a folder of cases and summarises the results.
//!
//! Several workers share the cases. The results are in the order of the cases and, except for the times, do not depend on
//! the number of workers. A case whose scene is damaged is reported and not counted.

use std::collections::BTreeSet;

use super::{
    calibration::Calibration,
    confusion::{Confusion, Tally},
    error::CaseError,
    judge::{CaseResult, FoundVerdict, Truth},
    meta::inspect_case,
    store::{CaseFolder, CaseList, KeptCase},
    trade_off::TradeOff,
};
use geometry::{
    parallel::map_each,
    rigid::{PoseDelta, pose_error},
};
use inspection::{
    library::{FileCheck, Library},
    pipeline::{Cancelled, Inspection, ProgressObserver, Recipe, Unwatched},
};
use stages::scene::SceneCloud;

/// Inspects cases and compares the verdicts with the true labels.
pub struct CaseJudge<'a> {
    library: &'a Library,
    recipe: &'a Recipe,
    /// The checksum of each reference's cloud.
    clouds: Vec<String>,
}

impl<'a> CaseJudge<'a> {
    /// Uses this library and recipe.
    pub fn new(library: &'a Library, recipe: &'a Recipe) -> Self {
        let references = library.references.iter();
        let clouds = references.map(|reference| FileCheck::of_cloud(&reference.cloud).crc32);
        Self {
            library,
            recipe,
            clouds: clouds.collect(),
        }
    }

    /// Inspects the scene of a case and compares the verdict with its true label.
    pub fn judge(
        &self,
        case: &KeptCase,
        scene: &SceneCloud,
        watch: &dyn ProgressObserver,
    ) -> Result<CaseResult, Cancelled> {
        let about = &case.meta.about;
        let (one, name) = (about.one_of_several.as_ref(), about.found.part.as_deref());
        let inspection = inspect_case(scene, one, name, self.library, self.recipe, watch)?;
        Ok(self.compare(case, &inspection))
    }

    /// Compares an inspection of a case's scene, by this library, with its truth.
    pub fn compare(&self, case: &KeptCase, inspection: &Inspection) -> CaseResult {
        let about = &case.meta.about;
        let mut result = CaseResult {
            name: case.name.clone(),
            difficulty: about.difficulty.clone(),
            truth: about.truth.clone(),
            found: FoundVerdict::from(&inspection.verdict),
            pose_error: None,
            timings: inspection.timings,
        };
        if result.is_guess_right() == Some(true) {
            result.pose_error = self.pose_error(case, inspection);
        }
        result
    }

    /// Summarises results of this judge.
    pub fn summarise(&self, results: Vec<CaseResult>, problems: Vec<CaseError>) -> Evaluation {
        let references = self.library.references.iter();
        let order: Vec<String> = references.map(|r| r.name.clone()).collect();
        Evaluation::of(results, problems, &order)
    }

    fn pose_error(&self, case: &KeptCase, inspection: &Inspection) -> Option<PoseDelta> {
        let truth = case.meta.about.pose.as_ref()?;
        let found = inspection.found_pose()?;
        let reference = inspection.ranking.entries.first()?.reference;
        let is_of_it = |crc32: &String| self.clouds.get(reference) == Some(crc32);
        if !truth.cloud_crc32.as_ref().is_none_or(is_of_it) {
            return None;
        }
        let middle = self.library.references.get(reference)?.middle()?;
        Some(pose_error(
            &found.camera_from_part(),
            &truth.camera_from_part,
            &middle,
        ))
    }
}

/// The results of a folder of cases, and their summary.
#[derive(Debug, Default)]
pub struct Evaluation {
    /// One result per case that could be read, in the order of the cases.
    pub results: Vec<CaseResult>,
    /// The cases that could not be read.
    pub problems: Vec<CaseError>,
    /// True labels against answers.
    pub confusion: Confusion,
    /// Counts per true label, in the order of the matrix' rows.
    pub by_truth: Vec<(Truth, Tally)>,
    /// Counts per difficulty in alphabetical order; cases without one come first.
    pub by_difficulty: Vec<(Option<String>, Tally)>,
    /// Scores compared with the shares of right guesses.
    pub calibration: Calibration,
    /// False accepts and wrong refusals at every threshold on the score.
    pub trade_off: TradeOff,
}

impl Evaluation {
    /// Summarises these results; `order` lists the library's parts.
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
            trade_off: TradeOff::of(&results),
            confusion,
            problems,
            results,
        }
    }
}

/// Inspects all cases on `num_workers` threads. Each thread calls `after_each` after a case.
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
    let inspect = |index: usize| {
        let case = &cases[index];
        let judged = folder.read_scene(case).map(|scene| {
            let judged = judge.judge(case, &scene, &Unwatched);
            judged.expect("nobody is there to cancel")
        });
        after_each(case);
        judged
    };
    let mut results = Vec::new();
    for judged in map_each(cases.len(), num_workers, inspect) {
        match judged {
            Ok(result) => results.push(result),
            Err(problem) => problems.push(problem),
        }
    }
    judge.summarise(results, problems)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{CaseDescription, CaseOutcome, OneOfSeveral, TruePose};
    use inspection::pipeline;
    use inspection::{fixtures::shipped_library, library::shipped_enrolled_at};
    use simulate::{CellSetup, PartKind, RackKind, RackSetup, Side, frame, rack_frame};
    use stages::pose::PoseEstimate;
    use stages::scene::scene_from_frame;

    #[test]
    fn a_pose_is_judged_only_in_the_coordinates_of_the_cloud_that_it_is_of() {
        let library = shipped_library();
        let shot = frame(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 77));
        let at = shipped_enrolled_at("fender").expect("shipped");
        let camera_from_part = shot.truth.camera_from_part * at.part_from_model.inverse();
        let folder = tempfile::tempdir().expect("a folder");
        let cases = CaseFolder::at(folder.path());
        for (name, cloud_crc32) in [
            ("its_own", Some(at.cloud.crc32)),
            ("not_said", None),
            ("of_another", Some("00000000".into())),
        ] {
            let about = CaseDescription {
                origin: name.into(),
                simulated: true,
                kept_at: jiff::Timestamp::UNIX_EPOCH,
                remark: String::new(),
                difficulty: Some("placed".into()),
                truth: Truth::Part("fender".into()),
                found: FoundVerdict::default(),
                pose: Some(TruePose {
                    camera_from_part,
                    cloud_crc32,
                }),
                one_of_several: None,
            };
            let scene = scene_from_frame(&shot.frame);
            cases.keep(&scene, about).expect("kept");
        }
        let recipe = Recipe::default();
        let judge = CaseJudge::new(&library, &recipe);
        let list = cases.list().expect("listed");
        let evaluation = evaluate(&cases, list, &judge, 2, &|_| ());
        let judged = |name: &str| {
            let mut results = evaluation.results.iter();
            let result = results.find(|r| r.name == name).expect("there");
            assert_eq!(result.is_guess_right(), Some(true));
            result.pose_error
        };
        let error = judged("its_own").expect("known");
        assert!(
            error.rotation.degrees() < 2.0 && error.shift.mm() < 10.0,
            "{error:?}"
        );
        assert_eq!(judged("not_said"), Some(error));
        assert_eq!(judged("of_another"), None);
        assert_eq!(evaluation.by_difficulty.len(), 1);
    }

    #[test]
    fn a_case_of_one_of_several_parts_is_about_that_part() {
        let library = shipped_library();
        let setup = RackSetup::drawn(RackKind::Apart, 2, 0, 2).expect("two places");
        let rack = rack_frame(&setup).expect("a plain cell");
        let scene = scene_from_frame(&rack.frame);
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 2;
        let found = pipeline::run_all(&scene, &library, &recipe, &Unwatched).expect("two parts");
        let folder = tempfile::tempdir().expect("a folder");
        let cases = CaseFolder::at(folder.path());
        for one in &found {
            let name = one.verdict.guess().expect("a part");
            let pose = one.found_pose().map(PoseEstimate::camera_from_part);
            let about = CaseDescription {
                origin: name.into(),
                simulated: true,
                kept_at: jiff::Timestamp::UNIX_EPOCH,
                remark: String::new(),
                difficulty: None,
                truth: Truth::Part(name.into()),
                found: FoundVerdict::from(&one.verdict),
                pose: None,
                one_of_several: OneOfSeveral::of(&recipe, pose),
            };
            cases.keep(&scene, about).expect("kept");
        }
        // Whatever the recipe of the evaluation looks for.
        let recipe = Recipe::default();
        let judge = CaseJudge::new(&library, &recipe);
        let list = cases.list().expect("listed");
        let evaluation = evaluate(&cases, list, &judge, 1, &|_| ());
        assert_eq!(evaluation.results.len(), 2);
        for result in &evaluation.results {
            assert_eq!(result.judgement(), CaseOutcome::Right, "{result:?}");
        }
    }

    #[test]
    fn a_pose_that_is_no_rigid_transform_makes_a_case_damaged_and_a_missing_one_does_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let cases = CaseFolder::at(folder.path());
        let points = (0..12).map(|i| nalgebra::Point3::new(i as f32 * 0.1, 0.2, 1.0));
        let cloud = geometry::cloud::PointCloud::from_points(points);
        let about = CaseDescription {
            origin: "stretched".into(),
            simulated: true,
            kept_at: jiff::Timestamp::UNIX_EPOCH,
            remark: String::new(),
            difficulty: None,
            truth: Truth::Nothing,
            found: FoundVerdict::default(),
            pose: None,
            one_of_several: None,
        };
        let scene = stages::scene::scene_from_cloud(cloud);
        let kept = cases.keep(&scene, about).expect("kept");
        assert_eq!(cases.list().expect("listed").cases, [kept]);
        let toml = folder.path().join("stretched").join("case.toml");
        let text = std::fs::read_to_string(&toml).expect("read");
        assert!(!text.contains("pose") && !text.contains("difficulty"));
        let stretched =
            "\n[pose]\ncamera_from_part = [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";
        std::fs::write(&toml, text + stretched).expect("written");
        let list = cases.list().expect("listed");
        assert!(list.cases.is_empty());
        let problem = list.problems.first().expect("named").to_string();
        assert!(problem.contains("not a rigid transform"), "{problem}");
    }
}
