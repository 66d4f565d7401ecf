use std::{path::Path, time::Instant};

use jiff::Timestamp;

use super::*;
use crate::workspaces::compare::{kept_recipes::RecipeChange, matrix::Matrix};
use geometry::cloud::PointCloud;
use inspection::pipeline::{RecipeFolder, Replace};
use records::{
    cases::{
        Calibration, CaseDescription, CaseMeta, Confusion, FoundVerdict, SCHEMA_VERSION, TradeOff,
    },
    history::{FILE, FrameRecord},
};
use shell::{
    inspection::{inspected::inspected_cell, source::CellChoice},
    workspace::TestShell,
};
use stages::scene::{PictureEdge, scene_from_cloud};

fn kept(name: &str) -> KeptCase {
    let about = CaseDescription {
        origin: name.into(),
        simulated: true,
        kept_at: Timestamp::UNIX_EPOCH,
        remark: String::new(),
        difficulty: None,
        truth: Truth::Part("fender".into()),
        found: FoundVerdict::default(),
        pose: None,
        one_of_several: None,
    };
    let scene = FrameRecord {
        file: "scene.pcd".into(),
        bytes: 0,
        crc32: 0,
        edge: PictureEdge::View,
        camera: None,
        metres_per_unit: None,
        block_side: None,
        is_simulated: true,
        is_only_recent: false,
        empty_cell: None,
        empty_cell_crc32: None,
        shots: Vec::new(),
    };
    KeptCase {
        name: name.into(),
        meta: CaseMeta {
            schema_version: SCHEMA_VERSION,
            about,
            scene,
        },
    }
}

fn listed(done: CaseDone) -> CompareResult {
    listed_as(&["a", "b"], done)
}

fn listed_as(names: &[&str], done: CaseDone) -> CompareResult {
    CompareResult::Cases {
        cases: cases(names),
        problem: None,
        done,
        way: None,
    }
}

fn cases(names: &[&str]) -> Cases {
    Cases {
        folder: CaseFolder::at("cases"),
        list: names.iter().map(|name| kept(name)).collect(),
        problems: Arc::default(),
    }
}

/// An ended run over these cases.
fn ran(bench: &Bench, cases: Cases) -> CompareResult {
    CompareResult::Ran(Arc::new(CaseRun {
        recipe: Arc::clone(&bench.shell.session.recipe),
        results: Vec::new(),
        problems: Vec::new(),
        cases,
        matrix: Matrix::of(Confusion::of(&[], &[])),
        calibration: Calibration::of(&[]),
        trade_off: TradeOff::of(&[]),
        ended: Some(Timestamp::UNIX_EPOCH),
    }))
}

/// The workspace without a window; jobs do not run, and the test supplies their results.
struct Bench {
    compare: CompareState,
    shell: TestShell,
}

impl Bench {
    fn new() -> Self {
        Self {
            compare: CompareState::new(None, None, &TaskRunner::without_threads()),
            shell: TestShell::default(),
        }
    }

    /// The workspace on these folders of cases and recipes; the jobs that change them run in `work` and `work_on_recipes`.
    fn on_disk(folder: &Path) -> Self {
        let (cases, recipes) = (folder.join("cases"), folder.join("recipes"));
        let runner = TaskRunner::without_threads();
        Self {
            compare: CompareState::new(Some(cases), Some(recipes), &runner),
            shell: TestShell::default(),
        }
    }

    /// Runs the waiting changes of the kept cases.
    fn work(&mut self) {
        while self.at_work() == Some(JobKind::Cases) {
            assert!(self.compare.task.run_waiting());
            self.compare.update(&mut self.shell.context());
        }
    }

    /// Runs the waiting changes of the recipes.
    fn work_on_recipes(&mut self) {
        self.compare.update(&mut self.shell.context());
        while self.compare.recipes.task.run_waiting() {
            self.compare.update(&mut self.shell.context());
        }
    }

