//! A robot pose written by a person: the name of its convention, then the numbers. Sixteen bare numbers are a matrix.

use std::ops::RangeInclusive;

use nalgebra::Vector3;

use super::{Convention, ConventionError};
use files::Row;
use geometry::{rigid::RigidTransform, units::Metres};
use texts::{Described, Message};

/// A pose that a person wrote, and its convention.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenPose {
    /// The pose, in metres.
    pub pose: RigidTransform,
    /// The convention in which it was written.
    pub convention: Convention,
}

/// Why a text is not a pose.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WrittenPoseError {
    /// The first word is not the name of a convention.
    NoSuchConvention {
        /// The first word.
        name: String,
    },
    /// A word stands where a number is expected.
    NoNumber {
        /// The word.
        word: String,
    },
    /// Numbers without a convention, other than the 16 of a matrix.
    NoConvention {
        /// Number of numbers.
        found: usize,
    },
    /// The numbers are not a pose in their convention.
    Numbers(#[from] ConventionError),
    /// No cell is this large: the unit is wrong.
    TooFar {
        /// Its distance from the origin.
        distance: Metres,
        /// The convention in which it was written.
        convention: Convention,
    },
    /// The nozzle is too near to the flange or too far from it for any gun: the unit is probably wrong.
    Nozzle {
        /// Its distance from the flange.
        distance: Metres,
        /// The convention in which it was written.
        convention: Convention,
    },
}

impl Described for WrittenPoseError {
    fn message(&self) -> Message {
        let in_unit_of = |message: Message, convention: &Convention| {
            message
                .with("unit", convention.length_unit().symbol())
                .with("name", convention.name())
        };
        match self {
            Self::NoSuchConvention { name } => Message::new("written-no-such-convention")
                .with("name", &*format!("{name:?}"))
                .with("names", &*names()),
            Self::NoConvention { found } => Message::new("written-no-convention")
                .with("found", *found as f64)
                .with("names", &*names()),
            Self::NoNumber { word } => {
                Message::new("written-no-number").with("word", &*format!("{word:?}"))
            }
            Self::Numbers(error) => error.message(),
            Self::TooFar {
                distance,
                convention,
            } => in_unit_of(Message::new("written-too-far"), convention)
                .with("distance_m", distance.0)
                .with("most", MAX_POSE_DISTANCE_M),
            Self::Nozzle {
                distance,
                convention,
            } => in_unit_of(Message::new("written-nozzle"), convention)
                .with("distance_m", distance.0)
                .with("from_m", *NOZZLE_DISTANCE_RANGE_M.start())
                .with("to_m", *NOZZLE_DISTANCE_RANGE_M.end()),
        }
    }
}

texts::display!(WrittenPoseError);

fn names() -> String {
    Convention::ALL.map(Convention::name).join(", ")
}

/// Valid distances of a nozzle from the flange, metres.
pub const NOZZLE_DISTANCE_RANGE_M: RangeInclusive<f64> = 0.01..=3.0;

/// Maximum distance of a pose from the origin, metres.
pub const MAX_POSE_DISTANCE_M: f64 = 100.0;

/// Reads `kuka 1450 -310 890 10 20 30`, or the 16 numbers of a matrix. Refuses a position that is in no cell.
pub fn parse_written_pose(text: &str) -> Result<WrittenPose, WrittenPoseError> {
    let written = read(text)?;
    let distance = Metres(written.pose.translation.vector.norm());
    if distance.0 > MAX_POSE_DISTANCE_M {
        return Err(WrittenPoseError::TooFar {
            distance,
            convention: written.convention,
        });
    }
    Ok(written)
}

fn read(text: &str) -> Result<WrittenPose, WrittenPoseError> {
    let text = text.trim();
    let first = text
        .split(|c: char| c.is_whitespace() || matches!(c, ':' | ',' | ';' | '['))
        .next()
        .unwrap_or_default();
    let is_name = first.starts_with(|c: char| c.is_alphabetic());
    let (convention, rest) = if is_name {
        let named = Convention::by_name(&first.to_lowercase());
        let named = named.ok_or_else(|| WrittenPoseError::NoSuchConvention {
            name: first.to_owned(),
        })?;
        let rest = text.get(first.len()..).unwrap_or_default();
        (Some(named), rest.trim_start_matches([':', ',', ';']))
    } else {
        (None, text)
    };
    // Brackets remain when the numbers are copied out of JSON.
    let bare = rest.trim().trim_start_matches('[').trim_end_matches(']');
    let row = Row::new(bare);
    let numbers = row
        .cells()
        .flat_map(str::split_whitespace)
        .map(|word| {
            let number = row.number(word);
            number.ok_or_else(|| WrittenPoseError::NoNumber {
                word: word.to_owned(),
            })
        })
        .collect::<Result<Vec<f64>, _>>()?;
    let convention = match convention {
        Some(convention) => convention,
        None if numbers.len() == Convention::Matrix.names().len() => Convention::Matrix,
        None => {
            return Err(WrittenPoseError::NoConvention {
                found: numbers.len(),
            });
        }
    };
    Ok(WrittenPose {
        pose: convention.read(&numbers)?,
        convention,
    })
}

