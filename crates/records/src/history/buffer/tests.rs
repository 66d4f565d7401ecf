//! Inspections waiting in memory while the disk cannot be written.

use std::fs;

use super::*;
use crate::{
    fixtures::{history_entry, open_history},
    history::{
        Filter, FrameLoss, KeepFrames, StoredVerdict, Traceability, schema::APPLICATION,
        waiting::MAX_WAITING,
    },
};
use capture::fixtures::moment;
use stages::fixtures::small_scene;

fn numbers(keeper: &HistoryBuffer) -> Vec<i64> {
    let page = keeper.page(&Filter::default(), 0, 10_000).expect("asked");
    assert_eq!(
        (page.num_matching, page.num_all),
        (page.rows.len(), page.rows.len())
    );
    page.rows.iter().map(|row| row.number).collect()
}

fn failures(news: &[HistoryEvent]) -> usize {
    let is_failure = |news: &&HistoryEvent| matches!(news, HistoryEvent::Failed { .. });
    news.iter().filter(is_failure).count()
}

fn not_accepted(seconds: i64) -> NewEntry {
    history_entry(seconds, StoredVerdict::Rejected, "fender")
}

#[test]
fn without_a_folder_everything_is_kept_in_memory_and_nothing_is_wrong() {
    let keeper = HistoryBuffer::new(None);
    let now = Instant::now();
    keeper.open(now);
    for seconds in 1..=6 {
        keeper.add(seconds as u64, not_accepted(seconds), now);
    }
    assert_eq!(numbers(&keeper), [-6, -5, -4, -3, -2, -1]);
    let news = keeper.take_news();
    assert_eq!(news.len(), 6);
    assert_eq!(
        news[2],
        HistoryEvent::Added {
            ticket: 3,
            number: -3
        }
    );
    keeper.set_remark(-2, "a dent");
    let filter = Filter {
        text: "DENT".into(),
        ..Filter::default()
    };
    assert_eq!(
        keeper.page(&filter, 0, 10).expect("asked").rows[0].number,
        -2
    );
    // The scenes of the newest inspections are kept too.
    let scene = |number| {
        keeper
            .lock()
            .waiting_mut(number)
            .expect("waits")
            .scene
            .clone()
    };
    assert_eq!(scene(-6), Some(small_scene(6)));
    assert_eq!(scene(-1), None);
    let loss = |number| {
        let record = keeper.row(number).expect("asked").expect("there");
        record.detail.frame_loss
    };
    assert_eq!([loss(-6), loss(-1)], [None, None], "none was to be written");
    assert!(
        !keeper
            .row(-6)
            .expect("asked")
            .expect("there")
            .detail
            .thumbnail
            .is_empty()
    );
    assert_eq!(keeper.next_try(), None);
}

#[test]
fn an_old_one_that_waits_for_the_disk_says_that_its_frame_is_lost() {
    let home = tempfile::tempdir().expect("a folder");
    let place = home.path().join("taken");
    fs::write(&place, "a file").expect("written");
    let keeper = HistoryBuffer::new(Some(place));
    for seconds in 1..=6 {
        keeper.add(seconds as u64, not_accepted(seconds), Instant::now());
    }
    let loss = |number| {
        let record = keeper.row(number).expect("asked").expect("there");
        record.detail.frame_loss
    };
    assert_eq!([loss(-6), loss(-1)], [None, Some(FrameLoss::NotWritable)]);
}

