//! The draft in three dimensions: kept bright, the rest dull.

use std::sync::Arc;

use egui::{Button, Rect, RichText, Ui, UiBuilder, Vec2, vec2};

use super::{EnrolAction, draft::Draft, picture::toggled, selection::Selection};
use crate::app::{
    action::Action,
    state::{State, ThemeChoice},
    theme::{font, space},
    viewport::{
        FitRequest, StandardView, ViewCamera, ViewColours, ViewError, ViewScene, ViewStyle,
        Viewport, ViewportGpu,
    },
};

/// The view of the draft.
pub(super) struct DraftView {
    viewport: Viewport,
    camera: ViewCamera,
    scene: ViewScene,
    style: ViewStyle,
    styled: ThemeChoice,
    shown: Option<(u64, Arc<Selection>)>,
    has_focus: bool,
}

impl DraftView {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self {
            viewport: Viewport::new(gpu),
            camera: ViewCamera::default(),
            scene: ViewScene::default(),
            style: ViewStyle::new(ViewColours::dark()),
            styled: ThemeChoice::Dark,
            shown: None,
            has_focus: false,
        }
    }

    /// True while keys go to the view.
    pub(super) fn has_focus(&self) -> bool {
        self.has_focus
    }

    /// The view is not shown.
    pub(super) fn rest(&mut self) {
        self.has_focus = false;
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        state: &State,
        actions: &mut Vec<Action>,
    ) {
        self.show(draft);
        if self.styled != state.theme {
            self.style = ViewStyle::new(match state.theme {
                ThemeChoice::Dark => ViewColours::dark(),
                ThemeChoice::Light => ViewColours::light(),
            });
            self.styled = state.theme;
        }
        let rect = ui.available_rect_before_wrap();
        let label = "3-D view of the draft";
        let seen = self
            .viewport
            .ui(ui, label, &mut self.camera, &self.scene, &self.style);
        self.has_focus = seen.response.has_focus();
        if let Some(picked) = seen.picked
            && draft.subject.can_be_corrected()
        {
            let segments = draft.subject.segments(draft.corrections.taking);
            let segment = segments.of_point.get(picked.index).copied();
            let edit = segment.and_then(|segment| toggled(draft, segment));
            actions.extend(edit.map(|edit| Action::Enrol(EnrolAction::Correct(edit))));
        }
        let bar = vec2(rect.width() - 2.0 * space::SMALL, space::TARGET);
        let bar = Rect::from_min_size(rect.min + Vec2::splat(space::SMALL), bar);
        ui.scope_builder(UiBuilder::new().max_rect(bar), |ui| {
            ui.horizontal(|ui| self.controls(ui));
        });
    }

    /// Takes in another selection; its points were prepared by the worker. Only another draft moves the camera.
    fn show(&mut self, draft: &Draft) {
        let shown = self.shown.as_ref();
        if shown.is_some_and(|(_, selection)| Arc::ptr_eq(selection, &draft.selection)) {
            return;
        }
        if shown.is_none_or(|(number, _)| *number != draft.number) {
            self.camera.request_fit(FitRequest::Focus);
        }
        self.scene.points = vec![draft.selection.points.clone()];
        self.shown = Some((draft.number, Arc::clone(&draft.selection)));
    }

    fn controls(&mut self, ui: &mut Ui) {
        let button = |ui: &mut Ui, text: &str| {
            let text = RichText::new(text).font(font::small());
            ui.add(Button::new(text).min_size(Vec2::splat(space::TARGET)))
        };
        if button(ui, "Fit").clicked() {
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
    }
}
