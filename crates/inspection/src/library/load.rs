//! Loading a library: in parallel, each part on its own, so that a damaged one is reported and the others load.

use std::{collections::HashMap, fs, path::PathBuf, time::SystemTime};

use super::{
    Library,
    entry::{CLOUD, Entry, THUMBNAIL},
    error::LibraryError,
    part::PartMeta,
    problem::{EntryError, EntryProblem, EntryWarning},
    shipped::shipped_entries,
    store::LibraryFolder,
    stored_part::{CloudCheckLevel, StoredPart, meta_of, read_entry},
};
use geometry::parallel::{map_each, num_cores};
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

/// The most parts of a library that are loaded together: they take about 4 GB of memory.
const MAX_PARTS: usize = 10_000;

/// How often parts are loaded at most while writers change them.
const MAX_LOADS: usize = 5;

impl LibraryFolder {
    /// Loads all parts. It is an error only if the folder cannot be listed; damaged parts are in `problems`.
    pub fn load(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        self.load_after(params, &Library::default())
    }

    /// As [`Self::load`], and takes the parts that have not changed from the library that was loaded before.
    pub fn load_after(
        &self,
        params: &ReferenceParams,
        former: &Library,
    ) -> Result<LibraryLoad, LibraryError> {
        self.load_unchanged(|entries| load_entries(entries, CloudCheckLevel::Quick, params, former))
    }

    /// Lists all parts without reading their clouds.
    pub fn list(&self) -> Result<LibraryListing, LibraryError> {
        Ok(list_entries(&self.entries()?))
    }

    /// As [`Self::load`], and checks every file of every part against its cloud.
    pub fn verify(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        let none = Library::default();
        self.load_unchanged(|all| load_entries(all, CloudCheckLevel::Thorough, params, &none))
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
            None,
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
                limit: MAX_PARTS,
            });
        }
        let changed = |entry: &Entry| fs::metadata(&entry.path).and_then(|m| m.modified()).ok();
        let changed_at = entries.iter().map(changed).collect();
        Ok((entries, changed_at))
    }
}

/// Loads the parts inside the program.
pub(super) fn load_shipped(params: &ReferenceParams) -> LibraryLoad {
    let none = Library::default();
    load_entries(&shipped_entries(), CloudCheckLevel::Quick, params, &none)
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
    Some(read_entry(&entry, CloudCheckLevel::Quick, params, None))
}

fn load_entries(
    entries: &[Entry],
    look: CloudCheckLevel,
    params: &ReferenceParams,
    former: &Library,
) -> LibraryLoad {
    let former = former.references.iter();
    let former: HashMap<&str, &Reference> = former
        .map(|reference| (reference.enrolled_as.as_str(), reference))
        .collect();
    let read_one = |i: usize| {
        let entry = &entries[i];
        let former = former.get(entry.name.as_str()).copied();
        let mut read = read_entry(entry, look, params, former)?;
        read.reference = read.reference.for_library_of(entries.len());
        Ok(read)
    };
    let mut load = LibraryLoad::default();
    for read in map_each(entries.len(), num_cores(), read_one) {
        match read {
            Ok(part) => {
                if let Some(zones) = &part.meta.surface {
                    let name = part.meta.name.to_string();
                    load.library.surface_zones.insert(name, zones.clone());
                }
                load.library.references.push(part.reference);
                load.parts.push(part.meta);
                load.warnings.extend(part.warnings);
            }
            Err(problem) => load.problems.push(problem),
        }
    }
    load
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
        let (params, none) = (ReferenceParams::default(), Library::default());
        load_entries(entries, CloudCheckLevel::Quick, &params, &none)
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
