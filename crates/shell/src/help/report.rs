//! Problem reports: the page of Help that says what one holds, and the task that writes it.

use std::{
    net::{Ipv4Addr, Ipv6Addr},
    path::PathBuf,
    sync::Arc,
};

use egui::Ui;

use crate::{
    action::{Action, DialogRequest},
    inspection::inspected::Inspected,
    notice::Notice,
    settings::Settings,
    state::{State, notify},
};
use inspection::{library::PartName, pipeline::NamedRecipe};
use records::{
    history::Traceability,
    report::{ProblemReport, SETTINGS_FILE, compared_entries},
};
use ui::{
    language::text,
    theme::space,
    user_error::UserError,
    widgets::{heading, text_button},
};

/// What a text has in place of the address of a robot, a camera or a computer.
const ADDRESS: &str = "(address)";

/// Starts to write a report about what is on screen.
pub(crate) fn write(state: &mut State, path: PathBuf) {
    let inspected = on_screen(state).cloned();
    let recipe = recipe(state);
    let system = [
        format!("Graphics: {}", state.installation.graphics),
        format!("Language: {}", state.session.language.code()),
    ];
    let settings = Settings::of(state, None).without_secrets();
    let library_cache = state.inspector.library_cache.clone();
    let log: Vec<&str> = state.log.iter().map(String::as_str).collect();
    let log = without_addresses(&log.join("\n"));
    let title = text!("help-report-writing");
    state.report_writing.start(title, move |_| {
        let settings = toml::to_string(&settings);
        // A problem with the settings costs nothing else.
        let settings = settings.unwrap_or_else(|error| error.to_string());
        let texts = [
            (SETTINGS_FILE, without_addresses(&settings)),
            ("log.txt", log),
        ];
        let entries = inspected.as_deref().map(entries).unwrap_or_default();
        let line = inspected.as_deref().map(|inspected| {
            let recorded = inspected.as_recorded(&inspected.subject, inspected.robot.as_deref());
            without_addresses(&recorded.line(&Traceability::default()))
        });
        let loaded = library_cache.get();
        let report = ProblemReport {
            scene: inspected.as_ref().map(|inspected| &*inspected.scene),
            line: line.as_deref(),
            recipe: &recipe,
            library: loaded.place.as_ref(),
            entries: &entries,
            system: &system,
            texts: &texts,
        };
        report.write(&path).map_err(|error| UserError::of(&error))?;
        Ok(path)
    });
}

/// Says whether a report was written.
pub fn update(state: &mut State) {
    let notice = match state.report_writing.poll() {
        Some(Ok(path)) => Notice::done(text!("shell-wrote", path = path.display().to_string())),
        Some(Err(error)) => error.into(),
        None => return,
    };
    notify(state, notice);
}

fn on_screen(state: &State) -> Option<&Arc<Inspected>> {
    let shown = state.session.shown.as_ref()?;
    Some(&shown.inspected)
}

/// The recipe of what is on screen, else the one in use.
fn recipe(state: &State) -> Arc<NamedRecipe> {
    let recipe = on_screen(state).map_or(&state.session.recipe, |inspected| &inspected.recipe);
    Arc::clone(recipe)
}

fn entries(inspected: &Inspected) -> Vec<PartName> {
    compared_entries(&inspected.inspection, &inspected.library.parts)
}

/// The text without network addresses. Ports stay.
fn without_addresses(text: &str) -> String {
    let of_version_6 = |letter: char| letter.is_ascii_hexdigit() || matches!(letter, '.' | ':');
    let text = without(text, of_version_6, |word| word.parse::<Ipv6Addr>().is_ok());
    let of_version_4 = |letter: char| letter.is_ascii_digit() || letter == '.';
    without(&text, of_version_4, |word| word.parse::<Ipv4Addr>().is_ok())
}

/// The text without the words of these letters that are addresses.
fn without(
    text: &str,
    is_letter: impl Fn(char) -> bool,
    is_address: impl Fn(&str) -> bool,
) -> String {
    let mut cleaned = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(begin) = rest.find(&is_letter) {
        let (before, from) = rest.split_at(begin);
        let end = from.find(|letter: char| !is_letter(letter));
        let (word, after) = from.split_at(end.unwrap_or(from.len()));
        cleaned.push_str(before);
        // A stop or a colon may be that of the sentence; and `d::ce` is in the middle of `std::cell`.
        let has_digit = |word: &str| word.bytes().any(|letter| letter.is_ascii_digit());
        let mut both = [word, word.trim_matches(['.', ':'])].into_iter();
        match both.find(|word| has_digit(word) && is_address(word)) {
            Some(address) => cleaned.push_str(&word.replacen(address, ADDRESS, 1)),
            None => cleaned.push_str(word),
        }
        rest = after;
    }
    cleaned.push_str(rest);
    cleaned
}

/// Draws what a report would hold, and the button that writes it.
pub(super) fn ui(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    ui.label(text!("help-report-says"));
    heading(ui, &text!("help-report-inside"));
    let mut lines = Vec::new();
    match on_screen(state) {
        None => lines.push(text!("help-report-no-scene")),
        Some(inspected) => {
            let scene = inspected.origin.shown_title();
            lines.push(if inspected.scan.is_some() {
                text!("help-report-first-shot", scene = scene)
            } else {
                text!("help-report-scene", scene = scene)
            });
            let entries = entries(inspected);
            if let Some(first) = entries.first() {
                let part = inspected.library.title_of(first.as_str()).to_owned();
                let num = entries.len();
                lines.push(text!("help-report-entries", part = part, num = num));
            }
        }
    }
    let recipe = recipe(state).label.to_string();
    lines.extend([
        text!("help-report-recipe", recipe = recipe),
        text!("help-report-system"),
        text!("help-report-settings"),
        text!("help-report-log", num = state.log.len()),
    ]);
    for line in lines {
        ui.label(format!("•  {line}"));
    }
    ui.add_space(space::SMALL);
    ui.weak(text!("help-report-without"));
    ui.add_space(space::MEDIUM);
    if text_button(ui, &text!("help-report-save")).clicked() {
        actions.push(Action::Ask(DialogRequest::ProblemReport));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_left_out_of_texts_and_nothing_else_is() {
        for (text, cleaned) in [
            (
                "Robots that ask at 192.168.1.5:30100 get no answer",
                "Robots that ask at (address):30100 get no answer",
            ),
            ("genicam:10.0.0.7, lost", "genicam:(address), lost"),
            // A name that ends with a letter that an address of version 6 may have.
            ("source:10.0.0.7:80, lost", "source:(address):80, lost"),
            ("Answered 10.0.0.7.", "Answered (address)."),
            ("eki=[fe80::1]:54600", "eki=[(address)]:54600"),
            (
                "2026-11-30T12:30:05Z 0.1.0 std::cell 1.25 d:e",
                "2026-11-30T12:30:05Z 0.1.0 std::cell 1.25 d:e",
            ),
        ] {
            assert_eq!(without_addresses(text), cleaned);
        }
    }
}
