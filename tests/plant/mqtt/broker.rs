//! A mosquitto that the tests start, and a subscriber.

use std::{
    fs,
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::PathBuf,
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU32, Ordering},
        mpsc::{self, Receiver},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use plant::rumqttc::{Client, Event, MqttOptions, Packet, QoS};
use serde_json::Value;

/// Timeout with room for a busy machine and for the longest pause between two attempts to connect.
const PATIENCE: Duration = Duration::from_mins(2);

/// The password of the cell.
pub(crate) const PASSWORD: &str = "as written";

pub(crate) fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < until, "it took too long: {what}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// A broker that asks for a password; it loses all messages when it is killed.
pub(crate) struct Broker {
    folder: tempfile::TempDir,
    port: u16,
    child: Option<Child>,
}

fn is_there(program: &str) -> bool {
    let mut command = Command::new(program);
    let command = command.arg("--help").stdout(Stdio::null());
    command.stderr(Stdio::null()).status().is_ok()
}

/// The name or path of mosquitto; Debian installs it in a folder of root's path only.
fn mosquitto() -> Option<&'static str> {
    let mut names = ["mosquitto", "/usr/sbin/mosquitto"].into_iter();
    names.find(|name| is_there(name) && is_there("mosquitto_passwd"))
}

/// A port at which no server listens.
pub(crate) fn free_port() -> u16 {
    let socket = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    socket.local_addr().expect("its address").port()
}

/// True if mosquitto is installed; otherwise reports it, and fails if it is required.
pub(crate) fn has_mosquitto() -> bool {
    let is_installed = mosquitto().is_some();
    if !is_installed {
        let lacking = "mosquitto is not installed (apt-get install mosquitto)";
        geometry::fixtures::skipped("PARTSIGHT_REQUIRE_MQTT", lacking);
    }
    is_installed
}

impl Broker {
    /// Prepares a broker without starting it; `None`, with a message, if mosquitto is not installed.
    pub(crate) fn prepare() -> Option<Self> {
        if !has_mosquitto() {
            return None;
        }
        let folder = tempfile::tempdir().expect("a folder");
        let port = free_port();
        let broker = Self {
            folder,
            port,
            child: None,
        };
        // If started by root, it would otherwise switch to a user who cannot read the folder.
        let config = format!(
            "listener {port} 127.0.0.1\nallow_anonymous false\npassword_file {}\nuser root\n",
            broker.path("passwords").display()
        );
        fs::write(broker.path("mosquitto.conf"), config).expect("written");
        fs::write(broker.path("passwords"), "").expect("written");
        broker.let_in("cell", PASSWORD);
        broker.let_in("listener", "listens");
        Some(broker)
    }

