//! The page that calculates the camera's pose from pairs of robot and camera poses.

use egui::{Checkbox, Grid, RichText, ScrollArea, Ui, vec2};

use super::{
    controls::{error_row, mounts, name, use_it},
    in_use::pose,
    state::RobotCell,
    work::SolvedPairs,
};
use crate::{
    cell::dialog_state::{RobotAction, RobotDialog, RobotFile},
    inspection::source::file_name,
};
use robot::Convention;
use ui::{
    language::{described, text},
    theme::{Theme, space},
    user_error::UserError,
    widgets::{Mark, row, text_button},
};

/// Height of the table of residuals, logical pixels.
const TABLE_HEIGHT_PX: f32 = 170.0;
/// Height of a row of figures, logical pixels.
const ROW_HEIGHT_PX: f32 = 20.0;

pub(super) fn ui(
    ui: &mut Ui,
    robot: &RobotCell,
    shown: Convention,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    let theme = Theme::of(ui);
    mounts(ui, dialog);
    ui.add_space(space::SMALL);
    ui.horizontal(|ui| {
        if text_button(ui, &text!("robot-choose-pairs")).clicked() {
            caused.push(RobotAction::Ask(RobotFile::Pairs));
        }
        match &dialog.pairs {
            Some(path) => ui.label(file_name(path)),
            None => ui.weak(text!("robot-choose-pairs-says")),
        };
        if !robot.is_idle() {
            ui.add(egui::Spinner::new().size(18.0).color(theme.accent));
        }
    });
    let Some(found) = dialog.solved.clone() else {
        if dialog.pairs.is_none() {
            let text = text!("robot-pairs-format");
            ui.label(RichText::new(text).small().weak());
        }
        return;
    };
    ui.add_space(space::SMALL);
    residuals(ui, &found, dialog);
    ui.scope(|ui| {
        // Nothing here can be pressed, so rows may be lower.
        ui.spacing_mut().interact_size.y = ROW_HEIGHT_PX;
        figures(ui, &found);
    });
    for doubt in &found.solved.doubts {
        let sign = if doubt.is_grave() {
            Mark::Bad
        } else {
            Mark::Look
        };
        error_row(ui, sign, &UserError::of(doubt));
    }
    let solved = &found.solved;
    pose(
        ui,
        solved.mount.camera_transform(),
        &solved.mount_from_camera,
        shown,
    );
    ui.add_space(space::SMALL);
    name(ui, dialog);
    if !solved.is_usable() {
        let text = text!("robot-use-anyway");
        ui.add(Checkbox::new(&mut dialog.insists, text));
    }
    ui.add_space(space::SMALL);
    if use_it(ui, dialog.usable().is_some()) {
        caused.push(RobotAction::UseSolved);
    }
}

/// Draws the residual of each pair; an unticked pair does not count.
fn residuals(ui: &mut Ui, found: &SolvedPairs, dialog: &mut RobotDialog) {
    let solved = &found.solved;
    let weak = |text: String| RichText::new(text).weak();
    ScrollArea::vertical()
        .id_salt("residuals")
        .max_height(TABLE_HEIGHT_PX)
        .auto_shrink([false, true])
        .show(ui, |ui| {
            let grid = Grid::new("pairs").num_columns(4).spacing(vec2(24.0, 2.0));
            grid.show(ui, |ui| {
                for title in [
                    text!("robot-counts"),
                    text!("robot-off-mm"),
                    text!("robot-off-degrees"),
                    String::new(),
                ] {
                    ui.label(weak(title));
                }
                ui.end_row();
                for name in &found.names {
                    let mut counts = !dialog.left_out.contains(name);
                    if ui.add(Checkbox::new(&mut counts, name)).clicked() {
                        if counts {
                            dialog.left_out.retain(|left_out| left_out != name);
                        } else {
                            dialog.left_out.push(name.clone());
                        }
                    }
                    let pairs = &solved.residuals.pairs;
                    let place = pairs.iter().position(|pair| pair.name == *name);
                    if let Some(place) = place {
                        let off = pairs[place].off;
                        ui.label(format!("{:.2}", off.shift.mm()));
                        ui.label(format!("{:.3}", off.rotation.degrees()));
                        ui.label(weak(if place == solved.residuals.worst {
                            text!("robot-worst")
                        } else {
                            String::new()
                        }));
                    } else {
                        ui.label(weak(text!("robot-left-out")));
                    }
                    ui.end_row();
                }
            });
        });
}

fn figures(ui: &mut Ui, found: &SolvedPairs) {
    let solved = &found.solved;
    let rms = &solved.residuals.rms;
    let text = text!(
        "robot-mm-and-degrees",
        mm = format!("{:.2}", rms.shift.mm()),
        degrees = format!("{:.3}", rms.rotation.degrees())
    );
    row(ui, &text!("robot-rms"), &text);
    let bounds = &solved.bounds;
    let text = if bounds.shift.0.is_finite() {
        text!(
            "robot-mm-and-degrees",
            mm = format!("{:.2}", bounds.shift.mm()),
            degrees = format!("{:.3}", bounds.turn.degrees())
        )
    } else {
        text!("robot-not-determined")
    };
    row(ui, &text!("robot-uncertainty"), &text);
    let span = &solved.span;
    let text = text!(
        "robot-span",
        turn = format!("{:.0}", span.largest_turn.degrees()),
        other = format!("{:.0}", span.other_turn.degrees()),
        travel = format!("{:.0}", span.travel.mm())
    );
    row(ui, &text!("robot-flange-turned"), &text);
    let [robot, camera] = found.conventions;
    let text = text!(
        "robot-conventions-are",
        robot = described(&robot),
        camera = described(&camera)
    );
    row(ui, &text!("robot-read-as"), &text);
}
