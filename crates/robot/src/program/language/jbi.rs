//! Yaskawa's job (INFORM), with Cartesian positions in the base frame instead of pulses, so that it fits any arm.
//!
//! Poses X Y Z Rx Ry Rz, RECTAN in BASE; speeds `V` in mm/s; accelerations those of the arm, since JBI states them only as
//! shares of it; blends of no given radius, none at `PL=0`; the gun by `DOUT OT#` as the next move begins, since `NWAIT` runs
//! instructions during a move. The rail is BC, base axis 1. Yaskawa, *DX100 Options: Instructions for Data Transmission*,
//! job data format, and *Instructions for INFORM Language*, "NWAIT".
//!
//! Configuration: `RCONF`. First: 1 no flip, B < 0; second: 1 lower arm; third: 1 behind axis 1; then R, T and S: 1 from
//! ±180° on. If it is not known, the usual one. The first book, "RCONF". Uncertain: it draws the elbow with the wrist in
//! front only. Yaskawa's older manuals (NX100) define flip by R instead; jobs recorded on a YRC1000 use B, and the elbow
//! behind joint 1 as here.

use jiff::tz::TimeZone;

use super::{Calls, Motion, RobotLanguage, Step, ToolName};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program,
        configuration::Posture,
        text::{self, Lines},
    },
};

