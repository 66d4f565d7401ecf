//! What the commands read: scenes, clouds and the six numbers of a pose.

use std::path::Path;

use crate::{
    error::Advice,
    files::{self, FileError, FileWarning, Opened},
    geometry::{
        cloud::PointCloud,
        rigid::{RigidTransform, from_euler_zyx},
    },
    stages::scene::{SceneCloud, scene_from_cloud, scene_from_frame},
    units::{Metres, Radians},
};

/// Why a file is no input for a command.
#[derive(Debug, thiserror::Error)]
pub(super) enum InputError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{path}: a mesh, expected what a depth camera saw")]
    MeshIsNoScene { path: String },
    #[error("{path}: the mesh has no area")]
    EmptyMesh { path: String },
}

impl Advice for InputError {
    fn advice(&self) -> String {
        match self {
            Self::File(error) => error.advice(),
            Self::MeshIsNoScene { path } => {
                format!("Enrol it as a reference: partsight enrol {path} --name NAME")
            }
            Self::EmptyMesh { .. } => "Export the mesh again with its faces".into(),
        }
    }
}

/// Opens a captured scene.
pub(super) fn open_scene(path: &Path) -> Result<(SceneCloud, Vec<FileWarning>), InputError> {
    let opened = files::open(path)?;
    let warnings = opened.warnings();
    let scene = match opened {
        Opened::Cloud(cloud) => scene_from_cloud(cloud),
        Opened::Depth(frame) => scene_from_frame(&frame),
        Opened::Mesh(_) => {
            return Err(InputError::MeshIsNoScene {
                path: path.display().to_string(),
            });
        }
    };
    Ok((scene, warnings))
}

/// Points sampled of a mesh to align it.
const MESH_POINTS: usize = 16_000;

/// Opens anything with points: a mesh is sampled evenly.
pub(super) fn open_cloud(path: &Path) -> Result<(PointCloud, Vec<FileWarning>), InputError> {
    let opened = files::open(path)?;
    let warnings = opened.warnings();
    let cloud = match opened {
        Opened::Cloud(cloud) => cloud,
        Opened::Depth(frame) => scene_from_frame(&frame).cloud,
        Opened::Mesh(mesh) => {
            mesh.sample_evenly(MESH_POINTS, 1)
                .ok_or_else(|| InputError::EmptyMesh {
                    path: path.display().to_string(),
                })?
        }
    };
    Ok((cloud, warnings))
}

/// Reads "rx ry rz x y z" in degrees and millimetres, R = Rz·Ry·Rx.
pub(super) fn parse_pose(text: &str) -> Result<RigidTransform, String> {
    let numbers: Vec<f64> = text
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
        .map(|word| match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(format!("{word:?} is not a number")),
        })
        .collect::<Result<_, _>>()?;
    let [rx, ry, rz, x, y, z] = <[f64; 6]>::try_from(numbers).map_err(|numbers| {
        format!(
            "found {} numbers, expected six: three angles in degrees and three lengths in millimetres",
            numbers.len()
        )
    })?;
    let [rx, ry, rz] = [rx, ry, rz].map(|degrees| Radians::from_degrees(degrees).0);
    let [x, y, z] = [x, y, z].map(|mm| Metres::from_mm(mm).0);
    Ok(from_euler_zyx([rx, ry, rz, x, y, z]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_numbers_are_degrees_and_millimetres() {
        let pose = parse_pose("0 0 90, 1000 -20.5 0").expect("six numbers");
        let moved = pose * nalgebra::Point3::new(1.0, 0.0, 0.0);
        assert!((moved - nalgebra::Point3::new(1.0, 0.9795, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn anything_else_is_refused() {
        for text in [
            "",
            "1 2 3",
            "0 0 0 0 0 0 0",
            "a b c d e f",
            "0 0 0 0 0 nan",
            "0 0 0 0 0 inf",
        ] {
            assert!(parse_pose(text).is_err(), "{text}");
        }
    }
}
