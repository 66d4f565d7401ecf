//! On the right: Table I, and how far the shown methods ended from the truth.

use std::{fmt::Write as _, time::Duration};

use egui::{
    Align, Align2, Button, Layout, Painter, Pos2, Rect, RichText, ScrollArea, Sense, Shape, Stroke,
    Ui, pos2, vec2,
};

use super::{AlignAction, AlignFile, AlignState, Start, TableRow, plot};
use shell::session::Session;
use stages::pose::{PoseMethod, Uncertainty};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    widgets::{focus_ring, heading, labelled},
};

/// Largest width of a column of numbers, logical pixels.
const MAX_COLUMN_WIDTH_PX: f32 = 88.0;
/// Width of the names on the left, logical pixels.
const NAMES_WIDTH_PX: f32 = 44.0;
/// Height of a part's name above its rows, logical pixels.
const PART_HEIGHT_PX: f32 = 26.0;

/// State kept between frames: the number of rows seen, to scroll to new ones.
#[derive(Default)]
pub(super) struct SidePanel {
    num_seen: usize,
}

impl SidePanel {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        align: &AlignState,
        session: &Session,
        actions: &mut Vec<AlignAction>,
    ) {
        let table = &align.table;
        ui.heading(text!("align-table"));
        let is_at_work = align.is_table_at_work();
        progress(ui, align, session, actions);
        egui::Panel::bottom("true error")
            .resizable(false)
            .show_separator_line(false)
            .frame(egui::Frame::new())
            .show(ui, |ui| {
                true_error(ui, align, session);
                if !table.rows.is_empty() {
                    ui.add_space(space::MEDIUM);
                    export(ui, actions);
                }
            });
        if table.rows.is_empty() {
            ui.add_space(space::MEDIUM);
            ui.weak(text!("align-table-says"));
            self.num_seen = 0;
            return;
        }
        header(ui);
        let has_new = table.rows.len() != self.num_seen;
        self.num_seen = table.rows.len();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            rows(ui, align, session, actions);
            if is_at_work && has_new {
                ui.scroll_to_cursor(Some(Align::BOTTOM));
            }
        });
    }
}

/// Draws the progress of the table, and the buttons to start, continue or cancel it.
fn progress(ui: &mut Ui, align: &AlignState, session: &Session, actions: &mut Vec<AlignAction>) {
    let theme = Theme::of(ui);
    let table = &align.table;
    let num_parts = session
        .library
        .as_ref()
        .map_or(0, |library| library.parts.len());
    let total = num_parts * Start::NUM_PAPER;
    let num = table.rows.len();
    let is_at_work = align.is_table_at_work();
    let progress = if is_at_work {
        going(num, total, table.remaining(total))
    } else {
        standing(num, total)
    };
    ui.horizontal(|ui| {
        ui.label(RichText::new(progress).small().weak());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if is_at_work {
                let label = text!("align-cancel-table");
                if labelled(ui, Button::new(text!("shell-cancel")), &label).clicked() {
                    actions.push(AlignAction::Cancel);
                }
                return;
            }
            let (text, label, action) = if num == 0 {
                let text = text!("align-run-table");
                (text.clone(), text, AlignAction::RunTable)
            } else if num < total {
                (
                    text!("align-go-on"),
                    text!("align-go-on-table"),
                    AlignAction::RunTable,
                )
            } else {
                (
                    text!("align-again"),
                    text!("align-table-again"),
                    AlignAction::RestartTable,
                )
            };
            let button = ui.add_enabled_ui(total > 0, |ui| labelled(ui, Button::new(text), &label));
            let no_part = match &session.library {
                None => text!("shell-library-loading"),
                Some(library) if library.unloaded.is_some() => text!("align-library-failed"),
                Some(_) => text!("align-library-has-no-part"),
            };
            if button.inner.on_disabled_hover_text(no_part).clicked() {
                actions.push(action);
            }
        });
    });
    if num > 0 || is_at_work {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 8.0), Sense::hover());
        let share = num as f32 / total.max(1) as f32;
        let done = Rect::from_min_size(rect.min, vec2(rect.width() * share.min(1.0), 8.0));
        ui.painter().rect_filled(rect, ROUNDING, theme.track);
        ui.painter().rect_filled(done, ROUNDING, theme.accent);
    }
}

