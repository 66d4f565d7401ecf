//! Many clients, hostile clients, and the end of the service.

use std::{
    collections::{BTreeSet, VecDeque},
    io::Write as _,
    net::TcpStream,
    sync::{
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use partsight::{plant::http::HttpSettings, serve::ServerSettings};
use serde_json::{Value, json};

use super::{PATIENCE, Service, accepted, http_settings, patient, tokens, wait_until};

const TOKEN: &str = "0123456789abcdef0123456789abcdef";

fn with_token() -> HttpSettings {
    HttpSettings {
        tokens: tokens(TOKEN),
        ..http_settings()
    }
}

#[test]
fn of_ten_thousand_triggers_by_eight_clients_none_is_lost_or_answered_twice() {
    const CLIENTS: usize = 8;
    const EACH: usize = 1250;
    let service = Service::start(accepted);
    let words: Vec<Value> = thread::scope(|scope| {
        let service = &service;
        let clients = (0..CLIENTS).map(|_| {
            scope.spawn(move || {
                let mut client = service.client();
                let words = (0..EACH).map(|_| client.trigger().json());
                words.collect::<Vec<_>>()
            })
        });
        // Start all of them before waiting for the first.
        let clients: Vec<_> = clients.collect();
        let words = clients
            .into_iter()
            .map(|client| client.join().expect("served"));
        let words: Vec<Vec<Value>> = words.collect();
        for of_one in &words {
            assert!(of_one.is_sorted_by_key(|words| words["sequence"].as_u64()));
        }
        words.into_iter().flatten().collect()
    });
    let sequences = words.iter().map(|words| {
        assert_eq!(words["verdict"], "accepted");
        let sequence = words["sequence"].as_u64().expect("a number");
        let x = words["pose"]["values"][0]["value"]
            .as_f64()
            .expect("a number");
        assert!((x - sequence as f64).abs() < 1e-6, "{words}");
        sequence
    });
    let sequences: BTreeSet<u64> = sequences.collect();
    assert!(sequences.into_iter().eq(1..=10_000));
    assert_eq!(words.len(), 10_000);
    assert_eq!(service.num_inspected(), 10_000);
}

#[test]
fn as_many_triggers_wait_as_there_are_places_and_others_are_answered_at_once() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let settings = ServerSettings {
        max_clients: 2,
        ..patient()
    };
    let service = Service::start_with(settings, http_settings(), find);
    let [mut first, mut second, mut other] = [0; 3].map(|_| service.client());
    first.begin("POST", "/v1/trigger");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.begin("POST", "/v1/trigger");
    wait_until(|| {
        service
            .client()
            .get("/v1/metrics")
            .text
            .contains("partsight_clients 2\n")
    });
    // The client hangs up, but its place stays taken until its inspection is over.
    drop(first);
    for _ in 0..20 {
        let reply = other.trigger();
        assert_eq!(reply.status, 503);
        let answer = reply.json();
        assert_eq!(
            (&answer["verdict"], &answer["problem"]["reason"]),
            (&json!("full"), &json!("full"))
        );
        assert_eq!(
            (&answer["sequence"], &answer["pose"]),
            (&json!(0), &Value::Null)
        );
        assert_eq!(other.get("/v1/last").json()["verdict"], "none");
    }
    go_on.send(()).expect("awaited");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(2));
    assert_eq!(other.get("/v1/last").json()["sequence"], 1);
    go_on.send(()).expect("awaited");
    assert_eq!(second.reply().expect("an answer").json()["sequence"], 2);
}

/// Sets the flag when dropped, to end the threads that watch it.
struct EndAtLast<'a>(&'a AtomicBool);

impl Drop for EndAtLast<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

#[test]
fn hostile_clients_do_not_disturb_good_ones() {
    let service = Service::start_with(patient(), with_token(), accepted);
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        // The server may do anything with a hostile client: it continues with a new connection.
        let attack = |head: String, chunk: Vec<u8>, num: usize| {
            let (address, is_over) = (service.address, &is_over);
            scope.spawn(move || {
                while !is_over.load(Ordering::SeqCst) {
                    let Ok(mut stream) = TcpStream::connect(address) else {
                        continue;
                    };
                    let _ = stream.set_write_timeout(Some(Duration::from_millis(50)));
                    let _ = stream.write_all(head.as_bytes());
                    for _ in 0..num {
                        if stream.write_all(&chunk).is_err() {
                            break;
                        }
                    }
                    thread::sleep(Duration::from_millis(5));
                }
            });
        };
        let trigger = "POST /v1/trigger HTTP/1.1\r\nHost: x\r\n";
        let wrong = "Authorization: Bearer 0123456789abcdef0123456789abcdeX\r\n";
        attack("POST /v1/tri".into(), Vec::new(), 0);
        attack(format!("{trigger}{wrong}\r\n"), Vec::new(), 0);
        attack(String::new(), vec![0xff, 0x00, 0x80, b'\r', b'\n'], 100);
        attack(
            "GET / HTTP/1.1\r\n".into(),
            b"x: yyyyyyyyyyyyyyyyyyyyyyyy\r\n".to_vec(),
            10_000,
        );
        attack(
            format!("{trigger}{wrong}Content-Length: 1000000000\r\n\r\n"),
            vec![b'A'; 65536],
            200,
        );
        attack(
            format!("{trigger}{wrong}Transfer-Encoding: chunked\r\n\r\n"),
            b"8\r\nAAAAAAAA\r\n".to_vec(),
            10_000,
        );
        // Ends the attacks even if a good client fails.
        let _end = EndAtLast(&is_over);
        let mut kept = service.client().with_token(TOKEN);
        for round in 0..100 {
            // One client stays connected, the other connects for each request.
            let words = kept.trigger();
            assert_eq!(words.status, 200, "round {round}: {words:?}");
            let words = service.client().with_token(TOKEN).trigger();
            assert_eq!(words.status, 200, "round {round}: {words:?}");
        }
    });
    assert_eq!(service.num_inspected(), 200);
}

