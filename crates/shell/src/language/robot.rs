//! Texts about the poses of a robot in the language of the window. In English they equal those of the library itself.

use robot::{
    Convention, ConventionError, FARTHEST, NOZZLE_DISTANCE, WrittenPoseError, calibration::UNNAMED,
};
use station::robot_file::Unchecked;
use ui::language::text;

/// Returns the name of a convention.
pub fn convention_title(convention: Convention) -> String {
    match convention {
        Convention::Matrix => text!("robot-convention-matrix"),
        Convention::QuaternionXyzw => text!("robot-convention-quaternion"),
        Convention::RotationVector => text!("robot-convention-rotation-vector"),
        // Names of makers, and of the numbers on their controllers.
        Convention::Kuka
        | Convention::Fanuc
        | Convention::Abb
        | Convention::UniversalRobots
        | Convention::Yaskawa
        | Convention::Staubli
        | Convention::Doosan => convention.title().to_owned(),
    }
}

/// Describes order, axes and units of a convention's numbers.
pub fn convention_meaning(convention: Convention) -> String {
    match convention {
        Convention::Matrix => text!("robot-meaning-matrix"),
        Convention::QuaternionXyzw => text!("robot-meaning-quaternion"),
        Convention::RotationVector => text!("robot-meaning-rotation-vector"),
        Convention::Kuka => text!("robot-meaning-kuka"),
        Convention::Fanuc => text!("robot-meaning-fanuc"),
        Convention::Abb => text!("robot-meaning-abb"),
        Convention::UniversalRobots => text!("robot-meaning-universal-robots"),
        Convention::Yaskawa => text!("robot-meaning-yaskawa"),
        Convention::Staubli => text!("robot-meaning-staubli"),
        Convention::Doosan => text!("robot-meaning-doosan"),
    }
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
    let words = unchecked.iter().map(|unchecked| match unchecked {
        Unchecked::Arm => text!("robot-unchecked-arm"),
        Unchecked::Surroundings => text!("robot-unchecked-surroundings"),
        Unchecked::Film => text!("robot-unchecked-film"),
        Unchecked::Accelerations(what) => {
            text!("robot-unchecked-accelerations", what = *what)
        }
        Unchecked::NotSeen { num, num_points } => {
            text!("robot-unchecked-points", num = *num, all = *num_points)
        }
    });
    let what = words.collect::<Vec<String>>().join("; ");
    (!what.is_empty()).then(|| text!("robot-not-checked", what = what))
}

/// Explains why a text is not a pose, and what to do.
pub(crate) fn written_pose_error(error: &WrittenPoseError) -> [String; 2] {
    match error {
        WrittenPoseError::NoSuchConvention { name } => [
            text!("robot-no-such-convention", name = format!("{name:?}")),
            no_convention_advice(),
        ],
        WrittenPoseError::NoConvention { found } => [
            text!("robot-no-convention", found = *found),
            no_convention_advice(),
        ],
        WrittenPoseError::NoNumber { word } => [
            text!("robot-no-number", word = format!("{word:?}")),
            text!("robot-no-number-advice"),
        ],
        WrittenPoseError::Numbers(error) => convention_error(error),
        WrittenPoseError::TooFar {
            distance,
            convention,
        } => [
            text!(
                "robot-pose-too-far",
                distance = format!("{:.0}", distance.0),
                most = format!("{FARTHEST}")
            ),
            text!(
                "robot-pose-too-far-advice",
                unit = convention.length_unit().symbol(),
                convention = convention.name()
            ),
        ],
        WrittenPoseError::Nozzle {
            distance,
            convention,
        } => {
            let mm = |metres: f64| format!("{:.0}", 1000.0 * metres);
            [
                text!(
                    "robot-nozzle-distance",
                    distance = format!("{:.3}", distance.mm()),
                    from = mm(*NOZZLE_DISTANCE.start()),
                    to = mm(*NOZZLE_DISTANCE.end())
                ),
                text!(
                    "robot-nozzle-distance-advice",
                    unit = convention.length_unit().symbol(),
                    convention = convention.name()
                ),
            ]
        }
    }
}

fn no_convention_advice() -> String {
    let names = Convention::ALL.map(Convention::name).join(", ");
    text!("robot-no-convention-advice", names = names)
}

/// Explains why numbers are not a pose in their convention, and what to do.
fn convention_error(error: &ConventionError) -> [String; 2] {
    match error {
        ConventionError::Count {
            convention,
            found,
            needed,
        } => [
            text!(
                "robot-count",
                title = convention_title(*convention),
                needed = *needed,
                names = convention.names().join(" "),
                found = *found
            ),
            text!(
                "robot-count-advice",
                meaning = convention_meaning(*convention)
            ),
        ],
        ConventionError::NotFinite { name, value } => [
            text!("robot-not-finite", name = *name, value = value.to_string()),
            text!("robot-not-finite-advice"),
        ],
        ConventionError::NotUnit { length } => [
            text!("robot-not-unit", length = format!("{length:.4}")),
            text!("robot-not-unit-advice"),
        ],
        ConventionError::LongRotation { length } => [
            text!("robot-long-rotation", length = format!("{length:.2}")),
            text!("robot-long-rotation-advice"),
        ],
        ConventionError::NotRigid => [text!("robot-not-rigid"), text!("robot-not-rigid-advice")],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::error::Advice as _;
    use robot::parse_nozzle;
    use ui::language::Language;

    #[test]
    fn in_english_they_equal_those_of_the_library() {
        for convention in Convention::ALL {
            assert_eq!(convention_title(convention), convention.title());
            assert_eq!(convention_meaning(convention), convention.meaning());
        }
        let errors = [
            "kukka 1 2 3 4 5 6",
            "1 2 3 4 5 6",
            "7",
            "kuka 1 2 3 4 5 six",
            "kuka 1 2 3 4 5",
            "quaternion-xyzw 0 0 0.2 1 1 0 0",
            "universal-robots 0 0 0.2 86 5 120",
            "2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
            "kuka 0 0 0.25 0 45 0",
        ]
        .map(|text| parse_nozzle(text).expect_err(text));
        let not_finite = ConventionError::NotFinite {
            name: "X",
            value: f64::INFINITY,
        };
        for error in errors.into_iter().chain([not_finite.into()]) {
            let expected = [error.to_string(), error.advice()];
            assert_eq!(written_pose_error(&error), expected);
        }
        assert_eq!(calibration_name(UNNAMED), UNNAMED);
    }

    #[test]
    fn what_was_not_checked_reads_as_in_the_commands() {
        for unchecked in [
            Unchecked::Arm,
            Unchecked::Surroundings,
            Unchecked::Film,
            Unchecked::NotSeen {
                num: 426,
                num_points: 660,
            },
        ] {
            let expected = format!("Not checked: {unchecked}");
            assert_eq!(not_checked(&[unchecked]), Some(expected));
        }
        assert_eq!(not_checked(&[]), None);
        let both = [Unchecked::Arm, Unchecked::Accelerations("rail")];
        let expected = "Not checked: reach and collisions; acceleration of the rail";
        assert_eq!(not_checked(&both).as_deref(), Some(expected));
    }

    #[test]
    fn a_calibration_without_a_name_is_called_so_in_the_language_of_the_window() {
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
