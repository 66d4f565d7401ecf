//! Registration: refines the poses of all shots together.
//!
//! Point-to-plane ICP (Y. Chen and G. Medioni, "Object modelling by registration of multiple range images", Image and
//! Vision Computing 10(3), 1992) over all overlapping pairs at once: each Gauss-Newton step solves one system with six
//! unknowns per shot (K. Pulli, "Multiview registration for large data sets", 3DIM 1999, in its simultaneous form).
//! The scale of the Welsch weights shrinks from centimetres to the noise. The robot's poses enter as a prior, so that a
//! direction that no surface constrains stays as the robot reports it.
//!
//! Errors of neighbouring readings are correlated (from the depth sensor and from its calibration), so the pairs count as a
//! fraction of their number against the prior.

use nalgebra::{
    DMatrix, DVector, Isometry3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3, Vector6,
};

use super::{
    pairs::{ProjectedReading, Reach, RegistrationShot, meet},
    surface::{ShotSurface, Use},
};
use geometry::{
    parallel::{map_each, num_cores},
    rigid::RigidTransform,
    units::{Metres, Radians},
};

/// Parameters of [`register`].
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterParams {
    /// Standard deviation of a camera's position according to the robot, 0.5..20 mm. Raising it lets flat scenes slide.
    pub prior_shift: Metres,
    /// Standard deviation of a camera's rotation according to the robot, 0.05..2°.
    pub prior_turn: Radians,
    /// Approximate number of readings of each shot that are paired, 500..50 000. Raising it costs time.
    pub num_samples: usize,
    /// Number of threads; it does not change the result.
    pub num_workers: usize,
}

impl Default for RegisterParams {
    fn default() -> Self {
        Self {
            prior_shift: Metres::from_mm(3.0),
            prior_turn: Radians::from_degrees(0.3),
            num_samples: 8000,
            num_workers: num_cores(),
        }
    }
}

/// Scale of the Welsch weights in metres, and the most steps at it, from coarse to fine. A pose error of 3 mm and 0.3° moves
/// a point 2 m away by 13 mm.
const LEVELS: [(f64, usize); 4] = [(0.03, 4), (0.015, 6), (0.008, 8), (0.005, 12)];
/// Readings of two shots further apart than this, in scales, are not paired: their weight would be below exp(-9).
const REACH: f64 = 3.0;
/// The least scale of a pair, in standard deviations of its distance: far readings scatter by centimetres, but constrain
/// the rotation.
const SIGMAS: f64 = 2.0;
/// Error of a distance from calibration and quantisation, in metres, in addition to the noise.
const ERROR_FLOOR_M: f64 = 0.001;
/// This many pairs count as one with an independent error.
const CORRELATED: f64 = 25.0;
/// A step that moves no camera by more than this (metres, radians) ends a level.
const SETTLED_STEP_M_RAD: f64 = 2e-6;

/// Returns about `num` of the readings that a shot can be registered with, spread over its picture.
pub fn samples_of(surface: &ShotSurface, num: usize) -> Vec<u32> {
    // An odd step visits all columns.
    let step = (surface.num_surface / num.max(1)).max(1) | 1;
    let usable = surface.uses.iter().enumerate();
    usable
        .filter(|(_, used)| **used == Use::Surface)
        .step_by(step)
        .map(|(i, _)| i as u32)
        .collect()
}

/// Readings that [`middle_of`] averages, approximately.
const NUM_AVERAGED: usize = 500;

/// Returns the mean of a shot's readings, in camera space.
pub(super) fn middle_of(surface: &ShotSurface) -> Point3<f64> {
    let samples = samples_of(surface, NUM_AVERAGED);
    let sum: Vector3<f64> = samples
        .iter()
        .map(|&i| surface.points()[i as usize].coords.cast::<f64>())
        .sum();
    Point3::from(sum / samples.len().max(1) as f64)
}

/// Returns the refined poses of the shots, in order. `given` are the robot's poses.
pub fn register(
    surfaces: &[&ShotSurface],
    given: &[RigidTransform],
    params: &RegisterParams,
) -> Vec<RigidTransform> {
    // With many shots, each is paired with many others.
    let num_samples = params.num_samples * 8 / surfaces.len().max(8);
    let samples: Vec<Vec<u32>> = surfaces
        .iter()
        .map(|surface| samples_of(surface, num_samples))
        .collect();
    let mut poses = given.to_vec();
    for (scale, num_steps) in LEVELS {
        for _ in 0..num_steps {
            let posed: Vec<RegistrationShot<'_>> = surfaces
                .iter()
                .zip(&poses)
                .zip(&samples)
                .map(|((surface, pose), samples)| RegistrationShot {
                    surface,
                    base_from_camera: *pose,
                    samples,
                })
                .collect();
            let Some(steps) = step(&posed, given, scale, params) else {
                break;
            };
            for (pose, step) in poses.iter_mut().zip(&steps) {
                *pose = moved(pose, step);
            }
            if steps.iter().all(|step| step.amax() < SETTLED_STEP_M_RAD) {
                break;
            }
        }
    }
    poses
}

