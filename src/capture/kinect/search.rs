//! The search for libfreenect.

use std::path::Path;

use super::{error::KinectError, freenect::Library};
use crate::capture::driver_search::{DriverNames, NotLoaded};

/// Environment variable with the library's file or folder; the source's own setting takes precedence.
pub(super) const VARIABLE: &str = "PARTSIGHT_FREENECT";

/// File names of the library, the best-tested version first.
const NAMES: &[&str] = if cfg!(target_os = "macos") {
    &[
        "libfreenect.0.5.dylib",
        "libfreenect.0.dylib",
        "libfreenect.dylib",
        // Homebrew's folder on Apple silicon is not among those that the system searches.
        "/opt/homebrew/lib/libfreenect.dylib",
    ]
} else if cfg!(windows) {
    &["freenect.dll", "libfreenect.dll"]
} else {
    &["libfreenect.so.0.5", "libfreenect.so.0", "libfreenect.so"]
};

/// A library and the name by which it was found.
pub(super) struct LoadedDriver {
    pub(super) library: &'static Library,
    pub(super) name: String,
}

/// Loads the library from `setting`, else from the variable's place, else from the system.
pub(super) fn find(setting: Option<&Path>) -> Result<LoadedDriver, KinectError> {
    let freenect = DriverNames {
        variable: VARIABLE,
        names: NAMES,
    };
    match freenect.find(setting, Library::load) {
        Ok((library, name)) => Ok(LoadedDriver { library, name }),
        Err(NotLoaded::Absent) => Err(KinectError::NoLibrary {
            tried: NAMES.to_vec(),
        }),
        Err(NotLoaded::NotAt(path)) => Err(KinectError::LibraryNotAt { path }),
        Err(NotLoaded::Unusable { library, reason }) => {
            Err(KinectError::LibraryUnusable { library, reason })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_without_the_library_and_a_file_that_is_none_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        for place in [
            folder.path().to_path_buf(),
            folder.path().join("libfreenect.so.0.5"),
        ] {
            let error = find(Some(&place)).err().expect("nothing there");
            assert!(
                matches!(&error, KinectError::LibraryNotAt { path } if *path == place),
                "{error}"
            );
        }
        let file = folder.path().join(NAMES[0]);
        std::fs::write(&file, "no library").unwrap();
        for place in [folder.path(), file.as_path()] {
            let error = find(Some(place)).err().expect("no library");
            let is_unusable = matches!(&error, KinectError::LibraryUnusable { .. });
            assert!(cfg!(windows) || is_unusable, "{error}");
        }
    }
}
