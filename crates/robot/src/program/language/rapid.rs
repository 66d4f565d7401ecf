//! ABB's RAPID: one module with one procedure, `run_` and the name.
//!
//! Poses pos and orient; speeds speeddata in mm/s; accelerations `PathAccLim`; blends zonedata; the gun by `MoveLDO`, in the
//! middle of the blend. The rail is `eax_a` ("extjoint"). ABB, *RAPID Instructions, Functions and Data types*.
//!
//! A line moves the work object of a conveyor: `ufprog` FALSE and `ufmec` its unit, CNV1 and so on. `ActUnit`, `WaitWObj` and
//! `DropWObj` begin and end it, as in programs that others have published; before the end, the arm leaves it by a move in a
//! fixed work object, here to where it is. A position must state an external axis that is active, and the conveyor is one: these
//! state where each axis is. ABB, *Application manual `MultiMove`*, "Coordinated work objects", and the first book, "extjoint".
//!
//! Configuration: confdata. cfx 4: wrist behind axis 1; 2: wrist behind the lower arm; 1: axis 5 < 0. cf1, cf4 and cf6 are
//! quarter turns. The same book, "confdata".

use super::{Motion, RobotLanguage, Step, ToolName, Tracking};
use crate::{
    Convention,
    program::{
        JOINT_SPEED_SHARE, Program, TrackingFrame,
        configuration::Posture,
        text::{self, Lines},
    },
};
use geometry::rigid::RigidTransform;

pub(in crate::program) static RAPID: RobotLanguage = RobotLanguage {
    name: "rapid",
    title: "ABB RAPID",
    maker: "ABB",
    ending: "mod",
    convention: Convention::Abb,
    tool: ToolName::NameOrNozzle,
    speeds: [0.001, 5.0],
    outputs: 0..=9999,
    max_switching_blend: f64::INFINITY,
    switches_at: 0.5,
    rail_axis: Some("eax_a"),
    configuration: Some(configuration),
    // Of the 32 letters of a procedure, which is called `run_` plus the name.
    max_name: 28,
    reserved: &[WORDS, NAMES],
    is_case_sensitive: false,
    tracking: Some(Tracking {
        what: "conveyor",
        numbers: 1..=6,
    }),
    calls: None,
    comment_width: 78,
    line_end: "\r\n",
    write,
    #[cfg(test)]
    reader: tests::READER,
};

const WORDS: &str = "ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF \
    ENDMODULE ENDPROC ENDRECORD ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD MODULE \
    NOSTEPIN NOT NOVIEW OR PERS PROC RAISE READONLY RECORD RETRY RETURN STEP SYSMODULE TASK TEST THEN TO TRAP TRUE \
    TRYNEXT UNDO VAR VIEWONLY WHILE WITH XOR";
/// Names that a controller's own module or the routine at which it starts already has.
const NAMES: &str = "BASE MAIN USER";
/// Name of the tool that is declared if the settings have the nozzle's pose.
const OWN_TOOL: &str = "tPartsight";
/// Name of the work object that is declared if a line moves the frame.
const TRACKED_FRAME: &str = "wPartsight";
/// Speed of linear external axes in v1000, mm/s; used if no rail moves.
const DEFAULT_RAIL_SPEED_MM_S: f64 = 5000.0;
/// Least limit that `PathAccLim` takes, m/s².
const MIN_ACCELERATION_M_S2: f64 = 0.1;

