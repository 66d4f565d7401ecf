//! Remark on and true label of an inspection.

use egui::{Ui, WidgetInfo};

use super::HistoryAction;
use crate::shared::{truth_entries, truth_title};
use inspection::library::Truth;
use records::history::Summary;
use shell::{inspection::library_cache::LibraryView, session::Session};
use ui::{
    language::text,
    widgets::{heading, line_edit, shortened},
};

/// The remark and the true label being edited.
#[derive(Default)]
pub(super) struct Remark {
    /// The inspection, its stored remark, and the text being edited.
    draft: Option<(i64, String, String)>,
    /// The inspection for which the menu of true labels was opened, while it is open.
    labelled: Option<i64>,
}

impl Remark {
    /// Draws both; returns true while the remark or the label is being edited.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        row: &Summary,
        session: &Session,
        actions: &mut Vec<HistoryAction>,
    ) -> bool {
        heading(ui, &text!("history-actual-part"));
        let is_labelled = truth_menu(ui, row, &mut self.labelled, session, actions);
        heading(ui, &text!("history-remark"));
        // Start anew for another inspection, or if the stored remark was changed elsewhere.
        let is_of_it = self
            .draft
            .as_ref()
            .is_some_and(|(number, known, _)| *number == row.number && *known == row.remark);
        if !is_of_it {
            if let Some((number, remark)) = self.take_edited(Some(row.number)) {
                actions.push(HistoryAction::Remark(number, remark));
            }
            self.draft = Some((row.number, row.remark.clone(), in_one_line(&row.remark)));
        }
        let Some((_, known, text)) = &mut self.draft else {
            return is_labelled;
        };
        let field = line_edit(text, text!("shell-notes-hint"), f32::INFINITY);
        let response = ui.add(field);
        let label = text!("history-your-remark");
        response.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &label));
        if response.lost_focus() && is_edited(text, known) {
            // Until the stored remark comes back.
            known.clone_from(text);
            let remark = text.trim().to_owned();
            actions.push(HistoryAction::Remark(row.number, remark));
        }
        is_labelled || response.has_focus()
    }

    /// Takes a remark that was edited before another inspection came to the front or the window closes.
    pub(super) fn take_edited(&mut self, front: Option<i64>) -> Option<(i64, String)> {
        let (number, known, text) = self.draft.take()?;
        let is_edited = Some(number) != front && is_edited(&text, &known);
        is_edited.then(|| (number, text.trim().to_owned()))
    }
}

/// True if the text in the field is no longer that of the stored remark.
fn is_edited(text: &str, known: &str) -> bool {
    text.trim() != in_one_line(known).trim()
}

/// Returns a remark without line breaks, which commands may store: in one line they are drawn as boxes.
pub(super) fn in_one_line(remark: &str) -> String {
    remark.replace(char::is_control, " ")
}

/// Draws the menu of true labels; returns true while it is open. What is chosen in it is the label of the inspection for
/// which it was opened.
fn truth_menu(
    ui: &mut Ui,
    row: &Summary,
    labelled: &mut Option<i64>,
    session: &Session,
    actions: &mut Vec<HistoryAction>,
) -> bool {
    let number = labelled.unwrap_or(row.number);
    let unloaded = LibraryView::default();
    let library = session.library.as_deref().unwrap_or(&unloaded);
    let chosen = row.label.as_ref();
    let title = shortened(&truth_title(chosen, library), 24);
    let title = format!("{} · {title} ▼", text!("history-actual-part"));
    let menu = ui.menu_button(&title, |ui| {
        let first = [None, Some(Truth::NotEnrolled), Some(Truth::Nothing)];
        truth_entries(ui, chosen, &first, library, |truth| {
            actions.push(HistoryAction::Label(number, truth));
        });
    });
    let is_open = menu.inner.is_some();
    *labelled = is_open.then_some(number);
    is_open || menu.response.clicked()
}