    /// Lists the recipes again, as after a change by another program.
    fn relist_recipes(&mut self) {
        let cx = &mut self.shell.context();
        self.compare.recipes.start(RecipeChange::List, cx);
        self.work_on_recipes();
    }

    fn names(&self) -> Vec<&str> {
        let cases = self.compare.cases.as_ref().expect("listed");
        cases.list.iter().map(|case| case.name.as_str()).collect()
    }

    /// Two kept cases, the first in front and under study.
    fn with_a_case() -> Self {
        let mut bench = Self::new();
        bench.act(CompareAction::Follow);
        assert_eq!(bench.at_work(), Some(JobKind::Cases));
        bench.done(listed(CaseDone::Listed));
        assert_eq!(bench.at_work(), None);
        bench.act(CompareAction::OpenCase("a".into()));
        assert_eq!(bench.at_work(), Some(JobKind::Study));
        let request = bench.compare.study_request(&bench.shell.session);
        let truth = request.expect("a case in front").truth;
        assert_eq!(truth, Some(Truth::Part("fender".into())));
        bench
    }

    fn act(&mut self, action: CompareAction) {
        self.compare.apply(action, &mut self.shell.context());
    }

    /// Finishes the running job with this result.
    fn done(&mut self, result: CompareResult) {
        self.compare.task.start("made up", move |_| Ok(result));
        assert!(self.compare.task.run_waiting());
        self.compare.update(&mut self.shell.context());
    }

    fn at_work(&self) -> Option<JobKind> {
        self.compare.running().and(self.compare.job)
    }

    fn is_behind(&self) -> bool {
        self.compare.is_behind(&self.shell.session)
    }
}

#[test]
fn a_change_of_the_kept_cases_is_never_pushed_out() {
    let mut bench = Bench::with_a_case();
    bench.act(CompareAction::Remove("b".into()));
    assert_eq!(bench.at_work(), Some(JobKind::Cases));
    // The study that it cancelled, and later requests, wait.
    bench.act(CompareAction::Set("accept.min_score", 0.5));
    bench.act(CompareAction::RunAll);
    assert_eq!(bench.at_work(), Some(JobKind::Cases));
    assert!(!bench.is_behind());
    let removed = CaseDone::Removed {
        name: "b".into(),
        trash: "trash/b".into(),
    };
    bench.done(listed(removed));
    assert!(bench.compare.is_running_cases());
    assert!(matches!(
        bench.compare.undo.done[..],
        [Undo::Cases(_, CaseEdit::Restore { .. })]
    ));
    // The recipe was changed before the run began: the case in front is still studied, as soon as possible.
    assert!(bench.is_behind());
    bench.act(CompareAction::Follow);
    assert_eq!(bench.at_work(), Some(JobKind::Study));
}

#[test]
fn another_recipe_gives_a_run_up_and_another_part_waits_for_its_end() {
    let mut bench = Bench::with_a_case();
    bench.act(CompareAction::RunAll);
    assert!(bench.compare.is_running_cases());
    bench.act(CompareAction::Against(Some("grille".into())));
    assert!(bench.compare.is_running_cases() && bench.compare.is_study_old());
    bench.act(CompareAction::Set("project.pixel", 4.0));
    assert_eq!(bench.at_work(), Some(JobKind::Study));
    let request = bench.compare.study_request(&bench.shell.session);
    let request = request.expect("a case in front");
    assert_eq!(request.recipe.project.pixel, geometry::units::Metres(0.004));
    assert_eq!(request.against.as_deref(), Some("grille"));
    assert!(!bench.compare.is_running_cases());
}

