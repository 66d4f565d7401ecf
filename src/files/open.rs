//! Opening any file: find it, recognise its content, hand it to its reader.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::error::FileError;
use super::source::{Source, read_bytes};
use super::{depth_png, gltf, obj, pcd, ply, stl, xyz};
use crate::error::Advice;
use crate::geometry::cloud::PointCloud;
use crate::geometry::depth_frame::DepthFrame;
use crate::geometry::mesh::TriangleMesh;
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
}

impl Advice for FileWarning {
    fn advice(&self) -> String {
        match self {
            Self::TooWideForMetres { .. } => "Export the file again with metres as its unit".into(),
        }
    }
}

/// Extents from here on, in metres, are warned about: a mirror of 0.1 m reads so in millimetres, and no cell is as wide.
const SUSPICIOUS_EXTENT: f64 = 100.0;

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
        (extent >= SUSPICIOUS_EXTENT)
            .then_some(FileWarning::TooWideForMetres {
                extent: Metres(extent),
            })
            .into_iter()
            .collect()
    }
}

/// Reads the file at `path`, whose format is told by its content, never by its name.
///
/// One mesh of a glTF or GLB file is chosen by `#` and its name after the path: `car.gltf#Door_FL`. A file whose own
/// name has a `#` in it is found first.
pub fn open(path: &Path) -> Result<FileContent, FileError> {
    let (file, mesh_name) = split_mesh_name(path);
    let bytes = read_bytes(&file)?;
    read(&file, &bytes, mesh_name.as_deref())
}

/// As [`open`], for bytes that are in memory already; `path` is for the errors about them, and where a depth image's
/// camera is looked for.
pub(crate) fn open_bytes(path: &Path, bytes: &[u8]) -> Result<FileContent, FileError> {
    read(path, bytes, None)
}

fn read(path: &Path, bytes: &[u8], mesh_name: Option<&str>) -> Result<FileContent, FileError> {
    let source = Source { path, bytes };
    let format = recognise(source)?;
    if let (Some(wanted), false) = (mesh_name, matches!(format, Format::Gltf)) {
        return Err(FileError::NoSuchMesh {
            path: path.to_owned(),
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

/// The file and the mesh name in `path`: the longest part before a `#` that is a file wins.
fn split_mesh_name(path: &Path) -> (PathBuf, Option<String>) {
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
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
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
