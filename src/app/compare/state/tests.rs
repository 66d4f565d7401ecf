use jiff::Timestamp;

use super::*;
use crate::{
    app::{
        action,
        job::{Answer, Request},
        lane::Lane,
        worker::News,
    },
    cases::{CaseAbout, CaseMeta, Edge, Found, SCHEMA_VERSION, SceneRecord},
};

fn kept(name: &str) -> KeptCase {
    let about = CaseAbout {
        origin: name.into(),
        simulated: true,
        kept_at: Timestamp::UNIX_EPOCH,
        remark: String::new(),
        difficulty: None,
        truth: Truth::Part("fender".into()),
        found: Found::default(),
        pose: None,
    };
    let scene = SceneRecord {
        bytes: 0,
        crc32: 0,
        picture_edge: Edge::View,
        camera: None,
        empty_cell_crc32: None,
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

fn listed(done: CaseDone) -> CompareAnswer {
    CompareAnswer::Cases {
        folder: CaseFolder::at("cases"),
        cases: [kept("a"), kept("b")].into(),
        troubles: Vec::new(),
        done,
    }
}

fn posted(effect: Option<Effect>) -> Option<(u64, CompareRequest)> {
    match effect? {
        Effect::Post {
            generation,
            request: Request::Compare(request),
        } => Some((generation, request)),
        other => panic!("expected a request of the workspace, found {other:?}"),
    }
}

fn act(state: &mut State, action: CompareAction) -> Option<(u64, CompareRequest)> {
    posted(apply(state, action))
}

fn done(
    state: &mut State,
    generation: u64,
    answer: CompareAnswer,
) -> Option<(u64, CompareRequest)> {
    let news = News::Done {
        generation,
        outcome: Ok(Answer::Compare(answer)),
    };
    posted(action::apply(
        state,
        action::Action::Hear(Lane::Compare, news),
    ))
}

/// Two kept cases, the first in front and under study.
fn with_a_case() -> (State, u64) {
    let mut state = State::default();
    let (generation, request) = act(&mut state, CompareAction::Follow).expect("posted");
    assert!(matches!(
        request,
        CompareRequest::Cases {
            change: CaseChange::List,
            ..
        }
    ));
    assert!(done(&mut state, generation, listed(CaseDone::Listed)).is_none());
    let opened = act(&mut state, CompareAction::OpenCase("a".into()));
    let (generation, request) = opened.expect("posted");
    let CompareRequest::Study(request) = request else {
        panic!("studied");
    };
    assert_eq!(request.truth, Some(Truth::Part("fender".into())));
    (state, generation)
}

#[test]
fn a_change_of_the_kept_cases_is_never_pushed_out() {
    let (mut state, _) = with_a_case();
    let (removing, _) = act(&mut state, CompareAction::Remove("b".into())).expect("posted");
    // The study that it pushed out, and whatever comes meanwhile, waits.
    let set = CompareAction::Set("accept.min_score", 0.5);
    assert!(act(&mut state, set).is_none());
    assert!(act(&mut state, CompareAction::RunAll).is_none());
    assert!(!state.is_compare_behind());
    let removed = CaseDone::Removed {
        name: "b".into(),
        trash: "trash/b".into(),
    };
    let (running, request) = done(&mut state, removing, listed(removed)).expect("posted");
    assert!(matches!(request, CompareRequest::Run { .. }));
    assert!(state.is_running_cases());
    assert!(matches!(state.compare.undo, Some(Undo::Removal { .. })));
    // The recipe was changed before the run began: the case in front still comes, as soon as it may.
    assert!(state.is_compare_behind());
    let (studying, request) = act(&mut state, CompareAction::Follow).expect("posted");
    assert!(matches!(request, CompareRequest::Study(_)) && studying > running);
}

#[test]
fn another_recipe_gives_a_run_up_and_another_part_waits_for_its_end() {
    let (mut state, _) = with_a_case();
    let (_, request) = act(&mut state, CompareAction::RunAll).expect("posted");
    assert!(matches!(request, CompareRequest::Run { .. }));
    let against = CompareAction::Against(Some("grille".into()));
    assert!(act(&mut state, against).is_none());
    assert!(state.is_running_cases() && state.is_study_old());
    let set = CompareAction::Set("project.pixel", 4.0);
    let (_, request) = act(&mut state, set).expect("posted");
    let CompareRequest::Study(request) = request else {
        panic!("studied");
    };
    assert_eq!(request.recipe.project.pixel, crate::units::Metres(0.004));
    assert_eq!(request.against.as_deref(), Some("grille"));
    assert!(!state.is_running_cases());
}

#[test]
fn a_study_that_was_cancelled_stays_marked_old_and_is_not_kept() {
    let (mut state, _) = with_a_case();
    assert!(state.is_study_old());
    action::apply(&mut state, action::Action::Cancel(Lane::Compare));
    assert!(state.is_study_old() && !state.is_compare_behind());
    assert!(act(&mut state, CompareAction::Keep).is_none());
    assert!(state.notices[0].what.contains("no case to keep"));
}

#[test]
fn a_recipe_that_is_the_one_in_use_again_is_no_longer_on_trial() {
    let (mut state, _) = with_a_case();
    act(&mut state, CompareAction::Set("project.pixel", 4.0)).expect("posted");
    assert!(state.compare.tried.is_some());
    act(&mut state, CompareAction::Reset("project.pixel")).expect("posted");
    assert!(state.compare.tried.is_none());
    // Nothing is inspected anew for what changes nothing or cannot be.
    assert!(act(&mut state, CompareAction::ResetAll).is_none());
    assert!(act(&mut state, CompareAction::Set("project.pixel", 400.0)).is_none());
    assert!(state.notices[0].what.contains("Pixel cannot be 400 mm"));
    assert!(state.compare.tried.is_none());
}

#[test]
fn what_is_said_of_something_done_takes_the_place_of_what_was_said_before() {
    let mut state = State::default();
    for name in ["a", "b"] {
        hear_done(&mut state, CaseDone::Kept(Box::new(kept(name))));
    }
    let said: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
    assert_eq!(said, ["Kept as b"]);
}
