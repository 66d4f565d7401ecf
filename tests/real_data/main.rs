//! Checks on real data made by others: files, silhouettes, recorded scenes, a car's meshes.
//!
//! The data is looked for in `../shared/data` beside the crate, or where `PARTSIGHT_DATA` says. Without it the tests
//! say so and pass; with `PARTSIGHT_REQUIRE_DATA=1` they fail.

mod booth;
mod files;
#[cfg(unix)]
mod hostile;
#[path = "../kit/mod.rs"]
mod kit;
mod registration;
mod scan;
mod scenes;
mod silhouettes;

use std::path::{Path, PathBuf};

/// The folder with the data; `None`, with a word about it, where there is none.
#[expect(
    clippy::print_stderr,
    reason = "a test that checks nothing must say so"
)]
pub(crate) fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var_os("PARTSIGHT_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"),
        PathBuf::from,
    );
    if folder.is_dir() {
        return Some(folder);
    }
    let is_required = std::env::var_os("PARTSIGHT_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(
        !is_required,
        "PARTSIGHT_REQUIRE_DATA=1, and there is no folder {}",
        folder.display()
    );
    eprintln!(
        "skipped: no folder {}; PARTSIGHT_DATA can name another",
        folder.display()
    );
    None
}
