//! What a person says of an inspection: a remark, and what it truly is.

use egui::{ScrollArea, TextEdit, Ui, WidgetInfo, vec2};

use super::HistoryAction;
use crate::{
    app::{
        inspection::library_cache::LibraryView,
        language::text,
        shell::session::Session,
        ui::{
            theme::{Theme, space},
            widgets::{heading, shortened},
        },
    },
    history::Summary,
    library::Truth,
};

/// The remark that is being written.
#[derive(Default)]
pub(super) struct Remark {
    /// Of which inspection, what stood there, and what is written.
    draft: Option<(i64, String, String)>,
}

impl Remark {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        row: &Summary,
        session: &Session,
        theme: &Theme,
        actions: &mut Vec<HistoryAction>,
    ) {
        heading(ui, theme, &text!("history-actual-part"));
        truth_menu(ui, row, session, actions);
        heading(ui, theme, &text!("history-remark"));
        // Another inspection, or somebody else has written another remark.
        let is_of_it = self
            .draft
            .as_ref()
            .is_some_and(|(number, known, _)| *number == row.number && *known == row.remark);
        if !is_of_it {
            self.keep(actions, Some(row.number));
            self.draft = Some((row.number, row.remark.clone(), row.remark.clone()));
        }
        let Some((_, known, text)) = &mut self.draft else {
            return;
        };
        let field = TextEdit::singleline(text)
            .hint_text(text!("history-remark-hint"))
            .desired_width(f32::INFINITY)
            .min_size(vec2(0.0, space::TARGET))
            .align(egui::Align2::LEFT_CENTER);
        let response = ui.add(field);
        let label = text!("history-your-remark");
        response.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &label));
        if response.lost_focus() && text.trim() != known {
            // Until it is written and comes back.
            known.clone_from(text);
            let remark = text.trim().to_owned();
            actions.push(HistoryAction::Remark(row.number, remark));
        }
    }

    /// What was written of an inspection before another came to the front, or the window closes, is not lost.
    pub(super) fn keep(&mut self, actions: &mut Vec<HistoryAction>, front: Option<i64>) {
        if let Some((number, known, text)) = self.draft.take()
            && Some(number) != front
            && text.trim() != known.trim()
        {
            let remark = text.trim().to_owned();
            actions.push(HistoryAction::Remark(number, remark));
        }
    }
}

/// What a truth is called where it is chosen.
fn title_of(truth: Option<&Truth>, library: Option<&LibraryView>) -> String {
    match truth {
        None => text!("history-truth-not-set"),
        Some(Truth::NotEnrolled) => text!("history-truth-not-enrolled"),
        Some(Truth::Nothing) => text!("history-truth-nothing"),
        Some(Truth::Part(name)) => {
            let place = library.and_then(|library| library.place_of(name));
            let title = library
                .zip(place)
                .map(|(library, place)| library.title(place));
            title.unwrap_or(name).to_owned()
        }
    }
}

fn truth_menu(ui: &mut Ui, row: &Summary, session: &Session, actions: &mut Vec<HistoryAction>) {
    let library = session.library.as_deref();
    let chosen = row.label.as_ref();
    let name = text!("history-actual-part");
    let title = format!("{name} · {} ▼", shortened(&title_of(chosen, library), 24));
    ui.menu_button(&title, |ui| {
        ui.set_min_width(200.0);
        ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
            let parts = library.iter().flat_map(|library| &library.parts);
            let parts = parts.map(|part| Some(Truth::Part(part.name.as_str().to_owned())));
            let others = [None, Some(Truth::NotEnrolled), Some(Truth::Nothing)];
            for truth in others.into_iter().chain(parts) {
                let title = title_of(truth.as_ref(), library);
                let response = ui.selectable_label(row.label == truth, &title);
                response.widget_info(|| {
                    let label = format!("{name}: {title}");
                    WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                if response.clicked() {
                    actions.push(HistoryAction::Label(row.number, truth));
                    ui.close();
                }
            }
        });
    });
}
