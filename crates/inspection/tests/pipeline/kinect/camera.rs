//! Cameras that work or fail, played by a stub library compiled here.

use std::{env, ffi::OsStr, fs, time::Duration};

use capture::{CameraErrorKind, Image, KinectSpec, NextCapture, Recovery, SourceSpec, open};
use geometry::error::Advice as _;

use capture::fixtures::{SHARED, compile_c};

use crate::{
    kinect::{listed, open_error, open_kinect, skipped},
    own_process::{self, is_own},
    played_camera::next_capture,
};

/// The calls from the start to the end of a stream, with their arguments.
const WHOLE: &str = "init 0,select 2,open 0,mode 5,start 1,stop 1,close 1,shutdown 1";

/// Runs a test's body with a camera in that state; in the state "old" its library lacks a function.
fn with_camera(test: &str, state: &str, body: impl FnOnce()) {
    if is_own(test) {
        return body();
    }
    let folder = tempfile::tempdir().expect("a folder");
    let library = folder.path().join("libfreenect.so.0.5");
    let mut options = SHARED.to_vec();
    options.extend((state == "old").then_some("-DOLD"));
    if let Err(why) = compile_c(
        "crates/inspection/tests/pipeline/kinect/camera.c",
        &library,
        &options,
    ) {
        return skipped("PARTSIGHT_REQUIRE_KINECT", &why);
    }
    let log = folder.path().join("calls");
    let environment: [(&str, &OsStr); 3] = [
        ("PARTSIGHT_FREENECT", folder.path().as_os_str()),
        ("STUB", OsStr::new(state)),
        ("STUB_LOG", log.as_os_str()),
    ];
    own_process::run(test, &environment);
}

/// Returns the calls so far, separated by commas, and clears the log.
fn calls() -> String {
    let path = env::var_os("STUB_LOG").expect("a log");
    let calls = fs::read_to_string(&path).unwrap_or_default();
    fs::write(&path, "").expect("emptied");
    calls.trim_end().replace('\n', ",")
}

#[test]
fn the_newest_frame_comes_in_millimetres_with_the_cameras_own_focal_length() {
    let test =
        "kinect::camera::the_newest_frame_comes_in_millimetres_with_the_cameras_own_focal_length";
    with_camera(test, "well", || {
        let mut kinect = open_kinect().expect("opens");
        assert_eq!(kinect.title(), "Kinect");
        for expected in [1003, 1005] {
            let captured = next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("a frame");
            assert_eq!(captured.warnings, []);
            let Image::Depth(frame) = captured.image else {
                panic!("a cloud")
            };
            assert_eq!(
                (frame.depth[319], frame.depth[320]),
                (expected, 0),
                "10 m is no reading"
            );
            assert!((frame.metres_per_unit - 0.001).abs() < 1e-12);
            let camera = frame.intrinsics;
            // Reference distance over twice the pixel size.
            assert!((camera.fx - 583.25).abs() < 0.01 && (camera.fy - 583.25).abs() < 0.01);
            assert!((camera.cx - 320.0).abs() < 1e-9 && (camera.cy - 240.0).abs() < 1e-9);
        }
        drop(kinect);
        assert_eq!(calls(), WHOLE);
        drop(open_kinect().expect("opens again"));
        assert_eq!(calls(), WHOLE, "without a frame");
    });
}

#[test]
fn every_camera_is_listed_and_opened_by_its_serial_number() {
    let test = "kinect::camera::every_camera_is_listed_and_opened_by_its_serial_number";
    with_camera(test, "well", || {
        let titles: Vec<String> = listed().into_iter().map(|listed| listed.title).collect();
        assert_eq!(titles, ["Kinect A00362", "Kinect B00417"]);
        calls();
        let spec = listed()
            .pop()
            .and_then(|last| last.spec)
            .expect("can be opened");
        assert_eq!(spec.to_string(), "kinect:B00417");
        calls();
        let mut kinect = open(&spec).expect("opens");
        assert_eq!(kinect.title(), "Kinect B00417");
        next_capture(kinect.as_mut())
            .expect("no problem")
            .expect("a frame");
        drop(kinect);
        assert_eq!(calls(), WHOLE.replace("open 0", "open 1"));

        for serial in ["C1", "A00362 ", "A\0"] {
            let spec = KinectSpec {
                serial: Some(serial.into()),
                library: None,
            };
            let error = open(&SourceSpec::Kinect(spec)).err().expect("another");
            assert!(error.to_string().contains("only A00362, B00417"), "{error}");
        }
        assert!(!calls().contains("open"));
    });
}

#[test]
fn while_it_is_open_here_it_is_listed_as_in_use() {
    let test = "kinect::camera::while_it_is_open_here_it_is_listed_as_in_use";
    with_camera(test, "well", || {
        let kinect = open_kinect().expect("opens");
        let error = listed().pop().and_then(|last| last.error).expect("in use");
        assert_eq!(error.kind, CameraErrorKind::InUse);
        drop(kinect);
        assert!(listed().pop().is_some_and(|last| last.error.is_none()));
    });
}

