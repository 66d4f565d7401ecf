//! Ranges of the settings that the commands and the window share. A controller may allow less.

use std::ops::RangeInclusive;

/// Clearance of gun and arm from part, boxes and floor, mm.
pub const CLEARANCE_MM: RangeInclusive<f64> = 0.0..=1000.0;
/// Radius of the gun, mm; the check uses at most half the gun's length.
pub const GUN_RADIUS_MM: RangeInclusive<f64> = 1.0..=1000.0;
/// Speed where the path sets none, mm/s.
pub const SPEED_MM_S: RangeInclusive<f64> = 1.0..=5000.0;
/// Distance of the approach points, mm.
pub const APPROACH_MM: RangeInclusive<f64> = 10.0..=1000.0;
/// Blend radius, mm.
pub const BLEND_MM: RangeInclusive<f64> = 0.0..=100.0;
/// Maximum tilt of the nozzle, degrees.
pub const MAX_TILT_DEG: RangeInclusive<f64> = 0.0..=30.0;
/// Largest number of a digital output.
pub const MAX_GUN_OUTPUT: u16 = 9999;
