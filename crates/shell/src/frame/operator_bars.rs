//! The bars above and below the operator's view: the parts of this shift, the running work, and the operator's few controls.

use egui::{Align, Button, Frame, Layout, Margin, Panel, RichText, Ui, WidgetInfo, vec2};

use super::top_bar::{Progress, language_menu, progress};
use crate::{
    action::Action,
    cell::{self, RobotCell},
    roles::RoleAction,
    session::{Session, ShiftParts, WorkspaceKind},
    source::{
        live::{self, LiveAction},
        source_menu,
    },
    state::State,
};
use ui::{
    language::{keys, text},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, by_width, labelled, line_mark, shortened, text_button},
};

/// Height of the lower bar, logical pixels.
pub(crate) const LOWER: f32 = 76.0;
/// Height of its buttons, logical pixels.
const BUTTON: f32 = 52.0;
/// Width of the column beside the picture in a wide and in a narrow window, logical pixels.
pub const COLUMN: [f32; 2] = [400.0, 320.0];

/// Returns the width of the column beside the picture in a window of this width.
pub fn column_width(window: f32) -> f32 {
    by_width(window, COLUMN)
}

/// Draws both bars.
pub fn ui(
    ui: &mut Ui,
    state: &State,
    robot: &RobotCell,
    work: Option<Progress>,
    actions: &mut Vec<Action>,
) {
    let theme = Theme::of(ui);
    let frame = Frame::new()
        .fill(theme.panel)
        .inner_margin(Margin::symmetric(14, 0));
    Panel::top("operator's upper bar")
        .exact_size(space::TOP_BAR)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| upper(ui, state, robot, work, actions));
        });
    Panel::bottom("operator's lower bar")
        .exact_size(LOWER)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| lower(ui, state, actions));
        });
}

fn upper(
    ui: &mut Ui,
    state: &State,
    robot: &RobotCell,
    work: Option<Progress>,
    actions: &mut Vec<Action>,
) {
    ui.label(RichText::new("Partsight").font(font::body_strong()));
    ui.add_space(space::LARGE);
    // Otherwise the row would be as high as the bar.
    ui.horizontal(|ui| counts(ui, &state.session.shift));
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let key = RichText::new(keys("Ctrl K")).small();
        let name = text!("shell-engineers-view");
        let engineer = Button::new(&*name).shortcut_text(key.weak());
        let says = match state.roles.pin {
            Some(_) => text!("operator-locked-says"),
            None => text!("shell-to-engineer"),
        };
        if labelled(ui, engineer, &name).on_hover_text(says).clicked() {
            actions.push(Action::Role(RoleAction::Switch));
        }
        let history = WorkspaceKind::History.title();
        if text_button(ui, &history)
            .on_hover_text(text!("operator-history-says"))
            .clicked()
        {
            actions.push(Action::GoTo(WorkspaceKind::History));
        }
        language_menu(ui, state, actions);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let session = &state.session;
            not_recorded(ui, session);
            cell::chip(
                ui,
                robot,
                session,
                work.is_some() || session.is_history_failing,
            );
            progress(ui, state, work, actions);
        });
    });
}

/// Draws whether inspections cannot be written.
fn not_recorded(ui: &mut Ui, session: &Session) {
    if session.is_history_failing {
        let theme = Theme::of(ui);
        line_mark(ui, 16.0, 8.0, Mark::Look);
        let text = RichText::new(text!("operator-not-recorded")).color(theme.warning);
        let label = ui.add(egui::Label::new(text).truncate());
        label.on_hover_text(text!("operator-not-recorded-says"));
    }
}

/// Draws the number of parts of this shift before its source, and how many were accepted.
fn counts(ui: &mut Ui, shift: &ShiftParts) {
    let theme = Theme::of(ui);
    let (Some(since), Some(source)) = (&shift.since, &shift.source) else {
        return;
    };
    let since = text!(
        "operator-shift-since",
        time = since.strftime("%H:%M").to_string()
    );
    let source = shortened(&source_menu::now(source), 20);
    let label = RichText::new(format!("{since}\n{source}")).small().weak();
    ui.label(label).on_hover_text(text!("operator-shift-says"));
    let num = shift.num_ok + shift.num_not_ok;
    let chips = [
        (None, text!("operator-num-parts", num = num)),
        (
            Some(Mark::Good),
            text!("operator-num-ok", num = shift.num_ok),
        ),
        (
            Some(Mark::Bad),
            text!("operator-num-not-ok", num = shift.num_not_ok),
        ),
    ];
    for (sign, text) in chips {
        let chip = Frame::new()
            .fill(theme.control)
            .stroke(theme.edge_stroke())
            .corner_radius(ROUNDING)
            .inner_margin(Margin::symmetric(10, 5))
            .show(ui, |ui| {
                ui.spacing_mut().interact_size.y = 0.0;
                if let Some(sign) = sign {
                    line_mark(ui, 16.0, 8.0, sign);
                }
                ui.label(RichText::new(text).font(font::body_strong()));
            });
        chip.response.on_hover_text(text!("operator-shift-says"));
    }
}

fn lower(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let text = |text: &str| RichText::new(text).font(font::verdict());
    let key = |text: &str| RichText::new(text).small();
    let is_live = state.session.is_live();
    let (name, space) = (text!("shell-capture"), keys("Space"));
    // The accent marks the next button to press; while a source is followed, there is none.
    let capture = if is_live {
        Button::new(text(&name)).shortcut_text(key(&space).weak())
    } else {
        Button::new(text(&name).color(theme.on_accent))
            .shortcut_text(key(&space).color(theme.on_accent))
            .fill(theme.accent)
    };
    let capture = ui.add(capture.min_size(vec2(200.0, BUTTON)));
    capture.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
    if capture.clicked() {
        actions.push(Action::Capture);
    }
    let [strong, weak] = if is_live {
        [theme.on_accent; 2]
    } else {
        [theme.text, theme.weak_text]
    };
    let follow = text!("shell-live");
    let live = Button::selectable(is_live, text(&follow).color(strong))
        .frame_when_inactive(true)
        .shortcut_text(key("L").color(weak))
        .min_size(vec2(110.0, BUTTON));
    let live = ui.add(live);
    live.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_live, &follow));
    let says = if is_live {
        text!("operator-stop-live-says")
    } else {
        text!("operator-live-says")
    };
    if live.on_hover_text(says).clicked() {
        actions.push(Action::Live(LiveAction::Toggle));
    }
    let name = text!("operator-wrong-part");
    let wrong = Button::new(text(&name)).min_size(vec2(150.0, BUTTON));
    // While the part moves, it may be another one.
    let is_current = state.session.current_result().is_some();
    let wrong = ui.add_enabled(is_current, wrong);
    wrong.widget_info(|| WidgetInfo::labeled(egui::Role::Button, is_current, &name));
    if wrong
        .on_hover_text(text!("operator-wrong-part-says"))
        .on_disabled_hover_text(text!("operator-wrong-part-not-now"))
        .clicked()
    {
        actions.push(Action::WrongPart);
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        source(ui, &state.session);
    });
}

/// Draws the source, and whether frames arrive.
fn source(ui: &mut Ui, session: &Session) {
    let text = |text: String| egui::Label::new(RichText::new(text).weak());
    if session.is_live() {
        let (sign, words) = live::words(session);
        ui.add(text(words).truncate());
        line_mark(ui, 16.0, 8.0, sign);
    } else {
        let source = text!(
            "operator-source",
            source = source_menu::now(&session.source)
        );
        ui.add(text(source).truncate());
    }
}
