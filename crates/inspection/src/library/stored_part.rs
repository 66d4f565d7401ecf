//! Reads one stored part, and checks its files against each other.

use std::{
    borrow::Cow,
    fs,
    io::{self, Read as _},
    path::Path,
};

use super::{
    entry::{CLOUD, Entry, META, SIGNATURE, THUMBNAIL},
    part::{FileCheck, PartMeta, SCHEMA_VERSION, StoredSignature},
    problem::{EntryError, EntryIssue, EntryProblem, EntryWarning, MAX_POINTS},
    spray_path::{MAX_BYTES, SprayPath, SprayPathError},
    surface_zones::SurfaceZones,
};
use files::{
    FileContent, FileError, open_bytes, open_regular, parse_toml, read_bytes, read_picture,
    toml_problem,
};
use geometry::{cloud::PointCloud, nearest::KdTree, normals::estimate_normals, units::Metres};
use stages::reference::{Reference, ReferenceParams};

/// A stored part, read and prepared.
#[derive(Debug)]
pub struct StoredPart {
    /// Content of `part.toml`.
    pub meta: PartMeta,
    /// The prepared reference, with cloud and views.
    pub reference: Reference,
    /// Warnings about the part.
    pub warnings: Vec<EntryWarning>,
}

/// Maximum size of a `part.toml` or `signature.json`, bytes.
const MAX_TEXT_BYTES: u64 = 8 << 20;

/// How thoroughly a stored part is checked.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CloudCheckLevel {
    /// Only what an inspection needs.
    Quick,
    /// All files against each other.
    Thorough,
}

/// Reads a stored part; `former` is its reference as last loaded, which is taken if it would be prepared the same.
pub(super) fn read_entry(
    entry: &Entry,
    look: CloudCheckLevel,
    params: &ReferenceParams,
    former: Option<&Reference>,
) -> Result<StoredPart, EntryProblem> {
    let read = || -> Result<StoredPart, EntryError> {
        let meta = read_meta(entry)?;
        let cloud = read_cloud(entry, &meta.cloud)?;
        let part = meta.part_name().as_str();
        // The borders, which are found on first use, depend on the cut.
        let is_same = |former: &&Reference| {
            former.cut == meta.cut && former.is_prepared_from(&cloud, meta.coverage, params)
        };
        let mut reference = match former.filter(is_same) {
            Some(former) => former.clone(),
            None => Reference::prepare(part, cloud, meta.coverage, params)?.with_cut(meta.cut),
        };
        part.clone_into(&mut reference.name);
        meta.name.as_str().clone_into(&mut reference.enrolled_as);
        let mut issues = issues(entry, &reference, look, params);
        if look == CloudCheckLevel::Thorough
            && let Err(error) = read_spray_path(&entry.path, &meta)
        {
            let why = error.to_string();
            issues.push(EntryIssue::SprayPath { why });
        }
        let warnings = issues
            .into_iter()
            .map(|issue| EntryWarning {
                entry: entry.name.clone(),
                issue,
            })
            .collect();
        Ok(StoredPart {
            meta,
            reference,
            warnings,
        })
    };
    read().map_err(|reason| EntryProblem {
        entry: entry.name.clone(),
        path: entry.path.clone(),
        reason,
    })
}

/// Returns why a stored part cannot be loaded; `None` if it can.
pub(super) fn problem_of(entry: &Entry) -> Option<EntryProblem> {
    let params = ReferenceParams::default();
    read_entry(entry, CloudCheckLevel::Quick, &params, None).err()
}

/// Reads the `part.toml` of a stored part.
pub(super) fn meta_of(entry: &Entry) -> Result<PartMeta, EntryProblem> {
    read_meta(entry).map_err(|reason| EntryProblem {
        entry: entry.name.clone(),
        path: entry.path.clone(),
        reason,
    })
}

fn read_meta(entry: &Entry) -> Result<PartMeta, EntryError> {
    let text = meta_text(entry).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => EntryError::Missing { file: META },
        io::ErrorKind::InvalidData => EntryError::BadMeta {
            found: "it is not text".into(),
        },
        _ => EntryError::Unreadable { source },
    })?;
    let bad = |error: toml::de::Error| EntryError::BadMeta {
        found: toml_problem(&text, &error),
    };
    let meta: PartMeta = parse_toml(Path::new(META), &text, SCHEMA_VERSION, bad)?;
    if let Some(found) = meta.surface.as_ref().and_then(SurfaceZones::problem) {
        return Err(EntryError::BadMeta { found });
    }
    if meta.name.as_str() == entry.name {
        Ok(meta)
    } else {
        Err(EntryError::NameMismatch {
            folder: entry.name.clone(),
            name: meta.name,
        })
    }
}

