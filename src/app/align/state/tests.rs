use super::*;
use crate::{
    app::{
        action::{self, Action},
        job::{Outcome, answer},
        shelf::Shelf,
        state::Workspace,
        worker::{Desk, News},
    },
    geometry::{cloud::PointCloud, rigid::RigidTransform},
    pipeline::{Stage, Watch},
    stages::pose::PoseMethod,
};
use std::cell::{Cell, RefCell};

/// Keeps what is handed over; gives up after so many parts.
struct Tray {
    parts: RefCell<Vec<Outcome>>,
    most: usize,
    progress: Cell<(usize, usize)>,
}

impl Tray {
    fn of(most: usize) -> Self {
        Self {
            parts: RefCell::default(),
            most,
            progress: Cell::default(),
        }
    }
}

impl Watch for Tray {
    fn begins(&self, _stage: Stage) {}

    fn is_cancelled(&self) -> bool {
        self.parts.borrow().len() >= self.most
    }
}

impl Desk<Outcome> for Tray {
    fn stands(&self, outcome: Outcome) {
        self.partly(outcome);
    }

    fn is_followed(&self) -> bool {
        true
    }

    fn progress(&self, done: usize, total: usize) {
        self.progress.set((done, total));
    }

    fn partly(&self, outcome: Outcome) {
        self.parts.borrow_mut().push(outcome);
    }
}

/// A state that knows the shipped library.
fn with_library(shelf: &Shelf) -> State {
    let library = Some(Arc::clone(&shelf.get().expect("shipped parts").shown));
    State {
        library,
        workspace: Workspace::Align,
        ..State::default()
    }
}

/// Does it, has the work done, and lets the state hear of it.
fn run_whole(state: &mut State, shelf: &Shelf, action: AlignAction, tray: &Tray) {
    let Some(Effect::Post {
        generation,
        request,
    }) = apply(state, action)
    else {
        panic!("expected a request");
    };
    let outcome = answer(request, shelf, tray);
    let parts = tray.parts.take().into_iter();
    let parts = parts.map(|outcome| News::Partly {
        generation,
        outcome,
    });
    let done = outcome.map(|outcome| News::Done {
        generation,
        outcome,
    });
    for news in parts.chain(done) {
        action::apply(state, Action::Hear(Lane::Align, news));
    }
}

fn place(state: &State) -> usize {
    state.align.place.round() as usize
}

/// E by its definition: every distance, no tree.
fn slow_e(pair: &Pair, pose: &RigidTransform) -> f64 {
    let target: Vec<_> = pair.target.finite().map(|(_, p)| p.cast::<f64>()).collect();
    let every = 40;
    let nearest = |p: &nalgebra::Point3<f32>| {
        let at = pose * p.cast::<f64>();
        let distances = target.iter().map(|q| (q - at).norm_squared());
        distances.fold(f64::INFINITY, f64::min)
    };
    let sample = pair.sample.iter().step_by(every);
    let num = sample.len() as f64;
    sample.map(nearest).sum::<f64>() / num
}

#[test]
fn every_method_runs_on_the_pair_and_a_scrubbed_pose_gives_the_e_of_its_iteration() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    apply(&mut state, AlignAction::ChoosePart("fender".into()));
    apply(&mut state, AlignAction::ChooseStart(Start::Paper(3)));
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    assert!(state.works.is_empty() && state.align.coming.is_none());
    let shown = state.align.shown.as_ref().expect("a result");
    let methods: Vec<_> = shown.runs.iter().map(|run| run.method).collect();
    assert_eq!(methods, PoseMethod::ALL);
    assert_eq!(place(&state), shown.last_place());
    for (run, track) in shown.tracks() {
        assert_eq!(track.poses.len(), track.e_m2.len());
        // Over a part of the sample, so not exactly.
        for place in [0, track.poses.len() / 2, track.poses.len() - 1] {
            let (slow, quick) = (
                slow_e(&shown.pair, &track.pose_at(place)),
                track.e_m2[place],
            );
            assert!(
                (slow - quick).abs() < 0.25 * quick + 1e-10,
                "{:?} at {place}: {slow} {quick}",
                run.method
            );
        }
        assert_eq!(
            track.pose_at(usize::MAX),
            track.poses[track.poses.len() - 1]
        );
        let error = track.true_error.expect("known");
        let end = track.end_e_m2();
        assert_eq!(
            error.rotation.degrees() < 0.1,
            end < 1e-8,
            "{:?} {end} {error:?}",
            run.method
        );
    }
    let global = shown
        .tracks()
        .find(|(run, _)| run.method == PoseMethod::Global);
    let error = global
        .and_then(|(_, track)| track.true_error)
        .expect("a pose");
    assert!(
        error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
        "{error:?}"
    );
}

#[test]
fn the_source_is_the_part_moved_by_the_start_and_the_truth_brings_it_back() {
    let shelf = Shelf::default();
    let shelved = shelf.get().expect("shipped parts");
    let reference = &shelved.library.references[0];
    for start in [Start::Paper(4), Start::Random(3)] {
        let pair = Pair::moved_copy(reference, "part", start);
        let truth = pair.truth.expect("known");
        assert!(pair.e_m2(&truth) < 1e-11);
        let first = start.transform() * reference.cloud.points[0].cast::<f64>();
        assert!((pair.source.points[0].cast::<f64>() - first).norm() < 1e-6);
    }
}

