//! `partsight simulate --scan DIR`: writes frames of one part from several sides, with the poses that a robot would
//! report.

use std::path::Path;

use serde_json::json;

use super::SimulateArgs;
use crate::{
    cli::{
        Outcome,
        console::{Advised as _, Console, advised_error},
        write_json,
    },
    files::{disk, write_depth_png},
    geometry::rigid::row_major,
    robot::frame_poses::FRAME_POSES,
    simulate::{ScanSetup, SimulatedScan},
    units::{Metres, Radians},
};

/// Typical errors of the poses that a robot reports.
const PLACE_ERROR: Metres = Metres(0.003);
const TURN_ERROR: Radians = Radians(0.005);

pub(super) fn run(
    folder: &Path,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let subjects = args.subjects();
    let [subject] = subjects.as_slice() else {
        return Err(advised_error(
            format!(
                "{} parts are named, but a scan shows only one",
                subjects.len()
            ),
            "Name one, such as --part fender",
        ));
    };
    disk::create_dir_all(folder).map_err(|error| {
        advised_error(
            format!("{}: {error}", folder.display()),
            "Give a folder that can be written",
        )
    })?;
    let scan = SimulatedScan::new(ScanSetup {
        subject: *subject,
        num_shots: args.shots,
        place_error: PLACE_ERROR,
        turn_error: TURN_ERROR,
        noise: args.noise,
        seed: args.seed,
    });
    let mut frames = serde_json::Map::new();
    console.start_progress(args.shots);
    for (k, shot) in scan.shots().iter().enumerate() {
        let name = format!("frame-{:02}.png", k + 1);
        console.begin(&name);
        write_depth_png(&folder.join(&name), &shot.frame).advised()?;
        let pose = json!({
            "world_from_camera": row_major(&shot.given),
            "true_world_from_camera": row_major(&shot.base_from_camera),
        });
        frames.insert(name, pose);
        console.done();
    }
    console.end_progress();
    let poses = json!({
        "base_from_model": row_major(&scan.base_from_model),
        "frames": frames,
    });
    write_json(&folder.join(FRAME_POSES), &poses)?;
    console.line(&format_args!(
        "{}: {} simulated frames and their poses. Now: partsight scan {0} --out scan.ply",
        folder.display(),
        args.shots
    ));
    Ok(Outcome::Accepted)
}
