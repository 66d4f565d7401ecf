//! The changes since an earlier run: worse results first, then better ones, then other scores.

use egui::{RichText, ScrollArea, Ui};

use super::{CompareAction, RunChanges, kept_cases::case_row};
use records::cases::{CaseChange, FoundVerdict};
use shell::inspection::library_cache::LibraryView;
use ui::{
    language::{described, text},
    theme::{Theme, font},
};

pub(super) fn ui(
    ui: &mut Ui,
    changes: &RunChanges,
    shown: &LibraryView,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let RunChanges { file, changes } = changes;
    ui.horizontal_wrapped(|ui| {
        let worse = match changes.regressions.len() {
            0 => theme.accepted,
            _ => theme.rejected,
        };
        let num_worse = text!("compare-num-worse", count = changes.regressions.len());
        let worse = RichText::new(num_worse).color(worse);
        ui.label(worse.font(font::body_strong()));
        let mut rest = vec![
            text!("compare-num-better", count = changes.mends.len()),
            text!("compare-num-rescored", count = changes.rescored.len()),
            text!("compare-num-common", count = changes.num_common),
        ];
        if !changes.added.is_empty() {
            rest.push(text!("compare-num-new", count = changes.added.len()));
        }
        if !changes.gone.is_empty() {
            rest.push(text!("compare-num-gone", count = changes.gone.len()));
        }
        rest.push(text!("compare-against-file", file = file));
        ui.label(format!("· {}", rest.join(" · ")));
    });
    let rows: Vec<(String, &CaseChange)> = [
        (text!("compare-worse"), &changes.regressions),
        (text!("compare-better"), &changes.mends),
        (text!("history-figure-score"), &changes.rescored),
    ]
    .into_iter()
    .flat_map(|(word, list)| list.iter().map(move |change| (word.clone(), change)))
    .collect();
    if rows.is_empty() {
        ui.weak(text!("compare-no-changes"));
    }
    ScrollArea::vertical()
        .id_salt("changes")
        .auto_shrink(false)
        .show(ui, |ui| {
            for (word, change) in rows {
                case_row(ui, &change.name, &words(&word, change, shown), acts);
            }
        });
}

/// Describes a change briefly: a row fits about sixty characters.
fn words(word: &str, change: &CaseChange, shown: &LibraryView) -> String {
    let found = |found: &FoundVerdict| match (&found.part, found.score) {
        (Some(part), Some(score)) => format!("{} {score:.2}", shown.title_of(part)),
        _ => text!("compare-nothing"),
    };
    let before = found(&change.before);
    let now = match change.now.score {
        Some(score) if change.before.part == change.now.part => format!("{score:.2}"),
        _ => found(&change.now),
    };
    let [was, is] = change.judgements.map(|outcome| described(&outcome));
    if was == is {
        text!(
            "compare-change-same",
            change = word,
            before = before,
            now = now
        )
    } else {
        text!(
            "compare-change",
            change = word,
            is = is,
            was = was,
            before = before,
            now = now,
        )
    }
}
