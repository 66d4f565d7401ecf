//! KUKA Robot Language: one `.src` with the points in the moves, no `.dat`.
//!
//! Poses X Y Z A B C; speeds `$VEL.CP` in m/s; accelerations `$ACC.CP`; blends `C_DIS` with `$APO.CDIS`; the gun by
//! `TRIGGER … DO $OUT`, in the middle of the blend. KUKA, *System Software 8.3, Operating and Programming Instructions for
//! System Integrators* and *System Variables*.
//!
//! Configuration: status and turn. `S` bit 0: wrist behind axis 1; bit 1: elbow up; bit 2: A5 < 0. `T` bits 0 to 5: axis 1
//! to 6 < 0. The same book, "Status and Turn".

use super::{Motion, RobotLanguage, Step, ToolName};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program,
        configuration::Posture,
        text::{self, Lines},
    },
};
use geometry::rigid::RigidTransform;

pub(in crate::program) static KRL: RobotLanguage = RobotLanguage {
    name: "krl",
    title: "KUKA KRL",
    maker: "KUKA",
    ending: "src",
    convention: Convention::Kuka,
    tool: ToolName::Number(16),
    speeds: [0.001, 2.0],
    outputs: 1..=4096,
    max_switching_blend: f64::INFINITY,
    switches_at: 0.5,
    rail_axis: Some("E1"),
    configuration: Some(configuration),
    max_name: 24,
    reserved: &[WORDS],
    is_case_sensitive: false,
    tracking: None,
    calls: None,
    // Of the 140 letters of a line.
    comment_width: 100,
    line_end: "\r\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

const WORDS: &str = "AND ANIN ANOUT BOOL BRAKE B_AND B_EXOR B_NOT B_OR CASE CHANNEL CHAR CIRC CIRC_REL CONFIRM \
    CONST CONTINUE DECL DEF DEFAULT DEFDAT DEFFCT DELAY DIGIN DISTANCE DO ELSE END ENDDAT ENDFCT ENDFOR ENDIF ENDLOOP \
    ENDSPLINE ENDSWITCH ENDWHILE ENUM EXIT EXOR EXT EXTFCT FALSE FOR GLOBAL GOTO HALT IF IMPORT INT INTERRUPT IS LIN \
    LIN_REL LOOP MAXIMUM MINIMUM NOT OR PRIO PTP PTP_REL PUBLIC PULSE REAL REPEAT RESUME RETURN SCIRC SIGNAL SLIN \
    SPLINE SPTP STEP STRUC SWITCH THEN TO TRIGGER TRUE UNTIL WAIT WHEN WHILE";

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], name: &str) -> Lines {
    let mut lines = Lines::default();
    for line in ["&ACCESS RVP", "&REL 1", "&COMMENT Partsight"] {
        lines.add(line);
    }
    lines.add(format!("DEF {name} ( )"));
    for comment in comments {
        lines.add(format!("; {comment}"));
    }
    let settings = program.settings;
    let output = settings.params.gun_output;
    lines.add("EXT BAS (BAS_COMMAND :IN,REAL :IN )");
    lines.add("GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )");
    lines.add("INTERRUPT ON 3");
    lines.add("BAS (#INITMOV,0)");
    lines.add(format!("BAS (#VEL_PTP,{:.0})", JOINT_SPEED_SHARE * 100.0));
    lines.add(format!("BAS (#TOOL,{})", program.tool(&KRL)));
    lines.add("BAS (#BASE,0)");
    if let Some(tool) = &settings.flange_from_nozzle {
        lines.add(format!("$TOOL={}", frame(tool, None, None)));
    }
    if let Some(acceleration) = program.acceleration {
        lines.add(format!("$ACC.CP={}", text::fixed(acceleration, 3)));
    }
    lines.add(format!(
        "$APO.CDIS={}",
        text::fixed(settings.params.blend.mm(), 3)
    ));
    lines.add(format!("$OUT[{output}]=FALSE"));
    let mut current = None;
    for step in steps {
        match step.motion {
            // The configuration is only given here: linear moves keep the status and take the nearest turn.
            Motion::Joints(gun) => {
                let to = frame(&step.to, step.configuration.as_deref(), step.rail);
                lines.instruct(format!("PTP {to}"));
                if step.rail.is_some() {
                    // BAS (#VEL_PTP) also slows the rail, and linear moves would wait for it.
                    lines.instruct("$VEL_EXTAX[1]=100");
                }
                if let Some(is_on) = gun {
                    let state = if is_on { "TRUE" } else { "FALSE" };
                    lines.instruct(format!("$OUT[{output}]={state}"));
                }
            }
            Motion::Line(line) => {
                let speed = text::fixed(line.speed, 6);
                if current.as_ref() != Some(&speed) {
                    lines.instruct(format!("$VEL.CP={speed}"));
                    current = Some(speed);
                }
                if let Some(is_on) = line.gun {
                    let state = if is_on { "TRUE" } else { "FALSE" };
                    // Switches at the end of the following move, in the middle of its blend.
                    lines.instruct(format!(
                        "TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[{output}]={state}"
                    ));
                }
                let blend = if line.blend > 0.0 { " C_DIS" } else { "" };
                let to = frame(&step.to, None, step.rail);
                lines.instruct(format!("LIN {to}{blend}"));
            }
        }
    }
    lines.add(format!("$OUT[{output}]=FALSE"));
    lines.add("END");
    lines
}

