//! By what a library is known again.

use super::{CloudCheck, Library};
use crate::files::crc32;

impl Library {
    /// Eight hexadecimal digits that are the same for the same parts with the same clouds, wherever they lie and in
    /// whatever order: the CRC-32 of all names and checksums of clouds. Titles and notes do not count.
    ///
    /// Goes through all clouds, some milliseconds: ask once per library, not once per inspection.
    pub fn identity(&self) -> String {
        let mut parts: Vec<String> = self
            .references
            .iter()
            .map(|reference| {
                let CloudCheck { num_points, crc32 } = CloudCheck::of_cloud(&reference.cloud);
                format!("{} {num_points} {crc32}\n", reference.name)
            })
            .collect();
        parts.sort();
        format!("{:08x}", crc32(parts.concat().as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use crate::{library::load::load_shipped, stages::reference::ReferenceParams};

    #[test]
    fn a_library_is_known_by_its_names_and_clouds() {
        let library = load_shipped(&ReferenceParams::default()).library;
        let identity = library.identity();
        assert!(identity.len() == 8 && identity.bytes().all(|c| c.is_ascii_hexdigit()));
        let mut turned = library.clone();
        turned.references.reverse();
        assert_eq!(turned.identity(), identity);
        let mut fewer = library.clone();
        fewer.references.pop();
        assert_ne!(fewer.identity(), identity);
        let mut renamed = library.clone();
        renamed.references[0].name = "other".into();
        assert_ne!(renamed.identity(), identity);
        let mut moved = library.clone();
        moved.references[0].cloud.points[7].z += 1e-6;
        assert_ne!(moved.identity(), identity);
    }
}
