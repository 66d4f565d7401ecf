//! Shows what should hang there, and lets the user choose it.

use std::iter;

use egui::{
    Align, Button, CollapsingHeader, Layout, PopupCloseBehavior, RichText, ScrollArea, Ui, Vec2,
    WidgetInfo,
    containers::menu::{MenuButton, MenuConfig},
};

use super::{entry::LABEL_WIDTH_PX, orders::ExpectAction};
use crate::{
    action::{Action, DialogRequest},
    inspection::source::file_name,
    session::{Session, UserRole},
};
use inspection::{library::PartName, pipeline::ExpectedPart};
use stages::{rack::Place, segment::MAX_PARTS};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::{fitted_middle, show_scroll_bar, wrapped},
};

/// Width of the menu, logical pixels.
const MENU_WIDTH_PX: f32 = 300.0;
/// Part of the window's height that the menu leaves free, logical pixels.
const MARGIN: f32 = 260.0;

/// Draws what is expected of the next part, as a menu, and below it why that is not known.
pub fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let expected = session.expected();
    let (title, says) = match &expected {
        Ok(expected) if expected.is_empty() => (text!("expect-anything"), text!("expect-says")),
        Ok(expected) => {
            let titles = session.titles_of(expected.parts());
            (titles.clone(), titles)
        }
        Err(_) => (text!("expect-not-known"), text!("expect-says")),
    };
    let num = expected
        .as_ref()
        .map_or(0, |expected| expected.parts().len());
    let name = text!("expect-title");
    ui.horizontal(|ui| {
        ui.set_min_height(space::TARGET);
        let from = ui.cursor().left();
        ui.label(RichText::new(&name).weak());
        ui.add_space((from + LABEL_WIDTH_PX - ui.cursor().left()).max(0.0));
        let room = ui.available_width() - 2.0 * ui.spacing().button_padding.x - 24.0;
        let shown = match num {
            0 | 1 => fitted_middle(ui.painter(), &title, &font::body(), room),
            num => text!("shell-num-parts", num = num),
        };
        let button = Button::new(format!("{shown} ▼")).min_size(Vec2::splat(space::TARGET));
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let (button, _) = MenuButton::from_button(button)
            .config(config)
            .ui(ui, |ui| menu(ui, session, actions));
        button.widget_info(|| {
            WidgetInfo::labeled(egui::Role::Button, true, format!("{name}: {title}"))
        });
        button.on_hover_text(says);
    });
    // The engineer's card has no room for it.
    if num > 1 && session.is_operator_view() {
        wrapped(ui, &title, &font::small(), theme.weak_text);
    }
    if let Err(error) = expected {
        let error = error.in_words();
        wrapped(ui, &error.what, &font::body_strong(), theme.warning);
        wrapped(ui, &error.advice, &font::body(), theme.text);
    }
}

fn menu(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ui.set_width(MENU_WIDTH_PX);
    let is_engineer = session.role == UserRole::Engineer;
    if let Some(path) = session.expecting.orders() {
        ui.label(RichText::new(text!("expect-by-orders")).font(font::heading()));
        ui.label(file_name(path))
            .on_hover_text(path.display().to_string());
        if is_engineer && button(ui, text!("expect-close-orders")).clicked() {
            actions.push(Action::Expect(ExpectAction::CloseOrders));
            ui.close();
        }
    } else {
        let chosen = &session.expecting.chosen;
        show_scroll_bar(ui);
        let height = (ui.ctx().content_rect().height() - MARGIN).max(4.0 * space::TARGET);
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            let places = &session.rack.in_camera().places;
            for place in places {
                place_ui(ui, session, place, chosen, actions);
            }
            if !places.is_empty() {
                ui.separator();
                ui.weak(text!("expect-elsewhere-heading"));
            }
            for name in session.part_names() {
                part(ui, session, name.as_str(), chosen, actions);
            }
        });
        ui.separator();
        let clear = if session.recipe.expect.is_empty() {
            text!("expect-anything")
        } else {
            text!("expect-as-recipe", recipe = &session.recipe.label.name)
        };
        let clear = ui.add_enabled_ui(!chosen.is_empty(), |ui| button(ui, clear));
        if clear.inner.clicked() {
            actions.push(Action::Expect(ExpectAction::Parts(Vec::new())));
            ui.close();
        }
    }
    if is_engineer {
        let orders = button(ui, text!("expect-orders"));
        if orders.on_hover_text(text!("expect-orders-says")).clicked() {
            actions.push(Action::Ask(DialogRequest::Orders));
            ui.close();
        }
    }
}

