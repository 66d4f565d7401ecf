//! The page about whether camera and cell still stand where they stood.

use egui::{DragValue, Grid, Label, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};
use jiff::{Timestamp, Zoned, tz::TimeZone};

use super::{
    cell_check::{CellChecks, CheckFolderContent, marked, no_baseline, shown_time},
    state::RobotCell,
};
use crate::{
    cell::dialog_state::{CheckAction, RobotAction, RobotDialog, RobotFile, RobotQuestion},
    language::UnitSystem,
    session::Session,
    source::source_menu,
};
use geometry::units::{Metres, Radians};
use robot::cell_check::{CellBaseline, CellCheck, CellFinding, CellLimits};
use ui::{
    language::{advised, described, text},
    plot::OverTime,
    theme::{Theme, space},
    user_error::UserError,
    widgets::{self, Mark, error_row, heading, row, sentence, text_button},
};

/// Height of the list of checks, logical pixels.
const TABLE_HEIGHT_PX: f32 = 170.0;
/// Height of a row of the list, logical pixels.
const ROW_HEIGHT_PX: f32 = 20.0;
/// Maximum number of checks in list and plot, the newest; the exported table has them all.
const MOST_SHOWN: usize = 100;
/// Minimum number of checks for a plot.
const LEAST_DRAWN: usize = 2;

pub(super) fn ui(
    ui: &mut Ui,
    robot: &RobotCell,
    session: &Session,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    let checks = robot.checks();
    let says = RichText::new(text!("robot-check-says")).small();
    ui.label(says.weak());
    ui.add_space(space::SMALL);
    if !checks.has_folder() {
        let nowhere = UserError {
            what: text!("robot-check-no-folder"),
            advice: text!("robot-check-no-folder-advice"),
        };
        return error_row(ui, Mark::Look, &nowhere);
    }
    let content = checks.content();
    let units = session.units;
    baseline(ui, content, units);
    for problem in &content.problems {
        error_row(ui, Mark::Bad, problem);
    }
    let source = source_menu::now(&session.source);
    row(ui, &text!("robot-frames-from"), &source);
    ui.add_space(space::SMALL);
    if dialog.question == Some(RobotQuestion::ReplaceBaseline) {
        question(ui, dialog, caused);
    } else {
        limits(ui, &mut dialog.limits);
        buttons(ui, checks, caused);
    }
    progress(ui, checks, caused);
    if let Some(problem) = &dialog.problem {
        error_row(ui, Mark::Bad, problem);
    }
    if let (Some(check), Some(baseline)) = (checks.latest(), &content.baseline) {
        finding(ui, check, baseline.limits, units);
    }
    if !content.checks.is_empty() {
        former(ui, content, units);
        ui.add_space(space::SMALL);
        let is_idle = checks.running().is_none();
        ui.add_enabled_ui(is_idle, |ui| {
            if text_button(ui, &text!("shell-export-csv")).clicked() {
                caused.push(RobotAction::Ask(RobotFile::Checks));
            }
        });
    }
}

/// Draws the baseline and its limits.
fn baseline(ui: &mut Ui, content: &CheckFolderContent, units: UnitSystem) {
    let Some(baseline) = &content.baseline else {
        if !content.has_baseline {
            error_row(ui, Mark::Open, &no_baseline());
        }
        return;
    };
    let taken = taken(baseline.made_at, baseline.num_frames, baseline.is_simulated);
    row(ui, &text!("robot-baseline"), &taken);
    let CellLimits { shift, turn } = baseline.limits;
    let allowed = text!(
        "robot-allowed-are",
        shift = units.length(shift.0),
        turn = units.angle(turn.0)
    );
    row(ui, &text!("robot-allowed"), &allowed);
    if baseline.num_planes() == 0 {
        let no_wall = UserError {
            what: text!("robot-no-wall"),
            advice: text!("robot-no-wall-advice"),
        };
        error_row(ui, Mark::Look, &no_wall);
    }
}

/// Says when and how many frames were taken.
fn taken(at: Timestamp, num_frames: usize, is_simulated: bool) -> String {
    let taken = text!("robot-taken-at", time = shown_time(at), count = num_frames);
    marked(taken, is_simulated)
}

