//! The folder of one part: its files, and writing them.

use std::{
    fs,
    io::{self, Read as _},
    path::{Path, PathBuf},
};

use super::{
    name::PartName,
    part::{Part, PartMeta, cloud_bytes},
};

use files::{open_regular, replace_file, sync_folder, write_file};

/// File names within a part's folder.
pub(super) const META: &str = "part.toml";
pub(super) const CLOUD: &str = "cloud.ply";
pub(super) const SIGNATURE: &str = "signature.json";
pub(super) const THUMBNAIL: &str = "thumbnail.png";

/// Prefix of a spray path's file name. The checksum follows, so that a new path never replaces the file of an old one.
pub(super) const SPRAY_PREFIX: &str = "spray-";

/// Prefix of the folder of a part that is being written.
pub(super) const NEW_PREFIX: &str = ".new-";

/// The folder of one part in a library, whatever its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// Name of the part.
    pub(super) name: String,
    /// The folder.
    pub(super) path: PathBuf,
    /// Its files, if the part is inside the program.
    pub(super) shipped: Option<&'static ShippedFiles>,
}

/// Names and contents of the files of a part inside the program.
pub(super) type ShippedFiles = [(&'static str, &'static [u8]); 4];

impl Entry {
    /// Returns a file of a part inside the program.
    pub(super) fn shipped_file(&self, name: &str) -> Option<&'static [u8]> {
        let mut files = self.shipped?.iter();
        files.find(|(n, _)| *n == name).map(|(_, bytes)| *bytes)
    }

    pub(super) fn in_folder(name: String, path: PathBuf) -> Self {
        Self {
            name,
            path,
            shipped: None,
        }
    }
}

/// Returns whether a folder can be a part: it has a valid name or a `part.toml`. Other folders on the medium are
/// ignored.
pub(super) fn is_entry(file_name: &str, path: &Path) -> bool {
    path.is_dir() && (PartName::new(file_name).is_ok() || path.join(META).exists())
}

/// True for the name of a file that the program writes into a part's folder.
pub fn is_part_file(name: &str) -> bool {
    let spray = name.strip_prefix(SPRAY_PREFIX);
    let checksum = spray.and_then(|rest| rest.strip_suffix(".csv"));
    let is_checksum = |text: &str| {
        text.len() == 8 && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'))
    };
    matches!(name, META | CLOUD | SIGNATURE | THUMBNAIL) || checksum.is_some_and(is_checksum)
}

pub(super) fn write_part(folder: &Path, part: &Part) -> io::Result<()> {
    let Part {
        meta,
        cloud,
        signature,
        thumbnail,
    } = part;
    write_file(&folder.join(META), meta_text(meta)?.as_bytes())?;
    write_file(&folder.join(CLOUD), &cloud_bytes(cloud))?;
    write_file(&folder.join(SIGNATURE), &serde_json::to_vec(signature)?)?;
    let mut png = io::Cursor::new(Vec::new());
    thumbnail
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(io::Error::other)?;
    write_file(&folder.join(THUMBNAIL), png.get_ref())?;
    sync_folder(folder)
}

pub(super) fn meta_text(meta: &PartMeta) -> io::Result<String> {
    toml::to_string(meta).map_err(io::Error::other)
}

/// Copies the regular files of a folder except its `part.toml`.
pub(super) fn copy_files(from: &Path, to: &Path) -> io::Result<()> {
    for found in fs::read_dir(from)? {
        let path = found?.path();
        match path.file_name() {
            Some(name) if name != META && path.is_file() => {
                let mut content = Vec::new();
                open_regular(&path)?.read_to_end(&mut content)?;
                write_file(&to.join(name), &content)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Replaces `part.toml` atomically.
pub(super) fn rewrite_meta(folder: &Path, meta: &PartMeta) -> io::Result<()> {
    replace_file(&folder.join(META), meta_text(meta)?.as_bytes())
}
