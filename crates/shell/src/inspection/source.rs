//! Sources of scenes: the simulated cell, files, and cameras.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::Arc,
    time::SystemTime,
};

use serde::{Deserialize, Serialize};

use crate::{
    inspection::camera::{Camera, NoFrame},
    language::{object, scene_title},
};
use capture::{
    self, CaptureError, CaptureWarning, CellScene, SimulatedSpec, SourceSpec, read_image,
};
use files::{self, written_at};
use geometry::error::Advice;
use inspection::pipeline::NamedRecipe;
use records::history::{FrameError, FrameRecord, SceneTitle, read_frame};
use simulate::{
    CellSetup, ObjectKind, PartKind, PartPose, PoseRange, Side, SimulatedObject, frame,
};
use stages::{
    scan::Shot,
    scene::{EmptyCell, SceneCloud, scene_from_frame, scene_from_image},
};
use station::{CaptureFacts, Subject};
use ui::{language::text, task::TaskError, user_error::UserError, widgets::sentence};

pub use files::file_name;

/// What hangs in the simulated cell when a frame is captured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CellChoice {
    /// The eight parts in turn.
    #[default]
    InTurn,
    /// Always this part.
    Part(PartKind, Side),
    /// Always this object, which is not an enrolled part.
    Foreign(ObjectKind),
    /// Nothing.
    Empty,
}

impl CellChoice {
    /// All choices, in the order of the source menu.
    pub fn all() -> impl Iterator<Item = Self> {
        let sides = |kind: PartKind| {
            let sides = if kind.is_sided() {
                &Side::ALL[..]
            } else {
                &[Side::Left]
            };
            sides.iter().map(move |side| Self::Part(kind, *side))
        };
        std::iter::once(Self::InTurn)
            .chain(PartKind::ALL.into_iter().flat_map(sides))
            .chain([
                Self::Foreign(ObjectKind::Hood),
                Self::Foreign(ObjectKind::Wheel),
            ])
            .chain([Self::Empty])
    }

    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::InTurn => text!("shell-every-part"),
            Self::Part(kind, side) if kind.is_sided() => {
                format!("{}, {}", kind.title(), side.name())
            }
            Self::Part(kind, _) => kind.title().into(),
            Self::Foreign(kind) => text!("shell-not-enrolled", what = object(kind)),
            Self::Empty => text!("shell-empty-cell"),
        }
    }

    /// Returns the same cell as a continuous camera.
    pub fn followed(self) -> SimulatedSpec {
        let mut spec = SimulatedSpec::default();
        match self {
            Self::InTurn => {}
            Self::Part(kind, side) => {
                spec.scene = CellScene::Part(kind);
                spec.side = side;
            }
            Self::Foreign(kind) => spec.scene = CellScene::Object(kind),
            Self::Empty => spec.scene = CellScene::Empty,
        }
        spec
    }

    /// Returns what hangs there in the frame of this number, counted from 1.
    pub fn subject(self, number: u64) -> SimulatedObject {
        /// The first frame shows a front door, like the first example of the command line.
        const FIRST: u64 = 3;
        let part = |kind, side| SimulatedObject::Part {
            kind,
            side,
            model_seed: 0,
        };
        match self {
            Self::InTurn => {
                let num_kinds = PartKind::ALL.len() as u64;
                part(
                    PartKind::ALL[((number + FIRST) % num_kinds) as usize],
                    Side::Left,
                )
            }
            Self::Part(kind, side) => part(kind, side),
            Self::Foreign(kind) => SimulatedObject::Object(kind),
            Self::Empty => SimulatedObject::Nothing,
        }
    }
}

/// The source of single frames of the simulated cell, as the history stores it.
pub(crate) const CELL_SOURCE: &str = "simulated cell";

