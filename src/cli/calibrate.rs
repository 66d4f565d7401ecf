//! `partsight calibrate`: calibrates where the camera sits in the robot's cell.

mod captures;
mod hand_eye;
mod line;
mod show;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::{Choice, choice, parse_robot_pose},
};
use robot::{
    RobotFrame, WrittenPose,
    calibration::{CalibrationError, CameraPlace, CellCalibration, Origin, default_path},
    hand_eye::Mount,
    line::LineCalibration,
};

/// Calibrate where the camera sits in the robot's cell: by hand, or from pairs of robot and camera poses
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight calibrate set \"kuka 1200 -400 1900 86 -5 120\" --mount eye-to-hand --name \"Cell 2\"
  partsight calibrate hand-eye pairs.csv --mount eye-in-hand
  partsight calibrate hand-eye poses.csv --captures captures/ --mount eye-to-hand --out cell.toml
  partsight calibrate capture-pose \"kuka 900 0 1100 0 90 0\"
  partsight calibrate show --as fanuc
  partsight calibrate confirm --calibration cell.toml
  partsight calibrate line fender frames/*.png --counts counts.csv

The calibration is a text file, by default cell.toml in your data folder, where the other commands find it.
Conventions: matrix (16 numbers, metres), quaternion-xyzw, rotation-vector, kuka, fanuc, abb, universal-robots, \
yaskawa, staubli, doosan. Units and order of each: partsight report --conventions")]
pub(super) struct CalibrateArgs {
    #[command(subcommand)]
    command: CalibrateCommand,
}

#[derive(Debug, Subcommand)]
enum CalibrateCommand {
    HandEye(hand_eye::HandEyeArgs),
    Set(SetArgs),
    CapturePose(CapturePoseArgs),
    Confirm(ConfirmArgs),
    Line(line::LineArgs),
    Show(show::ShowArgs),
}

/// Enter the camera's pose by hand
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight calibrate set \"0 0 1 1.2  -1 0 0 -0.4  0 -1 0 1.9  0 0 0 1\" --mount eye-to-hand
  partsight calibrate set \"fanuc 50 0 90 0 0 90\" --mount eye-in-hand --name \"Cell 2\"

The numbers are robot_from_camera (eye to hand) or flange_from_camera (eye in hand): where the camera's frame (x right, \
y down, z forward) stands in the robot's base frame, or in the flange's.")]
struct SetArgs {
    /// The convention and its numbers, or the 16 numbers of a matrix in metres, row after row
    #[arg(value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true)]
    pose: WrittenPose,
    #[command(flatten)]
    kept: CalibrationOutput,
    /// What the camera is fixed to
    #[arg(long, value_parser = choice(&MOUNTS))]
    mount: Mount,
}

/// Store the flange pose at which every capture is taken, for a camera on the flange
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  partsight calibrate capture-pose \"kuka 900 0 1100 0 90 0\"

The numbers are robot_from_flange, as the controller shows it without a tool.")]
struct CapturePoseArgs {
    /// The convention and its numbers, or the 16 numbers of a matrix in metres, row after row
    #[arg(value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true)]
    pose: WrittenPose,
    /// The calibration to change; default: your own
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
}

/// Confirm the numbers of a calibration that was edited: until then, no robot gets poses by them
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  partsight calibrate confirm --calibration cell.toml

The numbers then count as entered by hand. Check them first: partsight calibrate show")]
struct ConfirmArgs {
    /// The calibration; default: your own. The former file is kept beside it
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
}

/// Where a new calibration goes, and what it is called.
#[derive(Debug, Args)]
struct CalibrationOutput {
    /// The file to write; default: your own cell.toml. An existing file is kept beside it
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Name of the cell
    #[arg(long, value_name = "TEXT", default_value = "")]
    name: String,
    /// Anything worth remembering
    #[arg(long, value_name = "TEXT", default_value = "")]
    notes: String,
}

impl CalibrationOutput {
    fn calibration(&self, camera: CameraPlace, origin: Origin) -> CellCalibration {
        CellCalibration {
            name: self.name.clone(),
            notes: self.notes.clone(),
            camera,
            origin,
            made_at: geometry::clock::now(),
        }
    }
}

const MOUNTS: [Choice<Mount>; 2] = [
    (
        "eye-to-hand",
        "The camera stands in the cell",
        Mount::EyeToHand,
    ),
    (
        "eye-in-hand",
        "The camera is on the robot's flange",
        Mount::EyeInHand,
    ),
];

pub(super) fn run(args: &CalibrateArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        CalibrateCommand::HandEye(args) => hand_eye::run(args, console),
        CalibrateCommand::Set(args) => set(args, console),
        CalibrateCommand::CapturePose(args) => capture_pose(args, console),
        CalibrateCommand::Confirm(args) => confirm(args, console),
        CalibrateCommand::Line(args) => line::run(args, console),
        CalibrateCommand::Show(args) => show::run(args, console),
    }
}

fn set(args: &SetArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let camera = CameraPlace::on(args.mount, args.pose.pose);
    keep(camera, Origin::ByHand, &args.kept, console)
}

fn capture_pose(args: &CapturePoseArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let (path, mut calibration) = load(args.calibration.as_deref())?;
    match &mut calibration.camera {
        CameraPlace::OnFlange { capture_pose, .. } => *capture_pose = Some(args.pose.pose),
        CameraPlace::Fixed { .. } => {
            return Err(advised_error(
                format!(
                    "{}: the camera stands in the cell, and does not move with the arm",
                    path.display()
                ),
                "Leave the arm's pose out, or calibrate the cell again with --mount eye-in-hand",
            ));
        }
    }
    calibration.save_keeping_former(&path).advised()?;
    console.line(&format_args!("{}: captures are taken from", path.display()));
    show::matrix("robot_from_flange", &args.pose.pose, console);
    question_unit(&calibration, console);
    Ok(Outcome::Accepted)
}

fn confirm(args: &ConfirmArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let path = path_of(args.calibration.as_deref())?;
    let former = CellCalibration::confirm(&path).advised()?;
    let shown = path.display();
    match former {
        Some(former) => {
            console.line(&format_args!("Confirmed the numbers of {shown}"));
            console.line(&format_args!(
                "  the previous file is kept in {}",
                former.display()
            ));
        }
        None => console.line(&format_args!("{shown} was not edited: nothing to confirm")),
    }
    let calibration = CellCalibration::load(&path).advised()?;
    show::calibration(&calibration, None, console);
    question_unit(&calibration, console);
    Ok(Outcome::Accepted)
}

/// Writes a new calibration and shows it.
fn keep(
    camera: CameraPlace,
    origin: Origin,
    kept: &CalibrationOutput,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let path = path_of(kept.out.as_deref())?;
    let calibration = kept.calibration(camera, origin);
    let former = calibration.save_keeping_former(&path).advised()?;
    console.line(&format_args!("Written to {}", path.display()));
    if let Some(former) = former {
        console.line(&format_args!(
            "  the previous file is kept in {}",
            former.display()
        ));
    }
    show::calibration(&calibration, None, console);
    question_unit(&calibration, console);
    Ok(Outcome::Accepted)
}

fn question_unit(calibration: &CellCalibration, console: &Console) {
    if let Some(doubt) = calibration.camera.unit_doubt() {
        console.warn(&doubt, &doubt);
    }
}

/// Returns the named file, or the user's own.
fn path_of(given: Option<&Path>) -> anyhow::Result<PathBuf> {
    match given {
        Some(path) => Ok(path.to_owned()),
        None => default_path().advised(),
    }
}

/// Loads the named calibration, or the user's own. Also returns its path.
fn load(given: Option<&Path>) -> anyhow::Result<(PathBuf, CellCalibration)> {
    let path = path_of(given)?;
    let calibration = CellCalibration::load(&path).advised()?;
    Ok((path, calibration))
}

/// Returns the named calibration, or the user's own.
pub(super) fn cell_calibration(given: Option<&Path>) -> anyhow::Result<CellCalibration> {
    load(given).map(|(_, calibration)| calibration)
}

/// Returns the calibration for a scan: a named one is loaded at once and must be valid; the user's own, if any, is read
/// only when needed.
pub(super) fn scan_calibration(
    given: Option<&Path>,
) -> anyhow::Result<impl FnOnce() -> Result<Option<CellCalibration>, CalibrationError>> {
    let named = given.map(|path| load(Some(path))).transpose()?;
    Ok(move || match (named, default_path()) {
        (Some((_, calibration)), _) => Ok(Some(calibration)),
        (None, Err(_)) => Ok(None),
        (None, Ok(path)) => CellCalibration::load_if_there(&path),
    })
}

/// Where the camera sits, for a command that inspects.
#[derive(Debug, Args)]
pub(super) struct CalibrationChoice {
    /// Where the camera sits in the robot's cell, as written by `calibrate`; default: your own calibration, if there is
    /// one
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// With a camera on the flange: the flange pose at the capture, as `kuka X Y Z A B C`, or the 16 numbers of a
    /// matrix
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true)]
    robot_pose: Option<WrittenPose>,
}

/// The line that carries the parts past the camera, for a command that follows them.
#[derive(Debug, Args)]
pub(super) struct LineChoice {
    /// The line that carries the parts past the camera without a stop, as written by `calibrate line`; without it, a part that
    /// moves is refused
    #[arg(long = "line", value_name = "FILE", requires = "source")]
    file: Option<PathBuf>,
}

impl LineChoice {
    /// Reads the file of the line, if one is named.
    pub(super) fn load(&self) -> anyhow::Result<Option<LineCalibration>> {
        let line = self.file.as_deref().map(LineCalibration::load);
        line.transpose().advised()
    }
}

/// The error of what needs a calibration that there is not.
pub(super) fn no_calibration(needed_by: &str) -> anyhow::Error {
    advised_error(
        format!("{needed_by} needs to know where the camera sits in the robot's cell"),
        "Name a calibration with --calibration, or make one: partsight calibrate",
    )
}

impl CalibrationChoice {
    /// The named file.
    pub(super) fn path(&self) -> Option<&Path> {
        self.calibration.as_deref()
    }

    /// Returns the robot's frame; `None` without a calibration. A named calibration must exist and be valid; the user's
    /// own is used if possible, with a warning otherwise.
    pub(super) fn frame(&self, console: &Console) -> anyhow::Result<Option<RobotFrame>> {
        let must_be = self.calibration.is_some() || self.robot_pose.is_some();
        let given = self.robot_pose.as_ref().map(|written| &written.pose);
        if must_be {
            let (path, calibration) = load(self.calibration.as_deref())?;
            if given.is_some() && calibration.camera.mount() == Mount::EyeToHand {
                return Err(advised_error(
                    format!(
                        "{}: the camera stands in the cell, so the arm's pose says nothing about it",
                        path.display()
                    ),
                    "Leave --robot-pose out",
                ));
            }
            return calibration.frame(given).map(Some).advised();
        }
        let Ok(path) = default_path() else {
            return Ok(None);
        };
        let own = CellCalibration::load_if_there(&path).unwrap_or_else(|error| {
            console.warn(&format_args!("no poses for the robot: {error}"), &error);
            None
        });
        let frame = own.map(|own| own.frame(None)).transpose();
        Ok(frame.unwrap_or_else(|error| {
            console.warn(&format_args!("no poses for the robot: {error}"), &error);
            None
        }))
    }
}
