//! Data shared by the threads: the library in use, which is loaded on first use and replaced as a whole when it changes, the
//! camera, the recording and the history.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard},
};

use image::RgbaImage;

use crate::inspection::{
    camera::{Camera, SharedRecording},
    folder_watch::{self, entries},
};
use geometry::error::{Advice as _, lock};
use inspection::{
    library::{
        Library, LibraryError, LibraryFolder, LibraryLoad, LibraryPlace, PartMeta, PartName,
        PartNumbers, SprayPath, TakenVersion, open_library,
    },
    pipeline::{ProgressObserver, Recipe},
};
use records::history::HistoryBuffer;
use robot::{
    RobotFrame,
    spray::{OffThePart, off_the_part},
};
use stages::reference::{Reference, ReferenceParams};
use ui::{
    language::{advised, text},
    user_error::UserError,
};

/// A handle to the library, the camera, the recording, the history and the robot frame in use; clones share them.
#[derive(Clone, Debug)]
pub struct LibraryCache {
    choice: Arc<Mutex<Choice>>,
    camera: Camera,
    recording: SharedRecording,
    history: Arc<HistoryBuffer>,
    robot: Arc<Mutex<Option<Arc<RobotFrame>>>>,
}

#[derive(Debug, Default)]
struct Choice {
    /// The requested folder; without one [`open_library`] finds it.
    given: Option<PathBuf>,
    loaded: Option<Arc<LoadedLibrary>>,
    /// A library loaded before the first one.
    former: Option<Arc<LoadedLibrary>>,
    /// The numbers that the window itself gave to the parts.
    own_numbers: Option<PartNumbers>,
    taken_version: Option<ReadTakenVersion>,
}

/// Reads the published version that a library was taken from; the error and its advice.
pub type ReadTakenVersion = fn(&LibraryPlace) -> Result<Option<TakenVersion>, [String; 2]>;

/// A loaded library.
#[derive(Debug)]
pub struct LoadedLibrary {
    /// Where it is stored; `None` if it could not be loaded.
    pub place: Option<LibraryPlace>,
    /// The references, prepared with the default parameters.
    pub library: Arc<Library>,
    /// The view of it for the window.
    pub shown: Arc<LibraryView>,
    /// The references prepared last with other parameters.
    fitted: Mutex<Option<(ReferenceParams, Arc<Library>)>>,
    /// The entries of its folder before it was loaded; none without a folder, or if one was still young.
    entries: Vec<folder_watch::Entry>,
}

impl LoadedLibrary {
    /// True if it has a folder, which has not changed since.
    fn is_unchanged(&self) -> bool {
        !self.entries.is_empty() && entries(&self.shown.path) == self.entries
    }

    /// Returns its folder, or why it cannot be changed.
    pub fn folder_to_change(&self) -> Result<&LibraryFolder, UserError> {
        let folder = self.place.as_ref().and_then(LibraryPlace::folder);
        folder.ok_or_else(|| {
            let reason = self.shown.is_fixed.clone();
            reason.unwrap_or_else(|| UserError {
                what: text!("shell-inside-program"),
                advice: text!("shell-inside-program-advice"),
            })
        })
    }

    /// Returns the references prepared with the recipe's parameters. Takes as long as loading the library unless the
    /// parameters are the default or those of the last call; `None` if cancelled.
    pub fn fitting(&self, recipe: &Recipe, watch: &dyn ProgressObserver) -> Option<Arc<Library>> {
        let params = recipe.reference_params();
        if params == ReferenceParams::default() {
            return Some(Arc::clone(&self.library));
        }
        let lock = || lock(&self.fitted);
        if let Some((known, library)) = &*lock()
            && *known == params
        {
            return Some(Arc::clone(library));
        }
        let num = self.library.references.len();
        let references = self.library.references.iter().zip(&self.shown.parts);
        let references = references.map(|(loaded, meta)| {
            if watch.is_cancelled() {
                return None;
            }
            // Without an outline at these parameters it keeps the one it was loaded with, and its index.
            let cloud = Arc::clone(&loaded.cloud);
            let prepared = Reference::prepare(&loaded.name, cloud, meta.coverage, &params);
            Some(prepared.map_or_else(
                |_| loaded.clone(),
                |prepared| prepared.with_cut(loaded.cut).for_library_of(num),
            ))
        });
        let library = Arc::new(Library {
            references: references.collect::<Option<_>>()?,
            surface_zones: self.library.surface_zones.clone(),
        });
        *lock() = Some((params, Arc::clone(&library)));
        Some(library)
    }
}