/// Origin of a scene.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// A frame of the simulated cell.
    Simulated {
        /// What hung in the cell.
        choice: CellChoice,
        /// Number of the frame, which is also its seed.
        number: u64,
    },
    /// A file.
    File {
        /// Path of the file.
        path: PathBuf,
        /// True if the file says that it is simulated.
        is_simulated: bool,
    },
    /// The shots of a scan, put together.
    Scan {
        /// Name of their folder or files.
        name: String,
        /// Number of shots that were used.
        num_shots: usize,
        /// True if it is simulated.
        is_simulated: bool,
        /// Files of the shots.
        #[serde(default)]
        files: ScanFiles,
    },
    /// A frame of a camera, a recording or a watched folder.
    Frame {
        /// Name shown to the user.
        name: String,
        /// True if it is simulated, or was when it was recorded.
        is_simulated: bool,
        /// The capture, if it is known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        capture: Option<CaptureFacts>,
    },
}

impl Origin {
    /// The origin of a capture of this source.
    pub fn of_capture(captured: &capture::Captured, source: &SourceSpec, num_dropped: u64) -> Self {
        Self::Frame {
            name: captured.name.clone(),
            is_simulated: captured.is_simulated,
            capture: Some(CaptureFacts::new(captured, source, num_dropped)),
        }
    }

    /// What was inspected, as records name it; `source` is the name of the source for the history.
    pub fn subject(&self, source: String) -> Subject {
        // The names in the line of JSON are those that the commands write.
        let (scene, capture) = match self {
            Self::Simulated { number, .. } => (format!("simulated frame {number}"), None),
            Self::File { path, .. } => (path.display().to_string(), None),
            Self::Scan { .. } => (self.scene_title().to_string(), None),
            Self::Frame { name, capture, .. } => (name.clone(), capture.clone()),
        };
        let subject = Subject {
            title: self.scene_title(),
            ..Subject::of_scene(scene, source, self.is_simulated())
        };
        match capture {
            Some(facts) => subject.with_capture(facts),
            None => subject,
        }
    }

    /// Returns the title in the language of the window.
    pub fn shown_title(&self) -> String {
        scene_title(&self.scene_title(), self.is_simulated())
    }

    /// Returns what the scene is called, as the history stores it.
    pub(crate) fn scene_title(&self) -> SceneTitle {
        match self {
            Self::Simulated { number, .. } => SceneTitle::SimulatedFrame(*number),
            Self::File { path, .. } => SceneTitle::Named(file_name(path)),
            Self::Scan {
                name, num_shots, ..
            } => SceneTitle::Scan {
                name: name.clone(),
                num_shots: *num_shots,
            },
            Self::Frame {
                name, is_simulated, ..
            } => match SceneTitle::of_frame(name, *is_simulated) {
                SceneTitle::Named(name) => SceneTitle::Named(sentence(&name)),
                numbered => numbered,
            },
        }
    }

    /// Returns the title in English, as cases and reports store it.
    pub fn title(&self) -> String {
        let title = self.scene_title();
        match (&title, self.is_simulated()) {
            (SceneTitle::SimulatedFrame(_), _) => sentence(&title.to_string()),
            (_, true) => format!("{title}, simulated"),
            (_, false) => title.to_string(),
        }
    }

    /// True if the scene is simulated.
    pub fn is_simulated(&self) -> bool {
        match self {
            Self::Simulated { .. } => true,
            Self::File { is_simulated, .. }
            | Self::Scan { is_simulated, .. }
            | Self::Frame { is_simulated, .. } => *is_simulated,
        }
    }

    /// When a scene of this origin that was just taken was captured: a file when it was written, else now.
    pub fn captured_at(&self) -> SystemTime {
        let written = match self {
            Self::File { path, .. } => written_at(path).unwrap_or(SystemTime::UNIX_EPOCH).into(),
            Self::Frame { capture, .. } => capture.as_ref().and_then(CaptureFacts::written_at),
            Self::Simulated { .. } | Self::Scan { .. } => None,
        };
        written.unwrap_or_else(SystemTime::now)
    }

    /// Returns a source that gives the same scene again, by simulating the same frame or reading the files again. `None` for a
    /// frame of a camera, which cannot be had again.
    pub fn source(&self) -> Option<SceneOrScan> {
        Some(match self {
            Self::Simulated { choice, number } => SceneOrScan::Scene(SceneSource::Cell {
                choice: *choice,
                number: *number,
            }),
            Self::File { path, .. } => SceneOrScan::Scene(SceneSource::File(path.clone())),
            Self::Scan { files, .. } if !files.frames.is_empty() => {
                SceneOrScan::Scan(ScanOrder::Open(files.clone()))
            }
            Self::Scan { .. } | Self::Frame { .. } => return None,
        })
    }
}

