//! Takes a version out of a store: whole or not at all.

use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    MAX_BUNDLE_BYTES, Manifest, TrustedKey,
    archive::{files_in, unpack},
    error::{BundleError, LocalPart},
    sha256,
    store::{BundleStore, bundle_name, manifest_name},
};
use crate::{
    files::{FileError, file_name, read_bytes, read_limited, write_file},
    library::{LibraryFolder, PartName, PartNumbers, shipped_files},
    stages::reference::ReferenceParams,
};

/// The file in the library that says which version it was taken from. It is replaced together with the parts.
const RECORD: &str = ".version.json";
/// The largest such file: ten thousand parts.
const MAX_RECORD_BYTES: u64 = 4 << 20;
/// The version of its format.
const SCHEMA: u32 = 1;

/// What becomes of parts that were enrolled or changed here, and are in no version that was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalParts {
    /// Nothing: the version is not taken.
    Keep,
    /// They are moved to the library's trash.
    Trash,
}

/// What to take.
#[derive(Clone, Copy, Debug)]
pub struct Take {
    /// The version; without it the newest, and never one that is older than the installed one.
    pub version: Option<u32>,
    /// What becomes of parts that would be replaced and are in no version.
    pub local: LocalParts,
}

/// What a library was taken from, and what it was then.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TakenBundle {
    schema: u32,
    /// The store, for people.
    pub store: String,
    /// The public key that the version was signed with, base64.
    pub key: String,
    /// When it was taken.
    pub taken_at: Timestamp,
    /// The version.
    pub manifest: Manifest,
    /// The digest of every part as it was taken.
    parts: BTreeMap<PartName, String>,
}

/// What came of taking.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Installed {
    /// The version is the library now.
    New {
        /// The version.
        manifest: Manifest,
        /// Where the parts that it replaced lie in the trash.
        trashed: Vec<PathBuf>,
    },
    /// The newest version was there already; nothing was changed.
    Already(Manifest),
}

/// Puts a version in the place of all parts of a library. Before that, its signature, its digest and the names in it are
/// checked, and every part is loaded. Where anything is wrong, the library stays as it is; replaced parts go to its trash.
/// Parts that have a number here keep it; the others get the published one.
pub fn take(
    library: &LibraryFolder,
    store: &BundleStore,
    trusted: TrustedKey,
    asked: Take,
) -> Result<Installed, BundleError> {
    let newest = store.newest()?;
    let newest = newest.ok_or_else(|| BundleError::NothingPublished {
        store: store.address().clone(),
    })?;
    let version = asked.version.unwrap_or(newest);
    let before = TakenBundle::of(library)?;
    // Numbers of another publisher mean nothing here.
    let before = before.filter(|before| before.key == trusted.to_base64());
    let installed = before.as_ref().map(|before| before.manifest.version);
    if let Some(installed) = installed.filter(|installed| *installed > version)
        && asked.version.is_none()
    {
        return Err(BundleError::Older {
            found: version,
            installed,
        });
    }
    let manifest = verified_manifest(store, trusted, version, newest)?;
    if let Some(before) = before
        && before.manifest == manifest
        && asked.version.is_none()
    {
        return Ok(Installed::Already(manifest));
    }
    let bundle = verified_bundle(store, &manifest)?;
    let bad = |reason| BundleError::BadBundle {
        name: store.shown(&bundle_name(&manifest.bundle.sha256)),
        reason,
    };
    let files = files_in(&bundle).map_err(bad)?;
    let replaced = library.replace_all(|building| {
        unpack(&files, building)?;
        let record = match checked_record(library, building, store, trusted, &manifest, asked.local)
        {
            Ok(record) => record,
            Err(error) => return Ok(Err(error)),
        };
        let text = serde_json::to_vec_pretty(&record).map_err(io::Error::other)?;
        write_file(&building.join(RECORD), &text)?;
        let numbers = match numbers_with(library, trusted, &manifest) {
            Ok(numbers) => numbers,
            Err(error) => return Ok(Err(error)),
        };
        if !numbers.is_empty() {
            numbers.write(building)?;
        }
        Ok(Ok(()))
    })?;
    let trashed = replaced?;
    Ok(Installed::New { manifest, trashed })
}

