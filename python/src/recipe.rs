//! The parameters of an inspection.

use std::{fmt::Display, path::PathBuf, sync::Arc};

use partsight::{
    RecipeFile,
    pipeline::{
        NamedRecipe, RecipeLabel,
        parameters::{Kind, PARAMETERS, Parameter, Setting, SettingError},
    },
};
use pyo3::{
    IntoPyObjectExt as _,
    exceptions::{PyKeyError, PyValueError},
    prelude::*,
    types::{PyAny, PyDict},
};

use crate::error::advised;

/// The parameters of an inspection: the built-in recipe, or the one in a file, with settings of your own.
///
/// `Recipe({"accept.min_score": 0.85, "segment.plane_distance": "12 mm"})`. Numbers are in the parameter's own unit; names,
/// units and ranges are in docs/guide/parameters.md, and `dict(recipe)` lists all of them.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Recipe {
    pub(crate) recipe: NamedRecipe,
}

fn setting(name: &str, value: impl Display) -> Result<Setting, SettingError> {
    format!("{name}={value}").parse()
}

#[pymethods]
impl Recipe {
    #[new]
    #[pyo3(signature = (settings = None, *, file = None))]
    fn new(
        py: Python<'_>,
        settings: Option<&Bound<'_, PyAny>>,
        file: Option<PathBuf>,
    ) -> PyResult<Self> {
        let file = match file {
            Some(path) => py.detach(|| RecipeFile::read(&path)).map_err(advised)?,
            None => RecipeFile::built_in(),
        };
        let mut recipe = file.recipe.clone();
        if let Some(settings) = settings {
            let given = PyDict::new(py);
            given.update(settings.cast()?)?;
            for (name, value) in given {
                let name: String = name.extract()?;
                setting(&name, value.str()?)
                    .map_err(advised)?
                    .apply(&mut recipe);
            }
        }
        let label = RecipeLabel {
            name: file.name.to_string(),
            is_changed: recipe != file.recipe,
        };
        let parameters = Arc::new(recipe);
        Ok(Self {
            recipe: NamedRecipe { label, parameters },
        })
    }

    /// Its name, followed by `(modified)` if a setting differs from the recipe of this name; `built-in` is the
    /// program's own.
    #[getter]
    fn name(&self) -> String {
        self.recipe.label.to_string()
    }

    /// Eight hexadecimal digits, the same for the same parameters.
    #[getter]
    fn identity(&self) -> String {
        self.recipe.identity()
    }

    /// The names of all parameters.
    #[staticmethod]
    fn keys() -> Vec<&'static str> {
        PARAMETERS.iter().map(|parameter| parameter.key).collect()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(parameter) = Parameter::<partsight::Recipe>::of_key(name) else {
            let error = setting(name, "").map_or_else(|error| error.to_string(), |_| name.into());
            return Err(PyKeyError::new_err(error));
        };
        match parameter.kind {
            Kind::Number(_) => parameter.value(&self.recipe).into_bound_py_any(py),
            Kind::Choice(_) => parameter.text(&self.recipe).into_bound_py_any(py),
        }
    }

    /// Supports `pickle`: keeps the name, and the parameters to the bit.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (String, bool, String))> {
        let RecipeLabel { name, is_changed } = self.recipe.label.clone();
        let parameters: &partsight::Recipe = &self.recipe;
        let json = serde_json::to_string(parameters);
        let json = json.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let restore = py.get_type::<Self>().getattr("_restore")?;
        Ok((restore, (name, is_changed, json)))
    }

    /// Restores a pickled recipe.
    #[staticmethod]
    fn _restore(name: String, is_changed: bool, json: &str) -> PyResult<Self> {
        let recipe: partsight::Recipe =
            serde_json::from_str(json).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let recipe = NamedRecipe {
            label: RecipeLabel { name, is_changed },
            parameters: Arc::new(recipe),
        };
        Ok(Self { recipe })
    }

    fn __repr__(&self) -> String {
        format!("<Recipe {}, {}>", self.recipe.label, self.identity())
    }
}
