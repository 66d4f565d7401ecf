//! The card's section on the pose for a robot: in one convention, and always with its frame.

use egui::{Align, Layout, RichText, Ui};

use super::hold::Hold;
use crate::workspaces::inspect::state::InspectAction;
use geometry::rigid::RigidTransform;
use robot::{Convention, RobotPose, RobotValue, Unit};
use shell::{
    action::Action, inspection::inspected::Inspected, language::convention_meaning,
    session::Session,
};
use ui::{
    language::{described, text},
    theme::{Theme, font, space},
    widgets::{drop_down, heading, row},
};

/// An accepted pose in the chosen convention.
#[derive(Clone, Debug)]
pub(super) struct NumberedPose {
    /// `camera_from_part` or `robot_from_part`.
    pub(super) name: &'static str,
    /// The frame of the pose, in words.
    pub(super) frame: String,
    /// The pose as numbers.
    pub(super) pose: RobotPose,
}

/// Returns the pose in the robot's frame if a robot may act on it, else in the camera's, to be read only; `None` unless
/// accepted, or if a person has reported that it is another part.
pub(super) fn numbered(session: &Session, inspected: &Inspected) -> Option<NumberedPose> {
    if session.shift.reported_as(inspected).is_some() {
        return None;
    }
    let camera_from_part = accepted_pose(inspected)?;
    let (name, frame, transform) = if let Ok(robot) = Hold::robot_of_files(session, inspected) {
        (
            "robot_from_part",
            text!("inspect-robot-frame", name = described(&robot.name)),
            robot.robot_from_part(&camera_from_part),
        )
    } else {
        let frame = match session.robot_of(inspected) {
            Some(_) => text!("inspect-camera-frame-only"),
            None => text!("inspect-camera-frame"),
        };
        ("camera_from_part", frame, camera_from_part)
    };
    Some(NumberedPose {
        name,
        frame,
        pose: session.convention.write(&transform),
    })
}

fn accepted_pose(inspected: &Inspected) -> Option<RigidTransform> {
    let inspection = &inspected.inspection;
    let pose = inspection.pose.as_ref()?.as_ref().ok()?;
    inspection
        .verdict
        .is_accepted()
        .then(|| pose.camera_from_part())
}

/// Formats the pose for the clipboard: a title, a line with names and units, then the bare numbers.
pub(super) fn clipboard_text(numbered: &NumberedPose) -> String {
    let NumberedPose { name, frame, pose } = numbered;
    let title = described(&pose.convention);
    let meaning = convention_meaning(pose.convention);
    let rounded: Vec<String> = pose.values.iter().map(RobotValue::rounded).collect();
    let numbers = match pose.convention {
        Convention::Matrix => {
            let rows: Vec<String> = rounded.chunks(4).map(|row| row.join(" ")).collect();
            rows.join("\n")
        }
        _ => format!("{}\n{}", pose.line(), rounded.join(" ")),
    };
    format!("{name} · {title} · {frame} · {meaning}\n{numbers}")
}

/// Draws the section; nothing unless there is a pose for a robot.
pub(super) fn ui(
    ui: &mut Ui,
    inspected: &Inspected,
    session: &Session,
    actions: &mut Vec<InspectAction>,
) {
    let theme = Theme::of(ui);
    let Some(numbered) = numbered(session, inspected) else {
        return;
    };
    heading(ui, &text!("shell-pose"));
    ui.scope(|ui| {
        // Text on the card is lower, but this is a control.
        ui.spacing_mut().interact_size.y = space::TARGET;
        choice(ui, session.convention, actions);
    });
    let NumberedPose { name, frame, pose } = &numbered;
    let small = |text: &str| RichText::new(text.to_owned()).small().weak();
    ui.label(RichText::new(*name).font(font::body_strong()));
    // Warn: numbers in the wrong frame move a robot to the wrong place.
    let colour = if *name == "robot_from_part" {
        theme.weak_text
    } else {
        theme.warning
    };
    ui.label(small(frame).color(colour));
    if pose.convention == Convention::Matrix {
        ui.columns(4, |columns| {
            for (index, column) in columns.iter_mut().enumerate() {
                column.with_layout(Layout::top_down(Align::Max), |ui| {
                    for value in pose.values.iter().skip(index).step_by(4) {
                        // As many digits as fit; the clipboard has more.
                        ui.label(format!("{:.4}", value.value));
                    }
                });
            }
        });
    } else {
        for value in &pose.values {
            let unit = match value.unit {
                Unit::Degrees => "°".to_owned(),
                unit => format!(" {}", unit.symbol()),
            };
            let text = format!("{}{unit}", value.rounded());
            row(ui, value.name, text.trim_end());
        }
    }
    ui.label(small(&convention_meaning(pose.convention)));
    if let Some(note) = &pose.gimbal_note {
        ui.colored_label(theme.warning, note);
    }
}

