//! The kept cases: a list before the first run, then the confusion matrix with its plots, the cases of one cell, or the changes
//! since an earlier run.

use std::f32::consts::FRAC_PI_2;

use egui::{
    Align, Align2, Button, Layout, Rect, RichText, ScrollArea, Sense, Shape, Stroke, StrokeKind,
    Ui, Vec2, WidgetInfo, epaint::TextShape, pos2, vec2,
};

use crate::workspaces::compare::{
    CaseRun, CompareAction, CompareFile, CompareState, RunChanges,
    matrix::{Matrix, MatrixCell, column_title, row_title},
    score_plots,
};
use records::cases::{CaseAnswer, CaseChange, CaseOutcome, FoundVerdict, KeptCase};
use shell::{inspection::library_cache::LibraryView, session::Session};
use ui::{
    language::{described, text},
    theme::{ROUNDING, Theme, font, space},
    user_error::UserError,
    widgets::{focus_ring, labelled, shortened, show_scroll_bar, text_button},
};

/// Width of the rows' names, and what they are left in a narrow window, logical pixels.
const NAMES_WIDTH_PX: f32 = 118.0;
const NARROW_NAMES_WIDTH_PX: f32 = 68.0;
/// Width of a letter of these names, logical pixels.
const LETTER_WIDTH_PX: f32 = 6.9;
/// Height of the columns' names where the columns are narrow.
const UPRIGHT_NAME_HEIGHT_PX: f32 = 104.0;
/// Least width of a column.
const NARROWEST: f32 = space::TARGET + 2.0;
/// A column wider than this has its name written across.
const WIDE_COLUMN_PX: f32 = 110.0;

pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    header(ui, compare, session, acts);
    let listed = compare.cases.as_ref();
    let cases = listed.map(|cases| &*cases.list);
    let Some(cases) = cases.filter(|cases| !cases.is_empty()) else {
        let text = match (cases, compare.folder.as_deref()) {
            (None, _) => text!("compare-looking"),
            (Some(_), Some(folder)) => {
                text!("compare-no-cases-in", folder = folder.display().to_string())
            }
            (Some(_), None) => text!("compare-no-cases"),
        };
        ui.label(RichText::new(text).font(font::verdict()).weak());
        if let Some(listed) = listed.filter(|listed| !listed.problems.is_empty()) {
            let text = text!("compare-num-unreadable", count = listed.problems.len());
            ui.label(text).on_hover_text(words_of(&listed.problems));
        }
        ui.weak(text!("compare-no-cases-advice"));
        return;
    };
    let cell = compare.cell.as_ref();
    let Some(run) = &compare.run else {
        list(ui, compare, session, cases, acts);
        return;
    };
    if let (Some(changes), Some(shown)) = (&compare.changes, &session.library) {
        changes_list(ui, changes, shown, acts);
        return;
    }
    // Without it, a matrix higher than the room looks cut.
    show_scroll_bar(ui);
    ScrollArea::both()
        .id_salt("cases")
        .auto_shrink(false)
        .show(ui, |ui| match cell.and_then(|cell| run.matrix.cell(cell)) {
            Some(cell) => of_cell(ui, session, run, cell, acts),
            None => matrix_and_calibration(ui, session, run, acts),
        });
}

/// Draws matrix and score plots side by side, or one below the other in a narrow window.
fn matrix_and_calibration(
    ui: &mut Ui,
    session: &Session,
    run: &CaseRun,
    acts: &mut Vec<CompareAction>,
) {
    let unloaded = LibraryView::default();
    let shown = session.library.as_deref().unwrap_or(&unloaded);
    let num_columns = run.matrix.columns.len() as f32;
    let beside = ui.available_width() - score_plots::WIDTH - space::LARGE;
    if beside >= NAMES_WIDTH_PX + 16.0 + NARROWEST * num_columns {
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_max_width(beside);
                matrix(ui, &run.matrix, shown, acts);
            });
            ui.add_space(space::MEDIUM);
            ui.vertical(|ui| plots(ui, run));
        });
    } else {
        matrix(ui, &run.matrix, shown, acts);
        ui.add_space(space::MEDIUM);
        ui.horizontal_wrapped(|ui| plots(ui, run));
    }
}

fn plots(ui: &mut Ui, run: &CaseRun) {
    score_plots::calibration(ui, &run.calibration);
    score_plots::trade_off(ui, &run.trade_off, run.recipe.accept.min_score);
}

