//! Runs the fuzz targets on their seeds, whole, cut, and with a byte changed: they build and do not panic.

#![allow(clippy::pedantic, reason = "the folder is a crate of its own")]

#[allow(dead_code, reason = "its `main` is called on the command line")]
#[path = "../../fuzz/seeds.rs"]
mod seeds;
#[path = "../../fuzz/targets.rs"]
mod targets;

use std::fs;

#[test]
fn every_target_takes_its_seeds() {
    let folder = tempfile::tempdir().expect("a folder");
    seeds::fill(folder.path()).expect("seeds");
    for (name, target) in [
        ("open", targets::open as fn(&[u8])),
        ("texts", targets::texts),
        ("requests", targets::requests),
        ("streams", targets::streams),
        ("inspect", targets::inspect),
    ] {
        let mut num = 0;
        for seed in fs::read_dir(folder.path().join(name)).expect("its seeds") {
            let path = seed.expect("a seed").path();
            // Every file is a seed, including the camera beside a depth image.
            let bytes = fs::read(&path).expect("read");
            target(&bytes);
            target(&bytes[..bytes.len() / 2]);
            let mut other = bytes;
            let middle = other.len() / 3;
            other[middle] ^= 0x15;
            target(&other);
            num += 1;
        }
        assert!(num > 8, "{num} seeds of {name}");
    }
}
