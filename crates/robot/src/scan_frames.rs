//! The frames of a scan with the poses of their cameras, from a folder, a recording or single files.
//!
//! The poses come from the file given, else from the recording, else from [`FRAME_POSES`] beside the frames.

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, SystemTime},
};

use super::{
    calibration::{CalibrationError, CellCalibration},
    frame_poses::{FRAME_POSES, FramePose, FramePosesError, read_frame_poses},
};
use capture::{
    CaptureError, CaptureWarning, DepthSource as _, NextCapture, Pace, RecordingSpec, Replay,
    SkippedCapture, read_image,
};
use files::{file_name, written_at};
use geometry::{error::Advice, rigid::RigidTransform};
use stages::{
    scan::Shot,
    scene::{SceneCloud, scene_from_image},
};

/// A frame, and the arm's pose if the recording has one.
#[derive(Clone, Debug)]
pub struct ScanFrame {
    /// The frame's file name.
    pub name: String,
    /// The frame's cloud, in camera space.
    pub scene: Arc<SceneCloud>,
    /// When it was captured: as recorded, else when its file was last written.
    pub captured_at: SystemTime,
    /// Transform from the flange frame to the robot's base frame.
    robot_from_flange: Option<RigidTransform>,
}

/// Progress of [`read_frames`].
#[derive(Debug)]
pub enum FrameNews<'a> {
    /// The number of frames, before the first is read.
    Total(usize),
    /// A frame was read: its name and the warnings about it.
    Read(&'a str, &'a [CaptureWarning]),
    /// A frame cannot be read and was skipped.
    Skipped(&'a SkippedCapture),
}

