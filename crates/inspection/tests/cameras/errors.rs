//! Errors of cameras, and the list of sources by library.

use capture::{CameraError, CameraLibrary, CaptureError, SourceListing, SourceSpec, list};

/// The error of a camera, its library or its file; any other fails the test.
pub(crate) fn camera_error(error: CaptureError) -> CameraError {
    match error {
        CaptureError::Camera(error) => error,
        other => panic!("{other}"),
    }
}

/// The sources of a library, including those that cannot be opened.
pub(crate) fn listed_by(
    library: &CameraLibrary,
    is_of_library: impl Fn(&SourceSpec) -> bool,
) -> Vec<SourceListing> {
    let listed = list().into_iter();
    let of_library = listed.filter(|listed| match (&listed.spec, &listed.error) {
        (Some(spec), _) => is_of_library(spec),
        (None, Some(error)) => error.library == library,
        (None, None) => false,
    });
    of_library.collect()
}
