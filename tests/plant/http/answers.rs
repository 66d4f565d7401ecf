//! The answers at each path, checked against the published description.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use partsight::{
    robot::line::OnLine,
    serve::{
        CameraState, CameraStatus, Found, FrameFacts, FrameParts, Problem, RackPlace,
        ServerSettings, VerdictCode,
    },
};
use serde_json::{Value, json};

use super::{Service, accepted, client::Reply, http_settings, patient, refused, schema, tokens};

/// Every path for GET requests.
const READ: [&str; 7] = [
    "/v1/status",
    "/v1/last",
    "/v1/path?sequence=1",
    "/v1/report",
    "/v1/healthz",
    "/v1/metrics",
    "/v1/openapi.json",
];

/// The numbers of a pose.
fn numbers(pose: &Value) -> Vec<f64> {
    let values = pose["values"].as_array().expect("numbers").iter();
    values
        .map(|value| value["value"].as_f64().expect("a number"))
        .collect()
}

fn assert_at(numbers: &[f64], expected: [f64; 6]) {
    assert_eq!(numbers.len(), expected.len(), "{numbers:?}");
    for (found, expected) in numbers.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{numbers:?}");
    }
}

/// Checks the fields that every answer about an inspection has.
fn assert_known(answer: &Value, verdict: &str, sequence: u32) {
    assert_eq!(answer["verdict"], verdict, "{answer}");
    assert_eq!(answer["sequence"], sequence, "{answer}");
    assert!(
        answer["boot"].as_u64().is_some_and(|boot| boot > 0),
        "{answer}"
    );
    assert!(answer.get("age_ms").is_some(), "{answer}");
}

/// The value of this metric in the text.
fn metric(text: &str, name: &str) -> Option<f64> {
    let mut lines = text.lines().filter_map(|line| line.rsplit_once(' '));
    let (_, value) = lines.find(|(found, _)| *found == format!("partsight_{name}"))?;
    Some(value.parse().expect("a number"))
}

#[test]
fn every_path_answers_about_the_last_inspection() {
    let service = Service::start(accepted);
    let mut client = service.client();
    let none = client.get("/v1/last").json();
    assert_known(&none, "none", 0);
    assert_eq!(
        (&none["pose"], &none["age_ms"]),
        (&Value::Null, &Value::Null)
    );
    assert_eq!(client.get("/v1/report").json()["report"], Value::Null);
    let triggered = client.trigger();
    assert_eq!(triggered.field("cache-control"), "no-store");
    let triggered = triggered.json();
    assert_known(&triggered, "accepted", 1);
    assert_at(
        &numbers(&triggered["pose"]),
        [1.0, 250.0, 1500.0, 0.0, 0.0, 0.0],
    );
    assert_eq!(triggered["pose"]["convention"], "fanuc");
    let matrix = json!([
        1.0, 0.0, 0.0, 0.001, 0.0, 1.0, 0.0, 0.25, 0.0, 0.0, 1.0, 1.5, 0.0, 0.0, 0.0, 1.0
    ]);
    assert_eq!(triggered["pose"]["transform"], matrix);
    assert_eq!(triggered["part"], "fender");
    assert_eq!(
        (&triggered["number"], &triggered["points"]),
        (&json!(4), &json!(2))
    );
    assert_eq!(
        (&triggered["simulated"], &triggered["approximate"]),
        (&json!(true), &json!(false))
    );
    assert_eq!(
        (&triggered["camera"], &triggered["problem"]),
        (&json!("running"), &Value::Null)
    );
    let again = client.get("/v1/last").json();
    assert_known(&again, "accepted", 1);
    assert_eq!(again["pose"], triggered["pose"]);
    let status = client.get("/v1/status").json();
    assert_known(&status, "accepted", 1);
    assert_eq!(status["pose"], Value::Null);
    let path = client.get("/v1/path?sequence=1").json();
    assert_known(&path, "accepted", 1);
    assert_eq!(path["pose"], triggered["pose"]);
    let expected = json!([
        { "numbers": [7.0, 250.0, 1500.0, 0.0, 0.0, 0.0], "gun_on": true, "in_band": false, "speed_mm_s": 250.0 },
        { "numbers": [8.0, 250.0, 1500.0, 0.0, 0.0, 0.0], "gun_on": false, "in_band": true, "speed_mm_s": null },
    ]);
    assert_eq!(path["path"], expected);
    let report = client.get("/v1/report").json();
    assert_known(&report, "accepted", 1);
    assert_eq!(report["report"]["pose"]["rms_m"], 0.5);
    let health = client.get("/v1/healthz").json();
    assert_eq!(
        health,
        json!({ "boot": triggered["boot"], "camera": "running" })
    );
    assert_eq!(service.num_inspected(), 1);
}