#[test]
fn a_thousand_silent_connections_make_room_for_others() {
    let service = Service::start_with(patient(), with_token(), accepted);
    let mut kept = service.client().with_token(TOKEN);
    assert_eq!(kept.trigger().status, 200);
    // A thousand connections, all of them silent; 600 at a time, which are more than the server allows.
    let mut silent = VecDeque::new();
    for _ in 0..1000 {
        silent.push_back(service.client());
        if silent.len() > 600 {
            silent.pop_front();
        }
    }
    for sequence in 2..=4 {
        let mut new = service.client().with_token(TOKEN);
        assert_eq!(new.trigger().json()["sequence"], sequence);
    }
    assert_eq!(kept.trigger().json()["sequence"], 5);
    drop(silent);
}

#[test]
fn what_is_too_long_or_too_slow_is_refused_and_the_connection_closed() {
    let short = ServerSettings {
        request_timeout: Duration::from_secs(2),
        ..ServerSettings::default()
    };
    let service = Service::start_with(short, http_settings(), accepted);
    let trigger = "POST /v1/trigger HTTP/1.1\r\nHost: localhost\r\n";
    let refused = |request: &str, status: u16, reason: &str| {
        let mut client = service.client();
        client.send(request.as_bytes()).expect("sent");
        let reply = client.reply().expect("an answer");
        assert_eq!(reply.status, status, "{reply:?}");
        if !reason.is_empty() {
            assert_eq!(reply.json()["problem"]["reason"], reason);
        }
        assert!(client.is_let_go(), "{reason}");
    };
    // A gigabyte announced, or begun; a missing body; a head that is too long.
    refused(
        &format!("{trigger}Content-Length: 1000000000\r\n\r\n"),
        413,
        "too_long",
    );
    let begun = format!(
        "{trigger}Content-Length: 1000000000\r\n\r\n{}",
        "A".repeat(100_000)
    );
    refused(&begun, 413, "too_long");
    let chunk = format!("1000\r\n{}\r\n", "A".repeat(4096));
    refused(
        &format!("{trigger}Transfer-Encoding: chunked\r\n\r\n{chunk}"),
        413,
        "too_long",
    );
    refused(
        &format!("{trigger}Content-Length: 5\r\n\r\nA"),
        408,
        "incomplete",
    );
    refused(
        &format!("{trigger}X: {}\r\n\r\n", "A".repeat(20_000)),
        431,
        "",
    );
    refused(&format!("{trigger}{}\r\n", "X: y\r\n".repeat(100)), 431, "");
    refused("\0\0\0\0\r\n\r\n", 400, "");
    // Half a head, and nothing at all.
    for bytes in [&b"POST /v1/trigger HTTP/1.1\r\nHo"[..], b""] {
        let mut client = service.client();
        client.send(bytes).expect("sent");
        assert!(client.is_let_go());
    }
    assert_eq!(service.num_inspected(), 0);
    assert_eq!(service.client().trigger().status, 200);
}

#[test]
fn who_waits_when_the_service_ends_is_told_so() {
    let (begun, has_begun) = mpsc::channel();
    let (go_on, may_go_on) = mpsc::channel::<()>();
    let find = move |number| {
        begun.send(number).expect("awaited");
        may_go_on.recv().expect("released");
        accepted(number)
    };
    let mut service = Service::start_with(patient(), http_settings(), find);
    let [mut first, mut second, mut idle] = [0; 3].map(|_| service.client());
    assert_eq!(idle.get("/v1/last").status, 200);
    first.begin("POST", "/v1/trigger");
    assert_eq!(has_begun.recv_timeout(PATIENCE), Ok(1));
    second.begin("POST", "/v1/trigger");
    wait_until(|| {
        service
            .client()
            .get("/v1/metrics")
            .text
            .contains("partsight_clients 2\n")
    });
    service.server.ask_to_end();
    go_on.send(()).expect("awaited");
    // Its inspection had begun.
    assert_eq!(first.reply().expect("an answer").json()["sequence"], 1);
    let reply = second.reply().expect("an answer");
    assert_eq!(reply.status, 503);
    assert_eq!(reply.json()["problem"]["reason"], "stopping");
    service.end();
    assert!(idle.is_let_go());
    assert!(TcpStream::connect(service.address).is_err());
}
