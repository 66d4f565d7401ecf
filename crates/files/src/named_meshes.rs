//! The meshes of a file, each for itself.

use std::path::PathBuf;

use nalgebra::Vector3;

use super::error::FileError;
use super::import::{ImportOptions, LengthUnit};
use geometry::mesh::TriangleMesh;

/// A mesh, and the name behind the path of its file that opens it.
#[derive(Debug)]
pub struct NamedMesh {
    /// No other mesh of the file has this name.
    pub name: String,
    /// The mesh, or why it cannot be read.
    pub mesh: Result<TriangleMesh, FileError>,
}

impl NamedMesh {
    /// Returns width, height and depth of the box around it; `None` if it cannot be read.
    pub fn size(&self) -> Option<Vector3<f32>> {
        let (low, high) = self.mesh.as_ref().ok()?.bounds()?;
        Some(high - low)
    }

    /// Returns the longest side of that box, which distinguishes body parts from screws; 0 if it cannot be read.
    pub fn longest_side(&self) -> f32 {
        self.size().map_or(0.0, |sides| sides.max())
    }

    /// Returns the number of its triangles.
    pub fn num_triangles(&self) -> usize {
        let mesh = self.mesh.as_ref();
        mesh.map_or(0, |mesh| mesh.triangles.len())
    }
}

/// All meshes of a file that can be opened by name.
#[derive(Debug)]
pub struct MeshFile {
    /// The file, without the words behind its path.
    pub file: PathBuf,
    /// The import options behind its path. The axes of the meshes are converted already, their lengths are not.
    pub options: ImportOptions,
    /// The meshes, in the file's order.
    pub meshes: Vec<NamedMesh>,
    /// True if the file can be opened without a name, too, as one mesh.
    pub opens_whole: bool,
}

impl MeshFile {
    /// Returns the path that opens the mesh of this name in this unit; without a name, the whole file.
    pub fn path_of(&self, name: Option<&str>, unit: LengthUnit) -> PathBuf {
        let mut path = self.file.clone().into_os_string();
        if let Some(name) = name {
            path.push("#");
            path.push(name);
        }
        path.push(
            ImportOptions {
                unit,
                ..self.options
            }
            .suffix(),
        );
        path.into()
    }
}
