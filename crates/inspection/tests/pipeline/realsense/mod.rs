//! RealSense tests without a camera: a stub library that plays two, and librealsense itself with files that it
//! records of a software camera.
//!
//! A loaded library stays in its process with all its state, so every test has a process of its own. Without a C
//! compiler the tests report that they are skipped. Those with librealsense itself need a file that has its
//! functions, named by `PARTSIGHT_TEST_REALSENSE`: librealsense2.so, or the module `pyrealsense2.*.so` of the Python
//! package, which contains the library. With `PARTSIGHT_REQUIRE_REALSENSE=1` they fail if it is missing.

mod camera;
mod library;
mod recorded;

use crate::own_process;
use std::ffi::OsStr;

use capture::fixtures::{SHARED, compile_c, listed_by};
use capture::{
    CaptureError, DepthSource, REALSENSE, RealsenseSpec, SourceListing, SourceSpec, open,
};
use geometry::{depth_frame::DepthFrame, fixtures::skipped};

/// Source of a stub library with the functions of librealsense, which plays two cameras.
const CAMERA: &str = "crates/inspection/tests/pipeline/realsense/camera.c";
/// Runs a test's body with the cameras in that state; see `camera.c`.
fn with_cameras(test: &str, state: &str, body: impl FnOnce()) {
    if own_process::is_own(test) {
        return body();
    }
    let folder = tempfile::tempdir().expect("a folder");
    let library = folder.path().join("librealsense2.so.2.55");
    if let Err(why) = compile_c(CAMERA, &library, &SHARED) {
        return skipped("PARTSIGHT_REQUIRE_COMPILER", &why);
    }
    let environment: [(&str, &OsStr); 2] = [
        ("PARTSIGHT_REALSENSE", folder.path().as_os_str()),
        ("STUB", OsStr::new(state)),
    ];
    own_process::run(test, &environment);
}

/// Opens the first camera.
fn open_camera() -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&SourceSpec::Realsense(RealsenseSpec::default()))
}

fn open_text(text: &str) -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&text.parse().expect("a source"))
}

/// The RealSense cameras in the list of sources.
fn listed() -> Vec<SourceListing> {
    listed_by(&REALSENSE, |spec| matches!(spec, SourceSpec::Realsense(_)))
}

/// Checks every pixel of a frame except those that `camera.c` changes from frame to frame. Returns the frame's
/// number.
fn check(frame: &DepthFrame, width: usize, height: usize) -> u16 {
    let camera = frame.intrinsics;
    assert_eq!((camera.width, camera.height), (width, height));
    assert_eq!(frame.depth.len(), width * height);
    for (index, &depth) in frame.depth.iter().enumerate() {
        let (column, row) = (index % width, index / width);
        let expected = match (column, row) {
            (5, 7) | (11, 3) => continue,
            (9, 3) => 0,
            _ => 1000 + 3 * column + row,
        };
        assert_eq!(usize::from(depth), expected, "column {column}, row {row}");
    }
    frame.depth[7 * width + 5]
}
