//! The texts of results, the history and robots in the window's language, and lengths and angles in its units.
//!
//! Each kind of result is matched exhaustively, so that a new one does not compile without its text.

use crate::inspection::source::CELL_SOURCE;
use capture::SourceSpec;
use inspection::{
    library::Side,
    pipeline::{AS_IN_THE_PAPER, Identification, RecipeLabel, RefusalKind},
};
use records::history::{
    DriftQuantity, DriftWarning, SceneTitle, ServoRun, ServoTargetKind, StoredVerdict, Summary,
};
use robot::Convention;
use servo::ServoState;
use simulate::ObjectKind;
use station::robot_file::Unchecked;
use ui::{
    language::{Language, Message, attribute, described, text},
    user_error::UserError,
    widgets::{Mark, sentence},
};

/// Says whether an inspection was accepted, for whatever reason it was not.
pub fn accepted_or_not(is_accepted: bool) -> String {
    described(if is_accepted {
        &StoredVerdict::Accepted
    } else {
        &StoredVerdict::Rejected
    })
}

/// Returns the title of an inspection.
pub fn inspection_title(past: &Summary) -> String {
    let found = past.identification();
    let part = &past.title;
    match (found, found.heading(part, Language::current())) {
        (Identification::Part, Some(part)) if past.verdict != StoredVerdict::Accepted => {
            text!("results-title-refused", part = part)
        }
        (_, Some(name)) => name,
        (Identification::NotRecognised, None) => text!("results-title-not-recognised", part = part),
        (Identification::Unknown { is_like: true }, None) => {
            text!("results-title-unknown", part = part)
        }
        (Identification::NoPart, None) => described(&StoredVerdict::NoPart),
        (_, None) => text!("inspect-unknown-part"),
    }
}

/// Returns the title of a scene.
pub fn scene_title(scene: &SceneTitle, is_simulated: bool) -> String {
    let title = match scene {
        SceneTitle::SimulatedFrame(number) => {
            return numbered(&number.to_string());
        }
        SceneTitle::Named(name) => name.clone(),
        SceneTitle::Scan { name, num_shots } => {
            format!("{name} · {}", text!("shots-all-used", num = *num_shots))
        }
    };
    if is_simulated {
        text!("shell-of-simulator", name = title)
    } else {
        title
    }
}

/// The title of the frame of the simulated cell with this number.
fn numbered(number: &str) -> String {
    sentence(&described(&SceneTitle::numbered(number)))
}

/// Returns the title of a source; only the simulated cell has a name of its own.
pub fn source_title(source: &str, is_simulated: bool) -> String {
    let cell = || text!("shell-simulated-cell");
    if source == CELL_SOURCE {
        return cell();
    }
    match source.parse() {
        Ok(SourceSpec::Simulated(_)) if is_simulated => match source.split_once([',', ':']) {
            Some((_, settings)) => format!("{} · {settings}", cell()),
            None => cell(),
        },
        _ => source.to_owned(),
    }
}

/// Returns the texts that the list shows for data, in lower case, each with what the search text has for them.
pub fn searched_texts() -> Vec<[String; 2]> {
    let verdict = |verdict: StoredVerdict| (described(&verdict), format!("={}", verdict.name()));
    let named = |found: Identification| {
        let named = found.name("", Language::current());
        named.unwrap_or_default()
    };
    let both = [
        (numbered(""), "=simulated_frame ".to_owned()),
        (
            text!("shell-of-simulator", name = ""),
            "=simulated".to_owned(),
        ),
        (text!("shots-all-used", num = ""), "=shots ".to_owned()),
        (text!("shell-simulated-cell"), format!("\n{CELL_SOURCE}")),
        (text!("shell-simulated-cell"), "\nsimulated".to_owned()),
        verdict(StoredVerdict::Rejected),
        verdict(StoredVerdict::Unknown),
        (
            named(Identification::AnotherMake),
            "=another_make".to_owned(),
        ),
        (
            named(Identification::AnotherModel),
            "=another_model".to_owned(),
        ),
        (named(Identification::MirrorImage), "=mirrored".to_owned()),
        (named(Identification::OtherHalf), "=other_half".to_owned()),
        verdict(StoredVerdict::NoPart),
    ];
    both.map(|(shown, searched)| [shown.to_lowercase(), searched])
        .into()
}

