//! Cameras that work or fail.

use std::time::Duration;

use capture::{
    CameraErrorKind, NextCapture, RealsenseSpec, Recovery, SourceSpec, fixtures::camera_error,
};

use geometry::error::Advice as _;

use crate::{
    played_camera::{frame_of, is_lost_and_found_again, is_refused, next_capture, next_frame},
    realsense::{check, listed, open_camera, open_text, with_cameras},
};

/// The pixel that shows the number of the camera.
const CAMERA_NUMBER: usize = 3 * 848 + 11;

#[test]
fn depth_comes_in_the_preferred_size_and_in_metres() {
    let test = "realsense::camera::depth_comes_in_the_preferred_size_and_in_metres";
    with_cameras(test, "well", || {
        let mut camera = open_camera().expect("opens");
        assert_eq!(camera.title(), "Intel RealSense D435 A1");
        assert!(!camera.is_simulated());
        for number in 1..=3 {
            let captured = next_capture(camera.as_mut()).expect("no problem");
            let captured = captured.expect("no end");
            assert_eq!(captured.number, u64::from(number));
            // For a live camera this is the present time, whatever its own clock says.
            assert!(captured.taken_at.as_millisecond() > 1_000_000);
            let frame = frame_of(captured);
            assert_eq!(check(&frame, 848, 480), number);
            assert_eq!(frame.depth[CAMERA_NUMBER], 0);
            assert_eq!(frame.metres_per_unit.to_string(), "0.001");
            let lens = frame.intrinsics;
            let numbers = [lens.fx, lens.fy, lens.cx, lens.cy];
            assert_eq!(format!("{numbers:?}"), "[421.5, 421.25, 424.0, 240.0]");
            assert!(lens.distortion.is_none());
        }
        drop(camera);
        next_frame(open_camera().expect("opens again").as_mut());
    });
}

#[test]
fn a_camera_is_listed_and_opened_by_its_serial_number() {
    let test = "realsense::camera::a_camera_is_listed_and_opened_by_its_serial_number";
    with_cameras(test, "well", || {
        let found = listed();
        let titles: Vec<&str> = found.iter().map(|listed| &listed.title[..]).collect();
        assert_eq!(
            titles,
            ["Intel RealSense D435 A1", "Intel RealSense D435 B2"]
        );
        let spec = found[1].spec.clone().expect("can be opened");
        assert_eq!(spec.to_string(), "realsense:B2");
        let mut camera = open_text("realsense:B2").expect("opens");
        assert_eq!(camera.title(), "Intel RealSense D435 B2");
        assert_eq!(next_frame(camera.as_mut()).depth[CAMERA_NUMBER], 1);

        let error = open_text("realsense:B2").err().expect("in use");
        assert!(error.to_string().contains("resource busy"), "{error}");
        assert_eq!(error.recovery(), Recovery::Reopen);
        next_frame(camera.as_mut());
        drop(camera);

        let error = open_text("realsense:C3").err().expect("another");
        assert!(error.to_string().contains("only A1, B2"), "{error}");
        assert_eq!(error.recovery(), Recovery::Reopen);
    });
}

#[test]
fn a_camera_without_depth_is_passed_over_and_listed_as_such() {
    let test = "realsense::camera::a_camera_without_depth_is_passed_over_and_listed_as_such";
    with_cameras(test, "tracking", || {
        let mut camera = open_camera().expect("opens the second");
        assert_eq!(camera.title(), "Intel RealSense D435 B2");
        assert_eq!(next_frame(camera.as_mut()).depth[CAMERA_NUMBER], 1);
        drop(camera);

        let error = open_text("realsense:A1").err().expect("no depth");
        assert!(error.to_string().contains("A1 has no depth"), "{error}");

        let [tracking, depth] = <[_; 2]>::try_from(listed()).expect("two cameras");
        assert!(tracking.spec.is_none());
        let error = tracking.error.expect("a reason");
        assert!(
            matches!(error.kind, CameraErrorKind::NoDepth { .. }),
            "{error}"
        );
        let spec = depth.spec.expect("can be opened");
        assert_eq!(spec.to_string(), "realsense:B2");
    });
}

#[test]
fn a_preset_is_set_by_its_name_and_its_unit_is_read() {
    let test = "realsense::camera::a_preset_is_set_by_its_name_and_its_unit_is_read";
    with_cameras(test, "well", || {
        let error = open_text("realsense,preset=Highest").err().expect("none");
        let text = error.to_string();
        assert!(
            text.contains("only Custom, Default, High Accuracy"),
            "{text}"
        );
        assert_eq!(error.recovery(), Recovery::None);
        let mut camera = open_text("realsense,preset=high accuracy").expect("opens");
        let frame = next_frame(camera.as_mut());
        assert_eq!(frame.metres_per_unit.to_string(), "0.0005");
        drop(camera);
        let mut camera = open_text("realsense,preset=Default").expect("opens");
        let frame = next_frame(camera.as_mut());
        assert_eq!(frame.metres_per_unit.to_string(), "0.001");
    });
}

