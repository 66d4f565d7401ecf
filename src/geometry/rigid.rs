//! Rigid transforms: rotation and shift in three dimensions.
//!
//! A transform is named `to_from`: `camera_from_part * point_in_part` is the same point in the camera's space.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::units::{Metres, Radians};

/// A rotation followed by a shift in metres.
pub type RigidTransform = Isometry3<f64>;

/// The transform of six numbers `[θx θy θz x y z]` in radians and metres, as the paper writes T1..T5 (eq. 15).
///
/// The paper names no order of the rotations; here R = Rz(θz) · Ry(θy) · Rx(θx).
pub fn from_euler_zyx(parameters: [f64; 6]) -> RigidTransform {
    let [rx, ry, rz, x, y, z] = parameters;
    // nalgebra's `from_euler_angles(roll, pitch, yaw)` is Rz(yaw) · Ry(pitch) · Rx(roll).
    Isometry3::from_parts(
        Translation3::new(x, y, z),
        UnitQuaternion::from_euler_angles(rx, ry, rz),
    )
}

/// The 4×4 matrix as 16 numbers, row after row.
pub fn row_major(transform: &RigidTransform) -> [f64; 16] {
    let matrix = transform.to_homogeneous();
    std::array::from_fn(|i| matrix[(i / 4, i % 4)])
}

/// A matrix that is no rigid transform.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NotRigid {
    /// A number that is not finite.
    #[error("a number is not finite")]
    NotFinite,
    /// The last row is another than 0 0 0 1.
    #[error("the last row is {row:?}, expected 0 0 0 1")]
    LastRow {
        /// What it is.
        row: [f64; 4],
    },
    /// The nine numbers of the rotation mirror what they turn.
    #[error("it mirrors: the determinant of the rotation is {determinant:.3}, expected 1")]
    Mirrors {
        /// Of the 3×3 block.
        determinant: f64,
    },
    /// The nine numbers of the rotation stretch or shear what they turn.
    #[error("its rotation stretches or shears by {by:.4}, at most {limit} is taken for rounding")]
    Stretches {
        /// Largest number of RᵀR - I, without its sign.
        by: f64,
        /// What was allowed.
        limit: f64,
    },
}

/// The transform of a 4×4 matrix, 16 numbers row after row; lengths in metres.
///
/// Its rotation may be rounded: RᵀR may be off the identity by `limit` in each number, and the nearest rotation is taken.
pub fn from_row_major(m: &[f64; 16], limit: f64) -> Result<RigidTransform, NotRigid> {
    if m.iter().any(|x| !x.is_finite()) {
        return Err(NotRigid::NotFinite);
    }
    let row = [m[12], m[13], m[14], m[15]];
    if row.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(x, e)| (x - e).abs() > 1e-9) {
        return Err(NotRigid::LastRow { row });
    }
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    let by = (rotation.transpose() * rotation - Matrix3::identity()).amax();
    if !(by <= limit) {
        return Err(NotRigid::Stretches { by, limit });
    }
    let determinant = rotation.determinant();
    let nearest = rotation_nearest_to(&rotation).filter(|_| determinant > 0.0);
    let rotation = nearest.ok_or(NotRigid::Mirrors { determinant })?;
    Ok(Isometry3::from_parts(
        Translation3::new(m[3], m[7], m[11]),
        rotation,
    ))
}

/// How far two poses of the same thing are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseError {
    /// The angle of the rotation that leads from one to the other, 0..π.
    pub rotation: Radians,
    /// How far the point of interest moves from one to the other.
    pub shift: Metres,
}

/// The angle between two poses, and how far `at` (a point in the space that both map from) lands apart.
///
/// The shift is taken at a point that matters, such as the part's centroid: at a far origin the same small
/// rotation would read as a large shift.
pub fn pose_error(a: &RigidTransform, b: &RigidTransform, at: &Point3<f64>) -> PoseError {
    PoseError {
        rotation: Radians(a.rotation.angle_to(&b.rotation)),
        shift: Metres((a * at - b * at).norm()),
    }
}

/// The rigid transform that maps `from` onto `to` with the least sum of squared distances (Kabsch 1976, by SVD);
/// `None` when fewer than three pairs are given or they do not span a plane's worth of directions.
pub fn fit_rigid(
    pairs: impl Iterator<Item = (Point3<f64>, Point3<f64>)> + Clone,
) -> Option<RigidTransform> {
    let mut num_pairs = 0.0;
    let (mut from_sum, mut to_sum) = (Vector3::zeros(), Vector3::zeros());
    for (from, to) in pairs.clone() {
        num_pairs += 1.0;
        from_sum += from.coords;
        to_sum += to.coords;
    }
    if num_pairs < 3.0 {
        return None;
    }
    let (from_mean, to_mean) = (from_sum / num_pairs, to_sum / num_pairs);
    let cross_covariance = pairs.fold(Matrix3::zeros(), |sum, (from, to)| {
        sum + (to.coords - to_mean) * (from.coords - from_mean).transpose()
    });
    rotation_nearest_to(&cross_covariance).map(|rotation| {
        let shift = to_mean - rotation * from_mean;
        Isometry3::from_parts(Translation3::from(shift), rotation)
    })
}

/// The rotation R that maximises trace(Rᵀ M) for a 3×3 cross-covariance M; `None` when M has rank below two.
pub fn rotation_nearest_to(cross_covariance: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let svd = cross_covariance.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let singular = svd.singular_values;
    // Rank one leaves a free turn about a line: no single answer.
    if !(singular[1] > 1e-12 * singular[0].max(f64::MIN_POSITIVE)) {
        return None;
    }
    // The sign keeps a proper rotation when the best orthogonal matrix is a reflection.
    let sign = (u.determinant() * v_t.determinant()).signum();
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(rotation),
    ))
}
