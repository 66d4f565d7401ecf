//! The shots of a scan, and which of them are used.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::{Deserialize, Serialize};

use super::source::{HistoryFrame, Origin};
use crate::app::language::text;
use crate::{files::file_name, pipeline::NamedRecipe, scan::Shot};

/// The files of a scan, and which of its shots are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ScanFiles {
    /// A folder, a recording, or the frames themselves.
    pub frames: Vec<PathBuf>,
    /// The file of the poses; without it they are in the recording or lie beside the frames.
    pub poses: Option<PathBuf>,
    /// Frames that were added, each with the file of its pose.
    pub added: Vec<(PathBuf, PathBuf)>,
    /// Names of the shots that a person dropped.
    pub dropped: BTreeSet<String>,
}

impl ScanFiles {
    /// Those of a folder.
    pub fn of_folder(folder: PathBuf) -> Self {
        Self {
            frames: vec![folder],
            ..Self::default()
        }
    }

    /// Those that a past scan came from; of one that a command has written its name alone is known.
    pub(in crate::app) fn of_past(origin: &Origin) -> Self {
        match origin {
            Origin::Scan { files, .. } if !files.frames.is_empty() => Self {
                dropped: BTreeSet::new(),
                ..files.clone()
            },
            origin => Self::of_folder(origin.title().into()),
        }
    }

    /// What a person calls it, and what an enrolled part is said to come from.
    pub fn title(&self) -> String {
        self.frames
            .first()
            .map_or_else(String::new, |first| file_name(first))
    }

    /// The folder, if it is one that needs no other file to be opened again.
    pub fn folder(&self) -> Option<&Path> {
        match self.frames.as_slice() {
            [folder] if self.poses.is_none() && self.added.is_empty() => Some(folder),
            _ => None,
        }
    }
}

/// Shots that were read, with the files that they came from.
#[derive(Debug)]
pub struct ShotSet {
    /// The files; who dropped what is in [`ShotChoice`].
    pub files: ScanFiles,
    /// In the order of the files, those added last.
    pub shots: Vec<Shot>,
}

/// Shots, and which of them are left out.
#[derive(Clone, Debug)]
pub struct ShotChoice {
    /// All shots.
    pub set: Arc<ShotSet>,
    /// Places of those that a person dropped.
    pub dropped: BTreeSet<usize>,
}

impl ShotChoice {
    /// The files, to be opened again with the same shots dropped.
    pub fn files(&self) -> ScanFiles {
        let shots = self.set.shots.iter().enumerate();
        let dropped = shots.filter(|(place, _)| self.dropped.contains(place));
        ScanFiles {
            dropped: dropped.map(|(_, shot)| shot.name.clone()).collect(),
            ..self.set.files.clone()
        }
    }

    /// How many shots are not dropped.
    pub fn num_taken(&self) -> usize {
        self.set.shots.len() - self.dropped.len()
    }
}

/// Which shots to put together.
#[derive(Clone, Debug)]
pub enum ScanOrder {
    /// Read these.
    Open(ScanFiles),
    /// These are at hand.
    Known(ShotChoice),
    /// Those that the history keeps.
    Kept(Box<HistoryFrame>),
    /// One more, with the file of its pose if a person named one.
    Add(ShotChoice, PathBuf, Option<PathBuf>),
}

impl ScanOrder {
    /// What is done for it, for a person.
    pub fn title(&self) -> String {
        match self {
            Self::Open(files) => text!("shell-opening", name = files.title()),
            Self::Known(_) | Self::Kept(_) => text!("shots-putting-together"),
            Self::Add(_, frame, _) => text!("shots-adding", name = file_name(frame)),
        }
    }

    /// The same with the poses of this file.
    #[must_use]
    pub fn with_poses(self, file: PathBuf) -> Self {
        match self {
            Self::Open(files) => Self::Open(ScanFiles {
                poses: Some(file),
                ..files
            }),
            Self::Known(choice) => Self::Known(choice),
            Self::Kept(kept) => Self::Kept(kept),
            Self::Add(choice, frame, _) => Self::Add(choice, frame, Some(file)),
        }
    }
}

/// Put shots together.
#[derive(Clone, Debug)]
pub struct ScanRequest {
    /// Which.
    pub order: ScanOrder,
    /// The file of the hand-eye calibration: poses of the flange need it.
    pub calibration: Option<PathBuf>,
    /// All parameters.
    pub recipe: Arc<NamedRecipe>,
}
