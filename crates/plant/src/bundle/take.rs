//! Takes a version out of a store: whole or not at all.

use std::{io, path::PathBuf};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    MAX_BUNDLE_BYTES, Manifest, TrustedKey,
    archive::{files_in, unpack},
    error::BundleError,
    local::{ArrivingPart, Digests, LocalContent, LocalPart, StoredPart, differences},
    sha256,
    store::{BundleStore, bundle_name, manifest_name},
};
use files::{FileError, parse_json, read_limited, write_file};
use inspection::library::{LibraryFolder, PartName, PartNumbers, SprayPath};
use stages::reference::ReferenceParams;

/// The file in the library that records the version that it was taken from. It is replaced together with the parts.
const RECORD: &str = ".version.json";
/// The largest such file: ten thousand parts.
const MAX_RECORD_BYTES: u64 = 4 << 20;
/// The version of its format.
const SCHEMA: u32 = 1;

/// What becomes of parts that were enrolled or changed here, and of spray paths that do not fit the new version.
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
    parts: Digests,
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
        /// The parts whose spray paths were stored here, and still are.
        kept_paths: Vec<PartName>,
    },
    /// The newest version was there already; nothing was changed.
    Already(Manifest),
}

/// Puts a version in the place of all parts of a library. Before that, its signature, its digest and the names in it are
/// checked, and every part is loaded. Where anything is wrong, the library stays as it is; replaced parts go to its trash.
/// Parts that have a number here keep it; the others get the published one.
/// Spray paths that were stored here stay with their parts where the version has the same reference and no path for it.
///
/// The version counts from the rename by which [`LibraryFolder::replace_all`] installs it: an error of what follows, moving
/// the former parts to the trash, is reported, and the next writer completes it.
pub fn take(
    library: &LibraryFolder,
    store: &BundleStore,
    trusted: TrustedKey,
    asked: Take,
) -> Result<Installed, BundleError> {
    let newest = store.newest()?;
    let newest = newest.ok_or_else(|| BundleError::NothingPublished {
        store: store.address().to_string(),
    })?;
    let version = asked.version.unwrap_or(newest);
    let before = TakenBundle::read(library)?;
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
    let files = files_in(&bundle).map_err(|reason| bad_bundle(store, &manifest, reason))?;
    let mut kept_paths = Vec::new();
    let replaced = library.replace_all(|building| {
        unpack(&files, building)?;
        let checked = LibraryFolder::open(building)
            .map_err(BundleError::from)
            .and_then(|coming| {
                let parts = arriving_parts(&coming, store, &manifest)?;
                let paths = paths_to_keep(library, &parts, asked.local)?;
                Ok((coming, parts, paths))
            });
        let (coming, parts, paths) = match checked {
            Ok(checked) => checked,
            Err(error) => return Ok(Err(error)),
        };
        for (part, path) in paths {
            if let Err(error) = coming.write_spray_path(&part, Some(&path))? {
                return Ok(Err(error.into()));
            }
            kept_paths.push(part);
        }
        let parts = parts.into_iter();
        let record = TakenBundle {
            schema: SCHEMA,
            store: store.address().to_string(),
            key: trusted.to_base64(),
            taken_at: geometry::clock::now(),
            manifest: manifest.clone(),
            parts: parts.map(|part| (part.meta.name, part.digest)).collect(),
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
    Ok(Installed::New {
        manifest,
        trashed,
        kept_paths,
    })
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
        store: store.address().to_string(),
        wanted: version,
        newest,
    })?;
    Manifest::verified(&name, &bytes, trusted)?.numbered(&name, version)
}

fn verified_bundle(store: &BundleStore, manifest: &Manifest) -> Result<Vec<u8>, BundleError> {
    let expected = &manifest.bundle;
    if expected.bytes > MAX_BUNDLE_BYTES {
        return Err(BundleError::TooLarge {
            found: expected.bytes,
            limit: MAX_BUNDLE_BYTES,
        });
    }
    let bad = |reason| bad_bundle(store, manifest, reason);
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

fn bad_bundle(store: &BundleStore, manifest: &Manifest, reason: String) -> BundleError {
    BundleError::BadBundle {
        name: store.shown(&bundle_name(&manifest.bundle.sha256)),
        reason,
    }
}

/// The library's numbers of parts, with those of a version.
fn numbers_with(
    library: &LibraryFolder,
    trusted: TrustedKey,
    manifest: &Manifest,
) -> Result<PartNumbers, BundleError> {
    let before = TakenBundle::read(library)?.filter(|before| before.key == trusted.to_base64());
    let before = before.map_or_else(PartNumbers::default, |before| before.manifest.numbers);
    let mut numbers = library.numbers()?;
    numbers.add_published(&manifest.numbers, &before);
    Ok(numbers)
}

/// All parts of the version, if each can be loaded.
fn arriving_parts(
    coming: &LibraryFolder,
    store: &BundleStore,
    manifest: &Manifest,
) -> Result<Vec<ArrivingPart>, BundleError> {
    let load = coming.load(&ReferenceParams::default())?;
    if let Some(problem) = load.problems.into_iter().next() {
        return Err(BundleError::UnreadablePart {
            version: manifest.version,
            problem: Box::new(problem),
        });
    }
    let found = load.parts.len();
    if found != manifest.num_parts {
        let reason = format!("it has {found} parts, expected {}", manifest.num_parts);
        return Err(bad_bundle(store, manifest, reason));
    }
    let mut parts = Vec::new();
    for meta in load.parts {
        let found = StoredPart::of(coming, &meta.name).ok_or_else(|| {
            let reason = format!("its part {} cannot be read", meta.name);
            bad_bundle(store, manifest, reason)
        })?;
        let digest = found.digest;
        parts.push(ArrivingPart { meta, digest });
    }
    Ok(parts)
}

/// The spray paths that go over to the version. An error if it would replace anything else that was made here, unless that
/// may go to the trash.
fn paths_to_keep(
    library: &LibraryFolder,
    arriving: &[ArrivingPart],
    local: LocalParts,
) -> Result<Vec<(PartName, SprayPath)>, BundleError> {
    let before = TakenBundle::read(library)?;
    let before = before.as_ref().map(|before| &before.parts);
    let LocalContent { parts, spray_paths } = LocalContent::of(library, before, arriving)?;
    if parts.is_empty() || local == LocalParts::Trash {
        Ok(spray_paths)
    } else {
        Err(BundleError::LocalParts { parts })
    }
}

impl TakenBundle {
    /// What a library was taken from last; none of one that was only ever enrolled.
    pub fn read(library: &LibraryFolder) -> Result<Option<Self>, BundleError> {
        let path = library.file_beside_parts(RECORD);
        let bytes = match read_limited(&path, MAX_RECORD_BYTES) {
            Err(FileError::NotFound { .. }) => return Ok(None),
            bytes => bytes?,
        };
        let record = parse_json(&path, &bytes, SCHEMA, |error| BundleError::BadRecord {
            path: path.clone(),
            reason: error.to_string(),
        });
        record.map(Some)
    }

    /// True if it is this version, signed with this key.
    pub fn is_of(&self, manifest: &Manifest, key: TrustedKey) -> bool {
        self.manifest == *manifest && self.key == key.to_base64()
    }

    /// What differs from that version here, in the order of the names: enrolled or changed parts, then removed ones.
    pub fn differences(&self, library: &LibraryFolder) -> Result<Vec<LocalPart>, BundleError> {
        differences(library, &self.parts)
    }
}

#[cfg(test)]
mod tests;