/// Returns the name of a kind of refusal, for counts.
pub fn refusal_kind(kind: &RefusalKind) -> String {
    let name = kind.message().attribute(Language::current(), "kind");
    name.unwrap_or_else(|| kind.to_string())
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

/// Returns the label of a traceability field.
pub fn traced(name: &str) -> String {
    match name {
        "serial" => text!("inspect-serial"),
        "order" => text!("inspect-order"),
        "operator" => text!("inspect-operator"),
        name => name.to_owned(),
    }
}

/// Returns the name of a recipe, marked if it was modified; the name itself is not translated.
pub fn recipe_label(label: &RecipeLabel) -> String {
    let name = recipe_name(&label.name);
    if label.is_changed {
        text!("results-recipe-modified", name = name)
    } else {
        name
    }
}

/// Returns the name of a recipe: a text for the paper's, else what the user named it.
pub fn recipe_name(name: &str) -> String {
    match name {
        AS_IN_THE_PAPER => text!("results-recipe-as-in-the-paper"),
        name => name.to_owned(),
    }
}

/// Returns the name of an object that is not enrolled but may hang in the simulated cell.
pub(crate) fn object(kind: ObjectKind) -> String {
    match kind {
        ObjectKind::Hood => text!("results-object-hood"),
        ObjectKind::Wheel => text!("results-object-wheel"),
        ObjectKind::Box => text!("results-object-box"),
        ObjectKind::Chair => text!("results-object-chair"),
        ObjectKind::Board => text!("results-object-board"),
        ObjectKind::Ladder => text!("results-object-ladder"),
        ObjectKind::Stool => text!("results-object-stool"),
        ObjectKind::Bucket => text!("results-object-bucket"),
    }
}

/// Describes order, axes and units of a convention's numbers.
pub fn convention_meaning(convention: Convention) -> String {
    attribute(&convention, "meaning")
}

/// Lists what was not checked; `None` if everything was.
pub fn not_checked(unchecked: &[Unchecked]) -> Option<String> {
    let words: Vec<String> = unchecked.iter().map(described).collect();
    let what = words.join("; ");
    let message = Message::new("not-checked").with("what", &*what);
    (!what.is_empty()).then(|| sentence(&described(&message)))
}

/// Names what a run was to reach.
pub fn target_title(target: ServoTargetKind) -> String {
    match target {
        ServoTargetKind::StandardPosition => text!("servoing-standard-position"),
        ServoTargetKind::CameraPose => text!("servoing-camera-pose"),
        ServoTargetKind::PathStart => text!("servoing-path-start"),
    }
}

/// Says what a run is doing.
pub fn state_title(state: ServoState) -> String {
    match state {
        ServoState::Looking => text!("servoing-looking"),
        ServoState::Moving => text!("servoing-moving"),
        ServoState::Waiting => text!("servoing-waiting"),
        ServoState::Holding => text!("servoing-holding"),
        ServoState::Checking => text!("servoing-checking"),
    }
}

/// Says how a run ended, with its mark.
pub fn end_title(run: &ServoRun) -> (Mark, String) {
    match &run.stopped {
        None if run.is_approximate => (Mark::Look, text!("servoing-arrived-approximately")),
        None => (Mark::Good, text!("servoing-arrived")),
        Some(_) => (Mark::Bad, text!("servoing-stopped")),
    }
}

/// Writes a shift and an angle; `None` if they are not known.
pub fn shift_and_turn(
    shift_m: Option<f64>,
    turn_rad: Option<f64>,
    units: UnitSystem,
) -> Option<String> {
    Some(format!(
        "{} · {}",
        units.length(shift_m?),
        units.angle(turn_rad?)
    ))
}

/// Returns the name of what is followed of a part.
pub fn drift_quantity(quantity: DriftQuantity) -> String {
    match quantity {
        DriftQuantity::Score => sentence(&text!("history-figure-score")),
        DriftQuantity::ShiftBoundM => text!("history-drift-shift-bound"),
        DriftQuantity::RmsM => text!("history-drift-fit"),
        DriftQuantity::XM => text!("history-drift-place-along", axis = "x"),
        DriftQuantity::YM => text!("history-drift-place-along", axis = "y"),
        DriftQuantity::ZM => text!("history-drift-place-along", axis = "z"),
    }
}

/// Formats a value of it.
pub fn drift_value(quantity: DriftQuantity, value: f64, units: UnitSystem) -> String {
    match quantity {
        // Scores near 1 differ in the third decimal.
        DriftQuantity::Score => format!("{value:.3}"),
        DriftQuantity::ShiftBoundM | DriftQuantity::RmsM => units.length(value),
        DriftQuantity::XM | DriftQuantity::YM | DriftQuantity::ZM => units.signed_length(value),
    }
}

/// Says that the part of this title will be refused, and what to do before.
pub fn drift_warning(part: &str, warning: &DriftWarning, units: UnitSystem) -> UserError {
    let DriftWarning {
        quantity,
        limit,
        refuses_in,
    } = *warning;
    UserError {
        what: text!(
            "history-drift-warning",
            part = part,
            count = refuses_in,
            name = drift_quantity(quantity),
            limit = drift_value(quantity, limit, units)
        ),
        advice: text!("history-drift-warning-advice"),
    }
}

/// Units shown to the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnitSystem {
    /// Millimetres and degrees.
    #[default]
    MillimetresDegrees,
    /// Metres and radians.
    MetresRadians,
}

