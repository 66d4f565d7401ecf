//! ABB's RAPID: one module with one procedure.

use super::{
    JOINT_SPEED, Lines, Program, ProgramFormat,
    steps::{Motion, Step},
    text,
};
use geometry::rigid::RigidTransform;

const WIDTH: usize = 78;
/// Name of the tool that is declared if the settings have the nozzle's pose.
const OWN_TOOL: &str = "tPartsight";
/// Speed of linear external axes in v1000, mm/s; used if no rail moves.
const RAIL_SPEED: f64 = 5000.0;
/// Least limit that `PathAccLim` takes, m/s².
const LEAST_ACCELERATION: f64 = 0.1;

pub(super) fn write(program: &Program<'_>, steps: &[Step], header: &[String], name: &str) -> Lines {
    let settings = program.settings;
    let mut lines = Lines::default();
    lines.add(format!("MODULE {name}"));
    for comment in text::comments(header, WIDTH) {
        lines.add(format!("  ! {comment}"));
    }
    let mut tool = program.tool(ProgramFormat::Rapid);
    if let Some(place) = &settings.flange_from_nozzle {
        tool = OWN_TOOL.into();
        lines.add("  ! Set the load of the tool: its mass is assumed.");
        lines.add(format!(
            "  LOCAL PERS tooldata {OWN_TOOL}:=[TRUE,{},[1,[0,0,50],[1,0,0,0],0,0,0]];",
            pose(place)
        ));
    }
    let signal = format!("doGun{}", settings.gun_output);
    lines.add(format!("  PROC run_{name}()"));
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
        let limit = text::fixed(acceleration.max(LEAST_ACCELERATION), 3);
        lines.add(format!(
            "    PathAccLim TRUE\\AccMax:={limit},TRUE\\DecelMax:={limit};"
        ));
    }
    lines.add(format!("    SetDO {signal},0;"));
    // The rail keeps to its top speed even where the nozzle hardly moves.
    let rail_speed = program
        .rail_speed()
        .map_or(RAIL_SPEED, |speed| 1000.0 * speed);
    let rail = text::fixed(rail_speed, 3);
    // TCP, orientation and external axes: a tenth of v1000's speeds.
    let slow = format!("[100,50,{},100]", text::fixed(JOINT_SPEED * rail_speed, 3));
    for step in steps {
        match step.motion {
            Motion::Joints(gun) => {
                lines.instruct(format!(
                    "    MoveJ {},{slow},fine,{tool}\\WObj:=wobj0;",
                    target(step)
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
                    "    {verb} {},[{speed},500,{rail},1000],{zone},{tool}\\WObj:=wobj0{signal};",
                    target(step)
                ));
            }
        }
    }
    lines.add(format!("    SetDO {signal},0;"));
    lines.add("  ENDPROC");
    lines.add("ENDMODULE");
    lines
}

fn pose(place: &RigidTransform) -> String {
    let numbers = text::numbers(ProgramFormat::Rapid, place);
    format!(
        "[[{}],[{}]]",
        numbers[..3].join(","),
        numbers[3..].join(",")
    )
}

fn target(step: &Step) -> String {
    let pose = pose(&step.to);
    let inner = &pose[1..pose.len() - 1];
    let configuration = step.configuration.as_deref().unwrap_or("[0,0,0,0]");
    let rail = step.rail.map_or_else(|| "9E9".into(), text::rail_mm);
    format!("[{inner},{configuration},[{rail},9E9,9E9,9E9,9E9,9E9]]")
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
