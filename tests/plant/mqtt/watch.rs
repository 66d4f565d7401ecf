//! `inspect --source --mqtt`: a source followed without a server.

use std::{
    fs,
    path::Path,
    process::{Child, Command, Stdio},
};

use serde_json::{Value, json};

use crate::mqtt::{
    assert_conforms,
    broker::{Broker, Subscriber},
    program::{interrupt, partsight, prepare},
};

/// Follows a source and publishes the inspections.
fn inspect(folder: &Path, broker: &Broker, source: &str) -> Command {
    let address = broker.address();
    let followed = [
        "inspect",
        "--source",
        source,
        "--as",
        "kuka",
        "--no-history",
    ];
    let place = ["--calibration", "cell.toml", "--number", "fender=7"];
    let mqtt = ["--mqtt", &address, "--mqtt-password-file", "password"];
    let mut command = partsight(folder, &[&followed[..], &place, &mqtt].concat());
    command.stdout(Stdio::null());
    command
}

/// The inspections until the state becomes offline.
fn inspections(subscriber: &Subscriber) -> Vec<Value> {
    let mut found = Vec::new();
    loop {
        let received = subscriber.next();
        match received.topic.as_str() {
            "state" => {
                assert_conforms(&received.json, "StateMessage");
                if received.json["online"] == false {
                    return found;
                }
            }
            topic => {
                assert_eq!((topic, received.is_retained), ("inspection", false));
                assert_conforms(&received.json, "InspectionMessage");
                found.push(received.json);
            }
        }
    }
}

#[test]
fn every_capture_of_a_folder_is_published_and_the_last_state_is_offline() {
    let Some(broker) = Broker::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    prepare(folder.path());
    let captures = folder.path().join("captures");
    fs::create_dir(&captures).expect("made");
    for (part, out) in [("fender", "captures/a.ply"), ("grille", "captures/b.ply")] {
        let simulate = ["simulate", "--part", part, "--out", out];
        let simulated = partsight(folder.path(), &simulate).output();
        assert!(simulated.expect("starts").status.success());
    }
    fs::write(captures.join("c.ply"), "no cloud").expect("written");
    let subscriber = Subscriber::start(&broker);
    let ran = inspect(folder.path(), &broker, "recording:captures").output();
    let ran = ran.expect("starts");
    let words = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(2), "one cannot be read: {words}");
    let found = inspections(&subscriber);
    let [fender, grille, unreadable] = &found[..] else {
        panic!("three captures: {found:?} {words}");
    };
    for (number, message) in (1..).zip(&found) {
        assert_eq!(message["sequence"], number, "{message}");
        assert_eq!(message["boot"], fender["boot"], "{message}");
    }
    for (message, part, number) in [
        (fender, "fender", json!(7)),
        (grille, "grille", Value::Null),
    ] {
        assert_eq!(
            (&message["verdict"], &message["part"], &message["number"]),
            (&json!("accepted"), &json!(part), &number)
        );
        assert_eq!(message["simulated"], true, "{message}");
        assert_eq!(message["pose"]["in_convention"]["convention"], "kuka");
    }
    assert_eq!(unreadable["verdict"], "error", "{unreadable}");
    assert_eq!(unreadable["problem"]["reason"], "unreadable");
    assert_eq!(unreadable["pose"], Value::Null);
    let kept = Subscriber::retained(&broker);
    assert_eq!(
        (&kept["online"], &kept["camera"], &kept["boot"]),
        (&json!(false), &Value::Null, &fender["boot"])
    );
}

/// Killed when dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn of_a_camera_each_part_is_published_once_until_ctrl_c() {
    let Some(broker) = Broker::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    prepare(folder.path());
    let subscriber = Subscriber::start(&broker);
    let child = inspect(folder.path(), &broker, "simulated,fps=5:fender").spawn();
    let mut running = Running(child.expect("starts"));
    // Frames keep coming, but only one verdict counts for one part.
    let first = loop {
        let received = subscriber.next();
        if received.topic == "inspection" {
            break received.json;
        }
        assert_eq!(received.json["online"], true, "{received:?}");
    };
    assert_eq!(
        (&first["part"], &first["sequence"]),
        (&json!("fender"), &json!(1))
    );
    interrupt(&running.0);
    let ended = running.0.wait().expect("ends");
    assert!(matches!(ended.code(), Some(0 | 1)), "{ended}");
    let more = inspections(&subscriber);
    assert!(more.is_empty(), "{more:?}");
    assert_eq!(Subscriber::retained(&broker)["online"], false);
}

#[test]
fn options_that_would_be_passed_over_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    prepare(folder.path());
    let mqtt = "--mqtt mqtt://broker/cell";
    let source = "--source simulated:fender";
    for (args, why) in [
        (format!("a.ply {mqtt}"), "--mqtt needs --source"),
        ("a.ply --as kuka".into(), "need --mqtt"),
        (format!("{source} --number fender=1"), "need --mqtt"),
        (
            format!("{source} {mqtt} --calibration cell.toml"),
            "no convention is chosen",
        ),
        (
            format!("{source} {mqtt} --as kuka"),
            "where the camera sits",
        ),
    ] {
        let args = format!("inspect --no-history {args}");
        let args: Vec<&str> = args.split(' ').collect();
        let refused = partsight(folder.path(), &args).output().expect("starts");
        let words = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{args:?}: {words}");
        assert!(words.contains(why), "{args:?}: {words}");
        assert!(words.contains("to do: "), "{args:?}: {words}");
    }
}
