//! What should hang before the camera: parts that the user chose, those of an order, or those that the recipe expects.
//!
//! With a table of orders, the order and the serial number that are entered say what to expect of the next part. While that is
//! not known, or a table that was chosen is not read yet, nothing is captured. A part keeps what
//! was expected of it; if its order or serial number turns out to be another one, no robot may act on it. The table is read again
//! once it changes.

use std::{iter, path::PathBuf, ptr, sync::Arc};

use egui::{
    Align, Button, CollapsingHeader, Layout, PopupCloseBehavior, RichText, ScrollArea, Ui, Vec2,
    WidgetInfo,
    containers::menu::{MenuButton, MenuConfig},
};

use crate::{
    action::{Action, DialogRequest},
    inspection::{inspected::Inspected, source::file_name},
    notice::{Notice, NoticeTopic},
    session::{Session, UserRole},
    source::live,
    state::{State, notify, remove_notices},
    trace::{
        entry::LABEL_WIDTH_PX,
        orders::{ExpectAction, NotKnown, OrderTable},
    },
};
use inspection::{
    library::{PartMeta, PartName},
    pipeline::{Expected, ExpectedPart},
};
use records::{history::Traceability, orders::Orders};
use stages::{rack::Place, segment::MAX_PARTS};
use station::Doubt;
use ui::{
    language::text,
    theme::{Theme, font, space},
    user_error::UserError,
    widgets::{fitted_middle, pad_entries, show_scroll_bar, wrapped},
};

impl Session {
    /// The table of orders in use, if there is one.
    pub(crate) fn orders(&self) -> Result<Option<Arc<Orders>>, NotKnown> {
        let Some(table) = &self.expecting.orders else {
            return Ok(None);
        };
        let unread = || NotKnown::Unread {
            file: file_name(&table.path),
        };
        let content = table.content.as_ref().ok_or_else(unread)?;
        let orders = content
            .as_ref()
            .map_err(|e| NotKnown::Table(Arc::clone(e)))?;
        Ok(Some(Arc::clone(orders)))
    }

    /// What should hang there for an order and a serial number.
    fn expected_of(&self, trace: &Traceability) -> Result<Expected, NotKnown> {
        // A library that is not loaded yet is not known to lack a part.
        let library = self.library.as_ref();
        let is_enrolled = |name: &str| {
            library.is_none_or(|library| {
                let mut parts = library.parts.iter();
                parts.any(|part| part.part_name().as_str() == name)
            })
        };
        let Some(orders) = self.orders()? else {
            let parts = self.expecting.chosen.iter();
            let chosen = parts.filter(|part| is_enrolled(&part.name)).cloned();
            let rack = Some(self.rack.in_camera());
            let chosen = Expected::new(chosen.collect(), rack, is_enrolled);
            let chosen = chosen.map_err(NotKnown::Chosen)?;
            let expected = self.recipe.expected_or_own(chosen, rack, is_enrolled);
            return expected.map_err(|error| NotKnown::Recipe {
                name: self.recipe.label.name.clone(),
                error,
            });
        };
        let expected = orders.expected(trace, Some(self.rack.in_camera()), is_enrolled);
        expected.map_err(NotKnown::Order)
    }

    /// What should hang there at the next capture.
    pub fn expected(&self) -> Result<Expected, NotKnown> {
        self.expected_of(&self.trace.of_next())
    }

    /// What should hang there now: with the serial number of the frame whose verdicts count, unless another one was entered.
    pub(crate) fn expected_now(&self) -> Result<Expected, NotKnown> {
        let parts = self.latest_parts().iter();
        self.expected_with(parts.filter(|part| {
            let currency = self.currency(part);
            !part.is_open()
                && !matches!(
                    currency,
                    Some(Doubt::Moving | Doubt::SourceLost | Doubt::Superseded)
                )
        }))
    }

    /// What Live should expect: the frame keeps the serial number that one of its parts has taken.
    fn expected_by_live(&self) -> Result<Expected, NotKnown> {
        let is_past = self.latest(|shown| !shown.is_past).is_none();
        let parts = self.latest_parts().iter();
        self.expected_with(parts.filter(|_| !is_past && !self.is_watching()))
    }

