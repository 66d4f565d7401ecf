//! Where libfreenect is looked for.

use std::{
    env,
    ffi::OsString,
    path::{Path, PathBuf, absolute},
};

use super::{error::KinectError, freenect::Library};

/// Names a file or a folder; the source's own setting goes before it.
pub(super) const VARIABLE: &str = "PARTSIGHT_FREENECT";

/// The library's names, the one that is known to fit first.
const NAMES: &[&str] = if cfg!(target_os = "macos") {
    &[
        "libfreenect.0.5.dylib",
        "libfreenect.0.dylib",
        "libfreenect.dylib",
        // Homebrew's folder on Apple's own processors is none of those that the system looks into.
        "/opt/homebrew/lib/libfreenect.dylib",
    ]
} else if cfg!(windows) {
    &["freenect.dll", "libfreenect.dll"]
} else {
    &["libfreenect.so.0.5", "libfreenect.so.0", "libfreenect.so"]
};

/// A library and the name that it was found by.
pub(super) struct LoadedDriver {
    pub(super) library: &'static Library,
    pub(super) name: String,
}

/// Loads the library: at `setting`, else where the variable says, else where the system keeps libraries.
///
/// A place that is set and wrong is an error: another library than the one that was asked for is not taken.
pub(super) fn find(setting: Option<&Path>) -> Result<LoadedDriver, KinectError> {
    let variable = env::var_os(VARIABLE).filter(|value| !value.is_empty());
    match setting
        .map(Path::to_path_buf)
        .or(variable.map(PathBuf::from))
    {
        Some(place) => find_at(&place),
        None => first_of(NAMES.iter().map(OsString::from)).unwrap_or_else(|| {
            let tried = NAMES.to_vec();
            Err(KinectError::NoLibrary { tried })
        }),
    }
}

fn find_at(place: &Path) -> Result<LoadedDriver, KinectError> {
    // A bare name would be looked for in the system's folders.
    let path = absolute(place).unwrap_or_else(|_| place.to_path_buf());
    let not_there = || KinectError::LibraryNotAt {
        path: place.to_path_buf(),
    };
    if path.is_dir() {
        let files = NAMES
            .iter()
            .map(|name| path.join(name))
            .filter(|file| file.is_file());
        return first_of(files.map(OsString::from)).unwrap_or_else(|| Err(not_there()));
    }
    if !path.is_file() {
        return Err(not_there());
    }
    first_of([OsString::from(path)]).unwrap_or_else(|| Err(not_there()))
}

/// The first that is there; `None` if none is. One that is there and cannot be loaded is the answer, too.
fn first_of(
    names: impl IntoIterator<Item = OsString>,
) -> Option<Result<LoadedDriver, KinectError>> {
    names.into_iter().find_map(|name| {
        let text = name.to_string_lossy().into_owned();
        match Library::load(&name) {
            Ok(library) => Some(Ok(LoadedDriver {
                library,
                name: text,
            })),
            Err(reason) if is_absent(&text, &reason) => None,
            Err(reason) => Some(Err(KinectError::LibraryUnusable {
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
