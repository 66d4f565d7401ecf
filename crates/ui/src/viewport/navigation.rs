//! Turns pointer, wheel, pinch and key input over a view into camera motion.

use egui::{EventFilter, Key, Modifiers, PointerButton, Response, Ui};
use glam::Vec2;

use super::{
    camera::{FitRequest, StandardView, ViewCamera, ViewSize},
    drawing::Drawing,
    scene::ViewScene,
};

/// Rotation per press of an arrow key, radians: 24 presses make a full turn.
const TURN_PER_PRESS: f32 = std::f32::consts::TAU / 24.0;
/// Shift per press of Shift and an arrow key, logical pixels.
const PAN_PER_PRESS: f32 = 40.0;
/// Zoom factor per press of + or −.
const ZOOM_PER_PRESS: f32 = 1.2;
/// Zoom exponent (base e) per logical pixel scrolled: one notch of about 50 pixels zooms by 1.28.
const ZOOM_PER_SCROLL: f32 = 0.005;

/// Performs the fit that the camera was asked for, once there is something to fit to.
pub(super) fn fit_if_pending(camera: &mut ViewCamera, scene: &ViewScene, size: ViewSize) {
    let bounds = match camera.pending_fit() {
        Some(FitRequest::Focus) => scene.focus(),
        Some(FitRequest::Everything) => scene.bounds(),
        None => None,
    };
    if let Some(bounds) = bounds {
        camera.fit(&bounds, size);
    }
}

/// Moves the camera by the input since the last frame, except for a drag that draws.
pub(super) fn navigate(
    ui: &Ui,
    response: &Response,
    drawing: &Drawing,
    camera: &mut ViewCamera,
    size: ViewSize,
) {
    if !drawing.is_held() {
        drag(ui, response, camera, size);
    }
    zoom(ui, response, camera, size);
    if is_listening(ui, response) {
        keys(ui, response, camera, size);
    }
}

/// Returns true if the view takes keys: it has the focus, or nothing has it and the pointer is over the view.
pub(super) fn is_listening(ui: &Ui, response: &Response) -> bool {
    response.has_focus()
        || (response.contains_pointer() && ui.memory(egui::Memory::focused).is_none())
}

fn drag(ui: &Ui, response: &Response, camera: &mut ViewCamera, size: ViewSize) {
    let moved = vec2(response.drag_delta());
    // `zoom` handles two-finger panning together with the pinch.
    if ui.input(egui::InputState::multi_touch).is_some() {
        return;
    }
    let shift = ui.input(|input| input.modifiers.shift);
    if response.dragged_by(PointerButton::Primary) && !shift {
        camera.orbit(moved, size);
    } else if response.dragged() {
        camera.pan(moved, size);
    }
}

fn zoom(ui: &Ui, response: &Response, camera: &mut ViewCamera, size: ViewSize) {
    if !response.contains_pointer() {
        return;
    }
    let Some(cursor) = response.hover_pos() else {
        return;
    };
    let (scroll, pinch, fingers) = ui.input(|input| {
        let fingers = input
            .multi_touch()
            .map_or(egui::Vec2::ZERO, |touch| touch.translation_delta);
        (input.smooth_scroll_delta().y, input.zoom_delta(), fingers)
    });
    let factor = pinch * (scroll * ZOOM_PER_SCROLL).exp();
    camera.zoom_at(factor, vec2(cursor - response.rect.min), size);
    camera.pan(vec2(fingers), size);
}

fn keys(ui: &Ui, response: &Response, camera: &mut ViewCamera, size: ViewSize) {
    if response.has_focus() {
        // The view uses the arrow keys and Escape; Tab still leaves it.
        let arrows = EventFilter {
            tab: false,
            horizontal_arrows: true,
            vertical_arrows: true,
            escape: true,
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    }
    let presses =
        |modifiers, key| ui.input_mut(|input| input.count_and_consume_key(modifiers, key)) as f32;
    let arrows = |modifiers| {
        Vec2::new(
            presses(modifiers, Key::ArrowRight) - presses(modifiers, Key::ArrowLeft),
            presses(modifiers, Key::ArrowDown) - presses(modifiers, Key::ArrowUp),
        )
    };
    let pan = arrows(Modifiers::SHIFT) * PAN_PER_PRESS;
    let turn = arrows(Modifiers::NONE) * TURN_PER_PRESS;
    camera.pan(pan, size);
    camera.turn(turn.x, turn.y);
    let nearer = presses(Modifiers::NONE, Key::Plus) + presses(Modifiers::NONE, Key::Equals)
        - presses(Modifiers::NONE, Key::Minus);
    camera.zoom_at(ZOOM_PER_PRESS.powf(nearer), size / 2.0, size);
    for (key, view) in [
        (Key::Z, StandardView::Front),
        (Key::Y, StandardView::Top),
        (Key::X, StandardView::Side),
    ] {
        if presses(Modifiers::NONE, key) > 0.0 {
            camera.look(view);
            camera.request_fit(FitRequest::Focus);
        }
    }
    if presses(Modifiers::NONE, Key::F) > 0.0 {
        camera.request_fit(FitRequest::Focus);
    }
    if presses(Modifiers::SHIFT, Key::F) > 0.0 {
        camera.request_fit(FitRequest::Everything);
    }
}

/// Converts egui's vector to glam's.
pub(super) fn vec2(v: egui::Vec2) -> Vec2 {
    Vec2::new(v.x, v.y)
}
