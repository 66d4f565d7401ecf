//! `partsight calibrate hand-eye`: computes the camera's pose from pairs of robot and camera poses.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{
    CalibrationOutput, Console, MOUNTS, Outcome,
    captures::{TargetChoice, pairs_of_captures},
    keep,
    show::matrix,
};
use crate::cli::{
    console::{Advised as _, Table, advised_error},
    input::{choice, parse_convention},
};
use geometry::{error::Advice as _, rigid::row_major};
use records::report::SCHEMA;
use robot::{
    Convention,
    calibration::{CalibrationFit, CameraPlace, Origin},
    hand_eye::{HandEye, Mount, PosePair, Target, solve},
    pairs::{PairConventions, read_pairs},
};

/// Calculate the camera's pose from pairs of robot and camera poses
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight calibrate hand-eye pairs.csv --mount eye-in-hand
  partsight calibrate hand-eye pairs.csv --mount eye-to-hand --without p7 --out cell.toml
  partsight calibrate hand-eye poses.csv --captures captures/ --mount eye-to-hand

PAIRS has a line for each pair: the robot's pose (robot_from_flange, as the controller shows the flange without a tool), \
then the camera's (camera_from_target: where the camera sees a target). With eye in hand the target stands in the cell, \
with eye to hand it is on the flange. A name may precede the numbers, and lines at the top name the conventions:

  # robot: kuka                 X Y Z mm, A B C degrees
  # camera: rotation-vector     x y z m, rx ry rz; without this line a matrix of 16 numbers
  p1; 1450.2; -310.0; 890.5; 12.01; -45.2; 178.8; 0.1021; -0.0310; 1.2044; 0.31; -2.10; 0.02

With --captures the target is any enrolled part, fixed where a target would be: PAIRS then has the robot's poses alone, \
each after the name of its capture in DIR (without names, in the order of the files).

Take 8 to 15 pairs, the target in all parts of the picture, the flange turned about two different axes by 30 degrees and \
more; pairs that repeat a pose of the arm count as one. Exit codes: 0 written, 1 the poses do not determine the camera's \
place or do not agree (nothing is written without --even-if-doubtful), 2 something could not be read.")]
pub(super) struct HandEyeArgs {
    /// Pairs of poses: CSV or JSON
    #[arg(value_name = "PAIRS")]
    pairs: PathBuf,
    /// What the camera is fixed to
    #[arg(long, value_parser = choice(&MOUNTS))]
    mount: Mount,
    #[command(flatten)]
    kept: CalibrationOutput,
    #[command(flatten)]
    targets: TargetChoice,
    /// Convention of the robot's poses, if the file does not name it
    #[arg(long, value_name = "CONVENTION", value_parser = parse_convention)]
    robot_convention: Option<Convention>,
    /// Convention of the camera's poses, if the file does not name it
    #[arg(long, value_name = "CONVENTION", value_parser = parse_convention, conflicts_with = "captures")]
    camera_convention: Option<Convention>,
    /// Leave these pairs out: their names, or the numbers of their lines
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    without: Vec<String>,
    /// Only calculate and show: write nothing
    #[arg(long)]
    dry_run: bool,
    /// Write the calibration even if the poses do not determine it or disagree
    #[arg(long)]
    even_if_doubtful: bool,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &HandEyeArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let (mut pairs, target) = if let Some(folder) = &args.targets.captures {
        let convention = args.robot_convention;
        pairs_of_captures(&args.pairs, convention, folder, &args.targets, console)?
    } else {
        let given = PairConventions {
            robot: args.robot_convention,
            camera: args.camera_convention,
        };
        let read = read_pairs(&args.pairs, given).advised()?;
        console.note(&format_args!(
            "{} pairs: robot in {}, camera in {}",
            read.pairs.len(),
            read.robot.title(),
            read.camera.title()
        ));
        (read.pairs, Target::Marker)
    };
    let left_out = leave_out(&mut pairs, &args.without)?;
    let solved = solve(&pairs, args.mount, target).advised()?;
    if args.json {
        console.line(&serde_json::to_string(&Line::of(&solved, args))?);
    } else {
        show(&solved, console);
    }
    for doubt in &solved.doubts {
        console.warn(doubt, doubt);
    }
    let is_to_be_written = !args.dry_run && (solved.is_usable() || args.even_if_doubtful);
    if is_to_be_written {
        let camera = CameraPlace::on(solved.mount, solved.mount_from_camera);
        let file = args.pairs.file_name().unwrap_or_default();
        let fit = CalibrationFit::of(&solved, file.to_string_lossy().into_owned(), left_out);
        if args.json {
            let path = super::path_of(args.kept.out.as_deref())?;
            let calibration = args.kept.calibration(camera, Origin::HandEye(fit));
            calibration.save_keeping_former(&path).advised()?;
        } else {
            keep(camera, Origin::HandEye(fit), &args.kept, console)?;
        }
    } else if !solved.is_usable() {
        console.note(&"Nothing was written: the result must not be used. Take the pairs as advised above, or insist \
            with --even-if-doubtful.");
    }
    Ok(Outcome::accepted_if(solved.is_usable()))
}

