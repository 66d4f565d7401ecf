//! Serialises a rigid transform as its 4×4 matrix: 16 numbers, row by row. For `#[serde(with = "…")]`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::rigid::{RigidTransform, from_row_major, row_major};

/// Writes the matrix.
pub fn serialize<S: Serializer>(
    transform: &RigidTransform,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    row_major(transform).serialize(serializer)
}

/// Reads the matrix; fails if it is not a rigid transform (scales, mirrors, or is not finite).
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<RigidTransform, D::Error> {
    let numbers = <[f64; 16]>::deserialize(deserializer)?;
    from_row_major(&numbers, 1e-6)
        .ok_or_else(|| serde::de::Error::custom("the 16 numbers are not a rigid transform"))
}

/// A rigid transform serialised as 16 numbers, for places where `with` does not fit, such as inside an `Option`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct SixteenNumbers(#[serde(with = "super::sixteen_numbers")] pub RigidTransform);
