//! The fields for title, name and notes of a part.

use egui::{RichText, TextEdit, Ui, vec2};

use super::draft::{Field, Form};
use inspection::library::MAX_TITLE;
use ui::{
    language::{text, what_and_advice},
    theme::{Theme, space},
    widgets::{Mark, line_mark},
};

/// Draws the fields; returns the one that was edited.
pub(super) fn ui(ui: &mut Ui, form: &Form) -> Option<Field> {
    let mut written = None;
    let line = |ui: &mut Ui, label: String, hint: String, text: &str, rows: usize| {
        let mut text = text.to_owned();
        let name = ui.label(RichText::new(label).small().weak());
        let edit = if rows == 1 {
            TextEdit::singleline(&mut text).align(egui::Align2::LEFT_CENTER)
        } else {
            TextEdit::multiline(&mut text).desired_rows(rows)
        };
        let edit = edit
            .hint_text(hint)
            .desired_width(f32::INFINITY)
            .min_size(vec2(0.0, space::TARGET));
        let response = ui.add(edit).labelled_by(name.id);
        response.changed().then_some(text)
    };
    if let Some(title) = line(
        ui,
        text!("enrol-title"),
        text!("enrol-title-hint"),
        &form.title,
        1,
    ) {
        written = Some(Field::Title(title));
    }
    if form.title.chars().count() >= MAX_TITLE {
        let text = text!("enrol-title-full", limit = MAX_TITLE);
        let text = RichText::new(text).small().color(Theme::of(ui).warning);
        ui.add(egui::Label::new(text).wrap());
    }
    if let Some(name) = line(
        ui,
        text!("shell-name"),
        text!("enrol-name-hint"),
        &form.name,
        1,
    ) {
        written = Some(Field::Name(name));
    }
    if !(form.name.is_empty() && form.title.is_empty())
        && let Err(error) = form.words()
    {
        let [what, advice] = what_and_advice(&error);
        complaint(ui, &what, &advice);
    }
    if let Some(notes) = line(
        ui,
        text!("enrol-notes"),
        text!("shell-notes-hint"),
        &form.notes,
        2,
    ) {
        written = Some(Field::Notes(notes));
    }
    written
}

/// Draws what is wrong and what to do.
pub(super) fn complaint(ui: &mut Ui, what: &str, advice: &str) {
    let theme = Theme::of(ui);
    remark(ui, Mark::Look, what);
    ui.label(RichText::new(advice).color(theme.warning));
}

/// Draws a mark and a sentence.
pub(super) fn remark(ui: &mut Ui, sign: Mark, text: &str) {
    ui.horizontal_top(|ui| {
        line_mark(ui, 18.0, 8.0, sign);
        let mut letters = text.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        let text: String = first.chain(letters).collect();
        ui.add(egui::Label::new(text).wrap());
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_that_has_reached_its_limit_says_so() {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        for (entered, is_full) in [(79, false), (80, true), (120, true)] {
            let mut form = Form::default();
            form.write(Field::Title("x".repeat(entered)), None);
            let output = ctx.run_ui(egui::RawInput::default(), |root| {
                ui(root, &form);
            });
            let is_said = output.shapes.iter().any(|drawn| match &drawn.shape {
                egui::Shape::Text(text) => text.galley.text().contains("at most 80 characters"),
                _ => false,
            });
            output.drop_without_applying_deltas();
            assert_eq!(is_said, is_full, "{entered}");
        }
    }
}
