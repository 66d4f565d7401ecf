//! Loading a library: in parallel, each part on its own, so that a damaged one is reported and the others load.

use std::{
    borrow::Cow,
    fs,
    io::{self, Read as _},
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    Library,
    entry::{CLOUD, Entry, META, SIGNATURE, THUMBNAIL},
    error::LibraryError,
    part::{FileCheck, PartMeta, SCHEMA_VERSION, StoredSignature},
    problem::{EntryError, EntryIssue, EntryProblem, EntryWarning, MAX_POINTS},
    shipped::shipped_entries,
    spray_store::read_spray_path,
    store::LibraryFolder,
};
use files::{
    FileContent, FileError, open_bytes, open_regular, parse_toml, read_bytes, read_picture,
    toml_problem,
};
use geometry::{
    cloud::PointCloud,
    nearest::KdTree,
    normals::estimate_normals,
    parallel::{map_each, num_cores},
    units::Metres,
};
use stages::reference::{Reference, ReferenceParams};

/// Result of loading a library.
#[derive(Debug, Default)]
pub struct LibraryLoad {
    /// The loaded parts, sorted by name.
    pub library: Library,
    /// The `part.toml` of each loaded part, in the same order.
    pub parts: Vec<PartMeta>,
    /// The parts that could not be loaded, with reasons. Their files were not changed.
    pub problems: Vec<EntryProblem>,
    /// Warnings about loaded parts.
    pub warnings: Vec<EntryWarning>,
}

/// Result of listing a library.
#[derive(Debug, Default)]
pub struct LibraryListing {
    /// The `part.toml` of each part, sorted by name.
    pub parts: Vec<PartMeta>,
    /// The parts whose `part.toml` or cloud is missing or unreadable, with reasons.
    pub problems: Vec<EntryProblem>,
}

/// A stored part, read and prepared.
#[derive(Debug)]
pub struct StoredPart {
    /// Content of `part.toml`.
    pub meta: PartMeta,
    /// The prepared reference, with cloud and views.
    pub reference: Reference,
    /// Warnings about the part.
    pub warnings: Vec<EntryWarning>,
}

/// Maximum size of a `part.toml` or `signature.json`, bytes.
const MAX_TEXT_BYTES: u64 = 8 << 20;

/// The most parts of a library that are loaded together: they take about 4 GB of memory.
pub(super) const MAX_PARTS: usize = 10_000;

/// How often parts are loaded at most while writers change them.
const MAX_LOADS: usize = 5;

/// How thoroughly a stored part is checked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum CloudCheckLevel {
    /// Only what an inspection needs.
    Quick,
    /// All files against each other.
    Thorough,
}

impl LibraryFolder {
    /// Loads all parts. It is an error only if the folder cannot be listed; damaged parts are in `problems`.
    pub fn load(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        self.load_unchanged(|entries| load_entries(entries, CloudCheckLevel::Quick, params))
    }

    /// Lists all parts without reading their clouds.
    pub fn list(&self) -> Result<LibraryListing, LibraryError> {
        Ok(list_entries(&self.entries()?))
    }

    /// As [`Self::load`], and checks every file of every part against its cloud.
    pub fn verify(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        self.load_unchanged(|entries| load_entries(entries, CloudCheckLevel::Thorough, params))
    }

    /// Loads one part.
    pub fn read(
        &self,
        name: &str,
        params: &ReferenceParams,
    ) -> Result<Result<StoredPart, EntryProblem>, LibraryError> {
        Ok(read_entry(
            &self.entry(name)?,
            CloudCheckLevel::Quick,
            params,
        ))
    }

    /// Returns the path of a part's thumbnail, if it exists.
    pub fn thumbnail(&self, name: &str) -> Option<PathBuf> {
        let path = self.entry(name).ok()?.path.join(THUMBNAIL);
        path.exists().then_some(path)
    }

    /// Loads again if a writer moved or changed parts meanwhile: some would be missing, or be of the former library.
    fn load_unchanged(
        &self,
        mut load: impl FnMut(&[Entry]) -> LibraryLoad,
    ) -> Result<LibraryLoad, LibraryError> {
        let mut before = self.dated_entries()?;
        for _ in 1..MAX_LOADS {
            let loaded = load(&before.0);
            let after = self.dated_entries()?;
            if before == after {
                return Ok(loaded);
            }
            before = after;
        }
        Ok(load(&before.0))
    }

