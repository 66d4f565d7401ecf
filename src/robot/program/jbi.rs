//! Yaskawa's job, with Cartesian positions in the base frame: no pulses, so that it fits any arm.

use jiff::tz::TimeZone;

use super::{JOINT_SPEED, Lines, Program, ProgramFormat, Step, text};

/// A comment holds 32 letters.
const WIDTH: usize = 32;

pub(super) fn write(program: &Program<'_>, steps: &[Step], header: &[String], name: &str) -> Lines {
    let output = program.settings.gun_output;
    let mut lines = Lines::default();
    lines.add("/JOB");
    lines.add(format!("//NAME {}", name.to_uppercase()));
    lines.add("//POS");
    lines.add(format!("///NPOS {},0,0,0,0,0", steps.len()));
    lines.add(format!("///TOOL {}", program.tool(ProgramFormat::Jbi)));
    lines.add("///POSTYPE BASE");
    lines.add("///RECTAN");
    // No flip, upper arm, front; the other 21 do not count.
    lines.add("///RCONF 1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0");
    for (i, step) in steps.iter().enumerate() {
        let to = match step {
            Step::Joints(to) => to,
            Step::Line(line) => &line.to,
        };
        let numbers = text::numbers(ProgramFormat::Jbi, to);
        lines.add(format!("C{i:05}={}", numbers.join(",")));
    }
    lines.add("//INST");
    let at = program.at.to_zoned(TimeZone::UTC);
    lines.add(format!("///DATE {}", at.strftime("%Y/%m/%d %H:%M")));
    lines.add("///COMM Partsight");
    lines.add("///ATTR SC,RW,RJ");
    lines.add("////FRAME BASE");
    lines.add("///GROUP1 RB1");
    lines.instruct("NOP");
    for comment in text::comments(header, WIDTH) {
        lines.instruct(format!("'{comment}"));
    }
    lines.instruct(format!("DOUT OT#({output}) OFF"));
    for (i, step) in steps.iter().enumerate() {
        match step {
            Step::Joints(_) => {
                let share = text::fixed(JOINT_SPEED * 100.0, 2);
                lines.instruct(format!("MOVJ C{i:05} VJ={share} PL=0"));
            }
            Step::Line(line) => {
                let speed = text::fixed(line.speed * 1000.0, 1);
                let end = if line.blend_unless_gun() > 0.0 {
                    ""
                } else {
                    " PL=0"
                };
                lines.instruct(format!("MOVL C{i:05} V={speed}{end}"));
                if let Some(is_on) = line.gun {
                    let state = if is_on { "ON" } else { "OFF" };
                    lines.instruct(format!("DOUT OT#({output}) {state}"));
                }
            }
        }
    }
    lines.instruct(format!("DOUT OT#({output}) OFF"));
    lines.instruct("END");
    lines
}
