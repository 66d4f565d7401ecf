//! The button at the foot of the rail that shows the role and switches it.

use egui::{
    Align, Layout, Painter, Popup, Pos2, Rect, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2,
};

use super::{LOCK_AFTER, RoleAction, UserRole};
use crate::{action::Action, frame::rail, state::State};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::focus_ring,
};

/// Draws the button with its menu.
pub(crate) fn chip(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let role = state.session.role;
    ui.with_layout(Layout::bottom_up(Align::Center), |ui| {
        let size = vec2(ui.available_width(), space::RAIL);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let colour = if response.hovered() {
            theme.text
        } else {
            theme.weak_text
        };
        let painter = ui.painter();
        let stroke = Stroke::new(1.6, colour);
        lock(painter, rect.center() - vec2(0.0, 9.0), role, stroke);
        rail::label(painter, rect, &role.title(), colour);
        focus_ring(ui, rect, &response);
        let says = match role {
            UserRole::Operator => text!("shell-operators-view"),
            UserRole::Engineer => text!("shell-engineers-view"),
        };
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &says));
        match role {
            UserRole::Operator => {
                if response.on_hover_text(text!("shell-to-engineer")).clicked() {
                    actions.push(Action::Role(RoleAction::Switch));
                }
            }
            UserRole::Engineer => {
                Popup::menu(&response).show(|ui| menu(ui, state, actions));
            }
        }
    });
}

fn menu(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    ui.set_min_width(250.0);
    let mut entry = |ui: &mut Ui, text: String, action: RoleAction| {
        if ui.button(text).clicked() {
            actions.push(Action::Role(action));
            ui.close();
        }
    };
    entry(ui, text!("shell-operators-view"), RoleAction::Switch);
    ui.separator();
    if state.roles.pin.is_none() {
        entry(ui, text!("shell-set-pin"), RoleAction::SetPin);
        let says = text!("shell-set-pin-says");
        ui.label(RichText::new(says).small().weak());
        return;
    }
    entry(ui, text!("shell-change-pin"), RoleAction::SetPin);
    entry(ui, text!("shell-remove-pin"), RoleAction::RemovePin);
    ui.separator();
    ui.label(RichText::new(text!("shell-lock-after")).font(font::heading()));
    for minutes in LOCK_AFTER {
        let is_so = state.roles.lock_after == minutes;
        if ui
            .radio(is_so, text!("shell-minutes", num = minutes))
            .clicked()
        {
            actions.push(Action::Role(RoleAction::LockAfter(minutes)));
        }
    }
}

/// Draws a padlock: closed for the operator, open for the engineer.
fn lock(painter: &Painter, centre: Pos2, role: UserRole, stroke: Stroke) {
    let at = |x: f32, y: f32| pos2(centre.x + x, centre.y + y);
    let body = Rect::from_min_max(at(-7.0, -1.0), at(7.0, 9.0));
    painter.rect_stroke(body, 1.5, stroke, StrokeKind::Middle);
    let end = match role {
        UserRole::Operator => -1.0,
        UserRole::Engineer => -4.0,
    };
    let arch = [
        at(-4.5, -1.0),
        at(-4.5, -5.0),
        at(-2.5, -8.0),
        at(2.5, -8.0),
        at(4.5, -5.0),
        at(4.5, end),
    ];
    painter.line(arch.to_vec(), stroke);
}
