//! The simulated cell: where part, arm and camera are, and what disturbs a run.

use std::time::Duration;

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{ArmDynamics, CellPart, SimulatedArm, SimulatedController, StreamProtocol};
use crate::{Fence, Look, Target, Task, TaskError, Tool, stream::Stream};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    oriented_box::OrientedBox,
    rigid::{PoseDelta, RigidTransform, from_euler_zyx, pose_error},
    units::{Metres, Radians},
};
use inspection::{
    library::Library,
    pipeline::{Recipe, Unwatched, run},
};
use robot::{
    arm::{Arm, ArmError, GUN_RADIUS_M, Joints, Obstacles, PlacedArm},
    calibration::CameraPlace,
    spray::default_path,
};
use serde::{Deserialize, Serialize};
use simulate::{SensorNoise, SimulatedScan};
use stages::{reference::Reference, scene::scene_from_frame, stand_off::StandOffParams};

/// Where the simulated robot should bring the camera or the nozzle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SimulatedTarget {
    /// The part's standard position.
    Standard,
    /// A camera pose drawn from the seed, at which frames of the part were recorded.
    Recorded,
    /// The start of a spray path over the middle of the part.
    PathStart,
}

impl SimulatedTarget {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard position",
            Self::Recorded => "recorded camera pose",
            Self::PathStart => "start of a path",
        }
    }
}

/// What goes wrong during a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Disturbance {
    /// Nothing.
    None,
    /// The part is taken away.
    Removed,
    /// The part is exchanged for its mirror image; of a part without sides, for another part.
    Mirrored,
    /// The part is exchanged for another enrolled one.
    Exchanged,
    /// The part is pushed by 50 mm.
    Pushed,
    /// The camera is covered.
    Covered,
    /// A tenth of the frames is lost, throughout.
    FramesLost,
    /// The camera's clock jumps, forwards or backwards.
    ClockJump,
}

impl Disturbance {
    /// All that go wrong.
    pub const ALL: [Self; 7] = [
        Self::Removed,
        Self::Mirrored,
        Self::Exchanged,
        Self::Pushed,
        Self::Covered,
        Self::FramesLost,
        Self::ClockJump,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "undisturbed",
            Self::Removed => "part removed",
            Self::Mirrored => "mirror image instead",
            Self::Exchanged => "another part instead",
            Self::Pushed => "pushed by 50 mm",
            Self::Covered => "camera covered",
            Self::FramesLost => "10 % of frames lost",
            Self::ClockJump => "camera's clock jumps",
        }
    }
}

/// How wrong the calibration may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandEyeError {
    /// Greatest shift.
    pub shift: Metres,
    /// Greatest angle.
    pub turn: Radians,
}

/// Everything that determines a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSetup {
    /// The part.
    pub part: CellPart,
    /// Where it should be.
    pub target: SimulatedTarget,
    /// Scales the camera's noise; 1 is a Kinect's.
    pub noise: f64,
    /// How far the start is from the target at most, along each axis, and about it.
    pub start: (Metres, Radians),
    /// How wrong the calibration is at most.
    pub hand_eye: HandEyeError,
    /// Time between two frames.
    pub frame_period: Duration,
    /// Time from a frame to its verdict.
    pub delay: Duration,
    /// The arm.
    pub dynamics: ArmDynamics,
    /// What goes wrong.
    pub disturbance: Disturbance,
    /// Seed of everything that is drawn.
    pub seed: u64,
}

impl CellSetup {
    /// Seed of the noise of the frame with this number.
    fn noise_seed(&self, number: u64) -> u64 {
        self.seed.wrapping_mul(1_000_003).wrapping_add(number)
    }
}

