//! The tab of the robot: arm, nozzle and gun of its programs, what they stay clear of, and which points of the path the arm
//! reaches.

use egui::{Button, DragValue, Key, Label, RichText, Role, Ui, WidgetInfo};

use super::{
    reach::Reach,
    side::{self, TITLE, menu},
    state::PaintState,
};
use crate::workspaces::paint::state::{PaintAction, PaintFile};
use inspection::pipeline::parameters::{Kind, Parameter, Parameters as _};
use robot::{
    Convention,
    arm::{ARM_NAMES, Arm, PointProblem},
    program::ProgramParams,
};
use shell::{cell::ProgramSetup, language::not_checked, session::Session};
use station::robot_file::Unchecked;
use ui::{
    language::{parameters, text},
    parameter_control::fold,
    theme::Theme,
    widgets::{Mark, grouped, heading, labelled, line_edit, row, shortened, text_button},
};

/// Draws the tab.
pub(super) fn ui(
    ui: &mut Ui,
    paint: &PaintState,
    session: &Session,
    actions: &mut Vec<PaintAction>,
) {
    let theme = Theme::of(ui);
    heading(ui, &text!("paint-arm-group"));
    let mut setup = session.program.clone();
    arm_ui(ui, &mut setup, actions);
    let label = text!("paint-nozzle");
    let nozzle = field(ui, &label, &mut setup.nozzle, "kuka 0 0 250 0 45 0")
        .on_hover_text(text!("paint-nozzle-hint"));
    // Keep the focus, so that keys typed to correct it do not act as shortcuts.
    let is_entered = nozzle.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered && setup.nozzle_error().is_some() {
        nozzle.request_focus();
    }
    if session.program.arm.is_some() {
        // The scope is there without an error too, so that the fields below keep their ids, and with them the focus.
        ui.scope(|ui| {
            if let Some(Err(error)) = paint.reach(session) {
                note(ui, &error.what, theme.rejected);
                note(ui, &error.advice, theme.text);
            }
        });
        base_ui(ui, &mut setup);
    }
    // A scope for the same reason.
    ui.scope(|ui| reach_ui(ui, paint, session, actions));
    heading(ui, &text!("paint-cell-group"));
    obstacles_ui(ui, &mut setup, actions);
    fold(ui, text!("paint-more-robot"), theme.weak_text)
        .id_salt("robot")
        .show_unindented(ui, |ui| {
            let label = text!("paint-rail");
            field(ui, &label, &mut setup.rail, "y,-2000,2000,1000")
                .on_hover_text(text!("paint-rail-hint"));
            let label = text!("paint-tool");
            field(ui, &label, &mut setup.tool, "1").on_hover_text(text!("paint-tool-hint"));
            for row in ProgramParams::ALL {
                number_ui(ui, row, &mut setup.params);
            }
        });
    if setup != session.program {
        actions.push(PaintAction::SetUp(setup));
    }
}

/// Draws the group on the reach: that the cell must be calibrated for it, or what was found.
fn reach_ui(ui: &mut Ui, paint: &PaintState, session: &Session, actions: &mut Vec<PaintAction>) {
    let theme = Theme::of(ui);
    if session.robot.is_none() {
        heading(ui, &text!("paint-reach-group"));
        note(ui, &text!("paint-not-calibrated"), theme.weak_text);
    } else if let Some(Ok(reach)) = paint.reach(session) {
        heading(ui, &text!("paint-reach-group"));
        reasons(ui, reach, &session.program, actions);
    }
}

fn note(ui: &mut Ui, words: &str, colour: egui::Color32) {
    ui.add(Label::new(RichText::new(words).color(colour)).wrap());
}

/// Draws a number before its name.
fn number_ui(ui: &mut Ui, row: &Parameter<ProgramParams>, params: &mut ProgramParams) {
    let Kind::Number(number) = &row.kind else {
        return;
    };
    let [least, most] = number.range;
    let before = row.value(params);
    let mut value = before;
    ui.horizontal(|ui| {
        let drag = DragValue::new(&mut value)
            .range(least..=most)
            .max_decimals(number.decimals)
            .suffix(number.unit.sign());
        let response = ui.add(drag).on_hover_text(parameters::help(row));
        let name = ui.label(parameters::name(row));
        response.labelled_by(name.id);
    });
    if value.to_bits() != before.to_bits() {
        // The field keeps to the range.
        let _ = row.set(params, value);
    }
}

