//! The window of the retention rule: which frames are kept, and how long.

use egui::{Button, Context, DragValue, Grid, Ui, WidgetInfo, vec2};

use super::{HistoryAction, HistoryState};
use records::history::{ACCEPTED_KEPT, KeepFrames, Retention, Usage};
use ui::{
    language::{described, text},
    theme::space,
    widgets::{self, labelled, text_button},
};

/// Draws the window while it is open.
pub(super) fn ui(ctx: &Context, history: &HistoryState, actions: &mut Vec<HistoryAction>) {
    let Some(known) = history.rule else {
        return;
    };
    let mut rule = known;
    let modal = widgets::dialog(ctx, "frames that are kept", |ui| {
        ui.set_max_width(520.0);
        ui.heading(text!("history-keep-title"));
        ui.add_space(space::SMALL);
        ui.weak(text!("history-keep-why", num = ACCEPTED_KEPT));
        ui.add_space(space::SMALL);
        Grid::new("frames")
            .num_columns(2)
            .spacing(vec2(20.0, 8.0))
            .show(ui, |ui| rows(ui, &mut rule));
        ui.add_space(space::SMALL);
        used(ui, history.kept.1);
        ui.add_space(space::MEDIUM);
        let mut closing = None;
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-apply"), true) {
                closing = Some(true);
            }
            if text_button(ui, &text!("shell-close")).clicked() {
                closing = Some(false);
            }
        });
        closing
    });
    let is_closed = modal.should_close();
    let action = match modal.inner {
        Some(true) => HistoryAction::Keep(rule),
        Some(false) => HistoryAction::Rule(None),
        None if is_closed => HistoryAction::Rule(None),
        None if rule != known => HistoryAction::Rule(Some(rule)),
        None => return,
    };
    actions.push(action);
}

fn rows(ui: &mut Ui, rule: &mut Retention) {
    ui.label(text!("history-keep-which"));
    ui.horizontal(|ui| {
        for keep in KeepFrames::ALL {
            let title = described(&keep);
            let button = Button::selectable(rule.keep == keep, &title);
            let button = button.frame_when_inactive(true);
            if labelled(ui, button, &title).clicked() {
                rule.keep = keep;
            }
        }
    });
    ui.end_row();
    let label = text!("history-keep-days");
    ui.label(&label);
    let days = DragValue::new(&mut rule.max_days).range(Retention::DAYS);
    number(ui, days, &label);
    ui.end_row();
    let label = text!("history-keep-gigabytes");
    ui.label(&label);
    let gigabytes = DragValue::new(&mut rule.max_gigabytes)
        .range(Retention::GIGABYTES)
        .speed(0.1);
    number(ui, gigabytes, &label);
    ui.end_row();
}

fn number(ui: &mut Ui, value: DragValue<'_>, label: &str) {
    let response = ui.add_sized(vec2(110.0, space::TARGET), value);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::SpinButton, true, label));
}

fn used(ui: &mut Ui, usage: Usage) {
    let gigabytes = |bytes: u64| format!("{:.2} GB", bytes as f64 / 1e9);
    ui.label(text!(
        "history-keep-used",
        count = usage.num_frames,
        size = gigabytes(usage.num_bytes),
    ));
    ui.weak(text!(
        "history-keep-marked",
        size = gigabytes(usage.num_bytes_marked)
    ));
}
