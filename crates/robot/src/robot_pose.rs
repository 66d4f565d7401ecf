//! Conversion of poses to and from the numbers of a convention.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::convention::{Convention, Layout};
use geometry::rigid::{RigidTransform, from_row_major, row_major};
use texts::{Described, Message};

/// What a number of a pose is counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub enum Unit {
    /// Metres.
    #[serde(rename = "m")]
    Metres,
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetres,
    /// Degrees.
    #[serde(rename = "deg")]
    Degrees,
    /// Radians.
    #[serde(rename = "rad")]
    Radians,
    /// A bare number.
    #[serde(rename = "1")]
    One,
}

impl Unit {
    /// The unit as written after a number; empty for a bare number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Metres => "m",
            Self::Millimetres => "mm",
            Self::Degrees => "deg",
            Self::Radians => "rad",
            Self::One => "",
        }
    }

    /// Decimals that a person needs: some micrometres, and millionths of a turn.
    fn num_decimals(self) -> usize {
        match self {
            Self::Millimetres => 3,
            Self::Degrees => 4,
            Self::Metres | Self::Radians => 6,
            Self::One => 8,
        }
    }

    /// Number of these units in a metre or a radian.
    fn per_base(self) -> f64 {
        match self {
            Self::Metres | Self::Radians | Self::One => 1.0,
            Self::Millimetres => 1000.0,
            Self::Degrees => 180.0 / std::f64::consts::PI,
        }
    }
}

/// One number of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RobotValue {
    /// Its name on the controller.
    pub name: &'static str,
    /// The number, to the last digit.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
}

impl RobotValue {
    /// The number rounded for people, without its unit.
    pub fn rounded(&self) -> String {
        fixed(self.value, self.unit.num_decimals())
    }
}

/// Formats a number with fixed decimals; one that rounds to zero has no minus sign.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.bytes().all(|c| matches!(c, b'-' | b'.' | b'0'));
    if is_zero {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

/// Whether three angles express a rotation reliably.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GimbalLock {
    /// They do, or the convention has no three angles.
    Clear,
    /// Within 0.6° of gimbal lock: the numbers are right together, but the first and the last angle change by many
    /// degrees where the pose hardly changes.
    Near,
    /// In gimbal lock: only the sum or difference of the first and the last angle counts, and one of them was set to 0.
    Locked,
}

/// A pose in the numbers of a convention, in the order in which the controller wants them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RobotPose {
    /// Which convention.
    pub convention: Convention,
    /// What it is: order, axes, units.
    pub meaning: String,
    /// The numbers.
    pub values: Vec<RobotValue>,
    /// Whether they are in gimbal lock.
    pub gimbal_lock: GimbalLock,
    /// Explanation of the gimbal lock for people; null if there is none.
    pub gimbal_note: Option<String>,
}

impl RobotPose {
    /// The bare numbers.
    pub fn numbers(&self) -> Vec<f64> {
        self.values.iter().map(|value| value.value).collect()
    }

    /// One line for people: each number with its name and unit.
    pub fn line(&self) -> String {
        let values = self.values.iter().map(|value| {
            let text = format!("{} {} {}", value.name, value.rounded(), value.unit.symbol());
            text.trim_end().to_owned()
        });
        values.collect::<Vec<_>>().join(", ")
    }
}

/// Why numbers are not a pose.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConventionError {
    /// Too few or too many numbers.
    Count {
        /// The convention.
        convention: Convention,
        /// Numbers given.
        found: usize,
        /// Numbers needed.
        needed: usize,
    },
    /// A number is infinite or NaN.
    NotFinite {
        /// Name of the number in the convention.
        name: &'static str,
        /// The number.
        value: f64,
    },
    /// The quaternion is not of unit length.
    NotUnit {
        /// Its length.
        length: f64,
    },
    /// The rotation vector is longer than a full turn: the unit is wrong.
    LongRotation {
        /// Its length.
        length: f64,
    },
    /// The matrix also stretches or mirrors.
    NotRigid,
}

impl Described for ConventionError {
    fn message(&self) -> Message {
        match self {
            Self::Count {
                convention,
                found,
                needed,
            } => Message::new("written-count")
                .with("convention", convention.name())
                .with("names", &*convention.names().join(" "))
                .with("needed", *needed as f64)
                .with("found", *found as f64),
            Self::NotFinite { name, value } => Message::new("written-not-finite")
                .with("name", *name)
                .with("value", &*value.to_string()),
            Self::NotUnit { length } => Message::new("written-not-unit").with("length", *length),
            Self::LongRotation { length } => {
                Message::new("written-long-rotation").with("length", *length)
            }
            Self::NotRigid => Message::new("written-not-rigid"),
        }
    }
}

texts::display!(ConventionError);

