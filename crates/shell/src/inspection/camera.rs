//! The camera in use and the recording in progress, shared between threads; at most one camera is open.
//!
//! A continuous source is closed as soon as nobody uses its frames. A recording or a watched folder stays open between
//! requests: each request gets the next frame of the recording, and the newest file of the folder that came since. What is being
//! recorded continues when another source is followed.

use std::{
    collections::BTreeMap,
    fmt,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard},
    time::{Duration, Instant},
};

use capture::{
    self, BackpressurePolicy, CaptureError, Captured, DepthSource, Feed, FeedItem, FeedState,
    FeedStatus, Recorder, SourceSpec,
};
use geometry::error::{Advice, lock};
use stages::{field_of_view::FieldOfView, scene::SceneCloud};
use ui::language::Message;

/// A handle to the camera in use; clones share it.
#[derive(Clone)]
pub struct Camera {
    opened: Arc<Mutex<Option<OpenedCamera>>>,
    open: Arc<Open>,
    /// The field of view of each source, as far as its frames have shown it.
    views: Arc<Mutex<BTreeMap<String, Arc<FieldOfView>>>>,
}

/// Opens a source.
type Open = dyn Fn(&SourceSpec) -> Result<Box<dyn DepthSource>, CaptureError> + Send + Sync;

impl Default for Camera {
    fn default() -> Self {
        Self::opened_by(capture::open)
    }
}

struct OpenedCamera {
    spec: SourceSpec,
    feed: Arc<Feed>,
}

/// Why there is no frame.
#[derive(Debug, thiserror::Error, Advice)]
pub enum NoFrame {
    /// The source reported an error.
    #[error(transparent)]
    #[advice(transparent)]
    Capture(Arc<CaptureError>),
    /// A recording has no more frames.
    #[error("{}", no_more_frames(title))]
    #[advice = "Capture again to start at its first frame"]
    AtItsEnd {
        /// Title of the recording.
        title: String,
    },
    /// The request was cancelled.
    #[error("the frame is no longer needed")]
    #[advice = "Capture again"]
    Cancelled,
}

/// The source of this title has ended.
pub(crate) fn no_more_frames(title: &str) -> Message {
    Message::new("no-more-frames").with("source", title)
}

/// Time to wait for a frame before checking for cancellation again.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// How long the next file of a watched folder may take to be read, if one waits.
const NEWER: Duration = Duration::from_millis(400);
/// How long newer files are waited for: a camera may save without a pause.
const LONGEST: Duration = Duration::from_secs(3);

