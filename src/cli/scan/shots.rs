//! The frames of a scan with their poses, from a folder, a recording or files.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use super::{PosesChoice, warn_of_excluded};
use crate::{
    capture::{DepthSource as _, Next, Pace, RecordingSpec, Replay},
    cli::{
        calibrate::calibration_if_any,
        console::{Advised as _, Console, advised_error},
        input::open_scene,
    },
    geometry::rigid::RigidTransform,
    robot::{
        calibration::CellCalibration,
        frame_poses::{FRAME_POSES, FramePose, FramePoses},
    },
    scan::{Scan, ScanParams, Shot, Unwatched, assemble},
    stages::scene::{SceneCloud, scene_from_image},
};

/// A frame, and where the arm stood if the recording says it.
struct Frame {
    name: String,
    scene: Arc<SceneCloud>,
    recorded: Option<RigidTransform>,
}

/// Reads frames with their poses and puts them together; warns of what is left out.
pub(in crate::cli) fn open_scan(
    paths: &[PathBuf],
    given: &PosesChoice,
    console: &mut Console,
) -> anyhow::Result<Scan> {
    let frames = match paths {
        [folder] if folder.is_dir() => of_folder(folder, console)?,
        files => of_files(files, console)?,
    };
    let calibration = calibration_if_any(given.calibration.as_deref(), console)?;
    let poses = poses_of(paths, given.poses.as_deref(), &frames, calibration.as_ref())?;
    let shots: Vec<Shot> = frames
        .into_iter()
        .zip(poses)
        .map(|(frame, base_from_camera)| Shot {
            name: frame.name,
            scene: frame.scene,
            base_from_camera,
        })
        .collect();
    let scan = assemble(&shots, &ScanParams::default(), &Unwatched).advised()?;
    console.end_progress();
    warn_of_excluded(&scan, console);
    Ok(scan)
}

fn of_folder(folder: &Path, console: &mut Console) -> anyhow::Result<Vec<Frame>> {
    let spec = RecordingSpec {
        folder: folder.to_owned(),
        pace: Some(Pace::Step),
        camera: None,
    };
    let mut source = Replay::open(&spec).advised()?;
    console.start_progress(source.num_frames());
    let mut frames = Vec::new();
    loop {
        match source.next(Duration::ZERO).advised()? {
            Next::Captured(captured) => {
                console.begin(&captured.name);
                for warning in &captured.warnings {
                    console.warn(&format_args!("{}: {warning}", captured.name), warning);
                }
                frames.push(Frame {
                    scene: Arc::new(scene_from_image(captured.image)),
                    name: captured.name,
                    recorded: captured.robot_from_flange.map(|pose| *pose),
                });
                console.done();
            }
            Next::Skipped(skipped) => console.warn(
                &format_args!("{} is left out: {}", skipped.name, skipped.error),
                &*skipped.error,
            ),
            Next::NotYet => {}
            Next::End => return Ok(frames),
        }
    }
}

fn of_files(files: &[PathBuf], console: &mut Console) -> anyhow::Result<Vec<Frame>> {
    console.start_progress(files.len());
    let mut frames = Vec::new();
    for file in files {
        console.begin(&file.display());
        let (scene, warnings) = open_scene(file).advised()?;
        for warning in &warnings {
            console.warn(&format_args!("{}: {warning}", file.display()), warning);
        }
        let name = file.file_name().unwrap_or(file.as_os_str());
        frames.push(Frame {
            name: name.to_string_lossy().into_owned(),
            scene: Arc::new(scene),
            recorded: None,
        });
        console.done();
    }
    Ok(frames)
}

/// The poses of the cameras: from the file given, else what was recorded, else the file beside the frames.
fn poses_of(
    paths: &[PathBuf],
    given: Option<&Path>,
    frames: &[Frame],
    calibration: Option<&CellCalibration>,
) -> anyhow::Result<Vec<RigidTransform>> {
    let recorded: Option<Vec<RigidTransform>> = frames.iter().map(|f| f.recorded).collect();
    let recorded = recorded.filter(|all| given.is_none() && !all.is_empty());
    if let Some(recorded) = recorded {
        let poses = frames.iter().zip(recorded).map(|(frame, pose)| {
            FramePose::Flange(pose).base_from_camera(&frame.name, calibration)
        });
        return poses.collect::<Result<_, _>>().advised();
    }
    let beside = || {
        let first = paths.first()?;
        let folder = if first.is_dir() {
            first
        } else {
            first.parent()?
        };
        Some(folder.join(FRAME_POSES)).filter(|file| file.is_file())
    };
    let Some(file) = given.map(Path::to_owned).or_else(beside) else {
        return Err(advised_error(
            format!(
                "no poses: neither the frames nor a {FRAME_POSES} beside them say where the camera was"
            ),
            "Give the file with --poses, or record the frames with partsight capture --robot-poses",
        ));
    };
    let names: Vec<String> = frames.iter().map(|frame| frame.name.clone()).collect();
    let poses = FramePoses::read(&file, &names).advised()?;
    let of_frame = |name: &String| {
        let pose = poses.of(name)?;
        Some(pose.base_from_camera(name, calibration))
    };
    let all = names.iter().filter_map(of_frame);
    all.collect::<Result<_, _>>().advised()
}