/// What the window shows of a library.
#[derive(Debug, Default)]
pub struct LibraryView {
    /// Folder of the library.
    pub path: PathBuf,
    /// [`LibraryLoad::identity`].
    pub identity: String,
    /// Stored data of every part, in the library's order.
    pub parts: Vec<PartMeta>,
    /// Thumbnails of the parts, in the same order, where there is one.
    pub thumbnails: Vec<Option<RgbaImage>>,
    /// Spray paths of the parts, in the same order, where one is stored.
    pub spray_paths: Vec<Option<StoredPath>>,
    /// The stored numbers by which robots know the parts.
    pub numbers: PartNumbers,
    /// Parts that could not be loaded.
    pub damaged: Vec<Damaged>,
    /// Why it could not be loaded, if so; then it has no parts and cannot be changed.
    pub unloaded: Option<UserError>,
    /// Why it cannot be changed, if so.
    pub is_fixed: Option<UserError>,
    /// Entries that had to be set aside, and other oddities.
    pub problems: Vec<UserError>,
    /// The published version that it was taken from, if it was, in words.
    pub version: Option<String>,
}

/// The spray path stored with a part.
#[derive(Clone, Debug)]
pub struct StoredPath {
    /// The path.
    pub path: SprayPath,
    /// Why robots do not get it, if it does not aim at the part.
    pub off: Option<OffThePart>,
}

/// A part that could not be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damaged {
    /// Name of its folder.
    pub entry: String,
    /// Why, and what to do.
    pub problem: UserError,
}

impl LibraryView {
    /// True if it is in the same folder and has the same parts, with the same titles, notes, numbers and spray paths.
    fn is_same(&self, other: &Self) -> bool {
        self.is_same_but_numbers(other) && self.numbers == other.numbers
    }

    fn is_same_but_numbers(&self, other: &Self) -> bool {
        self.version == other.version
            && self.path == other.path
            && self.identity == other.identity
            && self.parts == other.parts
            && self.damaged == other.damaged
            && self.unloaded == other.unloaded
    }

    /// Title of the part at this index.
    pub fn title(&self, index: usize) -> &str {
        self.parts.get(index).map_or("", PartMeta::shown_title)
    }

    /// Title of the part enrolled under this name; the name itself if there is none.
    pub fn title_of<'a>(&'a self, name: &'a str) -> &'a str {
        self.index_of(name).map_or(name, |index| self.title(index))
    }

    /// Titles that tell all entries apart, in the library's order: the title of the part, with the entry's name where the part has
    /// several references.
    pub fn reference_titles(&self) -> Vec<String> {
        let mut num_references: HashMap<&PartName, usize> = HashMap::new();
        let mut part_titles: HashMap<&PartName, &str> = HashMap::new();
        for entry in &self.parts {
            *num_references.entry(entry.part_name()).or_default() += 1;
            part_titles.insert(&entry.name, entry.shown_title());
        }
        let titles = self.parts.iter().map(|entry| {
            let part = entry.part_name();
            let title = part_titles.get(part).copied().unwrap_or(part.as_str());
            if num_references.get(part).is_some_and(|num| *num > 1) {
                format!("{title} · {}", entry.name)
            } else {
                title.to_owned()
            }
        });
        titles.collect()
    }

    /// Index of the part with this name.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.parts
            .iter()
            .position(|part| part.name.as_str() == name)
    }
}

