//! Opening of any file: finds it, recognises its format and calls its reader.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::content::{FileContent, is_before_camera, is_capture};
use super::error::{FileError, NoFile};
use super::import::{ImportOptions, file_of, split_words};
use super::named_meshes::MeshFile;
use super::source::{Source, read_bytes};
use super::{depth_png, gltf, obj, pcd, ply, stl, xyz};
use geometry::cloud::PointCloud;
use geometry::error::guarded;

/// Reads the file at `path`. Its format is recognised by its content, never by its name.
///
/// `#` and a name after the path select one mesh of a glTF or GLB file, or one object of an OBJ: `car.gltf#Door_FL`. [`ImportOptions`] for a cloud or
/// a mesh are given in the same way: `door.stl#units=mm#up=z`. A file whose own name contains a `#` takes precedence.
pub fn open(path: &Path) -> Result<FileContent, FileError> {
    let asked = AskedFile::of(path)?;
    asked.content(&bytes_of(&asked.file)?)
}

/// What [`open_each`] finds in a file.
#[derive(Debug)]
pub enum OpenedFile {
    /// Every mesh of a glTF, or every object of an OBJ, for itself.
    Several(MeshFile),
    /// What [`open`] returns.
    One(FileContent),
}

/// Like [`open`], but reads several meshes of a file each for itself, unless the path names one of them.
pub fn open_each(path: &Path) -> Result<OpenedFile, FileError> {
    let asked = AskedFile::of(path)?;
    let bytes = bytes_of(&asked.file)?;
    // Reading it as one says why it cannot be read, and names the meshes of a file too large to read each.
    match asked.meshes(&bytes) {
        Ok(Some(several)) => Ok(OpenedFile::Several(several)),
        Ok(None) | Err(_) => asked.content(&bytes).map(OpenedFile::One),
    }
}

/// A path, split into the file and what the words behind it ask for.
struct AskedFile {
    file: PathBuf,
    options: ImportOptions,
    mesh_name: Option<String>,
}

impl AskedFile {
    fn of(path: &Path) -> Result<Self, FileError> {
        let (file, words) = split_words(path);
        let mut options = ImportOptions::default();
        let mut mesh_name: Option<String> = None;
        for word in words.iter().flat_map(|words| words.split('#')) {
            let is_option = options.take(word).map_err(|bad| FileError::ImportOption {
                path: file.clone(),
                bad,
            })?;
            if !is_option {
                // The name may contain a `#`.
                mesh_name =
                    Some(mesh_name.map_or_else(|| word.to_owned(), |name| name + "#" + word));
            }
        }
        Ok(Self {
            file,
            options,
            mesh_name,
        })
    }

    /// Reads what is asked for.
    fn content(&self, bytes: &[u8]) -> Result<FileContent, FileError> {
        let content = read(&self.file, bytes, self.mesh_name.as_deref())?;
        Ok(match self.options.applied(content) {
            FileContent::Mesh(mesh) if is_capture(&mesh) && is_before_camera(&mesh) => {
                FileContent::Cloud(PointCloud::from_points(mesh.vertices))
            }
            content => content,
        })
    }

    /// Reads every mesh for itself; `None` if one is asked for by name, or if there are not several.
    fn meshes(&self, bytes: &[u8]) -> Result<Option<MeshFile>, FileError> {
        if self.mesh_name.is_some() {
            return Ok(None);
        }
        let path = self.file.as_path();
        let source = Source { path, bytes };
        let (mut meshes, opens_whole) = without_panic(path, || match recognise(source)? {
            Format::Gltf => Ok((gltf::read_each(source)?, false)),
            Format::Obj => Ok((obj::read_each(source)?, true)),
            Format::Pcd | Format::Ply | Format::Stl | Format::DepthPng | Format::Xyz => {
                Ok((Vec::new(), false))
            }
        })?;
        if meshes.is_empty() {
            return Ok(None);
        }
        let axes = ImportOptions {
            up: self.options.up,
            ..ImportOptions::default()
        };
        for mesh in meshes
            .iter_mut()
            .filter_map(|named| named.mesh.as_mut().ok())
        {
            axes.convert(&mut mesh.vertices);
        }
        Ok(Some(MeshFile {
            file: path.to_owned(),
            options: self.options,
            meshes,
            opens_whole,
        }))
    }
}

fn bytes_of(file: &Path) -> Result<Vec<u8>, FileError> {
    read_bytes(file).map_err(|error| match error {
        FileError::NotAFile {
            path,
            found: NoFile::Folder,
        } => FileError::FolderOfCaptures { path },
        error => error,
    })
}

/// Like [`open`], for bytes in memory. `path` is for errors, and names the place where a depth image's camera is looked for.
pub fn open_bytes(path: &Path, bytes: &[u8]) -> Result<FileContent, FileError> {
    read(path, bytes, None)
}

/// Returns width, height and depths of a 16-bit PNG in memory; all depths may be 0. `path` is for errors.
pub fn read_depths(path: &Path, bytes: &[u8]) -> Result<((usize, usize), Vec<u16>), FileError> {
    let source = Source { path, bytes };
    without_panic(path, || {
        if depth_png::is_png(bytes) {
            return depth_png::decode(source);
        }
        Err(FileError::WrongPngKind {
            path: path.to_owned(),
            found: described(source),
        })
    })
}

fn read(path: &Path, bytes: &[u8], mesh_name: Option<&str>) -> Result<FileContent, FileError> {
    without_panic(path, || read_known(Source { path, bytes }, mesh_name))
}

/// Makes a panic of a reader an error of its file.
fn without_panic<T>(
    path: &Path,
    read: impl FnOnce() -> Result<T, FileError>,
) -> Result<T, FileError> {
    guarded(read).unwrap_or_else(|fault| {
        Err(FileError::Fault {
            path: path.to_owned(),
            fault,
        })
    })
}

fn read_known(source: Source<'_>, mesh_name: Option<&str>) -> Result<FileContent, FileError> {
    let format = recognise(source)?;
    if let (Some(wanted), false) = (mesh_name, matches!(format, Format::Gltf | Format::Obj)) {
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
        Format::Obj => obj::read(source, mesh_name),
        Format::Gltf => gltf::read(source, mesh_name).map(FileContent::Mesh),
        Format::DepthPng => depth_png::read(source).map(FileContent::Depth),
        Format::Xyz => xyz::read(source).map(FileContent::Cloud),
    }
}

/// Returns when the file that [`open`] reads at `path` was last written, if the system knows it.
pub fn written_at(path: &Path) -> Option<SystemTime> {
    file_of(path)
        .metadata()
        .and_then(|file| file.modified())
        .ok()
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
    // Before the text formats: many binary STL files also begin with "solid".
    if stl::is_binary(bytes) {
        return Ok(Format::Stl);
    }
    // Before the test for text: a PCD may be binary after its header.
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
            image: match source.path.file_name() {
                Some(name) if name == depth_png::FOLDER_CAMERA => {
                    source.path.with_file_name("*.png")
                }
                _ => source.path.with_extension("png"),
            },
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

/// Describes a file for an error that expected another kind.
fn described(source: Source<'_>) -> String {
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

/// Returns true if the first 4096 bytes contain no zero.
fn is_text(bytes: &[u8]) -> bool {
    !bytes.iter().take(4096).any(|&byte| byte == 0)
}

fn unknown_binary(source: Source<'_>) -> FileError {
    let Source { path, bytes } = source;
    // The content of a cut binary STL cannot be recognised. The file name may word the error, but not choose the reader.
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
