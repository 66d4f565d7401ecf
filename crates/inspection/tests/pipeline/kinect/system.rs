//! The system's own libfreenect, with or without a Kinect.

use capture::{CameraErrorKind, KinectSpec, SourceSpec, fixtures::camera_error, open};
use geometry::error::Advice as _;

use crate::{
    kinect::{listed, skipped},
    own_process::{self, is_own},
};

#[test]
fn the_systems_library_is_found_by_itself_and_says_whether_a_kinect_is_there() {
    let test =
        "kinect::system::the_systems_library_is_found_by_itself_and_says_whether_a_kinect_is_there";
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    let kinects = listed();
    assert!(!kinects.is_empty());
    for kinect in kinects {
        let Some(error) = kinect.error else {
            assert!(kinect.spec.is_some());
            continue;
        };
        assert!(kinect.spec.is_none());
        println!("figures: {}: {error}. {}", kinect.title, error.advice());
        match error.kind {
            CameraErrorKind::LibraryMissing { path: None } => {
                skipped("PARTSIGHT_REQUIRE_KINECT", "libfreenect is not installed");
            }
            // The errors of a machine without a Kinect, without USB, or without permission.
            CameraErrorKind::NoDevice { wanted: None, .. }
            | CameraErrorKind::LibraryNotStarted
            | CameraErrorKind::NoPermission { .. } => {}
            kind => panic!("{kind:?}"),
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
    let error = camera_error(error.expect("nothing there"));
    assert!(matches!(
        error.kind,
        CameraErrorKind::LibraryMissing { path: Some(_) }
    ));
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
