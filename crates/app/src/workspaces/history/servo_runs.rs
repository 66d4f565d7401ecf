//! Runs of visual servoing in place of the inspections: the list, and the selected run with its curve.

use std::sync::Arc;

use egui::{
    Align2, RichText, ScrollArea, Sense, Ui, WidgetInfo, pos2,
    text::{LayoutJob, TextWrapping},
    vec2,
};

use super::{
    Direction, HistoryAction, HistoryState, RunsView,
    list::{DAY_AND_TIME, local_time},
};
use crate::shared::servo_curve;
use records::history::{ServoRecord, ServoRun};
use shell::{
    language::{UnitSystem, end_title, shift_and_turn, target_title},
    workspace::ShellContext,
};
use ui::{
    language::{advised, described, text},
    theme::{ROUNDING, Theme, font, space},
    user_error::UserError,
    widgets::{focus_ring, heading, line_mark, mark, path_row, row, sentence, wrapped},
};

/// Height of a row, logical pixels: a target for a gloved finger.
const ROW_HEIGHT: f32 = 40.0;
/// Height of the curve beside the list, logical pixels.
const CURVE_HEIGHT: f32 = 320.0;

impl HistoryState {
    /// Shows the runs (`true`) or the inspections.
    pub(super) fn show_runs(&mut self, are_shown: bool, cx: &ShellContext<'_>) {
        self.runs = are_shown.then(RunsView::default);
        self.look_at_run(None, cx);
    }

    /// Fetches the runs, while they are shown, with this one selected.
    pub(super) fn look_at_run(&mut self, wanted: Option<i64>, cx: &ShellContext<'_>) {
        let Some(runs) = &self.runs else {
            return;
        };
        let wanted = wanted.or_else(|| runs.selected_number());
        let filter = self.filter.clone();
        let keeper = Arc::clone(cx.services.library_cache.history());
        self.finding.start(text!("history-looking"), move |_| {
            let filter = filter.at(&geometry::clock::zoned_now());
            let found = RunsView::find(&filter, wanted, &keeper);
            Ok(Box::new(found.map_err(|error| UserError::of(&error))?))
        });
    }

    /// Selects the run above or below.
    pub(super) fn step_run(&mut self, direction: Direction, cx: &ShellContext<'_>) {
        let Some(runs) = &self.runs else {
            return;
        };
        let rows = &runs.page.rows;
        let selected = runs.selected_number();
        let at = rows.iter().position(|run| Some(run.number) == selected);
        let to = match (at, direction) {
            (None, _) => 0,
            (Some(at), Direction::Up) => at.saturating_sub(1),
            (Some(at), Direction::Down) => at + 1,
        };
        if let Some(number) = rows.get(to).map(|run| run.number) {
            self.look_at_run(Some(number), cx);
        }
    }
}

/// Draws the list.
pub(super) fn list(
    ui: &mut Ui,
    runs: &RunsView,
    units: UnitSystem,
    actions: &mut Vec<HistoryAction>,
) {
    if runs.page.rows.is_empty() {
        ui.add_space(space::LARGE);
        ui.weak(text!("servoing-no-runs-listed"));
        return;
    }
    let selected = runs.selected_number();
    ui.spacing_mut().item_spacing.y = 2.0;
    ScrollArea::vertical().auto_shrink(false).show_rows(
        ui,
        ROW_HEIGHT,
        runs.page.rows.len(),
        |ui, visible| {
            for run in &runs.page.rows[visible] {
                list_row(ui, run, selected == Some(run.number), units, actions);
            }
        },
    );
}

