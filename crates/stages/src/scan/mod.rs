//! Scans: several frames of one part, each with its camera's pose, become one cloud in the robot's base frame.
//!
//! ```text
//! Shot ─► Surface ─► refined poses ─► FusedCloud ─► part
//!         normals    joint ICP        mean per voxel, vote of the shots' segmentations
//! ```
//!
//! 1. [`surface`]: computes normals and noise of every reading, and sets readings at depth discontinuities apart.
//! 2. [`register`]: refines the poses of all shots together by point-to-plane ICP, with the robot's poses as a prior.
//! 3. [`suspects`]: excludes a shot that contradicts the others, or overlaps none of them; the rest is refined again. If fewer
//!    than two thirds of the shots agree, or either of two may be wrong, the scan is refused. Smaller contradictions give a
//!    warning.
//! 4. [`fuse`]: averages the readings by their noise, and drops points that other shots look through.
//! 5. [`part`]: the shots' segmentations vote on every point; the connected piece with the most votes is the part.
//!
//! The results do not depend on the number of threads.
//!
//! Known limits: a shift of a shot along its surface goes unnoticed if its overlap with the others shows no edge. Errors that all
//! shots share, such as a wrong focal length, remain.

mod assemble;
mod error;
mod free_space;
pub mod fuse;
pub mod overlap;
mod pairs;
pub mod part;
pub mod register;
pub mod surface;
pub mod suspects;
pub mod unseen;
pub mod visibility;

use std::sync::Arc;

use nalgebra::Point3;

use crate::{
    scene::SceneCloud,
    segment::{BackgroundSign, PointLabel, SegmentParams, Segmentation, SegmentedPart},
};
use geometry::{
    rigid::{PoseDelta, RigidTransform, pose_error},
    units::{Metres, Radians},
};

pub use self::{
    assemble::{assemble, assemble_all},
    error::ScanError,
    fuse::FusedCloud,
    overlap::{Agreement, Overlap},
    register::RegisterParams,
    surface::ShotSurface,
    suspects::{Doubt, Excluded, SuspectParams},
};

/// One frame of a scan, with the pose of its camera according to the robot.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The frame's name, for messages.
    pub name: String,
    /// The frame's points, in camera space.
    pub scene: Arc<SceneCloud>,
    /// The camera's pose according to the robot, accurate to a few millimetres and tenths of a degree.
    pub base_from_camera: RigidTransform,
}

/// Parameters of [`assemble()`]. The defaults suit a Kinect-like camera on a robot's flange.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanParams {
    /// Edge of the voxels in which readings are averaged, 1..20 mm. Smaller voxels keep more detail and noise.
    pub voxel: Metres,
    /// Refinement of the poses.
    pub register: RegisterParams,
    /// Limits at which a shot is excluded.
    pub suspect: SuspectParams,
    /// Segmentation of each shot.
    pub segment: SegmentParams,
}

impl Default for ScanParams {
    fn default() -> Self {
        Self {
            voxel: Metres::from_mm(4.0),
            register: RegisterParams::default(),
            suspect: SuspectParams::default(),
            segment: SegmentParams::default(),
        }
    }
}

/// The steps of [`assemble()`], for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanStep {
    /// Normals and segmentation of the shot of this index.
    Shot(usize),
    /// Refinement of the poses.
    Align,
    /// Fusion of the readings, and finding the part among them.
    Fuse,
}

