//! The draft in three dimensions: kept points bright, the rest dull.

use std::sync::Arc;

use egui::{Rect, Ui, vec2};

use super::{
    EnrolAction, EnrolState,
    draft::Draft,
    outline::{DrawnOutline, DrawnOver},
    picture::{drag_to_draw, toggled},
    selection::{Edit, OutlineMode, Selection},
};
use crate::shots::{Overlay, POINT_SIZE};
use geometry::rigid::RigidTransform;
use ui::{
    language::text,
    theme::{Theme, ThemeChoice, space},
    viewport::{
        DrawnShape, FitRequest, ViewCamera, ViewColours, ViewDirection, ViewError, ViewScene,
        ViewStyle, ViewTool, Viewport, ViewportGpu, colour_keys, drawing,
    },
};

/// What the view shows.
struct Shown {
    number: u64,
    selection: Arc<Selection>,
    /// For a scan: the shot whose own surface is marked.
    looked_at: Option<usize>,
    /// For a scan: the camera pose that defines the frame shown.
    space: Option<RigidTransform>,
}

/// The view of the draft.
pub(super) struct DraftView {
    viewport: Viewport,
    camera: ViewCamera,
    scene: ViewScene,
    shown: Option<Shown>,
    has_focus: bool,
}

impl DraftView {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self {
            viewport: Viewport::new(gpu),
            camera: ViewCamera::default(),
            scene: ViewScene::default(),
            shown: None,
            has_focus: false,
        }
    }

    /// True while the view has the key focus.
    pub(super) fn has_focus(&self) -> bool {
        self.has_focus
    }

    /// Drops the key focus while the view is hidden.
    pub(super) fn rest(&mut self) {
        self.has_focus = false;
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        enrol: &EnrolState,
        theme: ThemeChoice,
        actions: &mut Vec<EnrolAction>,
    ) {
        let looked_at = enrol.shots.looked_at;
        self.show(draft, looked_at);
        let mut style = ViewStyle::new(ViewColours::of(theme));
        if draft.subject.scan().is_some() {
            style.point_size = POINT_SIZE;
        }
        let can_correct = draft.subject.can_be_corrected();
        let shape = enrol.shape.filter(|_| can_correct);
        self.viewport.tool = match (shape, self.viewport.tool) {
            (Some(shape), _) => ViewTool::Draw(shape),
            (None, ViewTool::Draw(_)) => ViewTool::Look,
            (None, tool) => tool,
        };
        let rect = ui.available_rect_before_wrap();
        let label = text!("enrol-view");
        let seen = self
            .viewport
            .ui(ui, &label, &mut self.camera, &self.scene, &style);
        self.has_focus = seen.response.has_focus();
        if let Some(corners) = seen.drawn {
            let size = seen.response.rect.size();
            let size = glam::Vec2::new(size.x, size.y);
            let outline = DrawnOutline {
                corners: corners.into(),
                over: DrawnOver::View {
                    clip_from_world: self.camera.clip_from_world(size),
                },
            };
            let edit = Edit::Outline(enrol.outline_mode, outline);
            actions.push(EnrolAction::Correct(edit));
        }
        if let Some(picked) = seen.picked
            && can_correct
        {
            let segments = draft.subject.segments(draft.corrections.taking);
            let segment = segments.of_point.get(picked.index).copied();
            let edit = segment.and_then(|segment| toggled(draft, segment));
            actions.extend(edit.map(EnrolAction::Correct));
        }
        if let Some(overlay) = overlay(draft, looked_at) {
            let painter = ui.painter_at(rect);
            let corner = rect.left_bottom() + vec2(space::MEDIUM, -space::MEDIUM);
            let keys = overlay.colour_keys(&style.colours);
            colour_keys(&painter, corner, &keys, Theme::of(ui));
        }
        let bar = ViewDirection::buttons(ui, rect, &mut self.camera);
        if let Some(shape) = shape {
            let painter = ui.painter_at(rect);
            let corners = self.viewport.drawing.corners(shape);
            let (mode, colours) = (enrol.outline_mode, &style.colours);
            drawing::outline(&painter, &corners, &mode.title(), colours);
            // The hint would cover the part while a person draws.
            if corners.is_empty() {
                let below = rect.with_min_y(bar.bottom()).shrink(space::SMALL);
                hint(ui, below, shape, mode, colours);
            }
        }
    }

    /// Shows another selection, prepared by the worker. Only another draft moves the camera.
    fn show(&mut self, draft: &Draft, looked_at: Option<usize>) {
        let shown = self.shown.as_ref();
        let is_same = |shown: &Shown| {
            Arc::ptr_eq(&shown.selection, &draft.selection) && shown.looked_at == looked_at
        };
        if shown.is_some_and(is_same) {
            return;
        }
        let fused = draft.subject.scan();
        let space = fused.and_then(|fused| fused.space());
        let stays =
            |shown: &Shown| shown.number == draft.number || space.is_some() && shown.space == space;
        if !shown.is_some_and(stays) {
            self.camera.request_fit(FitRequest::Focus);
        }
        self.scene = ViewScene {
            points: vec![draft.selection.points.clone()],
            ..ViewScene::default()
        };
        if let Some(overlay) = overlay(draft, looked_at) {
            overlay.add_to(&mut self.scene);
        }
        self.shown = Some(Shown {
            number: draft.number,
            selection: Arc::clone(&draft.selection),
            looked_at,
            space,
        });
    }
}

/// Draws a hint on how to draw and what it does.
fn hint(ui: &mut Ui, place: Rect, shape: DrawnShape, mode: OutlineMode, colours: &ViewColours) {
    let text = text!(
        "enrol-view-hint",
        drag = drag_to_draw(shape),
        does = mode.explanation()
    );
    drawing::hint(ui, place, text, colours);
}

/// The overlay of a scan's points.
fn overlay(draft: &Draft, looked_at: Option<usize>) -> Option<Overlay<'_>> {
    Some(Overlay {
        fused: draft.subject.scan()?,
        unseen: None,
        looked_at,
        has_cameras: true,
        has_unseen: true,
    })
}
