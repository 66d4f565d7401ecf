//! `partsight simulate`: writes a frame of the simulated cell, or many of them as cases with their truth, or runs a robot in it.

mod cases;
mod line;
mod rack;
mod robot;
mod scan;

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
};

use clap::{Args, builder::PossibleValuesParser};

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error, with_advice},
    input::{Choice, choice, within},
    servo::parse_robot,
    servo_choice::SimulatedRobotChoice,
    write_json,
};
use files::{depth_png::intrinsics_path, save_cloud, write_depth_png};
use geometry::depth_frame::DepthFrame;
use geometry::written_pose::{GivenPose, parse_pose};
use serve::parse_address;
use simulate::{
    CellSetup, Clutter, ObjectKind, PartKind, PartPose, PoseRange, RackKind, Side, SimulatedObject,
    Stand, frame,
};
use stages::scene::scene_from_frame;
use station::servoing::RobotAddress;

/// Take a frame of a simulated cell: one part in front of a wall and a floor, with a Kinect's noise
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight simulate --part fender --out fender.pcd
  partsight simulate --part front_door --side right --seed 7 --out door.png --truth door.truth.json
  partsight simulate --part grille --pose \"0 0 15deg 0 0 1.2\" --out grille.pcd
  partsight simulate --cases tried --num 40 --placement facing,placed,hard
  partsight simulate --part fender --scan frames --shots 8
  partsight simulate --line passing
  partsight simulate --rack 3 --rack-kind touching --seed 4 --out rack.png --truth rack.truth.json
  partsight simulate --cases tried --part objects,empty --num 9 --clutter on-floor
  partsight simulate --cases booth --booth --num 80
  partsight simulate --robot egm=127.0.0.1:6510 --part fender --out cell.toml    a robot that another program servoes

The same arguments give the same file. Cases are added to those already in the folder; their truth refers to the shipped \
parts, and partsight evaluate counts how often they are recognised.
Only the left doors and the left fender are shipped: a right one is not recognised until it is enrolled.")]
pub(super) struct SimulateArgs {
    /// What hangs in the cell; objects stands for the eight things that are not shipped parts. With --cases several may
    /// be given; default: all parts
    #[arg(long, value_name = "NAME", value_delimiter = ',', required_unless_present_any = ["cases", "rack", "line"], value_parser = PossibleValuesParser::new(subject_names()))]
    part: Vec<String>,
    /// Side of the car, for doors and fenders
    #[arg(long, value_parser = choice(&SIDES), default_value = "left")]
    side: Side,
    /// Seed of the pose, the cell and the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Model of the car; 0 is the standard one
    #[arg(long, default_value_t = 0)]
    model: u64,
    /// Exact pose: three angles (radians, or 15deg) and the origin of the part's model, near its middle, in front of the camera (metres, or 1200mm); R = Rz·Ry·Rx
    #[arg(
        long,
        value_name = "\"rx ry rz x y z\"",
        value_parser = parse_pose,
        allow_hyphen_values = true,
        conflicts_with = "placement"
    )]
    pose: Option<GivenPose>,
    /// How far from square-on the random pose may be; with --cases several may be given
    #[arg(long, value_parser = choice(&PLACEMENTS), value_delimiter = ',', default_value = "placed")]
    placement: Vec<Placement>,
    /// What else is in the cell
    #[arg(long, value_parser = choice(&CLUTTERS), default_value = "none")]
    clutter: Clutter,
    /// What holds the part
    #[arg(long, value_parser = choice(&STANDS), default_value = "none")]
    stand: Stand,
    /// A paint booth seen from the robot's flange: the part cut off by the picture, a field of view smaller than the
    /// picture, tubes and clamps that touch the part. The seed sets the pose, the stand and the walls
    #[arg(long, conflicts_with_all = ["placement", "clutter", "stand"])]
    booth: bool,
    /// Camera noise as a multiple of a Kinect's; 0 is none
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = |text: &str| within(text, &(0.0..=5.0)))]
    noise: f64,
    /// Instead of one part: a rack with this many places, 2 to 5, side by side. The seed also draws the parts and how each hangs;
    /// --truth lists them from left to right. With --stand post they hang on one bar
    #[arg(long, value_name = "N", conflicts_with_all = ["part", "side", "pose", "placement", "booth", "cases", "scan"])]
    rack: Option<usize>,
    /// With --rack: what is special about it
    #[arg(long, value_name = "KIND", value_parser = choice(&RACKS), default_value = "apart", requires = "rack", conflicts_with_all = ["part", "cases"])]
    rack_kind: RackKind,
    /// The file: .pcd (organised), .png (16-bit depth, intrinsics in a .json beside it), .ply or .xyz (points only);
    /// with --robot, the calibration of its camera (.toml)
    #[arg(long, value_name = "FILE", required_unless_present_any = ["cases", "scan", "line"])]
    out: Option<PathBuf>,
    /// Write what is known about the frame as JSON: the part, its pose, how much of it is seen; with --robot, where it ended
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Instead of one file: write cases with their truth into this folder
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "truth", "pose"])]
    cases: Option<PathBuf>,
    /// Instead of one file: write frames from several sides into this folder, with the poses that a robot would report,
    /// for partsight scan; in a cell of their own
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "truth", "pose", "cases"])]
    scan: Option<PathBuf>,
    /// With --scan: number of frames
    #[arg(long, value_name = "N", default_value_t = 8, requires = "scan", value_parser = parse_shots)]
    shots: usize,
    /// Instead of one file: write frames of a part that passes on a line into this folder, with counts.csv, the counts of the
    /// line's encoder, for partsight calibrate line
    #[arg(long, value_name = "DIR", conflicts_with_all = ["part", "side", "pose", "placement", "booth", "out", "truth", "cases", "scan", "rack"])]
    line: Option<PathBuf>,
    /// With --cases: total number of cases; their seeds are consecutive
    #[arg(long, value_name = "N", default_value_t = 40, requires = "cases", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    num: u64,
    /// With --cases: how hard they are, in words; default: the placement
    #[arg(long, value_name = "WORDS", requires = "cases")]
    difficulty: Option<String>,
    /// Instead of a frame: an arm whose camera looks at the part, with a controller that another program drives, as
    /// partsight servo does. The address is the one that servo gets: egm=IP:PORT or rsi=IP:PORT of that program, ur=IP of this
    /// computer. The seed sets the start
    #[arg(id = "simulated", long = "robot", value_name = "PROTOCOL=ADDRESS", value_parser = parse_robot, conflicts_with_all = ["side", "model", "pose", "placement", "clutter", "stand", "booth", "noise", "rack", "cases", "scan", "line"], help_heading = ROBOT)]
    robot: Option<RobotAddress>,
    /// Port, or IP address and port, at which the camera of the robot gives its frames
    #[arg(long, value_name = "PORT", value_parser = parse_camera, default_value = "30200", requires = "simulated", help_heading = ROBOT)]
    camera: SocketAddr,
    #[command(flatten, next_help_heading = ROBOT)]
    arm: SimulatedRobotChoice,
}