fn list_row(
    ui: &mut Ui,
    run: &ServoRun,
    is_selected: bool,
    units: UnitSystem,
    actions: &mut Vec<HistoryAction>,
) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), ROW_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let (sign, end) = end_title(run);
    response.widget_info(|| {
        let label = text!(
            "servoing-row",
            number = run.number.abs(),
            part = &run.title,
            end = &end
        );
        WidgetInfo::selected(egui::Role::Button, true, is_selected, label)
    });
    if response.clicked() {
        actions.push(HistoryAction::SelectRun(run.number));
    }
    if !ui.is_rect_visible(rect) {
        return;
    }
    let painter = ui.painter();
    if is_selected || response.hovered() {
        painter.rect_filled(rect, ROUNDING, theme.control);
    }
    let y = rect.center().y;
    mark(painter, pos2(rect.left() + 20.0, y), 9.0, sign, theme);
    let time = local_time(run.at, DAY_AND_TIME);
    let left = shift_and_turn(run.error_m, run.error_rad, units).unwrap_or_default();
    let right = rect.right() - 14.0;
    let on_right = |x: f32, text: String| {
        let at = pos2(x, y);
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            text,
            font::body(),
            theme.weak_text,
        );
    };
    on_right(right, time);
    on_right(right - 170.0, left);
    let title = format!("{} · {end}", run.title);
    let mut job = LayoutJob::simple_singleline(title, font::body_strong(), theme.text);
    job.wrap = TextWrapping::truncate_at_width(size.x - 40.0 - 330.0);
    let galley = painter.layout_job(job);
    let top = y - galley.size().y / 2.0;
    painter.galley(pos2(rect.left() + 40.0, top), galley, theme.text);
    focus_ring(ui, rect, &response);
}

/// Draws the selected run: how it ended, its curve, and its figures.
pub(super) fn details(ui: &mut Ui, runs: &RunsView, units: UnitSystem) {
    let theme = Theme::of(ui);
    let Some(ServoRecord { run, curve }) = &runs.selected else {
        ui.weak(text!("servoing-choose-run"));
        return;
    };
    ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.label(RichText::new(&run.title).font(font::title()));
        let (sign, end) = end_title(run);
        ui.horizontal(|ui| {
            line_mark(ui, 20.0, 9.0, sign);
            let end = RichText::new(&end).font(font::verdict());
            ui.label(end.color(sign.colour(theme)));
        });
        if run.is_simulated {
            ui.colored_label(theme.warning, sentence(&text!("enrol-origin-simulated")));
        }
        if let Some(reason) = &run.stopped {
            let why = sentence(&described(reason));
            wrapped(ui, &why, &font::body(), theme.text);
            wrapped(ui, &advised(reason), &font::body_strong(), theme.warning);
        }
        ui.add_space(space::SMALL);
        let tolerance = (run.tolerance_m, run.tolerance_rad);
        servo_curve(ui, curve, tolerance, CURVE_HEIGHT);
        let number = text!("servoing-run-number", number = run.number.abs());
        heading(ui, &number);
        ui.spacing_mut().interact_size.y = 22.0;
        row(ui, &text!("servoing-target"), &target_title(run.target));
        if let Some(left) = shift_and_turn(run.error_m, run.error_rad, units) {
            row(ui, &text!("servoing-error"), &left);
        }
        if let Some(bounds) = shift_and_turn(run.bounds_m, run.bounds_rad, units) {
            row(ui, &text!("servoing-bounds"), &bounds);
        }
        let tolerance = shift_and_turn(Some(run.tolerance_m), Some(run.tolerance_rad), units);
        row(
            ui,
            &text!("servoing-tolerance"),
            &tolerance.unwrap_or_default(),
        );
        if let Some(speed) = run.speed_m_s {
            let speed = format!("{}/s", units.length(speed));
            row(ui, &text!("servoing-speed"), &speed);
        }
        row(ui, &text!("servoing-took"), &format!("{:.1} s", run.took_s));
        row(ui, &text!("robot-title"), &run.robot);
        path_row(ui, &text!("servoing-source"), &run.source);
        row(
            ui,
            &text!("servoing-time"),
            &local_time(run.at, DAY_AND_TIME),
        );
    });
}
