//! OpenNI tests without a camera: the system's libOpenNI2 with a stub driver that plays one, and with files that the
//! library itself records of it.
//!
//! A loaded library stays in its process with all its state, so every test has a process of its own. Without the
//! library (`apt-get install libopenni2-0`) or a C compiler the tests report that they are skipped; with
//! `PARTSIGHT_REQUIRE_OPENNI=1` they fail.

mod camera;
mod library;
mod played;

use crate::own_process;
use std::{
    env,
    ffi::OsStr,
    fs,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
};

use capture::fixtures::{SHARED, compile_c, listed_by};
use capture::{CaptureError, DepthSource, OPENNI, OpenNiSpec, SourceListing, SourceSpec, open};
use geometry::{depth_frame::DepthFrame, fixtures::skipped};

/// Source of a stub driver for OpenNI's library, which plays a camera.
const CAMERA: &str = "crates/inspection/tests/pipeline/openni/camera.c";
/// Runs a test's body with the camera in that state; see `camera.c`. Before, `prepare` gets the folder of the
/// library.
fn with_camera(test: &str, state: &str, prepare: impl FnOnce(&Path), body: impl FnOnce()) {
    if own_process::is_own(test) {
        return body();
    }
    let folder = tempfile::tempdir().expect("a folder");
    if let Err(why) = install(folder.path()) {
        return skipped("PARTSIGHT_REQUIRE_OPENNI", &why);
    }
    prepare(folder.path());
    let environment: [(&str, &OsStr); 2] = [
        ("PARTSIGHT_OPENNI", folder.path().as_os_str()),
        ("STUB", OsStr::new(state)),
    ];
    own_process::run(test, &environment);
}

/// Puts the system's library into a folder, with its driver for files and the stub driver.
fn install(folder: &Path) -> Result<(), String> {
    let library =
        system_library().ok_or("libOpenNI2 is not installed (apt-get install libopenni2-0)")?;
    let (drivers, its_drivers) = (
        folder.join("OpenNI2/Drivers"),
        library.with_file_name("OpenNI2/Drivers"),
    );
    fs::create_dir_all(&drivers).expect("made");
    symlink(&library, folder.join("libOpenNI2.so.0")).expect("linked");
    let of_files = "libOniFile.so.0";
    symlink(its_drivers.join(of_files), drivers.join(of_files)).expect("linked");
    let driver = drivers.join("libCamera.so.0");
    compile_c(CAMERA, &driver, &SHARED)
}

/// The library of Debian's package.
fn system_library() -> Option<PathBuf> {
    let folder = format!("/usr/lib/{}-linux-gnu", env::consts::ARCH);
    let library = Path::new(&folder).join("libOpenNI2.so.0");
    library.is_file().then_some(library)
}

/// Opens the first camera.
fn open_camera() -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&SourceSpec::OpenNi(OpenNiSpec::default()))
}

/// The OpenNI cameras in the list of sources.
fn listed() -> Vec<SourceListing> {
    listed_by(&OPENNI, |spec| matches!(spec, SourceSpec::OpenNi(_)))
}

/// Checks that a frame shows what the camera saw, in metres and not mirrored. Returns its number, which one pixel
/// holds.
fn check(frame: &DepthFrame, width: usize, height: usize) -> usize {
    let camera = frame.intrinsics;
    assert_eq!((camera.width, camera.height), (width, height));
    assert_eq!(frame.depth.len(), width * height);
    // The focal length is half the width over the tangent of half the field of view: 1 rad across, 0.8 rad upright.
    let focal = [
        width as f64 / 2.0 / 0.5_f64.tan(),
        height as f64 / 2.0 / 0.4_f64.tan(),
    ];
    assert!((camera.fx - focal[0]).abs() < 1e-3 && (camera.fy - focal[1]).abs() < 1e-3);
    let millimetres = |column: usize, row: usize| {
        let metres = f64::from(frame.depth[row * width + column]) * frame.metres_per_unit;
        (metres * 1000.0).round() as usize
    };
    for row in 0..height {
        for column in 0..width {
            let expected = match (column, row) {
                (5, 7) => continue,
                (9, 3) => 0,
                _ => 1000 + 10 * column + row,
            };
            assert_eq!(
                millimetres(column, row),
                expected,
                "column {column}, row {row}"
            );
        }
    }
    millimetres(5, 7) - 500
}
