//! A rigid transform as it is written: its 4×4 matrix, 16 numbers row after row. For `#[serde(with = "…")]`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::rigid::{RigidTransform, from_row_major, row_major};

/// Writes the matrix.
pub fn serialize<S: Serializer>(
    transform: &RigidTransform,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    row_major(transform).serialize(serializer)
}

/// Reads the matrix; one that also stretches, mirrors or is not finite is refused.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<RigidTransform, D::Error> {
    let numbers = <[f64; 16]>::deserialize(deserializer)?;
    from_row_major(&numbers, 1e-6)
        .ok_or_else(|| serde::de::Error::custom("the 16 numbers are not a rigid transform"))
}

/// A rigid transform that is written so, for places where `with` does not fit, such as within an `Option`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct SixteenNumbers(#[serde(with = "super::sixteen_numbers")] pub RigidTransform);
