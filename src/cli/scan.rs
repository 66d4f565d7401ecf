//! `partsight scan`: fuses several frames with known camera poses into one cloud.

mod output;

use std::{
    collections::BTreeMap,
    fmt::Display,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::SystemTime,
};

use clap::Args;

use self::output::{ScanLine, show};
use super::{
    Outcome,
    calibrate::scan_calibration,
    console::{Advised as _, Console, advised_error},
};
use files::{PointProperty, file_name, write_atomically, write_ply_with};
use robot::scan_frames::{FrameNews, first_captured_at, read_frames, with_poses};
use stages::{
    scan::{FusedCloud, Scan, ScanParams, Unwatched, assemble_all},
    segment::SegmentParams,
};
use texts::Message;

/// Where the camera was for each frame of a scan.
#[derive(Debug, Args)]
pub(super) struct PosesChoice {
    /// With a scan: pose of the camera or flange for each frame (see partsight help scan); default: poses.json beside
    /// the frames
    #[arg(long, value_name = "FILE")]
    poses: Option<PathBuf>,
    /// With a scan given by flange poses: where the camera sits on the flange, as written by `calibrate`; default: your
    /// own calibration, if there is one
    #[arg(
        id = "scan_calibration",
        long = "scan-calibration",
        value_name = "FILE"
    )]
    calibration: Option<PathBuf>,
}

/// Fuse several frames of one part, each taken at a known pose of the camera on the robot
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight scan frames/ --out fender.ply
  partsight scan frames/ --poses truth.json --out fender.ply --part-only
  partsight scan booth/left2_*.png --poses booth/truth.json --out fender.ply --json

Poses: a file such as
  {\"frames\": {\"a.png\": {\"world_from_camera\": [16 numbers of the 4x4 matrix, row by row, metres]},
              \"b.png\": {\"world_from_camera\": [...]}}}
Where the robot gives the flange's pose, write base_from_flange instead; the hand-eye calibration then says where the \
camera sits. A recording made with partsight capture --robot-poses needs no such file.
The poses may be off by some millimetres and tenths of a degree: they are refined against each other. A frame that does \
not fit, or overlaps no other, is named and left out.
The cloud is written in the robot's base frame, in metres, with normals. For each point, num_shots is the number of frames \
that saw it, bit k of seen_by is set if frame k did (seen_by_high for frames 32 and up), and part is 1 on the part.
Exit codes: 0 every frame was used, 1 some were left out or no part was found, 2 it could not run.")]
pub(super) struct ScanArgs {
    /// A folder of frames, a recording, or the frames themselves
    #[arg(required = true, value_name = "DIR")]
    frames: Vec<PathBuf>,
    #[command(flatten)]
    poses: PosesChoice,
    /// The cloud to write, PLY
    #[arg(long, value_name = "FILE.ply", value_parser = ply_path)]
    out: PathBuf,
    /// Write the part alone, without the cell
    #[arg(long)]
    part_only: bool,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

fn ply_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("ply") => Ok(path),
        _ => Err("the cloud is written as PLY: end the name in .ply".into()),
    }
}

pub(super) fn run(args: &ScanArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let segment = SegmentParams::default();
    let (scan, _) = open_scan(&args.frames, &args.poses, &segment, console)?;
    let part = scan.cloud.part();
    let has_part = !part.cloud.points.is_empty();
    let written = if args.part_only { &part } else { &scan.cloud };
    if written.cloud.points.is_empty() {
        return Err(advised_error(
            "no frame shows a part before the background",
            "Leave --part-only out to see the fused cloud",
        ));
    }
    write(&args.out, written).advised()?;
    if args.json {
        let out = args.out.display().to_string();
        console.line(&serde_json::to_string(&ScanLine::of(&scan, &part, &out))?);
    } else {
        show(&scan, &part, console);
        console.line(&format_args!("Written to {}", args.out.display()));
    }
    let all_used = scan.shots.iter().all(|shot| shot.excluded.is_none());
    Ok(Outcome::accepted_if(all_used && has_part))
}

fn left_out(name: &str, why: &dyn Display) -> Message {
    Message::new("left-out")
        .with("name", name)
        .with("why", &*why.to_string())
}

/// Reads frames with their poses and fuses them, each segmented with these parameters; warns of frames left out and of frames
/// that fit poorly. Also returns when the first of the frames was captured.
pub(super) fn open_scan(
    paths: &[PathBuf],
    given: &PosesChoice,
    segment: &SegmentParams,
    console: &mut Console,
) -> anyhow::Result<(Scan, SystemTime)> {
    refuse_one_name_twice(paths)?;
    let frames = read_frames(paths, &mut |news| {
        match news {
            FrameNews::Total(num) => console.start_progress(num),
            FrameNews::Read(name, warnings) => {
                console.begin(&name);
                for warning in warnings {
                    console.warn(&format_args!("{name}: {warning}"), warning);
                }
                console.done();
            }
            FrameNews::Skipped(skipped) => {
                console.warn(&left_out(&skipped.name, &*skipped.error), &*skipped.error);
            }
        }
        ControlFlow::Continue(())
    })
    .advised()?;
    let captured_at = first_captured_at(&frames);
    let calibration = scan_calibration(given.calibration.as_deref())?;
    let shots = with_poses(paths, given.poses.as_deref(), frames, calibration);
    let params = ScanParams {
        segment: segment.clone(),
        ..ScanParams::default()
    };
    let scan = assemble_all(shots.advised()?, &params, &Unwatched).advised()?;
    console.end_progress();
    for shot in &scan.shots {
        if let Some(why) = &shot.excluded {
            console.warn(&left_out(&shot.name, why), why);
        }
    }
    if let Some(doubt) = &scan.doubt {
        console.warn(doubt, doubt);
    }
    Ok((scan, captured_at))
}

/// Refuses frames of one name, since poses are given by name.
fn refuse_one_name_twice(paths: &[PathBuf]) -> anyhow::Result<()> {
    let mut former: BTreeMap<String, &Path> = BTreeMap::new();
    for path in paths {
        let name = file_name(path);
        match former.insert(name.clone(), path) {
            None => {}
            Some(other) if other == path => {
                return Err(advised_error(
                    format!("{} is given twice", path.display()),
                    "Give each frame once",
                ));
            }
            Some(other) => {
                return Err(advised_error(
                    format!("{} and {} have one name", other.display(), path.display()),
                    "Rename one of them, and its entry among the poses",
                ));
            }
        }
    }
    Ok(())
}

fn write(path: &Path, cloud: &FusedCloud) -> Result<(), files::FileError> {
    let properties: [PointProperty<'_>; 4] = [
        ("num_shots", &|i| cloud.seen_by[i].count_ones()),
        ("seen_by", &|i| cloud.seen_by[i] as u32),
        ("seen_by_high", &|i| (cloud.seen_by[i] >> 32) as u32),
        ("part", &|i| cloud.is_part[i].into()),
    ];
    write_atomically(path, |writer| {
        write_ply_with(writer, &cloud.cloud, &properties)
    })
}
