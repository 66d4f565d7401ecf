//! Where versions are kept: a folder, or a bucket of an S3-compatible store.

use std::{
    fmt,
    path::{Path as FilePath, PathBuf},
    str::FromStr,
    time::Duration,
};

use object_store::{
    BackoffConfig, GetOptions, ObjectStore, PutMode, PutOptions, PutPayload, RetryConfig,
    aws::AmazonS3Builder, local::LocalFileSystem, path::Path,
};
use tokio::{
    runtime::{self, Runtime},
    time::timeout,
};

use super::{
    connector::{Connector, patience},
    error::BundleError,
    manifest,
};

/// Digits of a version in the name of its manifest.
const DIGITS: usize = 10;
/// The object that tells whether a store keeps what is there. What is in it does not matter.
const PROBE: &str = "if-none-match";

/// Which store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StoreAddress {
    /// A folder of this computer, or of a share that is mounted there.
    Folder(PathBuf),
    /// A bucket; its endpoint, region and credentials come from the environment.
    S3 {
        /// Its name.
        bucket: String,
        /// What the names of all objects begin with, without a slash at either end; may be empty.
        prefix: String,
    },
}

impl FromStr for StoreAddress {
    type Err = BundleError;

    fn from_str(text: &str) -> Result<Self, BundleError> {
        let bad = |reason| BundleError::BadAddress {
            address: without_secrets(text),
            reason,
        };
        if text.contains("://") && text.contains('@') {
            return Err(bad("credentials come from the environment"));
        }
        let Some(rest) = text.strip_prefix("s3://") else {
            return match text {
                "" => Err(bad("it is empty")),
                text if text.contains("://") => Err(bad("only s3:// is known, beside folders")),
                folder => Ok(Self::Folder(folder.into())),
            };
        };
        let (bucket, prefix) = rest.split_once('/').unwrap_or((rest, ""));
        let is_allowed = |c: u8| matches!(c, b'a'..=b'z' | b'0'..=b'9' | b'.' | b'-');
        if !(3..=63).contains(&bucket.len()) || !bucket.bytes().all(is_allowed) {
            return Err(bad(
                "a bucket has 3 to 63 lowercase letters, digits, points and dashes",
            ));
        }
        let prefix = prefix.trim_end_matches('/');
        let is_sound =
            prefix.is_empty() || Path::parse(prefix).is_ok_and(|path| path.to_string() == prefix);
        if !is_sound {
            return Err(bad("the prefix is no path"));
        }
        Ok(Self::S3 {
            bucket: bucket.to_owned(),
            prefix: prefix.to_owned(),
        })
    }
}

/// An address for a message: a password may stand before the `@`.
fn without_secrets(text: &str) -> String {
    match (text.split_once("://"), text.rsplit_once('@')) {
        (Some((scheme, _)), Some((_, rest))) => format!("{scheme}://…@{rest}"),
        _ => text.to_owned(),
    }
}

impl fmt::Display for StoreAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder(path) => path.display().fmt(f),
            Self::S3 { bucket, prefix } if prefix.is_empty() => write!(f, "s3://{bucket}"),
            Self::S3 { bucket, prefix } => write!(f, "s3://{bucket}/{prefix}"),
        }
    }
}

/// A store that can be asked.
pub struct BundleStore {
    address: StoreAddress,
    prefix: Path,
    objects: Box<dyn ObjectStore>,
    runtime: Runtime,
}

