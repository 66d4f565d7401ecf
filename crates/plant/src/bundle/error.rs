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
#[derive(Debug, Error)]
pub enum BundleError {
    /// A text is no store.
    #[error("{address:?} is not a store: {reason}")]
    BadAddress {
        /// As it was given.
        address: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The store cannot be reached, or refuses.
    #[error("{store}: {doing}: {source}")]
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
    NoConditionalPut {
        /// Its address.
        store: String,
    },
    /// The store has no version at all.
    #[error("{store}: no version of a library was published there")]
    NothingPublished {
        /// Its address.
        store: String,
    },
    /// The store has no version of this number.
    #[error("{store}: no version {wanted}; the newest is {newest}")]
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
    VersionTaken {
        /// Its address.
        store: String,
        /// Its number.
        version: u32,
    },
    /// A manifest cannot be understood, or was changed.
    #[error("{name}: the manifest is damaged or was changed: {reason}")]
    BadManifest {
        /// Its name in the store.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Another key than the trusted one signed it.
    #[error("{name}: signed with the key {found}, but the trusted key is {trusted}")]
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
    BadBundle {
        /// Its name in the store.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A part in a bundle cannot be loaded.
    #[error("version {version} holds a part that cannot be read: {problem}")]
    UnreadablePart {
        /// The version.
        version: u32,
        /// Which part, and why.
        problem: Box<EntryProblem>,
    },
    /// A part of the library that is to be published cannot be loaded.
    #[error(transparent)]
    Problem(#[from] Box<EntryProblem>),
    /// A spray path of the library that is to be published cannot be used.
    #[error(transparent)]
    SprayPath(#[from] EntryWarning),
    /// The library has no parts.
    #[error("{}: the library has no part to publish", path.display())]
    NoParts {
        /// The folder.
        path: PathBuf,
    },
    /// The parts changed while they were packed.
    #[error("{}: the library changed while it was read", path.display())]
    Changing {
        /// The folder.
        path: PathBuf,
    },
    /// More than is published or taken at once.
    #[error("{found} bytes, at most {limit} are published or taken")]
    TooLarge {
        /// Bytes of the object or of the parts.
        found: u64,
        /// The largest size allowed.
        limit: u64,
    },
    /// The note is no note.
    #[error("the note has {found} characters, but at most {limit} are allowed")]
    LongNote {
        /// Characters given.
        found: usize,
        /// The most allowed.
        limit: usize,
    },
    /// The library has a later version than the newest one in the store.
    #[error("version {found} is older than version {installed}, which is installed")]
    Older {
        /// The version that would be taken.
        found: u32,
        /// The version of the library.
        installed: u32,
    },
    /// Parts or spray paths would leave the library that are in no version taken before.
    #[error("the version would replace what was made here: {}", listed(parts))]
    LocalParts {
        /// Which, and what became of them since.
        parts: Vec<LocalPart>,
    },
    /// The library's record of the version that it was taken from cannot be read.
    #[error("{}: damaged: {reason}", path.display())]
    BadRecord {
        /// The file.
        path: PathBuf,
        /// The first thing wrong.
        reason: String,
    },
    /// A key is there already.
    #[error("{}: exists already", path.display())]
    KeyExists {
        /// The file.
        path: PathBuf,
    },
    /// A file holds no key of the kind that is needed.
    #[error("{}: not an Ed25519 {what} in PEM form: {reason}", path.display())]
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
    NoRandom,
    /// The system gives no thread or socket for the connection.
    #[error("the connection cannot be prepared: {source}")]
    NoRuntime {
        /// What the system says.
        source: io::Error,
    },
    /// The parts cannot be packed.
    #[error("the library cannot be packed: {}", words_of(source))]
    Pack {
        /// What the system says.
        source: io::Error,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The library cannot be read or written.
    #[error(transparent)]
    Library(#[from] LibraryError),
}

fn listed(parts: &[LocalPart]) -> String {
    let parts: Vec<String> = parts.iter().map(LocalPart::to_string).collect();
    parts.join(", ")
}

impl Advice for BundleError {
    fn advice(&self) -> String {
        match self {
            Self::BadAddress { .. } => {
                "Give a folder, or s3://BUCKET or s3://BUCKET/PREFIX".into()
            }
            Self::Store { source, .. } => source.advice(),
            Self::NoConditionalPut { .. } => {
                "Publish to a folder, or to a store that knows If-None-Match, such as Amazon S3 or a recent MinIO".into()
            }
            Self::NothingPublished { .. } => {
                "Check the address, or publish one: partsight library publish --to STORE --key FILE".into()
            }
            Self::NoSuchVersion { newest, .. } => format!("Give --version {newest} or less, or leave --version out to \
                take the newest"),
            Self::VersionTaken { .. } => {
                "Look at what they published with partsight library take, then publish again: yours then becomes the next version".into()
            }
            Self::BadManifest { .. } | Self::BadBundle { .. } => {
                "Do not use this version: publish the library again, and find out who can write to the store".into()
            }
            Self::OtherKey { .. } => {
                "Ask the publisher for the public key, library.pub, and give that with --trust if you trust it".into()
            }
            Self::OtherPublisher { .. } => {
                "Publish with that key, because cells that trust it take no other, or publish to another folder or prefix; if \
                 nobody knows that key, remove the version from the store"
                    .into()
            }
            Self::UnreadablePart { version, .. } => {
                format!("Update Partsight on this computer if it is older than where version {version} was published; else publish the library again")
            }
            Self::Problem(problem) => problem.advice(),
            Self::SprayPath(warning) => warning.advice(),
            Self::NoParts { .. } => "Enrol a part first: partsight enrol FILE --name NAME".into(),
            Self::Changing { .. } => "Wait until nobody is enrolling parts, then publish again".into(),
            Self::TooLarge { .. } => "Split the parts over several stores".into(),
            Self::LongNote { .. } => "Shorten the note".into(),
            Self::Older { found, .. } => {
                format!("Nothing needs to be done, unless you want to go back: then give --version {found}")
            }
            Self::LocalParts { .. } => {
                "Publish them with the library, or take with --replace, which moves these parts to the library's .trash".into()
            }
            Self::BadRecord { path, .. } => {
                format!("Remove {}, then take the version again", path.display())
            }
            Self::KeyExists { .. } => {
                "Use this key, or name another folder; cells that trust this key take nothing signed with another \
                 one".into()
            }
            Self::BadKey { what, .. } => format!("Give the {what} that partsight library keys made"),
            Self::NoRandom => "Report this with the message".into(),
            Self::NoRuntime { .. } => "Close other programs, then try again".into(),
            Self::Pack { source } => advice_on(source).into(),
            Self::File(error) => error.advice(),
            Self::Library(error) => error.advice(),
        }
    }
}