    /// The folders of all parts, and when each was changed: a new part may take the place of one of the same name.
    fn dated_entries(&self) -> Result<(Vec<Entry>, Vec<Option<SystemTime>>), LibraryError> {
        let entries = self.entries()?;
        if entries.len() > MAX_PARTS {
            return Err(LibraryError::TooManyParts {
                path: self.path().to_owned(),
                found: entries.len(),
            });
        }
        let changed = |entry: &Entry| fs::metadata(&entry.path).and_then(|m| m.modified()).ok();
        let changed_at = entries.iter().map(changed).collect();
        Ok((entries, changed_at))
    }
}

/// Loads the parts inside the program.
pub(super) fn load_shipped(params: &ReferenceParams) -> LibraryLoad {
    load_entries(&shipped_entries(), CloudCheckLevel::Quick, params)
}

/// Lists the parts inside the program.
pub(super) fn list_shipped() -> LibraryListing {
    list_entries(&shipped_entries())
}

fn list_entries(entries: &[Entry]) -> LibraryListing {
    let mut listing = LibraryListing::default();
    for entry in entries {
        let has_cloud = entry.shipped.is_some() || entry.path.join(CLOUD).is_file();
        let missing = || EntryProblem {
            entry: entry.name.clone(),
            path: entry.path.clone(),
            reason: EntryError::Missing { file: CLOUD },
        };
        match meta_of(entry).and_then(|meta| has_cloud.then_some(meta).ok_or_else(missing)) {
            Ok(meta) => listing.parts.push(meta),
            Err(problem) => listing.problems.push(problem),
        }
    }
    listing
}

/// Loads one part inside the program; `None` if there is none with this name.
pub(super) fn read_shipped(
    name: &str,
    params: &ReferenceParams,
) -> Option<Result<StoredPart, EntryProblem>> {
    let entry = shipped_entries().into_iter().find(|e| e.name == name)?;
    Some(read_entry(&entry, CloudCheckLevel::Quick, params))
}

fn load_entries(entries: &[Entry], look: CloudCheckLevel, params: &ReferenceParams) -> LibraryLoad {
    let read_one = |i: usize| {
        let mut read = read_entry(&entries[i], look, params)?;
        read.reference = read.reference.for_library_of(entries.len());
        Ok(read)
    };
    let mut load = LibraryLoad::default();
    for read in map_each(entries.len(), num_cores(), read_one) {
        match read {
            Ok(part) => {
                load.library.references.push(part.reference);
                load.parts.push(part.meta);
                load.warnings.extend(part.warnings);
            }
            Err(problem) => load.problems.push(problem),
        }
    }
    load
}

fn read_entry(
    entry: &Entry,
    look: CloudCheckLevel,
    params: &ReferenceParams,
) -> Result<StoredPart, EntryProblem> {
    let read = || -> Result<StoredPart, EntryError> {
        let meta = read_meta(entry)?;
        let cloud = read_cloud(entry, &meta.cloud)?;
        let mut reference =
            Reference::prepare(meta.part_name().as_str(), cloud, meta.coverage, params)?
                .with_cut(meta.cut);
        meta.name.as_str().clone_into(&mut reference.enrolled_as);
        let mut issues = issues(entry, &reference, look, params);
        if look == CloudCheckLevel::Thorough
            && let Err(error) = read_spray_path(&entry.path, &meta)
        {
            let why = error.to_string();
            issues.push(EntryIssue::SprayPath { why });
        }
        let warnings = issues
            .into_iter()
            .map(|issue| EntryWarning {
                entry: entry.name.clone(),
                issue,
            })
            .collect();
        Ok(StoredPart {
            meta,
            reference,
            warnings,
        })
    };
    read().map_err(|reason| EntryProblem {
        entry: entry.name.clone(),
        path: entry.path.clone(),
        reason,
    })
}

/// Returns why a stored part cannot be loaded; `None` if it can.
pub(super) fn problem_of(entry: &Entry) -> Option<EntryProblem> {
    read_entry(entry, CloudCheckLevel::Quick, &ReferenceParams::default()).err()
}

