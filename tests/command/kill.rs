//! A program that is killed while it writes loses at most the inspection that it was writing.
//!
//! The test runs itself as another process, which writes inspections with their frames, and their reports as JSON,
//! PDF and a row of a table, as fast as it can, and reports each on standard output. It is killed at a random moment,
//! again and again, in the same folder.

use std::{
    env, fs,
    io::{BufRead as _, BufReader, Write as _},
    path::Path,
    process::{Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use crate::kit::{history_entry, open_history, small_scene};
use jiff::Timestamp;
use partsight::{
    files::write_atomically,
    history::{Filter, History, KeepFrames, NewEntry, Retention, StoredVerdict, Traceability},
    library::Library,
    pipeline::{self, Inspection, NamedRecipe, Recipe, Unwatched},
    report::{
        ReportFolder,
        pose_report::{PdfPictures, PoseReport, ReportSubject, SeenBy, append_csv, pose_pdf},
    },
    robot::Convention,
};
use rand::{RngExt as _, SeedableRng as _};

/// Environment variable of the process to be killed: the folder to write in.
const BODY: &str = "PARTSIGHT_KILL_TEST";
/// The table of poses in that folder.
const TABLE: &str = "poses.csv";
const NUM_KILLS: usize = 200;

const ALL: Retention = Retention {
    keep: KeepFrames::All,
    max_days: 3650,
    max_gigabytes: 10.0,
};

/// An inspection with unique contents.
fn entry(number: i64) -> NewEntry {
    let mut entry = history_entry(number, StoredVerdict::Unknown, "unknown");
    entry.record.summary.at = geometry::clock::now();
    entry.record.detail.line = line_of(number);
    entry.picture = None;
    entry
}

fn line_of(number: i64) -> String {
    format!(
        "{{\"scene\":\"frame {number}\",\"padding\":\"{}\"}}",
        "x".repeat(600)
    )
}

fn inspection() -> Inspection {
    let library = Library::default();
    pipeline::run(&small_scene(1), &library, &Recipe::default(), &Unwatched).expect("not cancelled")
}

fn report_of(number: i64, inspection: &Inspection) -> PoseReport {
    PoseReport::of(&ReportSubject {
        inspected_at: Timestamp::UNIX_EPOCH,
        scene: &format!("frame {number}"),
        source: None,
        seen_by: SeenBy::Simulation,
        trace: &Traceability::default(),
        inspection,
        middle: None,
        stand_off: None,
        recipe: &NamedRecipe::default(),
        library_identity: "0badcafe",
        num_references: 0,
        robot: None,
        for_robot: None,
        doubts: &[],
        convention: Convention::Kuka,
    })
}

/// The process to be killed: writes until then.
#[test]
fn body() {
    let Some(folder) = env::var_os(BODY) else {
        return;
    };
    let folder = Path::new(&folder);
    let mut history = open_history(folder);
    let mut reports = ReportFolder::make(&folder.join("reports")).expect("made");
    let inspection = inspection();
    let mut out = std::io::stdout();
    loop {
        // The number that it will get, because no other process writes.
        let newest = history.page(&Filter::default(), 0, 1).expect("asked");
        let next = newest.rows.first().map_or(1, |row| row.number + 1);
        let number = history.add(&entry(next), &ALL).expect("written");
        assert_eq!(number, next);
        let name = format!("frame-{number}.pcd");
        let line = line_of(number);
        reports
            .write(Path::new(&name), &line, &[])
            .expect("written");
        let report = report_of(number, &inspection);
        let pdf = pose_pdf(&report, &PdfPictures::default());
        for (ending, bytes) in [("json", report.to_json().as_bytes()), ("pdf", &pdf)] {
            let path = folder.join(format!("reports/frame-{number}.pose.{ending}"));
            write_atomically(&path, |writer| writer.write_all(bytes)).expect("written");
        }
        append_csv(&folder.join(TABLE), &report).expect("appended");
        writeln!(out, "written {number}").expect("read");
        out.flush().expect("read");
    }
}

#[test]
fn a_kill_at_any_moment_loses_at_most_the_inspection_in_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut random = rand_pcg::Pcg64::seed_from_u64(2_026);
    let mut known = 0;
    let mut num_in_flight = 0;
    let mut all_told = Vec::new();
    for kill in 0..NUM_KILLS {
        // From before it has opened the file until after several inspections.
        let moment = Duration::from_micros(random.random_range(0..100_000));
        let reply = killed_after(moment, folder.path());
        let history = open_history(folder.path());
        let page = history.page(&Filter::default(), 0, 1).expect("asked");
        let newest = page.rows.first().map_or(0, |row| row.number);
        assert_eq!(page.num_all as i64, newest, "kill {kill}: none is missing");
        let reply = reply.unwrap_or(known);
        assert!(
            reply <= newest,
            "kill {kill}: {reply} was reported as written, {newest} is there"
        );
        assert!(
            newest <= reply + 1,
            "kill {kill}: {reply} was reported as written, {newest} is there"
        );
        num_in_flight += newest - reply;
        for number in known + 1..=newest {
            let record = history.known(number).expect("whole");
            assert_eq!(record.detail.line, line_of(number));
            assert_eq!(record.summary.scene.to_string(), format!("frame {number}"));
            let kept = history.scene(&record).expect("whole").expect("kept");
            let written = small_scene(number as u16);
            assert!(kept.cloud.points == written.cloud.points, "another frame");
        }
        for number in known + 1..=reply {
            let path = folder
                .path()
                .join(format!("reports/frame-{number}.report.json"));
            let line = fs::read_to_string(path).expect("written");
            assert_eq!(line, line_of(number) + "\n");
            all_told.push(number);
        }
        known = newest;
    }
    // Every report is complete, even one not yet reported; an interrupted one is at most a hidden file.
    let mut num_reports = 0;
    for report in fs::read_dir(folder.path().join("reports")).expect("there") {
        let path = report.expect("listed").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.starts_with('.') {
            continue;
        }
        let bytes = fs::read(&path).expect("read");
        if path.extension().is_some_and(|ending| ending == "pdf") {
            assert!(bytes.trim_ascii_end().ends_with(b"%%EOF"), "{name}");
        } else {
            serde_json::from_slice::<serde_json::Value>(&bytes).expect("whole");
        }
        num_reports += usize::from(name.ends_with(".report.json"));
    }
    check_table(folder.path(), &all_told);
    assert!(
        num_reports as i64 >= known - num_in_flight,
        "{num_reports} of {known}"
    );
    // Even on a busy machine, the kills must hit a process that writes.
    assert!(known > 50, "only {known} written in {NUM_KILLS} lives");
    // Every row has a frame and every frame a row; the file of the camera is common to all frames.
    let history = History::open(folder.path()).expect("opened").history;
    assert_eq!(history.usage().expect("asked").num_frames as i64, known);
    let files = fs::read_dir(history.frames_folder())
        .expect("there")
        .count();
    assert_eq!(files as i64, known + 1);
}

/// Checks that every reported row is there, and that none is cut off once another was appended.
fn check_table(folder: &Path, all_told: &[i64]) {
    let table = folder.join(TABLE);
    append_csv(&table, &report_of(0, &inspection())).expect("appended");
    let text = fs::read_to_string(&table).expect("read");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let scene = rows[0].iter().position(|name| *name == "scene");
    let scene = scene.expect("a column");
    // Reports differ in their scene only, so complete rows have as many cells as the last one.
    let whole = rows.last().map_or(0, Vec::len);
    assert!(rows.iter().skip(1).all(|row| row.len() == whole), "{text}");
    for number in all_told {
        let name = format!("frame {number}");
        let num = rows.iter().filter(|row| row[scene] == name).count();
        assert_eq!(num, 1, "{name}");
    }
}

/// Runs the body, kills it this time after its start, and returns the last number that it reported.
fn killed_after(moment: Duration, folder: &Path) -> Option<i64> {
    let mut child = Command::new(env::current_exe().expect("this program"))
        .args(["--exact", "kill::body", "--nocapture", "--test-threads=1"])
        .env(BODY, folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let lines = BufReader::new(child.stdout.take().expect("piped"));
    let reader = thread::spawn(move || {
        let lines = lines.lines().map_while(Result::ok);
        // The first one follows the test runner's own words on its line.
        let numbers = lines.filter_map(|line| line.split_once("written ")?.1.parse().ok());
        numbers.last()
    });
    thread::sleep(Duration::from_millis(15) + moment);
    // SIGKILL: the process cannot clean up.
    child.kill().expect("it runs until it is killed");
    child.wait().expect("gone");
    reader.join().expect("read")
}

#[test]
fn two_processes_write_at_once_and_nothing_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_owned();
    let is_over = Arc::new(AtomicBool::new(false));
    let other = {
        let (path, is_over) = (path.clone(), Arc::clone(&is_over));
        // This process adds entries while the others run.
        thread::spawn(move || {
            let mut history = History::open(&path).expect("opened").history;
            let mut numbers = Vec::new();
            while !is_over.load(Ordering::Relaxed) {
                let entry = entry(10_000 + numbers.len() as i64);
                numbers.push(history.add(&entry, &ALL).expect("written"));
            }
            numbers
        })
    };
    let mut child = Command::new(env!("CARGO_BIN_EXE_partsight"))
        .args(["simulate", "--part", "grille", "--out", "grille.pcd"])
        .current_dir(&path)
        .env("HOME", &path)
        .env("XDG_DATA_HOME", &path)
        .spawn()
        .expect("starts");
    assert!(child.wait().expect("ended").success());
    for _ in 0..3 {
        let inspected = Command::new(env!("CARGO_BIN_EXE_partsight"))
            .args(["inspect", "grille.pcd", "grille.pcd", "--history", "."])
            .current_dir(&path)
            .env("HOME", &path)
            .env("XDG_DATA_HOME", &path)
            .output()
            .expect("ran");
        let err = String::from_utf8_lossy(&inspected.stderr).into_owned();
        assert!(!err.contains("history"), "{err}");
    }
    is_over.store(true, Ordering::Relaxed);
    let ours = other.join().expect("written");
    let history = History::open(&path).expect("opened").history;
    let page = history.page(&Filter::default(), 0, 1000).expect("asked");
    assert_eq!(page.num_all, ours.len() + 6);
    for number in ours {
        let record = history.known(number).expect("there");
        assert!(history.scene(&record).expect("read").is_some());
    }
}
