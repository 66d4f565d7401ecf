//! What the window's thread does: gets a scene, inspects it and prepares what the panels draw.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use nalgebra::Point3;

use super::{deviation::deviations, figures::Figures};
use crate::{
    error::Advice,
    files::{self, FileError, FileWarning, Opened},
    library::{LibraryError, LibraryLoad, open_library},
    pipeline::{self, Inspection, Recipe, Watch},
    simulate::{CellSetup, ObjectKind, PartKind, PartPose, Placement, Side, Subject, frame},
    stages::{
        reference::ReferenceParams,
        scene::{SceneCloud, scene_from_cloud, scene_from_frame},
    },
};

/// What hangs in the simulated cell when a frame is captured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellChoice {
    /// The eight parts one after the other.
    #[default]
    InTurn,
    /// Always this part.
    Part(PartKind, Side),
    /// Always this thing, which is no enrolled part.
    Foreign(ObjectKind),
    /// Nothing.
    Empty,
}

impl CellChoice {
    /// Every choice, as the source menu lists them.
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

    /// What a person calls it.
    pub fn title(self) -> String {
        match self {
            Self::InTurn => "Every part in turn".into(),
            Self::Part(kind, side) if kind.is_sided() => {
                format!("{}, {}", kind.title(), side.name())
            }
            Self::Part(kind, _) => kind.title().into(),
            Self::Foreign(kind) => format!("Not enrolled: {}", kind.name()),
            Self::Empty => "Empty cell".into(),
        }
    }

    /// What hangs there for the frame of this number, counted from 1.
    fn subject(self, number: u64) -> Subject {
        /// The first frame shows a front door, as the first look in a terminal does.
        const FIRST: u64 = 3;
        let part = |kind, side| Subject::Part {
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
            Self::Foreign(kind) => Subject::Object(kind),
            Self::Empty => Subject::Nothing,
        }
    }
}

/// Where a scene came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A frame of the simulated cell.
    Simulated {
        /// Its number, which is also its seed.
        number: u64,
    },
    /// A file.
    File(PathBuf),
}

impl Origin {
    /// What a person calls it.
    pub fn title(&self) -> String {
        match self {
            Self::Simulated { number } => format!("Simulated frame {number}"),
            Self::File(path) => file_name(path),
        }
    }
}

/// The last part of a path, or all of it where there is none.
pub fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// What the window asks for.
#[derive(Clone, Debug)]
pub enum Request {
    /// A frame of the simulated cell.
    Capture {
        /// What hangs there.
        choice: CellChoice,
        /// Number and seed of the frame.
        number: u64,
    },
    /// A file.
    Open(PathBuf),
}

/// A scene with everything that was found in it.
#[derive(Debug)]
pub struct Inspected {
    /// Where the scene came from.
    pub origin: Origin,
    /// The scene.
    pub scene: SceneCloud,
    /// What was found.
    pub inspection: Inspection,
    /// What the panels draw.
    pub figures: Figures,
    /// The library it was compared with.
    pub library: Arc<LibraryShown>,
    /// What was odd about the file.
    pub warnings: Vec<FileWarning>,
    /// The least score that is accepted.
    pub min_score: f64,
    /// Middle of the best reference's extent, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// Signed distance of every point of the scene to the best reference at its pose, metres; NaN where there is
    /// none, empty without a pose.
    pub deviations: Vec<f32>,
}

/// What the window shows of a library.
#[derive(Debug, Default)]
pub struct LibraryShown {
    /// Its folder.
    pub path: PathBuf,
    /// Name for people of every reference, in the library's order.
    pub titles: Vec<String>,
    /// What had to be set aside, and what is odd.
    pub troubles: Vec<Trouble>,
}

/// Something that went wrong, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trouble {
    /// What went wrong.
    pub what: String,
    /// What to do.
    pub advice: String,
}

impl Trouble {
    /// From an error that brings its advice.
    pub fn of<E: std::fmt::Display + Advice>(error: &E) -> Self {
        Self {
            what: error.to_string(),
            advice: error.advice(),
        }
    }
}

/// Why a scene could not be inspected.
#[derive(Debug, thiserror::Error)]
enum WorkError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Library(#[from] LibraryError),
    #[error("{}: a mesh, expected what a depth camera saw", path.display())]
    MeshIsNoScene { path: PathBuf },
}

impl Advice for WorkError {
    fn advice(&self) -> String {
        match self {
            Self::File(error) => error.advice(),
            Self::Library(error) => error.advice(),
            Self::MeshIsNoScene { path } => format!(
                "Enrol it as a reference: partsight enrol {} --name NAME",
                path.display()
            ),
        }
    }
}

/// The inspector at work: the library once loaded, and the recipe.
#[derive(Debug, Default)]
pub struct Inspector {
    library_path: Option<PathBuf>,
    loaded: Option<(LibraryLoad, Arc<LibraryShown>)>,
    recipe: Recipe,
}

impl Inspector {
    /// With the library of this folder, else the one that [`open_library`] finds.
    pub fn new(library_path: Option<PathBuf>) -> Self {
        Self {
            library_path,
            ..Self::default()
        }
    }

