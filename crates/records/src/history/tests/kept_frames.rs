//! Which frames are kept.

use super::*;

#[test]
fn frames_go_by_rule_age_and_size_and_marked_ones_stay() {
    let (folder, mut history) = new_history();
    let day = 24 * 3600;
    let keep = |keep| Retention { keep, ..ALL };
    let mut add = |days: i64, verdict, keep| {
        let entry = history_entry(days * day, verdict, "grille");
        let number = history.add(&entry, &keep).expect("written");
        let frame = history.known(number).expect("there").summary.frame_bytes;
        (number, frame)
    };
    assert!(
        add(0, StoredVerdict::NoPart, keep(KeepFrames::None))
            .1
            .is_none()
    );
    let (old, _) = add(1, StoredVerdict::Unknown, keep(KeepFrames::NotAccepted));
    let (marked, _) = add(2, StoredVerdict::Rejected, ALL);
    for days in (5..40).step_by(3) {
        add(days, StoredVerdict::NoPart, keep(KeepFrames::None));
    }
    let (next, bytes) = add(40, StoredVerdict::Accepted, ALL);
    let (newest, _) = add(41, StoredVerdict::Accepted, ALL);
    history.set_remark(marked, "asked about").expect("written");
    let is_kept = |history: &History, number| {
        history
            .known(number)
            .expect("there")
            .summary
            .frame_bytes
            .is_some()
    };

    let swept = history.sweep(&ALL, moment(41 * day)).expect("swept");
    assert_eq!(swept.num_frames, 1);
    assert!(!is_kept(&history, old) && is_kept(&history, marked) && is_kept(&history, next));

    let bytes = bytes.expect("kept");
    let usage = history.usage().expect("asked");
    assert_eq!(usage.num_frames, 3);
    assert!(usage.num_bytes_marked > 0 && usage.num_bytes_marked < usage.num_bytes);
    // Limits below 0.1 GB are clamped, so pretend 60 MB per frame: the limit then fits the marked one and one more.
    history
        .file
        .execute(
            "UPDATE inspection SET frame_bytes = 60000000 WHERE frame_bytes IS NOT NULL",
            [],
        )
        .expect("changed");
    let tight = Retention {
        max_gigabytes: 0.13,
        ..ALL
    };
    history.sweep(&tight, moment(41 * day)).expect("swept");
    assert!(!is_kept(&history, next) && is_kept(&history, newest) && is_kept(&history, marked));
    let files = std::fs::read_dir(folder.path().join("history-frames")).expect("listed");
    // The two frames and their camera.
    assert_eq!(files.count(), 3, "{bytes}");
}

#[test]
fn a_clock_that_is_wrong_removes_no_frames_and_the_age_goes_on_when_it_is_right() {
    let day = 24 * 3600;
    let (_folder, mut history) = new_history();
    let add = |history: &mut History, days: i64, keep| {
        let entry = history_entry(days * day, StoredVerdict::NoPart, "grille");
        let retention = Retention { keep, ..ALL };
        history.add(&entry, &retention).expect("written");
    };
    let swept = |history: &mut History, days: i64| {
        let swept = history.sweep(&ALL, moment(days * day)).expect("swept");
        swept.num_frames
    };
    for days in 1..=20 {
        add(&mut history, days, KeepFrames::All);
    }
    // Ten years ahead, before its first inspection.
    assert_eq!(swept(&mut history, 3650), 0);
    // A clock without a battery: the inspection seems years old.
    add(&mut history, -2000, KeepFrames::All);
    assert_eq!(swept(&mut history, 21), 0);
    for days in [3670, 3671] {
        add(&mut history, days, KeepFrames::All);
        assert_eq!(swept(&mut history, days), 0);
    }
    add(&mut history, 22, KeepFrames::All);
    assert_eq!(swept(&mut history, 22), 0);
    for days in 23..=50 {
        add(&mut history, days, KeepFrames::None);
    }
    // The wrong clock made them older by at most a few days.
    assert_eq!(swept(&mut history, 50), 21);

    // The clock is wrong at every start of the computer until it has asked the network.
    let (_folder, mut history) = new_history();
    for days in 1..=20 {
        add(&mut history, -2000, KeepFrames::All);
        add(&mut history, days, KeepFrames::All);
    }
    assert_eq!(swept(&mut history, 21), 0);
    for days in 21..=40 {
        add(&mut history, days, KeepFrames::None);
    }
    // A tenth early at most: what is 27 days old stays.
    assert_eq!(swept(&mut history, 40), 23);
}

#[test]
fn the_newest_accepted_parts_keep_their_frames_until_they_are_labelled() {
    let (_folder, mut history) = new_history();
    let rule = Retention {
        keep: KeepFrames::NotAccepted,
        ..ALL
    };
    let num = ACCEPTED_KEPT as i64 + 3;
    for seconds in 0..num {
        let entry = history_entry(seconds, StoredVerdict::Accepted, "grille");
        history.add(&entry, &rule).expect("written");
    }
    let refused = history_entry(0, StoredVerdict::Rejected, "grille");
    let refused = history.add(&refused, &rule).expect("written");
    // Another program keeps all frames; this one does not know.
    let all = history_entry(0, StoredVerdict::Accepted, "grille");
    let all = history.add(&all, &ALL).expect("written");
    // What was wrongly accepted is said two parts later.
    let truth = Truth::Part("fender".into());
    history.set_label(1, Some(&truth)).expect("labelled");
    let swept = history.sweep(&rule, moment(num)).expect("swept");
    assert_eq!(swept.num_frames, 2);
    let has_frame = |history: &History, number| {
        let summary = history.known(number).expect("there").summary;
        summary.frame_bytes.is_some()
    };
    let kept = [1, 2, 3, 4, num, refused, all].map(|number| has_frame(&history, number));
    assert_eq!(kept, [true, false, false, true, true, true, true]);
    // Where space is short they go first, although others are older.
    let least = Retention {
        max_gigabytes: 0.1,
        ..rule
    };
    let bytes = 110_000_000 - history.usage().expect("read").num_bytes as i64;
    history
        .file
        .execute(
            "UPDATE inspection SET frame_bytes = ? WHERE number = ?",
            [bytes, num],
        )
        .expect("grown");
    history.sweep(&least, moment(num)).expect("swept");
    assert!(!has_frame(&history, num) && has_frame(&history, all));
    assert!(has_frame(&history, refused));
}

#[test]
fn frames_without_a_row_go_and_rows_without_a_frame_say_so() {
    let (folder, mut history) = new_history();
    let number = history
        .add(&history_entry(1, StoredVerdict::NoPart, "grille"), &ALL)
        .expect("written");
    let other = history
        .add(&history_entry(2, StoredVerdict::NoPart, "grille"), &ALL)
        .expect("written");
    let frame = history
        .known(number)
        .expect("there")
        .detail
        .frame
        .expect("kept");
    let frames = history.frames_folder().to_owned();
    std::fs::remove_file(frames.join(&frame.file)).expect("removed");
    let stray = frames.join("20260301T060000000-1-999.png");
    std::fs::write(&stray, "half a frame").expect("written");
    // While another program has it open nothing is a stray, since its row may be about to be written.
    let second = open_history(folder.path());
    assert!(stray.exists());
    drop((history, second));

    let history = open_history(folder.path());
    assert!(!stray.exists());
    assert_eq!(history.known(number).expect("there").detail.frame, None);
    let kept = history.known(other).expect("there");
    assert!(history.scene(&kept).expect("read").is_some());
    assert_eq!(history.usage().expect("asked").num_frames, 1);
}