fn header(ui: &mut Ui, compare: &CompareState, session: &Session, acts: &mut Vec<CompareAction>) {
    let theme = Theme::of(ui);
    ui.horizontal(|ui| {
        ui.label(RichText::new(text!("compare-all-cases")).font(font::body_strong()));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let folder = compare.cases.as_ref().map(|cases| cases.folder.path());
            let hover = folder.map_or_else(String::new, |path| path.display().to_string());
            let label = text!("compare-folder-of-cases");
            let button = labelled(ui, Button::new(text!("compare-folder")), &label);
            if button.on_hover_text(hover).clicked() {
                acts.push(CompareAction::Ask(CompareFile::Cases));
            }
            let is_matrix = compare.cell.is_none() && compare.changes.is_none();
            if !is_matrix && text_button(ui, &text!("compare-back")).clicked() {
                acts.push(CompareAction::ShowCell(None));
            }
            if let Some(run) = &compare.run
                && let Some(ended) = run.ended
                && is_matrix
            {
                let label = text!("compare-earlier-label");
                let button = labelled(ui, Button::new(text!("compare-earlier")), &label);
                if button
                    .on_hover_text(text!("compare-earlier-hint"))
                    .clicked()
                {
                    acts.push(CompareAction::Ask(CompareFile::EarlierRun));
                }
                let at = ended.to_zoned(jiff::tz::TimeZone::system());
                let time = at.strftime("%H:%M").to_string();
                let at = text!("compare-ran-at", time = time);
                ui.label(RichText::new(at).small().weak());
            }
        });
    });
    let Some(run) = &compare.run else {
        return;
    };
    let height = std::mem::take(&mut ui.spacing_mut().interact_size.y);
    ui.horizontal_wrapped(|ui| {
        let tally = &run.matrix.tally;
        // The worst comes first.
        let colour = match tally.wrong_accepted {
            0 => theme.accepted,
            _ => theme.rejected,
        };
        let wrong = text!("compare-false-accepts", count = tally.wrong_accepted);
        let wrong = RichText::new(wrong).color(colour);
        ui.label(wrong.font(font::body_strong()));
        let mut rest = vec![text!(
            "compare-tally",
            right = tally.right,
            total = tally.total,
            refused = tally.refused,
        )];
        let problems = run.cases.problems.iter().chain(&run.problems);
        let problems: Vec<UserError> = problems.cloned().collect();
        if !problems.is_empty() {
            rest.push(text!("compare-num-unreadable", count = problems.len()));
        }
        let done = run.results.len() + run.problems.len();
        let total = run.cases.list.len();
        if run.ended.is_none() {
            rest.push(if compare.is_running_cases() {
                text!("compare-run-running", done = done, total = total)
            } else {
                text!("compare-run-stopped", done = done, total = total)
            });
        }
        let rest = ui.label(format!("· {}", rest.join(" · ")));
        if !problems.is_empty() {
            rest.on_hover_text(words_of(&problems));
        }
        if *run.recipe != **compare.tried_recipe(session) {
            let text = format!("· {}", text!("compare-other-recipe"));
            ui.label(RichText::new(text).color(theme.warning));
        }
        if let (Some(num), Some(kept)) = (compare.num_covered, &compare.cases) {
            let total = kept.list.len();
            let text = if num < total {
                text!("compare-run-covers", done = num, total = total)
            } else {
                text!("compare-cases-removed")
            };
            ui.label(RichText::new(format!("· {text}")).color(theme.warning));
        }
    });
    ui.spacing_mut().interact_size.y = height;
}

/// All of these problems: the notices join those with the same advice.
fn words_of(problems: &[UserError]) -> String {
    let words: Vec<&str> = problems.iter().map(|error| error.what.as_str()).collect();
    words.join("\n")
}

/// Lists all cases, before any run.
fn list(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    cases: &[KeptCase],
    acts: &mut Vec<CompareAction>,
) {
    let hint = if compare.is_running_cases() {
        text!("compare-running")
    } else {
        text!("compare-run-hint")
    };
    ui.weak(hint);
    let height = space::TARGET;
    ScrollArea::vertical()
        .id_salt("list of cases")
        .auto_shrink(false)
        .show_rows(ui, height, cases.len(), |ui, rows| {
            for case in cases.get(rows).unwrap_or_default() {
                let about = &case.meta.about;
                let truth = session.library.as_ref();
                let truth = truth.map_or_else(String::new, |shown| row_title(&about.truth, shown));
                let what = text!("compare-it-is", part = truth)
                    + &difficulty_words(about.difficulty.as_deref());
                case_row(ui, &case.name, &what, acts);
            }
        });
}

