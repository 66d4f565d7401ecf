//! Pairs that repeat a pose of the arm: a line that was copied, or several captures between two movements.
//!
//! Such pairs share the errors of the arm and of the target's place in the picture, so they count as one pair, with the
//! mean of their camera poses. Counted by themselves they would make the bounds too small, and the pairs that are not
//! repeated suspect.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::PosePair;
use geometry::{
    rigid::{PoseDelta, RigidTransform, pose_error},
    units::{Metres, Radians},
};

/// An arm that did not move returns the same pose, up to the last digit that its controller shows.
const SAME_ARM: PoseDelta = PoseDelta {
    rotation: Radians(2e-4),
    shift: Metres(1e-4),
};
/// The camera's noise; poses of one target that differ more contradict each other and stay pairs of their own.
const SAME_TARGET: PoseDelta = PoseDelta {
    rotation: Radians(0.01),
    shift: Metres(0.005),
};

/// Returns the pairs with repeats as one, in the order of their first; its name lists them all.
pub(super) fn different(pairs: &[PosePair]) -> Vec<PosePair> {
    let mut groups: Vec<Vec<&PosePair>> = Vec::new();
    for pair in pairs {
        let group = groups.iter_mut().find(|group| repeats(group[0], pair));
        match group {
            Some(group) => group.push(pair),
            None => groups.push(vec![pair]),
        }
    }
    groups.iter().map(|group| merged(group)).collect()
}

fn repeats(first: &PosePair, pair: &PosePair) -> bool {
    let is_within = |a: &RigidTransform, b: &RigidTransform, limit: PoseDelta| {
        let off = pose_error(a, b, &Point3::origin());
        off.shift <= limit.shift && off.rotation <= limit.rotation
    };
    is_within(&first.robot_from_flange, &pair.robot_from_flange, SAME_ARM)
        && is_within(
            &first.camera_from_target,
            &pair.camera_from_target,
            SAME_TARGET,
        )
}

fn merged(group: &[&PosePair]) -> PosePair {
    let (first, num) = (group[0], group.len() as f64);
    if group.len() == 1 {
        return first.clone();
    }
    let start = &first.camera_from_target;
    let shifts = group
        .iter()
        .map(|pair| pair.camera_from_target.translation.vector);
    let turns = group.iter().map(|pair| {
        let turn = pair.camera_from_target.rotation * start.rotation.inverse();
        turn.scaled_axis()
    });
    let turn = UnitQuaternion::from_scaled_axis(turns.sum::<Vector3<f64>>() / num);
    let names: Vec<&str> = group.iter().map(|pair| pair.name.as_str()).collect();
    PosePair {
        name: names.join(", "),
        robot_from_flange: first.robot_from_flange,
        camera_from_target: Isometry3::from_parts(
            Translation3::from(shifts.sum::<Vector3<f64>>() / num),
            turn * start.rotation,
        ),
    }
}
