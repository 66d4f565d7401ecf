//! Why a library could not be published or taken.

use std::{io, path::PathBuf};

use thiserror::Error;

use super::{keys::TrustedKey, local::LocalPart, store_error::StoreError};
use files::{FileError, advice_on, words_of};
use geometry::error::Advice;
use inspection::library::{EntryProblem, EntryWarning, LibraryError};

/// Why a library could not be published or taken. The library and the versions in the store are as they were before, with
/// two exceptions: after the last rename of [`take`](fn@super::take) the new version counts, and where the store stopped
/// answering [`publish`](fn@super::publish), only the store knows whether it has the version.
#[derive(Debug, Error, Advice)]
pub enum BundleError {
    /// A text is no store.
    #[error("{address:?} is not a store: {reason}")]
    #[advice = "Give a folder, or s3://BUCKET or s3://BUCKET/PREFIX"]
    BadAddress {
        /// As it was given.
        address: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The store cannot be reached, or refuses.
    #[error("{store}: {doing}: {source}")]
    #[advice(source.advice())]
    Store {
        /// Its address.
        store: String,
        /// What was tried, such as `cannot list the versions`.
        doing: &'static str,
        /// Why.
        source: Box<StoreError>,
    },
    /// The store writes over what is there, though it was asked not to.
    #[error(
        "{store}: this store does not prevent two publishers from making the same version: it ignores If-None-Match"
    )]
    #[advice = "Publish to a folder, or to a store that knows If-None-Match, such as Amazon S3 or a recent MinIO"]
    NoConditionalPut {
        /// Its address.
        store: String,
    },
    /// The store has no version at all.
    #[error("{store}: no version of a library was published there")]
    #[advice = "Check the address, or publish one: partsight library publish --to STORE --key FILE"]
    NothingPublished {
        /// Its address.
        store: String,
    },
    /// The store has no version of this number.
    #[error("{store}: no version {wanted}; the newest is {newest}")]
    #[advice = "Give --version {newest} or less, or leave --version out to take the newest"]
    NoSuchVersion {
        /// Its address.
        store: String,
        /// The version asked for.
        wanted: u32,
        /// The newest version there.
        newest: u32,
    },
    /// Somebody else has published this version meanwhile.
    #[error("{store}: somebody else has published version {version} in the meantime")]
    #[advice = "Look at what they published with partsight library take, then publish again: yours then becomes the next version"]
    VersionTaken {
        /// Its address.
        store: String,
        /// Its number.
        version: u32,
    },
    /// A manifest cannot be understood, or was changed.
    #[error("{name}: the manifest is damaged or was changed: {reason}")]
    #[advice(DO_NOT_USE)]
    BadManifest {
        /// Its name in the store.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Another key than the trusted one signed it.
    #[error("{name}: signed with the key {found}, but the trusted key is {trusted}")]
    #[advice = "Ask the publisher for the public key, library.pub, and give that with --trust if you trust it"]
    OtherKey {
        /// Its name in the store.
        name: String,
        /// The key that it names.
        found: TrustedKey,
        /// The key that was given.
        trusted: TrustedKey,
    },
    /// The newest version in the store is signed with another key than the publisher's.
    #[error("{name}: signed with the key {found}, but your key is {own}")]
    #[advice = "Publish with that key, because cells that trust it accept no other, or publish to another folder or prefix; if nobody knows \
               that key, remove the version from the store"]
    OtherPublisher {
        /// Its name in the store.
        name: String,
        /// The key that it names.
        found: TrustedKey,
        /// The publisher's key.
        own: TrustedKey,
    },
    /// A bundle is not the one that its manifest names, or holds what no bundle may hold.
    #[error("{name}: the bundle is damaged or was changed: {reason}")]
    #[advice(DO_NOT_USE)]
    BadBundle {
        /// Its name in the store.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A part in a bundle cannot be loaded.
    #[error("version {version} holds a part that cannot be read: {problem}")]
    #[advice = "Update Partsight on this computer if it is older than where version {version} was published; else publish the library again"]
    UnreadablePart {
        /// The version.
        version: u32,
        /// Which part, and why.
        problem: Box<EntryProblem>,
    },
    /// A part of the library that is to be published cannot be loaded.
    #[error(transparent)]
    #[advice(transparent)]
    Problem(#[from] Box<EntryProblem>),
    /// A spray path of the library that is to be published cannot be used.
    #[error(transparent)]
    #[advice(transparent)]
    SprayPath(#[from] EntryWarning),
    /// The library has no parts.
    #[error("{}: the library has no part to publish", path.display())]
    #[advice = "Enrol a part first: partsight enrol FILE --name NAME"]
    NoParts {
        /// The folder.
        path: PathBuf,
    },
    /// The parts changed while they were packed.
    #[error("{}: the library changed while it was read", path.display())]
    #[advice = "Wait until nobody is enrolling parts, then publish again"]
    Changing {
        /// The folder.
        path: PathBuf,
    },
    /// More than is published or taken at once.
    #[error("{found} bytes, at most {limit} are published or taken")]
    #[advice = "Split the parts over several stores"]
    TooLarge {
        /// Bytes of the object or of the parts.
        found: u64,
        /// The largest size allowed.
        limit: u64,
    },
    /// The note is no note.
    #[error("the note has {found} characters, but at most {limit} are allowed")]
    #[advice = "Shorten the note"]
    LongNote {
        /// Characters given.
        found: usize,
        /// The most allowed.
        limit: usize,
    },
    /// The library has a later version than the newest one in the store.
    #[error("version {found} is older than version {installed}, which is installed")]
    #[advice = "Nothing needs to be done, unless you want to go back: then give --version {found}"]
    Older {
        /// The version that would be taken.
        found: u32,
        /// The version of the library.
        installed: u32,
    },
    /// Parts or spray paths would leave the library that are in no version taken before.
    #[error("the version would replace what was made here: {}", listed(parts))]
    #[advice = "Publish them with the library, or take with --replace, which moves these parts to the library's .trash"]
    LocalParts {
        /// Which, and what became of them since.
        parts: Vec<LocalPart>,
    },
    /// The library's record of the version that it was taken from cannot be read.
    #[error("{}: damaged: {reason}", path.display())]
    #[advice("Remove {}, then take the version again", path.display())]
    BadRecord {
        /// The file.
        path: PathBuf,
        /// The first thing wrong.
        reason: String,
    },
    /// A key is there already.
    #[error("{}: exists already", path.display())]
    #[advice = "Use this key, or name another folder; cells that trust this key take nothing signed with another one"]
    KeyExists {
        /// The file.
        path: PathBuf,
    },
    /// A file holds no key of the kind that is needed.
    #[error("{}: not an Ed25519 {what} in PEM form: {reason}", path.display())]
    #[advice = "Give the {what} that partsight library keys made"]
    BadKey {
        /// The file.
        path: PathBuf,
        /// `private key` or `public key`.
        what: &'static str,
        /// Message of the reader.
        reason: String,
    },
    /// The system gives no random numbers.
    #[error("the system provides no random numbers, from which keys are made")]
    #[advice = "Report this with the message"]
    NoRandom,
    /// The system gives no thread or socket for the connection.
    #[error("the connection cannot be prepared: {source}")]
    #[advice = "Close other programs, then try again"]
    NoRuntime {
        /// What the system says.
        source: io::Error,
    },
    /// The parts cannot be packed.
    #[error("the library cannot be packed: {}", words_of(source))]
    #[advice(advice_on(source))]
    Pack {
        /// What the system says.
        source: io::Error,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The library cannot be read or written.
    #[error(transparent)]
    #[advice(transparent)]
    Library(#[from] LibraryError),
}

fn listed(parts: &[LocalPart]) -> String {
    let parts: Vec<String> = parts.iter().map(LocalPart::to_string).collect();
    parts.join(", ")
}

const DO_NOT_USE: &str =
    "Do not use this version: publish the library again, and find out who can write to the store";
