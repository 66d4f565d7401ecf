//! The page on the calibration in use.

use egui::{Button, RichText, Ui};

use super::{
    dialog::told,
    state::{RobotAction, RobotCell, RobotDialog, RobotFile},
};
use crate::{
    app::{
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
            let text = "The cell is not calibrated: poses are in the camera's frame, and a robot cannot use them";
            ui.label(RichText::new(text).color(theme.text));
        }
        Some(in_use) => {
            figures(ui, &in_use.calibration, theme);
            row(ui, theme, "file", &in_use.path.display().to_string());
            if in_use.is_edited {
                let edited = UserError {
                    what: "the file was edited: its numbers count as entered by hand".into(),
                    advice: "Calibrate again to have residuals beside them".into(),
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
        if labelled(ui, Button::new("Load…"), "Load…").clicked() {
            caused.push(RobotAction::Ask(RobotFile::Calibration));
        }
        if in_use.is_some() && labelled(ui, Button::new("Forget"), "Forget").clicked() {
            caused.push(RobotAction::Forget);
        }
    });
}

fn figures(ui: &mut Ui, calibration: &CellCalibration, theme: &Theme) {
    row(ui, theme, "cell", &calibration.shown_with_identity());
    row(
        ui,
        theme,
        "camera",
        &sentence(calibration.camera.mount().describe()),
    );
    let made = calibration
        .made_at
        .strftime("%Y-%m-%d %H:%M UTC")
        .to_string();
    row(ui, theme, "made", &made);
    match &calibration.origin {
        Origin::ByHand => row(ui, theme, "from", "entered by hand"),
        Origin::HandEye(fit) => {
            let from = format!("{} pairs of {}", fit.num_pairs, fit.pairs_file);
            row(ui, theme, "from", &from);
            let rms = format!(
                "{:.2} mm and {:.3}° rms, worst {:.2} mm ({})",
                fit.rms_mm, fit.rms_degrees, fit.worst_mm, fit.worst_pair
            );
            row(ui, theme, "residuals", &rms);
            if let (Some(mm), Some(degrees)) = (fit.bound_mm, fit.bound_degrees) {
                let bounds = format!("{mm:.2} mm and {degrees:.3}°");
                row(ui, theme, "uncertainty (95 %)", &bounds);
            }
            for doubt in &fit.doubts {
                ui.label(RichText::new(sentence(doubt)).color(theme.warning));
            }
        }
    }
}

/// A transform in the robot's numbers, with what they mean.
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

/// Where the arm stands at a capture, for a camera on the flange.
fn arm(
    ui: &mut Ui,
    stored: Option<&RigidTransform>,
    convention: Convention,
    dialog: &mut RobotDialog,
    theme: &Theme,
    caused: &mut Vec<RobotAction>,
) {
    if let Some(stored) = stored {
        let name = "robot_from_flange at every capture";
        pose(ui, name, stored, convention, theme);
    } else {
        let unknown = UserError {
            what: "the flange pose at a capture is not known: there is no pose for the robot"
                .into(),
            advice: "Type the flange's pose as the controller shows it, and store it".into(),
        };
        told(ui, Mark::Look, &unknown, theme);
    }
    ui.horizontal(|ui| {
        let label = ui.label("Flange at a capture");
        let hint = format!("{}: {}", convention.name(), convention.names().join(" "));
        ui.add(
            egui::TextEdit::singleline(&mut dialog.arm)
                .hint_text(hint)
                .desired_width(340.0),
        )
        .labelled_by(label.id);
        let is_pose = dialog.typed_arm().is_ok();
        ui.add_enabled_ui(is_pose, |ui| {
            if labelled(ui, Button::new("Store"), "Store").clicked() {
                caused.push(RobotAction::StoreArm);
            }
        });
    });
}
