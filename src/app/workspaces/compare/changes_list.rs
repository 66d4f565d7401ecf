//! What changed since an earlier run: the worse first, then the better, then other scores.

use egui::{RichText, ScrollArea, Ui};

use super::{CompareAction, RunChanges, kept_cases::case_row, matrix::part_title};
use crate::{
    app::{
        inspection::library_cache::LibraryView,
        ui::theme::{Theme, font},
    },
    cases::{CaseChange, CaseOutcome, FoundVerdict},
};

/// Draws all of it.
pub(super) fn ui(
    ui: &mut Ui,
    changes: &RunChanges,
    shown: &LibraryView,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let RunChanges { file, changes } = changes;
    ui.horizontal_wrapped(|ui| {
        let worse = match changes.regressions.len() {
            0 => RichText::new("none worse").color(theme.accepted),
            num => RichText::new(format!("{num} worse")).color(theme.rejected),
        };
        ui.label(worse.font(font::body_strong()));
        let mut rest = vec![
            format!("{} better", changes.mends.len()),
            format!("{} with another score", changes.rescored.len()),
            format!("{} cases of both", changes.num_common),
        ];
        for (num, words) in [
            (changes.added.len(), "new"),
            (changes.gone.len(), "gone or damaged"),
        ] {
            if num > 0 {
                rest.push(format!("{num} {words}"));
            }
        }
        let text = format!("· {} · against {file}", rest.join(" · "));
        ui.label(RichText::new(text).color(theme.text));
    });
    let rows: Vec<(&str, &CaseChange)> = [
        ("worse", &changes.regressions),
        ("better", &changes.mends),
        ("score", &changes.rescored),
    ]
    .into_iter()
    .flat_map(|(word, list)| list.iter().map(move |change| (word, change)))
    .collect();
    if rows.is_empty() {
        let text = "Every case of both runs came out as before";
        ui.label(RichText::new(text).color(theme.weak_text));
    }
    ScrollArea::vertical()
        .id_salt("changes")
        .auto_shrink(false)
        .show(ui, |ui| {
            for (word, change) in rows {
                case_row(ui, &change.name, &words(word, change, shown), theme, acts);
            }
        });
}

/// Short: a row has room for some sixty letters.
fn words(word: &str, change: &CaseChange, shown: &LibraryView) -> String {
    let found = |found: &FoundVerdict| match (&found.part, found.score) {
        (Some(part), Some(score)) => format!("{} {score:.2}", part_title(part, shown)),
        _ => "nothing".into(),
    };
    let before = found(&change.before);
    let now = match change.now.score {
        Some(score) if change.before.part == change.now.part => format!("{score:.2}"),
        _ => found(&change.now),
    };
    let [was, is] = change.judgements.map(CaseOutcome::words);
    if was == is {
        format!("{word}: {before} → {now}")
    } else {
        format!("{word}: {is}, was {was} · {before} → {now}")
    }
}