impl BundleStore {
    /// Prepares the connection. A folder has to be there: in place of one that is not mounted, nothing is made.
    pub fn open(address: StoreAddress) -> Result<Self, BundleError> {
        let runtime = runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|source| BundleError::NoRuntime { source })?;
        let (objects, prefix) = match &address {
            StoreAddress::Folder(path) => (folder(path), Path::default()),
            StoreAddress::S3 { bucket, prefix } => (s3(bucket), Path::from(prefix.as_str())),
        };
        let objects = objects.map_err(|error| BundleError::Store {
            store: address.clone(),
            doing: "cannot be used",
            reason: reason_of(&error),
        })?;
        Ok(Self {
            address,
            prefix,
            objects,
            runtime,
        })
    }

    /// Which it is.
    pub fn address(&self) -> &StoreAddress {
        &self.address
    }

    /// The number of the newest version; none where nothing was published.
    pub(super) fn newest(&self) -> Result<Option<u32>, BundleError> {
        let folder = self.prefix.clone().join("manifests");
        let listed = self.run(patience(0), self.objects.list_with_delimiter(Some(&folder)));
        let listed = match listed {
            // Of a store that is a folder, nothing was published yet.
            Err(object_store::Error::NotFound { .. }) => return Ok(None),
            listed => listed.map_err(|error| self.wrong("cannot list the versions", &error))?,
        };
        let names = listed
            .objects
            .iter()
            .filter_map(|found| found.location.filename());
        Ok(names.filter_map(version_of).max())
    }

    /// The manifest of a version, as it lies there; none if there is no such version.
    pub(super) fn manifest(&self, version: u32) -> Result<Option<Vec<u8>>, BundleError> {
        self.get(&manifest_name(version), manifest::MAX_BYTES)
    }

    /// Writes the manifest of a version, unless there is one; then false.
    pub(super) fn put_manifest(&self, version: u32, text: String) -> Result<bool, BundleError> {
        match self.put(&manifest_name(version), text.into_bytes(), PutMode::Create) {
            Ok(()) => Ok(true),
            Err(
                object_store::Error::AlreadyExists { .. }
                | object_store::Error::Precondition { .. },
            ) => Ok(false),
            Err(error) => Err(self.wrong("cannot write the manifest", &error)),
        }
    }

    /// A bundle of so many bytes; none if there is none of this name, and never more than `limit` bytes.
    pub(super) fn bundle(&self, sha256: &str, limit: u64) -> Result<Option<Vec<u8>>, BundleError> {
        self.get(&bundle_name(sha256), limit)
    }

    /// Writes a bundle. One of the same name has the same bytes.
    pub(super) fn put_bundle(&self, sha256: &str, bytes: Vec<u8>) -> Result<(), BundleError> {
        self.put(&bundle_name(sha256), bytes, PutMode::Overwrite)
            .map_err(|error| self.wrong("cannot write the bundle", &error))
    }

    /// An error if the store writes over what is there, though it is asked not to: some ignore the question, and two
    /// publishers would both believe that the version is theirs.
    pub(super) fn check_conditional_put(&self) -> Result<(), BundleError> {
        let wrong = |error| self.wrong("cannot be written to", &error);
        let content = || b"for a test of the store".to_vec();
        self.put(PROBE, content(), PutMode::Overwrite)
            .map_err(wrong)?;
        match self.put(PROBE, content(), PutMode::Create) {
            Err(
                object_store::Error::AlreadyExists { .. }
                | object_store::Error::Precondition { .. },
            ) => Ok(()),
            Err(error) => Err(wrong(error)),
            Ok(()) => Err(BundleError::NoConditionalPut {
                store: self.address.clone(),
            }),
        }
    }

    /// How errors about an object of this name begin.
    pub(super) fn shown(&self, name: &str) -> String {
        format!("{}/{name}", self.address)
    }

    fn get(&self, name: &str, limit: u64) -> Result<Option<Vec<u8>>, BundleError> {
        let wrong = |error| self.wrong("cannot be read", &error);
        let location = self.location(name);
        let got = self.objects.get_opts(&location, GetOptions::default());
        let got = match self.run(patience(0), got) {
            Err(object_store::Error::NotFound { .. }) => return Ok(None),
            got => got.map_err(wrong)?,
        };
        let found = got.meta.size;
        if found > limit {
            return Err(BundleError::TooLarge { found, limit });
        }
        let bytes = self.run(patience(found), got.bytes()).map_err(wrong)?;
        Ok(Some(bytes.to_vec()))
    }

    fn put(&self, name: &str, bytes: Vec<u8>, mode: PutMode) -> object_store::Result<()> {
        let location = self.location(name);
        // The client itself limits each of its tries.
        let patience = 4 * patience(bytes.len() as u64);
        let payload = PutPayload::from(bytes);
        let put = (self.objects).put_opts(&location, payload, PutOptions::from(mode));
        self.run(patience, put).map(|_| ())
    }

    /// Waits for an answer, and not for ever.
    fn run<T>(
        &self,
        patience: Duration,
        work: impl Future<Output = object_store::Result<T>>,
    ) -> object_store::Result<T> {
        let answered = self
            .runtime
            .block_on(async { timeout(patience, work).await });
        answered.unwrap_or_else(|late| {
            Err(object_store::Error::Generic {
                store: "store",
                source: Box::new(late),
            })
        })
    }

    fn location(&self, name: &str) -> Path {
        let names = name.split('/');
        names.fold(self.prefix.clone(), Path::join)
    }

    fn wrong(&self, doing: &'static str, error: &object_store::Error) -> BundleError {
        BundleError::Store {
            store: self.address.clone(),
            doing,
            reason: reason_of(error),
        }
    }
}

