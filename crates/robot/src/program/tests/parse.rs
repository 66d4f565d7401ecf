//! Reads programs back by the controllers' manuals, independently of the writers.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use crate::program::ProgramFormat;
use geometry::rigid::RigidTransform;

/// A move as a controller would run it.
#[derive(Clone, Debug)]
pub(super) struct Move {
    pub(super) to: RigidTransform,
    /// Speed, m/s; none for a joint move.
    pub(super) speed: Option<f64>,
    /// Gun state on the way.
    pub(super) is_gun_on: bool,
    /// True if the robot stops at the point, false if it may cut the corner.
    pub(super) is_exact: bool,
    /// Acceleration, m/s²; none if the program states none, or for a joint move.
    pub(super) acceleration: Option<f64>,
    /// The gun switches this far before the end of the move instead of at it, metres.
    pub(super) switches_before: f64,
    /// The configuration there, as written.
    pub(super) configuration: String,
    /// Position of the first external axis, metres; none if not written.
    pub(super) rail: Option<f64>,
}

/// Content of a program.
#[derive(Debug, Default)]
pub(super) struct Read {
    pub(super) name: String,
    pub(super) tool: String,
    pub(super) output: String,
    pub(super) comments: Vec<String>,
    pub(super) moves: Vec<Move>,
    /// Names of called programs, in order.
    pub(super) calls: Vec<String>,
    /// Gun state after the last line.
    pub(super) is_gun_on: bool,
}

pub(super) fn read(format: ProgramFormat, text: &str) -> Read {
    match format {
        ProgramFormat::Krl => krl(text),
        ProgramFormat::Ls => ls(text),
        ProgramFormat::Rapid => rapid(text),
        ProgramFormat::UrScript => urscript(text),
        ProgramFormat::Jbi => jbi(text),
        ProgramFormat::Drl => drl(text),
    }
}

/// All numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || matches!(c, '-' | '.')))
        .filter_map(|word| word.parse().ok())
        .collect()
}

fn between<'a>(text: &'a str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text
        .split_once(begin)
        .unwrap_or_else(|| panic!("{begin} in {text}"));
    rest.split_once(end)
        .unwrap_or_else(|| panic!("{end} in {text}"))
        .0
}

fn about(axis: Vector3<f64>, degrees: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(axis * degrees.to_radians())
}

/// A pose from millimetres and a rotation.
fn placed(mm: &[f64], rotation: UnitQuaternion<f64>) -> RigidTransform {
    Isometry3::from_parts(
        Translation3::new(mm[0] / 1000.0, mm[1] / 1000.0, mm[2] / 1000.0),
        rotation,
    )
}

/// Turns about the fixed x, then the fixed y, then the fixed z.
fn fixed_xyz(mm: &[f64], rx: f64, ry: f64, rz: f64) -> RigidTransform {
    let turn = about(Vector3::z(), rz) * about(Vector3::y(), ry) * about(Vector3::x(), rx);
    placed(mm, turn)
}

fn krl(text: &str) -> Read {
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
        } else if let Some(rest) = line.strip_prefix("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[") {
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

fn ls(text: &str) -> Read {
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
                speed: is_line.then(|| speed.expect("one").parse::<f64>().expect("mm/s") / 1000.0),
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

fn rapid(text: &str) -> Read {
    let mut read = Read::default();
    let mut acceleration = None;
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
        } else if line.starts_with("Move") {
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
            let (tool, gun) = rest.split_once("\\WObj:=wobj0").expect("a frame");
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

fn urscript(text: &str) -> Read {
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
            read.name = name.trim_end_matches("():").into();
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

fn jbi(text: &str) -> Read {
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

fn drl(text: &str) -> Read {
    let mut read = Read::default();
    for line in text.lines() {
        if let Some(comment) = line.strip_prefix("# ") {
            read.comments.push(comment.into());
        } else if let Some(tool) = line.strip_prefix("set_tcp(") {
            read.tool = tool.trim_end_matches(')').trim_matches('"').into();
        } else if let Some(rest) = line.strip_prefix("set_digital_output(") {
            let (output, state) = rest.split_once(", ").expect("two");
            read.output = output.into();
            read.is_gun_on = state == "ON)";
        } else if line.starts_with("move") {
            let n = numbers(between(line, "posx(", ")"));
            let turn =
                about(Vector3::z(), n[3]) * about(Vector3::y(), n[4]) * about(Vector3::z(), n[5]);
            let is_line = line.starts_with("movel(");
            assert!(line.contains("ref=DR_BASE"));
            let value = |name: &str| numbers(line.split_once(name).expect(name).1)[0];
            read.moves.push(Move {
                to: placed(&n, turn),
                speed: is_line.then(|| value(" vel=") / 1000.0),
                is_gun_on: read.is_gun_on,
                is_exact: !is_line || value(" radius=") == 0.0,
                acceleration: is_line.then(|| value(" acc=") / 1000.0),
                switches_before: 0.0,
                configuration: String::new(),
                rail: None,
            });
        }
    }
    read
}