/// Heading of the options for a robot.
const ROBOT: &str = "A robot for another program (--robot)";

fn parse_camera(text: &str) -> Result<SocketAddr, String> {
    parse_address(text).map_err(|error| with_advice(&error))
}

/// Returns the names of all objects, then of groups of them.
fn subject_names() -> Vec<&'static str> {
    let parts = PartKind::ALL.map(PartKind::name);
    let objects = ObjectKind::ALL.map(ObjectKind::name);
    let mut names = [parts, objects].concat();
    names.extend([EMPTY, ALL, OBJECTS]);
    names
}

const EMPTY: &str = "empty";
const ALL: &str = "all";
const OBJECTS: &str = "objects";

fn parse_shots(text: &str) -> Result<usize, String> {
    let shots = text.parse::<usize>().ok();
    shots
        .filter(|shots| (2..=64).contains(shots))
        .ok_or_else(|| "expected a number from 2 to 64".into())
}

impl SimulateArgs {
    /// Returns the objects to simulate.
    fn subjects(&self) -> Vec<SimulatedObject> {
        let part = |kind| SimulatedObject::Part {
            kind,
            side: self.side,
            model_seed: self.model,
        };
        if self.part.is_empty() {
            return PartKind::ALL.map(part).to_vec();
        }
        let mut subjects = Vec::new();
        for name in &self.part {
            match name.as_str() {
                EMPTY => subjects.push(SimulatedObject::Nothing),
                ALL => subjects.extend(PartKind::ALL.map(part)),
                OBJECTS => subjects.extend(ObjectKind::ALL.map(SimulatedObject::Object)),
                name => {
                    subjects.extend(PartKind::from_name(name).map(part));
                    subjects.extend(ObjectKind::from_name(name).map(SimulatedObject::Object));
                }
            }
        }
        subjects
    }

    /// Creates the cell with this object; the pose is drawn.
    fn cell(&self, subject: SimulatedObject, seed: u64) -> CellSetup {
        let mut setup = if self.booth {
            CellSetup::booth(subject, seed)
        } else {
            CellSetup::new(subject, seed)
        };
        self.equip(&mut setup);
        setup
    }

    /// Sets the noise, and what stands around the part.
    fn equip(&self, setup: &mut CellSetup) {
        setup.noise.multiplier = self.noise;
        setup.clutter = self.clutter;
        setup.stand = self.stand;
    }
}

#[rustfmt::skip]
const CLUTTERS: [Choice<Clutter>; 3] = [
    ("none", "Nothing", Clutter::None),
    ("on-floor", "Two or three things on the floor", Clutter::OnFloor),
    ("in-front", "The same, and a plank that hides 10 to 25 % of the part", Clutter::InFront),
];

const STANDS: [Choice<Stand>; 3] = [
    ("none", "Nothing in sight", Stand::None),
    ("post", "A post with two hooks", Stand::Post),
    ("floor", "It stands on the floor", Stand::Floor),
];

