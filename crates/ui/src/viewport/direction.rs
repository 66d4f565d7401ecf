//! The buttons that fit a view and turn it to a standard direction.

use egui::{Button, Rect, RichText, Ui, UiBuilder, Vec2, vec2};

use super::camera::{FitRequest, StandardView, ViewCamera};
use crate::{language::text, theme::space};

/// Direction from which a view shall show all of its focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewDirection {
    /// The present direction.
    Present,
    /// One of the standard views.
    From(StandardView),
}

impl ViewDirection {
    /// All directions that can be chosen, with their texts.
    pub fn choices() -> [(String, Self); 4] {
        [
            (text!("view-fit"), Self::Present),
            (text!("view-front"), Self::From(StandardView::Front)),
            (text!("view-top"), Self::From(StandardView::Top)),
            (text!("view-side"), Self::From(StandardView::Side)),
        ]
    }

    /// Turns the camera, and fits the view.
    pub fn apply(self, camera: &mut ViewCamera) {
        if let Self::From(view) = self {
            camera.look(view);
        }
        camera.request_fit(FitRequest::Focus);
    }

    /// Draws a button for each direction, in a row at the top of this view. Returns the place of the row.
    pub fn buttons(ui: &mut Ui, view: Rect, camera: &mut ViewCamera) -> Rect {
        let size = vec2(view.width() - 2.0 * space::SMALL, space::TARGET);
        let bar = Rect::from_min_size(view.min + Vec2::splat(space::SMALL), size);
        ui.scope_builder(UiBuilder::new().max_rect(bar), |ui| {
            ui.horizontal(|ui| {
                for (text, direction) in Self::choices() {
                    let button = Button::new(RichText::new(text).small());
                    let button = button.min_size(Vec2::splat(space::TARGET));
                    if ui.add(button).clicked() {
                        direction.apply(camera);
                    }
                }
            });
        });
        bar
    }
}
