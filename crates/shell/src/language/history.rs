//! Translates texts that the history stores in English into the language of the window.

use super::results::{
    is_recognised, rejection, rejection_advice, unrecognisable, unrecognisable_advice,
};
use inspection::pipeline::{AcceptParams, Refusal, RefusalKind, is_like};
use records::history::{Record, StoredVerdict, Summary};
use ui::language::text;

/// Prefix of the title of a frame of the simulated cell, before its number.
const FRAME: &str = "Simulated frame ";
/// Suffix of the title of a simulated scene.
const SIMULATED: &str = ", simulated";
/// Suffix of the title of a scan, after the number of its shots.
const SHOTS: &str = " shots";
/// Source of the single frames of the simulated cell.
const CELL: &str = "simulated cell";
/// Source of the frames of the simulated cell that is followed, before its settings.
const FOLLOWED_CELL: &str = "simulated";

/// Translates the title of an inspection.
pub fn stored_title(past: &Summary) -> String {
    if let Some(part) = recognised_part(past) {
        return text!("results-title-refused", part = part);
    }
    if let Some(part) = past.mirror_of() {
        return text!("results-title-mirrored", part = part);
    }
    match (past.verdict, stored_part(past)) {
        (StoredVerdict::Rejected, Some(part)) => {
            text!("results-title-not-recognised", part = part)
        }
        (StoredVerdict::Unknown, _) if past.score.is_some_and(|[score, _]| !is_like(score)) => {
            text!("inspect-unknown-part")
        }
        (StoredVerdict::Unknown, Some(part)) => text!("results-title-unknown", part = part),
        (StoredVerdict::NoPart, _) => text!("results-no-part"),
        _ => past.title.clone(),
    }
}

/// Returns the title of a part that was recognised and yet not accepted. The limits of its recipe are not in the row: those
/// of the built-in recipe decide.
pub fn recognised_part(past: &Summary) -> Option<&str> {
    let is_recognised = is_recognised(past.score?, &AcceptParams::default());
    let is_refused = past.verdict == StoredVerdict::Rejected;
    stored_part(past).filter(|_| is_refused && is_recognised)
}

/// Returns the title that the best match had at the time of the inspection.
fn stored_part(past: &Summary) -> Option<&str> {
    let title = past.title.as_str();
    match past.verdict {
        StoredVerdict::Accepted => Some(title),
        StoredVerdict::Rejected => title.strip_prefix("Not recognised · nearest "),
        StoredVerdict::Unknown => title
            .strip_prefix("Unknown · nearest ")
            .or_else(|| past.mirror_of()),
        StoredVerdict::NoPart => None,
    }
}

/// Translates the stored title of a scene or its source, except the names of files and cameras.
pub fn stored_scene(title: &str, is_simulated: bool) -> String {
    if !is_simulated {
        return stored_scan(title);
    }
    if title == CELL {
        return text!("shell-simulated-cell");
    }
    if let Some(settings) = title.strip_prefix(FOLLOWED_CELL)
        && (settings.is_empty() || settings.starts_with([',', ':']))
    {
        let cell = text!("shell-simulated-cell");
        return match settings.trim_start_matches([',', ':']) {
            "" => cell,
            settings => format!("{cell} · {settings}"),
        };
    }
    if let Some(number) = title.strip_prefix(FRAME)
        && let Ok(number) = number.parse::<u64>()
    {
        return text!("shell-simulated-frame", number = number);
    }
    match title.strip_suffix(SIMULATED) {
        Some(name) => text!("shell-of-simulator", name = stored_scan(name)),
        None => stored_scan(title),
    }
}

/// Translates the number of shots in the stored title of a scan; returns any other title unchanged.
fn stored_scan(title: &str) -> String {
    let counted = title.strip_suffix(SHOTS);
    if let Some((name, num)) = counted.and_then(|title| title.rsplit_once(" · "))
        && let Ok(num) = num.parse::<u64>()
    {
        return format!("{name} · {}", text!("shots-all-used", num = num));
    }
    title.to_owned()
}

/// Returns what [`stored_scene`] shows beside what the history stores for it, in lower case, so that a search finds both.
pub fn shown_for_stored() -> Vec<[String; 2]> {
    // The texts that are searched begin on lines of their own.
    let followed_cell = format!("\n{FOLLOWED_CELL}");
    let both = [
        (text!("shell-simulated-frame", number = ""), FRAME),
        (text!("shell-of-simulator", name = ""), SIMULATED),
        (text!("shots-all-used", num = ""), SHOTS),
        (text!("shell-simulated-cell"), CELL),
        (text!("shell-simulated-cell"), followed_cell.as_str()),
    ];
    both.map(|(shown, stored)| [shown.to_lowercase(), stored.to_lowercase()])
        .into()
}

