//! FANUC's teach pendant program in ASCII form.
//!
//! Poses X Y Z W P R; speeds in whole mm/sec; accelerations those of the arm, since LS states them only as shares of it;
//! blends `CNT100`; the gun by `TB 0.00sec,DO`, where the move to the point ends. FANUC, *R-30iB Operator's Manual (Basic
//! Operation)*, also "TIME BEFORE/AFTER".
//!
//! A line moves the tracking frame of a schedule, which the program's attributes name with the boundary, here the first, as in
//! programs that controllers have saved. The program that calls it sets the trigger. FANUC, *`ArcTool`*, "Tracking Setup".
//!
//! Configuration: `CONFIG` with N (J5 < 0) or F, U (elbow up) or D, T (wrist in front of axis 1) or B, and the turns of J4,
//! J5 and J6: 0 within ±180°, ±1 up to 540°. If it is not known, the usual one. The same book, "Position data".
//! Joint 3 of FANUC arms is counted against the upper arm here and against the horizontal there; CONFIG does not count its
//! turns, so the coupling does not matter. Uncertain: `$SCR_GRP[1].$TURN_AXIS` sets which joints CONFIG counts, here the
//! usual 4, 5, 6; it matters where J4 is beyond ±180°. The manual draws the elbow with the wrist in front only.

use jiff::tz::TimeZone;

use super::{Calls, Motion, RobotLanguage, Step, ToolName, Tracking};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program, TrackingFrame,
        configuration::Posture,
        text::{self, Lines},
    },
};

pub(in crate::program) static LS: RobotLanguage = RobotLanguage {
    name: "ls",
    title: "FANUC LS",
    maker: "FANUC",
    ending: "ls",
    convention: Convention::Fanuc,
    tool: ToolName::Number(10),
    speeds: [0.001, 2.0],
    outputs: 1..=512,
    max_switching_blend: f64::INFINITY,
    switches_at: 0.5,
    rail_axis: Some("E1"),
    configuration: Some(configuration),
    max_name: 36,
    // The format has a field for the name.
    reserved: &[],
    is_case_sensitive: false,
    tracking: Some(Tracking {
        what: "tracking schedule",
        numbers: 1..=6,
    }),
    calls: Some(Calls {
        max_instructions: 9999,
        // The move switches the gun.
        num_switch_instructions: 0,
        write: write_calls,
    }),
    comment_width: 32,
    line_end: "\r\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

/// No flip, elbow up, front; used if the configuration is not known.
const DEFAULT_CONFIGURATION: &str = "N U T, 0, 0, 0";

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], name: &str) -> Lines {
    let tool = program.tool(&LS);
    let output = program.settings.params.gun_output;
    let mut moves = Lines::default();
    let mut add = |motion: &str, text: &str| {
        let number = moves.num_instructions() + 1;
        moves.instruct(format!("{number:4}:{motion}{text} ;"));
    };
    for comment in comments {
        add("  ", &format!("!{comment}"));
    }
    add("  ", "UFRAME_NUM=0");
    add("  ", &format!("UTOOL_NUM={tool}"));
    add("  ", &format!("DO[{output}]=OFF"));
    let mut points = Lines::default();
    for (i, step) in steps.iter().enumerate() {
        let number = i + 1;
        // TIME BEFORE switches where the move ends, without a stop.
        let gun = step.gun().map(|is_on| {
            let state = if is_on { "ON" } else { "OFF" };
            format!(" TB   0.00sec,DO[{output}]={state}")
        });
        let gun = gun.unwrap_or_default();
        match step.motion {
            Motion::Joints(_) => add(
                "J ",
                &format!("P[{number}] {:.0}% FINE{gun}", JOINT_SPEED_SHARE * 100.0),
            ),
            Motion::Line(line) => {
                let speed = text::fixed((line.speed * 1000.0).max(1.0), 0);
                let end = if line.blend > 0.0 { "CNT100" } else { "FINE" };
                add("L ", &format!("P[{number}] {speed}mm/sec {end}{gun}"));
            }
        }
        let numbers = text::numbers(LS.convention, &program.in_frame(&step.to));
        let [x, y, z, w, p, r] = numbers.as_slice() else {
            continue;
        };
        points.add(format!("P[{number}]{{"));
        points.add("   GP1:");
        let configuration = step
            .configuration
            .as_deref()
            .unwrap_or(DEFAULT_CONFIGURATION);
        points.add(format!(
            "\tUF : 0, UT : {tool},\t\tCONFIG : '{configuration}',"
        ));
        points.add(format!("\tX = {x} mm,\tY = {y} mm,\tZ = {z} mm,"));
        let more = if step.rail.is_some() { "," } else { "" };
        points.add(format!("\tW = {w} deg,\tP = {p} deg,\tR = {r} deg{more}"));
        if let Some(rail) = step.rail {
            points.add(format!("\tE1= {} mm", text::rail_mm(rail)));
        }
        points.add("};");
    }
    add("  ", &format!("DO[{output}]=OFF"));
    whole(program, name, &moves, &points)
}

