//! Kinect tests without a Kinect: a recorded session played by the fakenect build of libfreenect, a stub library that
//! behaves like the real one with a working or failing camera, and the system's libfreenect itself.
//!
//! A loaded library stays in its process with all its state, so every test has a process of its own. Without the
//! libraries (`apt-get install libfreenect0.5`) or a C compiler the tests report that they are skipped; with
//! `PARTSIGHT_REQUIRE_KINECT=1` they fail.

mod camera;
mod cycles;
mod played;
mod session;
mod system;

use std::path::PathBuf;

use capture::{
    CameraError, CaptureError, DepthSource, FREENECT, KinectSpec, SourceListing, SourceSpec,
    fixtures::{camera_error, listed_by},
    open,
};
use geometry::fixtures::skipped;

/// Opens the Kinect that the environment provides.
fn open_kinect() -> Result<Box<dyn DepthSource>, CaptureError> {
    open(&SourceSpec::Kinect(KinectSpec::default()))
}

/// Returns why the Kinect does not open.
fn open_error() -> CameraError {
    camera_error(open_kinect().err().expect("does not open"))
}

/// The Kinects in the list of sources, including those that cannot be opened.
fn listed() -> Vec<SourceListing> {
    listed_by(&FREENECT, |spec| matches!(spec, SourceSpec::Kinect(_)))
}

/// The folder with the fakenect build; `None`, with a message, if it is not installed.
fn fakenect() -> Option<PathBuf> {
    let lib = PathBuf::from("/usr/lib");
    let of_machine = format!("{}-linux-gnu/fakenect", std::env::consts::ARCH);
    let folders = [
        lib.join(of_machine),
        lib.join("fakenect"),
        "/usr/lib64/fakenect".into(),
    ];
    let folder = folders
        .into_iter()
        .find(|folder| folder.join("libfreenect.so.0.5").is_file());
    if folder.is_none() {
        skipped(
            "PARTSIGHT_REQUIRE_KINECT",
            "the fakenect build of libfreenect is not installed (apt-get install libfreenect0.5)",
        );
    }
    folder
}
