//! The conventions in which controllers expect a pose.
//!
//! What each means, and the sources for it:
//!
//! | convention | rotation | units | source |
//! | --- | --- | --- | --- |
//! | KUKA | R = Rz(A)·Ry(B)·Rx(C) | mm, degrees | Basler `rc_visard`, *Pose formats*; Mech-Mind, *Euler angles*; Vathos, *Rotations* |
//! | FANUC | R = Rz(R)·Ry(P)·Rx(W) | mm, degrees | the same three |
//! | ABB | unit quaternion, q1 the scalar | mm | ABB, *RAPID reference manual*, data types `pos` and `orient`: `[1, 0, 0, 0]` is no rotation; Basler |
//! | Universal Robots | axis times angle | m, radians | Universal Robots, *Script manual*, module motion: a pose is a position and an axis-angle; Basler |
//! | Yaskawa | R = Rz(Rz)·Ry(Ry)·Rx(Rx) | mm, degrees | Basler; Mech-Mind; Vathos |
//! | Stäubli | R = Rx(rx)·Ry(ry)·Rz(rz) | mm, degrees | `RoboDK` as it writes VAL 3; Mech-Mind |
//! | Doosan | R = Rz(A)·Ry(B)·Rz(C) | mm, degrees | Mech-Mind; Vathos |
//!
//! Only the manuals of ABB and Universal Robots were available, and nothing was tried on a controller. Some controllers
//! can be set to other units or angles; this is their default. `assets/conventions.md` shows one pose in all
//! conventions.

use serde::{Deserialize, Serialize};

use super::{euler::Order, robot_pose::Unit};
use texts::{Described, Language, Message};

#[cfg(test)]
mod tests;

/// How a pose is written down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Convention {
    /// 4×4 matrix.
    #[default]
    Matrix,
    /// Position and quaternion, scalar last.
    QuaternionXyzw,
    /// Position and rotation vector.
    RotationVector,
    /// KUKA's X Y Z A B C.
    Kuka,
    /// FANUC's X Y Z W P R.
    Fanuc,
    /// ABB's pos and orient: quaternion, scalar first.
    Abb,
    /// Universal Robots' pose: position and rotation vector.
    UniversalRobots,
    /// Yaskawa's X Y Z Rx Ry Rz.
    Yaskawa,
    /// Stäubli's trsf.
    Staubli,
    /// Doosan's posx.
    Doosan,
}

/// How the rotation is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    Matrix,
    Xyzw,
    Wxyz,
    RotationVector,
    Angles {
        order: Order,
        /// True if the angle of the rightmost rotation comes first.
        reversed: bool,
    },
}

impl Convention {
    /// Every convention.
    pub const ALL: [Self; 10] = [
        Self::Matrix,
        Self::QuaternionXyzw,
        Self::RotationVector,
        Self::Kuka,
        Self::Fanuc,
        Self::Abb,
        Self::UniversalRobots,
        Self::Yaskawa,
        Self::Staubli,
        Self::Doosan,
    ];

    /// The name on the command line, in JSON and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Matrix => "matrix",
            Self::QuaternionXyzw => "quaternion-xyzw",
            Self::RotationVector => "rotation-vector",
            Self::Kuka => "kuka",
            Self::Fanuc => "fanuc",
            Self::Abb => "abb",
            Self::UniversalRobots => "universal-robots",
            Self::Yaskawa => "yaskawa",
            Self::Staubli => "staubli",
            Self::Doosan => "doosan",
        }
    }

    /// Finds the convention with this [`name`](Self::name).
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|convention| convention.name() == name)
    }

    /// The name shown to people, in English.
    pub fn title(self) -> String {
        self.to_string()
    }

    /// Order, axes and units of the numbers, in full and in English.
    pub fn meaning(self) -> String {
        let meaning = self.message().attribute(Language::English, "meaning");
        meaning.unwrap_or_default()
    }

    /// The names of the numbers, in order.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Matrix => &[
                "r11", "r12", "r13", "x", "r21", "r22", "r23", "y", "r31", "r32", "r33", "z",
                "m41", "m42", "m43", "m44",
            ],
            Self::QuaternionXyzw => &["x", "y", "z", "qx", "qy", "qz", "qw"],
            Self::Abb => &["x", "y", "z", "q1", "q2", "q3", "q4"],
            Self::Kuka | Self::Doosan => &["X", "Y", "Z", "A", "B", "C"],
            Self::Fanuc => &["X", "Y", "Z", "W", "P", "R"],
            Self::Yaskawa => &["X", "Y", "Z", "Rx", "Ry", "Rz"],
            Self::RotationVector | Self::UniversalRobots | Self::Staubli => {
                &["x", "y", "z", "rx", "ry", "rz"]
            }
        }
    }

    /// The unit of lengths.
    pub fn length_unit(self) -> Unit {
        match self {
            Self::Matrix | Self::QuaternionXyzw | Self::RotationVector | Self::UniversalRobots => {
                Unit::Metres
            }
            Self::Kuka | Self::Fanuc | Self::Abb | Self::Yaskawa | Self::Staubli | Self::Doosan => {
                Unit::Millimetres
            }
        }
    }

    /// The name and unit of each number, in order.
    pub fn named_units(self) -> impl Iterator<Item = (&'static str, Unit)> {
        self.names().iter().copied().zip(self.units())
    }

    /// The unit of each number, in order.
    pub(super) fn units(self) -> Vec<Unit> {
        let length = self.length_unit();
        let turn = match self.layout() {
            Layout::Matrix => {
                // x, y and z are the last numbers of the first three rows.
                let unit = |i| {
                    if i % 4 == 3 && i < 12 {
                        length
                    } else {
                        Unit::One
                    }
                };
                return (0..16).map(unit).collect();
            }
            Layout::Xyzw | Layout::Wxyz => Unit::One,
            Layout::RotationVector => Unit::Radians,
            Layout::Angles { .. } => Unit::Degrees,
        };
        let num = self.names().len();
        (0..num)
            .map(|i| if i < 3 { length } else { turn })
            .collect()
    }

    pub(super) fn layout(self) -> Layout {
        let angles = |order, reversed| Layout::Angles { order, reversed };
        match self {
            Self::Matrix => Layout::Matrix,
            Self::QuaternionXyzw => Layout::Xyzw,
            Self::Abb => Layout::Wxyz,
            Self::RotationVector | Self::UniversalRobots => Layout::RotationVector,
            Self::Kuka => angles(Order::Zyx, false),
            Self::Fanuc | Self::Yaskawa => angles(Order::Zyx, true),
            Self::Staubli => angles(Order::Xyz, false),
            Self::Doosan => angles(Order::Zyz, false),
        }
    }
}

impl Described for Convention {
    fn message(&self) -> Message {
        Message::new("convention").with("convention", self.name())
    }
}

texts::display!(Convention);
