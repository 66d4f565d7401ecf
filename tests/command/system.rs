//! What the system can do to the built program: limits on the size of files, pipes in place of files, a wrong clock.

#![cfg(unix)]

use std::{
    fmt::Write as _,
    fs,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

#[cfg(target_os = "linux")]
use crate::kit::{SHARED, compile_c};
use crate::workplace::{Ran, Workplace};

/// Wall time after which a program counts as blocked.
const PATIENCE: Duration = Duration::from_mins(10);

/// Waits until a program has ended; one that is blocked is killed.
fn ended(mut child: Child) -> Ran {
    let begun = Instant::now();
    while child.try_wait().expect("a state").is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().expect("killed");
        }
        thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().expect("ended").into()
}

fn start(mut command: Command) -> Child {
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    piped.spawn().expect("starts")
}

/// A place with the capture `fender.pcd` of a part of the library `parts`.
fn with_fender() -> Workplace {
    let place = Workplace::new();
    place.with_part("fender");
    place
}

/// A spray path of some 10 kB, which does not aim at the part.
fn write_path(place: &Workplace) {
    let mut text =
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n".to_owned();
    for x in 0..200 {
        writeln!(text, "{x}.125,250.125,999.125,0,0,1").expect("in memory");
    }
    place.write("path.csv", &text);
}

/// A command with a limit on the size of files, in blocks of 512 bytes.
fn limited(place: &Workplace, num_blocks: u32, args: &[&str]) -> Command {
    let program = env!("CARGO_BIN_EXE_partsight");
    let limit = format!("ulimit -f {num_blocks}; exec {program} \"$@\"");
    place.command_of("sh", &[&["-c", &limit, "sh"], args].concat())
}

#[test]
fn a_limit_on_the_size_of_files_is_an_error_and_loses_no_file() {
    let place = with_fender();
    write_path(&place);
    let store = [
        "library",
        "--library",
        "parts",
        "path",
        "fender",
        "path.csv",
    ];
    // Stored, with the warning that it does not aim at the part.
    place.coded(1, &store);
    let message = "the file would be larger than this system allows";
    let refused = |args: &[&str]| {
        let ran = ended(start(limited(&place, 8, args)));
        assert_eq!(ran.code, 2, "{args:?}\n{}", ran.err);
        assert!(ran.err.contains(message), "{args:?}\n{}", ran.err);
        assert!(ran.err.contains("ulimit -f"), "{args:?}\n{}", ran.err);
    };
    // The same path again, whose file has the same name.
    refused(&store);
    let verify = ["library", "--library", "parts", "verify"];
    let verified = place.accepted(&verify);
    assert!(!verified.err.contains("warning"), "{}", verified.err);
    refused(&["simulate", "--part", "grille", "--out", "grille.pcd"]);
    refused(&[
        "enrol",
        "fender.pcd",
        "--name",
        "other",
        "--library",
        "parts",
    ]);
    refused(&[
        "capture",
        "--source",
        "simulated",
        "--frames",
        "1",
        "--out",
        "tried",
    ]);
    assert!(!place.path("grille.pcd").exists());
    assert!(!place.path("parts/other").exists());

    // The verdict is there, and the history says why it is not.
    let inspect = ["inspect", "fender.pcd", "--library", "parts", "--json"];
    let inspect = [&inspect[..], &["--history", "kept"]].concat();
    let ran = ended(start(limited(&place, 8, &inspect)));
    assert_eq!(ran.json()["accepted"], true);
    assert!(ran.err.contains("history"), "{}", ran.err);
    assert!(ran.err.contains("ulimit -f"), "{}", ran.err);
    let again = place.accepted(&inspect);
    assert!(again.err.is_empty(), "{}", again.err);
}

