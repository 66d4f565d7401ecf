//! Opening any file: find it, recognise its content, hand it to its reader.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::error::FileError;
use super::import::ImportOptions;
use super::source::{Source, read_bytes};
use super::{depth_png, gltf, obj, pcd, ply, stl, xyz};
use crate::error::{Advice, guarded};
use crate::geometry::cloud::PointCloud;
use crate::geometry::depth_frame::DepthFrame;
use crate::geometry::mesh::TriangleMesh;
use crate::geometry::pinhole_fit::fit_pinhole;
use crate::units::Metres;

/// What a file held.
#[derive(Clone, Debug, PartialEq)]
pub enum FileContent {
    /// Points, in the camera's space unless the file's maker meant otherwise. At least one is finite.
    Cloud(PointCloud),
    /// A surface with at least one triangle.
    Mesh(TriangleMesh),
    /// A depth image with its camera. At least one pixel is a reading.
    Depth(DepthFrame),
}

/// Something odd about a file that could be read nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FileWarning {
    /// The numbers, taken as metres, span more than any spray cell.
    #[error("the points span {:.0} m, so the file may be in millimetres", extent.0)]
    TooWideForMetres {
        /// The longest side of the box around the points.
        extent: Metres,
    },
    /// The file has more in it than its header says.
    #[error("{num} bytes follow the last point, so the file is probably damaged")]
    SurplusBytes {
        /// Bytes behind the last point.
        num: u64,
    },
    /// Points that a camera at the origin cannot see.
    #[error("{:.1} % of the points lie behind the camera, so they are probably in another frame", share * 100.0)]
    BehindCamera {
        /// Share of the points, 0..1.
        share: f64,
    },
    /// Rows and columns that are no picture.
    #[error(
        "its rows and columns are not the picture of a camera without distortion at the origin"
    )]
    NoPinholeCamera,
}

impl Advice for FileWarning {
    fn advice(&self) -> String {
        match self {
            Self::TooWideForMetres { .. } => "Read it as millimetres: --units mm, or #units=mm behind its path".into(),
            Self::SurplusBytes { .. } => {
                "Copy or export the file again from the program that made it".into()
            }
            Self::BehindCamera { .. } | Self::NoPinholeCamera => {
                "For an inspection export the capture in the camera's own frame, x right, y down, z forward, with its distortion removed"
                    .into()
            }
        }
    }
}

/// Extents from here on, in metres, are warned about: a mirror of 0.1 m reads so in millimetres, and no cell is as wide.
const SUSPICIOUS_EXTENT: f64 = 100.0;

/// Of an organised cloud with fewer readings nothing is said: no camera can be fitted to a few.
const MIN_READINGS: usize = 1000;

fn warnings_of(cloud: &PointCloud) -> impl Iterator<Item = FileWarning> {
    let num = cloud.surplus_bytes;
    let surplus = (num > 0).then_some(FileWarning::SurplusBytes { num });
    // Only a picture is for sure in a camera's space; other clouds may be in any, and are when they are enrolled.
    let share = cloud.grid.map_or(0.0, |_| cloud.share_behind());
    let behind = (share > 0.0).then_some(FileWarning::BehindCamera { share });
    let is_no_picture = cloud.grid.is_some_and(|grid| {
        cloud.num_finite() >= MIN_READINGS && fit_pinhole(&cloud.points, grid).is_none()
    });
    let no_camera = (behind.is_none() && is_no_picture).then_some(FileWarning::NoPinholeCamera);
    surplus.into_iter().chain(behind).chain(no_camera)
}

impl FileContent {
    /// True if the file says that no camera read what it holds.
    pub fn is_simulated(&self) -> bool {
        match self {
            Self::Cloud(cloud) => cloud.is_simulated,
            Self::Depth(frame) => frame.is_simulated,
            Self::Mesh(_) => false,
        }
    }

