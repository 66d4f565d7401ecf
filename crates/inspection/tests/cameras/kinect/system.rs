//! The system's own libfreenect, with or without a Kinect.

use capture::{CameraLibraryError, CaptureError, KinectError, KinectSpec, SourceSpec, open};
use geometry::error::Advice as _;

use crate::{
    kinect::{listed, skipped, trouble_of},
    own_process::{self, is_own},
};

#[test]
fn the_systems_library_is_found_by_itself_and_says_whether_a_kinect_is_there() {
    let test = "kinect::system::the_systems_library_is_found_by_itself_and_says_whether_a_kinect_is_there";
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    let kinects = listed();
    assert!(!kinects.is_empty());
    for kinect in kinects {
        let Some(error) = kinect.trouble else {
            assert!(kinect.spec.is_some());
            continue;
        };
        assert!(kinect.spec.is_none());
        println!("figures: {}: {error}. {}", kinect.title, error.advice());
        match trouble_of(error) {
            KinectError::Library(CameraLibraryError::NotInstalled { .. }) => {
                skipped("libfreenect is not installed");
            }
            // The errors of a machine without a Kinect, without USB, or without permission.
            KinectError::NoDevice
            | KinectError::NoUsb { .. }
            | KinectError::NoPermission { .. } => {}
            error => panic!("{error}"),
        }
    }
}

#[test]
fn a_place_without_the_library_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let library = Some(folder.path().to_path_buf());
    let error = open(&SourceSpec::Kinect(KinectSpec {
        serial: None,
        library,
    }))
    .err();
    let error: CaptureError = error.expect("nothing there");
    assert!(
        error
            .to_string()
            .contains(&folder.path().display().to_string()),
        "{error}"
    );
    assert!(
        error.advice().contains("PARTSIGHT_FREENECT"),
        "{}",
        error.advice()
    );
}
