//! Principal axes of a point set: mean, covariance (eq. 4 and 5), and its eigenvectors in descending order (eq. 6).

use nalgebra::{
    Isometry3, Matrix3, Point3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3,
};

use super::rigid::RigidTransform;

/// Mean and principal axes of weighted points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// Weighted mean of the points.
    pub mean: Point3<f64>,
    /// Unit eigenvectors of the covariance as columns, largest eigenvalue first. Signs are arbitrary.
    pub axes: Matrix3<f64>,
    /// Variances along the axes, square metres, descending, never negative.
    pub variances: [f64; 3],
}

impl PrincipalAxes {
    /// Returns the transform from the space of the axes to that of the points: origin at the mean, right-handed, so
    /// the third axis may be reversed.
    pub fn frame(&self) -> RigidTransform {
        let first: Vector3<f64> = self.axes.column(0).into_owned();
        let second: Vector3<f64> = self.axes.column(1).into_owned();
        let matrix = Matrix3::from_columns(&[first, second, first.cross(&second)]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Isometry3::from_parts(Translation3::from(self.mean.coords), turn)
    }
}

/// Computes the principal axes of points with positive weights; `None` for fewer than three points.
///
/// With equal weights this is the paper's eq. 4 and 5 up to the factor n/(n-1), which does not change the axes.
pub fn principal_axes(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
) -> Option<PrincipalAxes> {
    let mut num_points = 0_usize;
    let (mut weight_sum, mut sum) = (0.0, Vector3::zeros());
    for (point, weight) in points.clone() {
        num_points += 1;
        weight_sum += weight;
        sum += point.coords * weight;
    }
    if num_points < 3 || weight_sum <= 0.0 {
        return None;
    }
    let mean = sum / weight_sum;
    // Sum only the six distinct entries: this loop runs over every point of the part.
    let [mut xx, mut xy, mut xz, mut yy, mut yz, mut zz] = [0.0; 6];
    for (point, weight) in points {
        let d = point.coords - mean;
        let w = d * weight;
        xx += w.x * d.x;
        xy += w.x * d.y;
        xz += w.x * d.z;
        yy += w.y * d.y;
        yz += w.y * d.z;
        zz += w.z * d.z;
    }
    let covariance = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) / weight_sum;
    let eigen = SymmetricEigen::new(covariance);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    Some(PrincipalAxes {
        mean: Point3::from(mean),
        axes: Matrix3::from_columns(&order.map(|i| eigen.eigenvectors.column(i).into_owned())),
        variances: order.map(|i| eigen.eigenvalues[i].max(0.0)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_box_are_its_edges_in_order_of_length() {
        let points: Vec<_> = (0..8)
            .map(|i| {
                let corner = |bit: i32, half: f64| if i >> bit & 1 == 1 { half } else { -half };
                (
                    Point3::new(corner(0, 1.0) + 5.0, corner(1, 3.0), corner(2, 2.0)),
                    1.0,
                )
            })
            .collect();
        let principal = principal_axes(points.iter().copied()).expect("eight points");
        assert!((principal.mean - Point3::new(5.0, 0.0, 0.0)).norm() < 1e-12);
        for (column, axis) in [Vector3::y(), Vector3::z(), Vector3::x()]
            .iter()
            .enumerate()
        {
            assert!(principal.axes.column(column).dot(axis).abs() > 1.0 - 1e-12);
        }
        for (variance, expected) in principal.variances.iter().zip([9.0, 4.0, 1.0]) {
            assert!((variance - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn two_points_have_no_axes() {
        let points = [(Point3::origin(), 1.0), (Point3::new(1.0, 0.0, 0.0), 1.0)];
        assert_eq!(principal_axes(points.into_iter()), None);
    }
}
