//! What is servoed: part, target, robot and limits.

use egui::{Button, DragValue, Role, Ui, WidgetInfo, vec2};

use super::state::chosen_part;
use crate::workspaces::servo::state::{ServoAction, ServoFile};
use geometry::oriented_box::OrientedBox;
use records::history::ServoTargetKind;
use servo::{ServoParams, simulated::StreamProtocol};
use shell::{cell::ServoSettings, language::target_title, rack::box_numbers, session::Session};
use ui::{
    language::text,
    theme::space,
    widgets::{drop_down, heading, line_edit, row, text_button},
};

/// Draws what can be chosen.
pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<ServoAction>) {
    let mut setup = session.servo.clone();
    // Robots that ask are servoed by all of it, whichever robot is chosen here.
    let is_simulated = setup.robot.is_none() && !session.answering.is_on;
    heading(ui, &text!("servoing-part-and-target"));
    part(ui, session, &mut setup);
    target(ui, is_simulated, &mut setup, actions);
    heading(ui, &text!("robot-title"));
    robot(ui, &mut setup);
    heading(ui, &text!("servoing-limits"));
    limits(ui, &mut setup);
    if !is_simulated {
        kept_clear(ui, session, &mut setup, actions);
    }
    if setup != session.servo {
        actions.push(ServoAction::SetUp(setup));
    }
}

fn part(ui: &mut Ui, session: &Session, setup: &mut ServoSettings) {
    let Some(library) = &session.library else {
        return;
    };
    let Some(chosen) = chosen_part(session) else {
        return;
    };
    let title = library.title_of(chosen);
    let label = format!("{}: {title}", text!("shell-part"));
    drop_down(
        ui,
        &label,
        title,
        ui.available_width() - space::LARGE,
        |ui| {
            for part in &library.parts {
                let name = part.name.as_str();
                if ui
                    .selectable_label(name == chosen, part.shown_title())
                    .clicked()
                {
                    setup.part = Some(name.to_owned());
                }
            }
        },
    );
}

/// Draws a button that chooses one of several values; returns whether it was pressed.
fn choice(ui: &mut Ui, is_chosen: bool, text: &str) -> bool {
    let button = Button::selectable(is_chosen, text)
        .frame_when_inactive(true)
        .min_size(vec2(space::TARGET, space::TARGET));
    let response = ui.add(button);
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), is_chosen, text));
    response.clicked()
}

fn target(
    ui: &mut Ui,
    is_simulated: bool,
    setup: &mut ServoSettings,
    actions: &mut Vec<ServoAction>,
) {
    // A simulated robot has no frames of its own.
    if is_simulated {
        row(
            ui,
            &text!("servoing-target"),
            &target_title(ServoTargetKind::StandardPosition),
        );
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for kind in ServoTargetKind::ALL {
            if choice(ui, setup.target == kind, &target_title(kind)) {
                setup.target = kind;
            }
        }
    });
    if setup.target != ServoTargetKind::CameraPose {
        return;
    }
    if text_button(ui, &text!("servoing-add-frame")).clicked() {
        actions.push(ServoAction::Ask(ServoFile::SeenAs));
    }
    let mut removed = None;
    for (index, path) in setup.seen_as.iter().enumerate() {
        ui.horizontal(|ui| {
            let remove = text!("servoing-remove-frame");
            if text_button(ui, "✕").on_hover_text(remove).clicked() {
                removed = Some(index);
            }
            ui.label(files::file_name(path))
                .on_hover_text(path.display().to_string());
        });
    }
    if let Some(index) = removed {
        setup.seen_as.remove(index);
    }
}

fn robot(ui: &mut Ui, setup: &mut ServoSettings) {
    ui.horizontal_wrapped(|ui| {
        for (robot, title) in [
            (None, text!("servoing-simulated")),
            (Some(StreamProtocol::Egm), "ABB".to_owned()),
            (Some(StreamProtocol::Rsi), "KUKA".to_owned()),
            (Some(StreamProtocol::Rtde), "Universal Robots".to_owned()),
        ] {
            if choice(ui, setup.robot == robot, &title) {
                setup.robot = robot;
            }
        }
    });
    let Some(protocol) = setup.robot else {
        ui.weak(text!("servoing-simulated-says"));
        return;
    };
    let (label, example) = match protocol {
        StreamProtocol::Egm => (text!("servoing-listen-at"), "192.168.1.10:6510"),
        StreamProtocol::Rsi => (text!("servoing-listen-at"), "192.168.1.10:49152"),
        StreamProtocol::Rtde => (text!("servoing-connect-to"), "192.168.1.20"),
    };
    let name = ui.label(label);
    ui.add(line_edit(
        &mut setup.address,
        example.to_owned(),
        f32::INFINITY,
    ))
    .labelled_by(name.id);
    ui.weak(text!("servoing-no-safety"));
}

fn limits(ui: &mut Ui, setup: &mut ServoSettings) {
    for (name, value, range, unit) in [
        (
            text!("servoing-speed"),
            &mut setup.speed,
            ServoParams::SPEEDS_MM_S,
            " mm/s",
        ),
        (
            text!("servoing-tolerance"),
            &mut setup.tolerance,
            ServoParams::TOLERANCES_MM,
            " mm",
        ),
        (
            text!("servoing-clearance"),
            &mut setup.clearance,
            ServoParams::CLEARANCES_MM,
            " mm",
        ),
    ] {
        ui.horizontal(|ui| {
            let drag = DragValue::new(value)
                .range(range)
                .max_decimals(1)
                // Or a robot would be moved by the first figures of a number.
                .update_while_editing(false)
                .suffix(unit);
            let response = ui.add(drag);
            let label = ui.label(name);
            response.labelled_by(label.id);
        });
    }
    ui.checkbox(&mut setup.in_steps, text!("servoing-in-steps"))
        .on_hover_text(text!("servoing-in-steps-hint"));
}

/// Draws what a robot keeps within, and clear of.
fn kept_clear(
    ui: &mut Ui,
    session: &Session,
    setup: &mut ServoSettings,
    actions: &mut Vec<ServoAction>,
) {
    volume(ui, &mut setup.volume);
    let program = &session.program;
    let arm = program.arm_title().unwrap_or_else(|| text!("paint-no-arm"));
    row(ui, &text!("servoing-arm"), &arm);
    let nozzle = match program.nozzle.trim() {
        "" => text!("servoing-no-nozzle"),
        nozzle => nozzle.to_owned(),
    };
    row(ui, &text!("servoing-nozzle"), &nozzle);
    if text_button(ui, &text!("servoing-to-robot")).clicked() {
        actions.push(ServoAction::GoToRobot);
    }
}

/// A volume to begin with: in front of a robot at the origin.
const FIRST_VOLUME: OrientedBox = OrientedBox {
    centre_m: [1.0, 0.0, 1.0],
    size_m: [2.0, 2.0, 2.0],
    angles_rad: [0.0; 3],
};

/// Draws the box that flange, camera and nozzle never leave.
fn volume(ui: &mut Ui, volume: &mut Option<OrientedBox>) {
    let mut is_bounded = volume.is_some();
    let checkbox = ui.checkbox(&mut is_bounded, text!("rack-volume"));
    if checkbox
        .on_hover_text(text!("servoing-volume-says"))
        .changed()
    {
        *volume = is_bounded.then_some(FIRST_VOLUME);
    }
    if let Some(region) = volume {
        box_numbers(ui, region);
    }
}