/// Draws the fields for the limits of the next baseline.
fn limits(ui: &mut Ui, limits: &mut CellLimits) {
    ui.horizontal(|ui| {
        ui.label(text!("robot-new-baseline-allows"));
        let mut mm = limits.shift.mm();
        let field = DragValue::new(&mut mm)
            .range(CellLimits::SHIFT_MM)
            .speed(0.1)
            .max_decimals(1)
            .suffix(" mm");
        if number(ui, field, &text!("robot-allowed-shift")) {
            limits.shift = Metres::from_mm(mm);
        }
        let mut degrees = limits.turn.degrees();
        let field = DragValue::new(&mut degrees)
            .range(CellLimits::TURN_DEGREES)
            .speed(0.01)
            .max_decimals(2)
            .suffix("°");
        if number(ui, field, &text!("robot-allowed-turn")) {
            limits.turn = Radians::from_degrees(degrees);
        }
    });
}

/// Draws a number that can be dragged or typed; true if the user changed it.
fn number(ui: &mut Ui, field: DragValue<'_>, label: &str) -> bool {
    let response = ui.add_sized(vec2(110.0, space::TARGET), field);
    response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, label));
    response.changed()
}

fn buttons(ui: &mut Ui, checks: &CellChecks, caused: &mut Vec<RobotAction>) {
    let is_idle = checks.running().is_none();
    let content = checks.content();
    let mut act = |action| caused.push(RobotAction::Check(action));
    ui.horizontal(|ui| {
        if !content.has_baseline {
            let take = text!("robot-take-baseline");
            if widgets::default_button(ui, &take, is_idle) {
                act(CheckAction::TakeBaseline);
            }
            return;
        }
        let can_check = is_idle && content.baseline.is_some();
        if widgets::default_button(ui, &text!("robot-check-now"), can_check) {
            act(CheckAction::Check);
        }
        ui.add_enabled_ui(is_idle, |ui| {
            if text_button(ui, &text!("robot-take-new-baseline")).clicked() {
                act(CheckAction::TakeBaseline);
            }
        });
    });
}

/// Asks before a baseline is replaced.
fn question(ui: &mut Ui, dialog: &mut RobotDialog, caused: &mut Vec<RobotAction>) {
    ui.label(text!("robot-replace-says"));
    ui.horizontal(|ui| {
        if widgets::default_button(ui, &text!("robot-keep-baseline"), true) {
            dialog.question = None;
        }
        if text_button(ui, &text!("robot-replace-baseline")).clicked() {
            caused.push(RobotAction::Check(CheckAction::TakeBaseline));
        }
    });
}

/// Draws the running work and the button that cancels it.
fn progress(ui: &mut Ui, checks: &CellChecks, caused: &mut Vec<RobotAction>) {
    let theme = Theme::of(ui);
    let Some(running) = checks.running() else {
        return;
    };
    ui.horizontal(|ui| {
        ui.add(egui::Spinner::new().size(18.0).color(theme.accent));
        let words = match running.progress {
            Some((done, total)) => text!(
                "shell-progress",
                work = &running.title,
                done = done,
                total = total
            ),
            None => running.title.clone(),
        };
        ui.weak(words);
        if text_button(ui, &text!("shell-cancel")).clicked() {
            caused.push(RobotAction::Check(CheckAction::Cancel));
        }
    });
}

