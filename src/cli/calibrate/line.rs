//! `partsight calibrate line`: how a line moves past the camera, and how far for each count of its encoder.

use std::path::PathBuf;

use clap::Args;
use nalgebra::Point3;

use super::{Console, Outcome, captures::seen_in};
use crate::cli::{
    LibraryChoice,
    console::{Advised as _, advised_error},
    input::{Choice, choice, parse_name, within},
};
use files::file_name;
use inspection::library::{Library, PartName};
use robot::{
    line::{CountedPose, Counter, LineCalibration, fit},
    pairs::{FrameCount, read_counts},
};
use stages::reference::ReferenceParams;

/// Calculate how a line moves past the camera: its direction, and its way for each count of its encoder
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight calibrate line fender frames/*.png --counts counts.csv
  partsight calibrate line fender frames/*.png --counts counts.csv --counter-bits 16 --out line2.toml
  partsight calibrate line fender frames/*.png --counts counts.csv --stop s1.png --stop s2.png --stop s3.png --speed 100

Let one enrolled part pass the camera slowly and evenly, without swinging, and take 5 frames or more that show it whole, \
from where it has come in to where it is about to leave. COUNTS has a line for each frame: its name, and the count of the \
encoder when it was taken. Without names, the counts are those of the frames in their order.

  frame-01.png; 40211
  frame-02.png; 40893

With --stop, frames of the same part after the line was stopped also tell how late the camera delivers, if each count was \
read when its frame arrived.

Frames that are not accepted, or show another part, are named and left out. Exit codes: 0 written, 2 the frames do not \
determine the line, or something could not be read.")]
pub(super) struct LineArgs {
    /// The enrolled part that passes
    #[arg(value_name = "PART", value_parser = parse_name)]
    part: PartName,
    /// Frames of it, in the order in which they were taken
    #[arg(value_name = "FRAME", required = true)]
    frames: Vec<PathBuf>,
    /// Table of the counts: the name of each frame and its count
    #[arg(long, value_name = "COUNTS")]
    counts: PathBuf,
    /// A frame of the part after the line was stopped with it in sight, with its count in the same table; may be given several times
    #[arg(long = "stop", value_name = "FRAME", requires = "speed")]
    stopped: Vec<PathBuf>,
    /// Speed of the line while the part passed, mm/s (5 to 1000)
    #[arg(long, value_name = "MM/S", requires = "stopped", value_parser = |text: &str| within(text, &(5.0..=1000.0)))]
    speed: Option<f64>,
    /// Width of the encoder's counter
    #[arg(long, value_name = "BITS", default_value = "32", value_parser = choice(&COUNTERS))]
    counter_bits: Counter,
    /// The file to write
    #[arg(long, value_name = "FILE", default_value = "line.toml")]
    out: PathBuf,
    #[command(flatten)]
    library: LibraryChoice,
}

impl LineArgs {
    /// All frames: those of the passing part, then those after the line was stopped.
    fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.frames.iter().chain(&self.stopped)
    }
}

const COUNTERS: [Choice<Counter>; 2] = [
    ("16", "It begins again at 0 after 65535", Counter::Bits16),
    (
        "32",
        "It begins again at 0 after 4294967295",
        Counter::Bits32,
    ),
];

pub(super) fn run(args: &LineArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let counts = counts_of(args)?;
    let library = args
        .library
        .load_some(&ReferenceParams::default(), console)?
        .library;
    let [passed, stopped] = poses(args, &counts, &library, console)?;
    // The target's origin is the middle of the part.
    let middle = Point3::origin();
    let mut line = fit(&passed, &middle, args.counter_bits).advised()?;
    if let Some(speed) = args.speed {
        let measured = line.with_delay(&passed, &stopped, &middle, speed / 1000.0);
        line = measured.advised()?;
    }
    let line = LineCalibration {
        part: args.part.to_string(),
        made_at: geometry::clock::now(),
        ..line
    };
    line.save(&args.out).advised()?;
    show(&line, &args.out.display().to_string(), console);
    Ok(Outcome::Accepted)
}

/// The poses of the part in the frames in which it passes, and in those after the line was stopped.
fn poses(
    args: &LineArgs,
    counts: &[i64],
    library: &Library,
    console: &mut Console,
) -> anyhow::Result<[Vec<CountedPose>; 2]> {
    console.start_progress(counts.len());
    let mut poses = [Vec::new(), Vec::new()];
    let mut reference = None;
    for ((index, file), count) in args.files().enumerate().zip(counts) {
        console.begin(&file.display());
        let seen = seen_in(file, library, true, console)?;
        let name = args.part.as_str();
        if let Some(part) = seen {
            // Each reference has its own frame.
            if part.part == name && *reference.get_or_insert(part.reference) == part.reference {
                poses[usize::from(index >= args.frames.len())].push(CountedPose {
                    name: file_name(file),
                    count: *count,
                    camera_from_part: part.camera_from_target,
                    bound: None,
                });
            } else {
                console.note(&format_args!(
                    "left out {}: it shows {}, or {name} as another reference",
                    file.display(),
                    part.part
                ));
            }
        }
        console.done();
    }
    console.end_progress();
    Ok(poses)
}

/// The count of each frame.
fn counts_of(args: &LineArgs) -> anyhow::Result<Vec<i64>> {
    let counts = read_counts(&args.counts).advised()?;
    if counts.iter().all(|count| count.frame.is_none()) {
        let num_frames = args.files().count();
        if counts.len() == num_frames {
            return Ok(counts.iter().map(|count| count.count).collect());
        }
        return Err(advised_error(
            format!("{} counts of {num_frames} frames", counts.len()),
            "Write the name of its frame before each count",
        ));
    }
    let count_of = |name: &str| {
        let is_it = |count: &&FrameCount| count.frame.as_deref() == Some(name);
        counts.iter().find(is_it).map(|count| count.count)
    };
    let counted = args.files().map(|file| {
        let name = file_name(file);
        count_of(&name).ok_or_else(|| {
            advised_error(
                format!("{}: no count of {name}", args.counts.display()),
                "Write a line with the name of the frame and its count, or leave the frame out",
            )
        })
    });
    counted.collect()
}

fn show(line: &LineCalibration, path: &str, console: &mut Console) {
    let direction = line.direction;
    console.line(&format_args!("Written to {path}"));
    console.entry(
        "line",
        &format_args!(
            "{:.3} {:.3} {:.3} in the camera's frame while the count rises, within {:.2}°",
            direction.x,
            direction.y,
            direction.z,
            line.direction_bound.degrees()
        ),
    );
    console.entry(
        "encoder",
        &format_args!(
            "{:.6} mm for each count, within {:.2} %",
            line.way_per_count.mm(),
            100.0 * line.scale_bound
        ),
    );
    console.entry(
        "poses",
        &format_args!(
            "{} over {:.0} mm, {:.2} mm off the line (rms)",
            line.num_poses,
            line.way.mm(),
            line.residual.mm()
        ),
    );
    if line.delay_bound > 0.0 {
        console.entry(
            "camera",
            &format_args!(
                "{:.0} ms late, within {:.0} ms",
                1000.0 * line.delay,
                1000.0 * line.delay_bound
            ),
        );
    }
}