/// Lists the cases of one cell.
fn of_cell(
    ui: &mut Ui,
    session: &Session,
    run: &CaseRun,
    cell: &MatrixCell,
    acts: &mut Vec<CompareAction>,
) {
    let Some(shown) = &session.library else {
        return;
    };
    ui.weak(cell_text(cell, shown));
    for result in cell
        .results
        .iter()
        .filter_map(|index| run.results.get(*index))
    {
        let found = &result.found;
        let what = match (&found.part, found.score, &found.reason) {
            // A high score alone does not say why it is refused.
            (Some(part), Some(score), Some(reason)) => {
                format!("{} {score:.2}: {reason}", shown.title_of(part))
            }
            (Some(part), Some(score), None) => format!("{} {score:.2}", shown.title_of(part)),
            (_, _, reason) => reason.clone().unwrap_or_default(),
        };
        let what = format!("{what}{}", difficulty_words(result.difficulty.as_deref()));
        case_row(ui, &result.name, &what, acts);
    }
}

/// Describes what a cell counts.
fn cell_text(cell: &MatrixCell, shown: &LibraryView) -> String {
    let (truth, answer) = &cell.cell;
    let (truth, num) = (row_title(truth, shown), cell.results.len());
    match answer {
        CaseAnswer::Part(_) => text!(
            "compare-cell-taken-for",
            truth = truth,
            part = column_title(answer, shown),
            count = num,
        ),
        CaseAnswer::NotAccepted => text!("compare-cell-not-accepted", truth = truth, count = num),
    }
}

/// Suffix of a case's line.
fn difficulty_words(difficulty: Option<&str>) -> String {
    difficulty.map_or_else(String::new, |words| format!(" · {words}"))
}

fn case_row(ui: &mut Ui, name: &str, what: &str, acts: &mut Vec<CompareAction>) {
    ui.horizontal(|ui| {
        let text = RichText::new(shortened(name, 34)).font(font::body_strong());
        let size = vec2(190.0, space::TARGET);
        let open = ui.add(Button::new(text).min_size(size));
        let label = text!("compare-open-case", name = name);
        open.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &label));
        if open
            .on_hover_text(text!("compare-open-case-hint"))
            .clicked()
        {
            acts.push(CompareAction::OpenCase(name.to_owned()));
        }
        let label = text!("compare-remove-named", name = name);
        let remove = labelled(ui, Button::new(text!("shell-remove")), &label);
        if remove.clicked() {
            acts.push(CompareAction::Remove(name.to_owned()));
        }
        ui.weak(shortened(what, 60)).on_hover_text(what);
    });
}

/// Draws the matrix: truths from top to bottom, answers from left to right.
fn matrix(ui: &mut Ui, matrix: &Matrix, shown: &LibraryView, acts: &mut Vec<CompareAction>) {
    let theme = Theme::of(ui);
    let columns = matrix.columns.iter();
    let columns: Vec<String> = columns.map(|answer| column_title(answer, shown)).collect();
    let rows = matrix.rows.iter();
    let rows: Vec<String> = rows.map(|truth| row_title(truth, shown)).collect();
    let num_columns = matrix.columns.len().max(1);
    let room = ui.available_width() - 16.0;
    // The columns keep their width as long as the names have some.
    let names =
        (room - NARROWEST * num_columns as f32).clamp(NARROW_NAMES_WIDTH_PX, NAMES_WIDTH_PX);
    let width = ((room - names) / num_columns as f32).clamp(NARROWEST, 140.0);
    let height = space::TARGET + 2.0;
    let head = if width > WIDE_COLUMN_PX {
        22.0
    } else {
        UPRIGHT_NAME_HEIGHT_PX
    };
    let size = vec2(
        names + width * num_columns as f32,
        head + height * matrix.rows.len() as f32,
    );
    let (all, _) = ui.allocate_exact_size(size, Sense::hover());
    let painter = ui.painter().clone();
    let origin = all.min + vec2(names, head);
    for (column, name) in columns.iter().enumerate() {
        let middle = origin.x + width * (column as f32 + 0.5);
        let colour = theme.weak_text;
        if width > WIDE_COLUMN_PX {
            let at = pos2(middle, origin.y - 6.0);
            let name = shortened(name, (width / 6.5) as usize);
            painter.text(at, Align2::CENTER_BOTTOM, name, font::small(), colour);
        } else {
            let galley = painter.layout_no_wrap(shortened(name, 18), font::small(), colour);
            let at = pos2(middle - galley.size().y / 2.0, origin.y - 4.0);
            let upright = TextShape::new(at, galley, colour).with_angle(-FRAC_PI_2);
            painter.add(Shape::Text(upright));
        }
    }
    for (row, name) in rows.iter().enumerate() {
        let at = pos2(origin.x - 8.0, origin.y + height * (row as f32 + 0.5));
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            shortened(name, (names / LETTER_WIDTH_PX) as usize),
            font::small(),
            theme.text,
        );
        for column in 0..num_columns {
            let rect = rect_of(origin, [row, column], vec2(width, height));
            painter.rect_filled(rect, ROUNDING, theme.canvas);
        }
    }
    for cell in &matrix.cells {
        let rect = rect_of(origin, cell.place, vec2(width, height));
        let id = ui.scope_id().with(("cell", cell.place));
        let response = ui.interact(rect, id, Sense::click());
        let (colour, sign, word) = match cell.judgement {
            right @ CaseOutcome::Right => (theme.accepted, "", described(&right)),
            wrong @ CaseOutcome::WrongAccepted => (theme.rejected, " ×", described(&wrong)),
            CaseOutcome::Refused => (theme.warning, " !", text!("compare-cell-refused")),
        };
        let label = format!("{}, {word}", cell_text(cell, shown));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &label));
        painter.rect_filled(rect, ROUNDING, colour.gamma_multiply(0.28));
        let stroke = Stroke::new(if response.hovered() { 2.0 } else { 1.0 }, colour);
        painter.rect_stroke(rect, ROUNDING, stroke, StrokeKind::Inside);
        let text = format!("{}{sign}", cell.results.len());
        let at = rect.center();
        painter.text(
            at,
            Align2::CENTER_CENTER,
            text,
            font::body_strong(),
            theme.text,
        );
        focus_ring(ui, rect, &response);
        if response.on_hover_text(label).clicked() {
            acts.push(CompareAction::ShowCell(Some(cell.cell.clone())));
        }
    }
    ui.add_space(space::SMALL);
    ui.label(RichText::new(text!("compare-matrix-hint")).small().weak());
}

