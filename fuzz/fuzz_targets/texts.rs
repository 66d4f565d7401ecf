//! Everything that is read from a text beside a capture: cameras, calibrations, poses, spray paths, recipes, lists of
//! recordings and sequences.

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
    pipeline::RecipeFile,
    robot::{
        calibration::CellCalibration,
        frame_poses::FramePoses,
        pairs::{PairConventions, read_arm_poses, read_pairs},
    },
};

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    // A recording's list begins with JSON; as a calibration it is read all the same.
    let list = if bytes.starts_with(b"{\"partsight") {
        "recording.jsonl"
    } else {
        "depth.txt"
    };
    let path = folder.path().join(list);
    fs::write(&path, bytes).expect("written");
    // A reader would wait until the file has settled.
    let file = File::options().write(true).open(&path).expect("there");
    file.set_modified(SystemTime::UNIX_EPOCH).expect("set");
    let _ = DepthCamera::read(&path);
    let _ = CellCalibration::load(&path);
    let _ = read_pairs(&path, PairConventions::default());
    let _ = read_arm_poses(&path, None);
    let _ = SprayPath::read(&path);
    let _ = FramePoses::read(&path, &["a.png".into(), "b.png".into()]);
    let _ = RecipeFile::read(&path);
    let spec = format!("recording:{}", folder.path().display());
    if let Ok(partsight::SourceSpec::Recording(spec)) = spec.parse() {
        let _ = Replay::open(&spec);
    }
});