#[test]
fn a_refused_part_and_a_stale_pose_have_no_numbers() {
    let never_fresh = ServerSettings {
        max_age: Duration::ZERO,
        ..patient()
    };
    let old = |number| Found {
        captured: Instant::now().checked_sub(Duration::from_secs(1)),
        ..accepted(number)
    };
    let stale = Service::start_with(never_fresh, http_settings(), old);
    for (service, verdict, reason) in [
        (&Service::start(refused), "refused", "low_score"),
        (&stale, "stale", "stale"),
    ] {
        let mut client = service.client();
        let mut answers = vec![client.trigger().json()];
        let paths = [
            "/v1/last",
            "/v1/status",
            "/v1/path?sequence=1",
            "/v1/report",
        ];
        answers.extend(paths.map(|path| client.get(path).json()));
        for answer in &answers {
            assert_known(answer, verdict, 1);
            assert_eq!(answer["pose"], Value::Null);
            assert_eq!(answer["points"], 0);
            assert_eq!(answer["problem"]["reason"], reason);
            assert_eq!(answer["part"], "fender");
        }
        assert_eq!(answers[3]["path"], json!([]));
        // The report still names the part, but has nothing that a robot could move by.
        let line = &answers[4]["report"];
        assert_eq!(line["status"], "ok");
        assert_eq!((line.get("pose"), line.get("robot")), (None, None));
        let text = client.get("/v1/report").text;
        let mut answer: Value = serde_json::from_str(&text).expect("JSON");
        // Boot number and age may have any digits.
        for name in ["boot", "age_ms"] {
            answer[name] = Value::Null;
        }
        let text = answer.to_string();
        assert!(!text.contains("250") && !text.contains("rms_m"), "{text}");
    }
}

#[test]
fn a_camera_that_is_lost_and_a_program_that_fails_are_errors_with_their_reason() {
    let problem = Problem {
        reason: "camera_lost".into(),
        message: "the camera is gone (to do: Plug it in)".into(),
    };
    let lost = problem.clone();
    let service = Service::start(move |number| match number {
        1 => Found::error(lost.clone()),
        2 => panic!("no ray for this pixel"),
        _ => accepted(number),
    });
    *service.camera.lock().expect("whole") = Some(CameraStatus {
        state: CameraState::Lost,
        problem: Some(problem),
    });
    let mut client = service.client();
    for (sequence, reason) in [(1, "camera_lost"), (2, "fault")] {
        let reply = client.trigger();
        assert_eq!(reply.status, 503);
        let answer = reply.json();
        assert_known(&answer, "error", sequence);
        assert_eq!(
            (&answer["problem"]["reason"], &answer["pose"]),
            (&json!(reason), &Value::Null)
        );
        // The last answer is repeated; its error is not an error of this request.
        let last = client.get("/v1/last");
        assert_eq!(
            (last.status, &last.json()["verdict"]),
            (200, &json!("error"))
        );
    }
    let status = client.get("/v1/status").json();
    assert_eq!(
        (&status["camera"], &status["problem"]["reason"]),
        (&json!("lost"), &json!("camera_lost"))
    );
    assert_eq!(client.get("/v1/healthz").json()["camera"], "lost");
    assert_known(&client.trigger().json(), "accepted", 3);
}