    fn expected_with<'a>(
        &self,
        parts: impl Iterator<Item = &'a Arc<Inspected>>,
    ) -> Result<Expected, NotKnown> {
        let trace = self.trace.of_next();
        self.expected_of(&self.with_serial_of(parts, trace))
    }

    /// With the serial number that one of these parts of the same order has taken, unless there is one already. Only one part of
    /// a frame takes the number, but its row in the table is for all of them.
    fn with_serial_of<'a>(
        &self,
        parts: impl Iterator<Item = &'a Arc<Inspected>>,
        mut trace: Traceability,
    ) -> Traceability {
        if trace.serial.is_empty() {
            let mut of_parts = parts.map(|part| self.trace.of_part(part));
            let of_same =
                of_parts.find(|of_part| of_part.order == trace.order && !of_part.serial.is_empty());
            trace.serial = of_same.unwrap_or_default().serial;
        }
        trace
    }

    /// True if the part has another order or serial number by now, and other parts are expected for that than when it was
    /// inspected.
    pub(crate) fn is_of_other_order(&self, part: &Inspected) -> bool {
        let is_past = self.shown.as_ref().is_some_and(|shown| shown.is_past);
        if self.expecting.orders.is_none() || is_past {
            return false;
        }
        let frame = self.latest_parts();
        let is_latest = frame.iter().any(|one| ptr::eq(Arc::as_ptr(one), part));
        let beside = frame.iter().filter(|_| is_latest);
        let trace = self.with_serial_of(beside, self.trace.of_part(part));
        let expected = self.expected_of(&trace).map(|expected| match part.scan {
            Some(_) => expected.anywhere(),
            None => expected,
        });
        !expected.is_ok_and(|expected| expected == part.recipe.expected)
    }

    /// Titles of these parts, each once, with their places or their numbers.
    pub fn titles_of(&self, parts: &[ExpectedPart]) -> String {
        let mut counts: Vec<(&ExpectedPart, usize)> = Vec::new();
        for part in parts {
            match counts.iter_mut().find(|(known, _)| *known == part) {
                Some((_, num)) => *num += 1,
                None => counts.push((part, 1)),
            }
        }
        let titles = counts.into_iter().map(|(part, num)| {
            let title = title_of(part, |name| self.title_of(name));
            match num {
                1 => title,
                num => format!("{num} × {title}"),
            }
        });
        titles.collect::<Vec<_>>().join(" · ")
    }

    /// The title of a part.
    pub(super) fn title_of(&self, name: &str) -> String {
        match &self.library {
            Some(library) => library.title_of(name).to_owned(),
            None => name.to_owned(),
        }
    }

    /// True if a place of the rack is for this part, too.
    fn may_hang_at(&self, place: &Place, name: &str) -> bool {
        let parts = self.library.iter().flat_map(|library| &library.parts);
        let mut references = parts.filter(|part| part.part_name().as_str() == name);
        let is_for = |reference: &str| place.parts.iter().any(|part| part.name == reference);
        place.parts.is_empty() || is_for(name) || references.any(|part| is_for(part.name.as_str()))
    }

    /// Names of the enrolled parts, each once.
    fn part_names(&self) -> Vec<&PartName> {
        let parts = self.library.iter().flat_map(|library| &library.parts);
        let mut names: Vec<&PartName> = parts.map(PartMeta::part_name).collect();
        names.sort();
        names.dedup();
        names
    }
}

/// The title of a part, with its place.
pub fn title_of(part: &ExpectedPart, title_of: impl Fn(&str) -> String) -> String {
    let title = title_of(&part.name);
    match &part.place {
        Some(place) => text!("expect-at-place", part = title, place = place),
        None => title,
    }
}

/// Carries out an action.
pub(crate) fn apply(state: &mut State, action: ExpectAction) {
    let expecting = &mut state.session.expecting;
    match action {
        ExpectAction::Parts(mut parts) => {
            if expecting.orders.is_none() {
                parts.truncate(MAX_PARTS);
                expecting.chosen = parts;
            }
        }
        ExpectAction::CloseOrders => {
            expecting.orders = None;
            remove_notices(state, NoticeTopic::Orders);
        }
    }
}

/// Uses the table of orders in this file from now on; nothing is inspected until it is read.
pub(crate) fn use_orders(state: &mut State, path: PathBuf) {
    remove_notices(state, NoticeTopic::Orders);
    state.session.expecting.chosen.clear();
    state.session.expecting.orders = Some(OrderTable::unread(path));
    state.orders_watch.stop();
}

fn tell(state: &mut State, error: UserError) {
    notify(state, Notice::from(error).about(NoticeTopic::Orders));
}

