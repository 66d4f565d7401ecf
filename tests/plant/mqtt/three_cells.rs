//! The three simulated cells of `packaging`: the script that starts them, and the file for compose.

use std::{
    collections::BTreeSet,
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::{Ipv4Addr, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
};

use serde_json::{Value, json};

use crate::mqtt::{
    assert_conforms,
    broker::{Received, Subscriber, free_port, has_mosquitto, wait_until},
    program::interrupt,
};

const CELLS: [(&str, &str); 3] = [
    ("cell1", "fender"),
    ("cell2", "front_door"),
    ("cell3", "trunk_lid"),
];

fn at(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The running script, ended when dropped.
struct Script(Child);

impl Drop for Script {
    fn drop(&mut self) {
        if let Ok(None) = self.0.try_wait() {
            interrupt(&self.0);
        }
        let _ = self.0.wait();
    }
}

/// Processes whose command line or environment names this folder, except the script itself.
fn processes_of(folder: &Path, script: u32) -> Vec<String> {
    let folder = folder.to_str().expect("text");
    let entries = fs::read_dir("/proc").expect("Linux");
    let processes = entries.filter_map(|entry| {
        let path = entry.ok()?.path();
        let id: u32 = path.file_name()?.to_str()?.parse().ok()?;
        // For a process that has ended these cannot be read, or are empty.
        let command = fs::read(path.join("cmdline")).ok()?;
        let environment = fs::read(path.join("environ")).unwrap_or_default();
        let all = [command.as_slice(), &environment].concat();
        let names = String::from_utf8_lossy(&all).contains(folder);
        let command = String::from_utf8_lossy(&command).replace('\0', " ");
        (names && id != script).then_some(command)
    });
    processes.collect()
}

/// All messages that arrived, in any order.
struct Inbox {
    subscriber: Subscriber,
    received: Vec<Received>,
}

impl Inbox {
    /// The first message of this topic that meets the condition; waits for it if necessary.
    fn find(&mut self, topic: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        let mut next = 0;
        loop {
            for received in &self.received[next..] {
                if received.topic == topic && is_so(&received.json) {
                    return received.json.clone();
                }
            }
            next = self.received.len();
            self.received.push(self.subscriber.next());
        }
    }
}

fn trigger(port: u16) -> String {
    let at = (Ipv4Addr::LOCALHOST, port);
    wait_until("the cell listens", || TcpStream::connect(at).is_ok());
    let mut stream = BufReader::new(TcpStream::connect(at).expect("connected"));
    stream.get_mut().write_all(b"TRIGGER\n").expect("sent");
    let mut line = String::new();
    stream.read_line(&mut line).expect("answered");
    line
}

#[test]
fn three_cells_tell_their_states_and_verdicts_and_end_together() {
    if !has_mosquitto() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let data = folder.path().join("cells");
    let broker = free_port();
    let ports = [free_port(), free_port(), free_port()];
    let messages = fs::File::create(folder.path().join("messages")).expect("created");
    // The parent process may ignore Ctrl-C, which a script inherits and cannot undo.
    let script = Command::new("env")
        .args(["--default-signal=INT", "bash"])
        .arg(at("packaging/three_cells.sh"))
        .arg(&data)
        .env("PARTSIGHT", env!("CARGO_BIN_EXE_partsight"))
        .env("MQTT_PORT", broker.to_string())
        .env("CELL_PORTS", ports.map(|port| port.to_string()).join(" "))
        .env("HOME", folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(messages)
        .spawn();
    let mut script = Script(script.expect("starts"));
    let words = || {
        let words = fs::read_to_string(folder.path().join("messages"));
        words.unwrap_or_default()
    };
    wait_until("mosquitto listens", || {
        TcpStream::connect((Ipv4Addr::LOCALHOST, broker)).is_ok()
    });
    let mut inbox = Inbox {
        subscriber: Subscriber::start_at(broker, "three_cells/"),
        received: Vec::new(),
    };

    for (port, (cell, part)) in ports.into_iter().zip(CELLS) {
        let is_running = |state: &Value| state["camera"]["state"] == "running";
        let state = inbox.find(&format!("{cell}/state"), is_running);
        assert_conforms(&state, "StateMessage");
        assert_eq!(state["online"], true, "{state}");
        let reply = trigger(port);
        assert!(
            reply.starts_with("TRIGGER;accepted;1;"),
            "{reply}{}",
            words()
        );
        let message = inbox.find(&format!("{cell}/inspection"), |_| true);
        assert_conforms(&message, "InspectionMessage");
        assert_eq!(
            (&message["part"], &message["verdict"]),
            (&json!(part), &json!("accepted"))
        );
        // Each cell has a folder of its own.
        let library = data.join(cell).join("partsight/library");
        assert!(library.is_dir(), "{}", library.display());
    }
    let at_work = processes_of(folder.path(), script.0.id());
    assert_eq!(at_work.len(), 4, "{at_work:?}");

    interrupt(&script.0);
    let ended = script.0.wait().expect("ends");
    assert_eq!(ended.code(), Some(0), "{}", words());
    for (cell, _) in CELLS {
        let state = inbox.find(&format!("{cell}/state"), |state| state["online"] == false);
        assert_conforms(&state, "StateMessage");
    }
    drop(inbox);
    let left = processes_of(folder.path(), script.0.id());
    assert!(left.is_empty(), "{left:?}");
}

/// `compose.yaml` as JSON; `None`, with a message, if no Python can read YAML.
fn compose() -> Option<Value> {
    let program =
        "import json, sys, yaml; json.dump(yaml.safe_load(open(sys.argv[1])), sys.stdout)";
    // Another Python in the path may lack the packages that Debian's has.
    let mut interpreters = ["python3", "/usr/bin/python3"].into_iter();
    let has_yaml = |interpreter: &&str| {
        let tried = Command::new(interpreter)
            .args(["-c", "import yaml"])
            .output();
        tried.is_ok_and(|output| output.status.success())
    };
    let Some(interpreter) = interpreters.find(has_yaml) else {
        let lacking = "Python's yaml is not installed (apt-get install python3-yaml)";
        geometry::fixtures::skipped("PARTSIGHT_REQUIRE_PACKAGING", lacking);
        return None;
    };
    let read = Command::new(interpreter)
        .args(["-c", program])
        .arg(at("packaging/compose.yaml"))
        .output();
    let read = read.expect("it was there");
    let words = String::from_utf8_lossy(&read.stderr);
    assert!(read.status.success(), "{words}");
    Some(serde_json::from_slice(&read.stdout).expect("JSON"))
}

/// Starts no container: checks that the program accepts the options of every cell.
#[test]
fn the_containers_are_the_same_three_cells() {
    let Some(compose) = compose() else {
        return;
    };
    let services = compose["services"].as_object().expect("services");
    assert!(services.contains_key("broker"));
    // One service builds the image of all; the others must not look for it in a registry.
    let with_build = CELLS.map(|(cell, _)| services[cell]["build"]["dockerfile"].as_str());
    let [Some(recipe), None, None] = with_build else {
        panic!("{with_build:?}");
    };
    let recipe = fs::read_to_string(at(recipe)).expect("a Containerfile");
    let copied = recipe.lines().find_map(|line| line.strip_prefix("COPY "));
    let copied = copied.and_then(|args| args.split(' ').next());
    let context = fs::read_to_string(at(".dockerignore")).expect("read");
    let sent = context.lines().filter_map(|line| line.strip_prefix('!'));
    assert_eq!(sent.collect::<Vec<_>>(), [copied.expect("a package")]);
    let folder = tempfile::tempdir().expect("a folder");
    let mut addresses = BTreeSet::new();
    for (cell, part) in CELLS {
        let service = &services[cell];
        assert_eq!(service["image"], "localhost/partsight", "{cell}");
        let is_pulled = service["pull_policy"] != "never";
        assert_eq!(is_pulled, service["build"].is_object(), "{cell}");
        for volume in service["volumes"].as_array().expect("a list") {
            let volume = volume.as_str().expect("text");
            let (from, _) = volume.split_once(':').expect("from:to");
            let is_known = match from.strip_prefix("./") {
                Some(file) => at("packaging").join(file).is_file(),
                None => compose["volumes"].get(from).is_some() && from == cell,
            };
            assert!(is_known, "{volume}");
        }
        let address = service["ports"][0].as_str().expect("text");
        assert!(addresses.insert(address), "{address} is taken");
        let args = service["command"].as_array().expect("a list");
        let args = args.iter().map(|arg| arg.as_str().expect("text"));
        // Options are checked before the calibration, which is missing.
        let missing = "--calibration=no_such_cell.toml";
        let args = args.map(|arg| {
            let is_calibration = arg.starts_with("--calibration=");
            if is_calibration { missing } else { arg }
        });
        let args: Vec<&str> = args.collect();
        assert!(args.contains(&missing), "{args:?}");
        assert!(args.iter().any(|arg| arg.ends_with(part)), "{args:?}");
        let prefix = format!("--mqtt=mqtt://broker/three_cells/{cell}");
        assert!(args.contains(&prefix.as_str()), "{args:?}");
        let output = Command::new(env!("CARGO_BIN_EXE_partsight"))
            .args(&args)
            .current_dir(folder.path())
            .env("HOME", folder.path())
            .env("XDG_DATA_HOME", folder.path())
            .output()
            .expect("starts");
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(words.contains("no_such_cell.toml"), "{words}");
    }
}
