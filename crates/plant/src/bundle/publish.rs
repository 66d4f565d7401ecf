//! Makes the library as it is the next version.

use super::{
    BundleCheck, MAX_BUNDLE_BYTES, Manifest, SigningKey,
    archive::{files_in, pack, unpack},
    error::BundleError,
    manifest::MAX_NOTE,
    sha256,
    store::{BundleStore, manifest_name},
};
use files::FileError;
use inspection::library::{EntryIssue, EntryWarning, LibraryFolder, LibraryLoad, PartName};
use stages::reference::ReferenceParams;

/// Publishes all parts of a library as the version after the newest one in the store. Only what can be taken is
/// published: every part is loaded from the packed bundle first. The note is for people, at most 2000 characters. The
/// numbers of the parts are published with them; a part without one gets it now.
///
/// A version counts from its manifest on, whatever of its bundle is in the store. Where this fails nothing was published,
/// unless the store stopped answering while the manifest was written.
pub fn publish(
    library: &LibraryFolder,
    store: &BundleStore,
    key: &SigningKey,
    note: &str,
) -> Result<Manifest, BundleError> {
    let found = note.chars().count();
    if found > MAX_NOTE {
        return Err(BundleError::LongNote {
            found,
            limit: MAX_NOTE,
        });
    }
    let numbers = library.give_numbers()?;
    let load = library.verify(&ReferenceParams::default())?;
    let identity = load.identity();
    let parts = names_of(load)?;
    if parts.is_empty() {
        return Err(BundleError::NoParts {
            path: library.path().to_owned(),
        });
    }
    let bundle = pack(library, &parts)?;
    if !is_the_same(&bundle, &identity)? {
        return Err(BundleError::Changing {
            path: library.path().to_owned(),
        });
    }
    let check = BundleCheck {
        sha256: sha256(&bundle),
        bytes: bundle.len() as u64,
    };
    if check.bytes > MAX_BUNDLE_BYTES {
        return Err(BundleError::TooLarge {
            found: check.bytes,
            limit: MAX_BUNDLE_BYTES,
        });
    }
    let newest = store.newest()?;
    if let Some(newest) = newest {
        check_publisher(store, newest, key)?;
    }
    let version = newest.unwrap_or(0).saturating_add(1);
    store.check_conditional_put()?;
    store.put_bundle(&check.sha256, bundle)?;
    let now = geometry::clock::now();
    let manifest = Manifest::new(version, now, parts.len(), check, note, numbers);
    if store.put_manifest(version, &manifest.signed(key))? {
        Ok(manifest)
    } else {
        Err(BundleError::VersionTaken {
            store: store.address().to_string(),
            version,
        })
    }
}

/// Refuses to publish after a version that another key signed: cells that trust that key could take nothing any more. A
/// damaged version is no obstacle; the next one replaces it.
fn check_publisher(store: &BundleStore, newest: u32, key: &SigningKey) -> Result<(), BundleError> {
    let name = store.shown(&manifest_name(newest));
    let bytes = match store.manifest(newest) {
        Ok(Some(bytes)) => bytes,
        Ok(None) | Err(BundleError::TooLarge { .. }) => return Ok(()),
        Err(error) => return Err(error),
    };
    match Manifest::verified(&name, &bytes, key.trusted()) {
        Err(BundleError::OtherKey {
            name,
            found,
            trusted,
        }) => Err(BundleError::OtherPublisher {
            name,
            found,
            own: trusted,
        }),
        _ => Ok(()),
    }
}

/// The parts of a library that has no damaged one, and no damaged spray path.
fn names_of(load: LibraryLoad) -> Result<Vec<PartName>, BundleError> {
    if let Some(problem) = load.problems.into_iter().next() {
        return Err(Box::new(problem).into());
    }
    let is_damage = |warning: &EntryWarning| matches!(warning.issue, EntryIssue::SprayPath { .. });
    match load.warnings.into_iter().find(is_damage) {
        Some(warning) => Err(warning.into()),
        None => Ok(load.parts.into_iter().map(|part| part.name).collect()),
    }
}

/// True if the bundle unpacks to a library of this identity: no part changed while it was read.
fn is_the_same(bundle: &[u8], identity: &str) -> Result<bool, BundleError> {
    let Ok(files) = files_in(bundle) else {
        return Ok(false);
    };
    let folder = tempfile::tempdir().map_err(|source| BundleError::Pack { source })?;
    unpack(&files, folder.path()).map_err(|source| FileError::writing(folder.path(), source))?;
    let load = LibraryFolder::open(folder.path())?.verify(&ReferenceParams::default())?;
    let is_same = load.identity() == identity;
    Ok(is_same && names_of(load).is_ok())
}
