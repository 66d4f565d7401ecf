//! Files that librealsense recorded, played by librealsense.

use std::{
    env,
    ffi::OsStr,
    fs,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};

use capture::{
    BackpressurePolicy, CameraErrorKind, CaptureError, DepthSource, Feed, FeedItem, FeedState,
    NextCapture, Pace, RealsenseSpec, Recovery, SourceSpec, open,
};
use geometry::{distortion::Distortion, error::Advice as _};

use capture::fixtures::{SHARED, camera_error, compile_c};

use crate::{
    own_process,
    played_camera::{PATIENCE, frame_of, next_capture},
    realsense::{check, listed, skipped},
};

const NUM_FRAMES: u16 = 60;
/// Brown-Conrady in `rs2_distortion`.
const BROWN_CONRADY: &str = "4";
const KANNALA_BRANDT: &str = "5";
/// Stub for the interpreter's functions that the modules of the Python package need.
const PYTHON: &str = "python.so";

/// Runs a test's body with librealsense and a file that it recorded of a camera with that lens model.
fn with_file(test: &str, model: &str, body: impl FnOnce()) {
    if own_process::is_own(test) {
        return body();
    }
    let folder = tempfile::tempdir().expect("a folder");
    if let Err(why) = record(folder.path(), model) {
        return skipped("PARTSIGHT_REQUIRE_REALSENSE", &why);
    }
    let python = folder.path().join(PYTHON);
    let environment: [(&str, &OsStr); 2] = [
        ("PARTSIGHT_REALSENSE", folder.path().as_os_str()),
        ("LD_PRELOAD", python.as_os_str()),
    ];
    own_process::run(test, &environment);
}

/// Puts librealsense into a folder, with a file that it records.
fn record(folder: &Path, model: &str) -> Result<(), String> {
    let library = env::var_os("PARTSIGHT_TEST_REALSENSE").filter(|path| !path.is_empty());
    let library = library.ok_or("PARTSIGHT_TEST_REALSENSE names no library")?;
    let library = fs::canonicalize(library).expect("PARTSIGHT_TEST_REALSENSE is there");
    let python = folder.join(PYTHON);
    compile_c(
        "crates/inspection/tests/pipeline/realsense/python.c",
        &python,
        &SHARED,
    )?;
    let program = folder.join("record");
    compile_c(
        "crates/inspection/tests/pipeline/realsense/record.c",
        &program,
        &[],
    )?;
    let linked = folder.join("librealsense2.so");
    symlink(library, &linked).expect("linked");
    let output = Command::new(program)
        .args([&linked, &folder.join("a")])
        .arg(NUM_FRAMES.to_string())
        .arg(model)
        .env("LD_PRELOAD", python)
        .output()
        .expect("started");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    Ok(())
}

/// The recorded file; its ending depends on the version of the library.
fn file() -> PathBuf {
    let folder = env::var_os("PARTSIGHT_REALSENSE").expect("set");
    let files = ["a.db3", "a.bag"].map(|name| Path::new(&folder).join(name));
    let mut files = files.into_iter();
    files.find(|file| file.is_file()).expect("recorded")
}

fn spec(pace: Option<Pace>) -> SourceSpec {
    SourceSpec::Realsense(RealsenseSpec {
        device: Some(file().display().to_string()),
        pace,
        ..RealsenseSpec::default()
    })
}

fn open_file() -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&spec(None))
}

#[test]
fn every_frame_of_a_file_comes_as_it_was_recorded_and_then_the_end() {
    let test =
        "realsense::recorded::every_frame_of_a_file_comes_as_it_was_recorded_and_then_the_end";
    with_file(test, BROWN_CONRADY, || {
        for _ in 0..2 {
            let mut played = open_file().expect("opens");
            assert_eq!(played.title(), format!("Recording {}", file().display()));
            assert!(!played.is_simulated());
            for number in 1..=NUM_FRAMES {
                let captured = next_capture(played.as_mut()).expect("no problem");
                let captured = captured.expect("no end");
                assert_eq!(captured.number, u64::from(number));
                let taken_at = 1_700_000_000_000 + 100 * (i64::from(number) - 1);
                assert_eq!(captured.taken_at.as_millisecond(), taken_at);
                let frame = frame_of(captured);
                assert_eq!(check(&frame, 16, 12), number);
                assert_eq!(frame.metres_per_unit.to_string(), "0.0005");
                let lens = frame.intrinsics;
                let numbers = [lens.fx, lens.fy, lens.cx, lens.cy];
                assert_eq!(format!("{numbers:?}"), "[20.0, 21.0, 7.5, 5.25]");
                let expected = Distortion {
                    k1: 0.125,
                    k2: -0.0625,
                    p1: f64::from(0.001_f32),
                    p2: f64::from(-0.002_f32),
                    k3: 0.015_625,
                    ..Distortion::NONE
                };
                assert_eq!(lens.distortion, expected);
            }
            for _ in 0..3 {
                assert!(next_capture(played.as_mut()).expect("an end").is_none());
            }
        }
    });
}