/// Reads the `part.toml` of a stored part.
pub(super) fn meta_of(entry: &Entry) -> Result<PartMeta, EntryProblem> {
    read_meta(entry).map_err(|reason| EntryProblem {
        entry: entry.name.clone(),
        path: entry.path.clone(),
        reason,
    })
}

fn read_meta(entry: &Entry) -> Result<PartMeta, EntryError> {
    let text = meta_text(entry).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => EntryError::Missing { file: META },
        io::ErrorKind::InvalidData => EntryError::BadMeta {
            found: "it is not text".into(),
        },
        _ => EntryError::Unreadable { source },
    })?;
    let bad = |error: toml::de::Error| EntryError::BadMeta {
        found: toml_problem(&text, &error),
    };
    let meta: PartMeta = parse_toml(Path::new(META), &text, SCHEMA_VERSION, bad)?;
    if meta.name.as_str() == entry.name {
        Ok(meta)
    } else {
        Err(EntryError::NameMismatch {
            folder: entry.name.clone(),
            name: meta.name,
        })
    }
}

fn meta_text(entry: &Entry) -> io::Result<String> {
    match entry.shipped_file(META) {
        Some(bytes) => String::from_utf8(bytes.to_vec()).map_err(io::Error::other),
        None => read_text(&entry.path.join(META)),
    }
}

fn read_text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    open_regular(path)?
        .take(MAX_TEXT_BYTES)
        .read_to_string(&mut text)?;
    Ok(text)
}

/// Reads the cloud and checks it against `part.toml`.
fn read_cloud(entry: &Entry, expected: &FileCheck) -> Result<PointCloud, EntryError> {
    let path = entry.path.join(CLOUD);
    let not_a_cloud = |found: &str| EntryError::NotACloud {
        found: found.to_owned(),
    };
    let bytes = match entry.shipped_file(CLOUD) {
        Some(bytes) => Ok(Cow::Borrowed(bytes)),
        None => read_bytes(&path).map(Cow::Owned),
    };
    let opened = bytes.and_then(|bytes| Ok((open_bytes(&path, &bytes)?, bytes)));
    let (opened, bytes) = match opened {
        Ok(opened) => opened,
        Err(FileError::NotFound { .. }) => return Err(EntryError::Missing { file: CLOUD }),
        Err(error) => return Err(EntryError::BadCloud(Box::new(error))),
    };
    let mut cloud = match opened {
        FileContent::Cloud(cloud) => cloud,
        FileContent::Mesh(_) => return Err(not_a_cloud("a mesh")),
        FileContent::Depth(_) => return Err(not_a_cloud("a depth image")),
    };
    let found = FileCheck::from_bytes(&bytes, cloud.points.len());
    cloud.points.shrink_to_fit();
    cloud.normals.iter_mut().for_each(Vec::shrink_to_fit);
    // No stage uses them.
    (cloud.colours, cloud.labels) = (None, None);
    if found != *expected {
        return Err(EntryError::ChangedCloud {
            found,
            expected: expected.clone(),
        });
    }
    if cloud.points.len() > MAX_POINTS {
        return Err(not_a_cloud(&format!("{} points", cloud.points.len())));
    }
    let is_unit = |n: &nalgebra::Vector3<f32>| (n.norm() - 1.0).abs() < 0.01;
    if !cloud
        .normals
        .as_ref()
        .is_some_and(|n| n.iter().all(is_unit))
    {
        // Written by another program: estimate normals as enrolling does.
        let tree = KdTree::new(&cloud.points);
        cloud.normals = Some(estimate_normals(
            &cloud.points,
            &tree,
            Metres::from_mm(24.0),
            &nalgebra::Point3::origin(),
        ));
    }
    Ok(cloud)
}

