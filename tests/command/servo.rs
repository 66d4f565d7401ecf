//! Visual servoing.

use std::{
    io::{BufRead as _, BufReader, Read as _},
    net::UdpSocket,
    process::{Child, Stdio},
};

use serde_json::Value;

use crate::workplace::Workplace;

#[test]
fn a_simulated_robot_is_brought_to_its_target_and_the_lines_say_how() {
    let place = Workplace::new();
    let ran = place.accepted(&["servo", "fender", "--simulated", "rsi", "--json"]);
    let lines = ran.out.lines().map(|line| {
        let line: Result<Value, _> = serde_json::from_str(line);
        line.expect("a line of JSON")
    });
    let lines: Vec<Value> = lines.collect();
    let (end, frames) = lines.split_last().expect("lines");
    let error = |line: &Value| line["error_m"].as_f64();
    let first = frames.iter().find_map(error).expect("an error");
    assert!(first > 0.05 && end["arrived"] == true, "{}", ran.out);
    assert!(error(end).expect("an error") < 0.001, "{end}");
    assert!(end["bounds_m"].as_f64().expect("bounds") < 0.008, "{end}");
    assert!(ran.err.contains("True error at the end"), "{}", ran.err);
    // The history has the run with its curve, and no inspection.
    let line = |args: &[&str]| -> Value {
        let ran = place.accepted(args);
        serde_json::from_str(ran.out.trim()).expect("a line of JSON")
    };
    let run = line(&["history", "run", "1", "--json"]);
    assert_eq!(
        (&run["arrived"], &run["simulated"]),
        (&true.into(), &true.into())
    );
    assert_eq!(
        (&run["part"], &run["robot"]),
        (&"fender".into(), &"rsi".into())
    );
    assert_eq!(
        (&run["error_m"], &run["bounds_m"]),
        (&end["error_m"], &end["bounds_m"])
    );
    let curve = run["curve"].as_array().expect("a curve");
    assert!(
        curve.len() > 10 && curve.len() <= frames.len(),
        "{}",
        curve.len()
    );
    assert_eq!(line(&["history", "runs", "--json"])["number"], 1);
    let listed = place.accepted(&["history", "list", "--json"]);
    assert_eq!(listed.out, "");
    let shown = place.accepted(&["history", "run", "1"]).out;
    assert!(shown.contains("standard position"), "{shown}");
    let table = place.accepted(&["history", "runs", "--csv", "runs.csv"]);
    assert!(table.out.contains("Wrote 1 run to"), "{}", table.out);
    let unknown = place.coded(2, &["history", "run", "7"]).err;
    assert!(unknown.contains("partsight history runs"), "{unknown}");
    let tried = place.accepted(&[
        "servo",
        "fender",
        "--simulated",
        "--no-history",
        "--seed",
        "2",
        "--delay",
        "100",
        "--hand-eye",
        "5,0.5",
        "--backlash",
        "0.01",
    ]);
    assert!(tried.err.contains("up to 5.0 mm and 0.5°"), "{}", tried.err);
    assert_eq!(line(&["history", "runs", "--json"])["number"], 1);
}

#[test]
fn what_cannot_be_servoed_is_refused_with_advice() {
    let place = Workplace::new();
    let pose = "1 0 0 0.1  0 1 0 0  0 0 1 0.1  0 0 0 1";
    place.accepted(&[
        "calibrate",
        "set",
        pose,
        "--mount",
        "eye-in-hand",
        "--out",
        "cell.toml",
    ]);
    let servo = |more: &[&str]| {
        let args = [
            &["servo", "fender", "--source", "simulated:fender"][..],
            more,
        ];
        place.coded(2, &args.concat()).err
    };
    let replayed = [
        "servo",
        "fender",
        "--source",
        "recording:x",
        "--robot",
        "egm=0",
    ];
    let calibrated = |robot: &str| servo(&["--calibration", "cell.toml", "--robot", robot]);
    let to_path = |more: &[&str]| {
        let target = [
            "--calibration",
            "cell.toml",
            "--robot",
            "egm=0",
            "--target",
            "path-start",
        ];
        servo(&[&target[..], more].concat())
    };
    for (refusal, advice) in [
        (
            place.coded(2, &["servo", "boat", "--simulated"]).err,
            "partsight library list",
        ),
        (
            place
                .coded(2, &["servo", "fender", "--simulated", "--hand-eye=20"])
                .err,
            "such as 20,2",
        ),
        (
            place
                .coded(2, &["servo", "fender", "--simulated", "--hand-eye=20,nan"])
                .err,
            "such as 20,2",
        ),
        (
            servo(&["--robot", "egm=0", "--delay", "50"]),
            "cannot be used with",
        ),
        (
            place
                .coded(2, &["servo", "fender", "--robot=egm=0", "--delay=50"])
                .err,
            "cannot be used with",
        ),
        (place.coded(2, &replayed).err, "Give a camera as --source"),
        (servo(&["--robot", "abb=6510"]), "egm=192.168.1.10:6510"),
        (calibrated("rsi=0"), "--arm and --nozzle"),
        (calibrated("ur=127.0.0.1:9"), "remote control"),
        (
            servo(&["--robot", "egm=0", "--volume", "0,0,0,1"]),
            "two opposite corners",
        ),
        (
            servo(&["--robot", "egm=0", "--volume", "0 0 0 1 2 1"]),
            "to do",
        ),
        (
            servo(&[
                "--robot",
                "egm=0",
                "--target",
                "path-start",
                "--seen-as",
                "x.png",
            ]),
            "cannot be used with",
        ),
        (to_path(&[]), "partsight library path fender"),
    ] {
        assert!(refusal.contains(advice), "{refusal}");
    }
}

