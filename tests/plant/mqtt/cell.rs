//! A cell without a camera: a server that a robot triggers, and that publishes its results.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpStream,
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use partsight::{
    RigidTransform,
    history::Traceability,
    plant::mqtt::{
        BrokerAccess, LibraryMessage, LinkNews, LinkSubject, MqttLink, PoseFormat, Unsent,
    },
    robot::Convention,
    serve::{
        Answer, Asked, CameraStatus, Found, FrameParts, InspectionRecord, Inspector, ListenAddress,
        Listener, PoseKind, Problem, Server, ServerSettings, VerdictCode,
    },
};

use crate::mqtt::broker::{Broker, wait_until};

/// An accepted part, `number` millimetres from the robot.
pub(crate) fn accepted(number: u32) -> Found {
    let x = f64::from(number) / 1000.0;
    Found {
        verdict: VerdictCode::Accepted,
        captured: Some(Instant::now()),
        part: "fender".into(),
        number: 4,
        marks: Answer::SIMULATED,
        pose: Some(RigidTransform::translation(x, 0.25, 1.5)),
        ..Found::default()
    }
}

pub(crate) fn refused(number: u32) -> Found {
    Found {
        verdict: VerdictCode::Refused,
        problem: Problem {
            reason: "low_score".into(),
            message: "too low (to do: Look again)".into(),
        },
        // The cell must not publish these.
        ..accepted(number)
    }
}

/// An inspector that returns what it is told to, and publishes it.
struct Fake {
    number: u32,
    find: fn(u32) -> Found,
    link: Arc<MqttLink>,
    is_ending: Arc<AtomicBool>,
}

impl Inspector for Fake {
    fn inspect(&mut self, _asked: &Asked) -> FrameParts {
        self.number += 1;
        (self.find)(self.number).into()
    }

    fn recorded(&mut self, record: InspectionRecord) {
        self.link.inspected(record);
    }

    fn answered(&mut self) {}

    fn turn(&mut self) -> ControlFlow<()> {
        if self.is_ending.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

pub(crate) struct Cell {
    pub(crate) link: Arc<MqttLink>,
    pub(crate) boot: u32,
    robot: Option<BufReader<TcpStream>>,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    news: Mutex<Vec<LinkNews>>,
}

impl Cell {
    /// Starts a cell that accepts every part.
    pub(crate) fn start(broker: &Broker, password: &str) -> Self {
        Self::start_with(
            broker,
            password,
            ServerSettings::default().max_age,
            accepted,
        )
    }

    pub(crate) fn start_with(
        broker: &Broker,
        password: &str,
        max_age: Duration,
        find: fn(u32) -> Found,
    ) -> Self {
        let file = broker.path("password");
        fs::write(&file, password).expect("written");
        let address = broker.address().parse().expect("an address");
        let access = BrokerAccess::new(address, Some(&file), None).expect("usable");
        let at: ListenAddress = "ascii=0".parse().expect("an address");
        let listener = Listener::new(at, Some(Convention::Kuka)).expect("spoken");
        let settings = ServerSettings {
            max_age,
            ..ServerSettings::default()
        };
        let mut server =
            Server::start(&[listener], settings, CameraStatus::default, |_| ()).expect("started");
        let boot = server.boot();
        let subject = LinkSubject {
            boot,
            library: LibraryMessage {
                identity: "0123abcd".into(),
                num_parts: 8,
            },
            pose: PoseFormat {
                kind: PoseKind::RobotFromPart,
                convention: Convention::Kuka,
            },
            trace: Traceability {
                order: "A-17".into(),
                ..Traceability::default()
            },
        };
        let link = Arc::new(MqttLink::start(&access, subject).expect("started"));
        let is_ending = Arc::new(AtomicBool::new(false));
        let robot = TcpStream::connect(server.addresses()[0].address).expect("connected");
        let mut fake = Fake {
            number: 0,
            find,
            link: Arc::clone(&link),
            is_ending: Arc::clone(&is_ending),
        };
        Self {
            link,
            boot,
            robot: Some(BufReader::new(robot)),
            is_ending,
            thread: Some(thread::spawn(move || server.run(&mut fake))),
            news: Mutex::default(),
        }
    }

    /// Triggers an inspection and returns the verdict that the robot receives.
    pub(crate) fn trigger(&mut self) -> String {
        let robot = self.robot.as_mut().expect("connected");
        robot.get_mut().write_all(b"TRIGGER\n").expect("sent");
        let mut line = String::new();
        robot.read_line(&mut line).expect("answered");
        line.split(';').nth(1).expect("a verdict").to_owned()
    }

    /// All events of the link so far.
    pub(crate) fn news(&self) -> Vec<LinkNews> {
        let mut all = self.news.lock().expect("whole");
        while let Some(news) = self.link.news() {
            all.push(news);
        }
        all.clone()
    }

    pub(crate) fn wait_connected(&self, num: usize) {
        let is_connected = |news: &&LinkNews| matches!(news, LinkNews::Connected { .. });
        wait_until("connected", || {
            self.news().iter().filter(is_connected).count() >= num
        });
    }

    pub(crate) fn wait_lost(&self) {
        let is_lost = |news: &LinkNews| matches!(news, LinkNews::Lost(_));
        wait_until("lost", || self.news().iter().any(is_lost));
    }

    pub(crate) fn end(mut self) -> Result<(), Unsent> {
        self.stop();
        let link = Arc::into_inner(self.link).expect("the server has ended");
        link.end()
    }

    fn stop(&mut self) {
        self.is_ending.store(true, Ordering::SeqCst);
        self.robot = None;
        if let Some(thread) = self.thread.take() {
            thread.join().expect("ended");
        }
    }
}