#[test]
fn a_run_is_outdated_until_it_covers_the_cases_that_are_kept_now() {
    let mut bench = Bench::with_a_case();
    let run = |bench: &Bench, names: &[&str]| ran(bench, cases(names));
    let of_two = run(&bench, &["a", "b"]);
    bench.done(of_two);
    assert_eq!(bench.compare.num_covered, None);
    let c_kept = CaseDone::Kept(Box::new(kept("c")));
    bench.done(listed_as(&["a", "b", "c"], c_kept));
    assert_eq!(bench.compare.num_covered, Some(2));
    let of_three = run(&bench, &["a", "b", "c"]);
    bench.done(of_three);
    assert_eq!(bench.compare.num_covered, None);
    let removed = |name: &str| CaseDone::Removed {
        name: name.into(),
        trash: "trash".into(),
    };
    bench.done(listed_as(&["a", "c"], removed("b")));
    assert_eq!(bench.compare.num_covered, Some(2));
    // Another case of the same name.
    let CompareResult::Cases { mut cases, .. } = listed_as(&["a", "b", "c"], CaseDone::Listed)
    else {
        unreachable!()
    };
    let other = Arc::get_mut(&mut cases.list).expect("the only one");
    other[1].meta.about.truth = Truth::NotEnrolled;
    bench.done(CompareResult::Cases {
        cases,
        problem: None,
        done: CaseDone::Listed,
        way: None,
    });
    assert_eq!(bench.compare.num_covered, Some(2));
    bench.done(listed_as(&["a", "b", "c"], CaseDone::Restored("b".into())));
    assert_eq!(bench.compare.num_covered, None);
    // A run that was cancelled or failed does not cover them either.
    let CompareResult::Ran(of_one) = run(&bench, &["a"]) else {
        unreachable!()
    };
    bench.compare.run = Some(of_one);
    bench.compare.cancel();
    assert_eq!(bench.compare.num_covered, Some(1));
    bench.compare.num_covered = None;
    let failed = UserError {
        what: "the folder is gone".into(),
        advice: String::new(),
    };
    let task = &mut bench.compare.task;
    task.start("made up", move |_| Err(failed.into()));
    assert!(task.run_waiting());
    bench.compare.update(&mut bench.shell.context());
    assert_eq!(bench.compare.num_covered, Some(1));
}

#[test]
fn why_no_case_was_kept_is_shown_until_its_truth_is_chosen_or_another_case_is_in_front() {
    let mut bench = Bench::with_a_case();
    bench.act(CompareAction::Keep);
    let Some(Action::Notify(notice)) = bench.shell.sent.last() else {
        panic!("{:?}", bench.shell.sent);
    };
    assert_eq!(notice.topic, NoticeTopic::Case);
    for action in [
        CompareAction::SetTruth(Truth::NotEnrolled),
        CompareAction::OpenCase("b".into()),
    ] {
        bench.shell.sent.clear();
        bench.act(action);
        assert!(matches!(
            bench.shell.sent[..],
            [Action::RemoveNotices(NoticeTopic::Case)]
        ));
    }
}

#[test]
fn a_study_that_was_cancelled_stays_marked_old_and_is_not_kept() {
    let mut bench = Bench::with_a_case();
    assert!(bench.compare.is_study_old());
    bench.compare.cancel();
    assert!(bench.compare.is_study_old() && !bench.is_behind());
    bench.act(CompareAction::Keep);
    assert_eq!(bench.at_work(), None);
    assert!(bench.shell.notices()[0].contains("no case to keep"));
}

#[test]
fn a_recipe_that_is_the_one_in_use_again_is_no_longer_on_trial() {
    let mut bench = Bench::with_a_case();
    bench.act(CompareAction::Set("project.pixel", 4.0));
    assert!(bench.compare.tried.is_some());
    bench.act(CompareAction::Reset("project.pixel"));
    assert!(bench.compare.tried.is_none());
    bench.compare.cancel();
    // No new inspection for an action that changes nothing or is refused.
    bench.act(CompareAction::ResetAll);
    bench.act(CompareAction::Set("project.pixel", 400.0));
    assert_eq!(bench.at_work(), None);
    assert!(bench.shell.notices()[0].contains("Pixel cannot be 400 mm"));
    assert!(bench.compare.tried.is_none());
}

