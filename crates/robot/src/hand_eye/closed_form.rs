//! X and Z in closed form: the rotations by Kronecker products, then the shifts by linear least squares.
//!
//! For the rotations, Gᵢ X Bᵢ = Z means vec Z = (Bᵢᵀ ⊗ Gᵢ) vec X for every pair. The mean of those 9×9 matrices maps
//! the true X to the true Z, and its largest singular value is then 1: its singular vectors are the two rotations.

use nalgebra::{DMatrix, DVector, Isometry3, Matrix3, SMatrix, Translation3, Vector3};

use super::{Equation, HandEyeSolution};
use geometry::rigid::rotation_nearest_to;

/// Singular values below this share of the largest are rounding errors: the shift along them is left at 0.
const NEGLIGIBLE: f64 = 1e-9;

/// X and Z in closed form.
pub(super) struct ClosedForm {
    pub(super) unknowns: HandEyeSolution,
    /// Lead of the best rotation over the next, 0..1; at 0 another rotation fits as well.
    pub(super) lead: f64,
}

/// Solves at least three equations for X and Z; `None` if they do not determine any answer. The accuracy is not
/// assessed.
pub(super) fn solve(equations: &[Equation]) -> Option<ClosedForm> {
    let mut mean = SMatrix::<f64, 9, 9>::zeros();
    for equation in equations {
        let g = rotation(&equation.anchor_from_mount);
        let b = rotation(&equation.camera_from_target);
        mean += b.transpose().kronecker(&g);
    }
    let svd = mean.svd(true, true);
    let largest = svd.singular_values.imax();
    let first = svd.singular_values[largest];
    let others = svd.singular_values.iter().enumerate();
    let others = others.filter(|(i, _)| *i != largest).map(|(_, s)| *s);
    let lead = 1.0 - others.fold(0.0, f64::max) / first.max(f64::MIN_POSITIVE);
    let x = Matrix3::from_iterator(svd.v_t?.row(largest).iter().copied());
    let z = Matrix3::from_iterator(svd.u?.column(largest).iter().copied());
    // The sign of both is free, but only one makes X a rotation.
    let sign = x.determinant().signum();
    let (x, z) = (
        rotation_nearest_to(&(x * sign))?,
        rotation_nearest_to(&(z * sign))?,
    );

    // Gᵢ (X t_Bᵢ + t_X) + t_Gᵢ = t_Z, three rows for each pair.
    let mut rows = DMatrix::<f64>::zeros(3 * equations.len(), 6);
    let mut sides = DVector::<f64>::zeros(3 * equations.len());
    for (i, equation) in equations.iter().enumerate() {
        let g = rotation(&equation.anchor_from_mount);
        let seen = x * equation.camera_from_target.translation.vector;
        let side = -(equation.anchor_from_mount.translation.vector + g * seen);
        rows.fixed_view_mut::<3, 3>(3 * i, 0).copy_from(&g);
        rows.fixed_view_mut::<3, 3>(3 * i, 3)
            .copy_from(&-Matrix3::identity());
        sides.fixed_rows_mut::<3>(3 * i).copy_from(&side);
    }
    let svd = rows.svd(true, true);
    let least = NEGLIGIBLE * svd.singular_values.max();
    let shifts = svd.solve(&sides, least).ok()?;
    let shift = |at: usize| -> Vector3<f64> { shifts.fixed_rows::<3>(at).into_owned() };
    Some(ClosedForm {
        unknowns: HandEyeSolution {
            mount_from_camera: Isometry3::from_parts(Translation3::from(shift(0)), x),
            anchor_from_target: Isometry3::from_parts(Translation3::from(shift(3)), z),
        },
        lead,
    })
}

fn rotation(transform: &Isometry3<f64>) -> Matrix3<f64> {
    transform.rotation.to_rotation_matrix().into_inner()
}
