//! `partsight simulate --line DIR`: writes frames of a part that passes on a line, with the counts of its encoder.

use std::{fmt::Write as _, path::Path};

use super::SimulateArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
};
use files::{disk, write_depth_png, write_text};
use simulate::{LineSetup, SensorNoise, SimulatedLine};

/// Number of frames.
const NUM_FRAMES: usize = 12;
/// Time from one to the next, seconds.
const PERIOD_S: f64 = 0.5;

pub(super) fn run(
    folder: &Path,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let unwritable = |error: std::io::Error| {
        advised_error(
            format!("{}: {error}", folder.display()),
            "Give a folder that can be written",
        )
    };
    disk::create_dir_all(folder).map_err(unwritable)?;
    let setup = LineSetup {
        seed: args.seed,
        ..LineSetup::default()
    };
    let line = SimulatedLine::arrange(&setup);
    let mut counts = String::from("# frame; count of the encoder\n");
    let middle = line.seconds_at(line.way_to(0));
    for k in 0..NUM_FRAMES {
        let seconds = middle + PERIOD_S * (k as f64 - 0.5 * (NUM_FRAMES - 1) as f64);
        let name = format!("frame-{:02}.png", k + 1);
        let noise = SensorNoise {
            multiplier: args.noise,
            seed: args.seed.wrapping_add(k as u64),
        };
        write_depth_png(&folder.join(&name), &line.frame(seconds, &noise)).advised()?;
        // Writing to memory does not fail.
        let _ = writeln!(counts, "{name}; {}", line.count(seconds));
    }
    write_text(&folder.join("counts.csv"), &counts).advised()?;
    let part = line.kind_of(0);
    console.line(&format_args!(
        "{0}: {NUM_FRAMES} simulated frames of a passing {1} and their counts. Now: partsight calibrate line {2} {0}/*.png --counts {0}/counts.csv",
        folder.display(),
        part.title().to_lowercase(),
        part.name(),
    ));
    Ok(Outcome::Accepted)
}
