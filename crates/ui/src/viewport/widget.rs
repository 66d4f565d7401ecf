//! The view as a widget: handles input and shows the picture.

use std::sync::{Arc, Mutex};

use eframe::{
    egui_wgpu::{Callback, CallbackResources, CallbackTrait, ScreenDescriptor},
    wgpu,
};
use egui::{
    Align, CursorIcon, Key, Label, Layout, Modifiers, PaintCallbackInfo, Rect, Response, RichText,
    Sense, Ui, UiBuilder,
};
use glam::Vec2;

use super::{
    camera::ViewCamera,
    detail::{MovingDetail, NextRepaint, pixel_side},
    drawing::{Drawing, DrawnShape},
    gpu::{ViewError, ViewportGpu},
    legend,
    measure::{self, Anchor, Measurement},
    navigation::{self, vec2},
    picking::{self, PickedPoint},
    renderer::{Frame, ViewRenderer},
    scene::ViewScene,
    screenshot::ViewShot,
    style::ViewStyle,
};
use crate::language::text;
use geometry::error::{Advice, lock};

/// What a click or a left drag on the view does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewTool {
    /// A click picks a point, a drag rotates.
    #[default]
    Look,
    /// A click sets one end of a measured distance, a drag rotates.
    Measure,
    /// A drag draws this shape; a click does nothing.
    Draw(DrawnShape),
}

/// One 3-D view in the window.
///
/// It keeps only the state of the view itself; camera, scene and style are passed in each frame. Giving two views the same
/// [`ViewCamera`] links them. Dropping the view frees its GPU resources.
pub struct Viewport {
    gpu: Result<ViewportGpu, ViewError>,
    renderer: Arc<Mutex<ViewRenderer>>,
    detail: MovingDetail,
    shown_camera: Option<ViewCamera>,
    /// What a click or a left drag does.
    pub tool: ViewTool,
    /// The outline being drawn.
    pub drawing: Drawing,
    /// The distance being measured.
    pub measure: Measurement,
}

/// What happened in a view during this frame.
#[derive(Clone, Debug)]
pub struct ViewportResponse {
    /// egui's own response, for focus, hover and context menus.
    pub response: Response,
    /// The point that was clicked.
    pub picked: Option<PickedPoint>,
    /// The outline that was drawn: its corners as shares of the view's width and height, from the top left.
    pub drawn: Option<Vec<Vec2>>,
}

