//! The HTTP interface of the server, tested over real sockets on the loopback address with an inspector that needs no
//! camera.
//!
//! Requests are written and answers parsed by hand, and checked against the published description.

mod access;
mod answers;
mod client;
mod command;
mod limits;
mod schema;

use std::{
    net::SocketAddr,
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

use partsight::{
    RigidTransform,
    plant::http::{HttpServer, HttpSettings, Tls, Tokens},
    robot::Convention,
    serve::{
        Answer, Asked, CameraState, CameraStatus, ClientEvent, ClientNews, Found, FrameParts,
        PathStep, Server, ServerSettings,
    },
};
use serve::fixtures::{self, RunningServer};

use self::client::Client;

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(2);

/// An accepted part with a path and a report.
fn accepted(number: u32) -> Found {
    let step = |x, marks, speed| PathStep {
        robot_from_nozzle: RigidTransform::translation(x, 0.25, 1.5),
        marks,
        speed,
    };
    Found {
        path: vec![
            step(0.007, Answer::GUN_ON, Some(0.25)),
            step(0.008, Answer::IN_BAND, None),
        ],
        report: r#"{"schema":1,"status":"ok","pose":{"rms_m":0.5},"robot":{"calibration":"cell"},"ranking":[]}"#
            .into(),
        ..fixtures::accepted(number)
    }
}

fn refused(number: u32) -> Found {
    fixtures::refused(accepted(number))
}

/// State of a service's camera; `None` makes the program panic when it is asked.
type Camera = Arc<Mutex<Option<CameraStatus>>>;

/// A running server with HTTP only.
struct Service {
    http: Option<HttpServer>,
    address: SocketAddr,
    camera: Camera,
    events: Arc<Mutex<Vec<ClientEvent>>>,
    server: RunningServer,
}

impl Service {
    fn start<F: Into<FrameParts>>(find: impl FnMut(u32) -> F + Send + 'static) -> Self {
        Self::start_with(patient(), http_settings(), find)
    }

    fn start_with<F: Into<FrameParts>>(
        settings: ServerSettings,
        http: HttpSettings,
        mut find: impl FnMut(u32) -> F + Send + 'static,
    ) -> Self {
        let camera: Camera = Arc::new(Mutex::new(Some(CameraStatus {
            state: CameraState::Running,
            problem: None,
        })));
        let events = Arc::new(Mutex::new(Vec::new()));
        let (of_clients, reply) = (Arc::clone(&camera), Arc::clone(&events));
        let server = Server::start(
            &[],
            settings,
            move || {
                let status = of_clients.lock().map(|status| status.clone());
                status.expect("whole").expect("the camera is asked")
            },
            move |event| reply.lock().expect("whole").push(event),
        )
        .expect("started");
        let http = HttpServer::start(http, server.handle()).expect("started");
        let find = move |number, asked: &Asked| {
            let mut found: FrameParts = find(number).into();
            // What is expected shows in the answer.
            found.first.number += (asked.expected.iter())
                .map(|one| one.part + 100 * one.place)
                .sum::<u32>();
            let named = [&asked.order.order, &asked.order.serial];
            found.first.number += 1000 * named.map(|text| text.len() as u32).iter().sum::<u32>();
            let age = asked.count_age.as_millis() as u32;
            found.first.number += asked.count.map_or(0, |count| 100_000 + count % 1000 + age);
            found
        };
        Self {
            address: http.address(),
            http: Some(http),
            camera,
            events,
            server: RunningServer::start(server, find, drop),
        }
    }

    fn client(&self) -> Client {
        Client::connect(self.address)
    }

    fn num_inspected(&self) -> u32 {
        self.server.num_inspected()
    }

    fn num_events(&self, news: &ClientNews) -> usize {
        let events = self.events.lock().expect("whole");
        events.iter().filter(|event| event.news == *news).count()
    }

    fn end(&mut self) {
        self.server.end();
        self.http = None;
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        self.end();
    }
}

/// Settings that do not disconnect a client, even on a slow machine.
fn patient() -> ServerSettings {
    ServerSettings {
        request_timeout: PATIENCE,
        ..ServerSettings::default()
    }
}

/// Settings for any free port of the loopback address.
fn http_settings() -> HttpSettings {
    HttpSettings {
        address: "127.0.0.1:0".parse().expect("an address"),
        convention: Convention::Fanuc,
        tokens: Tokens::default(),
        tls: None,
    }
}

/// Reads tokens from a file with this text.
fn tokens(text: &str) -> Tokens {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("tokens");
    std::fs::write(&path, text).expect("written");
    Tokens::load(&path).expect("tokens")
}

/// A self-signed certificate for the loopback address, for tests only.
fn certificate() -> PathBuf {
    own_file("localhost.cert.pem")
}

fn key() -> PathBuf {
    own_file("localhost.key.pem")
}

fn own_file(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("tests/plant/http").join(name)
}

fn tls() -> Tls {
    Tls::load(&certificate(), &key()).expect("a certificate and its key")
}

fn wait_until(what: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !what() {
        assert!(Instant::now() < until, "it took too long");
        thread::sleep(Duration::from_millis(5));
    }
}
