//! Kept frames of the shots of a scan.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::frames::{FrameError, FrameRecord, read, remove, write};
use geometry::{rigid::RigidTransform, sixteen_numbers};
use stages::{scan::Shot, scene::SceneCloud};

/// Database record of a kept shot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShotRecord {
    /// Name for people.
    pub name: String,
    /// Camera pose according to the robot, 16 numbers in row-major order, metres.
    #[serde(with = "sixteen_numbers")]
    pub base_from_camera: RigidTransform,
    /// Frame of the shot.
    pub frame: FrameRecord,
}

impl FrameRecord {
    /// Returns the frame's file, and for a scan those of all shots.
    pub(super) fn files(&self) -> impl Iterator<Item = &str> {
        let shots = self.shots.iter().map(|shot| shot.frame.file.as_str());
        let others = shots.filter(|file| *file != self.file);
        std::iter::once(self.file.as_str()).chain(others)
    }

    /// Returns the paths of all files in this folder: frames, and cameras that belong to a single frame.
    pub(super) fn paths(&self, folder: &Path) -> Vec<PathBuf> {
        let paths = self.files().map(|file| folder.join(file));
        paths
            .flat_map(|path| [path.with_extension("json"), path])
            .collect()
    }

    /// Returns the total size of all files.
    pub(super) fn all_bytes(&self) -> u64 {
        if self.shots.is_empty() {
            return self.bytes;
        }
        self.shots.iter().map(|shot| shot.frame.bytes).sum()
    }
}

/// Writes the shots of a scan, all of them or none. The inspection's own frame is the one of `scene`.
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

/// Reads the shots of a kept scan as they were inspected.
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