fn write(program: &Program<'_>, steps: &[Step], comments: &[String], name: &str) -> Lines {
    let settings = program.settings;
    let mut lines = Lines::default();
    lines.add(format!("MODULE {name}"));
    for comment in comments {
        lines.add(format!("  ! {comment}"));
    }
    let mut tool = program.tool(&RAPID);
    if let Some(nozzle) = &settings.flange_from_nozzle {
        tool = OWN_TOOL.into();
        lines.add("  ! Set the load of the tool: its mass is assumed.");
        lines.add(format!(
            "  LOCAL PERS tooldata {OWN_TOOL}:=[TRUE,{},[1,[0,0,50],[1,0,0,0],0,0,0]];",
            pose(nozzle)
        ));
    }
    let tracking = settings.tracking.as_ref();
    let frame = if tracking.is_some() {
        TRACKED_FRAME
    } else {
        "wobj0"
    };
    if let Some(TrackingFrame { number, .. }) = tracking {
        let none = "[[0,0,0],[1,0,0,0]]";
        lines.add(format!(
            "  LOCAL PERS wobjdata {TRACKED_FRAME}:=[FALSE,FALSE,\"CNV{number}\",{none},{none}];"
        ));
    }
    let signal = format!("doGun{}", settings.params.gun_output);
    lines.add(format!("  PROC run_{name}()"));
    let here = format!("here:=CRobT(\\Tool:={tool}\\WObj:=wobj0);");
    if tracking.is_some() {
        lines.add("    VAR robtarget here;");
        lines.add("    VAR extjoint axes;");
    }
    // The first move takes the configuration that was checked, or stops; linear moves then keep it, even if an axis is
    // at the border of a quadrant.
    let is_known = steps
        .first()
        .is_some_and(|step| step.configuration.is_some());
    lines.add(if is_known {
        "    ConfJ\\On;"
    } else {
        "    ConfJ\\Off;"
    });
    lines.add("    ConfL\\Off;");
    if let Some(acceleration) = program.acceleration {
        let limit = text::fixed(acceleration.max(MIN_ACCELERATION_M_S2), 3);
        lines.add(format!(
            "    PathAccLim TRUE\\AccMax:={limit},TRUE\\DecelMax:={limit};"
        ));
    }
    lines.add(format!("    SetDO {signal},0;"));
    if let Some(TrackingFrame { number, .. }) = tracking {
        lines.add(format!("    ActUnit CNV{number};"));
        lines.add(format!("    WaitWObj {TRACKED_FRAME};"));
        lines.add(format!("    {here}"));
        lines.add("    axes:=here.extax;");
    }
    // The rail keeps to its top speed even where the nozzle hardly moves.
    let rail_speed = program
        .rail_speed()
        .map_or(DEFAULT_RAIL_SPEED_MM_S, |speed| 1000.0 * speed);
    let rail = text::fixed(rail_speed, 3);
    // TCP, orientation and external axes: a tenth of v1000's speeds.
    let slow = format!(
        "[100,50,{},100]",
        text::fixed(JOINT_SPEED_SHARE * rail_speed, 3)
    );
    for step in steps {
        match step.motion {
            Motion::Joints(gun) => {
                lines.instruct(format!(
                    "    MoveJ {},{slow},fine,{tool}\\WObj:={frame};",
                    target(program, step)
                ));
                if let Some(is_on) = gun {
                    lines.instruct(format!("    SetDO {signal},{};", u8::from(is_on)));
                }
            }
            Motion::Line(line) => {
                let speed = text::fixed(line.speed * 1000.0, 3);
                let zone = zone(line.blend);
                let (verb, signal) = match line.gun {
                    Some(is_on) => ("MoveLDO", format!(",{signal},{}", u8::from(is_on))),
                    None => ("MoveL", String::new()),
                };
                lines.instruct(format!(
                    "    {verb} {},[{speed},500,{rail},1000],{zone},{tool}\\WObj:={frame}{signal};",
                    target(program, step)
                ));
            }
        }
    }
    lines.add(format!("    SetDO {signal},0;"));
    if tracking.is_some() {
        lines.add(format!("    {here}"));
        lines.add(format!("    MoveL here,{slow},fine,{tool}\\WObj:=wobj0;"));
        lines.add(format!("    DropWObj {TRACKED_FRAME};"));
    }
    lines.add("  ENDPROC");
    lines.add("ENDMODULE");
    lines
}

fn pose(pose: &RigidTransform) -> String {
    let numbers = text::numbers(RAPID.convention, pose);
    format!(
        "[[{}],[{}]]",
        numbers[..3].join(","),
        numbers[3..].join(",")
    )
}

fn target(program: &Program<'_>, step: &Step) -> String {
    let pose = pose(&program.in_frame(&step.to));
    let inner = &pose[1..pose.len() - 1];
    let configuration = step.configuration.as_deref().unwrap_or("[0,0,0,0]");
    let axes = match step.rail {
        _ if program.settings.tracking.is_some() => "axes".into(),
        Some(rail) => format!("[{},9E9,9E9,9E9,9E9,9E9]", text::rail_mm(rail)),
        None => "[9E9,9E9,9E9,9E9,9E9,9E9]".to_owned(),
    };
    format!("[{inner},{configuration},{axes}]")
}

