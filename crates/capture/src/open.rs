//! Lists and opens sources.

use super::{
    camera_error::CameraError,
    error::CaptureError,
    genicam::{self, Genicam},
    kinect::{self, Kinect},
    openni, realsense,
    recording::Replay,
    simulated::SimulatedCell,
    source::DepthSource,
    spec::{SimulatedSpec, SourceSpec},
    watched::WatchedFolder,
};

/// Opens a source. Has to be called on the thread that will use the source.
pub fn open(spec: &SourceSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    Ok(match spec {
        SourceSpec::Simulated(spec) => Box::new(SimulatedCell::new(spec.clone())),
        SourceSpec::Recording(spec) => Box::new(Replay::open(spec)?),
        SourceSpec::Watched(spec) => Box::new(WatchedFolder::new(spec)),
        SourceSpec::Kinect(spec) => Box::new(Kinect::open(spec)?),
        SourceSpec::Genicam(spec) => Box::new(Genicam::open(spec)?),
        SourceSpec::OpenNi(spec) => openni::open(spec)?,
        SourceSpec::Realsense(spec) => realsense::open(spec)?,
    })
}

/// A source that can be opened now, or a kind of source and why it cannot.
#[derive(Debug)]
pub struct SourceListing {
    /// Title to show to the operator.
    pub title: String,
    /// The source to open; `None` if a person has to act first.
    pub spec: Option<SourceSpec>,
    /// Why it cannot be opened.
    pub error: Option<CameraError>,
}

impl SourceListing {
    pub(super) fn openable(title: String, spec: SourceSpec) -> Self {
        Self {
            title,
            spec: Some(spec),
            error: None,
        }
    }

    pub(super) fn unusable(error: CameraError) -> Self {
        Self {
            title: error.library.camera.to_owned(),
            spec: None,
            error: Some(error),
        }
    }
}

/// Lists the sources that need no folder: the simulated cell and every connected camera. Takes about a second, the time
/// GenICam cameras have to answer.
pub fn list() -> Vec<SourceListing> {
    let simulated = SourceListing::openable(
        "Simulated cell".into(),
        SourceSpec::Simulated(SimulatedSpec::default()),
    );
    [simulated]
        .into_iter()
        .chain(kinect::list())
        .chain(genicam::list())
        .chain(openni::list())
        .chain(realsense::list())
        .collect()
}
