//! `partsight calibrate show`, and the text form of a calibration.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{Console, Outcome, path_of};
use crate::cli::{
    console::{Advised as _, in_columns},
    input::parse_convention,
};
use geometry::rigid::{RigidTransform, row_major};
use records::report::SCHEMA;
use robot::{
    Convention,
    calibration::{CalibrationError, CameraPlace, CellCalibration, Origin, ReadCalibration},
};

/// Show the calibration: where the camera sits, and how that is known
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight calibrate show
  partsight calibrate show --calibration cell.toml --as kuka
  partsight calibrate show --json")]
pub(super) struct ShowArgs {
    /// The calibration; default: your own
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Also in this convention
    #[arg(long = "as", value_name = "CONVENTION", value_parser = parse_convention)]
    convention: Option<Convention>,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

/// JSON line of `calibrate show --json`.
#[derive(Serialize)]
struct Line<'a> {
    schema: u32,
    calibration: String,
    name: &'a str,
    identity: String,
    mount: robot::hand_eye::Mount,
    robot_from_camera: Option<[f64; 16]>,
    flange_from_camera: Option<[f64; 16]>,
    robot_from_flange: Option<[f64; 16]>,
    origin: &'a Origin,
    made_at: jiff::Timestamp,
    /// True if its numbers were changed and not confirmed: then no robot gets poses by them.
    edited: bool,
}

pub(super) fn run(args: &ShowArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let path = path_of(args.calibration.as_deref())?;
    let ReadCalibration {
        calibration: loaded,
        is_edited,
    } = CellCalibration::read(&path).advised()?;
    if args.json {
        let (fixed, on_flange, capture_pose) = match &loaded.camera {
            CameraPlace::Fixed { robot_from_camera } => (Some(robot_from_camera), None, None),
            CameraPlace::OnFlange {
                flange_from_camera,
                capture_pose,
            } => (None, Some(flange_from_camera), capture_pose.as_ref()),
        };
        let line = Line {
            schema: SCHEMA,
            calibration: path.display().to_string(),
            name: &loaded.name,
            identity: loaded.identity(),
            mount: loaded.camera.mount(),
            robot_from_camera: fixed.map(row_major),
            flange_from_camera: on_flange.map(row_major),
            robot_from_flange: capture_pose.map(row_major),
            origin: &loaded.origin,
            made_at: loaded.made_at,
            edited: is_edited,
        };
        console.line(&serde_json::to_string(&line)?);
        return Ok(Outcome::Accepted);
    }
    console.line(&path.display());
    calibration(&loaded, args.convention, console);
    if is_edited {
        let edited = CalibrationError::Edited { path };
        console.warn(&edited, &edited);
    }
    Ok(Outcome::Accepted)
}

/// Shows everything about a calibration, one line per item.
pub(super) fn calibration(
    shown: &CellCalibration,
    convention: Option<Convention>,
    console: &mut Console,
) {
    let mut line = |what: &str, text: &str| {
        if !text.is_empty() {
            console.entry(what, &text);
        }
    };
    line("cell", &shown.frame_name().to_string());
    line("notes", &shown.notes);
    line("mount", shown.camera.mount().describe());
    line("from", &shown.origin.describe());
    if let Origin::HandEye(fit) = &shown.origin {
        if let (Some(mm), Some(degrees)) = (fit.bound_mm, fit.bound_degrees) {
            let text = format!(
                "off by less than {mm:.2} mm where the targets stood and {degrees:.3}° in 95 of 100 cases"
            );
            line("bounds", &text);
        }
        for doubt in &fit.doubts {
            line("doubt", doubt);
        }
    }
    line(
        "made",
        &shown.made_at.strftime("%Y-%m-%d %H:%M UTC").to_string(),
    );
    let name = shown.camera.mount().camera_transform();
    pose(name, shown.camera.mount_from_camera(), convention, console);
    match &shown.camera {
        CameraPlace::OnFlange {
            capture_pose: Some(arm),
            ..
        } => pose("robot_from_flange", arm, convention, console),
        CameraPlace::OnFlange { .. } => console.line(
            &"  captures from any pose of the arm: each needs --robot-pose, or store one with calibrate capture-pose",
        ),
        CameraPlace::Fixed { .. } => {}
    }
}

fn pose(
    name: &str,
    transform: &RigidTransform,
    convention: Option<Convention>,
    console: &mut Console,
) {
    matrix(name, transform, console);
    if let Some(convention) = convention {
        let written = convention.write(transform);
        console.line(&format_args!(
            "  {}: {}",
            convention.title(),
            written.line()
        ));
        console.line(&format_args!("    {}", written.meaning));
        if let Some(note) = written.gimbal_note {
            console.line(&format_args!("    {note}"));
        }
    }
}

/// Shows a transform as a matrix.
pub(super) fn matrix(name: &str, transform: &RigidTransform, console: &mut Console) {
    console.line(&format_args!("  {name}, 4x4 matrix, shift in metres"));
    for row in row_major(transform).chunks(4) {
        console.line(&format_args!("    {}", in_columns(row)));
    }
}
