//! The draft as the camera sees it, with the box or lasso being drawn.

use std::sync::Arc;

use egui::{CursorIcon, EventFilter, Key, Rect, Response, Sense, TextureHandle, Ui, pos2, vec2};
use glam::Vec2;

use super::{
    EnrolAction, EnrolState,
    draft::Draft,
    outline::{DrawnOutline, DrawnOver},
    segments::PointAction,
    selection::{Edit, Selection},
};
use ui::{
    language::text,
    theme::{Theme, font},
    viewport::{Drawing, DrawnShape, ViewColours, drawing},
    widgets::{fitted, focus_ring, texture},
};

/// The texture of the picture, and the outline being drawn in it.
#[derive(Default)]
pub(super) struct PicturePane {
    made: Option<(Arc<Selection>, TextureHandle)>,
    drawing: Drawing,
    /// The box moved by the keys, fractions of the picture.
    keyed: Option<Rect>,
}

/// Distance that an arrow key moves the box, fraction of the picture.
const STEP: f32 = 0.02;
/// Height of the caption below the picture (two lines), logical pixels.
const CAPTION: f32 = 38.0;

impl PicturePane {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        enrol: &EnrolState,
        actions: &mut Vec<EnrolAction>,
    ) {
        let theme = Theme::of(ui);
        self.make(ui.ctx(), &draft.selection);
        let Some((_, texture)) = &self.made else {
            return;
        };
        let room = ui.available_rect_before_wrap();
        let (room, _) = room.split_top_bottom_at_y(room.bottom() - CAPTION);
        let place = fitted(room, texture.aspect_ratio());
        let below = place.left_bottom() + vec2(0.0, 6.0);
        let response = ui.interact(
            place,
            ui.scope_id().with("picture"),
            Sense::click_and_drag(),
        );
        response.widget_info(|| {
            let label = text!("enrol-picture");
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        let painter = ui.painter_at(room);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture.id(), place, whole, egui::Color32::WHITE);
        // The picture cannot be turned, so a drag draws a box by default.
        let shape = enrol.shape.unwrap_or(DrawnShape::Box);
        let mode = enrol.outline_mode;
        let mut mended = None;
        if draft.subject.can_be_corrected() {
            let drawn = self.drawing.follow(ui, &response, Some(shape));
            let drawn = drawn.or_else(|| self.by_keys(ui, &response));
            let outline = drawn.map(|corners| DrawnOutline {
                corners: corners.into(),
                over: DrawnOver::Picture,
            });
            mended = outline.map(|outline| Edit::Outline(mode, outline));
            mended = mended.or_else(|| clicked(&response, draft));
            if response.hovered() {
                ui.set_cursor_icon(CursorIcon::Crosshair);
            }
            let text = text!(
                "enrol-picture-hint",
                drag = drag_to_draw(shape),
                does = mode.explanation()
            );
            let (font, colour) = (font::small(), theme.weak_text);
            let galley = ui.painter().layout(text, font, colour, place.width());
            ui.painter().galley(below, galley, colour);
        }
        let mut corners = self.drawing.corners(shape);
        if !corners.is_empty() {
            self.keyed = None;
        }
        if let Some(keyed) = self.keyed {
            let at = |share: egui::Pos2| place.min + share.to_vec2() * place.size();
            let on_screen = Rect::from_min_max(at(keyed.min), at(keyed.max));
            corners = drawing::box_corners(on_screen).to_vec();
        }
        // The picture has the same colours in every theme, so the outline on it does, too.
        drawing::outline(&painter, &corners, &mode.title(), &ViewColours::dark());
        focus_ring(ui, place, &response);
        if let Some(edit) = mended {
            actions.push(EnrolAction::Correct(edit));
        }
    }

    /// Uploads the picture of a new selection.
    fn make(&mut self, ctx: &egui::Context, selection: &Arc<Selection>) {
        if self
            .made
            .as_ref()
            .is_some_and(|(of, _)| Arc::ptr_eq(of, selection))
        {
            return;
        }
        let made = texture(ctx, "what is kept", Some(&selection.picture));
        self.made = made.map(|texture| (Arc::clone(selection), texture));
    }

    /// Arrow keys move a box, or with Shift its lower right corner; Enter applies it.
    fn by_keys(&mut self, ui: &Ui, response: &Response) -> Option<Vec<Vec2>> {
        if !response.has_focus() {
            self.keyed = None;
            return None;
        }
        let filter = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            escape: self.keyed.is_some(),
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        let (moved, is_sizing, is_leaving) = ui.input(|input| {
            let pressed = |key| f32::from(u8::from(input.key_pressed(key)));
            let across = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            let down = pressed(Key::ArrowDown) - pressed(Key::ArrowUp);
            let is_leaving = input.key_pressed(Key::Escape);
            (vec2(across, down) * STEP, input.modifiers.shift, is_leaving)
        });
        if is_leaving {
            self.keyed = None;
        } else if moved != egui::Vec2::ZERO {
            let middle = Rect::from_min_max(pos2(0.25, 0.25), pos2(0.75, 0.75));
            let keyed = self.keyed.get_or_insert(middle);
            if is_sizing {
                keyed.max = (keyed.max + moved).clamp(keyed.min + vec2(STEP, STEP), pos2(1.0, 1.0));
            } else {
                let least = keyed.min.to_vec2();
                let most = pos2(1.0, 1.0) - keyed.max;
                *keyed = keyed.translate(moved.clamp(-least, most));
            }
        }
        let is_entered = response.clicked() && response.interact_pointer_pos().is_none();
        let drawn = self.keyed.filter(|_| is_entered)?;
        self.keyed = None;
        let corners = drawing::box_corners(drawn).into_iter();
        Some(corners.map(|at| Vec2::new(at.x, at.y)).collect())
    }
}

/// Toggles the segment that was clicked.
fn clicked(response: &Response, draft: &Draft) -> Option<Edit> {
    let at = response.interact_pointer_pos();
    let at = at.filter(|_| response.clicked())?;
    let share = (at - response.rect.min) / response.rect.size();
    let [width, height] = draft.subject.picture.size();
    let column = ((share.x * width as f32) as usize).min(width - 1);
    let row = ((share.y * height as f32) as usize).min(height - 1);
    toggled(
        draft,
        *draft.selection.segment_at.get(row * width + column)?,
    )
}

/// Describes how the shape is drawn.
pub(super) fn drag_to_draw(shape: DrawnShape) -> String {
    match shape {
        DrawnShape::Box => text!("enrol-drag-box"),
        DrawnShape::Lasso | DrawnShape::Way => text!("enrol-drag-lasso"),
    }
}

/// Keeps the segment if all of it is dropped, else drops it.
pub(super) fn toggled(draft: &Draft, segment: u16) -> Option<Edit> {
    let index = usize::from(segment);
    let num_kept = *draft.selection.kept_of.get(index)?;
    let fate = if num_kept == 0 {
        PointAction::Kept
    } else {
        PointAction::Dropped
    };
    Some(Edit::Segment(index, fate))
}