/// Why a simulated cell cannot be arranged.
#[derive(Debug, thiserror::Error)]
pub enum SimulatedCellError {
    /// The library lacks the part.
    #[error("{part} is not enrolled")]
    NotEnrolled {
        /// Its name.
        part: String,
    },
    /// The target cannot be recorded: the part is not accepted there.
    #[error("{part} is not accepted where its target should be recorded")]
    NotRecorded {
        /// Its name.
        part: String,
    },
    /// No start was found from which the whole part is seen and that the arm reaches.
    #[error("no start was found from which {part} is seen and that the arm reaches")]
    NoStart {
        /// Its name.
        part: String,
    },
    /// The arm is not known.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// The task cannot be done.
    #[error(transparent)]
    Task(#[from] TaskError),
}

/// A cell in which a run can be started.
pub struct SimulatedCell<'a> {
    pub(super) setup: CellSetup,
    pub(super) library: &'a Library,
    recipe: Recipe,
    scan: SimulatedScan,
    /// The scan's model in part space.
    part_from_model: RigidTransform,
    /// What hangs there after an exchange.
    exchanged: Option<SimulatedScan>,
    /// How the part is moved by a push.
    push: RigidTransform,
    /// By how much the camera's clock jumps, seconds.
    pub(super) clock_jump: f64,
    /// When something goes wrong.
    pub(super) disturbed_at: Duration,
    /// The arm, without obstacles.
    pub(super) placed: PlacedArm,
    pub(super) start: Joints,
    pub(super) flange_from_camera: RigidTransform,
    /// The task, with the calibration as the program knows it.
    pub task: Task,
    /// The fence of the cell.
    pub fence: Fence,
    /// True pose of the camera at the target; of the nozzle for a path.
    pub(super) part_from_goal: RigidTransform,
    /// Where the part hangs at first.
    pub(super) robot_from_part: RigidTransform,
}

/// The camera of a cell in which nothing goes wrong. It needs no library, so it may outlive its cell, on a thread of its own.
pub struct CellCamera {
    setup: CellSetup,
    scan: SimulatedScan,
    base_from_model: RigidTransform,
    flange_from_camera: RigidTransform,
}

impl CellCamera {
    /// The frame with this number, taken with the flange here.
    pub fn frame(&self, flange: &RigidTransform, number: u64) -> DepthFrame {
        let noise = SensorNoise {
            multiplier: self.setup.noise,
            seed: self.setup.noise_seed(number),
        };
        let robot_from_camera = flange * self.flange_from_camera;
        (self.scan).frame(&robot_from_camera, &self.base_from_model, &noise)
    }
}

/// The arm of every simulated cell.
pub const ARM: &str = "irb4600";
/// The base of the arm in the base frame of the cell.
const ARM_BACK_M: f64 = -1.35;
/// Number of frames that a target is recorded from.
const NUM_RECORDED: u64 = 10;
/// Separates these random numbers from others with the same seed.
const RANDOM_STREAM: u64 = 0x5e24_05e2_405e_2405;
/// Most starts that are drawn.
const MAX_STARTS: usize = 400;
/// Least distance of the part from the edge of the picture at the start, pixels.
const MIN_EDGE_DISTANCE_PIXELS: f64 = 4.0;

impl<'a> SimulatedCell<'a> {
    /// Arranges the cell around the part of an enrolled library.
    pub fn arrange(setup: CellSetup, library: &'a Library) -> Result<Self, SimulatedCellError> {
        let name = setup.part.name();
        let reference = library.references.iter().find(|one| one.name == name);
        let with_middle = reference.and_then(|one| Some((one, one.middle()?)));
        let Some((reference, middle)) = with_middle else {
            return Err(SimulatedCellError::NotEnrolled { part: name });
        };
        let mut random = Pcg64::seed_from_u64(setup.seed ^ RANDOM_STREAM);
        let scan = setup.part.scan(setup.seed);
        let part_from_model = setup.part.part_from_model();
        let robot_from_part = scan.base_from_model * part_from_model.inverse();
        let flange_from_camera = flange_from_camera();
        let hand_eye = drawn(&mut random, setup.hand_eye.shift.0, setup.hand_eye.turn.0);
        let calibrated = flange_from_camera * hand_eye;
        let placed = placed_arm()?;
        let mut cell = Self {
            exchanged: (setup.part).exchanged(setup.disturbance, setup.seed, &mut random),
            push: RigidTransform::from_parts(
                Translation3::from(direction(&mut random) * 0.05),
                UnitQuaternion::identity(),
            ),
            clock_jump: [-1.0, 1.0][random.random_range(0..2)] * random.random_range(0.1..2.0),
            disturbed_at: Duration::from_secs_f64(random.random_range(0.3..2.5)),
            recipe: Recipe::default(),
            start: [0.0; 6],
            flange_from_camera,
            task: Task {
                part: name.clone(),
                reference: name.clone(),
                middle,
                camera: CameraPlace::OnFlange {
                    flange_from_camera: calibrated,
                    capture_pose: None,
                },
                target: Target::standard_position(),
            },
            fence: fence(&placed, &calibrated, reference),
            part_from_goal: RigidTransform::identity(),
            robot_from_part,
            placed,
            scan,
            part_from_model,
            library,
            setup,
        };
        let seen_from = cell.set_target(reference, &mut random)?;
        cell.start = cell.drawn_start(&seen_from, &mut random)?;
        cell.task = cell.task.checked()?;
        Ok(cell)
    }

