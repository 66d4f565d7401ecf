//! The dialog with the meshes of a file, of which those to be enrolled are chosen.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
    sync::{Arc, Weak},
};

use egui::{
    Align, Context, EventFilter, Key, Layout, Modifiers, Rect, ScrollArea, Sense, Stroke,
    StrokeKind, TextureHandle, Ui, Vec2, WidgetInfo, pos2,
    text::{LayoutJob, TextWrapping},
    vec2,
};
use image::RgbaImage;

use super::{
    EnrolAction, EnrolState,
    meshes::{ListedMesh, MeshAction, MeshList, MeshListing, MeshOrder},
};
use crate::shared::{paint_fitted, thumbnail_texture};
use files::import::LengthUnit;
use shell::{language::UnitSystem, session::Session};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    tool_row::choice,
    user_error::UserError,
    widgets::{
        self, Mark, default_button, fitted_middle, focus_ring, grouped, line_edit, mark,
        text_button,
    },
};

/// Width of the dialog's content, logical pixels.
const WIDTH: f32 = 720.0;
/// Part of the window's height that the list leaves free, for what is above and below it, logical pixels.
const LIST_MARGIN: f32 = 330.0;
/// Width of the search field, logical pixels.
const SEARCH_WIDTH: f32 = 200.0;
/// Height of a row, and the gap between two, logical pixels.
const ROW_HEIGHT: f32 = 64.0;
const ROW_GAP: f32 = 2.0;
/// Size of a picture, logical pixels.
const PICTURE: Vec2 = vec2(80.0, 60.0);
/// Rows that *Page up* and *Page down* go.
const PAGE: i64 = 5;

/// What the dialog keeps between frames.
#[derive(Default)]
pub(super) struct MeshDialog {
    /// What is listed.
    listing: Weak<MeshListing>,
    /// Textures of the visible pictures.
    textures: BTreeMap<usize, (Arc<RgbaImage>, TextureHandle)>,
    /// Number of the move by keys that was scrolled to.
    followed: u64,
    /// The rows that were visible.
    seen: Range<usize>,
    /// The search field or a row had the focus, so that Enter enrols.
    takes_enter: bool,
}

impl MeshDialog {
    /// Draws the dialog while there are meshes to choose from.
    pub(super) fn ui(
        &mut self,
        ctx: &Context,
        enrol: &EnrolState,
        session: &Session,
        actions: &mut Vec<EnrolAction>,
    ) {
        let Some(list) = &enrol.mesh_list else {
            *self = Self::default();
            return;
        };
        let is_new = self.listing.as_ptr() != Arc::as_ptr(list.listing());
        if is_new {
            *self = Self {
                listing: Arc::downgrade(list.listing()),
                ..Self::default()
            };
        }
        let mut caused = Vec::new();
        let modal = widgets::dialog(ctx, "meshes of a file", |ui| {
            ui.set_width(WIDTH);
            self.keys(ui, list, &mut caused);
            ui.heading(text!("enrol-meshes", file = list.title()));
            ui.weak(text!("enrol-meshes-hint"));
            ui.add_space(space::SMALL);
            let is_searching = bar(ui, list, is_new, &mut caused);
            let room = ctx.content_rect().height() - LIST_MARGIN;
            let room = room.max(2.0 * ROW_HEIGHT);
            let is_in_list = ui
                .scope(|ui| self.rows(ui, list, room, session.units, &mut caused))
                .inner;
            self.takes_enter = is_searching || is_in_list;
            ui.add_space(space::MEDIUM);
            buttons(ui, list, &mut caused);
        });
        if modal.should_close() {
            caused.push(MeshAction::Close);
        }
        actions.extend(caused.into_iter().map(EnrolAction::Meshes));
    }

    /// Handles the keys that work in the search field, too.
    fn keys(&self, ui: &Ui, list: &MeshList, caused: &mut Vec<MeshAction>) {
        let pressed =
            |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as i64;
        let steps = pressed(Key::ArrowDown) - pressed(Key::ArrowUp)
            + PAGE * (pressed(Key::PageDown) - pressed(Key::PageUp));
        if steps != 0
            && let Some(last) = list.num_shown().checked_sub(1)
        {
            let from = list.row_of_keys().0.map_or(-1, |row| row as i64);
            let to = (from + steps).clamp(0, last as i64);
            caused.push(MeshAction::GoTo(to as usize));
        }
        if self.takes_enter && pressed(Key::Enter) > 0 {
            caused.push(MeshAction::Enrol(list.row_to_enrol()));
        }
    }

