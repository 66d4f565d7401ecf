//! Parses a pose as a person writes it: six numbers with optional units.

use super::rigid::{RigidTransform, from_euler_zyx};
use crate::{
    error::Advice,
    units::{Metres, Radians},
};

/// A pose as a person wrote it, with doubts about its units.
#[derive(Clone, Debug)]
pub struct GivenPose {
    /// The pose as parsed.
    pub pose: RigidTransform,
    /// Numbers that were probably meant in another unit.
    pub doubts: Vec<UnitDoubt>,
}

/// A number of a pose that was probably meant in another unit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[error("{what} {word} is {value}; did you mean {meant}?")]
#[advice = "Write the unit after the number: deg or rad, mm, cm or m"]
pub struct UnitDoubt {
    what: &'static str,
    word: String,
    value: String,
    meant: String,
}

/// Parses "rx ry rz x y z" as the paper writes its T1..T5 (eq. 15): radians and metres, R = Rz·Ry·Rx. A number may
/// carry its own unit: `90deg`, `90°`, `800mm`, `80cm`.
pub fn parse_pose(text: &str) -> Result<GivenPose, String> {
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
        .collect();
    let words = <[&str; 6]>::try_from(words).map_err(|words| {
        format!(
            "found {} numbers, expected six: three angles (radians, or 90deg) and three lengths (metres, or 800mm)",
            words.len()
        )
    })?;
    let mut numbers = [0.0; 6];
    let mut doubts = Vec::new();
    for (i, (number, word)) in numbers.iter_mut().zip(words).enumerate() {
        *number = parse_number(word, if i < 3 { &ANGLES } else { &LENGTHS })?;
        doubts.extend(if i < 3 {
            doubt_angle(word, Radians(*number))
        } else {
            doubt_length(word, Metres(*number))
        });
    }
    Ok(GivenPose {
        pose: from_euler_zyx(numbers),
        doubts,
    })
}

/// Angle units and their size in radians.
const ANGLES: [(&str, f64); 3] = [
    ("deg", std::f64::consts::PI / 180.0),
    ("°", std::f64::consts::PI / 180.0),
    ("rad", 1.0),
];

/// Length units and their size in metres; `m` last, because the others end in it.
const LENGTHS: [(&str, f64); 3] = [("mm", 0.001), ("cm", 0.01), ("m", 1.0)];

/// Longest plausible length, metres: no cell is larger.
const MAX_LENGTH_M: f64 = 10.0;

/// Doubts an angle of more than a full turn, unless its unit was written.
fn doubt_angle(word: &str, angle: Radians) -> Option<UnitDoubt> {
    let is_bare = word.parse::<f64>().is_ok();
    (is_bare && angle.0.abs() > std::f64::consts::TAU).then(|| UnitDoubt {
        what: "the angle",
        word: word.to_owned(),
        value: format!("{word} rad, {:.0} degrees", angle.degrees()),
        meant: format!("{word}deg"),
    })
}

fn doubt_length(word: &str, length: Metres) -> Option<UnitDoubt> {
    (length.0.abs() > MAX_LENGTH_M).then(|| UnitDoubt {
        what: "the length",
        word: word.to_owned(),
        value: format!("{:.0} m", length.0),
        meant: format!("{}mm", word.trim_end_matches(char::is_alphabetic)),
    })
}

/// Parses a number with one of the given units, or with none.
fn parse_number(word: &str, units: &[(&str, f64)]) -> Result<f64, String> {
    let with_unit = units
        .iter()
        .find_map(|(unit, factor)| word.strip_suffix(unit).map(|number| (number, *factor)));
    let (number, factor) = with_unit.unwrap_or((word, 1.0));
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number * factor),
        _ => {
            let names: Vec<&str> = units.iter().map(|(unit, _)| *unit).collect();
            Err(format!(
                "{word:?} is not a number with {} or no unit",
                names.join(", ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_numbers_are_radians_and_metres_or_what_their_unit_says() {
        let plain = parse_pose("0 0 1.5707963267948966, 1 -0.0205 0")
            .expect("six numbers")
            .pose;
        let units = parse_pose("0° 0rad 90deg 100cm -20.5mm 0m")
            .expect("six numbers")
            .pose;
        let moved = plain * nalgebra::Point3::new(1.0, 0.0, 0.0);
        assert!((moved - nalgebra::Point3::new(1.0, 0.9795, 0.0)).norm() < 1e-12);
        assert!((units.to_homogeneous() - plain.to_homogeneous()).norm() < 1e-12);
    }

    #[test]
    fn anything_else_is_refused() {
        for text in [
            "",
            "1 2 3",
            "0 0 0 0 0 0 0",
            "a b c d e f",
            "0 0 0 0 0 nan",
            "0 0 0 0 0 inf",
            "0 0 0 0 0 3in",
            "0mm 0 0 0 0 0",
            "0 0 0 0 0 90deg",
        ] {
            assert!(parse_pose(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_in_the_wrong_unit_are_doubted() {
        let doubts = |text| {
            let given = parse_pose(text).expect("six numbers");
            let doubts = given.doubts.iter().map(ToString::to_string);
            doubts.collect::<Vec<_>>().join("\n")
        };
        assert_eq!(doubts("3.14 0 -720deg 9 -9.5 1200mm"), "");
        let both = doubts("0 0 15 0 0 1200");
        assert!(both.contains("did you mean 15deg?"), "{both}");
        assert!(both.contains("did you mean 1200mm?"), "{both}");
        assert!(doubts("0 0 0 0 0 1200m").contains("did you mean 1200mm?"));
    }
}