    /// Sets the target and the true pose of the camera or nozzle there; returns the true pose of the part in the camera around
    /// which starts are drawn.
    fn set_target(
        &mut self,
        reference: &Reference,
        random: &mut Pcg64,
    ) -> Result<RigidTransform, SimulatedCellError> {
        match self.setup.target {
            SimulatedTarget::Standard => Ok(RigidTransform::identity()),
            SimulatedTarget::Recorded => {
                // Up to 200 mm farther away, and seen up to 10° from the side.
                let by = drawn(random, 0.05, 10_f64.to_radians());
                let back = RigidTransform::translation(0.0, 0.0, random.random_range(0.0..0.2));
                let about = Translation3::from(self.task.middle.coords);
                let true_pose = back * about * by * about.inverse();
                self.part_from_goal = true_pose.inverse();
                let robot_from_camera = self.robot_from_part * self.part_from_goal;
                let looks = (0..NUM_RECORDED).filter_map(|k| {
                    let seed = self.setup.noise_seed(u64::from(u32::MAX) + k);
                    let frame = self.frame_from(&robot_from_camera, Duration::ZERO, seed)?;
                    Some(self.inspected(&frame, Duration::ZERO))
                });
                let looks: Vec<Look> = looks.collect();
                let target = Target::recorded(&looks, &self.task.middle);
                self.task.target = target.ok_or_else(|| SimulatedCellError::NotRecorded {
                    part: self.task.part.clone(),
                })?;
                Ok(true_pose)
            }
            SimulatedTarget::PathStart => {
                let band = StandOffParams::default();
                let path = default_path(reference, &band);
                let Some(path) = path else {
                    let part = self.task.part.clone();
                    return Err(SimulatedCellError::NotRecorded { part });
                };
                let calibration = PoseDelta {
                    shift: self.setup.hand_eye.shift,
                    rotation: self.setup.hand_eye.turn,
                };
                let nozzle = self.placed.flange_from_nozzle;
                self.task.target = Target::path_start(&path, nozzle, calibration, &band)?;
                self.part_from_goal = robot::spray::nozzle_frames(&path)[0];
                // From nearer, the camera does not see the whole part.
                Ok(RigidTransform::identity())
            }
        }
    }

    /// Draws the arm's joints at a start from which the camera sees the whole part.
    fn drawn_start(
        &self,
        seen_from: &RigidTransform,
        random: &mut Pcg64,
    ) -> Result<Joints, SimulatedCellError> {
        let (shift, turn) = self.setup.start;
        let middle = Translation3::from((seen_from * self.task.middle).coords);
        for _ in 0..MAX_STARTS {
            let mut along = |most: f64| most * (2.0 * random.random::<f64>() - 1.0);
            let by = Translation3::new(along(shift.0), along(shift.0), along(shift.0));
            let turned = UnitQuaternion::from_scaled_axis(
                direction(random) * turn.0 * random.random::<f64>(),
            );
            let camera_from_part = by * middle * turned * middle.inverse() * seen_from;
            if !self.is_in_picture(&camera_from_part) {
                continue;
            }
            let robot_from_camera = self.robot_from_part * camera_from_part.inverse();
            let flange = robot_from_camera * self.flange_from_camera.inverse();
            if let Ok(joints) = self.joints_at(&flange) {
                return Ok(joints);
            }
        }
        let part = self.task.part.clone();
        Err(SimulatedCellError::NoStart { part })
    }

    /// The joints that bring the flange here, in the usual configuration.
    pub(super) fn joints_at(&self, flange: &RigidTransform) -> Result<Joints, crate::StopReason> {
        let home = [0.0, 0.4, 0.2, 0.0, -1.5, 0.0];
        let nozzle = flange * self.placed.flange_from_nozzle;
        Ok(self.placed.joints_near(&nozzle, &home)?)
    }