/// As [`parse_written_pose`], for the pose of a nozzle on the flange: refuses a distance that no gun has. The nozzle is
/// exactly at the flange if the controller's flange frame was moved there.
pub fn parse_nozzle(text: &str) -> Result<WrittenPose, WrittenPoseError> {
    let written = read(text)?;
    let at = written.pose.translation.vector;
    if at == Vector3::zeros() || NOZZLE_DISTANCE_RANGE_M.contains(&at.norm()) {
        return Ok(written);
    }
    Err(WrittenPoseError::Nozzle {
        distance: Metres(at.norm()),
        convention: written.convention,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::error::Advice as _;

    #[test]
    fn a_convention_and_its_numbers_are_a_pose() {
        let expected = Convention::Kuka
            .read(&[1450.5, -310.0, 890.0, 10.0, 20.0, 30.0])
            .expect("a pose");
        for text in [
            "kuka 1450.5 -310 890 10 20 30",
            "KUKA: 1450.5, -310, 890, 10, 20, 30",
            " kuka [1450.5, -310, 890, 10, 20, 30]\n",
            "kuka;1450,5;-310;890;10;20;30",
        ] {
            let read = parse_written_pose(text).expect(text);
            assert_eq!(read.convention, Convention::Kuka);
            assert_eq!(read.pose, expected, "{text}");
        }
        let matrix = parse_written_pose("1 0 0 0.5  0 1 0 0  0 0 1 2  0 0 0 1").expect("a matrix");
        assert_eq!(matrix.convention, Convention::Matrix);
        assert!((matrix.pose.translation.vector.x - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_nozzle_in_the_wrong_unit_is_refused_with_the_unit_of_its_convention() {
        for text in [
            "kuka 0 0 250 0 45 0",
            "universal-robots 0 0 0.25 0 0 0",
            "kuka 0 0 0 0 45 0",
        ] {
            let written = parse_nozzle(text).expect(text);
            assert_eq!(written, parse_written_pose(text).expect("a pose"));
        }
        for (text, distance, unit) in [
            (
                "kuka 0 0 0.25 0 45 0",
                "0.250 mm",
                "in mm, the unit of kuka",
            ),
            (
                "universal-robots 0 0 250 0 0 0",
                "250000.000 mm",
                "in m, the unit of universal-robots",
            ),
            (
                "1 0 0 0  0 1 0 0  0 0 1 250  0 0 0 1",
                "250000.000 mm",
                "in m, the unit of matrix",
            ),
        ] {
            let error = parse_nozzle(text).expect_err(text);
            assert!(error.to_string().contains(distance), "{error}");
            assert!(error.advice().contains(unit), "{}", error.advice());
        }
        assert!(parse_nozzle("kuka").is_err());
    }

    #[test]
    fn a_rotation_vector_in_degrees_is_refused() {
        for text in [
            "universal-robots 1.2 0 0 86 5 120",
            "rotation-vector 0 0 0.2 0 -6.3 0",
        ] {
            for error in
                [parse_written_pose(text), parse_nozzle(text)].map(|read| read.expect_err(text))
            {
                assert!(error.to_string().contains("at most 2π"), "{error}");
                assert!(error.advice().contains("in radians"), "{}", error.advice());
            }
        }
        // A full turn with four decimals.
        parse_written_pose("universal-robots 1.2 0 0 0 6.2832 0").expect("a pose");
    }

    #[test]
    fn anything_else_is_refused_in_words() {
        for (text, expected) in [
            ("", "0 numbers without"),
            ("1 2 3 4 5 6", "6 numbers without the name"),
            ("kukka 1 2 3 4 5 6", "\"kukka\""),
            ("kuka 1 2 3 4 5", "5 are given"),
            ("kuka 1 2 3 4 5 six", "\"six\" is not a number"),
            ("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "not a rigid transform"),
            (
                "universal-robots 1200 -400 1900 0 0 0",
                "2283 m away, expected at most 100 m",
            ),
        ] {
            let error = parse_written_pose(text).expect_err(text);
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.advice().is_empty());
        }
    }
}
