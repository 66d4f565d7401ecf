//! Texts about the poses of a robot in the language of the window.

use robot::Convention;
use station::robot_file::Unchecked;
use ui::language::{attribute, described, text};

/// Describes order, axes and units of a convention's numbers.
pub fn convention_meaning(convention: Convention) -> String {
    attribute(&convention, "meaning")
}

/// Lists what was not checked; `None` if everything was.
pub fn not_checked(unchecked: &[Unchecked]) -> Option<String> {
    let words: Vec<String> = unchecked.iter().map(described).collect();
    let what = words.join("; ");
    (!what.is_empty()).then(|| text!("robot-not-checked", what = what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_checked_is_listed() {
        assert_eq!(not_checked(&[]), None);
        let both = [Unchecked::Arm, Unchecked::Accelerations("rail")];
        let expected = "Not checked: reach and collisions; acceleration of the rail";
        assert_eq!(not_checked(&both).as_deref(), Some(expected));
    }
}