fn verified_manifest(
    store: &BundleStore,
    trusted: TrustedKey,
    version: u32,
    newest: u32,
) -> Result<Manifest, BundleError> {
    let name = store.shown(&manifest_name(version));
    let bytes = store.manifest(version)?;
    let bytes = bytes.ok_or_else(|| BundleError::NoSuchVersion {
        store: store.address().clone(),
        wanted: version,
        newest,
    })?;
    let manifest = Manifest::verified(&name, &bytes, trusted)?;
    if manifest.version == version {
        Ok(manifest)
    } else {
        Err(BundleError::BadManifest {
            name,
            reason: format!("it is of version {}", manifest.version),
        })
    }
}

fn verified_bundle(store: &BundleStore, manifest: &Manifest) -> Result<Vec<u8>, BundleError> {
    let expected = &manifest.bundle;
    if expected.bytes > MAX_BUNDLE_BYTES {
        return Err(BundleError::TooLarge {
            found: expected.bytes,
            limit: MAX_BUNDLE_BYTES,
        });
    }
    let bad = |reason: String| BundleError::BadBundle {
        name: store.shown(&bundle_name(&expected.sha256)),
        reason,
    };
    let found = match store.bundle(&expected.sha256, expected.bytes) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Err(bad("it is missing".into())),
        Err(BundleError::TooLarge { found, limit }) => {
            return Err(bad(format!("it has {found} bytes, expected {limit}")));
        }
        Err(error) => return Err(error),
    };
    let num = found.len() as u64;
    if num != expected.bytes {
        return Err(bad(format!(
            "it has {num} bytes, expected {}",
            expected.bytes
        )));
    }
    let digest = sha256(&found);
    if digest != expected.sha256 {
        return Err(bad(format!("its SHA-256 is {digest}")));
    }
    Ok(found)
}

/// The library's numbers of parts, with those of a version.
fn numbers_with(
    library: &LibraryFolder,
    trusted: TrustedKey,
    manifest: &Manifest,
) -> Result<PartNumbers, BundleError> {
    let before = TakenBundle::of(library)?.filter(|before| before.key == trusted.to_base64());
    let before = before.map_or_else(PartNumbers::default, |before| before.manifest.numbers);
    let mut numbers = library.numbers()?;
    numbers.add_published(&manifest.numbers, &before);
    Ok(numbers)
}

/// What the library will say of itself, if all new parts can be loaded and none is lost that is in no version.
fn checked_record(
    library: &LibraryFolder,
    building: &Path,
    store: &BundleStore,
    trusted: TrustedKey,
    manifest: &Manifest,
    local: LocalParts,
) -> Result<TakenBundle, BundleError> {
    let coming = LibraryFolder::open(building)?;
    let load = coming.load(&ReferenceParams::default())?;
    if let Some(problem) = load.problems.into_iter().next() {
        return Err(BundleError::UnreadablePart {
            version: manifest.version,
            problem: Box::new(problem),
        });
    }
    let found = load.parts.len();
    if found != manifest.num_parts {
        return Err(BundleError::BadBundle {
            name: store.shown(&bundle_name(&manifest.bundle.sha256)),
            reason: format!("it has {found} parts, expected {}", manifest.num_parts),
        });
    }
    let mut parts = BTreeMap::new();
    for meta in load.parts {
        let digest = digest_of(&coming, &meta.name)?;
        parts.insert(meta.name, digest);
    }
    if local == LocalParts::Keep {
        let before = TakenBundle::of(library)?;
        let local = local_parts(library, before.as_ref(), &parts)?;
        if !local.is_empty() {
            return Err(BundleError::LocalParts { parts: local });
        }
    }
    Ok(TakenBundle {
        schema: SCHEMA,
        store: store.address().to_string(),
        key: trusted.to_base64(),
        taken_at: Timestamp::now(),
        manifest: manifest.clone(),
        parts,
    })
}

