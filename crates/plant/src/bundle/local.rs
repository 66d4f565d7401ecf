//! What was made at this cell: parts and spray paths that are in no version.
//!
//! A spray path lies with its part, and `part.toml` names it. A part with a path is therefore compared twice: as it is, and
//! as it was before the path was stored.

use std::{collections::BTreeMap, fmt, iter};

use super::{error::BundleError, sha256};
use files::{file_name, read_bytes};
use inspection::library::{FileCheck, LibraryFolder, PartMeta, PartName, SprayPath, shipped_files};

/// A part of a library that differs from the version taken last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LocalPart {
    /// It is not in that version.
    Enrolled(String),
    /// It is in that version, with other files.
    Changed(String),
    /// It is in that version, without the spray path that was stored here.
    SprayPath(String),
    /// It is in that version, but not here.
    Removed(PartName),
}

impl fmt::Display for LocalPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Enrolled(name) => write!(f, "{name} (enrolled here)"),
            Self::Changed(name) => write!(f, "{name} (changed here)"),
            Self::SprayPath(name) => write!(f, "{name} (spray path stored here)"),
            Self::Removed(name) => write!(f, "{name} (removed here)"),
        }
    }
}

/// By what the parts of a version are known.
pub(super) type Digests = BTreeMap<PartName, String>;

/// A part of the version that is being taken.
pub(super) struct ArrivingPart {
    pub(super) meta: PartMeta,
    pub(super) digest: String,
}

/// What this cell has that a version would replace.
#[derive(Default)]
pub(super) struct LocalContent {
    /// Parts that do not go over to the version.
    pub(super) parts: Vec<LocalPart>,
    /// Spray paths that do: the version has the same reference of the part, and no path for it.
    pub(super) spray_paths: Vec<(PartName, SprayPath)>,
}

impl LocalContent {
    /// Compares a library with the version taken before and the one that arrives. Parts that the program brings along, and
    /// those that come again, are none of this cell's own.
    pub(super) fn of(
        library: &LibraryFolder,
        before: Option<&Digests>,
        arriving: &[ArrivingPart],
    ) -> Result<Self, BundleError> {
        let mut local = Self::default();
        for name in library.names()? {
            let part = PartName::new(&name).ok();
            // A part that cannot be read is not lost either.
            let found = part.as_ref().and_then(|part| StoredPart::of(library, part));
            let taken = before
                .zip(part.as_ref())
                .and_then(|(before, part)| before.get(part));
            let coming = arriving
                .iter()
                .find(|coming| coming.meta.name.as_str() == name);
            let shipped = shipped_files(&name).map(digest_of_files);
            let arriving = coming.map(|coming| &coming.digest);
            let known: Vec<&String> = [taken, arriving, shipped.as_ref()]
                .into_iter()
                .flatten()
                .collect();
            let (Some(part), Some(found)) = (part, found) else {
                local.parts.push(LocalPart::new(name, taken));
                continue;
            };
            if known.iter().any(|digest| found.is(digest)) {
                continue;
            }
            if !known.iter().any(|digest| found.is_without_path(digest)) {
                local.parts.push(LocalPart::new(name, taken));
                continue;
            }
            if coming.is_some_and(|coming| coming.meta.spray == found.spray) {
                continue;
            }
            match path_to_keep(library, &part, &found.cloud, coming) {
                Some(path) => local.spray_paths.push((part, path)),
                None => local.parts.push(LocalPart::SprayPath(name)),
            }
        }
        Ok(local)
    }
}

/// The spray path of a part, if it can go over to the part that arrives: a path is in the frame of its reference.
fn path_to_keep(
    library: &LibraryFolder,
    part: &PartName,
    cloud: &FileCheck,
    coming: Option<&ArrivingPart>,
) -> Option<SprayPath> {
    let PartMeta {
        cloud: theirs,
        spray: None,
        ..
    } = &coming?.meta
    else {
        return None;
    };
    if cloud != theirs {
        return None;
    }
    library.spray_path(part.as_str()).ok()?
}