#[test]
fn a_folder_that_cannot_be_made_is_said_once_and_what_waited_is_written_later() {
    let home = tempfile::tempdir().expect("a folder");
    let place = home.path().join("taken").join("partsight");
    fs::write(home.path().join("taken"), "a file").expect("written");
    let keeper = HistoryBuffer::new(Some(place.clone()));
    let begun = Instant::now();
    keeper.open(begun);
    for seconds in 1..=3 {
        keeper.add(seconds as u64, not_accepted(seconds), begun);
    }
    let later = begun + PAUSE;
    keeper.retry(begun + PAUSE / 2);
    keeper.add(4, not_accepted(4), later);
    let news = keeper.take_news();
    assert_eq!(failures(&news), 1, "{news:?}");
    assert_eq!(numbers(&keeper), [-4, -3, -2, -1]);
    keeper.set_label(-3, Some(&Truth::NotEnrolled));

    fs::remove_file(home.path().join("taken")).expect("removed");
    keeper.retry(later + PAUSE / 2);
    assert_eq!(keeper.take_news().len(), 1, "too early: but for the label");
    keeper.retry(later + PAUSE);
    assert_eq!(
        keeper.take_news(),
        [HistoryEvent::Works {
            numbers: vec![(-1, 1), (-2, 2), (-3, 3), (-4, 4)],
            num_lost: 0,
        }]
    );
    assert_eq!(numbers(&keeper), [4, 3, 2, 1]);
    let third = keeper.row(3).expect("asked").expect("there");
    assert_eq!(third.summary.label, Some(Truth::NotEnrolled));
    assert_eq!(third.summary.at, moment(3));
    drop(keeper);
    assert!(place.join(FILE).exists());
    let history = open_history(&place);
    let fourth = history.known(4).expect("written");
    assert!(history.scene(&fourth).expect("read").is_some());
}

#[test]
fn a_frame_that_cannot_be_written_costs_no_row_and_is_told_once_until_one_can() {
    let folder = tempfile::tempdir().expect("a folder");
    let keeper = HistoryBuffer::new(Some(folder.path().to_owned()));
    let now = Instant::now();
    let frames = folder.path().join("history-frames");
    let add = |seconds: i64| keeper.add(seconds as u64, not_accepted(seconds), now);
    add(1);
    fs::remove_dir_all(&frames).expect("removed");
    fs::write(&frames, "no folder").expect("written");
    add(2);
    add(3);
    let news = || {
        let mut of_frames = Vec::new();
        for news in keeper.take_news() {
            match news {
                HistoryEvent::FramesNotKept { what, advice } => {
                    of_frames.push(Some((what, advice)));
                }
                HistoryEvent::FramesKept => of_frames.push(None),
                HistoryEvent::Added { .. } => {}
                other => panic!("{other:?}"),
            }
        }
        of_frames
    };
    let first = news();
    let [Some((what, advice))] = first.as_slice() else {
        panic!("{first:?}");
    };
    assert!(
        what.contains("frames are no longer kept") && what.contains("history-frames"),
        "{what}"
    );
    assert!(advice.contains("without frames"), "{advice}");
    // The rule keeps none: nothing is lost.
    let none = Retention {
        keep: KeepFrames::None,
        ..Retention::default()
    };
    keeper.set_retention(none);
    add(4);
    keeper.set_retention(Retention::default());
    keeper.take_news();
    fs::remove_file(&frames).expect("removed");
    add(5);
    fs::remove_dir_all(&frames).expect("removed");
    fs::write(&frames, "no folder").expect("written");
    add(6);
    let again = news();
    assert!(matches!(again[..], [None, Some(_)]), "{again:?}");
    assert_eq!(numbers(&keeper), [6, 5, 4, 3, 2, 1]);
    assert_eq!((keeper.num_waiting(), keeper.next_try()), (0, None));
    let loss = |number| {
        let record = keeper.row(number).expect("asked").expect("written");
        let detail = record.detail;
        assert!(detail.frame.is_none() || detail.frame_loss.is_none());
        detail.frame_loss
    };
    let lost = Some(FrameLoss::NotWritable);
    assert_eq!(
        [1, 2, 3, 4, 5, 6].map(loss),
        [None, lost, lost, None, None, lost]
    );
}

#[test]
fn more_than_can_wait_are_counted() {
    let home = tempfile::tempdir().expect("a folder");
    fs::write(home.path().join("taken"), "a file").expect("written");
    let keeper = HistoryBuffer::new(Some(home.path().join("taken")));
    let begun = Instant::now();
    for ticket in 0..MAX_WAITING as u64 + 5 {
        let mut entry = not_accepted(ticket as i64);
        (entry.scene, entry.picture) = (None, None);
        keeper.add(ticket, entry, begun);
    }
    assert_eq!(keeper.num_lost(), 5);
    fs::remove_file(home.path().join("taken")).expect("removed");
    keeper.retry(begun + PAUSE);
    assert_eq!(keeper.num_lost(), 0);
    let news = keeper.take_news();
    let Some(HistoryEvent::Works { numbers, num_lost }) = news.last() else {
        panic!("{:?}", news.last());
    };
    assert_eq!((numbers.len(), *num_lost), (MAX_WAITING, 5));
}