impl UnitSystem {
    /// Symbols of the units.
    pub fn title(self) -> &'static str {
        match self {
            Self::MillimetresDegrees => "mm · °",
            Self::MetresRadians => "m · rad",
        }
    }

    /// Returns the other system.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::MillimetresDegrees => Self::MetresRadians,
            Self::MetresRadians => Self::MillimetresDegrees,
        }
    }

    /// Formats a length given in metres.
    pub fn length(self, metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} mm", minus(metres * 1000.0, 1)),
            Self::MetresRadians => format!("{} m", minus(metres, 4)),
        }
    }

    /// Formats an area given in square metres.
    pub fn area(self, square_metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} cm²", minus(square_metres * 1e4, 0)),
            Self::MetresRadians => format!("{} m²", minus(square_metres, 2)),
        }
    }

    /// Factor from metres, unit symbol and decimals for lengths on an axis.
    pub fn length_axis(self) -> (f64, &'static str, usize) {
        match self {
            Self::MillimetresDegrees => (1000.0, "mm", 0),
            Self::MetresRadians => (1.0, "m", 3),
        }
    }

    /// Factor from radians, unit symbol and decimals for angles on an axis.
    pub fn angle_axis(self) -> (f64, &'static str, usize) {
        match self {
            Self::MillimetresDegrees => (1.0_f64.to_degrees(), "°", 0),
            Self::MetresRadians => (1.0, "rad", 2),
        }
    }

    /// Formats a difference of lengths given in metres, with its sign.
    pub fn signed_length(self, metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} mm", signed(metres * 1000.0, 1)),
            Self::MetresRadians => format!("{} m", signed(metres, 4)),
        }
    }

    /// Formats the magnitude of an angle given in radians.
    pub fn angle(self, radians: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{:.2}°", radians.to_degrees()),
            Self::MetresRadians => format!("{radians:.4} rad"),
        }
    }

    /// Formats an angle given in radians, with its sign.
    pub fn signed_angle(self, radians: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{}°", signed(radians.to_degrees(), 2)),
            Self::MetresRadians => format!("{} rad", signed(radians, 4)),
        }
    }
}

/// Formats a number, with a minus sign (U+2212) if it is negative.
fn minus(value: f64, decimals: usize) -> String {
    let text = signed(value, decimals);
    text.strip_prefix('+').map(str::to_owned).unwrap_or(text)
}

