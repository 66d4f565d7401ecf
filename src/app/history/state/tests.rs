//! What is listed, looked at and kept in memory, without a thread that answers.

use super::*;
use crate::{
    app::{
        action::{Action, apply},
        history::{Direction, HistoryAction, HistoryJob, TakenIn, take, take_in},
        inspect::work::{InspectRequest, inspect},
        shelf::Shelf,
        source::{CellChoice, SceneSource},
    },
    history::{HistoryNews, PastVerdict},
    pipeline::{PoseChoice, Recipe, Unwatched},
};

fn inspected(number: u64) -> Arc<Inspected> {
    // Without a pose it is quick.
    let recipe = Recipe {
        pose: PoseChoice::Skip,
        ..Recipe::default()
    };
    let request = InspectRequest {
        source: SceneSource::Cell {
            choice: CellChoice::Empty,
            number,
        },
        recipe: Arc::new(recipe),
    };
    let inspected = inspect(&request, &Shelf::default(), &Unwatched).expect("inspected");
    Arc::new(inspected.expect("not cancelled"))
}

fn row(inspected: &Inspected, number: i64) -> Summary {
    Summary {
        number,
        ..inspected.entry.record.summary.clone()
    }
}

/// The state with these rows listed, the newest first.
fn listing(inspected: &Inspected, numbers: &[i64]) -> State {
    let mut state = State::default();
    let rows: Vec<Summary> = numbers.iter().map(|n| row(inspected, *n)).collect();
    let looked = Looked {
        asked: state.history.wanted(),
        page: Page {
            num_matching: rows.len(),
            num_all: rows.len(),
            rows,
        },
        record: None,
        kept: Default::default(),
        frames: None,
    };
    assert!(
        take(&mut state, looked).is_some(),
        "the newest is looked up"
    );
    state
}

fn hear(state: &mut State, news: HistoryNews) {
    apply(state, Action::History(HistoryAction::Hear(news)));
}

#[test]
fn a_new_result_is_handed_over_and_the_newest_few_stay_whole() {
    let found = inspected(1);
    let mut state = State::default();
    for number in 1..=7_i64 {
        let (taken, effect) = take_in(&mut state, 1, &found);
        assert_eq!(taken, TakenIn::New);
        let Some(Effect::History(HistoryJob::Add(ticket, entry))) = effect else {
            panic!("not handed over: {effect:?}");
        };
        assert_eq!(entry.record.summary.verdict, PastVerdict::NoPart);
        assert!(!state.history.is_settled());
        assert_eq!(state.history.num_rows(), number as usize);
        hear(&mut state, HistoryNews::Added { ticket, number });
    }
    let whole = |number| state.history.whole(number).is_some();
    assert!(whole(7) && whole(4) && !whole(3) && !whole(1));
    // It was not asked for again: a scene in front with something else changed is no inspection of its own.
    state.history.repeated = Some(9);
    assert!(take_in(&mut state, 9, &found).1.is_none());
}

#[test]
fn who_looks_at_the_newest_goes_on_looking_at_the_newest() {
    let found = inspected(1);
    let mut state = listing(&found, &[3, 2, 1]);
    assert_eq!(state.history.selected, Some(3));
    let add = |state: &mut State, number| {
        let ticket = state.history.ticket(&found);
        hear(state, HistoryNews::Added { ticket, number });
    };
    add(&mut state, 4);
    assert_eq!(state.history.selected, Some(4));
    let mut state = listing(&found, &[3, 2, 1]);
    apply(&mut state, Action::History(HistoryAction::Select(1)));
    add(&mut state, 4);
    assert_eq!(state.history.selected, Some(1));
}

#[test]
fn the_arrows_stop_at_the_ends() {
    let mut state = listing(&inspected(1), &[3, 2, 1]);
    for (direction, expected) in [
        (Direction::Up, 3),
        (Direction::Down, 2),
        (Direction::Down, 1),
        (Direction::Down, 1),
        (Direction::Up, 2),
    ] {
        apply(&mut state, Action::History(HistoryAction::Step(direction)));
        assert_eq!(state.history.selected, Some(expected));
    }
}

#[test]
fn what_waited_keeps_its_place_under_its_new_number() {
    let found = inspected(1);
    let mut state = State::default();
    let ticket = state.history.ticket(&found);
    let trouble = HistoryNews::Failed {
        what: "the disk is full".into(),
        advice: "Make room".into(),
    };
    hear(&mut state, trouble);
    hear(&mut state, HistoryNews::Added { ticket, number: -1 });
    assert_eq!(state.history.selected, Some(-1));
    assert_eq!(state.notices.len(), 1);
    let works = HistoryNews::Works {
        numbers: vec![(-1, 58)],
        num_lost: 0,
    };
    hear(&mut state, works);
    assert_eq!(state.history.selected, Some(58));
    assert!(state.history.whole(58).is_some() && state.history.trouble.is_none());
    assert!(state.notices[1].what.contains("one inspection that waited"));
}

#[test]
fn rows_out_of_sight_are_asked_for_once() {
    let mut state = listing(&inspected(1), &[3, 2, 1]);
    state.history.page.num_matching = 5000;
    let see = |state: &mut State, rows| {
        let effect = apply(state, Action::History(HistoryAction::Visible(rows)));
        effect.is_some()
    };
    assert!(!see(&mut state, 0..3));
    assert!(see(&mut state, 2000..2020));
    assert_eq!(state.history.wanted().rows, 1900..2120);
}