fn button(ui: &mut Ui, text: String) -> egui::Response {
    let size = Vec2::new(ui.available_width(), space::TARGET);
    ui.add_sized(size, Button::new(text))
}

/// Draws a place of the rack with the part that is expected there and, unfolded, the parts that may hang there.
fn place_ui(
    ui: &mut Ui,
    session: &Session,
    place: &Place,
    chosen: &[ExpectedPart],
    actions: &mut Vec<Action>,
) {
    let is_here = |part: &&ExpectedPart| part.place.as_ref() == Some(&place.name);
    let here = chosen.iter().find(is_here).map(|part| &*part.name);
    let title = match here {
        Some(name) => session.title_of(name),
        None => text!("expect-anything"),
    };
    let names = session.part_names().into_iter();
    let names = names.map(PartName::as_str);
    let names = names.filter(|name| session.may_hang_at(place, name));
    let title = format!("{}: {title}", place.name);
    let header = CollapsingHeader::new(title).id_salt(("place", &place.name));
    header.show(ui, |ui| {
        for name in iter::once(None).chain(names.map(Some)) {
            let title = match name {
                Some(name) => session.title_of(name),
                None => text!("expect-anything"),
            };
            let size = Vec2::new(ui.available_width(), space::TARGET);
            let shown = fitted_middle(ui.painter(), &title, &font::body(), size.x);
            let entry = ui.add_sized(size, Button::selectable(here == name, shown));
            let label = text!("expect-at-place", part = &title, place = &place.name);
            entry.widget_info(|| {
                WidgetInfo::selected(egui::Role::Button, true, here == name, &label)
            });
            let others = chosen.iter().filter(|part| !is_here(part)).cloned();
            let new = name.map(|name| ExpectedPart {
                name: name.to_owned(),
                place: Some(place.name.clone()),
            });
            let parts: Vec<ExpectedPart> = others.chain(new).collect();
            if entry.clicked() && parts.len() <= MAX_PARTS {
                actions.push(Action::Expect(ExpectAction::Parts(parts)));
            }
        }
    });
}

/// Draws a part with the number of it that is expected at no place of its own, and buttons that change the number.
fn part(
    ui: &mut Ui,
    session: &Session,
    name: &str,
    chosen: &[ExpectedPart],
    actions: &mut Vec<Action>,
) {
    let title = &session.title_of(name);
    let is_it = |part: &ExpectedPart| part.name == name && part.place.is_none();
    let num = chosen.iter().filter(|part| is_it(part)).count();
    ui.horizontal(|ui| {
        ui.set_min_height(space::TARGET);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let change = |ui: &mut Ui, sign: &str, is_possible: bool, says: String| {
                let button = Button::new(sign).min_size(Vec2::splat(space::TARGET));
                let button = ui.add_enabled(is_possible, button);
                button.widget_info(|| {
                    WidgetInfo::labeled(egui::Role::Button, is_possible, format!("{says}: {title}"))
                });
                button.on_hover_text(says).clicked()
            };
            let is_more = change(ui, "+", chosen.len() < MAX_PARTS, text!("expect-one-more"));
            ui.add_sized(
                Vec2::new(24.0, space::TARGET),
                egui::Label::new(num.to_string()),
            );
            let is_less = change(ui, "−", num > 0, text!("expect-one-less"));
            let mut parts = chosen.to_vec();
            if is_more {
                parts.push(name.into());
            } else if is_less {
                let last = parts.iter().rposition(is_it);
                last.map(|last| parts.remove(last));
            }
            if is_more || is_less {
                actions.push(Action::Expect(ExpectAction::Parts(parts)));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let shown = fitted_middle(ui.painter(), title, &font::body(), ui.available_width());
                ui.label(shown);
            });
        });
    });
}