impl Camera {
    /// Makes a handle that opens sources with `open`.
    pub fn opened_by(
        open: impl Fn(&SourceSpec) -> Result<Box<dyn DepthSource>, CaptureError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            opened: Arc::default(),
            open: Arc::new(open),
            views: Arc::default(),
        }
    }

    /// Returns the feed of a source. If another source is open, closes it first. Wait for frames with [`Feed::wait`].
    pub fn feed(&self, spec: &SourceSpec) -> Result<Arc<Feed>, NoFrame> {
        let mut opened = self.lock();
        if let Some(OpenedCamera { spec: known, feed }) = &*opened
            && known == spec
            && !feed.status().state.is_over()
        {
            return Ok(Arc::clone(feed));
        }
        // One camera at a time: two handles to the same device would exclude each other.
        *opened = None;
        let (open, wanted) = (Arc::clone(&self.open), spec.clone());
        let feed = Feed::start_with(
            move || open(&wanted),
            BackpressurePolicy::for_source(spec),
            || {},
        )
        .map_err(|error| NoFrame::Capture(Arc::new(error)))?;
        let feed = Arc::new(feed);
        *opened = Some(OpenedCamera {
            spec: spec.clone(),
            feed: Arc::clone(&feed),
        });
        Ok(feed)
    }

    /// Waits for the next frame of a source, until cancelled; of a watched folder, for the newest of the files that wait.
    pub fn next(
        &self,
        spec: &SourceSpec,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Captured, NoFrame> {
        let feed = self.feed(spec)?;
        let mut found = wait(&feed, spec, is_cancelled);
        // What hangs there now is on the newest file, even if that cannot be read.
        let until = Instant::now() + LONGEST;
        while matches!(spec, SourceSpec::Watched(_))
            && Instant::now() < until
            && !is_cancelled()
            && let Some(newer) = feed.wait(NEWER)
        {
            found = taken(newer);
        }
        drop(feed);
        self.rest();
        found
    }

    /// Waits for the next `num` frames of a source, or fewer if it ends, until cancelled. Calls `on_frame` with the number of
    /// frames so far.
    pub fn frames(
        &self,
        spec: &SourceSpec,
        num: usize,
        is_cancelled: &dyn Fn() -> bool,
        on_frame: &dyn Fn(usize),
    ) -> Result<Vec<Captured>, NoFrame> {
        let feed = self.feed(spec)?;
        let mut frames = Vec::with_capacity(num);
        let mut failed = None;
        while frames.len() < num && failed.is_none() {
            match wait(&feed, spec, is_cancelled) {
                Ok(frame) => {
                    frames.push(frame);
                    on_frame(frames.len());
                }
                Err(NoFrame::AtItsEnd { .. }) if !frames.is_empty() => break,
                Err(error) => failed = Some(error),
            }
        }
        drop(feed);
        self.rest();
        failed.map_or(Ok(frames), Err)
    }

    /// Returns a second feed of a source that is being followed; neither takes frames from the other. If nobody follows the
    /// source, the returned feed has failed.
    pub fn tap(&self, spec: &SourceSpec) -> Feed {
        match &*self.lock() {
            Some(opened) if opened.spec == *spec => opened.feed.tap(),
            Some(_) | None => Feed::failed(CaptureError::NotFollowed),
        }
    }

    /// Gives a scene the field of view known from earlier frames of its source, and remembers what this scene adds to it.
    pub fn share_view(&self, spec: &SourceSpec, scene: &mut Arc<SceneCloud>) {
        let mut views = lock(&self.views);
        let known = views.remove(&spec.to_string());
        if known.is_some() {
            Arc::make_mut(scene).set_known_view(known.clone());
        }
        if let Some(view) = FieldOfView::remembered(known, scene.field_of_view()) {
            views.insert(spec.to_string(), view);
        }
    }

    /// Closes a continuous source unless something still uses its frames.
    pub fn rest(&self) {
        let mut opened = self.lock();
        let is_idle =
            |held: &mut OpenedCamera| held.spec.is_live() && Arc::strong_count(&held.feed) == 1;
        let idle = opened.take_if(is_idle);
        drop(opened);
        // Dropping the feed waits for the camera's thread, so release the lock first.
        drop(idle);
    }

    fn lock(&self) -> MutexGuard<'_, Option<OpenedCamera>> {
        // Valid after a panic, because the content is only replaced as a whole.
        lock(&self.opened)
    }
}

fn taken(item: FeedItem) -> Result<Captured, NoFrame> {
    match item {
        FeedItem::Captured(captured) => Ok(captured),
        FeedItem::Skipped(skipped) => Err(NoFrame::Capture(skipped.error)),
    }
}

fn wait(
    feed: &Feed,
    spec: &SourceSpec,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<Captured, NoFrame> {
    loop {
        if is_cancelled() {
            return Err(NoFrame::Cancelled);
        }
        match feed.wait(POLL_INTERVAL) {
            Some(item) => return taken(item),
            None => match feed.status().state {
                FeedState::Failed(error) | FeedState::Lost { error, .. } => {
                    return Err(NoFrame::Capture(error));
                }
                FeedState::Ended | FeedState::Stopped => {
                    let title = spec.title();
                    return Err(NoFrame::AtItsEnd { title });
                }
                FeedState::Opening | FeedState::Running => {}
            },
        }
    }
}

impl fmt::Debug for Camera {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let spec = self.lock().as_ref().map(|opened| opened.spec.clone());
        f.debug_tuple("Camera").field(&spec).finish()
    }
}

/// The recording in progress, if any; clones share it.
#[derive(Clone, Debug, Default)]
pub struct SharedRecording(Arc<Mutex<Option<OpenRecording>>>);

#[derive(Debug)]
struct OpenRecording {
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
                OpenRecording {
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

    fn lock(&self) -> MutexGuard<'_, Option<OpenRecording>> {
        // Sound after a panic: the content is only ever replaced as a whole.
        lock(&self.0)
    }
}

