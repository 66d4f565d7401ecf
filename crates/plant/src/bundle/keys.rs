//! The key that signs versions of a library, and the one by which they are known: Ed25519, as PEM files. Those that OpenSSL
//! makes are read, too.

use std::{
    fmt,
    fs::File,
    path::{Path, PathBuf},
};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use ring::{
    rand::SystemRandom,
    signature::{ED25519, Ed25519KeyPair, KeyPair as _, UnparsedPublicKey},
};
use rustls::pki_types::{PrivatePkcs8KeyDer, SubjectPublicKeyInfoDer, pem::PemObject as _};

use super::{error::BundleError, sha256};
use files::{FileError, disk, read_limited, sync_folder};

/// A key in PEM has some hundred bytes.
const MAX_KEY_BYTES: u64 = 1 << 14;
/// The bytes before the 32 bytes of a public key in DER (RFC 8410).
const PUBLIC_KEY_PREFIX: [u8; 12] = [
    0x30, 0x2a, 0x30, 0x05, 0x06, 0x03, 0x2b, 0x65, 0x70, 0x03, 0x21, 0x00,
];
const PUBLIC_KEY_BYTES: usize = 32;
/// Letters of a line in PEM.
const PEM_LINE: usize = 64;

/// Signs versions of a library.
pub struct SigningKey(Ed25519KeyPair);

/// A public key: what it signed is taken.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TrustedKey([u8; PUBLIC_KEY_BYTES]);

/// Where a new pair of keys lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyFiles {
    /// To publish with. Only its owner can read it.
    pub private: PathBuf,
    /// For the cells.
    pub public: PathBuf,
}

/// Makes a pair of keys, `library.key` and `library.pub`, in a folder. Keys that are there are never replaced.
pub fn make_keys(folder: &Path) -> Result<KeyFiles, BundleError> {
    let files = KeyFiles {
        private: folder.join("library.key"),
        public: folder.join("library.pub"),
    };
    for path in [&files.private, &files.public] {
        if path.symlink_metadata().is_ok() {
            return Err(BundleError::KeyExists { path: path.clone() });
        }
    }
    let no_random = |_| BundleError::NoRandom;
    let document = Ed25519KeyPair::generate_pkcs8(&SystemRandom::new()).map_err(no_random)?;
    let pair = Ed25519KeyPair::from_pkcs8(document.as_ref())
        .map_err(|error| bad_key(&files.private, "private key", error))?;
    let public = [&PUBLIC_KEY_PREFIX[..], pair.public_key().as_ref()].concat();
    disk::create_dir_all(folder).map_err(|source| FileError::writing(folder, source))?;
    write_pair(
        &files,
        &pem("PRIVATE KEY", document.as_ref()),
        &pem("PUBLIC KEY", &public),
    )?;
    sync_folder(folder).map_err(|source| FileError::writing(folder, source))?;
    Ok(files)
}

/// Writes both keys, or none.
fn write_pair(files: &KeyFiles, private: &str, public: &str) -> Result<(), FileError> {
    write_new(&files.private, private, 0o600)?;
    write_new(&files.public, public, 0o644).inspect_err(|_| {
        // One key alone would stand in the way of the next try.
        let _ = disk::remove_file(&files.private);
    })
}

/// Writes a file that is not there yet.
fn write_new(path: &Path, text: &str, mode: u32) -> Result<(), FileError> {
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.mode(mode);
    }
    // Elsewhere a file has the access rights of its folder.
    #[cfg(not(unix))]
    let _ = mode;
    let wrong = |source| FileError::writing(path, source);
    let mut file = disk::open(&options, path).map_err(wrong)?;
    let written = disk::write_all(&mut file, text.as_bytes()).and_then(|()| disk::sync_all(&file));
    written.map_err(|source| {
        // Half a key would stand in the way of the next try.
        let _ = disk::remove_file(path);
        wrong(source)
    })
}

fn bad_key(path: &Path, what: &'static str, reason: impl fmt::Display) -> BundleError {
    BundleError::BadKey {
        path: path.to_owned(),
        what,
        reason: reason.to_string(),
    }
}

fn pem(label: &str, der: &[u8]) -> String {
    let text = STANDARD.encode(der);
    let mut lines = vec![format!("-----BEGIN {label}-----")];
    // Base64 is ASCII: every place in it is a border between characters.
    lines.extend((0..text.len()).step_by(PEM_LINE).map(|from| {
        let to = text.len().min(from + PEM_LINE);
        text[from..to].to_owned()
    }));
    lines.push(format!("-----END {label}-----\n"));
    lines.join("\n")
}

impl SigningKey {
    /// Of a file with a private key: PKCS#8 as PEM.
    pub fn load(path: &Path) -> Result<Self, BundleError> {
        let bytes = read_limited(path, MAX_KEY_BYTES)?;
        let der = PrivatePkcs8KeyDer::from_pem_slice(&bytes);
        let der = der.map_err(|error| bad_key(path, "private key", error))?;
        // Other programs leave the public key out, which is computed then.
        let pair = Ed25519KeyPair::from_pkcs8_maybe_unchecked(der.secret_pkcs8_der());
        pair.map(Self)
            .map_err(|error| bad_key(path, "private key", error))
    }

