//! The page on which an operator says what a part really is: the enrolled parts as tiles that a gloved hand hits.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

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
    /// The enrolled parts, in the order of the tiles: an index of each in the library.
    parts: Vec<usize>,
    /// What is searched for.
    find: String,
    /// Those of `parts` that have it in title or name.
    found: Vec<usize>,
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
        let parts = in_order(inspected);
        Some(Self {
            part: part.clone(),
            named: [title, at.strftime("%H:%M").to_string()],
            accepted: summary.part.clone().filter(|_| is_accepted),
            former: former.map(|(_, label)| label.clone()),
            library: Arc::clone(&inspected.library),
            found: parts.clone(),
            parts,
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
                let field = ui.add(line_edit(&mut self.find, label.clone(), 220.0));
                field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &label));
                if field.changed() {
                    self.search();
                }
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

    /// Finds the parts that have what is searched for in title or name.
    fn search(&mut self) {
        let wanted = self.find.trim().to_lowercase();
        let has_it = |index: &usize| {
            let part = self.library.parts.get(*index);
            part.is_some_and(|part| {
                part.shown_title().to_lowercase().contains(&wanted)
                    || part.part_name().as_str().contains(&wanted)
            })
        };
        self.found = self.parts.iter().copied().filter(has_it).collect();
    }

    fn tiles(&self, ui: &mut Ui, thumbnails: &Thumbnails, actions: &mut Vec<InspectAction>) {
        if self.found.is_empty() {
            ui.weak(text!("operator-no-such-part"));
            return;
        }
        // The scroll bar is beside the tiles, not over them.
        ui.spacing_mut().scroll = ScrollStyle::solid();
        ui.spacing_mut().item_spacing = Vec2::splat(space::MEDIUM);
        let width = ui.available_width() - ui.spacing().scroll.allocated_width();
        let columns = (width + space::MEDIUM) / (TILE[0] + space::MEDIUM);
        let columns = columns.max(1.0) as usize;
        let rows: Vec<&[usize]> = self.found.chunks(columns).collect();
        let area = ScrollArea::vertical().auto_shrink(false);
        area.show_rows(ui, TILE[1], rows.len(), |ui, visible| {
            for row in rows.get(visible).unwrap_or_default() {
                ui.horizontal(|ui| {
                    for index in *row {
                        let Some(part) = self.library.parts.get(*index) else {
                            continue;
                        };
                        if self.tile(ui, *index, part, thumbnails).clicked() {
                            let name = part.part_name().as_str().to_owned();
                            actions.push(InspectAction::ActualPart(Truth::Part(name)));
                        }
                    }
                });
            }
        });
    }

    fn tile(
        &self,
        ui: &mut Ui,
        index: usize,
        part: &PartMeta,
        thumbnails: &Thumbnails,
    ) -> Response {
        let theme = Theme::of(ui);
        let (rect, _) = ui.allocate_exact_size(TILE.into(), Sense::hover());
        // The focus stays with the part when other rows become visible.
        let id = ui.scope_id().with(("part", index));
        let response = ui.interact(rect, id, Sense::click());
        let (name, title) = (part.part_name().as_str(), part.shown_title());
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
        if let Some(texture) = thumbnails.of_part(index) {
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

/// An index of each enrolled part: the likeliest of the frame first, then by title.
fn in_order(inspected: &Inspected) -> Vec<usize> {
    let library = &inspected.library;
    // A part may have several references, of which its own has its title.
    let mut index_of: BTreeMap<&PartName, usize> = BTreeMap::new();
    for (index, reference) in library.parts.iter().enumerate() {
        let known = index_of.entry(reference.part_name()).or_insert(index);
        if reference.reference_of().is_none() {
            *known = index;
        }
    }
    let examined = inspected.inspection.ranking.entries.iter();
    let examined = examined.filter(|entry| entry.is_examined);
    let likeliest = examined.filter_map(|entry| {
        let reference = library.parts.get(entry.reference)?;
        index_of.get(reference.part_name()).copied()
    });
    let mut seen = BTreeSet::new();
    let likeliest = likeliest.filter(|index| seen.insert(*index));
    let mut all: Vec<usize> = likeliest.take(NUM_LIKELIEST).collect();
    let mut others: Vec<usize> = index_of.into_values().collect();
    others.retain(|index| !all.contains(index));
    others.sort_by_cached_key(|index| library.title(*index).to_lowercase());
    all.extend(others);
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
    use egui::{FullOutput, Pos2, RawInput, Shape};

    use super::*;
    use shell::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::Shown,
        workspace::TestShell,
    };
    use stages::confirm::ConfirmedMatch;
    use ui::theme::ThemeChoice;

    /// The page about a part that was inspected with a library of this many parts.
    fn page(num: usize) -> WrongPartPage {
        let parts: Vec<String> = (0..num).map(|index| format!("part-{index:02}")).collect();
        page_of(parts.iter().map(|name| (name.as_str(), None)), None)
    }

    /// The page about a part that was inspected with a library of these references and the parts that they are of, and which of
    /// them were examined, the best first; `None` for the ranking of the shipped parts.
    fn page_of<'a>(
        references: impl Iterator<Item = (&'a str, Option<&'a str>)>,
        examined: Option<&[usize]>,
    ) -> WrongPartPage {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        let known = Arc::clone(&inspected.library);
        let named = |name: &str| PartName::new(name).expect("a name");
        let references = references.map(|(name, of)| PartMeta {
            name: named(name),
            title: name.replace("part-", "Part "),
            part: of.map(named),
            ..known.parts[0].clone()
        });
        inspected.library = Arc::new(LibraryView {
            parts: references.collect(),
            ..LibraryView::default()
        });
        if let Some(examined) = examined {
            let first = inspected.inspection.ranking.entries[0].clone();
            let examined = examined.iter().map(|reference| ConfirmedMatch {
                reference: *reference,
                is_examined: true,
                ..first.clone()
            });
            inspected.inspection.ranking.entries = examined.collect();
        }
        let part = inspected.hung().clone();
        let mut shell = TestShell::default();
        shell.session.shown = Some(Shown::new(1, Arc::new(inspected)));
        WrongPartPage::about(&part, &shell.session).expect("it is shown")
    }

    /// Draws the page in a small window.
    fn draw(page: &mut WrongPartPage) -> FullOutput {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        Theme::install(ThemeChoice::default(), &ctx);
        ctx.enable_accesskit();
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1024.0, 600.0))),
            ..RawInput::default()
        };
        ctx.run_ui(input, |ui| {
            page.ui(ui, &Thumbnails::default(), &mut Vec::new());
        })
    }

    fn texts(page: &mut WrongPartPage) -> Vec<String> {
        let output = draw(page);
        let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        });
        let texts = texts.collect();
        output.drop_without_applying_deltas();
        texts
    }

    /// The titles of the tiles that are laid out, in their order.
    fn tiles(page: &mut WrongPartPage) -> Vec<String> {
        let output = draw(page);
        let update = output.platform_output.accesskit_update.as_ref();
        let nodes = update.expect("it is enabled").nodes.iter();
        let titles = nodes.filter_map(|(_, node)| node.label()?.strip_prefix("Actual part: "));
        let titles = titles.map(str::to_owned).collect();
        output.drop_without_applying_deltas();
        titles
    }

    #[test]
    fn of_many_parts_only_the_tiles_in_sight_are_laid_out() {
        let mut many = page(1000);
        let drawn = tiles(&mut many);
        assert!((10..=25).contains(&drawn.len()), "{drawn:?}");
        many.find = "part 99".into();
        many.search();
        let drawn = tiles(&mut many);
        assert!(drawn.contains(&"Part 999".to_owned()), "{drawn:?}");
        assert_eq!(drawn.len(), 11);
    }

    #[test]
    fn a_part_of_several_references_has_one_tile_and_leaves_room_for_other_likely_parts() {
        let references = [
            ("door-2", Some("door")),
            ("door-3", Some("door")),
            ("door", None),
            ("fender", None),
            ("bonnet", None),
            ("hinge", None),
            ("grille", None),
            ("apron", None),
        ];
        let examined = [1, 3, 0, 2, 6, 5, 4, 7];
        let page = page_of(references.into_iter(), Some(&examined));
        let titles = page.parts.iter().map(|index| page.library.title(*index));
        let titles: Vec<&str> = titles.collect();
        assert_eq!(
            titles,
            ["door", "fender", "grille", "hinge", "bonnet", "apron"]
        );
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
        many.search();
        let drawn = texts(&mut many);
        assert!(
            has(&drawn, "Part 07") && !has(&drawn, "Part 00"),
            "{drawn:?}"
        );
        many.find = "door".into();
        many.search();
        assert!(has(&texts(&mut many), "No part has this name"));
    }
}
