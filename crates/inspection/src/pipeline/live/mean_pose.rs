//! The mean of several estimates of one pose, without outliers.
//!
//! The mean rotation is the unit quaternion that maximises Σ (q·qᵢ)², the eigenvector of Σ qᵢqᵢᵀ with the largest
//! eigenvalue; it treats q and -q alike: F. L. Markley, Y. Cheng, J. L. Crassidis and Y. Oshman, "Averaging
//! Quaternions", Journal of Guidance, Control, and Dynamics 30(4), 2007. Positions are averaged at the part's middle,
//! which a small turn does not move. The estimates averaged are those near the one with the most neighbours.

use nalgebra::{Matrix4, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};

use geometry::{
    rigid::{RigidTransform, pose_error},
    units::{Metres, Radians},
};

/// How far estimates of the same pose may be apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseTolerance {
    /// Distance at the part's middle, 1..20 mm. Raising it averages different poses.
    pub shift: Metres,
    /// Angle, 0.2..5°. Raising it averages different poses.
    pub turn: Radians,
}

/// The mean of several estimates of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanPose {
    /// Transform from part space to camera space.
    pub camera_from_part: RigidTransform,
    /// Number of estimates averaged.
    pub num_agreeing: usize,
}

/// Averages the largest group of estimates that agree. `middle` is the middle of the part, part space, metres. `None`
/// without estimates.
pub fn mean_pose(
    estimates: &[RigidTransform],
    middle: &Point3<f64>,
    tolerance: PoseTolerance,
) -> Option<MeanPose> {
    let is_near = |a: &RigidTransform, b: &RigidTransform| {
        let apart = pose_error(a, b, middle);
        apart.shift <= tolerance.shift && apart.rotation <= tolerance.turn
    };
    let num_near = |pose: &RigidTransform| {
        estimates
            .iter()
            .filter(|other| is_near(pose, other))
            .count()
    };
    // Of equals the first, so that the same estimates always have the same mean.
    let mut centre: Option<(usize, &RigidTransform)> = None;
    for pose in estimates {
        let num = num_near(pose);
        if centre.is_none_or(|(most, _)| num > most) {
            centre = Some((num, pose));
        }
    }
    let (_, centre) = centre?;
    let group: Vec<&RigidTransform> = estimates
        .iter()
        .filter(|pose| is_near(centre, pose))
        .collect();
    let rotation = mean_rotation(group.iter().map(|pose| pose.rotation))?;
    let at = group
        .iter()
        .map(|pose| (*pose * middle).coords)
        .sum::<Vector3<f64>>()
        / group.len() as f64;
    let shift = at - rotation * middle.coords;
    Some(MeanPose {
        camera_from_part: RigidTransform::from_parts(Translation3::from(shift), rotation),
        num_agreeing: group.len(),
    })
}

/// `None` without any rotation.
fn mean_rotation(
    rotations: impl Iterator<Item = UnitQuaternion<f64>>,
) -> Option<UnitQuaternion<f64>> {
    let sum = rotations.fold(Matrix4::zeros(), |sum, q| {
        sum + q.coords * q.coords.transpose()
    });
    let eigen = sum.symmetric_eigen();
    let largest = eigen.eigenvalues.imax();
    let coords = eigen.eigenvectors.column(largest).into_owned();
    (eigen.eigenvalues[largest] > 0.0)
        .then(|| UnitQuaternion::from_quaternion(Quaternion::from_vector(coords)))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use geometry::rigid::from_euler_zyx;

    const TOLERANCE: PoseTolerance = PoseTolerance {
        shift: Metres(0.006),
        turn: Radians(0.02),
    };

    fn noisy(truth: &RigidTransform, num: usize, random: &mut Pcg64) -> Vec<RigidTransform> {
        let mut draw = |width: f64| width * (2.0 * random.random::<f64>() - 1.0);
        (0..num)
            .map(|_| {
                let [a, b, c] = std::array::from_fn(|_| draw(0.004));
                let [x, y, z] = std::array::from_fn(|_| draw(0.001));
                truth * from_euler_zyx([a, b, c, x, y, z])
            })
            .collect()
    }

    #[test]
    fn the_mean_is_nearer_to_the_truth_than_the_estimates_and_outliers_do_not_pull_it() {
        let middle = Point3::new(0.1, -0.2, 0.05);
        let (mut of_means, mut of_estimates) = (0.0, 0.0);
        for seed in 0..20 {
            let mut random = Pcg64::seed_from_u64(seed);
            let truth = from_euler_zyx([0.2, -0.1, 3.1, 0.1, 0.0, 1.3]);
            let good = noisy(&truth, 9, &mut random);
            let mut estimates = good.clone();
            estimates.insert(3, truth * from_euler_zyx([0.0, 0.0, 3.1, 0.3, 0.0, 0.0]));
            estimates.insert(0, truth * from_euler_zyx([0.0, 0.0, 0.0, 0.02, 0.0, 0.0]));
            let mean = mean_pose(&estimates, &middle, TOLERANCE).expect("a mean");
            assert_eq!(mean.num_agreeing, 9);
            let off = |pose: &RigidTransform| {
                let off = pose_error(pose, &truth, &middle);
                off.shift.0 / 0.001 + off.rotation.0 / 0.004
            };
            of_means += off(&mean.camera_from_part);
            of_estimates += good.iter().map(off).sum::<f64>() / 9.0;
        }
        // The mean of nine estimates should be a third as far off.
        let gain = of_means / of_estimates;
        assert!(gain < 0.45, "{gain}");
    }

    #[test]
    fn the_two_signs_of_a_quaternion_are_one_rotation() {
        let q = UnitQuaternion::from_euler_angles(0.3, 0.2, -2.9);
        let minus = UnitQuaternion::new_unchecked(-q.into_inner());
        let mean = mean_rotation([q, minus, q].into_iter()).expect("a mean");
        assert!(mean.angle_to(&q) < 1e-9);
        assert!(mean_pose(&[], &Point3::origin(), TOLERANCE).is_none());
    }
}
