//! What tests of this crate and of those above it build.

use std::{env, ffi::OsString, path::Path, process::Command, time::Instant};

use geometry::fixtures::small_frame;
use jiff::{SignedDuration, Timestamp};

use crate::{
    CameraError, CameraLibrary, CaptureError, Captured, Image, SourceListing, SourceSpec, list,
};

/// The time this many seconds after a fixed one.
pub fn moment(seconds: i64) -> Timestamp {
    let first: Timestamp = "2026-03-01T06:00:00Z".parse().expect("a time");
    first + SignedDuration::from_secs(seconds)
}

/// The error of a camera, its library or its file; any other fails the test.
pub fn camera_error(error: CaptureError) -> CameraError {
    match error {
        CaptureError::Camera(error) => error,
        other => panic!("{other}"),
    }
}

/// The sources of a library, including those that cannot be opened.
pub fn listed_by(
    library: &CameraLibrary,
    is_of_library: impl Fn(&SourceSpec) -> bool,
) -> Vec<SourceListing> {
    let listed = list().into_iter();
    let of_library = listed.filter(|listed| match (&listed.spec, &listed.error) {
        (Some(spec), _) => is_of_library(spec),
        (None, Some(error)) => error.library == library,
        (None, None) => false,
    });
    of_library.collect()
}

/// A capture of one pixel, arriving now.
pub fn captured(number: u64, taken_at: Timestamp) -> Captured {
    Captured {
        number,
        name: format!("frame {number}"),
        taken_at,
        arrived: Instant::now(),
        image: Image::Depth(small_frame(1, [1])),
        is_simulated: false,
        truth: None,
        robot_from_flange: None,
        warnings: Vec::new(),
    }
}

/// Options of [`compile_c`] that make a shared library.
pub const SHARED: [&str; 2] = ["-shared", "-fPIC"];

/// Compiles a C file, named from the root of the workspace, to a program, or with [`SHARED`] to a library. The error names
/// what this machine lacks.
pub fn compile_c(source: &str, made: &Path, options: &[&str]) -> Result<(), String> {
    let source = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(source);
    assert!(source.exists(), "{}", source.display());
    let compiler = env::var_os("CC").unwrap_or_else(|| OsString::from("cc"));
    let output = Command::new(compiler)
        .args(["-Wall", "-Wextra", "-Werror", "-pthread"])
        .args(options)
        .arg("-o")
        .arg(made)
        .arg(source)
        .arg("-ldl")
        .output()
        .map_err(|error| format!("no C compiler: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    // Missing headers of the C library are a fault of the machine; any other error is a fault of the file.
    assert!(message.contains("No such file or directory"), "{message}");
    Err("no C headers".into())
}