/// For tests: the shipped parts of the checkout, whatever library the user has. They are loaded once.
#[cfg(any(test, feature = "fixtures"))]
impl Default for LibraryCache {
    fn default() -> Self {
        static SHIPPED: std::sync::OnceLock<Arc<LoadedLibrary>> = std::sync::OnceLock::new();
        let given = ::inspection::fixtures::SHIPPED_PARTS;
        let cache = Self::new(Some(given.into()), Camera::default());
        let shipped = SHIPPED.get_or_init(|| cache.get());
        cache.lock().loaded = Some(Arc::clone(shipped));
        cache
    }
}

impl LibraryCache {
    /// Makes a cache for the library in this folder, else for the one that [`open_library`] finds.
    pub fn new(given: Option<PathBuf>, camera: Camera) -> Self {
        let choice = Choice {
            given,
            ..Choice::default()
        };
        Self {
            choice: Arc::new(Mutex::new(choice)),
            camera,
            recording: SharedRecording::default(),
            history: Arc::default(),
            robot: Arc::default(),
        }
    }

    /// Reads by this function from which published version a library was taken.
    #[must_use]
    pub fn with_versions(self, taken_version: Option<ReadTakenVersion>) -> Self {
        self.lock().taken_version = taken_version;
        self
    }

    /// Takes what is unchanged from a library that was loaded before.
    #[must_use]
    pub fn with_former(self, former: Option<Arc<LoadedLibrary>>) -> Self {
        self.lock().former = former;
        self
    }

    /// The robot frame in use, with the camera's pose in the robot's base, if the cell is calibrated.
    pub fn robot(&self) -> Option<Arc<RobotFrame>> {
        lock(&self.robot).clone()
    }

    /// Sets the robot frame in use.
    pub fn use_robot(&self, robot: Option<Arc<RobotFrame>>) {
        *lock(&self.robot) = robot;
    }

    /// Replaces the history.
    #[must_use]
    pub fn with_history(self, history: Arc<HistoryBuffer>) -> Self {
        Self { history, ..self }
    }

    /// The history of inspections.
    pub fn history(&self) -> &Arc<HistoryBuffer> {
        &self.history
    }

    /// The recording in progress, if any.
    pub fn recording(&self) -> &SharedRecording {
        &self.recording
    }

    /// The camera in use.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the library, loading it on first use. If it cannot be loaded, returns an empty library, so that scenes can
    /// still be captured and shown; the next call tries again.
    pub fn get(&self) -> Arc<LoadedLibrary> {
        let mut choice = self.lock();
        let is_there = |known: &&Arc<LoadedLibrary>| known.shown.unloaded.is_none();
        if let Some(loaded) = choice.loaded.as_ref().filter(is_there) {
            return Arc::clone(loaded);
        }
        match choice.load() {
            Ok(loaded) => loaded,
            Err(error) => choice.without(&error),
        }
    }

    /// Loads the library again after a change.
    pub fn reload(&self) -> Result<Arc<LoadedLibrary>, LibraryError> {
        self.lock().load()
    }

    /// Loads the library again if another program has changed it; `None` if it is unchanged or another one was chosen. If it
    /// cannot be loaded, the present one stays in use.
    pub fn refresh(&self) -> Result<Option<Arc<LoadedLibrary>>, LibraryError> {
        let choice = self.lock();
        let (given, taken_version) = (choice.given.clone(), choice.taken_version);
        let known = choice.loaded.clone();
        drop(choice);
        let known = known.as_deref();
        if known.is_some_and(LoadedLibrary::is_unchanged) {
            return Ok(None);
        }
        // The lock is released while loading, so that no other thread waits for the disk.
        let found = Arc::new(load(given.as_deref(), taken_version, known)?);
        let mut choice = self.lock();
        let known = choice.loaded.as_ref();
        let is_known = known.is_some_and(|known| known.shown.is_same(&found.shown));
        if is_known || choice.given != given {
            return Ok(None);
        }
        choice.loaded = Some(Arc::clone(&found));
        Ok(Some(found))
    }

    /// Notes that the window gave these numbers to the parts.
    pub fn note_numbers(&self, numbers: &PartNumbers) {
        self.lock().own_numbers = Some(numbers.clone());
    }

    /// Returns true if the library only differs from the former one by numbers that the window gave to its parts.
    pub fn is_own_change(&self, former: &LibraryView, now: &LibraryView) -> bool {
        now.is_same_but_numbers(former) && self.lock().own_numbers.as_ref() == Some(&now.numbers)
    }

