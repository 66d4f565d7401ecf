//! Parameters of servoing.

use std::{ops::RangeInclusive, time::Duration};

use geometry::{
    error::Advice,
    rigid::PoseDelta,
    units::{Metres, Radians},
};

/// Parameters of a [`Servo`](crate::Servo).
#[derive(Clone, Debug, PartialEq)]
pub struct ServoParams {
    /// Share of the error that is reduced per second, 0.2..4 1/s. Raising it is faster, up to half of each acceleration
    /// divided by its speed.
    pub gain: f64,
    /// Limits of the motion.
    pub limits: Limits,
    /// The arm stops correcting at this error, 0.1..10 mm and 0.01..1°. Lowering it takes more corrections.
    pub deadband: PoseDelta,
    /// Largest error at the end with its bounds, 0.5..50 mm and 0.05..5°. Poses by a Kinect have bounds of 2 to 4 mm and 0.15 to
    /// 0.4°, with three times its noise of 4 to 7 mm and 0.3 to 0.6°; lowering the tolerance below those refuses each end.
    pub tolerance: PoseDelta,
    /// Least distance of flange, camera, nozzle and arm from part and obstacles, 5..500 mm.
    pub clearance: Metres,
    /// Largest plausible change of the part's pose from one accepted frame to the next, 3..100 mm and 0.5..10°. It must
    /// exceed what noise and a wrong calibration add, or the robot holds for nothing.
    pub max_step: PoseDelta,
    /// Largest error to start from, up to 2 m and 90°.
    pub max_error: PoseDelta,
    /// Greatest age of the last accepted frame while the robot moves, 0.1..2 s: longer than the delay and two frames.
    pub max_age: Duration,
    /// How long the robot holds before it stops for good, 0..60 s.
    pub patience: Duration,
    /// Longest time of all, 1..600 s.
    pub max_time: Duration,
    /// Number of frames that must agree before the robot starts, and again after the part has moved, 2..20.
    pub num_agreeing: usize,
    /// Number of frames that the goal is averaged over on the way, 1..30. Raising it moves more evenly, and later.
    pub num_averaged: usize,
    /// Number of accepted frames at rest that the end rests upon, 1..30.
    pub num_final: usize,
    /// How long the arm must have been at rest before such a frame, 0..2 s: arm and camera swing on.
    pub settle: Duration,
    /// Most corrections at rest, 1..30.
    pub max_rounds: usize,
    /// How far the arm may be from the way on which it was sent, 1..200 mm and 0.1..20°.
    pub max_astray: PoseDelta,
    /// How far the arm may be behind on that way, 0.02..2 s: longer than the delay of its controller.
    pub max_lag: Duration,
    /// Longest time between two states of the arm, 0.005..0.5 s.
    pub max_gap: Duration,
}

impl Default for ServoParams {
    fn default() -> Self {
        let within = |mm, degrees| PoseDelta {
            shift: Metres::from_mm(mm),
            rotation: Radians::from_degrees(degrees),
        };
        Self {
            gain: 2.0,
            limits: Limits::default(),
            deadband: within(0.5, 0.05),
            tolerance: within(8.0, 1.0),
            clearance: Metres::from_mm(50.0),
            max_step: within(30.0, 3.0),
            max_error: within(600.0, 60.0),
            max_age: Duration::from_millis(600),
            patience: Duration::from_secs(2),
            max_time: Duration::from_mins(1),
            num_agreeing: 3,
            num_averaged: 6,
            num_final: 6,
            settle: Duration::from_millis(200),
            max_rounds: 8,
            max_astray: within(30.0, 4.0),
            max_lag: Duration::from_millis(400),
            max_gap: Duration::from_millis(100),
        }
    }
}

/// Limits of the motion of flange, camera, nozzle and tools. Speeds and accelerations are those of the point that moves most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Speed, 0.005..1 m/s.
    pub speed: f64,
    /// Acceleration, 0.05..10 m/s². It must allow `speed` · `turn_speed` twice over, which a turn at full speed needs.
    pub acceleration: f64,
    /// Angular speed, 0.005..2 rad/s.
    pub turn_speed: f64,
    /// Angular acceleration, 0.05..20 rad/s².
    pub turn_acceleration: f64,
}

impl Default for Limits {
    /// Below the 250 mm/s of a robot that is set up by hand.
    fn default() -> Self {
        Self {
            speed: 0.2,
            acceleration: 1.0,
            turn_speed: 20_f64.to_radians(),
            turn_acceleration: 120_f64.to_radians(),
        }
    }
}

impl Limits {
    /// The acceleration left for changes of the twist: at the same twist, a point of the robot that turns is accelerated too.
    pub(crate) fn acceleration_left(&self) -> f64 {
        self.acceleration - self.speed * self.turn_speed
    }
}

