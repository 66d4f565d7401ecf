//! MQTT against a real broker: mosquitto, started by each test at a free port (`apt-get install mosquitto`). Without
//! it the tests report that they are skipped; with `PARTSIGHT_REQUIRE_MQTT=1` they fail. Encrypted connections are
//! not tested here.

mod broker;
mod cell;
mod program;
#[cfg(target_os = "linux")]
mod three_cells;
mod watch;

use std::{thread, time::Duration};

use partsight::{
    Advice as _,
    plant::mqtt::{LinkNews, LinkProblem, MAX_UNSENT, messages_schema},
    serve::{CameraState, CameraStatus, Found, Problem, ServerSettings},
};
use serde_json::{Value, json};

use self::{
    broker::{Broker, PASSWORD, Subscriber},
    cell::{Cell, accepted, refused},
};

/// Checks that a message conforms to the published schema of this name.
fn assert_conforms(message: &Value, name: &str) {
    let schema: Value = serde_json::from_str(&messages_schema()).expect("JSON");
    let held = crate::kit::conforms(message, &schema["$defs"][name], &schema);
    assert_eq!(held, Ok(()));
}

/// Receives inspections up to this sequence number and returns their numbers. A number twice in a row is a repeated
/// message.
fn sequences_up_to(last: u64, subscriber: &Subscriber) -> Vec<u64> {
    let mut found = Vec::new();
    while found.last() != Some(&last) {
        let message = subscriber.next_of("inspection").json;
        found.push(message["sequence"].as_u64().expect("a number"));
    }
    found
}

/// A broker that refuses only the cell, with a subscriber.
fn closed_broker() -> Option<(Broker, Subscriber)> {
    let mut broker = Broker::prepare()?;
    broker.let_in("cell", "another");
    broker.start();
    let subscriber = Subscriber::start(&broker);
    Some((broker, subscriber))
}

fn let_cell_in(broker: &Broker) {
    broker.let_in("cell", PASSWORD);
    broker.reload();
}

#[test]
fn the_state_is_kept_and_inspections_arrive_in_order() {
    let Some(broker) = Broker::start_new() else {
        return;
    };
    let find = |number| match number {
        2 => refused(number),
        3 => Found::error(Problem {
            reason: "no_frame".into(),
            message: "no frame came".into(),
        }),
        _ => accepted(number),
    };
    let mut cell = Cell::start_with(&broker, PASSWORD, ServerSettings::default().max_age, find);
    cell.wait_connected(1);
    let kept = Subscriber::retained(&broker);
    assert_conforms(&kept, "StateMessage");
    assert_eq!(
        (&kept["online"], &kept["boot"]),
        (&json!(true), &json!(cell.boot))
    );
    assert_eq!(
        kept["library"],
        json!({"identity": "0123abcd", "num_parts": 8})
    );
    let version = format!("Partsight {}", env!("CARGO_PKG_VERSION"));
    assert_eq!(kept["program"], json!(version));

    let subscriber = Subscriber::start(&broker);
    assert_eq!(subscriber.next_of("state").json["online"], true);
    cell.link.set_camera(CameraStatus {
        state: CameraState::Running,
        problem: None,
    });
    let running = subscriber.next_of("state");
    assert_eq!(running.json["camera"]["state"], "running");
    let reply: Vec<String> = (0..4).map(|_| cell.trigger()).collect();
    assert_eq!(reply, ["accepted", "refused", "error", "accepted"]);
    for (number, verdict) in (1..).zip(&reply) {
        let received = subscriber.next();
        assert_eq!(
            (received.topic.as_str(), received.is_retained),
            ("inspection", false)
        );
        let message = received.json;
        assert_conforms(&message, "InspectionMessage");
        assert_eq!(message["sequence"], number);
        assert_eq!(message["boot"], cell.boot);
        assert_eq!(message["verdict"], *verdict);
        assert_eq!(message["traceability"], json!({"order": "A-17"}));
        // A pose is published only with an accepted verdict.
        assert_eq!(
            message["pose"].is_object(),
            verdict == "accepted",
            "{message}"
        );
        assert_eq!(
            message["problem"].is_null(),
            verdict == "accepted",
            "{message}"
        );
        assert_eq!(
            message["captured_at"].is_null(),
            verdict == "error",
            "{message}"
        );
        assert_eq!(message["simulated"], verdict != "error", "{message}");
        if verdict == "accepted" {
            assert_eq!(
                (&message["part"], &message["number"]),
                (&json!("fender"), &json!(4))
            );
            assert_eq!(message["pose"]["transform"], "robot_from_part");
            let kuka = &message["pose"]["in_convention"];
            assert_eq!(kuka["convention"], "kuka");
            let x = kuka["values"][0]["value"].as_f64().expect("a number");
            assert!((x - f64::from(number)).abs() < 1e-9, "{message}");
        }
    }
    assert_eq!(cell.end(), Ok(()));
    let last = subscriber.next_of("state").json;
    assert_conforms(&last, "StateMessage");
    assert_eq!(
        (&last["online"], &last["camera"]),
        (&json!(false), &Value::Null)
    );
    assert_eq!(Subscriber::retained(&broker), last);
}

