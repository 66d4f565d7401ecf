//! The card of an enrolled part: what it is called, where it came from, and what can be done with it.

use egui::{Button, Rect, RichText, ScrollArea, Ui, pos2, vec2};

use super::{
    EnrolAction, EnrolFile, EnrolState,
    draft::OpenedPart,
    fields::{self, complaint},
    thumbnails::Thumbnails,
};
use crate::{
    app::{
        shell::session::Session,
        ui::{
            theme::{ROUNDING, Theme, font, space},
            widgets::{fitted, grouped},
        },
    },
    library::PartMeta,
};

/// Draws the card.
pub(super) fn ui(
    ui: &mut Ui,
    open: &OpenedPart,
    enrol: &EnrolState,
    session: &Session,
    thumbnails: &Thumbnails,
    theme: &Theme,
    actions: &mut Vec<EnrolAction>,
) {
    let library = session.library.as_deref();
    let place = library.and_then(|library| library.place_of(open.name.as_str()));
    let part = library
        .zip(place)
        .and_then(|(library, place)| library.parts.get(place));
    let can_change = library.is_some_and(|library| library.is_fixed.is_none());
    let can_change = can_change && !enrol.is_changing_library();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let title = part.map_or(open.name.as_str(), PartMeta::shown_title);
        ui.label(RichText::new(title).font(font::verdict()).color(theme.text));
        let button = |ui: &mut Ui, text: &str| {
            let button = Button::new(text).min_size(vec2(ui.available_width(), space::TARGET));
            ui.add(button).clicked()
        };
        if let Some(part) = part {
            let size = vec2(ui.available_width(), 120.0);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            ui.painter().rect_filled(rect, ROUNDING, theme.canvas);
            if let Some(texture) = place.and_then(|place| thumbnails.of_part(place)) {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                let at = fitted(rect.shrink(2.0), texture.aspect_ratio());
                let painter = ui.painter();
                painter.image(texture.id(), at, whole, egui::Color32::WHITE);
            }
            origin(ui, part, theme);
            ui.add_space(space::SMALL);
            ui.add_enabled_ui(can_change, |ui| {
                if let Some(field) = fields::ui(ui, &open.form, theme) {
                    actions.push(EnrolAction::WriteOpen(field));
                }
                super::form::shared_title(ui, &open.form, session, theme);
                let words = open.form.words();
                let has_changed = words.is_ok_and(|words| words != part.words());
                ui.add_enabled_ui(has_changed, |ui| {
                    if button(ui, "Rename") {
                        actions.push(EnrolAction::Rename);
                    }
                });
                ui.add_space(space::SMALL);
                if button(ui, "Spray path…") {
                    actions.push(EnrolAction::Ask(EnrolFile::SprayPath));
                }
                if part.spray.is_some() && button(ui, "Remove the spray path") {
                    let name = open.name.clone();
                    actions.push(EnrolAction::RemovePath(name));
                }
                if button(ui, "Enrol anew") {
                    let name = open.name.clone();
                    actions.push(EnrolAction::Replace(name));
                }
            });
        } else {
            let mut damaged = library.iter().flat_map(|library| &library.damaged);
            if let Some(damaged) = damaged.find(|d| d.entry == open.name.as_str()) {
                complaint(ui, &damaged.trouble.what, &damaged.trouble.advice, theme);
            }
        }
        ui.add_enabled_ui(can_change, |ui| {
            if button(ui, "Remove") {
                let name = open.name.clone();
                actions.push(EnrolAction::Remove(name));
            }
        });
        if button(ui, "Close") {
            actions.push(EnrolAction::Close);
        }
        super::form::fixed(ui, session, theme);
    });
}

/// Where it came from.
fn origin(ui: &mut Ui, part: &PartMeta, theme: &Theme) {
    let at = part.enrolled.at.to_zoned(jiff::tz::TimeZone::system());
    let seen = if part.simulated {
        "simulated, not from a camera"
    } else {
        "seen by a camera"
    };
    let path = part.spray.as_ref().map_or_else(String::new, |spray| {
        format!(" · spray path of {} points", spray.num_points)
    });
    let text = format!(
        "Enrolled {} from {}, {} · {} points · {seen}{path}",
        at.strftime("%Y-%m-%d %H:%M"),
        part.enrolled.from,
        part.enrolled.how.describe(),
        grouped(part.cloud.num_points),
    );
    ui.label(
        RichText::new(text)
            .font(font::small())
            .color(theme.weak_text),
    );
}
