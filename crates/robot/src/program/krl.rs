//! KUKA Robot Language: one `.src` with the points in the moves.

use super::{
    JOINT_SPEED, Lines, Program, ProgramFormat,
    steps::{Motion, Step},
    text,
};
use geometry::rigid::RigidTransform;

/// Letters of a comment after `; `; KRL takes 140.
const WIDTH: usize = 100;

pub(super) fn write(program: &Program<'_>, steps: &[Step], header: &[String], name: &str) -> Lines {
    let mut lines = Lines::default();
    for line in ["&ACCESS RVP", "&REL 1", "&COMMENT Partsight"] {
        lines.add(line);
    }
    lines.add(format!("DEF {name} ( )"));
    for comment in text::comments(header, WIDTH) {
        lines.add(format!("; {comment}"));
    }
    let settings = program.settings;
    let output = settings.gun_output;
    lines.add("EXT BAS (BAS_COMMAND :IN,REAL :IN )");
    lines.add("GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )");
    lines.add("INTERRUPT ON 3");
    lines.add("BAS (#INITMOV,0)");
    lines.add(format!("BAS (#VEL_PTP,{:.0})", JOINT_SPEED * 100.0));
    lines.add(format!("BAS (#TOOL,{})", program.tool(ProgramFormat::Krl)));
    lines.add("BAS (#BASE,0)");
    if let Some(tool) = &settings.flange_from_nozzle {
        lines.add(format!("$TOOL={}", frame(tool, None, None)));
    }
    if let Some(acceleration) = program.acceleration {
        lines.add(format!("$ACC.CP={}", text::fixed(acceleration, 3)));
    }
    lines.add(format!("$APO.CDIS={}", text::fixed(settings.blend.mm(), 3)));
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
    let numbers = text::numbers(ProgramFormat::Krl, pose);
    let named = ["X", "Y", "Z", "A", "B", "C"].iter().zip(numbers);
    let named = named.map(|(name, number)| format!("{name} {number}"));
    let rail = rail.map(|rail| format!("E1 {}", text::rail_mm(rail)));
    let named = named.chain(configuration.map(str::to_owned)).chain(rail);
    let all: Vec<String> = named.collect();
    format!("{{{}}}", all.join(","))
}