/// A source that can deliver a scene.
#[derive(Clone, Debug)]
pub enum SceneSource {
    /// A frame of the simulated cell.
    Cell {
        /// What hangs in the cell.
        choice: CellChoice,
        /// Number and seed of the frame.
        number: u64,
    },
    /// A file.
    File(PathBuf),
    /// The next frame of a camera, a recording or a watched folder.
    Camera(Box<SourceSpec>),
    /// A scene already in memory.
    AtHand(Arc<SceneCloud>, Origin),
    /// Another source, whose camera recorded this empty cell.
    WithEmptyCell(Arc<EmptyCell>, Box<SceneSource>),
    /// A frame kept in the history.
    Kept(Box<HistoryFrame>),
}

/// A frame kept in the history.
#[derive(Clone, Debug)]
pub struct HistoryFrame {
    /// Folder of the kept frames.
    pub folder: PathBuf,
    /// Its file, and data that the file does not contain.
    pub frame: FrameRecord,
    /// Origin of the scene.
    pub origin: Origin,
}

/// A scene and its origin.
#[derive(Clone, Debug)]
pub struct Captured {
    /// The captured scene.
    pub scene: Arc<SceneCloud>,
    /// Origin of the scene.
    pub origin: Origin,
    /// Problems found while reading it.
    pub warnings: Vec<CaptureWarning>,
}

/// Why a source delivered no scene.
#[derive(Debug, thiserror::Error, Advice)]
pub enum SceneError {
    /// The file cannot be read as a capture.
    #[error(transparent)]
    #[advice(match _0 {
        CaptureError::MeshIsNoCapture { .. } => {
            "Open it in the Enrol workspace (2) to enrol it as a reference".into()
        }
        other => other.advice(),
    })]
    File(#[from] CaptureError),
    /// The camera delivered no frame.
    #[error(transparent)]
    #[advice(transparent)]
    Camera(#[from] NoFrame),
    /// The frame in the history cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Kept(#[from] FrameError),
}

impl From<SceneError> for TaskError {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Camera(NoFrame::Cancelled) => Self::Cancelled,
            error => UserError::of(&error).into(),
        }
    }
}

impl SceneSource {
    /// Returns the name of the source for the history.
    pub fn in_words(&self) -> String {
        match self {
            Self::Cell { .. } => CELL_SOURCE.into(),
            Self::File(path) => path.display().to_string(),
            Self::Camera(spec) => spec.to_string(),
            Self::WithEmptyCell(_, source) => source.in_words(),
            Self::AtHand(_, origin) => origin.scene_title().to_string(),
            Self::Kept(kept) => kept.origin.scene_title().to_string(),
        }
    }

