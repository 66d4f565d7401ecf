//! Why a file could not be read or written, and what to do about it.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::cause::{advice_on, words_of};
use super::import::BadImportOption;
use super::names::{listed, nearest_name};
use geometry::error::{Advice, Fault};

/// Why a file could not be read or written. Every variant about a file names it.
#[derive(Debug, Error, Advice)]
pub enum FileError {
    /// There is nothing at that path.
    #[error("{}: no such file", path.display())]
    #[advice = "Check the name and that the drive is connected"]
    NotFound {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The system denies access.
    #[error("{}: permission denied", path.display())]
    #[advice = "Ask for access to this folder, or copy the file to a folder of your own"]
    PermissionDenied {
        /// The file, or the folder to write to.
        path: PathBuf,
    },
    /// There is a folder, a pipe or a device instead of a file.
    #[error("{}: {found}", path.display())]
    #[advice(match found {
        NoFile::Folder => "Give the path of a file, not of a folder",
        NoFile::Device => "Copy its content into a file and give that",
    })]
    NotAFile {
        /// The path as it was given.
        path: PathBuf,
        /// What the path is instead.
        found: NoFile,
    },
    /// There is a folder instead of a capture, cloud or mesh.
    #[error("{}: {}", path.display(), NoFile::Folder)]
    #[advice("Give the captures in it, for example {}", path.join("*.png").display())]
    FolderOfCaptures {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The file has no bytes.
    #[error("{}: the file is empty", path.display())]
    #[advice = "Record or export the file again; its last copy was not completed"]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The content is in none of the known formats.
    #[error("{}: found {found}, expected PCD, PLY, XYZ or CSV text, STL, OBJ, glTF, GLB or a depth PNG", path.display())]
    #[advice = "Export the cloud as PCD or PLY, or the part as STL, OBJ or glTF, and open that"]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// A description of its first bytes.
        found: String,
    },
    /// The camera of a depth image was given instead of the image.
    #[error("{}: this is the camera of {}, not a capture", path.display(), image.display())]
    #[advice("Give the PNG: {}", image.display())]
    IsIntrinsics {
        /// The JSON.
        path: PathBuf,
        /// The image that it belongs to.
        image: PathBuf,
    },
    /// The format is known, but not this variant of it.
    #[error("{}: found {found}, expected {expected}", path.display())]
    #[advice = "Export the file again as {expected}"]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// The variant found.
        found: String,
        /// The supported variants.
        expected: &'static str,
    },
    /// The file ends early.
    #[error("{}: the file ends early: found {found} bytes of {what}, expected {expected}", path.display())]
    #[advice = "Copy or export the file again; the last copy stopped half-way"]
    Truncated {
        /// The file.
        path: PathBuf,
        /// The part of the file that is cut.
        what: &'static str,
        /// Bytes present.
        found: u64,
        /// How much was needed.
        expected: Expected,
    },
    /// The header is contradictory or cannot be parsed.
    #[error("{}: bad header: found {found}, expected {expected}", path.display())]
    #[advice(EXPORT_AGAIN)]
    BadHeader {
        /// The file.
        path: PathBuf,
        /// The words of the header.
        found: String,
        /// What is allowed there.
        expected: &'static str,
    },
    /// A line of a text format cannot be parsed.
    #[error("{}, line {line}: found {found:?}, expected {expected}", path.display())]
    #[advice = "Correct line {line} in a text editor, or export the file again"]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// The beginning of the line.
        found: String,
        /// What is allowed there.
        expected: &'static str,
    },
    /// The content is damaged or contradicts itself.
    #[error("{}: damaged: {what}", path.display())]
    #[advice(EXPORT_AGAIN)]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The damage found.
        what: String,
    },
    /// The file has more of something than is read from one file.
    #[error("{}: {found} {what}, but at most {limit} are read", path.display())]
    #[advice = "Thin the cloud out, or cut away what is not the part, and export it again"]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The thing counted, as a plural: "points", "bytes".
        what: &'static str,
        /// Count that the file has or claims.
        found: u64,
        /// The most that is read.
        limit: u64,
    },
    /// The file is larger than files of this kind ever are.
    #[error("{}: {found} bytes, but at most {limit} are read from a file of this kind", path.display())]
    #[advice = "Choose another file: a table, a description or a calibration is far smaller"]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Size of the file in bytes.
        found: u64,
        /// The most bytes that are read.
        limit: u64,
    },
    /// A newer version of the program wrote the file.
    #[error("{}: made by a newer version of Partsight (schema {found}, this one reads up to {known})", path.display())]
    #[advice = "Update Partsight on this computer"]
    Newer {
        /// The file.
        path: PathBuf,
        /// The version of its format.
        found: u32,
        /// The newest version that this program reads.
        known: u32,
    },
    /// The system names no folder for the user's data.
    #[error("this system has no folder for user data")]
    #[advice = "Set {OWN_FOLDER} to a folder of your own"]
    NoUserFolder,
    /// Another program wrote to the file while it was read.
    #[error("{}: the file changed while it was read", path.display())]
    #[advice = "Wait until the program that writes it has finished, then open it again"]
    Changing {
        /// The file.
        path: PathBuf,
    },
    /// The reader of this format panicked.
    #[error("{}: {fault}", path.display())]
    #[advice(fault.advice())]
    Fault {
        /// The file.
        path: PathBuf,
        /// The panic.
        fault: Fault,
    },
    /// The file has no points, or none with three finite coordinates.
    #[error("{}: none of its {found} points is a reading", path.display())]
    #[advice = "Check that the camera saw the part, between 0.5 m and 4 m away, and capture again"]
    NoPoints {
        /// The file.
        path: PathBuf,
        /// Points or pixels in the file, none of them a reading.
        found: usize,
    },
    /// A file of a mesh format has no triangles.
    #[error("{}: no triangles, expected a surface", path.display())]
    #[advice = "Export the part as a surface of triangles, not as curves or points"]
    NoTriangles {
        /// The file.
        path: PathBuf,
    },
    /// The file has no mesh of the requested name.
    #[error("{}: no mesh named {wanted:?}; it has {}", path.display(), listed(available, wanted))]
    #[advice(mesh_to_name(path, wanted, available))]
    NoSuchMesh {
        /// The file, without the name of the mesh.
        path: PathBuf,
        /// The requested name, after `#`.
        wanted: String,
        /// The names in the file, in its order; empty for formats without named meshes.
        available: Vec<String>,
    },
    /// The import options after the path are not valid.
    #[error("{}: {bad}", path.display())]
    #[advice(bad.advice())]
    ImportOption {
        /// The file, without the options.
        path: PathBuf,
        /// What is wrong with the options.
        bad: BadImportOption,
    },
    /// The file has several meshes and none was named.
    #[error("{}: {} meshes, expected one name after '#'; it has {}", path.display(), available.len(), listed(available, ""))]
    #[advice("Add the name of one mesh after '#', for example {}#{}", path.display(), available.first().map_or("NAME", String::as_str))]
    NeedsMeshName {
        /// The file.
        path: PathBuf,
        /// The names in the file, in its order.
        available: Vec<String>,
    },
    /// A depth PNG has no camera file.
    #[error("{}: a depth image, expected its intrinsics in {}", path.display(), json.display())]
    #[advice("Put the camera's intrinsics into {}, for example {EXAMPLE_JSON}", json.display())]
    MissingIntrinsics {
        /// The image.
        path: PathBuf,
        /// The path where the camera was expected.
        json: PathBuf,
    },
    /// The lens distortion is not one-to-one inside the picture.
    #[error(
        "{}: bad intrinsics: the distortion folds back inside the picture, so that some pixels have no ray",
        path.display()
    )]
    #[advice("Check k1 to k6, p1 and p2 in {}: they are OpenCV's, for the image at this width and height; without them the lens is taken for a pinhole", path.display())]
    FoldingDistortion {
        /// The JSON.
        path: PathBuf,
    },
    /// The camera file cannot be used.
    #[error("{}: bad intrinsics: {found}", path.display())]
    #[advice("Correct {}, for example to {EXAMPLE_JSON}", path.display())]
    BadIntrinsics {
        /// The JSON.
        path: PathBuf,
        /// What is wrong with it.
        found: String,
    },
    /// A PNG is not 16-bit greyscale.
    #[error("{}: found {found}, expected a 16-bit greyscale PNG of depth", path.display())]
    #[advice = "Save the depth image itself as 16-bit greyscale PNG, not the picture drawn from it"]
    WrongPngKind {
        /// The image.
        path: PathBuf,
        /// The kind found, such as "a colour PNG".
        found: String,
    },
    /// The file name's ending is not a format that can be written.
    #[error("{}: no format belongs to this name, expected {ENDINGS}", path.display())]
    #[advice = "End the name in {ENDINGS}"]
    UnknownEnding {
        /// The path as it was given.
        path: PathBuf,
    },
    /// Writing the camera of a depth image would overwrite a file that is not a camera.
    #[error("{}: exists already and is not the camera of a depth image; the camera of {} would overwrite it", path.display(), image.display())]
    #[advice("Choose another name for the image, or move {} away", path.display())]
    ForeignSidecar {
        /// The JSON file that exists.
        path: PathBuf,
        /// The image to be written.
        image: PathBuf,
    },
    /// The system could not read the file.
    #[error("{}: cannot read: {source}", path.display())]
    #[advice = "Copy the file to this computer's own disk and open the copy"]
    Read {
        /// The file.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// The system could not write; the path is unchanged.
    #[error("{}: cannot write: {}", path.display(), words_of(source))]
    #[advice(advice_on(source))]
    Write {
        /// The path to be written.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
}

/// What a path is instead of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoFile {
    /// A folder.
    #[error("a folder, expected a file")]
    Folder,
    /// A pipe, a socket or a device.
    #[error("not a regular file")]
    Device,
}

