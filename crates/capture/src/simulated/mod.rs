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

use self::conveyor::{ConveyorState, PART_START_DISTANCE_M, RACK_START_DISTANCE_M};
use super::{
    error::CaptureError,
    source::{Captured, DepthSource, Image, NextCapture},
    spec::{CellScene, NUM_ON_RACK, SimulatedSpec},
};
use geometry::rigid::RigidTransform;
use simulate::{
    CellSetup, FrameTruth, LineSetup, PartKind, PartPose, RackKind, RackSetup, SensorNoise,
    SimulatedFrame, SimulatedLine, SimulatedObject, StandingCell, StandingRack,
};

/// The simulated cell as a camera.
pub struct SimulatedCell {
    spec: SimulatedSpec,
    /// The present cell, and the number of the part or rack for which it was arranged.
    cell: Option<(u64, ArrangedCell)>,
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

    /// Returns the frame with this number, from 1: always the same for the same settings. The truth has no labels; there is none
    /// of a rack or a line that runs without a stop, which show several parts.
    pub fn frame(&mut self, number: u64) -> (Image, Option<FrameTruth>) {
        let seconds = number.saturating_sub(1) as f64 / self.spec.frames_per_second;
        let moment = match self.spec.scene {
            CellScene::Line { every } | CellScene::Rack { every } => {
                Some(ConveyorState::at(seconds, every))
            }
            CellScene::Conveyor { .. }
            | CellScene::Part(_)
            | CellScene::Object(_)
            | CellScene::Empty => None,
        };
        let visit = moment.map_or(0, |moment| moment.visit);
        let cell = match self.cell.take() {
            Some((arranged, cell)) if arranged == visit => cell,
            _ => ArrangedCell::arrange(&self.spec, visit),
        };
        let noise = SensorNoise {
            multiplier: self.spec.noise,
            seed: mixed(self.spec.seed, number),
        };
        let placed = |rest_pose: &RigidTransform, from_m| {
            moment.map_or(*rest_pose, |now| now.camera_from_part(rest_pose, from_m))
        };
        let (frame, truth) = match &cell {
            ArrangedCell::One(cell) => {
                let camera_from_part = placed(&cell.rest_pose(), PART_START_DISTANCE_M);
                let SimulatedFrame { frame, truth } = cell.frame(&camera_from_part, &noise);
                let truth = FrameTruth {
                    labels: Vec::new(),
                    ..truth
                };
                (frame, Some(truth))
            }
            ArrangedCell::Rack(rack) => {
                let moved = placed(&RigidTransform::identity(), RACK_START_DISTANCE_M);
                (rack.frame(|_| Some(moved), &noise), None)
            }
            ArrangedCell::Conveyor(line) => (line.frame(seconds, &noise), None),
        };
        self.cell = Some((visit, cell));
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

/// The cell with everything in it at rest.
enum ArrangedCell {
    One(StandingCell),
    Rack(StandingRack),
    Conveyor(SimulatedLine),
}

impl ArrangedCell {
    /// Arranges the cell with part or rack number `visit` of the line.
    fn arrange(spec: &SimulatedSpec, visit: u64) -> Self {
        let part = |kind| SimulatedObject::Part {
            kind,
            side: spec.side,
            model_seed: spec.model,
        };
        let subject = match spec.scene {
            CellScene::Rack { .. } => return Self::rack(spec, visit),
            CellScene::Conveyor { speed } => {
                let setup = LineSetup {
                    speed,
                    seed: spec.seed,
                    ..LineSetup::default()
                };
                return Self::Conveyor(SimulatedLine::arrange(&setup));
            }
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
        Self::One(StandingCell::arrange(&setup, mesh))
    }

    /// Wall and floor change with each rack: they stand behind and below its parts.
    fn rack(spec: &SimulatedSpec, visit: u64) -> Self {
        let seed = spec.seed.wrapping_add(visit);
        let drawn = RackSetup::drawn(RackKind::Apart, NUM_ON_RACK, spec.model, seed);
        let mut setup = drawn.expect("a rack has 2 to 5 places");
        setup.cell.clutter = spec.clutter;
        let rack = StandingRack::arrange(&setup);
        Self::Rack(rack.expect("a rack in a plain cell"))
    }
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
        let mut captured = Captured {
            truth: truth.map(Arc::new),
            ..Captured::now(number, name, image)
        };
        if let (CellScene::Conveyor { .. }, Some(started)) = (self.spec.scene, self.started) {
            // A busy computer draws a frame late; the parts were there when it was due.
            let due = started
                + Duration::from_secs_f64((number - 1) as f64 / self.spec.frames_per_second);
            let late = captured.arrived.saturating_duration_since(due);
            captured.taken_at -= late;
        }
        Ok(NextCapture::Captured(captured))
    }
}

#[cfg(test)]
mod tests;
