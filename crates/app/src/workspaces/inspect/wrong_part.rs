//! The page on which an operator says what a part really is: the enrolled parts as tiles that a gloved hand hits.

use std::{collections::BTreeSet, sync::Arc};

use egui::{
    Align, Button, CentralPanel, Frame, Layout, Margin, Rect, Response, RichText, Role, ScrollArea,
    Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, style::ScrollStyle, vec2,
};

use crate::{
    shared::{Thumbnails, paint_fitted},
    workspaces::inspect::state::InspectAction,
};
use inspection::library::{PartMeta, PartName, Truth};
use records::history::{HungId, StoredVerdict};
use shell::{
    action::Event,
    inspection::{inspected::Inspected, library_cache::LibraryView},
    session::Session,
};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    widgets::{fitted_middle, focus_ring, line_edit, title_rows, wrapped},
};

/// Width and height of a tile, logical pixels.
const TILE: [f32; 2] = [176.0, 188.0];
/// Height of its picture, logical pixels.
const PICTURE: f32 = 112.0;
/// Height of its title of one or two rows, logical pixels.
const TITLE: f32 = 42.0;
/// Height of the row above the tiles, logical pixels.
const HEAD: f32 = 52.0;
/// Number of the likeliest parts that come before the others: a row of tiles in the smallest window.
const NUM_LIKELIEST: usize = 5;
/// Number of parts above which they can be searched.
const MANY: usize = 12;

/// The page, about one part.
#[derive(Debug)]
pub struct WrongPartPage {
    /// The part.
    part: HungId,
    /// Its title, and when it was inspected.
    named: [String; 2],
    /// Name of the part that it was accepted as, if it was.
    accepted: Option<String>,
    /// Its true label so far.
    former: Option<Truth>,
    library: Arc<LibraryView>,
    /// The enrolled parts, in the order of the tiles.
    parts: Vec<PartName>,
    /// What is searched for.
    find: String,
}

impl WrongPartPage {
    /// Opens the page about a part of the latest frame; `None` if it has gone.
    pub(super) fn about(part: &HungId, session: &Session) -> Option<Self> {
        let mut latest = session.latest_parts().iter();
        let inspected = latest.find(|latest| latest.hung() == part)?;
        let summary = &inspected.entry.record.summary;
        let is_accepted = summary.verdict == StoredVerdict::Accepted;
        let title = inspected.part_title().filter(|_| is_accepted);
        let title = title.map_or_else(|| text!("inspect-not-recognised"), str::to_owned);
        let at = summary.at.to_zoned(jiff::tz::TimeZone::system());
        let mut labelled = session.shift.labelled.iter();
        let former = labelled.find(|(known, _)| known == part);
        Some(Self {
            part: part.clone(),
            named: [title, at.strftime("%H:%M").to_string()],
            accepted: summary.part.clone().filter(|_| is_accepted),
            former: former.map(|(_, label)| label.clone()),
            library: Arc::clone(&inspected.library),
            parts: in_order(inspected),
            find: String::new(),
        })
    }

    /// The library whose parts it shows.
    pub(super) fn library(&self) -> &Arc<LibraryView> {
        &self.library
    }

    /// What the operator says: the part really is this.
    pub(super) fn labelled(self, label: Truth) -> Event {
        Event::Labelled {
            part: self.part,
            label,
            former: self.former,
        }
    }