pub(in crate::program) static JBI: RobotLanguage = RobotLanguage {
    name: "jbi",
    title: "Yaskawa JBI",
    maker: "Yaskawa",
    ending: "jbi",
    convention: Convention::Yaskawa,
    tool: ToolName::Number(63),
    speeds: [0.001, 1.5],
    outputs: 1..=4096,
    max_switching_blend: f64::INFINITY,
    switches_at: 0.5,
    rail_axis: Some("BC, base axis 1"),
    configuration: Some(configuration),
    max_name: 32,
    // The format has a field for the name.
    reserved: &[],
    is_case_sensitive: false,
    tracking: None,
    calls: Some(Calls {
        max_instructions: 9999,
        num_switch_instructions: 1,
        write: write_calls,
    }),
    comment_width: 32,
    line_end: "\r\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

/// RCONF cannot express turns beyond this, degrees.
const MAX_TURN_DEG: f64 = 360.0;
/// No flip, upper arm, front, no turns; used if the configuration is not known.
const DEFAULT_CONFIGURATION: &str = "1,0,0,0,0,0";
/// Unused numbers at the end of RCONF.
const NUM_UNUSED: usize = 18;

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], name: &str) -> Lines {
    let output = program.settings.params.gun_output;
    let mut lines = Lines::default();
    lines.add("/JOB");
    lines.add(format!("//NAME {}", name.to_uppercase()));
    lines.add("//POS");
    // Positions of the robot, and of its rail as base axis.
    let num_rails = steps.iter().filter(|step| step.rail.is_some()).count();
    lines.add(format!("///NPOS {},{num_rails},0,0,0,0", steps.len()));
    lines.add(format!("///TOOL {}", program.tool(&JBI)));
    lines.add("///POSTYPE BASE");
    lines.add("///RECTAN");
    // RCONF applies to the points below it.
    let mut current = None;
    for (i, step) in steps.iter().enumerate() {
        let configuration = step
            .configuration
            .as_deref()
            .unwrap_or(DEFAULT_CONFIGURATION);
        if current != Some(configuration) {
            lines.add(format!(
                "///RCONF {configuration}{}",
                ",0".repeat(NUM_UNUSED)
            ));
            current = Some(configuration);
        }
        let numbers = text::numbers(JBI.convention, &step.to);
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
        comments,
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
        let position = format!("C{i:05}{}", rail.unwrap_or_default());
        let motion = match step.motion {
            Motion::Joints(_) => {
                let share = text::fixed(JOINT_SPEED_SHARE * 100.0, 2);
                format!("MOVJ {position} VJ={share} PL=0")
            }
            Motion::Line(line) => {
                let speed = text::fixed(line.speed * 1000.0, 1);
                let end = if line.blend > 0.0 { "" } else { " PL=0" };
                format!("MOVL {position} V={speed}{end}")
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
fn write_calls(program: &Program<'_>, parts: &[String], comments: &[String], name: &str) -> Lines {
    let mut lines = Lines::default();
    lines.add("/JOB");
    lines.add(format!("//NAME {}", name.to_uppercase()));
    lines.add("//POS");
    lines.add("///NPOS 0,0,0,0,0,0");
    begin(&mut lines, program, &["///ATTR SC,RW"], comments);
    for part in parts {
        lines.instruct(format!("CALL JOB:{}", part.to_uppercase()));
    }
    lines.instruct("END");
    lines
}

/// Writes the lines between the positions and the moves.
fn begin(lines: &mut Lines, program: &Program<'_>, attributes: &[&str], comments: &[String]) {
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
    for comment in comments {
        lines.instruct(format!("'{comment}"));
    }
}

fn configuration(posture: &Posture) -> Option<String> {
    let [s, _, _, r, b, t] = posture.degrees;
    let turning = [r, t, s];
    if turning.iter().any(|angle| angle.abs() > MAX_TURN_DEG) {
        return None;
    }
    let main = [b < 0.0, !posture.is_elbow_up, !posture.is_ahead];
    let turns = turning.map(|angle| angle.abs() >= 180.0);
    let all = main.into_iter().chain(turns);
    let all: Vec<String> = all.map(|is_set| u8::from(is_set).to_string()).collect();
    Some(all.join(","))
}

#[cfg(test)]
mod tests {
    use crate::program::tests::read::{Move, Read, Reader, between, fixed_xyz, numbers};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "PAINT",
        tool: "1",
        accelerations: [None; 2],
        speed_step: 0.05e-3,
        stops: false,
        switches_before: 0.0,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        let (mut places, mut rails) = (Vec::new(), Vec::new());
        let (mut num_places, mut configuration) = ([0, 0], String::new());
        let (mut is_during, mut is_switched) = (false, false);
        for line in text.split("\r\n") {
            if let Some(name) = line.strip_prefix("//NAME ") {
                read.name = name.into();
            } else if let Some(tool) = line.strip_prefix("///TOOL ") {
                read.tool = tool.into();
            } else if let Some(counts) = line.strip_prefix("///NPOS ") {
                num_places = [0, 1].map(|kind| numbers(counts)[kind] as usize);
            } else if let Some(numbers) = line.strip_prefix("///RCONF ") {
                assert_eq!(numbers.split(',').count(), 24);
                configuration = numbers.into();
            } else if let Some(called) = line.strip_prefix("CALL JOB:") {
                read.calls.push(called.into());
            } else if line == "CWAIT" {
                is_during = false;
            } else if let Some(place) = line.strip_prefix('C') {
                let (number, numbers_of) = place.split_once('=').expect("a place");
                assert_eq!(number, format!("{:05}", places.len()));
                let n = numbers(numbers_of);
                places.push((fixed_xyz(&n, n[3], n[4], n[5]), configuration.clone()));
            } else if let Some(place) = line.strip_prefix("BC") {
                let (number, mm) = place.split_once('=').expect("a place");
                assert_eq!(number, format!("{:05}", rails.len()));
                rails.push(mm.parse::<f64>().expect("mm") / 1000.0);
            } else if let Some(comment) = line.strip_prefix('\'') {
                assert!(comment.len() <= 32);
                read.comments.push(comment.into());
            } else if let Some(rest) = line.strip_prefix("DOUT OT#(") {
                let (output, state) = rest.split_once(") ").expect("two");
                read.output = output.into();
                read.is_gun_on = state == "ON";
                // With NWAIT it runs as the last move begins, and only one fits there.
                if let Some(last) = read.moves.last_mut().filter(|_| is_during) {
                    assert!(!is_switched, "{line}");
                    last.is_gun_on = read.is_gun_on;
                    is_switched = true;
                }
            } else if line.starts_with("MOV") {
                let mut words = line.split(' ');
                let is_line = words.next() == Some("MOVL");
                let number: usize = words.next().expect("a place")[1..].parse().expect("number");
                let mut speed = words.next().expect("a speed");
                let mut rail = None;
                if let Some(of_rail) = speed.strip_prefix("BC") {
                    rail = Some(rails[of_rail.parse::<usize>().expect("a number")]);
                    speed = words.next().expect("a speed");
                }
                let (to, configuration) = places[number].clone();
                let rest: Vec<&str> = words.collect();
                assert!(matches!(
                    rest[..],
                    [] | ["PL=0" | "NWAIT"] | ["PL=0", "NWAIT"]
                ));
                is_during = rest.contains(&"NWAIT");
                is_switched = false;
                read.moves.push(Move {
                    to,
                    configuration,
                    rail,
                    speed: is_line.then(|| speed[2..].parse::<f64>().expect("mm/s") / 1000.0),
                    is_gun_on: read.is_gun_on,
                    is_exact: rest.contains(&"PL=0"),
                    acceleration: None,
                    switches_before: 0.0,
                });
            }
        }
        assert_eq!([places.len(), rails.len()], num_places);
        let group = between(text, "///GROUP1 ", "\r\n");
        assert!(group == "RB1,BS1" || (group == "RB1" && rails.is_empty()));
        // A job without positions has no lines about their frame.
        let of_positions = ["///POSTYPE BASE", "///RECTAN", "////FRAME BASE"];
        for line in of_positions {
            let is_there = text.contains(&format!("\r\n{line}\r\n"));
            assert_eq!(is_there, num_places[0] > 0, "{line}");
        }
        for line in ["NOP", "END"] {
            assert!(text.contains(&format!("\r\n{line}\r\n")), "{line}");
        }
        read
    }
}