    fn is_in_picture(&self, camera_from_part: &RigidTransform) -> bool {
        let camera = Intrinsics::KINECT;
        let camera_from_model = camera_from_part * self.part_from_model;
        self.scan.part().vertices.iter().all(|p| {
            let pixel = camera.pixel_of(&(camera_from_model * p.cast::<f64>()));
            pixel.is_some_and(|(u, v)| {
                let inside = |x: f64, size: usize| {
                    (MIN_EDGE_DISTANCE_PIXELS..=size as f64 - 1.0 - MIN_EDGE_DISTANCE_PIXELS)
                        .contains(&x)
                };
                inside(u, camera.width) && inside(v, camera.height)
            })
        })
    }

    fn is_disturbed(&self, by: Disturbance, at: Duration) -> bool {
        self.setup.disturbance == by && at >= self.disturbed_at
    }

    /// True if the part that hangs there at this time is the one that it should be.
    pub(super) fn hangs(&self, at: Duration) -> bool {
        let gone = [
            Disturbance::Removed,
            Disturbance::Mirrored,
            Disturbance::Exchanged,
        ];
        !gone.iter().any(|by| self.is_disturbed(*by, at))
    }

    /// Where the part is at this time.
    pub(super) fn robot_from_part_at(&self, at: Duration) -> RigidTransform {
        if self.is_disturbed(Disturbance::Pushed, at) {
            self.push * self.robot_from_part
        } else {
            self.robot_from_part
        }
    }

    /// A frame from the camera's true pose; `None` of one that is lost.
    fn frame_from(
        &self,
        robot_from_camera: &RigidTransform,
        at: Duration,
        seed: u64,
    ) -> Option<DepthFrame> {
        let is_lost = self.setup.disturbance == Disturbance::FramesLost
            && Pcg64::seed_from_u64(seed ^ RANDOM_STREAM).random_bool(0.1);
        if is_lost {
            return None;
        }
        let noise = SensorNoise {
            multiplier: self.setup.noise,
            seed,
        };
        let is_exchanged = self.is_disturbed(Disturbance::Mirrored, at)
            || self.is_disturbed(Disturbance::Exchanged, at);
        let scan = (self.exchanged.as_ref().filter(|_| is_exchanged)).unwrap_or(&self.scan);
        let mut base_from_model = self.robot_from_part_at(at) * self.part_from_model;
        if self.is_disturbed(Disturbance::Removed, at) {
            // Far above the ceiling.
            base_from_model = Translation3::new(0.0, 0.0, 50.0) * base_from_model;
        }
        let mut frame = scan.frame(robot_from_camera, &base_from_model, &noise);
        if self.is_disturbed(Disturbance::Covered, at) {
            frame.depth.fill(0);
        }
        Some(frame)
    }

    /// What the inspection of a frame says, dated by the camera's clock.
    pub(super) fn inspected(&self, frame: &DepthFrame, taken_at: Duration) -> Look {
        let scene = scene_from_frame(frame);
        let inspection = run(&scene, self.library, &self.recipe, &Unwatched);
        let inspection = inspection.expect("not cancelled");
        Look::new(&self.task, &inspection, taken_at)
    }

    /// The frame's time by the camera's clock.
    pub(super) fn dated(&self, at: Duration) -> Duration {
        if self.is_disturbed(Disturbance::ClockJump, at) {
            Duration::from_secs_f64((at.as_secs_f64() + self.clock_jump).max(0.0))
        } else {
            at
        }
    }

    /// Its arm, at the start.
    pub fn arm(&self) -> SimulatedArm {
        let arm = SimulatedArm::new(self.placed.clone(), self.start, self.setup.dynamics);
        arm.expect("the start was checked")
    }

    /// What it was arranged for.
    pub fn setup(&self) -> &CellSetup {
        &self.setup
    }

    /// Its camera.
    pub fn into_camera(self) -> CellCamera {
        CellCamera {
            base_from_model: self.robot_from_part * self.part_from_model,
            setup: self.setup,
            scan: self.scan,
            flange_from_camera: self.flange_from_camera,
        }
    }

    /// Its arm with the nozzle, as the program knows them.
    pub fn placed_arm(&self) -> &PlacedArm {
        &self.placed
    }

    /// The controller of its robot, at the start.
    pub fn controller(&self, protocol: StreamProtocol) -> SimulatedController {
        SimulatedController::new(self.arm(), self.placed.clone(), protocol)
    }