fn rect_of(origin: egui::Pos2, [row, column]: [usize; 2], size: Vec2) -> Rect {
    let min = origin + vec2(size.x * column as f32, size.y * row as f32);
    Rect::from_min_size(min, size).shrink(1.0)
}

fn changes_list(
    ui: &mut Ui,
    changes: &RunChanges,
    shown: &LibraryView,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let RunChanges { file, changes } = changes;
    ui.horizontal_wrapped(|ui| {
        let worse = match changes.regressions.len() {
            0 => theme.accepted,
            _ => theme.rejected,
        };
        let num_worse = text!("compare-num-worse", count = changes.regressions.len());
        let worse = RichText::new(num_worse).color(worse);
        ui.label(worse.font(font::body_strong()));
        let mut rest = vec![
            text!("compare-num-better", count = changes.mends.len()),
            text!("compare-num-rescored", count = changes.rescored.len()),
            text!("compare-num-common", count = changes.num_common),
        ];
        if !changes.added.is_empty() {
            rest.push(text!("compare-num-new", count = changes.added.len()));
        }
        if !changes.gone.is_empty() {
            rest.push(text!("compare-num-gone", count = changes.gone.len()));
        }
        rest.push(text!("compare-against-file", file = file));
        ui.label(format!("· {}", rest.join(" · ")));
    });
    let rows: Vec<(String, &CaseChange)> = [
        (text!("compare-worse"), &changes.regressions),
        (text!("compare-better"), &changes.mends),
        (text!("history-figure-score"), &changes.rescored),
    ]
    .into_iter()
    .flat_map(|(word, list)| list.iter().map(move |change| (word.clone(), change)))
    .collect();
    if rows.is_empty() {
        ui.weak(text!("compare-no-changes"));
    }
    ScrollArea::vertical()
        .id_salt("changes")
        .auto_shrink(false)
        .show(ui, |ui| {
            for (word, change) in rows {
                case_row(ui, &change.name, &words(&word, change, shown), acts);
            }
        });
}

/// Describes a change briefly: a row fits about sixty characters.
fn words(word: &str, change: &CaseChange, shown: &LibraryView) -> String {
    let found = |found: &FoundVerdict| match (&found.part, found.score) {
        (Some(part), Some(score)) => format!("{} {score:.2}", shown.title_of(part)),
        _ => text!("compare-nothing"),
    };
    let before = found(&change.before);
    let now = match change.now.score {
        Some(score) if change.before.part == change.now.part => format!("{score:.2}"),
        _ => found(&change.now),
    };
    let [was, is] = change.judgements.map(|outcome| described(&outcome));
    if was == is {
        text!(
            "compare-change-same",
            change = word,
            before = before,
            now = now
        )
    } else {
        text!(
            "compare-change",
            change = word,
            is = is,
            was = was,
            before = before,
            now = now,
        )
    }
}
