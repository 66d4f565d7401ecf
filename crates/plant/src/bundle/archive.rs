//! A bundle: the parts of a library in a tar archive without compression, which clouds hardly allow.
//!
//! Every entry is a regular file `PART/FILE`, where PART is the name of a part and FILE one of the names that the program
//! writes. Whatever else an archive can hold (other paths, links, devices, long names) is refused before anything is written,
//! so that no entry leads out of the library. Names of parts have no capitals: no two differ by case alone.

use std::{collections::BTreeSet, io, path::Path};

use tar::{Archive, Builder, EntryType, Header};

use super::{MAX_BUNDLE_BYTES, error::BundleError};
use files::{disk, file_name, read_limited, sync_folder, write_file};
use inspection::library::{LibraryFolder, PartName, is_part_file};

/// A file in a bundle.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct BundledFile<'a> {
    part: PartName,
    name: String,
    content: &'a [u8],
}

/// Packs these parts. The same parts give the same bytes.
pub(super) fn pack(library: &LibraryFolder, parts: &[PartName]) -> Result<Vec<u8>, BundleError> {
    let mut builder = Builder::new(Vec::new());
    let in_memory = |source| BundleError::Pack { source };
    for part in parts {
        for path in library.files_of(part)? {
            let content = read_limited(&path, MAX_BUNDLE_BYTES)?;
            let found = (builder.get_ref().len() + content.len()) as u64;
            if found > MAX_BUNDLE_BYTES {
                return Err(BundleError::TooLarge {
                    found,
                    limit: MAX_BUNDLE_BYTES,
                });
            }
            let mut header = Header::new_ustar();
            header.set_entry_type(EntryType::Regular);
            header.set_mode(0o644);
            header.set_mtime(0);
            header.set_size(content.len() as u64);
            let name = format!("{part}/{}", file_name(&path));
            builder
                .append_data(&mut header, name, &content[..])
                .map_err(in_memory)?;
        }
    }
    builder.into_inner().map_err(in_memory)
}

/// The files of a bundle, none of which leads out of the folder that they are written to; else what is wrong with it.
pub(super) fn files_in(bundle: &[u8]) -> Result<Vec<BundledFile<'_>>, String> {
    let unreadable = |error: io::Error| format!("it is no archive: {error}");
    let mut archive = Archive::new(bundle);
    let mut files = Vec::new();
    let mut names = BTreeSet::new();
    // Raw: entries that give the next one a longer name are seen as what they are, and refused.
    for entry in archive.entries().map_err(unreadable)?.raw(true) {
        let entry = entry.map_err(unreadable)?;
        let path = String::from_utf8_lossy(&entry.path_bytes()).into_owned();
        if entry.header().entry_type() != EntryType::Regular {
            return Err(format!("{path:?} is no regular file"));
        }
        let part_and_name = path.split_once('/').and_then(|(part, name)| {
            let part = PartName::new(part).ok()?;
            is_part_file(name).then(|| (part, name.to_owned()))
        });
        let Some((part, name)) = part_and_name else {
            return Err(format!("{path:?} is no file of a part"));
        };
        // The archive lies in memory, where the file is that part of it.
        let from = usize::try_from(entry.raw_file_position()).ok();
        let to = from.and_then(|from| from.checked_add(usize::try_from(entry.size()).ok()?));
        let content = from.zip(to).and_then(|(from, to)| bundle.get(from..to));
        let Some(content) = content else {
            return Err(format!("it ends in {path:?}"));
        };
        if !names.insert(path.clone()) {
            return Err(format!("{path:?} is in it twice"));
        }
        files.push(BundledFile {
            part,
            name,
            content,
        });
    }
    Ok(files)
}

