//! Where a search from no start begins: centre on centre, turned every way.

use std::f64::consts::{PI, SQRT_2, TAU};

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use geometry::{principal::PrincipalAxes, rigid::RigidTransform};

/// Rotations tried beside the principal axes: hardly a rotation is further than 40° from one of them, within what the
/// coarse refinement closes.
const NUM_ROTATIONS: usize = 150;

/// Principal axes on principal axes: a rigid motion takes one cloud's to the other's, up to half turns.
pub(super) fn along_axes(source: &PrincipalAxes, target: &PrincipalAxes) -> [RigidTransform; 4] {
    let (of_source, of_target) = (source.frame().rotation, target.frame().rotation);
    [
        UnitQuaternion::identity(),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI),
    ]
    .map(|half_turn| about_centres(source, target, of_target * half_turn * of_source.inverse()))
}

/// Rotations spread evenly over SO(3).
pub(super) fn all_round(
    source: &PrincipalAxes,
    target: &PrincipalAxes,
) -> impl Iterator<Item = RigidTransform> {
    spread_rotations(NUM_ROTATIONS).map(|turn| about_centres(source, target, turn))
}

fn about_centres(
    source: &PrincipalAxes,
    target: &PrincipalAxes,
    turn: UnitQuaternion<f64>,
) -> RigidTransform {
    Isometry3::from_parts(Translation3::from(target.mean - turn * source.mean), turn)
}

/// M. Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3)", CVPR 2022.
pub(super) fn spread_rotations(num: usize) -> impl Iterator<Item = UnitQuaternion<f64>> {
    // The constants of the article: irrational ratios for which the spiral covers SO(3) evenly.
    const PHI: f64 = SQRT_2;
    const PSI: f64 = 1.533_751_168_755_204_3;
    (0..num).map(move |i| {
        let s = i as f64 + 0.5;
        let (r, big_r) = ((s / num as f64).sqrt(), (1.0 - s / num as f64).sqrt());
        let (sin_a, cos_a) = (TAU * s / PHI).sin_cos();
        let (sin_b, cos_b) = (TAU * s / PSI).sin_cos();
        UnitQuaternion::from_quaternion(Quaternion::new(
            big_r * cos_b,
            r * sin_a,
            r * cos_a,
            big_r * sin_b,
        ))
    })
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn no_rotation_is_far_from_one_that_is_tried() {
        let tried: Vec<UnitQuaternion<f64>> = spread_rotations(NUM_ROTATIONS).collect();
        let mut rng = Pcg64::seed_from_u64(1);
        for _ in 0..2000 {
            let axis = Vector3::from([(); 3].map(|()| rng.random::<f64>() - 0.5));
            let any = UnitQuaternion::from_scaled_axis(axis.normalize() * PI * rng.random::<f64>());
            let nearest = tried
                .iter()
                .map(|turn| turn.angle_to(&any))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest.to_degrees() < 43.0, "{}", nearest.to_degrees());
        }
    }
}
