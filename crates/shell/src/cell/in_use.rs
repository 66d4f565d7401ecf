//! The page about the calibration in use.

use egui::{RichText, Ui};

use super::{
    controls::error_row,
    state::{RobotCell, edited},
};
use crate::{
    cell::dialog_state::{RobotAction, RobotDialog, RobotFile, RobotQuestion},
    language::convention_meaning,
    session::Session,
};
use geometry::rigid::RigidTransform;
use robot::{
    Convention, RobotPose,
    calibration::{CameraPlace, CellCalibration, Origin},
    hand_eye::Mount,
};
use ui::{
    language::{described, text, what_and_advice},
    theme::{Theme, space},
    user_error::UserError,
    widgets::{Mark, default_button, heading, row, sentence, text_button},
};

pub(super) fn ui(
    ui: &mut Ui,
    robot: &RobotCell,
    session: &Session,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    let in_use = robot.in_use();
    match in_use {
        None => {
            let text = text!("robot-not-calibrated");
            ui.label(text);
        }
        Some(in_use) => {
            figures(ui, &in_use.calibration);
            row(ui, &text!("robot-file"), &in_use.path.display().to_string());
            if in_use.is_edited {
                error_row(ui, Mark::Look, &edited());
                confirm(ui, dialog, caused);
            }
            let calibration = &in_use.calibration;
            let name = calibration.camera.mount().camera_transform();
            pose(
                ui,
                name,
                calibration.camera.mount_from_camera(),
                session.convention,
            );
            if let CameraPlace::OnFlange { capture_pose, .. } = &calibration.camera
                && !in_use.is_edited
            {
                arm(
                    ui,
                    capture_pose.as_ref(),
                    session.convention,
                    dialog,
                    caused,
                );
            }
        }
    }
    ui.add_space(space::MEDIUM);
    ui.horizontal(|ui| {
        if text_button(ui, &text!("robot-load")).clicked() {
            caused.push(RobotAction::Ask(RobotFile::Calibration));
        }
        if in_use.is_some() && text_button(ui, &text!("robot-forget")).clicked() {
            caused.push(RobotAction::Forget);
        }
    });
}

/// Draws the button that confirms edited numbers, or the question before.
fn confirm(ui: &mut Ui, dialog: &mut RobotDialog, caused: &mut Vec<RobotAction>) {
    if dialog.question != Some(RobotQuestion::ConfirmEdited) {
        if text_button(ui, &text!("robot-confirm")).clicked() {
            caused.push(RobotAction::Confirm);
        }
        return;
    }
    ui.label(text!("robot-confirm-says"));
    ui.horizontal(|ui| {
        if default_button(ui, &text!("robot-confirm-not"), true) {
            dialog.question = None;
        }
        if text_button(ui, &text!("robot-confirm-right")).clicked() {
            caused.push(RobotAction::Confirm);
        }
    });
}

fn figures(ui: &mut Ui, calibration: &CellCalibration) {
    let theme = Theme::of(ui);
    let name = described(&calibration.frame_name());
    row(ui, &text!("robot-cell"), &name);
    row(
        ui,
        &text!("robot-camera"),
        &sentence(&mount(calibration.camera.mount())),
    );
    let made = calibration
        .made_at
        .strftime("%Y-%m-%d %H:%M UTC")
        .to_string();
    row(ui, &text!("robot-made"), &made);
    match &calibration.origin {
        Origin::ByHand => row(ui, &text!("robot-from"), &text!("robot-entered-by-hand")),
        Origin::HandEye(fit) => {
            let from = text!(
                "robot-pairs-of",
                num = fit.num_pairs,
                file = &fit.pairs_file
            );
            row(ui, &text!("robot-from"), &from);
            let rms = text!(
                "robot-residuals-are",
                mm = format!("{:.2}", fit.rms_mm),
                degrees = format!("{:.3}", fit.rms_degrees),
                worst = format!("{:.2}", fit.worst_mm),
                pair = &fit.worst_pair
            );
            row(ui, &text!("robot-residuals"), &rms);
            if let (Some(mm), Some(degrees)) = (fit.bound_mm, fit.bound_degrees) {
                let bounds = text!(
                    "robot-mm-and-degrees",
                    mm = format!("{mm:.2}"),
                    degrees = format!("{degrees:.3}")
                );
                row(ui, &text!("robot-uncertainty"), &bounds);
            }
            for doubt in &fit.doubts {
                ui.label(RichText::new(sentence(doubt)).color(theme.warning));
            }
        }
    }
}

/// Describes what the camera is fixed to.
fn mount(mount: Mount) -> String {
    match mount {
        Mount::EyeToHand => text!("robot-eye-to-hand"),
        Mount::EyeInHand => text!("robot-eye-in-hand"),
    }
}

/// Draws a transform in the robot's convention, with the meaning of the numbers.
pub(super) fn pose(ui: &mut Ui, name: &str, transform: &RigidTransform, convention: Convention) {
    let theme = Theme::of(ui);
    let written: RobotPose = convention.write(transform);
    heading(ui, &format!("{name} · {}", described(&convention)));
    if convention == Convention::Matrix {
        for numbers in written.values.chunks(4) {
            let cells: Vec<String> = numbers.iter().map(|v| format!("{:9.5}", v.value)).collect();
            ui.label(RichText::new(cells.join("  ")).monospace());
        }
    } else {
        ui.label(written.line());
    }
    let small = |text: &str| RichText::new(text.to_owned()).small();
    ui.label(small(&convention_meaning(convention)).weak());
    if let Some(note) = &written.gimbal_note {
        ui.label(small(note).color(theme.warning));
    }
}

/// Draws the arm's pose at a capture, for a camera on the flange.
fn arm(
    ui: &mut Ui,
    stored: Option<&RigidTransform>,
    convention: Convention,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    if let Some(stored) = stored {
        let name = text!("robot-flange-at-every");
        pose(ui, &name, stored, convention);
    } else {
        let unknown = UserError {
            what: text!("robot-flange-unknown"),
            advice: text!("robot-flange-unknown-advice"),
        };
        error_row(ui, Mark::Look, &unknown);
    }
    ui.horizontal(|ui| {
        let label = ui.label(text!("robot-flange-at"));
        let hint = format!("{}: {}", convention.name(), convention.names().join(" "));
        ui.add(
            egui::TextEdit::singleline(&mut dialog.arm)
                .hint_text(hint)
                .desired_width(340.0),
        )
        .labelled_by(label.id);
        let typed = dialog.typed_arm();
        ui.add_enabled_ui(typed.is_ok(), |ui| {
            let why_not = typed.err().map(|error| what_and_advice(&error).join("\n"));
            let store = text_button(ui, &text!("shell-store"));
            let store = store.on_disabled_hover_text(why_not.unwrap_or_default());
            if store.clicked() {
                caused.push(RobotAction::StoreArm);
            }
        });
    });
}
