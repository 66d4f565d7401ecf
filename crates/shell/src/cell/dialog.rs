//! The frame of the dialog with its pages and the last error, the pages about a calibration, and the controls that pages share.

use egui::{Checkbox, Context, Grid, RichText, ScrollArea, Ui, vec2};

use crate::{
    cell::{
        answering, check_page,
        dialog_state::{
            RobotAction, RobotDialog, RobotFile, RobotPage, RobotQuestion, SolvedPairs,
        },
        state::{RobotCell, edited},
    },
    inspection::source::file_name,
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
    widgets::{
        self, Mark, default_button, drop_down, error_row, heading, row, sentence, text_button,
        value_button,
    },
};

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 640.0;
/// Part of the window's height that the pages leave free, for heading, buttons, edges, and a notice above the dialog, logical
/// pixels.
const MARGIN: f32 = 220.0;

/// Room above the dialog, for a notice, logical pixels.
const TOP_MARGIN_PX: f32 = 48.0;

impl RobotCell {
    /// Draws the dialog while it is open; returns the user's actions.
    pub fn ui(&self, ctx: &Context, session: &Session) -> Vec<RobotAction> {
        let Some(known) = self.dialog() else {
            return Vec::new();
        };
        let mut dialog = known.clone();
        let mut caused = Vec::new();
        let modal = widgets::dialog_below(ctx, "robot", TOP_MARGIN_PX, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 80.0));
            ui.heading(text!("robot-title"));
            ui.add_space(space::SMALL);
            ui.horizontal_wrapped(|ui| {
                for page in RobotPage::ALL {
                    value_button(ui, &mut dialog.page, page, page.title());
                }
            });
            ui.separator();
            let room = ctx.content_rect().height() - MARGIN;
            ScrollArea::vertical()
                .max_height(room)
                .min_scrolled_height(room)
                .auto_shrink([false, true])
                .show(ui, |ui| {
                    self.page(ui, session, &mut dialog, &mut caused);
                });
            ui.separator();
            if text_button(ui, &text!("shell-close")).clicked() {
                caused.push(RobotAction::Close);
            }
        });
        if modal.should_close() && caused.is_empty() {
            caused.push(RobotAction::Close);
        }
        if dialog != *known {
            caused.insert(0, RobotAction::Edit(Box::new(dialog)));
        }
        caused
    }

    /// Draws the page in front and the last error.
    fn page(
        &self,
        ui: &mut Ui,
        session: &Session,
        dialog: &mut RobotDialog,
        caused: &mut Vec<RobotAction>,
    ) {
        match dialog.page {
            RobotPage::InUse => in_use(ui, self, session, dialog, caused),
            RobotPage::ByHand => by_hand(ui, dialog, caused),
            RobotPage::FromPairs => {
                from_pairs(ui, self, session.convention, dialog, caused);
            }
            // This page shows the error itself, above its list.
            RobotPage::Check => return check_page::ui(ui, self, session, dialog, caused),
            RobotPage::Answer => answering::page(ui, self, session, dialog, caused),
        }
        if let Some(error) = &dialog.problem {
            ui.add_space(space::SMALL);
            error_row(ui, Mark::Bad, error);
        }
    }
}

/// Draws the page about the calibration in use.
fn in_use(
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
fn pose(ui: &mut Ui, name: &str, transform: &RigidTransform, convention: Convention) {
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

/// Draws the page for typing the camera's pose.
fn by_hand(ui: &mut Ui, dialog: &mut RobotDialog, caused: &mut Vec<RobotAction>) {
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

/// Height of the table of residuals, logical pixels.
const TABLE_HEIGHT_PX: f32 = 170.0;
/// Height of a row of figures, logical pixels.
const ROW_HEIGHT_PX: f32 = 20.0;

/// Draws the page for hand-eye calibration.
fn from_pairs(
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
        fit_figures(ui, &found);
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

fn fit_figures(ui: &mut Ui, found: &SolvedPairs) {
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

/// Draws the choice of what the camera is fixed to.
fn mounts(ui: &mut Ui, dialog: &mut RobotDialog) {
    ui.horizontal(|ui| {
        for (mount, text) in [
            (Mount::EyeToHand, text!("robot-camera-in-cell")),
            (Mount::EyeInHand, text!("robot-camera-on-flange")),
        ] {
            value_button(ui, &mut dialog.mount, mount, text);
        }
    });
}

/// Draws the field for the name of a new calibration.
fn name(ui: &mut Ui, dialog: &mut RobotDialog) {
    ui.horizontal(|ui| {
        let label = ui.label(text!("robot-name-of-cell"));
        ui.add(egui::TextEdit::singleline(&mut dialog.name).desired_width(280.0))
            .labelled_by(label.id);
    });
}

/// Draws the button that uses the calibration of the page.
fn use_it(ui: &mut Ui, is_there: bool) -> bool {
    widgets::default_button(ui, &text!("robot-use-it"), is_there)
}
