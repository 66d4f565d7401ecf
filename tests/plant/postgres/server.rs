//! A PostgreSQL server that the tests start.

use std::{
    env, fs,
    net::{Ipv4Addr, TcpListener},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};

use partsight::plant::database::{Database, DatabaseAccess, DatabaseAddress, DatabaseError};

/// Timeout with room for a busy machine and for the longest pause between two attempts to connect.
const PATIENCE: Duration = Duration::from_mins(2);

/// The password of the user `cell`.
pub(crate) const PASSWORD: &str = "as written";
/// Password of the server's owner.
const OWNER_PASSWORD: &str = "of the owner";

pub(crate) fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < until, "it took too long: {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// A server that asks for passwords and offers encryption, with the database `plant` of the user `cell`.
pub(crate) struct Postgres {
    folder: tempfile::TempDir,
    programs: PathBuf,
    port: u16,
    child: Option<Child>,
}

/// The folder of Debian's newest PostgreSQL.
fn programs() -> Option<PathBuf> {
    let versions = fs::read_dir("/usr/lib/postgresql").ok()?;
    let versions = versions.filter_map(|version| Some(version.ok()?.path().join("bin")));
    let mut versions: Vec<PathBuf> = versions
        .filter(|programs| programs.join("initdb").is_file())
        .collect();
    versions.sort();
    versions.pop()
}

fn is_root() -> bool {
    let asked = Command::new("id").arg("-u").output();
    asked.is_ok_and(|output| output.stdout == b"0\n")
}

/// A command of the server, run as another user if this one is root, which the server refuses.
fn as_somebody(program: &Path) -> Command {
    if !is_root() {
        return Command::new(program);
    }
    let mut command = Command::new("setpriv");
    command
        .args(["--reuid=nobody", "--regid=nogroup", "--clear-groups"])
        .arg(program);
    command
}

fn done(command: &mut Command) -> Output {
    let output = command.output().expect("started");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {words}");
    output
}

impl Postgres {
    /// Starts a server; `None`, with a message, if PostgreSQL is not installed.
    pub(crate) fn start_new() -> Option<Self> {
        let Some(programs) = programs() else {
            let lacking = "PostgreSQL is not installed (apt-get install postgresql)";
            geometry::fixtures::skipped("PARTSIGHT_REQUIRE_POSTGRES", lacking);
            return None;
        };
        let folder = tempfile::tempdir().expect("a folder");
        let socket = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
        let port = socket.local_addr().expect("its address").port();
        drop(socket);
        let mut server = Self {
            folder,
            programs,
            port,
            child: None,
        };
        server.make();
        server.start();
        server.sql_in(
            "postgres",
            &format!("CREATE ROLE cell LOGIN PASSWORD '{PASSWORD}'"),
        );
        server.sql_in("postgres", "CREATE DATABASE plant OWNER cell");
        Some(server)
    }

    /// A file of the server's folder, or beside it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn make(&self) {
        let plant = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/plant/http");
        fs::write(self.path("owner"), OWNER_PASSWORD).expect("written");
        for name in ["localhost.cert.pem", "localhost.key.pem"] {
            fs::copy(plant.join(name), self.path(name)).expect("copied");
        }
        done(
            Command::new("chmod")
                .arg("600")
                .arg(self.path("localhost.key.pem")),
        );
        if is_root() {
            done(
                Command::new("chown")
                    .args(["-R", "nobody"])
                    .arg(self.folder.path()),
            );
        }
        done(
            as_somebody(&self.programs.join("initdb"))
                .args([
                    "--username=postgres",
                    "--auth=scram-sha-256",
                    "--encoding=UTF8",
                ])
                .args(["--locale=C", "--no-sync"])
                .arg(format!("--pwfile={}", self.path("owner").display()))
                .arg(format!("--pgdata={}", self.path("data").display()))
                .current_dir(self.folder.path()),
        );
    }

    fn spawn(&self) -> Child {
        let set = |name: &str, value: &Path| format!("{name}={}", value.display());
        let log = fs::File::options()
            .create(true)
            .append(true)
            .open(self.path("log"))
            .expect("a log");
        as_somebody(&self.programs.join("postgres"))
            .arg("-D")
            .arg(self.path("data"))
            .args(["-p", &self.port.to_string()])
            .args(["-c", "listen_addresses=127.0.0.1", "-c", "ssl=on"])
            // Written data survive a killed process even without fsync.
            .args(["-c", "fsync=off"])
            .args(["-c", &set("unix_socket_directories", self.folder.path())])
            .args([
                "-c",
                &set("ssl_cert_file", &self.path("localhost.cert.pem")),
            ])
            .args(["-c", &set("ssl_key_file", &self.path("localhost.key.pem"))])
            .current_dir(self.folder.path())
            .stdout(Stdio::null())
            .stderr(log)
            .spawn()
            .expect("started")
    }

    /// Starts it, and waits until it answers. Retries, because processes of a killed server may block the start for a
    /// moment.
    pub(crate) fn start(&mut self) {
        let until = Instant::now() + PATIENCE;
        let mut child = self.spawn();
        while !self.psql("postgres", "SELECT 1").status.success() {
            let log = fs::read_to_string(self.path("log")).unwrap_or_default();
            assert!(Instant::now() < until, "it does not start: {log}");
            if child.try_wait().expect("asked").is_some() {
                child = self.spawn();
            }
            thread::sleep(Duration::from_millis(50));
        }
        self.child = Some(child);
    }

    /// Kills it, like a loss of power.
    pub(crate) fn kill(&mut self) {
        if let Some(mut child) = self.child.take() {
            child.kill().expect("killed");
            child.wait().expect("ended");
        }
    }

    fn psql(&self, database: &str, sql: &str) -> Output {
        Command::new(self.programs.join("psql"))
            .args(["-X", "-A", "-t", "-q", "-v", "ON_ERROR_STOP=1"])
            .args(["-h", "127.0.0.1", "-p", &self.port.to_string()])
            .args(["-U", "postgres", "-d", database, "-c", sql])
            .env("PGPASSWORD", OWNER_PASSWORD)
            .env("PGCLIENTENCODING", "UTF8")
            .output()
            .expect("started")
    }

    fn sql_in(&self, database: &str, sql: &str) -> Vec<String> {
        let output = self.psql(database, sql);
        let words = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{sql}: {words}");
        let text = String::from_utf8(output.stdout).expect("text");
        text.lines().map(str::to_owned).collect()
    }

    /// Runs a query as the owner, and returns the lines of the answer.
    pub(crate) fn sql(&self, sql: &str) -> Vec<String> {
        self.sql_in("plant", sql)
    }

    /// Address of the database `plant`, without encryption.
    pub(crate) fn address(&self) -> String {
        self.address_of("plant")
    }

    pub(crate) fn address_of(&self, database: &str) -> String {
        format!("postgres://cell@127.0.0.1:{}/{database}", self.port)
    }

    /// Access data for this address and password.
    pub(crate) fn access_to(&self, address: &str, password: &str) -> DatabaseAccess {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("password");
        fs::write(&file, password).expect("written");
        let address: DatabaseAddress = address.parse().expect("an address");
        let certificate = self.path("localhost.cert.pem");
        let certificate = address.is_encrypted.then_some(certificate.as_path());
        DatabaseAccess::new(address, Some(&file), certificate).expect("usable")
    }

    pub(crate) fn access(&self) -> DatabaseAccess {
        self.access_to(&self.address(), PASSWORD)
    }

    pub(crate) fn open(&self) -> Result<Database, DatabaseError> {
        Database::open(&self.access())
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        self.kill();
    }
}