/// What differs in a library from the version with these parts, in the order of the names: enrolled or changed parts, then
/// removed ones.
pub(super) fn differences(
    library: &LibraryFolder,
    taken: &Digests,
) -> Result<Vec<LocalPart>, BundleError> {
    let names = library.names()?;
    let mut differences = Vec::new();
    for name in &names {
        let part = PartName::new(name).ok();
        let digest = part.as_ref().and_then(|part| taken.get(part));
        let found = part.and_then(|part| StoredPart::of(library, &part));
        match (digest, found) {
            (Some(taken), Some(found)) if found.is(taken) => {}
            (Some(taken), Some(found)) if found.is_without_path(taken) => {
                differences.push(LocalPart::SprayPath(name.clone()));
            }
            (taken, _) => differences.push(LocalPart::new(name.clone(), taken)),
        }
    }
    let is_gone = |part: &&PartName| names.iter().all(|name| name != part.as_str());
    let gone = taken.keys().filter(is_gone).cloned();
    differences.extend(gone.map(LocalPart::Removed));
    Ok(differences)
}

impl LocalPart {
    /// A part that is not as it was taken, if it was taken at all.
    fn new(name: String, taken: Option<&String>) -> Self {
        match taken {
            Some(_) => Self::Changed(name),
            None => Self::Enrolled(name),
        }
    }
}

/// A part as it lies in a library.
pub(super) struct StoredPart {
    cloud: FileCheck,
    spray: Option<FileCheck>,
    /// By what it is known: all that the program reads of it, with `part.toml` as the program writes it.
    pub(super) digest: String,
    /// The same with `part.toml` as it is. Libraries that an earlier version of this program took have noted this one.
    digest_as_is: String,
    /// The digest that it had before its spray path was stored; `None` if it has none.
    digest_without_path: Option<String>,
}

impl StoredPart {
    /// `None` if the part cannot be read.
    pub(super) fn of(library: &LibraryFolder, part: &PartName) -> Option<Self> {
        let files = files_of(library, part).ok()?;
        let files: Vec<(&str, &[u8])> = files
            .iter()
            .map(|(name, content)| (name.as_str(), &content[..]))
            .collect();
        // The description is the first file.
        let ((meta_name, meta), others) = files.split_first()?;
        let mut meta: PartMeta = toml::from_str(str::from_utf8(meta).ok()?).ok()?;
        let digest_with = |meta: &PartMeta| {
            let text = toml::to_string(meta).ok()?;
            // A description without a path leaves the path's file unread.
            let is_read = |name: &str| meta.spray.is_some() || !name.starts_with("spray-");
            let others = others.iter().filter(|(name, _)| is_read(name));
            let files = iter::once((*meta_name, text.as_bytes())).chain(others.copied());
            Some(digest_of_files(&files.collect::<Vec<_>>()))
        };
        let digest = digest_with(&meta)?;
        let spray = meta.spray.take();
        Some(Self {
            digest,
            digest_as_is: digest_of_files(&files),
            digest_without_path: spray.as_ref().and_then(|_| digest_with(&meta)),
            spray,
            cloud: meta.cloud,
        })
    }

    /// True if it is the part of this digest.
    fn is(&self, digest: &str) -> bool {
        self.digest == digest || self.digest_as_is == digest
    }

    /// True if it is the part of this digest, apart from the spray path that was stored here.
    fn is_without_path(&self, digest: &str) -> bool {
        self.digest_without_path.as_deref() == Some(digest)
    }
}

fn files_of(
    library: &LibraryFolder,
    part: &PartName,
) -> Result<Vec<(String, Vec<u8>)>, BundleError> {
    let paths = library.files_of(part)?.into_iter();
    let read = paths.map(|path| Ok::<_, BundleError>((file_name(&path), read_bytes(&path)?)));
    read.collect()
}

/// Of names and contents, in this order.
fn digest_of_files(files: &[(&str, &[u8])]) -> String {
    let lines: Vec<String> = files
        .iter()
        .map(|(name, content)| format!("{name} {}\n", sha256(content)))
        .collect();
    sha256(lines.concat().as_bytes())
}