    /// Switches to the library in this folder, else to the one that [`open_library`] finds. If it cannot be loaded, the old
    /// one stays in use.
    pub fn choose(&self, given: Option<PathBuf>) -> Result<Arc<LoadedLibrary>, LibraryError> {
        let mut other = Choice {
            given,
            ..Choice::default()
        };
        let loaded = other.load()?;
        *self.lock() = other;
        Ok(loaded)
    }

    fn lock(&self) -> MutexGuard<'_, Choice> {
        // Sound after a panic: the content is only ever replaced as a whole.
        lock(&self.choice)
    }
}

impl Choice {
    fn load(&mut self) -> Result<Arc<LoadedLibrary>, LibraryError> {
        let given = self.given.as_deref();
        let is_it = |former: &Arc<LoadedLibrary>| {
            given == Some(former.shown.path.as_path()) && former.is_unchanged()
        };
        let first = self.former.take();
        let loaded = match (&self.loaded, first) {
            (None, Some(first)) if is_it(&first) => first,
            (former, first) => {
                let former = former.as_ref().or(first.as_ref());
                let former = former.map(Arc::as_ref);
                Arc::new(load(given, self.taken_version, former)?)
            }
        };
        self.loaded = Some(Arc::clone(&loaded));
        Ok(loaded)
    }

    /// Returns the stand-in for a library that could not be loaded, the same one for the same error.
    fn without(&mut self, error: &LibraryError) -> Arc<LoadedLibrary> {
        let problem = UserError {
            what: text!("shell-library-not-loaded", error = error.to_string()),
            advice: text!("shell-library-not-loaded-advice", advice = error.advice()),
        };
        if let Some(known) = &self.loaded
            && known.shown.unloaded.as_ref() == Some(&problem)
        {
            return Arc::clone(known);
        }
        let shown = LibraryView {
            path: self.given.clone().unwrap_or_default(),
            problems: vec![problem.clone()],
            is_fixed: Some(problem.clone()),
            unloaded: Some(problem),
            ..LibraryView::default()
        };
        let loaded = Arc::new(LoadedLibrary {
            place: None,
            library: Arc::default(),
            shown: Arc::new(shown),
            fitted: Mutex::default(),
            entries: Vec::new(),
        });
        self.loaded = Some(Arc::clone(&loaded));
        loaded
    }
}

fn load(
    given: Option<&Path>,
    taken_version: Option<ReadTakenVersion>,
    former: Option<&LoadedLibrary>,
) -> Result<LoadedLibrary, LibraryError> {
    let place = open_library(given)?;
    // Before the parts, so that the next look notices what changes meanwhile.
    let entries = place.folder().map(|folder| entries(folder.path()));
    let entries = entries.filter(|entries| folder_watch::are_settled(entries));
    let none = Library::default();
    let former = former.map_or(&none, |former| former.library.as_ref());
    let load = place.load_after(&ReferenceParams::default(), former)?;
    let identity = load.identity();
    let LibraryLoad {
        library,
        parts,
        problems: of_entries,
        warnings,
    } = load;
    let problems = of_entries.iter().map(UserError::of);
    let mut problems: Vec<UserError> = problems.chain(warnings.iter().map(UserError::of)).collect();
    let mut spray_paths = Vec::with_capacity(parts.len());
    for (part, reference) in parts.iter().zip(&library.references) {
        let stored = part
            .spray
            .as_ref()
            .map(|_| place.spray_path(part.name.as_str()));
        spray_paths.push(match stored.transpose() {
            Ok(path) => {
                let path = path.flatten().map(|path| StoredPath {
                    off: off_the_part(&path, reference),
                    path,
                });
                if let Some(advice) = path
                    .as_ref()
                    .and_then(|path| path.off.as_ref())
                    .map(advised)
                {
                    problems.push(UserError {
                        what: text!("shell-path-off-part", part = part.shown_title()),
                        advice,
                    });
                }
                path
            }
            Err(error) => {
                problems.push(UserError::of(&error));
                None
            }
        });
    }
    let numbers = place.numbers().unwrap_or_else(|error| {
        problems.push(UserError::of(&error));
        PartNumbers::default()
    });
    let thumbnails = parts.iter().map(|part| place.thumbnail(part.name.as_str()));
    let damaged = of_entries.iter().map(|problem| Damaged {
        entry: problem.entry.clone(),
        problem: UserError::of(problem),
    });
    let is_fixed = match &place {
        LibraryPlace::Program(reason) => Some(UserError {
            what: text!("shell-library-inside", reason = reason.to_string()),
            advice: reason.advice(),
        }),
        _ => None,
    };
    let without_parts = place.folder().filter(|_| parts.is_empty());
    problems.extend(without_parts.and_then(no_library));
    let taken = taken_version.map(|version_of| version_of(&place));
    let version = match taken.transpose() {
        Ok(version) => version.flatten().map(|version| in_words(&version)),
        Err([what, advice]) => {
            problems.push(UserError { what, advice });
            None
        }
    };
    let shown = Arc::new(LibraryView {
        path: place.location().into(),
        identity,
        thumbnails: thumbnails.collect(),
        damaged: damaged.collect(),
        spray_paths,
        numbers,
        unloaded: None,
        is_fixed,
        parts,
        problems,
        version,
    });
    Ok(LoadedLibrary {
        place: Some(place),
        library: Arc::new(library),
        shown,
        fitted: Mutex::default(),
        entries: entries.unwrap_or_default(),
    })
}

