//! Lengths and angles at public boundaries.
//!
//! Inside a function body a length is a plain `f64` in metres and an angle a plain `f64` in radians.
//! Millimetres and degrees appear only where a person reads or writes them, through the methods here.

use std::{borrow::Borrow, fmt};

use serde::{Deserialize, Serialize};

/// A length in metres.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Metres(pub f64);

impl Metres {
    /// A length given in millimetres.
    pub fn from_mm(millimetres: f64) -> Self {
        Self(millimetres / 1000.0)
    }

    /// The length in millimetres.
    pub fn mm(self) -> f64 {
        self.0 * 1000.0
    }
}

impl fmt::Display for Metres {
    /// Formats in millimetres, for display.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} mm", self.mm())
    }
}

/// An angle in radians.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Radians(pub f64);

impl Radians {
    /// An angle given in degrees.
    pub fn from_degrees(degrees: f64) -> Self {
        Self(degrees.to_radians())
    }

    /// The angle in degrees.
    pub fn degrees(self) -> f64 {
        self.0.to_degrees()
    }
}

impl fmt::Display for Radians {
    /// Formats in degrees, for display.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.2}°", self.degrees())
    }
}

/// Lists words in English, such as "A, B or C".
pub fn any_of<T: Borrow<str>>(words: &[T]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => {
            format!("{} or {}", first.join(", "), last.borrow())
        }
        _ => words.concat(),
    }
}

/// Writes a number of things in English, such as "1 point" or "5 points".
pub fn counted(num: usize, one: &str, many: &str) -> String {
    let noun = if num == 1 { one } else { many };
    format!("{num} {noun}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_thing_is_singular() {
        let texts = [0, 1, 2].map(|num| counted(num, "point", "points"));
        assert_eq!(texts, ["0 points", "1 point", "2 points"]);
    }
    #[test]
    fn only_the_last_two_words_of_a_list_have_or_between_them() {
        let words = ["A", "B", "C"];
        let texts = [0, 1, 2, 3].map(|num| any_of(&words[..num]));
        assert_eq!(texts, ["", "A", "A or B", "A, B or C"]);
    }
}