/// Applies a step to a pose: a rotation about the camera (first three, radians) and a shift (metres) in the base frame.
fn moved(pose: &RigidTransform, step: &Vector6<f64>) -> RigidTransform {
    let turn = UnitQuaternion::from_scaled_axis(step.fixed_rows::<3>(0).into_owned());
    let shift: Vector3<f64> = step.fixed_rows::<3>(3).into_owned();
    let mut rotation = turn * pose.rotation;
    rotation.renormalize();
    Isometry3::from_parts(
        Translation3::from(pose.translation.vector + shift),
        rotation,
    )
}

/// Computes one Gauss-Newton step for all cameras; `None` if the system cannot be solved.
fn step(
    posed: &[RegistrationShot<'_>],
    given: &[RigidTransform],
    scale: f64,
    params: &RegisterParams,
) -> Option<Vec<Vector6<f64>>> {
    let n = posed.len();
    let blocks = map_each(n, params.num_workers, |i| blocks_of(posed, i, scale));
    let mut matrix = DMatrix::zeros(6 * n, 6 * n);
    let mut right = DVector::zeros(6 * n);
    // Sum in the order of the shots, so that the number of threads does not matter.
    for (i, of_shot) in blocks.iter().enumerate() {
        for (j, block) in of_shot.iter().enumerate() {
            let Some(block) = block else { continue };
            let mut add = |row: usize, column: usize, values: &Matrix6<f64>| {
                let mut view = matrix.fixed_view_mut::<6, 6>(6 * row, 6 * column);
                view += values;
            };
            add(i, i, &block.own);
            add(j, j, &block.other);
            add(i, j, &block.cross);
            add(j, i, &block.cross.transpose());
            let mut own = right.fixed_rows_mut::<6>(6 * i);
            own += block.own_right;
            let mut other = right.fixed_rows_mut::<6>(6 * j);
            other += block.other_right;
        }
    }
    let (per_turn, per_shift) = (
        1.0 / params.prior_turn.0.powi(2),
        1.0 / params.prior_shift.0.powi(2),
    );
    for (i, (posed, given)) in posed.iter().zip(given).enumerate() {
        let turned = (posed.base_from_camera.rotation * given.rotation.inverse()).scaled_axis();
        let shifted = posed.base_from_camera.translation.vector - given.translation.vector;
        for axis in 0..3 {
            matrix[(6 * i + axis, 6 * i + axis)] += per_turn;
            right[6 * i + axis] -= per_turn * turned[axis];
            matrix[(6 * i + 3 + axis, 6 * i + 3 + axis)] += per_shift;
            right[6 * i + 3 + axis] -= per_shift * shifted[axis];
        }
    }
    let solved = matrix.cholesky()?.solve(&right);
    let all = (0..n).map(|i| solved.fixed_rows::<6>(6 * i).into_owned());
    Some(all.collect())
}

/// The normal equations of the pairs between one shot's samples and another shot.
struct Block {
    own: Matrix6<f64>,
    other: Matrix6<f64>,
    cross: Matrix6<f64>,
    own_right: Vector6<f64>,
    other_right: Vector6<f64>,
}

fn blocks_of(posed: &[RegistrationShot<'_>], i: usize, scale: f64) -> Vec<Option<Block>> {
    let own = &posed[i];
    let others = posed.iter().enumerate();
    others
        .map(|(j, other)| (i != j).then(|| block_of(own, other, scale)))
        .collect()
}

fn block_of(own: &RegistrationShot<'_>, other: &RegistrationShot<'_>, scale: f64) -> Block {
    let other_from_own = other.base_from_camera.inverse() * own.base_from_camera;
    let centre =
        |posed: &RegistrationShot<'_>| Point3::from(posed.base_from_camera.translation.vector);
    let (own_centre, other_centre) = (centre(own), centre(other));
    let mut block = Block {
        own: Matrix6::zeros(),
        other: Matrix6::zeros(),
        cross: Matrix6::zeros(),
        own_right: Vector6::zeros(),
        other_right: Vector6::zeros(),
    };
    for &i in own.samples {
        let met = meet(
            own.surface,
            i as usize,
            other.surface,
            &other_from_own,
            &other.base_from_camera,
            Reach {
                least: REACH * scale,
                sigmas: REACH * SIGMAS,
            },
        );
        let ProjectedReading::Pair(pair) = met else {
            continue;
        };
        let off = pair.off();
        let robust = (-(off / scale.max(SIGMAS * pair.sigma)).powi(2)).exp();
        let weight = robust / (CORRELATED * (pair.sigma.powi(2) + ERROR_FLOOR_M * ERROR_FLOOR_M));
        // off = n · (to - from); the own shot moves `from`, the other one `to`.
        let row = |at: &Point3<f64>, centre: &Point3<f64>| {
            let lever = (at - centre).cross(&pair.normal);
            let n = &pair.normal;
            Vector6::new(lever.x, lever.y, lever.z, n.x, n.y, n.z)
        };
        let own_row = row(&pair.from, &own_centre);
        let other_row = row(&pair.to, &other_centre);
        let weighted = own_row * weight;
        block.own += weighted * own_row.transpose();
        block.cross -= weighted * other_row.transpose();
        block.other += other_row * weight * other_row.transpose();
        block.own_right += weighted * off;
        block.other_right -= other_row * (weight * off);
    }
    block
}