#[test]
fn a_newer_history_is_left_alone_and_inspections_wait() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(FILE);
    let file = rusqlite::Connection::open(&path).expect("made");
    file.pragma_update(None, "user_version", 99).expect("set");
    file.pragma_update(None, "application_id", APPLICATION)
        .expect("set");
    drop(file);
    let bytes = fs::read(&path).expect("there");
    let keeper = HistoryBuffer::new(Some(folder.path().to_owned()));
    keeper.open(Instant::now());
    keeper.add(1, not_accepted(1), Instant::now());
    let news = keeper.take_news();
    assert!(
        matches!(&news[0], HistoryEvent::Failed { what, advice } if what.contains("newer version") && advice.contains("Update")),
        "{news:?}"
    );
    assert_eq!(numbers(&keeper), [-1]);
    assert_eq!(fs::read(&path).expect("there"), bytes);
}

#[test]
fn a_file_that_breaks_while_it_is_open_is_set_aside_and_writing_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let keeper = HistoryBuffer::new(Some(folder.path().to_owned()));
    let now = Instant::now();
    for seconds in 1..=5 {
        keeper.add(seconds as u64, not_accepted(seconds), now);
    }
    assert_eq!(numbers(&keeper), [5, 4, 3, 2, 1]);
    keeper.take_news();
    // Pages of the tables in the file, in the log and in memory.
    let inner = keeper.lock();
    let file = &inner.history.as_ref().expect("open").file;
    file.execute_batch("PRAGMA shrink_memory")
        .expect("let go of");
    drop(inner);
    for name in [FILE.to_owned(), format!("{FILE}-wal")] {
        let path = folder.path().join(name);
        let length = fs::metadata(&path).expect("there").len();
        fs::write(&path, vec![0x77; length as usize]).expect("written");
    }
    keeper.add(6, not_accepted(6), now);
    keeper.add(7, not_accepted(7), now);
    let news = keeper.take_news();
    let is_aside = |news: &HistoryEvent| matches!(news, HistoryEvent::SetAside(_));
    assert!(news.iter().any(is_aside), "{news:?}");
    assert_eq!(failures(&news), 0, "{news:?}");
    assert_eq!(numbers(&keeper), [2, 1]);
}

#[test]
fn a_label_goes_to_the_row_that_stands_for_the_part_whether_it_waits_or_is_written() {
    let home = tempfile::tempdir().expect("a folder");
    let place = home.path().join("taken");
    fs::write(&place, "a file").expect("written");
    let keeper = HistoryBuffer::new(Some(place.clone()));
    let begun = Instant::now();
    let refused = not_accepted(1);
    let hung = refused.record.summary.hung.clone();
    let mut accepted = history_entry(2, StoredVerdict::Accepted, "fender");
    accepted.record.summary.hung = hung.clone();
    for (ticket, entry) in (1..).zip([refused, accepted, not_accepted(3)]) {
        keeper.add(ticket, entry, begun);
    }
    let label = |label: &Truth, remark: &str| {
        let row = keeper.label_part(&hung, label, remark).expect("labelled");
        let row = row.expect("a row");
        assert_eq!(keeper.part(&hung).expect("asked"), Some(row.clone()));
        (row.number, row.label, row.remark)
    };
    let fender = Truth::Part("fender".into());
    let bent = || "bent".to_owned();
    assert_eq!(label(&fender, " bent "), (-2, Some(fender.clone()), bent()));

    fs::remove_file(&place).expect("removed");
    keeper.retry(begun + PAUSE);
    let row = |number| keeper.row(number).expect("asked").expect("there").summary;
    assert_eq!((row(2).label, row(2).remark), (Some(fender), bent()));
    let other = Truth::NotEnrolled;
    // An existing remark is kept.
    assert_eq!(label(&other, "painted"), (2, Some(other), bent()));
    assert_eq!((row(1).label, row(3).label), (None, None));
    let unknown = |keeper: &HistoryBuffer| keeper.label_part(&HungId::new(), &Truth::Nothing, "");
    let refused = unknown(&keeper).expect_err("no such part");
    assert!(refused.to_string().contains("no inspection of this part"));
    keeper.take_news();
    for part in [&hung, &HungId::new()] {
        keeper.set_part_label(part, None);
    }
    assert_eq!((row(2).label, row(2).remark), (None, bent()));
    let news = keeper.take_news();
    assert!(
        matches!(
            &news[..],
            [HistoryEvent::Changed { number: 2 }, HistoryEvent::NotChanged { what, .. }]
                if what.contains("no inspection of this part")
        ),
        "{news:?}"
    );
    let in_memory = HistoryBuffer::default();
    assert_eq!(unknown(&in_memory).expect("asked"), None);
}

