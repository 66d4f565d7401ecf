//! The simulated cell as a camera: frames at its own rate, each determined by the settings and its number.
//!
//! A camera that is read too slowly loses frames; here their numbers are skipped, so that the line runs at the same speed
//! on every machine.

mod conveyor;

use std::{
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use self::conveyor::ConveyorState;
use super::{
    error::CaptureError,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{CellScene, SimulatedSpec},
};
use simulate::{
    CellSetup, FrameTruth, PartKind, PartPose, SensorNoise, SimulatedFrame, SimulatedObject,
    StandingCell,
};

/// The simulated cell as a camera.
pub struct SimulatedCell {
    spec: SimulatedSpec,
    /// The present cell, and the number of the part for which it was arranged.
    cell: Option<(u64, StandingCell)>,
    /// When the first frame was due.
    started: Option<Instant>,
    /// Number of the last frame, from 1; 0 before the first.
    number: u64,
}

impl SimulatedCell {
    /// A cell whose first frame is due at the first request.
    pub fn new(spec: SimulatedSpec) -> Self {
        Self {
            spec,
            cell: None,
            started: None,
            number: 0,
        }
    }

    /// Returns the frame with this number, from 1: always the same for the same settings. The truth has no labels.
    pub fn frame(&mut self, number: u64) -> (Image, FrameTruth) {
        let seconds = number.saturating_sub(1) as f64 / self.spec.frames_per_second;
        let moment = match self.spec.scene {
            CellScene::Line { every } => Some(ConveyorState::at(seconds, every)),
            CellScene::Part(_) | CellScene::Object(_) | CellScene::Empty => None,
        };
        let visit = moment.map_or(0, |moment| moment.visit);
        let cell = match self.cell.take() {
            Some((arranged, cell)) if arranged == visit => cell,
            _ => arranged(&self.spec, visit),
        };
        let rest_pose = cell.rest_pose();
        let camera_from_part = moment.map_or(rest_pose, |now| now.camera_from_part(&rest_pose));
        let noise = SensorNoise {
            multiplier: self.spec.noise,
            seed: mixed(self.spec.seed, number),
        };
        let SimulatedFrame { frame, truth } = cell.frame(&camera_from_part, &noise);
        self.cell = Some((visit, cell));
        let truth = FrameTruth {
            labels: Vec::new(),
            ..truth
        };
        (Image::Depth(frame), truth)
    }

    /// Number of the next frame, and the time until it is due.
    fn due(&mut self, now: Instant) -> (u64, Duration) {
        let elapsed = now - *self.started.get_or_insert(now);
        let rate = self.spec.frames_per_second;
        // Last frame that is due by now. Of earlier ones only the one before it may still be delivered.
        let latest = (elapsed.as_secs_f64() * rate) as u64 + 1;
        let number = (self.number + 1).max(latest.saturating_sub(1));
        let at = Duration::from_secs_f64((number - 1) as f64 / rate);
        (number, at.saturating_sub(elapsed))
    }
}

/// Arranges the cell with part number `visit` of the line.
fn arranged(spec: &SimulatedSpec, visit: u64) -> StandingCell {
    let part = |kind| SimulatedObject::Part {
        kind,
        side: spec.side,
        model_seed: spec.model,
    };
    let subject = match spec.scene {
        CellScene::Line { .. } => {
            // Begin with a front door, as everywhere the program shows one part.
            let first = PartKind::FrontDoor as u64;
            part(PartKind::ALL[((first + visit) % PartKind::ALL.len() as u64) as usize])
        }
        CellScene::Part(kind) => part(kind),
        CellScene::Object(kind) => SimulatedObject::Object(kind),
        CellScene::Empty => SimulatedObject::Nothing,
    };
    let mesh = subject.mesh();
    let mut setup = CellSetup::new(subject, spec.seed);
    setup.clutter = spec.clutter;
    setup.pose = match spec.pose.placement() {
        // Wall and floor follow from the cell's seed, so keep it; each part hangs differently.
        Ok(range) => {
            let seed = spec.seed.wrapping_add(visit);
            let placed = range.draw(&mesh, &setup.intrinsics, seed);
            PartPose::Fixed(placed.camera_from_part)
        }
        Err(pose) => PartPose::Fixed(pose),
    };
    StandingCell::arrange(&setup, mesh)
}

/// A well-mixed seed for each frame and each seed of the cell (the finaliser of G. Steele, D. Lea and C. Flood, "Fast
/// Splittable Pseudorandom Number Generators", OOPSLA 2014).
fn mixed(seed: u64, number: u64) -> u64 {
    let mut z = seed.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Name of a frame, before its number.
const FRAME: &str = "simulated frame ";

/// Returns the number of the frame of the simulated cell that has this name.
pub fn simulated_frame_number(name: &str) -> Option<u64> {
    name.strip_prefix(FRAME)?.parse().ok()
}

impl DepthSource for SimulatedCell {
    fn title(&self) -> String {
        self.spec.title()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let (number, left) = self.due(Instant::now());
        thread::sleep(left.min(wait));
        if left > wait {
            return Ok(NextCapture::NotYet);
        }
        self.number = number;
        let (image, truth) = self.frame(number);
        let name = format!("{FRAME}{number}");
        Ok(NextCapture::Captured(Captured {
            truth: Some(Arc::new(truth)),
            ..Captured::now(number, name, image)
        }))
    }
}

#[cfg(test)]
mod tests;
