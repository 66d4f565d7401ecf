//! Checks on real data from other sources: files, silhouettes, recorded scenes, a car's meshes.
//!
//! The data are in `../shared/data` beside the crate, or in the folder that `PARTSIGHT_DATA` names. Without them the
//! tests report it and pass; with `PARTSIGHT_REQUIRE_DATA=1` they fail.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

mod booth;
mod composed;
mod files;
mod hand_eye;
#[cfg(unix)]
mod hostile;
#[path = "../kit/mod.rs"]
mod kit;
mod mesh_side;
mod registration;
mod scan;
mod scenes;
mod sheet_metal;
mod silhouettes;

use std::path::{Path, PathBuf};

/// The folder with the data; `None`, with a message, if there is none.
pub(crate) fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var_os("PARTSIGHT_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"),
        PathBuf::from,
    );
    if folder.is_dir() {
        return Some(folder);
    }
    let lacking = format_args!(
        "no folder {}; PARTSIGHT_DATA can name another",
        folder.display()
    );
    geometry::fixtures::skipped("PARTSIGHT_REQUIRE_DATA", lacking);
    None
}
