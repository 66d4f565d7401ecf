//! Finds and loads a camera's library, at the place of a setting or else where the system keeps libraries, and looks up its
//! functions.

use std::{
    env,
    ffi::{OsStr, OsString},
    path::{Path, PathBuf, absolute},
};

/// The library of one kind of camera.
pub(super) struct DriverNames<'a> {
    /// Environment variable with the library's file or folder; the source's own setting takes precedence.
    pub(super) variable: &'static str,
    /// File names to try, the best-tested version first.
    pub(super) names: &'a [&'a str],
}

/// Why no library was loaded.
#[derive(Debug)]
pub(super) enum NotLoaded {
    /// The system has no library of any of the names.
    Absent,
    /// The place in a setting has no such library.
    NotAt(PathBuf),
    /// A library was found, but the system cannot load it.
    Unusable {
        /// Name or path of the library.
        library: String,
        /// The system's message.
        reason: String,
    },
}

impl DriverNames<'_> {
    /// Loads the library with `load`, whose error is the system's message. Also returns the name by which the library was
    /// found.
    ///
    /// A wrong place in a setting is an error: no other library than the requested one is loaded.
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
        // Make the path absolute: a bare name would be searched for in the system's folders.
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

/// Loads the first library that exists; `None` if there is none. One that exists and cannot be loaded is an error.
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

/// True if the system's message means that the library does not exist, rather than that it or one of its dependencies
/// cannot be loaded.
fn is_absent(name: &str, reason: &str) -> bool {
    // On Windows the message is the same code in both cases.
    cfg!(windows) || (reason.contains(name) && reason.to_lowercase().contains("no such file"))
}

/// Defines `Functions`, a library's functions with their types as in its header, and `Library`, which loads it.
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

        /// A library, loaded until the process ends.
        pub(super) struct Library {
            /// The functions, or the name of the first missing one.
            functions: Result<Functions, &'static str>,
        }

        impl Library {
            /// Loads the library of that name or path; the error is the system's message.
            pub(super) fn load(name: &std::ffi::OsStr) -> Result<&'static Self, String> {
                static LOADED: std::sync::Mutex<Vec<(std::ffi::OsString, &'static Library)>> =
                    std::sync::Mutex::new(Vec::new());
                let mut loaded = $crate::error::lock(&LOADED);
                if let Some((_, library)) = loaded.iter().find(|(known, _)| known == name) {
                    return Ok(library);
                }
                // SAFETY: loading runs the library's initialisers, which only set up its own objects; if a setting
                // names another library, that one's run as if the user had started it as a program.
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