/// Progress while rows are being added, in words.
fn going(num: usize, total: usize, remaining: Option<Duration>) -> String {
    match remaining {
        Some(time) => {
            let time = shortly(time);
            text!(
                "align-rows-done-left",
                done = num,
                total = total,
                time = time
            )
        }
        None => text!("align-rows-done", done = num, total = total),
    }
}

/// Progress while the table is not at work, in words.
fn standing(num: usize, total: usize) -> String {
    match num {
        0 => text!("align-rows", total = total),
        num if num < total => text!("align-rows-stopped", done = num, total = total),
        _ => text!("align-rows-all", total = total),
    }
}

fn shortly(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..=99 => format!("{} s", seconds + 1),
        seconds => format!("{} min", seconds.div_ceil(60)),
    }
}

/// Number and right edge of each column, from left to right.
fn columns(rect: Rect) -> impl Iterator<Item = (usize, f32)> {
    let num = PoseMethod::ALL.len();
    let width = ((rect.width() - NAMES_WIDTH_PX) / num as f32).min(MAX_COLUMN_WIDTH_PX);
    (0..num).map(move |index| {
        let right = rect.right() - 8.0;
        (index, right - width * (num - 1 - index) as f32)
    })
}

fn header(ui: &mut Ui) {
    let theme = Theme::of(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 22.0), Sense::hover());
    let painter = ui.painter();
    let write = |x: f32, anchor: Align2, text: &str| {
        let at = pos2(x, rect.center().y);
        painter.text(at, anchor, text, font::small(), theme.weak_text);
    };
    write(
        rect.left(),
        Align2::LEFT_CENTER,
        &text!("align-column-part"),
    );
    for (index, x) in columns(rect) {
        write(
            x,
            Align2::RIGHT_CENTER,
            &plot::method_title(PoseMethod::ALL[index]),
        );
    }
}

fn rows(ui: &mut Ui, align: &AlignState, session: &Session, actions: &mut Vec<AlignAction>) {
    let theme = Theme::of(ui);
    let mut part = "";
    for (index, row) in align.table.rows.iter().enumerate() {
        if row.part != part {
            part = &row.part;
            let (rect, _) =
                ui.allocate_exact_size(vec2(ui.available_width(), PART_HEIGHT_PX), Sense::hover());
            let at = rect.left_bottom() - vec2(0.0, 4.0);
            let painter = ui.painter();
            painter.text(
                at,
                Align2::LEFT_BOTTOM,
                &row.title,
                font::body_strong(),
                theme.text,
            );
        }
        let size = vec2(ui.available_width(), space::TARGET);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let is_chosen = align.chosen_part(session) == Some(row.part.as_str())
            && align.start == Start::Paper(row.start);
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, spoken(row))
        });
        if response.hovered() || is_chosen {
            ui.painter().rect_filled(rect, ROUNDING, theme.control);
        }
        paint_row(ui.painter(), rect, row, theme);
        focus_ring(ui, rect, &response);
        if response.clicked() {
            actions.push(AlignAction::OpenRow(index));
        }
    }
}

fn paint_row(painter: &Painter, rect: Rect, row: &TableRow, theme: &Theme) {
    let y = rect.center().y;
    let at = pos2(rect.left() + 8.0, y);
    let start = Start::Paper(row.start).title();
    painter.text(
        at,
        Align2::LEFT_CENTER,
        start,
        font::body(),
        theme.weak_text,
    );
    for ((index, x), cell) in columns(rect).zip(&row.cells) {
        let (text, font, colour) = match (&cell.figures, row.is_best(index)) {
            (Ok(figures), true) => (short(figures.e_m2), font::body_strong(), theme.accepted),
            (Ok(figures), false) => (short(figures.e_m2), font::body(), theme.text),
            (Err(_), _) => (text!("align-none"), font::body(), theme.rejected),
        };
        let written = painter.text(pos2(x, y), Align2::RIGHT_CENTER, text, font, colour);
        if row.is_best(index) {
            tick(
                painter,
                written.left_center() - vec2(9.0, 0.0),
                Stroke::new(1.8, colour),
            );
        }
    }
}

