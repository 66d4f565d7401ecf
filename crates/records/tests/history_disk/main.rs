//! A history on a disk that fails, wherever `SQLite` itself writes, and wherever a frame is written.
//!
//! `SQLite` writes by calls of its own. A stub library (`disk.c`) intercepts them and lets the n-th one fail, for
//! every n: with a full disk, an input/output error once or from then on, or the end of the program. Afterwards the
//! history read is the old one or the new one, and is never set aside as damaged; a frame that fails costs no row. Without a C compiler the tests
//! report that they are skipped; with `PARTSIGHT_REQUIRE_COMPILER=1` they fail.

#![allow(clippy::disallowed_methods, reason = "tests change files")]
#![cfg(target_os = "linux")]

use std::{env, fs, path::Path, process::Command, sync::Arc, thread};

use capture::fixtures::{SHARED, compile_c};
use geometry::{error::Advice as _, fixtures::skipped};
use records::fixtures::{history_entry, open_history};
use records::history::{
    Filter, FrameLoss, History, HistoryError, KeepFrames, Retention, StoredVerdict,
};
use stages::scene::EmptyCell;

/// Environment variable of the process whose disk fails: its folder.
const BODY: &str = "PARTSIGHT_HISTORY_DISK_TEST";
/// More than the calls of any run.
const MOST_CALLS: usize = 1000;

const ALL: Retention = Retention {
    keep: KeepFrames::All,
    max_days: 3650,
    max_gigabytes: 10.0,
};

type Step = fn(&mut History) -> Result<(), HistoryError>;

/// The changes made to a history, in order.
const STEPS: [Step; 3] = [
    |history| add(history, 2),
    |history| history.set_remark(1, "seen"),
    |history| add(history, 3),
];

/// Adds an inspection with an empty cell of its own.
fn add(history: &mut History, seconds: i64) -> Result<(), HistoryError> {
    let mut entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
    let scene = Arc::make_mut(entry.scene.as_mut().expect("a scene"));
    let cell = EmptyCell::from_scene(scene).expect("a picture");
    scene.empty_cell = Some(Arc::new(cell));
    history.add(&entry, &ALL).map(|_| ())
}

/// The process on the failing disk: reports after each step that it is done, or why not. Retries a step if the fault
/// occurs only once.
#[test]
fn body() {
    let Some(folder) = env::var_os(BODY) else {
        return;
    };
    let folder = Path::new(&folder);
    let fails_once = env::var("DISK_FAULT").is_ok_and(|fault| fault.starts_with("once"));
    let mut history = None;
    let mut is_over = false;
    for (number, step) in STEPS.into_iter().enumerate() {
        let mut take = || -> Result<(), HistoryError> {
            if history.is_none() {
                history = Some(sound(folder)?);
            }
            step(history.as_mut().expect("open"))
        };
        let mut taken = take();
        if let Err(error) = &taken {
            println!("error {error}\nadvice {}", error.advice());
            if fails_once {
                taken = take();
            }
        }
        if taken.is_err() {
            is_over = true;
            break;
        }
        println!("done {number}");
    }
    if is_over {
        drop(history);
        match History::open_to_read(folder) {
            Ok(read) => {
                let page = read.history.page(&Filter::default(), 0, 10).expect("asked");
                println!("read {}", page.num_all);
            }
            Err(error) => println!("error {error}\nadvice {}", error.advice()),
        }
    }
}

fn sound(folder: &Path) -> Result<History, HistoryError> {
    let opened = History::open(folder)?;
    assert_eq!(opened.set_aside, None);
    Ok(opened.history)
}

/// The report of the other process.
struct Reply {
    is_killed: bool,
    num_done: usize,
    errors: Vec<String>,
    num_read: Option<usize>,
}

/// Which files fail: those of the database, or the frames.
const DATABASE: &str = "/history.sqlite";
const FRAMES: &str = "/history-frames/";