    /// Draws the page; returns its place.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        thumbnails: &Thumbnails,
        actions: &mut Vec<InspectAction>,
    ) -> Rect {
        let theme = Theme::of(ui);
        let room = ui.available_rect_before_wrap();
        let frame = Frame::new()
            .fill(theme.panel)
            .inner_margin(Margin::symmetric(24, 12));
        CentralPanel::default().frame(frame).show(ui, |ui| {
            self.head(ui, actions);
            let [part, time] = &self.named;
            let question = text!("operator-which-part", part = part, time = time);
            wrapped(ui, &question, &font::verdict(), theme.text);
            ui.add_space(space::SMALL);
            self.tiles(ui, thumbnails, actions);
        });
        room
    }

    fn head(&mut self, ui: &mut Ui, actions: &mut Vec<InspectAction>) {
        ui.horizontal(|ui| {
            let back = large_button(ui, &text!("operator-back"));
            if back.on_hover_text(text!("operator-back-says")).clicked() {
                actions.push(InspectAction::LeaveWrongPart);
            }
            if self.parts.len() > MANY {
                let label = text!("operator-find-part");
                let field = line_edit(&mut self.find, label.clone(), 220.0);
                ui.add(field)
                    .widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &label));
            }
            // A layout without a size would take all the height that is free.
            let size = vec2(ui.available_width(), HEAD);
            ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
                let none = large_button(ui, &text!("operator-none-of-these"));
                if none
                    .on_hover_text(text!("operator-none-of-these-says"))
                    .clicked()
                {
                    actions.push(InspectAction::ActualPart(Truth::NotEnrolled));
                }
            });
        });
    }

    fn tiles(&self, ui: &mut Ui, thumbnails: &Thumbnails, actions: &mut Vec<InspectAction>) {
        // The scroll bar is beside the tiles, not over them.
        ui.spacing_mut().scroll = ScrollStyle::solid();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(space::MEDIUM);
            let columns = (ui.available_width() + space::MEDIUM) / (TILE[0] + space::MEDIUM);
            let columns = columns.max(1.0) as usize;
            let wanted = self.find.trim().to_lowercase();
            let found = self.parts.iter().filter(|name| {
                let title = self.library.title_of(name.as_str()).to_lowercase();
                title.contains(&wanted) || name.as_str().contains(&wanted)
            });
            let found: Vec<&PartName> = found.collect();
            if found.is_empty() {
                ui.weak(text!("operator-no-such-part"));
            }
            for row in found.chunks(columns) {
                ui.horizontal(|ui| {
                    for name in row {
                        if self.tile(ui, name.as_str(), thumbnails).clicked() {
                            let label = Truth::Part(name.as_str().to_owned());
                            actions.push(InspectAction::ActualPart(label));
                        }
                    }
                });
            }
        });
    }

    fn tile(&self, ui: &mut Ui, name: &str, thumbnails: &Thumbnails) -> Response {
        let theme = Theme::of(ui);
        let (rect, response) = ui.allocate_exact_size(TILE.into(), Sense::click());
        let title = self.library.title_of(name);
        let is_accepted = self.accepted.as_deref() == Some(name);
        let is_former = self.former.as_ref().and_then(Truth::part) == Some(name);
        let note = match (is_accepted, is_former) {
            (_, true) => text!("operator-labelled-as-this"),
            (true, false) => text!("operator-recognised-as-this"),
            (false, false) => String::new(),
        };
        let is_marked = is_accepted || is_former;
        let painter = ui.painter_at(rect);
        let fill = if response.hovered() {
            theme.control_hovered
        } else {
            theme.control
        };
        let edge = if is_marked {
            Stroke::new(2.0, theme.accent)
        } else {
            Stroke::new(1.0, theme.edge)
        };
        painter.rect(rect, ROUNDING, fill, edge, StrokeKind::Inside);
        let inner = rect.shrink(space::SMALL);
        let picture = Rect::from_min_size(inner.min, vec2(inner.width(), PICTURE));
        let index = self.library.place_of(name);
        if let Some(texture) = index.and_then(|index| thumbnails.of_part(index)) {
            paint_fitted(&painter, texture, picture);
        }
        let fonts = [font::body_strong(), font::small()];
        let room = vec2(inner.width(), TITLE);
        let rows = title_rows(&painter, title, &fonts, theme.text, room);
        let top = picture.bottom() + space::SMALL;
        painter.galley(pos2(inner.left(), top), rows, theme.text);
        let small = font::small();
        let drawn = fitted_middle(&painter, &note, &small, inner.width());
        let drawn = painter.layout_no_wrap(drawn, small, theme.weak_text);
        let at = pos2(inner.left(), inner.bottom() - drawn.size().y);
        painter.galley(at, drawn, theme.weak_text);
        focus_ring(ui, rect, &response);
        response.widget_info(|| {
            let label = text!("shell-actual-part", part = title);
            let mut info = WidgetInfo::selected(Role::Button, true, is_marked, label);
            info.current_text_value = (!note.is_empty()).then(|| note.clone());
            info
        });
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        response
    }
}

