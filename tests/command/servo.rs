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
    for (refusal, advice) in [
        (
            place.coded(2, &["servo", "boat", "--simulated"]).err,
            "partsight library list",
        ),
        (place.coded(2, &replayed).err, "Give a camera as --source"),
        (servo(&["--robot", "abb=6510"]), "egm=192.168.1.10:6510"),
        (calibrated("rsi=0"), "--arm and --nozzle"),
        (calibrated("ur=127.0.0.1:9"), "remote control"),
    ] {
        assert!(refusal.contains(advice), "{refusal}");
    }
}
