//! The shots of a scan among the kept frames.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::frames::{FrameError, FrameRecord, read, remove, write};
use crate::{
    geometry::{rigid::RigidTransform, sixteen_numbers},
    scan::Shot,
    stages::scene::SceneCloud,
};

/// What is written down of a kept shot of a scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShotRecord {
    /// Its name for people.
    pub name: String,
    /// The camera's pose by the robot, 16 numbers row after row, metres.
    #[serde(with = "sixteen_numbers")]
    pub base_from_camera: RigidTransform,
    /// Its frame.
    pub frame: FrameRecord,
}

impl FrameRecord {
    /// Its file, and those of all shots of a scan.
    pub(super) fn files(&self) -> impl Iterator<Item = &str> {
        let shots = self.shots.iter().map(|shot| shot.frame.file.as_str());
        let others = shots.filter(|file| *file != self.file);
        std::iter::once(self.file.as_str()).chain(others)
    }

    /// All its files in this folder: frames, and their cameras where they have their own.
    pub(super) fn paths(&self, folder: &Path) -> Vec<PathBuf> {
        let paths = self.files().map(|file| folder.join(file));
        paths
            .flat_map(|path| [path.with_extension("json"), path])
            .collect()
    }

    /// Size of all its files.
    pub(super) fn all_bytes(&self) -> u64 {
        if self.shots.is_empty() {
            return self.bytes;
        }
        self.shots.iter().map(|shot| shot.frame.bytes).sum()
    }
}

/// Writes the shots of a scan: all of them or none. The frame of the inspection is the one of `scene`.
pub(super) fn write_shots(
    folder: &Path,
    scene: &Arc<SceneCloud>,
    shots: &[Shot],
    at: Timestamp,
) -> Result<Option<FrameRecord>, FrameError> {
    let mut records: Vec<ShotRecord> = Vec::new();
    let mut main = None;
    for shot in shots {
        let written = write(folder, &shot.scene, at);
        let Ok(Some(frame)) = written else {
            for path in records.iter().flat_map(|shot| shot.frame.paths(folder)) {
                let _ = remove(&path);
            }
            return written;
        };
        if Arc::ptr_eq(&shot.scene, scene) {
            main = Some(frame.clone());
        }
        records.push(ShotRecord {
            name: shot.name.clone(),
            base_from_camera: shot.base_from_camera,
            frame,
        });
    }
    let main = main.or_else(|| records.first().map(|shot| shot.frame.clone()));
    Ok(main.map(|main| FrameRecord {
        shots: records,
        ..main
    }))
}

/// The shots of a kept scan, as they were put together.
pub fn read_shots(folder: &Path, frame: &FrameRecord) -> Result<Vec<Shot>, FrameError> {
    let shot = |shot: &ShotRecord| {
        Ok(Shot {
            name: shot.name.clone(),
            scene: Arc::new(read(folder, &shot.frame)?),
            base_from_camera: shot.base_from_camera,
        })
    };
    frame.shots.iter().map(shot).collect()
}