/// A parameter out of its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[error("{what} is {value}, expected {low} to {high}")]
#[advice = "Set {what} to {low} to {high}"]
pub struct ServoError {
    /// The parameter, with its unit.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

impl ServoParams {
    /// Valid speeds, mm/s.
    pub const SPEEDS_MM_S: RangeInclusive<f64> = 5.0..=1000.0;
    /// Valid tolerances, mm.
    pub const TOLERANCES_MM: RangeInclusive<f64> = 0.5..=50.0;
    /// Valid least distances, mm.
    pub const CLEARANCES_MM: RangeInclusive<f64> = 5.0..=500.0;

    /// The default parameters with another speed, mm/s, tolerance and least distance.
    pub fn limited(
        speed_mm_s: f64,
        tolerance: Metres,
        clearance: Metres,
    ) -> Result<Self, ServoError> {
        let mut params = Self::default();
        params.limits.speed = speed_mm_s / 1000.0;
        // A robot that goes faster must brake as soon.
        params.limits.acceleration = params.limits.acceleration.max(5.0 * params.limits.speed);
        params.tolerance.shift = tolerance;
        params.clearance = clearance;
        params.checked()
    }

    /// Returns the parameters if all are within their ranges.
    pub fn checked(self) -> Result<Self, ServoError> {
        let limits = &self.limits;
        let turn = |rotation: Radians| rotation.degrees();
        // The robot must be able to brake as fast as the error shrinks, with as much again to follow changes of the goal.
        let most_gain = (0.5 * limits.acceleration_left() / limits.speed)
            .min(0.5 * limits.turn_acceleration / limits.turn_speed)
            .min(4.0);
        let of = |what, value, range: RangeInclusive<f64>| {
            let (low, high) = range.into_inner();
            (what, value, low, high)
        };
        for (what, value, low, high) in [
            of("the speed, mm/s", 1000.0 * limits.speed, Self::SPEEDS_MM_S),
            ("the angular speed, rad/s", limits.turn_speed, 0.005, 2.0),
            (
                "the acceleration, m/s²",
                limits.acceleration,
                (2.0 * limits.speed * limits.turn_speed).max(0.05),
                10.0,
            ),
            (
                "the angular acceleration, rad/s²",
                limits.turn_acceleration,
                0.05,
                20.0,
            ),
            ("the gain, 1/s", self.gain, 0.2, most_gain),
            ("the deadband, mm", self.deadband.shift.mm(), 0.1, 10.0),
            ("the deadband, °", turn(self.deadband.rotation), 0.01, 1.0),
            of(
                "the tolerance, mm",
                self.tolerance.shift.mm(),
                Self::TOLERANCES_MM,
            ),
            ("the tolerance, °", turn(self.tolerance.rotation), 0.05, 5.0),
            of(
                "the least distance, mm",
                self.clearance.mm(),
                Self::CLEARANCES_MM,
            ),
            ("the largest step, mm", self.max_step.shift.mm(), 3.0, 100.0),
            (
                "the largest step, °",
                turn(self.max_step.rotation),
                0.5,
                10.0,
            ),
            (
                "the largest error, mm",
                self.max_error.shift.mm(),
                1.0,
                2000.0,
            ),
            (
                "the largest error, °",
                turn(self.max_error.rotation),
                1.0,
                90.0,
            ),
            ("the greatest age, s", self.max_age.as_secs_f64(), 0.1, 2.0),
            ("the patience, s", self.patience.as_secs_f64(), 0.0, 60.0),
            (
                "the longest time, s",
                self.max_time.as_secs_f64(),
                1.0,
                600.0,
            ),
            ("the frames that agree", self.num_agreeing as f64, 2.0, 20.0),
            ("the frames averaged", self.num_averaged as f64, 1.0, 30.0),
            ("the frames at the end", self.num_final as f64, 1.0, 30.0),
            ("the time to settle, s", self.settle.as_secs_f64(), 0.0, 2.0),
            ("the most corrections", self.max_rounds as f64, 1.0, 30.0),
            ("the way astray, mm", self.max_astray.shift.mm(), 1.0, 200.0),
            (
                "the way astray, °",
                turn(self.max_astray.rotation),
                0.1,
                20.0,
            ),
            ("the longest lag, s", self.max_lag.as_secs_f64(), 0.02, 2.0),
            ("the longest gap, s", self.max_gap.as_secs_f64(), 0.005, 0.5),
        ] {
            if !(low..=high).contains(&value) {
                return Err(ServoError {
                    what,
                    value,
                    low,
                    high,
                });
            }
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_sound_and_a_gain_for_which_the_robot_brakes_too_slowly_is_not() {
        assert_eq!(ServoParams::default().checked(), Ok(ServoParams::default()));
        let mut lazy = ServoParams::default();
        lazy.limits.acceleration = 0.3;
        assert_eq!(lazy.checked().map_err(|e| e.what), Err("the gain, 1/s"));
        for broken in [f64::NAN, f64::INFINITY, -1.0] {
            let mut params = ServoParams::default();
            params.limits.speed = broken;
            assert_eq!(params.checked().map_err(|e| e.what), Err("the speed, mm/s"));
        }
    }
}
