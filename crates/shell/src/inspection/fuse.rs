//! Reads shots with their poses and puts them together, in a task.

use std::{
    cell::Cell,
    collections::BTreeSet,
    ops::ControlFlow,
    panic::resume_unwind,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
    time::{Duration, SystemTime},
};

use super::{
    scan_choice::{ScanFiles, ScanOrder, ScanRequest, ShotChoice, ShotSet},
    scan_figure::{ScanFigure, ShotRow, rows},
    source::Origin,
};
use files::file_name;
use geometry::{error::Advice, rigid::RigidTransform};
use inspection::pipeline::{ProgressObserver, Stage};
use records::history::{FrameError, read_shots};
use robot::{
    calibration::CellCalibration,
    frame_poses::FramePosesError,
    scan_frames::{
        FrameNews, ScanFramesError, first_captured_at, poses_beside, read_frames, with_poses,
    },
};
use stages::scan::{Scan, ScanError, ScanObserver, ScanParams, ScanStep, Shot, assemble};
use ui::{
    language::{Message, described},
    user_error::UserError,
};

/// Shots put together.
#[derive(Debug)]
pub struct FusedShots {
    /// The shots, and which of them were dropped.
    pub choice: ShotChoice,
    /// The result for the shots that were not dropped.
    pub scan: Scan,
    /// One row per shot of the choice, in its order.
    pub rows: Vec<ShotRow>,
    /// Data of the 3-D view.
    pub figure: ScanFigure,
    /// Problems found in the files.
    pub warnings: Vec<UserError>,
}

impl FusedShots {
    /// Number of shots that the result is based on.
    pub fn num_used(&self) -> usize {
        self.scan.used().count()
    }

    /// Pose, according to the robot, of the camera whose frame the figure uses.
    pub fn space(&self) -> Option<RigidTransform> {
        self.scan.used().next().map(|(_, shot)| shot.given)
    }

    /// Origin of the scan.
    pub fn origin(&self) -> Origin {
        Origin::Scan {
            name: self.choice.set.files.title(),
            num_shots: self.num_used(),
            is_simulated: self.scan.cloud.cloud.is_simulated,
            files: self.choice.files(),
        }
    }

    /// Returns the name shown to the user.
    pub fn title(&self) -> String {
        let title = self.choice.set.files.title();
        format!("{title} · {} shots", self.num_used())
    }
}

/// Why shots cannot be put together.
#[derive(Debug, thiserror::Error, Advice)]
pub enum FuseError {
    /// The frames or their poses cannot be read.
    #[error(transparent)]
    #[advice(match _0 {
        ScanFramesError::NoPoses => {
            "Choose the file of the poses; its form is described by partsight help scan".into()
        }
        ScanFramesError::Poses(FramePosesError::Missing { .. }) => {
            "Choose a file that has them, or add them to this one and open the scan again".into()
        }
        ScanFramesError::Poses(FramePosesError::NoCalibration { .. } | FramePosesError::CameraIsFixed { .. }) => {
            "Load the calibration of the camera on the flange (Robot…, B), then open the scan again".into()
        }
        other => other.advice(),
    })]
    Frames(#[from] ScanFramesError),
    /// The shots in the history cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Kept(#[from] FrameError),
    /// The shots do not fit together.
    #[error(transparent)]
    #[advice(match _0 {
        ScanError::TooFewShots { found: 1 } => {
            "Open a folder with frames from other sides too, or open this frame by itself (Ctrl O)".into()
        }
        ScanError::TooFewShots { .. } => "Open the folder that holds the frames".into(),
        other => other.advice(),
    })]
    Scan(#[from] ScanError),
    /// Another shot has the same name.
    #[error("{name} is among the shots already")]
    #[advice = "Rename the file and its entry among the poses"]
    NameTaken {
        /// Name of both shots.
        name: String,
    },
}

impl FuseError {
    /// True if the user can help by choosing a file of poses.
    pub fn wants_poses(&self) -> bool {
        matches!(
            self,
            Self::Frames(
                ScanFramesError::NoPoses | ScanFramesError::Poses(FramePosesError::Missing { .. })
            )
        )
    }

    fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Frames(ScanFramesError::Cancelled) | Self::Scan(ScanError::Cancelled)
        )
    }
}

/// Counts the steps of a request.
pub struct Steps<'a> {
    watch: &'a dyn ProgressObserver,
    /// Called with the steps done and the total steps.
    report: &'a dyn Fn(usize, usize),
    done: Cell<usize>,
    total: Cell<usize>,
}

impl<'a> Steps<'a> {
    pub fn new(watch: &'a dyn ProgressObserver, report: &'a dyn Fn(usize, usize)) -> Self {
        Self {
            watch,
            report,
            done: Cell::new(0),
            total: Cell::new(0),
        }
    }

    fn expect(&self, num: usize) {
        self.total.set(self.total.get() + num);
    }

    fn step(&self) {
        self.done.set(self.done.get() + 1);
        let total = self.total.get().max(self.done.get());
        (self.report)(self.done.get(), total);
    }
}

/// The inspection of each shot begins with its segmentation, which counts as one step.
impl ProgressObserver for Steps<'_> {
    fn begins(&self, stage: Stage) {
        if stage == Stage::Segment {
            self.step();
        }
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

/// What follows the fusion; decides the number of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    /// Every shot is inspected.
    Inspect,
    /// A part is enrolled.
    Enrol,
}

/// Reads the shots and puts them together; `None` if cancelled.
pub fn fuse(
    request: &ScanRequest,
    then: Then,
    steps: &Steps<'_>,
) -> Result<Option<FusedShots>, FuseError> {
    let mut warnings = Vec::new();
    let fused = read(request, steps, &mut warnings).and_then(|choice| {
        let num = choice.num_taken();
        steps.expect(match then {
            Then::Inspect => 2 * num + 2,
            Then::Enrol => num + 2,
        });
        let shots = choice.set.shots.iter().enumerate();
        let taken = shots.filter(|(place, _)| !choice.dropped.contains(place));
        let taken: Vec<Shot> = taken.map(|(_, shot)| shot.clone()).collect();
        let params = ScanParams {
            segment: request.recipe.segment.clone(),
            ..ScanParams::default()
        };
        let scan = assembled(&taken, &params, steps)?;
        let rows = rows(&choice, &scan);
        let figure = ScanFigure::of(&choice, &scan);
        Ok(FusedShots {
            choice,
            scan,
            rows,
            figure,
            warnings,
        })
    });
    match fused {
        Err(error) if error.is_cancelled() => Ok(None),
        fused => fused.map(Some),
    }
}

