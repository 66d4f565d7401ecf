//! Identity of a library.

use super::{FileCheck, LibraryLoad};
use files::crc32;

impl LibraryLoad {
    /// Returns eight hexadecimal digits that are the same for the same parts with the same clouds, wherever the library
    /// is stored and in any order: the CRC-32 of the names of all loaded parts and the checksums of their clouds.
    /// Titles and notes do not count.
    pub fn identity(&self) -> String {
        let mut parts: Vec<String> = self
            .parts
            .iter()
            .map(|part| {
                let FileCheck { num_points, crc32 } = &part.cloud;
                format!("{} {num_points} {crc32}\n", part.part_name().as_str())
            })
            .collect();
        parts.sort();
        format!("{:08x}", crc32(parts.concat().as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use crate::library::{FileCheck, load::load_shipped};
    use geometry::cloud::PointCloud;
    use stages::reference::ReferenceParams;

    #[test]
    fn a_library_is_known_by_its_names_and_clouds() {
        let load = || load_shipped(&ReferenceParams::default());
        let library = load();
        let identity = library.identity();
        assert!(identity.len() == 8 && identity.bytes().all(|c| c.is_ascii_hexdigit()));
        let mut turned = load();
        turned.parts.reverse();
        assert_eq!(turned.identity(), identity);
        let mut fewer = load();
        fewer.parts.pop();
        assert_ne!(fewer.identity(), identity);
        let mut renamed = load();
        renamed.parts[0].part = Some("other".parse().expect("a name"));
        assert_ne!(renamed.identity(), identity);
        let mut moved = load();
        let mut cloud = PointCloud::clone(&moved.library.references[0].cloud);
        // The checksum in the file is that of the cloud.
        assert_eq!(FileCheck::of_cloud(&cloud), moved.parts[0].cloud);
        cloud.points[7].z += 1e-6;
        moved.parts[0].cloud = FileCheck::of_cloud(&cloud);
        assert_ne!(moved.identity(), identity);
    }
}
