//! The simulated cell as a camera: frames at its own rate, each following from the settings and its number alone.

use std::{
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use super::{
    error::CaptureError,
    source::{Captured, DepthSource, Image, Next},
    spec::{CellScene, SimulatedSpec},
};
use crate::{
    geometry::mesh::TriangleMesh,
    simulate::{CellSetup, PartPose, Subject, Truth, frame_of_mesh},
};

/// The simulated cell as a camera.
pub struct SimulatedCell {
    spec: SimulatedSpec,
    mesh: TriangleMesh,
    started: Instant,
    /// Of the frame given last, from 1; 0 before the first.
    number: u64,
}

impl SimulatedCell {
    /// A cell whose first frame is due now.
    pub fn new(spec: SimulatedSpec) -> Self {
        let mesh = subject(&spec).mesh();
        Self {
            spec,
            mesh,
            started: Instant::now(),
            number: 0,
        }
    }

    /// The frame of this number, counted from 1.
    pub fn frame(&self, number: u64) -> (Image, Truth) {
        let mut setup = CellSetup::new(subject(&self.spec), self.spec.seed);
        setup.pose = match self.spec.pose.placement() {
            Ok(range) => PartPose::Drawn(range),
            Err(pose) => PartPose::Fixed(pose),
        };
        setup.clutter = self.spec.clutter;
        setup.noise.multiplier = self.spec.noise;
        setup.noise.seed = self
            .spec
            .seed
            .wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let simulated = frame_of_mesh(&setup, &self.mesh);
        (
            Image::Depth(simulated.frame),
            Truth {
                labels: Vec::new(),
                ..simulated.truth
            },
        )
    }
}

fn subject(spec: &SimulatedSpec) -> Subject {
    match spec.scene {
        CellScene::Line { .. } => Subject::Nothing,
        CellScene::Part(kind) => Subject::Part {
            kind,
            side: spec.side,
            model_seed: spec.model,
        },
        CellScene::Object(kind) => Subject::Object(kind),
        CellScene::Empty => Subject::Nothing,
    }
}

impl DepthSource for SimulatedCell {
    fn title(&self) -> String {
        self.spec.title()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, wait: Duration) -> Result<Next, CaptureError> {
        let due = self.started
            + Duration::from_secs_f64(self.number as f64 / self.spec.frames_per_second);
        let left = due.saturating_duration_since(Instant::now());
        thread::sleep(left.min(wait));
        if left > wait {
            return Ok(Next::NotYet);
        }
        self.number += 1;
        let (image, truth) = self.frame(self.number);
        Ok(Next::Captured(Captured {
            number: self.number,
            name: format!("simulated frame {}", self.number),
            taken_at: Timestamp::now(),
            arrived: Instant::now(),
            image,
            is_simulated: true,
            truth: Some(Arc::new(truth)),
            warnings: Vec::new(),
        }))
    }
}
