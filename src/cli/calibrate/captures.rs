//! Camera poses from captures of an enrolled part.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::{
    LibraryChoice,
    console::{Advised as _, Console, advised_error},
    input::{open_scene, warn_of},
};
use capture::may_be_capture;
use files::{file_name, in_counting_order};
use geometry::error::Advice as _;
use inspection::{
    library::Library,
    pipeline::{self, Recipe, Unwatched},
};
use robot::{
    Convention,
    hand_eye::{PosePair, Target},
    pairs::{ArmPose, read_arm_poses},
    part_target::{ObservedTarget, seen_part},
};
use stages::reference::ReferenceParams;

/// What the camera saw, where it is not in the file of pairs.
#[derive(Debug, Args)]
pub(super) struct TargetChoice {
    /// Captures of an enrolled part that is the target; PAIRS then holds the robot's poses alone
    #[arg(long, value_name = "DIR")]
    pub(super) captures: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryChoice,
}

/// Inspects the capture of every pose; captures that are not accepted or show another part than most are named and left
/// out.
pub(super) fn pairs_of_captures(
    poses: &Path,
    convention: Option<Convention>,
    folder: &Path,
    targets: &TargetChoice,
    console: &mut Console,
) -> anyhow::Result<(Vec<PosePair>, Target)> {
    let (poses, convention) = read_arm_poses(poses, convention).advised()?;
    let files = files_of(folder, &poses)?;
    let library = targets
        .library
        .load_some(&ReferenceParams::default(), console)?
        .library;
    console.note(&format_args!(
        "{} poses of the robot in {}",
        poses.len(),
        convention.title()
    ));
    console.start_progress(poses.len());
    let mut seen: Vec<(PosePair, ObservedTarget)> = Vec::new();
    for (pose, file) in poses.iter().zip(&files) {
        console.begin(&file.display());
        if let Some(part) = seen_in(file, &library, false, console)? {
            let pair = PosePair {
                name: match &pose.capture {
                    Some(_) => pose.place.clone(),
                    None => format!("{} ({})", file_name(file), pose.place),
                },
                robot_from_flange: pose.robot_from_flange,
                camera_from_target: part.camera_from_target,
            };
            seen.push((pair, part));
        }
        console.done();
    }
    console.end_progress();
    Ok(of_one_part(seen, console))
}

/// Inspects a capture; if no enrolled part is seen there well enough, or if it must be whole and is not, names and leaves it out.
pub(super) fn seen_in(
    file: &Path,
    library: &Library,
    must_be_whole: bool,
    console: &Console,
) -> anyhow::Result<Option<ObservedTarget>> {
    let (scene, warnings) = open_scene(file).advised()?;
    warn_of(file, &warnings, console);
    let inspection = pipeline::run(&scene, library, &Recipe::default(), &Unwatched)?;
    let seen = match seen_part(&inspection, &scene, library) {
        Ok(_) if must_be_whole && inspection.touches_edge() => Err((
            "the part is cut off by the edge of the picture".to_owned(),
            "Take frames that show all of it".to_owned(),
        )),
        Ok(part) => Ok(part),
        Err(error) => Err((error.to_string(), error.advice())),
    };
    if let Err((why, advice)) = &seen {
        console.advise(&format_args!("left out {}: {why}", file.display()), advice);
    }
    Ok(seen.ok())
}

/// Returns the captures of the poses: by name, or all of the folder in counting order.
fn files_of(folder: &Path, poses: &[ArmPose]) -> anyhow::Result<Vec<PathBuf>> {
    let named: Option<Vec<&String>> = poses.iter().map(|pose| pose.capture.as_ref()).collect();
    if let Some(names) = named {
        return Ok(names.into_iter().map(|name| folder.join(name)).collect());
    }
    let listed = std::fs::read_dir(folder).map_err(|error| {
        advised_error(
            format!("{}: cannot be read: {error}", folder.display()),
            "Give the folder of the captures",
        )
    })?;
    let mut files: Vec<PathBuf> = listed
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| may_be_capture(path))
        .collect();
    files.sort_by_cached_key(|path| in_counting_order(&file_name(path)));
    if files.len() != poses.len() {
        return Err(advised_error(
            format!(
                "{} captures in {}, and {} poses of the robot",
                files.len(),
                folder.display(),
                poses.len()
            ),
            "Write the name of its capture before each pose",
        ));
    }
    Ok(files)
}

/// Returns the pairs of the reference that most captures show, since each reference has its own frame.
fn of_one_part(
    seen: Vec<(PosePair, ObservedTarget)>,
    console: &Console,
) -> (Vec<PosePair>, Target) {
    let count = |reference: usize| {
        seen.iter()
            .filter(|(_, part)| part.reference == reference)
            .count()
    };
    let most = seen.iter().max_by_key(|(_, part)| count(part.reference));
    let Some(target) = most.map(|(_, part)| part.clone()) else {
        return (Vec::new(), Target::Marker);
    };
    console.note(&format_args!("The target is {}", target.part));
    let mut pairs = Vec::new();
    for (pair, part) in seen {
        if part.reference == target.reference {
            pairs.push(pair);
        } else {
            console.note(&format_args!(
                "left out {}: it shows {}",
                pair.name, part.part
            ));
        }
    }
    let normal = target.normal;
    (pairs, Target::Part { normal })
}
