//! The scene in three dimensions, the part coloured by its deviation from the enrolled one.

use std::sync::Arc;

use egui::{Button, Rect, RichText, Ui, UiBuilder, Vec2, pos2, vec2};

use crate::{
    app::{
        inspect::work::Inspected,
        state::{State, ThemeChoice},
        theme::{Theme, font, space},
        viewport::{
            Colouring, FitRequest, LineSet, PointSet, StandardView, ViewCamera, ViewColours,
            ViewError, ViewScene, ViewStyle, ViewTool, Viewport, ViewportGpu, furniture,
        },
    },
    units::Metres,
};

/// Ends of the scale of deviations: a few times a depth camera's noise, so that a dent shows and noise does not.
const DEVIATION_RANGE: Metres = Metres(0.01);

/// The view of the last result.
pub(super) struct SceneView {
    viewport: Viewport,
    camera: ViewCamera,
    scene: ViewScene,
    style: ViewStyle,
    styled: ThemeChoice,
    /// What a person chose to colour by; until then the deviation where there is one, else the segments.
    chosen: Option<Colouring>,
    /// The axes of the part's middle, where it was found.
    axes: Vec<LineSet>,
    frustum: Vec<LineSet>,
    shows_camera: bool,
    has_deviations: bool,
    has_focus: bool,
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
            style: ViewStyle {
                deviation_range: DEVIATION_RANGE,
                ..ViewStyle::new(ViewColours::dark())
            },
            styled: ThemeChoice::Dark,
            chosen: None,
            axes: Vec::new(),
            frustum: Vec::new(),
            shows_camera: false,
            has_deviations: false,
            has_focus: false,
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
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        let axes = pose.zip(inspected.middle).map(|(pose, middle)| {
            let camera_from_middle =
                pose.camera_from_part() * nalgebra::Translation3::from(middle.coords);
            furniture::axes(Metres(0.15)).at(&camera_from_middle)
        });
        self.axes = axes.into_iter().collect();
        let frustum = scene.intrinsics.as_ref();
        self.frustum = frustum
            .map(|camera| furniture::frustum(camera, Metres(0.25)))
            .into_iter()
            .collect();
        let mut set = PointSet::segmented(points, &inspection.segmentation.labels);
        self.has_deviations = !inspected.deviations.is_empty();
        if self.has_deviations {
            set = set.with_deviations(inspected.deviations.clone());
        }
        self.scene = ViewScene {
            points: vec![set],
            lines: self.axes.clone(),
            labels: Vec::new(),
        };
        self.place_lines();
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
            self.style = ViewStyle::new(match state.theme {
                ThemeChoice::Dark => ViewColours::dark(),
                ThemeChoice::Light => ViewColours::light(),
            });
            self.style.deviation_range = DEVIATION_RANGE;
            self.styled = state.theme;
        }
        self.style.colouring = self.colouring();
        let theme = Theme::of(state.theme);
        let rect = ui.available_rect_before_wrap();
        let label = "3-D view of the scene";
        let seen = self
            .viewport
            .ui(ui, label, &mut self.camera, &self.scene, &self.style);
        self.has_focus = seen.response.has_focus();
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
        if matches!(
            inspected.origin,
            crate::app::source::Origin::Simulated { .. }
        ) {
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

    /// True while keys go to the view; the space bar then still captures.
    pub(super) fn has_focus(&self) -> bool {
        self.has_focus
    }

    fn place_lines(&mut self) {
        self.scene.lines.clone_from(&self.axes);
        if self.shows_camera {
            self.scene.lines.extend_from_slice(&self.frustum);
        }
    }

    fn colouring(&self) -> Colouring {
        match (self.chosen, self.has_deviations) {
            (Some(Colouring::Deviation) | None, false) => Colouring::Segment,
            (Some(chosen), _) => chosen,
            (None, true) => Colouring::Deviation,
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
        let now = RichText::new(format!("Colour · {} ▼", self.style.colouring.title()))
            .font(font::small());
        ui.menu_button(now, |ui| {
            for colouring in Colouring::ALL {
                let is_chosen = self.style.colouring == colouring;
                if ui.selectable_label(is_chosen, colouring.title()).clicked() {
                    ui.close();
                }
            }
        });
        let text = RichText::new("Camera").font(font::small());
        let camera = Button::new(text)
            .selected(self.shows_camera)
            .min_size(Vec2::splat(space::TARGET));
        if ui
            .add(camera)
            .on_hover_text("Show where the camera is")
            .clicked()
        {
            self.shows_camera = !self.shows_camera;
            self.place_lines();
        }
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
pub(in crate::app) fn grouped(number: usize) -> String {
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
