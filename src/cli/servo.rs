//! `partsight servo`: moves a robot by what the camera sees of a part.

use std::{
    ops::ControlFlow,
    path::PathBuf,
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use clap::Args;
use nalgebra::Point3;
use serde_json::json;

use super::{
    LibraryChoice, Outcome,
    calibrate::camera_place,
    console::{Advised as _, Console, advised_error, with_advice},
    follow::parse_source,
    input::{
        EmptyCellChoice, open_scene, parse_name, parse_nozzle_pose, scene_of, warn_of, within,
    },
    interrupt::Interrupt,
    program::CellChoice,
    recipe::RecipeChoice,
};
use capture::{BackpressurePolicy, Feed, FeedItem, FeedState, SourceSpec};
use geometry::{
    error::Advice as _,
    rigid::PoseDelta,
    units::{Metres, Radians},
};
use inspection::{
    library::{Library, PartName},
    pipeline::{Expected, NamedRecipe, Unwatched, run as inspect},
};
use records::report::SCHEMA;
use robot::{
    WrittenPose,
    arm::{Arm, GUN_RADIUS, PlacedArm},
    program::ProgramParams,
};
use servo::{
    Arrival, Fence, Look, Servo, ServoParams, Step, Target, Task, Tool,
    simulated::{
        ArmDynamics, CellSetup, Disturbance, HandEyeError, SimulatedCell, SimulatedTarget,
        StreamProtocol,
    },
    stream::Drive,
};
use simulate::PartKind;
use station::{
    CameraScenes,
    servoing::{RobotAddress, RobotLink, ServoNews, SimulatedRobot, servo},
};

/// Move a robot until the part stands where it should in front of the camera
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight servo fender --simulated                                       a simulated robot, to see how it works
  partsight servo fender --source kinect --robot egm=192.168.1.10:6510
  partsight servo fender --source kinect --robot ur=192.168.1.20 --speed 100
  partsight servo fender --source kinect --robot rsi=192.168.1.10:49152 --arm kr16.toml --nozzle \"kuka 0 0 200 0 0 0\"
  partsight servo fender --source kinect --robot egm=6510 --seen-as ready_1.png --seen-as ready_2.png

Robots:
  egm=IP:PORT   ABB's Externally Guided Motion; this computer listens there
  rsi=IP:PORT   KUKA's RobotSensorInterface; this computer listens there
  ur=IP         Universal Robots, over RTDE; the program is sent to the robot
docs/guide/servo.md has the programs for the controllers.

It is no safety function: people are protected by the robot's own safety controller. Untested on controllers: try it slowly first.
The robot moves only on accepted frames. It stops, and says why, on anything else, and on Ctrl-C.
Exit codes: 0 the target is reached, 1 stopped before, 2 could not run.")]
pub(super) struct ServoArgs {
    /// Name of the part
    #[arg(value_name = "PART", value_parser = parse_name)]
    part: PartName,
    /// The robot's controller
    #[arg(long, value_name = "PROTOCOL=ADDRESS", value_parser = parse_robot, required_unless_present = "simulated", requires = "source")]
    robot: Option<RobotAddress>,
    /// Move a simulated robot with a camera instead, in this protocol
    #[arg(long, value_name = "PROTOCOL", value_parser = parse_protocol, num_args = 0..=1, default_missing_value = "egm", conflicts_with_all = ["robot", "source"])]
    simulated: Option<StreamProtocol>,
    /// Seed of the simulated start
    #[arg(long, value_name = "N", default_value_t = 1, requires = "simulated")]
    seed: u64,
    /// The camera (partsight capture --help)
    #[arg(long, value_name = "SOURCE", value_parser = parse_source)]
    source: Option<SourceSpec>,
    /// Frames of the part, taken where the camera should stand; default: the part's standard position, as at its enrolment
    #[arg(long, value_name = "FILE", conflicts_with = "simulated")]
    seen_as: Vec<PathBuf>,
    /// Where the camera sits, as written by `calibrate`; default: your own calibration
    #[arg(long, value_name = "FILE", conflicts_with = "simulated")]
    calibration: Option<PathBuf>,
    /// The arm, which is then kept within its reach and clear of part and obstacles: a name, or a TOML file; RSI needs it
    #[arg(
        long,
        value_name = "ARM",
        requires = "nozzle",
        conflicts_with = "simulated"
    )]
    arm: Option<String>,
    /// Pose of the nozzle on the flange, as `kuka X Y Z A B C`, or the 16 numbers of a matrix: it is kept clear of the part
    #[arg(long, value_name = "POSE", value_parser = parse_nozzle_pose, allow_hyphen_values = true, conflicts_with = "simulated")]
    nozzle: Option<WrittenPose>,
    #[command(flatten)]
    cell: CellChoice,
    /// Least distance from part and obstacles, mm (5 to 500)
    #[arg(long, value_name = "MM", default_value_t = 50.0, value_parser = |text: &str| within(text, &(5.0..=500.0)))]
    clearance: f64,
    /// Greatest speed of flange, camera and nozzle, mm/s (5 to 1000)
    #[arg(long, value_name = "MM/S", default_value_t = 200.0, value_parser = |text: &str| within(text, &(5.0..=1000.0)))]
    speed: f64,
    /// Greatest error at the end with its bounds, mm (0.5 to 50)
    #[arg(long, value_name = "MM", default_value_t = ServoParams::default().tolerance.shift.mm(), value_parser = |text: &str| within(text, &(0.5..=50.0)))]
    tolerance: f64,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeChoice,
    #[command(flatten)]
    empty_cell: EmptyCellChoice,
    /// Write one line of JSON per frame and one for the end, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