    /// Does what is asked; `None` when cancelled.
    pub fn answer(
        &mut self,
        request: Request,
        watch: &dyn Watch,
    ) -> Option<Result<Arc<Inspected>, Trouble>> {
        match self.inspect(request, watch) {
            Ok(inspected) => inspected.map(Arc::new).map(Ok),
            Err(error) => Some(Err(Trouble::of(&error))),
        }
    }

    fn inspect(
        &mut self,
        request: Request,
        watch: &dyn Watch,
    ) -> Result<Option<Inspected>, WorkError> {
        if self.loaded.is_none() {
            self.loaded = Some(load(self.library_path.as_deref())?);
        }
        let Some((load, shown)) = &self.loaded else {
            return Ok(None);
        };
        if watch.is_cancelled() {
            return Ok(None);
        }
        let (scene, origin, warnings) = match request {
            Request::Capture { choice, number } => {
                let mut setup = CellSetup::new(choice.subject(number), number);
                setup.pose = PartPose::Drawn(Placement::facing());
                let scene = scene_from_frame(&frame(&setup).frame);
                (scene, Origin::Simulated { number }, Vec::new())
            }
            Request::Open(path) => {
                let (scene, warnings) = open_scene(&path)?;
                (scene, Origin::File(path), warnings)
            }
        };
        let Ok(inspection) = pipeline::run(&scene, &load.library, &self.recipe, watch) else {
            return Ok(None);
        };
        let best = inspection.ranking.entries.first();
        let best = best.and_then(|best| load.library.references.get(best.reference));
        let bounds = best.and_then(|reference| reference.cloud.bounds());
        let deviations = best.map_or_else(Vec::new, |reference| {
            deviations(&scene, &inspection, reference)
        });
        let figures = Figures::of(&scene, &inspection, &load.library, &shown.titles);
        Ok(Some(Inspected {
            origin,
            scene,
            inspection,
            figures,
            library: Arc::clone(shown),
            warnings,
            min_score: self.recipe.accept.min_score,
            middle: bounds.map(|(low, high)| nalgebra::center(&low, &high).cast()),
            deviations,
        }))
    }
}

fn open_scene(path: &Path) -> Result<(SceneCloud, Vec<FileWarning>), WorkError> {
    let opened = files::open(path)?;
    let warnings = opened.warnings();
    let scene = match opened {
        Opened::Cloud(cloud) => scene_from_cloud(cloud),
        Opened::Depth(frame) => scene_from_frame(&frame),
        Opened::Mesh(_) => {
            return Err(WorkError::MeshIsNoScene {
                path: path.to_owned(),
            });
        }
    };
    Ok((scene, warnings))
}

fn load(given: Option<&Path>) -> Result<(LibraryLoad, Arc<LibraryShown>), LibraryError> {
    let place = open_library(given)?;
    let load = place.load(&ReferenceParams::default())?;
    let title = |(meta, name): (&crate::library::PartMeta, &String)| {
        if meta.title.is_empty() {
            name.clone()
        } else {
            meta.title.clone()
        }
    };
    let names = load.library.references.iter().map(|r| r.name.clone());
    let names: Vec<String> = names.collect();
    let set_aside = load.problems.iter().map(Trouble::of);
    let shown = LibraryShown {
        path: place.location().into(),
        titles: load.parts.iter().zip(&names).map(title).collect(),
        troubles: set_aside
            .chain(load.warnings.iter().map(Trouble::of))
            .collect(),
    };
    Ok((load, Arc::new(shown)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::{Unwatched, Verdict};

    #[test]
    fn the_first_frame_is_a_front_door_and_all_eight_parts_come_in_turn() {
        let kind = |number| match CellChoice::InTurn.subject(number) {
            Subject::Part { kind, .. } => kind,
            other => panic!("{other:?}"),
        };
        assert_eq!(kind(1), PartKind::FrontDoor);
        let seen: std::collections::BTreeSet<_> = (1..=8).map(kind).collect();
        assert_eq!(seen.len(), 8);
    }

    #[test]
    fn a_captured_frame_comes_back_inspected_and_a_mesh_is_refused_in_words() {
        let mut inspector = Inspector::new(None);
        let request = Request::Capture {
            choice: CellChoice::InTurn,
            number: 1,
        };
        let inspected = inspector
            .answer(request, &Unwatched)
            .expect("not cancelled");
        let inspected = inspected.expect("inspected");
        let Verdict::Part { part, rejected, .. } = &inspected.inspection.verdict else {
            panic!("no part");
        };
        assert_eq!((part.as_str(), rejected), ("front_door", &None));
        let known = inspected.deviations.iter().filter(|d| d.is_finite());
        let mean = known.clone().sum::<f32>() / known.clone().count() as f32;
        assert!(known.count() > 10_000 && mean.abs() < 0.002, "{mean}");

        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("part.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
        let refused = inspector.answer(Request::Open(path), &Unwatched);
        let trouble = refused.expect("not cancelled").expect_err("refused");
        assert!(trouble.what.contains("a mesh") && trouble.advice.contains("enrol"));
    }
}