/// Lets a caller follow and cancel [`assemble()`].
pub trait ScanObserver: Sync {
    /// Called when a step begins. Those of several shots may begin at the same time, on other threads.
    fn begins(&self, _step: ScanStep) {}
    /// Returns true to cancel.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// An observer that ignores progress and never cancels.
pub struct Unwatched;

impl ScanObserver for Unwatched {}

/// An assembled scan.
#[derive(Clone, Debug)]
pub struct Scan {
    /// The shots, in the order given.
    pub shots: Vec<ScannedShot>,
    /// The points of all shots that were used, in the robot's base frame.
    pub cloud: FusedCloud,
    /// How well the shots that were used agree at the robot's poses.
    pub before: Agreement,
    /// How well they agree at the refined poses.
    pub after: Agreement,
    /// Set if they do not agree as well as they should, though well enough to be used.
    pub doubt: Option<Doubt>,
}

/// A shot of a scan, with its refined pose and how well it fits.
#[derive(Clone, Debug)]
pub struct ScannedShot {
    /// The frame's name.
    pub name: String,
    /// The frame's points, in camera space.
    pub scene: Arc<SceneCloud>,
    /// The frame's readings with normals and noise.
    pub surface: Arc<ShotSurface>,
    /// The frame's own segmentation.
    pub segmentation: Arc<ShotSegmentation>,
    /// True if its segmentation counts in the vote on which points are the part.
    pub finds_part: bool,
    /// The camera's pose according to the robot.
    pub given: RigidTransform,
    /// The refined pose; for an excluded shot the pose at which it did not fit.
    pub base_from_camera: RigidTransform,
    /// How far the refinement moved the points that the shot sees.
    pub moved: PoseDelta,
    /// Agreement with the other shots at the robot's poses; `None` if it overlaps none.
    pub before: Option<Overlap>,
    /// Agreement at the refined poses.
    pub after: Option<Overlap>,
    /// Agreement at the refined poses, on the part alone.
    pub after_on_part: Option<Overlap>,
    /// Number of fused points that this shot is the first to see.
    pub num_new: usize,
    /// Why the shot was excluded; `None` if it was used.
    pub excluded: Option<Excluded>,
}

/// What a scan uses of a frame's segmentation.
#[derive(Clone, Debug)]
pub struct ShotSegmentation {
    /// One label per reading.
    pub labels: Vec<PointLabel>,
    /// What the frame takes for the part; `None` if it shows none.
    part: Option<ShotPart>,
}

/// What a frame takes for the part.
#[derive(Clone, Debug)]
struct ShotPart {
    /// Indices of its readings, ascending.
    indices: Vec<u32>,
    /// The reason why it looks like background, if there is one.
    background_sign: Option<BackgroundSign>,
}

impl From<Segmentation> for ShotSegmentation {
    fn from(segmentation: Segmentation) -> Self {
        let part = |part: SegmentedPart| ShotPart {
            background_sign: part.background_sign(),
            indices: part.indices,
        };
        Self {
            labels: segmentation.labels,
            part: segmentation.part.ok().map(part),
        }
    }
}

impl Scan {
    /// Returns the shots as given, excluded ones included. Assembling them again yields the same scan.
    pub fn given(&self) -> Vec<Shot> {
        let given = |shot: &ScannedShot| Shot {
            name: shot.name.clone(),
            scene: Arc::clone(&shot.scene),
            base_from_camera: shot.given,
        };
        self.shots.iter().map(given).collect()
    }

    /// Returns how far the robot's poses of the shots that were used move what is at this point of the base frame, at most.
    /// The refined poses are their mean, so none of them alone is more certain.
    pub fn disagreement(&self, at: &Point3<f64>) -> PoseDelta {
        let none = PoseDelta {
            rotation: Radians(0.0),
            shift: Metres(0.0),
        };
        self.used().fold(none, |most, (_, shot)| {
            let own = pose_error(&shot.given_from_refined(), &RigidTransform::identity(), at);
            PoseDelta {
                rotation: Radians(own.rotation.0.max(most.rotation.0)),
                shift: Metres(own.shift.0.max(most.shift.0)),
            }
        })
    }

    /// Returns the shots that were used, each with its index among all.
    pub fn used(&self) -> impl Iterator<Item = (usize, &ScannedShot)> {
        let all = self.shots.iter().enumerate();
        all.filter(|(_, shot)| shot.excluded.is_none())
    }
}

impl ScannedShot {
    /// Returns the motion, in the base frame, from where the refined pose puts what the shot sees to where the robot's pose
    /// puts it.
    fn given_from_refined(&self) -> RigidTransform {
        self.given * self.base_from_camera.inverse()
    }
}

#[cfg(test)]
mod tests;
