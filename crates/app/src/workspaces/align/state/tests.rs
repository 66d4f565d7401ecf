use std::sync::Arc;

use super::*;
use crate::workspaces::align::{scrubber::explanation, track::in_the_window};
use geometry::{cloud::PointCloud, rigid::RigidTransform};
use shell::{
    inspection::{
        camera::Camera, inspected::inspected_cell, library_cache::LibraryCache, source::CellChoice,
    },
    session::Shown,
    workspace::TestShell,
};
use simulate::{PartKind, Side};
use stages::pose::PoseMethod;
use ui::language::Language;

/// The workspace without a window; jobs run when the test asks.
struct Bench {
    align: AlignState,
    shell: TestShell,
}

impl Bench {
    /// Without a loaded library.
    fn new() -> Self {
        Self {
            align: AlignState::new(&TaskRunner::without_threads()),
            shell: TestShell::default(),
        }
    }

    /// With the shipped library.
    fn with_library() -> Self {
        let mut bench = Self::new();
        let loaded = bench.shell.services.library_cache.get();
        bench.shell.session.library = Some(Arc::clone(&loaded.shown));
        bench
    }

    fn act(&mut self, action: AlignAction) {
        self.align.apply(action, &mut self.shell.context());
    }

    /// Carries out an action and runs the job that it starts.
    fn run(&mut self, action: AlignAction) {
        self.run_until(action, usize::MAX);
    }

    /// The same, but runs the job only until it has handed over `num_parts` partial results.
    fn run_until(&mut self, action: AlignAction, num_parts: usize) {
        self.act(action);
        assert!(self.align.task.run_waiting_until(num_parts));
        self.align.update(&mut self.shell.context());
    }

    fn iteration(&self) -> usize {
        self.align.iteration.round() as usize
    }

    fn missing(&self) -> Option<String> {
        self.align.choice(&self.shell.session).err()
    }
}

