//! Every reader of clouds, meshes and depth images; the content decides which.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use partsight::files::{FileError, open_bytes};

fuzz_target!(|bytes: &[u8]| {
    let opened = open_bytes(Path::new("fuzzed"), bytes);
    if let Err(FileError::Fault { fault, .. }) = opened {
        panic!("{fault}");
    }
});
