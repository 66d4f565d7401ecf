//! The card of an enrolled part: its name, its origin, and what can be done with it.

use egui::{Button, RichText, ScrollArea, Ui, vec2};

use super::{
    EnrolAction, EnrolFile, EnrolState,
    draft::OpenedPart,
    fields::{self, complaint},
    thumbnails::Thumbnails,
};
use crate::shared::paint_fitted;
use inspection::library::PartMeta;
use shell::session::Session;
use ui::{
    language::{described, text},
    theme::{ROUNDING, Theme, space},
    widgets::grouped,
};

/// Draws the card.
pub(super) fn ui(
    ui: &mut Ui,
    open: &OpenedPart,
    enrol: &EnrolState,
    session: &Session,
    thumbnails: &Thumbnails,
    actions: &mut Vec<EnrolAction>,
) {
    let theme = Theme::of(ui);
    let library = session.library.as_deref();
    let index = library.and_then(|library| library.index_of(open.name.as_str()));
    let part = library
        .zip(index)
        .and_then(|(library, index)| library.parts.get(index));
    let can_change = library.is_some_and(|library| library.is_fixed.is_none());
    let can_change = can_change && !enrol.is_changing_library();
    // The scroll bar is beside the fields, not over them.
    ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let title = part.map_or(open.name.as_str(), PartMeta::shown_title);
        ui.heading(title);
        let button = |ui: &mut Ui, text: String| {
            let button = Button::new(text).min_size(vec2(ui.available_width(), space::TARGET));
            ui.add(button).clicked()
        };
        if let Some(part) = part {
            let size = vec2(ui.available_width(), 120.0);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            ui.painter().rect_filled(rect, ROUNDING, theme.canvas);
            if let Some(texture) = index.and_then(|index| thumbnails.of_part(index)) {
                paint_fitted(ui.painter(), texture, rect.shrink(2.0));
            }
            let number = library.and_then(|library| library.numbers.number_of(&part.name));
            origin(ui, part, number);
            ui.add_space(space::SMALL);
            ui.add_enabled_ui(can_change, |ui| {
                if let Some(field) = fields::ui(ui, &open.form) {
                    actions.push(EnrolAction::WriteOpen(field));
                }
                super::form::shared_title(ui, &open.form, open.name.as_str(), session);
                let words = open.form.words();
                let has_changed = words.is_ok_and(|words| words != part.words());
                ui.add_enabled_ui(has_changed, |ui| {
                    if button(ui, text!("enrol-rename")) {
                        actions.push(EnrolAction::Rename);
                    }
                });
                ui.add_space(space::SMALL);
                if button(ui, text!("enrol-spray-path")) {
                    actions.push(EnrolAction::Ask(EnrolFile::SprayPath));
                }
                if part.spray.is_some() && button(ui, text!("enrol-remove-path")) {
                    actions.push(EnrolAction::RemovePath(open.name.clone()));
                }
                if button(ui, text!("enrol-anew")) {
                    actions.push(EnrolAction::Replace(open.name.clone()));
                }
            });
        } else {
            let mut damaged = library.iter().flat_map(|library| &library.damaged);
            if let Some(damaged) = damaged.find(|d| d.entry == open.name.as_str()) {
                complaint(ui, &damaged.problem.what, &damaged.problem.advice);
            }
        }
        ui.add_enabled_ui(can_change, |ui| {
            if button(ui, text!("shell-remove")) {
                actions.push(EnrolAction::Remove(open.name.clone()));
            }
        });
        if button(ui, text!("shell-close")) {
            actions.push(EnrolAction::Close);
        }
        super::form::fixed(ui, session);
    });
}

/// Draws where the part came from, and the number by which robots know it.
fn origin(ui: &mut Ui, part: &PartMeta, number: Option<u32>) {
    let at = part.enrolled.at.to_zoned(jiff::tz::TimeZone::system());
    let seen = if part.simulated {
        text!("enrol-origin-simulated")
    } else {
        text!("enrol-origin-seen")
    };
    let enrolled = text!(
        "enrol-origin",
        time = at.strftime("%Y-%m-%d %H:%M").to_string(),
        source = &part.enrolled.from,
        method = described(&part.enrolled.how),
    );
    let points = text!(
        "enrol-origin-points",
        points = grouped(part.cloud.num_points)
    );
    let mut facts = vec![enrolled, points, seen];
    if let Some(spray) = &part.spray {
        facts.push(text!("enrol-origin-path", count = spray.num_points));
    }
    if let Some(number) = number {
        facts.push(text!("enrol-origin-number", number = number));
    }
    ui.label(RichText::new(facts.join(" · ")).small().weak());
}
