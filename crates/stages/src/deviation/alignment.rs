//! Aligns a part with its reference by what most of its surface says, so that a dent stays where it is.
//!
//! Gauss-Newton steps on the signed distances to the surface, with Tukey's biweight: what lies further off than five times the
//! spread of all counts nothing (A. E. Beaton and J. W. Tukey, "The fitting of power series, meaning polynomials, illustrated on
//! band-spectroscopic data", Technometrics 16(2), 1974). A prior holds the directions that a flat sheet leaves open.

use nalgebra::{Isometry3, Matrix6, Translation3, UnitQuaternion, Vector3, Vector6};

use super::{readings::NodeReadings, surface::Surface};
use geometry::{rigid::RigidTransform, statistics::median};

/// Standard deviations of the normal distribution per median of magnitudes.
pub(super) const DEVIATIONS_PER_MEDIAN: f64 = 1.4826;
/// Where the biweight ends, in standard deviations.
const BIWEIGHT_DEVIATIONS: f64 = 4.685;
/// The smallest spread that is believed, metres.
pub(super) const MIN_SPREAD_M: f64 = 1e-4;
/// Number of reweighted fits.
const NUM_FITS: usize = 8;
/// Number of nodes that share one error: their reference and the camera's rounding are alike over centimetres.
const NODES_PER_ERROR: f64 = 20.0;
/// How far off the pose of an accepted part may be, radians and metres: standard deviations of the prior.
const POSE_TURN: f64 = 0.006;
const POSE_SHIFT_M: f64 = 0.003;

/// A small motion about a point of part space.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallMotion {
    about: Vector3<f64>,
    /// Turn, radians, and shift, metres.
    twist: Vector6<f64>,
}

impl SmallMotion {
    /// Finds the motion after which most of the readings lie on the surface.
    pub(super) fn onto(surface: &Surface<'_>, readings: &NodeReadings) -> Self {
        let nodes = (0..surface.points.len()).filter(|node| readings.num(*node) > 0.0);
        let nodes: Vec<usize> = nodes.collect();
        let mut motion = Self {
            about: surface.middle(&nodes).coords,
            twist: Vector6::zeros(),
        };
        let pairs: Vec<(Vector6<f64>, f64)> = (nodes.iter())
            .filter_map(|node| Some((motion.change_of(surface, *node), readings.mean(*node)?)))
            .collect();
        for _ in 0..NUM_FITS {
            let left = |(change, off): &(Vector6<f64>, f64)| off + change.dot(&motion.twist);
            let Some(spread) = median(pairs.iter().map(|pair| left(pair).abs())) else {
                break;
            };
            let spread = (DEVIATIONS_PER_MEDIAN * spread).max(MIN_SPREAD_M);
            let mut stiffness = Matrix6::<f64>::zeros();
            let mut pull = Vector6::<f64>::zeros();
            for (change, off) in &pairs {
                let weight = biweight(left(&(*change, *off)), spread);
                let weight = weight / (spread * spread * NODES_PER_ERROR);
                stiffness += change * change.transpose() * weight;
                pull -= change * (weight * off);
            }
            for axis in 0..3 {
                stiffness[(axis, axis)] += 1.0 / (POSE_TURN * POSE_TURN);
                stiffness[(axis + 3, axis + 3)] += 1.0 / (POSE_SHIFT_M * POSE_SHIFT_M);
            }
            let Some(solved) = stiffness.cholesky() else {
                break;
            };
            motion.twist = solved.solve(&pull);
        }
        motion
    }

    /// How much further outside a reading at a node lies after the motion, metres.
    pub(super) fn off_by(&self, surface: &Surface<'_>, node: usize) -> f64 {
        self.change_of(surface, node).dot(&self.twist)
    }

    /// The pose after the motion.
    pub(super) fn applied(&self, part_from_camera: &RigidTransform) -> RigidTransform {
        let turn = self.twist.fixed_rows::<3>(0).into_owned();
        let turn = UnitQuaternion::from_scaled_axis(turn);
        let shift = self.twist.fixed_rows::<3>(3).into_owned();
        // About its own middle.
        let shift = shift + self.about - turn * self.about;
        let mut moved = Isometry3::from_parts(Translation3::from(shift), turn) * part_from_camera;
        moved.rotation.renormalize();
        moved
    }

    /// Change of the distance at a node by turn and shift.
    fn change_of(&self, surface: &Surface<'_>, node: usize) -> Vector6<f64> {
        let normal: Vector3<f64> = surface.normals[node].cast();
        let arm = surface.points[node].coords.cast::<f64>() - self.about;
        let turn = arm.cross(&normal);
        Vector6::new(turn.x, turn.y, turn.z, normal.x, normal.y, normal.z)
    }
}

/// Tukey's biweight of a value, 0..1.
pub(super) fn biweight(value: f64, spread: f64) -> f64 {
    let share = value / (BIWEIGHT_DEVIATIONS * spread);
    (1.0 - share * share).max(0.0).powi(2)
}