fn in_words(taken: &TakenVersion) -> String {
    let version = taken.version.to_string();
    let store = &taken.store;
    if taken.is_changed {
        text!(
            "shell-library-version-changed",
            version = version,
            store = store
        )
    } else {
        text!("shell-library-version", version = version, store = store)
    }
}

/// What to say of a folder without parts: something else lies there, so probably another one was meant.
fn no_library(folder: &LibraryFolder) -> Option<UserError> {
    let is_visible = |entry: &fs::DirEntry| !entry.file_name().as_encoded_bytes().starts_with(b".");
    let mut entries = fs::read_dir(folder.path()).ok()?.flatten();
    entries.find(is_visible)?;
    let advice = match folder.probably_meant() {
        Some(meant) => text!("shell-choose-library", path = meant.display().to_string()),
        None => text!("shell-choose-or-go-on"),
    };
    Some(UserError {
        what: text!(
            "shell-holds-no-library",
            path = folder.path().display().to_string()
        ),
        advice,
    })
}

#[cfg(test)]
mod tests {
    use std::{
        fs::File,
        time::{Duration, SystemTime},
    };

    use super::*;
    use ::inspection::fixtures::copy_library;
    use inspection::pipeline::Unwatched;

    #[test]
    fn a_library_that_cannot_be_loaded_leaves_the_old_one_in_use() {
        let library_cache = LibraryCache::default();
        let before = library_cache.get();
        assert_eq!(before.shown.index_of("fender"), Some(2));
        assert_eq!(before.shown.title(2), "Fender, left");
        library_cache
            .choose(Some("no/such/library".into()))
            .expect_err("refused");
        let after = library_cache.get();
        assert!(Arc::ptr_eq(&before, &after));
        let anew = library_cache.reload().expect("loaded again");
        assert!(!Arc::ptr_eq(&before, &anew));
    }

    #[test]
    fn a_library_that_comes_late_is_loaded_when_it_is_there() {
        let stick = tempfile::tempdir().expect("a folder");
        let path = stick.path().join("parts");
        let library_cache = LibraryCache::new(Some(path.clone()), Camera::default());
        let missing = library_cache.get();
        let problem = missing.shown.unloaded.as_ref().expect("not there");
        assert!(
            problem.what.contains("no such library folder"),
            "{problem:?}"
        );
        assert!(missing.library.references.is_empty() && missing.shown.is_fixed.is_some());
        // The same error is reported only once.
        assert!(Arc::ptr_eq(&missing, &library_cache.get()));
        fs::create_dir(&path).expect("made");
        let found = library_cache.get();
        assert!(found.shown.unloaded.is_none() && found.shown.problems.is_empty());
    }