fn arm_ui(ui: &mut Ui, setup: &mut ProgramSetup, actions: &mut Vec<PaintAction>) {
    let title = setup.arm_title().unwrap_or_else(|| text!("paint-no-arm"));
    let text = format!("{} ▼", shortened(&title, TITLE));
    let label = text!("paint-arm", arm = title);
    menu(ui, text, &label, text!("paint-arm-hint"), |ui| {
        if ui
            .selectable_label(setup.arm.is_none(), text!("paint-no-arm"))
            .clicked()
        {
            setup.arm = None;
            ui.close();
        }
        for name in ARM_NAMES {
            let is_chosen = setup.arm.as_deref() == Some(name);
            let title = Arm::named(name).map_or_else(|_| name.to_owned(), |arm| arm.name);
            if ui.selectable_label(is_chosen, title).clicked() {
                setup.arm = Some(name.to_owned());
                ui.close();
            }
        }
        ui.separator();
        if ui.button(text!("paint-from-file")).clicked() {
            actions.push(PaintAction::Ask(PaintFile::Arm));
            ui.close();
        }
    });
}

fn obstacles_ui(ui: &mut Ui, setup: &mut ProgramSetup, actions: &mut Vec<PaintAction>) {
    let file = setup.obstacles_title();
    let title = file.unwrap_or_else(|| text!("paint-no-obstacles"));
    let label = text!("paint-obstacles", file = shortened(&title, TITLE));
    let text = format!("{label} ▼");
    menu(ui, text, &label, text!("paint-obstacles-hint"), |ui| {
        let is_none = setup.obstacles.is_none();
        if ui
            .selectable_label(is_none, text!("paint-no-obstacles"))
            .clicked()
        {
            setup.obstacles = None;
            ui.close();
        }
        ui.separator();
        if ui.button(text!("paint-from-file")).clicked() {
            actions.push(PaintAction::Ask(PaintFile::Obstacles));
            ui.close();
        }
    });
}

/// Draws the pose of the arm's base, as KUKA writes it: its position on the left, its turns on the right.
fn base_ui(ui: &mut Ui, setup: &mut ProgramSetup) {
    ui.label(text!("paint-base"))
        .on_hover_text(text!("paint-base-hint"));
    let numbers = setup.base.iter_mut().zip(Convention::Kuka.names());
    ui.columns(2, |columns| {
        for (index, (value, name)) in numbers.enumerate() {
            let (unit, speed) = if index < 3 { (" mm", 1.0) } else { ("°", 0.1) };
            let drag = DragValue::new(value)
                .range(ProgramSetup::base_range(index))
                .speed(speed)
                .max_decimals(2)
                .update_while_editing(false)
                .prefix(format!("{name} "))
                .suffix(unit);
            let response = columns[index / 3].add(drag);
            let label = text!("paint-base-number", name = *name);
            response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &label));
            response.on_hover_text(text!("paint-base-hint"));
        }
    });
}

/// Draws a text field below its label; an empty one shows an example.
fn field(ui: &mut Ui, label: &str, text: &mut String, example: &str) -> egui::Response {
    let name = ui.label(label);
    let example = text!("paint-example", example = example);
    ui.add(line_edit(text, example, f32::INFINITY))
        .labelled_by(name.id)
}

/// Draws the share of the path that the arm reaches, or that it is not known. Without an arm and a calibrated cell, nothing is
/// asked of one.
pub(super) fn verdict(ui: &mut Ui, paint: &PaintState, session: &Session) {
    if session.program.arm.is_none() {
        let words = not_checked(&Unchecked::of_arm(None));
        if let Some(words) = words.filter(|_| session.robot.is_some()) {
            side::verdict(ui, Mark::Look, &words);
        }
        return;
    }
    let Some(Ok(reach)) = paint.reach(session) else {
        if paint.reach_task.running().is_some() {
            side::verdict(ui, Mark::Open, &text!("paint-checking-reach"));
            return;
        }
        let shown = side::verdict(ui, Mark::Look, &text!("paint-arm-not-checked"));
        if let Some(Err(error)) = paint.reach(session) {
            shown.on_hover_text(&error.what);
        }
        return;
    };
    let (num, all) = (reach.check.num_reached(), reach.check.points.len());
    let (sign, words) = if num == all {
        (
            Mark::Good,
            text!("paint-arm-reaches-all", all = grouped(all)),
        )
    } else {
        let words = text!(
            "paint-arm-reaches-some",
            share = floor_percent(num, all),
            missed = grouped(all - num),
            all = grouped(all)
        );
        (Mark::Bad, words)
    };
    side::verdict(ui, sign, &words).on_hover_text(text!("paint-arm-reaches-hint"));
}

/// Writes the share of `num` in `all` in per cent, rounded down: only all of them are 100 %.
fn floor_percent(num: usize, all: usize) -> String {
    let tenths = 1000 * num / all.max(1);
    format!("{}.{}", tenths / 10, tenths % 10)
}