fn parse_robot(text: &str) -> Result<RobotAddress, String> {
    text.parse::<RobotAddress>()
        .map_err(|error| with_advice(&error))
}

fn parse_protocol(text: &str) -> Result<StreamProtocol, String> {
    match text {
        "egm" => Ok(StreamProtocol::Egm),
        "rsi" => Ok(StreamProtocol::Rsi),
        "ur" => Ok(StreamProtocol::Rtde),
        _ => Err("expected egm, rsi or ur".into()),
    }
}

/// How wrong the simulated calibration is at most.
const SIMULATED_HAND_EYE: HandEyeError = HandEyeError {
    shift: Metres(0.02),
    turn: Radians(0.035),
};
/// Radius around the camera that is kept clear.
const CAMERA_RADIUS: f64 = 0.06;
/// How long the camera's thread waits for a frame before it looks whether the run is over.
const TURN: Duration = Duration::from_millis(100);

pub(super) fn run(args: &ServoArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let recipe = args.recipe.recipe()?;
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let name = args.part.as_str();
    if !load.library.has_part(name) {
        return Err(advised_error(
            format!("{name} is not enrolled"),
            "See the parts with partsight library list",
        ));
    }
    let interrupt = Interrupt::listen()?;
    let end = match (&args.robot, &args.source) {
        (Some(robot), Some(source)) => real(
            args,
            robot,
            source,
            &load.library,
            &recipe,
            &interrupt,
            console,
        )?,
        _ => simulated(args, &load.library, &interrupt, console)?,
    };
    Ok(shown(&end, args, console))
}

impl ServoArgs {
    fn params(&self) -> anyhow::Result<ServoParams> {
        let mut params = ServoParams::default();
        params.limits.speed = self.speed / 1000.0;
        // A robot that goes faster must brake as soon.
        params.limits.acceleration = params.limits.acceleration.max(5.0 * params.limits.speed);
        params.tolerance.shift = Metres::from_mm(self.tolerance);
        params.checked().advised()
    }

    fn placed(&self) -> anyhow::Result<Option<PlacedArm>> {
        let (Some(arm), Some(nozzle)) = (&self.arm, &self.nozzle) else {
            return Ok(None);
        };
        let arm = Arm::named(arm).advised()?;
        let placed = self.cell.place(arm, nozzle.pose, &ProgramParams::default());
        placed.map(Some)
    }

    /// What the camera should see: the standard position, or the part as in the frames.
    fn target(
        &self,
        task: &Task,
        library: &Library,
        recipe: &NamedRecipe,
        console: &Console,
    ) -> anyhow::Result<Target> {
        if self.seen_as.is_empty() {
            return Ok(Target::standard_position());
        }
        let mut looks = Vec::new();
        for path in &self.seen_as {
            let (scene, warnings) = open_scene(path).advised()?;
            warn_of(path, &warnings, console);
            let inspection = inspect(&scene, library, recipe, &Unwatched)?;
            let look = Look::new(task, &inspection, Duration::ZERO);
            if let Err(reason) = &look.seen {
                let shown = path.display();
                console.advise(&format_args!("{shown}: {reason}"), &reason.advice());
            }
            looks.push(look);
        }
        let target = Target::recorded(&looks, &task.middle);
        target.ok_or_else(|| {
            advised_error(
                format!(
                    "{} is not accepted in at least half of these frames, in the same place",
                    task.part
                ),
                "Take the frames again, with the whole part in the picture and the camera at rest",
            )
        })
    }
}