/// Writes the files into an empty folder.
pub(super) fn unpack(files: &[BundledFile<'_>], into: &Path) -> io::Result<()> {
    let parts: BTreeSet<&PartName> = files.iter().map(|file| &file.part).collect();
    for part in &parts {
        disk::create_dir(into.join(part.as_str()))?;
    }
    for file in files {
        let path = into.join(file.part.as_str()).join(&file.name);
        write_file(&path, file.content)?;
    }
    for part in &parts {
        sync_folder(&into.join(part.as_str()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An archive with these entries, whatever their paths.
    fn archive(entries: &[(&str, EntryType, &[u8])]) -> Vec<u8> {
        let mut builder = Builder::new(Vec::new());
        for (path, kind, content) in entries {
            let mut header = Header::new_ustar();
            header.as_mut_bytes()[..path.len()].copy_from_slice(path.as_bytes());
            header.set_entry_type(*kind);
            header.set_mode(0o644);
            header.set_size(content.len() as u64);
            header.set_cksum();
            builder.append(&header, *content).expect("in memory");
        }
        builder.into_inner().expect("in memory")
    }

    #[test]
    fn files_of_parts_come_back() {
        let entries = [
            ("door/part.toml", EntryType::Regular, &b"meta"[..]),
            ("door/cloud.ply", EntryType::Regular, &[7; 2000][..]),
            ("gate-2/spray-0badcafe.csv", EntryType::Regular, &b""[..]),
        ];
        let archive = archive(&entries);
        let files = files_in(&archive).expect("sound");
        let found: Vec<_> = files
            .iter()
            .map(|file| (format!("{}/{}", file.part, file.name), file.content))
            .collect();
        let expected = entries.map(|(path, _, content)| (path.to_owned(), content));
        assert_eq!(found, expected);
        let folder = tempfile::tempdir().expect("a folder");
        unpack(&files, folder.path()).expect("written");
        for (path, _, content) in entries {
            let written = std::fs::read(folder.path().join(path));
            assert_eq!(written.expect("there"), content);
        }
    }

    #[test]
    fn nothing_leads_out_of_the_library() {
        for path in [
            "../door/cloud.ply",
            "/etc/cloud.ply",
            "door/../cloud.ply",
            "door/../../cloud.ply",
            "./door/cloud.ply",
            "door//cloud.ply",
            "door\\cloud.ply",
            "C:/cloud.ply",
            "cloud.ply",
            "door/sub/cloud.ply",
            "Door/cloud.ply",
            "door/Cloud.ply",
            "con/cloud.ply",
            ".trash/cloud.ply",
            "door/.part.toml.new",
            "door/run.sh",
            "door/spray-0BADCAFE.csv",
            "door/spray-../../.csv",
            "",
        ] {
            let archive = archive(&[(path, EntryType::Regular, &b"x"[..])]);
            assert!(files_in(&archive).is_err(), "{path:?}");
        }
    }

    #[test]
    fn links_devices_folders_and_long_names_are_refused() {
        for kind in [
            EntryType::Link,
            EntryType::Symlink,
            EntryType::Char,
            EntryType::Block,
            EntryType::Directory,
            EntryType::Fifo,
            EntryType::Continuous,
            EntryType::GNULongName,
            EntryType::GNULongLink,
            EntryType::GNUSparse,
            EntryType::XGlobalHeader,
            EntryType::XHeader,
        ] {
            let archive = archive(&[("door/cloud.ply", kind, &b"x"[..])]);
            assert!(files_in(&archive).is_err(), "{kind:?}");
        }
    }

    #[test]
    fn the_same_file_twice_and_a_cut_archive_are_refused() {
        let file = ("door/cloud.ply", EntryType::Regular, &[7_u8; 2000][..]);
        assert!(files_in(&archive(&[file, file])).is_err());
        let archive = archive(&[file]);
        for end in [513, 1024, 2511] {
            assert!(files_in(&archive[..end]).is_err(), "{end}");
        }
        // A header that claims more than there is.
        let mut header = Header::new_ustar();
        header.set_path("door/cloud.ply").expect("a short path");
        header.set_entry_type(EntryType::Regular);
        header.set_size(1 << 40);
        header.set_cksum();
        assert!(files_in(header.as_bytes()).is_err());
        assert!(files_in(b"no archive at all").is_err());
    }
}
