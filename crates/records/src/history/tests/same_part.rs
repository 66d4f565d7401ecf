//! Several inspections of one part.

use super::*;

#[test]
fn a_part_counts_once_however_often_it_was_inspected_and_nothing_of_it_is_lost() {
    let (folder, mut history) = new_history();
    let part = history_entry(1, StoredVerdict::Accepted, "grille");
    let other = history_entry(2, StoredVerdict::Rejected, "grille");
    for entry in [
        &part,
        &again(&part, 3, StoredVerdict::Rejected),
        &other,
        &again(&part, 4, StoredVerdict::Accepted),
    ] {
        history.add(entry, &ALL).expect("written");
    }
    let all = Filter::default();
    let page = history.page(&all, 0, 10).expect("asked");
    assert_eq!((page.num_matching, page.num_all), (2, 2));
    let rows: Vec<_> = page
        .rows
        .iter()
        .map(|row| (row.number, row.num_below))
        .collect();
    assert_eq!(rows, [(3, 0), (1, 2)]);
    let accepted = Filter {
        verdict: Some(StoredVerdict::Accepted.into()),
        ..all.clone()
    };
    assert_eq!(numbers(&history, &accepted), [1]);
    let with_below = Filter {
        with_below: true,
        ..all.clone()
    };
    assert_eq!(numbers(&history, &with_below), [4, 2, 3, 1]);
    let below = history.below(1).expect("asked");
    let below: Vec<_> = below
        .iter()
        .map(|r| (r.summary.number, r.summary.verdict))
        .collect();
    assert_eq!(
        below,
        [(2, StoredVerdict::Rejected), (4, StoredVerdict::Accepted)]
    );
    let mut exported = 0;
    let counted = history.each(&all, |_| {
        exported += 1;
        Ok::<(), HistoryError>(())
    });
    counted.expect("listed");
    assert_eq!(exported, 2);
    // Each inspection keeps its own frame.
    assert_eq!(history.usage().expect("asked").num_frames, 4);
    drop(history);
    assert_eq!(
        open_history(folder.path())
            .usage()
            .expect("asked")
            .num_frames,
        4
    );
}

#[test]
fn a_refusal_gives_way_to_an_acceptance_and_an_acceptance_stands() {
    let (_folder, mut history) = new_history();
    let part = history_entry(1, StoredVerdict::Unknown, "grille");
    history.add(&part, &ALL).expect("written");
    history.set_remark(1, "a new grille").expect("written");
    history
        .add(&again(&part, 2, StoredVerdict::Rejected), &ALL)
        .expect("written");
    assert_eq!(numbers(&history, &Filter::default()), [1]);
    history
        .add(&again(&part, 3, StoredVerdict::Accepted), &ALL)
        .expect("written");
    history
        .add(&again(&part, 4, StoredVerdict::Rejected), &ALL)
        .expect("written");
    let page = history.page(&Filter::default(), 0, 10).expect("asked");
    let [row] = page.rows.as_slice() else {
        panic!("{page:?}");
    };
    assert_eq!(
        (row.number, row.num_below, row.verdict),
        (3, 3, StoredVerdict::Accepted)
    );
    // A remark on the part is found with it; the first result is unchanged.
    assert_eq!(row.remark, "a new grille");
    let text = "new".into();
    let found = Filter {
        text,
        ..Filter::default()
    };
    assert_eq!(numbers(&history, &found), [3]);
    history.set_remark(1, "the new grille").expect("written");
    assert_eq!(
        history.known(3).expect("there").summary.remark,
        "the new grille"
    );
    let first = history.known(1).expect("there").summary;
    assert_eq!(
        (first.verdict, first.parent),
        (StoredVerdict::Unknown, Some(3))
    );
}

#[test]
fn a_part_stays_a_part_of_its_source_when_a_repeated_inspection_stands_for_it() {
    let (_folder, mut history) = new_history();
    let waiting = HistoryBuffer::new(None);
    let mut part = history_entry(1, StoredVerdict::Rejected, "grille");
    part.record.summary.source = "kinect".into();
    let mut repeated = again(&part, 2, StoredVerdict::Accepted);
    repeated.record.summary.source = "Kinect frame 12".into();
    for (ticket, entry) in (1..).zip([&part, &repeated]) {
        history.add(entry, &ALL).expect("written");
        waiting.add(ticket, entry.clone(), Instant::now());
    }
    let of_camera = Filter {
        source: Some("kinect".into()),
        ..Filter::default()
    };
    assert_eq!(numbers(&history, &of_camera), [2]);
    let page = waiting.page(&of_camera, 0, 10).expect("asked");
    assert_eq!(page.num_matching, 1);
    assert_eq!(page.rows[0].verdict, StoredVerdict::Accepted);
}

#[test]
fn what_stands_for_its_part_does_so_above_what_was_written_before_unless_that_alone_accepts_it() {
    use StoredVerdict::{Accepted, Rejected};

    let standing = |of: &NewEntry, seconds, verdict| {
        let mut entry = again(of, seconds, verdict);
        entry.stands_for_part = true;
        entry.record.summary.trace.serial = format!("TL-{seconds}");
        entry
    };
    let parts = [(1, Accepted), (3, Accepted), (5, Rejected)];
    let [one, two, three] =
        parts.map(|(seconds, verdict)| history_entry(seconds, verdict, "grille"));
    let entries = [
        one.clone(),
        standing(&one, 2, Accepted),
        two.clone(),
        standing(&two, 4, Rejected),
        three.clone(),
        standing(&three, 6, Rejected),
    ];
    let (_folder, mut history) = new_history();
    // Those that wait in memory are listed in the same way.
    let buffer = HistoryBuffer::default();
    for (ticket, entry) in entries.into_iter().enumerate() {
        history.add(&entry, &ALL).expect("written");
        buffer.add(ticket as u64, entry, std::time::Instant::now());
    }
    let all = Filter::default();
    let written = history.page(&all, 0, 9).expect("asked");
    let waiting = buffer.page(&all, 0, 9).expect("asked");
    for page in [written, waiting] {
        let row = |row: &Summary| {
            (
                row.scene.to_string(),
                row.num_below,
                row.trace.serial.clone(),
            )
        };
        let rows: Vec<_> = page.rows.iter().map(row).collect();
        let expected = [
            ("frame 6", "TL-6"),
            ("frame 3", "TL-4"),
            ("frame 2", "TL-2"),
        ];
        let expected = expected.map(|(scene, serial)| (scene.to_owned(), 1, serial.to_owned()));
        assert_eq!(rows, expected);
    }
    // What is traced later is found with the part.
    let found = Filter {
        text: "tl-4".into(),
        ..all
    };
    assert_eq!(numbers(&history, &found), [3]);
}
