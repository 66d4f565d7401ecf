//! A camera on a simulated arm for robots that ask the server: it looks from where its robot says that it stands, so that a
//! robot's own program can be tried without a robot.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

use super::{ServoRunError, ServoSetup, ServoTarget, SimulatedTrial, trial::kind_of};
use crate::{Camera, NewFrame};
use capture::{
    BackpressurePolicy, CaptureError, Captured, CellScene, DepthSource, Feed, Image, NextCapture,
    SimulatedSpec, SourceSpec,
};
use geometry::{
    depth_frame::DepthFrame,
    error::lock,
    oriented_box::OrientedBox,
    rigid::{PoseDelta, RigidTransform},
};
use inspection::library::Library;
use robot::{RobotFrame, arm::PlacedArm, calibration::CameraPlace};
use serve::Asked;
use servo::{
    ServoParams, StopReason,
    simulated::{CellCamera, SimulatedArm},
};

/// A camera on a simulated arm.
pub struct CarriedCamera {
    arm: Arc<Mutex<SimulatedArm>>,
    cell: Arc<CellCamera>,
    trial: SimulatedTrial,
    period: Duration,
    scene: CellScene,
    /// Where the camera sits on the flange, as calibrated.
    place: CameraPlace,
    placed: PlacedArm,
    /// Work volume in the base frame.
    volume: Option<OrientedBox>,
}

impl CarriedCamera {
    /// Arranges a cell around a part of the library, with the arm at the start.
    pub fn arrange(
        part: &str,
        library: &Library,
        trial: SimulatedTrial,
    ) -> Result<Self, ServoRunError> {
        let cell = trial.arrange(part, library)?;
        Ok(Self {
            arm: Arc::new(Mutex::new(cell.arm())),
            trial,
            period: cell.setup().frame_period,
            scene: CellScene::Part(kind_of(part)?),
            place: cell.task.camera,
            placed: cell.placed_arm().clone(),
            volume: cell.fence.volume,
            cell: Arc::new(cell.into_camera()),
        })
    }

    /// Starts the camera.
    pub fn start(&self) -> Result<Camera, CaptureError> {
        let (arm, cell) = (Arc::clone(&self.arm), Arc::clone(&self.cell));
        let (period, delay) = (self.period, self.trial.delay);
        Camera::start_with(move || {
            let (arm, cell) = (Arc::clone(&arm), Arc::clone(&cell));
            let open = move || -> Result<Box<dyn DepthSource>, CaptureError> {
                Ok(Box::new(Frames {
                    arm: Arc::clone(&arm),
                    cell: Arc::clone(&cell),
                    period,
                    delay,
                    next: Instant::now(),
                    coming: VecDeque::new(),
                    num_taken: 0,
                    num_delivered: 0,
                }))
            };
            let feed = Feed::start_with(open, BackpressurePolicy::Newest, || ())?;
            Ok((feed, NewFrame::SecondArrived))
        })
    }

    /// What the history calls it.
    pub fn source(&self) -> SourceSpec {
        SourceSpec::Simulated(SimulatedSpec {
            scene: self.scene,
            seed: self.trial.seed,
            ..SimulatedSpec::default()
        })
    }

    /// Where the flange stands, as its robot reports it.
    pub fn flange(&self) -> RigidTransform {
        lock(&self.arm).state().robot_from_flange
    }

    /// The camera's frame with the arm as it stands, by the calibration.
    pub fn frame(&self) -> RobotFrame {
        RobotFrame {
            robot_from_camera: self.flange() * self.place.mount_from_camera(),
            name: "simulated".into(),
        }
    }

    /// What servoing has to know, with this target.
    pub fn setup(&self, target: ServoTarget, params: ServoParams) -> ServoSetup {
        let hand_eye = &self.trial.hand_eye;
        ServoSetup {
            camera: self.place,
            calibration: Some(PoseDelta {
                shift: hand_eye.shift,
                rotation: hand_eye.turn,
            }),
            target,
            flange_from_nozzle: Some(self.placed.flange_from_nozzle),
            placed: Some(self.placed.clone()),
            volume: self.volume,
            params,
        }
    }