/// True if it is known what should hang there; otherwise says why nothing is inspected.
pub(crate) fn may_inspect(state: &mut State) -> bool {
    match state.session.expected() {
        Ok(_) => true,
        Err(error) => {
            tell(state, error.in_words());
            false
        }
    }
}

/// What Live is to expect from now on: what it expected before if that is not known.
pub(crate) fn follow_expected(session: &mut Session) -> Expected {
    if let Ok(expected) = session.expected_by_live() {
        session.expecting.followed = expected;
    }
    session.expecting.followed.clone()
}

/// Takes over the table once it has changed. Live starts over once something else is expected.
pub fn update(state: &mut State) {
    let expecting = &mut state.session.expecting;
    if let Some(content) = state.orders_watch.poll(expecting.orders.as_ref())
        && let Some(table) = &mut expecting.orders
    {
        let used = text!("expect-table-used", file = file_name(&table.path));
        let notice = match &content {
            Ok(_) if table.content.is_none() => Some(Notice::done(used)),
            Ok(_) => None,
            Err(error) => {
                let error = NotKnown::Table(Arc::clone(error)).in_words();
                Some(Notice::from(error).about(NoticeTopic::Orders))
            }
        };
        table.content = Some(content);
        if let Some(notice) = notice {
            notify(state, notice);
        }
    }
    let mut notices = state.notices.iter();
    let is_notified = notices.any(|notice| notice.topic == NoticeTopic::Orders);
    if is_notified && state.session.expected().is_ok() {
        remove_notices(state, NoticeTopic::Orders);
    }
    if state.session.is_live() {
        let expected = state.session.expected_by_live();
        if expected.is_ok_and(|expected| expected != state.session.expecting.followed) {
            live::expect_anew(state);
        }
    }
}

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
        let (button, _) = MenuButton::from_button(button).config(config).ui(ui, |ui| {
            pad_entries(ui);
            menu(ui, session, actions);
        });
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::Shown,
        trace::orders::Expecting,
    };
    use records::history::HungId;

    #[test]
    fn the_program_starts_with_the_table_of_last_time() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("orders.csv");
        std::fs::write(&path, "order;parts\n4711;fender\n").expect("written");
        let mut session = State::default().session;
        for (path, is_read) in [(path.clone(), true), (path.with_extension("txt"), false)] {
            session.expecting = Expecting::starting(Some(path));
            let known = session.expected_of(&Traceability {
                order: "4711".into(),
                ..Traceability::default()
            });
            assert_eq!(known.is_ok(), is_read, "{known:?}");
            assert!(!matches!(known, Err(NotKnown::Unread { .. })));
        }
    }

    #[test]
    fn the_serial_number_that_a_part_took_counts_for_its_whole_frame() {
        let path = Path::new("orders.csv");
        let rows = "order;serial;parts\n4711;;fender|fender\n4711;S-1;fender|grille\n";
        let mut session = State::default().session;
        session.expecting.orders = Some(OrderTable {
            path: path.into(),
            content: Some(Ok(Arc::new(Orders::parse(path, rows).expect("a table")))),
        });
        let trace = |serial: &str| Traceability {
            order: "4711".into(),
            serial: serial.into(),
            ..Traceability::default()
        };
        session.trace = crate::trace::current_trace::CurrentTrace::starting(trace(""));
        let of_number = session.expected_of(&trace("S-1")).expect("in the table");
        assert_ne!(session.expected().ok().as_ref(), Some(&of_number));
        let part = |number, serial| {
            let mut part = inspected_cell(CellChoice::InTurn, number);
            part.recipe = Arc::new(part.recipe.expecting(of_number.clone()));
            part.set_part(HungId::new(), trace(serial));
            Arc::new(part)
        };
        let parts = vec![part(1, ""), part(2, "S-1")];
        for selected in [0, 1] {
            session.shown = Some(Shown::of_parts(1, parts.clone(), selected));
            assert_eq!(session.expected_now().ok().as_ref(), Some(&of_number));
            assert_eq!(session.expected_by_live().ok().as_ref(), Some(&of_number));
            for part in &parts {
                assert!(!session.is_of_other_order(part));
            }
        }
        // By itself it has no number.
        session.shown = Some(Shown::new(2, Arc::clone(&parts[0])));
        assert!(session.is_of_other_order(&parts[0]));
        assert_eq!(session.expected_now().ok(), session.expected().ok());
    }
}