/// Draws a tick, the mark of the best result.
fn tick(painter: &Painter, centre: Pos2, stroke: Stroke) {
    let at = |x: f32, y: f32| centre + vec2(x, y);
    let corners = vec![at(-4.0, 0.0), at(-1.0, 3.5), at(4.5, -4.0)];
    painter.add(Shape::line(corners, stroke));
}

/// Formats a small number briefly: "2.0e-3".
fn short(value: f64) -> String {
    format!("{value:.1e}")
}

/// Describes a row for a screen reader.
fn spoken(row: &TableRow) -> String {
    let mut text = format!("{}, {}", row.title, Start::Paper(row.start).title());
    for (index, cell) in row.cells.iter().enumerate() {
        let name = plot::method_title(cell.method);
        let best = if row.is_best(index) {
            format!(", {}", text!("align-best"))
        } else {
            String::new()
        };
        let _ = match &cell.figures {
            Ok(figures) => write!(text, "; {name} {}{best}", short(figures.e_m2)),
            Err(_) => write!(text, "; {name} {}", text!("align-no-pose")),
        };
    }
    text
}

/// Draws the errors of the shown methods, or their bounds where the truth is not known.
fn true_error(ui: &mut Ui, align: &AlignState, session: &Session) {
    let theme = Theme::of(ui);
    let Some(shown) = &align.shown else {
        return;
    };
    let is_known = shown.pair.truth.is_some();
    let title = if is_known {
        text!("align-true-error")
    } else {
        text!("align-uncertainty")
    };
    let titled = ui.scope(|ui| heading(ui, &title)).response;
    if !is_known {
        titled.on_hover_text(text!("align-uncertainty-says"));
    }
    ui.spacing_mut().interact_size.y = 20.0;
    let line = |ui: &mut Ui, name: RichText, turn: RichText, shift: RichText| {
        ui.horizontal(|ui| {
            ui.label(name);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let size = vec2(92.0, 20.0);
                let right = Layout::right_to_left(Align::Center);
                ui.allocate_ui_with_layout(size, right, |ui| {
                    ui.set_min_size(size);
                    ui.label(shift);
                });
                ui.label(turn);
            });
        });
    };
    let weak = |text: String| RichText::new(text).small().weak();
    let names = [
        text!("align-method"),
        text!("align-rotation"),
        text!("align-shift"),
    ];
    let [method, rotation, shift] = names.map(weak);
    line(ui, method, rotation, shift);
    for run in &shown.runs {
        let colour = plot::method_colour(run.method, theme);
        let name = RichText::new(plot::method_title(run.method)).color(colour);
        let off = run.track.as_ref().map(|track| match track.true_error {
            Some(error) => Some((error.rotation.0, error.shift.0)),
            None => track
                .uncertainty
                .filter(Uncertainty::is_held)
                .map(|bounds| (bounds.turn.0, bounds.shift.0)),
        });
        let (turn, shift) = match off {
            Ok(Some((turn, shift))) => (session.units.angle(turn), session.units.length(shift)),
            Ok(None) => (text!("align-unconstrained"), String::new()),
            Err(_) => (text!("align-no-pose"), String::new()),
        };
        let text = |text: String| RichText::new(text);
        line(ui, name, text(turn), text(shift));
    }
}

fn export(ui: &mut Ui, actions: &mut Vec<AlignAction>) {
    let theme = Theme::of(ui);
    ui.horizontal(|ui| {
        let width = ui.available_width() - 90.0;
        let text = RichText::new(text!("shell-export-csv")).font(font::body_strong());
        let button = Button::new(text.color(theme.on_accent)).fill(theme.accent);
        if ui
            .add(button.min_size(vec2(width, space::TARGET)))
            .clicked()
        {
            actions.push(AlignAction::Ask(AlignFile::TableFile));
        }
        let copy =
            Button::new(text!("align-copy")).min_size(vec2(ui.available_width(), space::TARGET));
        if ui
            .add(copy)
            .on_hover_text(text!("align-copy-hint"))
            .clicked()
        {
            actions.push(AlignAction::CopyTable);
        }
    });
}
