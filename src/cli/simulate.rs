//! `partsight simulate`: a frame of the simulated cell, as a file.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum, builder::PossibleValuesParser};

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error},
};
use crate::{
    error::Advice,
    files::{depth_png::intrinsics_path, save_cloud, write_atomically, write_depth_png},
    geometry::written_pose::{GivenPose, parse_pose},
    simulate::{CellSetup, PartKind, PartPose, Placement, Side, SimulatedFrame, frame},
    stages::scene::scene_from_frame,
};

/// Take a frame of a simulated cell: one part before wall and floor, with a Kinect's noise
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight simulate --part fender --out fender.pcd
  partsight simulate --part front_door --side right --seed 7 --out door.png --truth door.truth.json
  partsight simulate --part grille --pose \"0 0 15deg 0 0 1.2\" --out grille.pcd

The same arguments give the same file.
Of the doors and the fender only the left ones are shipped: a right one is not recognised until it is enrolled.")]
pub(super) struct SimulateArgs {
    /// Which part
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(PartKind::ALL.map(PartKind::name)))]
    part: String,
    /// Side of the car, for doors and fenders
    #[arg(long, value_enum, default_value_t = SideChoice::Left)]
    side: SideChoice,
    /// Draws the pose, the cell and the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Model of the car; 0 is the standard one
    #[arg(long, default_value_t = 0)]
    model: u64,
    /// Exact place: three angles (radians, or 15deg) and the part's middle before the camera (metres, or 1200mm); R = Rz·Ry·Rx
    #[arg(
        long,
        value_name = "\"rx ry rz x y z\"",
        value_parser = parse_pose,
        allow_hyphen_values = true,
        conflicts_with = "placement"
    )]
    pose: Option<GivenPose>,
    /// How far from square-on the pose is drawn
    #[arg(long, value_enum, default_value_t = PlacementChoice::Placed)]
    placement: PlacementChoice,
    /// The file: .pcd (organised), .png (16-bit depth, intrinsics in a .json beside it), .ply or .xyz (points only)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Write what is known about the frame as JSON: the part, its pose, how much of it is seen
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SideChoice {
    Left,
    Right,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum PlacementChoice {
    /// Hung with care: up to 10 degrees off
    Facing,
    /// Hung anyhow: up to 30 degrees off, any roll
    Placed,
    /// Up to 45 degrees off, any roll
    Hard,
}

impl From<PlacementChoice> for Placement {
    fn from(choice: PlacementChoice) -> Self {
        match choice {
            PlacementChoice::Facing => Self::facing(),
            PlacementChoice::Placed => Self::placed(),
            PlacementChoice::Hard => Self::hard(),
        }
    }
}

pub(super) fn run(args: &SimulateArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let Some(kind) = PartKind::from_name(&args.part) else {
        anyhow::bail!("no part is called {}", args.part);
    };
    check_outputs_differ(args)?;
    for doubt in args.pose.iter().flat_map(|given| &given.doubts) {
        console.warn(doubt, doubt);
    }
    let side = match args.side {
        SideChoice::Left => Side::Left,
        SideChoice::Right => Side::Right,
    };
    let mut setup = CellSetup::with_part(kind, side, args.model, args.seed);
    setup.pose = match (&args.pose, args.placement) {
        (Some(given), _) => PartPose::Fixed(given.pose),
        (None, placement) => PartPose::Drawn(placement.into()),
    };
    let simulated = frame(&setup);
    write_frame(&args.out, &simulated)?;
    let truth = &simulated.truth;
    if let Some(path) = &args.truth {
        write_atomically(path, |writer| {
            serde_json::to_writer_pretty(&mut *writer, truth)?;
            writeln!(writer)
        })
        .advised()?;
    }
    let [x, y, z] = [0, 1, 2].map(|i| truth.camera_from_part.translation.vector[i] * 1000.0);
    console.line(&format_args!(
        "{}: a simulated {} with its middle at x {x:.0}  y {y:.0}  z {z:.0} mm, {:.0} % of it in sight",
        args.out.display(),
        kind.title().to_lowercase(),
        truth.visible_share * 100.0
    ));
    if truth.visible_share < LEAST_VISIBLE {
        console.warn(&OutOfSight, &OutOfSight);
    }
    Ok(Outcome::Accepted)
}

/// Below this share "0 %" is shown.
const LEAST_VISIBLE: f64 = 0.005;

#[derive(Debug, thiserror::Error)]
#[error("the camera does not see the part at this pose")]
struct OutOfSight;

impl Advice for OutOfSight {
    fn advice(&self) -> String {
        "Put the part's middle near the camera's axis, about 1.3 m away: --pose \"0 0 0 0 0 1.3\""
            .into()
    }
}

/// Refuses a call that would write one of its files over another.
fn check_outputs_differ(args: &SimulateArgs) -> anyhow::Result<()> {
    let Some(truth) = &args.truth else {
        return Ok(());
    };
    if is_same_file(truth, &args.out) {
        return Err(advised_error(
            "--out and --truth are the same file",
            "Name two",
        ));
    }
    let camera = intrinsics_path(&args.out);
    if is_png(&args.out) && is_same_file(truth, &camera) {
        return Err(advised_error(
            format!(
                "--truth would overwrite {}, where the camera of the depth image goes",
                camera.display()
            ),
            format!(
                "Name another file, for example --truth {}",
                args.out.with_extension("truth.json").display()
            ),
        ));
    }
    Ok(())
}

/// True if two paths, whose files need not exist, name one file.
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

fn write_frame(path: &Path, simulated: &SimulatedFrame) -> anyhow::Result<()> {
    if is_png(path) {
        write_depth_png(path, &simulated.frame).advised()
    } else {
        save_cloud(path, &scene_from_frame(&simulated.frame).cloud).advised()
    }
}
