//! How fast the robot may move.

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