/// A simulated robot as a program of its own. Dropping it kills it.
struct RobotProgram {
    child: Child,
    /// The arguments with which another program servoes it.
    servo: Vec<String>,
}

impl RobotProgram {
    fn start(place: &Workplace, robot: &str) -> Self {
        let args = [
            "simulate", "--part", "fender", "--robot", robot, "--camera", "0",
        ];
        let files = ["--out", "cell.toml", "--truth", "end.json"];
        let mut command = place.command(&[&args[..], &files[..]].concat());
        let mut child = (command.stdout(Stdio::piped()).spawn()).expect("starts");
        let mut line = String::new();
        let out = child.stdout.as_mut().expect("piped");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let quoted = line.trim_end().split('"').enumerate();
        let words = quoted.flat_map(|(index, text)| -> Vec<String> {
            if index % 2 == 1 {
                vec![text.to_owned()]
            } else {
                text.split_whitespace().map(str::to_owned).collect()
            }
        });
        // Without the name of the program.
        let servo: Vec<String> = words.skip(1).collect();
        assert_eq!(servo.first().map(String::as_str), Some("servo"), "{line}");
        Self { child, servo }
    }

    fn servo<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        let servo = self.servo.iter().map(String::as_str);
        servo.chain(more.iter().copied()).collect()
    }
}

impl Drop for RobotProgram {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_robot_that_is_another_program_is_brought_to_its_target() {
    let place = Workplace::new();
    let free = UdpSocket::bind("127.0.0.1:0").and_then(|socket| socket.local_addr());
    let at = format!("rsi={}", free.expect("a port"));
    let mut robot = RobotProgram::start(&place, &at);
    let ran = place.accepted(&robot.servo(&["--json"]));
    let lines = ran.lines();
    let end = lines.last().expect("lines");
    assert_eq!(end["arrived"], true, "{end}");
    assert!(!ran.err.contains("no simulated robot"), "{}", ran.err);
    let status = robot.child.wait().expect("started");
    assert!(status.success(), "{status}");
    // What the robot knows, and the program that moved it does not.
    let truth = place.json("end.json");
    let left = |name: &str| truth[name].as_f64().expect("a number");
    assert_eq!(truth["arrived"], true, "{truth}");
    assert!(
        left("error_m") < 0.002 && left("error_rad").to_degrees() < 0.2,
        "{truth}"
    );
    let first = lines.iter().find_map(|line| line["error_m"].as_f64());
    assert!(first > Some(0.05), "{first:?}");
    let run = place.accepted(&["history", "run", "1", "--json"]).json();
    assert_eq!(run["simulated"], true, "{run}");
}

#[test]
fn a_robot_that_goes_down_on_the_way_stops_the_run_with_its_reason() {
    let place = Workplace::new();
    let mut robot = RobotProgram::start(&place, "ur=127.0.0.1:0");
    let mut command = place.command(&robot.servo(&["--json"]));
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut servo = piped.spawn().expect("starts");
    let mut out = BufReader::new(servo.stdout.take().expect("piped"));
    let moves = out.by_ref().lines().find(|line| {
        let line = line.as_ref().expect("text");
        let line: Value = serde_json::from_str(line).expect("a line of JSON");
        line["error_m"].is_number()
    });
    assert!(moves.is_some(), "{:?}", servo.wait_with_output());
    robot.child.kill().expect("it runs");
    let mut rest = String::new();
    out.read_to_string(&mut rest).expect("text");
    let ran = servo.wait_with_output().expect("started");
    let err = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(2), "{rest}{err}");
    assert!(
        err.contains("the connection to the robot at") && err.contains("to do"),
        "{err}"
    );
    let run = place.accepted(&["history", "run", "1", "--json"]).json();
    assert_eq!(run["arrived"], false, "{run}");
    assert!(!place.path("end.json").exists());
}

#[test]
fn a_robot_that_cannot_be_simulated_is_refused_with_advice() {
    let place = Workplace::new();
    for (more, advice) in [
        (&["fender,grille", "--robot", "egm=6510"][..], "Give one"),
        (&["fender", "--delay", "50"], "--robot"),
        (&["fender", "--robot", "abb=6510"], "egm=192.168.1.10:6510"),
        (
            &["fender", "--robot", "egm=6510", "--rack", "3"],
            "cannot be used with",
        ),
    ] {
        let args = [&["simulate", "--out", "x.toml", "--part"][..], more];
        let refusal = place.coded(2, &args.concat()).err;
        assert!(refusal.contains(advice), "{refusal}");
    }
}