#[test]
fn a_panic_in_a_handler_is_the_error_of_that_request_alone() {
    let service = Service::start(accepted);
    let mut client = service.client();
    let camera = Arc::clone(&service.camera);
    let status = camera.lock().expect("whole").take();
    for (method, path) in [
        ("GET", "/v1/status"),
        ("GET", "/v1/metrics"),
        ("POST", "/v1/trigger"),
    ] {
        let reply = client.ask(method, path);
        assert_eq!(reply.status, 500, "{path}");
        let answer = reply.json();
        assert_known(&answer, "error", 0);
        assert_eq!(answer["problem"]["reason"], "fault");
        assert!(
            answer["problem"]["message"]
                .as_str()
                .is_some_and(|text| text.contains("to do"))
        );
    }
    *camera.lock().expect("whole") = status;
    assert_eq!(client.trigger().status, 200);
}

#[test]
fn metrics_count_verdicts_and_waiting_times() {
    let service = Service::start(|number| match number {
        2 => refused(number),
        _ => accepted(number),
    });
    let mut client = service.client();
    let before = client.get("/v1/metrics");
    assert_eq!(
        before.field("content-type"),
        "text/plain; version=0.0.4; charset=utf-8"
    );
    assert_eq!(
        metric(&before.text, "inspections_total{verdict=\"accepted\"}"),
        Some(0.0)
    );
    assert_eq!(metric(&before.text, "last_frame_age_seconds"), None);
    for _ in 0..3 {
        assert_eq!(client.trigger().status, 200);
    }
    let text = client.get("/v1/metrics").text;
    for (name, value) in [
        ("inspections_total{verdict=\"accepted\"}", 2.0),
        ("inspections_total{verdict=\"refused\"}", 1.0),
        ("inspections_total{verdict=\"error\"}", 0.0),
        ("trigger_seconds_bucket{le=\"+Inf\"}", 3.0),
        ("trigger_seconds_count", 3.0),
        ("camera_state{state=\"running\"}", 1.0),
        ("camera_state{state=\"lost\"}", 0.0),
        ("clients", 0.0),
    ] {
        assert_eq!(metric(&text, name), Some(value), "{name} in\n{text}");
    }
    assert!(metric(&text, "last_frame_age_seconds").is_some_and(|age| age >= 0.0));
    assert!(metric(&text, "trigger_seconds_sum").is_some_and(|sum| sum > 0.0));
    // The format requires every line to be a comment, or a name with a number.
    let values = text.lines().filter(|line| !line.starts_with("# "));
    for line in values {
        let (name, value) = line.rsplit_once(' ').expect("a name and a number");
        assert!(
            name.starts_with("partsight_") && value.parse::<f64>().is_ok(),
            "{line}"
        );
    }
}

/// Checks an answer against its description.
fn assert_described(reply: &Reply, method: &str, path: &str, document: &Value) {
    let (path, _) = path.split_once('?').unwrap_or((path, ""));
    let operation = &document["paths"][path][method.to_lowercase()];
    let response = &operation["responses"][reply.status.to_string()];
    let media = reply.field("content-type");
    let schema = response["content"][media].get("schema");
    let schema = schema.unwrap_or_else(|| panic!("{method} {path}: {} {media}", reply.status));
    let value = if media == "application/json" {
        reply.json()
    } else {
        json!(reply.text)
    };
    if let Err(why) = schema::check(&value, schema, document) {
        panic!("{method} {path}, {}: {why}\n{value}", reply.status);
    }
}

#[test]
fn a_part_on_a_line_is_answered_with_where_it_is_there_and_one_without_a_pose_is_not() {
    let here = OnLine {
        number: 12,
        count: Some(4_294_967_290),
        at: "2026-03-01T08:00:00.25Z".parse().expect("a time"),
        bound_mm: 3.5,
        speed_mm_s: -99.5,
    };
    let ago = Duration::from_millis(200);
    let since = Instant::now().checked_sub(ago).expect("up longer");
    let service = Service::start(move |number| FrameParts {
        first: Found {
            on_line: Some(here),
            on_line_since: Some(since),
            ..accepted(number)
        },
        others: vec![Found {
            on_line: Some(OnLine::default()),
            ..refused(2)
        }],
        ..FrameParts::default()
    });
    let mut client = service.client();
    let document = client.get("/v1/openapi.json").json();
    let reply = client.trigger();
    assert_described(&reply, "POST", "/v1/trigger", &document);
    let mut answer = reply.json();
    let since = answer["on_line"]["since_ms"].take();
    assert!(since.as_u64().is_some_and(|since| since >= 200), "{since}");
    let expected = json!({
        "number": 12, "count": 4_294_967_290_u32, "at": "2026-03-01T08:00:00.25Z", "bound_mm": 3.5, "speed_mm_s": -99.5,
        "since_ms": null,
    });
    assert_eq!(answer["on_line"], expected);
    assert_eq!(answer["parts"][1]["on_line"], Value::Null);
    assert_eq!(client.get("/v1/status").json()["on_line"], Value::Null);
}

