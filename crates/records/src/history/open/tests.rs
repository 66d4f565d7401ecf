//! Opening files that are damaged, foreign or of another version.

use std::{
    fs::File,
    io::{Seek as _, SeekFrom, Write as _},
};

use super::*;
use crate::{
    fixtures::{history_entry, new_history, open_history},
    history::{Filter, KeepFrames, Retention, StoredVerdict},
};
use geometry::error::Advice as _;

/// Creates a closed history with `num` inspections.
fn closed(num: i64) -> tempfile::TempDir {
    let (folder, mut history) = new_history();
    let retention = Retention {
        keep: KeepFrames::All,
        ..Retention::default()
    };
    for seconds in 0..num {
        let entry = history_entry(seconds, StoredVerdict::Accepted, "fender");
        history.add(&entry, &retention).expect("written");
    }
    drop(history);
    folder
}

fn num_rows(history: &History) -> usize {
    let page = history.page(&Filter::default(), 0, 1).expect("asked");
    page.num_all
}

fn damage(path: &Path, at: u64, bytes: &[u8]) {
    let mut file = File::options().write(true).open(path).expect("there");
    file.seek(SeekFrom::Start(at)).expect("there");
    file.write_all(bytes).expect("written");
}

#[test]
fn a_damaged_file_is_set_aside_with_its_frames_and_a_new_one_begun() {
    type Damage = fn(&Path);
    let kinds: [Damage; 4] = [
        |path| fs::write(path, "this is no database at all, but some other text").expect("written"),
        |path| {
            let length = fs::metadata(path).expect("there").len();
            let file = File::options().write(true).open(path).expect("there");
            file.set_len(length / 2).expect("cut");
        },
        |path| damage(path, 4096, &[0x5a; 4096]),
        |path| damage(path, 0, &[0; 100]),
    ];
    for (number, kind) in kinds.into_iter().enumerate() {
        let folder = closed(40);
        let path = folder.path().join(FILE);
        kind(&path);
        let bytes = fs::read(&path).expect("there");
        let opened = History::open(folder.path()).expect("a new one");
        let set_aside = opened.set_aside.expect("said");
        assert!(!set_aside.what.is_empty());
        assert_eq!(num_rows(&opened.history), 0, "damage {number}");
        assert_eq!(fs::read(&set_aside.aside).expect("kept"), bytes);
        let frames = with_ending(&set_aside.aside, "-frames");
        assert_eq!(fs::read_dir(frames).expect("kept").count(), 41);
        drop(opened.history);
        // Reported only once, since the new file is intact.
        assert_eq!(num_rows(&open_history(folder.path())), 0);
    }
}

#[test]
fn another_programs_database_is_refused_and_nothing_of_it_or_beside_it_changes() {
    for (application, version) in [(0, 0), (0, 1), (77, 0), (77, VERSION), (77, VERSION + 4)] {
        for journal in ["DELETE", "WAL"] {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join(FILE);
            let file = Connection::open(&path).expect("made");
            let mode: String = file
                .pragma_update_and_check(None, "journal_mode", journal, |row| row.get(0))
                .expect("set");
            assert_eq!(mode, journal.to_lowercase());
            file.execute_batch("CREATE TABLE recipe (name TEXT)")
                .expect("made");
            for (name, value) in [("application_id", application), ("user_version", version)] {
                file.pragma_update(None, name, value).expect("set");
            }
            drop(file);
            let bytes = fs::read(&path).expect("there");
            for open in [History::open, History::open_to_read] {
                let refused = open(folder.path()).expect_err("refused");
                assert!(matches!(refused, HistoryError::Foreign { .. }), "{refused}");
                assert!(refused.to_string().contains("another program"));
                assert!(refused.advice().contains("--history"));
            }
            assert_eq!(fs::read(&path).expect("kept"), bytes);
            assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
        }
    }
}

#[test]
fn another_programs_database_that_lies_in_its_log_is_left_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(FILE);
    let other = Connection::open(&path).expect("made");
    other
        .pragma_update_and_check(None, "journal_mode", "WAL", |_| Ok(()))
        .expect("set");
    other
        .execute_batch("CREATE TABLE recipe (name TEXT)")
        .expect("made");
    let log = with_ending(&path, "-wal");
    let read = || [&path, &log].map(|path| fs::read(path).expect("there"));
    let before = read();
    let refused = History::open(folder.path()).expect_err("refused");
    assert!(matches!(refused, HistoryError::Foreign { .. }), "{refused}");
    assert_eq!(read(), before);
}

#[test]
fn a_history_that_lacks_a_table_or_an_index_is_set_aside() {
    for lost in [
        "TABLE recipe",
        "TABLE setting",
        "TABLE detail",
        "TABLE inspection",
        "INDEX listed",
    ] {
        let folder = closed(3);
        let path = folder.path().join(FILE);
        let file = Connection::open(&path).expect("there");
        file.pragma_update(None, "foreign_keys", false)
            .expect("set");
        file.execute_batch(&format!("DROP {lost}"))
            .expect("dropped");
        drop(file);
        let opened = History::open_to_read(folder.path()).expect("a new one");
        let set_aside = opened.set_aside.expect("said");
        let [_, name] = lost.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{lost}");
        };
        assert!(set_aside.what.contains(name), "{}", set_aside.what);
        assert!(set_aside.aside.is_file());
        assert_eq!(num_rows(&opened.history), 0);
    }
}

