//! Drawing a box or a lasso with the pointer, over a 3-D view or a picture.

use egui::{
    Event, Frame, Key, Label, Painter, PointerButton, Pos2, Rect, Response, RichText, Shape,
    Stroke, Ui, UiBuilder, vec2,
};
use glam::{Mat4, Vec2, Vec3};

use super::style::{Role, ViewColours};
use crate::theme::{ROUNDING, font, space};

/// The shape that a drag draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawnShape {
    /// An upright rectangle between two corners.
    Box,
    /// A polygon along the pointer's path, closed by a straight line.
    Lasso,
    /// The pointer's path itself, straight or not.
    Way,
}

/// An outline being drawn.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// The pointer's path, logical pixels on the screen; empty once the drawing was cancelled.
    trail: Vec<Pos2>,
    /// True from the press that began it until the release, cancelled or not.
    is_held: bool,
}

/// Projects a point to shares of the view's width and height from the top left; `None` behind the eye.
pub fn seen_at(clip_from_world: &Mat4, point: Vec3) -> Option<Vec2> {
    let clip = *clip_from_world * point.extend(1.0);
    // Beyond the near plane, as the view draws it; also false for NaN.
    let is_before_eye = clip.w > clip.z;
    is_before_eye.then(|| (Vec2::new(clip.x, -clip.y) / clip.w + 1.0) / 2.0)
}

/// Minimum distance between corners of a lasso, logical pixels.
const LEAST_STEP: f32 = 1.0;
/// Minimum width in any direction, logical pixels; a narrower outline is ignored as accidental.
const LEAST_WIDTH: f32 = 3.0;

impl Drawing {
    /// Follows a left drag over `response` while there is a shape to draw. When it ends, returns the corners as shares of the
    /// response's width and height from the top left, or nothing if the outline was accidental.
    ///
    /// Escape or a second finger cancels the drawing. The rest of the drag then does nothing.
    pub fn follow(
        &mut self,
        ui: &Ui,
        response: &Response,
        shape: Option<DrawnShape>,
    ) -> Option<Vec<Vec2>> {
        let rect = response.rect;
        let is_begun = response.drag_started_by(PointerButton::Primary)
            && shape.is_some()
            && !ui.input(|input| input.modifiers.shift);
        if is_begun {
            self.is_held = true;
            // Start where the button went down: the pointer has moved since.
            let origin = ui.input(|input| input.pointer.press_origin());
            self.trail = origin.map(|at| rect.clamp(at)).into_iter().collect();
        }
        if !self.is_held {
            return None;
        }
        let is_given_up =
            ui.input(|input| input.key_pressed(Key::Escape) || input.multi_touch().is_some());
        if is_given_up || shape.is_none() {
            self.trail.clear();
        }
        // Take every position passed: a slow window draws only a few frames per second.
        let passed = ui.input(|input| {
            let moves = input.events.iter().filter_map(|event| match event {
                Event::PointerMoved(at) => Some(*at),
                _ => None,
            });
            moves.collect::<Vec<_>>()
        });
        let passed = passed.into_iter().filter(|_| !is_begun);
        for at in passed.chain(response.interact_pointer_pos()) {
            let at = rect.clamp(at);
            if self
                .trail
                .last()
                .is_some_and(|last| last.distance(at) >= LEAST_STEP)
            {
                self.trail.push(at);
            }
        }
        if response.dragged() {
            return None;
        }
        let corners = self.corners(shape?);
        *self = Self::default();
        let share = |at: Pos2| (at - rect.min) / rect.size();
        (shape == Some(DrawnShape::Way) || is_meant(&corners)).then(|| {
            let shares = corners.into_iter().map(share);
            shares.map(|share| Vec2::new(share.x, share.y)).collect()
        })
    }

    /// True while a left drag belongs to the drawing.
    pub(super) fn is_held(&self) -> bool {
        self.is_held
    }

