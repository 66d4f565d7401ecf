//! A robot pose written by a person: the name of its convention, then the numbers. Sixteen bare numbers are a matrix.

use super::{Convention, ConventionError};
use crate::{error::Advice, files::Row, geometry::rigid::RigidTransform};

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
    #[error("no convention is named {name:?}")]
    NoSuchConvention {
        /// The first word.
        name: String,
    },
    /// A word stands where a number is expected.
    #[error("{word:?} is not a number")]
    NoNumber {
        /// The word.
        word: String,
    },
    /// Numbers without a convention, other than the 16 of a matrix.
    #[error("{found} numbers without the name of a convention")]
    NoConvention {
        /// Number of numbers.
        found: usize,
    },
    /// The numbers are not a pose in their convention.
    #[error(transparent)]
    Numbers(#[from] ConventionError),
}

impl Advice for WrittenPoseError {
    fn advice(&self) -> String {
        match self {
            Self::NoSuchConvention { .. } | Self::NoConvention { .. } => format!(
                "Write the convention first, for example \"kuka 1450 -310 890 10 20 30\": {}",
                Convention::ALL.map(Convention::name).join(", ")
            ),
            Self::NoNumber { .. } => "Write numbers with a point, separated by spaces".into(),
            Self::Numbers(error) => error.advice(),
        }
    }
}

/// Reads `kuka 1450 -310 890 10 20 30`, or the 16 numbers of a matrix.
pub fn parse_written_pose(text: &str) -> Result<WrittenPose, WrittenPoseError> {
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
    let row = Row::of(bare);
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn anything_else_is_refused_in_words() {
        for (text, expected) in [
            ("", "0 numbers without"),
            ("1 2 3 4 5 6", "6 numbers without the name"),
            ("kukka 1 2 3 4 5 6", "\"kukka\""),
            ("kuka 1 2 3 4 5", "5 are given"),
            ("kuka 1 2 3 4 5 six", "\"six\" is not a number"),
            ("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "not a rigid transform"),
        ] {
            let error = parse_written_pose(text).expect_err(text);
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.advice().is_empty());
        }
    }
}
