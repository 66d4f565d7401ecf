//! What the poses of the arm span: turns about a single axis leave the camera's place along that axis unconstrained.

use nalgebra::{Matrix3, Vector3};

use super::PosePair;
use geometry::units::{Metres, Radians};

/// What the poses of a calibration span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The largest turn of the flange between two poses.
    pub largest_turn: Radians,
    /// Root mean square turn about the second strongest axis, over all pairs of poses.
    pub other_turn: Radians,
    /// Unit axis in the flange frame about which it turned most; its sign is arbitrary.
    pub main_axis: Vector3<f64>,
    /// Largest distance between two target positions in the camera frame.
    pub travel: Metres,
}

impl Span {
    pub(super) fn of(pairs: &[PosePair]) -> Self {
        let mut scatter = Matrix3::zeros();
        let mut num = 0.0;
        let (mut largest_turn, mut travel) = (0.0_f64, 0.0_f64);
        for (i, a) in pairs.iter().enumerate() {
            for b in &pairs[i + 1..] {
                let turn = a.robot_from_flange.inv_mul(&b.robot_from_flange).rotation;
                let turn = turn.scaled_axis();
                scatter += turn * turn.transpose();
                num += 1.0;
                largest_turn = largest_turn.max(turn.norm());
                let seen = a.camera_from_target.translation.vector
                    - b.camera_from_target.translation.vector;
                travel = travel.max(seen.norm());
            }
        }
        let eigen = (scatter / f64::max(num, 1.0)).symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        Self {
            largest_turn: Radians(largest_turn),
            other_turn: Radians(eigen.eigenvalues[order[1]].max(0.0).sqrt()),
            main_axis: eigen.eigenvectors.column(order[0]).into_owned(),
            travel: Metres(travel),
        }
    }

    /// The main axis in words: the flange's x, y or z if it is nearly one of them.
    pub fn main_axis_in_words(&self) -> String {
        let axis = self.main_axis;
        // Within 15 degrees.
        let near = (0..3).find(|&i| axis[i].abs() > 0.966);
        match near {
            Some(i) => format!("the flange's {} axis", ["x", "y", "z"][i]),
            None => format!(
                "the flange's axis ({:.2}, {:.2}, {:.2})",
                axis.x, axis.y, axis.z
            ),
        }
    }
}