    /// What is odd about the content; empty when nothing is. The numbers themselves are never changed.
    pub fn warnings(&self) -> Vec<FileWarning> {
        let bounds = match self {
            Self::Cloud(cloud) => cloud.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Depth(_) => None,
        };
        let extent = bounds.map_or(0.0, |(low, high)| f64::from((high - low).amax()));
        let mut warnings = Vec::new();
        if extent >= SUSPICIOUS_EXTENT {
            let extent = Metres(extent);
            warnings.push(FileWarning::TooWideForMetres { extent });
        }
        if let Self::Cloud(cloud) = self {
            warnings.extend(warnings_of(cloud));
        }
        warnings
    }
}

/// Reads the file at `path`, whose format is told by its content, never by its name.
///
/// One mesh of a glTF or GLB file is chosen by `#` and its name after the path: `car.gltf#Door_FL`. In the same way
/// [`ImportOptions`] say how the numbers of a cloud or a mesh are meant: `door.stl#units=mm#up=z`. A file whose own name has
/// a `#` in it is found first.
pub fn open(path: &Path) -> Result<FileContent, FileError> {
    let (file, words) = split_words(path);
    let mut options = ImportOptions::default();
    let mut mesh_name: Option<String> = None;
    for word in words.iter().flat_map(|words| words.split('#')) {
        let is_option = options.take(word).map_err(|bad| FileError::ImportOption {
            path: file.clone(),
            bad,
        })?;
        if !is_option {
            // A name may have a # in it.
            mesh_name = Some(mesh_name.map_or_else(|| word.to_owned(), |name| name + "#" + word));
        }
    }
    let bytes = read_bytes(&file)?;
    let content = read(&file, &bytes, mesh_name.as_deref())?;
    Ok(options.applied(content))
}

/// As [`open`], for bytes that are in memory already; `path` is for the errors about them, and where a depth image's
/// camera is looked for.
pub fn open_bytes(path: &Path, bytes: &[u8]) -> Result<FileContent, FileError> {
    read(path, bytes, None)
}

fn read(path: &Path, bytes: &[u8], mesh_name: Option<&str>) -> Result<FileContent, FileError> {
    guarded(|| read_known(Source { path, bytes }, mesh_name)).unwrap_or_else(|fault| {
        Err(FileError::Fault {
            path: path.to_owned(),
            fault,
        })
    })
}

fn read_known(source: Source<'_>, mesh_name: Option<&str>) -> Result<FileContent, FileError> {
    let format = recognise(source)?;
    if let (Some(wanted), false) = (mesh_name, matches!(format, Format::Gltf)) {
        return Err(FileError::NoSuchMesh {
            path: source.path.to_owned(),
            wanted: wanted.to_owned(),
            available: Vec::new(),
        });
    }
    match format {
        Format::Pcd => pcd::read(source).map(FileContent::Cloud),
        Format::Ply => ply::read(source),
        Format::Stl => stl::read(source).map(FileContent::Mesh),
        Format::Obj => obj::read(source),
        Format::Gltf => gltf::read(source, mesh_name).map(FileContent::Mesh),
        Format::DepthPng => depth_png::read(source).map(FileContent::Depth),
        Format::Xyz => xyz::read(source).map(FileContent::Cloud),
    }
}

/// The file that [`open`] reads at `path`, without the words behind it.
pub fn file_of(path: &Path) -> PathBuf {
    split_words(path).0
}

/// The file in `path` and the words behind it: the longest part before a `#` that is a file wins.
fn split_words(path: &Path) -> (PathBuf, Option<String>) {
    let whole = (path.to_owned(), None);
    if path.exists() {
        return whole;
    }
    // A name that is not Unicode cannot be split here; as a whole it still works.
    let Some(text) = path.to_str() else {
        return whole;
    };
    let mut splits = text.rmatch_indices('#').map(|(at, _)| text.split_at(at));
    splits
        .find(|(file, _)| Path::new(file).is_file())
        .map_or(whole, |(file, name)| {
            (file.into(), Some(name.trim_start_matches('#').to_owned()))
        })
}

