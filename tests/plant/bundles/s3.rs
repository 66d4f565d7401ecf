//! S3 servers that the tests start.

use std::{
    collections::BTreeMap,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream},
    process::{Child, Command, Stdio},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

/// Timeout with room for a busy machine.
const PATIENCE: Duration = Duration::from_mins(2);

fn free_address() -> SocketAddr {
    let socket = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    socket.local_addr().expect("its address")
}

/// An address at which no server listens.
pub(crate) fn closed_endpoint() -> String {
    format!("http://{}", free_address())
}

/// A moto server with an empty bucket `parts`; killed when dropped.
pub(crate) struct S3Server {
    child: Child,
    address: SocketAddr,
}

impl S3Server {
    /// Starts a server; `None`, with a message, if moto is not installed.
    pub(crate) fn start() -> Option<Self> {
        let address = free_address();
        let started = Command::new("moto_server")
            .args(["-H", "127.0.0.1", "-p", &address.port().to_string()])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        let Ok(child) = started else {
            geometry::fixtures::skipped(
                "PARTSIGHT_REQUIRE_S3",
                "moto is not installed (pip install \"moto[server]\")",
            );
            return None;
        };
        let server = Self { child, address };
        let until = Instant::now() + PATIENCE;
        while TcpStream::connect(address).is_err() {
            assert!(Instant::now() < until, "moto does not listen");
            thread::sleep(Duration::from_millis(20));
        }
        server.make_bucket();
        Some(server)
    }

    pub(crate) fn endpoint(&self) -> String {
        format!("http://{}", self.address)
    }

    fn make_bucket(&self) {
        let mut stream = TcpStream::connect(self.address).expect("connected");
        let host = self.address;
        let request = format!(
            "PUT /parts HTTP/1.1\r\nHost: {host}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
        );
        stream.write_all(request.as_bytes()).expect("sent");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("answered");
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }
}

impl Drop for S3Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What is wrong with a [`FaultyServer`].
#[derive(Clone, Copy)]
pub(crate) enum Fault {
    /// It writes over what is there, like stores that do not know `If-None-Match`.
    WritesOver,
    /// It keeps a manifest, and closes the connection instead of answering.
    LosesAnswers,
    /// It answers every request with this status and this code of S3.
    Refuses(&'static str, &'static str),
}

/// Names and contents of a store's objects.
type Objects = BTreeMap<String, Vec<u8>>;

/// A server with a bucket that never lists anything.
pub(crate) struct FaultyServer {
    address: SocketAddr,
    objects: Arc<Mutex<Objects>>,
}

impl FaultyServer {
    /// Starts the server; its thread ends with the test program.
    pub(crate) fn start(fault: Fault) -> Self {
        let socket = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
        let address = socket.local_addr().expect("its address");
        let objects = Arc::new(Mutex::new(Objects::new()));
        let theirs = Arc::clone(&objects);
        thread::spawn(move || {
            for stream in socket.incoming() {
                answer(stream.expect("a connection"), fault, &theirs);
            }
        });
        Self { address, objects }
    }

    pub(crate) fn endpoint(&self) -> String {
        format!("http://{}", self.address)
    }

    /// The names of all objects that were written.
    pub(crate) fn written(&self) -> Vec<String> {
        let objects = self.objects.lock().expect("no panic");
        objects.keys().cloned().collect()
    }
}

/// Answers one request and closes the connection.
fn answer(stream: TcpStream, fault: Fault, objects: &Mutex<Objects>) {
    const NOTHING: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?><ListBucketResult><Name>parts</Name>\
                           <KeyCount>0</KeyCount><IsTruncated>false</IsTruncated></ListBucketResult>";
    let mut reader = BufReader::new(stream);
    let mut request = String::new();
    let mut length = 0;
    let mut is_new = false;
    loop {
        let mut line = String::new();
        if reader.read_line(&mut line).unwrap_or(0) == 0 {
            return;
        }
        let header = line.trim_end().to_lowercase();
        if let Some(value) = header.strip_prefix("content-length:") {
            length = value.trim().parse().expect("a number");
        }
        is_new |= header.starts_with("if-none-match:");
        if request.is_empty() {
            request = line;
        } else if header.is_empty() {
            break;
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).expect("the body");
    let mut words = request.split(' ');
    let (method, path) = (words.next(), words.next().expect("a path"));
    let mut objects = objects.lock().expect("no panic");
    let (status, content) = match (fault, method) {
        (Fault::Refuses(status, code), _) => {
            let text = format!("<?xml version=\"1.0\"?><Error><Code>{code}</Code></Error>");
            (status, text.into_bytes())
        }
        (Fault::LosesAnswers, Some("PUT")) if is_new && objects.contains_key(path) => {
            ("412 Precondition Failed", Vec::new())
        }
        (_, Some("PUT")) => {
            objects.insert(path.to_owned(), body);
            if matches!(fault, Fault::LosesAnswers) && path.contains("manifests") {
                return;
            }
            ("200 OK", Vec::new())
        }
        _ if path.contains("list-type") => ("200 OK", NOTHING.into()),
        _ => match objects.get(path) {
            Some(content) => ("200 OK", content.clone()),
            None => ("404 Not Found", Vec::new()),
        },
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nETag: \"1\"\r\nLast-Modified: Fri, 20 Nov 2026 10:00:00 GMT\r\n\
         Content-Length: {}\r\nConnection: close\r\n\r\n",
        content.len()
    );
    let mut stream = reader.into_inner();
    let sent = stream.write_all(&[head.as_bytes(), &content].concat());
    sent.expect("sent");
}