/// Draws why points are not reached, and positions that reach more.
fn reasons(ui: &mut Ui, reach: &Reach, setup: &ProgramSetup, actions: &mut Vec<PaintAction>) {
    let theme = Theme::of(ui);
    collisions_ui(ui, reach);
    if let Some(words) = not_checked(&reach.unchecked) {
        note(ui, &words, theme.warning);
    }
    if let Some(range) = reach.rail_range {
        let [from, to] = range.map(|at| format!("{:.0}", 1000.0 * at));
        let words = text!("paint-rail-moves", from = from, to = to);
        note(ui, &words, theme.weak_text);
    }
    if let Some((num, most)) = reach.check.tilted() {
        let degrees = format!("{:.0}", most.to_degrees());
        let words = text!("paint-tilted", num = num, degrees = degrees);
        note(ui, &words, theme.weak_text);
    }
    let [slower, by_joints, spraying] = reach.check.changed_moves();
    if slower + by_joints > 0 {
        let words = text!("paint-changed-moves", slower = slower, joints = by_joints);
        note(ui, &words, theme.weak_text);
    }
    if spraying > 0 {
        let words = text!("paint-slower-spraying", num = spraying);
        note(ui, &words, theme.weak_text);
    }
    if reach.check.num_reached() == reach.check.points.len() {
        return;
    }
    for (reason, count) in reach.reasons() {
        note(ui, &format!("{} · {reason}", grouped(count)), theme.text);
    }
    let points = reach.check.points.iter();
    let problems = || points.clone().filter_map(|point| point.problem.as_ref());
    if problems().any(PointProblem::is_of_joints) {
        note(ui, &text!("paint-joints-advice"), theme.text);
    }
    if problems().any(PointProblem::is_acceleration) {
        note(ui, &text!("paint-acceleration-advice"), theme.text);
    }
    if text_button(ui, &text!("paint-show-unreached")).clicked() {
        actions.push(PaintAction::ShowUnreached);
    }
    if let Some((place, direction)) = reach.rail.zip(reach.rail_direction) {
        let at = format!("{:.0}", 1000.0 * place.shift[0]);
        let words = text!("paint-rail-at", at = at, count = grouped(place.num_reached));
        note(ui, &words, theme.weak_text);
        let shift = (direction * place.shift[0]).into();
        apply_ui(ui, &text!("paint-apply-rail"), setup, shift, actions);
    }
    if let Some(place) = reach.base {
        let count = grouped(place.num_reached);
        let words = text!(
            "paint-base-moved",
            by = moved_by(place.shift),
            count = count
        );
        note(ui, &words, theme.weak_text);
        apply_ui(ui, &text!("paint-apply-base"), setup, place.shift, actions);
    }
}

/// Writes a shift, metres, in millimetres along each axis that it moves along.
fn moved_by(shift: [f64; 3]) -> String {
    let axes = Convention::Kuka.names().iter().zip(shift);
    let moved = axes.filter(|(_, metres)| metres.abs() >= 0.0005);
    let moved = moved.map(|(axis, metres)| format!("{axis} {:+.0}", 1000.0 * metres));
    moved.collect::<Vec<String>>().join(", ")
}

/// Draws the button that moves the base by this shift, metres.
fn apply_ui(
    ui: &mut Ui,
    label: &str,
    setup: &ProgramSetup,
    shift: [f64; 3],
    actions: &mut Vec<PaintAction>,
) {
    let button = labelled(ui, Button::new(text!("shell-apply")), label);
    if button.on_hover_text(label).clicked() {
        let mut setup = setup.clone();
        for (value, metres) in setup.base.iter_mut().zip(shift) {
            // To the decimals that the fields show.
            *value = (100.0 * (*value + 1000.0 * metres)).round() / 100.0;
        }
        actions.push(PaintAction::SetUp(setup));
    }
}

fn collisions_ui(ui: &mut Ui, reach: &Reach) {
    let count = reach.check.num_collisions();
    // Collisions are only known at points that the arm reaches.
    let value = match (count, reach.check.num_reached()) {
        (0, 0) => text!("paint-collisions-not-checked"),
        (0, num) if num < reach.check.points.len() => text!("paint-no-collisions-reached"),
        (0, _) if reach.unchecked.contains(&Unchecked::Surroundings) => {
            text!("paint-no-collisions-part")
        }
        _ => text!("paint-num-collisions", count = count),
    };
    row(ui, &text!("paint-collisions"), &value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_names_the_axes_along_which_it_moves() {
        assert_eq!(moved_by([0.2, 0.0, -0.1]), "X +200, Z -100");
        assert_eq!(moved_by([-0.0, 0.35, 1e-7]), "Y +350");
    }

    #[test]
    fn a_path_that_is_not_reached_completely_is_never_reached_to_100_per_cent() {
        assert_eq!(floor_percent(9999, 10_000), "99.9");
        assert_eq!(floor_percent(0, 7), "0.0");
        assert_eq!(floor_percent(7, 7), "100.0");
    }
}
