//! Universal Robots' and Doosan's scripts: calls with named arguments.

use super::{
    JOINT_SPEED, Lines, Program, ProgramFormat,
    steps::{Motion, Step},
    text,
};
use geometry::rigid::RigidTransform;

const WIDTH: usize = 98;
/// Joint speed limit of both makers' arms, rad/s.
const FASTEST_JOINT: f64 = std::f64::consts::PI;

pub(super) fn write_urscript(
    program: &Program<'_>,
    steps: &[Step],
    header: &[String],
    name: &str,
) -> Lines {
    let settings = program.settings;
    let pose = |pose: &RigidTransform| {
        format!(
            "p[{}]",
            text::numbers(ProgramFormat::UrScript, pose).join(", ")
        )
    };
    let gun = |is_on: bool| {
        let state = if is_on { "True" } else { "False" };
        format!(
            "  set_standard_digital_out({}, {state})",
            settings.gun_output
        )
    };
    let mut lines = Lines::default();
    lines.add(format!("def {name}():"));
    for comment in text::comments(header, WIDTH) {
        lines.add(format!("  # {comment}"));
    }
    if let Some(tool) = &settings.flange_from_nozzle {
        lines.add(format!("  set_tcp({})", pose(tool)));
    }
    lines.add(gun(false));
    let acceleration = text::fixed(program.line_acceleration(), 3);
    for step in steps {
        match step.motion {
            Motion::Joints(_) => {
                let speed = text::fixed(JOINT_SPEED * FASTEST_JOINT, 3);
                lines.instruct(format!("  movej({}, a=0.5, v={speed})", pose(&step.to)));
            }
            Motion::Line(line) => {
                lines.instruct(format!(
                    "  movel({}, a={acceleration}, v={}, r={})",
                    pose(&step.to),
                    text::fixed(line.speed, 6),
                    text::fixed(line.blend, 5)
                ));
            }
        }
        lines_gun(&mut lines, step.gun().map(gun));
    }
    lines.add(gun(false));
    lines.add("end");
    lines
}

pub(super) fn write_drl(program: &Program<'_>, steps: &[Step], header: &[String]) -> Lines {
    let settings = program.settings;
    let pose = |pose: &RigidTransform| {
        format!(
            "posx({})",
            text::numbers(ProgramFormat::Drl, pose).join(", ")
        )
    };
    let gun = |is_on: bool| {
        let state = if is_on { "ON" } else { "OFF" };
        format!("set_digital_output({}, {state})", settings.gun_output)
    };
    let mut lines = Lines::default();
    for comment in text::comments(header, WIDTH) {
        lines.add(format!("# {comment}"));
    }
    lines.add(format!("set_tcp(\"{}\")", program.tool(ProgramFormat::Drl)));
    lines.add(gun(false));
    let acceleration = text::fixed(1000.0 * program.line_acceleration(), 1);
    for step in steps {
        match step.motion {
            Motion::Joints(_) => {
                let speed = (JOINT_SPEED * FASTEST_JOINT).to_degrees();
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
        lines_gun(&mut lines, step.gun().map(gun));
    }
    lines.add(gun(false));
    lines
}

fn lines_gun(lines: &mut Lines, gun: Option<String>) {
    if let Some(gun) = gun {
        lines.instruct(gun);
    }
}