#[test]
fn a_file_is_let_go_before_its_end() {
    let test = "realsense::recorded::a_file_is_let_go_before_its_end";
    with_file(test, BROWN_CONRADY, || {
        for num in [0, 1, 2, 5, 20, 40] {
            let mut played = open_file().expect("opens");
            for number in 1..=num {
                let captured = next_capture(played.as_mut()).expect("no problem");
                assert_eq!(captured.expect("no end").number, number);
            }
        }
    });
}

#[test]
fn a_feed_plays_a_file_at_its_own_pace_and_ends() {
    let test = "realsense::recorded::a_feed_plays_a_file_at_its_own_pace_and_ends";
    with_file(test, BROWN_CONRADY, || {
        for pace in [Pace::AsTaken, Pace::PerSecond(60.0)] {
            let spec = spec(Some(pace));
            let delivery = BackpressurePolicy::for_source(&spec);
            let feed = Feed::start(spec, delivery, || {}).expect("a thread");
            let mut num_frames = 0;
            while let Some(item) = feed.wait(PATIENCE) {
                assert!(matches!(item, FeedItem::Captured(_)), "{item:?}");
                num_frames += 1;
            }
            assert!(num_frames > 0);
            let state = feed.status().state;
            assert!(matches!(state, FeedState::Ended), "{state:?}");
        }
    });
}

#[test]
fn a_file_of_a_lens_that_cannot_be_held_is_refused() {
    let test = "realsense::recorded::a_file_of_a_lens_that_cannot_be_held_is_refused";
    with_file(test, KANNALA_BRANDT, || {
        let error = camera_error(open_file().err().expect("refused"));
        let text = error.to_string();
        assert!(
            matches!(error.kind, CameraErrorKind::Unsuitable { .. }),
            "{text}"
        );
        assert!(text.contains("by the Kannala-Brandt model"), "{text}");
    });
}

#[test]
fn a_file_that_is_damaged_cut_off_or_none_is_named() {
    let test = "realsense::recorded::a_file_that_is_damaged_cut_off_or_none_is_named";
    with_file(test, BROWN_CONRADY, || {
        let path = file();
        let name = path.display().to_string();
        let whole = fs::read(&path).expect("recorded");
        let num = whole.len();
        for (content, words) in [
            (&whole[..num - 1], "cut off"),
            (&whole[..num / 2], "cut off"),
            (&whole[..100], "cut off"),
            (&b"no recording at all"[..], "no recording"),
            (&b""[..], "no recording"),
        ] {
            fs::write(&path, content).expect("written");
            let error = open_file().err().expect("refused");
            let text = error.to_string();
            assert!(text.starts_with(&name) && text.contains(words), "{text}");
            assert_eq!(error.recovery(), Recovery::None);
            assert!(!error.advice().is_empty());
        }
        // A file of the right length without contents.
        let mut empty = whole.clone();
        empty[100..].fill(0);
        fs::write(&path, &empty).expect("written");
        let error = open_file().err().expect("refused");
        assert!(error.to_string().starts_with(&name), "{error}");
        fs::remove_file(&path).expect("removed");
        let missing = open(&format!("realsense:{name}").parse().expect("a source"));
        let error = missing.err().expect("refused");
        assert!(matches!(error, CaptureError::File(_)), "{error}");

        fs::write(&path, &whole).expect("written");
        let mut again = open_file().expect("whole again");
        assert!(next_capture(again.as_mut()).expect("no problem").is_some());
    });
}

#[test]
fn librealsense_without_a_camera_says_so() {
    let test = "realsense::recorded::librealsense_without_a_camera_says_so";
    with_file(test, BROWN_CONRADY, || {
        // A machine with a camera lists it instead.
        if let Some(error) = listed().into_iter().find_map(|listed| listed.error) {
            assert!(
                matches!(error.kind, CameraErrorKind::NoDevice { wanted: None, .. }),
                "{error}"
            );
            assert_eq!(error.recovery(), Recovery::Reopen);
        }
        let mut played = open_file().expect("opens");
        let next = played.next(Duration::from_secs(5)).expect("no problem");
        assert!(matches!(next, NextCapture::Captured(_)), "{next:?}");
    });
}
