//! The fields for title, name and notes of a part.

use egui::{RichText, TextEdit, Ui, vec2};

use super::draft::{Field, Form};
use crate::{
    app::{
        language::text,
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, mark},
        },
    },
    error::Advice as _,
};

/// Draws the fields; returns the one that was edited.
pub(super) fn ui(ui: &mut Ui, form: &Form, theme: &Theme) -> Option<Field> {
    let mut written = None;
    let line = |ui: &mut Ui, label: String, hint: String, text: &str, rows: usize| {
        let mut text = text.to_owned();
        let name = ui.label(
            RichText::new(label)
                .font(font::small())
                .color(theme.weak_text),
        );
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
    if let Some(name) = line(
        ui,
        text!("enrol-name"),
        text!("enrol-name-hint"),
        &form.name,
        1,
    ) {
        written = Some(Field::Name(name));
    }
    if !(form.name.is_empty() && form.title.is_empty())
        && let Err(error) = form.words()
    {
        complaint(ui, &error.to_string(), &error.advice(), theme);
    }
    if let Some(notes) = line(
        ui,
        text!("enrol-notes"),
        text!("enrol-notes-hint"),
        &form.notes,
        2,
    ) {
        written = Some(Field::Notes(notes));
    }
    written
}

/// Draws what is wrong and what to do.
pub(super) fn complaint(ui: &mut Ui, what: &str, advice: &str, theme: &Theme) {
    said(ui, Mark::Look, what, theme);
    ui.label(RichText::new(advice).color(theme.warning));
}

/// Draws a mark and a sentence.
pub(super) fn said(ui: &mut Ui, sign: Mark, text: &str, theme: &Theme) {
    ui.horizontal_top(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(18.0, 18.0), egui::Sense::hover());
        mark(ui.painter(), rect.center(), 8.0, sign, theme);
        let mut letters = text.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        let text: String = first.chain(letters).collect();
        ui.add(egui::Label::new(RichText::new(text).color(theme.text)).wrap());
    });
}