/// Why the frames of a scan or their poses cannot be read.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ScanFramesError {
    /// A frame or the folder cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Frames(#[from] CaptureError),
    /// Neither the frames nor a file beside them have poses.
    #[error("no poses: neither the frames nor a {FRAME_POSES} beside them give the camera's poses")]
    #[advice = "Give the file with --poses, or record the frames with partsight capture --robot-poses"]
    NoPoses,
    /// Poses are missing or unusable.
    #[error(transparent)]
    #[advice(transparent)]
    Poses(#[from] FramePosesError),
    /// The poses are the flange's, and the calibration cannot be read.
    #[error("the poses are the flange's, but the calibration cannot be used: {0}")]
    #[advice(transparent)]
    Calibration(#[from] CalibrationError),
    /// The caller cancelled.
    #[error("reading the frames was cancelled")]
    #[advice = "Start it again"]
    Cancelled,
}

/// Reads the frames of one folder or recording, or the files given. `observer` receives the progress and may cancel.
pub fn read_frames(
    paths: &[PathBuf],
    observer: &mut dyn FnMut(FrameNews<'_>) -> ControlFlow<()>,
) -> Result<Vec<ScanFrame>, ScanFramesError> {
    let mut tell = |news: FrameNews<'_>| match observer(news) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(ScanFramesError::Cancelled),
    };
    let mut frames = Vec::new();
    if let [folder] = paths
        && folder.is_dir()
    {
        let mut source = Replay::open(&RecordingSpec {
            folder: folder.clone(),
            pace: Some(Pace::Step),
            camera: None,
        })?;
        tell(FrameNews::Total(source.num_frames()))?;
        loop {
            match source.next(Duration::ZERO)? {
                NextCapture::Captured(captured) => {
                    tell(FrameNews::Read(&captured.name, &captured.warnings))?;
                    frames.push(ScanFrame {
                        captured_at: captured.taken_at.into(),
                        scene: Arc::new(scene_from_image(captured.image)),
                        name: captured.name,
                        robot_from_flange: captured.robot_from_flange.map(|pose| *pose),
                    });
                }
                NextCapture::Skipped(skipped) => tell(FrameNews::Skipped(&skipped))?,
                NextCapture::NotYet => {}
                NextCapture::End => return Ok(frames),
            }
        }
    }
    tell(FrameNews::Total(paths.len()))?;
    for file in paths {
        let (image, warnings) = read_image(file)?;
        let name = file_name(file);
        tell(FrameNews::Read(&name, &warnings))?;
        frames.push(ScanFrame {
            name,
            captured_at: written_at(file).unwrap_or(SystemTime::UNIX_EPOCH),
            scene: Arc::new(scene_from_image(image)),
            robot_from_flange: None,
        });
    }
    Ok(frames)
}

/// When the first of these frames was captured; the beginning of time if that is not known.
pub fn first_captured_at(frames: &[ScanFrame]) -> SystemTime {
    let times = frames.iter().map(|frame| frame.captured_at);
    times.min().unwrap_or(SystemTime::UNIX_EPOCH)
}

/// Returns the file of poses beside the frames, if there is one.
pub fn poses_beside(paths: &[PathBuf]) -> Option<PathBuf> {
    let first = paths.first()?;
    let folder = if first.is_dir() {
        first
    } else {
        first.parent()?
    };
    Some(folder.join(FRAME_POSES)).filter(|file| file.is_file())
}

/// Joins the frames with the poses of their cameras. `calibration` is called only if a pose is the flange's.
pub fn with_poses(
    paths: &[PathBuf],
    given: Option<&Path>,
    frames: Vec<ScanFrame>,
    calibration: impl FnOnce() -> Result<Option<CellCalibration>, CalibrationError>,
) -> Result<Vec<Shot>, ScanFramesError> {
    let recorded: Option<Vec<FramePose>> = frames
        .iter()
        .map(|frame| frame.robot_from_flange.map(FramePose::Flange))
        .collect();
    let recorded = recorded.filter(|all| given.is_none() && !all.is_empty());
    let poses = if let Some(recorded) = recorded {
        recorded
    } else {
        let file = given.map(Path::to_owned).or_else(|| poses_beside(paths));
        let file = file.ok_or(ScanFramesError::NoPoses)?;
        let names: Vec<String> = frames.iter().map(|frame| frame.name.clone()).collect();
        read_frame_poses(&file, &names)?
    };
    let needs_calibration = poses.iter().any(|p| matches!(p, FramePose::Flange(_)));
    let calibration = if needs_calibration {
        calibration()?
    } else {
        None
    };
    let shot = |(frame, pose): (ScanFrame, FramePose)| {
        Ok(Shot {
            base_from_camera: pose.base_from_camera(&frame.name, calibration.as_ref())?,
            name: frame.name,
            scene: frame.scene,
        })
    };
    frames.into_iter().zip(poses).map(shot).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stages::fixtures::small_scene;

    #[test]
    fn a_calibration_that_cannot_be_read_is_an_error_only_of_poses_that_need_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cell.toml");
        std::fs::write(&path, "mount = ").expect("written");
        let frame = |robot_from_flange| ScanFrame {
            name: "a.png".into(),
            scene: small_scene(1),
            captured_at: SystemTime::UNIX_EPOCH,
            robot_from_flange,
        };
        let poses = folder.path().join(FRAME_POSES);
        let numbers = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
        let text = format!(r#"{{"frames": {{"a.png": {{"world_from_camera": {numbers}}}}}}}"#);
        std::fs::write(&poses, text).expect("written");
        let load = || CellCalibration::load_if_there(&path);
        let shots = with_poses(&[], Some(&poses), vec![frame(None)], load).expect("shots");
        assert_eq!(shots[0].base_from_camera, RigidTransform::identity());
        let recorded = || vec![frame(Some(RigidTransform::identity()))];
        let error = with_poses(&[], None, recorded(), load).expect_err("no calibration");
        assert!(error.to_string().contains("cell.toml"), "{error}");
        assert!(error.advice().contains("Correct the file"), "{error}");
        std::fs::remove_file(&path).expect("there");
        let error = with_poses(&[], None, recorded(), load).expect_err("no calibration");
        assert!(error.advice().contains("calibrat"), "{error}");
        assert!(matches!(
            error,
            ScanFramesError::Poses(FramePosesError::NoCalibration { .. })
        ));
    }
}
