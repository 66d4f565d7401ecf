//! A rigid transform as it is written: its 4×4 matrix, 16 numbers row after row. For `#[serde(with = "…")]`.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::rigid::{RigidTransform, row_major};

/// Writes the matrix.
pub fn serialize<S: Serializer>(
    transform: &RigidTransform,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    row_major(transform).serialize(serializer)
}

/// Reads the matrix; one that also stretches, mirrors or is not finite is refused.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<RigidTransform, D::Error> {
    let m = <[f64; 16]>::deserialize(deserializer)?;
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    let is_rotation = (rotation.transpose() * rotation - Matrix3::identity()).norm() < 1e-6
        && rotation.determinant() > 0.0
        && [m[3], m[7], m[11]].iter().all(|x| x.is_finite());
    if !is_rotation {
        return Err(serde::de::Error::custom(
            "the 16 numbers are not a rigid transform",
        ));
    }
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Isometry3::from_parts(
        Translation3::new(m[3], m[7], m[11]),
        rotation,
    ))
}