#[test]
fn a_cancelled_table_keeps_its_rows_and_goes_on_where_it_stopped() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    let tray = Tray::of(2);
    run_whole(&mut state, &shelf, AlignAction::RunTable, &tray);
    assert!(
        AlignState::is_table_at_work(&state),
        "nothing said that it is done"
    );
    action::apply(&mut state, Action::Cancel(Lane::Align));
    assert!(!AlignState::is_table_at_work(&state));
    assert_eq!(state.align.table.rows.len(), 2);
    let num_parts = state.library.as_ref().map_or(0, |l| l.parts.len());
    assert_eq!(tray.progress.get(), (2, num_parts * Start::NUM_PAPER));

    run_whole(&mut state, &shelf, AlignAction::RunTable, &Tray::of(1));
    let starts: Vec<_> = state.align.table.rows.iter().map(|row| row.start).collect();
    assert_eq!(starts, [0, 1, 2]);
    let text = table::text(&state.align.table.rows, ',');
    assert_eq!(text.lines().count(), 4);
}

#[test]
fn a_row_of_the_table_is_aligned_unless_the_table_is_at_work() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    run_whole(&mut state, &shelf, AlignAction::RunTable, &Tray::of(2));
    apply(&mut state, AlignAction::Choose(Pairing::Files));
    assert!(apply(&mut state, AlignAction::OpenRow(1)).is_none());
    assert_eq!(state.align.start, Start::Paper(1));
    assert_eq!(state.align.pairing, Pairing::MovedCopy);
    action::apply(&mut state, Action::Cancel(Lane::Align));
    assert!(matches!(
        apply(&mut state, AlignAction::OpenRow(0)),
        Some(Effect::Post { .. })
    ));
    assert!(apply(&mut state, AlignAction::OpenRow(99)).is_none());
}

#[test]
fn what_is_missing_is_said_in_words() {
    let mut state = State::default();
    let missing = |state: &State| AlignState::choice(state).err();
    assert!(missing(&state).is_some_and(|text| text.contains("no part")));
    assert!(apply(&mut state, AlignAction::Run).is_none());
    apply(&mut state, AlignAction::Choose(Pairing::Scene));
    assert!(missing(&state).is_some_and(|text| text.contains("Capture")));
    apply(&mut state, AlignAction::Choose(Pairing::Files));
    assert!(missing(&state).is_some_and(|text| text.contains("Source…")));
    apply(
        &mut state,
        AlignAction::Chosen(AlignAsk::Source, "a.ply".into()),
    );
    assert!(missing(&state).is_some_and(|text| text.contains("Target…")));
    apply(
        &mut state,
        AlignAction::Chosen(AlignAsk::Target, "b.ply".into()),
    );
    assert_eq!(missing(&state), None);
}

#[test]
fn a_custom_start_carries_units_and_is_refused_in_words() {
    let mut state = State::default();
    apply(&mut state, AlignAction::ToggleCustom);
    apply(&mut state, AlignAction::WriteCustom("0 0 30deg".into()));
    assert!(!state.align.custom.is_start());
    assert!(state.align.custom.remarks[0].contains("expected six"));
    apply(&mut state, AlignAction::UseCustom);
    assert_eq!(state.align.start, Start::default());
    apply(
        &mut state,
        AlignAction::WriteCustom("0 0 90deg 100mm 0 1200".into()),
    );
    assert!(state.align.custom.remarks[0].contains("1200mm"));
    apply(&mut state, AlignAction::UseCustom);
    let moved = state.align.start.transform() * nalgebra::Point3::origin();
    assert!((moved.x - 0.1).abs() < 1e-12);
    assert_eq!(state.align.custom.form, Form::Closed);
}

#[test]
fn random_starts_are_counted_and_come_again() {
    let mut state = State::default();
    apply(&mut state, AlignAction::DrawStart);
    let first = state.align.start;
    assert_eq!(first, Start::Random(1));
    apply(&mut state, AlignAction::DrawStart);
    assert_ne!(state.align.start.transform(), first.transform());
    apply(&mut state, AlignAction::ChooseStart(Start::Random(1)));
    assert_eq!(state.align.start.transform(), first.transform());
}

#[test]
fn the_scrubber_stays_within_the_way_and_plays_to_its_end() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    let last = state.align.last_place();
    assert!(last > 3);
    apply(&mut state, AlignAction::Step(1.0));
    assert_eq!(place(&state), last);
    apply(&mut state, AlignAction::Step(-2.0));
    assert_eq!(place(&state), last - 2);
    apply(&mut state, AlignAction::Scrub(-5.0));
    assert_eq!(place(&state), 0);
    apply(&mut state, AlignAction::Scrub(last as f32));
    // From the end it plays from the beginning.
    apply(&mut state, AlignAction::TogglePlay);
    assert_eq!(
        (place(&state), state.align.playback),
        (0, Playback::Playing)
    );
    apply(&mut state, AlignAction::Advance(0.1));
    assert!(state.align.place > 0.0 && state.align.playback == Playback::Playing);
    apply(&mut state, AlignAction::Advance(60.0));
    assert_eq!(
        (place(&state), state.align.playback),
        (last, Playback::Paused)
    );
    apply(&mut state, AlignAction::Advance(1.0));
    assert_eq!(place(&state), last);
}