/// Returns the reason of a refusal, and what to do; in English if only the text is stored.
pub fn stored_refusal(past: &Record, title_of: impl Fn(&str) -> String) -> Option<[String; 2]> {
    let Record { summary, detail } = past;
    let refusal = detail.refusal.as_ref()?;
    let Some(why) = refusal.why.clone() else {
        return Some([refusal.reason.clone(), refusal.advice.clone()]);
    };
    // Call the best match by the title that the list shows: the part may have been renamed since.
    let why = why.renamed(|name| match stored_part(summary) {
        Some(title) if detail.nearest.as_deref() == Some(name) => title.to_owned(),
        _ => title_of(name),
    });
    Some(match &why {
        Refusal::Rejected(why) => [rejection(why), rejection_advice(why)],
        Refusal::Unrecognisable(why) => [unrecognisable(why), unrecognisable_advice(why)],
    })
}

/// Returns the name of a kind of refusal, for counts.
pub fn refusal_kind(kind: RefusalKind) -> String {
    match kind {
        RefusalKind::LowScore => text!("results-kind-low-score"),
        RefusalKind::Piece => text!("results-kind-piece"),
        RefusalKind::HardlySeen => text!("results-kind-hardly-seen"),
        RefusalKind::AnotherModel => text!("results-kind-another-model"),
        RefusalKind::AnotherMake => text!("results-kind-another-make"),
        RefusalKind::AmbiguousPose => text!("results-kind-ambiguous-pose"),
        RefusalKind::Unconstrained => text!("results-kind-unconstrained"),
        RefusalKind::Uncertain => text!("results-kind-uncertain"),
        RefusalKind::Unknown => text!("results-kind-unknown"),
        RefusalKind::Mirrored => text!("results-kind-mirrored"),
        RefusalKind::MirroredImage => text!("results-kind-mirrored-image"),
        RefusalKind::SmallMargin => text!("results-kind-small-margin"),
        RefusalKind::Unconfirmed => text!("results-kind-unconfirmed"),
        RefusalKind::OutOfRange => text!("results-kind-out-of-range"),
        RefusalKind::BehindCamera => text!("results-kind-behind-camera"),
        RefusalKind::SurplusBytes => text!("results-kind-surplus-bytes"),
        RefusalKind::NoPose => text!("results-kind-no-pose"),
        RefusalKind::NotSteady => text!("results-kind-not-steady"),
        RefusalKind::FewFrames => text!("results-kind-few-frames"),
        RefusalKind::Undecided => text!("results-kind-undecided"),
        RefusalKind::PosesApart => text!("results-kind-poses-apart"),
        RefusalKind::TooFewPoints
        | RefusalKind::TooWide
        | RefusalKind::OnlyBackground
        | RefusalKind::NoPlane
        | RefusalKind::TooLarge
        | RefusalKind::NoShape
        | RefusalKind::NoOutline
        | RefusalKind::EmptyLibrary
        | RefusalKind::Fault => text!("results-no-part"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use capture::{SimulatedSpec, SourceSpec};
    use inspection::{fixtures::rejections, pipeline::Rejection};
    use records::{
        fixtures::history_entry,
        history::{Filter, StoredRefusal},
    };
    use ui::language::Language;

    /// A refused front door whose title was "Door, left" at that time.
    fn past(refusal: StoredRefusal) -> Record {
        let mut past = history_entry(1, StoredVerdict::Rejected, "front_door").record;
        past.summary.title = "Not recognised · nearest Door, left".into();
        past.detail.refusal = Some(refusal);
        past
    }

    fn title_of(name: &str) -> String {
        format!("the {name} of today")
    }

    #[test]
    fn titles_are_recognised_as_the_history_writes_them() {
        let written = include_str!("../../../records/src/history/entry.rs");
        for title in [
            "Not recognised · nearest {name}",
            "Unknown · nearest {name}",
        ] {
            assert!(written.contains(title), "{title}");
        }
    }

    #[test]
    fn the_title_of_an_unknown_part_names_no_part_that_it_is_not_like() {
        let mut past = history_entry(1, StoredVerdict::Unknown, "front_door").record;
        past.summary.title = "Unknown · nearest Door, left".into();
        let mut shown = |score| {
            past.summary.score = Some([score, score]);
            stored_title(&past.summary)
        };
        assert!(shown(0.3).contains("Door, left"));
        assert!(!shown(0.004).contains("Door, left"));
    }

    #[test]
    fn a_part_that_is_only_in_doubt_where_it_is_has_its_name_in_the_title() {
        let mut past = history_entry(1, StoredVerdict::Rejected, "front_door").record;
        past.summary.title = "Not recognised · nearest Door, left".into();
        let mut shown = |score| {
            past.summary.score = Some(score);
            stored_title(&past.summary)
        };
        assert_eq!(shown([0.97, 0.97]), "Door, left · not accepted");
        for score in [[0.89, 0.97], [0.97, 0.43]] {
            assert_eq!(shown(score), "Not recognised · nearest Door, left");
        }
    }

    #[test]
    fn titles_of_scenes_are_recognised_as_they_are_written() {
        let source = include_str!("../inspection/source.rs");
        let fuse = include_str!("../inspection/fuse.rs");
        for (written, title) in [
            (source, format!("\"{FRAME}{{number}}\"")),
            (source, format!("\"{{name}}{SIMULATED}\"")),
            (source, format!("\"{CELL}\"")),
            (fuse, format!("\"{{title}} · {{}}{SHOTS}\"")),
        ] {
            assert!(written.contains(&title), "{title}");
        }
    }

    #[test]
    fn a_stored_scene_is_shown_in_the_language_of_the_window_and_files_keep_their_names() {
        let titles = [
            ("Simulated frame 7", true, "Simuliertes Bild 7"),
            ("simulated cell", true, "Simulierte Zelle"),
            ("door.pcd, simulated", true, "door.pcd, simuliert"),
            ("shots · 3 shots", false, "shots · 3 Aufnahmen"),
            (
                "shots · 3 shots, simulated",
                true,
                "shots · 3 Aufnahmen, simuliert",
            ),
            // Names of files and cameras, and texts written by commands.
            ("Simulated frame 7", false, "Simulated frame 7"),
            (
                "Simulated frame of a door",
                true,
                "Simulated frame of a door",
            ),
            ("door, simulated", false, "door, simulated"),
            ("three shots", false, "three shots"),
            ("Kinect frame 12", false, "Kinect frame 12"),
            ("/data/door.pcd", true, "/data/door.pcd"),
        ];
        for (title, is_simulated, _) in titles {
            let shown = stored_scene(title, is_simulated);
            assert!(shown.eq_ignore_ascii_case(title), "{shown}");
        }
        Language::German.make_current();
        let shown = titles.map(|(title, is_simulated, _)| stored_scene(title, is_simulated));
        Language::English.make_current();
        assert_eq!(shown, titles.map(|(.., expected)| expected));
    }

    #[test]
    fn the_simulated_cell_has_one_name_whether_it_is_followed_or_captured() {
        let followed = SourceSpec::Simulated(SimulatedSpec::default());
        assert_eq!(followed.to_string(), FOLLOWED_CELL);
        Language::German.make_current();
        let shown = ["simulated cell", "simulated", "simulated,side=right:fender"]
            .map(|source| stored_scene(source, true));
        let both = shown_for_stored();
        Language::English.make_current();
        let [single, followed, set_up] = shown;
        assert_eq!(
            (&*single, &*followed),
            ("Simulierte Zelle", "Simulierte Zelle")
        );
        assert_eq!(set_up, "Simulierte Zelle · side=right:fender");
        let mut row = history_entry(1, StoredVerdict::Accepted, "fender")
            .record
            .summary;
        row.scene = "Frame 12".into();
        row.source = FOLLOWED_CELL.into();
        let filter = Filter {
            text: "Zelle".into(),
            shown: both,
            ..Filter::default()
        };
        assert!(filter.passes(&row));
    }

    #[test]
    fn a_stored_refusal_is_shown_in_the_language_of_the_window_and_names_parts_as_the_list_does() {
        let why = Rejection::SmallMargin {
            part: "front_door".into(),
            other: "back_door".into(),
            margin: 0.12,
            threshold: 0.6,
        };
        let past = past(StoredRefusal {
            reason: "in English".into(),
            advice: "in English".into(),
            why: Some(Refusal::Rejected(why)),
        });
        let shown = || stored_refusal(&past, title_of).expect("refused");
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
    fn a_refusal_stored_only_as_english_text_is_shown_unchanged() {
        let past = past(StoredRefusal {
            reason: "too low".into(),
            advice: "look again".into(),
            why: None,
        });
        let shown = stored_refusal(&past, title_of);
        assert_eq!(shown, Some(["too low".to_owned(), "look again".to_owned()]));
    }

    #[test]
    fn no_two_kinds_of_rejection_have_the_same_name() {
        let kinds: std::collections::BTreeSet<RefusalKind> = rejections()
            .into_iter()
            .map(|why| Refusal::Rejected(why).kind())
            .collect();
        for language in Language::ALL {
            language.make_current();
            let names: std::collections::BTreeSet<String> =
                kinds.iter().map(|kind| refusal_kind(*kind)).collect();
            assert_eq!(names.len(), kinds.len(), "{language:?}");
        }
        Language::English.make_current();
    }
}