#[test]
fn an_unplugged_camera_is_lost_and_found_again() {
    let test = "realsense::camera::an_unplugged_camera_is_lost_and_found_again";
    with_cameras(test, "unplugged", || {
        is_lost_and_found_again(SourceSpec::Realsense(RealsenseSpec::default()));
    });
}

#[test]
fn a_camera_that_sends_nothing_is_waited_for_then_opened_again() {
    let test = "realsense::camera::a_camera_that_sends_nothing_is_waited_for_then_opened_again";
    with_cameras(test, "silent", || {
        let mut camera = open_camera().expect("opens");
        let next = camera
            .next(Duration::from_millis(5))
            .expect("no problem yet");
        assert!(matches!(next, NextCapture::NotYet), "{next:?}");
        let error = next_capture(camera.as_mut()).expect_err("silent");
        assert_eq!(error.recovery(), Recovery::Reopen);
        let error = camera_error(error);
        assert!(
            matches!(error.kind, CameraErrorKind::NoFrames { .. }),
            "{error}"
        );
    });
}

/// Checks message and advice in a state in which the camera does not open, or stops after its first frames.
fn refused(test: &str, state: &str, words: &str, advice: &str) {
    with_cameras(test, state, || {
        is_refused(
            &SourceSpec::Realsense(RealsenseSpec::default()),
            words,
            advice,
        );
    });
}

#[test]
fn no_camera() {
    let words = "no RealSense camera is plugged in";
    refused(
        "realsense::camera::no_camera",
        "no camera",
        words,
        "Plug the camera in",
    );
}

#[test]
fn no_permission() {
    let words = "cannot be opened: failed to open usb interface: 0, error: RS2_USB_STATUS_ACCESS";
    let test = "realsense::camera::no_permission";
    refused(test, "no permission", words, "Close other programs");
}

#[test]
fn a_camera_that_does_not_open_is_listed_with_the_reason() {
    let test = "realsense::camera::a_camera_that_does_not_open_is_listed_with_the_reason";
    with_cameras(test, "no permission", || {
        let found = listed();
        assert_eq!(found.len(), 2);
        for camera in found {
            assert!(camera.spec.is_none());
            let error = camera.error.expect("a reason");
            assert_eq!(error.kind, CameraErrorKind::NotOpened, "{error}");
        }
    });
}

#[test]
fn busy() {
    let words = "cannot be started: Device or resource busy";
    refused(
        "realsense::camera::busy",
        "busy",
        words,
        "Close other programs",
    );
}

#[test]
fn no_bandwidth() {
    let words = "cannot be started: not enough bandwidth";
    refused(
        "realsense::camera::no_bandwidth",
        "no bandwidth",
        words,
        "same hub",
    );
}

#[test]
fn no_depth() {
    refused(
        "realsense::camera::no_depth",
        "no depth",
        "has no depth",
        "firmware",
    );
}

#[test]
fn a_camera_that_may_get_its_firmware_is_tried_again() {
    let test = "realsense::camera::a_camera_that_may_get_its_firmware_is_tried_again";
    with_cameras(test, "no depth", || {
        let error = open_camera().err().expect("no depth");
        assert_eq!(error.recovery(), Recovery::Reopen);
    });
}

#[test]
fn a_lens_that_cannot_be_held() {
    let test = "realsense::camera::a_lens_that_cannot_be_held";
    refused(test, "lens", "inverse Brown-Conrady", "D400");
}

#[test]
fn no_unit_of_depth() {
    let words = "a unit of depth of 0 m";
    refused(
        "realsense::camera::no_unit_of_depth",
        "no unit",
        words,
        "calibration",
    );
}

#[test]
fn a_frame_that_is_not_as_large_as_its_mode() {
    let test = "realsense::camera::a_frame_that_is_not_as_large_as_its_mode";
    refused(test, "cut", "848×479 pixels", "cable");
}

#[test]
fn a_frame_without_all_its_bytes() {
    let test = "realsense::camera::a_frame_without_all_its_bytes";
    refused(test, "short", "1760 in all", "cable");
}

#[test]
fn a_queue_that_fails() {
    let words = "was lost: the queue is broken";
    refused(
        "realsense::camera::a_queue_that_fails",
        "crash",
        words,
        "cable",
    );
}

#[test]
fn another_version_of_the_library() {
    let test = "realsense::camera::another_version_of_the_library";
    let words = "cannot be started: API version mismatch";
    refused(test, "other version", words, "newer librealsense 2");
}

#[test]
fn no_presets() {
    let test = "realsense::camera::no_presets";
    with_cameras(test, "no presets", || {
        let error = open_text("realsense,preset=Default").err().expect("none");
        assert!(error.to_string().ends_with("\"Default\""), "{error}");
        assert!(error.advice().contains("out"), "{}", error.advice());
        next_frame(open_camera().expect("opens").as_mut());
    });
}