#[test]
fn all_parts_of_a_frame_come_with_the_first_and_only_the_accepted_ones_have_poses() {
    let service = Service::start(|number| {
        let line = json!({
            "pose": [1], "robot": [1],
            "parts": [{ "part": "fender", "pose": [1], "robot": [1] }, { "part": "hood", "pose": [2], "robot": [2] }],
        });
        FrameParts {
            first: Found {
                report: line.to_string(),
                ..accepted(number)
            },
            others: vec![refused(2)],
            ..FrameParts::default()
        }
    });
    let mut client = service.client();
    for reply in [
        client.trigger(),
        client.get("/v1/last"),
        client.get("/v1/report"),
    ] {
        let answer = reply.json();
        assert_known(&answer, "accepted", 1);
        assert_eq!([&answer["index"], &answer["num_parts"]], [1, 2]);
        let parts = answer["parts"].as_array().expect("parts");
        assert_eq!(parts.len(), 2);
        assert_known(&parts[0], "accepted", 1);
        assert_eq!(parts[0]["pose"], answer["pose"]);
        assert_known(&parts[1], "refused", 2);
        assert_eq!([&parts[1]["index"], &parts[1]["num_parts"]], [2, 2]);
        assert_eq!(parts[1]["pose"], Value::Null);
        if let Some(report) = answer.get("report") {
            assert!(report["pose"].is_array() && report["parts"][0]["pose"].is_array());
            let refused = &report["parts"][1];
            assert_eq!(refused["part"], "hood");
            assert!(
                refused.get("pose").is_none() && refused.get("robot").is_none(),
                "{report}"
            );
        }
    }
    let path = |sequence: u32| format!("/v1/path?sequence={sequence}");
    let accepted = client.get(&path(1)).json();
    assert!(!accepted["path"].as_array().expect("points").is_empty());
    let refused = client.get(&path(2)).json();
    assert_known(&refused, "refused", 2);
    assert_eq!(refused["path"], json!([]));
    assert_eq!(client.get(&path(3)).status, 404);
    assert_eq!(client.trigger().json()["sequence"], 3);
}

#[test]
fn before_a_rack_each_part_has_its_place_and_the_frame_what_is_empty_and_missing() {
    let hook = |number, name: &str| RackPlace {
        number,
        name: name.into(),
    };
    let service = Service::start(move |number| {
        let first = Found {
            place: Some(hook(1, "left hook")),
            ..accepted(number)
        };
        let missing = Found {
            verdict: VerdictCode::NoPart,
            number: 0,
            place: Some(hook(2, "right hook")),
            ..refused(2)
        };
        let facts = FrameFacts {
            rack: Some("rack A".into()),
            empty_places: Some(vec![hook(2, "right hook")]),
            missing: Some(vec![(&missing).into()]),
        };
        let (others, facts) = (vec![missing], facts.into());
        FrameParts {
            first,
            others,
            facts,
        }
    });
    let mut client = service.client();
    let document = client.get("/v1/openapi.json").json();
    let [left, right] = [(1, "left hook"), (2, "right hook")]
        .map(|(number, name)| json!({ "number": number, "name": name }));
    let triggered = client.trigger();
    assert_described(&triggered, "POST", "/v1/trigger", &document);
    for reply in [triggered, client.get("/v1/last")] {
        let answer = reply.json();
        assert_eq!(answer["place"], left);
        let places = [0_usize, 1].map(|part| &answer["parts"][part]["place"]);
        assert_eq!(places, [&left, &right]);
        assert_eq!(answer["rack"], "rack A");
        assert_eq!(answer["empty_places"], json!([right]));
        let missing = json!([{ "part": "fender", "number": null, "place": right }]);
        assert_eq!(answer["missing"], missing);
    }
    // Without a rack, nothing of it is in the answer.
    let plain = Service::start(accepted).client().trigger().json();
    for field in ["place", "rack", "empty_places", "missing"] {
        assert!(plain.get(field).is_none(), "{plain}");
        assert!(plain["parts"][0].get(field).is_none(), "{plain}");
    }
}