    /// Draws the visible rows; returns whether one has the focus.
    fn rows(
        &mut self,
        ui: &mut Ui,
        list: &MeshList,
        room: f32,
        units: UnitSystem,
        caused: &mut Vec<MeshAction>,
    ) -> bool {
        let num_rows = list.num_shown();
        if num_rows == 0 {
            let size = vec2(ui.available_width(), room);
            ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                ui.set_min_size(size);
                ui.add_space(space::LARGE);
                ui.weak(text!("enrol-meshes-none"));
            });
            return false;
        }
        ui.spacing_mut().item_spacing.y = ROW_GAP;
        // The scroll bar is beside the list, not over it.
        ui.spacing_mut().scroll.floating_allocated_width = space::MEDIUM;
        let mut area = ScrollArea::vertical()
            .id_salt("meshes")
            .auto_shrink(false)
            .max_height(room)
            .min_scrolled_height(room);
        let (row_of_keys, num_moves) = list.row_of_keys();
        let reached = row_of_keys.filter(|_| self.followed != num_moves);
        self.followed = num_moves;
        if let Some(offset) = reached.and_then(|row| self.offset_to(row, room)) {
            area = area.vertical_scroll_offset(offset);
        }
        let textures = &mut self.textures;
        let (mut has_focus, mut seen) = (false, 0..0);
        area.show_rows(ui, ROW_HEIGHT, num_rows, |ui, visible| {
            seen = visible.clone();
            for row in visible {
                let Some((index, mesh)) = list.mesh(row) else {
                    continue;
                };
                if let Some(image) = list.picture(index) {
                    let made = textures.get(&index);
                    if made.is_none_or(|(of, _)| !Arc::ptr_eq(of, image)) {
                        let made = thumbnail_texture(ui.ctx(), "mesh", image);
                        textures.insert(index, (Arc::clone(image), made));
                    }
                }
                let shown = ShownMesh {
                    row,
                    index,
                    mesh,
                    problem: list.problem(index),
                    is_ticked: list.is_ticked(index),
                    figures: figures(mesh, list.unit(), units),
                    texture: textures.get(&index).map(|(_, texture)| texture),
                };
                let response = shown.ui(ui, caused);
                if reached == Some(row) {
                    response.request_focus();
                } else if response.gained_focus() && row_of_keys != Some(row) {
                    caused.push(MeshAction::GoTo(row));
                }
                has_focus |= response.has_focus();
            }
        });
        let visible = seen.clone().filter_map(|row| list.mesh(row));
        let visible: BTreeSet<usize> = visible.map(|(index, _)| index).collect();
        self.textures.retain(|index, _| visible.contains(index));
        if self.seen != seen {
            caused.push(MeshAction::Visible(seen.clone()));
            self.seen = seen;
        }
        has_focus
    }

    /// Scroll offset that shows this row if it is out of sight.
    fn offset_to(&self, row: usize, height: f32) -> Option<f32> {
        // The last visible row is often cut off.
        if self.seen.start < row && row + 2 < self.seen.end {
            return None;
        }
        let pitch = ROW_HEIGHT + ROW_GAP;
        let top = row as f32 * pitch;
        Some(if row <= self.seen.start {
            top
        } else {
            (top + pitch - height).max(0.0)
        })
    }
}

/// Draws search, order and unit; returns whether the search field has the focus.
fn bar(ui: &mut Ui, list: &MeshList, is_new: bool, caused: &mut Vec<MeshAction>) -> bool {
    let mut has_focus = false;
    ui.horizontal_wrapped(|ui| {
        let mut search = list.search().to_owned();
        let field = line_edit(&mut search, text!("enrol-meshes-find-hint"), SEARCH_WIDTH);
        let field = ui.add(field.min_size(vec2(SEARCH_WIDTH, space::TARGET)));
        let label = text!("enrol-meshes-find");
        field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &label));
        if is_new {
            field.request_focus();
        }
        has_focus = field.has_focus();
        if field.changed() {
            caused.push(MeshAction::Search(search));
        }
        ui.add_space(space::MEDIUM);
        for order in MeshOrder::ALL {
            let title = order.title();
            let label = text!("enrol-meshes-order", order = &title);
            if choice(ui, &title, &label, list.order() == order, true).clicked() {
                caused.push(MeshAction::Order(order));
            }
        }
        ui.add_space(space::MEDIUM);
        for unit in LengthUnit::ALL {
            let label = text!("enrol-meshes-unit", unit = unit.name());
            let button = choice(ui, unit.name(), &label, list.unit() == unit, true);
            if button.on_hover_text(&label).clicked() {
                caused.push(MeshAction::Unit(unit));
            }
        }
    });
    let (shown, count) = (list.num_shown(), list.listing().meshes.len());
    ui.weak(text!("enrol-meshes-counted", shown = shown, count = count));
    has_focus
}

fn buttons(ui: &mut Ui, list: &MeshList, caused: &mut Vec<MeshAction>) {
    ui.horizontal(|ui| {
        let count = list.num_to_enrol();
        let enrol = text!("enrol-meshes-enrol", count = count);
        if default_button(ui, &enrol, count > 0) {
            caused.push(MeshAction::Enrol(list.row_to_enrol()));
        }
        if list.listing().file.opens_whole {
            let whole = text_button(ui, &text!("enrol-meshes-whole"));
            if whole
                .on_hover_text(text!("enrol-meshes-whole-hint"))
                .clicked()
            {
                caused.push(MeshAction::EnrolWhole);
            }
        }
        if text_button(ui, &text!("shell-cancel")).clicked() {
            caused.push(MeshAction::Close);
        }
    });
}