    /// Brings the flange where its robot says that it stands. Frames count from then on: the request that is returned came when
    /// the arm was there. Where the arm cannot stand, it stays, and the reason is returned.
    pub fn stand(
        &self,
        robot_from_flange: &RigidTransform,
        asked: &Asked,
    ) -> Result<Asked, StopReason> {
        lock(&self.arm).go(robot_from_flange)?;
        let now = Asked::now();
        Ok(Asked {
            at: now.at,
            by_clock: now.by_clock,
            ..asked.clone()
        })
    }
}

/// The frames of a camera on an arm.
struct Frames {
    arm: Arc<Mutex<SimulatedArm>>,
    cell: Arc<CellCamera>,
    period: Duration,
    /// How much later a frame is delivered than it was taken.
    delay: Duration,
    /// When the next one is taken.
    next: Instant,
    /// Those that were taken, and when they are delivered.
    coming: VecDeque<(Instant, DepthFrame)>,
    num_taken: u64,
    num_delivered: u64,
}

impl Frames {
    fn take(&mut self, now: Instant) {
        // A busy computer leaves frames out.
        self.next = (self.next + self.period).max(now);
        let flange = lock(&self.arm).true_flange();
        self.num_taken += 1;
        let frame = self.cell.frame(&flange, self.num_taken);
        self.coming.push_back((now + self.delay, frame));
    }
}

impl DepthSource for Frames {
    fn title(&self) -> String {
        "Camera on a simulated arm".into()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let until = Instant::now() + wait;
        loop {
            let now = Instant::now();
            if let Some((_, frame)) = self.coming.pop_front_if(|(due, _)| *due <= now) {
                self.num_delivered += 1;
                let number = self.num_delivered;
                let name = format!("frame {number} from the simulated arm");
                let captured = Captured::now(number, name, Image::Depth(frame));
                return Ok(NextCapture::Captured(captured));
            }
            if self.next <= now {
                self.take(now);
                continue;
            }
            let due = self.coming.front().map_or(self.next, |(due, _)| *due);
            let next = due.min(self.next);
            thread::sleep(next.min(until).saturating_duration_since(now));
            if next > until {
                return Ok(NextCapture::NotYet);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::units::{Metres, Radians};
    use inspection::{
        fixtures::shipped_library,
        pipeline::{NamedRecipe, Unwatched, run},
    };
    use servo::simulated::HandEyeError;
    use stages::scene::scene_from_image;

    #[test]
    fn it_looks_from_where_its_robot_says_that_it_stands() {
        let library = shipped_library();
        let exact = SimulatedTrial {
            delay: Duration::from_millis(40),
            hand_eye: HandEyeError {
                shift: Metres(0.0),
                turn: Radians(0.0),
            },
            ..SimulatedTrial::default()
        };
        let carried = CarriedCamera::arrange("fender", &library, exact).expect("a start");
        let camera = carried.start().expect("a thread");
        let recipe = NamedRecipe::default();
        let patience = Duration::from_mins(5);
        let robot_from_part = |asked: &Asked| {
            let frame = camera.frame_after(asked, patience, || false);
            let captured = frame.expect("a frame");
            assert!(captured.is_simulated);
            let scene = scene_from_image(captured.image);
            let seen = run(&scene, &library, &recipe, &Unwatched).expect("never cancelled");
            assert!(seen.verdict.is_accepted(), "{:?}", seen.verdict);
            let pose = seen.found_pose().expect("accepted");
            carried.frame().robot_from_part(&pose.camera_from_part())
        };
        let start = carried.flange();
        let first = robot_from_part(&Asked::now());
        // Where the part is at its standard position in front of the camera.
        let there = first * carried.place.mount_from_camera().inverse();
        let way = |to: &RigidTransform| {
            let flange = carried.flange().translation.vector;
            (flange - to.translation.vector).norm()
        };
        assert!(way(&start) < 1e-6 && way(&there) > 0.05);
        let asked = carried.stand(&there, &Asked::now()).expect("within reach");
        assert!(way(&there) < 1e-6);
        let second = robot_from_part(&asked);
        // The part hangs where it hung, whatever the camera looks from.
        let moved = (first.translation.vector - second.translation.vector).norm();
        assert!(moved < 0.01, "{moved}");
        let far = RigidTransform::translation(9.0, 0.0, 0.0);
        let away = carried.stand(&far, &Asked::now()).err();
        assert_eq!(away, Some(StopReason::OutOfReach));
        assert!(way(&there) < 1e-6);
    }
}