#[test]
fn a_recipe_is_used_and_the_one_before_comes_back() {
    let mut bench = Bench::with_a_case();
    let before = Arc::clone(&bench.shell.session.recipe);
    bench.act(CompareAction::Set("project.pixel", 4.0));
    bench.act(CompareAction::Use);
    let used = |bench: &Bench| {
        let mut sent = bench.shell.sent.iter().rev();
        sent.find_map(|action| match action {
            Action::UseRecipe(recipe) => Some(Arc::clone(recipe)),
            _ => None,
        })
    };
    let tried = used(&bench).expect("sent");
    assert_eq!(tried.project.pixel, geometry::units::Metres(0.004));
    bench.shell.session.recipe = Arc::clone(&tried);
    bench.act(CompareAction::Undo);
    assert!(used(&bench).is_some_and(|recipe| Arc::ptr_eq(&recipe, &before)));
    // The recipe that was in use stays on trial.
    let on_trial = bench.compare.tried.as_ref();
    assert!(on_trial.is_some_and(|recipe| Arc::ptr_eq(recipe, &tried)));
}

#[test]
fn what_is_said_of_something_done_takes_the_place_of_what_was_said_before() {
    let mut bench = Bench::new();
    for name in ["a", "b"] {
        let done = CaseDone::Kept(Box::new(kept(name)));
        let (folder, cx) = (CaseFolder::at("cases"), &mut bench.shell.context());
        bench.compare.take_done(done, &folder, None, cx);
    }
    assert!(matches!(
        &bench.shell.sent[..],
        [Action::Notify(first), Action::Retract(gone), Action::Notify(second)]
            if first == gone && second.what == "Kept as b"
    ));
}

#[test]
fn a_run_takes_over_the_cases_that_it_listed() {
    let mut bench = Bench::with_a_case();
    let of_three = ran(&bench, cases(&["a", "b", "c"]));
    bench.done(of_three);
    assert_eq!(bench.names(), ["a", "b", "c"]);
    assert_eq!(bench.compare.num_covered, None);
    bench.act(CompareAction::OpenCase("c".into()));
    assert!(matches!(&bench.compare.front, Front::Kept(case) if case.name == "c"));
}

#[test]
fn the_cases_are_listed_again_after_a_change_by_another_program_once_nothing_runs() {
    let mut bench = Bench::with_a_case();
    bench.act(CompareAction::RunAll);
    bench.compare.is_listed = false;
    bench.act(CompareAction::Follow);
    assert!(bench.compare.is_running_cases() && !bench.is_behind());
    let of_two = ran(&bench, cases(&["a", "b"]));
    bench.done(of_two);
    while bench.at_work() == Some(JobKind::Study) {
        bench.compare.cancel();
    }
    assert!(bench.is_behind());
    bench.act(CompareAction::Follow);
    assert_eq!(bench.at_work(), Some(JobKind::Cases));
}

#[test]
fn a_case_in_front_that_another_program_changed_or_removed_is_shown_as_it_is() {
    let mut bench = Bench::with_a_case();
    let mut other = cases(&["a", "b"]);
    let list = Arc::get_mut(&mut other.list).expect("the only one");
    list[0].meta.about.truth = Truth::Nothing;
    bench.compare.take_cases(other, &mut bench.shell.context());
    assert_eq!(bench.compare.truth, Some(Truth::Nothing));
    assert!(bench.compare.is_study_old());
    bench.shell.sent.clear();
    bench.done(listed_as(&["b"], CaseDone::Listed));
    assert!(matches!(bench.compare.front, Front::Scene));
    assert!(bench.shell.notices()[0].contains("case a is gone"));
}

#[test]
fn a_problem_of_the_list_is_reported_once_and_the_advice_to_keep_a_case_goes_with_the_first() {
    let mut bench = Bench::new();
    bench.act(CompareAction::Follow);
    let list = |names: &[&str], problems: &[&str]| {
        let problem = |what: &&str| UserError {
            what: (*what).into(),
            advice: String::new(),
        };
        CompareResult::Cases {
            cases: Cases {
                problems: problems.iter().map(problem).collect(),
                ..cases(names)
            },
            problem: None,
            done: CaseDone::Listed,
            way: None,
        }
    };
    bench.done(list(&[], &["x is damaged"]));
    bench.act(CompareAction::RunAll);
    bench.shell.sent.clear();
    bench.done(list(&["a"], &["x is damaged", "y is damaged"]));
    assert_eq!(bench.shell.notices(), ["y is damaged"]);
    let gone = no_cases();
    let mut sent = bench.shell.sent.iter();
    assert!(sent.any(|action| matches!(action, Action::Retract(other) if *other == gone)));
}