fn run(folder: &Path, disk: &Path, files: &str, fault: &str) -> Reply {
    let output = Command::new(env::current_exe().expect("this program"))
        .args(["body", "--exact", "--nocapture", "--test-threads=1"])
        .env(BODY, folder)
        .env("LD_PRELOAD", disk)
        .env("DISK_FILES", files)
        .env("DISK_FAULT", fault)
        .env("DISK_MARK", folder.join("mark"))
        .output()
        .expect("started");
    let words = String::from_utf8_lossy(&output.stdout).into_owned();
    let is_killed = output.status.code().is_none();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(
        is_killed == (fault.starts_with("killed") && folder.join("mark").exists())
            && (is_killed || output.status.success()),
        "{fault}: {}\n{words}\n{complaint}",
        output.status
    );
    let mut reply = Reply {
        is_killed,
        num_done: 0,
        errors: Vec::new(),
        num_read: None,
    };
    // The first line follows the name of the test.
    for line in words
        .lines()
        .map(|line| line.trim_start_matches("test body ... "))
    {
        if line.starts_with("done ") {
            reply.num_done += 1;
        } else if let Some(error) = line.strip_prefix("error ") {
            reply.errors.push(error.to_owned());
        } else if let Some(advice) = line.strip_prefix("advice ") {
            reply.errors.last_mut().expect("an error").push_str(advice);
        } else if let Some(num) = line.strip_prefix("read ") {
            reply.num_read = num.parse().ok();
        }
    }
    reply
}

/// Checks the history afterwards: the steps in `reply` are done, and nothing else has changed.
fn check(folder: &Path, num_before: usize, fault: &str, reply: &Reply) {
    let mut history = open_history(folder);
    let page = history.page(&Filter::default(), 0, 10).expect("asked");
    let first = history.known(1).expect("the first is there");
    let num_added = page.num_all - num_before;
    let is_remarked = first.summary.remark == "seen";
    // The steps are in order: an inspection, a remark, an inspection.
    let state = match (num_added, is_remarked) {
        (0, false) => 0,
        (1, false) => 1,
        (1, true) => 2,
        (2, true) => 3,
        other => panic!("{fault}: {other:?}"),
    };
    assert!(
        (reply.num_done..=reply.num_done + 1).contains(&state),
        "{fault}: {} done, {state} there",
        reply.num_done
    );
    for row in page
        .rows
        .iter()
        .filter(|row| row.number > num_before as i64)
    {
        let record = history.known(row.number).expect("whole");
        let scene = history.scene(&record).expect("read");
        assert!(scene.is_some(), "{fault}: {}", row.scene);
    }
    add(&mut history, 9).expect("the disk is well again");
}

/// Lets every call fail, one after the other, starting with a history of `num_before` inspections that `prepare`
/// makes. With `is_listed`, they must be readable whatever fails.
fn fails_at_every_call(num_before: usize, is_listed: bool, prepare: impl Fn(&Path)) {
    let tools = tempfile::tempdir().expect("a folder");
    let disk = tools.path().join("libdisk.so");
    if let Err(why) = compile_c("crates/records/tests/history_disk/disk.c", &disk, &SHARED) {
        return skipped("PARTSIGHT_REQUIRE_COMPILER", &why);
    }
    let prepared = tools.path().join("prepared");
    fs::create_dir(&prepared).expect("made");
    prepare(&prepared);
    // At once, because most of the time goes by waiting for the disk and for processes.
    thread::scope(|scope| {
        for kind in ["full", "broken", "once", "killed"] {
            let (prepared, disk) = (&prepared, &disk);
            scope.spawn(move || fails_in_one_way(kind, num_before, is_listed, prepared, disk));
        }
    });
}