/// Removes the pairs with these names or lines, and returns their names.
fn leave_out(pairs: &mut Vec<PosePair>, without: &[String]) -> anyhow::Result<Vec<String>> {
    let mut left_out = Vec::new();
    for name in without {
        let name = name.trim();
        let is_meant = |pair: &PosePair| {
            let given = pair.name.split(" (").next().unwrap_or_default();
            pair.name == name
                || given == name
                || pair.name.contains(&format!("(line {name})"))
                || pair.name == format!("line {name}")
        };
        let Some(at) = pairs.iter().position(is_meant) else {
            let names: Vec<&str> = pairs.iter().map(|pair| pair.name.as_str()).collect();
            return Err(advised_error(
                format!("no pair is named {name}"),
                format!("Name one of {}", names.join(", ")),
            ));
        };
        left_out.push(pairs.remove(at).name);
    }
    Ok(left_out)
}

/// Shows the residuals and the solution.
fn show(solved: &HandEye, console: &mut Console) {
    let mut table = Table::new(&["PAIR", "OFF mm", "OFF degrees", ""]);
    let residuals = &solved.residuals;
    for (i, pair) in residuals.pairs.iter().enumerate() {
        table.row([
            pair.name.clone(),
            format!("{:.3}", pair.off.shift.mm()),
            format!("{:.4}", pair.off.rotation.degrees()),
            if i == residuals.worst { "worst" } else { "" }.to_owned(),
        ]);
    }
    table.row([
        "rms".to_owned(),
        format!("{:.3}", residuals.rms.shift.mm()),
        format!("{:.4}", residuals.rms.rotation.degrees()),
    ]);
    console.table(&table);
    let span = &solved.span;
    let text = format!(
        "the flange turned by {:.0}° at most, about other axes than its main one by {:.0}° (rms); the target moved by \
         {:.0} mm in front of the camera",
        span.largest_turn.degrees(),
        span.other_turn.degrees(),
        span.travel.mm()
    );
    console.entry("span", &text);
    if solved.bounds.shift.0.is_finite() {
        let text = format!(
            "off by less than {:.2} mm where the targets stood and {:.3}° in 95 of 100 cases, if the errors of the \
             pairs are independent",
            solved.bounds.shift.mm(),
            solved.bounds.turn.degrees()
        );
        console.entry("bounds", &text);
    }
    matrix(
        solved.mount.target_transform(),
        &solved.anchor_from_target,
        console,
    );
    matrix(
        solved.mount.camera_transform(),
        &solved.mount_from_camera,
        console,
    );
}

/// JSON line of `calibrate hand-eye --json`.
#[derive(Serialize)]
struct Line<'a> {
    schema: u32,
    pairs_file: String,
    mount: Mount,
    usable: bool,
    robot_from_camera: Option<[f64; 16]>,
    flange_from_camera: Option<[f64; 16]>,
    flange_from_target: Option<[f64; 16]>,
    robot_from_target: Option<[f64; 16]>,
    rms_m: f64,
    rms_rad: f64,
    shift_bound_m: Option<f64>,
    turn_bound_rad: Option<f64>,
    largest_turn_rad: f64,
    other_turn_rad: f64,
    pairs: Vec<PairLine<'a>>,
    doubts: Vec<DoubtLine>,
}

#[derive(Serialize)]
struct PairLine<'a> {
    name: &'a str,
    off_m: f64,
    off_rad: f64,
}

#[derive(Serialize)]
struct DoubtLine {
    what: String,
    advice: String,
    grave: bool,
}

impl<'a> Line<'a> {
    fn of(solved: &'a HandEye, args: &HandEyeArgs) -> Self {
        let on = |mount: Mount, transform| (solved.mount == mount).then(|| row_major(transform));
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        let (x, z) = (&solved.mount_from_camera, &solved.anchor_from_target);
        Self {
            schema: SCHEMA,
            pairs_file: args.pairs.display().to_string(),
            mount: solved.mount,
            usable: solved.is_usable(),
            robot_from_camera: on(Mount::EyeToHand, x),
            flange_from_camera: on(Mount::EyeInHand, x),
            flange_from_target: on(Mount::EyeToHand, z),
            robot_from_target: on(Mount::EyeInHand, z),
            rms_m: solved.residuals.rms.shift.0,
            rms_rad: solved.residuals.rms.rotation.0,
            shift_bound_m: finite(solved.bounds.shift.0),
            turn_bound_rad: finite(solved.bounds.turn.0),
            largest_turn_rad: solved.span.largest_turn.0,
            other_turn_rad: solved.span.other_turn.0,
            pairs: solved
                .residuals
                .pairs
                .iter()
                .map(|pair| PairLine {
                    name: &pair.name,
                    off_m: pair.off.shift.0,
                    off_rad: pair.off.rotation.0,
                })
                .collect(),
            doubts: solved
                .doubts
                .iter()
                .map(|doubt| DoubtLine {
                    what: doubt.to_string(),
                    advice: doubt.advice(),
                    grave: doubt.is_grave(),
                })
                .collect(),
        }
    }
}
