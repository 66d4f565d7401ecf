//! Reading and writing of clouds, meshes and depth frames. A file's format is recognised by its content.
//!
//! | format | read as | source |
//! | --- | --- | --- |
//! | PCD 0.5-0.7: ascii, binary, `binary_compressed` | cloud | the Point Cloud Library's `PCD_V7` page and `pcd_io.cpp` |
//! | PLY: ascii, binary of either byte order | cloud, or mesh if it has faces | G. Turk, *The PLY Polygon File Format*, 1994 |
//! | XYZ and CSV text | cloud | no standard; see [`xyz`] |
//! | STL: ascii, binary | mesh | 3D Systems, *Stereolithography Interface Specification*, 1989 |
//! | OBJ | mesh, or cloud without faces | Wavefront *Advanced Visualizer*, appendix B1 |
//! | glTF 2.0, GLB | one mesh, chosen by `#name` | Khronos, *glTF 2.0 Specification* |
//! | 16-bit depth PNG with a JSON of intrinsics beside it | depth frame | see [`depth_png`] |
//!
//! Lengths are taken as metres, because no cloud format states its unit.
//! [`FileContent::warnings`] warns if the numbers look like millimetres.
//!
//! Every size that a header claims is checked against the bytes present and against [`MAX_UNPACKED_BYTES`] before memory
//! is allocated. Only regular files up to a size limit are opened (`open_regular`). A panic in a reader becomes an error of
//! its file.
//!
//! # Own readers
//! PNG, JSON, base64 and the glTF document are read by libraries. The other formats are read here, because the libraries
//! tried fell short: `pcd-rs` makes two allocations per point and panics if a compressed block is shorter than its header
//! says; `ply-rs-bw` refuses `nan` in ascii rows and the property names that `CloudCompare` writes; `stl_io` takes a binary
//! file that begins with "solid " for text and drops every solid after the first; `tobj` returns nothing for an OBJ without
//! faces; neither of the last two can name the line that is wrong.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

mod cause;
mod cells;
mod checksum;
mod content;
mod counting_order;
mod depth_camera;
pub mod depth_png;
pub mod disk;
mod error;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
mod folders;
mod gltf;
pub mod import;
mod lock;
mod named_meshes;
mod names;
mod obj;
mod open;
pub mod pcd;
pub mod ply;
mod readings;
mod scalar;
mod source;
mod stl;
mod surface;
mod text;
mod write;
pub mod xyz;
mod zip;

pub use self::cause::{advice_on, words_of};
pub use self::cells::{Row, csv_comment, csv_text, table_rows};
pub use self::checksum::crc32;
pub use self::content::{FileContent, FileWarning, ONLY_MILLIMETRES_M};
pub use self::counting_order::in_counting_order;
pub use self::depth_camera::{DepthCamera, StoredOrientation, Turn};
pub use self::depth_png::read_picture;
pub use self::depth_png::write_depth_png;
pub use self::error::{Expected, FileError, NoFile};
pub use self::folders::user_settings;
pub use self::folders::{file_name, folder_of, new_folder, sync_folder, user_data, write_file};
pub use self::import::file_of;
pub use self::lock::FileLock;
pub use self::named_meshes::{MeshFile, NamedMesh};
pub use self::names::{nearest_name, stays_inside};
pub use self::open::{OpenedFile, open, open_bytes, open_each, read_depths, written_at};
pub use self::pcd::write_pcd;
pub use self::ply::{PointProperty, write_ply, write_ply_with};
pub use self::source::{open_regular, read_bytes, read_limited, refuse_special, shortened};
pub use self::text::{parse_json, parse_toml, read_text, toml_problem, visible};
pub use self::write::{replace_file, write_text};
pub use self::write::{save_cloud, write_atomically};
pub use self::xyz::write_xyz;
#[cfg(any(test, feature = "fixtures"))]
pub use self::zip::read_zip;
pub use self::zip::write_zip;

/// Endings of files that may hold a captured scene, for file dialogs; the content decides what a file is.
pub const SCENE_ENDINGS: &[&str] = &["pcd", "ply", "xyz", "txt", "csv", "asc", "pts", "png"];
/// Endings of files that may hold points, meshes included.
pub const POINT_ENDINGS: &[&str] = &[
    "pcd", "ply", "xyz", "txt", "csv", "asc", "pts", "png", "stl", "obj", "gltf", "glb",
];

/// The most points, vertices, triangles or pixels read from one file: 160 full Kinect frames. A header that claims more is
/// most likely wrong, and one `PointCloud` would take more than a gigabyte.
pub const MAX_POINTS: usize = 50_000_000;

/// The largest file that is read, in bytes. 50 million points with normals and colours take 1.6 GB in binary.
pub const MAX_FILE_BYTES: u64 = 2 << 30;

/// The most memory allocated for the unpacked content of a file, in bytes. Packed points and empty pixels can unpack to a
/// thousand times their size.
pub const MAX_UNPACKED_BYTES: u64 = 1 << 30;
