//! The page about the calibration in use.

use egui::{Button, RichText, Ui};

use super::{
    dialog::told,
    state::{RobotAction, RobotCell, RobotDialog, RobotFile},
};
use crate::{
    app::{
        language::text,
        shell::session::Session,
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, heading, labelled, row, sentence},
        },
        user_error::UserError,
    },
    geometry::rigid::RigidTransform,
    robot::{
        Convention, RobotPose,
        calibration::{CameraPlace, CellCalibration, Origin},
        hand_eye::Mount,
    },
};

pub(super) fn ui(
    ui: &mut Ui,
    robot: &RobotCell,
    session: &Session,
    dialog: &mut RobotDialog,
    theme: &Theme,
    caused: &mut Vec<RobotAction>,
) {
    let in_use = robot.in_use();
    match in_use {
        None => {
            let text = text!("robot-not-calibrated");
            ui.label(RichText::new(text).color(theme.text));
        }
        Some(in_use) => {
            figures(ui, &in_use.calibration, theme);
            row(
                ui,
                theme,
                &text!("robot-file"),
                &in_use.path.display().to_string(),
            );
            if in_use.is_edited {
                let edited = UserError {
                    what: text!("robot-edited"),
                    advice: text!("robot-edited-advice"),
                };
                told(ui, Mark::Look, &edited, theme);
            }
            let calibration = &in_use.calibration;
            let name = calibration.camera.mount().camera_transform();
            pose(
                ui,
                name,
                calibration.camera.mount_from_camera(),
                session.convention,
                theme,
            );
            if let CameraPlace::OnFlange { capture_pose, .. } = &calibration.camera {
                arm(
                    ui,
                    capture_pose.as_ref(),
                    session.convention,
                    dialog,
                    theme,
                    caused,
                );
            }
        }
    }
    ui.add_space(space::MEDIUM);
    ui.horizontal(|ui| {
        let load = text!("robot-load");
        if labelled(ui, Button::new(&*load), &load).clicked() {
            caused.push(RobotAction::Ask(RobotFile::Calibration));
        }
        let forget = text!("robot-forget");
        if in_use.is_some() && labelled(ui, Button::new(&*forget), &forget).clicked() {
            caused.push(RobotAction::Forget);
        }
    });
}

fn figures(ui: &mut Ui, calibration: &CellCalibration, theme: &Theme) {
    row(
        ui,
        theme,
        &text!("robot-cell"),
        &calibration.shown_with_identity(),
    );
    row(
        ui,
        theme,
        &text!("robot-camera"),
        &sentence(&mount(calibration.camera.mount())),
    );
    let made = calibration
        .made_at
        .strftime("%Y-%m-%d %H:%M UTC")
        .to_string();
    row(ui, theme, &text!("robot-made"), &made);
    match &calibration.origin {
        Origin::ByHand => row(
            ui,
            theme,
            &text!("robot-from"),
            &text!("robot-entered-by-hand"),
        ),
        Origin::HandEye(fit) => {
            let from = text!(
                "robot-pairs-of",
                num = fit.num_pairs,
                file = &fit.pairs_file
            );
            row(ui, theme, &text!("robot-from"), &from);
            let rms = text!(
                "robot-residuals-are",
                mm = format!("{:.2}", fit.rms_mm),
                degrees = format!("{:.3}", fit.rms_degrees),
                worst = format!("{:.2}", fit.worst_mm),
                pair = &fit.worst_pair
            );
            row(ui, theme, &text!("robot-residuals"), &rms);
            if let (Some(mm), Some(degrees)) = (fit.bound_mm, fit.bound_degrees) {
                let bounds = text!(
                    "robot-mm-and-degrees",
                    mm = format!("{mm:.2}"),
                    degrees = format!("{degrees:.3}")
                );
                row(ui, theme, &text!("robot-uncertainty"), &bounds);
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
pub(super) fn pose(
    ui: &mut Ui,
    name: &str,
    transform: &RigidTransform,
    convention: Convention,
    theme: &Theme,
) {
    let written: RobotPose = convention.write(transform);
    heading(ui, theme, &format!("{name} · {}", convention.title()));
    if convention == Convention::Matrix {
        for numbers in written.values.chunks(4) {
            let cells: Vec<String> = numbers.iter().map(|v| format!("{:9.5}", v.value)).collect();
            ui.label(
                RichText::new(cells.join("  "))
                    .monospace()
                    .color(theme.text),
            );
        }
    } else {
        ui.label(RichText::new(written.line()).color(theme.text));
    }
    let small = |text: &str| RichText::new(text.to_owned()).font(font::small());
    ui.label(small(written.meaning).color(theme.weak_text));
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
    theme: &Theme,
    caused: &mut Vec<RobotAction>,
) {
    if let Some(stored) = stored {
        let name = text!("robot-flange-at-every");
        pose(ui, &name, stored, convention, theme);
    } else {
        let unknown = UserError {
            what: text!("robot-flange-unknown"),
            advice: text!("robot-flange-unknown-advice"),
        };
        told(ui, Mark::Look, &unknown, theme);
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
        let is_pose = dialog.typed_arm().is_ok();
        ui.add_enabled_ui(is_pose, |ui| {
            let store = text!("robot-store");
            if labelled(ui, Button::new(&*store), &store).clicked() {
                caused.push(RobotAction::StoreArm);
            }
        });
    });
}
