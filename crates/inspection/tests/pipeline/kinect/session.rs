//! Writes a session as libfreenect's `fakenect-record` does.

use std::{fs, path::Path};

use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
};
use simulate::{CellSetup, PartKind, PartPose, PoseRange, Side, SimulatedObject, frame};

/// Distance between a Kinect's projector and camera, cm.
const BASELINE: f64 = 7.5;
/// Distance of the reference plane, cm.
const REFERENCE: f64 = 120.0;
/// Width of a pixel (1280 across) on that plane, cm.
const PIXEL: f64 = 0.1042;
/// No reading.
const NOTHING: u16 = 2047;

/// The camera with these values.
pub(crate) const CAMERA: Intrinsics = Intrinsics {
    width: 640,
    height: 480,
    fx: 575.8157,
    fy: 575.8157,
    cx: 320.0,
    cy: 240.0,
    distortion: Distortion::NONE,
};

/// Frames of such a camera in the simulated cell: a fender, nothing, a front door.
pub(crate) fn frames() -> Vec<DepthFrame> {
    let part = |kind| {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, 5);
        setup.pose = PartPose::Drawn(PoseRange::facing());
        setup
    };
    let setups = [
        part(PartKind::Fender),
        CellSetup::new(SimulatedObject::Nothing, 6),
        part(PartKind::FrontDoor),
    ];
    let seen = setups.into_iter().map(|mut setup| {
        setup.intrinsics = CAMERA;
        frame(&setup).frame
    });
    seen.collect()
}

/// Writes one frame so often that no test reaches the end.
pub(crate) fn write_endless(folder: &Path, frame: &DepthFrame) {
    write(folder, std::slice::from_ref(frame), 0.0);
    let index = folder.join("INDEX.txt");
    let line = fs::read_to_string(&index).expect("an index");
    fs::write(&index, line.repeat(20_000)).expect("written");
}

/// Writes frames in steps of disparity, `apart` seconds apart.
pub(crate) fn write(folder: &Path, frames: &[DepthFrame], apart: f64) {
    let mut index = String::new();
    for (k, frame) in frames.iter().enumerate() {
        let seconds = 1_290_000_000.0 + apart * k as f64;
        let name = format!("d-{seconds:.6}-{}.pgm", 2_000_000 * (k + 1));
        let mut bytes = b"P5 640 480 65535\n".to_vec();
        for &value in &frame.depth {
            let millimetres = f64::from(value) * frame.metres_per_unit * 1000.0;
            bytes.extend(step(millimetres).to_ne_bytes());
        }
        fs::write(folder.join(&name), bytes).expect("written");
        index += &name;
        index.push('\n');
    }
    fs::write(folder.join("INDEX.txt"), index).expect("written");
}

/// The step of disparity that a Kinect gives for a distance; 0 is no reading.
pub(crate) fn step(millimetres: f64) -> u16 {
    let shift = BASELINE * (1.0 - REFERENCE / (millimetres / 10.0));
    let step = 4.0 * (shift / PIXEL + 0.375) + 800.0;
    if millimetres > 0.0 && step >= 0.0 && step < f64::from(NOTHING) {
        step.round() as u16
    } else {
        NOTHING
    }
}

/// Distance between two steps at this depth, mm.
pub(crate) fn step_width(millimetres: f64) -> f64 {
    millimetres.powi(2) * PIXEL / (4.0 * 10.0 * BASELINE * REFERENCE)
}
