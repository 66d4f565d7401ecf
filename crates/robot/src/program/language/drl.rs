//! Doosan Robot Language: a script without a function.
//!
//! Poses posx; speeds `vel` in mm/s; accelerations `acc`; blends `radius`; the gun by `set_digital_output`. Outputs run ahead
//! of a blended move, at a moment that could not be established, so the robot stops at the point where the gun switches.
//! There are no external axes. Doosan, *Programming Manual*, motion and I/O.
//!
//! What was looked for, to switch without a stop, and not found:
//!
//! - An output tied to a place on the path. Public examples set outputs a time after an asynchronous move has begun.
//! - Asynchronous moves that blend. Doosan's own Python (`DSR_ROBOT.py` of its ROS package) sets the radius of `amovel` to 0,
//!   so each of them ends in a stop. `amovesx` follows many points, but at one speed, and these paths have one for each.
//! - A thread (`thread_run`, called again every 10 ms) that reads `get_current_posx` and sets the output while the program
//!   moves on. Threads beside moves are used for communication only. Whether pose and outputs can be used in one during a
//!   `movel`, which waits for its end, is not documented, and over ROS such a move was reported to block the pose.

use super::{Motion, RobotLanguage, Step, ToolName};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program,
        text::{self, Lines},
    },
};
use geometry::rigid::RigidTransform;

pub(in crate::program) static DRL: RobotLanguage = RobotLanguage {
    name: "drl",
    title: "Doosan DRL",
    maker: "Doosan",
    ending: "drl",
    convention: Convention::Doosan,
    tool: ToolName::Name,
    speeds: [0.001, 1.0],
    outputs: 1..=16,
    max_switching_blend: 0.0,
    switches_at: 0.5,
    rail_axis: None,
    // The arms cannot be checked.
    configuration: None,
    max_name: 64,
    // Programs do not contain their names.
    reserved: &[],
    is_case_sensitive: false,
    tracking: None,
    calls: None,
    comment_width: 98,
    line_end: "\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

/// Joint speed limit of the arms, rad/s.
const MAX_JOINT_SPEED_RAD_S: f64 = std::f64::consts::PI;

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], _name: &str) -> Lines {
    let settings = program.settings;
    let pose =
        |pose: &RigidTransform| format!("posx({})", text::numbers(DRL.convention, pose).join(", "));
    let gun = |is_on: bool| {
        let state = if is_on { "ON" } else { "OFF" };
        format!(
            "set_digital_output({}, {state})",
            settings.params.gun_output
        )
    };
    let mut lines = Lines::default();
    for comment in comments {
        lines.add(format!("# {comment}"));
    }
    lines.add(format!("set_tcp(\"{}\")", program.tool(&DRL)));
    lines.add(gun(false));
    let acceleration = text::fixed(1000.0 * program.line_acceleration(), 1);
    for step in steps {
        match step.motion {
            Motion::Joints(_) => {
                let speed = (JOINT_SPEED_SHARE * MAX_JOINT_SPEED_RAD_S).to_degrees();
                lines.instruct(format!(
                    "movejx({}, vel={}, acc={}, ref=DR_BASE, sol=get_current_solution_space())",
                    pose(&step.to),
                    text::fixed(speed, 1),
                    text::fixed(2.0 * speed, 1)
                ));
            }
            Motion::Line(line) => {
                lines.instruct(format!(
                    "movel({}, vel={}, acc={acceleration}, radius={}, ref=DR_BASE)",
                    pose(&step.to),
                    text::fixed(line.speed * 1000.0, 3),
                    text::fixed(line.blend * 1000.0, 2)
                ));
            }
        }
        if let Some(is_on) = step.gun() {
            lines.instruct(gun(is_on));
        }
    }
    lines.add(gun(false));
    lines
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use crate::program::tests::read::{Move, Read, Reader, about, between, numbers, placed};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "",
        tool: "tool1",
        accelerations: [Some(1.2), Some(4.0)],
        speed_step: 0.5e-6,
        stops: true,
        switches_before: 0.0,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        for line in text.lines() {
            if let Some(comment) = line.strip_prefix("# ") {
                read.comments.push(comment.into());
            } else if let Some(tool) = line.strip_prefix("set_tcp(") {
                read.tool = tool.trim_end_matches(')').trim_matches('"').into();
            } else if let Some(rest) = line.strip_prefix("set_digital_output(") {
                let (output, state) = rest.split_once(", ").expect("two");
                read.output = output.into();
                read.is_gun_on = state == "ON)";
            } else if line.starts_with("move") {
                let n = numbers(between(line, "posx(", ")"));
                let turn = about(Vector3::z(), n[3])
                    * about(Vector3::y(), n[4])
                    * about(Vector3::z(), n[5]);
                let is_line = line.starts_with("movel(");
                assert!(line.contains("ref=DR_BASE"));
                let value = |name: &str| numbers(line.split_once(name).expect(name).1)[0];
                read.moves.push(Move {
                    to: placed(&n, turn),
                    speed: is_line.then(|| value(" vel=") / 1000.0),
                    is_gun_on: read.is_gun_on,
                    is_exact: !is_line || value(" radius=") == 0.0,
                    acceleration: is_line.then(|| value(" acc=") / 1000.0),
                    switches_before: 0.0,
                    configuration: String::new(),
                    rail: None,
                });
            }
        }
        read
    }
}