#[test]
fn an_unplugged_camera_is_an_error_that_opening_again_may_help() {
    let test = "kinect::camera::an_unplugged_camera_is_an_error_that_opening_again_may_help";
    with_camera(test, "unplugged", || {
        let mut kinect = open_kinect().expect("opens");
        for _ in 0..2 {
            next_capture(kinect.as_mut())
                .expect("no problem")
                .expect("a frame");
        }
        let error = kinect.next(Duration::from_millis(500)).expect_err("lost");
        assert_eq!(error.recovery(), Recovery::Reopen);
        assert!(error.to_string().contains("marked dead"), "{error}");
        // The library stopped the stream itself; the second stop has no effect.
        let whole = WHOLE.replace("stop 1", "stop 1,stop 1");
        assert_eq!(calls(), whole, "let go at once");
        assert!(matches!(kinect.next(Duration::ZERO), Ok(NextCapture::End)));
        drop(kinect);
        assert_eq!(calls(), "");
    });
}

#[test]
fn a_camera_that_sends_nothing_is_waited_for() {
    let test = "kinect::camera::a_camera_that_sends_nothing_is_waited_for";
    with_camera(test, "silent", || {
        let mut kinect = open_kinect().expect("opens");
        let next = kinect
            .next(Duration::from_millis(5))
            .expect("no problem yet");
        assert!(matches!(next, NextCapture::NotYet), "{next:?}");
        drop(kinect);
        assert_eq!(calls(), WHOLE);
    });
}

#[test]
fn a_signal_is_no_open_error() {
    with_camera(
        "kinect::camera::a_signal_is_no_open_error",
        "signals",
        || {
            let mut kinect = open_kinect().expect("opens");
            for _ in 0..3 {
                next_capture(kinect.as_mut())
                    .expect("no problem")
                    .expect("a frame");
            }
        },
    );
}

/// Checks message, advice and calls in a state in which the camera does not open.
fn refused(test: &str, state: &str, words: &str, advice: &str, expected_calls: &str) {
    with_camera(test, state, || {
        let error = open_error();
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.advice().contains(advice), "{}", error.advice());
        assert_eq!(calls(), expected_calls);
        // The second attempt fails in the same way: nothing is left behind.
        assert_eq!(open_error().to_string(), error.to_string());
    });
}

#[test]
fn no_usb() {
    refused(
        "kinect::camera::no_usb",
        "no usb",
        "USB error -99",
        "USB",
        "init 0",
    );
}

#[test]
fn no_device() {
    let calls = "init 0,select 2,shutdown 1";
    refused(
        "kinect::camera::no_device",
        "no device",
        "no Kinect is plugged in",
        "power supply",
        calls,
    );
}

#[test]
fn no_permission() {
    let calls = "init 0,select 2,shutdown 1";
    refused(
        "kinect::camera::no_permission",
        "no permission",
        "does not allow",
        "plug the Kinect in again",
        calls,
    );
}

#[test]
fn no_permission_is_listed() {
    with_camera(
        "kinect::camera::no_permission_is_listed",
        "no permission",
        || {
            let kinects = listed();
            assert_eq!(kinects.len(), 2);
            for kinect in kinects {
                let error = kinect.error.expect("not permitted");
                assert!(matches!(error.kind, CameraErrorKind::NoPermission { .. }));
            }
        },
    );
}

#[test]
fn busy() {
    let calls = "init 0,select 2,shutdown 1";
    refused(
        "kinect::camera::busy",
        "busy",
        "in use by another program",
        "Close the other program",
        calls,
    );
}

#[test]
fn half_open() {
    let calls = "init 0,select 2,open 0,shutdown 1";
    refused(
        "kinect::camera::half_open",
        "half open",
        "const shift",
        "Unplug",
        calls,
    );
}

#[test]
fn no_mode() {
    let calls = "init 0,select 2,open 0,close 1,shutdown 1";
    refused(
        "kinect::camera::no_mode",
        "no mode",
        "in none of the supported formats",
        "another build",
        calls,
    );
}

#[test]
fn no_bandwidth() {
    let calls = "init 0,select 2,open 0,mode 5,close 1,shutdown 1";
    refused(
        "kinect::camera::no_bandwidth",
        "no bandwidth",
        "cannot be started: Failed to submit",
        "another USB socket",
        calls,
    );
}

#[test]
fn a_library_without_a_function_that_is_needed_is_named_with_it() {
    let test = "kinect::camera::a_library_without_a_function_that_is_needed_is_named_with_it";
    with_camera(test, "old", || {
        let error = open_error();
        assert!(
            error
                .to_string()
                .contains("no function freenect_start_depth"),
            "{error}"
        );
        assert!(
            error.advice().contains("libfreenect 0.5"),
            "{}",
            error.advice()
        );
        assert_eq!(calls(), "");
    });
}