fn read(
    request: &ScanRequest,
    steps: &Steps<'_>,
    warnings: &mut Vec<UserError>,
) -> Result<ShotChoice, FuseError> {
    let calibration = || {
        let path = request.calibration.as_deref();
        path.map_or(Ok(None), CellCalibration::load_if_there)
    };
    let mut frames_of = |paths: &[PathBuf], poses: Option<&Path>| {
        let frames = read_frames(paths, &mut |news| {
            match news {
                FrameNews::Total(num) => steps.expect(num),
                FrameNews::Read(name, odd) => {
                    steps.step();
                    warnings.extend(odd.iter().map(|warning| UserError {
                        what: format!("{name}: {warning}"),
                        advice: warning.advice(),
                    }));
                }
                FrameNews::Skipped(skipped) => {
                    steps.step();
                    let left_out = Message::new("left-out")
                        .with("name", &*skipped.name)
                        .with("why", &*skipped.error.to_string());
                    warnings.push(UserError {
                        what: described(&left_out),
                        advice: skipped.error.advice(),
                    });
                }
            }
            if steps.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        let captured_at = first_captured_at(&frames);
        let shots = with_poses(paths, poses, frames, calibration);
        shots.map(|shots| (shots, captured_at))
    };
    match &request.order {
        ScanOrder::Known(choice) => Ok(choice.clone()),
        // The history keeps only shots that were not dropped.
        ScanOrder::Kept(kept) => Ok(ShotChoice {
            dropped: BTreeSet::new(),
            set: Arc::new(ShotSet {
                files: ScanFiles::of_past(&kept.origin),
                shots: read_shots(&kept.folder, &kept.frame)?,
                captured_at: SystemTime::UNIX_EPOCH,
            }),
        }),
        ScanOrder::Open(files) => {
            let (mut shots, mut captured_at) = frames_of(&files.frames, files.poses.as_deref())?;
            for (frame, poses) in &files.added {
                let (added, at) = frames_of(std::slice::from_ref(frame), Some(poses))?;
                shots.extend(added);
                captured_at = captured_at.min(at);
            }
            let is_dropped = |shot: &Shot| files.dropped.contains(&shot.name);
            let dropped = (0..shots.len()).filter(|place| is_dropped(&shots[*place]));
            Ok(ShotChoice {
                dropped: dropped.collect(),
                set: Arc::new(ShotSet {
                    files: files.clone(),
                    shots,
                    captured_at,
                }),
            })
        }
        ScanOrder::Add(choice, frame, given) => {
            add_frame(choice, frame, given.as_deref(), |paths, poses| {
                frames_of(paths, Some(poses))
            })
        }
    }
}

/// Adds a frame to the shots. `read` reads it with its pose from a file: the one given, else that of the scan or one beside
/// the frame.
fn add_frame(
    choice: &ShotChoice,
    frame: &Path,
    given: Option<&Path>,
    mut read: impl FnMut(&[PathBuf], &Path) -> Result<(Vec<Shot>, SystemTime), ScanFramesError>,
) -> Result<ShotChoice, FuseError> {
    let name = file_name(frame);
    let mut shots = choice.set.shots.clone();
    if shots.iter().any(|shot| shot.name == name) {
        return Err(FuseError::NameTaken { name });
    }
    let mut files = choice.set.files.clone();
    let paths = [frame.to_owned()];
    let candidates = if let Some(given) = given {
        vec![given.to_owned()]
    } else {
        // The file may have got a pose for this frame since the scan was read.
        let of_scan = files.poses.clone().or_else(|| poses_beside(&files.frames));
        of_scan.into_iter().chain(poses_beside(&paths)).collect()
    };
    let mut found = Err(ScanFramesError::NoPoses);
    for file in candidates {
        found = read(&paths, &file).map(|read| (read, file));
        if found.is_ok() {
            break;
        }
    }
    let ((added, at), file) = found?;
    shots.extend(added);
    let [frame] = paths;
    files.added.push((frame, file));
    Ok(ShotChoice {
        dropped: choice.dropped.clone(),
        set: Arc::new(ShotSet {
            files,
            shots,
            captured_at: choice.set.captured_at.min(at),
        }),
    })
}

/// Carries progress and cancellation between the threads of a fusion.
#[derive(Default)]
struct Relay {
    num_begun: AtomicUsize,
    is_cancelled: AtomicBool,
}

impl ScanObserver for Relay {
    fn begins(&self, _step: ScanStep) {
        self.num_begun.fetch_add(1, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Interval for checking cancellation.
const LOOKS: Duration = Duration::from_millis(10);

/// Puts the shots together on a separate thread, because `steps` can only be used on this one.
fn assembled(shots: &[Shot], params: &ScanParams, steps: &Steps<'_>) -> Result<Scan, ScanError> {
    let relay = Relay::default();
    thread::scope(|scope| {
        let work = scope.spawn(|| assemble(shots, params, &relay));
        let mut num_told = 0;
        loop {
            let is_done = work.is_finished();
            relay
                .is_cancelled
                .store(steps.is_cancelled(), Ordering::Relaxed);
            while num_told < relay.num_begun.load(Ordering::Relaxed) {
                num_told += 1;
                steps.step();
            }
            if is_done {
                break;
            }
            thread::sleep(LOOKS);
        }
        work.join().unwrap_or_else(|panic| resume_unwind(panic))
    })
}
