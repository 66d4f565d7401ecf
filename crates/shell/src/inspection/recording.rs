//! The recording in progress, which continues when another source is followed.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard},
};

use capture::{CaptureError, Captured, FeedStatus, Recorder, SourceSpec};
use geometry::error::lock;

/// The recording in progress, if any; clones share it.
#[derive(Clone, Debug, Default)]
pub struct SharedRecording(Arc<Mutex<Option<Open>>>);

#[derive(Debug)]
struct Open {
    /// The folder that the user chose; the recording is a folder inside it.
    parent: PathBuf,
    recorder: Recorder,
}

/// What was recorded so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// Folder of the recording.
    pub folder: PathBuf,
    /// Number of frames.
    pub num_frames: u64,
    /// Size of the frames, bytes.
    pub num_bytes: u64,
}

impl SharedRecording {
    /// Writes the frame into a recording in `parent`, starting one if necessary; without `parent`, ends the recording.
    pub fn write(
        &self,
        parent: Option<&Path>,
        captured: &Captured,
        spec: &SourceSpec,
        feed: &FeedStatus,
    ) -> Result<Option<Recorded>, CaptureError> {
        let mut recording = self.lock();
        let Some(parent) = parent else {
            *recording = None;
            return Ok(None);
        };
        // An error ends the recording.
        let mut open = match recording.take() {
            Some(open) if open.parent == parent => open,
            _ => {
                let title = feed.title.clone().unwrap_or_else(|| spec.title());
                let (folder, source) = (parent.join(name()), spec.to_string());
                Open {
                    parent: parent.to_owned(),
                    recorder: Recorder::create(&folder, &title, &source, captured.is_simulated)?,
                }
            }
        };
        open.recorder.write(captured)?;
        let recorded = Recorded {
            folder: open.recorder.folder().to_owned(),
            num_frames: open.recorder.num_frames(),
            num_bytes: open.recorder.num_bytes(),
        };
        *recording = Some(open);
        Ok(Some(recorded))
    }

    /// Ends the recording, which is complete after every frame.
    pub fn end(&self) {
        *self.lock() = None;
    }

    fn lock(&self) -> MutexGuard<'_, Option<Open>> {
        // Sound after a panic: the content is only ever replaced as a whole.
        lock(&self.0)
    }
}

/// Returns a folder name that sorts by time and is unique.
fn name() -> String {
    let now = geometry::clock::zoned_now();
    now.strftime("recording %Y-%m-%d %H.%M.%S.%3f").to_string()
}