impl Viewport {
    /// Makes a view drawn by `gpu`; with an error, the view shows the error text instead.
    pub fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self {
            gpu,
            renderer: Arc::default(),
            detail: MovingDetail::default(),
            shown_camera: None,
            tool: ViewTool::default(),
            drawing: Drawing::default(),
            measure: Measurement::default(),
        }
    }

    /// Shows the scene in all the room left in `ui`. `label` names the view for a screen reader and must differ between views.
    pub fn ui(
        &mut self,
        ui: &mut Ui,
        label: &str,
        camera: &mut ViewCamera,
        scene: &ViewScene,
        style: &ViewStyle,
    ) -> ViewportResponse {
        let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let id = ui.scope_id().with(("viewport", label));
        let response = ui.interact(rect, id, Sense::click_and_drag() | Sense::FOCUSABLE);
        describe(ui, &response, label);
        let size = vec2(rect.size());
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }

        let shape = match self.tool {
            ViewTool::Draw(shape) => Some(shape),
            ViewTool::Look | ViewTool::Measure => None,
        };
        let drawn = self.drawing.follow(ui, &response, shape);
        navigation::navigate(ui, &response, &self.drawing, camera, size);
        navigation::fit_if_pending(camera, scene, size);
        self.tool_keys(ui, &response);
        let picked = self.click(&response, camera, scene, style);

        match self.drawable() {
            Ok(gpu) => {
                let gpu = gpu.clone();
                self.paint(ui, &gpu, rect, camera, scene, style);
                self.overlay(ui, rect, camera, scene, style);
            }
            Err(error) => say(ui, rect, &error, style),
        }
        if response.has_focus() {
            let inside = rect.shrink(1.0);
            ui.painter().rect_stroke(
                inside,
                0.0,
                ui.visuals().selection.stroke,
                egui::StrokeKind::Inside,
            );
        }
        if self.tool != ViewTool::Look && response.hovered() {
            ui.set_cursor_icon(CursorIcon::Crosshair);
        }
        ViewportResponse {
            response,
            picked,
            drawn,
        }
    }

    /// Number of times the picture was redrawn; it stays constant while nothing changes.
    pub fn num_pictures(&self) -> u64 {
        lock(&self.renderer).num_pictures()
    }

    /// Number of sets uploaded to the device, over all views that share it.
    pub fn num_uploads(&self) -> u64 {
        self.gpu.as_ref().map_or(0, ViewportGpu::num_uploads)
    }

    /// Share of the points drawn in the last frame, 0..1; below 1 only while a slow device follows a moving camera.
    pub fn detail(&self) -> f32 {
        self.detail.share()
    }

    /// Captures the view with this camera, scene and style, to be drawn elsewhere; `size` in logical pixels.
    pub fn shot(
        &self,
        camera: &ViewCamera,
        scene: &ViewScene,
        style: &ViewStyle,
        size: egui::Vec2,
        pixels_per_point: f32,
    ) -> Result<ViewShot, ViewError> {
        let pixels = |points: f32| (points * pixels_per_point).round().max(1.0) as u32;
        Ok(ViewShot {
            gpu: self.drawable()?.clone(),
            camera: *camera,
            scene: scene.clone(),
            style: style.clone(),
            size: [pixels(size.x), pixels(size.y)],
            pixels_per_point,
        })
    }

    fn drawable(&self) -> Result<&ViewportGpu, ViewError> {
        let gpu = self.gpu.as_ref().map_err(Clone::clone)?;
        gpu.problem().map_or(Ok(gpu), Err)
    }

    fn tool_keys(&mut self, ui: &Ui, response: &Response) {
        if !navigation::is_listening(ui, response) {
            return;
        }
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::M) {
            self.tool = match self.tool {
                ViewTool::Look => ViewTool::Measure,
                ViewTool::Measure => ViewTool::Look,
                ViewTool::Draw(shape) => ViewTool::Draw(shape),
            };
        }
        let is_measuring = self.tool == ViewTool::Measure || self.measure != Measurement::default();
        if is_measuring && pressed(Key::Escape) {
            self.end_measuring();
        }
    }

    /// Stops measuring and forgets what was measured.
    pub fn end_measuring(&mut self) {
        self.tool = ViewTool::Look;
        self.measure = Measurement::default();
    }

    fn click(
        &mut self,
        response: &Response,
        camera: &ViewCamera,
        scene: &ViewScene,
        style: &ViewStyle,
    ) -> Option<PickedPoint> {
        if !response.clicked() || matches!(self.tool, ViewTool::Draw(_)) {
            return None;
        }
        let cursor = vec2(response.interact_pointer_pos()? - response.rect.min);
        let is_shown = |role| style.colours.role(role).weight > 0.0;
        let picked = picking::pick(camera, scene, is_shown, cursor, vec2(response.rect.size()))?;
        if self.tool == ViewTool::Measure {
            self.measure.add(picked.position);
        }
        Some(picked)
    }

    fn paint(
        &mut self,
        ui: &Ui,
        gpu: &ViewportGpu,
        rect: Rect,
        camera: &ViewCamera,
        scene: &ViewScene,
        style: &ViewStyle,
    ) {
        let now = ui.input(|input| input.time);
        let has_moved = self.shown_camera.is_some_and(|shown| shown != *camera);
        self.shown_camera = Some(*camera);
        let (num_samples, next) = self.detail.frame(has_moved, now);
        match next {
            NextRepaint::AtOnce => ui.request_repaint(),
            NextRepaint::Within(seconds) => ui.request_repaint_after_secs(seconds as f32),
            NextRepaint::Whenever => {}
        }
        let callback = PaintView {
            gpu: gpu.clone(),
            renderer: Arc::clone(&self.renderer),
            rect,
            frame: Frame {
                camera: *camera,
                scene: scene.clone(),
                style: style.clone(),
                size: vec2(rect.size()),
                // Both are set in `prepare`, which knows the window's actual scale.
                target: [0, 0],
                num_samples,
            },
        };
        ui.painter()
            .add(Callback::new_paint_callback(rect, callback));
    }

    fn overlay(
        &self,
        ui: &Ui,
        rect: Rect,
        camera: &ViewCamera,
        scene: &ViewScene,
        style: &ViewStyle,
    ) {
        let painter = ui.painter_at(rect);
        for label in &scene.labels {
            if let Some(at) = measure::on_screen(label.at, rect, camera) {
                measure::plate(&painter, at, &label.text, style, Anchor::Right);
            }
        }
        self.measure.ui(&painter, rect, camera, style);
        if self.tool == ViewTool::Measure
            && let Some(next) = self.measure.next_step()
        {
            let at = rect.center_bottom() - egui::vec2(0.0, 44.0);
            measure::plate(&painter, at, &next, style, Anchor::Middle);
        }
        legend::ui(&painter, rect, scene, style);
    }
}

