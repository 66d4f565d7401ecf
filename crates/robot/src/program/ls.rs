//! FANUC's teach pendant program in ASCII form.

use jiff::tz::TimeZone;

use super::{
    JOINT_SPEED, Lines, Program, ProgramFormat,
    steps::{Motion, Step},
    text,
};

/// Letters of a remark.
const WIDTH: usize = 32;
/// No flip, elbow up, front; used if the configuration is not known.
const USUAL: &str = "N U T, 0, 0, 0";

pub(super) fn write(program: &Program<'_>, steps: &[Step], header: &[String], name: &str) -> Lines {
    let tool = program.tool(ProgramFormat::Ls);
    let output = program.settings.gun_output;
    let mut moves = Lines::default();
    let mut add = |motion: &str, text: &str| {
        let number = moves.num_instructions() + 1;
        moves.instruct(format!("{number:4}:{motion}{text} ;"));
    };
    for comment in text::comments(header, WIDTH) {
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
                &format!("P[{number}] {:.0}% FINE{gun}", JOINT_SPEED * 100.0),
            ),
            Motion::Line(line) => {
                let speed = text::fixed((line.speed * 1000.0).max(1.0), 0);
                let end = if line.blend > 0.0 { "CNT100" } else { "FINE" };
                add("L ", &format!("P[{number}] {speed}mm/sec {end}{gun}"));
            }
        }
        let numbers = text::numbers(ProgramFormat::Ls, &step.to);
        let [x, y, z, w, p, r] = numbers.as_slice() else {
            continue;
        };
        points.add(format!("P[{number}]{{"));
        points.add("   GP1:");
        let configuration = step.configuration.as_deref().unwrap_or(USUAL);
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
pub(super) fn write_calls(
    program: &Program<'_>,
    parts: &[String],
    header: &[String],
    name: &str,
) -> Lines {
    let mut calls = Lines::default();
    let remarks = text::comments(header, WIDTH)
        .into_iter()
        .map(|line| format!("!{line}"));
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
    lines.add("/MN");
    lines.append(moves);
    lines.add("/POS");
    lines.append(points);
    lines.add("/END");
    lines
}
