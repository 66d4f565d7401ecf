//! The page for typing the camera's pose.

use egui::{RichText, Ui};

use super::{
    controls::{error_row, mounts, name, use_it},
    in_use::pose,
};
use crate::{
    cell::dialog_state::{RobotAction, RobotDialog},
    language::convention_meaning,
};
use robot::{Convention, calibration::CameraPlace};
use ui::{
    language::{described, text, what_and_advice},
    theme::space,
    user_error::UserError,
    widgets::{Mark, drop_down},
};

pub(super) fn ui(ui: &mut Ui, dialog: &mut RobotDialog, caused: &mut Vec<RobotAction>) {
    mounts(ui, dialog);
    ui.add_space(space::SMALL);
    ui.horizontal(|ui| {
        ui.label(text!("robot-numbers-of"));
        convention(ui, &mut dialog.convention);
    });
    let small = |text: &str| RichText::new(text.to_owned()).small();
    ui.label(small(&convention_meaning(dialog.convention)).weak());
    ui.add_space(space::SMALL);
    let transform = dialog.mount.camera_transform();
    let label = ui.label(text!("robot-where-camera-stands", transform = transform));
    let hint = dialog.convention.names().join("  ");
    let rows = if dialog.convention == Convention::Matrix {
        4
    } else {
        1
    };
    ui.add(
        egui::TextEdit::multiline(&mut dialog.numbers)
            .hint_text(hint)
            .desired_rows(rows)
            .desired_width(f32::INFINITY),
    )
    .labelled_by(label.id);
    let typed = dialog.typed();
    match &typed {
        Ok(written) => {
            // Show it as a matrix, which reveals a wrong order or sign.
            pose(ui, transform, &written.pose, Convention::Matrix);
            if let Some(doubt) = CameraPlace::on(dialog.mount, written.pose).unit_doubt() {
                error_row(ui, Mark::Look, &UserError::of(&doubt));
            }
        }
        Err(_) if dialog.numbers.trim().is_empty() => {}
        Err(error) => error_row(ui, Mark::Bad, &what_and_advice(error).into()),
    }
    ui.add_space(space::SMALL);
    name(ui, dialog);
    ui.add_space(space::SMALL);
    if use_it(ui, typed.is_ok()) {
        caused.push(RobotAction::UseTyped);
    }
}

fn convention(ui: &mut Ui, convention: &mut Convention) {
    let chosen = *convention;
    let title = described(&chosen);
    let label = text!("robot-numbers-are-of", convention = &title);
    drop_down(ui, &label, &title, 240.0, |ui| {
        for other in Convention::ALL {
            ui.selectable_value(convention, other, described(&other));
        }
    });
}
