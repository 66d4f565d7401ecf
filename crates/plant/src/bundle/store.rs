//! Where versions are kept: a folder, or a bucket of an S3-compatible store.

use std::{
    fmt,
    path::{Path as FilePath, PathBuf},
    str::FromStr,
    time::Duration,
};

use hyper::Uri;
use object_store::{
    BackoffConfig, GetOptions, ObjectStore, PutMode, PutOptions, PutPayload, RetryConfig,
    aws::{AmazonS3Builder, AmazonS3ConfigKey},
    local::LocalFileSystem,
    path::Path,
};
use tokio::{
    runtime::{self, Runtime},
    time::timeout,
};

use super::{
    connector::{Connector, patience},
    error::BundleError,
    manifest,
    store_error::StoreError,
};

/// Digits of a version in the name of its manifest.
const DIGITS: usize = 10;
/// The object that shows whether a store refuses to overwrite. Its content does not matter.
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
        (None, Some((_, rest))) => format!("…@{rest}"),
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
        let objects = objects.map_err(|source| BundleError::Store {
            store: address.to_string(),
            doing: "cannot be used",
            source: Box::new(source),
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
        Ok(self.versions()?.into_iter().max())
    }

    /// The numbers of all versions, in no order.
    pub(super) fn versions(&self) -> Result<Vec<u32>, BundleError> {
        let folder = self.prefix.clone().join("manifests");
        let listed = self.run(patience(0), self.objects.list_with_delimiter(Some(&folder)));
        let listed = match listed {
            // Of a store that is a folder, nothing was published yet.
            Err(object_store::Error::NotFound { .. }) => return Ok(Vec::new()),
            listed => listed.map_err(|error| self.wrong("cannot list the versions", &error))?,
        };
        let names = listed
            .objects
            .iter()
            .filter_map(|found| found.location.filename());
        Ok(names.filter_map(version_of).collect())
    }

    /// The manifest of a version, as it lies there; none if there is no such version.
    pub(super) fn manifest(&self, version: u32) -> Result<Option<Vec<u8>>, BundleError> {
        self.get(&manifest_name(version), manifest::MAX_BYTES)
    }

    /// Writes the manifest of a version; false if there is another one.
    pub(super) fn put_manifest(&self, version: u32, text: &str) -> Result<bool, BundleError> {
        let bytes = text.as_bytes().to_vec();
        let error = match self.put(&manifest_name(version), bytes, PutMode::Create) {
            Ok(()) => return Ok(true),
            Err(error) => error,
        };
        // The answer to a write may be lost, and if the client writes again, it finds what it has written itself.
        let found = self.manifest(version).ok().flatten();
        if found.as_deref() == Some(text.as_bytes()) {
            return Ok(true);
        }
        match error {
            object_store::Error::AlreadyExists { .. }
            | object_store::Error::Precondition { .. } => Ok(false),
            error => Err(self.wrong("cannot write the manifest", &error)),
        }
    }

    /// Reads a bundle of at most `limit` bytes; `None` if there is none of this name.
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
                store: self.address.to_string(),
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
            store: self.address.to_string(),
            doing,
            source: Box::new(StoreError::from_object_store(error)),
        }
    }
}

fn folder(path: &FilePath) -> Result<Box<dyn ObjectStore>, StoreError> {
    let folder = LocalFileSystem::new_with_prefix(path);
    let folder = folder.map_err(|error| StoreError::from_object_store(&error))?;
    Ok(Box::new(folder.with_fsync(true)))
}

fn s3(bucket: &str) -> Result<Box<dyn ObjectStore>, StoreError> {
    // A person waits: with the defaults it would be three minutes until a store counts as unreachable.
    let retry = RetryConfig {
        backoff: BackoffConfig::default(),
        max_retries: 2,
        retry_timeout: Duration::from_secs(20),
    };
    let builder = AmazonS3Builder::from_env();
    check_settings(&|key| builder.get_config_value(&key))?;
    let store = builder
        .with_bucket_name(bucket)
        .with_retry(retry)
        .with_http_connector(Connector)
        .build();
    Ok(Box::new(
        store.map_err(|error| StoreError::from_object_store(&error))?,
    ))
}