/// Size and number of triangles.
fn figures(mesh: &ListedMesh, unit: LengthUnit, units: UnitSystem) -> String {
    let (factor, symbol, decimals) = units.length_axis();
    let factor = factor * f64::from(unit.metres());
    let [width, height, depth] = mesh
        .sides
        .map(|side| format!("{:.decimals$}", side * factor));
    text!(
        "enrol-meshes-figures",
        size = format!("{width} × {height} × {depth} {symbol}"),
        triangles = grouped(mesh.num_triangles),
    )
}

/// A row of the list.
struct ShownMesh<'a> {
    row: usize,
    index: usize,
    mesh: &'a ListedMesh,
    problem: Option<UserError>,
    is_ticked: bool,
    figures: String,
    texture: Option<&'a TextureHandle>,
}

impl ShownMesh<'_> {
    fn ui(&self, ui: &mut Ui, caused: &mut Vec<MeshAction>) -> egui::Response {
        let size = vec2(ui.available_width(), ROW_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        // The focus stays with the mesh when the list is sorted or scrolled.
        let id = ui.scope_id().with(("mesh", self.index));
        let response = ui.interact(rect, id, Sense::click());
        let is_enabled = self.problem.is_none();
        response.widget_info(|| {
            let label = format!("{}, {}", self.mesh.name, self.figures);
            let role = egui::Role::CheckBox;
            let mut info = WidgetInfo::selected(role, is_enabled, self.is_ticked, label);
            let problem = self.problem.as_ref();
            info.current_text_value = problem.map(|problem| problem.what.clone());
            info
        });
        if response.has_focus() {
            // Up and down go to other rows; Tab still leaves the list.
            let arrows = EventFilter {
                tab: false,
                horizontal_arrows: false,
                vertical_arrows: true,
                escape: false,
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        }
        if ui.is_rect_visible(rect) {
            self.paint(ui, rect, response.hovered());
            focus_ring(ui, rect, &response);
        }
        if is_enabled && response.double_clicked() {
            caused.push(MeshAction::Enrol(Some(self.row)));
        } else if is_enabled && response.clicked() {
            caused.push(if ui.input(|input| input.modifiers.shift) {
                MeshAction::TickTo(self.row)
            } else {
                MeshAction::Tick(self.row)
            });
        }
        match &self.problem {
            Some(problem) => {
                response.on_hover_text(format!("{}\n{}", problem.what, problem.advice))
            }
            None => response,
        }
    }

    fn paint(&self, ui: &Ui, rect: Rect, is_hovered: bool) {
        let theme = Theme::of(ui);
        let painter = ui.painter_at(rect);
        let is_enabled = self.problem.is_none();
        if is_enabled && (is_hovered || self.is_ticked) {
            painter.rect_filled(rect, ROUNDING, theme.control);
        }
        let middle = pos2(rect.left() + 20.0, rect.center().y);
        let square = Rect::from_center_size(middle, Vec2::splat(18.0));
        if self.is_ticked {
            painter.rect_filled(square, ROUNDING, theme.accent);
            let at = |x: f32, y: f32| middle + vec2(x, y);
            let tick = vec![at(-4.5, 0.0), at(-1.0, 4.0), at(5.0, -4.0)];
            painter.line(tick, Stroke::new(2.0, theme.on_accent));
        } else if is_enabled {
            let edge = Stroke::new(1.5, theme.weak_text);
            painter.rect_stroke(square, ROUNDING, edge, StrokeKind::Inside);
        }
        let left_centre = pos2(rect.left() + 40.0 + PICTURE.x / 2.0, rect.center().y);
        let picture = Rect::from_center_size(left_centre, PICTURE);
        match self.texture {
            Some(texture) => paint_fitted(&painter, texture, picture),
            None if is_enabled => mark(&painter, picture.center(), 10.0, Mark::Open, theme),
            None => mark(&painter, picture.center(), 10.0, Mark::Look, theme),
        }
        let left = picture.right() + space::MEDIUM;
        let room = rect.right() - space::SMALL - left;
        let (name_colour, below, colour) = match &self.problem {
            None => (theme.text, &self.figures, theme.weak_text),
            Some(problem) => (theme.weak_text, &problem.what, theme.warning),
        };
        let name = fitted_middle(&painter, &self.mesh.name, &font::body_strong(), room);
        let name = LayoutJob::simple_singleline(name, font::body_strong(), name_colour);
        let below = LayoutJob::simple_singleline(below.clone(), font::small(), colour);
        let mut top = rect.top() + 12.0;
        for mut job in [name, below] {
            job.wrap = TextWrapping::truncate_at_width(room);
            let drawn = painter.layout_job(job);
            let height = drawn.size().y;
            painter.galley(pos2(left, top), drawn, colour);
            top += height + 4.0;
        }
    }
}
