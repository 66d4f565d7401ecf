//! The shipped parts: copies of `reference_parts/` inside the binary.

use std::{
    io,
    path::{Path, PathBuf},
};

use super::{
    entry::{CLOUD, Entry, META, SIGNATURE, ShippedFiles, THUMBNAIL},
    numbers::PartNumbers,
    part::FileCheck,
};
use files::{FileContent, disk, open_bytes, sync_folder, write_file};
use geometry::rigid::RigidTransform;

/// The folder of one shipped part.
struct ShippedPart {
    name: &'static str,
    files: ShippedFiles,
}

/// Includes the files of the named parts at build time.
macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(ShippedPart {
            name: $name,
            files: [
                (META, include_bytes!(concat!("../../../../reference_parts/", $name, "/part.toml"))),
                (CLOUD, include_bytes!(concat!("../../../../reference_parts/", $name, "/cloud.ply"))),
                (SIGNATURE, include_bytes!(concat!("../../../../reference_parts/", $name, "/signature.json"))),
                (THUMBNAIL, include_bytes!(concat!("../../../../reference_parts/", $name, "/thumbnail.png"))),
            ],
        }),*]
    };
}

const SHIPPED: &[ShippedPart] = shipped![
    "back_bumper",
    "back_door",
    "fender",
    "front_bumper",
    "front_door",
    "grille",
    "radiator_support",
    "trunk_lid",
];

/// Numbers of the parts inside the program. A user's own library gives its parts their numbers itself, once they are needed.
pub(super) fn shipped_numbers() -> PartNumbers {
    PartNumbers::parse(include_str!("../../../../reference_parts/numbers.toml"))
        .expect("a test reads the file")
}

/// Writes all shipped parts into an empty folder.
pub(super) fn write_shipped(folder: &Path) -> io::Result<()> {
    for part in SHIPPED {
        let part_folder = folder.join(part.name);
        disk::create_dir(&part_folder)?;
        for (name, content) in part.files {
            write_file(&part_folder.join(name), content)?;
        }
        sync_folder(&part_folder)?;
    }
    sync_folder(folder)
}

/// Names and contents of the files of a shipped part, in the order of [`LibraryFolder::files_of`](super::LibraryFolder);
/// `None` if there is none of this name.
pub fn shipped_files(name: &str) -> Option<&'static [(&'static str, &'static [u8])]> {
    let part = SHIPPED.iter().find(|part| part.name == name)?;
    Some(&part.files)
}

/// Where a shipped part hung when it was enrolled.
#[derive(Clone, Debug, PartialEq)]
pub struct EnrolledAt {
    /// Transform from the simulated model to the camera, whose frame is part space.
    pub part_from_model: RigidTransform,
    /// Size and checksum of its cloud.
    pub cloud: FileCheck,
}

/// Returns the pose at enrolment of the shipped part with this name; `None` if there is none.
pub fn shipped_enrolled_at(name: &str) -> Option<EnrolledAt> {
    let part = SHIPPED.iter().find(|part| part.name == name)?;
    let (_, bytes) = part.files.iter().find(|(file, _)| *file == CLOUD)?;
    let Ok(FileContent::Cloud(cloud)) = open_bytes(Path::new(CLOUD), bytes) else {
        return None;
    };
    Some(EnrolledAt {
        // Frontal, 1.3 m in front of the camera: see the README of the folder.
        part_from_model: RigidTransform::translation(0.0, 0.0, 1.3),
        cloud: FileCheck::from_bytes(bytes, cloud.points.len()),
    })
}

/// Returns the shipped parts inside the program.
pub(super) fn shipped_entries() -> Vec<Entry> {
    let entry = |part: &'static ShippedPart| Entry {
        name: part.name.to_owned(),
        path: PathBuf::from(part.name),
        shipped: Some(&part.files),
    };
    SHIPPED.iter().map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_part_has_a_number() {
        let numbers = shipped_numbers();
        for part in SHIPPED {
            let name = part.name.parse().expect("a name");
            assert!(numbers.number_of(&name).is_some(), "{}", part.name);
        }
        assert_eq!(numbers.all().count(), SHIPPED.len());
    }
}