/// Formats a number with its sign, using U+2212 for minus; no sign if it rounds to zero.
fn signed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    if digits.bytes().all(|b| matches!(b, b'0' | b'.')) {
        digits
    } else if value < 0.0 {
        format!("\u{2212}{digits}")
    } else {
        format!("+{digits}")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use inspection::{
        fixtures::rejections,
        pipeline::{Refusal, Rejection},
    };
    use records::{
        fixtures::history_entry,
        history::{Filter, Record},
    };
    use ui::language::advised;

    /// A refused front door whose title was "Door, left" at that time.
    fn refused_door(verdict: StoredVerdict) -> Record {
        let mut past = history_entry(1, verdict, "front_door").record;
        past.summary.title = "Door, left".into();
        past
    }

    #[test]
    fn the_title_of_an_unknown_part_names_no_part_that_it_is_not_like() {
        let mut past = refused_door(StoredVerdict::Unknown);
        let mut shown = |score| {
            past.summary.score = Some([score, score]);
            inspection_title(&past.summary)
        };
        assert!(shown(0.3).contains("Door, left"));
        assert!(!shown(0.004).contains("Door, left"));
    }

    #[test]
    fn a_part_that_is_only_in_doubt_where_it_is_has_its_name_in_the_title() {
        let mut past = refused_door(StoredVerdict::Rejected);
        let ambiguous = Rejection::AmbiguousPose {
            part: "front_door".into(),
            margin: 0.1,
            threshold: 0.4,
        };
        past.summary.reason = Some(Refusal::Rejected(ambiguous).kind());
        let mut shown = |score| {
            past.summary.score = Some(score);
            inspection_title(&past.summary)
        };
        assert_eq!(shown([0.97, 0.97]), "Door, left · not accepted");
        for score in [[0.89, 0.97], [0.97, 0.43]] {
            assert_eq!(shown(score), "Not recognised · nearest Door, left");
        }
    }

    #[test]
    fn what_is_of_another_make_or_the_image_of_a_part_is_called_so_in_the_list_and_found_by_it() {
        let part = || "door".to_owned();
        let (score, likeness) = (0.2, 0.7);
        for (verdict, why, title) in [
            (
                StoredVerdict::Rejected,
                Rejection::AnotherMake {
                    part: part(),
                    likeness,
                },
                "Door, left, another make",
            ),
            (
                StoredVerdict::Unknown,
                Rejection::MirroredImage {
                    part: part(),
                    score,
                },
                "Mirror image of Door, left",
            ),
            (
                StoredVerdict::Unknown,
                Rejection::OtherHalf {
                    part: part(),
                    score,
                },
                "Mirror image of the enrolled piece of Door, left",
            ),
        ] {
            let mut past = refused_door(verdict).summary;
            past.reason = Some(Refusal::Rejected(why).kind());
            past.score = Some([score, 0.0]);
            assert_eq!(inspection_title(&past), title);
            let filter = Filter {
                text: title.into(),
                shown: searched_texts(),
                ..Filter::default()
            };
            assert!(filter.passes(&past), "{title}");
        }
    }

    #[test]
    fn a_stored_scene_is_shown_in_the_language_of_the_window_and_files_keep_their_names() {
        let named = |name: &str| SceneTitle::Named(name.to_owned());
        let scan = || SceneTitle::Scan {
            name: "shots".into(),
            num_shots: 3,
        };
        let titles = [
            (
                SceneTitle::SimulatedFrame(7),
                true,
                "Simulated frame 7",
                "Simuliertes Bild 7",
            ),
            (
                named("door.pcd"),
                true,
                "door.pcd, simulated",
                "door.pcd, simuliert",
            ),
            (scan(), false, "shots · 3 shots", "shots · 3 Aufnahmen"),
            (
                scan(),
                true,
                "shots · 3 shots, simulated",
                "shots · 3 Aufnahmen, simuliert",
            ),
            (
                named("Simulated frame 7"),
                false,
                "Simulated frame 7",
                "Simulated frame 7",
            ),
            (
                named("Kinect frame 12"),
                false,
                "Kinect frame 12",
                "Kinect frame 12",
            ),
        ];
        for (language, place) in [(Language::English, 0), (Language::German, 1)] {
            language.make_current();
            for (title, is_simulated, english, german) in &titles {
                let expected = [english, german][place];
                assert_eq!(scene_title(title, *is_simulated), *expected);
            }
        }
        Language::English.make_current();
    }

    #[test]
    fn the_simulated_cell_has_one_name_whether_it_is_followed_or_captured() {
        Language::German.make_current();
        let sources = [
            CELL_SOURCE,
            "simulated",
            "simulated,side=right:fender",
            "/data/door.pcd",
        ];
        let shown = sources.map(|source| source_title(source, true));
        let both = searched_texts();
        Language::English.make_current();
        let cell = "Simulierte Zelle";
        assert_eq!(
            shown,
            [
                cell,
                cell,
                "Simulierte Zelle · side=right:fender",
                "/data/door.pcd"
            ]
        );
        let mut row = history_entry(1, StoredVerdict::Accepted, "fender")
            .record
            .summary;
        row.source = "simulated".into();
        let filter = Filter {
            text: "Zelle".into(),
            shown: both,
            ..Filter::default()
        };
        assert!(filter.passes(&row));
    }

    #[test]
    fn the_words_that_the_list_has_for_a_verdict_find_it() {
        let rows = StoredVerdict::ALL.map(|verdict| refused_door(verdict).summary);
        for language in Language::ALL {
            language.make_current();
            for (verdict, row) in StoredVerdict::ALL.into_iter().zip(&rows) {
                let filter = Filter {
                    text: described(&verdict),
                    shown: searched_texts(),
                    ..Filter::default()
                };
                let is_accepted = verdict == StoredVerdict::Accepted;
                assert_eq!(filter.passes(row), !is_accepted, "{language:?} {verdict:?}");
            }
        }
        Language::English.make_current();
    }

    #[test]
    fn a_stored_refusal_is_shown_in_the_language_of_the_window_and_names_parts_as_the_list_does() {
        let mut past = refused_door(StoredVerdict::Rejected);
        past.detail.refusal = Some(Refusal::Rejected(Rejection::SmallMargin {
            part: "front_door".into(),
            other: "back_door".into(),
            margin: 0.12,
            threshold: 0.6,
        }));
        let title_of = |name: &str| format!("the {name} of today");
        let shown = || {
            let why = past.titled_refusal(title_of).expect("refused");
            [described(&why), advised(&why)]
        };
        assert_eq!(
            shown()[0],
            "Door, left and the back_door of today fit almost equally well (margin 0.12, needed 0.60)"
        );
        Language::German.make_current();
        let [reason, advice] = shown();
        Language::English.make_current();
        assert!(reason.starts_with("Door, left "), "{reason}");
        for part in [" the back_door of today ", "Vorsprung 0.12"] {
            assert!(reason.contains(part), "{reason}");
        }
        assert!(advice.contains("Sichtseite"), "{advice}");
    }

    #[test]
    fn no_two_kinds_of_rejection_have_the_same_name() {
        let kinds: BTreeSet<RefusalKind> = rejections()
            .into_iter()
            .map(|why| Refusal::Rejected(why).kind())
            .collect();
        for language in Language::ALL {
            language.make_current();
            let names: BTreeSet<String> = kinds.iter().map(refusal_kind).collect();
            assert_eq!(names.len(), kinds.len(), "{language:?}");
        }
        Language::English.make_current();
    }

    #[test]
    fn a_part_that_certainly_does_not_hang_there_is_not_named() {
        let says = |score: f64| {
            described(&Rejection::Unknown {
                nearest: "Fender".to_owned(),
                score,
            })
        };
        assert!(!says(0.004).contains("Fender"));
        assert!(says(0.3).contains("Fender"));
    }

    #[test]
    fn what_was_not_checked_is_listed() {
        assert_eq!(not_checked(&[]), None);
        let both = [Unchecked::Arm, Unchecked::Accelerations("rail")];
        let expected = "Not checked: reach and collisions; acceleration of the rail";
        assert_eq!(not_checked(&both).as_deref(), Some(expected));
    }

    #[test]
    fn a_person_reads_signs_and_units() {
        let mm = UnitSystem::MillimetresDegrees;
        assert_eq!(mm.signed_length(0.0423), "+42.3 mm");
        assert_eq!(mm.signed_length(-0.0081), "\u{2212}8.1 mm");
        assert_eq!(mm.signed_length(-0.000_01), "0.0 mm");
        assert_eq!(mm.signed_angle(std::f64::consts::FRAC_PI_2), "+90.00°");
        assert_eq!(UnitSystem::MetresRadians.signed_length(0.0423), "+0.0423 m");
        assert_eq!(mm.length(-0.0481), "\u{2212}48.1 mm");
        assert_eq!(mm.length(0.15), "150.0 mm");
        assert_eq!(mm.angle(0.1), "5.73°");
        assert_eq!(mm.other().other(), mm);
    }
}
