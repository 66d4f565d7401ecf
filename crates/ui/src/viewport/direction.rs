//! The buttons that fit a view and turn it to a standard direction.

use egui::{Button, RichText, Ui, Vec2};

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

    /// Draws a button for each direction.
    pub fn buttons(ui: &mut Ui, camera: &mut ViewCamera) {
        for (text, direction) in Self::choices() {
            let button = Button::new(RichText::new(text).small());
            let button = button.min_size(Vec2::splat(space::TARGET));
            if ui.add(button).clicked() {
                direction.apply(camera);
            }
        }
    }
}
