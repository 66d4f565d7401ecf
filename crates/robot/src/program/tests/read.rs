//! What the languages' readers find in a program, and what they share.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use geometry::rigid::RigidTransform;

/// A move as a controller would run it.
#[derive(Clone, Debug)]
pub(in crate::program) struct Move {
    pub(in crate::program) to: RigidTransform,
    /// Speed, m/s; none for a joint move.
    pub(in crate::program) speed: Option<f64>,
    /// Gun state on the way.
    pub(in crate::program) is_gun_on: bool,
    /// True if the robot stops at the point, false if it may cut the corner.
    pub(in crate::program) is_exact: bool,
    /// Acceleration, m/s²; none if the program states none, or for a joint move.
    pub(in crate::program) acceleration: Option<f64>,
    /// The gun switches this far before the end of the move instead of at it, metres.
    pub(in crate::program) switches_before: f64,
    /// The configuration there, as written.
    pub(in crate::program) configuration: String,
    /// Position of the first external axis, metres; none if not written.
    pub(in crate::program) rail: Option<f64>,
}

/// Content of a program.
#[derive(Debug, Default)]
pub(in crate::program) struct Read {
    pub(in crate::program) name: String,
    pub(in crate::program) tool: String,
    pub(in crate::program) output: String,
    pub(in crate::program) comments: Vec<String>,
    pub(in crate::program) moves: Vec<Move>,
    /// Names of called programs, in order.
    pub(in crate::program) calls: Vec<String>,
    /// Number of what moves the frame; empty if it stands still.
    pub(in crate::program) tracking: String,
    /// Direction in which it moves, in the robot's base frame, where the program says it.
    pub(in crate::program) direction: Option<Vector3<f64>>,
    /// True if the program ends the following.
    pub(in crate::program) has_left: bool,
    /// Gun state after the last line.
    pub(in crate::program) is_gun_on: bool,
}

/// What the tests know of a language, by the controllers' manuals and independently of its table and its writer.
pub(in crate::program) struct Reader {
    /// Reads a program.
    pub(in crate::program) read: fn(&str) -> Read,
    /// Name in the text of a program named `paint`; empty if programs do not contain their names.
    pub(in crate::program) program_name: &'static str,
    /// Tool if none is given; empty if programs name none.
    pub(in crate::program) tool: &'static str,
    /// Acceleration of linear moves for a path of which it is unknown, and for one with 4 m/s².
    pub(in crate::program) accelerations: [Option<f64>; 2],
    /// Largest rounding error of a written speed, m/s.
    pub(in crate::program) speed_step: f64,
    /// True if the robot stops where the gun switches.
    pub(in crate::program) stops: bool,
    /// Metres before a point with a blend of 5 mm at which the gun switches.
    pub(in crate::program) switches_before: f64,
}

/// All numbers in a text.
pub(in crate::program) fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || matches!(c, '-' | '.')))
        .filter_map(|word| word.parse().ok())
        .collect()
}

pub(in crate::program) fn between<'a>(text: &'a str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text
        .split_once(begin)
        .unwrap_or_else(|| panic!("{begin} in {text}"));
    rest.split_once(end)
        .unwrap_or_else(|| panic!("{end} in {text}"))
        .0
}

pub(in crate::program) fn about(axis: Vector3<f64>, degrees: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(axis * degrees.to_radians())
}

/// A pose from millimetres and a rotation.
pub(in crate::program) fn placed(mm: &[f64], rotation: UnitQuaternion<f64>) -> RigidTransform {
    Isometry3::from_parts(
        Translation3::new(mm[0] / 1000.0, mm[1] / 1000.0, mm[2] / 1000.0),
        rotation,
    )
}

/// Turns about the fixed x, then the fixed y, then the fixed z.
pub(in crate::program) fn fixed_xyz(mm: &[f64], rx: f64, ry: f64, rz: f64) -> RigidTransform {
    let turn = about(Vector3::z(), rz) * about(Vector3::y(), ry) * about(Vector3::x(), rx);
    placed(mm, turn)
}
