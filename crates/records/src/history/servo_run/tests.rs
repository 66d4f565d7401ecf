use std::time::Instant;

use super::*;
use crate::{
    fixtures::{history_entry, new_history, open_history, servo_record},
    history::{HistoryBuffer, Retention},
};
use capture::fixtures::moment;
use files::fixtures::csv_column;

/// A folder with an inspection and two runs.
fn written() -> (tempfile::TempDir, History) {
    let (folder, mut history) = new_history();
    let entry = history_entry(0, StoredVerdict::Accepted, "fender");
    history.add(&entry, &Retention::default()).expect("written");
    let moved = StopReason::Moved {
        shift_m: 0.05,
        turn_rad: 0.1,
    };
    for record in [
        servo_record(1, "fender", None),
        servo_record(2, "front_door", Some(moved)),
    ] {
        history.add_servo_run(&record).expect("written");
    }
    (folder, history)
}

fn numbers(history: &History, filter: &Filter) -> Vec<i64> {
    let page = history.servo_runs(filter, 0, 100).expect("read");
    assert_eq!((page.num_matching, page.num_all), (page.rows.len(), 2));
    page.rows.iter().map(|run| run.number).collect()
}

#[test]
fn a_run_comes_back_whole_with_its_curve_and_counts_as_no_inspection() {
    let (folder, history) = written();
    drop(history);
    let history = open_history(folder.path());
    let mut expected = servo_record(
        2,
        "front_door",
        Some(StopReason::Moved {
            shift_m: 0.05,
            turn_rad: 0.1,
        }),
    );
    expected.run.number = 2;
    assert_eq!(history.servo_run(2).expect("read"), expected);
    assert_eq!(
        expected.curve.last().expect("samples").held.as_deref(),
        Some("moved")
    );
    assert!(matches!(
        history.servo_run(3),
        Err(HistoryError::NoSuchServoRun { number: 3 })
    ));
    let everything = Filter {
        with_below: true,
        ..Filter::default()
    };
    let page = history.page(&everything, 0, 100).expect("read");
    assert_eq!(
        (page.num_all, page.num_matching, page.rows.len()),
        (1, 1, 1)
    );
    assert_eq!(history.outcomes(&everything).expect("read").len(), 1);
    assert_eq!(history.poses(&everything, 9).expect("read").len(), 1);
}

#[test]
fn runs_are_filtered_by_what_they_have_in_common_with_inspections() {
    let (_folder, history) = written();
    let any = Filter::default;
    let verdict = |verdict| Filter {
        verdict: Some(verdict),
        ..any()
    };
    let text = |text: &str| Filter {
        text: text.into(),
        ..any()
    };
    for (filter, expected) in [
        (any(), &[2, 1][..]),
        (
            Filter {
                part: Some("fender".into()),
                ..any()
            },
            &[1],
        ),
        (
            Filter {
                since: Some(moment(2)),
                ..any()
            },
            &[2],
        ),
        (
            Filter {
                is_simulated: Some(false),
                ..any()
            },
            &[],
        ),
        (verdict(StoredVerdict::Accepted.into()), &[1]),
        (verdict(VerdictFilter::NotAccepted), &[2]),
        (verdict(StoredVerdict::NoPart.into()), &[]),
        (text("front DOOR moved"), &[2]),
        (text("egm"), &[2, 1]),
    ] {
        assert_eq!(numbers(&history, &filter), expected, "{filter:?}");
        let mut passing = Vec::new();
        for number in [2, 1] {
            let run = history.servo_run(number).expect("read").run;
            passing.extend(filter.passes_servo(&run).then_some(number));
        }
        assert_eq!(passing, expected, "{filter:?}");
    }
}

#[test]
fn a_stored_end_that_cannot_be_read_is_an_error_and_no_arrival() {
    let (_folder, history) = written();
    history
        .file
        .execute("UPDATE servo_run SET stopped = '{}' WHERE number = 2", [])
        .expect("written");
    assert!(history.servo_run(2).is_err());
    assert!(history.servo_runs(&Filter::default(), 0, 10).is_err());
    assert_eq!(history.servo_run(1).expect("read").run.stopped, None);
}

#[test]
fn runs_wait_in_memory_while_the_disk_cannot_be_written() {
    let home = tempfile::tempdir().expect("a folder");
    let place = home.path().join("taken");
    std::fs::write(&place, "a file").expect("written");
    let keeper = HistoryBuffer::new(Some(place.clone()));
    for seconds in 1..=2 {
        let record = servo_record(seconds, "fender", None);
        keeper.add_servo_run(record, Instant::now());
    }
    let numbers = || {
        let page = keeper.servo_runs(&Filter::default(), 0, 10).expect("read");
        assert_eq!((page.num_matching, page.num_all), (2, 2));
        page.rows.iter().map(|run| run.number).collect::<Vec<_>>()
    };
    assert_eq!(numbers(), [-2, -1]);
    assert_eq!(keeper.servo_run(-1).expect("kept").run.at, moment(1));
    assert_eq!(keeper.num_servo_runs_waiting(), 2);
    std::fs::remove_file(&place).expect("removed");
    keeper.retry_now();
    assert_eq!(numbers(), [2, 1]);
    assert_eq!(keeper.num_servo_runs_waiting(), 0);
    assert_eq!(keeper.servo_run(1).expect("read").run.at, moment(1));
}

#[test]
fn a_table_has_a_line_for_each_run() {
    let (folder, history) = written();
    let page = history.servo_runs(&Filter::default(), 0, 10).expect("read");
    let path = folder.path().join("runs.csv");
    let num = write_servo_table(&path, page.rows.iter().rev()).expect("written");
    assert_eq!(num, 2);
    let table = std::fs::read_to_string(&path).expect("read");
    assert_eq!(csv_column(&table, "number"), ["1", "2"]);
    assert_eq!(csv_column(&table, "arrived"), ["true", "false"]);
    assert_eq!(csv_column(&table, "stopped"), ["", "moved"]);
    assert_eq!(csv_column(&table, "bounds_m"), ["0.002100", ""]);
    assert!(
        csv_column(&table, "reason")[1].contains("moved by 50 mm"),
        "{table}"
    );
}
