//! What the threads share: the library in use, loaded when first needed and replaced whole when it was changed, and the
//! camera.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use image::RgbaImage;

use super::{camera::Camera, fitted::PreparedLibraryCache, recording::SharedRecording};
use crate::{
    app::user_error::UserError,
    error::Advice as _,
    history::HistoryBuffer,
    library::{
        Library, LibraryError, LibraryLoad, LibraryPlace, PartMeta, SprayPath, open_library,
    },
    stages::reference::ReferenceParams,
};

/// A handle to the library, the camera and the recording in use; clones share them.
#[derive(Clone, Debug, Default)]
pub struct LibraryCache {
    choice: Arc<Mutex<Choice>>,
    camera: Camera,
    recording: SharedRecording,
    history: Arc<HistoryBuffer>,
}

#[derive(Debug, Default)]
struct Choice {
    /// The folder that was asked for; without one [`open_library`] finds it.
    given: Option<PathBuf>,
    loaded: Option<Arc<LoadedLibrary>>,
}

/// A loaded library.
#[derive(Debug)]
pub struct LoadedLibrary {
    /// Where it lies.
    pub place: LibraryPlace,
    /// The references, prepared.
    pub library: Library,
    /// What the window shows of it.
    pub shown: Arc<LibraryView>,
    /// The references as another recipe wants them.
    pub(in crate::app) fitted: PreparedLibraryCache,
}

/// What the window shows of a library.
#[derive(Debug, Default)]
pub struct LibraryView {
    /// Its folder.
    pub path: PathBuf,
    /// [`LibraryLoad::identity`].
    pub identity: String,
    /// What is written down of every part, in the library's order.
    pub parts: Vec<PartMeta>,
    /// The small pictures of the parts, in the same order, where there is one.
    pub thumbnails: Vec<Option<RgbaImage>>,
    /// The spray paths of the parts, in the same order, where one is stored.
    pub spray_paths: Vec<Option<SprayPath>>,
    /// The parts that could not be loaded.
    pub damaged: Vec<Damaged>,
    /// Why it cannot be changed at all, if so.
    pub is_fixed: Option<UserError>,
    /// What had to be set aside, and what is odd.
    pub troubles: Vec<UserError>,
}

/// A part that could not be loaded.
#[derive(Clone, Debug)]
pub struct Damaged {
    /// The name of its folder.
    pub entry: String,
    /// Why, and what to do.
    pub trouble: UserError,
}

impl LibraryView {
    /// Name for people of the part at this place.
    pub fn title(&self, place: usize) -> &str {
        self.parts.get(place).map_or("", PartMeta::shown_title)
    }

    /// The place of a part.
    pub fn place_of(&self, name: &str) -> Option<usize> {
        self.parts
            .iter()
            .position(|part| part.name.as_str() == name)
    }
}

impl LibraryCache {
    /// The library of this folder, else the one that [`open_library`] finds.
    pub fn new(given: Option<PathBuf>, camera: Camera) -> Self {
        let loaded = None;
        Self {
            choice: Arc::new(Mutex::new(Choice { given, loaded })),
            camera,
            recording: SharedRecording::default(),
            history: Arc::default(),
        }
    }

    /// The same, with this history.
    #[must_use]
    pub fn with_history(self, history: Arc<HistoryBuffer>) -> Self {
        Self { history, ..self }
    }

    /// The history.
    pub fn history(&self) -> &Arc<HistoryBuffer> {
        &self.history
    }

    /// The recording in progress.
    pub fn recording(&self) -> &SharedRecording {
        &self.recording
    }

    /// The camera in use.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The library; loads it if nobody has yet.
    pub fn get(&self) -> Result<Arc<LoadedLibrary>, LibraryError> {
        let mut choice = self.lock();
        if let Some(shelved) = &choice.loaded {
            return Ok(Arc::clone(shelved));
        }
        choice.load()
    }

    /// Loads it anew, after it was changed.
    pub fn reload(&self) -> Result<Arc<LoadedLibrary>, LibraryError> {
        self.lock().load()
    }

    /// Uses another library from now on: the one of this folder, else the one that [`open_library`] finds. One that
    /// cannot be loaded leaves the old one in use.
    pub fn choose(&self, given: Option<PathBuf>) -> Result<Arc<LoadedLibrary>, LibraryError> {
        let mut other = Choice {
            given,
            loaded: None,
        };
        let shelved = other.load()?;
        *self.lock() = other;
        Ok(shelved)
    }

    fn lock(&self) -> MutexGuard<'_, Choice> {
        // What it holds is only ever replaced whole.
        self.choice.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Choice {
    fn load(&mut self) -> Result<Arc<LoadedLibrary>, LibraryError> {
        let shelved = Arc::new(load(self.given.as_deref())?);
        self.loaded = Some(Arc::clone(&shelved));
        Ok(shelved)
    }
}

fn load(given: Option<&Path>) -> Result<LoadedLibrary, LibraryError> {
    let place = open_library(given)?;
    let load = place.load(&ReferenceParams::default())?;
    let identity = load.identity();
    let LibraryLoad {
        library,
        parts,
        problems,
        warnings,
    } = load;
    let troubles = problems.iter().map(UserError::of);
    let mut troubles: Vec<UserError> = troubles.chain(warnings.iter().map(UserError::of)).collect();
    let mut spray_paths = Vec::with_capacity(parts.len());
    for part in &parts {
        let stored = part
            .spray
            .as_ref()
            .map(|_| place.spray_path(part.name.as_str()));
        spray_paths.push(match stored.transpose() {
            Ok(path) => path.flatten(),
            Err(error) => {
                troubles.push(UserError::of(&error));
                None
            }
        });
    }
    let thumbnails = parts.iter().map(|part| place.thumbnail(part.name.as_str()));
    let damaged = problems.iter().map(|problem| Damaged {
        entry: problem.entry.clone(),
        trouble: UserError::of(problem),
    });
    let is_fixed = match &place {
        LibraryPlace::Program(reason) => Some(UserError {
            what: format!("The library lies inside the program and cannot be changed ({reason})"),
            advice: reason.advice(),
        }),
        _ => None,
    };
    let shown = Arc::new(LibraryView {
        path: place.location().into(),
        identity,
        thumbnails: thumbnails.collect(),
        damaged: damaged.collect(),
        spray_paths,
        is_fixed,
        parts,
        troubles,
    });
    Ok(LoadedLibrary {
        place,
        library,
        shown,
        fitted: PreparedLibraryCache::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_that_cannot_be_loaded_leaves_the_old_one_in_use() {
        let library_cache = LibraryCache::default();
        let before = library_cache.get().expect("the shipped parts");
        assert_eq!(before.shown.place_of("fender"), Some(2));
        assert_eq!(before.shown.title(2), "Fender, left");
        library_cache
            .choose(Some("no/such/library".into()))
            .expect_err("refused");
        let after = library_cache.get().expect("still there");
        assert!(Arc::ptr_eq(&before, &after));
        let anew = library_cache.reload().expect("loaded again");
        assert!(!Arc::ptr_eq(&before, &anew));
    }
}