/// Formats a pose with the arm's configuration and the rail's position.
fn frame(pose: &RigidTransform, configuration: Option<&str>, rail: Option<f64>) -> String {
    let numbers = text::numbers(KRL.convention, pose);
    let named = ["X", "Y", "Z", "A", "B", "C"].iter().zip(numbers);
    let named = named.map(|(name, number)| format!("{name} {number}"));
    let rail = rail.map(|rail| format!("E1 {}", text::rail_mm(rail)));
    let named = named.chain(configuration.map(str::to_owned)).chain(rail);
    let all: Vec<String> = named.collect();
    format!("{{{}}}", all.join(","))
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "another controller may not name every configuration"
)]
fn configuration(posture: &Posture) -> Option<String> {
    let bits = |all: &[bool]| -> u8 {
        let all = all.iter().enumerate();
        all.map(|(i, is_set)| u8::from(*is_set) << i).sum()
    };
    let degrees = &posture.degrees;
    let status = bits(&[!posture.is_ahead, posture.is_elbow_up, degrees[4] < 0.0]);
    let turn = bits(&degrees.map(|angle| angle < 0.0));
    Some(format!("S {status},T {turn}"))
}

#[cfg(test)]
mod tests {
    use crate::program::tests::read::{Move, Read, Reader, between, fixed_xyz, numbers};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "paint",
        tool: "1",
        accelerations: [None, Some(4.0)],
        speed_step: 0.5e-6,
        stops: false,
        switches_before: 0.0,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        let frame = |line: &str| {
            let inner = between(line, "{", "}");
            let value = |name: &str| {
                let cell = inner.split(',').find(|cell| cell.trim().starts_with(name));
                numbers(cell.expect(name))[0]
            };
            let mm = [value("X "), value("Y "), value("Z ")];
            fixed_xyz(&mm, value("C "), value("B "), value("A "))
        };
        let (mut speed, mut pending, mut acceleration) = (f64::NAN, None, None);
        for line in text.split("\r\n") {
            assert!(line.len() <= 140, "{line}");
            if let Some(comment) = line.strip_prefix("; ") {
                read.comments.push(comment.into());
            } else if let Some(rest) = line.strip_prefix("DEF ") {
                read.name = rest.trim_end_matches(" ( )").into();
            } else if let Some(rest) = line.strip_prefix("BAS (#TOOL,") {
                read.tool = rest.trim_end_matches(')').into();
            } else if let Some(rest) = line.strip_prefix("$VEL.CP=") {
                speed = rest.parse().expect("a speed");
            } else if let Some(rest) = line.strip_prefix("$ACC.CP=") {
                acceleration = Some(rest.parse().expect("an acceleration"));
            } else if let Some(rest) = line.strip_prefix("$OUT[") {
                read.output = rest.split(']').next().expect("a number").into();
                read.is_gun_on = rest.ends_with("=TRUE");
            } else if let Some(rest) = line.strip_prefix("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[")
            {
                assert_eq!(rest.split(']').next(), Some(read.output.as_str()));
                pending = Some(rest.ends_with("=TRUE"));
            } else if line.starts_with("PTP") || line.starts_with("LIN") {
                read.moves.push(Move {
                    to: frame(line),
                    speed: line.starts_with("LIN").then_some(speed),
                    is_gun_on: read.is_gun_on,
                    is_exact: !line.ends_with("C_DIS"),
                    acceleration: acceleration.filter(|_| line.starts_with("LIN")),
                    switches_before: 0.0,
                    configuration: line
                        .split_once(",S ")
                        .map_or_else(String::new, |(_, rest)| {
                            let rest = rest.split('}').next().expect("an end");
                            let rest = rest.split(",E1").next().expect("a beginning");
                            format!("S {rest}")
                        }),
                    rail: (line.split_once(",E1 ")).map(|(_, rest)| numbers(rest)[0] / 1000.0),
                });
                read.is_gun_on = pending.take().unwrap_or(read.is_gun_on);
            }
        }
        assert!(text.trim_end().ends_with("END"));
        read
    }
}