    #[test]
    fn a_library_is_loaded_again_only_after_its_folder_has_changed() {
        let folder = tempfile::tempdir().expect("a folder");
        copy_library(folder.path());
        let load = || {
            let library_cache = LibraryCache::new(Some(folder.path().into()), Camera::default());
            library_cache.get();
            library_cache
        };
        let refreshed = |cache: &LibraryCache| cache.refresh().expect("there");
        // Within a step of the disk's clock a change would not show.
        let young = load();
        assert!(!young.lock().loaded.as_ref().expect("loaded").is_unchanged());
        let before = SystemTime::now() - Duration::from_mins(1);
        for entry in fs::read_dir(folder.path()).expect("listed") {
            let entry = File::open(entry.expect("an entry").path()).expect("opened");
            entry.set_modified(before).expect("dated");
        }
        let library_cache = load();
        let loaded = library_cache.get();
        let again = LibraryCache::new(Some(folder.path().into()), Camera::default());
        let again = again.with_former(Some(Arc::clone(&loaded)));
        assert!(Arc::ptr_eq(&again.get(), &loaded));
        // In place, which no writer does: the folder's entries stay as they were, so that nothing is read.
        let fender = folder.path().join("fender");
        fs::write(fender.join("part.toml"), "no part").expect("written");
        assert!(refreshed(&library_cache).is_none());
        fs::rename(fender.join("part.toml"), fender.join("gone.toml")).expect("renamed");
        let changed = refreshed(&library_cache).expect("another");
        assert_eq!(changed.shown.index_of("fender"), None);
        assert_eq!(changed.shown.damaged.len(), 1);
    }

    #[test]
    fn a_library_that_goes_stays_in_use() {
        let stick = tempfile::tempdir().expect("a folder");
        let path = stick.path().join("parts");
        fs::create_dir(&path).expect("made");
        let library_cache = LibraryCache::new(Some(path.clone()), Camera::default());
        let before = library_cache.get();
        fs::remove_dir(&path).expect("removed");
        library_cache.refresh().expect_err("gone");
        assert!(Arc::ptr_eq(&before, &library_cache.get()));
    }

    #[test]
    fn a_folder_of_other_things_is_not_silently_taken_for_a_library() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("letter.txt"), "").expect("written");
        let problems_at = |path: &Path| {
            let loaded = LibraryCache::new(Some(path.to_owned()), Camera::default()).get();
            loaded.shown.problems.clone()
        };
        let other = problems_at(folder.path());
        assert!(other[0].what.contains("holds no library"), "{other:?}");
        let shipped = Path::new(::inspection::fixtures::SHIPPED_PARTS);
        let part = problems_at(&shipped.join("fender"));
        let above = shipped.canonicalize().expect("there");
        let advice = &part[0].advice;
        assert!(advice.contains(&above.display().to_string()), "{advice}");
    }

    struct CancellableProgress;
    impl ProgressObserver for CancellableProgress {
        fn is_cancelled(&self) -> bool {
            true
        }
    }

    #[test]
    fn references_have_as_many_rays_as_the_recipe_gives_scenes() {
        let loaded = LibraryCache::default().get();
        let mut recipe = Recipe::default();
        let as_loaded = loaded.fitting(&recipe, &Unwatched).expect("loaded");
        assert!(Arc::ptr_eq(&as_loaded, &loaded.library));
        recipe.signature.num_rays = 128;
        let fitted = loaded.fitting(&recipe, &Unwatched).expect("prepared");
        let names = |library: &Library| -> Vec<String> {
            let references = library.references.iter();
            references.map(|r| r.name.clone()).collect()
        };
        assert_eq!(names(&fitted), names(&as_loaded));
        for view in fitted.references.iter().flat_map(|r| &r.views) {
            assert_eq!(view.signature().rays.len(), 128);
        }
        let again = loaded.fitting(&recipe, &Unwatched).expect("known");
        assert!(Arc::ptr_eq(&fitted, &again));

        recipe.signature.num_rays = 64;
        assert!(loaded.fitting(&recipe, &CancellableProgress).is_none());
    }
}