/// Servos a real robot.
fn real(
    args: &ServoArgs,
    robot: &RobotAddress,
    source: &SourceSpec,
    library: &Library,
    recipe: &NamedRecipe,
    interrupt: &Interrupt,
    console: &mut Console,
) -> anyhow::Result<Step> {
    if source.is_replayed() {
        return Err(advised_error(
            format!("{source} is replayed: its frames do not show what hangs there now"),
            "Give a camera as --source, or try a simulated robot: --simulated",
        ));
    }
    let name = args.part.as_str();
    let reference = library.references.iter().find(|one| one.name == name);
    let with_middle = reference.and_then(|one| Some((one, one.middle()?)));
    let Some((reference, middle)) = with_middle else {
        return Err(advised_error(
            format!("{name} has several references"),
            "Name the one that hangs there: partsight library list",
        ));
    };
    let expected = Expected::new(vec![name.into()], None, |_| true).advised()?;
    let recipe = recipe.clone().expecting(expected);
    let camera = camera_place(args.calibration.as_deref())?;
    let mut task = Task {
        part: name.to_owned(),
        reference: name.to_owned(),
        middle,
        camera,
        target: Target::standard_position(),
    };
    task.target = args.target(&task, library, &recipe, console)?;
    let task = task.checked().advised()?;
    let placed = args.placed()?;
    let stream = robot.stream(placed.as_ref()).advised()?;
    let fence = fence(args, &task, placed, &reference.cloud.points);
    let servo_run = Servo::new(task.clone(), args.params()?, fence).advised()?;
    let mut drive = Drive::new(stream, servo_run);
    let empty_cell = args.empty_cell.open(console)?;
    let feed = Feed::start(source.clone(), BackpressurePolicy::Newest, || ()).advised()?;
    let mut link = RobotLink::open(robot).advised()?;
    let at = link.address();
    console.note(&format_args!("Waiting for the robot: {}", robot.at(at)));
    let started = Instant::now();
    let mut scenes = CameraScenes::new(empty_cell);
    let quiet = Console::new();
    let next_look = |is_over: &AtomicBool| loop {
        if is_over.load(Ordering::SeqCst) || feed.status().state.is_over() {
            return None;
        }
        let Some(FeedItem::Captured(captured)) = feed.wait(TURN) else {
            continue;
        };
        let taken_at = captured.arrived.saturating_duration_since(started);
        let scene = scene_of(captured, &mut scenes, &quiet);
        // It is never cancelled.
        let inspection = inspect(&scene, library, &recipe, &Unwatched).ok()?;
        return Some(Look::new(&task, &inspection, taken_at));
    };
    let now = || started.elapsed();
    let mut lost: Option<String> = None;
    let end = servo(&mut link, &mut drive, &now, next_look, |news| {
        if let FeedState::Failed(error) | FeedState::Lost { error } = feed.status().state {
            let words = error.to_string();
            if lost.as_ref() != Some(&words) {
                console.warn(&words, &*error);
                lost = Some(words);
            }
        }
        show_news(news, args.json, console);
        flow(interrupt, console)
    });
    end.advised()
}

/// Servos a simulated robot.
fn simulated(
    args: &ServoArgs,
    library: &Library,
    interrupt: &Interrupt,
    console: &mut Console,
) -> anyhow::Result<Step> {
    let name = args.part.as_str();
    let kind = PartKind::ALL.into_iter().find(|kind| kind.name() == name);
    let Some(kind) = kind else {
        let known = PartKind::ALL.map(PartKind::name).join(", ");
        return Err(advised_error(
            format!("the simulated cell has no {name}"),
            format!("Choose one of {known}"),
        ));
    };
    let setup = CellSetup {
        kind,
        target: SimulatedTarget::Standard,
        noise: 1.0,
        start: (Metres(0.25), Radians::from_degrees(25.0)),
        hand_eye: SIMULATED_HAND_EYE,
        frame_period: TURN,
        delay: Duration::ZERO,
        dynamics: ArmDynamics::default(),
        disturbance: Disturbance::None,
        seed: args.seed,
    };
    let protocol = args.simulated.unwrap_or(StreamProtocol::Egm);
    let cell = SimulatedCell::arrange(setup, library)?;
    let servo_run = Servo::new(cell.task.clone(), args.params()?, cell.fence.clone()).advised()?;
    let mut drive = Drive::new(cell.stream(protocol), servo_run);
    let started = SimulatedRobot::start(cell.controller(protocol), protocol);
    let (robot, mut link) = started.advised()?;
    console.note(
        &"Simulated: an arm carries the camera; its calibration is wrong by up to 20 mm and 2°",
    );
    let mut number = 0;
    let next_look = |_: &AtomicBool| {
        number += 1;
        robot.look(|flange, at| cell.look(flange, at, number))
    };
    let now = || robot.now().0;
    let end = servo(&mut link, &mut drive, &now, next_look, |news| {
        show_news(news, args.json, console);
        flow(interrupt, console)
    });
    let end = end.advised()?;
    let (at, flange) = robot.now();
    let left = cell.true_error(&flange, at);
    console.note(&format_args!("True error at the end: {}", words(&left)));
    Ok(end)
}