#[test]
fn a_study_that_failed_leaves_no_verdict_of_another_case() {
    let mut bench = Bench::with_a_case();
    let study = CaseStudy {
        inspected: None,
        truth: None,
        recipe: Arc::clone(&bench.shell.session.recipe),
        found: FoundVerdict::default(),
        found_title: String::new(),
        refused: None,
        doubts: Vec::new(),
        time_ms: 1.0,
        distances: Vec::new(),
        against: None,
        against_title: String::new(),
        comparison: None,
    };
    bench.done(CompareResult::Studied(Arc::new(study)));
    assert!(bench.compare.study.is_some() && !bench.compare.is_study_old());
    bench.act(CompareAction::OpenCase("b".into()));
    assert_eq!(bench.at_work(), Some(JobKind::Study));
    let failed = UserError {
        what: "b is damaged".into(),
        advice: String::new(),
    };
    let task = &mut bench.compare.task;
    task.start("made up", move |_| Err(failed.into()));
    assert!(task.run_waiting());
    bench.compare.update(&mut bench.shell.context());
    assert!(bench.compare.study.is_none());
    assert!(bench.compare.is_study_old() && !bench.compare.is_study_pending());
}

/// Keeps a case of this name, as another program does.
fn keep_at(folder: &Path, name: &str) {
    let points = (0..12).map(|i| nalgebra::Point3::new(i as f32 * 0.1, 0.2, 1.0));
    let scene = scene_from_cloud(PointCloud::from_points(points));
    let kept = CaseFolder::at(folder).keep(&scene, kept(name).meta.about);
    kept.expect("kept");
}

#[test]
fn removed_cases_come_back_one_after_the_other_and_go_again() {
    let home = tempfile::tempdir().expect("a folder");
    let [folder, other] = ["cases", "other"].map(|name| home.path().join(name));
    for name in ["a", "b", "c"] {
        keep_at(&folder, name);
    }
    let mut bench = Bench::on_disk(home.path());
    bench.act(CompareAction::Follow);
    bench.work();
    for name in ["a", "b"] {
        bench.act(CompareAction::Remove(name.into()));
        bench.work();
    }
    assert_eq!(bench.names(), ["c"]);
    // Neither another folder nor a recipe that is opened or used takes the changes away.
    bench.act(CompareAction::Folder(other));
    bench.work();
    bench.act(CompareAction::Set("project.pixel", 4.0));
    bench.act(CompareAction::Use);
    assert!(bench.names().is_empty());
    bench.act(CompareAction::Undo);
    bench.act(CompareAction::Undo);
    bench.work();
    assert_eq!(bench.names(), ["b", "c"]);
    bench.act(CompareAction::Undo);
    bench.work();
    assert_eq!(bench.names(), ["a", "b", "c"]);
    bench.act(CompareAction::Redo);
    bench.work();
    assert_eq!(bench.names(), ["b", "c"]);
    bench.act(CompareAction::Undo);
    bench.work();
    assert_eq!(bench.names(), ["a", "b", "c"]);
    let undo = &bench.compare.undo;
    assert!(undo.done.is_empty() && undo.undone.len() == 3);
}

