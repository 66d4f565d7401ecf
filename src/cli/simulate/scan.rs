//! `partsight simulate --scan DIR`: writes frames of one part from several sides, with the poses that a robot would
//! report.

use std::{collections::BTreeSet, path::Path};

use serde_json::json;

use super::SimulateArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    write_json,
};
use files::{depth_png::intrinsics_path, disk, file_name, write_depth_png};
use geometry::{
    rigid::row_major,
    units::{Metres, Radians},
};
use robot::frame_poses::FRAME_POSES;
use simulate::{ScanSetup, SimulatedScan};

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
    refuse_other_files(folder, args.shots)?;
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
        let name = frame_name(k);
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

fn frame_name(k: usize) -> String {
    format!("frame-{:02}.png", k + 1)
}

/// Refuses a folder with files that are not replaced, such as the frames of an earlier scan with more of them: they would
/// belong to this scan, too.
fn refuse_other_files(folder: &Path, num_shots: usize) -> anyhow::Result<()> {
    let unreadable = |error: std::io::Error| {
        advised_error(
            format!("{}: {error}", folder.display()),
            "Give a folder that can be read",
        )
    };
    let mut written = BTreeSet::from([FRAME_POSES.to_owned()]);
    for k in 0..num_shots {
        let camera = intrinsics_path(Path::new(&frame_name(k)));
        written.extend([frame_name(k), file_name(&camera)]);
    }
    for entry in folder.read_dir().map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name();
        if !written.contains(&*name.to_string_lossy()) {
            return Err(advised_error(
                format!(
                    "{}: {} is no file of this scan and would become part of it",
                    folder.display(),
                    name.display()
                ),
                "Give a new folder, or empty this one first",
            ));
        }
    }
    Ok(())
}