/// Tolerance for a unit quaternion, a full turn and a rigid matrix: people copy at least four decimals.
const COPY_TOLERANCE: f64 = 1e-3;

impl Convention {
    /// Converts a pose to the numbers of this convention.
    pub fn write(self, pose: &RigidTransform) -> RobotPose {
        let rotation = &pose.rotation;
        let mut gimbal_lock = GimbalLock::Clear;
        let turn: Vec<f64> = match self.layout() {
            Layout::Matrix => Vec::new(),
            Layout::Xyzw | Layout::Wxyz => {
                // Of a rotation's two quaternions, take the one whose scalar is not negative.
                let sign = if rotation.w < 0.0 { -1.0 } else { 1.0 };
                let [x, y, z, w] =
                    [rotation.i, rotation.j, rotation.k, rotation.w].map(|q| q * sign);
                match self.layout() {
                    Layout::Wxyz => vec![w, x, y, z],
                    _ => vec![x, y, z, w],
                }
            }
            Layout::RotationVector => rotation.scaled_axis().as_slice().to_vec(),
            Layout::Angles { order, reversed } => {
                let (mut angles, lock) = order.angles(rotation);
                gimbal_lock = lock;
                if reversed {
                    angles.reverse();
                }
                angles.to_vec()
            }
        };
        let shift = pose.translation.vector;
        let numbers: Vec<f64> = match self.layout() {
            Layout::Matrix => row_major(pose).to_vec(),
            _ => shift.iter().copied().chain(turn).collect(),
        };
        let values = self.names().iter().zip(self.units()).zip(numbers);
        let values = values.map(|((name, unit), number)| RobotValue {
            name,
            // Adding 0 turns -0 into 0.
            value: number * unit.per_base() + 0.0,
            unit,
        });
        RobotPose {
            convention: self,
            meaning: self.meaning(),
            values: values.collect(),
            gimbal_note: self.gimbal_note(gimbal_lock),
            gimbal_lock,
        }
    }

    /// Returns the pose given by these numbers, which are in the convention's order and units.
    pub fn read(self, numbers: &[f64]) -> Result<RigidTransform, ConventionError> {
        let names = self.names();
        if numbers.len() != names.len() {
            return Err(ConventionError::Count {
                convention: self,
                found: numbers.len(),
                needed: names.len(),
            });
        }
        if let Some((value, name)) = numbers
            .iter()
            .zip(names)
            .find(|(value, _)| !value.is_finite())
        {
            return Err(ConventionError::NotFinite {
                name,
                value: *value,
            });
        }
        let base: Vec<f64> = numbers
            .iter()
            .zip(self.units())
            .map(|(number, unit)| number / unit.per_base())
            .collect();
        let rotation = match (self.layout(), base.as_slice()) {
            (Layout::Matrix, all) => {
                let all = <[f64; 16]>::try_from(all).ok();
                let rigid = all.and_then(|all| from_row_major(&all, COPY_TOLERANCE));
                return rigid.ok_or(ConventionError::NotRigid);
            }
            (Layout::Xyzw, &[_, _, _, x, y, z, w]) | (Layout::Wxyz, &[_, _, _, w, x, y, z]) => {
                let quaternion = Quaternion::new(w, x, y, z);
                let length = quaternion.norm();
                if !((length - 1.0).abs() < COPY_TOLERANCE) {
                    return Err(ConventionError::NotUnit { length });
                }
                UnitQuaternion::from_quaternion(quaternion)
            }
            (Layout::RotationVector, &[_, _, _, x, y, z]) => {
                let turn = Vector3::new(x, y, z);
                let length = turn.norm();
                if length > TAU + COPY_TOLERANCE {
                    return Err(ConventionError::LongRotation { length });
                }
                UnitQuaternion::from_scaled_axis(turn)
            }
            (Layout::Angles { order, reversed }, &[_, _, _, a, b, c]) => {
                order.rotation(if reversed { [c, b, a] } else { [a, b, c] })
            }
            _ => unreachable!("every layout has as many numbers as names"),
        };
        let shift = Translation3::new(base[0], base[1], base[2]);
        Ok(Isometry3::from_parts(shift, rotation))
    }

    fn gimbal_note(self, lock: GimbalLock) -> Option<String> {
        let Layout::Angles { reversed, .. } = self.layout() else {
            return None;
        };
        let [first, middle, last] = *self.names().last_chunk::<3>()?;
        // γ is the angle that was set to 0.
        let zeroed = if reversed { first } else { last };
        match lock {
            GimbalLock::Clear => None,
            GimbalLock::Near => Some(format!(
                "near gimbal lock: {first} and {last} are right together, but may jump from one pose to the next"
            )),
            GimbalLock::Locked => Some(format!(
                "gimbal lock at this {middle}: {first} and {last} turn about the same axis, so {zeroed} was set to 0"
            )),
        }
    }
}
