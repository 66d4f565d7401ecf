//! Texts about the poses of a robot in the language of the window. In English they equal those of the library itself.

use records::history::Summary;
use robot::{
    Convention, ConventionError, FARTHEST, NOZZLE_DISTANCE, WrittenPoseError, calibration::UNNAMED,
};
use stages::scan;
use station::{Doubt, robot_file::Unchecked};
use ui::language::{advised, described, text};

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

/// Explains why a robot must not act on a result, and what to do.
pub fn doubt(doubt: &Doubt) -> [String; 2] {
    match doubt {
        Doubt::ReportedWrong => [
            text!("operator-reported-wrong"),
            text!("robot-doubt-capture-again"),
        ],
        Doubt::SourceLost => [
            text!("robot-doubt-source-lost"),
            text!("robot-doubt-source-lost-advice"),
        ],
        Doubt::Moving => [
            text!("robot-doubt-moving"),
            text!("robot-doubt-moving-advice"),
        ],
        Doubt::Superseded => [
            text!("robot-doubt-superseded"),
            text!("robot-doubt-capture-again"),
        ],
        Doubt::NotAccepted => [
            text!("robot-doubt-not-accepted"),
            text!("robot-doubt-capture-again"),
        ],
        Doubt::NoPose => [
            text!("robot-doubt-no-pose"),
            text!("robot-doubt-no-pose-advice"),
        ],
        Doubt::NotCalibrated => [
            text!("robot-doubt-not-calibrated"),
            text!("robot-doubt-not-calibrated-advice"),
        ],
        Doubt::ClockAhead(ahead) => [
            text!(
                "robot-doubt-clock-ahead",
                seconds = ahead.ahead.as_secs().to_string()
            ),
            text!("robot-doubt-clock-ahead-advice"),
        ],
        Doubt::Old => [text!("robot-doubt-old"), text!("robot-doubt-capture-again")],
        Doubt::Ambiguous => [
            text!("robot-doubt-ambiguous"),
            text!("robot-doubt-ambiguous-advice"),
        ],
        Doubt::OffScale(off) => [described(off), advised(off)],
        Doubt::Scan(doubt) => of_scan(doubt),
        Doubt::OffThePart(off) => [
            if off.num_too_near > 0 {
                text!(
                    "robot-doubt-too-near",
                    near = off.num_too_near,
                    all = off.num_spraying
                )
            } else {
                text!(
                    "robot-doubt-off-part",
                    aiming = off.num_aiming,
                    all = off.num_spraying
                )
            },
            text!("robot-doubt-off-part-advice"),
        ],
        Doubt::NotReached(missed) => [
            text!(
                "robot-doubt-not-reached",
                arm = missed.arm.as_str(),
                missed = missed.num_points - missed.num_reached,
                all = missed.num_points
            ),
            text!("robot-doubt-not-reached-advice"),
        ],
        Doubt::FilmOffPlan(off_plan) => {
            let [planned, written] = off_plan.within.map(|share| format!("{:.1}", 100.0 * share));
            let [planned_um, written_um] = off_plan.mean.map(|mean| format!("{:.1}", 1e6 * mean));
            [
                text!(
                    "robot-doubt-film-off-plan",
                    written = written,
                    written_um = written_um,
                    planned = planned,
                    planned_um = planned_um,
                    tolerance = format!("{:.0}", 100.0 * off_plan.tolerance),
                    stops = off_plan.num_stops
                ),
                text!("robot-doubt-film-off-plan-advice"),
            ]
        }
    }
}

/// Explains what kept a robot from acting on an inspection when it was made; `None` if nothing did.
pub fn past_doubts(past: &Summary) -> Option<String> {
    let kinds = past.noted.robot_doubts.iter();
    let doubts: Vec<_> = kinds
        .map(|kind| text!("robot-doubt-kind", kind = kind))
        .collect();
    (!doubts.is_empty()).then(|| text!("robot-was-not-to-act", why = doubts.join("; ")))
}

fn of_scan(doubt: &scan::Doubt) -> [String; 2] {
    match doubt {
        scan::Doubt::PoorAgreement { name, share } => [
            text!(
                "robot-doubt-frames-disagree",
                frame = name.as_str(),
                disagree = format!("{:.1}", 100.0 * (1.0 - share))
            ),
            text!("robot-doubt-frames-disagree-advice"),
        ],
        scan::Doubt::PosesApart { names, apart } => [
            text!(
                "robot-doubt-poses-apart",
                one = names[0].as_str(),
                other = names[1].as_str(),
                apart = apart.to_string()
            ),
            text!("robot-doubt-poses-apart-advice"),
        ],
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
    use std::time::Duration;

    use super::*;
    use geometry::{error::Advice as _, units::Metres};
    use robot::parse_nozzle;
    use stages::pose::OffScale;
    use station::ClockAhead;
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
    fn doubts_and_what_was_not_checked_read_as_in_the_commands() {
        let ahead = Duration::from_hours(1);
        for kind in [
            Doubt::SourceLost,
            Doubt::Moving,
            Doubt::Superseded,
            Doubt::NotAccepted,
            Doubt::NoPose,
            Doubt::ClockAhead(ClockAhead { ahead }),
            Doubt::Old,
            Doubt::Ambiguous,
            Doubt::OffScale(OffScale {
                is_larger: true,
                by: 0.05,
            }),
            Doubt::Scan(scan::Doubt::PoorAgreement {
                name: "a.png".into(),
                share: 0.93,
            }),
            Doubt::Scan(scan::Doubt::PosesApart {
                names: ["a.png".into(), "b.png".into()],
                apart: Metres::from_mm(31.4),
            }),
        ] {
            assert_eq!(doubt(&kind), [kind.to_string(), kind.advice()]);
        }
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