#[test]
fn a_pipe_in_place_of_a_file_is_refused_at_once() {
    let place = with_fender();
    write_path(&place);
    fs::create_dir(place.path("kept")).expect("made");
    for name in [
        "kept/history.sqlite",
        "pipe",
        "pipe.pcd",
        "pipe.toml",
        "pipe.csv",
        "pipe.bag",
        "pipe.oni",
        "pipe.db3",
    ] {
        let made = Command::new("mkfifo").arg(place.path(name)).status();
        assert!(made.expect("starts").success(), "{name}");
    }
    let inspect = ["inspect", "fender.pcd", "--library", "parts", "--json"];
    let with = |args: &[&'static str]| [&inspect[..], args].concat();
    let kept = ended(start(place.command(&with(&["--history", "kept"]))));
    assert_eq!(kept.json()["accepted"], true);
    assert!(kept.err.contains("not a regular file"), "{}", kept.err);
    assert!(kept.err.contains("to do: Move"), "{}", kept.err);

    for args in [
        &["history", "list", "--history", "kept"][..],
        &["inspect", "pipe.pcd", "--json"],
        &["inspect", "fender.pcd", "--library", "pipe", "--json"],
        &["inspect", "fender.pcd", "--recipe", "pipe.toml", "--json"],
        &[
            "inspect",
            "fender.pcd",
            "--calibration",
            "pipe.toml",
            "--json",
        ],
        &[
            "inspect",
            "fender.pcd",
            "--empty-cell",
            "pipe.pcd",
            "--json",
        ],
        &["inspect", "--source", "realsense:pipe.bag", "--json"],
        &["inspect", "--source", "realsense:pipe.db3", "--json"],
        &["inspect", "--source", "openni:pipe.oni", "--json"],
        &["inspect", "--source", "recording:pipe", "--json"],
        &["enrol", "pipe.pcd", "--name", "other", "--library", "parts"],
        &[
            "library",
            "--library",
            "parts",
            "path",
            "fender",
            "pipe.csv",
        ],
        &["library", "--library", "pipe", "list"],
    ] {
        let ran = ended(start(place.command(args)));
        assert_eq!(ran.code, 2, "{args:?}\n{}\n{}", ran.out, ran.err);
        assert!(
            ran.err.contains("pipe") || ran.err.contains("kept"),
            "{}",
            ran.err
        );
        assert!(ran.err.contains("to do:"), "{args:?}\n{}", ran.err);
    }
}

/// Longer than the calendar reaches: eight thousand years.
#[cfg(target_os = "linux")]
const CLOCK_AHEAD: &str = "253402300800";

#[cfg(target_os = "linux")]
#[test]
fn a_clock_beyond_the_calendar_stops_nothing() {
    let place = with_fender();
    let clock = place.path("libclock.so");
    if let Err(why) = compile_c("tests/command/clock.c", &clock, &SHARED) {
        return geometry::fixtures::skipped("PARTSIGHT_REQUIRE_COMPILER", why);
    }
    let run = |args: &[&str]| {
        let mut command = place.command(args);
        command
            .env("LD_PRELOAD", &clock)
            .env("CLOCK_AHEAD", CLOCK_AHEAD);
        let ran = ended(start(command));
        assert_eq!(ran.code, 0, "{args:?}\n{}\n{}", ran.out, ran.err);
        ran
    };
    let inspect = ["inspect", "fender.pcd", "--library", "parts", "--json"];
    run(&[&inspect[..], &["--history", "kept"]].concat());
    for since in ["today", "7d", "9998-12-31"] {
        let list = [
            "history",
            "list",
            "--history",
            "kept",
            "--json",
            "--since",
            since,
        ];
        let rows = run(&list).lines();
        assert_eq!(rows.len(), 1, "{since}");
        let at = rows[0]["at"].as_str().expect("a time");
        assert!(at.starts_with("9999-01-01"), "{at}");
    }
    run(&["simulate", "--part", "grille", "--out", "grille.pcd"]);
    run(&[
        "capture",
        "--source",
        "simulated",
        "--frames",
        "2",
        "--out",
        "tried",
    ]);
    run(&["capture", "--source", "recording:tried", "--out", "copy"]);
    run(&[
        "report",
        "fender.pcd",
        "--library",
        "parts",
        "--out",
        "reports",
        "--format",
        "pdf,csv",
    ]);
    run(&[
        "enrol",
        "fender-reference.pcd",
        "--name",
        "other",
        "--library",
        "parts",
    ]);
    run(&["library", "--library", "parts", "remove", "other"]);
}
