//! The scene in three dimensions, with the enrolled part laid over it at its pose.

use std::sync::Arc;

use egui::{Button, Rect, RichText, Ui, UiBuilder, Vec2, pos2, vec2};

use crate::{
    app::{
        state::{State, ThemeChoice},
        theme::{Theme, font, space},
        viewport::{
            Colouring, FitRequest, PointSet, StandardView, ViewCamera, ViewColours, ViewError,
            ViewScene, ViewStyle, ViewTool, Viewport, ViewportGpu, furniture,
        },
        work::Inspected,
    },
    units::Metres,
};

/// The view of the last result.
pub(super) struct SceneView {
    viewport: Viewport,
    camera: ViewCamera,
    scene: ViewScene,
    style: ViewStyle,
    styled: ThemeChoice,
    caption: String,
}

impl SceneView {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        let mut camera = ViewCamera::default();
        camera.request_fit(FitRequest::Focus);
        Self {
            viewport: Viewport::new(gpu),
            camera,
            scene: ViewScene::default(),
            style: ViewStyle::new(ViewColours::dark()),
            styled: ThemeChoice::Dark,
            caption: String::new(),
        }
    }

    /// Takes in a new result: the only place where its points are gone through.
    pub(super) fn show(&mut self, inspected: &Arc<Inspected>) {
        let Inspected {
            scene,
            inspection,
            figures,
            ..
        } = &**inspected;
        let points: Vec<[f32; 3]> = scene.cloud.points.iter().map(|p| [p.x, p.y, p.z]).collect();
        let mut lines = vec![furniture::axes(Metres(0.15))];
        if let Some(camera) = &scene.intrinsics {
            lines.push(furniture::frustum(camera, Metres(0.25)));
        }
        self.scene = ViewScene {
            points: vec![PointSet::segmented(points, &inspection.segmentation.labels)],
            lines,
            labels: Vec::new(),
        };
        self.camera.request_fit(FitRequest::Focus);
        let num_planes = inspection.segmentation.planes.len();
        self.caption = format!(
            "{} points · part {} · {num_planes} background {} removed",
            grouped(figures.num_points),
            grouped(figures.num_part),
            if num_planes == 1 { "plane" } else { "planes" },
        );
    }

    pub(super) fn ui(&mut self, ui: &mut Ui, state: &State, inspected: &Inspected) {
        if self.styled != state.theme {
            let colouring = self.style.colouring;
            self.style = ViewStyle::new(match state.theme {
                ThemeChoice::Dark => ViewColours::dark(),
                ThemeChoice::Light => ViewColours::light(),
            });
            self.style.colouring = colouring;
            self.styled = state.theme;
        }
        let theme = Theme::of(state.theme);
        let rect = ui.available_rect_before_wrap();
        let label = "3-D view of the scene";
        self.viewport
            .ui(ui, label, &mut self.camera, &self.scene, &self.style);
        let bar = Rect::from_min_size(
            rect.min + Vec2::splat(space::MEDIUM),
            vec2(rect.width() - 20.0, space::TARGET),
        );
        ui.scope_builder(UiBuilder::new().max_rect(bar), |ui| {
            ui.horizontal_wrapped(|ui| self.controls(ui));
        });
        let painter = ui.painter();
        let bottom = pos2(rect.left() + 14.0, rect.bottom() - 12.0);
        painter.text(
            bottom,
            egui::Align2::LEFT_BOTTOM,
            &self.caption,
            font::small(),
            theme.weak_text,
        );
        if matches!(inspected.origin, crate::app::work::Origin::Simulated { .. }) {
            let corner = pos2(rect.right() - 14.0, rect.bottom() - 12.0);
            let text = format!("{} · no camera was read", inspected.origin.title());
            painter.text(
                corner,
                egui::Align2::RIGHT_BOTTOM,
                text,
                font::small(),
                theme.weak_text,
            );
        }
    }

    fn controls(&mut self, ui: &mut Ui) {
        let button = |ui: &mut Ui, text: &str| {
            let text = RichText::new(text).font(font::small());
            ui.add(Button::new(text).min_size(Vec2::splat(space::TARGET)))
        };
        if button(ui, "Fit")
            .on_hover_text("Fit the part (F)")
            .clicked()
        {
            self.camera.request_fit(FitRequest::Focus);
        }
        for (text, view) in [
            ("Front", StandardView::Front),
            ("Top", StandardView::Top),
            ("Side", StandardView::Side),
        ] {
            if button(ui, text).clicked() {
                self.camera.look(view);
                self.camera.request_fit(FitRequest::Focus);
            }
        }
        let now = RichText::new(format!("Colour · {} ⏷", self.style.colouring.title()))
            .font(font::small());
        ui.menu_button(now, |ui| {
            for colouring in [Colouring::Segment, Colouring::Height, Colouring::Plain] {
                let is_chosen = self.style.colouring == colouring;
                if ui.selectable_label(is_chosen, colouring.title()).clicked() {
                    self.style.colouring = colouring;
                    ui.close();
                }
            }
        });
        let is_measuring = self.viewport.tool == ViewTool::Measure;
        let text = RichText::new("Measure").font(font::small());
        let measure = Button::new(text)
            .selected(is_measuring)
            .min_size(Vec2::splat(space::TARGET));
        if ui
            .add(measure)
            .on_hover_text("Click two points (M)")
            .clicked()
        {
            self.viewport.tool = if is_measuring {
                ViewTool::Look
            } else {
                ViewTool::Measure
            };
        }
    }
}

/// A whole number in groups of three digits.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn long_numbers_are_grouped() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(301_812), "301\u{202f}812");
        assert_eq!(grouped(1_000_000), "1\u{202f}000\u{202f}000");
    }
}
