//! Texts about results in the language of the window.

use crate::inspection::source::CELL_SOURCE;
use capture::SourceSpec;
use inspection::{
    library::Side,
    pipeline::{AS_IN_THE_PAPER, Identification, RecipeLabel, RefusalKind},
};
use records::history::{SceneTitle, StoredVerdict, Summary};
use simulate::ObjectKind;
use ui::{
    language::{Language, described, text},
    widgets::sentence,
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
}
