//! Visual servoing.

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