#[test]
fn what_was_inspected_while_the_broker_was_gone_arrives_once_it_is_back() {
    let Some(mut broker) = Broker::start_new() else {
        return;
    };
    let subscriber = Subscriber::start(&broker);
    let mut cell = Cell::start(&broker, PASSWORD);
    cell.trigger();
    assert_eq!(sequences_up_to(1, &subscriber), [1]);
    broker.kill();
    cell.wait_lost();
    // Robots still get answers.
    for _ in 0..20 {
        assert_eq!(cell.trigger(), "accepted");
    }
    // The cell connects last, so that the subscriber misses nothing.
    broker.let_in("cell", "another");
    broker.start();
    subscriber.wait_subscribed(2);
    let_cell_in(&broker);
    let found = sequences_up_to(21, &subscriber);
    let mut once = found.clone();
    once.dedup();
    let missed: Vec<u64> = (2..=21).collect();
    let is_again = once.first() == Some(&1);
    assert_eq!(once[usize::from(is_again)..], missed);
    let num_again = found.len() - once.len() + usize::from(is_again);
    assert!(num_again <= 1, "one message was on its way: {found:?}");
    cell.wait_connected(2);
    let news = cell.news();
    let [
        LinkNews::Connected { .. },
        LinkNews::Lost(problem),
        LinkNews::Connected {
            num_waiting,
            num_dropped: 0,
        },
    ] = &news[..]
    else {
        panic!("one loss, told once: {news:?}");
    };
    assert!(*num_waiting >= 20, "{news:?}");
    assert!(problem.advice().contains("is retried"), "{problem}");
    assert_eq!(cell.end(), Ok(()));
}

#[test]
fn the_oldest_inspections_are_dropped_and_counted() {
    let Some((broker, subscriber)) = closed_broker() else {
        return;
    };
    let mut cell = Cell::start(&broker, PASSWORD);
    cell.wait_lost();
    for _ in 0..MAX_UNSENT + 5 {
        cell.trigger();
    }
    let_cell_in(&broker);
    let state = subscriber.next();
    assert_eq!(
        (state.topic.as_str(), &state.json["num_dropped"]),
        ("state", &json!(5))
    );
    let last = MAX_UNSENT as u64 + 5;
    let expected: Vec<u64> = (6..=last).collect();
    assert_eq!(sequences_up_to(last, &subscriber), expected);
    let unsent = cell.end().expect_err("five were dropped");
    assert!(unsent.to_string().ends_with(": 5"), "{unsent}");
    assert!(unsent.advice().contains("history"));
}

#[test]
fn a_pose_that_became_too_old_in_the_queue_is_not_sent() {
    let Some((broker, subscriber)) = closed_broker() else {
        return;
    };
    let max_age = Duration::from_secs(2);
    let mut cell = Cell::start_with(&broker, PASSWORD, max_age, accepted);
    assert_eq!(cell.trigger(), "accepted");
    thread::sleep(max_age);
    let_cell_in(&broker);
    let message = subscriber.next_of("inspection").json;
    assert_conforms(&message, "InspectionMessage");
    assert_eq!(
        (&message["verdict"], &message["pose"]),
        (&json!("stale"), &Value::Null)
    );
    assert_eq!(
        (&message["part"], &message["sequence"]),
        (&json!("fender"), &json!(1))
    );
    assert_eq!(message["problem"]["reason"], "stale");
    assert!(message["age_ms"].as_u64() >= Some(2000), "{message}");
    assert_eq!(cell.end(), Ok(()));
}

#[test]
fn a_wrong_password_is_told_with_what_to_do_and_no_robot_waits() {
    let Some(broker) = Broker::start_new() else {
        return;
    };
    let mut cell = Cell::start(&broker, "wrong");
    cell.wait_lost();
    assert_eq!(cell.trigger(), "accepted");
    let news = cell.news();
    let [LinkNews::Lost(problem @ LinkProblem::Refused { .. })] = &news[..] else {
        panic!("{news:?}");
    };
    assert!(problem.to_string().contains("password"), "{problem}");
    assert!(problem.advice().contains("--mqtt-password-file"));
    let unsent = cell.end().expect_err("nothing went out");
    assert!(unsent.to_string().ends_with(": 1"), "{unsent}");
}
