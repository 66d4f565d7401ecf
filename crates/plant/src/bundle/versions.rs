//! Lists the versions in a store.

use super::{
    Manifest, TrustedKey,
    error::BundleError,
    store::{BundleStore, manifest_name},
};

/// A version in a store, to be shown: whichever key signed it, and without a look at its bundle.
#[derive(Debug)]
pub struct PublishedVersion {
    /// Its number.
    pub version: u32,
    /// Its manifest and the key that signed it, or why it cannot be read.
    pub manifest: Result<(Manifest, TrustedKey), BundleError>,
}

/// All versions in a store, the newest first.
pub fn versions(store: &BundleStore) -> Result<Vec<PublishedVersion>, BundleError> {
    let mut numbers = store.versions()?;
    numbers.sort_unstable_by(|a, b| b.cmp(a));
    let mut versions = Vec::new();
    for version in numbers {
        let name = store.shown(&manifest_name(version));
        let manifest = match store.manifest(version) {
            // Somebody removed it meanwhile.
            Ok(None) => continue,
            Ok(Some(bytes)) => Manifest::of_any_key(&name, &bytes)
                .and_then(|(manifest, key)| Ok((manifest.numbered(&name, version)?, key))),
            Err(BundleError::TooLarge { found, .. }) => {
                let reason = format!("it has {found} bytes");
                Err(BundleError::BadManifest { name, reason })
            }
            Err(error) => return Err(error),
        };
        versions.push(PublishedVersion { version, manifest });
    }
    Ok(versions)
}
