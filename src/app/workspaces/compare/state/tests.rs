use jiff::Timestamp;

use super::*;
use crate::{
    app::{shell::context::TestShell, workspaces::compare::matrix::Matrix},
    cases::{
        Calibration, CaseDescription, CaseMeta, Confusion, FoundVerdict, SCHEMA_VERSION, TradeOff,
    },
    history::FrameRecord,
    stages::scene::PictureEdge,
};

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
    let cases = Cases {
        folder: CaseFolder::at("cases"),
        list: names.iter().map(|name| kept(name)).collect(),
    };
    CompareResult::Cases {
        cases,
        troubles: Vec::new(),
        done,
    }
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
    assert!(matches!(bench.compare.undo, Some(Undo::Removal { .. })));
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
    assert_eq!(request.recipe.project.pixel, crate::units::Metres(0.004));
    assert_eq!(request.against.as_deref(), Some("grille"));
    assert!(!bench.compare.is_running_cases());
}

#[test]
fn a_run_is_outdated_until_it_covers_the_cases_that_are_kept_now() {
    let mut bench = Bench::with_a_case();
    let run = |bench: &Bench, names: &[&str]| {
        CompareResult::Ran(Arc::new(CaseRun {
            recipe: Arc::clone(&bench.shell.session.recipe),
            results: Vec::new(),
            troubles: Vec::new(),
            cases: names.iter().map(|name| kept(name)).collect(),
            matrix: Matrix::of(Confusion::of(&[], &[])),
            calibration: Calibration::of(&[]),
            trade_off: TradeOff::of(&[]),
            ended: Some(Timestamp::UNIX_EPOCH),
        }))
    };
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
        troubles: Vec::new(),
        done: CaseDone::Listed,
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
    let Some(Message::Notify(notice)) = bench.shell.messages.last() else {
        panic!("{:?}", bench.shell.messages);
    };
    assert_eq!(notice.topic, NoticeTopic::Case);
    for action in [
        CompareAction::SetTruth(Truth::NotEnrolled),
        CompareAction::OpenCase("b".into()),
    ] {
        bench.shell.messages.clear();
        bench.act(action);
        assert!(matches!(
            bench.shell.messages[..],
            [Message::RemoveNotices(NoticeTopic::Case)]
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
        let mut messages = bench.shell.messages.iter().rev();
        messages.find_map(|message| match message {
            Message::UseRecipe(recipe) => Some(Arc::clone(recipe)),
            _ => None,
        })
    };
    let tried = used(&bench).expect("sent");
    assert_eq!(tried.project.pixel, crate::units::Metres(0.004));
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
        bench.compare.take_done(done, &mut bench.shell.context());
    }
    assert!(matches!(
        &bench.shell.messages[..],
        [Message::Notify(first), Message::Retract(gone), Message::Notify(second)]
            if first == gone && second.what == "Kept as b"
    ));
}