/// Checks the environment variables: the client panics on bad ones, or puts them unchanged into every address and header.
fn check_settings(
    value_of: &dyn Fn(AmazonS3ConfigKey) -> Option<String>,
) -> Result<(), StoreError> {
    let wrong = |name, problem: String| Err(StoreError::Setting { name, problem });
    for (key, name) in [
        (AmazonS3ConfigKey::Endpoint, "AWS_ENDPOINT"),
        (AmazonS3ConfigKey::S3Endpoint, "AWS_ENDPOINT_URL_S3"),
    ] {
        if let Some(endpoint) = value_of(key).filter(|endpoint| !is_endpoint(endpoint)) {
            let shown = without_secrets(&endpoint);
            return wrong(name, format!("is {shown:?}, expected https://HOST[:PORT]"));
        }
    }
    let region = value_of(AmazonS3ConfigKey::Region).unwrap_or_default();
    if !(region.bytes()).all(|c| c.is_ascii_alphanumeric() || c == b'-') {
        let problem = format!("is {region:?}, expected a region such as us-east-1");
        return wrong("AWS_REGION", problem);
    }
    let (key_id, secret) = ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY");
    let credentials = [
        (key_id, value_of(AmazonS3ConfigKey::AccessKeyId)),
        (secret, value_of(AmazonS3ConfigKey::SecretAccessKey)),
        ("AWS_SESSION_TOKEN", value_of(AmazonS3ConfigKey::Token)),
    ];
    for (name, value) in &credentials {
        let is_odd = |c: u8| !c.is_ascii_graphic();
        if value
            .as_ref()
            .is_some_and(|value| value.bytes().any(is_odd))
        {
            let problem = "has a blank or another character that no credentials have";
            return wrong(*name, problem.into());
        }
    }
    match credentials.map(|(_, value)| value.is_some()) {
        [true, false, _] => wrong(secret, format!("is missing, though {key_id} is set")),
        [false, true, _] => wrong(key_id, format!("is missing, though {secret} is set")),
        _ => Ok(()),
    }
}

/// True for http or https, a host, and at most a path.
fn is_endpoint(text: &str) -> bool {
    let Ok(uri) = text.parse::<Uri>() else {
        return false;
    };
    let is_web = matches!(uri.scheme_str(), Some("http" | "https"));
    let has_host = uri.host().is_some_and(|host| !host.is_empty());
    is_web && has_host && !text.contains('@') && uri.query().is_none()
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
    use geometry::error::Advice as _;

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
        assert!(store.put_manifest(1, "first").expect("written"));
        assert!(!store.put_manifest(1, "second").expect("refused"));
        // As after an answer that was lost.
        assert!(store.put_manifest(1, "first").expect("there"));
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
    fn what_the_environment_says_is_checked_before_it_is_used() {
        use AmazonS3ConfigKey::{AccessKeyId, Endpoint, Region, SecretAccessKey};
        let checked = |settings: &[(AmazonS3ConfigKey, &str)]| {
            check_settings(&|key| {
                let found = settings.iter().find(|(name, _)| *name == key);
                found.map(|(_, value)| (*value).to_owned())
            })
        };
        assert_eq!(checked(&[]), Ok(()));
        let sound = [
            (Endpoint, "https://minio.plant.example:9000"),
            (Region, "eu-central-1"),
            (AccessKeyId, "cell"),
            (SecretAccessKey, "a/b+c="),
        ];
        assert_eq!(checked(&sound), Ok(()));
        for (settings, words) in [
            (
                &[(Endpoint, "minio:9000")][..],
                "AWS_ENDPOINT is \"minio:9000\", expected https://",
            ),
            (&[(Endpoint, "")][..], "AWS_ENDPOINT is \"\""),
            (&[(Endpoint, "ftp://minio")][..], "AWS_ENDPOINT is"),
            (&[(Endpoint, "cell:hidden@minio")][..], "AWS_ENDPOINT is"),
            (
                &[(Endpoint, "https://cell:hidden@minio")][..],
                "AWS_ENDPOINT is",
            ),
            (&[(Region, "eu west")][..], "AWS_REGION is \"eu west\""),
            (
                &[(AccessKeyId, "cell")][..],
                "AWS_SECRET_ACCESS_KEY is missing",
            ),
            (
                &[(SecretAccessKey, "hidden")][..],
                "AWS_ACCESS_KEY_ID is missing",
            ),
            (
                &[(AccessKeyId, "cell"), (SecretAccessKey, "hidden\n")][..],
                "AWS_SECRET_ACCESS_KEY has a blank",
            ),
        ] {
            let error = checked(settings).expect_err(words);
            let text = format!("{error}; {}", error.advice());
            assert!(
                text.starts_with(words) && text.contains("Correct AWS_"),
                "{text}"
            );
            assert!(!text.contains("hidden"), "{text}");
        }
    }

    #[test]
    fn a_folder_that_is_not_mounted_is_an_error_and_not_made() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("share");
        let error = BundleStore::open(StoreAddress::Folder(missing.clone()));
        let error = error.err().expect("not there");
        let expected = format!(
            "{}: cannot be used: the folder does not exist",
            missing.display()
        );
        assert_eq!(error.to_string(), expected);
        assert!(error.advice().contains("share is connected"));
        assert!(!missing.exists());
    }
}
