//! A straight rail below an arm: a seventh axis.

use std::str::FromStr;

use nalgebra::{Unit, Vector3};

use super::ArmError;

/// A straight rail below an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rail {
    /// Direction of the rail in the frame of the path.
    pub direction: Unit<Vector3<f64>>,
    /// First and last position, metres from where the cell was calibrated.
    pub range: [f64; 2],
    /// Top speed, 0.001..10 m/s, if it moves along the path; none if it stands still.
    pub speed: Option<f64>,
    /// Greatest acceleration, 0.001..100 m/s²; none if not known.
    pub acceleration: Option<f64>,
}

/// Minimum length, metres: a shorter rail was probably given in metres.
const MIN_LENGTH_M: f64 = 0.1;

impl Rail {
    pub(super) fn checked(self) -> Result<Self, ArmError> {
        let [low, high] = self.range;
        let wrong_range = || {
            Err(ArmError::Rail {
                low: low * 1000.0,
                high: high * 1000.0,
            })
        };
        if !(low < high && low.abs().max(high.abs()) <= 100.0) {
            return wrong_range();
        }
        if self.speed.is_none() && !(low..=high).contains(&0.0) {
            return Err(ArmError::Standing {
                low: low * 1000.0,
                high: high * 1000.0,
            });
        }
        if let Some(speed) = self.speed
            && !(0.001..=10.0).contains(&speed)
        {
            return Err(ArmError::Value {
                what: "the rail's speed in mm/s".into(),
                value: speed * 1000.0,
            });
        }
        if let Some(acceleration) = self.acceleration
            && !(0.001..=100.0).contains(&acceleration)
        {
            return Err(ArmError::Value {
                what: "the rail's acceleration in mm/s²".into(),
                value: acceleration * 1000.0,
            });
        }
        if high - low < MIN_LENGTH_M {
            return wrong_range();
        }
        Ok(self)
    }

    /// Even positions from one end to the other, at most `step` metres apart unless that would be more than 1001.
    pub(super) fn positions(&self, step: f64) -> Vec<f64> {
        let [low, high] = self.range;
        let num = ((high - low) / step).ceil().clamp(1.0, 1000.0);
        let positions = (0..=num as usize).map(|i| low + (high - low) * i as f64 / num);
        positions.collect()
    }
}

impl FromStr for Rail {
    type Err = ArmError;

    /// Parses axis of the path's frame, first and last position and, if it moves along the path, top speed and
    /// optionally greatest acceleration, in millimetres and seconds: `y,-2000,2000,1000,2000`. `-y` runs the other way.
    fn from_str(text: &str) -> Result<Self, ArmError> {
        let wrong = || ArmError::NoRail { text: text.into() };
        let mut words = text.split(',').map(str::trim);
        let direction = match words.next() {
            Some("x") => Vector3::x(),
            Some("y") => Vector3::y(),
            Some("z") => Vector3::z(),
            Some("-x") => -Vector3::x(),
            Some("-y") => -Vector3::y(),
            Some("-z") => -Vector3::z(),
            _ => return Err(wrong()),
        };
        let numbers: Result<Vec<f64>, _> = words.map(str::parse::<f64>).collect();
        let numbers = numbers.map_err(|_no_number| wrong())?;
        let (low, high, speed, acceleration) = match numbers[..] {
            [low, high] => (low, high, None, None),
            [low, high, speed] => (low, high, Some(speed), None),
            [low, high, speed, acceleration] => (low, high, Some(speed), Some(acceleration)),
            _ => return Err(wrong()),
        };
        let rail = Self {
            direction: Unit::new_normalize(direction),
            range: [low / 1000.0, high / 1000.0],
            speed: speed.map(|speed| speed / 1000.0),
            acceleration: acceleration.map(|acceleration| acceleration / 1000.0),
        };
        rail.checked()
    }
}
