//! `partsight serve --http`: the built program, with the simulated cell as its camera.

use std::{
    io::{BufRead as _, BufReader},
    net::SocketAddr,
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use serde_json::{Value, json};

use super::client::Client;

/// A command of the built program, with this folder as the user's own.
fn partsight(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_partsight"));
    command
        .args(args)
        .current_dir(folder)
        .env("XDG_DATA_HOME", folder.join("data"))
        .env("HOME", folder);
    command
}

/// A folder with the calibration of a cell whose camera frame is the robot's base frame.
fn cell() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let pose = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
    let set = [
        "calibrate",
        "set",
        pose,
        "--mount",
        "eye-to-hand",
        "--out",
        "cell.toml",
    ];
    let ran = partsight(folder.path(), &set).output().expect("ran");
    assert!(ran.status.success(), "{ran:?}");
    folder
}

const SERVE: [&str; 7] = [
    "serve",
    "--source",
    "simulated,fps=5:fender",
    "--calibration",
    "cell.toml",
    "--listen",
    "eki=0",
];

/// Ends the program even if a test fails.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A running program that listens for HTTP.
struct Started {
    child: Ended,
    /// Its messages up to the one with the address.
    words: Vec<String>,
    address: SocketAddr,
    /// Its further messages.
    rest: Box<dyn Iterator<Item = String> + Send>,
}

fn started(folder: &Path, args: &[&str]) -> Started {
    let child = partsight(folder, args)
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn();
    let mut child = Ended(child.expect("starts"));
    let stderr = BufReader::new(child.0.stderr.take().expect("a pipe"));
    let mut words = Vec::new();
    let mut lines = stderr.lines().map_while(Result::ok);
    let address = lines.find_map(|line| {
        let rest = line.strip_prefix("Listening: http://");
        let address = rest
            .and_then(|rest| rest.split_once("/v1"))
            .map(|(address, _)| address.to_owned());
        words.push(line);
        address
    });
    let address = address.unwrap_or_else(|| panic!("{words:?}"));
    Started {
        child,
        words,
        address: address.parse().expect("an address"),
        rest: Box::new(lines),
    }
}

#[test]
fn http_alone_opens_no_other_port() {
    let folder = cell();
    let args = [&SERVE[..5], &["--as", "fanuc", "--http", "0"]].concat();
    let service = started(folder.path(), &args);
    let words = service.words.iter();
    let listening: Vec<_> = words.filter(|line| line.starts_with("Listening")).collect();
    assert_eq!(listening.len(), 1, "{listening:?}");
}

#[test]
fn a_trigger_over_http_inspects_the_simulated_part() {
    let folder = cell();
    let args = [&SERVE[..], &["--as", "fanuc", "--http", "0"]].concat();
    let Started {
        child,
        address,
        rest,
        ..
    } = started(folder.path(), &args);
    // The program keeps writing, so its output must be read.
    let reader = std::thread::spawn(move || rest.for_each(drop));
    let mut client = Client::connect(address);
    let answer = client.trigger().json();
    assert_eq!(
        (&answer["verdict"], &answer["part"]),
        (&json!("accepted"), &json!("fender")),
        "{answer}"
    );
    assert_eq!(
        (&answer["simulated"], &answer["sequence"]),
        (&json!(true), &json!(1))
    );
    let line = client.get("/v1/report").json()["report"].clone();
    assert_eq!(
        (&line["status"], &line["part"]),
        (&json!("ok"), &json!("fender")),
        "{line}"
    );
    // The same pose in both: millimetres in the answer, a matrix in metres in the line.
    let x = answer["pose"]["values"][0]["value"]
        .as_f64()
        .expect("a number");
    let metres = line["robot"]["robot_from_part"][3]
        .as_f64()
        .expect("a number");
    assert!((x - 1000.0 * metres).abs() < 1e-6, "{answer} {line}");
    drop(child);
    reader.join().expect("read");
}

#[test]
fn new_versions_of_the_library_are_taken_between_inspections() {
    let folder = cell();
    let ran = |args: &[&str]| {
        let ran = partsight(folder.path(), args).output().expect("ran");
        assert!(ran.status.success(), "{args:?} {ran:?}");
    };
    std::fs::create_dir(folder.path().join("store")).expect("made");
    ran(&["library", "keys", "keys"]);
    let publish = [
        "library",
        "publish",
        "--to",
        "store",
        "--key",
        "keys/library.key",
    ];
    ran(&publish);
    let trust = ["--trust", "keys/library.pub", "--library", "parts"];
    ran(&[&["library", "take", "--from", "store"][..], &trust].concat());
    let http = ["--as", "fanuc", "--http", "0"];
    let take = ["--take", "store", "--take-every", "1"];
    let args = [&SERVE[..5], &http, &take, &trust].concat();
    let Started {
        child,
        address,
        rest,
        ..
    } = started(folder.path(), &args);
    let reader = std::thread::spawn(move || rest.for_each(drop));
    let mut client = Client::connect(address);
    let reply = |client: &mut Client| {
        let answer = client.trigger().json();
        assert_eq!(answer["verdict"], "accepted", "{answer}");
        (answer["part"].clone(), answer["number"].clone())
    };
    assert_eq!(reply(&mut client), (json!("fender"), json!(3)));

    let library_until = |is_so: &dyn Fn(&Value) -> bool| {
        let until = Instant::now() + super::PATIENCE;
        loop {
            // A connection that is silent for long is closed.
            let library = Client::connect(address).get("/v1/status").json()["library"].clone();
            if is_so(&library) {
                return;
            }
            assert!(Instant::now() < until, "{library}");
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    library_until(&|library| library == &json!({ "version": 1, "problem": null }));
    ran(&["library", "rename", "fender", "--to", "wing"]);
    ran(&publish);
    library_until(&|library| library["version"] == 2);
    let mut client = Client::connect(address);
    assert_eq!(reply(&mut client), (json!("wing"), json!(3)));

    let third = folder.path().join("store/manifests/0000000003.txt");
    std::fs::write(third, "not signed").expect("written");
    library_until(&|library| library["problem"]["reason"] == "library_not_taken");
    let mut client = Client::connect(address);
    assert_eq!(reply(&mut client), (json!("wing"), json!(3)));
    let metrics = client.get("/v1/metrics").text;
    assert!(
        metrics.contains("\npartsight_library_version 2\n"),
        "{metrics}"
    );
    assert!(
        metrics.contains("\npartsight_library_take_failed 1\n"),
        "{metrics}"
    );
    drop(child);
    reader.join().expect("read");
}

#[test]
fn what_cannot_be_served_is_said_with_advice() {
    let folder = cell();
    std::fs::write(folder.path().join("tokens"), "short\n").expect("written");
    for (args, what, advice) in [
        (
            &["--as", "kuka", "--http", "0.0.0.0:0"][..],
            "open to the network",
            "--http-token-file",
        ),
        (&["--http", "0"], "no convention of its own", "--as"),
        (
            &["--as", "kuka", "--http", "0", "--http-token-file", "tokens"],
            "not a token",
            "openssl",
        ),
        (
            &["--as", "kuka", "--http", "door"],
            "neither a port nor an IP address",
            "1 to 65535",
        ),
        (
            &["--as", "kuka", "--http", "0", "--http-cert", "cell.toml"],
            "--http-key",
            "",
        ),
    ] {
        let args = [&SERVE[..], args].concat();
        let ran = partsight(folder.path(), &args).output().expect("ran");
        let reply = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(2), "{reply}");
        assert!(reply.contains(what) && reply.contains(advice), "{reply}");
    }
}