/// How much a cut file should have held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Expected {
    /// A number of bytes; for text, a lower bound.
    #[error("{0}")]
    Bytes(u64),
    /// The content that is missing, where the number of bytes is unknown.
    #[error("{0}")]
    More(&'static str),
}

/// The endings under which a cloud or a depth image can be written.
const ENDINGS: &str = ".pcd, .ply, .xyz, or .png for a depth image";

/// The environment variable that names another folder for the user's data and settings. A relative path starts at the
/// working folder, as in an argument.
pub(super) const OWN_FOLDER: &str = "PARTSIGHT_DATA";

impl FileError {
    /// Returns the variant for a system error on reading.
    pub fn reading(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        let inner = source.get_ref().and_then(|inner| inner.downcast_ref());
        if let Some(found) = inner.copied() {
            return Self::NotAFile { path, found };
        }
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            io::ErrorKind::PermissionDenied => Self::PermissionDenied { path },
            io::ErrorKind::IsADirectory => Self::NotAFile {
                path,
                found: NoFile::Folder,
            },
            _ => Self::Read { path, source },
        }
    }

    /// Returns the variant for a system error on writing.
    pub fn writing(path: &Path, source: io::Error) -> Self {
        Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}

const EXPORT_AGAIN: &str = "Export the file again from the program that made it";

fn mesh_to_name(path: &Path, wanted: &str, available: &[String]) -> String {
    match nearest_name(available.iter().map(String::as_str), wanted) {
        Some(name) => format!(
            "Did you mean {}#{name}? Give one of the names it has",
            path.display()
        ),
        None if available.is_empty() => {
            format!("Open {} without a name after '#'", path.display())
        }
        None => "Give one of the names it has after '#'".into(),
    }
}

/// A Kinect with depth in millimetres, as in the JSON beside a depth image.
const EXAMPLE_JSON: &str = r#"{"width":640,"height":480,"fx":525.0,"fy":525.0,"cx":319.5,"cy":239.5,"metres_per_unit":0.001}"#;
