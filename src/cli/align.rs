//! `partsight align`: computes the rigid transform from one cloud onto another.

use std::{path::PathBuf, time::Instant};

use clap::Args;
use serde::Serialize;

use super::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error},
    input::{Choice, choice, open_cloud, warn_of},
};
use geometry::{
    cloud::PointCloud,
    error::Advice as _,
    rigid::row_major,
    units::Metres,
    written_pose::{GivenPose, parse_pose},
};
use records::report::SCHEMA;
use stages::pose::{CloudRole, PoseError, PoseEstimate, PoseMethod, PoseWarning, align};
use texts::Message;

/// Align one cloud with another and print the rotation and translation
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight align scan.ply reference.ply
  partsight align scan.ply reference.ply --pose icp --initial \"0 0 30deg 100mm 0 0\"
  partsight align scan.ply reference.ply --pose icp-ga
  partsight align scan.ply door.stl --json

Both are in metres. A mesh is sampled evenly. The result maps points of SOURCE onto TARGET.
Exit codes: 0 aligned, 1 no pose was found or it should not be relied upon (hardly any overlap, ambiguous, not \
settled; the reason says which), 2 a file could not be read.
With --json there is a line even if no pose was found: target_from_source is then null, and reason says why.")]
pub(super) struct AlignArgs {
    /// The cloud that is moved
    source: PathBuf,
    /// The cloud that stays
    target: PathBuf,
    /// Method
    #[arg(long, value_parser = choice(&METHODS), default_value = "global")]
    pose: PoseMethod,
    /// Start pose: three angles (radians, or 90deg) and a shift (metres, or 800mm); R = Rz·Ry·Rx
    #[arg(long, value_name = "\"rx ry rz x y z\"", value_parser = parse_pose, allow_hyphen_values = true)]
    initial: Option<GivenPose>,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

#[rustfmt::skip]
const METHODS: [Choice<PoseMethod>; 3] = [
    ("global", "From any start: many are tried, the best is refined", PoseMethod::Global),
    ("icp", "The paper's iterative closest point, from one start", PoseMethod::Icp),
    ("icp-ga", "The paper's ICP-GA: ICP and a genetic algorithm in turns, from one start", PoseMethod::IcpGa),
];

/// JSON line of `align --json`.
#[derive(Debug, Serialize)]
struct AlignLine<'a> {
    schema: u32,
    source: &'a str,
    target: &'a str,
    method: &'static str,
    target_from_source: Option<[f64; 16]>,
    /// Why there is no pose, or why not to rely on it.
    reason: Option<String>,
    e_m2: Option<f64>,
    rms_m: Option<f64>,
    overlap: Option<f64>,
    shift_bound_m: Option<f64>,
    turn_bound_rad: Option<f64>,
    iterations: Option<usize>,
    stopped: Option<&'static str>,
    ambiguous: bool,
    runner_up_ratio: Option<f64>,
    time_ms: f64,
}

