//! Writing, querying, filtering and sweeping.

use std::{sync::Arc, time::Instant};

use rand::{RngExt as _, SeedableRng as _};
use rusqlite::params_from_iter;

use super::{outcomes::outcomes_query, store::listed_query, *};
use crate::fixtures::{history_entry, new_history, open_history, refuse};
use capture::fixtures::moment;
use files::fixtures::csv_column;
use geometry::rigid::from_euler_zyx;
use inspection::{
    fixtures::{rejections, unrecognisables},
    library::Truth,
    pipeline::{Recipe, RecipeLabel, Refusal, RefusalKind},
};
use stages::{fixtures::small_scene, scan::Shot};

mod kept_frames;
mod same_part;

const ALL: Retention = Retention {
    keep: KeepFrames::All,
    max_days: 30,
    max_gigabytes: 1.0,
};

fn numbers(history: &History, filter: &Filter) -> Vec<i64> {
    let page = history.page(filter, 0, 1000).expect("asked");
    assert_eq!(page.num_matching, page.rows.len());
    page.rows.iter().map(|row| row.number).collect()
}

/// Creates another inspection of the same part.
fn again(of: &NewEntry, seconds: i64, verdict: StoredVerdict) -> NewEntry {
    let mut other = history_entry(seconds, verdict, "grille");
    other.record.summary.hung = of.record.summary.hung.clone();
    other
}

#[test]
fn what_is_written_comes_back_whole_also_after_closing() {
    let (folder, mut history) = new_history();
    let mut written = history_entry(1, StoredVerdict::Rejected, "front_door");
    written.record.summary.noted = RobotMarks {
        robot_doubts: vec!["old".into(), "moving".into()],
        motion_checked: Some(false),
    };
    written.record.summary.rack = Some("rack A".into());
    assert_eq!(history.add(&written, &ALL).expect("written"), 1);
    history.set_remark(1, " a dent, below ").expect("written");
    let label = Truth::Part("back_door".into());
    history.set_label(1, Some(&label)).expect("written");
    drop(history);

    let history = open_history(folder.path());
    let record = history.known(1).expect("there");
    let scene = history.scene(&record).expect("read").expect("kept");
    assert_eq!(Some(&scene), written.scene.as_deref());
    assert_eq!(
        image::load_from_memory(&record.detail.thumbnail)
            .expect("a PNG")
            .width(),
        16
    );
    assert_eq!(
        record.timings(),
        [
            ("segment".into(), 8.0),
            ("pose".into(), 20.5),
            ("total".into(), 31.5)
        ]
    );
    let frame = record.detail.frame.clone().expect("kept");
    let mut expected = written.record;
    expected.summary.number = 1;
    expected.summary.remark = "a dent, below".into();
    expected.summary.label = Some(label);
    expected.summary.frame_bytes = Some(frame.bytes);
    expected
        .detail
        .thumbnail
        .clone_from(&record.detail.thumbnail);
    expected.detail.frame = Some(frame);
    let pose = expected
        .detail
        .camera_from_part
        .take()
        .zip(record.detail.camera_from_part);
    let (before, now) = pose.expect("both");
    assert!((before.to_matrix() - now.to_matrix()).norm() < 1e-12);
    expected.detail.camera_from_part = Some(now);
    assert_eq!(record, expected);
    assert!(matches!(
        history.known(2),
        Err(HistoryError::NoSuchInspection { number: 2 })
    ));
}