/// Returns a folder name that sorts by time and is unique.
fn name() -> String {
    let now = geometry::clock::zoned_now();
    now.strftime("recording %Y-%m-%d %H.%M.%S.%3f").to_string()
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use capture::{WatchedFrom, WatchedSpec};
    use files::save_cloud;
    use geometry::{
        cloud::PointCloud,
        depth_frame::{DepthFrame, Intrinsics},
    };
    use stages::scene::{scene_from_frame, scene_from_image};

    fn is_open(camera: &Camera) -> bool {
        camera.lock().is_some()
    }

    #[test]
    fn a_live_camera_is_closed_after_its_frame_unless_somebody_follows_it() {
        let camera = Camera::default();
        let spec: SourceSpec = "simulated,fps=1000:empty".parse().expect("a source");
        let first = camera.next(&spec, &|| false).expect("a frame");
        assert!(first.is_simulated && !is_open(&camera));
        let followed = camera.feed(&spec).expect("opened");
        camera.next(&spec, &|| false).expect("a frame");
        assert!(is_open(&camera));
        drop(followed);
        camera.rest();
        assert!(!is_open(&camera));
    }

    #[test]
    fn of_the_files_that_wait_in_a_watched_folder_the_newest_is_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, x) in [("1.pcd", 0.1), ("2.pcd", 0.2), ("3.pcd", 0.3)] {
            let cloud = PointCloud::from_points([Point3::new(x, 0.0, 1.0)]);
            save_cloud(&folder.path().join(name), &cloud).expect("saved");
        }
        let spec = SourceSpec::Watched(WatchedSpec {
            folder: folder.path().to_owned(),
            from: WatchedFrom::All,
        });
        let newest = Camera::default().next(&spec, &|| false).expect("a file");
        assert_eq!(newest.name, "3.pcd");
    }

    #[test]
    fn several_frames_come_in_order_and_fewer_if_a_recording_ends() {
        let camera = Camera::default();
        let spec: SourceSpec = "simulated,fps=1000:empty".parse().expect("a source");
        let counts = std::cell::RefCell::new(Vec::new());
        let count = |num| counts.borrow_mut().push(num);
        let frames = camera.frames(&spec, 3, &|| false, &count);
        let frames = frames.expect("frames");
        let numbers: Vec<u64> = frames.iter().map(|frame| frame.number).collect();
        assert!(numbers.is_sorted_by(|a, b| a < b), "{numbers:?}");
        assert_eq!(*counts.borrow(), [1, 2, 3]);
        assert!(!is_open(&camera));

        let folder = tempfile::tempdir().expect("a folder");
        for (name, frame) in ["a.pcd", "b.pcd"].into_iter().zip(frames) {
            let scene = scene_from_image(frame.image);
            save_cloud(&folder.path().join(name), &scene.cloud).expect("written");
        }
        let text = format!("recording,pace=step:{}", folder.path().display());
        let spec: SourceSpec = text.parse().expect("a source");
        let frames = camera.frames(&spec, 3, &|| false, &|_| ());
        assert_eq!(frames.expect("all there are").len(), 2);
        // The next request starts the recording again.
        let frames = camera.frames(&spec, 1, &|| false, &|_| ());
        assert_eq!(frames.expect("the first").len(), 1);
    }

    #[test]
    fn a_field_of_view_is_remembered_for_the_next_frame_of_the_same_source() {
        let within = |margins: [usize; 2]| {
            let camera = Intrinsics::KINECT;
            let Intrinsics { width, height, .. } = camera;
            let is_inside = |i: usize| {
                let inside = |at: usize, size: usize, margin| (margin..size - margin).contains(&at);
                inside(i % width, width, margins[0]) && inside(i / width, height, margins[1])
            };
            let depth = (0..width * height).map(|i| if is_inside(i) { 1500 } else { 0 });
            let frame = DepthFrame {
                depth: depth.collect(),
                intrinsics: camera,
                metres_per_unit: 0.001,
                is_simulated: true,
            };
            Arc::new(scene_from_frame(&frame))
        };
        let is_inner =
            |scene: &SceneCloud| scene.field_of_view().is_some_and(FieldOfView::is_inner);
        let camera = Camera::default();
        let [one, other] = ["simulated", "simulated:empty"].map(|spec| spec.parse().expect("spec"));
        let (mut whole, mut alone) = (within([60, 40]), within([230, 150]));
        assert!(is_inner(&whole) && !is_inner(&alone));
        camera.share_view(&one, &mut whole);
        camera.share_view(&other, &mut alone);
        assert!(!is_inner(&alone), "another camera's frame");
        camera.share_view(&one, &mut alone);
        assert!(is_inner(&alone));
    }

    #[test]
    fn a_cancelled_wait_gives_no_frame() {
        let folder = tempfile::tempdir().expect("a folder");
        let text = format!("watch:{}", folder.path().display());
        let spec: SourceSpec = text.parse().expect("a source");
        let given_up = Camera::default().next(&spec, &|| true);
        assert!(matches!(given_up, Err(NoFrame::Cancelled)));
    }
}
