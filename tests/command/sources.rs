//! Sources that the built program records, replays, watches and follows.

use std::{
    fs,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;

use crate::{
    kit::{SHARED, compile_c},
    workplace::{Ran, Workplace},
};

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(2);

/// Starts a command that runs until it is interrupted.
fn start(place: &Workplace, args: &[&str]) -> Child {
    place
        .command(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts")
}

fn ended(child: Child) -> Ran {
    child.wait_with_output().expect("it ends").into()
}

/// The verdict without times and without the origin of the capture.
fn verdict(line: &str) -> Value {
    let mut line: Value = serde_json::from_str(line).expect("a line of JSON");
    let fields = line.as_object_mut().expect("an object");
    for field in ["timings_ms", "taken_at", "source", "number", "dropped"] {
        assert!(fields.remove(field).is_some(), "{field} is missing");
    }
    // Only a later frame shows it.
    fields.remove("motion_checked");
    fields.remove("replayed");
    line
}

fn wait_until(what: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !what() {
        assert!(Instant::now() < until, "it took too long");
        thread::sleep(Duration::from_millis(20));
    }
}

fn num_lines(path: &Path) -> usize {
    fs::read(path).map_or(0, |bytes| {
        String::from_utf8_lossy(&bytes).matches('\n').count()
    })
}

/// Interrupts the process as Ctrl-C does.
#[cfg(unix)]
fn interrupt(child: &Child) {
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill is there").success());
}

#[test]
fn a_recording_gives_the_same_verdicts_as_the_cell_itself_bit_for_bit() {
    let place = Workplace::new();
    let cell = "simulated,fps=4,noise=1.5:fender";
    let captured = place.accepted(&[
        "capture", "--source", cell, "--frames", "6", "--out", "tried",
    ]);
    assert_eq!(captured.out, "6 frames, simulated in tried\n");
    let replay = || {
        let Ran { out, err, .. } =
            place.accepted(&["inspect", "--source", "recording:tried", "--json"]);
        assert!(err.contains("6 inspected, 0 dropped"), "{err}");
        assert!(err.contains("Simulated: no camera is read"), "{err}");
        out.lines().map(verdict).collect::<Vec<_>>()
    };
    let first = replay();
    assert_eq!(first.len(), 6);
    assert_eq!(first, replay());
    for line in &first {
        assert_eq!(line["simulated"], true);
        assert_eq!(line["part"], "fender");
    }
    // Which frames of a live cell are dropped depends on the machine; frames seen both times agree.
    let ran = place.run(&["inspect", "--source", cell, "--frames", "3", "--json"]);
    let direct: Vec<Value> = ran.out.lines().map(verdict).collect();
    assert_eq!(direct.len(), 3, "{}", ran.err);
    let mut num_agreeing = 0;
    for line in &direct {
        assert_eq!(line["simulated"], true);
        if let Some(same) = first.iter().find(|other| other["scene"] == line["scene"]) {
            assert_eq!(same, line);
            num_agreeing += 1;
        }
    }
    assert!(num_agreeing >= 1, "{direct:?}");
    // The images of a recording can be inspected as files.
    let file = place.run(&["inspect", "tried/frame-000001.png", "--json"]);
    let file = file.json();
    assert_eq!(file["pose"], first[0]["pose"]);
    assert_eq!(file["simulated"], true);
}

#[test]
fn a_part_that_swings_is_refused_from_the_first_frame_of_a_source_on() {
    let place = Workplace::new();
    let capture = [
        "capture",
        "--source",
        "simulated",
        "--frames",
        "40",
        "--out",
        "line",
    ];
    place.accepted(&capture);
    let inspect = ["inspect", "--source", "recording:line", "--json"];
    let lines = place.run(&inspect).lines();
    let swings = |line: &Value| line["reason_kind"] == "not_steady";
    let first = lines.iter().position(swings).expect("a part comes in");
    // The same recording, from that frame on.
    let table = place.read("line/recording.jsonl");
    let (head, rows) = table.split_once('\n').expect("a head");
    let rows: Vec<&str> = rows.lines().skip(first).collect();
    place.write(
        "line/recording.jsonl",
        &format!("{head}\n{}\n", rows.join("\n")),
    );
    for num in ["1", "3"] {
        let ran = place.coded(1, &[&inspect[..], &["--frames", num]].concat());
        let lines = ran.lines();
        assert_eq!(lines.len().to_string(), num, "{}", ran.err);
        assert!(lines.iter().all(swings), "{}", ran.out);
    }
}

/// The arguments bound a run that does not end by itself.
const FOLLOW: [&str; 6] = [
    "inspect",
    "--source",
    "simulated,fps=4:fender",
    "--frames",
    "20",
    "--json",
];

/// Fewer frames were inspected than asked for: no more than show that the part of the first one hangs still.
fn ended_early(err: &str) -> bool {
    let line = err.lines().find(|line| line.contains(" inspected, "));
    let num = line.and_then(|line| line.split(' ').next()?.parse::<u32>().ok());
    num.is_some_and(|num| (1..20).contains(&num))
}

#[test]
fn following_ends_quietly_when_the_reader_goes_away() {
    let place = Workplace::new();
    let mut following = start(&place, &FOLLOW);
    drop(following.stdout.take());
    let Ran { code, err, .. } = ended(following);
    assert_eq!(code, 0, "{err}");
    assert!(ended_early(&err), "{err}");
    assert!(!err.contains("error"), "{err}");
}

#[cfg(target_os = "linux")]
#[test]
fn following_ends_with_an_error_when_the_disk_is_full() {
    let place = Workplace::new();
    let full = fs::File::options().write(true).open("/dev/full");
    let mut follow = place.command(&FOLLOW);
    let ran = follow.stdout(full.expect("there")).output();
    let Ran { code, err, .. } = ran.expect("starts").into();
    assert_eq!(code, 2, "{err}");
    assert!(ended_early(&err), "{err}");
    let message = "error: the output could not be written: the disk is full\n  to do: Make room";
    assert_eq!(err.matches(message).count(), 1, "{err}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_recording_that_is_whole() {
    let place = Workplace::new();
    let list = place.path("tried/recording.jsonl");
    let capture = ["capture", "--source", "simulated,fps=50", "--out", "tried"];
    let recording = start(&place, &capture);
    wait_until(|| num_lines(&list) > 3);
    interrupt(&recording);
    let Ran { code, out, err } = ended(recording);
    assert_eq!(code, 0, "{err}");
    let num = num_lines(&list) - 1;
    let begin = format!("{num} frames, simulated");
    assert!(out.starts_with(&begin), "{out}");
    let copy = ["capture", "--source", "recording:tried", "--out", "copy"];
    let copied = place.accepted(&copy);
    let begin = format!("{num} frames");
    assert!(
        copied.out.starts_with(&begin),
        "{} {}",
        copied.out,
        copied.err
    );
    let err = place.coded(2, &copy).err;
    assert!(err.contains("not empty") && err.contains("to do"), "{err}");
}

/// The only inspection in the history must be as it was shown in these lines.
#[cfg(unix)]
fn is_recorded_as_shown(place: &Workplace, lines: &[Value]) -> Value {
    let rows = place.accepted(&["history", "list", "--json"]).lines();
    assert_eq!(rows.len(), 1, "{rows:?}");
    let number = rows[0]["number"].to_string();
    let record = place.accepted(&["history", "show", &number, "--json"]);
    let recorded = record.json()["line"].clone();
    let shown = lines
        .iter()
        .find(|line| line["number"] == recorded["number"]);
    let shown = shown.expect("the frame was shown");
    for field in ["accepted", "reason_kind", "motion_checked", "replayed"] {
        assert_eq!(recorded.get(field), shown.get(field), "{field}");
    }
    recorded
}

#[cfg(unix)]
#[test]
fn a_part_is_recorded_as_it_was_shown_when_the_source_ends_before_it_is_known_to_hang_still() {
    let place = Workplace::new();
    // Ctrl-C while the first frame is inspected.
    let messages = place.path("messages.txt");
    let mut follow = place.command(&["inspect", "--source", "simulated,fps=1:fender", "--json"]);
    let following = follow
        .stdout(Stdio::piped())
        .stderr(fs::File::create(&messages).expect("a file"))
        .spawn()
        .expect("starts");
    wait_until(|| fs::read_to_string(&messages).is_ok_and(|text| text.contains("Simulated")));
    interrupt(&following);
    let ran = ended(following);
    let lines = ran.lines();
    let recorded = is_recorded_as_shown(&place, &lines);
    assert!(recorded.get("motion_checked").is_none());
    if lines.len() == 1 {
        assert_eq!(recorded["reason_kind"], "not_steady");
        assert_eq!(ran.code, 1);
    }
    // A recording shows no more than it has.
    let replay = Workplace::new();
    let source = "simulated:fender";
    replay.accepted(&[
        "capture", "--source", source, "--frames", "1", "--out", "one",
    ]);
    let lines = replay.accepted(&["inspect", "--source", "recording:one", "--json"]);
    let recorded = is_recorded_as_shown(&replay, &lines.lines());
    assert_eq!(recorded["accepted"], true);
    assert_eq!(recorded["motion_checked"], false);
    assert_eq!(recorded["replayed"], true);
    let shown = replay.accepted(&["history", "show", "1"]).out;
    assert!(
        shown.contains("no other frame shows whether the part hung still"),
        "{shown}"
    );
}

#[cfg(unix)]
#[test]
fn a_watched_folder_is_followed_until_ctrl_c() {
    let place = Workplace::new();
    let simulate = |name: &str| {
        place.accepted(&[
            "simulate",
            "--part",
            "fender",
            "--placement",
            "facing",
            "--out",
            name,
        ]);
    };
    simulate("one.pcd");
    let verdicts = place.path("verdicts.jsonl");
    let messages = place.path("messages.txt");
    let has_printed =
        |words: &str| fs::read_to_string(&messages).is_ok_and(|text| text.contains(words));
    let following = place
        .command(&["inspect", "--source", "watch,from=all:scans", "--json"])
        .stdout(fs::File::create(&verdicts).expect("a file"))
        .stderr(fs::File::create(&messages).expect("a file"))
        .spawn()
        .expect("starts");
    wait_until(|| has_printed("the folder does not exist"));
    fs::create_dir(place.path("scans")).expect("a folder");
    fs::rename(place.path("one.pcd"), place.path("scans/one.pcd")).expect("renamed");
    wait_until(|| num_lines(&verdicts) == 1);
    fs::write(place.path("scans/broken.pcd"), "# .PCD v0.7\n").expect("written");
    wait_until(|| num_lines(&verdicts) == 2);
    interrupt(&following);
    assert_eq!(ended(following).code, 2);
    assert!(has_printed("1 inspected, 0 dropped, 1 could not be read"));
    let lines = fs::read_to_string(&verdicts).expect("verdicts");
    let lines: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    assert_eq!(
        (&lines[0]["scene"], &lines[0]["part"]),
        (&"one.pcd".into(), &"fender".into())
    );
    assert_eq!(
        (&lines[0]["simulated"], &lines[0]["number"]),
        (&true.into(), &1.into())
    );
    assert_eq!(
        (&lines[1]["scene"], &lines[1]["status"]),
        (&"broken.pcd".into(), &"unreadable".into())
    );
}

#[test]
fn what_cannot_be_opened_is_said_with_what_to_do() {
    let place = Workplace::new();
    for (source, words) in [
        ("recording:missing", "the folder does not exist"),
        ("recording:.", "neither a recording nor a camera's file"),
    ] {
        let Ran { out, err, .. } = place.coded(2, &["inspect", "--source", source, "--json"]);
        assert_eq!(out, "");
        assert!(
            err.contains(words) && err.contains("to do"),
            "{source}: {err}"
        );
    }
    let err = place.coded(2, &["inspect", "--source", "camera"]).err;
    assert!(
        err.contains("is not a source") && err.contains("capture --list"),
        "{err}"
    );
    let out = place.accepted(&["capture", "--list"]).out;
    assert!(
        out.lines().any(|line| line.starts_with("simulated ")),
        "{out}"
    );
}

#[test]
fn a_cameras_files_are_listed_only_if_its_library_is_there() {
    let place = Workplace::new();
    fs::create_dir(place.path("empty")).expect("made");
    let list = |realsense: &str| -> Ran {
        let mut command = place.command(&["capture", "--list"]);
        command
            .env("PARTSIGHT_OPENNI", place.path("empty"))
            .env("PARTSIGHT_REALSENSE", place.path(realsense))
            .env("STUB", "no camera");
        command.output().expect("starts").into()
    };
    let Ran { code, out, err } = list("empty");
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("recording:DIR"), "{out}");
    assert!(!out.contains("FILE"), "{out}");
    for words in [
        "libOpenNI2 was not found there",
        "librealsense2 was not found there",
        "PARTSIGHT_REALSENSE",
    ] {
        assert!(err.contains(words), "{err}");
    }

    // With the library a file can be played, even if no camera is plugged in.
    let library = place.path("stub.so");
    if let Err(why) = compile_c(
        "crates/inspection/tests/pipeline/realsense/camera.c",
        &library,
        &SHARED,
    ) {
        return geometry::fixtures::skipped("PARTSIGHT_REQUIRE_COMPILER", why);
    }
    let Ran { code, out, err } = list("stub.so");
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("realsense:FILE.db3"), "{out}");
    assert!(!out.contains("openni:FILE.oni"), "{out}");
    assert!(err.contains("no RealSense camera is plugged in"), "{err}");
}