#[test]
fn a_trigger_may_say_what_is_expected_and_a_body_that_says_something_else_is_refused() {
    let service = Service::start(accepted);
    let mut client = service.client();
    let number = |reply: Reply| reply.json()["number"].as_u64().expect("a number");
    let plain = number(client.trigger());
    assert_eq!(number(client.trigger_with("")), plain);
    assert_eq!(number(client.trigger_with("{}")), plain);
    assert_eq!(number(client.trigger_with("{\"expected\": []}")), plain);
    assert_eq!(
        number(client.trigger_with("{\"expected\": [3, 5]}")),
        plain + 8
    );
    let mut placed = |body| number(client.trigger_with(body));
    assert_eq!(
        placed("{\"expected\": [3, 5], \"places\": [2, 1]}"),
        plain + 308
    );
    assert_eq!(
        placed("{\"expected\": [3, 5], \"places\": [0, 1]}"),
        plain + 108
    );
    assert_eq!(
        placed("{\"expected\": [3, 5], \"places\": [1]}"),
        plain + 108
    );
    let ordered = [
        "{\"order\": \"4711\"}",
        "{\"order\": \"A 17\", \"serial\": \"TL-1\"}",
    ];
    for (body, letters) in ordered.into_iter().zip([4, 8]) {
        assert_eq!(number(client.trigger_with(body)), plain + 1000 * letters);
    }
    for (body, counted) in [
        ("{\"count\": 123456}", 100_456),
        ("{\"count\": 123456, \"count_age_ms\": 40}", 100_496),
        ("{\"count\": -1, \"expected\": [3]}", 100_298),
    ] {
        assert_eq!(number(client.trigger_with(body)), plain + counted);
    }
    let num_before = service.num_inspected();
    for body in [
        "{\"count\": 4294967296}",
        "{\"count\": 1.5}",
        "{\"count\": \"7\"}",
        "{\"count_age_ms\": 40}",
        "{\"count\": 7, \"count_age_ms\": -1}",
        "{\"count\": 7, \"count_age_ms\": 10001}",
        "{\"expected\": 3}",
        "{\"expected\": [0]}",
        "{\"expected\": [-1]}",
        "{\"expected\": [1, 2, 3, 4, 5, 6, 7, 8, 9]}",
        "{\"expect\": [3]}",
        "{\"expected\": [3], \"places\": [1, 2]}",
        "{\"order\": 4711}",
        "{\"order\": \"4711\", \"expected\": [3]}",
        "{\"serial\": \"a\\tb\"}",
        "expected=3",
        "[3]",
    ] {
        let refused = client.trigger_with(body);
        assert_eq!(refused.status, 400, "{body}");
        assert_eq!(refused.json()["problem"]["reason"], "bad_body", "{body}");
    }
    assert_eq!(service.num_inspected(), num_before);
}

#[test]
fn every_answer_is_as_the_published_description_says() {
    let service = Service::start(|number| match number {
        2 => refused(number),
        3 => Found::error(Problem::default()),
        4 => Found {
            part: String::new(),
            number: 0,
            ..accepted(number)
        },
        _ => accepted(number),
    });
    let mut client = service.client();
    let document = client.get("/v1/openapi.json").json();
    assert_eq!(document["openapi"], "3.1.0");
    let paths = document["paths"].as_object().expect("paths");
    assert_eq!(paths.len(), READ.len() + 1);
    for _ in 0..5 {
        for path in READ {
            assert_described(&client.get(path), "GET", path, &document);
        }
        assert_described(&client.trigger(), "POST", "/v1/trigger", &document);
    }
    // Errors are described, too.
    client.fields = "Origin: http://example.com\r\n".into();
    for path in READ {
        assert_described(&client.get(path), "GET", path, &document);
    }
    client.fields = "Content-Length: 2000\r\n".into();
    let reply = client.trigger();
    assert_eq!(reply.status, 413);
    assert_described(&reply, "POST", "/v1/trigger", &document);
    let closed = Service::start_with(patient(), with_token(), accepted);
    let reply = closed.client().trigger();
    assert_eq!(reply.status, 401);
    assert_described(&reply, "POST", "/v1/trigger", &document);
    let mut known = closed.client().with_token("0123456789abcdef");
    let security = known.get("/v1/openapi.json").json()["security"].clone();
    assert_eq!(
        (security, &document["security"]),
        (json!([{ "token": [] }]), &json!([]))
    );
}

