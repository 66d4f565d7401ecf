//! The database is gone for a while, and robots go on triggering five inspections a second.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::postgres::{
    assert_same,
    program::{partsight, run},
    server::{PASSWORD, Postgres, wait_until},
    server_count,
};

/// From one trigger to the next.
const PERIOD: Duration = Duration::from_millis(200);

/// Folder of the history, in the test's own.
const HISTORY: &str = "here";

/// `partsight serve` with a simulated camera, killed when dropped.
struct Service {
    child: Child,
    robot: BufReader<TcpStream>,
    num_triggers: usize,
}

impl Service {
    fn start(folder: &Path, server: &Postgres) -> Self {
        fs::write(folder.join("password"), PASSWORD).expect("written");
        let matrix = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
        let calibrate = ["calibrate", "set", matrix, "--mount", "eye-to-hand"];
        run(
            folder,
            &[&calibrate[..], &["--out", "cell.toml"]].concat(),
            0,
        );
        let address = server.address();
        let source = ["serve", "--source", "simulated,fps=20:fender"];
        let cell = ["--as", "kuka", "--calibration", "cell.toml"];
        let listen = ["--listen", "ascii=0", "--history", HISTORY];
        let to = ["--history-to", &address, "--cell", "cell7"];
        let password = ["--database-password-file", "password"];
        let args = [&source[..], &cell, &listen, &to, &password].concat();
        let child = partsight(folder, &args)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = child.expect("starts");
        let mut messages = BufReader::new(child.stderr.take().expect("a pipe")).lines();
        let begin = "Listening: ascii=";
        let robot = messages.find_map(|line| {
            let line = line.expect("text");
            let (address, _) = line.strip_prefix(begin)?.split_once(',')?;
            Some(TcpStream::connect(address).expect("connected"))
        });
        // The service goes on writing.
        thread::spawn(move || messages.for_each(drop));
        Self {
            child,
            robot: BufReader::new(robot.expect("an address")),
            num_triggers: 0,
        }
    }

    /// Triggers for this long, at least once, and returns how long each answer took.
    fn trigger_for(&mut self, at_least: Duration) -> Vec<Duration> {
        let mut waited = Vec::new();
        let mut next = Instant::now();
        let until = next + at_least;
        while waited.is_empty() || next < until {
            thread::sleep(next.saturating_duration_since(Instant::now()));
            next += PERIOD;
            let asked = Instant::now();
            self.robot.get_mut().write_all(b"TRIGGER\n").expect("sent");
            let mut line = String::new();
            self.robot.read_line(&mut line).expect("a line");
            waited.push(asked.elapsed());
            self.num_triggers += 1;
            let expected = format!("TRIGGER;accepted;{};", self.num_triggers);
            assert!(line.starts_with(&expected), "{line}");
        }
        waited
    }

    /// Ends it as Ctrl-C does.
    fn interrupt(&mut self) {
        let sent = Command::new("kill")
            .args(["-INT", &self.child.id().to_string()])
            .status();
        assert!(sent.expect("kill is there").success());
        assert!(self.child.wait().expect("ended").success());
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Answers a robot before, during and after an outage, each for this long. Checks that the database has every inspection
/// once, and returns how long the answers took; `None` without PostgreSQL.
fn outage(at_least: Duration) -> Option<[(&'static str, Vec<Duration>); 3]> {
    let mut server = Postgres::start_new()?;
    let folder = tempfile::tempdir().expect("a folder");
    let mut service = Service::start(folder.path(), &server);
    service.trigger_for(Duration::ZERO);
    // Otherwise the sender might not have connected before the outage.
    wait_until("the first is there", || server_count(&server) == "1");
    let waited = ["before", "during", "after"].map(|when| {
        match when {
            "during" => server.kill(),
            "after" => server.start(),
            _ => {}
        }
        (when, service.trigger_for(at_least))
    });
    let num = service.num_triggers;
    wait_until("all are there", || server_count(&server) == num.to_string());
    service.interrupt();
    let history = folder.path().join(HISTORY);
    assert_eq!(assert_same(&server, &history, "cell7"), num);
    Some(waited)
}

#[test]
fn while_the_database_is_gone_every_trigger_is_answered_and_arrives_there_once() {
    outage(Duration::from_secs(4));
}

/// The same for a minute. Prints how long triggers took.
#[test]
#[ignore = "takes four minutes; a measurement, run with --ignored --nocapture"]
fn a_minute_without_the_database() {
    for (when, mut waited) in outage(Duration::from_mins(1)).into_iter().flatten() {
        waited.sort();
        let [median, p99] = [50, 99].map(|share| waited[(waited.len() - 1) * share / 100]);
        let num = waited.len();
        println!("{when}: {num} triggers, median {median:.1?}, 99 % {p99:.1?}");
    }
}