#[test]
fn the_truth_of_a_kept_case_is_saved_undone_and_redone() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = home.path().join("cases");
    keep_at(&folder, "a");
    let mut bench = Bench::on_disk(home.path());
    bench.act(CompareAction::Follow);
    bench.work();
    bench.act(CompareAction::OpenCase("a".into()));
    let saved = || {
        let list = CaseFolder::at(&folder).list().expect("listed");
        list.cases[0].meta.about.truth.clone()
    };
    let fender = Truth::Part("fender".into());
    for (action, truth) in [
        (
            CompareAction::SetTruth(Truth::NotEnrolled),
            Truth::NotEnrolled,
        ),
        (CompareAction::Undo, fender.clone()),
        (CompareAction::Redo, Truth::NotEnrolled),
        (CompareAction::Undo, fender),
    ] {
        bench.act(action);
        bench.work();
        assert_eq!(saved(), truth);
        assert_eq!(bench.compare.truth.as_ref(), Some(&truth));
        let front = &bench.compare.front;
        assert!(matches!(front, Front::Kept(case) if case.meta.about.truth == truth));
    }
    // The truth that it has is not written again.
    bench.compare.cancel();
    bench.act(CompareAction::SetTruth(saved()));
    assert_eq!(bench.at_work(), None);
}

/// A recipe `strict` in the folder, as another program saves it.
fn save_strict(folder: &Path, min_score: f64) -> RecipeFolder {
    let recipes = RecipeFolder::at(folder.join("recipes"));
    let mut strict = RecipeFile {
        name: PartName::new("strict").expect("a name"),
        ..RecipeFile::built_in()
    };
    strict.recipe.accept.min_score = min_score;
    recipes.save(&strict, Replace::Yes).expect("saved");
    recipes
}

fn min_score(recipe: &Recipe) -> f64 {
    (recipe.accept.min_score * 1000.0).round() / 1000.0
}

#[test]
fn saving_asks_before_it_replaces_what_another_program_saved() {
    let home = tempfile::tempdir().expect("a folder");
    let recipes = save_strict(home.path(), 0.95);
    let mut bench = Bench::on_disk(home.path());
    bench.work_on_recipes();
    let recipe = CompareAction::Recipe;
    bench.act(recipe(RecipeAction::Open("strict".into())));
    bench.act(CompareAction::Set("accept.min_score", 0.97));
    save_strict(home.path(), 0.99);
    bench.relist_recipes();
    assert_eq!(
        bench.shell.notices(),
        ["Recipe strict was changed by another program"]
    );
    let saved = || {
        let name = PartName::new("strict").expect("a name");
        min_score(&recipes.read(&name).expect("kept").recipe)
    };
    for (answer, value) in [(false, 0.99), (true, 0.97)] {
        bench.act(recipe(RecipeAction::Save));
        bench.work_on_recipes();
        assert!(bench.compare.recipes.is_asking);
        assert!((saved() - 0.99).abs() < 1e-9);
        bench.act(recipe(RecipeAction::Replace(answer)));
        bench.work_on_recipes();
        assert!(!bench.compare.recipes.is_asking);
        assert!((saved() - value).abs() < 1e-9);
    }
    // Now it is this window's own.
    bench.act(CompareAction::Set("accept.min_score", 0.5));
    bench.act(recipe(RecipeAction::Save));
    bench.work_on_recipes();
    assert!((saved() - 0.5).abs() < 1e-9);
}

#[test]
fn a_recipe_in_use_that_is_gone_is_not_said_to_be_changed() {
    let home = tempfile::tempdir().expect("a folder");
    let recipes = save_strict(home.path(), 0.95);
    let strict = PartName::new("strict").expect("a name");
    let mut bench = Bench::on_disk(home.path());
    let file = recipes.read(&strict).expect("kept");
    bench.shell.session.recipe = Arc::new(file.into());
    bench.work_on_recipes();
    assert!(bench.shell.notices().is_empty());
    recipes.remove(&strict).expect("removed");
    bench.relist_recipes();
    assert_eq!(
        bench.shell.notices(),
        ["Recipe strict is no longer among the saved recipes"]
    );
}