#[test]
fn the_newest_come_first_page_by_page() {
    let (_folder, mut history) = new_history();
    for seconds in [5, 3, 9, 1, 7] {
        let entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
        history.add(&entry, &Retention::default()).expect("written");
    }
    let page = |offset| {
        let page = history.page(&Filter::default(), offset, 2).expect("asked");
        assert_eq!((page.num_matching, page.num_all), (5, 5));
        page.rows
            .iter()
            .map(|row| row.scene.to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(page(0), ["frame 9", "frame 7"]);
    assert_eq!(page(2), ["frame 5", "frame 3"]);
    assert_eq!(page(4), ["frame 1"]);
    assert!(page(6).is_empty());
}

#[test]
fn every_filter_lets_through_what_a_plain_look_at_the_rows_does() {
    let (_folder, mut history) = new_history();
    let mut random = rand_pcg::Pcg64::seed_from_u64(7);
    let parts = ["front_door", "Fender", "back_door"];
    let mut rows = Vec::new();
    for _ in 0..200 {
        let verdict = StoredVerdict::ALL[random.random_range(0..4)];
        let part = parts[random.random_range(0..3)];
        let mut entry = history_entry(random.random_range(0..500), verdict, part);
        entry.record.summary.is_simulated = random.random();
        entry.record.summary.source = ["kinect", "kinect:B"][random.random_range(0..2)].into();
        entry.record.summary.rack =
            [None, Some("A"), Some("Rack Tür")][random.random_range(0..3)].map(str::to_owned);
        entry.record.summary.trace = Traceability {
            order: ["", "A 17", "a 17"][random.random_range(0..3)].into(),
            serial: ["", "TL-1", "TL-17"][random.random_range(0..3)].into(),
            operator: String::new(),
        };
        entry.record.summary.remark = ["", "Beule Ö", "dent 50%"][random.random_range(0..3)].into();
        entry.scene = None;
        let number = history.add(&entry, &Retention::default()).expect("written");
        entry.record.summary.number = number;
        rows.push(entry.record.summary);
    }
    rows.sort_by_key(|row| std::cmp::Reverse((row.at, row.number)));
    let mut num_found = 0;
    for _ in 0..300 {
        let from = random.random_range(0..500);
        let filter = Filter {
            since: random.random::<bool>().then(|| moment(from)),
            until: random.random::<bool>().then(|| moment(from + 150)),
            part: random
                .random_bool(0.3)
                .then(|| parts[random.random_range(0..3)].to_owned()),
            verdict: random
                .random_bool(0.4)
                .then(|| match random.random_range(0..5) {
                    4 => VerdictFilter::NotAccepted,
                    verdict => StoredVerdict::ALL[verdict].into(),
                }),
            is_simulated: random.random_bool(0.3).then(|| random.random()),
            source: random.random_bool(0.2).then(|| "kinect".to_owned()),
            rack: random.random_bool(0.2).then(|| "A".to_owned()),
            order: random.random_bool(0.2).then(|| "A 17".to_owned()),
            serial: random.random_bool(0.2).then(|| "TL-1".to_owned()),
            with_below: random.random(),
            text: [
                "",
                "",
                "door",
                "FENDER  dent",
                "ö",
                "50%",
                "_door frame",
                "nothing",
                "Tür frame",
                "rack",
            ][random.random_range(0..10)]
            .into(),
            shown: vec![["tür".into(), "door".into()]],
        };
        let plain: Vec<i64> = rows
            .iter()
            .filter(|row| filter.passes(row))
            .map(|row| row.number)
            .collect();
        num_found += plain.len();
        assert_eq!(numbers(&history, &filter), plain, "{filter:?}");
    }
    assert!(num_found > 1000, "{num_found}");
}

#[test]
fn a_word_of_what_is_shown_finds_what_is_stored() {
    let (_folder, mut history) = new_history();
    for seconds in [1, 2] {
        let mut entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
        if seconds == 1 {
            entry.record.summary.scene = SceneTitle::SimulatedFrame(7);
        }
        entry.scene = None;
        history.add(&entry, &Retention::default()).expect("written");
    }
    let asked = |text: &str, shown: &[[&str; 2]]| Filter {
        text: text.into(),
        shown: shown.iter().map(|both| both.map(str::to_owned)).collect(),
        ..Filter::default()
    };
    let shown = [["simuliertes bild ", "=simulated_frame "]];
    for (text, expected) in [
        ("BILD", &[1][..]),
        ("simuliertes bild 7", &[1]),
        ("simulated frame 7", &[1]),
        ("bild 8", &[]),
        ("simuliertes bilder", &[]),
        ("frame 2", &[2]),
    ] {
        assert_eq!(numbers(&history, &asked(text, &shown)), expected, "{text}");
    }
    assert!(numbers(&history, &asked("bild", &[])).is_empty());
}

#[test]
fn twenty_thousand_rows_are_asked_right_and_from_the_index_alone() {
    const NUM: i64 = 20_000;
    let (_folder, mut history) = new_history();
    let entries = (0..NUM).map(|i| {
        let verdict = if i % 10 == 0 {
            StoredVerdict::Rejected
        } else {
            StoredVerdict::Accepted
        };
        let mut entry = history_entry(i, verdict, if i % 8 == 0 { "grille" } else { "front_door" });
        (entry.picture, entry.scene) = (None, None);
        entry
    });
    history.add_all(entries).expect("written");
    let filters = [
        (Filter::default(), NUM),
        (
            Filter {
                verdict: Some(StoredVerdict::Rejected.into()),
                ..Filter::default()
            },
            NUM / 10,
        ),
        (
            Filter {
                part: Some("grille".into()),
                ..Filter::default()
            },
            NUM / 8,
        ),
        (
            Filter {
                since: Some(moment(NUM - 1000)),
                ..Filter::default()
            },
            1000,
        ),
        (
            Filter {
                // Also matches 19999.
                text: "frame 9999".into(),
                ..Filter::default()
            },
            2,
        ),
        (
            Filter {
                text: "grille".into(),
                verdict: Some(StoredVerdict::Rejected.into()),
                until: Some(moment(NUM / 2)),
                ..Filter::default()
            },
            NUM / 80,
        ),
    ];
    let of_order = Filter {
        order: Some("A 17".into()),
        ..Filter::default()
    };
    let plan = plan_of(&history, listed_query(&of_order));
    assert!(plan.contains("INDEX listed"), "{plan}");
    assert!(!plan.contains("TEMP B-TREE"), "{plan}");
    for (filter, num) in filters {
        let page = history.page(&filter, 0, 50).expect("asked");
        assert_eq!(
            (page.num_matching as i64, page.num_all as i64),
            (num, NUM),
            "{filter:?}"
        );
        assert_eq!(page.rows.len() as i64, num.min(50));
        assert!(
            page.rows
                .is_sorted_by_key(|row| std::cmp::Reverse(row.number))
        );
        let far = history.page(&filter, num as usize - 1, 50).expect("asked");
        assert_eq!(far.rows.len(), 1);
        // In index order, without sorting.
        let plan = plan_of(&history, listed_query(&filter));
        assert!(plan.contains("COVERING INDEX listed"), "{plan}");
        assert!(!plan.contains("TEMP B-TREE"), "{plan}");
        // Statistics read only the kind of a refusal from the rows themselves.
        let plan = plan_of(&history, outcomes_query(&filter));
        assert!(plan.contains("INDEX listed"), "{plan}");
        assert!(!plan.contains("TEMP B-TREE"), "{plan}");
        let outcomes = history.outcomes(&filter).expect("asked");
        assert_eq!(outcomes.len() as i64, num, "{filter:?}");
    }
}

/// Returns the query plan.
fn plan_of(history: &History, (asked, values): (String, Vec<rusqlite::types::Value>)) -> String {
    let asked = format!("EXPLAIN QUERY PLAN {asked}");
    let mut plan = history.file.prepare(&asked).expect("asked");
    let lines = plan.query_map(params_from_iter(values), |row| row.get("detail"));
    let lines: rusqlite::Result<Vec<String>> = lines.expect("asked").collect();
    lines.expect("text").join("\n")
}

#[test]
fn only_an_accepted_part_with_the_label_of_another_is_wrongly_accepted() {
    let mut record = history_entry(1, StoredVerdict::Accepted, "fender").record;
    assert!(!record.summary.is_wrongly_accepted());
    for (label, is_wrong) in [
        (Truth::Part("fender".into()), false),
        (Truth::Part("grille".into()), true),
        (Truth::NotEnrolled, true),
    ] {
        record.summary.label = Some(label);
        assert_eq!(record.summary.is_wrongly_accepted(), is_wrong);
        // Whatever its line said when it was inspected.
        let doubts = record.summary.robot_marks().robot_doubts;
        assert_eq!(doubts.contains(&"reported_wrong".to_owned()), is_wrong);
    }
    record.summary.verdict = StoredVerdict::Rejected;
    assert!(!record.summary.is_wrongly_accepted());
}

#[test]
fn a_part_that_was_reported_as_wrong_does_not_count_as_ok() {
    let (_folder, mut history) = new_history();
    for seconds in 1..=3 {
        let mut entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
        entry.record.summary.rack = (seconds > 1).then(|| "rack A".into());
        history.add(&entry, &ALL).expect("written");
    }
    for (number, label) in [(2, "fender"), (3, "grille")] {
        let label = Truth::Part(label.into());
        history.set_label(number, Some(&label)).expect("written");
    }
    let outcomes = history.outcomes(&Filter::default()).expect("asked");
    let are_ok: Vec<bool> = outcomes.iter().map(|outcome| outcome.is_ok).collect();
    assert_eq!(are_ok, [true, true, false]);
    for (number, outcome) in (1..).zip(outcomes) {
        let record = history.known(number).expect("there");
        assert_eq!(PartOutcome::from(&record), outcome);
    }
}

#[test]
fn two_recipes_with_one_identity_are_both_kept() {
    let (_folder, mut history) = new_history();
    let mut second = history_entry(2, StoredVerdict::NoPart, "grille");
    let mut recipe = Recipe::default();
    recipe.accept.min_score = 0.5;
    second.record.detail.recipe = Some(Arc::new(recipe.clone()));
    let label = RecipeLabel {
        name: "glossy".into(),
        is_changed: true,
    };
    second.record.detail.recipe_label = label.clone();
    for entry in [history_entry(1, StoredVerdict::NoPart, "grille"), second] {
        history.add(&entry, &Retention::default()).expect("written");
    }
    let recipe_of = |number| history.known(number).expect("there").detail.recipe;
    assert_eq!(recipe_of(1).as_deref(), Some(&Recipe::default()));
    assert_eq!(recipe_of(2).as_deref(), Some(&recipe));
    let label_of = |number| history.known(number).expect("there").detail.recipe_label;
    assert_eq!(label_of(1), RecipeLabel::default());
    assert_eq!(label_of(2), label);
}

#[test]
fn the_table_has_a_line_for_each_row_and_as_many_fields_as_its_head() {
    let (folder, mut history) = new_history();
    for seconds in 1..=4 {
        let entry = history_entry(seconds, StoredVerdict::Rejected, "grille");
        history.add(&entry, &Retention::default()).expect("written");
    }
    let path = folder.path().join("all.csv");
    let written = write_table(&path, |row| history.each(&Filter::default(), row));
    assert_eq!(written.expect("written"), 4);
    let table = std::fs::read_to_string(&path).expect("text");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 5);
    assert!(lines[1].starts_with("1,2026-03-01T06:00:01Z,frame 1,simulated,true,not_accepted,grille,grille,0.9700,0.2500,\"the best match, grille, scores 0.81, "));
    // Commas inside quotation marks do not separate fields.
    let num_fields = |line: &str| {
        let bare = line.split('"').step_by(2);
        bare.map(|piece| piece.matches(',').count()).sum::<usize>()
    };
    let wanted = num_fields(lines[0]);
    assert!(lines.iter().all(|line| num_fields(line) == wanted));
    let kinds = csv_column(&table, "reason_kind");
    assert_eq!(kinds, ["low_score"; 4]);
    assert_eq!(csv_column(&table, "place_number"), [""; 4]);
    // If reading fails midway, the existing table is kept.
    let failed = write_table(&path, |row| {
        history.each(&Filter::default(), row)?;
        Err(HistoryError::NoSuchInspection { number: 5 })
    });
    failed.expect_err("not whole");
    assert_eq!(std::fs::read_to_string(&path).expect("text"), table);
}

#[test]
fn every_refusal_comes_back_with_its_figures_and_is_counted_by_its_kind() {
    let (_folder, mut history) = new_history();
    let mut refusals: Vec<Refusal> = rejections().into_iter().map(Refusal::from).collect();
    refusals.extend(unrecognisables().into_iter().map(Refusal::from));
    for (seconds, refused) in (1..).zip(&refusals) {
        let mut entry = history_entry(seconds, StoredVerdict::Rejected, "fender");
        refuse(&mut entry, refused.clone());
        entry.scene = None;
        history.add(&entry, &ALL).expect("written");
    }
    let outcomes = history.outcomes(&Filter::default()).expect("asked");
    assert_eq!(outcomes.len(), refusals.len());
    for (number, (refused, outcome)) in (1..).zip(refusals.into_iter().zip(outcomes)) {
        assert_eq!(outcome.reason, Some(refused.kind()));
        let record = history.known(number).expect("there");
        assert_eq!(record.detail.refusal, Some(refused));
        assert_eq!(PartOutcome::from(&record), outcome);
    }
}

#[test]
fn of_a_refusal_that_is_damaged_or_of_a_later_kind_the_kind_is_left() {
    let (_folder, mut history) = new_history();
    for seconds in 1..=2 {
        let entry = history_entry(seconds, StoredVerdict::Rejected, "fender");
        history.add(&entry, &ALL).expect("written");
    }
    let changed = r#"UPDATE detail SET refusal = '{"kind":"low_score","part":"fen' WHERE number = 1;
        UPDATE detail SET refusal = '{"kind":"bewitched","part":"fender"}' WHERE number = 2;
        UPDATE inspection SET reason_kind = 'bewitched' WHERE number = 2;"#;
    history.file.execute_batch(changed).expect("changed");
    let kinds = ["low_score", "bewitched"].map(|kind| Some(RefusalKind::named(kind)));
    for (number, kind) in (1..).zip(&kinds) {
        let record = history.known(number).expect("there");
        assert_eq!(record.detail.refusal, None);
        assert_eq!(record.summary.reason, *kind);
    }
    let outcomes = history.outcomes(&Filter::default()).expect("asked");
    let reasons: Vec<_> = outcomes.into_iter().map(|outcome| outcome.reason).collect();
    assert_eq!(reasons, kinds);
}

#[test]
fn the_shots_of_a_scan_are_kept_and_go_together() {
    let (folder, mut history) = new_history();
    let shots: Vec<Shot> = (0..3)
        .map(|place: u16| Shot {
            name: format!("shot {place}"),
            scene: small_scene(place),
            base_from_camera: from_euler_zyx([0.0, 0.1, 0.0, 0.2, f64::from(place), 1.0]),
        })
        .collect();
    let mut scan = history_entry(1, StoredVerdict::Rejected, "grille");
    scan.scene = Some(Arc::clone(&shots[1].scene));
    history
        .add(&scan.of_scan(shots.clone()), &ALL)
        .expect("written");
    let single = history_entry(2, StoredVerdict::Rejected, "grille");
    history.add(&single, &ALL).expect("written");
    let record = history.known(1).expect("there");
    assert_eq!(
        history.scene(&record).expect("read").as_ref(),
        Some(&*shots[1].scene)
    );
    let kept = history.shots(&record).expect("read").expect("kept");
    for (kept, shot) in kept.iter().zip(&shots) {
        assert_eq!((&kept.name, &kept.scene), (&shot.name, &shot.scene));
        let off = kept.base_from_camera.to_matrix() - shot.base_from_camera.to_matrix();
        assert!(off.norm() < 1e-12);
    }
    assert_eq!(kept.len(), 3);
    let other = history.known(2).expect("there");
    assert!(history.shots(&other).expect("read").is_none());
    let files = |history: &History| {
        let files = std::fs::read_dir(history.frames_folder()).expect("listed");
        files.count()
    };
    // All frames share one camera.
    assert_eq!(files(&history), 5);
    drop(history);
    let mut history = open_history(folder.path());
    assert_eq!(files(&history), 5, "none is a stray");
    history.set_remark(2, "stays").expect("written");
    let later = Retention {
        keep: KeepFrames::None,
        ..ALL
    };
    for days in 1..=31 {
        let entry = history_entry(days * 24 * 3600, StoredVerdict::NoPart, "grille");
        history.add(&entry, &later).expect("written");
    }
    history.sweep(&ALL, moment(32 * 24 * 3600)).expect("swept");
    assert_eq!(files(&history), 2);
    assert!(history.known(1).expect("there").detail.frame.is_none());
}

#[test]
fn a_reinspection_is_traced_as_its_part_and_a_serial_number_is_found() {
    let (_folder, mut history) = new_history();
    let mut refused = history_entry(1, StoredVerdict::Rejected, "grille");
    refused.record.summary.trace = Traceability {
        serial: "TL-4711".into(),
        order: "A 17".into(),
        operator: "Kim".into(),
    };
    let mut again = history_entry(2, StoredVerdict::Accepted, "grille");
    again.record.summary.hung = refused.record.summary.hung.clone();
    again.record.summary.trace.operator = "Lee".into();
    let other = history_entry(3, StoredVerdict::Accepted, "grille");
    for entry in [&refused, &again, &other] {
        history.add(entry, &ALL).expect("written");
    }
    let found = Filter {
        text: "tl-4711".into(),
        ..Filter::default()
    };
    assert_eq!(numbers(&history, &found), [2]);
    let traced = history.known(2).expect("there").summary.trace;
    assert_eq!((&*traced.serial, &*traced.operator), ("TL-4711", "Lee"));
    let refused = history.known(1).expect("there").summary;
    assert_eq!((refused.parent, &*refused.trace.operator), (Some(2), "Kim"));
    // Inspections waiting in memory are listed in the same way.
    let buffer = HistoryBuffer::default();
    for (ticket, entry) in [again, other].into_iter().enumerate() {
        buffer.add(ticket as u64, entry, std::time::Instant::now());
    }
    let page = buffer.page(&Filter::default(), 0, 9).expect("asked");
    assert_eq!(
        page.rows.last().map(|row| &*row.trace.operator),
        Some("Lee")
    );
}

#[test]
fn a_serial_number_that_comes_later_is_added_to_the_inspections_of_its_part_that_have_none() {
    let (_folder, mut history) = new_history();
    let first = history_entry(1, StoredVerdict::Accepted, "grille");
    let mut traced = history_entry(3, StoredVerdict::Accepted, "grille");
    traced.record.summary.trace.serial = "TL-1".into();
    let second = again(&first, 2, StoredVerdict::Accepted);
    let entries = [first, second, traced];
    for entry in &entries {
        history.add(entry, &ALL).expect("written");
    }
    let known = TraceChange::Fill(Traceability {
        serial: "TL-4711".into(),
        ..Traceability::default()
    });
    for entry in &entries {
        let hung = &entry.record.summary.hung;
        history.trace_part(hung, &known).expect("written");
    }
    history.trace_part(&HungId::new(), &known).expect("no rows");
    let serial = |number| history.known(number).expect("there").summary.trace.serial;
    assert_eq!([1, 2, 3].map(serial), ["TL-4711", "TL-4711", "TL-1"]);
    let found = Filter {
        text: "tl-4711".into(),
        ..Filter::default()
    };
    assert_eq!(numbers(&history, &found), [1]);
    // It belongs to another part.
    let other = TraceChange::ClearSerial("TL-4711".into());
    for entry in &entries {
        let hung = &entry.record.summary.hung;
        history.trace_part(hung, &other).expect("written");
    }
    let serial = |number| history.known(number).expect("there").summary.trace.serial;
    assert_eq!([1, 2, 3].map(serial), ["", "", "TL-1"]);
    assert!(numbers(&history, &found).is_empty());
    // The order is named later, and another one than at the start; what is not named stays.
    let named = TraceChange::Set(Traceability {
        order: "4712".into(),
        ..Traceability::default()
    });
    let hung = &entries[2].record.summary.hung;
    history.trace_part(hung, &named).expect("written");
    let last = history.known(3).expect("there").summary.trace;
    assert_eq!((&*last.serial, &*last.order), ("TL-1", "4712"));
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_an_inspection_is_in_the_history_with_its_frame_or_says_why_not_or_not_at_all()
 {
    use files::disk::faults::{Writer, with_advice};

    let add = |folder: &std::path::Path, seconds| -> Result<(), HistoryError> {
        let mut history = History::open(folder)?.history;
        let entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
        // A frame that is not kept is reported, too.
        let (_, frame) = history.write(&entry, &ALL)?;
        frame.map(|is_kept| assert!(is_kept))
    };
    Writer {
        test: "history::tests::whichever_call_fails_an_inspection_is_in_the_history_with_its_frame_or_says_why_not_or_not_at_all",
        prepare: &|folder| add(folder, 1).expect("written"),
        write: &|folder| add(folder, 2).map_err(|error| with_advice(&error)),
        state: &|folder| {
            let history = open_history(folder);
            let page = history.page(&Filter::default(), 0, 10).expect("asked");
            let mut num_frames = 0;
            for row in &page.rows {
                let record = history.known(row.number).expect("there");
                let has_frame = history.scene(&record).expect("read").is_some();
                assert_ne!(has_frame, record.detail.frame_loss.is_some());
                num_frames += usize::from(has_frame);
            }
            // Files that no row refers to were removed.
            let frames = std::fs::read_dir(history.frames_folder()).expect("listed");
            assert_eq!(frames.count(), num_frames + 1);
            format!("{} inspections, {num_frames} frames", page.num_all)
        },
        between: &["2 inspections, 1 frames"],
    }
    .fails_at_every_call();
}

#[test]
fn poses_of_accepted_parts_come_in_the_order_of_time() {
    let (_folder, mut history) = new_history();
    for seconds in [3, 1, 2] {
        let verdict = match seconds {
            2 => StoredVerdict::Rejected,
            _ => StoredVerdict::Accepted,
        };
        let entry = history_entry(seconds, verdict, "fender");
        history.add(&entry, &ALL).expect("written");
    }
    let mut older = history_entry(4, StoredVerdict::Accepted, "fender");
    older.record.detail.line = r#"{"schema":1,"pose":null}"#.into();
    history.add(&older, &ALL).expect("written");
    let other = history_entry(5, StoredVerdict::Accepted, "grille");
    history.add(&other, &ALL).expect("written");
    let found = |filter: &Filter| {
        let poses = history.poses(filter, 9).expect("asked");
        let figures = poses
            .iter()
            .map(|pose| (pose.at, pose.reference.clone(), pose.rms_m));
        figures.collect::<Vec<_>>()
    };
    let fender = |seconds: i64| {
        (
            moment(seconds),
            "fender".to_owned(),
            0.001 + 1e-4 * seconds as f64,
        )
    };
    let of_fender = Filter {
        part: Some("fender".into()),
        ..Filter::default()
    };
    assert_eq!(found(&of_fender), [fender(1), fender(3)]);
    assert_eq!(found(&Filter::default()).len(), 3);
    let newest = history.poses(&of_fender, 1).expect("asked");
    let [newest] = newest.as_slice() else {
        panic!("{newest:?}");
    };
    assert_eq!((newest.at, &*newest.source), (moment(3), "simulated"));
    assert_eq!(newest.recipe, Recipe::default().identity());
    assert_eq!(newest.accept, Some(Recipe::default().accept));
    let until = Filter {
        until: Some(moment(3)),
        ..of_fender
    };
    assert_eq!(found(&until), [fender(1)]);
}

#[test]
fn not_accepted_is_everything_but_accepted_in_the_file_and_before() {
    let (_folder, mut history) = new_history();
    let filter = Filter {
        verdict: Some(VerdictFilter::NotAccepted),
        ..Filter::default()
    };
    let entries = StoredVerdict::ALL
        .into_iter()
        .zip(1..)
        .map(|(verdict, seconds)| history_entry(seconds, verdict, "grille"));
    for entry in entries {
        history.add(&entry, &ALL).expect("written");
        let summary = &entry.record.summary;
        let is_wanted = summary.verdict != StoredVerdict::Accepted;
        assert_eq!(filter.passes(summary), is_wanted, "{:?}", summary.verdict);
    }
    let found = history.page(&filter, 0, 10).expect("asked");
    assert_eq!(found.num_matching, 3);
}
