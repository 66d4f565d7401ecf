//! Cameras that work or fail.

use std::time::Duration;

use capture::{CameraErrorKind, NextCapture, OpenNiSpec, Recovery, SourceSpec, open};

use crate::{
    openni::{check, listed, open_camera, with_camera},
    played_camera::{is_lost_and_found_again, is_refused, next_frame},
};

/// Checks frames of a camera whose mirroring is on at first, whether or not it can be switched off.
fn shows_what_it_saw(test: &str, state: &str, metres_per_unit: f64) {
    with_camera(
        test,
        state,
        |_| {},
        || {
            let mut camera = open_camera().expect("opens");
            assert_eq!(camera.title(), "Partsight Stub camera stub@1");
            assert!(!camera.is_simulated());
            let mut before = 0;
            for _ in 0..3 {
                let frame = next_frame(camera.as_mut());
                assert!((frame.metres_per_unit - metres_per_unit).abs() < 1e-9);
                let number = check(&frame, 64, 48);
                assert!(number > before, "{number} after {before}");
                before = number;
            }
            drop(camera);
            next_frame(open_camera().expect("opens again").as_mut());
        },
    );
}

#[test]
fn depth_comes_in_metres_and_the_right_way_round() {
    shows_what_it_saw(
        "openni::camera::depth_comes_in_metres_and_the_right_way_round",
        "well",
        0.001,
    );
}

#[test]
fn a_picture_that_stays_mirrored_is_turned_back() {
    shows_what_it_saw(
        "openni::camera::a_picture_that_stays_mirrored_is_turned_back",
        "stuck",
        0.001,
    );
}

#[test]
fn a_picture_that_is_not_mirrored_stays_as_it_is() {
    shows_what_it_saw(
        "openni::camera::a_picture_that_is_not_mirrored_stays_as_it_is",
        "upright",
        0.001,
    );
}

#[test]
fn tenths_of_a_millimetre_are_read() {
    shows_what_it_saw(
        "openni::camera::tenths_of_a_millimetre_are_read",
        "fine",
        0.0001,
    );
}

#[test]
fn a_camera_is_listed_and_opened_by_its_uri() {
    with_camera(
        "openni::camera::a_camera_is_listed_and_opened_by_its_uri",
        "well",
        |_| {},
        || {
            let found = listed();
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].title, "Partsight Stub camera stub@1");
            let spec = found[0].spec.clone().expect("can be opened");
            assert_eq!(spec.to_string(), "openni:stub@1");
            let mut camera = open(&spec).expect("opens");
            next_frame(camera.as_mut());

            let error = listed().pop().and_then(|last| last.error).expect("in use");
            assert_eq!(error.kind, CameraErrorKind::InUse);
            next_frame(camera.as_mut());
            drop(camera);

            for uri in ["stub@2", "stub", "stub@1\0"] {
                let spec = OpenNiSpec {
                    device: Some(uri.into()),
                    ..OpenNiSpec::default()
                };
                let error = open(&SourceSpec::OpenNi(spec)).err().expect("another");
                assert!(error.to_string().contains("only stub@1"), "{error}");
                assert_eq!(error.recovery(), Recovery::Reopen);
            }
        },
    );
}

#[test]
fn an_unplugged_camera_is_lost_and_found_again() {
    with_camera(
        "openni::camera::an_unplugged_camera_is_lost_and_found_again",
        "unplugged",
        |_| {},
        || {
            is_lost_and_found_again(SourceSpec::OpenNi(OpenNiSpec::default()));
        },
    );
}

#[test]
fn a_camera_that_sends_nothing_is_waited_for() {
    with_camera(
        "openni::camera::a_camera_that_sends_nothing_is_waited_for",
        "silent",
        |_| {},
        || {
            let mut camera = open_camera().expect("opens");
            let next = camera
                .next(Duration::from_millis(5))
                .expect("no problem yet");
            assert!(matches!(next, NextCapture::NotYet), "{next:?}");
        },
    );
}

/// Checks message and advice in a state in which the camera does not open, or stops after its first frames.
fn refused(test: &str, state: &str, words: &str, advice: &str) {
    with_camera(
        test,
        state,
        |_| {},
        || {
            is_refused(&SourceSpec::OpenNi(OpenNiSpec::default()), words, advice);
        },
    );
}

#[test]
fn no_camera() {
    refused(
        "openni::camera::no_camera",
        "no camera",
        "no OpenNI camera is plugged in",
        "Plug the camera in",
    );
}

#[test]
fn busy() {
    refused(
        "openni::camera::busy",
        "busy",
        "cannot be opened",
        "Close other programs",
    );
}

#[test]
fn no_bandwidth() {
    refused(
        "openni::camera::no_bandwidth",
        "no bandwidth",
        "cannot be started",
        "another USB socket",
    );
}

#[test]
fn steps_of_disparity() {
    refused(
        "openni::camera::steps_of_disparity",
        "shifts",
        "neither in millimetres",
        "in millimetres",
    );
}

#[test]
fn no_field_of_view() {
    refused(
        "openni::camera::no_field_of_view",
        "no view",
        "field of view",
        "driver",
    );
}

#[test]
fn mirroring_that_is_not_told() {
    refused(
        "openni::camera::mirroring_that_is_not_told",
        "untold",
        "is mirrored",
        "wrong poses",
    );
}

#[test]
fn mirroring_that_changes() {
    refused(
        "openni::camera::mirroring_that_changes",
        "turned",
        "has changed",
        "as they are",
    );
}

#[test]
fn a_part_of_the_picture() {
    refused(
        "openni::camera::a_part_of_the_picture",
        "cropped",
        "a part of its picture",
        "cropping off",
    );
}
