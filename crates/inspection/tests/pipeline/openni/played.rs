//! Files that the library recorded.

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};

use capture::{
    BackpressurePolicy, CameraErrorKind, CaptureError, DepthSource, Feed, FeedItem, FeedState,
    NextCapture, OpenNiSpec, Pace, Recovery, SourceSpec, fixtures::camera_error, open,
};
use geometry::error::Advice as _;

use capture::fixtures::compile_c;

use crate::{
    openni::{check, with_camera},
    played_camera::{PATIENCE, frame_of, next_capture},
};

const NUM_FRAMES: usize = 12;

/// Records the camera in that state, in its default mode and mirroring.
fn record(folder: &Path, state: &str) {
    let program = folder.join("record");
    compile_c(
        "crates/inspection/tests/pipeline/openni/record.c",
        &program,
        &[],
    )
    .expect("as the driver was");
    let output = Command::new(program)
        .args([folder.join("libOpenNI2.so.0"), folder.join("a.oni")])
        .arg(NUM_FRAMES.to_string())
        .env("STUB", OsStr::new(state))
        .output()
        .expect("started");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
}

fn file() -> PathBuf {
    Path::new(&std::env::var_os("PARTSIGHT_OPENNI").expect("set")).join("a.oni")
}

fn spec(file: &Path, pace: Option<Pace>) -> SourceSpec {
    SourceSpec::OpenNi(OpenNiSpec {
        device: Some(file.display().to_string()),
        pace,
        library: None,
    })
}

fn open_file() -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&spec(&file(), None))
}

/// Checks that every frame of the file comes in order, followed by its end.
fn plays_whole(test: &str, state: &str, size: [usize; 2], metres_per_unit: f64) {
    with_camera(
        test,
        "well",
        |folder| record(folder, state),
        || {
            for _ in 0..2 {
                let mut file = open_file().expect("opens");
                assert!(!file.is_simulated());
                let mut numbers = Vec::new();
                while let Some(captured) = next_capture(file.as_mut()).expect("no problem") {
                    assert_eq!(captured.number, numbers.len() as u64 + 1);
                    let frame = frame_of(captured);
                    assert!((frame.metres_per_unit - metres_per_unit).abs() < 1e-9);
                    numbers.push(check(&frame, size[0], size[1]));
                }
                let first = numbers[0];
                let all: Vec<usize> = (first..first + numbers.len()).collect();
                assert_eq!(numbers, all);
                assert!(numbers.len() >= NUM_FRAMES, "{}", numbers.len());
                for _ in 0..3 {
                    let next = file.next(Duration::ZERO).expect("an end");
                    assert!(matches!(next, NextCapture::End), "{next:?}");
                }
            }
        },
    );
}

#[test]
fn a_file_of_a_mirrored_picture_is_turned_back() {
    plays_whole(
        "openni::played::a_file_of_a_mirrored_picture_is_turned_back",
        "well",
        [16, 12],
        0.001,
    );
}

#[test]
fn a_file_of_a_picture_that_is_not_mirrored_stays_as_it_is() {
    let test = "openni::played::a_file_of_a_picture_that_is_not_mirrored_stays_as_it_is";
    plays_whole(test, "upright", [16, 12], 0.001);
}

#[test]
fn a_file_in_tenths_of_a_millimetre_is_read() {
    plays_whole(
        "openni::played::a_file_in_tenths_of_a_millimetre_is_read",
        "fine",
        [64, 48],
        0.0001,
    );
}

#[test]
fn a_feed_plays_a_file_at_its_own_pace_and_ends() {
    let test = "openni::played::a_feed_plays_a_file_at_its_own_pace_and_ends";
    with_camera(
        test,
        "no camera",
        |folder| record(folder, "well"),
        || {
            let spec = spec(&file(), Some(Pace::AsTaken));
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
        },
    );
}

#[test]
fn a_file_that_does_not_tell_its_mirroring_is_refused() {
    let test = "openni::played::a_file_that_does_not_tell_its_mirroring_is_refused";
    with_camera(
        test,
        "well",
        |folder| record(folder, "untold"),
        || {
            let error = camera_error(open_file().err().expect("refused"));
            assert!(
                matches!(error.kind, CameraErrorKind::Unsuitable { .. }),
                "{error}"
            );
            let text = error.to_string();
            assert!(text.contains("a.oni"), "{text}");
            assert!(text.contains("whether its picture is mirrored"), "{text}");
        },
    );
}

#[test]
fn a_file_that_is_damaged_or_none_is_named() {
    let test = "openni::played::a_file_that_is_damaged_or_none_is_named";
    with_camera(
        test,
        "well",
        |folder| record(folder, "well"),
        || {
            let whole = fs::read(file()).expect("recorded");
            for content in [&whole[..20], b"no recording at all", b""] {
                fs::write(file(), content).expect("written");
                let error = open_file().err().expect("refused");
                assert!(error.to_string().contains("a.oni"), "{error}");
                assert_eq!(error.recovery(), Recovery::None);
                assert!(!error.advice().is_empty());
            }
            fs::remove_file(file()).expect("removed");
            let error = open_file().err().expect("refused");
            assert!(matches!(error, CaptureError::File(_)), "{error}");

            let long = file().with_file_name(format!("{}.oni", "a".repeat(240)));
            fs::write(&long, &whole).expect("written");
            let error = open(&spec(&long, None)).err().expect("refused");
            assert!(error.to_string().contains("255 bytes"), "{error}");

            fs::write(file(), &whole).expect("written");
            let mut again = open_file().expect("whole again");
            assert!(next_capture(again.as_mut()).expect("no problem").is_some());
        },
    );
}

#[test]
fn a_file_that_was_cut_off_is_refused_before_the_library_has_it() {
    let test = "openni::played::a_file_that_was_cut_off_is_refused_before_the_library_has_it";
    with_camera(
        test,
        "well",
        |folder| record(folder, "well"),
        || {
            let whole = fs::read(file()).expect("recorded");
            // The last record begins at the last magic; the library leaves bytes after it.
            let end = whole.windows(4).rposition(|magic| magic == b"NIR\0");
            let end = end.expect("a last record");
            for num in [end, end - 1, end / 2, end / 4, 100] {
                fs::write(file(), &whole[..num]).expect("written");
                let error = open_file().err().expect("refused");
                let text = error.to_string();
                assert!(text.contains("a.oni: cut off"), "{text}");
                assert_eq!(error.recovery(), Recovery::None);
            }
            fs::write(file(), &whole[..end + 28]).expect("written");
            let mut file = open_file().expect("whole");
            while let Some(captured) = next_capture(file.as_mut()).expect("no problem") {
                check(&frame_of(captured), 16, 12);
            }
        },
    );
}
