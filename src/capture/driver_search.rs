//! Where the library of a camera is looked for, where a setting says, else where the system keeps libraries; and its
//! functions once it is found.

use std::{
    env,
    ffi::{OsStr, OsString},
    path::{Path, PathBuf, absolute},
};

/// The library of one kind of camera.
pub(super) struct DriverNames<'a> {
    /// The variable that names its file or folder; the source's own setting goes before it.
    pub(super) variable: &'static str,
    /// Its file names, the one that is known to fit first.
    pub(super) names: &'a [&'a str],
}

/// Why no library was loaded.
#[derive(Debug)]
pub(super) enum NotLoaded {
    /// The system has none of the names.
    Absent,
    /// The place that a setting names has none.
    NotAt(PathBuf),
    /// There is one and the system cannot load it.
    Unusable {
        /// Its name or path.
        library: String,
        /// The system's words.
        reason: String,
    },
}

impl DriverNames<'_> {
    /// Loads the library with `load`, which gives the system's words where it cannot, and tells the name that it was
    /// found by.
    ///
    /// A place that is set and wrong is an error: another library than the one that was asked for is not taken.
    pub(super) fn find<L>(
        &self,
        setting: Option<&Path>,
        load: impl Fn(&OsStr) -> Result<L, String>,
    ) -> Result<(L, String), NotLoaded> {
        let variable = env::var_os(self.variable).filter(|value| !value.is_empty());
        match setting
            .map(Path::to_path_buf)
            .or(variable.map(PathBuf::from))
        {
            Some(place) => self.find_at(&place, load),
            None => first_of(self.names.iter().map(OsString::from), load)
                .unwrap_or(Err(NotLoaded::Absent)),
        }
    }

    fn find_at<L>(
        &self,
        place: &Path,
        load: impl Fn(&OsStr) -> Result<L, String>,
    ) -> Result<(L, String), NotLoaded> {
        // A bare name would be looked for in the system's folders.
        let path = absolute(place).unwrap_or_else(|_| place.to_path_buf());
        let files: Vec<PathBuf> = if path.is_dir() {
            self.names.iter().map(|name| path.join(name)).collect()
        } else {
            vec![path]
        };
        let files = files.into_iter().filter(|file| file.is_file());
        first_of(files.map(OsString::from), load)
            .unwrap_or_else(|| Err(NotLoaded::NotAt(place.to_path_buf())))
    }
}

/// The first that is there; `None` if none is. One that is there and cannot be loaded is the answer, too.
fn first_of<L>(
    names: impl IntoIterator<Item = OsString>,
    load: impl Fn(&OsStr) -> Result<L, String>,
) -> Option<Result<(L, String), NotLoaded>> {
    names.into_iter().find_map(|name| {
        let text = name.to_string_lossy().into_owned();
        match load(&name) {
            Ok(library) => Some(Ok((library, text))),
            Err(reason) if is_absent(&text, &reason) => None,
            Err(reason) => Some(Err(NotLoaded::Unusable {
                library: text,
                reason,
            })),
        }
    })
}

/// True if the system's words say that there is no such library, rather than that it, or one that it needs in turn,
/// cannot be loaded.
fn is_absent(name: &str, reason: &str) -> bool {
    // Windows gives a code for either.
    cfg!(windows) || (reason.contains(name) && reason.to_lowercase().contains("no such file"))
}

/// Makes `Functions`, the functions of a library by name with their types as its header has them, and `Library`, which loads
/// it.
macro_rules! driver_functions {
    (
        $(#[$attribute:meta])*
        $($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*
    ) => {
        #[derive(Clone, Copy)]
        $(#[$attribute])*
        struct Functions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            fn look_up(library: &'static libloading::Library) -> Result<Self, &'static str> {
                Ok(Self {
                    // SAFETY: the types are those of the header, and the library is never unloaded.
                    $($name: *unsafe { library.get(stringify!($name).as_bytes()) }
                        .or(Err(stringify!($name)))?,)*
                })
            }
        }

        /// A loaded library. It stays so until the process ends.
        pub(super) struct Library {
            /// Or the first function that is missing.
            functions: Result<Functions, &'static str>,
        }

        impl Library {
            /// Loads the library of that name or path, or says why that cannot be done in the system's own words.
            pub(super) fn load(name: &std::ffi::OsStr) -> Result<&'static Self, String> {
                static LOADED: std::sync::Mutex<Vec<(std::ffi::OsString, &'static Library)>> =
                    std::sync::Mutex::new(Vec::new());
                let mut loaded = $crate::error::lock(&LOADED);
                if let Some((_, library)) = loaded.iter().find(|(known, _)| known == name) {
                    return Ok(library);
                }
                // SAFETY: loading runs the library's initialisers, which only set up its own objects; a person who names
                // another library by a setting runs that one's as if it had been started as a program.
                let library = unsafe { libloading::Library::new(name) };
                let library = library.map_err(|error| error.to_string())?;
                let functions = Functions::look_up(Box::leak(Box::new(library)));
                let library: &'static Self = Box::leak(Box::new(Self { functions }));
                loaded.push((name.to_owned(), library));
                Ok(library)
            }
        }
    };
}
pub(super) use driver_functions;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_that_lacks_another_is_not_taken_for_absent() {
        let absent = "libfreenect.so.0: cannot open shared object file: No such file or directory";
        assert!(is_absent("libfreenect.so.0", absent));
        let lacks = "libusb-1.0.so.0: cannot open shared object file: No such file or directory";
        assert!(cfg!(windows) || !is_absent("libfreenect.so.0", lacks));
    }
}
