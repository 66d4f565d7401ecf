//! Replays a folder of frames as a source.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use super::{
    manifest::{self, FrameLine, MANIFEST},
    rgbd_sequence::{self, LIST},
};
use crate::{
    error::{CaptureError, CaptureWarning},
    read::{image_of, may_be_capture, read_image},
    source::{Captured, DepthSource, Image, NextCapture, SkippedCapture},
    spec::{Pace, RecordingSpec},
};
use files::{
    DepthCamera, crc32, file_name, in_counting_order, open_bytes, read_bytes, read_depths,
    written_at,
};
use geometry::rigid::RigidTransform;
use simulate::FrameTruth;

/// A folder of frames as a source: a recording, an RGB-D sequence with a list of depth images, or files in numeric order.
pub struct Replay {
    title: String,
    is_simulated: bool,
    frames: Vec<RecordedFrame>,
    /// Time of each frame, relative to the first.
    pub(super) due: Vec<Duration>,
    next: usize,
    started: Option<Instant>,
    folder: PathBuf,
    /// A path that exists as long as the drive is connected: the list of the frames, else their folder.
    root: PathBuf,
    /// Warnings about the whole folder; delivered with the first capture.
    warnings: Vec<CaptureWarning>,
}

/// Content of a folder.
pub(super) struct Frames {
    pub(super) title: String,
    pub(super) is_simulated: bool,
    pub(super) in_order: Vec<RecordedFrame>,
    pub(super) warnings: Vec<CaptureWarning>,
}

/// A frame to be read.
pub(super) struct RecordedFrame {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) taken_at: Option<Timestamp>,
    pub(super) is_simulated: bool,
    pub(super) truth: Option<Arc<FrameTruth>>,
    pub(super) robot_from_flange: Option<RigidTransform>,
    pub(super) content: Content,
}

/// How a frame's file is read.
pub(super) enum Content {
    /// As recorded, with its checksum; depth images have a camera.
    Listed(u32, Option<DepthCamera>),
    /// A depth image of this camera.
    Depth(DepthCamera),
    /// A file of any kind.
    Any,
}

/// Longer pauses are shortened to this.
const MAX_PAUSE: Duration = Duration::from_secs(10);
/// Pause before a frame without a time.
const DEFAULT_PAUSE: Duration = Duration::from_millis(100);

/// True if the folder has a list with the time of each frame.
pub(crate) fn is_sequence(folder: &Path) -> bool {
    folder.join(MANIFEST).is_file() || folder.join(LIST).is_file()
}

impl Replay {
    /// Finds the frames of a folder without reading them.
    pub fn open(spec: &RecordingSpec) -> Result<Self, CaptureError> {
        let folder = &spec.folder;
        if !folder.is_dir() {
            return Err(CaptureError::FolderGone {
                path: folder.clone(),
                may_come: false,
            });
        }
        let [manifest, list] = [MANIFEST, LIST].map(|name| folder.join(name));
        let (root, found) = if manifest.is_file() {
            (manifest, of_recording(folder)?)
        } else if list.is_file() {
            let frames = rgbd_sequence::frames(folder, spec.camera.as_deref())?;
            (list, frames)
        } else {
            (folder.clone(), of_folder(folder)?)
        };
        if found.in_order.is_empty() {
            let path = folder.clone();
            return Err(CaptureError::NoFrames { path });
        }
        Ok(Self {
            title: found.title,
            is_simulated: found.is_simulated,
            due: due_times(&found.in_order, spec.pace.unwrap_or(Pace::AsTaken)),
            frames: found.in_order,
            next: 0,
            started: None,
            folder: folder.clone(),
            root,
            warnings: found.warnings,
        })
    }

    /// Number of frames.
    pub fn num_frames(&self) -> usize {
        self.frames.len()
    }
}

fn of_recording(folder: &Path) -> Result<Frames, CaptureError> {
    let list = manifest::read(folder)?;
    let num_frames = list.frames.len();
    let frames = list.frames.into_iter().map(|line| {
        let FrameLine {
            file,
            crc32,
            taken_at,
            name,
            simulated,
            camera,
            truth,
            robot_from_flange,
            ..
        } = line;
        RecordedFrame {
            name,
            path: folder.join(file),
            taken_at: Some(taken_at),
            is_simulated: simulated,
            truth: truth.map(Arc::new),
            robot_from_flange: robot_from_flange.map(|pose| pose.0),
            content: Content::Listed(crc32, camera),
        }
    });
    let cut_off = list
        .is_cut_off
        .then_some(CaptureWarning::CutOff { num_frames });
    Ok(Frames {
        title: format!("Recording {}, {}", file_name(folder), list.header.title),
        is_simulated: list.header.simulated,
        in_order: frames.collect(),
        warnings: cut_off.into_iter().collect(),
    })
}

