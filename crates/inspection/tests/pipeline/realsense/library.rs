//! The library itself is missing, or is another one.

use std::fs;

use capture::CameraErrorKind;
use geometry::error::Advice as _;

use capture::fixtures::{SHARED, camera_error, compile_c};

use crate::{
    own_process::{self, is_own},
    played_camera::is_listed,
    realsense::{listed, open_text, skipped},
};

#[test]
fn the_systems_library_is_found_by_itself_or_told_to_be_absent() {
    let test = "realsense::library::the_systems_library_is_found_by_itself_or_told_to_be_absent";
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    is_listed(
        listed(),
        &["librealsense2", "https://", "PARTSIGHT_REALSENSE"],
    );
}

#[test]
fn a_place_without_the_library_and_other_libraries_are_told_apart() {
    let test = "realsense::library::a_place_without_the_library_and_other_libraries_are_told_apart";
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let source = format!("realsense,library={}", folder.path().display());
    let open_error = || camera_error(open_text(&source).err().expect("does not open"));
    let error = open_error();
    assert!(
        matches!(
            &error.kind,
            CameraErrorKind::LibraryMissing { path: Some(path) } if path == folder.path()
        ),
        "{error}"
    );
    assert!(
        error.advice().contains("PARTSIGHT_REALSENSE"),
        "{}",
        error.advice()
    );

    let library = folder.path().join("librealsense2.so.2.54");
    fs::write(&library, "no library").expect("written");
    let error = open_error();
    assert!(
        matches!(error.kind, CameraErrorKind::LibraryNotLoaded { .. }),
        "{error}"
    );

    // The newer library takes precedence.
    let library = folder.path().join("librealsense2.so.2.55");
    if let Err(why) = compile_c(
        "crates/inspection/tests/pipeline/realsense/python.c",
        &library,
        &SHARED,
    ) {
        return skipped("PARTSIGHT_REQUIRE_COMPILER", &why);
    }
    let error = open_error();
    let text = error.to_string();
    assert!(
        text.contains("2.55 has no function rs2_get_error_message"),
        "{text}"
    );
}