fn with_token() -> partsight::plant::http::HttpSettings {
    partsight::plant::http::HttpSettings {
        tokens: tokens("0123456789abcdef\n"),
        ..http_settings()
    }
}

#[test]
fn an_answer_that_is_changed_does_not_fit_the_description() {
    let service = Service::start(accepted);
    let mut client = service.client();
    let document = client.get("/v1/openapi.json").json();
    let schema = json!({ "$ref": "#/components/schemas/PathBody" });
    client.trigger();
    let path = client.get("/v1/path?sequence=1").json();
    assert_eq!(schema::check(&path, &schema, &document), Ok(()));
    let changed = |place: &str, value: Value| {
        let mut path = path.clone();
        *path.pointer_mut(place).expect("a field") = value;
        schema::check(&path, &schema, &document)
    };
    for (place, value) in [
        ("/verdict", json!("perhaps")),
        ("/sequence", json!(-1)),
        ("/boot", Value::Null),
        ("/age_ms", json!("1")),
        ("/camera", json!("asleep")),
        ("/simulated", json!(1)),
        ("/pose/values/0/value", json!("1.0")),
        ("/pose/values/0/unit", json!("inch")),
        ("/pose/transform", json!([1.0])),
        ("/path/1/numbers", json!({})),
        ("/path/1", json!({ "numbers": [] })),
    ] {
        assert!(changed(place, value).is_err(), "{place}");
    }
    let mut more = path.clone();
    more["extra"] = json!(1);
    assert!(schema::check(&more, &schema, &document).is_err());
}

#[test]
fn a_path_is_that_of_the_trigger_that_the_client_names() {
    let service = Service::start(accepted);
    let [mut client, mut other] = [0; 2].map(|_| service.client());
    let own = client.trigger().json()["sequence"].clone();
    other.trigger();
    let path = client.get(&format!("/v1/path?sequence={own}"));
    assert_known(&path.json(), "accepted", 1);
    assert_eq!(path.json()["path"].as_array().map(Vec::len), Some(2));
    for (query, status, reason) in [
        ("", 400, "no_trigger"),
        ("?sequence=", 400, "no_trigger"),
        ("?sequence=x", 400, "no_trigger"),
        ("?sequence=3", 404, "no_such_inspection"),
    ] {
        let reply = client.get(&format!("/v1/path{query}"));
        let answer = reply.json();
        assert_known(&answer, "bad_request", 0);
        assert_eq!(
            (reply.status, &answer["problem"]["reason"], &answer["pose"]),
            (status, &json!(reason), &Value::Null),
            "{query}"
        );
    }
}

#[test]
fn requests_after_each_other_and_in_pieces_are_answered_one_by_one() {
    let service = Service::start(accepted);
    let mut client = service.client();
    for byte in b"POST /v1/trigger HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n{}" {
        client.send(&[*byte]).expect("sent");
    }
    assert_known(&client.reply().expect("an answer").json(), "accepted", 1);
    for _ in 0..3 {
        client.begin("POST", "/v1/trigger");
    }
    for sequence in 2..=4 {
        assert_known(
            &client.reply().expect("an answer").json(),
            "accepted",
            sequence,
        );
    }
    for (method, path, status, reason) in [
        ("GET", "/v1/trigger", 405, "wrong_method"),
        ("POST", "/v1/last", 405, "wrong_method"),
        ("GET", "/", 404, "unknown_request"),
        ("GET", "/v1/last/", 404, "unknown_request"),
    ] {
        let reply = client.ask(method, path);
        let answer = reply.json();
        assert_eq!(
            (reply.status, &answer["problem"]["reason"]),
            (status, &json!(reason))
        );
        assert_known(&answer, "bad_request", 0);
    }
    assert_eq!(service.num_inspected(), 4);
}