/// The clouds and depth images of a folder, with numbers in their names in numeric order.
fn of_folder(folder: &Path) -> Result<Frames, CaptureError> {
    let listed = || -> io::Result<Vec<_>> {
        let paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
        paths.collect()
    };
    let mut paths = listed().map_err(|source| CaptureError::FolderUnreadable {
        path: folder.to_owned(),
        source,
    })?;
    paths.retain(|path| may_be_capture(path) && path.is_file());
    paths.sort_by_cached_key(|path| in_counting_order(&file_name(path)));
    let frames = paths.into_iter().map(|path| RecordedFrame {
        name: file_name(&path),
        path,
        taken_at: None,
        is_simulated: false,
        truth: None,
        robot_from_flange: None,
        content: Content::Any,
    });
    Ok(Frames {
        title: format!("Folder {}", file_name(folder)),
        is_simulated: false,
        in_order: frames.collect(),
        warnings: Vec::new(),
    })
}

fn due_times(frames: &[RecordedFrame], pace: Pace) -> Vec<Duration> {
    let mut due = Duration::ZERO;
    let mut previous: Option<Timestamp> = None;
    let as_taken = |frame: &RecordedFrame| {
        let pause = match (previous, frame.taken_at) {
            // If the clock was set back, there is no pause.
            (Some(previous), Some(taken_at)) => {
                Duration::try_from(taken_at.duration_since(previous))
                    .unwrap_or_default()
                    .min(MAX_PAUSE)
            }
            _ => DEFAULT_PAUSE,
        };
        previous = frame.taken_at;
        due += pause;
        due
    };
    let after_first = |mut times: Vec<Duration>| {
        let first = times.first().copied().unwrap_or_default();
        for time in &mut times {
            *time -= first;
        }
        times
    };
    match pace {
        Pace::AsTaken => after_first(frames.iter().map(as_taken).collect()),
        Pace::Step => vec![Duration::ZERO; frames.len()],
        Pace::PerSecond(rate) => {
            let pause = Duration::try_from_secs_f64(1.0 / rate).unwrap_or(MAX_PAUSE);
            (0..frames.len() as u32)
                .map(|k| pause.saturating_mul(k))
                .collect()
        }
    }
}

impl RecordedFrame {
    fn read(&self) -> Result<(Image, Vec<CaptureWarning>), CaptureError> {
        let depth_frame = |camera: DepthCamera, bytes: &[u8]| {
            let (size, depth) = read_depths(&self.path, bytes)?;
            let frame = camera
                .checked()
                .and_then(|camera| camera.frame(size, depth));
            frame.map_err(|what| self.damaged(what))
        };
        let no_warnings = |image| (image, Vec::new());
        match self.content {
            Content::Any => read_image(&self.path),
            Content::Depth(camera) => {
                let frame = depth_frame(camera, &read_bytes(&self.path)?)?;
                Ok(no_warnings(Image::Depth(frame)))
            }
            Content::Listed(checksum, camera) => {
                let bytes = read_bytes(&self.path)?;
                if crc32(&bytes) != checksum {
                    return Err(self.damaged("its checksum does not match".into()));
                }
                match camera {
                    Some(camera) => {
                        depth_frame(camera, &bytes).map(|frame| no_warnings(Image::Depth(frame)))
                    }
                    None => image_of(open_bytes(&self.path, &bytes), &self.path),
                }
            }
        }
    }

    fn damaged(&self, what: String) -> CaptureError {
        CaptureError::DamagedRecording {
            path: self.path.clone(),
            what,
        }
    }
}

impl DepthSource for Replay {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn is_simulated(&self) -> bool {
        self.is_simulated
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let (Some(frame), Some(due)) = (self.frames.get(self.next), self.due.get(self.next)) else {
            return Ok(NextCapture::End);
        };
        let left = due.saturating_sub(self.started.get_or_insert_with(Instant::now).elapsed());
        thread::sleep(left.min(wait));
        if left > wait {
            return Ok(NextCapture::NotYet);
        }
        self.next += 1;
        match frame.read() {
            Ok((image, warnings)) => Ok(NextCapture::Captured(Captured {
                number: self.next as u64,
                name: frame.name.clone(),
                taken_at: frame
                    .taken_at
                    .or_else(|| written_at(&frame.path).map(geometry::clock::timestamp))
                    .unwrap_or_else(geometry::clock::now),
                arrived: Instant::now(),
                is_simulated: frame.is_simulated || image.is_simulated(),
                image,
                truth: frame.truth.clone(),
                robot_from_flange: frame.robot_from_flange.map(Box::new),
                warnings: self.warnings.drain(..).chain(warnings).collect(),
            })),
            // The drive was removed: report it once instead of each of the remaining frames.
            Err(_) if !self.root.exists() => {
                self.next -= 1;
                Err(CaptureError::FolderGone {
                    path: self.folder.clone(),
                    may_come: true,
                })
            }
            Err(error) => Ok(NextCapture::Skipped(SkippedCapture {
                name: frame.name.clone(),
                error: Arc::new(error),
            })),
        }
    }
}