fn issues(
    entry: &Entry,
    reference: &Reference,
    look: CloudCheckLevel,
    params: &ReferenceParams,
) -> Vec<EntryIssue> {
    let mut issues = Vec::new();
    if entry.shipped.is_some() {
        return issues;
    }
    if !entry.path.ends_with(&entry.name) {
        issues.push(EntryIssue::LeftAside);
    }
    for file in [SIGNATURE, THUMBNAIL] {
        if !fs::exists(entry.path.join(file)).unwrap_or(false) {
            issues.push(EntryIssue::Missing { file });
        } else if look == CloudCheckLevel::Thorough
            && !belongs(&entry.path.join(file), reference, params)
        {
            issues.push(EntryIssue::Stale { file });
        }
    }
    issues
}

/// Returns whether a file derived from the cloud is intact and matches it.
fn belongs(file: &Path, reference: &Reference, params: &ReferenceParams) -> bool {
    if file.ends_with(THUMBNAIL) {
        return read_picture(file).is_ok();
    }
    let stored = read_text(file)
        .ok()
        .and_then(|text| serde_json::from_str::<StoredSignature>(&text).ok());
    let made = StoredSignature::of(reference, params);
    matches!((stored, made), (Some(stored), Some(made)) if stored.agrees_with(&made))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{PartNaming, shipped::write_shipped};

    fn library() -> (tempfile::TempDir, LibraryFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        write_shipped(folder.path()).expect("written");
        let library = LibraryFolder::open(folder.path()).expect("there");
        (folder, library)
    }

    fn quick(entries: &[Entry]) -> LibraryLoad {
        load_entries(entries, CloudCheckLevel::Quick, &ReferenceParams::default())
    }

    #[test]
    fn listing_reads_no_clouds_and_finds_missing_ones() {
        let (folder, library) = library();
        // Whatever is in it, it is not read.
        std::fs::write(folder.path().join("fender").join(CLOUD), "none").expect("written");
        std::fs::remove_file(folder.path().join("grille").join(CLOUD)).expect("removed");
        let LibraryListing { parts, problems } = library.list().expect("listed");
        assert_eq!((parts.len(), problems.len()), (7, 1));
        assert_eq!(problems[0].entry, "grille");
        let load = library.load(&ReferenceParams::default()).expect("loaded");
        let listed = list_shipped().parts;
        for (meta, reference) in load.parts.iter().zip(&load.library.references) {
            let size = reference
                .size()
                .map(|sides| sides.map(|side| side.mm().round()));
            let listed = listed.iter().find(|listed| listed.name == meta.name);
            let listed = listed.expect("shipped");
            assert_eq!(listed.enrolled.size_mm, size, "{}", meta.name);
        }
    }

    #[test]
    fn a_library_that_is_replaced_while_it_is_read_is_read_again() {
        let (_folder, library) = library();
        let mut num_loads = 0;
        let load = library.load_unchanged(|entries| {
            num_loads += 1;
            if num_loads == 1 {
                let replaced = library.replace_all::<()>(|building| {
                    write_shipped(building)?;
                    Ok(Ok(()))
                });
                replaced.expect("written").expect("not refused");
                let door = "front_door".parse().expect("a name");
                library.remove(&door).expect("removed");
            }
            quick(entries)
        });
        let load = load.expect("listed");
        assert!(load.problems.is_empty(), "{:?}", load.problems);
        assert_eq!((load.parts.len(), num_loads), (7, 2));
    }

    #[test]
    fn a_part_that_is_changed_in_its_place_while_it_is_read_is_read_again() {
        let (_folder, library) = library();
        let mut num_loads = 0;
        let load = library.load_unchanged(|entries| {
            num_loads += 1;
            let load = quick(entries);
            if num_loads == 1 {
                let name = "fender".parse().expect("a name");
                let words = PartNaming {
                    title: "Mudguard".into(),
                    ..library.words(&name).expect("there")
                };
                library.rename(&name, &words).expect("renamed");
            }
            load
        });
        let load = load.expect("listed");
        assert!(load.parts.iter().any(|part| part.title == "Mudguard"));
    }

    #[test]
    fn a_library_that_never_rests_is_read_nevertheless() {
        let (folder, library) = library();
        let mut num_loads = 0;
        let load = library.load_unchanged(|_| {
            num_loads += 1;
            fs::create_dir(folder.path().join(format!("part_{num_loads}"))).expect("made");
            LibraryLoad::default()
        });
        load.expect("listed");
        assert_eq!(num_loads, MAX_LOADS);
    }
}