fn flow(interrupt: &Interrupt, console: &Console) -> ControlFlow<()> {
    if interrupt.came() || !console.is_writable() {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

/// What every commanded pose is kept clear of.
fn fence(args: &ServoArgs, task: &Task, placed: Option<PlacedArm>, part: &[Point3<f32>]) -> Fence {
    let mut fence = Fence::none();
    if let Some(placed) = &placed {
        fence.obstacles = placed.obstacles.clone();
    }
    fence.obstacles.clearance = args.clearance / 1000.0;
    if let Some(nozzle) = &args.nozzle {
        fence.tools.push(Tool {
            end: Point3::from(nozzle.pose.translation.vector),
            radius: GUN_RADIUS,
        });
    }
    if let robot::calibration::CameraPlace::OnFlange {
        flange_from_camera, ..
    } = &task.camera
    {
        fence.tools.push(Tool {
            end: Point3::from(flange_from_camera.translation.vector),
            radius: CAMERA_RADIUS,
        });
    }
    fence.arm = placed;
    if !task.is_part_held() {
        fence.part = part.to_vec();
    }
    fence
}

fn words(error: &PoseDelta) -> String {
    format!(
        "{:.2} mm, {:.3}°",
        error.shift.mm(),
        error.rotation.degrees()
    )
}

fn show_news(news: Option<ServoNews>, is_json: bool, console: &mut Console) {
    match news {
        None => {}
        Some(ServoNews::Connected(peer)) => console.note(&format_args!("Robot: {peer}")),
        Some(ServoNews::Problem(problem)) => console.warn(&problem, &problem),
        Some(ServoNews::Looked { look, error, held }) => {
            let why = look.seen.as_ref().err().or(held.as_ref());
            if is_json {
                console.line(&json!({
                    "schema": SCHEMA,
                    "frame_s": look.taken_at.as_secs_f64(),
                    "error_m": error.map(|error| error.shift.0),
                    "error_rad": error.map(|error| error.rotation.0),
                    "held": why.map(servo::StopReason::kind),
                }));
                return;
            }
            let at = look.taken_at.as_secs_f64();
            let error = error.map_or_else(|| "looking".to_owned(), |error| words(&error));
            let why = why.map(|why| format!("   held: {why}")).unwrap_or_default();
            console.line(&format_args!("{at:7.2} s   {error}{why}"));
        }
    }
}

/// Shows how it ended.
fn shown(end: &Step, args: &ServoArgs, console: &mut Console) -> Outcome {
    let (arrival, reason) = match end {
        Step::Done(arrival) => (Some(&**arrival), None),
        Step::Stop(reason) => (None, Some(reason)),
        Step::Command(_) => (None, None),
    };
    if args.json {
        console.line(&json!({
            "schema": SCHEMA,
            "arrived": arrival.is_some(),
            "error_m": arrival.map(|end| end.error.shift.0),
            "error_rad": arrival.map(|end| end.error.rotation.0),
            "bounds_m": arrival.map(|end| end.bounds.shift.0),
            "bounds_rad": arrival.map(|end| end.bounds.rotation.0),
            "approximate": arrival.map(|end| end.is_approximate),
            "took_s": arrival.map(|end| end.took.as_secs_f64()),
            "stopped": reason.map(servo::StopReason::kind),
            "message": reason.map(ToString::to_string),
            "advice": reason.map(geometry::error::Advice::advice),
        }));
    } else if let Some(arrival) = arrival {
        show_arrival(arrival, console);
    } else if let Some(reason) = reason {
        console.line(&format_args!("Stopped: {reason}"));
        console.entry("to do", &reason.advice());
    }
    Outcome::accepted_if(arrival.is_some())
}

fn show_arrival(arrival: &Arrival, console: &mut Console) {
    let approximate = if arrival.is_approximate {
        ", approximate: it may be another model"
    } else {
        ""
    };
    console.line(&format_args!("The target is reached{approximate}"));
    console.entry("error", &words(&arrival.error));
    let (shift, turn) = (&arrival.bounds.shift, &arrival.bounds.rotation);
    let bounds = format!("{:.1} mm, {:.2}° (95 %)", shift.mm(), turn.degrees());
    console.entry("bounds", &bounds);
    let took = format!(
        "{:.1} s, {} frames at the end",
        arrival.took.as_secs_f64(),
        arrival.num_frames
    );
    console.entry("took", &took);
}