    /// Captures, reads or returns the scene; waiting for a frame ends when `is_cancelled`.
    pub fn take(
        &self,
        camera: &Camera,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Captured, SceneError> {
        match self {
            Self::Cell { choice, number } => {
                let mut setup = CellSetup::new(choice.subject(*number), *number);
                setup.pose = PartPose::Drawn(PoseRange::facing());
                Ok(Captured {
                    scene: Arc::new(scene_from_frame(&frame(&setup).frame)),
                    origin: Origin::Simulated {
                        choice: *choice,
                        number: *number,
                    },
                    warnings: Vec::new(),
                })
            }
            Self::File(path) => {
                let (image, warnings) = read_image(path)?;
                let scene = scene_from_image(image);
                Ok(Captured {
                    origin: Origin::File {
                        path: path.clone(),
                        is_simulated: scene.cloud.is_simulated,
                    },
                    scene: Arc::new(scene),
                    warnings,
                })
            }
            Self::Camera(spec) => {
                let captured = camera.next(spec, is_cancelled)?;
                let origin = Origin::of_capture(&captured, spec, 0);
                let mut captured = Captured {
                    origin,
                    ..captured.into()
                };
                camera.share_view(spec, &mut captured.scene);
                Ok(captured)
            }
            Self::WithEmptyCell(cell, source) => {
                let mut captured = source.take(camera, is_cancelled)?;
                let mut scene = Arc::unwrap_or_clone(captured.scene);
                scene.empty_cell = Some(Arc::clone(cell));
                captured.scene = Arc::new(scene);
                Ok(captured)
            }
            Self::Kept(kept) => Ok(Captured {
                scene: Arc::new(read_frame(&kept.folder, &kept.frame)?),
                origin: kept.origin.clone(),
                warnings: Vec::new(),
            }),
            Self::AtHand(scene, origin) => Ok(Captured {
                scene: Arc::clone(scene),
                origin: origin.clone(),
                warnings: Vec::new(),
            }),
        }
    }
}

impl From<capture::Captured> for Captured {
    fn from(frame: capture::Captured) -> Self {
        Self {
            scene: Arc::new(scene_from_image(frame.image)),
            origin: Origin::Frame {
                name: frame.name,
                is_simulated: frame.is_simulated,
                capture: None,
            },
            warnings: frame.warnings,
        }
    }
}

/// Something to inspect or enrol.
#[derive(Clone, Debug)]
pub enum SceneOrScan {
    /// A scene.
    Scene(SceneSource),
    /// The shots of a scan, to be put together.
    Scan(ScanOrder),
}

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
        let dropped = shots.filter(|(index, _)| self.dropped.contains(index));
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

#[cfg(test)]
mod tests {
    use super::*;
    use ui::language::Language;

    #[test]
    fn the_first_frame_is_a_front_door_and_all_eight_parts_come_in_turn() {
        let kind = |number| match CellChoice::InTurn.subject(number) {
            SimulatedObject::Part { kind, .. } => kind,
            other => panic!("{other:?}"),
        };
        assert_eq!(kind(1), PartKind::FrontDoor);
        let seen: std::collections::BTreeSet<_> = (1..=8).map(kind).collect();
        assert_eq!(seen.len(), 8);
    }

    #[test]
    fn a_file_without_any_reading_is_a_scene_without_points() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("covered.xyz");
        std::fs::write(&path, "nan nan nan\n").expect("written");
        let source = SceneSource::File(path);
        let captured = source.take(&Camera::default(), &|| false);
        assert!(captured.expect("read").scene.cloud.points.is_empty());
    }

    #[test]
    fn where_a_scene_came_from_is_shown_in_the_language_of_the_window_and_kept_in_english() {
        let frame = |name: &str, is_simulated| Origin::Frame {
            name: name.into(),
            is_simulated,
            capture: None,
        };
        let origins = [
            (
                Origin::Simulated {
                    choice: CellChoice::InTurn,
                    number: 7,
                },
                ["Simulated frame 7", "Simuliertes Bild 7"],
            ),
            (
                frame("simulated frame 12", true),
                ["Simulated frame 12", "Simuliertes Bild 12"],
            ),
            (
                frame("kinect frame 12", true),
                ["Kinect frame 12, simulated", "Kinect frame 12, simuliert"],
            ),
            (frame("kinect frame 12", false), ["Kinect frame 12"; 2]),
            (
                Origin::File {
                    path: "a/door.pcd".into(),
                    is_simulated: true,
                },
                ["door.pcd, simulated", "door.pcd, simuliert"],
            ),
            (
                Origin::Scan {
                    name: "door".into(),
                    num_shots: 3,
                    is_simulated: true,
                    files: ScanFiles::default(),
                },
                ["door · 3 shots, simulated", "door · 3 Aufnahmen, simuliert"],
            ),
        ];
        for (origin, [kept, shown]) in origins {
            assert_eq!(origin.shown_title(), kept);
            Language::German.make_current();
            let titles = [origin.title(), origin.shown_title()];
            Language::English.make_current();
            assert_eq!(titles, [kept, shown]);
        }
    }

    #[test]
    fn a_mesh_is_refused_in_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("part.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
        let refused = SceneSource::File(path)
            .take(&Camera::default(), &|| false)
            .expect_err("refused");
        assert!(refused.to_string().contains("a mesh") && refused.advice().contains("Enrol"));
    }
}