#[test]
fn a_changed_recipe_on_trial_is_on_trial_at_the_next_start_until_it_is_used() {
    let home = tempfile::tempdir().expect("a folder");
    save_strict(home.path(), 0.95);
    let start = || {
        let mut bench = Bench::on_disk(home.path());
        bench.work_on_recipes();
        assert!(bench.shell.notices().is_empty());
        bench
    };
    let mut bench = start();
    bench.act(CompareAction::Recipe(RecipeAction::Open("strict".into())));
    bench.act(CompareAction::Set("accept.min_score", 0.97));
    bench.compare.keep_trial();

    // A second window that tries nothing else leaves it.
    start().compare.keep_trial();
    let mut bench = start();
    let tried = bench.compare.tried.clone().expect("on trial");
    assert_eq!(tried.label.to_string(), "strict (modified)");
    assert!((min_score(&tried) - 0.97).abs() < 1e-9);
    bench.act(CompareAction::Use);
    bench.compare.keep_trial();
    assert!(start().compare.tried.is_none());
}

#[test]
fn the_copy_of_a_recipe_with_a_long_name_has_a_shorter_one() {
    let home = tempfile::tempdir().expect("a folder");
    save_strict(home.path(), 0.95);
    let mut bench = Bench::on_disk(home.path());
    bench.work_on_recipes();
    let long = "x".repeat(PartName::MAX_LENGTH);
    for copy in [2, 3] {
        let tried = bench.compare.recipes.named(&long, Arc::default());
        bench.compare.tried = Some(Arc::new(tried));
        bench.act(CompareAction::Recipe(RecipeAction::Duplicate));
        bench.work_on_recipes();
        let name = format!("{}_{copy}", "x".repeat(PartName::MAX_LENGTH - 2));
        assert!(bench.compare.recipes.has(&name), "{name}");
    }
}

fn inspected() -> Inspected {
    inspected_cell(CellChoice::Empty, 1)
}

fn about(inspected: &Inspected, remark: &str) -> CaseDescription {
    CaseDescription {
        remark: remark.into(),
        ..CaseDescription::of(&inspected.entry.record, Truth::Nothing)
    }
}

#[test]
fn a_case_labels_its_part_and_shares_a_remark_with_it() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = CaseFolder::at(home.path().join("cases"));
    let history = HistoryBuffer::new(Some(home.path().join("history")));
    let inspected = inspected();
    history.add(1, inspected.entry.clone(), Instant::now());
    let keep = |remark: &str| {
        let about = about(&inspected, remark);
        let (kept, problem) = keep_case(&folder, &inspected, about, &history).expect("kept");
        assert!(problem.is_none(), "{problem:?}");
        let row = history.row(1).expect("asked").expect("there").summary;
        assert_eq!(row.label, Some(Truth::Nothing));
        (kept.meta.about.remark, row.remark)
    };
    let both = |case: &str, row: &str| (case.to_owned(), row.to_owned());
    assert_eq!(keep(""), both("", ""));
    assert_eq!(keep("swept"), both("swept", "swept"));
    // A remark in the history is not overwritten.
    assert_eq!(keep("dark"), both("dark", "swept"));
    assert_eq!(keep(""), both("swept", "swept"));
}

#[test]
fn what_the_history_does_not_have_or_cannot_take_is_kept_all_the_same() {
    let home = tempfile::tempdir().expect("a folder");
    let folder = CaseFolder::at(home.path().join("cases"));
    let inspected = inspected();
    let keep = |history: &HistoryBuffer| {
        keep_case(&folder, &inspected, about(&inspected, "dark"), history).expect("kept")
    };
    let (kept, problem) = keep(&HistoryBuffer::default());
    assert!(problem.is_none(), "{problem:?}");
    assert_eq!(kept.meta.about.remark, "dark");

    let place = home.path().join("history");
    let history = HistoryBuffer::new(Some(place.clone()));
    history.add(1, inspected.entry.clone(), Instant::now());
    let file = rusqlite::Connection::open(place.join(FILE)).expect("opened");
    let broken = file.execute_batch("ALTER TABLE inspection RENAME TO gone");
    broken.expect("renamed");
    let (kept, problem) = keep(&history);
    assert!(problem.is_some());
    assert_eq!(kept.name, "simulated_frame_1_2");
}
