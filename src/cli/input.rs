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
    let opened = match files::open(path) {
        Ok(opened) => opened,
        // A camera that is covered or looks at nothing: the file is sound, there is just no part to see.
        Err(FileError::NoPoints { .. }) => return Ok((SceneCloud::default(), Vec::new())),
        Err(error) => return Err(error.into()),
    };
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

/// Reads "rx ry rz x y z" as the paper writes its T1..T5 (eq. 15): radians and metres, R = Rz·Ry·Rx. A number may carry
/// its unit instead: `90deg`, `800mm`.
pub(super) fn parse_pose(text: &str) -> Result<RigidTransform, String> {
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
        .collect();
    let [rx, ry, rz, x, y, z] = <[&str; 6]>::try_from(words).map_err(|words| {
        format!(
            "found {} numbers, expected six: three angles (radians, or 90deg) and three lengths (metres, or 800mm)",
            words.len()
        )
    })?;
    let angle = |word| parse_number(word, &[("deg", Radians::from_degrees(1.0).0), ("rad", 1.0)]);
    let length = |word| parse_number(word, &[("mm", Metres::from_mm(1.0).0), ("m", 1.0)]);
    Ok(from_euler_zyx([
        angle(rx)?,
        angle(ry)?,
        angle(rz)?,
        length(x)?,
        length(y)?,
        length(z)?,
    ]))
}

/// A number with one of the units given, or with none.
fn parse_number(word: &str, units: &[(&str, f64)]) -> Result<f64, String> {
    let with_unit = units
        .iter()
        .find_map(|(unit, factor)| word.strip_suffix(unit).map(|number| (number, *factor)));
    let (number, factor) = with_unit.unwrap_or((word, 1.0));
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number * factor),
        _ => Err(format!(
            "{word:?} is not a number with {} or no unit",
            units[0].0
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_numbers_are_radians_and_metres_or_what_their_unit_says() {
        let plain = parse_pose("0 0 1.5707963267948966, 1 -0.0205 0").expect("six numbers");
        let units = parse_pose("0deg 0rad 90deg 1000mm -20.5mm 0m").expect("six numbers");
        let moved = plain * nalgebra::Point3::new(1.0, 0.0, 0.0);
        assert!((moved - nalgebra::Point3::new(1.0, 0.9795, 0.0)).norm() < 1e-12);
        assert!((units.to_homogeneous() - plain.to_homogeneous()).norm() < 1e-12);
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
            "0 0 0 0 0 3cm",
            "0mm 0 0 0 0 0",
            "0 0 0 0 0 90deg",
        ] {
            assert!(parse_pose(text).is_err(), "{text}");
        }
    }
}
