//! Refuses an arm, a path or parameters that cannot be checked.

use super::{ArmError, ArmPoint, CheckParams, GUN_RADIUS_M, PlacedArm, kinematics::Solver};
use crate::spray::MOST_TILT;
use geometry::{rigid::is_finite, units::Metres};

/// Minimum radius of the gun, metres: a gun of radius 0 is a line, and collisions of its body are not checked.
const MIN_GUN_RADIUS_M: f64 = 0.001;
/// The foot of an arm may be this far below the floor, metres.
pub(super) const PIT_DEPTH_M: f64 = 0.1;
/// Maximum number of turns about the nozzle's axis: steps of 5°.
const MAX_TURNS: usize = 72;

/// Returns an error if arm, path or parameters cannot be checked; it numbers points from 1.
pub(super) fn validate(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<(), ArmError> {
    let not_finite = |what: String| Err(ArmError::NotFinite { what });
    if points.is_empty() {
        return Err(ArmError::NoPoints);
    }
    let (base, nozzle) = (&placed.robot_from_base, &placed.flange_from_nozzle);
    let approach = params.approach.unwrap_or(0.0);
    for (is_sound, what) in [
        (is_finite(base), "the pose of the arm's base"),
        (is_finite(nozzle), "the pose of the nozzle on the flange"),
        (params.rail.is_finite(), "the position of the rail"),
        (approach.is_finite(), "the distance of the approach point"),
    ] {
        if !is_sound {
            return not_finite(what.into());
        }
    }
    if !(1..=MAX_TURNS).contains(&params.num_turns) {
        return Err(ArmError::Value {
            what: "the number of turns about the nozzle's axis".into(),
            value: params.num_turns as f64,
        });
    }
    if !(0.0..=MOST_TILT.0 + 1e-9).contains(&params.max_tilt) {
        return Err(ArmError::Value {
            what: "the maximum tilt of the nozzle".into(),
            value: params.max_tilt,
        });
    }
    if let Some(rail) = placed.arm.rail {
        rail.checked()?;
    }
    for (what, value, low) in [
        ("the radius of the gun", placed.gun_radius, MIN_GUN_RADIUS_M),
        ("the clearance", placed.obstacles.clearance, 0.0),
    ] {
        let high = 1.0;
        if !(low..=high).contains(&value) {
            return Err(ArmError::Length {
                what,
                value: Metres(value),
                low: Metres(low),
                high: Metres(high),
            });
        }
    }
    let most = placed.most_gun_radius();
    if most > 0.0 && placed.gun_radius > most.max(GUN_RADIUS_M) {
        return Err(ArmError::Length {
            what: "the radius of the gun",
            value: Metres(placed.gun_radius),
            low: Metres(MIN_GUN_RADIUS_M),
            high: Metres(most),
        });
    }
    let below = Solver::new(placed, params.rail).foot_below_floor();
    if let Some(above) = below.filter(|below| *below > PIT_DEPTH_M) {
        return Err(ArmError::Floor {
            above: Metres(above),
        });
    }
    for (i, point) in points.iter().enumerate() {
        let is_speed = point.speed > 0.0 && point.speed < 100.0;
        if !(is_finite(&point.robot_from_nozzle) && point.aim.is_finite() && is_speed) {
            return not_finite(format!("the pose or speed of point {}", i + 1));
        }
    }
    Ok(())
}