fn meta_text(entry: &Entry) -> io::Result<String> {
    match entry.shipped_file(META) {
        Some(bytes) => String::from_utf8(bytes.to_vec()).map_err(io::Error::other),
        None => read_text(&entry.path.join(META)),
    }
}

fn read_text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    open_regular(path)?
        .take(MAX_TEXT_BYTES)
        .read_to_string(&mut text)?;
    Ok(text)
}

/// Reads the cloud and checks it against `part.toml`.
fn read_cloud(entry: &Entry, expected: &FileCheck) -> Result<PointCloud, EntryError> {
    let path = entry.path.join(CLOUD);
    let not_a_cloud = |found: &str| EntryError::NotACloud {
        found: found.to_owned(),
    };
    let bytes = match entry.shipped_file(CLOUD) {
        Some(bytes) => Ok(Cow::Borrowed(bytes)),
        None => read_bytes(&path).map(Cow::Owned),
    };
    let opened = bytes.and_then(|bytes| Ok((open_bytes(&path, &bytes)?, bytes)));
    let (opened, bytes) = match opened {
        Ok(opened) => opened,
        Err(FileError::NotFound { .. }) => return Err(EntryError::Missing { file: CLOUD }),
        Err(error) => return Err(EntryError::BadCloud(Box::new(error))),
    };
    let mut cloud = match opened {
        FileContent::Cloud(cloud) => cloud,
        FileContent::Mesh(_) => return Err(not_a_cloud("a mesh")),
        FileContent::Depth(_) => return Err(not_a_cloud("a depth image")),
    };
    let found = FileCheck::from_bytes(&bytes, cloud.points.len());
    cloud.points.shrink_to_fit();
    cloud.normals.iter_mut().for_each(Vec::shrink_to_fit);
    // No stage uses them.
    (cloud.colours, cloud.labels) = (None, None);
    if found != *expected {
        return Err(EntryError::ChangedCloud {
            found,
            expected: expected.clone(),
        });
    }
    if cloud.points.len() > MAX_POINTS {
        return Err(not_a_cloud(&format!("{} points", cloud.points.len())));
    }
    let is_unit = |n: &nalgebra::Vector3<f32>| (n.norm() - 1.0).abs() < 0.01;
    if !cloud
        .normals
        .as_ref()
        .is_some_and(|n| n.iter().all(is_unit))
    {
        // Written by another program: estimate normals as enrolling does.
        let tree = KdTree::new(&cloud.points);
        cloud.normals = Some(estimate_normals(
            &cloud.points,
            &tree,
            Metres::from_mm(24.0),
            &nalgebra::Point3::origin(),
        ));
    }
    Ok(cloud)
}

fn issues(
    entry: &Entry,
    reference: &Reference,
    look: CloudCheckLevel,
    params: &ReferenceParams,
) -> Vec<EntryIssue> {
    let mut issues = Vec::new();
    if entry.shipped.is_some() {
        return issues;
    }
    if !entry.path.ends_with(&entry.name) {
        issues.push(EntryIssue::LeftAside);
    }
    for file in [SIGNATURE, THUMBNAIL] {
        if !fs::exists(entry.path.join(file)).unwrap_or(false) {
            issues.push(EntryIssue::Missing { file });
        } else if look == CloudCheckLevel::Thorough
            && !belongs(&entry.path.join(file), reference, params)
        {
            issues.push(EntryIssue::Stale { file });
        }
    }
    issues
}

/// Returns whether a file derived from the cloud is intact and matches it.
fn belongs(file: &Path, reference: &Reference, params: &ReferenceParams) -> bool {
    if file.ends_with(THUMBNAIL) {
        return read_picture(file).is_ok();
    }
    let stored = read_text(file)
        .ok()
        .and_then(|text| serde_json::from_str::<StoredSignature>(&text).ok());
    let made = StoredSignature::of(reference, params);
    matches!((stored, made), (Some(stored), Some(made)) if stored.agrees_with(&made))
}

/// Reads the spray path in a part's folder, and checks it against `part.toml`.
pub(super) fn read_spray_path(
    folder: &Path,
    meta: &PartMeta,
) -> Result<Option<SprayPath>, SprayPathError> {
    let Some(expected) = &meta.spray else {
        return Ok(None);
    };
    let changed = |file: &Path, found: String| SprayPathError::Changed {
        path: file.to_owned(),
        found,
        expected: expected.crc32.clone(),
    };
    let Some(file_name) = expected.spray_file_name() else {
        return Err(changed(folder, "missing".into()));
    };
    let file = folder.join(file_name);
    let text = files::read_text(&file, MAX_BYTES)?;
    let path = SprayPath::parse(&text, &file);
    let num_points = path.as_ref().map_or(0, |path| path.points().len());
    let found = FileCheck::from_bytes(text.as_bytes(), num_points);
    if found != *expected {
        return Err(changed(&file, found.crc32));
    }
    path.map(Some)
}
