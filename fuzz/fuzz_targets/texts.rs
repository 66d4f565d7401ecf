//! Everything that is read from a text beside a capture: cameras, calibrations, poses, spray paths, sequences.

#![no_main]

use std::{
    fs::{self, File},
    time::SystemTime,
};

use libfuzzer_sys::fuzz_target;
use partsight::{
    SprayPath,
    capture::Replay,
    files::DepthCamera,
    robot::{
        calibration::CellCalibration,
        pairs::{PairConventions, read_arm_poses, read_pairs},
    },
};

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("depth.txt");
    fs::write(&path, bytes).expect("written");
    // A reader would wait until the file has settled.
    let file = File::options().write(true).open(&path).expect("there");
    file.set_modified(SystemTime::UNIX_EPOCH).expect("set");
    let _ = DepthCamera::read(&path);
    let _ = CellCalibration::load(&path);
    let _ = read_pairs(&path, PairConventions::default());
    let _ = read_arm_poses(&path, None);
    let _ = SprayPath::read(&path);
    let spec = format!("recording:{}", folder.path().display());
    if let Ok(partsight::SourceSpec::Recording(spec)) = spec.parse() {
        let _ = Replay::open(&spec);
    }
});
