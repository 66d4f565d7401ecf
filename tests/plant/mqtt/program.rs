//! The built program, when it is killed and when it ends.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpStream,
    path::Path,
    process::{Child, ChildStderr, Command, Stdio},
};

use serde_json::json;

use crate::mqtt::{
    assert_conforms,
    broker::{Broker, PASSWORD, Subscriber},
};

pub(crate) fn partsight(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_partsight"));
    command
        .args(args)
        .current_dir(folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env("XDG_DATA_HOME", folder.join("data"))
        .env("HOME", folder);
    command
}

/// Writes the password of the cell and its calibration, `cell.toml`.
pub(crate) fn prepare(folder: &Path) {
    fs::write(folder.join("password"), PASSWORD).expect("written");
    let matrix = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
    let mount = ["--mount", "eye-to-hand", "--out", "cell.toml"];
    let calibrate = [&["calibrate", "set", matrix][..], &mount].concat();
    let calibrated = partsight(folder, &calibrate).output();
    assert!(calibrated.expect("starts").status.success());
}

pub(crate) fn interrupt(child: &Child) {
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.expect("kill is there").success());
}

/// The simulated cell, killed when dropped.
struct Service {
    child: Child,
    messages: BufReader<ChildStderr>,
}

impl Service {
    fn start(folder: &Path, broker: &Broker) -> Self {
        let address = broker.address();
        let cell = [
            "serve",
            "--source",
            "simulated,fps=5:fender",
            "--as",
            "kuka",
        ];
        let place = [
            "--calibration",
            "cell.toml",
            "--listen",
            "ascii=0",
            "--no-history",
        ];
        let mqtt = ["--mqtt", &address, "--mqtt-password-file", "password"];
        let mut child = partsight(folder, &[&cell[..], &place, &mqtt].concat())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("starts");
        let messages = BufReader::new(child.stderr.take().expect("a pipe"));
        Self { child, messages }
    }

    /// Waits for the message that begins with `begin`, and returns the rest of its line.
    fn line(&mut self, begin: &str) -> String {
        let mut all = String::new();
        loop {
            let mut line = String::new();
            let num = self.messages.read_line(&mut line).expect("text");
            assert!(num > 0, "it ended without {begin}: {all}");
            if let Some(rest) = line.strip_prefix(begin) {
                return rest.trim_end().to_owned();
            }
            all += &line;
        }
    }

    fn trigger(&mut self) {
        let line = self.line("Listening: ascii=");
        let (address, _) = line.split_once(',').expect("an address");
        let mut stream = BufReader::new(TcpStream::connect(address).expect("connected"));
        stream.get_mut().write_all(b"TRIGGER\n").expect("sent");
        let mut line = String::new();
        stream.read_line(&mut line).expect("answered");
        assert!(line.starts_with("TRIGGER;accepted;1;"), "{line}");
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_program_that_is_killed_becomes_offline_and_one_that_ends_says_so() {
    let Some(broker) = Broker::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    prepare(folder.path());
    let subscriber = Subscriber::start(&broker);
    let mut service = Service::start(folder.path(), &broker);
    service.trigger();
    let message = subscriber.next_of("inspection").json;
    assert_conforms(&message, "InspectionMessage");
    assert_eq!(
        (&message["part"], &message["verdict"]),
        (&json!("fender"), &json!("accepted"))
    );
    assert_eq!(
        (&message["simulated"], &message["number"]),
        (&json!(true), &json!(3))
    );
    assert_eq!(message["pose"]["in_convention"]["convention"], "kuka");
    // The program is killed, so only the broker can report it.
    drop(service);
    loop {
        let state = subscriber.next_of("state").json;
        assert_conforms(&state, "StateMessage");
        if state["online"] == false {
            break;
        }
        assert_eq!(state["library"]["num_parts"], 8);
    }
    assert_eq!(Subscriber::retained(&broker)["online"], false);

    let mut service = Service::start(folder.path(), &broker);
    service.line("MQTT: connected");
    interrupt(&service.child);
    assert!(service.child.wait().expect("ended").success());
    let kept = Subscriber::retained(&broker);
    assert_eq!(
        (&kept["online"], &kept["camera"]),
        (&json!(false), &json!(null))
    );
}

#[test]
fn a_password_in_the_address_is_refused_and_not_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    for address in ["mqtt://me:secret@broker/cell", "tcp://me:secret@broker/c"] {
        let serve = ["serve", "--source", "simulated:fender", "--as", "kuka"];
        let args = [&serve[..], &["--mqtt", address]].concat();
        let refused = partsight(folder.path(), &args).output().expect("starts");
        let words = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{words}");
        assert!(words.contains("to do: "), "{words}");
        assert!(!words.contains("secret"), "{words}");
    }
}

#[test]
fn the_schema_of_the_messages_can_be_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    let printed = partsight(folder.path(), &["report", "--schema=mqtt"]).output();
    let printed = String::from_utf8(printed.expect("starts").stdout).expect("text");
    let published = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mqtt.schema.json");
    assert_eq!(printed, fs::read_to_string(published).expect("the schema"));
}