pub(super) fn run(args: &AlignArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let open = |path: &PathBuf| -> anyhow::Result<PointCloud> {
        let (cloud, warnings) = open_cloud(path).advised()?;
        warn_of(path, &warnings, console);
        Ok(PointCloud::from_points(cloud.points))
    };
    let (source, target) = (open(&args.source)?, open(&args.target)?);
    for doubt in args.initial.iter().flat_map(|given| &given.doubts) {
        console.warn(doubt, doubt);
    }
    let initial = args.initial.as_ref().map(|given| given.pose);
    let clock = Instant::now();
    let aligned = align(&source, &target, args.pose, initial);
    let time_ms = clock.elapsed().as_micros() as f64 / 1000.0;
    if let Err(error) = &aligned {
        let message = format!("{}: {error}", paths_meant(args, *error));
        console.error(&advised_error(message, error_advice(error)));
    }
    let doubt = aligned.as_ref().ok().and_then(PoseEstimate::doubt);
    if let Some(doubt) = &doubt {
        console.advise(&format_args!("warning: {doubt}"), &doubt_advice(doubt));
    }
    if args.json {
        let pose = aligned.as_ref().ok();
        let failure = aligned.as_ref().err().map(ToString::to_string);
        let fit = pose.map(|pose| pose.fit);
        let bounds = pose.and_then(|pose| pose.uncertainty);
        let line = AlignLine {
            schema: SCHEMA,
            source: &args.source.display().to_string(),
            target: &args.target.display().to_string(),
            method: args.pose.name(),
            target_from_source: pose.map(|pose| row_major(&pose.target_from_source)),
            reason: failure.or_else(|| doubt.map(|doubt| doubt.to_string())),
            e_m2: fit.map(|fit| fit.e_m2),
            rms_m: fit.map(|fit| fit.rms_m),
            overlap: fit.map(|fit| fit.overlap),
            shift_bound_m: bounds.map(|u| u.shift.0),
            turn_bound_rad: bounds.map(|u| u.turn.0),
            iterations: pose.map(|pose| pose.iterations.len()),
            stopped: pose.map(|pose| pose.stopped.name()),
            ambiguous: pose.is_some_and(PoseEstimate::is_ambiguous),
            runner_up_ratio: pose.and_then(|pose| pose.runner_up).map(|r| r.ratio),
            time_ms,
        };
        console.line(&serde_json::to_string(&line)?);
    } else if let Ok(pose) = &aligned {
        show(pose, time_ms, console);
    }
    Ok(match (aligned, doubt) {
        (Ok(_), None) => Outcome::Accepted,
        _ => Outcome::NotAccepted,
    })
}

/// The advice on an error, with the option of this command that gives a start.
fn error_advice(error: &PoseError) -> String {
    let advice = error.advice();
    match error {
        PoseError::OneSidedPairs { .. } | PoseError::NoOverlap { .. } => {
            format!("{advice}, or give a start with --initial")
        }
        _ => advice,
    }
}

/// As [`error_advice`], on a doubtful pose.
fn doubt_advice(doubt: &PoseWarning) -> String {
    let advice = doubt.advice();
    match doubt {
        PoseWarning::Ambiguous { .. } | PoseWarning::Unsettled { .. } => {
            format!("{advice}, with --initial")
        }
        PoseWarning::LittleOverlap { .. }
        | PoseWarning::Loose { .. }
        | PoseWarning::OffScale(_) => advice,
    }
}

/// Names the file that an error is about, or both.
fn paths_meant(args: &AlignArgs, error: PoseError) -> String {
    let (source, target) = (args.source.display(), args.target.display());
    match error {
        PoseError::TooFewPoints {
            which: CloudRole::Source,
            ..
        }
        | PoseError::Degenerate {
            which: CloudRole::Source,
            ..
        } => source.to_string(),
        PoseError::TooFewPoints {
            which: CloudRole::Target,
            ..
        }
        | PoseError::Degenerate {
            which: CloudRole::Target,
            ..
        } => target.to_string(),
        _ => Message::new("pose-onto")
            .with("source", &*source.to_string())
            .with("target", &*target.to_string())
            .to_string(),
    }
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
    if let Some(bounds) = pose.uncertainty {
        let (shift, turn) = (bounds.shift.mm(), bounds.turn.degrees());
        let text = match bounds.freedom {
            None => {
                format!("off by less than {shift:.2} mm and {turn:.3} degrees in 95 of 100 cases")
            }
            Some(freedom) => format!("unconstrained: {freedom}"),
        };
        row("bounds", text);
    }
    row(
        "method",
        format!(
            "{}, {} after {} iterations, {time_ms:.1} ms",
            pose.method.name(),
            pose.stopped,
            pose.iterations.len()
        ),
    );
    console.table(&table);
}

#[cfg(test)]
mod tests {
    use super::*;
    use stages::fixtures::pose_errors;

    #[test]
    fn only_this_command_advises_a_start_by_its_option() {
        for error in pose_errors() {
            assert!(!error.advice().contains("--"), "{}", error.advice());
        }
        let far = PoseError::NoOverlap {
            found: 3,
            needed: 12,
            reach: Metres(0.05),
        };
        assert!(error_advice(&far).ends_with("give a start with --initial"));
        let ambiguous = PoseWarning::Ambiguous { ratio: 1.02 };
        assert!(!ambiguous.advice().contains("--"));
        assert!(doubt_advice(&ambiguous).ends_with("with --initial"));
    }
}