#[test]
fn a_serial_number_that_comes_later_waits_with_its_part_until_it_can_be_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let keeper = HistoryBuffer::new(Some(folder.path().to_owned()));
    let begun = Instant::now();
    let entries = [1, 2].map(not_accepted);
    let [written, waiting] = entries
        .each_ref()
        .map(|entry| entry.record.summary.hung.clone());
    let [first, second] = entries;
    keeper.add(1, first, begun);
    // A lock by another program, for which writing does not wait.
    let inner = keeper.lock();
    let file = &inner.history.as_ref().expect("open").file;
    file.busy_timeout(Duration::ZERO).expect("set");
    drop(inner);
    let other = rusqlite::Connection::open(folder.path().join(FILE)).expect("opened");
    other.execute_batch("BEGIN IMMEDIATE").expect("locked");
    let known = |serial: &str| {
        TraceChange::Fill(Traceability {
            serial: serial.into(),
            ..Traceability::default()
        })
    };
    keeper.trace_part(&written, &known("TL-1"), begun);
    keeper.add(2, second, begun);
    for change in [
        known("TL-3"),
        TraceChange::ClearSerial("TL-3".into()),
        known("TL-2"),
    ] {
        keeper.trace_part(&waiting, &change, begun);
    }
    assert_eq!(failures(&keeper.take_news()), 1);
    let serial = |number| {
        let record = keeper.row(number).expect("asked").expect("there");
        record.summary.trace.serial
    };
    assert_eq!([1, -2].map(serial), ["", "TL-2"]);

    other.execute_batch("ROLLBACK").expect("unlocked");
    keeper.retry(begun + PAUSE);
    assert_eq!([1, 2].map(serial), ["TL-1", "TL-2"]);
    assert_eq!(numbers(&keeper), [2, 1]);
    assert_eq!(keeper.next_try(), None);
}

/// Returns the reports that the file was replaced.
#[cfg(unix)]
fn replacements(news: &[HistoryEvent]) -> usize {
    let is_replaced = |news: &&HistoryEvent| matches!(news, HistoryEvent::NotChanged { what, .. } if what.contains("moved, deleted or replaced"));
    news.iter().filter(is_replaced).count()
}

