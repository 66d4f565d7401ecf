//! The shots of a scan, and which of them are used.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::Arc,
    time::SystemTime,
};

use serde::{Deserialize, Serialize};

use super::source::{HistoryFrame, Origin};
use files::file_name;
use inspection::pipeline::NamedRecipe;
use stages::scan::Shot;
use ui::language::text;

/// The files of a scan, and which of its shots are dropped.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ScanFiles {
    /// A folder, a recording, or the frames themselves.
    pub frames: Vec<PathBuf>,
    /// The file of the poses; `None` if they are in the recording or beside the frames.
    pub poses: Option<PathBuf>,
    /// Frames added later, each with the file of its pose.
    pub added: Vec<(PathBuf, PathBuf)>,
    /// Names of the shots that the user dropped.
    pub dropped: BTreeSet<String>,
}

impl ScanFiles {
    /// Uses all frames of a folder.
    pub fn of_folder(folder: PathBuf) -> Self {
        Self {
            frames: vec![folder],
            ..Self::default()
        }
    }

    /// Returns the files of a past scan; for one written by a command only its name is known.
    pub(crate) fn of_past(origin: &Origin) -> Self {
        match origin {
            Origin::Scan { files, .. } if !files.frames.is_empty() => Self {
                dropped: BTreeSet::new(),
                ..files.clone()
            },
            origin => Self::of_folder(origin.title().into()),
        }
    }

    /// Name for the user, also stored as the source of an enrolled part.
    pub fn title(&self) -> String {
        self.frames
            .first()
            .map_or_else(String::new, |first| file_name(first))
    }

    /// The folder, if it alone is enough to open the scan again.
    pub fn folder(&self) -> Option<&Path> {
        match self.frames.as_slice() {
            [folder] if self.poses.is_none() && self.added.is_empty() => Some(folder),
            _ => None,
        }
    }
}

/// Shots with the files that they were read from.
#[derive(Debug)]
pub struct ShotSet {
    /// The files; the dropped shots are in [`ShotChoice`].
    pub files: ScanFiles,
    /// In the order of the files, with added ones last.
    pub shots: Vec<Shot>,
    /// When the first of them was captured.
    pub captured_at: SystemTime,
}

/// Shots, and which of them are dropped.
#[derive(Clone, Debug)]
pub struct ShotChoice {
    /// All shots.
    pub set: Arc<ShotSet>,
    /// Indices of the shots that the user dropped.
    pub dropped: BTreeSet<usize>,
}

impl ShotChoice {
    /// Returns the files for opening the scan again with the same shots dropped.
    pub fn files(&self) -> ScanFiles {
        let shots = self.set.shots.iter().enumerate();
        let dropped = shots.filter(|(place, _)| self.dropped.contains(place));
        ScanFiles {
            dropped: dropped.map(|(_, shot)| shot.name.clone()).collect(),
            ..self.set.files.clone()
        }
    }

    /// Number of shots that are not dropped.
    pub fn num_taken(&self) -> usize {
        self.set.shots.len() - self.dropped.len()
    }
}

/// Shots to be put together.
#[derive(Clone, Debug)]
pub enum ScanOrder {
    /// Read these files.
    Open(ScanFiles),
    /// These shots are already in memory.
    Known(ShotChoice),
    /// Read the shots kept in the history.
    Kept(Box<HistoryFrame>),
    /// Add one frame, with the file of its pose if the user chose one.
    Add(ShotChoice, PathBuf, Option<PathBuf>),
}

impl ScanOrder {
    /// Describes the work to the user.
    pub fn title(&self) -> String {
        match self {
            Self::Open(files) => text!("shell-opening", name = files.title()),
            Self::Known(_) | Self::Kept(_) => text!("shots-putting-together"),
            Self::Add(_, frame, _) => text!("shots-adding", name = file_name(frame)),
        }
    }

    /// Uses the poses in this file.
    #[must_use]
    pub fn with_poses(self, file: PathBuf) -> Self {
        match self {
            Self::Open(files) => Self::Open(ScanFiles {
                poses: Some(file),
                ..files
            }),
            Self::Add(choice, frame, _) => Self::Add(choice, frame, Some(file)),
            Self::Known(_) | Self::Kept(_) => self,
        }
    }
}

/// A request to put shots together.
#[derive(Clone, Debug)]
pub struct ScanRequest {
    /// The shots.
    pub order: ScanOrder,
    /// The file of the hand-eye calibration, which is needed for poses of the flange.
    pub calibration: Option<PathBuf>,
    /// All parameters of segmentation and inspection.
    pub recipe: Arc<NamedRecipe>,
}