    /// The key by which its signatures are known.
    pub fn trusted(&self) -> TrustedKey {
        let bytes = self.0.public_key().as_ref();
        TrustedKey(bytes.try_into().expect("a public key has 32 bytes"))
    }

    pub(super) fn sign(&self, message: &[u8]) -> Vec<u8> {
        self.0.sign(message).as_ref().to_vec()
    }
}

impl TrustedKey {
    /// Of a file with a public key as PEM.
    pub fn load(path: &Path) -> Result<Self, BundleError> {
        let bytes = read_limited(path, MAX_KEY_BYTES)?;
        let der = SubjectPublicKeyInfoDer::from_pem_slice(&bytes);
        let der = der.map_err(|error| bad_key(path, "public key", error))?;
        let key = der.as_ref().strip_prefix(&PUBLIC_KEY_PREFIX);
        key.and_then(Self::of_bytes)
            .ok_or_else(|| bad_key(path, "public key", "not an Ed25519 key"))
    }

    pub(super) fn of_bytes(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self)
    }

    /// As it stands in a manifest and in a library.
    pub(super) fn to_base64(self) -> String {
        STANDARD.encode(self.0)
    }

    pub(super) fn is_signature(self, message: &[u8], signature: &[u8]) -> bool {
        let key = UnparsedPublicKey::new(&ED25519, self.0);
        key.verify(message, signature).is_ok()
    }
}

/// The first 16 digits of its SHA-256, for people.
impl fmt::Display for TrustedKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&sha256(&self.0)[..16])
    }
}

impl fmt::Debug for TrustedKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "TrustedKey({self})")
    }
}

#[cfg(test)]
mod tests {
    use std::{fs, process::Command};

    use super::*;

    #[test]
    fn a_new_key_signs_and_its_public_half_knows_the_signature() {
        let folder = tempfile::tempdir().expect("a folder");
        let files = make_keys(&folder.path().join("keys")).expect("made");
        let key = SigningKey::load(&files.private).expect("read");
        let trusted = TrustedKey::load(&files.public).expect("read");
        assert_eq!(key.trusted(), trusted);
        let mut signature = key.sign(b"version 7");
        assert!(trusted.is_signature(b"version 7", &signature));
        assert!(!trusted.is_signature(b"version 8", &signature));
        signature[5] ^= 1;
        assert!(!trusted.is_signature(b"version 7", &signature));
        assert!(!trusted.is_signature(b"version 7", &[]));
    }

    #[test]
    fn keys_are_never_replaced_and_others_cannot_read_the_private_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let files = make_keys(folder.path()).expect("made");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            let mode = fs::metadata(&files.private)
                .expect("there")
                .permissions()
                .mode();
            assert_eq!(mode & 0o777, 0o600);
        }
        let before = fs::read(&files.private).expect("read");
        let again = make_keys(folder.path()).expect_err("there");
        assert!(matches!(again, BundleError::KeyExists { .. }), "{again}");
        fs::remove_file(&files.public).expect("removed");
        let again = make_keys(folder.path()).expect_err("one of them is there");
        assert!(matches!(again, BundleError::KeyExists { .. }), "{again}");
        assert_eq!(fs::read(&files.private).expect("read"), before);
        assert!(!files.public.exists());
    }

    #[test]
    fn no_private_key_is_left_without_its_public_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let files = KeyFiles {
            private: folder.path().join("library.key"),
            public: folder.path().join("missing/library.pub"),
        };
        write_pair(&files, "private", "public").expect_err("no folder for the public key");
        assert!(!files.private.exists());
    }

    #[test]
    fn what_is_no_key_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let files = make_keys(folder.path()).expect("made");
        // Each where the other belongs, and text.
        let text = folder.path().join("text");
        fs::write(&text, "no key").expect("written");
        for path in [&files.public, &text] {
            let error = SigningKey::load(path).err().expect("refused");
            assert!(matches!(error, BundleError::BadKey { .. }), "{error}");
        }
        for path in [&files.private, &text] {
            let error = TrustedKey::load(path).expect_err("refused");
            assert!(matches!(error, BundleError::BadKey { .. }), "{error}");
        }
    }

    #[test]
    fn keys_of_openssl_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let openssl = |args: &[&str]| {
            let mut command = Command::new("openssl");
            let run = command.args(args).current_dir(folder.path()).output();
            run.is_ok_and(|output| output.status.success())
        };
        if !openssl(&["genpkey", "-algorithm", "ed25519", "-out", "a.key"]) {
            println!("skipped: openssl is not installed, or makes no Ed25519 keys");
            return;
        }
        assert!(openssl(&[
            "pkey", "-in", "a.key", "-pubout", "-out", "a.pub"
        ]));
        let key = SigningKey::load(&folder.path().join("a.key")).expect("read");
        let trusted = TrustedKey::load(&folder.path().join("a.pub")).expect("read");
        assert_eq!(key.trusted(), trusted);
        let made = make_keys(folder.path()).expect("made");
        assert!(openssl(&["pkey", "-pubin", "-in", "library.pub", "-noout"]));
        assert!(made.private.exists());
    }
}
