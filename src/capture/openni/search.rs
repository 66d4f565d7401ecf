//! The search for libOpenNI2.

use std::path::Path;

use super::{error::OpenNiError, oni::Library};
use crate::capture::driver_search::{DriverNames, NotLoaded};

/// Environment variable with the library's file or folder; the source's own setting takes precedence.
pub(super) const VARIABLE: &str = "PARTSIGHT_OPENNI";

/// File names of the library. It finds its drivers in the folder `OpenNI2/Drivers` beside it.
const NAMES: &[&str] = if cfg!(target_os = "macos") {
    &["libOpenNI2.dylib", "/opt/homebrew/lib/ni2/libOpenNI2.dylib"]
} else if cfg!(windows) {
    &["OpenNI2.dll"]
} else {
    &["libOpenNI2.so.0", "libOpenNI2.so"]
};

/// Loads the library from `setting`, else from the variable's place, else from the system. Also returns its name.
pub(super) fn find(setting: Option<&Path>) -> Result<(&'static Library, String), OpenNiError> {
    let openni = DriverNames {
        variable: VARIABLE,
        names: NAMES,
    };
    openni
        .find(setting, Library::load)
        .map_err(|error| match error {
            NotLoaded::Absent => OpenNiError::NoLibrary {
                tried: NAMES.to_vec(),
            },
            NotLoaded::NotAt(path) => OpenNiError::LibraryNotAt { path },
            NotLoaded::Unusable { library, reason } => {
                OpenNiError::LibraryUnusable { library, reason }
            }
        })
}