#[test]
fn a_file_of_a_development_build_is_set_aside_with_its_frames() {
    let folder = closed(3);
    let path = folder.path().join(FILE);
    let file = Connection::open(&path).expect("there");
    file.pragma_update(None, "user_version", VERSION - 1)
        .expect("set");
    drop(file);
    let bytes = fs::read(&path).expect("there");
    let opened = History::open_to_read(folder.path()).expect("a new one");
    let set_aside = opened.set_aside.expect("reported");
    assert!(
        set_aside.what.contains("development build"),
        "{}",
        set_aside.what
    );
    assert_eq!(fs::read(&set_aside.aside).expect("kept"), bytes);
    let frames = with_ending(&set_aside.aside, FRAMES_ENDING);
    assert_eq!(fs::read_dir(frames).expect("kept").count(), 4);
    assert_eq!(num_rows(&opened.history), 0);
}

#[test]
fn a_newer_file_is_refused_in_words_and_left_as_it_is() {
    let folder = closed(3);
    let path = folder.path().join(FILE);
    let file = Connection::open(&path).expect("there");
    file.pragma_update(None, "user_version", VERSION + 4)
        .expect("set");
    drop(file);
    let bytes = fs::read(&path).expect("there");
    let frames = fs::read_dir(folder.path().join(FRAMES))
        .expect("there")
        .count();
    for _ in 0..2 {
        let refused = History::open(folder.path()).expect_err("refused");
        let HistoryError::Newer { found, known, .. } = refused else {
            panic!("{refused}");
        };
        assert_eq!((found, known), (VERSION + 4, VERSION));
    }
    assert_eq!(fs::read(&path).expect("there"), bytes);
    assert!(!with_ending(&path, "-wal").exists());
    assert_eq!(
        fs::read_dir(folder.path().join(FRAMES))
            .expect("there")
            .count(),
        frames
    );
}

#[test]
fn a_newer_file_whose_version_is_still_in_its_log_is_left_as_it_is_too() {
    let folder = closed(3);
    let path = folder.path().join(FILE);
    let other = Connection::open(&path).expect("there");
    other
        .pragma_update(None, "user_version", VERSION + 1)
        .expect("set");
    // The file is still open, so its log is not written back.
    let (bytes, log) = (
        fs::read(&path).expect("there"),
        fs::read(with_ending(&path, "-wal")).expect("there"),
    );
    assert!(!log.is_empty());
    let refused = History::open(folder.path()).expect_err("refused");
    assert!(matches!(refused, HistoryError::Newer { .. }), "{refused}");
    assert_eq!(fs::read(&path).expect("there"), bytes);
    assert_eq!(fs::read(with_ending(&path, "-wal")).expect("there"), log);
}

#[test]
fn a_damaged_log_is_set_aside_alone() {
    let folder = closed(3);
    let path = folder.path().join(FILE);
    let log = with_ending(&path, "-wal");
    fs::write(&log, [0x33; 5000]).expect("written");
    let opened = History::open(folder.path()).expect("opened");
    let set_aside = opened.set_aside.expect("said");
    assert!(
        set_aside.what.contains("newest inspections"),
        "{}",
        set_aside.what
    );
    assert_eq!(fs::read(set_aside.aside).expect("kept"), [0x33; 5000]);
    assert_eq!(num_rows(&opened.history), 3);
}

#[test]
fn two_write_at_once_and_nothing_is_lost() {
    let folder = closed(0);
    let write = |part: &str| {
        let mut history = open_history(folder.path());
        for seconds in 0..50 {
            let entry = history_entry(seconds, StoredVerdict::NoPart, part);
            history.add(&entry, &Retention::default()).expect("written");
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| write("fender"));
        scope.spawn(|| write("grille"));
    });
    let history = open_history(folder.path());
    assert_eq!(num_rows(&history), 100);
    assert_eq!(history.usage().expect("asked").num_frames, 100);
}

#[test]
fn looking_makes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = History::open_to_read(folder.path()).expect_err("not there");
    assert!(
        matches!(missing, HistoryError::NotFound { .. }),
        "{missing}"
    );
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 0);
}

#[cfg(unix)]
#[test]
fn a_pipe_or_a_device_in_place_of_the_file_or_of_one_beside_it_is_refused_at_once() {
    for ending in ["", "-wal", "-shm", "-journal"] {
        for is_pipe in [true, false] {
            let folder = closed(1);
            let path = with_ending(&folder.path().join(FILE), ending);
            let _ = fs::remove_file(&path);
            if is_pipe {
                let made = std::process::Command::new("mkfifo").arg(&path).status();
                assert!(made.is_ok_and(|made| made.success()), "mkfifo");
            } else {
                std::os::unix::fs::symlink("/dev/zero", &path).expect("made");
            }
            let before = fs::read_dir(folder.path()).expect("listed").count();
            for open in [History::open, History::open_to_read] {
                let refused = open(folder.path()).expect_err("refused");
                let text = refused.to_string();
                assert!(text.starts_with(&*path.to_string_lossy()), "{text}");
                assert!(text.contains("not a regular file"), "{text}");
                assert!(refused.advice().contains("Move"), "{}", refused.advice());
            }
            assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), before);
        }
    }
}