    /// The computer's side of a protocol of its robot.
    pub fn stream(&self, protocol: StreamProtocol) -> Box<dyn Stream + Send> {
        protocol.stream(&self.placed)
    }

    /// The frame with this number, taken with the flange here; `None` if it is lost.
    pub fn frame(&self, flange: &RigidTransform, at: Duration, number: u64) -> Option<DepthFrame> {
        let robot_from_camera = flange * self.flange_from_camera;
        self.frame_from(&robot_from_camera, at, self.setup.noise_seed(number))
    }

    /// What the inspection of that frame says.
    pub fn look(&self, flange: &RigidTransform, at: Duration, number: u64) -> Option<Look> {
        let frame = self.frame(flange, at, number)?;
        Some(self.inspected(&frame, self.dated(at)))
    }

    /// True error of the camera at the part's middle, or of the nozzle at its mouth, with the flange here.
    pub fn true_error(&self, flange: &RigidTransform, at: Duration) -> PoseDelta {
        let part_from_robot = self.robot_from_part_at(at).inverse();
        if self.setup.target == SimulatedTarget::PathStart {
            let part_from_nozzle = part_from_robot * flange * self.placed.flange_from_nozzle;
            return pose_error(&part_from_nozzle, &self.part_from_goal, &Point3::origin());
        }
        let camera_from_part = (part_from_robot * flange * self.flange_from_camera).inverse();
        let wanted = self.part_from_goal.inverse();
        pose_error(&camera_from_part, &wanted, &self.task.middle)
    }

    /// Points of the part's surface, part space.
    pub(super) fn surface(&self) -> Vec<Point3<f64>> {
        let vertices = self.scan.part().vertices.iter();
        vertices
            .map(|p| self.part_from_model * p.cast::<f64>())
            .collect()
    }
}

/// The camera looks 50° upwards from the flange's axis, as a gun on a bracket does, so that the wrist is bent.
fn flange_from_camera() -> RigidTransform {
    // Camera axes that look along the flange's z with the flange's x pointing up.
    let upright = UnitQuaternion::from_euler_angles(0.0, 0.0, -std::f64::consts::FRAC_PI_2);
    let bracket = UnitQuaternion::from_euler_angles(0.0, 50_f64.to_radians(), 0.0);
    RigidTransform::from_parts(Translation3::new(0.12, 0.04, 0.10), bracket * upright)
}

fn placed_arm() -> Result<PlacedArm, ArmError> {
    // The gun is below the camera and so long that the camera still sees the part, beyond its least range.
    let camera_from_nozzle = from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.12, 0.42]);
    Ok(PlacedArm {
        arm: Arm::named(ARM)?,
        robot_from_base: RigidTransform::translation(ARM_BACK_M, 0.0, 0.0),
        flange_from_nozzle: flange_from_camera() * camera_from_nozzle,
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    })
}

fn fence(placed: &PlacedArm, calibrated: &RigidTransform, reference: &Reference) -> Fence {
    let tool = |pose: &RigidTransform, radius| Tool {
        end: Point3::from(pose.translation.vector),
        radius,
    };
    let mut fence = Fence::none();
    fence.volume = Some(OrientedBox {
        centre_m: [0.6, 0.0, 1.2],
        size_m: [2.4, 2.4, 2.2],
        angles_rad: [0.0; 3],
    });
    fence.tools = vec![
        tool(calibrated, 0.06),
        tool(&placed.flange_from_nozzle, GUN_RADIUS_M),
    ];
    fence.arm = Some(placed.clone());
    fence.part.clone_from(&reference.cloud.points);
    fence
}

/// A transform with a shift and a turn up to these, in any direction.
fn drawn(random: &mut impl Rng, shift: f64, turn: f64) -> RigidTransform {
    let shift = direction(random) * shift * random.random::<f64>();
    let turn = direction(random) * turn * random.random::<f64>();
    RigidTransform::from_parts(
        Translation3::from(shift),
        UnitQuaternion::from_scaled_axis(turn),
    )
}

/// Draws a direction uniformly from the sphere.
fn direction(random: &mut impl Rng) -> Vector3<f64> {
    let z = 2.0 * random.random::<f64>() - 1.0;
    let turn = std::f64::consts::TAU * random.random::<f64>();
    let r = (1.0 - z * z).sqrt();
    Vector3::new(r * turn.cos(), r * turn.sin(), z)
}