/// Draws the last check, its figures beside the limits.
fn finding(ui: &mut Ui, check: &CellCheck, limits: CellLimits, units: UnitSystem) {
    heading(ui, &text!("robot-last-check"));
    let sign = match check.finding {
        CellFinding::InPlace => Mark::Good,
        CellFinding::PartMoved | CellFinding::Noisier => Mark::Look,
        CellFinding::CameraMoved | CellFinding::PartOrCameraMoved => Mark::Bad,
    };
    let found = UserError {
        what: marked(described(&check.finding), check.is_simulated),
        advice: advised(&check.finding),
    };
    error_row(ui, sign, &found);
    let mut figure = |name: String, value: String| row(ui, &name, &value);
    let taken = taken(check.at, check.num_frames, false);
    figure(text!("robot-checked"), taken);
    let of_shift = |shift: f64| {
        text!(
            "robot-of-allowed",
            value = units.length(shift),
            limit = units.length(limits.shift.0)
        )
    };
    figure(text!("robot-part-shifted"), of_shift(check.shift().0));
    let along = check.shift_m.map(|shift| units.signed_length(shift));
    figure(text!("robot-along-axes"), along.join(", "));
    let turn = text!(
        "robot-of-allowed",
        value = units.angle(check.turn_rad),
        limit = units.angle(limits.turn.0)
    );
    figure(text!("robot-part-turned"), turn);
    let background = check.background_shift_m;
    let background = background.map_or_else(|| text!("robot-wall-not-found"), of_shift);
    figure(text!("robot-wall-shifted"), background);
    let readings = text!(
        "robot-readings-are",
        rms = units.length(check.rms_m),
        ratio = format!("{:.1}", check.noise_ratio)
    );
    figure(text!("robot-readings"), readings);
}

/// Draws the last checks: those against the baseline in use as curves, and all in a list, newest first.
fn former(ui: &mut Ui, content: &CheckFolderContent, units: UnitSystem) {
    let checks = &content.checks;
    let shown = checks.len().min(MOST_SHOWN);
    let title = text!("robot-checks-shown", shown = shown, count = checks.len());
    heading(ui, &title);
    if let Some(baseline) = &content.baseline {
        drift(ui, checks, baseline, units);
    }
    let small = |text: String| RichText::new(text).small();
    ScrollArea::vertical()
        .id_salt("checks")
        .max_height(TABLE_HEIGHT_PX)
        .auto_shrink([false, true])
        .show(ui, |ui| {
            // Nothing here can be pressed, so rows may be lower.
            ui.spacing_mut().interact_size.y = ROW_HEIGHT_PX;
            let grid = Grid::new("checks").num_columns(4).spacing(vec2(20.0, 2.0));
            grid.show(ui, |ui| {
                for title in [
                    text!("robot-check-time"),
                    text!("robot-check-shift"),
                    text!("robot-check-turn"),
                    text!("robot-check-finding"),
                ] {
                    ui.label(small(title).weak());
                }
                ui.end_row();
                for check in checks.iter().rev().take(shown) {
                    let found = marked(described(&check.finding), check.is_simulated);
                    for figure in [
                        shown_time(check.at),
                        units.length(check.shift().0),
                        units.angle(check.turn_rad),
                    ] {
                        ui.label(small(figure));
                    }
                    ui.add(Label::new(small(sentence(&found))).wrap());
                    ui.end_row();
                }
            });
        });
}

/// Plots the shift of the part against the baseline, over the checks.
fn drift(ui: &mut Ui, checks: &[CellCheck], baseline: &CellBaseline, units: UnitSystem) {
    let theme = Theme::of(ui);
    let newest = checks.iter().rev();
    let newest = newest.filter(|check| check.baseline == baseline.made_at);
    let mut drawn: Vec<&CellCheck> = newest.take(MOST_SHOWN).collect();
    if drawn.len() < LEAST_DRAWN {
        return;
    }
    drawn.reverse();
    let zone = TimeZone::system();
    let at = drawn.iter().map(|check| check.at.to_zoned(zone.clone()));
    let at: Vec<Zoned> = at.collect();
    let along = |axis: usize| -> Vec<f32> {
        let shifts = drawn.iter().map(|check| check.shift_m[axis] as f32);
        shifts.collect()
    };
    let [x, y, z] = [0, 1, 2].map(along);
    let curves = [
        ("x", &*x, theme.first_series),
        ("y", &*y, theme.second_series),
        ("z", &*z, theme.reference_series),
    ];
    let written = |metres: f64| units.signed_length(metres);
    // The limit in both directions.
    let least_span = 2.0 * baseline.limits.shift.0;
    let title = text!("robot-shift-over-time");
    let shifts = OverTime {
        title: &title,
        at: &at,
        curves: &curves,
        levels: &[],
        written: &written,
        least_span,
        most: f64::INFINITY,
    };
    shifts.show(ui);
}
