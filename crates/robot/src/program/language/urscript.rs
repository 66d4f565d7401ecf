//! Universal Robots' script: one function.
//!
//! Poses p[…]; speeds in m/s; accelerations `a`; blends `r`; the gun by `set_standard_digital_out`. The controller runs what
//! follows a blended move as it enters the blend, so a blend is at most 5 mm where the gun switches. There are no external
//! axes. Universal Robots, *Script Manual*, and *User Manual*, "Blending".
//!
//! A line moves all positions, from where they are as `track_conveyor_linear` begins. So the function gets the count at which
//! the part was where the path is, and moves the frame by the way since then; its other argument is that of
//! `track_conveyor_linear`. The encoder is set up before (`encoder_enable_pulse_decode`). *Script Manual*, and *Conveyor
//! tracking guide (CB3 ≥ 3.8 and e-Series ≥ 5.2)*.

use nalgebra::Vector3;

use super::{Motion, RobotLanguage, Step, ToolName, Tracking};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program,
        text::{self, Lines},
    },
};
use geometry::rigid::RigidTransform;

pub(in crate::program) static URSCRIPT: RobotLanguage = RobotLanguage {
    name: "urscript",
    title: "URScript",
    maker: "Universal Robots",
    ending: "script",
    convention: Convention::UniversalRobots,
    tool: ToolName::Active,
    speeds: [0.001, 3.0],
    outputs: 0..=7,
    max_switching_blend: 0.005,
    switches_at: 0.0,
    rail_axis: None,
    // The arms have no spherical wrist, so they cannot be checked.
    configuration: None,
    max_name: 64,
    reserved: &[WORDS],
    is_case_sensitive: true,
    tracking: Some(Tracking {
        what: "encoder",
        numbers: 0..=1,
    }),
    calls: None,
    comment_width: 98,
    line_end: "\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

/// Also the functions that a program calls: it would call itself instead.
const WORDS: &str = "False True and break continue def elif else end global halt if join kill local not or \
    return run sec thread while xor movej movel set_standard_digital_out set_tcp track_conveyor_linear \
    stop_conveyor_tracking encoder_get_tick_count encoder_unwind_delta_tick_count pose_trans count ticks_per_meter way \
    frame";
/// Joint speed limit of the arms, rad/s.
const MAX_JOINT_SPEED_RAD_S: f64 = std::f64::consts::PI;

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], name: &str) -> Lines {
    let settings = program.settings;
    let pose = |pose: &RigidTransform| {
        format!("p[{}]", text::numbers(URSCRIPT.convention, pose).join(", "))
    };
    let gun = |is_on: bool| {
        let state = if is_on { "True" } else { "False" };
        format!(
            "  set_standard_digital_out({}, {state})",
            settings.params.gun_output
        )
    };
    let mut lines = Lines::default();
    let tracking = settings.tracking.as_ref();
    let arguments = tracking.map_or("", |_| "count, ticks_per_meter");
    lines.add(format!("def {name}({arguments}):"));
    for comment in comments {
        lines.add(format!("  # {comment}"));
    }
    if let Some(tool) = &settings.flange_from_nozzle {
        lines.add(format!("  set_tcp({})", pose(tool)));
    }
    lines.add(gun(false));
    if let Some(frame) = tracking {
        let number = frame.number;
        let direction = frame.robot_from_frame * Vector3::x();
        let direction: Vec<String> = direction.iter().map(|part| text::fixed(*part, 6)).collect();
        lines.add(format!(
            "  track_conveyor_linear(p[{}, 0, 0, 0], ticks_per_meter, {number})",
            direction.join(", ")
        ));
        lines.add(format!(
            "  way = encoder_unwind_delta_tick_count({number}, encoder_get_tick_count({number}) - count) / ticks_per_meter"
        ));
        lines.add(format!(
            "  frame = pose_trans({}, p[way, 0, 0, 0, 0, 0])",
            pose(&frame.robot_from_frame)
        ));
    }
    let target = |to: &RigidTransform| match tracking {
        Some(_) => format!("pose_trans(frame, {})", pose(&program.in_frame(to))),
        None => pose(to),
    };
    let acceleration = text::fixed(program.line_acceleration(), 3);
    for step in steps {
        match step.motion {
            Motion::Joints(_) => {
                let speed = text::fixed(JOINT_SPEED_SHARE * MAX_JOINT_SPEED_RAD_S, 3);
                lines.instruct(format!("  movej({}, a=0.5, v={speed})", target(&step.to)));
            }
            Motion::Line(line) => {
                lines.instruct(format!(
                    "  movel({}, a={acceleration}, v={}, r={})",
                    target(&step.to),
                    text::fixed(line.speed, 6),
                    text::fixed(line.blend, 5)
                ));
            }
        }
        if let Some(is_on) = step.gun() {
            lines.instruct(gun(is_on));
        }
    }
    lines.add(gun(false));
    if tracking.is_some() {
        lines.add("  stop_conveyor_tracking()");
    }
    lines.add("end");
    lines
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

    use crate::program::tests::read::{Move, Read, Reader, between, numbers};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "paint",
        tool: "",
        accelerations: [Some(1.2), Some(4.0)],
        speed_step: 0.5e-6,
        stops: false,
        switches_before: 0.005,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        let pose = |line: &str| {
            let n = numbers(between(line, "p[", "]"));
            let turn = UnitQuaternion::from_scaled_axis(Vector3::new(n[3], n[4], n[5]));
            Isometry3::from_parts(Translation3::new(n[0], n[1], n[2]), turn)
        };
        let mut blend = None;
        for line in text.lines().map(str::trim) {
            if let Some(comment) = line.strip_prefix("# ") {
                read.comments.push(comment.into());
            } else if let Some(name) = line.strip_prefix("def ") {
                let (name, arguments) = name.split_once('(').expect("arguments");
                read.name = name.into();
                assert!(["):", "count, ticks_per_meter):"].contains(&arguments));
            } else if let Some(rest) = line.strip_prefix("track_conveyor_linear(p[") {
                let (direction, encoder) = rest.split_once("], ticks_per_meter, ").expect("both");
                read.tracking = encoder.trim_end_matches(')').into();
                let n = numbers(direction);
                assert_eq!(n[3..], [0.0; 3]);
                read.direction = Some(Vector3::new(n[0], n[1], n[2]));
            } else if line.starts_with("stop_conveyor_tracking") {
                read.has_left = true;
            } else if let Some(rest) = line.strip_prefix("set_standard_digital_out(") {
                let (output, state) = rest.split_once(", ").expect("two");
                read.output = output.into();
                read.is_gun_on = state == "True)";
                // What follows a blended move runs as its blend begins.
                if let Some((last, blend)) = read.moves.last_mut().zip(blend) {
                    last.switches_before = blend;
                }
            } else if let Some(tool) = line.strip_prefix("set_tcp") {
                read.tool = tool.into();
            } else if line.starts_with("move") {
                let is_line = line.starts_with("movel(");
                let value = |name: &str| numbers(line.split_once(name).expect(name).1)[0];
                let in_frame = line.contains("(pose_trans(frame, p[");
                assert_eq!(in_frame, !read.tracking.is_empty());
                blend = is_line.then(|| value(" r="));
                read.moves.push(Move {
                    to: pose(line),
                    speed: is_line.then(|| value(" v=")),
                    is_gun_on: read.is_gun_on,
                    is_exact: !is_line || value(" r=") == 0.0,
                    acceleration: is_line.then(|| value(" a=")),
                    switches_before: 0.0,
                    configuration: String::new(),
                    rail: None,
                });
            }
        }
        assert!(text.ends_with("end\n"));
        read
    }
}
