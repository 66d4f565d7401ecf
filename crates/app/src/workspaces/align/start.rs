//! Starts of a moved copy: the paper's five transforms, one that a person enters, or a random one.

use std::f64::consts::PI;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use geometry::{
    rigid::{RigidTransform, from_euler_zyx},
    written_pose::parse_pose,
};
use stages::pose::displacements::DISPLACEMENTS;
use ui::language::text;

/// Largest shift of a random start along each axis, metres: that of T1.
const RANDOM_SHIFT: f64 = 0.8;

/// The transform that moves a part's points before they are aligned to the unmoved part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// One of T1..T5 (eq. 15), counted from 0.
    Paper(usize),
    /// A transform entered by a person.
    Custom(RigidTransform),
    /// A transform drawn with this seed: any rotation, shifts up to that of T1.
    Random(u64),
}

impl Default for Start {
    fn default() -> Self {
        Self::Paper(0)
    }
}

impl Start {
    /// Number of transforms of the paper.
    pub const NUM_PAPER: usize = DISPLACEMENTS.len();

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Paper(index) => format!("T{}", index + 1),
            Self::Custom(_) => text!("align-custom-start"),
            Self::Random(seed) => text!("align-random-start", seed = seed),
        }
    }

    /// The transform that moves the points.
    pub fn transform(self) -> RigidTransform {
        match self {
            Self::Paper(index) => {
                let numbers = DISPLACEMENTS.get(index).copied().unwrap_or_default();
                from_euler_zyx(numbers)
            }
            Self::Custom(transform) => transform,
            Self::Random(seed) => {
                let mut rng = Pcg64::seed_from_u64(seed);
                let angle = [(); 3].map(|()| rng.random_range(-PI..PI));
                let shift = [(); 3].map(|()| rng.random_range(-RANDOM_SHIFT..RANDOM_SHIFT));
                // Half the range: beyond it the same rotations repeat.
                from_euler_zyx([
                    angle[0],
                    0.5 * angle[1],
                    angle[2],
                    shift[0],
                    shift[1],
                    shift[2],
                ])
            }
        }
    }
}

/// A start as entered by a person: six numbers, with or without units.
#[derive(Debug, Default)]
pub struct CustomStart {
    /// True while its form is open.
    pub is_open: bool,
    /// The text entered.
    pub text: String,
    /// The start, if the text can be read as one.
    pub transform: Option<RigidTransform>,
    /// Errors and doubts found in the text.
    pub remarks: Vec<String>,
}

impl CustomStart {
    pub(super) fn write(&mut self, text: String) {
        let given = parse_pose(&text);
        self.transform = given.as_ref().ok().map(|given| given.pose);
        self.remarks = match given {
            Ok(given) => given.doubts.iter().map(ToString::to_string).collect(),
            Err(problem) => vec![problem],
        };
        self.text = text;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_transform_of_the_paper_is_a_quarter_turn_about_x_and_a_shift() {
        let moved = Start::Paper(0).transform() * nalgebra::Point3::new(0.0, 1.0, 0.0);
        assert!((moved - nalgebra::Point3::new(0.8, 0.0, 1.5)).norm() < 1e-12);
    }

    #[test]
    fn a_seed_draws_the_same_start_again_and_another_seed_another() {
        assert_eq!(Start::Random(7).transform(), Start::Random(7).transform());
        assert_ne!(Start::Random(7).transform(), Start::Random(8).transform());
        let shift = Start::Random(7).transform().translation.vector;
        assert!(shift.amax() <= RANDOM_SHIFT);
    }
}