/// Does this for one kind of fault.
fn fails_in_one_way(kind: &str, num_before: usize, is_listed: bool, prepared: &Path, disk: &Path) {
    let mut num_errors = 0;
    let mut is_through = false;
    for at in 1..=MOST_CALLS {
        let fault = format!("{kind} {at}");
        let folder = tempfile::tempdir().expect("a folder");
        copy(prepared, folder.path());
        let reply = run(folder.path(), disk, DATABASE, &fault);
        let has_failed = folder.path().join("mark").exists();
        for error in &reply.errors {
            let is_fitting = error.contains("disk") || error.contains("writable");
            assert!(is_fitting && !error.contains("move"), "{fault}: {error}");
        }
        let is_cut_off = reply.is_killed || reply.num_done < STEPS.len();
        assert!(!is_cut_off || has_failed, "{fault}");
        // A step that fails once succeeds when it is tried again.
        assert!(kind != "once" || !is_cut_off, "{fault}: {:?}", reply.errors);
        match reply.num_read {
            Some(num) => assert!(num >= num_before, "{fault}: {num} read"),
            None => assert!(
                reply.is_killed || !is_cut_off || !is_listed,
                "{fault}: {:?}",
                reply.errors
            ),
        }
        check(folder.path(), num_before, &fault, &reply);
        num_errors += reply.errors.len();
        if !has_failed {
            is_through = true;
            assert!(at > 10, "{kind}: only {at} calls");
            break;
        }
    }
    assert!(is_through, "{kind}: no end");
    assert!(
        num_errors > 0 || kind == "killed",
        "{kind}: nothing was said"
    );
}

fn copy(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).expect("listed") {
        let entry = entry.expect("listed");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            fs::create_dir(&target).expect("made");
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).expect("copied");
        }
    }
}

#[test]
fn whichever_call_of_a_frame_fails_its_inspection_is_written_and_says_why_the_frame_is_not_kept() {
    let tools = tempfile::tempdir().expect("a folder");
    let disk = tools.path().join("libdisk.so");
    if let Err(why) = compile_c("crates/records/tests/history_disk/disk.c", &disk, &SHARED) {
        return skipped("PARTSIGHT_REQUIRE_COMPILER", &why);
    }
    for (kind, loss) in [
        ("full", FrameLoss::DiskFull),
        ("broken", FrameLoss::NotWritable),
        ("once", FrameLoss::NotWritable),
    ] {
        for at in 1..=MOST_CALLS {
            let fault = format!("{kind} {at}");
            let folder = tempfile::tempdir().expect("a folder");
            let reply = run(folder.path(), &disk, FRAMES, &fault);
            assert_eq!(reply.errors, [""; 0], "{fault}");
            assert_eq!(reply.num_done, STEPS.len(), "{fault}");
            let history = open_history(folder.path());
            let mut num_lost = 0;
            for number in 1..=2 {
                let record = history.known(number).expect("written");
                let scene = history.scene(&record).expect("read");
                let lost = record.detail.frame_loss;
                assert_ne!(scene.is_some(), lost.is_some(), "{fault}: {number}");
                assert!(lost.is_none_or(|lost| lost == loss), "{fault}: {lost:?}");
                num_lost += usize::from(lost.is_some());
            }
            let has_failed = folder.path().join("mark").exists();
            assert_eq!(num_lost > 0, has_failed, "{fault}");
            // What was written of a lost frame is removed, where the disk lets it be.
            let frames = fs::read_dir(history.frames_folder()).expect("listed");
            let is_picture =
                |file: &fs::DirEntry| file.path().extension().is_some_and(|is| is == "png");
            let num_pictures = frames.flatten().filter(is_picture).count();
            assert!(kind != "once" || num_pictures == 2 - num_lost, "{fault}");
            if !has_failed {
                assert!(at > 4, "{kind}: only {at} calls");
                break;
            }
            assert!(at < MOST_CALLS, "{kind}: no end");
        }
    }
}

#[test]
fn whichever_call_fails_the_history_is_the_old_one_or_the_new() {
    fails_at_every_call(1, true, |folder| {
        add(&mut open_history(folder), 1).expect("written");
    });
}
