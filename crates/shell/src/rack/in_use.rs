//! The rack in use, the rack that is edited, and the actions on them.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use geometry::rigid::{RigidTransform, from_row_major, row_major};
use inspection::rack::{Rack, RackFile};
use robot::RobotFrame;
use ui::{language::text, user_error::UserError};

/// The rack in use.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "KeptRack", into = "KeptRack")]
pub struct RackInUse {
    /// Its file; `None` if parts may hang anywhere.
    pub(super) file: Option<RackFile>,
    /// Where the camera was when that was last known.
    pub(super) base_from_camera: Option<RigidTransform>,
    /// Its boxes and places in camera space.
    pub(super) in_camera: Rack,
}

/// The rack in use, as the settings keep it.
#[derive(Serialize, Deserialize)]
struct KeptRack {
    #[serde(default)]
    file: Option<RackFile>,
    /// Row by row.
    #[serde(default)]
    base_from_camera: Option<[f64; 16]>,
}

/// Tolerance of a kept transform: it was written by this program.
const KEPT_TOLERANCE: f64 = 1e-6;

impl TryFrom<KeptRack> for RackInUse {
    type Error = String;

    fn try_from(kept: KeptRack) -> Result<Self, String> {
        let read = |m: [f64; 16]| from_row_major(&m, KEPT_TOLERANCE).ok_or("no transform");
        let base_from_camera = kept.base_from_camera.map(read).transpose()?;
        let in_camera = kept.file.as_ref();
        let in_camera = in_camera.map(|file| file.in_camera(base_from_camera.as_ref()));
        let in_camera = in_camera.transpose().map_err(|error| error.to_string())?;
        Ok(Self {
            file: kept.file,
            base_from_camera,
            in_camera: in_camera.unwrap_or_default(),
        })
    }
}

impl From<RackInUse> for KeptRack {
    fn from(rack: RackInUse) -> Self {
        Self {
            file: rack.file,
            base_from_camera: rack.base_from_camera.as_ref().map(row_major),
        }
    }
}

impl RackInUse {
    /// The rack in camera space; empty without one.
    pub fn in_camera(&self) -> &Rack {
        &self.in_camera
    }

    /// Its name for the user.
    pub fn title(&self) -> String {
        match &self.file {
            None => text!("rack-none"),
            Some(file) if file.rack.name.is_empty() => text!("rack-unnamed"),
            Some(file) => file.rack.name.clone(),
        }
    }

    /// Puts it where the camera is now. While that is not known, the rack stays where it was.
    pub fn follow(&mut self, robot: Option<&RobotFrame>) {
        let moved = self.file.as_ref();
        let moved = moved.and_then(|file| file.in_camera(camera(robot)).ok());
        if let Some(moved) = moved {
            self.base_from_camera = camera(robot).copied();
            self.in_camera = moved;
        }
    }
}

/// The camera's pose in the robot's base.
pub(super) fn camera(robot: Option<&RobotFrame>) -> Option<&RigidTransform> {
    robot.map(|robot| &robot.robot_from_camera)
}

/// The window in which the rack is edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RackEditor {
    /// The rack being edited; it is in use unless it has an error.
    pub(super) draft: RackFile,
    /// Former drafts, the newest last.
    pub(super) past: Vec<RackFile>,
    /// What is wrong.
    pub(super) problem: Option<UserError>,
    /// True if nothing was inspected with the draft yet.
    pub(super) is_new: bool,
    /// True while a number is being dragged: all its changes are undone at once.
    pub(super) is_dragged: bool,
}

/// A rack that was read, and its file.
pub type ReadRack = (PathBuf, Box<RackFile>);

/// An action on the rack.
#[derive(Clone, Debug)]
pub enum RackAction {
    /// Open or close the window.
    Toggle,
    /// Read this file, and use its rack.
    Open(PathBuf),
    /// Use the rack that was read, or say why it cannot be read.
    Opened(Result<ReadRack, UserError>),
    /// Write the rack in use to this file.
    Save(PathBuf),
    /// Say that it was written to this file, or why it was not.
    Saved(Result<PathBuf, UserError>),
    /// Change the rack to this one.
    Edit {
        /// The changed rack.
        file: Box<RackFile>,
        /// True if it continues the last change.
        continues: bool,
    },
    /// Inspect with the changed rack.
    Inspect,
    /// Make a place, or change the one of this name, from the part in front.
    TakePlace(String),
    /// Make a place of each part of the frame in front that has none.
    TakePlaces,
    /// Add a box around the part in front to the work volume.
    TakeVolume,
    /// Undo the last change.
    Undo,
}
