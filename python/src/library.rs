//! The enrolled parts.

use std::{
    collections::BTreeMap,
    path::PathBuf,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use numpy::PyArrayDyn;
use partsight::{
    EnrolParams, LibraryError, LibraryFolder, LibraryLoad, PartDescription, PartName,
    enrol_captured,
    library::{LibraryPlace, MAX_TITLE, likenesses, open_library},
    pipeline::NamedRecipe,
};
use pyo3::prelude::*;

use crate::{
    arrays::points_of,
    error::{advised, refused, warn},
    recipe::Recipe,
    scene::Scene,
};

/// A library of enrolled parts, prepared for inspections.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Library {
    place: LibraryPlace,
    /// The recipe that its references are prepared with.
    pub(crate) recipe: NamedRecipe,
    /// Replaced as a whole when a part is enrolled.
    loaded: Mutex<Arc<LibraryLoad>>,
}

impl Library {
    /// A snapshot of the enrolled parts, which later enrolling does not change.
    pub(crate) fn loaded(&self) -> Arc<LibraryLoad> {
        self.lock().clone()
    }

    /// The recipe to inspect with: the one given, or else the library's own. Fails if the references are prepared
    /// with other parameters than the one given.
    pub(crate) fn recipe_or<'a>(&'a self, given: Option<&'a Recipe>) -> PyResult<&'a NamedRecipe> {
        let recipe = given.map_or(&self.recipe, |given| &given.recipe);
        if recipe.reference_params() != self.recipe.reference_params() {
            return Err(refused(
                "the library was prepared by other parameters of projection, contour or signature than the recipe's",
                "Open the library with the recipe: Library.open(path, recipe=recipe)",
            ));
        }
        Ok(recipe)
    }

    fn lock(&self) -> MutexGuard<'_, Arc<LibraryLoad>> {
        // A panic elsewhere leaves no partial state: the value is only replaced as a whole.
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn load(
        py: Python<'_>,
        recipe: Option<&Recipe>,
        open: impl Send + FnOnce() -> Result<LibraryPlace, LibraryError>,
    ) -> PyResult<Self> {
        let recipe = recipe.map_or_else(NamedRecipe::default, |given| given.recipe.clone());
        let params = recipe.reference_params();
        let (place, load) = py
            .detach(|| {
                let place = open()?;
                let load = place.load(&params)?;
                Ok((place, load))
            })
            .map_err(|error: LibraryError| advised(error))?;
        for problem in &load.problems {
            warn(py, problem)?;
        }
        for warning in &load.warnings {
            warn(py, warning)?;
        }
        Ok(Self {
            place,
            recipe,
            loaded: Mutex::new(Arc::new(load)),
        })
    }
}

#[pymethods]
impl Library {
    /// Opens a library's folder. Without a path it opens your own, which the window and the commands use, too, and
    /// which is filled with the eight shipped parts the first time.
    ///
    /// Parts are prepared with the parameters of the recipe. A damaged part is left out with a `UserWarning`.
    #[staticmethod]
    #[pyo3(signature = (path = None, *, recipe = None))]
    fn open(py: Python<'_>, path: Option<PathBuf>, recipe: Option<&Recipe>) -> PyResult<Self> {
        Self::load(py, recipe, move || open_library(path.as_deref()))
    }

    /// Opens a library's folder, and creates it if it does not exist.
    #[staticmethod]
    #[pyo3(signature = (path, *, recipe = None))]
    fn create(py: Python<'_>, path: PathBuf, recipe: Option<&Recipe>) -> PyResult<Self> {
        Self::load(py, recipe, move || {
            LibraryFolder::open_or_create(&path).map(LibraryPlace::Given)
        })
    }

    /// Its folder; `None` for the parts inside the program, which are used if the system has no folder for your own.
    #[getter]
    fn path(&self) -> Option<PathBuf> {
        self.place.folder().map(|folder| folder.path().to_owned())
    }

    /// Eight hexadecimal digits, the same for the same parts with the same clouds in any folder.
    #[getter]
    fn identity(&self) -> String {
        self.loaded().identity()
    }

    /// The names of the parts that an inspection may find, in order.
    #[getter]
    fn parts(&self) -> Vec<String> {
        let loaded = self.loaded();
        let names = loaded.parts.iter().map(|part| part.part_name().to_string());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names.dedup();
        names
    }

    /// Titles of all references by their names; a part may have several references.
    #[getter]
    fn titles(&self) -> BTreeMap<String, String> {
        let loaded = self.loaded();
        let titled = loaded
            .parts
            .iter()
            .map(|part| (part.name.to_string(), part.shown_title().to_owned()));
        titled.collect()
    }

    /// The cloud of a reference in part space, metres, float32 of the shape (N, 3): a new array each time.
    fn points<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let loaded = self.loaded();
        let mut references = loaded.library.references.iter();
        let Some(found) = references.find(|reference| reference.enrolled_as == name) else {
            return Err(advised(LibraryError::NoSuchPart {
                path: self.place.location().into(),
                name: name.to_owned(),
                available: self.titles().into_keys().collect(),
            }));
        };
        points_of(py, &found.cloud)
    }

    /// Enrols the part in a capture, as seen from one side; part space is the camera space of that capture.
    ///
    /// An earlier part of the same name goes to the library's trash. Anything odd about the part, or another part
    /// that it cannot be told from, raises a `UserWarning`. Inspections that began before use the library as it was.
    #[pyo3(signature = (scene, name, *, title = "", notes = ""))]
    fn enrol(
        &self,
        py: Python<'_>,
        scene: &Scene,
        name: &str,
        title: &str,
        notes: &str,
    ) -> PyResult<()> {
        let folder = match &self.place {
            LibraryPlace::Given(folder) | LibraryPlace::User(folder) => folder,
            LibraryPlace::Program(reason) => {
                return Err(refused(
                    reason,
                    "Open a folder of your own: Library.create(path)",
                ));
            }
        };
        let found = title.chars().count();
        if found > MAX_TITLE {
            let message =
                format!("the title has {found} characters, but at most {MAX_TITLE} are kept");
            return Err(refused(message, "Put the rest into the notes"));
        }
        let about = PartDescription {
            name: PartName::new(name).map_err(advised)?,
            title: title.to_owned(),
            notes: notes.to_owned(),
            from: scene.name.clone(),
            at: partsight::clock::now(),
            simulated: scene.capture.cloud.is_simulated,
        };
        let params = EnrolParams {
            segment: self.recipe.segment.clone(),
            ..EnrolParams::default()
        };
        let cloud = &scene.capture;
        let enrolled = py
            .detach(|| enrol_captured(cloud, &about, &params))
            .map_err(advised)?;
        let params = self.recipe.reference_params();
        let former = self.lock().clone();
        let load = py
            .detach(|| {
                folder.save(&enrolled.part)?;
                let load = Arc::new(folder.load_after(&params, &former.library)?);
                *self.lock() = load.clone();
                Ok(load)
            })
            .map_err(|error: LibraryError| advised(error))?;
        for warning in &enrolled.warnings {
            warn(py, warning)?;
        }
        let similar = py.detach(|| likenesses(&enrolled, Some(cloud), &load.library));
        let similar = similar.first().filter(|first| !first.is_distinguishable());
        similar.map_or(Ok(()), |similar| warn(py, similar))
    }

    /// The number of references.
    fn __len__(&self) -> usize {
        self.loaded().parts.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Library {:?}, {} references>",
            self.place.location(),
            self.__len__()
        )
    }
}
