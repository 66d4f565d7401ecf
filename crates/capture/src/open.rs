//! Lists and opens sources.

use super::{
    error::CaptureError,
    genicam::{self, Genicam},
    kinect::{self, Kinect},
    openni, realsense,
    recording::Replay,
    robot_camera::RobotCamera,
    simulated::SimulatedCell,
    source::DepthSource,
    spec::{SimulatedSpec, SourceListing, SourceSpec},
    watched::WatchedFolder,
};

/// Opens a source. Has to be called on the thread that will use the source.
pub fn open(spec: &SourceSpec) -> Result<Box<dyn DepthSource>, CaptureError> {
    Ok(match spec {
        SourceSpec::Simulated(spec) => Box::new(SimulatedCell::new(spec.clone())),
        SourceSpec::SimulatedRobot(at) => Box::new(RobotCamera::open(*at)?),
        SourceSpec::Recording(spec) => Box::new(Replay::open(spec)?),
        SourceSpec::Watched(spec) => Box::new(WatchedFolder::new(spec)),
        SourceSpec::Kinect(spec) => Box::new(Kinect::open(spec)?),
        SourceSpec::Genicam(spec) => Box::new(Genicam::open(spec)?),
        SourceSpec::OpenNi(spec) => openni::open(spec)?,
        SourceSpec::Realsense(spec) => realsense::open(spec)?,
    })
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
