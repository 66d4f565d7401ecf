//! The small signed file that makes a bundle a version of the library.
//!
//! Three lines: the manifest as JSON, the public key and the signature, both in base64. The signature is of the first line as
//! it stands there, behind [`SIGNED_AS`].

use std::path::Path;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    error::BundleError,
    keys::{SigningKey, TrustedKey},
};
use files::parse_json;
use inspection::library::PartNumbers;

/// The version of the format that is written, and the newest one that is read.
const SCHEMA: u32 = 1;
/// Stands before what is signed, so that no signature of anything else is one of a manifest.
const SIGNED_AS: &str = "partsight library manifest\n";
/// The largest manifest, in bytes: a thousand parts, and as many removed ones, with the longest names.
pub(super) const MAX_BYTES: u64 = 1 << 18;
/// The longest note, in characters.
pub(super) const MAX_NOTE: usize = 2000;

/// What a version of the library is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    schema: u32,
    /// From 1; each version has the next number.
    pub version: u32,
    /// When it was published.
    pub published_at: Timestamp,
    /// Parts in it, more references of a part included.
    pub num_parts: usize,
    /// The bundle that belongs to it.
    pub bundle: BundleCheck,
    /// Note of the publisher; may be empty.
    #[serde(default)]
    pub note: String,
    /// The numbers by which robots know the parts.
    #[serde(default, skip_serializing_if = "PartNumbers::is_empty")]
    pub numbers: PartNumbers,
}

/// By what a bundle is known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BundleCheck {
    /// SHA-256, 64 hexadecimal digits.
    pub sha256: String,
    /// Its size.
    pub bytes: u64,
}

impl Manifest {
    pub(super) fn new(
        version: u32,
        published_at: Timestamp,
        num_parts: usize,
        bundle: BundleCheck,
        note: &str,
        numbers: PartNumbers,
    ) -> Self {
        Self {
            schema: SCHEMA,
            version,
            published_at,
            num_parts,
            bundle,
            note: note.to_owned(),
            numbers,
        }
    }

    /// As it is published.
    pub(super) fn signed(&self, key: &SigningKey) -> String {
        let json = serde_json::to_string(self).expect("numbers and texts are JSON");
        let signature = key.sign(&signed_bytes(&json));
        let key = key.trusted().to_base64();
        format!("{json}\n{key}\n{}\n", STANDARD.encode(signature))
    }

    /// Of a published file, if this key signed it. `name` is for the errors about it.
    pub(super) fn verified(
        name: &str,
        bytes: &[u8],
        trusted: TrustedKey,
    ) -> Result<Self, BundleError> {
        let signed = SignedText::of(name, bytes)?;
        if signed.key == trusted {
            signed.manifest()
        } else {
            Err(BundleError::OtherKey {
                name: name.to_owned(),
                found: signed.key,
                trusted,
            })
        }
    }

    /// Of a published file, whichever key signed it, and that key: to be shown, not to be trusted.
    pub(super) fn of_any_key(name: &str, bytes: &[u8]) -> Result<(Self, TrustedKey), BundleError> {
        let signed = SignedText::of(name, bytes)?;
        Ok((signed.manifest()?, signed.key))
    }

    /// This manifest, if it is of the version under whose number it was found.
    pub(super) fn numbered(self, name: &str, version: u32) -> Result<Self, BundleError> {
        if self.version == version {
            Ok(self)
        } else {
            Err(damaged(name, &format!("it is of version {}", self.version)))
        }
    }
}

/// The three lines of a published file. Nothing of them was checked yet.
struct SignedText<'a> {
    /// For the errors.
    name: &'a str,
    json: &'a str,
    key: TrustedKey,
    signature: Vec<u8>,
}

impl<'a> SignedText<'a> {
    fn of(name: &'a str, bytes: &'a [u8]) -> Result<Self, BundleError> {
        let text = str::from_utf8(bytes).ok();
        let lines = text.and_then(|text| text.strip_suffix('\n'));
        let lines: Vec<&str> = lines
            .into_iter()
            .flat_map(|text| text.split('\n'))
            .collect();
        let [json, key, signature] = lines[..] else {
            return Err(damaged(name, "expected three lines"));
        };
        let decoded = |line: &str| STANDARD.decode(line).ok();
        let key = decoded(key).and_then(|bytes| TrustedKey::of_bytes(&bytes));
        let key = key.ok_or_else(|| damaged(name, "the second line is no key"))?;
        let signature = decoded(signature);
        let signature = signature.ok_or_else(|| damaged(name, "the third line is no signature"))?;
        Ok(Self {
            name,
            json,
            key,
            signature,
        })
    }