#[cfg(unix)]
#[test]
fn after_a_history_was_deleted_inspections_go_to_a_new_one_and_it_is_told_once() {
    let home = tempfile::tempdir().expect("a folder");
    let place = home.path().join("history");
    let keeper = HistoryBuffer::new(Some(place.clone()));
    let now = Instant::now();
    let entries = [1, 2, 3].map(not_accepted);
    let part = entries[0].record.summary.hung.clone();
    for (ticket, entry) in (1..).zip(entries) {
        keeper.add(ticket, entry, now);
    }
    keeper.take_news();
    fs::remove_dir_all(&place).expect("removed");
    // Neither a number nor a part of the former file is one of the new.
    keeper.set_remark(1, "a dent");
    let labelled = keeper.label_part(&part, &Truth::Nothing, "");
    assert!(matches!(labelled, Err(HistoryError::NoSuchPart { .. })));
    for seconds in 4..=5 {
        keeper.add(seconds as u64, not_accepted(seconds), now);
    }
    let news = keeper.take_news();
    assert_eq!((replacements(&news), failures(&news)), (1, 0), "{news:?}");
    let refused = |news: &HistoryEvent| matches!(news, HistoryEvent::NotChanged { what, .. } if what.contains("no inspection 1"));
    assert!(news.iter().any(refused), "{news:?}");
    assert_eq!(numbers(&keeper), [2, 1]);
    drop(keeper);
    let history = open_history(&place);
    let first = history.known(1).expect("written").summary;
    assert_eq!((first.at, first.remark), (moment(4), String::new()));

    // A file in the place of the folder: they wait until it is gone.
    let keeper = HistoryBuffer::new(Some(place.clone()));
    keeper.open(now);
    drop(history);
    fs::remove_dir_all(&place).expect("removed");
    fs::write(&place, "a file").expect("written");
    keeper.add(6, not_accepted(6), now);
    let news = keeper.take_news();
    assert_eq!((replacements(&news), failures(&news)), (1, 1), "{news:?}");
    fs::remove_file(&place).expect("removed");
    keeper.retry_now();
    assert_eq!(replacements(&keeper.take_news()), 0);
    assert_eq!(numbers(&keeper), [1]);
}

#[cfg(unix)]
#[test]
fn a_history_that_was_moved_away_keeps_its_rows_and_frames_and_a_new_one_gets_the_next() {
    let home = tempfile::tempdir().expect("a folder");
    let keeper = HistoryBuffer::new(Some(home.path().to_owned()));
    let now = Instant::now();
    keeper.add(1, not_accepted(1), now);
    keeper.take_news();
    let archive = home.path().join("archive");
    fs::create_dir(&archive).expect("made");
    // Without its log and its frames, as in a file manager.
    fs::rename(home.path().join(FILE), archive.join(FILE)).expect("moved");
    keeper.add(2, not_accepted(2), now);
    let news = keeper.take_news();
    assert_eq!(replacements(&news), 1, "{news:?}");
    let aside = news.iter().find_map(|news| match news {
        HistoryEvent::SetAside(aside) => Some(&aside.aside),
        _ => None,
    });
    fs::rename(aside.expect("set aside"), archive.join("history-frames")).expect("moved");
    assert_eq!(numbers(&keeper), [1]);
    let history = open_history(&archive);
    let first = history.known(1).expect("kept");
    assert_eq!(first.summary.at, moment(1));
    assert!(history.scene(&first).expect("read").is_some());
    drop(history);

    // Another history takes its place.
    let other = tempfile::tempdir().expect("a folder");
    drop(open_history(other.path()));
    fs::rename(other.path().join(FILE), home.path().join(FILE)).expect("moved");
    keeper.add(3, not_accepted(3), now);
    assert_eq!(replacements(&keeper.take_news()), 1);
    let row = keeper.row(1).expect("asked").expect("written");
    assert_eq!(row.summary.at, moment(3));
    assert_eq!(numbers(&keeper), [1]);
}

#[cfg(unix)]
#[test]
fn two_programs_whose_history_was_moved_away_go_on_in_one_new_file() {
    let home = tempfile::tempdir().expect("a folder");
    let keepers = [(); 2].map(|()| HistoryBuffer::new(Some(home.path().to_owned())));
    let [one, other] = &keepers;
    let now = Instant::now();
    one.add(1, not_accepted(1), now);
    other.add(2, not_accepted(2), now);
    let archive = home.path().join("archive");
    fs::create_dir(&archive).expect("made");
    // Without its log.
    fs::rename(home.path().join(FILE), archive.join(FILE)).expect("moved");
    one.add(3, not_accepted(3), now);
    one.add(4, not_accepted(4), now);
    other.add(5, not_accepted(5), now);
    one.add(6, not_accepted(6), now);
    drop(keepers);
    for (folder, seconds) in [
        (archive.as_path(), &[1, 2][..]),
        (home.path(), &[3, 4, 5, 6]),
    ] {
        let history = open_history(folder);
        for (number, seconds) in (1..).zip(seconds) {
            let row = history.known(number).expect("kept").summary;
            assert_eq!(row.at, moment(*seconds), "{number} of {}", folder.display());
        }
    }
}
