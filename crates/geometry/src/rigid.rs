//! Rigid transforms: rotation and translation in three dimensions.
//!
//! A transform is named `to_from`: `camera_from_part * point_in_part` is the same point in camera space.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::units::{Metres, Radians};

/// A rotation followed by a translation in metres.
pub type RigidTransform = Isometry3<f64>;

/// Returns the transform for six numbers `[θx θy θz x y z]` in radians and metres, as the paper writes T1..T5 (eq. 15).
///
/// The paper does not state the order of the rotations; here R = Rz(θz) · Ry(θy) · Rx(θx).
pub fn from_euler_zyx(parameters: [f64; 6]) -> RigidTransform {
    let [rx, ry, rz, x, y, z] = parameters;
    // nalgebra's `from_euler_angles(roll, pitch, yaw)` is Rz(yaw) · Ry(pitch) · Rx(roll).
    Isometry3::from_parts(
        Translation3::new(x, y, z),
        UnitQuaternion::from_euler_angles(rx, ry, rz),
    )
}

/// Returns the 4×4 matrix as 16 numbers, row by row.
pub fn row_major(transform: &RigidTransform) -> [f64; 16] {
    let matrix = transform.to_homogeneous();
    std::array::from_fn(|i| matrix[(i / 4, i % 4)])
}

/// Converts a 4×4 matrix, row by row. `None` if its upper left part deviates from a rotation by `tolerance` or more
/// (Frobenius norm of Rᵀ·R - 1), if it mirrors, does not end in 0 0 0 1, or is not finite.
pub fn from_row_major(m: &[f64; 16], tolerance: f64) -> Option<RigidTransform> {
    /// Below this error the numbers are a rotation to the last digits and are used unchanged.
    const EXACT_MAX_ERROR: f64 = 1e-9;
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    let off = (rotation.transpose() * rotation - Matrix3::identity()).norm();
    let last = [m[12], m[13], m[14], m[15] - 1.0];
    let is_rigid = off < tolerance
        && rotation.determinant() > 0.0
        && last.iter().all(|x| x.abs() < tolerance)
        && [m[3], m[7], m[11]].iter().all(|x| x.is_finite());
    if !is_rigid {
        return None;
    }
    let rotation = if off < EXACT_MAX_ERROR {
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation))
    } else {
        rotation_nearest_to(&rotation)?
    };
    Some(Isometry3::from_parts(
        Translation3::new(m[3], m[7], m[11]),
        rotation,
    ))
}

/// Returns true if all components are finite.
pub fn is_finite(transform: &RigidTransform) -> bool {
    let shift = transform.translation.vector.iter();
    let mut numbers = shift.chain(transform.rotation.coords.iter());
    numbers.all(|x| x.is_finite())
}

/// The difference between two poses of the same object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseDelta {
    /// Angle of the rotation from one pose to the other, 0..π.
    pub rotation: Radians,
    /// Distance by which the point of interest moves.
    pub shift: Metres,
}

/// Returns the angle between two poses, and the distance between the positions to which they map `at`, a point in
/// their common source space.
///
/// The shift is taken at a relevant point, such as the part's centroid: at a far origin the same small rotation
/// would appear as a large shift.
pub fn pose_error(a: &RigidTransform, b: &RigidTransform, at: &Point3<f64>) -> PoseDelta {
    PoseDelta {
        rotation: Radians(a.rotation.angle_to(&b.rotation)),
        shift: Metres((a * at - b * at).norm()),
    }
}

/// Fits the rigid transform that maps `from` onto `to` with the least sum of squared distances (Kabsch 1976, by SVD);
/// `None` for fewer than three pairs or if the points are collinear.
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

/// Returns the rotation R that maximises trace(Rᵀ M) for a 3×3 cross-covariance M; `None` if M has rank below two.
pub fn rotation_nearest_to(cross_covariance: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let svd = cross_covariance.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let singular = svd.singular_values;
    // With rank one the rotation about a line is undetermined.
    if !(singular[1] > 1e-12 * singular[0].max(f64::MIN_POSITIVE)) {
        return None;
    }
    // The sign keeps the rotation proper if the best orthogonal matrix is a reflection.
    let sign = (u.determinant() * v_t.determinant()).signum();
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(rotation),
    ))
}