/// Scaled like z5 and the other predefined zones: the tool turns within 1.5 times the radius.
fn zone(blend: f64) -> String {
    if blend <= 0.0 {
        return "fine".into();
    }
    let radius = text::fixed(blend * 1000.0, 2);
    let turn = text::fixed(blend * 1500.0, 2);
    let degrees = text::fixed(blend * 150.0, 3);
    format!("[FALSE,{radius},{turn},{turn},{degrees},{turn},{degrees}]")
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "another controller may not name every configuration"
)]
fn configuration(posture: &Posture) -> Option<String> {
    let [a1, _, _, a4, a5, a6] = posture.degrees;
    let [cf1, cf4, cf6] = [a1, a4, a6].map(|angle| (angle / 90.0).floor() as i32);
    let cfx =
        4 * u8::from(!posture.is_ahead) + 2 * u8::from(!posture.is_elbow_up) + u8::from(a5 < 0.0);
    Some(format!("[{cf1},{cf4},{cf6},{cfx}]"))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, UnitQuaternion};

    use crate::program::tests::read::{Move, Read, Reader, between, numbers, placed};

    pub(super) const READER: Reader = Reader {
        read,
        program_name: "paint",
        tool: "tool1",
        accelerations: [None, Some(4.0)],
        speed_step: 0.5e-6,
        stops: false,
        switches_before: 0.0,
    };

    /// Reads a program back by the controller's manual, independently of the writer.
    pub(super) fn read(text: &str) -> Read {
        let mut read = Read::default();
        let (mut acceleration, mut is_leaving) = (None, false);
        for line in text.lines().map(str::trim) {
            if let Some(comment) = line.strip_prefix("! ") {
                read.comments.push(comment.into());
            } else if let Some(name) = line.strip_prefix("MODULE ") {
                read.name = name.into();
            } else if let Some(limits) = line.strip_prefix("PathAccLim TRUE\\AccMax:=") {
                let (most, braking) = limits.split_once(",TRUE\\DecelMax:=").expect("two");
                assert_eq!(braking.trim_end_matches(';'), most);
                acceleration = Some(most.parse().expect("a limit"));
            } else if let Some(rest) = line.strip_prefix("SetDO doGun") {
                let (output, state) = rest.trim_end_matches(';').split_once(',').expect("two");
                read.output = output.into();
                read.is_gun_on = state == "1";
            } else if let Some(frame) = line.strip_prefix("LOCAL PERS wobjdata wPartsight:=") {
                read.tracking = between(frame, "[FALSE,FALSE,\"CNV", "\",[[0,0,0],").into();
            } else if let Some(unit) = line.strip_prefix("ActUnit CNV") {
                assert_eq!(unit.trim_end_matches(';'), read.tracking);
            } else if line == "WaitWObj wPartsight;" {
                assert!(read.moves.is_empty());
            } else if line.starts_with("MoveL here,") {
                assert!(line.ends_with("\\WObj:=wobj0;") && !read.is_gun_on);
                is_leaving = true;
            } else if line == "DropWObj wPartsight;" {
                read.has_left = is_leaving;
            } else if line.starts_with("Move") {
                let frame = if read.tracking.is_empty() {
                    "\\WObj:=wobj0"
                } else {
                    "\\WObj:=wPartsight"
                };
                let axes = ",[9E9,9E9,9E9,9E9,9E9,9E9]],";
                let line = &line.replace(",axes],", axes);
                let n = numbers(line);
                let turn = Quaternion::new(n[3], n[4], n[5], n[6]);
                assert!((turn.norm() - 1.0).abs() < 1e-6);
                // Configuration and external axes follow the target.
                let unused = ",9E9,9E9,9E9,9E9,9E9]],";
                let (target, _) = line.split_once(unused).expect("axes");
                let (target, rail) = target.rsplit_once(",[").expect("external axes");
                let configuration = target.rsplit_once(",[").expect("a configuration").1;
                let rest = between(line, unused, ";");
                let (speed, rest) = rest.split_once("],").expect("a speed");
                let (tool, gun) = rest.split_once(frame).expect("a frame");
                let is_exact = tool.starts_with("fine,");
                read.tool = tool.rsplit_once(',').expect("a tool").1.into();
                read.moves.push(Move {
                    to: placed(&n, UnitQuaternion::from_quaternion(turn)),
                    speed: (!line.starts_with("MoveJ ")).then(|| numbers(speed)[0] / 1000.0),
                    is_gun_on: read.is_gun_on,
                    is_exact,
                    acceleration: acceleration.filter(|_| !line.starts_with("MoveJ ")),
                    switches_before: 0.0,
                    configuration: configuration.trim_end_matches(']').into(),
                    rail: (rail != "9E9").then(|| rail.parse::<f64>().expect("mm") / 1000.0),
                });
                assert_eq!(line.starts_with("MoveLDO "), !gun.is_empty());
                if let Some(gun) = gun.strip_prefix(",doGun") {
                    read.is_gun_on = gun.ends_with(",1");
                }
            }
        }
        assert!(text.ends_with("ENDPROC\r\nENDMODULE\r\n"));
        read
    }
}