    /// The manifest, if the signature is its key's.
    fn manifest(&self) -> Result<Manifest, BundleError> {
        let name = self.name;
        if !(self.key).is_signature(&signed_bytes(self.json), &self.signature) {
            return Err(damaged(name, "the signature is not one of this text"));
        }
        let wrong = |error: serde_json::Error| damaged(name, &error.to_string());
        let manifest: Manifest = parse_json(Path::new(name), self.json.as_bytes(), SCHEMA, wrong)?;
        if is_sha256(&manifest.bundle.sha256) {
            Ok(manifest)
        } else {
            Err(damaged(name, "the bundle's SHA-256 is none"))
        }
    }
}

fn damaged(name: &str, reason: &str) -> BundleError {
    BundleError::BadManifest {
        name: name.to_owned(),
        reason: reason.to_owned(),
    }
}

fn signed_bytes(json: &str) -> Vec<u8> {
    [SIGNED_AS, json].concat().into_bytes()
}

/// It is also the name of the bundle in the store, which must hold no path.
fn is_sha256(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bundle::keys::make_keys;

    fn key(folder: &tempfile::TempDir, name: &str) -> SigningKey {
        let files = make_keys(&folder.path().join(name)).expect("made");
        SigningKey::load(&files.private).expect("read")
    }

    fn manifest(sha256: &str) -> Manifest {
        let bundle = BundleCheck {
            sha256: sha256.to_owned(),
            bytes: 1024,
        };
        Manifest::new(
            7,
            Timestamp::UNIX_EPOCH,
            8,
            bundle,
            "both doors\nof \"car 2\"",
            PartNumbers::default(),
        )
    }

    #[test]
    fn a_signed_manifest_comes_back_and_no_changed_byte_is_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let key = key(&folder, "a");
        let manifest = manifest(&"0f".repeat(32));
        let text = manifest.signed(&key);
        let read = |bytes: &[u8]| Manifest::verified("7.txt", bytes, key.trusted());
        assert_eq!(read(text.as_bytes()).expect("signed"), manifest);
        for at in 0..text.len() {
            let mut changed = text.clone().into_bytes();
            changed[at] ^= 1;
            assert!(read(&changed).is_err(), "byte {at}");
            assert!(read(&text.as_bytes()[..at]).is_err(), "cut at {at}");
        }
        assert!(read(format!("{text}\n").as_bytes()).is_err());
    }

    #[test]
    fn another_key_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mine, other) = (key(&folder, "a"), key(&folder, "b"));
        let text = manifest(&"0f".repeat(32)).signed(&other);
        let error = Manifest::verified("7.txt", text.as_bytes(), mine.trusted());
        let error = error.expect_err("another key");
        let BundleError::OtherKey { found, trusted, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!((*found, *trusted), (other.trusted(), mine.trusted()));
        // With the right key's name over it, the signature is still the other's.
        let [theirs, ours] = [&other, &mine].map(|key| key.trusted().to_base64());
        let claimed = text.replace(&theirs, &ours);
        let error = Manifest::verified("7.txt", claimed.as_bytes(), mine.trusted());
        assert!(matches!(error, Err(BundleError::BadManifest { .. })));
        let (shown, key) = Manifest::of_any_key("7.txt", text.as_bytes()).expect("signed");
        assert_eq!((shown.version, key), (7, other.trusted()));
        let error = Manifest::of_any_key("7.txt", claimed.as_bytes());
        assert!(matches!(error, Err(BundleError::BadManifest { .. })));
    }

    #[test]
    fn a_newer_format_and_a_path_in_place_of_a_digest_are_refused_though_signed() {
        let folder = tempfile::tempdir().expect("a folder");
        let key = key(&folder, "a");
        let read = |manifest: &Manifest| {
            let text = manifest.signed(&key);
            Manifest::verified("7.txt", text.as_bytes(), key.trusted()).expect_err("refused")
        };
        let newer = Manifest {
            schema: SCHEMA + 1,
            ..manifest(&"0f".repeat(32))
        };
        assert!(matches!(
            read(&newer),
            BundleError::File(files::FileError::Newer { .. })
        ));
        for sha256 in ["", "../../secret", &"0F".repeat(32)] {
            let error = read(&manifest(sha256));
            assert!(matches!(error, BundleError::BadManifest { .. }), "{error}");
        }
    }
}
