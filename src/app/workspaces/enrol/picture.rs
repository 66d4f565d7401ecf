//! The draft as the camera sees it, and the box that a person draws in it.

use std::sync::Arc;

use egui::{
    ColorImage, CursorIcon, EventFilter, Key, Pos2, Rect, Response, Sense, Stroke, StrokeKind,
    TextureHandle, TextureOptions, Ui, pos2, vec2,
};

use super::{
    EnrolAction,
    draft::Draft,
    segments::PointAction,
    selection::{BoxMode, Edit, PixelBox, Selection},
};
use crate::app::{
    language::text,
    ui::{
        theme::{Theme, font},
        viewport::{Role, ViewColours},
        widgets::{fitted, focus_ring},
    },
};

/// The texture of the picture, and the box.
#[derive(Default)]
pub(super) struct PicturePane {
    made: Option<(Arc<Selection>, TextureHandle)>,
    /// Where a drag began, picture shares.
    begun: Option<Pos2>,
    /// The box that the keys move, picture shares.
    keyed: Option<Rect>,
}

/// One press of an arrow key moves the box by this share of the picture.
const STEP: f32 = 0.02;
/// Room for two lines below the picture, logical pixels.
const CAPTION: f32 = 38.0;
/// A box smaller than this, in pixels of the picture, was not meant.
const LEAST_SIDE: usize = 2;

impl PicturePane {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        box_mode: BoxMode,
        theme: &Theme,
        actions: &mut Vec<EnrolAction>,
    ) {
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
        let mut mended = None;
        if draft.subject.can_be_corrected() {
            mended = self.by_pointer(ui, &response, place, draft, box_mode);
            mended = mended.or_else(|| self.by_keys(ui, &response, draft, box_mode));
            if response.hovered() {
                ui.set_cursor_icon(CursorIcon::Crosshair);
            }
            let text = text!("enrol-picture-hint", box = box_mode.explanation());
            let (font, colour) = (font::small(), theme.weak_text);
            let galley = ui.painter().layout(text, font, colour, place.width());
            ui.painter().galley(below, galley, colour);
        }
        let pointer = response.interact_pointer_pos();
        let drawn = self.begun.zip(pointer.map(|at| share_of(at, place)));
        let drawn = drawn.map(|(from, to)| Rect::from_two_pos(from, to));
        if let Some(drawn) = drawn.or(self.keyed) {
            let at = |p: Pos2| place.min + p.to_vec2() * place.size();
            let on_screen = Rect::from_min_max(at(drawn.min), at(drawn.max));
            // On the picture, whose colours are the same in any window.
            let colours = ViewColours::dark();
            let bright = colours.role(Role::Measure).colour;
            for (width, colour) in [(5.0, colours.background), (2.0, bright)] {
                let stroke = Stroke::new(width, colour);
                painter.rect_stroke(on_screen, 0.0, stroke, StrokeKind::Middle);
            }
            let text = box_mode.title();
            let galley = painter.layout_no_wrap(text, font::small(), bright);
            let plate = Rect::from_min_size(on_screen.min + vec2(2.0, 2.0), galley.size());
            painter.rect_filled(plate.expand(3.0), 0.0, colours.background);
            painter.galley(plate.min, galley, bright);
        }
        focus_ring(ui, place, &response, theme);
        if let Some(edit) = mended {
            actions.push(EnrolAction::Correct(edit));
        }
    }

    /// Uploads the picture of a new selection, once.
    fn make(&mut self, ctx: &egui::Context, selection: &Arc<Selection>) {
        if self
            .made
            .as_ref()
            .is_some_and(|(of, _)| Arc::ptr_eq(of, selection))
        {
            return;
        }
        let picture = &selection.picture;
        let size = [picture.width() as usize, picture.height() as usize];
        let image = ColorImage::from_rgb(size, picture.as_raw());
        let options = TextureOptions {
            mipmap_mode: Some(egui::TextureFilter::Linear),
            ..TextureOptions::LINEAR
        };
        let texture = ctx.load_texture("what is kept", image, options);
        self.made = Some((Arc::clone(selection), texture));
    }

    /// A drag draws a box, a click takes or drops a segment.
    fn by_pointer(
        &mut self,
        ui: &Ui,
        response: &Response,
        place: Rect,
        draft: &Draft,
        box_mode: BoxMode,
    ) -> Option<Edit> {
        let at = response
            .interact_pointer_pos()
            .map(|at| share_of(at, place));
        if response.drag_started() {
            // Where the button went down: the pointer has moved since.
            let origin = ui.input(|input| input.pointer.press_origin());
            self.begun = origin.map(|at| share_of(at, place));
            self.keyed = None;
        }
        if response.drag_stopped() {
            let drawn = Rect::from_two_pos(self.begun.take()?, at?);
            return boxed(drawn, draft, box_mode);
        }
        let at = at.filter(|_| response.clicked())?;
        let [width, height] = draft.subject.picture.size();
        let column = ((at.x * width as f32) as usize).min(width - 1);
        let row = ((at.y * height as f32) as usize).min(height - 1);
        toggled(
            draft,
            *draft.selection.segment_at.get(row * width + column)?,
        )
    }

    /// Arrow keys move a box, with Shift its lower right corner; Enter applies it.
    fn by_keys(
        &mut self,
        ui: &Ui,
        response: &Response,
        draft: &Draft,
        box_mode: BoxMode,
    ) -> Option<Edit> {
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
        boxed(drawn, draft, box_mode)
    }
}

/// Where a place on the screen is in the picture, in shares of its sides.
fn share_of(at: Pos2, place: Rect) -> Pos2 {
    let share = (at - place.min) / place.size();
    pos2(share.x.clamp(0.0, 1.0), share.y.clamp(0.0, 1.0))
}

fn boxed(drawn: Rect, draft: &Draft, box_mode: BoxMode) -> Option<Edit> {
    let size = draft.subject.picture.size();
    let pixel = |at: Pos2| {
        [at.x, at.y]
            .map(f32::abs)
            .into_iter()
            .zip(size)
            .map(|(share, side)| ((share * side as f32).round() as usize).min(side))
    };
    let mut from = pixel(drawn.min);
    let mut to = pixel(drawn.max);
    let drawn = PixelBox {
        from: [from.next()?, from.next()?],
        to: [to.next()?, to.next()?],
    };
    let is_meant = (0..2).all(|axis| drawn.from[axis] + LEAST_SIDE <= drawn.to[axis]);
    is_meant.then_some(Edit::Box(box_mode, drawn))
}

/// Takes the segment if all of it is dropped, else drops it.
pub(super) fn toggled(draft: &Draft, segment: u16) -> Option<Edit> {
    let place = usize::from(segment);
    let num_kept = *draft.selection.kept_of.get(place)?;
    let fate = if num_kept == 0 {
        PointAction::Kept
    } else {
        PointAction::Dropped
    };
    Some(Edit::Segment(place, fate))
}
