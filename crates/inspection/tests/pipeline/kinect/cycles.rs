//! Opening and closing a camera a thousand times leaks nothing.

use std::{ffi::OsStr, fs};

use capture::DepthSource;

use crate::{
    kinect::{fakenect, open_kinect, session},
    own_process::{self, is_own},
    played_camera::next_capture,
};

const NUM_CYCLES: usize = 1000;
/// After these cycles the allocator and the libraries have all that they keep.
const NUM_WARM_UP: usize = 50;
/// Largest growth allowed: a leaked frame per cycle would be 600 000 kB, a hundred bytes 100 kB.
const MOST_GROWTH_KB: u64 = 100;

/// Resources of a process.
#[derive(Debug)]
struct Held {
    memory_kb: u64,
    num_threads: u64,
    num_files: usize,
}

impl Held {
    fn now() -> Self {
        // `smaps_rollup` counts page by page; `status` is off by some hundred kB. Only anonymous memory counts: pages
        // of files are loaded as code first runs.
        let memory = fs::read_to_string("/proc/self/smaps_rollup").expect("of this process");
        let status = fs::read_to_string("/proc/self/status").expect("of this process");
        let number = |text: &str, name: &str| {
            let line = text
                .lines()
                .find_map(|line| line.strip_prefix(name))
                .expect("a line");
            let digits = line.trim().split(' ').next().expect("a number");
            digits.parse().expect("a number")
        };
        Self {
            memory_kb: number(&memory, "Anonymous:"),
            num_threads: number(&status, "Threads:"),
            num_files: fs::read_dir("/proc/self/fd")
                .expect("of this process")
                .count(),
        }
    }
}

#[test]
fn a_thousand_times_opened_and_closed_leaks_nothing() {
    let test = "kinect::cycles::a_thousand_times_opened_and_closed_leaks_nothing";
    if !is_own(test) {
        let Some(library) = fakenect() else { return };
        let folder = tempfile::tempdir().expect("a folder");
        session::write_endless(folder.path(), &session::frames()[1]);
        let environment: [(&str, &OsStr); 4] = [
            // Frame buffers are returned to the system at once, so that one more or less does not count as growth.
            ("MALLOC_MMAP_THRESHOLD_", OsStr::new("65536")),
            ("MALLOC_ARENA_MAX", OsStr::new("1")),
            ("PARTSIGHT_FREENECT", library.as_os_str()),
            ("FAKENECT_PATH", folder.path().as_os_str()),
        ];
        return own_process::run(test, &environment);
    }
    let cycle = || {
        let mut kinect: Box<dyn DepthSource> = open_kinect().expect("a session");
        next_capture(kinect.as_mut())
            .expect("no problem")
            .expect("a frame");
    };
    (0..NUM_WARM_UP).for_each(|_| cycle());
    let before = Held::now();
    (0..NUM_CYCLES).for_each(|_| cycle());
    let after = Held::now();
    println!("figures: {before:?}, after {NUM_CYCLES} cycles {after:?}");
    assert_eq!(after.num_files, before.num_files);
    assert_eq!(after.num_threads, before.num_threads);
    assert!(after.memory_kb <= before.memory_kb + MOST_GROWTH_KB);
}
