//! A cell without a camera: a server that a robot triggers, and that publishes its results.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpStream,
    sync::{Arc, Mutex},
    time::Duration,
};

use partsight::{
    history::Traceability,
    plant::mqtt::{
        BrokerAccess, LibraryMessage, LinkNews, LinkSubject, MqttLink, PoseFormat, Unsent,
    },
    robot::Convention,
    serve::{CameraStatus, Found, ListenAddress, Listener, PoseKind, Server, ServerSettings},
};
pub(crate) use serve::fixtures::accepted;
use serve::fixtures::{self, RunningServer};

use crate::mqtt::broker::{Broker, wait_until};

pub(crate) fn refused(number: u32) -> Found {
    fixtures::refused(accepted(number))
}

pub(crate) struct Cell {
    pub(crate) link: Arc<MqttLink>,
    pub(crate) boot: u32,
    robot: Option<BufReader<TcpStream>>,
    server: RunningServer,
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
        let server =
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
        };
        let trace = Traceability {
            order: "A-17".into(),
            ..Traceability::default()
        };
        let link = Arc::new(MqttLink::start(&access, subject).expect("started"));
        let robot = TcpStream::connect(server.addresses()[0].address).expect("connected");
        let inspected = Arc::clone(&link);
        let server = RunningServer::start(
            server,
            move |number, _| find(number).into(),
            move |record| inspected.inspected(record, &trace),
        );
        Self {
            link,
            boot,
            robot: Some(BufReader::new(robot)),
            server,
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
        self.robot = None;
        self.server.end();
    }
}
