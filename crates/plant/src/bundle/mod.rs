//! One library for many cells: signed, numbered versions of it in a folder or an S3-compatible store.
//!
//! ```text
//! publish: LibraryFolder ─► archive (tar) ─► STORE/bundles/SHA256.tar, then STORE/manifests/0000000007.txt
//! take:    manifest ─► signature ─► archive ─► digest ─► files ─► LibraryFolder::replace_all
//! ```
//!
//! A manifest names its bundle by size and SHA-256 and is signed with Ed25519, so that nothing about the store has to be
//! trusted. It is written last, and only where there is none of its number: a version is published whole or not at all,
//! and no two are the same. Taking changes nothing before the whole bundle was checked and every part in it was loaded.
//!
//! `docs/guide/plant.md` describes it for users.

mod archive;
mod connector;
mod error;
mod keys;
mod local;
mod manifest;
mod publish;
mod store;
mod store_error;
mod take;
mod versions;

pub use self::{
    error::BundleError,
    keys::{KeyFiles, SigningKey, TrustedKey, make_keys},
    local::LocalPart,
    manifest::{BundleCheck, Manifest},
    publish::publish,
    store::{BundleStore, StoreAddress},
    store_error::StoreError,
    take::{Installed, LocalParts, Take, TakenBundle, take},
    versions::{PublishedVersion, versions},
};

/// The largest bundle, in bytes: a thousand parts. It is held in memory.
pub const MAX_BUNDLE_BYTES: u64 = 512 << 20;

/// SHA-256 in hexadecimal.
fn sha256(bytes: &[u8]) -> String {
    use std::fmt::Write as _;

    let digest = ring::digest::digest(&ring::digest::SHA256, bytes);
    let digest: &[u8] = digest.as_ref();
    let mut text = String::new();
    for byte in digest {
        // Writing to memory does not fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}
