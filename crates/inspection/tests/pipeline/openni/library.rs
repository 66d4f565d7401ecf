//! The library itself: missing, another one, without drivers, and its effects on the process.

use std::{
    env, fs,
    os::unix::fs::symlink,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

use capture::{CameraError, CameraErrorKind, OpenNiSpec, SourceSpec, open};
use geometry::error::Advice as _;

use capture::fixtures::{SHARED, camera_error, compile_c};

use crate::{
    openni::{CAMERA, listed, skipped, system_library, with_camera},
    own_process::{self, is_own},
    played_camera::is_listed,
};

/// Returns why no camera opens with the library in this folder.
fn error_with(folder: &Path) -> CameraError {
    let spec = OpenNiSpec {
        library: Some(folder.to_path_buf()),
        ..OpenNiSpec::default()
    };
    camera_error(
        open(&SourceSpec::OpenNi(spec))
            .err()
            .expect("does not open"),
    )
}

#[test]
fn the_systems_library_is_found_by_itself_and_says_whether_a_camera_is_there() {
    let test = "openni::library::the_systems_library_is_found_by_itself_and_says_whether_a_camera_is_there";
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    if !is_listed(listed(), &["PARTSIGHT_OPENNI"]) {
        skipped(
            "PARTSIGHT_REQUIRE_OPENNI",
            "libOpenNI2 is not installed (apt-get install libopenni2-0)",
        );
    }
}

#[test]
fn a_place_without_the_library_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = error_with(folder.path());
    assert!(
        matches!(
            &error.kind,
            CameraErrorKind::LibraryMissing { path: Some(path) } if path == folder.path()
        ),
        "{error}"
    );
    assert!(
        error.advice().contains("PARTSIGHT_OPENNI"),
        "{}",
        error.advice()
    );

    fs::write(folder.path().join("libOpenNI2.so.0"), "no library").expect("written");
    let error = error_with(folder.path());
    assert!(
        matches!(error.kind, CameraErrorKind::LibraryNotLoaded { .. }),
        "{error}"
    );
}

#[test]
fn another_library_and_one_without_drivers_are_told_apart() {
    let test = "openni::library::another_library_and_one_without_drivers_are_told_apart";
    let Some(library) = system_library() else {
        return skipped(
            "PARTSIGHT_REQUIRE_OPENNI",
            "libOpenNI2 is not installed (apt-get install libopenni2-0)",
        );
    };
    if !is_own(test) {
        return own_process::run(test, &[]);
    }
    let folder = tempfile::tempdir().expect("a folder");
    symlink(library, folder.path().join("libOpenNI2.so.0")).expect("linked");
    for _ in 0..2 {
        let error = error_with(folder.path());
        assert_eq!(error.kind, CameraErrorKind::LibraryNotStarted, "{error}");
        assert!(error.to_string().contains("OpenNI2/Drivers"), "{error}");
    }

    let folder = tempfile::tempdir().expect("a folder");
    let other = folder.path().join("libOpenNI2.so.0");
    if let Err(why) = compile_c(CAMERA, &other, &SHARED) {
        return skipped("PARTSIGHT_REQUIRE_OPENNI", &why);
    }
    let error = error_with(folder.path());
    assert!(
        error.to_string().contains("no function oniInitialize"),
        "{error}"
    );
}

#[test]
fn threads_that_ended_are_not_asked_for() {
    let test = "openni::library::threads_that_ended_are_not_asked_for";
    with_camera(
        test,
        "well",
        |_| {},
        || {
            // A stack of this size goes back to the system with its thread.
            let builder = thread::Builder::new().stack_size(256 << 20);
            let thread = builder.spawn(|| listed().len()).expect("a thread");
            assert_eq!(thread.join().expect("ended"), 1);
            assert_eq!(listed().len(), 1);
        },
    );
}

#[test]
fn the_working_folder_of_other_threads_stays_while_the_library_starts() {
    let test =
        "openni::library::the_working_folder_of_other_threads_stays_while_the_library_starts";
    with_camera(
        test,
        "well",
        |_| {},
        || {
            let here = env::current_dir().expect("a folder");
            let is_over = Arc::new(AtomicBool::new(false));
            let watcher = {
                let (is_over, here) = (Arc::clone(&is_over), here.clone());
                thread::spawn(move || {
                    let mut num_elsewhere = 0;
                    while !is_over.load(Ordering::Relaxed) {
                        num_elsewhere +=
                            usize::from(env::current_dir().is_ok_and(|now| now != here));
                    }
                    num_elsewhere
                })
            };
            for _ in 0..50 {
                assert_eq!(listed().len(), 1);
            }
            is_over.store(true, Ordering::Relaxed);
            let num_elsewhere = watcher.join().expect("ended");
            assert_eq!(env::current_dir().expect("a folder"), here);
            let status = fs::read_to_string("/proc/self/status").expect("of this process");
            if num_elsewhere > 0 && !status.contains("Seccomp:\t0") {
                return skipped(
                    "PARTSIGHT_REQUIRE_OPENNI",
                    "this system may forbid a thread a working folder of its own",
                );
            }
            assert_eq!(num_elsewhere, 0);
        },
    );
}
