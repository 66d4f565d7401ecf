//! Scans: several frames of one part, each with the pose of its camera, become one cloud in the robot's base frame.
//!
//! ```text
//! Shot ─► Surface ─► refined poses ─► FusedCloud ─► part
//!         normals    joint ICP        mean per voxel, vote of the shots' segmentations
//! ```
//!
//! 1. [`surface`]: normals and noise of every reading; readings at depth discontinuities are set apart.
//! 2. [`register`]: the poses of all shots are refined together by point-to-plane ICP, held softly at the robot's.
//! 3. [`suspects`]: a shot that contradicts the others is named, excluded, and the rest is refined anew.
//! 4. [`fuse`]: the readings are averaged by their noise; what other shots look through is dropped.
//! 5. [`part`]: the shots' segmentations vote on every point; the connected piece with the most votes is the part.
//!
//! The results are the same on any number of threads.
//!
//! Known limits: a shot that overlaps no other keeps the robot's pose. Errors that all shots share, such as a wrong
//! focal length, remain.

mod assemble;
mod error;
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

use crate::{
    geometry::rigid::{PoseDelta, RigidTransform},
    stages::{
        scene::SceneCloud,
        segment::{SegmentParams, Segmentation},
    },
    units::Metres,
};

pub use self::{
    assemble::assemble,
    error::ScanError,
    fuse::FusedCloud,
    overlap::{Agreement, Overlap},
    register::RegisterParams,
    surface::ShotSurface,
    suspects::{Excluded, SuspectParams},
};

/// One frame of a scan and where the robot says its camera was.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The frame's name, for people.
    pub name: String,
    /// What the camera saw, in camera space.
    pub scene: Arc<SceneCloud>,
    /// The camera's pose by the robot; its error is a few millimetres and tenths of a degree.
    pub base_from_camera: RigidTransform,
}

/// Parameters of [`assemble()`]. The defaults work untouched for a Kinect-like camera on a robot's flange.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanParams {
    /// Edge of the voxels that the readings are averaged in, 1..20 mm. Lowering it keeps more detail and noise.
    pub voxel: Metres,
    /// Refinement of the poses.
    pub register: RegisterParams,
    /// When a shot is excluded.
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

/// The steps of [`assemble()`], as progress is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanStep {
    /// Normals and segmentation of the shot of this index.
    Shot(usize),
    /// Refinement of the poses.
    Align,
    /// Fusion of the readings, and which of them are the part.
    Fuse,
}

/// How a caller follows and stops [`assemble()`].
pub trait ScanObserver: Sync {
    /// A step begins; those of several shots may begin at once, on other threads.
    fn begins(&self, _step: ScanStep) {}
    /// True when the caller has lost interest.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody is watching.
pub struct Unwatched;

impl ScanObserver for Unwatched {}

/// A scan put together.
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
}

/// A shot of a scan, and what became of it.
#[derive(Clone, Debug)]
pub struct ScannedShot {
    /// The frame's name.
    pub name: String,
    /// What the camera saw.
    pub scene: Arc<SceneCloud>,
    /// Its readings with normals and noise.
    pub surface: Arc<ShotSurface>,
    /// What segmentation made of it.
    pub segmentation: Arc<Segmentation>,
    /// The camera's pose by the robot.
    pub given: RigidTransform,
    /// The refined pose; of an excluded shot the one at which it was found not to fit.
    pub base_from_camera: RigidTransform,
    /// How far the refinement moved what it saw.
    pub moved: PoseDelta,
    /// How it agrees with the other shots at the robot's poses; `None` if it overlaps none.
    pub before: Option<Overlap>,
    /// The same at the refined poses.
    pub after: Option<Overlap>,
    /// The same on the part alone.
    pub after_on_part: Option<Overlap>,
    /// Fused points that it is the first to see.
    pub num_new: usize,
    /// Why it was left out; `None` if it was used.
    pub excluded: Option<Excluded>,
}

impl Scan {
    /// The shots as they were given, those that were left out among them: put together again they are the same scan.
    pub fn given(&self) -> Vec<Shot> {
        let given = |shot: &ScannedShot| Shot {
            name: shot.name.clone(),
            scene: Arc::clone(&shot.scene),
            base_from_camera: shot.given,
        };
        self.shots.iter().map(given).collect()
    }

    /// The shots that were used, each with its number among all.
    pub fn used(&self) -> impl Iterator<Item = (usize, &ScannedShot)> {
        let all = self.shots.iter().enumerate();
        all.filter(|(_, shot)| shot.excluded.is_none())
    }
}

#[cfg(test)]
mod tests;
