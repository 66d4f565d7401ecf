//! Texts about enrolling in the language of the window: what is wrong, and what to do. In English they equal those of the
//! library itself, except where those name a command.

use super::results::{free_motion, unrecognisable, unrecognisable_advice};
use geometry::error::Advice as _;
use inspection::{
    library::{BadName, EnrolError, EnrolWarning, PartName, Side},
    pipeline::Unrecognisable,
};
use stages::{reference::ReferenceError, segment::BackgroundSign};
use ui::language::text;

/// Explains why a text is not a valid name.
pub fn bad_name(error: &BadName) -> [String; 2] {
    // As in the library, quoted, with letters that cannot be seen spelled out.
    let quoted = |name: &str| format!("{name:?}");
    let what = match error {
        BadName::Empty => text!("enrol-bad-name-empty"),
        BadName::TooLong { found, limit } => {
            text!("enrol-bad-name-long", found = *found, limit = *limit)
        }
        BadName::BadCharacter { name, character } => text!(
            "enrol-bad-name-character",
            name = quoted(name),
            character = format!("{character:?}")
        ),
        BadName::BadBeginning { name, character } => text!(
            "enrol-bad-name-beginning",
            name = quoted(name),
            character = format!("{character:?}")
        ),
        BadName::Reserved { name } => text!("enrol-bad-name-reserved", name = quoted(name)),
    };
    let advice = text!(
        "enrol-bad-name-advice",
        limit = PartName::MAX_LENGTH,
        example = error.example()
    );
    [what, advice]
}

/// Warns about a part that is about to be enrolled.
pub fn enrol_warning(warning: &EnrolWarning) -> [String; 2] {
    match warning {
        EnrolWarning::TouchesEdge => [
            text!("enrol-warning-edge"),
            text!("enrol-warning-edge-advice"),
        ],
        EnrolWarning::Background(sign) => [
            text!("enrol-warning-background", why = background_sign(sign)),
            text!("enrol-warning-background-advice"),
        ],
        EnrolWarning::OnBackground { percent } => [
            text!("enrol-warning-on-background", percent = *percent),
            text!("enrol-warning-on-background-advice"),
        ],
        EnrolWarning::Apart { percent } => [
            text!("enrol-warning-apart", percent = *percent),
            text!("enrol-warning-apart-advice"),
        ],
        EnrolWarning::TooLittle { score, needed } => [
            text!(
                "enrol-warning-too-little",
                score = format!("{score:.2}"),
                needed = format!("{needed:.2}")
            ),
            text!("enrol-warning-too-little-advice"),
        ],
        EnrolWarning::Unconstrained(freedom) => [
            text!(
                "enrol-warning-unconstrained",
                freedom = free_motion(*freedom)
            ),
            text!("enrol-warning-unconstrained-advice"),
        ],
        EnrolWarning::Symmetric { degrees } => [
            text!("enrol-warning-symmetric", degrees = *degrees),
            text!("enrol-warning-symmetric-advice"),
        ],
        EnrolWarning::SideUnclear { .. } => [
            text!("enrol-warning-side"),
            text!("enrol-warning-side-advice"),
        ],
        EnrolWarning::GoesOnUnseen { percent } => [
            text!("enrol-warning-unseen", percent = *percent),
            text!("enrol-warning-unseen-advice"),
        ],
    }
}

/// States the side that a part is painted from.
pub fn painted_from(side: Side) -> String {
    match side {
        Side::Front => text!("enrol-painted-from-front"),
        Side::Back => text!("enrol-painted-from-back"),
        Side::Left => text!("enrol-painted-from-left"),
        Side::Right => text!("enrol-painted-from-right"),
        Side::Top => text!("enrol-painted-from-top"),
        Side::Bottom => text!("enrol-painted-from-bottom"),
    }
}

/// Explains why a surface may be background.
fn background_sign(sign: &BackgroundSign) -> String {
    match sign {
        BackgroundSign::Behind { share } => {
            text!(
                "enrol-sign-behind",
                percent = format!("{:.0}", share * 100.0)
            )
        }
        BackgroundSign::Cut { sides } => text!("enrol-sign-cut", sides = *sides),
        BackgroundSign::Flat { area } => {
            text!("enrol-sign-flat", area = format!("{area:.2}"))
        }
    }
}

