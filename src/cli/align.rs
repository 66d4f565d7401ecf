//! `partsight align`: the rigid transform that lays one cloud over another.

use std::{path::PathBuf, time::Instant};

use clap::Args;
use serde::Serialize;

use super::{
    MethodChoice, Outcome,
    console::{Advised as _, Console, Table},
    input::{open_cloud, parse_pose},
    verdict::SCHEMA,
};
use crate::{
    geometry::{
        cloud::PointCloud,
        rigid::{RigidTransform, row_major},
    },
    stages::pose::{PoseEstimate, align},
    units::Metres,
};

/// Lay one cloud over another and say by what turn and shift
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight align scan.ply reference.ply
  partsight align scan.ply reference.ply --pose icp --initial \"0 0 30deg 100mm 0 0\"
  partsight align scan.ply door.stl --json

Both in metres. A mesh is sampled evenly. The answer maps points of SOURCE onto TARGET.
Exit codes: 0 aligned, 1 no pose was found, 2 a file could not be read.")]
pub(super) struct AlignArgs {
    /// The cloud that is moved
    source: PathBuf,
    /// The cloud that stays
    target: PathBuf,
    /// How
    #[arg(long, value_enum, default_value_t = MethodChoice::Global)]
    pose: MethodChoice,
    /// Where to start: three angles (radians, or 90deg) and a shift (metres, or 800mm); R = Rz·Ry·Rx
    #[arg(long, value_name = "\"rx ry rz x y z\"", value_parser = parse_pose, allow_hyphen_values = true)]
    initial: Option<RigidTransform>,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

/// The line of `align --json`.
#[derive(Debug, Serialize)]
struct AlignLine<'a> {
    schema: u32,
    source: &'a str,
    target: &'a str,
    method: &'static str,
    target_from_source: [f64; 16],
    e_m2: f64,
    rms_m: f64,
    overlap: f64,
    iterations: usize,
    stopped: &'static str,
    ambiguous: bool,
    runner_up_ratio: Option<f64>,
    time_ms: f64,
}

pub(super) fn run(args: &AlignArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let open = |path: &PathBuf| -> anyhow::Result<PointCloud> {
        let (cloud, warnings) = open_cloud(path).advised()?;
        for warning in &warnings {
            console.warn(&format_args!("{}: {warning}", path.display()), warning);
        }
        Ok(PointCloud::from_points(cloud.points))
    };
    let (source, target) = (open(&args.source)?, open(&args.target)?);
    let clock = Instant::now();
    let aligned = align(&source, &target, args.pose.into(), args.initial);
    let time_ms = clock.elapsed().as_micros() as f64 / 1000.0;
    let pose = match aligned.advised() {
        Ok(pose) => pose,
        Err(error) => {
            console.error(&error);
            return Ok(Outcome::NotAccepted);
        }
    };
    if args.json {
        let line = AlignLine {
            schema: SCHEMA,
            source: &args.source.display().to_string(),
            target: &args.target.display().to_string(),
            method: pose.method.name(),
            target_from_source: row_major(&pose.target_from_source),
            e_m2: pose.fit.e_m2,
            rms_m: pose.fit.rms_m,
            overlap: pose.fit.overlap,
            iterations: pose.iterations.len(),
            stopped: pose.stopped.name(),
            ambiguous: pose.is_ambiguous(),
            runner_up_ratio: pose.runner_up.map(|r| r.ratio),
            time_ms,
        };
        console.line(&serde_json::to_string(&line)?);
    } else {
        show(&pose, time_ms, console);
    }
    Ok(Outcome::Accepted)
}

fn show(pose: &PoseEstimate, time_ms: f64, console: &mut Console) {
    let transform = &pose.target_from_source;
    let (rx, ry, rz) = transform.rotation.euler_angles();
    let [x, y, z] = [0, 1, 2].map(|i| Metres(transform.translation.vector[i]).mm());
    let [rx, ry, rz] = [rx, ry, rz].map(f64::to_degrees);
    let mut table = Table::default();
    let mut row = |what: &str, text: String| table.row([what.to_owned(), text]);
    row(
        "turn",
        format!("rx {rx:.3}  ry {ry:.3}  rz {rz:.3} degrees (Rz·Ry·Rx)"),
    );
    row("shift", format!("x {x:.2}  y {y:.2}  z {z:.2} mm"));
    row(
        "fit",
        format!(
            "{:.2} mm rms, {:.0} % of the source lies on the target, E {:.2e} m²",
            pose.fit.rms_m * 1000.0,
            pose.fit.overlap * 100.0,
            pose.fit.e_m2
        ),
    );
    row(
        "method",
        format!(
            "{}, {} after {} iterations, {time_ms:.1} ms",
            pose.method.name(),
            pose.stopped.name().replace('_', " "),
            pose.iterations.len()
        ),
    );
    if pose.is_ambiguous() {
        row("beware", "another pose fits as well".to_owned());
        row("to do", "Say where to start with --initial".to_owned());
    }
    table.show(console);
}