#[rustfmt::skip]
const RACKS: [Choice<RackKind>; 7] = [
    ("apart", "Different parts with gaps of 40 to 150 mm", RackKind::Apart),
    ("touching", "Different parts with gaps of at most 10 mm", RackKind::Touching),
    ("overlapping", "Different parts in pairs: one hangs 100 to 300 mm in front of the other and hides up to a third of it", RackKind::Overlapping),
    ("equal", "Two equal parts among others", RackKind::Equal),
    ("mirrored", "The left and the right part of one kind among others", RackKind::Mirrored),
    ("foreign", "An object that is not a shipped part among parts", RackKind::Foreign),
    ("empty", "One place is empty", RackKind::Empty),
];

const SIDES: [Choice<Side>; 2] = [("left", "", Side::Left), ("right", "", Side::Right)];

/// The name of a kind of random pose, which cases give as their difficulty, and its range.
type Placement = (&'static str, fn() -> PoseRange);

#[rustfmt::skip]
const PLACEMENTS: [Choice<Placement>; 3] = [
    ("facing", "Hung with care: up to 10 degrees off", ("facing", PoseRange::facing)),
    ("placed", "Hung carelessly: up to 30 degrees off, any roll", ("placed", PoseRange::placed)),
    ("hard", "Up to 45 degrees off, any roll", ("hard", PoseRange::hard)),
];

pub(super) fn run(args: &SimulateArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    if let (Some(robot), Some(out)) = (&args.robot, &args.out) {
        return robot::run(robot, out, args, console);
    }
    if let Some(folder) = &args.cases {
        return cases::run(folder, args, console);
    }
    if let Some(folder) = &args.line {
        return line::run(folder, args, console);
    }
    if let Some(folder) = &args.scan {
        return scan::run(folder, args, console);
    }
    let (subjects, out) = (args.subjects(), args.out.as_deref());
    if let (Some(num_places), Some(out)) = (args.rack, out) {
        return rack::run(num_places, out, args, console);
    }
    let (&[subject], &[(_, pose_range)], Some(out)) = (&subjects[..], &args.placement[..], out)
    else {
        return Err(advised_error(
            "one file shows one part at one placement",
            "Give one of each, or write cases: partsight simulate --cases DIR",
        ));
    };
    check_outputs_differ(args, out)?;
    for doubt in args.pose.iter().flat_map(|given| &given.doubts) {
        console.warn(doubt, doubt);
    }
    let mut setup = args.cell(subject, args.seed);
    setup.pose = match &args.pose {
        Some(given) => PartPose::Fixed(given.pose),
        None => PartPose::Drawn(pose_range()),
    };
    let simulated = frame(&setup);
    write_frame(out, &simulated.frame)?;
    let truth = &simulated.truth;
    if let Some(path) = &args.truth {
        write_json(path, truth)?;
    }
    let what = match subject {
        SimulatedObject::Part { kind, .. } => kind.title().to_lowercase(),
        SimulatedObject::Object(kind) => kind.name().to_owned(),
        SimulatedObject::Nothing => {
            console.line(&format_args!("{}: a simulated empty cell", out.display()));
            return Ok(Outcome::Accepted);
        }
    };
    let [x, y, z] = [0, 1, 2].map(|i| truth.camera_from_part.translation.vector[i] * 1000.0);
    console.line(&format_args!(
        "{}: a simulated {what}, {:.0} % of it in sight; the origin of its model, which is not the middle that inspect shows, at x {x:.0}  y {y:.0}  z {z:.0} mm",
        out.display(),
        truth.visible_share * 100.0
    ));
    if truth.visible_share < LEAST_VISIBLE {
        console.advise(
            &"warning: the camera does not see the part at this pose",
            &"Put the part near the camera's axis, about 1.3 m away: --pose \"0 0 0 0 0 1.3\"",
        );
    }
    Ok(Outcome::Accepted)
}

/// Below this visible share "0 %" is shown.
const LEAST_VISIBLE: f64 = 0.005;

/// Refuses a call in which one output file would overwrite another.
fn check_outputs_differ(args: &SimulateArgs, out: &Path) -> anyhow::Result<()> {
    let Some(truth) = &args.truth else {
        return Ok(());
    };
    if is_same_file(truth, out) {
        return Err(advised_error(
            "--out and --truth are the same file",
            "Give two different files",
        ));
    }
    let camera = intrinsics_path(out);
    if is_png(out) && is_same_file(truth, &camera) {
        return Err(advised_error(
            format!(
                "--truth would overwrite {}, where the camera of the depth image goes",
                camera.display()
            ),
            format!(
                "Name another file, for example --truth {}",
                out.with_extension("truth.json").display()
            ),
        ));
    }
    Ok(())
}

/// Returns whether two paths, whose files need not exist, name the same file.
fn is_same_file(a: &Path, b: &Path) -> bool {
    let full = |path: &Path| {
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let name = path.file_name()?.to_owned();
        Some((folder.canonicalize().ok()?, name))
    };
    a == b || full(a).is_some_and(|a| full(b) == Some(a))
}

fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"))
}

fn write_frame(path: &Path, frame: &DepthFrame) -> anyhow::Result<()> {
    if is_png(path) {
        write_depth_png(path, frame).advised()
    } else {
        save_cloud(path, &scene_from_frame(frame).cloud).advised()
    }
}