/// Explains why a part cannot be enrolled.
pub fn enrol_error(error: &EnrolError) -> [String; 2] {
    match error {
        EnrolError::NoPart(no_part) => {
            let why = Unrecognisable::NoPart(*no_part);
            [unrecognisable(&why), unrecognisable_advice(&why)]
        }
        // Only a command chooses a surface by its number.
        EnrolError::Background(_) | EnrolError::NoSuchSurface { .. } => {
            [error.to_string(), error.advice()]
        }
        EnrolError::Reference(ReferenceError::NoOutline { num_points }) => [
            text!("enrol-error-no-outline", num = *num_points),
            text!("enrol-error-no-outline-advice"),
        ],
        EnrolError::Reference(ReferenceError::TooLarge { found, limit }) => [
            text!(
                "enrol-error-large",
                found = format!("{:.1}", found.0),
                limit = format!("{:.0}", limit.0)
            ),
            text!("enrol-error-large-advice"),
        ],
        EnrolError::TooFewPoints { found, needed } => [
            text!("enrol-error-points", found = *found, needed = *needed),
            text!("enrol-error-points-advice"),
        ],
        EnrolError::TooFewKept { found, needed } => [
            text!("enrol-error-kept", found = *found, needed = *needed),
            text!("enrol-error-kept-advice"),
        ],
        EnrolError::NoPartInScan { num_frames } => [
            text!("enrol-error-scan", num = *num_frames),
            text!("enrol-error-scan-advice"),
        ],
        EnrolError::NoArea { num_triangles } => [
            text!("enrol-error-area", num = *num_triangles),
            text!("enrol-error-area-advice"),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::units::Metres;
    use stages::segment::NoPart;
    use ui::language::Language;

    fn bad_names() -> Vec<BadName> {
        let long = "a".repeat(65);
        let names = ["", "Front door", "_door", "con", long.as_str()];
        let bad = names.map(|name| PartName::new(name).expect_err("not a name"));
        bad.into()
    }

    fn warnings() -> Vec<EnrolWarning> {
        let signs = [
            BackgroundSign::Behind { share: 0.4 },
            BackgroundSign::Cut { sides: 3 },
            BackgroundSign::Flat { area: 0.5 },
        ];
        let mut all: Vec<EnrolWarning> = signs.map(EnrolWarning::Background).into();
        all.extend(stages::fixtures::FREEDOMS.map(EnrolWarning::Unconstrained));
        all.extend([
            EnrolWarning::TouchesEdge,
            EnrolWarning::OnBackground { percent: 12 },
            EnrolWarning::Apart { percent: 7 },
            EnrolWarning::TooLittle {
                score: 0.7,
                needed: 0.9,
            },
            EnrolWarning::Symmetric { degrees: 180 },
            EnrolWarning::GoesOnUnseen { percent: 21 },
        ]);
        all
    }

    /// Its advice names an option of the command line.
    const UNCLEAR: EnrolWarning = EnrolWarning::SideUnclear {
        sides: [Side::Top, Side::Bottom],
    };

    fn errors() -> Vec<EnrolError> {
        vec![
            EnrolError::NoPart(NoPart::TooFewPoints {
                found: 5,
                needed: 200,
            }),
            EnrolError::Reference(ReferenceError::NoOutline { num_points: 9 }),
            EnrolError::Reference(ReferenceError::TooLarge {
                found: Metres(1732.0),
                limit: Metres(5.0),
            }),
            EnrolError::TooFewPoints {
                found: 5,
                needed: 200,
            },
            EnrolError::TooFewKept {
                found: 5,
                needed: 200,
            },
            EnrolError::NoArea { num_triangles: 3 },
        ]
    }

    #[test]
    fn in_english_the_window_says_what_the_library_says() {
        for error in bad_names() {
            assert_eq!(bad_name(&error), [error.to_string(), error.advice()]);
        }
        for warning in warnings() {
            let said = [warning.to_string(), warning.advice()];
            assert_eq!(enrol_warning(&warning), said);
        }
        for error in errors() {
            assert_eq!(enrol_error(&error), [error.to_string(), error.advice()]);
        }
        let in_scan = EnrolError::NoPartInScan { num_frames: 4 };
        let [what, advice] = enrol_error(&in_scan);
        assert_eq!(what, in_scan.to_string());
        assert!(!advice.contains("partsight"), "{advice}");
        let [what, advice] = enrol_warning(&UNCLEAR);
        assert_eq!(what, UNCLEAR.to_string());
        assert!(!advice.contains("--"), "{advice}");
    }

    #[test]
    fn every_other_language_says_it_in_its_own_words() {
        let said = || {
            let names = bad_names().into_iter().map(|error| bad_name(&error));
            let warnings = warnings().into_iter().chain([UNCLEAR]);
            let warnings = warnings.map(|warning| enrol_warning(&warning));
            let errors = errors().into_iter().map(|error| enrol_error(&error));
            let all = names.chain(warnings).chain(errors).flatten();
            all.collect::<Vec<String>>()
        };
        let english = said();
        for language in [Language::German, Language::Spanish, Language::Chinese] {
            language.make_current();
            for (own, english) in said().iter().zip(&english) {
                assert_ne!(own, english, "{language:?}");
            }
        }
    }
}