#[test]
fn an_old_result_stays_until_the_first_method_of_the_next_has_run() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    let old = Arc::clone(&state.align.shown.as_ref().expect("a result").pair);
    apply(&mut state, AlignAction::ChooseStart(Start::Paper(2)));
    // The pair, and then no method.
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(1));
    assert!(AlignState::is_pair_at_work(&state) && state.align.coming.is_some());
    assert!(Arc::ptr_eq(
        &old,
        &state.align.shown.as_ref().expect("a result").pair
    ));
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(2));
    let shown = state.align.shown.as_ref().expect("a result");
    assert!(!Arc::ptr_eq(&old, &shown.pair) && shown.runs.len() == 1);
}

#[test]
fn two_files_far_from_the_origin_are_laid_over_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let shelf = Shelf::default();
    let cloud = &shelf.get().expect("shipped parts").library.references[2].cloud;
    let off = nalgebra::Vector3::new(400.0, -300.0, 0.0);
    let turned = Start::Paper(1).transform();
    let mut state = State::default();
    apply(&mut state, AlignAction::Choose(Pairing::Files));
    for (name, ask, moved) in [
        ("target.ply", AlignAsk::Target, RigidTransform::identity()),
        ("source.ply", AlignAsk::Source, turned),
    ] {
        let path = folder.path().join(name);
        let points = cloud.points.iter().map(|p| moved * p.cast::<f64>() + off);
        let points = PointCloud::from_points(points.map(nalgebra::OPoint::cast));
        crate::files::save_cloud(&path, &points).expect("written");
        apply(&mut state, AlignAction::Chosen(ask, path));
    }
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    let shown = state.align.shown.as_ref().expect("a result");
    assert_eq!(shown.pair.title, "source.ply onto target.ply");
    let track = |method| {
        let mut tracks = shown.tracks();
        tracks
            .find(|(run, _)| run.method == method)
            .expect("a pose")
            .1
    };
    // At 400 m a coordinate is rounded to 0.03 mm.
    let end = track(PoseMethod::Global).end_e_m2();
    assert!(end < 1e-8, "{end}");
    let first = track(PoseMethod::Icp).e_m2[0];
    assert!(first > 1e-2, "ICP begins as the files lie: {first}");
    let track = track(PoseMethod::Global);
    assert_eq!(track.true_error, None);
}

#[test]
fn poor_pairs_are_refused_in_words_in_each_methods_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let (few, none) = (
        folder.path().join("few.xyz"),
        folder.path().join("none.xyz"),
    );
    std::fs::write(&few, "0 0 1\n0 1 1\n1 0 1\n1 1 1.2\n").expect("written");
    let mut state = State::default();
    apply(&mut state, AlignAction::Choose(Pairing::Files));
    apply(
        &mut state,
        AlignAction::Chosen(AlignAsk::Source, few.clone()),
    );
    apply(&mut state, AlignAction::Chosen(AlignAsk::Target, few));
    let shelf = Shelf::default();
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    let shown = state.align.shown.as_ref().expect("a result");
    assert_eq!(shown.runs.len(), PoseMethod::ALL.len());
    for run in &shown.runs {
        let trouble = run.track.as_ref().expect_err("too few points");
        assert!(trouble.what.contains("4 points") && !trouble.advice.is_empty());
        assert!(!trouble.advice.contains("--"), "{}", trouble.advice);
    }
    assert_eq!(state.align.last_place(), 0);
    apply(&mut state, AlignAction::Chosen(AlignAsk::Target, none));
    run_whole(&mut state, &shelf, AlignAction::Run, &Tray::of(usize::MAX));
    assert_eq!(
        state.notices.len(),
        1,
        "a file that is not there is a notice"
    );
    assert!(state.align.coming.is_none() && state.works.is_empty());
}

#[test]
fn the_table_is_written_as_csv_where_a_person_says() {
    let shelf = Shelf::default();
    let mut state = with_library(&shelf);
    run_whole(&mut state, &shelf, AlignAction::RunTable, &Tray::of(1));
    let chosen = AlignAction::Chosen(AlignAsk::TableFile, "t.csv".into());
    let Some(Effect::Post { request, .. }) = apply(&mut state, chosen) else {
        panic!("expected a request");
    };
    let Request::Write(WriteRequest::Text { text, .. }) = request else {
        panic!("expected a text");
    };
    assert!(text.starts_with("part,start,") && text.lines().count() == 2);
    let Some(Effect::CopyText(copied)) = apply(&mut state, AlignAction::CopyTable) else {
        panic!("expected a text");
    };
    assert_eq!(copied, text.replace(',', "\t"));
}