/// E by its definition, without a tree, over every 40th point of the sample.
fn slow_e(pair: &Pair, pose: &RigidTransform) -> f64 {
    let target = pair.target_points.positions().iter();
    let target: Vec<_> = target
        .map(|p| nalgebra::Point3::from(*p).cast::<f64>())
        .collect();
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
    let mut bench = Bench::with_library();
    bench.act(AlignAction::ChoosePart("fender".into()));
    bench.act(AlignAction::ChooseStart(Start::Paper(3)));
    bench.run(AlignAction::Run);
    assert!(bench.align.running().is_none() && bench.align.coming.is_none());
    let shown = bench.align.shown.as_ref().expect("a result");
    let methods: Vec<_> = shown.runs.iter().map(|run| run.method).collect();
    assert_eq!(methods, PoseMethod::ALL);
    assert_eq!(bench.iteration(), shown.last_iteration());
    for (run, track) in shown.tracks() {
        assert_eq!(track.poses.len(), track.e_m2.len());
        // Not exactly equal: each is over another part of the sample.
        for index in [0, track.poses.len() / 2, track.poses.len() - 1] {
            let (slow, quick) = (
                slow_e(&shown.pair, &track.pose_at(index)),
                track.e_m2[index],
            );
            assert!(
                (slow - quick).abs() < 0.25 * quick + 1e-10,
                "{:?} at {index}: {slow} {quick}",
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
    let library_cache = LibraryCache::default();
    let loaded = library_cache.get();
    let reference = &loaded.library.references[0];
    for start in [Start::Paper(4), Start::Random(3)] {
        let pair = Pair::moved_copy(reference, "part", start);
        let truth = pair.truth.expect("known");
        assert!(pair.e_m2(&truth) < 1e-11);
        let first = start.transform() * reference.cloud.points[0].cast::<f64>();
        assert!((pair.source.points[0].cast::<f64>() - first).norm() < 1e-6);
    }
}

#[test]
fn a_scene_is_aligned_to_the_reference_that_it_was_recognised_by() {
    let mut bench = Bench::with_library();
    let choice = CellChoice::Part(PartKind::Fender, Side::Left);
    let mut inspected = inspected_cell(choice, 3);
    // As if the fender had a second reference of this name, and that was found.
    inspected.inspection.ranking.entries[0].enrolled_as = "grille".into();
    bench.shell.session.shown = Some(Shown::new(1, Arc::new(inspected)));
    bench.act(AlignAction::Choose(Pairing::Scene));
    assert_eq!(bench.align.part.as_deref(), Some("grille"));
}

#[test]
fn a_cancelled_table_keeps_its_rows_and_goes_on_where_it_stopped() {
    let mut bench = Bench::with_library();
    bench.run_until(AlignAction::RunTable, 2);
    assert!(bench.align.is_table_at_work());
    let library = bench.shell.session.library.as_ref();
    let total = library.map_or(0, |library| library.parts.len()) * Start::NUM_PAPER;
    let running = bench.align.running().expect("at work");
    assert_eq!(running.progress, Some((2, total)));
    bench.act(AlignAction::Cancel);
    assert!(!bench.align.is_table_at_work());
    assert_eq!(bench.align.table.rows.len(), 2);

    bench.run_until(AlignAction::RunTable, 1);
    let starts: Vec<_> = bench.align.table.rows.iter().map(|row| row.start).collect();
    assert_eq!(starts, [0, 1, 2]);
    let text = table::text(&bench.align.table.rows, ',');
    assert_eq!(text.lines().count(), 4);
}

#[test]
fn a_row_of_the_table_is_aligned_unless_the_table_is_at_work() {
    let mut bench = Bench::with_library();
    bench.run_until(AlignAction::RunTable, 2);
    bench.act(AlignAction::Choose(Pairing::Files));
    bench.act(AlignAction::OpenRow(1));
    assert!(bench.align.is_table_at_work());
    assert_eq!(bench.align.start, Start::Paper(1));
    assert_eq!(bench.align.pairing, Pairing::MovedCopy);
    bench.act(AlignAction::Cancel);
    bench.act(AlignAction::OpenRow(99));
    assert!(bench.align.running().is_none());
    bench.act(AlignAction::OpenRow(0));
    assert!(bench.align.is_pair_at_work());
}

#[test]
fn what_is_missing_is_said_in_words() {
    let mut bench = Bench::new();
    let says = |bench: &Bench, words| bench.missing().is_some_and(|text| text.contains(words));
    assert!(says(&bench, "being loaded"));
    let missing = LibraryCache::new(Some("no/such/library".into()), Camera::default());
    bench.shell.session.library = Some(Arc::clone(&missing.get().shown));
    assert!(says(&bench, "no such library folder"));
    bench.act(AlignAction::Run);
    assert!(bench.align.running().is_none());
    bench.shell.session.library = Some(Arc::default());
    assert!(says(&bench, "no part"));
    bench.act(AlignAction::Run);
    assert!(bench.align.running().is_none());
    bench.act(AlignAction::Choose(Pairing::Scene));
    assert!(says(&bench, "Capture"));
    bench.act(AlignAction::Choose(Pairing::Files));
    assert!(says(&bench, "Source…"));
    bench.act(AlignAction::Chosen(AlignFile::Source, "a.ply".into()));
    assert!(says(&bench, "Target…"));
    bench.act(AlignAction::Chosen(AlignFile::Target, "b.ply".into()));
    assert_eq!(bench.missing(), None);
}

#[test]
fn a_custom_start_carries_units_and_is_refused_in_words() {
    let mut bench = Bench::new();
    bench.act(AlignAction::ToggleCustom);
    bench.act(AlignAction::WriteCustom("0 0 30deg".into()));
    assert!(bench.align.custom.transform.is_none());
    assert!(bench.align.custom.remarks[0].contains("expected six"));
    bench.act(AlignAction::UseCustom);
    assert_eq!(bench.align.start, Start::default());
    bench.act(AlignAction::WriteCustom("0 0 90deg 100mm 0 1200".into()));
    assert!(bench.align.custom.remarks[0].contains("1200mm"));
    bench.act(AlignAction::UseCustom);
    let moved = bench.align.start.transform() * nalgebra::Point3::origin();
    assert!((moved.x - 0.1).abs() < 1e-12);
    assert!(!bench.align.custom.is_open);
}

#[test]
fn random_starts_are_counted_and_come_again() {
    let mut bench = Bench::new();
    bench.act(AlignAction::DrawStart);
    let first = bench.align.start;
    assert_eq!(first, Start::Random(1));
    bench.act(AlignAction::DrawStart);
    assert_ne!(bench.align.start.transform(), first.transform());
    bench.act(AlignAction::ChooseStart(Start::Random(1)));
    assert_eq!(bench.align.start.transform(), first.transform());
}

#[test]
fn the_scrubber_stays_within_the_way_and_plays_to_its_end() {
    let mut bench = Bench::with_library();
    bench.run(AlignAction::Run);
    let last = bench.align.last_iteration();
    assert!(last > 3);
    bench.act(AlignAction::Step(1.0));
    assert_eq!(bench.iteration(), last);
    bench.act(AlignAction::Step(-2.0));
    assert_eq!(bench.iteration(), last - 2);
    bench.act(AlignAction::Scrub(-5.0));
    assert_eq!(bench.iteration(), 0);
    bench.act(AlignAction::Scrub(last as f32));
    // Play at the end starts again at the beginning.
    bench.act(AlignAction::TogglePlay);
    assert_eq!(
        (bench.iteration(), bench.align.playback),
        (0, Playback::Playing)
    );
    bench.act(AlignAction::Advance(0.1));
    assert!(bench.align.iteration > 0.0 && bench.align.playback == Playback::Playing);
    bench.act(AlignAction::Advance(60.0));
    assert_eq!(
        (bench.iteration(), bench.align.playback),
        (last, Playback::Paused)
    );
    bench.act(AlignAction::Advance(1.0));
    assert_eq!(bench.iteration(), last);
}

#[test]
fn an_old_result_stays_until_the_first_method_of_the_next_has_run() {
    let mut bench = Bench::with_library();
    bench.run(AlignAction::Run);
    let old = Arc::clone(&bench.align.shown.as_ref().expect("a result").pair);
    bench.act(AlignAction::ChooseStart(Start::Paper(2)));
    // Run until the pair is prepared, before the first method.
    bench.run_until(AlignAction::Run, 1);
    assert!(bench.align.is_pair_at_work() && bench.align.coming.is_some());
    assert!(Arc::ptr_eq(
        &old,
        &bench.align.shown.as_ref().expect("a result").pair
    ));
    bench.run_until(AlignAction::Run, 2);
    let shown = bench.align.shown.as_ref().expect("a result");
    assert!(!Arc::ptr_eq(&old, &shown.pair) && shown.runs.len() == 1);
}

#[test]
fn two_files_far_from_the_origin_are_laid_over_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let library_cache = LibraryCache::default();
    let cloud = &library_cache.get().library.references[2].cloud;
    let off = nalgebra::Vector3::new(400.0, -300.0, 0.0);
    let turned = Start::Paper(1).transform();
    let mut bench = Bench::new();
    bench.act(AlignAction::Choose(Pairing::Files));
    for (name, ask, moved) in [
        ("target.ply", AlignFile::Target, RigidTransform::identity()),
        ("source.ply", AlignFile::Source, turned),
    ] {
        let path = folder.path().join(name);
        let points = cloud.points.iter().map(|p| moved * p.cast::<f64>() + off);
        let points = PointCloud::from_points(points.map(nalgebra::OPoint::cast));
        files::save_cloud(&path, &points).expect("written");
        bench.act(AlignAction::Chosen(ask, path));
    }
    bench.run(AlignAction::Run);
    let shown = bench.align.shown.as_ref().expect("a result");
    assert_eq!(shown.pair.title(), "source.ply onto target.ply");
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
fn what_was_aligned_is_named_in_the_language_of_the_window() {
    let bench = Bench::with_library();
    let loaded = bench.shell.services.library_cache.get();
    let reference = &loaded.library.references[0];
    let pair = Pair::moved_copy(reference, "Fender, left", Start::Random(7));
    assert_eq!(pair.title(), "Fender, left from random start 7");
    Language::German.make_current();
    let title = pair.title();
    Language::English.make_current();
    assert_eq!(title, "Fender, left · zufälliger Start 7");
}

#[test]
fn poor_pairs_are_refused_in_words_in_each_methods_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let (few, none) = (
        folder.path().join("few.xyz"),
        folder.path().join("none.xyz"),
    );
    std::fs::write(&few, "0 0 1\n0 1 1\n1 0 1\n1 1 1.2\n").expect("written");
    let mut bench = Bench::new();
    bench.act(AlignAction::Choose(Pairing::Files));
    bench.act(AlignAction::Chosen(AlignFile::Source, few.clone()));
    bench.act(AlignAction::Chosen(AlignFile::Target, few));
    // The pair, and the first of the methods.
    bench.run_until(AlignAction::Run, 2);
    assert_eq!(explanation(&bench.align), "Aligning…");
    bench.run(AlignAction::Run);
    assert!(explanation(&bench.align).starts_with("No method found a pose"));
    let shown = bench.align.shown.as_ref().expect("a result");
    assert_eq!(shown.runs.len(), PoseMethod::ALL.len());
    for run in &shown.runs {
        let problem = in_the_window(run.track.as_ref().expect_err("too few points"));
        assert!(problem.what.contains("4 points") && !problem.advice.is_empty());
        assert!(!problem.advice.contains("--"), "{}", problem.advice);
    }
    assert_eq!(bench.align.last_iteration(), 0);
    bench.act(AlignAction::Chosen(AlignFile::Target, none));
    bench.run(AlignAction::Run);
    assert_eq!(
        bench.shell.notices().len(),
        1,
        "a file that is not there is a notice"
    );
    assert!(bench.align.coming.is_none() && bench.align.running().is_none());
}

#[test]
fn the_table_is_written_as_csv_where_a_person_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("t.csv");
    let mut bench = Bench::with_library();
    bench.run_until(AlignAction::RunTable, 1);
    bench.act(AlignAction::Chosen(AlignFile::TableFile, path.clone()));
    assert!(bench.align.is_writing() && bench.align.writing.run_waiting());
    bench.align.update(&mut bench.shell.context());
    assert_eq!(bench.shell.notices(), [format!("Wrote {}", path.display())]);
    let text = std::fs::read_to_string(&path).expect("written");
    assert!(text.starts_with("part,start,") && text.lines().count() == 2);
    bench.act(AlignAction::CopyTable);
    assert!(matches!(
        bench.shell.sent.last(),
        Some(Action::CopyText(copied)) if *copied == text.replace(',', "\t")
    ));
}
