//! Finds and loads a camera's library, at the place of a setting or else where the system keeps libraries, and looks up its
//! functions.

use std::{
    env,
    ffi::{OsStr, OsString},
    path::{Path, PathBuf, absolute},
};

use super::{
    camera_error::{CameraError, CameraErrorKind},
    camera_library::CameraLibrary,
};

/// Why a file was not loaded.
pub(super) enum LoadError {
    /// The system cannot load it, with the system's message.
    System(String),
    /// It lacks this function.
    MissingSymbol(&'static str),
}

impl CameraLibrary {
    /// Loads the library with `load`.
    ///
    /// A wrong place in a setting is an error: no other library than the requested one is loaded.
    pub(super) fn find<L>(
        &'static self,
        setting: Option<&Path>,
        load: impl Fn(&OsStr) -> Result<L, LoadError>,
    ) -> Result<L, CameraError> {
        let variable = env::var_os(self.variable).filter(|value| !value.is_empty());
        let location = setting.map(Path::to_path_buf);
        let Some(location) = location.or(variable.map(PathBuf::from)) else {
            let files = self.file_names.iter().map(OsString::from);
            let found = self.load_first(files, load);
            return found.unwrap_or_else(|| Err(self.missing(None)));
        };
        // Make the path absolute: a bare name would be searched for in the system's folders.
        let path = absolute(&location).unwrap_or_else(|_| location.clone());
        let files: Vec<PathBuf> = if path.is_dir() {
            let names = self.file_names.iter();
            names.map(|name| path.join(name)).collect()
        } else {
            vec![path]
        };
        let files = files.into_iter().filter(|file| file.is_file());
        let found = self.load_first(files.map(OsString::from), load);
        found.unwrap_or_else(|| Err(self.missing(Some(location))))
    }

    fn missing(&'static self, path: Option<PathBuf>) -> CameraError {
        self.error(CameraErrorKind::LibraryMissing { path })
    }