/// Writes a program that calls others, one after the other.
fn write_calls(program: &Program<'_>, parts: &[String], comments: &[String], name: &str) -> Lines {
    let mut calls = Lines::default();
    let remarks = comments.iter().map(|line| format!("!{line}"));
    let lines = parts
        .iter()
        .map(|part| format!("CALL {}", part.to_uppercase()));
    for (i, line) in remarks.chain(lines).enumerate() {
        calls.instruct(format!("{:4}:  {line} ;", i + 1));
    }
    whole(program, name, &calls, &Lines::default())
}

/// Puts head and end around instructions and points.
fn whole(program: &Program<'_>, name: &str, moves: &Lines, points: &Lines) -> Lines {
    let at = program.at.to_zoned(TimeZone::UTC);
    let at = at.strftime("DATE %y-%m-%d  TIME %H:%M:%S");
    let mut lines = Lines::default();
    lines.add(format!("/PROG  {}", name.to_uppercase()));
    lines.add("/ATTR");
    lines.add("OWNER\t\t= MNEDITOR;");
    lines.add("COMMENT\t\t= \"Partsight\";");
    lines.add("PROG_SIZE\t= 0;");
    lines.add(format!("CREATE\t\t= {at};"));
    lines.add(format!("MODIFIED\t= {at};"));
    lines.add("FILE_NAME\t= ;");
    lines.add("VERSION\t\t= 0;");
    lines.add(format!("LINE_COUNT\t= {};", moves.num_instructions()));
    lines.add("MEMORY_SIZE\t= 0;");
    lines.add("PROTECT\t\t= READ_WRITE;");
    lines.add("TCD:  STACK_SIZE\t= 0,");
    lines.add("      TASK_PRIORITY\t= 50,");
    lines.add("      TIME_SLICE\t= 0,");
    lines.add("      BUSY_LAMP_OFF\t= 0,");
    lines.add("      ABORT_REQUEST\t= 0,");
    lines.add("      PAUSE_REQUEST\t= 0;");
    lines.add("DEFAULT_GROUP\t= 1,*,*,*,*;");
    lines.add("CONTROL_CODE\t= 00000000 00000000;");
    if let Some(TrackingFrame { number, .. }) = program.settings.tracking {
        lines.add("/APPL");
        lines.add("");
        lines.add("LINE_TRACK;");
        lines.add(format!("  LINE_TRACK_SCHEDULE_NUMBER      : {number};"));
        lines.add("  LINE_TRACK_BOUNDARY_NUMBER      : 1;");
        lines.add("  CONTINUE_TRACK_AT_PROG_END      : FALSE;");
        lines.add("");
    }
    lines.add("/MN");
    lines.append(moves);
    lines.add("/POS");
    lines.append(points);
    lines.add("/END");
    lines
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "another controller may not name every configuration"
)]
fn configuration(posture: &Posture) -> Option<String> {
    let [_, _, _, j4, j5, j6] = posture.degrees;
    let flip = if j5 < 0.0 { 'N' } else { 'F' };
    let elbow = if posture.is_elbow_up { 'U' } else { 'D' };
    let side = if posture.is_ahead { 'T' } else { 'B' };
    let turn = |angle: f64| ((angle.abs() + 180.0) / 360.0).floor() as i32 * angle.signum() as i32;
    let turns = [j4, j5, j6].map(turn).map(|turn| turn.to_string());
    Some(format!("{flip} {elbow} {side}, {}", turns.join(", ")))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use crate::program::tests::read::{Move, Read, Reader, between, fixed_xyz, numbers};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "PAINT",
        tool: "1",
        accelerations: [None; 2],
        speed_step: 0.5e-3,
        stops: false,
        switches_before: 0.0,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        let (program, points) = text.split_once("/POS\r\n").expect("positions");
        let (head, program) = program.split_once("/MN\r\n").expect("moves");
        let places: BTreeMap<&str, &str> = (points.split("};"))
            .filter_map(|place| place.trim_start().strip_prefix("P[")?.split_once("]{"))
            .collect();
        let place = |number: &str| {
            let body = places[number];
            assert!(body.contains("UF : 0"));
            let value = |name: &str| {
                let (_, rest) = body.split_once(&format!("\t{name} = ")).expect(name);
                numbers(rest)[0]
            };
            let mm = [value("X"), value("Y"), value("Z")];
            let configuration = between(body, "CONFIG : '", "',").to_owned();
            let to = fixed_xyz(&mm, value("W"), value("P"), value("R"));
            let rail = body.split_once("deg,\r\n\tE1= ");
            let rail = rail.map(|(_, rest)| {
                assert!(rest.ends_with(" mm\r\n"), "{rest:?}");
                numbers(rest)[0] / 1000.0
            });
            (to, configuration, rail)
        };
        if let Some((_, tracking)) = head.split_once("/APPL\r\n\r\nLINE_TRACK;\r\n") {
            read.tracking = between(tracking, "LINE_TRACK_SCHEDULE_NUMBER      : ", ";").into();
            assert_eq!(
                between(tracking, "LINE_TRACK_BOUNDARY_NUMBER      : ", ";"),
                "1"
            );
            let goes_on = between(tracking, "CONTINUE_TRACK_AT_PROG_END      : ", ";");
            read.has_left = goes_on == "FALSE";
        }
        read.name = between(head, "/PROG  ", "\r\n").into();
        let count = between(head, "LINE_COUNT\t= ", ";")
            .parse::<usize>()
            .expect("a count");
        assert_eq!(program.lines().count(), count);
        for (i, line) in program.lines().enumerate() {
            let (number, rest) = line.split_once(':').expect("a number");
            assert_eq!(number.trim(), (i + 1).to_string());
            let rest = rest.trim_end_matches(" ;");
            if let Some(comment) = rest.strip_prefix("  !") {
                assert!(comment.len() <= 32);
                read.comments.push(comment.into());
            } else if let Some(tool) = rest.strip_prefix("  UTOOL_NUM=") {
                read.tool = tool.into();
            } else if let Some(output) = rest.strip_prefix("  DO[") {
                read.output = output.split(']').next().expect("a number").into();
                read.is_gun_on = output.ends_with("=ON");
            } else if rest.starts_with(['J', 'L']) {
                let speed = rest
                    .split("mm/sec")
                    .next()
                    .and_then(|head| head.split(' ').next_back());
                let is_line = rest.starts_with('L');
                let (to, configuration, rail) = place(between(rest, "P[", "]"));
                let (termination, option) = rest.split_once(" TB ").unwrap_or((rest, ""));
                assert!(termination.ends_with("FINE") || termination.ends_with("CNT100"));
                read.moves.push(Move {
                    to,
                    configuration,
                    rail,
                    speed: is_line
                        .then(|| speed.expect("one").parse::<f64>().expect("mm/s") / 1000.0),
                    is_gun_on: read.is_gun_on,
                    is_exact: termination.ends_with("FINE"),
                    acceleration: None,
                    switches_before: 0.0,
                });
                // TIME BEFORE: the output is set this long before the move ends.
                if !option.is_empty() {
                    let (time, output) = option.split_once("sec,DO[").expect("an output");
                    assert_eq!(time.trim().parse::<f64>(), Ok(0.0));
                    let (output, state) = output.split_once("]=").expect("a state");
                    assert_eq!(output, read.output);
                    read.is_gun_on = state == "ON";
                }
            } else if let Some(called) = rest.strip_prefix("  CALL ") {
                read.calls.push(called.into());
            } else {
                assert_eq!(rest, "  UFRAME_NUM=0");
            }
        }
        assert!(points.ends_with("/END\r\n"));
        read
    }
}
