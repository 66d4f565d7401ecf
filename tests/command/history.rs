//! The history as the built program writes and reads it, also with a failing disk.

use std::{
    fs,
    io::{self, Seek as _, Write as _},
    path::{self, Path},
    process::Command,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use jiff::{SignedDuration, Timestamp};
use partsight::{
    capture::{Captured, Image, Recorder},
    geometry::rigid::RigidTransform,
    history::{
        Filter, FrameLoss, History, HistoryBuffer, HistoryEvent, HungId, InspectionContext,
        KeepFrames, NewEntry, Retention, SceneTitle, StoredVerdict,
    },
    library::Library,
    pipeline::{self, NamedRecipe, Unwatched},
    simulate::{CellSetup, PartKind, SensorNoise, Side},
};
use serde_json::Value;

use crate::{
    kit::{HangingPart, csv_column, history_entry, open_history, scene_of},
    workplace::Workplace,
};

/// A place with captures of a fender and of a part that is not enrolled.
fn with_captures() -> Workplace {
    let place = Workplace::new();
    for (part, file) in [("fender", "fender.pcd"), ("hood", "hood.png")] {
        let placed = ["--placement", "facing", "--seed", "5", "--out", file];
        place.simulated(&[&["--part", part], &placed[..]].concat());
    }
    place
}

#[test]
fn what_inspect_saw_is_listed_shown_labelled_inspected_again_and_exported() {
    let place = with_captures();
    let own = place.path("data/partsight/history.sqlite");
    place.accepted(&["inspect", "fender.pcd", "--no-history"]);
    assert!(!own.exists());
    let inspected = place.run(&["inspect", "fender.pcd", "hood.png", "--json"]);
    assert_eq!((inspected.code, inspected.err.as_str()), (1, ""));
    assert!(own.exists());

    let listed = place.accepted(&["history", "list", "--json"]).lines();
    assert_eq!(listed.len(), 2);
    // The newest comes first; the frames of refused and of recently accepted ones are kept.
    assert_eq!(
        (&listed[0]["number"], &listed[0]["scene"]),
        (&2.into(), &"hood.png".into())
    );
    assert_eq!(
        (&listed[0]["frame_kept"], &listed[1]["frame_kept"]),
        (&true.into(), &true.into())
    );
    assert_eq!(
        (&listed[1]["verdict"], &listed[1]["part"]),
        (&"accepted".into(), &"fender".into())
    );
    let rows = place.accepted(&["history", "list", "--part", "fender", "--since", "today"]);
    assert!(
        rows.out.contains("fender.pcd") && !rows.out.contains("hood.png"),
        "{}",
        rows.out
    );
    assert!(
        rows.err.contains("1 of 1 parts shown, 2 parts in all"),
        "{}",
        rows.err
    );
    let none = place.accepted(&["history", "list", "--until", "2020-01-01", "--json"]);
    assert_eq!(none.out, "");

    // The line is the one that `inspect` wrote.
    let shown = place
        .accepted(&["history", "show", "1", "--json"])
        .lines()
        .remove(0);
    assert_eq!(shown["line"], inspected.lines()[0]);
    let card = place.accepted(&["history", "show", "2"]).out;
    assert!(
        card.contains("why not") && card.contains("history-frames"),
        "{card}"
    );

    // The same recipe and library give the same result for the kept frame, to the last digit.
    let again = place
        .accepted(&["history", "show", "2", "--again", "--json"])
        .lines()
        .remove(0);
    assert_eq!(
        (&again["again"]["same"], &again["again"]["changed"]),
        (&true.into(), &Value::Array(vec![]))
    );
    let other = place
        .accepted(&["history", "show", "2", "--again", "--matcher", "paper"])
        .out;
    assert!(
        other.contains("changed") && other.contains("recipe"),
        "{other}"
    );

    let mistyped = place.accepted(&["history", "label", "2", "frnt_door"]);
    assert!(mistyped.err.contains("front_door"), "{}", mistyped.err);
    place.accepted(&["history", "label", "2", "-"]);
    place.accepted(&["history", "remark", "2", "a hood, not ours"]);
    let found = place
        .accepted(&["history", "list", "--text", "HOOD ours", "--json"])
        .lines();
    assert_eq!(
        (found.len(), &found[0]["label"]),
        (1, &"not_enrolled".into())
    );

    place.accepted(&["history", "export", "--csv", "all.csv", "--cases", "cases"]);
    let table = fs::read_to_string(place.path("all.csv")).expect("written");
    assert_eq!(table.lines().count(), 3);
    assert!(table.contains("\"a hood, not ours\""), "{table}");
    let judged = place.accepted(&["evaluate", "cases"]);
    assert!(judged.out.contains('1'), "{}", judged.out);

    let kept = place.accepted(&["history", "keep", "all", "--days", "30"]);
    assert!(
        kept.out.contains("frames kept: all, at most 30 days"),
        "{}",
        kept.out
    );
    place.accepted(&["inspect", "fender.pcd"]);
    let newest = place
        .accepted(&["history", "list", "--limit", "1", "--json"])
        .lines();
    assert_eq!(
        (&newest[0]["number"], &newest[0]["frame_kept"]),
        (&3.into(), &true.into())
    );
    place.accepted(&["history", "keep", "none"]);
    place.accepted(&["inspect", "fender.pcd"]);
    let gone = place.run(&["history", "show", "4", "--again"]);
    assert_eq!(gone.code, 2);
    assert!(
        gone.err.contains("is not kept") && gone.err.contains("history keep all"),
        "{}",
        gone.err
    );
}

#[test]
fn a_label_that_is_no_part_names_the_library_and_no_case_is_written_into_one() {
    let place = with_captures();
    assert_eq!(place.run(&["inspect", "hood.png"]).code, 1);
    let mistyped = place.accepted(&["history", "label", "1", "frnt_door"]);
    let library = format!(
        "partsight{}library is named frnt_door",
        path::MAIN_SEPARATOR
    );
    assert!(mistyped.err.contains(&library), "{}", mistyped.err);
    let exported = place.accepted(&["history", "export", "--cases", "cases"]);
    let words = "cases in cases: 1 new, 0 updated, 0 unchanged";
    assert!(exported.err.contains(words), "{}", exported.err);
    place.accepted(&["history", "label", "1", "-"]);
    let again = place.accepted(&["history", "export", "--cases", "cases"]);
    let words = "cases in cases: 0 new, 1 updated, 0 unchanged";
    assert!(again.err.contains(words), "{}", again.err);
    let judged = place.accepted(&["evaluate", "cases", "--json", "judged.json"]);
    assert_eq!(judged.code, 0);
    let cases = &place.json("judged.json")["cases"];
    assert_eq!(cases.as_array().map(Vec::len), Some(1));
    assert_eq!(cases[0]["truth"]["is"], "not_enrolled");
    let library = "data/partsight/library";
    let refused = place.coded(2, &["history", "export", "--cases", library]);
    assert!(refused.err.contains("holds parts"), "{}", refused.err);
}

#[test]
fn a_label_takes_the_words_of_the_list_and_an_empty_one_is_refused() {
    let place = with_captures();
    assert_eq!(place.run(&["inspect", "hood.png"]).code, 1);
    let label = || {
        let listed = place.accepted(&["history", "list", "--json"]).lines();
        listed[0]["label"].clone()
    };
    for (given, shown) in [
        ("-", "not_enrolled"),
        ("nothing", "nothing"),
        ("not_enrolled", "not_enrolled"),
        ("none", "nothing"),
    ] {
        let set = place.accepted(&["history", "label", "1", given]);
        // The name of a part would be compared with the library.
        assert_eq!((label(), set.err.as_str()), (shown.into(), ""), "{given}");
    }
    for empty in ["", " "] {
        let refused = place.coded(2, &["history", "label", "1", empty]);
        assert!(refused.err.contains("? to remove"), "{}", refused.err);
        assert_eq!(label(), "nothing");
    }
    place.accepted(&["history", "label", "1", "?"]);
    assert_eq!(label(), Value::Null);
}

#[test]
fn everything_that_was_not_accepted_is_listed_under_that_name() {
    let place = with_captures();
    place.accepted(&["simulate", "--part", "empty", "--out", "empty.pcd"]);
    let all = ["fender.pcd", "hood.png", "empty.pcd"];
    assert_eq!(place.run(&[&["inspect"], &all[..]].concat()).code, 1);
    let scenes = |verdict: &str| {
        let list = ["history", "list", "--json", "--verdict", verdict];
        let lines = place.accepted(&list).lines();
        let scenes = lines
            .iter()
            .map(|line| line["scene"].as_str().map(str::to_owned));
        scenes
            .map(|scene| scene.expect("a name"))
            .collect::<Vec<_>>()
    };
    assert_eq!(scenes("not-accepted"), ["empty.pcd", "hood.png"]);
    assert_eq!(scenes("accepted"), ["fender.pcd"]);
    assert_eq!(scenes("rejected"), Vec::<String>::new());
    assert_eq!(scenes("unknown"), ["hood.png"]);
    assert_eq!(scenes("no-part"), ["empty.pcd"]);
    let card = place.run(&["history", "show", "1"]).out;
    assert!(
        card.contains(", margin 0.") && !card.contains("ahead of"),
        "{card}"
    );
}

#[test]
fn programs_read_why_an_inspection_was_not_accepted_as_a_kind() {
    let place = with_captures();
    let inspected = place.run(&["inspect", "fender.pcd", "hood.png"]);
    assert_eq!(inspected.code, 1);
    let kinds = ["1", "2"].map(|number| {
        let shown = place.accepted(&["history", "show", number, "--json"]);
        shown.lines()[0]["reason_kind"].clone()
    });
    assert_eq!(kinds, [Value::Null, "unknown".into()]);
    place.accepted(&["history", "export", "--csv", "all.csv"]);
    let table = place.read("all.csv");
    assert_eq!(csv_column(&table, "reason_kind"), ["", "unknown"]);
}

#[test]
fn the_list_names_the_part_that_a_mirror_image_is_of() {
    let place = Workplace::new();
    place.accepted(&[
        "simulate",
        "--part",
        "front_door",
        "--side",
        "right",
        "--placement",
        "facing",
        "--seed",
        "5",
        "--out",
        "right.pcd",
    ]);
    assert_eq!(place.run(&["inspect", "right.pcd"]).code, 1);
    let listed = place.accepted(&["history", "list"]);
    let named = "mirrored Front door, left";
    assert!(listed.out.contains(named), "{}", listed.out);
    let row = place
        .accepted(&["history", "list", "--json"])
        .lines()
        .remove(0);
    assert_eq!(row["mirror_of"], "Front door, left");
    assert_eq!(
        (&row["verdict"], &row["part"]),
        (&"unknown".into(), &Value::Null)
    );
}

/// Records parts that come in from the right one after the other, ten frames a second, hang still and leave to the
/// left. A part whose flag is false does not stop.
fn record_line(folder: &Path, parts: &[(PartKind, bool)]) {
    let recorder = Recorder::create(folder, "a line", "simulated", true);
    let mut recorder = recorder.expect("a folder");
    let mut number = 0;
    for (kind, rests) in parts {
        let part = HangingPart::new(*kind, 3);
        let coming = (1..=6).map(|step| 0.4 * f64::from(step)).rev();
        let resting = (0..if *rests { 26 } else { 2 }).map(|_| 0.0);
        let leaving = (1..=6).map(|step| -0.4 * f64::from(step));
        for x in coming.chain(resting).chain(leaving) {
            number += 1;
            let aside = RigidTransform::translation(x, 0.0, 0.0);
            let captured = Captured {
                number,
                name: format!("frame {number}"),
                taken_at: Timestamp::UNIX_EPOCH + SignedDuration::from_millis(100 * number as i64),
                arrived: Instant::now(),
                image: Image::Depth(part.frame(SensorNoise::kinect(number), &aside)),
                is_simulated: true,
                truth: None,
                robot_from_flange: None,
                warnings: Vec::new(),
            };
            recorder.write(&captured).expect("written");
        }
    }
}

#[test]
fn a_part_that_a_trend_will_refuse_is_named_before_and_a_steady_one_is_not() {
    let place = Workplace::new();
    let mut history = open_history(&place.path("."));
    for (part, step) in [("fender", 0.02), ("grille", 0.0)] {
        for index in 0..60_u8 {
            let mut entry = history_entry(i64::from(index), StoredVerdict::Accepted, part);
            // The log odds of a score; those of 0.9 are 2.197.
            let log_odds: f64 = 4.0 - step * f64::from(index);
            entry.record.summary.score = Some([1.0 / (1.0 + (-log_odds).exp()), 0.8]);
            (entry.scene, entry.picture) = (None, None);
            history.add(&entry, &Retention::default()).expect("written");
        }
    }
    drop(history);
    let drift =
        |more: &[&'static str]| [&["history", "drift", "--history", "."][..], more].concat();
    let lines = place.coded(1, &drift(&["--json"])).lines();
    let score = |line: &Value| line["quantities"][0].clone();
    assert_eq!(lines[0]["part"], "fender");
    assert_eq!(lines[1]["part"], "grille");
    assert_eq!(score(&lines[0])["trend"]["refuses_in"], 32);
    assert_eq!(score(&lines[0])["limit"], 0.9);
    assert_eq!(score(&lines[1])["trend"], Value::Null);
    let shown = place.coded(1, &drift(&[]));
    let warning =
        "fender drifts: at this trend, single parts are refused after 32 more inspections";
    assert!(shown.err.contains(warning), "{}", shown.err);
    // Its fit becomes worse, too, but nothing is refused for that.
    let steady = place.accepted(&drift(&["--part", "grille"]));
    assert!(
        steady.out.contains("rms") && !steady.err.contains("drifts"),
        "{}",
        steady.err
    );
}

#[test]
fn a_followed_source_writes_one_row_for_each_part_that_hung_there() {
    let place = Workplace::new();
    let parts = [
        (PartKind::Fender, true),
        (PartKind::FrontDoor, true),
        (PartKind::FrontDoor, true),
        (PartKind::BackDoor, false),
    ];
    record_line(&place.path("monday"), &parts);
    let mut history = History::open(&place.path(".")).expect("opened").history;
    let all = Retention {
        keep: KeepFrames::All,
        ..Retention::default()
    };
    history.set_retention(&all).expect("written");
    drop(history);
    let source = [
        "inspect",
        "--source",
        "recording:monday",
        "--json",
        "--history",
        ".",
    ];
    let ran = place.run(&source);
    // Every frame is still reported.
    assert_eq!(ran.lines().len(), 38 * 3 + 14, "{}", ran.err);
    let rows = place
        .accepted(&["history", "list", "--json", "--history", "."])
        .lines();
    let found = rows.iter().rev().map(|row| [&row["part"], &row["verdict"]]);
    let found: Vec<_> = found
        .map(|both| both.map(|text| text.as_str().unwrap_or("-")))
        .collect();
    assert_eq!(
        found[..3],
        [
            ["fender", "accepted"],
            ["front_door", "accepted"],
            ["front_door", "accepted"]
        ]
    );
    // The last one never hung still: it is represented by its best frame.
    assert_eq!((found.len(), found[3][0]), (4, "back_door"));
    for row in &rows {
        assert_eq!(
            (&row["reinspections"], &row["frame_kept"]),
            (&0.into(), &true.into())
        );
    }
    // The kept frame gives the verdict that counted.
    let again = [
        "history",
        "show",
        "1",
        "--again",
        "--json",
        "--history",
        ".",
    ];
    let again = place.accepted(&again).lines().remove(0);
    assert_eq!(again["again"]["verdict"], "accepted");
    // Followed once more, they are new parts: the program cannot know that it is the same recording.
    place.run(&source);
    let listed = place.accepted(&["history", "list", "--history", "."]);
    assert!(listed.err.contains("8 of 8 parts shown"), "{}", listed.err);
}

#[test]
fn a_history_that_cannot_be_written_is_a_warning_and_the_exit_code_stays() {
    let place = with_captures();
    fs::write(place.path("taken"), "a file").expect("written");
    let inspect = [
        "inspect",
        "fender.pcd",
        "fender.pcd",
        "fender.pcd",
        "--json",
        "--history",
        "taken",
    ];
    let ran = place.run(&inspect);
    assert_eq!((ran.code, ran.lines().len()), (0, 3), "{}", ran.err);
    assert_eq!(
        ran.err.matches("the history cannot be kept there").count(),
        1,
        "{}",
        ran.err
    );
    assert!(
        ran.err.contains("3 inspections are not in the history"),
        "{}",
        ran.err
    );
    assert_eq!(
        fs::read_to_string(place.path("taken")).expect("there"),
        "a file"
    );

    let missing = place.run(&["history", "list", "--history", "nowhere"]);
    assert_eq!(missing.code, 2);
    assert!(
        missing.err.contains("there is no history yet"),
        "{}",
        missing.err
    );
    assert!(!place.path("nowhere").exists());
    let unknown = place.run(&["inspect", "fender.pcd", "--history", "a", "--no-history"]);
    assert_eq!(unknown.code, 2);
}

#[test]
fn a_damaged_history_is_named_and_to_be_restored_from_a_copy() {
    let place = Workplace::new();
    let folder = place.path("kept");
    drop(History::open(&folder).expect("opened"));
    let file = fs::File::options()
        .write(true)
        .open(folder.join("history.sqlite"))
        .expect("there");
    let length = file.metadata().expect("read").len();
    file.set_len(length / 2).expect("cut");
    drop(file);
    let listed = ["history", "list", "--history", "kept"];
    let err = place.accepted(&listed).err;
    assert!(err.contains("history.sqlite: it ends after"), "{err}");
    assert!(err.contains("it was set aside as"), "{err}");
    assert!(err.contains("to do: If you have a copy"), "{err}");
}

/// SQLite's locks are those of the process: closing the file in one place must not release them in another.
#[test]
fn a_command_that_closes_the_history_leaves_the_log_of_a_program_that_opened_it_twice() {
    let place = Workplace::new();
    let folder = place.path("kept");
    let keeper = HistoryBuffer::new(Some(folder.clone()));
    let listed = || {
        let listed = place.accepted(&["history", "list", "--json", "--history", "kept"]);
        listed.lines().len()
    };
    for (ticket, entry) in (1..=3).zip(entries()) {
        keeper.add(ticket, entry, Instant::now());
        // As the sender to a database does.
        drop(History::open(&folder).expect("opened"));
        assert_eq!(listed(), ticket as usize);
    }
}

/// A separate file system, if this user may mount one.
struct Disk {
    folder: tempfile::TempDir,
}

impl Disk {
    /// Mounts a file system; `None`, with the reason printed, if that is not possible.
    #[expect(clippy::print_stderr, reason = "what was not tried is said")]
    fn of_kilobytes(size: u32) -> Option<Self> {
        let folder = tempfile::tempdir().expect("a folder");
        let disk = Self { folder };
        let mounted = cfg!(target_os = "linux") && disk.mount(&format!("size={size}k"));
        if !mounted {
            eprintln!("skipped: only the system's administrator may mount a small disk to fill");
        }
        mounted.then_some(disk)
    }

    fn mount(&self, options: &str) -> bool {
        let ran = Command::new("mount")
            .args(["-t", "tmpfs", "-o", options, "tmpfs"])
            .arg(self.path())
            .output();
        ran.is_ok_and(|ran| ran.status.success())
    }

    /// Remounts the disk. It is busy while a process that another test is starting has copies of this one's files.
    fn remount(&self, options: &str) {
        let remounted = || {
            let ran = Command::new("mount")
                .args(["-o", &format!("remount,{options}")])
                .arg(self.path())
                .status();
            ran.expect("ran").success()
        };
        let until = Instant::now() + Duration::from_secs(10);
        while !remounted() {
            assert!(Instant::now() < until, "{options}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // This fails if nothing is mounted.
        let _ = Command::new("umount").arg("-l").arg(self.path()).output();
    }
}

fn entries() -> impl Iterator<Item = NewEntry> {
    let setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 3);
    let scene = Arc::new(scene_of(&setup));
    let recipe = NamedRecipe::default();
    let inspection = pipeline::run(&scene, &Library::default(), &recipe, &Unwatched).expect("ran");
    (1..).map(move |number| {
        let about = InspectionContext {
            at: geometry::clock::now(),
            scene: SceneTitle::Named(format!("frame {number}")),
            source: "simulated".into(),
            is_simulated: true,
            title_of: &str::to_owned,
            line: "{}".into(),
            library: "0".into(),
            origin: None,
            picture: None,
            hung: HungId::new(),
        };
        NewEntry::of(about, &scene, &inspection, &recipe)
    })
}

fn num_failures(news: &[HistoryEvent]) -> usize {
    let is_failure = |news: &&HistoryEvent| matches!(news, HistoryEvent::Failed { .. });
    news.iter().filter(is_failure).count()
}

/// Longer than the pause before the next attempt.
const LATER: Duration = Duration::from_mins(5);

/// Fills a disk with this file, and returns its size.
fn fill(mut filling: &fs::File) -> u64 {
    let full = (0..).find_map(|_| filling.write(&[1; 4096]).err());
    assert_eq!(full.expect("full").kind(), io::ErrorKind::StorageFull);
    filling.metadata().expect("read").len()
}

#[test]
fn on_a_disk_that_fills_first_frames_and_then_rows_are_no_longer_written_and_each_is_said_once() {
    let Some(disk) = Disk::of_kilobytes(6000) else {
        return;
    };
    let keeper = HistoryBuffer::new(Some(disk.path().join("history")));
    let begun = Instant::now();
    keeper.open(begun);
    let mut entries = (1..).zip(entries());
    let mut add = |num| {
        for (ticket, entry) in entries.by_ref().take(num) {
            keeper.add(ticket, entry, begun);
        }
        keeper.take_news()
    };
    let record = |number| keeper.row(number).expect("asked").expect("there");
    let is_full = |what: &str, advice: &str| what.contains("full") && advice.contains("room");
    add(2);
    let frame_bytes = record(1).summary.frame_bytes.expect("kept");
    assert!(frame_bytes > 60_000, "{frame_bytes}");

    let filling = fs::File::create(disk.path().join("filling")).expect("made");
    let leave = |bytes: u64| {
        (&filling).seek(io::SeekFrom::End(0)).expect("at its end");
        let size = fill(&filling);
        filling.set_len(size - bytes).expect("cut");
    };
    // There is room for rows, but for no frame.
    leave(frame_bytes - 8192);
    let news = add(1);
    let is_told = |news: &&HistoryEvent| matches!(news, HistoryEvent::FramesNotKept { what, advice } if is_full(what, advice));
    assert_eq!(news.iter().filter(is_told).count(), 1, "{news:?}");
    assert_eq!((num_failures(&news), keeper.num_waiting()), (0, 0));
    // There is room for a frame, but not for its row as well.
    leave(frame_bytes + 8192);
    let news = add(1);
    assert_eq!(news.iter().filter(is_told).count(), 0, "{news:?}");
    assert_eq!((num_failures(&news), keeper.num_waiting()), (0, 0));
    for number in [3, 4] {
        let detail = record(number).detail;
        assert_eq!(
            (detail.frame, detail.frame_loss),
            (None, Some(FrameLoss::DiskFull))
        );
    }

    // There is room for nothing.
    leave(0);
    let num: u64 = 25;
    let news = add(num as usize - 4);
    assert_eq!(num_failures(&news), 1, "{news:?}");
    assert_eq!(news.iter().filter(is_told).count(), 0, "{news:?}");
    let full = |news: &HistoryEvent| matches!(news, HistoryEvent::Failed { what, advice } if is_full(what, advice));
    assert!(news.iter().any(full), "{news:?}");
    let page = keeper.page(&Filter::default(), 0, 100).expect("asked");
    assert_eq!(
        (page.num_all, page.rows.len()),
        (num as usize, num as usize)
    );
    assert!(keeper.num_waiting() > 0 && keeper.num_waiting() < num as usize);
    // Still full: the failure is not reported again.
    keeper.retry(begun + LATER);
    assert_eq!(keeper.take_news(), []);

    disk.remount("size=200m");
    keeper.retry(begun + 2 * LATER);
    let news = keeper.take_news();
    assert!(
        matches!(
            news.as_slice(),
            [
                HistoryEvent::FramesKept,
                HistoryEvent::Works { num_lost: 0, .. }
            ]
        ),
        "{news:?}"
    );
    assert_eq!(keeper.num_waiting(), 0);
    drop(keeper);
    let opened = History::open(&disk.path().join("history")).expect("opened");
    assert_eq!(opened.set_aside, None);
    let page = opened
        .history
        .page(&Filter::default(), 0, 100)
        .expect("asked");
    let scenes: Vec<String> = page
        .rows
        .iter()
        .rev()
        .map(|row| row.scene.to_string())
        .collect();
    let expected: Vec<String> = (1..=num).map(|number| format!("frame {number}")).collect();
    assert_eq!(scenes, expected);
}

#[test]
fn on_a_full_disk_the_history_is_listed_and_exported_and_nothing_says_to_move_it_away() {
    let Some(disk) = Disk::of_kilobytes(4000) else {
        return;
    };
    let mut history = History::open(disk.path()).expect("opened").history;
    for entry in entries().take(3) {
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let filling = fs::File::create(disk.path().join("filling")).expect("made");
    fill(&filling);

    let place = Workplace::new();
    let folder = disk.path().display().to_string();
    let listed = place.run(&["history", "list", "--json", "--history", &folder]);
    assert_eq!(
        (listed.code, listed.out.lines().count()),
        (0, 3),
        "{}",
        listed.err
    );
    assert!(listed.err.contains("to do: Make room"), "{}", listed.err);
    assert!(!listed.err.contains("move the file away"), "{}", listed.err);
    let exported = place.run(&[
        "history",
        "export",
        "--csv",
        "all.csv",
        "--history",
        &folder,
    ]);
    assert_eq!(exported.code, 0, "{}", exported.err);
    let table = fs::read_to_string(place.path("all.csv")).expect("written");
    assert_eq!(
        table.lines().filter(|line| line.contains("frame ")).count(),
        3
    );
    let shown = place.run(&["history", "show", "2", "--history", &folder]);
    assert_eq!(shown.code, 0, "{}", shown.err);

    // The window also shows what it can read.
    let keeper = HistoryBuffer::new(Some(disk.path().to_owned()));
    let begun = Instant::now();
    keeper.open(begun);
    let page = keeper.page(&Filter::default(), 0, 10).expect("asked");
    assert_eq!(page.num_all, 3);
    assert_eq!(num_failures(&keeper.take_news()), 1);
    // Nothing is waiting, and the disk still fails.
    keeper.retry(begun + LATER);
    assert_eq!(keeper.take_news(), []);
    fs::remove_file(disk.path().join("filling")).expect("removed");
    drop(filling);
    keeper.retry(begun + 2 * LATER);
    let news = keeper.take_news();
    assert!(
        matches!(news.as_slice(), [HistoryEvent::Works { .. }]),
        "{news:?}"
    );
}

#[test]
fn a_write_protected_history_can_be_read_and_is_written_again_later() {
    let Some(disk) = Disk::of_kilobytes(100_000) else {
        return;
    };
    let all = Retention {
        keep: KeepFrames::All,
        ..Retention::default()
    };
    let mut history = History::open(disk.path()).expect("opened").history;
    for entry in entries().take(3) {
        history.add(&entry, &all).expect("written");
    }
    drop(history);
    disk.remount("ro");
    let read = History::open_to_read(disk.path()).expect("opened").history;
    assert_eq!(
        read.page(&Filter::default(), 0, 10).expect("asked").num_all,
        3
    );
    let record = read.known(2).expect("there");
    assert!(read.scene(&record).expect("read").is_some());
    drop(read);

    let place = with_captures();
    let folder = disk.path().display().to_string();
    let listed = place.accepted(&["history", "list", "--json", "--history", &folder]);
    assert_eq!(listed.lines().len(), 3);
    let inspected = place.run(&["inspect", "fender.pcd", "fender.pcd", "--history", &folder]);
    assert_eq!(inspected.code, 0, "{}", inspected.err);
    assert_eq!(
        inspected.err.matches("to do:").count(),
        1,
        "{}",
        inspected.err
    );
    assert!(
        inspected
            .err
            .contains("2 inspections are not in the history"),
        "{}",
        inspected.err
    );

    let keeper = HistoryBuffer::new(Some(disk.path().to_owned()));
    let begun = Instant::now();
    keeper.open(begun);
    for (ticket, entry) in (0..2).zip(entries()) {
        keeper.add(ticket, entry, begun);
    }
    assert_eq!(num_failures(&keeper.take_news()), 1);
    // Meanwhile the rows written before are shown below those waiting.
    let page = keeper.page(&Filter::default(), 0, 10).expect("asked");
    assert_eq!((page.num_all, page.rows[2].number), (5, 3));
    keeper.retry(begun + LATER);
    assert_eq!(keeper.take_news(), []);
    disk.remount("rw");
    keeper.retry(begun + 2 * LATER);
    let page = keeper.page(&Filter::default(), 0, 10).expect("asked");
    assert_eq!((page.num_all, page.rows[0].number), (5, 5));
}

#[test]
fn serial_number_order_and_operator_stand_in_history_table_and_report() {
    let place = with_captures();
    let given = [
        "--serial",
        "TL-4711",
        "--order",
        "A 17",
        "--operator",
        "Kim, early",
    ];
    let inspected = place.accepted(&[&["inspect", "fender.pcd", "--json"], &given[..]].concat());
    assert_eq!(inspected.json()["serial"], "TL-4711");
    place.accepted(&["inspect", "fender.pcd", "--order", "B 2"]);
    let listed = place.accepted(&["history", "list"]).out;
    assert!(
        listed.contains("SERIAL") && listed.contains("Kim, early"),
        "{listed}"
    );
    let lines = place
        .accepted(&["history", "list", "--json", "--text", "tl-4711"])
        .lines();
    assert_eq!(lines.len(), 1);
    assert_eq!(
        (&lines[0]["serial"], &lines[0]["order"]),
        (&"TL-4711".into(), &"A 17".into())
    );
    for (options, expected) in [
        (&["--serial", "TL-4711"][..], &[1][..]),
        (&["--serial", "tl-4711"], &[]),
        (&["--order", " B 2 "], &[2]),
        (&["--order", "B"], &[]),
        (&["--order", "B 2", "--serial", "TL-4711"], &[]),
    ] {
        let list = ["history", "list", "--json"];
        let lines = place.accepted(&[&list[..], options].concat()).lines();
        let numbers: Vec<i64> = (lines.iter())
            .filter_map(|line| line["number"].as_i64())
            .collect();
        assert_eq!(numbers, expected, "{options:?}");
    }
    let shown = place.accepted(&["history", "show", "2"]).out;
    assert!(
        shown.contains("B 2") && !shown.contains("serial"),
        "{shown}"
    );
    place.accepted(&["history", "export", "--csv", "all.csv"]);
    let table = place.read("all.csv");
    for (heading, known) in [
        ("serial", ["TL-4711", ""]),
        ("order", ["A 17", "B 2"]),
        ("operator", ["Kim, early", ""]),
    ] {
        assert_eq!(csv_column(&table, heading), known, "{table}");
    }
    let report = [
        &[
            "report",
            "fender.pcd",
            "--out",
            "reports",
            "--format",
            "json,csv,pdf",
        ],
        &given[..],
    ];
    place.accepted(&report.concat());
    let report = place.json("reports/fender.pose.json");
    assert_eq!(report["traceability"]["operator"], "Kim, early");
    // A serial number belongs to one part.
    let refused = place.coded(2, &["inspect", "fender.pcd", "hood.png", "--serial", "1"]);
    assert!(
        refused.err.contains("--serial names one part"),
        "{}",
        refused.err
    );
}
