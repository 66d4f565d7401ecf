//! Above the list: its filter, and what can be done with the listed inspections; and the window of the retention rule, which says
//! which frames are kept, and how long.

use egui::{Align, Button, Context, DragValue, Grid, Layout, Ui, WidgetInfo, vec2};

use crate::workspaces::history::{
    HistoryAction, HistoryFile, HistoryState,
    filter::{DateRange, ListFilter, VERDICTS, day_of, verdict_title},
};
use records::history::{ACCEPTED_KEPT, KeepFrames, Retention, Usage};
use shell::session::Session;
use ui::{
    language::{described, text},
    theme::{Theme, space},
    widgets::{
        self, labelled, line_edit, menu_button, menu_list, sentence, shortened, text_button,
    },
};

/// Draws the bar.
pub(super) fn ui(
    ui: &mut Ui,
    history: &HistoryState,
    session: &Session,
    actions: &mut Vec<HistoryAction>,
) {
    let known = &history.filter;
    let mut filter = known.clone();
    ui.horizontal_wrapped(|ui| {
        let (label, hint) = (text!("history-find"), text!("history-find-hint"));
        text_field(ui, &mut filter.text, &label, hint, 170.0);
        days(ui, &mut filter);
        if history.runs.is_none() {
            verdicts(ui, &mut filter);
        }
        parts(ui, history, session, &mut filter);
        let is_filtered = *known != ListFilter::default();
        if is_filtered && text_button(ui, &text!("history-show-all")).clicked() {
            filter = ListFilter::default();
        }
    });
    if filter.days == DateRange::Typed {
        ui.horizontal(|ui| typed(ui, &mut filter));
    }
    ui.horizontal(|ui| {
        let counted = if let Some(runs) = &history.runs {
            let (matching, count) = (runs.page.num_matching, runs.page.num_all);
            text!("servoing-runs-counted", matching = matching, count = count)
        } else {
            let (matching, count) = (history.page.num_matching, history.num_rows());
            text!("history-counted", matching = matching, count = count)
        };
        ui.weak(&counted)
            .widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &counted));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            action_buttons(ui, history, actions);
        });
    });
    if filter != *known {
        actions.push(HistoryAction::Filter(filter));
    }
}

fn action_buttons(ui: &mut Ui, history: &HistoryState, actions: &mut Vec<HistoryAction>) {
    let ways = [
        (
            text!("shell-export-csv"),
            text!("history-export-csv-hint"),
            HistoryFile::Csv,
        ),
        (
            text!("history-export-cases"),
            text!("history-export-cases-hint"),
            HistoryFile::Cases,
        ),
    ];
    // Runs become no cases.
    let are_runs = history.runs.is_some();
    for (label, says, file) in ways.into_iter().take(if are_runs { 1 } else { 2 }) {
        if text_button(ui, &label).on_hover_text(says).clicked() {
            actions.push(HistoryAction::Ask(file));
        }
    }
    let is_shown = history.statistics.is_open();
    let (label, says) = (
        text!("history-statistics"),
        text!("history-statistics-hint"),
    );
    if toggle(ui, is_shown, &label, says) {
        actions.push(HistoryAction::Statistics(!is_shown));
    }
    if are_runs || history.num_servo_runs > 0 {
        let (label, says) = (text!("servoing-runs"), text!("servoing-runs-hint"));
        if toggle(ui, are_runs, &label, says) {
            actions.push(HistoryAction::ServoRuns(!are_runs));
        }
    }
    let frames = text_button(ui, &text!("history-frames-button"));
    let says = text!("history-frames-button-hint");
    if frames.on_hover_text(says).clicked() {
        let rule = history.kept.0;
        actions.push(HistoryAction::Rule(Some(rule)));
    }
}

/// Draws a button that shows something else in place of the list; returns whether it was pressed.
fn toggle(ui: &mut Ui, is_shown: bool, label: &str, says: String) -> bool {
    let button = Button::selectable(is_shown, label).frame_when_inactive(true);
    let shown = labelled(ui, button, label);
    shown.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_shown, label));
    shown.on_hover_text(says).clicked()
}

fn text_field(ui: &mut Ui, text: &mut String, label: &str, hint: String, width: f32) {
    let field = line_edit(text, hint, width).min_size(vec2(width, space::TARGET));
    ui.add(field)
        .widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, label));
}

/// Draws a menu for one choice; `label` tells it from other menus with the same choices.
fn menu<T: PartialEq + Clone>(
    ui: &mut Ui,
    label: &str,
    chosen: &mut T,
    choices: impl Iterator<Item = (T, String)>,
) {
    let choices: Vec<_> = choices.collect();
    let now = choices.iter().find(|(choice, _)| choice == chosen);
    let now = now.map_or("", |(_, title)| title);
    let title = format!("{label} · {} ▼", shortened(now, 20));
    menu_button(ui, &title, |ui| {
        ui.set_min_width(160.0);
        menu_list(ui, |ui| {
            for (choice, title) in choices {
                let response = ui.selectable_label(*chosen == choice, &title);
                response.widget_info(|| {
                    let label = format!("{label}: {title}");
                    WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                if response.clicked() {
                    *chosen = choice;
                    ui.close();
                }
            }
        });
    });
}

fn days(ui: &mut Ui, filter: &mut ListFilter) {
    let choices = DateRange::ALL.map(|days| (days, days.title()));
    let label = text!("history-filter-days");
    menu(ui, &label, &mut filter.days, choices.into_iter());
}

fn verdicts(ui: &mut Ui, filter: &mut ListFilter) {
    let all = std::iter::once((None, text!("history-filter-all-verdicts")));
    let each = VERDICTS.map(|verdict| (Some(verdict), verdict_title(verdict)));
    let label = sentence(&text!("history-figure-verdict"));
    menu(ui, &label, &mut filter.verdict, all.chain(each));
}

fn parts(ui: &mut Ui, history: &HistoryState, session: &Session, filter: &mut ListFilter) {
    let enrolled = session.library.iter().flat_map(|library| &library.parts);
    let enrolled = enrolled.map(|part| {
        let name = part.name.as_str().to_owned();
        (Some(name), part.shown_title().to_owned())
    });
    let is_enrolled = |name: &str| {
        let library = session.library.as_ref();
        library.is_some_and(|library| library.index_of(name).is_some())
    };
    // Those of another library, or removed from this one.
    let others = history.parts.iter().flatten();
    let others = others.filter(|(name, _)| !is_enrolled(name));
    let others = others.map(|(name, title)| (Some(name.clone()), title.clone()));
    let all = std::iter::once((None, text!("history-filter-all-parts")));
    let label = text!("shell-part");
    let choices = all.chain(enrolled).chain(others);
    menu(ui, &label, &mut filter.part, choices);
}

/// Draws the fields for the first and the last day.
fn typed(ui: &mut Ui, filter: &mut ListFilter) {
    let theme = Theme::of(ui);
    let fields = [
        (text!("history-from"), text!("history-first-day")),
        (text!("history-to"), text!("history-last-day")),
    ];
    for (text, (word, label)) in filter.typed.iter_mut().zip(fields) {
        ui.weak(word);
        text_field(ui, text, &label, "2026-11-20".to_owned(), 110.0);
    }
    if filter.typed.iter().any(|text| day_of(text).is_err()) {
        ui.colored_label(theme.warning, text!("history-day-format"));
    }
}

/// Draws the window while it is open.
pub(super) fn retention_rule(
    ctx: &Context,
    history: &HistoryState,
    actions: &mut Vec<HistoryAction>,
) {
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