enum Format {
    Pcd,
    Ply,
    Stl,
    Obj,
    Gltf,
    DepthPng,
    Xyz,
}

fn recognise(source: Source<'_>) -> Result<Format, FileError> {
    let bytes = source.bytes;
    if depth_png::is_png(bytes) {
        return Ok(Format::DepthPng);
    }
    if gltf::is_glb(bytes) {
        return Ok(Format::Gltf);
    }
    if ply::is_ply(bytes) {
        return Ok(Format::Ply);
    }
    // Before the text formats: many binary STL files begin with the word "solid" as well.
    if stl::is_binary(bytes) {
        return Ok(Format::Stl);
    }
    // Before the test for text: what follows the header of a PCD may be binary.
    if pcd::is_pcd(source) {
        return Ok(Format::Pcd);
    }
    if !is_text(bytes) {
        return Err(unknown_binary(source));
    }
    if stl::is_ascii(bytes) {
        return Ok(Format::Stl);
    }
    if gltf::is_json(bytes) {
        return Ok(Format::Gltf);
    }
    if depth_png::is_intrinsics(bytes) {
        return Err(FileError::IsIntrinsics {
            path: source.path.to_owned(),
            image: source.path.with_extension("png"),
        });
    }
    if obj::is_obj(source) {
        return Ok(Format::Obj);
    }
    if xyz::is_xyz(source) {
        return Ok(Format::Xyz);
    }
    let first = source
        .lines()
        .map(|(_, line)| line)
        .find(|line| !line.is_empty());
    Err(unknown(
        source,
        format!(
            "text that begins {:?}",
            beginning(&first.unwrap_or_default())
        ),
    ))
}

/// What a file is, for an error about one that should be something else.
pub(super) fn described(source: Source<'_>) -> String {
    let words = match recognise(source) {
        Ok(Format::Pcd) => "a PCD cloud",
        Ok(Format::Ply) => "a PLY",
        Ok(Format::Stl) => "an STL mesh",
        Ok(Format::Obj) => "an OBJ",
        Ok(Format::Gltf) => "a glTF",
        Ok(Format::DepthPng) => "a PNG",
        Ok(Format::Xyz) => "XYZ text",
        Err(FileError::UnknownFormat { found, .. }) => return found,
        Err(FileError::IsIntrinsics { .. }) => "the camera of a depth image",
        Err(_) => "something else",
    };
    words.into()
}

/// Text has no zero bytes; its beginning is enough to tell.
fn is_text(bytes: &[u8]) -> bool {
    !bytes.iter().take(4096).any(|&byte| byte == 0)
}

fn unknown_binary(source: Source<'_>) -> FileError {
    let Source { path, bytes } = source;
    // Nothing inside a cut binary STL tells what it is. The name may word the error, though not choose the reader.
    if path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("stl"))
    {
        return stl::wrong_length(source);
    }
    let known = [
        (b"\xff\xd8\xff".as_slice(), "a JPEG picture"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"%PDF", "a PDF"),
        (b"\xff\xfe", "text in UTF-16"),
        (b"\xfe\xff", "text in UTF-16"),
    ];
    let found = known.iter().find(|(magic, _)| bytes.starts_with(magic));
    let hex: Vec<String> = bytes
        .iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect();
    unknown(
        source,
        found.map_or_else(
            || format!("bytes that begin {}", hex.join(" ")),
            |(_, name)| (*name).into(),
        ),
    )
}

fn unknown(source: Source<'_>, found: String) -> FileError {
    FileError::UnknownFormat {
        path: source.path.to_owned(),
        found,
    }
}

fn beginning(line: &str) -> String {
    line.chars().take(40).collect()
}

#[cfg(test)]
mod tests;
