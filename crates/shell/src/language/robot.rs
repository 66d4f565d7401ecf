//! Texts about the poses of a robot in the language of the window.

use robot::{Convention, calibration::UNNAMED};
use station::robot_file::Unchecked;
use ui::language::{attribute, described, text};

/// Describes order, axes and units of a convention's numbers.
pub fn convention_meaning(convention: Convention) -> String {
    attribute(&convention, "meaning")
}

/// Translates the name of a calibration that has none; returns any other unchanged.
pub fn calibration_name(name: &str) -> String {
    match name.strip_prefix(UNNAMED) {
        Some(identity) => text!("robot-unnamed") + identity,
        None => name.to_owned(),
    }
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
    use ui::language::Language;

    #[test]
    fn what_was_not_checked_is_listed() {
        assert_eq!(not_checked(&[]), None);
        let both = [Unchecked::Arm, Unchecked::Accelerations("rail")];
        let expected = "Not checked: reach and collisions; acceleration of the rail";
        assert_eq!(not_checked(&both).as_deref(), Some(expected));
    }

    #[test]
    fn a_calibration_without_a_name_is_called_so_in_the_language_of_the_window() {
        assert_eq!(calibration_name(UNNAMED), UNNAMED);
        Language::German.make_current();
        let names = ["an unnamed calibration (3b2f68d5)", "Cell 2 (3b2f68d5)"];
        let shown = names.map(calibration_name);
        Language::English.make_current();
        assert_eq!(
            shown,
            [
                "eine Kalibrierung ohne Namen (3b2f68d5)",
                "Cell 2 (3b2f68d5)"
            ]
        );
    }
}
