//! Which sources there are, and opening one.

use super::{
    error::CaptureError,
    genicam, kinect, openni, realsense,
    recording::Replay,
    simulated::SimulatedCell,
    source::DepthSource,
    spec::{SimulatedSpec, SourceSpec},
    watched::WatchedFolder,
};

/// Opens a source. Call it on the thread that will use the source.
pub fn open(spec: &SourceSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    Ok(match spec {
        SourceSpec::Simulated(spec) => Box::new(SimulatedCell::new(spec.clone())),
        SourceSpec::Recording(spec) => Box::new(Replay::open(spec)?),
        SourceSpec::Watched(spec) => Box::new(WatchedFolder::new(spec)),
        SourceSpec::Kinect(spec) => kinect::open(spec)?,
        SourceSpec::Genicam(spec) => genicam::open(spec)?,
        SourceSpec::OpenNi(spec) => openni::open(spec)?,
        SourceSpec::Realsense(spec) => realsense::open(spec)?,
    })
}

/// A source that could be opened now, or a kind of source and why it cannot.
#[derive(Debug)]
pub struct SourceListing {
    /// What a person calls it.
    pub title: String,
    /// What to open; `None` where something has to be done first.
    pub spec: Option<SourceSpec>,
    /// Why it cannot be opened, with its advice.
    pub trouble: Option<CaptureError>,
}

/// The sources that can be found without being told a folder: the simulated cell and every connected camera. Takes about
/// a second, for which GenICam cameras may answer.
pub fn list() -> Vec<SourceListing> {
    let simulated = SourceListing {
        title: "Simulated cell".into(),
        spec: Some(SourceSpec::Simulated(SimulatedSpec::default())),
        trouble: None,
    };
    [simulated]
        .into_iter()
        .chain(kinect::list())
        .chain(genicam::list())
        .chain(openni::list())
        .chain(realsense::list())
        .collect()
}