    /// The corners drawn so far, logical pixels on the screen; none while nothing is drawn.
    pub fn corners(&self, shape: DrawnShape) -> Vec<Pos2> {
        match (shape, self.trail.as_slice()) {
            (DrawnShape::Box, [first, .., last]) => {
                box_corners(Rect::from_two_pos(*first, *last)).to_vec()
            }
            (DrawnShape::Box, _) => Vec::new(),
            (DrawnShape::Lasso | DrawnShape::Way, trail) => trail.to_vec(),
        }
    }
}

/// Corners of a box, clockwise from the top left.
pub fn box_corners(rect: Rect) -> [Pos2; 4] {
    [
        rect.left_top(),
        rect.right_top(),
        rect.right_bottom(),
        rect.left_bottom(),
    ]
}

/// Returns false for an outline that encloses almost nothing, such as a slipped click or a line.
fn is_meant(corners: &[Pos2]) -> bool {
    let Some(first) = corners.first() else {
        return false;
    };
    let far = |at: &Pos2| at.distance(*first);
    let farthest = corners.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
    let farthest = *farthest.unwrap_or(first);
    let length = far(&farthest);
    let along = (farthest - *first) / length.max(f32::MIN_POSITIVE);
    let across = corners.iter().map(|at| (*at - *first).dot(along.rot90()));
    let (low, high) = across.fold((0.0, 0.0), |(low, high): (f32, f32), at| {
        (low.min(at), high.max(at))
    });
    length >= LEAST_WIDTH && high - low >= LEAST_WIDTH
}

/// Draws an outline with a label that says what it will do.
pub fn outline(painter: &Painter, corners: &[Pos2], words: &str, colours: &ViewColours) {
    let [_, _, ..] = corners else {
        return;
    };
    let bright = colours.role(Role::Measure).colour;
    for (width, colour) in [(5.0, colours.background), (2.0, bright)] {
        painter.add(Shape::closed_line(
            corners.to_vec(),
            Stroke::new(width, colour),
        ));
    }
    let galley = painter.layout_no_wrap(words.to_owned(), font::small(), bright);
    // Place the label above the outline, but inside the clip rectangle.
    let above = Rect::from_points(corners).left_top() - vec2(-3.0, galley.size().y + 6.0);
    let room = painter.clip_rect().shrink(4.0);
    let room = Rect::from_min_max(room.min, (room.max - galley.size()).max(room.min));
    let plate = Rect::from_min_size(room.clamp(above), galley.size());
    painter.rect_filled(plate.expand(3.0), 0.0, colours.background);
    painter.galley(plate.min, galley, bright);
}

/// Draws a hint on a backing, so that it is legible over any points.
pub fn hint(ui: &mut Ui, place: Rect, text: String, colours: &ViewColours) {
    let text = RichText::new(text).small().color(colours.text);
    let plate = Frame::new()
        .fill(colours.background.gamma_multiply(0.85))
        .corner_radius(ROUNDING)
        .inner_margin(space::SMALL);
    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        // Selectable text would take the drags away from the view.
        plate.show(ui, |ui| ui.add(Label::new(text).selectable(false)));
    });
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn a_slip_and_a_line_are_not_meant_and_a_narrow_figure_of_eight_is() {
        let of = |corners: &[[f32; 2]]| {
            let corners: Vec<Pos2> = corners.iter().map(|at| pos2(at[0], at[1])).collect();
            is_meant(&corners)
        };
        assert!(!of(&[]) && !of(&[[5.0, 5.0]]));
        assert!(!of(&[[5.0, 5.0], [7.0, 5.0], [7.0, 7.0], [5.0, 7.0]]));
        assert!(!of(&[[0.0, 0.0], [100.0, 100.0]]));
        assert!(!of(&[[0.0, 0.0], [50.0, 51.0], [100.0, 100.0]]));
        assert!(of(&[[0.0, 0.0], [50.0, 55.0], [100.0, 100.0]]));
        // Its halves run in opposite directions, so their signed areas cancel.
        assert!(of(&[[0.0, 0.0], [100.0, 4.0], [100.0, 0.0], [0.0, 4.0]]));
    }
}
