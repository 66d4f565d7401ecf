//! The server for robots and PLCs, tested over real sockets on the loopback address with an inspector that needs no
//! camera.
//!
//! Requests are written and answers parsed here according to the guide, not with the program's own functions.

mod answers;
mod client;
mod hostile;
mod triggers;

use std::{
    collections::{BTreeSet, VecDeque},
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{SocketAddr, TcpStream},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use geometry::rigid::RigidTransform;
use robot::Convention;
use serve::{
    Answer, Asked, CameraState, CameraStatus, ClientEvent, ClientNews, Found, FrameParts,
    ListenAddress, Listener, PathStep, Problem, Server, ServerSettings, VerdictCode,
    fixtures::{self, RunningServer},
};

use client::Robot;

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(2);

/// Every protocol, at any free port.
const ALL: [&str; 5] = ["ascii=0", "binary=0", "binary-be=0", "eki=0", "urscript=0"];

/// An accepted part with a path.
fn accepted(number: u32) -> Found {
    let step = |x, marks, speed| PathStep {
        robot_from_nozzle: RigidTransform::translation(x, 0.25, 1.5),
        marks,
        speed,
    };
    Found {
        path: vec![
            step(0.007, Answer::GUN_ON, Some(0.25)),
            step(0.008, 0, None),
        ],
        ..fixtures::accepted(number)
    }
}

fn refused(number: u32) -> Found {
    fixtures::refused(accepted(number))
}

/// A running server.
struct Service {
    addresses: Vec<SocketAddr>,
    camera: Arc<Mutex<CameraStatus>>,
    events: Arc<Mutex<Vec<ClientEvent>>>,
    server: RunningServer,
}

impl Service {
    fn start<F: Into<FrameParts>>(
        listen: &[&str],
        settings: ServerSettings,
        mut find: impl FnMut(u32) -> F + Send + 'static,
    ) -> Self {
        let listeners = listen.iter().map(|text| {
            let at: ListenAddress = text.parse().expect("an address");
            Listener::new(at, Some(Convention::Fanuc)).expect("spoken")
        });
        let listeners: Vec<Listener> = listeners.collect();
        let camera = Arc::new(Mutex::new(CameraStatus {
            state: CameraState::Running,
            problem: None,
        }));
        let events = Arc::new(Mutex::new(Vec::new()));
        let (of_clients, reply) = (Arc::clone(&camera), Arc::clone(&events));
        let server = Server::start(
            &listeners,
            settings,
            move || of_clients.lock().expect("whole").clone(),
            move |event| reply.lock().expect("whole").push(event),
        )
        .expect("started");
        let addresses = server.addresses().iter().map(|at| at.address).collect();
        let find = move |number, asked: &Asked| {
            assert!(asked.at <= Instant::now());
            find(number).into()
        };
        Self {
            addresses,
            camera,
            events,
            server: RunningServer::start(server, find, drop),
        }
    }

    fn robot(&self, index: usize) -> Robot {
        Robot::connect(self.addresses[index], ALL[index])
    }

    fn wait_for(&self, news: impl Fn(&ClientNews) -> bool) {
        wait_until(|| {
            let events = self.events.lock().expect("whole");
            events.iter().any(|event| news(&event.news))
        });
    }
}

fn wait_until(what: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !what() {
        assert!(Instant::now() < until, "it took too long");
        thread::sleep(Duration::from_millis(5));
    }
}