fn choice(ui: &mut Ui, chosen: Convention, actions: &mut Vec<InspectAction>) {
    let mut convention = chosen;
    let title = described(&chosen);
    let label = text!("inspect-convention-of", name = &title);
    let width = ui.available_width();
    drop_down(ui, &label, &title, width, |ui| {
        for other in Convention::ALL {
            ui.selectable_value(&mut convention, other, described(&other));
        }
    })
    .on_hover_text(text!("inspect-convention-says"));
    if convention != chosen {
        actions.push(InspectAction::Act(Action::UseConvention(convention)));
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use geometry::rigid::from_euler_zyx;
    use inspection::pipeline::Verdict;
    use robot::RobotFrame;
    use shell::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::Shown,
    };

    #[test]
    fn what_is_copied_says_which_pose_it_is_and_reads_back() {
        let mut session = Session {
            convention: Convention::Fanuc,
            ..Session::default()
        };
        let show = |session: &mut Session, inspected| {
            session.shown = Some(Shown::new(1, Arc::new(inspected)));
        };
        show(&mut session, inspected_cell(CellChoice::InTurn, 1));
        let shown =
            |session: &Session| Arc::clone(&session.shown.as_ref().expect("shown").inspected);
        let inspected = shown(&session);
        let camera_from_part = accepted_pose(&inspected).expect("accepted");
        let robot = RobotFrame {
            robot_from_camera: from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]),
            name: "cell 1".into(),
        };
        for robot in [None, Some(Arc::new(robot))] {
            session.robot = robot;
            let text = clipboard_text(&numbered(&session, &inspected).expect("a pose"));
            let lines: Vec<&str> = text.lines().collect();
            let (name, expected) = match &session.robot {
                Some(robot) => ("robot_from_part", robot.robot_from_part(&camera_from_part)),
                None => ("camera_from_part", camera_from_part),
            };
            assert!(
                lines[0].starts_with(&format!("{name} · FANUC W P R · ")),
                "{text}"
            );
            assert!(lines[0].contains("R = Rz(R)·Ry(P)·Rx(W)"), "{text}");
            let numbers: Vec<f64> = lines[2]
                .split(' ')
                .map(|word| word.parse().expect("a number"))
                .collect();
            let read = Convention::Fanuc.read(&numbers).expect("a pose");
            assert!(
                (read.to_homogeneous() - expected.to_homogeneous()).amax() < 2e-6,
                "{text}"
            );
        }
        // A part that a person has reported as wrong has no pose for a robot.
        let part = inspected.hung().clone();
        session.shift.labelled = vec![(part, inspection::library::Truth::NotEnrolled)];
        assert!(numbered(&session, &inspected).is_none());
        session.shift.labelled = Vec::new();
        // Nor has one that is not accepted.
        let mut refused = inspected_cell(CellChoice::InTurn, 1);
        if let Verdict::Part { rejected, part, .. } = &mut refused.inspection.verdict {
            *rejected = Some(inspection::pipeline::Rejection::NotSteady { part: part.clone() });
        }
        show(&mut session, refused);
        assert!(numbered(&session, &shown(&session)).is_none());
    }
}