    /// Prepares and starts a broker; `None` as for [`Self::prepare`].
    pub(crate) fn start_new() -> Option<Self> {
        let mut broker = Self::prepare()?;
        broker.start();
        Some(broker)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The address of the cell at this broker.
    pub(crate) fn address(&self) -> String {
        format!("mqtt://cell@127.0.0.1:{}/hall3/cell7", self.port)
    }

    /// Sets the user's password from the next start or [`Self::reload`] on.
    pub(crate) fn let_in(&self, user: &str, password: &str) {
        let status = Command::new("mosquitto_passwd")
            .arg("-b")
            .arg(self.path("passwords"))
            .args([user, password])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        assert!(status.expect("started").success());
    }

    pub(crate) fn start(&mut self) {
        let child = Command::new(mosquitto().expect("it was there"))
            .arg("-c")
            .arg(self.path("mosquitto.conf"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        self.child = Some(child.expect("started"));
        let at = (Ipv4Addr::LOCALHOST, self.port);
        wait_until("mosquitto listens", || TcpStream::connect(at).is_ok());
    }

    pub(crate) fn reload(&self) {
        let id = self.child.as_ref().expect("started").id().to_string();
        let sent = Command::new("kill").args(["-HUP", &id]).status();
        assert!(sent.expect("kill is there").success());
    }

    /// Kills it, like a loss of power.
    pub(crate) fn kill(&mut self) {
        if let Some(mut child) = self.child.take() {
            child.kill().expect("killed");
            child.wait().expect("ended");
        }
    }
}

impl Drop for Broker {
    fn drop(&mut self) {
        self.kill();
    }
}

/// A message that arrived.
#[derive(Clone, Debug)]
pub(crate) struct Received {
    /// Topic without the prefix.
    pub(crate) topic: String,
    pub(crate) is_retained: bool,
    pub(crate) json: Value,
}

fn listener_name() -> String {
    static NUM: AtomicU32 = AtomicU32::new(0);
    format!("listener-{}", NUM.fetch_add(1, Ordering::SeqCst))
}

/// A subscriber to all topics of the cell, which subscribes again after every loss of the connection.
pub(crate) struct Subscriber {
    received: Receiver<Received>,
    num_subscribed: Arc<AtomicU32>,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Subscriber {
    /// Starts a subscriber, and returns once it is subscribed.
    pub(crate) fn start(broker: &Broker) -> Self {
        let mut options = MqttOptions::new(listener_name(), "127.0.0.1", broker.port);
        options.set_credentials("listener", "listens");
        Self::start_with(options, "hall3/cell7/")
    }

    /// Subscribes to all topics with this prefix, at a broker without passwords.
    pub(crate) fn start_at(port: u16, prefix: &'static str) -> Self {
        let options = MqttOptions::new(listener_name(), "127.0.0.1", port);
        Self::start_with(options, prefix)
    }

    fn start_with(mut options: MqttOptions, prefix: &'static str) -> Self {
        options.set_max_packet_size(1 << 20, 1 << 20);
        let (tell, received) = mpsc::channel();
        let num_subscribed = Arc::new(AtomicU32::new(0));
        let is_ending = Arc::new(AtomicBool::new(false));
        let (theirs, is_over) = (Arc::clone(&num_subscribed), Arc::clone(&is_ending));
        let thread = thread::spawn(move || {
            let (client, mut connection) = Client::new(options, 8);
            while !is_over.load(Ordering::SeqCst) {
                match connection.recv_timeout(Duration::from_secs(1)) {
                    Ok(Ok(Event::Incoming(Packet::ConnAck(_)))) => {
                        let all = client.try_subscribe(format!("{prefix}#"), QoS::AtLeastOnce);
                        all.expect("room");
                    }
                    Ok(Ok(Event::Incoming(Packet::SubAck(_)))) => {
                        theirs.fetch_add(1, Ordering::SeqCst);
                    }
                    Ok(Ok(Event::Incoming(Packet::Publish(publish)))) => {
                        let topic = publish.topic.strip_prefix(prefix);
                        let received = Received {
                            topic: topic.expect("of the cell").to_owned(),
                            is_retained: publish.retain,
                            json: serde_json::from_slice(&publish.payload).expect("JSON"),
                        };
                        // The receiver is gone once the test has ended.
                        let _ = tell.send(received);
                    }
                    Ok(Err(_)) => thread::sleep(Duration::from_millis(20)),
                    _ => {}
                }
            }
        });
        let subscriber = Self {
            received,
            num_subscribed,
            is_ending,
            thread: Some(thread),
        };
        subscriber.wait_subscribed(1);
        subscriber
    }

    /// Waits until it has subscribed this many times.
    pub(crate) fn wait_subscribed(&self, num: u32) {
        wait_until("subscribed", || {
            self.num_subscribed.load(Ordering::SeqCst) >= num
        });
    }

    pub(crate) fn next(&self) -> Received {
        self.received.recv_timeout(PATIENCE).expect("a message")
    }

    /// The next message of this topic.
    pub(crate) fn next_of(&self, topic: &str) -> Received {
        loop {
            let received = self.next();
            if received.topic == topic {
                return received;
            }
        }
    }

    /// The state that the broker retains.
    pub(crate) fn retained(broker: &Broker) -> Value {
        let state = Self::start(broker).next_of("state");
        assert!(state.is_retained, "{state:?}");
        state.json
    }
}

impl Drop for Subscriber {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let joined = thread.join();
            assert!(joined.is_ok() || thread::panicking(), "a wrong message");
        }
    }
}
