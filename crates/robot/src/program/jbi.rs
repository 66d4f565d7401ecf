//! Yaskawa's job, with Cartesian positions in the base frame instead of pulses, so that it fits any arm.

use jiff::tz::TimeZone;

use super::{
    JOINT_SPEED, Lines, Program, ProgramFormat,
    steps::{Motion, Step},
    text,
};

/// Letters of a comment.
const WIDTH: usize = 32;
/// No flip, upper arm, front, no turns; used if the configuration is not known.
const USUAL: &str = "1,0,0,0,0,0";
/// Unused numbers at the end of RCONF.
const UNUSED: usize = 18;

pub(super) fn write(program: &Program<'_>, steps: &[Step], header: &[String], name: &str) -> Lines {
    let output = program.settings.gun_output;
    let mut lines = Lines::default();
    lines.add("/JOB");
    lines.add(format!("//NAME {}", name.to_uppercase()));
    lines.add("//POS");
    // Positions of the robot, and of its rail as base axis.
    let num_rails = steps.iter().filter(|step| step.rail.is_some()).count();
    lines.add(format!("///NPOS {},{num_rails},0,0,0,0", steps.len()));
    lines.add(format!("///TOOL {}", program.tool(ProgramFormat::Jbi)));
    lines.add("///POSTYPE BASE");
    lines.add("///RECTAN");
    // RCONF applies to the points below it.
    let mut current = None;
    for (i, step) in steps.iter().enumerate() {
        let configuration = step.configuration.as_deref().unwrap_or(USUAL);
        if current != Some(configuration) {
            lines.add(format!("///RCONF {configuration}{}", ",0".repeat(UNUSED)));
            current = Some(configuration);
        }
        let numbers = text::numbers(ProgramFormat::Jbi, &step.to);
        lines.add(format!("C{i:05}={}", numbers.join(",")));
    }
    for (i, step) in steps.iter().enumerate() {
        if let Some(rail) = step.rail {
            lines.add(format!("BC{i:05}={}", text::rail_mm(rail)));
        }
    }
    begin(
        &mut lines,
        program,
        &["///ATTR SC,RW,RJ", "////FRAME BASE"],
        header,
    );
    let gun = |is_on: bool| {
        let state = if is_on { "ON" } else { "OFF" };
        format!("DOUT OT#({output}) {state}")
    };
    lines.instruct(gun(false));
    // The gun switches as the next move begins: NWAIT runs the instructions up to the next move during this one.
    let (mut switches, mut is_during) = (None, false);
    for (i, step) in steps.iter().enumerate() {
        let rail = step.rail.map(|_| format!(" BC{i:05}"));
        let place = format!("C{i:05}{}", rail.unwrap_or_default());
        let motion = match step.motion {
            Motion::Joints(_) => {
                let share = text::fixed(JOINT_SPEED * 100.0, 2);
                format!("MOVJ {place} VJ={share} PL=0")
            }
            Motion::Line(line) => {
                let speed = text::fixed(line.speed * 1000.0, 1);
                let end = if line.blend > 0.0 { "" } else { " PL=0" };
                format!("MOVL {place} V={speed}{end}")
            }
        };
        let switched = std::mem::replace(&mut switches, step.gun());
        is_during = switched.is_some();
        if let Some(is_on) = switched {
            lines.instruct(format!("{motion} NWAIT"));
            lines.instruct(gun(is_on));
        } else {
            lines.instruct(motion);
        }
    }
    if is_during {
        lines.instruct("CWAIT");
    }
    lines.instruct(gun(false));
    lines.instruct("END");
    lines
}

/// Writes a job without positions that calls others, one after the other.
pub(super) fn write_calls(
    program: &Program<'_>,
    parts: &[String],
    header: &[String],
    name: &str,
) -> Lines {
    let mut lines = Lines::default();
    lines.add("/JOB");
    lines.add(format!("//NAME {}", name.to_uppercase()));
    lines.add("//POS");
    lines.add("///NPOS 0,0,0,0,0,0");
    begin(&mut lines, program, &["///ATTR SC,RW"], header);
    for part in parts {
        lines.instruct(format!("CALL JOB:{}", part.to_uppercase()));
    }
    lines.instruct("END");
    lines
}

/// Writes the lines between the positions and the moves.
fn begin(lines: &mut Lines, program: &Program<'_>, attributes: &[&str], header: &[String]) {
    lines.add("//INST");
    let at = program.at.to_zoned(TimeZone::UTC);
    lines.add(format!("///DATE {}", at.strftime("%Y/%m/%d %H:%M")));
    lines.add("///COMM Partsight");
    for attribute in attributes {
        lines.add(attribute);
    }
    lines.add(if program.moves_on_rail() {
        "///GROUP1 RB1,BS1"
    } else {
        "///GROUP1 RB1"
    });
    lines.instruct("NOP");
    for comment in text::comments(header, WIDTH) {
        lines.instruct(format!("'{comment}"));
    }
}
