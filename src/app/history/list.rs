//! The list of past inspections, and what it shows of them.

use egui::{
    Align, Align2, Button, Layout, Painter, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, Vec2,
    pos2, vec2,
};

use super::{HistoryAction, HistoryFilter, HistoryState, PastInspection, PastVerdict};
use crate::app::{
    action::{Action, Ask},
    bars::{focus_ring, labelled},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, mark},
};

/// In more width than this all choices of the filter stand side by side, logical pixels.
const WIDE: f32 = 520.0;
/// Height of a row: a target for a gloved finger.
const ROW: f32 = 40.0;

pub(super) fn ui(ui: &mut Ui, history: &HistoryState, theme: &Theme, actions: &mut Vec<Action>) {
    bar(ui, history, actions);
    ui.add_space(space::SMALL);
    let columns = Columns::across(ui.available_width());
    head(ui, history, &columns, theme);
    let listed = history.listed();
    if listed.is_empty() {
        ui.add_space(space::LARGE);
        let text = "No inspection is like this: change the filter";
        ui.label(RichText::new(text).color(theme.weak_text));
        return;
    }
    ui.spacing_mut().item_spacing.y = 2.0;
    ScrollArea::vertical()
        .auto_shrink(false)
        .show_rows(ui, ROW, listed.len(), |ui, visible| {
            let visible = listed.get(visible).unwrap_or_default();
            for past in visible.iter().filter_map(|number| history.row(*number)) {
                row(ui, past, history.selected, &columns, theme, actions);
            }
        });
}

/// What to list, and what to do with it.
fn bar(ui: &mut Ui, history: &HistoryState, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let filter = &history.filter;
        let mut text = filter.text.clone();
        let field = TextEdit::singleline(&mut text)
            .hint_text("Part or scene")
            .desired_width(180.0)
            .min_size(vec2(180.0, space::TARGET))
            .align(egui::Align2::LEFT_CENTER);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Find"));
        if field.changed() {
            let verdict = filter.verdict;
            actions.push(Action::History(HistoryAction::Filter(HistoryFilter {
                text,
                verdict,
            })));
        }
        let is_wide = ui.available_width() > WIDE;
        if is_wide {
            verdicts(ui, filter, actions);
        } else {
            let now = filter.verdict.map_or("All", PastVerdict::title);
            ui.menu_button(format!("Verdict · {now} ▼"), |ui| {
                verdicts(ui, filter, actions);
            });
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if labelled(ui, Button::new("Export CSV…"), "Export CSV…").clicked() {
                actions.push(Action::Ask(Ask::HistoryCsv));
            }
        });
    });
}

/// Which verdicts to list.
fn verdicts(ui: &mut Ui, filter: &HistoryFilter, actions: &mut Vec<Action>) {
    for choice in std::iter::once(None).chain(PastVerdict::ALL.map(Some)) {
        let title = choice.map_or("All", PastVerdict::title);
        let button = Button::selectable(filter.verdict == choice, title);
        if ui
            .add(button.min_size(Vec2::splat(space::TARGET)))
            .clicked()
        {
            let text = filter.text.clone();
            let filter = HistoryFilter {
                text,
                verdict: choice,
            };
            actions.push(Action::History(HistoryAction::Filter(filter)));
        }
    }
}

/// Where the columns lie, from the left edge of the list.
struct Columns {
    part: f32,
    scene: f32,
    /// Right edges.
    score: f32,
    time: f32,
    when: f32,
}

impl Columns {
    fn across(width: f32) -> Self {
        let when = width - 14.0;
        let time = when - 84.0;
        let score = time - 84.0;
        let part = 40.0;
        Self {
            part,
            scene: part + (score - 60.0 - part) * 0.5,
            score,
            time,
            when,
        }
    }
}

fn head(ui: &mut Ui, history: &HistoryState, columns: &Columns, theme: &Theme) {
    let size = vec2(ui.available_width(), 22.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let count = format!("{} of {}", history.listed().len(), history.num_rows());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &count));
    let painter = ui.painter();
    let text = |x: f32, anchor: Align2, text: &str| {
        let at = pos2(rect.left() + x, rect.center().y);
        painter.text(at, anchor, text, font::heading(), theme.weak_text);
    };
    text(
        columns.part,
        Align2::LEFT_CENTER,
        &format!("Part · {count}"),
    );
    text(columns.scene, Align2::LEFT_CENTER, "Scene");
    text(columns.score, Align2::RIGHT_CENTER, "Score");
    text(columns.time, Align2::RIGHT_CENTER, "ms");
    text(columns.when, Align2::RIGHT_CENTER, "Time of day");
}

fn row(
    ui: &mut Ui,
    past: &PastInspection,
    selected: Option<u64>,
    columns: &Columns,
    theme: &Theme,
    actions: &mut Vec<Action>,
) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let is_selected = selected == Some(past.number);
    response.widget_info(|| {
        let verdict = past.verdict.title();
        let label = format!("Inspection {}: {}, {verdict}", past.number, past.title);
        egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, label)
    });
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        if is_selected || response.hovered() {
            painter.rect_filled(rect, ROUNDING, theme.control);
        }
        paint(painter, rect, past, columns, theme);
        focus_ring(ui, rect, &response, theme);
    }
    if response.clicked() {
        actions.push(Action::History(HistoryAction::Select(past.number)));
    }
    if response.double_clicked() {
        actions.push(Action::History(HistoryAction::Open(past.number)));
    }
}

fn paint(painter: &Painter, rect: Rect, past: &PastInspection, columns: &Columns, theme: &Theme) {
    let y = rect.center().y;
    let sign = match past.verdict {
        PastVerdict::Accepted => Mark::Good,
        PastVerdict::NotAccepted | PastVerdict::NoPart => Mark::Bad,
    };
    mark(painter, pos2(rect.left() + 20.0, y), 9.0, sign, theme);
    let left = |from: f32, to: f32, text: &str, font, colour| {
        let clip = Rect::from_x_y_ranges(
            rect.left() + from..=rect.left() + to - space::SMALL,
            rect.y_range(),
        );
        painter
            .with_clip_rect(clip.intersect(painter.clip_rect()))
            .text(
                pos2(rect.left() + from, y),
                Align2::LEFT_CENTER,
                text,
                font,
                colour,
            );
    };
    left(
        columns.part,
        columns.scene,
        &past.title,
        font::body_strong(),
        theme.text,
    );
    left(
        columns.scene,
        columns.score - 50.0,
        &past.scene,
        font::body(),
        theme.weak_text,
    );
    let right = |x: f32, text: &str, colour| {
        let at = pos2(rect.left() + x, y);
        painter.text(at, Align2::RIGHT_CENTER, text, font::body(), colour);
    };
    let [_, time] = &past.when;
    right(columns.score, &past.score_text, theme.text);
    right(columns.time, &past.time_text, theme.weak_text);
    right(columns.when, time, theme.weak_text);
}
