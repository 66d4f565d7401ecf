//! Where libOpenNI2 is looked for.

use std::path::Path;

use super::{error::OpenNiError, oni::Library};
use crate::capture::driver_search::{DriverNames, NotLoaded};

/// Names a file or a folder; the source's own setting goes before it.
pub(super) const VARIABLE: &str = "PARTSIGHT_OPENNI";

/// The library's names. It finds its drivers in the folder `OpenNI2/Drivers` beside it.
const NAMES: &[&str] = if cfg!(target_os = "macos") {
    &["libOpenNI2.dylib", "/opt/homebrew/lib/ni2/libOpenNI2.dylib"]
} else if cfg!(windows) {
    &["OpenNI2.dll"]
} else {
    &["libOpenNI2.so.0", "libOpenNI2.so"]
};

/// Loads the library: at `setting`, else where the variable says, else where the system keeps libraries. Its name comes
/// with it.
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
