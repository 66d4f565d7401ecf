//! The rail on the left: the workspaces, of which the operator sees only theirs, and at its foot the button that shows the role and
//! switches it.

use egui::{
    Align, Color32, Layout, Margin, Painter, Panel, Popup, Pos2, Rect, RichText, Sense, Stroke,
    StrokeKind, Ui, pos2, vec2,
};

use crate::{
    action::Action,
    roles::{LOCK_AFTER, RoleAction, UserRole, is_operators},
    session::WorkspaceKind,
    state::State,
};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::{fixed_panel, focus_ring, pad_entries},
};

/// Draws the rail.
pub fn ui(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let panel = Panel::left("rail").exact_size(space::RAIL);
    fixed_panel(ui, panel, Margin::ZERO, |ui| {
        // The keys of the other workspaces still work and ask for the engineer's view.
        let is_engineer = state.session.role == UserRole::Engineer;
        let listed = |workspace: &WorkspaceKind| is_engineer || is_operators(*workspace);
        for workspace in WorkspaceKind::ALL.into_iter().filter(listed) {
            let is_front = state.session.workspace == workspace;
            let size = vec2(ui.available_width(), space::RAIL);
            let (rect, response) = ui.allocate_exact_size(size, Sense::click());
            let painter = ui.painter();
            if is_front {
                painter.rect_filled(rect, 0.0, theme.control);
                let bar = Rect::from_min_size(rect.min, vec2(3.0, rect.height()));
                painter.rect_filled(bar, 0.0, theme.accent);
            }
            let colour = if is_front {
                theme.text
            } else {
                theme.weak_text
            };
            let icon = rect.center() - vec2(0.0, 9.0);
            sign(painter, workspace, icon, Stroke::new(1.6, colour));
            label(painter, rect, &workspace.title(), colour);
            focus_ring(ui, rect, &response);
            response.widget_info(|| {
                let label = workspace.title();
                egui::WidgetInfo::selected(egui::Role::Tab, true, is_front, label)
            });
            if response.clicked() {
                actions.push(Action::GoTo(workspace));
            }
        }
        role_button(ui, state, actions);
    });
}

/// Draws a name below a sign, in a smaller font if it is too long.
fn label(painter: &Painter, rect: Rect, name: &str, colour: Color32) {
    let laid_out = |font| painter.layout_no_wrap(name.to_owned(), font, colour);
    let mut galley = laid_out(font::small());
    if galley.size().x > rect.width() - space::SMALL {
        galley = laid_out(font::scale());
    }
    let at = rect.center() + vec2(0.0, 14.0) - galley.size() / 2.0;
    painter.galley(at, galley, colour);
}

/// Draws the sign of a workspace.
fn sign(painter: &Painter, workspace: WorkspaceKind, centre: Pos2, stroke: Stroke) {
    let at = |x: f32, y: f32| pos2(centre.x + x, centre.y + y);
    match workspace {
        WorkspaceKind::Inspect => {
            painter.circle_stroke(centre, 8.0, stroke);
            painter.circle_filled(centre, 2.4, stroke.color);
        }
        WorkspaceKind::Enrol => {
            painter.line_segment([at(-7.0, 0.0), at(7.0, 0.0)], stroke);
            painter.line_segment([at(0.0, -7.0), at(0.0, 7.0)], stroke);
        }
        WorkspaceKind::Compare => {
            let frame = Rect::from_center_size(centre, vec2(16.0, 12.0));
            painter.rect_stroke(frame, 1.0, stroke, egui::StrokeKind::Middle);
            painter.line_segment([at(0.0, -6.0), at(0.0, 6.0)], stroke);
        }
        WorkspaceKind::Align => {
            let corners = [at(-8.0, 5.0), at(-3.0, -7.0), at(8.0, -4.0), at(3.0, 7.0)];
            painter.add(egui::Shape::closed_line(corners.to_vec(), stroke));
        }
        WorkspaceKind::Paint => {
            for y in [-5.0, 0.0, 5.0] {
                let wave = (-8_i8..=8).map(f32::from);
                let wave = wave.map(|x| at(x, y + 1.6 * (x * 0.6).sin()));
                painter.line(wave.collect(), stroke);
            }
        }
        WorkspaceKind::Servo => {
            for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                let corner = |dx: f32, dy: f32| at(x * (8.0 - dx), y * (7.0 - dy));
                let bracket = vec![corner(4.0, 0.0), corner(0.0, 0.0), corner(0.0, 4.0)];
                painter.line(bracket, stroke);
            }
            painter.circle_filled(centre, 2.4, stroke.color);
        }
        WorkspaceKind::History => {
            for y in [-6.0, 0.0, 6.0] {
                painter.line_segment([at(-8.0, y), at(8.0, y)], stroke);
            }
        }
    }
}

/// Draws the button with its menu.
fn role_button(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
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
        label(painter, rect, &role.title(), colour);
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
                Popup::menu(&response).show(|ui| role_menu(ui, state, actions));
            }
        }
    });
}

fn role_menu(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    pad_entries(ui);
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
