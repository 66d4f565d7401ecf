//! A client that sends requests and waits for complete answers.

use std::{
    io::{self, Read as _, Write as _},
    net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// Longer than any answer takes.
const PATIENCE: Duration = Duration::from_mins(1);

/// How the end of an answer is recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Framing {
    /// A line end.
    Line,
    /// A fixed number of bytes.
    Bytes(usize),
    /// The length in its header.
    Http,
}

impl Framing {
    /// Returns whether these bytes are a complete answer.
    fn is_whole(self, answer: &[u8]) -> bool {
        match self {
            Self::Line => answer.ends_with(b"\n"),
            Self::Bytes(num) => answer.len() >= num,
            Self::Http => http_length(answer).is_some_and(|length| answer.len() >= length),
        }
    }

    /// Returns whether a complete answer is a success. Protocols other than HTTP close the connection on failure.
    fn is_success(self, answer: &[u8]) -> bool {
        match self {
            Self::Line | Self::Bytes(_) => !answer.is_empty(),
            Self::Http => answer.starts_with(b"HTTP/1.1 200 "),
        }
    }
}

/// Returns the number of bytes of an HTTP answer, once its header is complete.
fn http_length(answer: &[u8]) -> Option<usize> {
    let end = b"\r\n\r\n";
    let head = answer.windows(end.len()).position(|bytes| bytes == end)?;
    let text = String::from_utf8_lossy(&answer[..head]);
    let mut lengths = text.lines().filter_map(|line| {
        let (name, value) = line.split_once(':')?;
        let is_length = name.eq_ignore_ascii_case("content-length");
        is_length.then(|| value.trim().parse::<usize>().ok())?
    });
    Some(head + end.len() + lengths.next().unwrap_or(0))
}

/// A connection for one request after the other.
pub(super) struct Client {
    stream: TcpStream,
    framing: Framing,
    answer: Vec<u8>,
    /// The thread that answers, if there is no server.
    peer: Option<JoinHandle<()>>,
}

impl Client {
    /// Connects to a server.
    pub(super) fn connect(address: SocketAddr, framing: Framing) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        Ok(Self {
            stream,
            framing,
            answer: Vec::new(),
            peer: None,
        })
    }

    /// Connects to a thread that only reads and writes these numbers of bytes.
    pub(super) fn connect_bare(request_bytes: usize, answer_bytes: usize) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let mut client = Self::connect(listener.local_addr()?, Framing::Bytes(answer_bytes))?;
        let (mut stream, _) = listener.accept()?;
        stream.set_nodelay(true)?;
        let peer = thread::Builder::new().name("bare".into()).spawn(move || {
            let mut request = vec![0; request_bytes];
            let answer = vec![0; answer_bytes];
            while stream.read_exact(&mut request).is_ok() && stream.write_all(&answer).is_ok() {}
        })?;
        client.peer = Some(peer);
        Ok(client)
    }

    /// Sends a request and waits for the complete answer. Returns its number of bytes.
    pub(super) fn ask(&mut self, request: &[u8]) -> io::Result<usize> {
        self.stream.write_all(request)?;
        self.answer.clear();
        let mut chunk = [0; 4096];
        while !self.framing.is_whole(&self.answer) {
            match self.stream.read(&mut chunk)? {
                0 => return Err(io::ErrorKind::UnexpectedEof.into()),
                num => self.answer.extend(&chunk[..num]),
            }
        }
        if !self.framing.is_success(&self.answer) {
            let answer = String::from_utf8_lossy(&self.answer);
            return Err(io::Error::other(format!("it answered {answer}")));
        }
        Ok(self.answer.len())
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // The peer may have closed the connection already.
        let _ = self.stream.shutdown(Shutdown::Both);
        if let Some(peer) = self.peer.take() {
            let _ = peer.join();
        }
    }
}

/// Returns the number of answers per second over several connections at once, each sending `num_each` requests after a
/// first uncounted one.
pub(super) fn busy_rate(
    connect: impl Fn() -> io::Result<Client>,
    num_connections: usize,
    request: &[u8],
    num_each: usize,
) -> io::Result<f64> {
    let mut clients = Vec::with_capacity(num_connections);
    for _ in 0..num_connections {
        let mut client = connect()?;
        client.ask(request)?;
        clients.push(client);
    }
    let ask_all = |client: &mut Client| -> io::Result<()> {
        for _ in 0..num_each {
            client.ask(request)?;
        }
        Ok(())
    };
    let begun = Instant::now();
    thread::scope(|scope| {
        let threads = clients.iter_mut();
        let threads = threads.map(|client| scope.spawn(move || ask_all(client)));
        let threads: Vec<_> = threads.collect();
        let ended = threads.into_iter().map(|thread| {
            let joined = thread.join();
            joined.unwrap_or_else(|_| Err(io::Error::other("a client failed")))
        });
        ended.collect::<io::Result<()>>()
    })?;
    Ok((num_connections * num_each) as f64 / begun.elapsed().as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_exchange_answers_with_as_many_bytes_as_it_was_told() {
        let mut client = Client::connect_bare(20, 9_000).expect("connected");
        for _ in 0..3 {
            assert_eq!(client.ask(&[7; 20]).expect("answered"), 9_000);
        }
        let connect = || Client::connect_bare(7, 1);
        let rate = busy_rate(connect, 3, b"STATUS\n", 4).expect("answered");
        assert!(rate.is_finite() && rate > 0.0);
    }

    #[test]
    fn an_answer_over_http_ends_where_its_head_says() {
        let head = "HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\n";
        let is_whole = |text: &str| Framing::Http.is_whole(text.as_bytes());
        for (text, whole) in [
            (String::new(), false),
            (head[..20].to_owned(), false),
            (format!("{head}\"no\""), false),
            (format!("{head}\"yes\""), true),
        ] {
            assert_eq!(is_whole(&text), whole, "{text}");
        }
        let is_success = |text: &str| Framing::Http.is_success(text.as_bytes());
        assert!(is_success(head));
        assert!(!is_success(&head.replace("200 OK", "503 No")));
    }
}