/// The enrolled parts: the likeliest of the frame first, then by title.
fn in_order(inspected: &Inspected) -> Vec<PartName> {
    let library = &inspected.library;
    let examined = inspected.inspection.ranking.entries.iter();
    let examined = examined.filter(|entry| entry.is_examined);
    let likeliest = examined.filter_map(|entry| {
        let reference = library.parts.get(entry.reference)?;
        Some(reference.part_name())
    });
    let mut others: Vec<&PartName> = library.parts.iter().map(PartMeta::part_name).collect();
    others.sort_by_cached_key(|name| library.title_of(name.as_str()).to_lowercase());
    // A part may have several references.
    let mut seen = BTreeSet::new();
    let mut all: Vec<PartName> = Vec::new();
    for name in likeliest.take(NUM_LIKELIEST).chain(others) {
        if seen.insert(name) {
            all.push(name.clone());
        }
    }
    all
}

fn large_button(ui: &mut Ui, text: &str) -> Response {
    let button = Button::new(RichText::new(text).font(font::verdict()));
    let response = ui.add(button.min_size(vec2(120.0, HEAD)));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, text));
    response
}

#[cfg(test)]
mod tests {
    use egui::{Pos2, RawInput, Shape};

    use super::*;
    use shell::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::Shown,
        workspace::TestShell,
    };
    use ui::theme::ThemeChoice;

    /// The page about a part that was inspected with a library of this many parts.
    fn page(num: usize) -> WrongPartPage {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        let known = Arc::clone(&inspected.library);
        let parts = known.parts.iter().cycle().take(num).enumerate();
        let parts = parts.map(|(index, part)| PartMeta {
            name: PartName::new(&format!("part-{index:02}")).expect("a name"),
            title: format!("Part {index:02}"),
            part: None,
            ..part.clone()
        });
        inspected.library = Arc::new(LibraryView {
            parts: parts.collect(),
            ..LibraryView::default()
        });
        let part = inspected.hung().clone();
        let mut shell = TestShell::default();
        shell.session.shown = Some(Shown::new(1, Arc::new(inspected)));
        WrongPartPage::about(&part, &shell.session).expect("it is shown")
    }

    fn texts(page: &mut WrongPartPage) -> Vec<String> {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1024.0, 600.0))),
            ..RawInput::default()
        };
        let output = ctx.run_ui(input, |ui| {
            page.ui(ui, &Thumbnails::default(), &mut Vec::new());
        });
        let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        });
        let texts = texts.collect();
        output.drop_without_applying_deltas();
        texts
    }

    #[test]
    fn only_many_parts_are_searched_and_the_others_are_left_out() {
        let has = |texts: &[String], text: &str| texts.iter().any(|drawn| drawn == text);
        assert!(!has(&texts(&mut page(MANY)), "Find a part"));
        let mut many = page(MANY + 1);
        let drawn = texts(&mut many);
        assert!(
            has(&drawn, "Find a part") && has(&drawn, "Part 00"),
            "{drawn:?}"
        );
        many.find = " part 07".into();
        let drawn = texts(&mut many);
        assert!(
            has(&drawn, "Part 07") && !has(&drawn, "Part 00"),
            "{drawn:?}"
        );
        many.find = "door".into();
        assert!(has(&texts(&mut many), "No part has this name"));
    }
}