/// The parts that were enrolled or changed here. Those that the program brings along, and those that come again with the
/// new version, are none.
fn local_parts(
    library: &LibraryFolder,
    before: Option<&TakenBundle>,
    coming: &BTreeMap<PartName, String>,
) -> Result<Vec<LocalPart>, BundleError> {
    let mut local = Vec::new();
    for name in library.names()? {
        let part = PartName::new(&name).ok();
        // One that cannot be read is not lost either.
        let digest = part.as_ref().and_then(|part| digest_of(library, part).ok());
        let taken = before
            .zip(part.as_ref())
            .and_then(|(before, part)| before.parts.get(part));
        let arriving = part.as_ref().and_then(|part| coming.get(part));
        let shipped = shipped_files(&name).map(digest_of_files);
        let known = [taken, arriving, shipped.as_ref()];
        let is_known = digest.is_some_and(|found| known.contains(&Some(&found)));
        match taken {
            _ if is_known => {}
            Some(_) => local.push(LocalPart::Changed(name)),
            None => local.push(LocalPart::Enrolled(name)),
        }
    }
    Ok(local)
}

impl TakenBundle {
    /// What a library was taken from last; none of one that was only ever enrolled.
    pub fn of(library: &LibraryFolder) -> Result<Option<Self>, BundleError> {
        let path = library.file_beside_parts(RECORD);
        let bytes = match read_limited(&path, MAX_RECORD_BYTES) {
            Err(FileError::NotFound { .. }) => return Ok(None),
            bytes => bytes?,
        };
        let bad = |reason| BundleError::BadRecord { path, reason };
        match serde_json::from_slice::<Self>(&bytes) {
            Ok(record) if record.schema > SCHEMA => {
                Err(bad("made by a newer version of Partsight".into()))
            }
            Ok(record) => Ok(Some(record)),
            Err(error) => Err(bad(error.to_string())),
        }
    }

    /// What differs from that version here, in the order of the names: enrolled or changed parts, then removed ones.
    pub fn differences(&self, library: &LibraryFolder) -> Result<Vec<LocalPart>, BundleError> {
        let names = library.names()?;
        let mut differences = Vec::new();
        for name in &names {
            let part = PartName::new(name).ok();
            let taken = part.as_ref().and_then(|part| self.parts.get(part));
            let digest = part.as_ref().and_then(|part| digest_of(library, part).ok());
            match taken {
                None => differences.push(LocalPart::Enrolled(name.clone())),
                Some(_) if digest.as_ref() == taken => {}
                Some(_) => differences.push(LocalPart::Changed(name.clone())),
            }
        }
        let is_gone = |part: &&PartName| names.iter().all(|name| name != part.as_str());
        let gone = self.parts.keys().filter(is_gone).cloned();
        differences.extend(gone.map(LocalPart::Removed));
        Ok(differences)
    }
}

/// By what a part is known: all that the program reads of it.
fn digest_of(library: &LibraryFolder, part: &PartName) -> Result<String, BundleError> {
    let mut files = Vec::new();
    for path in library.files_of(part)? {
        files.push((file_name(&path), read_bytes(&path)?));
    }
    let files: Vec<(&str, &[u8])> = files
        .iter()
        .map(|(name, content)| (name.as_str(), &content[..]))
        .collect();
    Ok(digest_of_files(&files))
}

/// Of names and contents, in this order.
fn digest_of_files(files: &[(&str, &[u8])]) -> String {
    let lines: Vec<String> = files
        .iter()
        .map(|(name, content)| format!("{name} {}\n", sha256(content)))
        .collect();
    sha256(lines.concat().as_bytes())
}

#[cfg(test)]
mod tests;