fn folder(path: &FilePath) -> object_store::Result<Box<dyn ObjectStore>> {
    let folder = LocalFileSystem::new_with_prefix(path)?.with_fsync(true);
    Ok(Box::new(folder))
}

fn s3(bucket: &str) -> object_store::Result<Box<dyn ObjectStore>> {
    // A person waits: with the defaults it would be three minutes until a store counts as unreachable.
    let retry = RetryConfig {
        backoff: BackoffConfig::default(),
        max_retries: 2,
        retry_timeout: Duration::from_secs(20),
    };
    let store = AmazonS3Builder::from_env()
        .with_bucket_name(bucket)
        .with_retry(retry)
        .with_http_connector(Connector)
        .build()?;
    Ok(Box::new(store))
}

/// The words of the client on one line, without the XML that stores answer with.
fn reason_of(error: &object_store::Error) -> String {
    let words = error.to_string();
    let words = words.split("<?xml").next().unwrap_or_default();
    let words: Vec<&str> = words.split_whitespace().collect();
    words.join(" ").trim_end_matches([':', ' ']).to_owned()
}

pub(super) fn manifest_name(version: u32) -> String {
    format!("manifests/{version:0DIGITS$}.txt")
}

pub(super) fn bundle_name(sha256: &str) -> String {
    format!("bundles/{sha256}.tar")
}

/// The version of a manifest of this name; `None` if it is no manifest's.
fn version_of(name: &str) -> Option<u32> {
    let digits = name.strip_suffix(".txt")?;
    let is_number = digits.len() == DIGITS && digits.bytes().all(|c| c.is_ascii_digit());
    let version = digits.parse().ok().filter(|_| is_number)?;
    (version > 0).then_some(version)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_folders_or_buckets() {
        for (text, shown) in [
            ("/mnt/share/library", "/mnt/share/library"),
            ("library", "library"),
            ("s3://parts", "s3://parts"),
            ("s3://parts/", "s3://parts"),
            ("s3://parts/hall-3/doors/", "s3://parts/hall-3/doors"),
        ] {
            let address: StoreAddress = text.parse().expect(text);
            assert_eq!(address.to_string(), shown);
        }
        for text in [
            "",
            "s3://",
            "s3://Parts/x",
            "s3://user:secret@parts",
            "s3://parts/a//b",
            "s3://parts/../x",
            "https://parts.example/x",
        ] {
            let error = text.parse::<StoreAddress>().expect_err(text);
            assert!(matches!(error, BundleError::BadAddress { .. }), "{error}");
            assert!(!error.to_string().contains("secret"), "{error}");
        }
    }

    #[test]
    fn a_version_is_known_by_the_name_of_its_manifest() {
        for version in [1, 42, u32::MAX] {
            let name = manifest_name(version);
            let name = name.strip_prefix("manifests/").expect("its folder");
            assert_eq!(version_of(name), Some(version));
        }
        for name in [
            "1.txt",
            "0000000000.txt",
            "9999999999.txt",
            "+000000001.txt",
            "0000000001.tmp",
        ] {
            assert_eq!(version_of(name), None, "{name}");
        }
    }

    #[test]
    fn what_is_there_is_not_written_over_and_more_than_expected_is_not_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = BundleStore::open(StoreAddress::Folder(folder.path().to_owned()));
        let store = store.expect("opened");
        assert_eq!(store.newest().expect("listed"), None);
        store
            .check_conditional_put()
            .expect("a folder keeps what is there");
        assert!(store.put_manifest(1, "first".into()).expect("written"));
        assert!(!store.put_manifest(1, "second".into()).expect("refused"));
        assert_eq!(
            store.manifest(1).expect("read").as_deref(),
            Some(&b"first"[..])
        );
        assert_eq!(store.manifest(2).expect("asked"), None);
        assert_eq!(store.newest().expect("listed"), Some(1));
        store.put_bundle("ab", vec![7; 100]).expect("written");
        let too_large = store.bundle("ab", 99).expect_err("too large");
        assert!(matches!(
            too_large,
            BundleError::TooLarge {
                found: 100,
                limit: 99
            }
        ));
    }

    #[test]
    fn a_folder_that_is_not_mounted_is_an_error_and_not_made() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("share");
        let error = BundleStore::open(StoreAddress::Folder(missing.clone()));
        let error = error.err().expect("not there");
        assert!(matches!(error, BundleError::Store { .. }), "{error}");
        assert!(!missing.exists());
    }
}