/// Names the view and its keys for a screen reader.
fn describe(ui: &Ui, response: &Response, label: &str) {
    ui.accesskit_node_builder(response.id, |node| {
        node.set_role(egui::accesskit::Role::Canvas);
        node.set_label(label);
        node.set_description(text!("view-keys"));
    });
}

/// Shows the error in place of the view.
fn say(ui: &mut Ui, rect: Rect, error: &ViewError, style: &ViewStyle) {
    let colours = &style.colours;
    ui.painter().rect_filled(rect, 0.0, colours.background);
    let inside = rect.shrink(24.0);
    let layout = Layout::top_down(Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(inside).layout(layout), |ui| {
        ui.add_space((inside.height() / 2.0 - 40.0).max(0.0));
        // Selectable text would take the drags from the view.
        let mut say = |text: RichText| ui.add(Label::new(text).selectable(false));
        say(RichText::new(text!("view-no-view"))
            .size(20.0)
            .color(colours.text));
        say(RichText::new(error.to_string()).color(colours.weak_text));
        say(RichText::new(error.advice()).color(colours.text));
    });
}

/// One frame of a view, passed to egui's paint callback.
struct PaintView {
    gpu: ViewportGpu,
    renderer: Arc<Mutex<ViewRenderer>>,
    rect: Rect,
    frame: Frame,
}

impl CallbackTrait for PaintView {
    fn prepare(
        &self,
        device: &wgpu::Device,
        _queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        _resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        // Round as egui does, so that a texel is a pixel, but do not clip at the window's edge.
        let pixel = |points: f32| (points * screen.pixels_per_point).round() as i32;
        let origin = [pixel(self.rect.min.x), pixel(self.rect.min.y)];
        let end = [pixel(self.rect.max.x), pixel(self.rect.max.y)];
        let most = device.limits().max_texture_dimension_2d as i32;
        let side = pixel_side(self.frame.num_samples);
        let target = [0, 1].map(|axis| {
            let pixels = (end[axis] - origin[axis]).clamp(1, most) as u32;
            pixels.div_ceil(side)
        });
        let frame = Frame {
            target,
            ..self.frame.clone()
        };
        let mut renderer = lock(&self.renderer);
        renderer.draw(&self.gpu, &frame, encoder);
        renderer.place(&self.gpu, origin, side);
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        lock(&self.renderer).composite(&self.gpu, pass);
    }
}