    /// Loads the first file that exists; `None` if there is none. One that exists and cannot be used is an error.
    fn load_first<L>(
        &'static self,
        files: impl IntoIterator<Item = OsString>,
        load: impl Fn(&OsStr) -> Result<L, LoadError>,
    ) -> Option<Result<L, CameraError>> {
        files.into_iter().find_map(|name| {
            let file = name.to_string_lossy().into_owned();
            let error = match load(&name) {
                Ok(loaded) => return Some(Ok(loaded)),
                Err(LoadError::System(reason)) if is_absent(&file, &reason) => return None,
                Err(LoadError::System(reason)) => self
                    .error(CameraErrorKind::LibraryNotLoaded { file })
                    .quoting([reason]),
                Err(LoadError::MissingSymbol(function)) => {
                    self.error(CameraErrorKind::LibraryLacks { file, function })
                }
            };
            Some(Err(error))
        })
    }
}

/// True if the system's message means that the library does not exist, rather than that it or one of its dependencies
/// cannot be loaded.
fn is_absent(name: &str, reason: &str) -> bool {
    // On Windows the message is the same code in both cases.
    cfg!(windows) || (reason.contains(name) && reason.to_lowercase().contains("no such file"))
}

/// Defines `Functions`, a library's functions with their types as in its header, and loads them. The library may lack those
/// after a `?`.
macro_rules! driver_functions {
    (
        $(#[$attribute:meta])*
        $($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*
        $(? $optional:ident: fn($($of_optional:ty),*) $(-> $optional_result:ty)?;)*
    ) => {
        $(#[$attribute])*
        pub(super) struct Functions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            $($optional: Option<unsafe extern "C" fn($($of_optional),*) $(-> $optional_result)?>,)*
        }

        impl Functions {
            /// Loads the library of that name or path, which stays loaded until the process ends.
            pub(super) fn load(
                name: &std::ffi::OsStr,
            ) -> Result<&'static Self, $crate::driver_search::LoadError> {
                use $crate::driver_search::LoadError;
                static LOADED: std::sync::Mutex<Vec<(std::ffi::OsString, &'static Functions)>> =
                    std::sync::Mutex::new(Vec::new());
                let mut loaded = ::geometry::error::lock(&LOADED);
                if let Some((_, functions)) = loaded.iter().find(|(known, _)| known == name) {
                    return Ok(functions);
                }
                // SAFETY: loading runs the library's initialisers, which only set up its own objects; if a setting
                // names another library, that one's run as if the user had started it as a program.
                let library = unsafe { libloading::Library::new(name) };
                let library = library.map_err(|error| LoadError::System(error.to_string()))?;
                let functions = Self::look_up(&library);
                // Even a library that lacks a function may have started threads: never unload it.
                std::mem::forget(library);
                let functions = functions.map_err(LoadError::MissingSymbol)?;
                let functions: &'static Self = Box::leak(Box::new(functions));
                loaded.push((name.to_owned(), functions));
                Ok(functions)
            }

            fn look_up(library: &libloading::Library) -> Result<Self, &'static str> {
                Ok(Self {
                    // SAFETY: the types are those of the header, and the library is never unloaded.
                    $($name: *unsafe { library.get(stringify!($name).as_bytes()) }
                        .or(Err(stringify!($name)))?,)*
                    // SAFETY: as above.
                    $($optional: unsafe { library.get(stringify!($optional).as_bytes()) }
                        .ok()
                        .map(|function| *function),)*
                })
            }
        }
    };
}
pub(super) use driver_functions;

#[cfg(test)]
mod tests {
    use std::{collections::BTreeSet, fs};

    use super::*;
    use crate::camera_library::FREENECT;
    use geometry::error::Advice as _;

    static LIBRARY: CameraLibrary = CameraLibrary {
        name: "libtest",
        cameras: "test cameras",
        versions: "libtest 1",
        install: "apt-get install libtest1",
        variable: "PARTSIGHT_NO_SUCH_VARIABLE",
        file_names: &["libtest.so.1", "libtest.so"],
        ..FREENECT
    };

    /// Loads text files as if they were libraries.
    fn load(name: &OsStr) -> Result<PathBuf, LoadError> {
        let path = PathBuf::from(name);
        match fs::read_to_string(&path).as_deref() {
            Ok("library") => Ok(path),
            Ok("another") => Err(LoadError::MissingSymbol("test_init")),
            Ok(_) => Err(LoadError::System("invalid ELF header".into())),
            Err(_) => Err(LoadError::System(format!(
                "{}: No such file or directory",
                path.display()
            ))),
        }
    }

    #[test]
    fn the_best_tested_file_of_a_place_is_loaded_or_is_an_error_with_its_own_advice() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (
            folder.path().join("libtest.so.1"),
            folder.path().join("libtest.so"),
        );
        let missing = folder.path().join("missing");
        let mut advice = BTreeSet::new();
        let mut refused = |place: Option<&Path>, words: &str| {
            let error = LIBRARY.find(place, load).expect_err(words);
            assert!(error.to_string().contains(words), "{error}");
            assert!(!error.advice().contains('\n') && !error.advice().ends_with('.'));
            advice.insert(error.advice());
        };
        let not_installed = "libtest, the library for test cameras, is not installed (looked for libtest.so.1, libtest.so)";
        refused(None, not_installed);
        for place in [folder.path(), missing.as_path(), second.as_path()] {
            let words = format!("{}: libtest was not found there", place.display());
            refused(Some(place), &words);
        }
        fs::write(&second, "library").unwrap();
        for place in [folder.path(), second.as_path()] {
            assert_eq!(LIBRARY.find(Some(place), load).unwrap(), second);
        }
        fs::write(&first, "no library").unwrap();
        if cfg!(not(windows)) {
            refused(Some(folder.path()), "so.1 cannot be loaded: invalid ELF");
        }
        fs::write(&first, "another").unwrap();
        let words = "so.1 has no function test_init: not libtest 1";
        refused(Some(folder.path()), words);
        fs::write(&first, "library").unwrap();
        assert_eq!(LIBRARY.find(Some(folder.path()), load).unwrap(), first);

        let num_with = |words: &str| {
            advice
                .iter()
                .filter(|advice| advice.contains(words))
                .count()
        };
        assert_eq!(advice.len(), if cfg!(windows) { 3 } else { 4 });
        assert_eq!(num_with("PARTSIGHT_NO_SUCH_VARIABLE"), 2, "{advice:?}");
        assert_eq!(
            num_with("apt-get install libtest1"),
            advice.len() - 1,
            "{advice:?}"
        );
    }

    #[test]
    fn of_many_file_names_a_message_shows_the_first() {
        static MANY: CameraLibrary = CameraLibrary {
            file_names: &[
                "libtest.so.3",
                "libtest.so.2",
                "libtest.so.1",
                "libtest.so.0",
            ],
            ..LIBRARY
        };
        let error = MANY
            .find(None, load)
            .expect_err("not installed")
            .to_string();
        let names = "(looked for libtest.so.3, libtest.so.2, libtest.so.1, …)";
        assert!(error.ends_with(names), "{error}");
    }

    #[test]
    fn a_library_that_lacks_another_is_not_taken_for_absent() {
        let absent = "libfreenect.so.0: cannot open shared object file: No such file or directory";
        assert!(is_absent("libfreenect.so.0", absent));
        let lacks = "libusb-1.0.so.0: cannot open shared object file: No such file or directory";
        assert!(cfg!(windows) || !is_absent("libfreenect.so.0", lacks));
    }
}
