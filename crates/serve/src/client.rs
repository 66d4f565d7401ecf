//! One client connection: reads its requests one after the other and answers each.

use std::{
    io::{self, Read as _, Write as _},
    net::{Shutdown, SocketAddr, TcpStream},
    sync::{Arc, mpsc::SyncSender},
    time::{Duration, Instant},
};

use super::{
    answer::{Answer, Problem, VerdictCode},
    listen::Listener,
    protocol::bad_request::BadRequest,
    server::{ClientMemory, ClientNews, Job, LINGER_TIME, Shared, WRITE_TIMEOUT, answer_to},
};

/// Read timeout, after which a silent client's time limits are checked.
const READ_TIMEOUT: Duration = Duration::from_millis(100);
/// Bytes per read. A parser keeps at most one incomplete request, so this plus one request bounds a client's memory.
const CHUNK_BYTES: usize = 512;
/// Most bytes of a refused client that are read and discarded.
const MAX_DISCARDED_BYTES: usize = 1 << 20;

/// A connection and what is needed to answer it.
pub(super) struct Client {
    pub(super) stream: Arc<TcpStream>,
    pub(super) peer: SocketAddr,
    pub(super) listener: Listener,
    pub(super) shared: Arc<Shared>,
    pub(super) jobs: SyncSender<Job>,
}

/// Why a connection is closed.
enum EndReason {
    /// The client hung up or was idle for too long, or the server stops.
    Silent,
    /// The request was bad; the answer gives the reason.
    Answered(BadRequest),
}

impl Client {
    /// Serves requests until either side ends the connection.
    pub(super) fn serve(self) {
        let protocol = self.listener.at.protocol.name();
        self.shared.tell(self.peer, protocol, ClientNews::Connected);
        let news = match self.talk() {
            Ok(EndReason::Answered(why)) => {
                // If the client has hung up, it needs no answer.
                let _ = self.refuse(&why);
                ClientNews::BadRequest(why)
            }
            // A broken connection counts as ended.
            Ok(EndReason::Silent) | Err(_) => ClientNews::Left,
        };
        self.shared.forget_silent(&self.stream);
        self.shared.tell(self.peer, protocol, news);
    }

    fn talk(&self) -> io::Result<EndReason> {
        self.stream.set_nonblocking(false)?;
        self.stream.set_nodelay(true)?;
        self.stream.set_read_timeout(Some(READ_TIMEOUT))?;
        self.stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        let settings = self.shared.settings;
        let mut bytes: Vec<u8> = Vec::new();
        let mut chunk = [0; CHUNK_BYTES];
        let mut last_answer = Instant::now();
        // When the pending incomplete request began.
        let mut begun: Option<Instant> = None;
        let mut is_silent = true;
        let mut memory = ClientMemory::new(&self.shared);
        while !self.shared.is_stopping() {
            let Listener { at, convention } = self.listener;
            let parsed = at.protocol.parse(&bytes, convention);
            if parsed.used > 0 {
                bytes.drain(..parsed.used);
                begun = (!bytes.is_empty()).then(Instant::now);
            }
            match parsed.request {
                Some(Ok(request)) => {
                    if is_silent {
                        self.shared.forget_silent(&self.stream);
                        is_silent = false;
                    }
                    let stream = Arc::clone(&self.stream);
                    let is_withdrawn = move || is_closed(&stream);
                    let (shared, jobs) = (&self.shared, &self.jobs);
                    let answer = answer_to(request, shared, jobs, &mut memory, is_withdrawn);
                    self.send(&answer)?;
                    last_answer = Instant::now();
                    continue;
                }
                Some(Err(why)) => return Ok(EndReason::Answered(why)),
                None => {}
            }
            if begun.is_some_and(|begun| begun.elapsed() > settings.request_timeout) {
                let seconds = settings.request_timeout.as_secs();
                return Ok(EndReason::Answered(BadRequest::Incomplete { seconds }));
            }
            if begun.is_none() && last_answer.elapsed() > settings.idle_timeout {
                return Ok(EndReason::Silent);
            }
            match (&*self.stream).read(&mut chunk) {
                Ok(0) => return Ok(EndReason::Silent),
                Ok(num) => {
                    begun.get_or_insert_with(Instant::now);
                    bytes.extend(&chunk[..num]);
                }
                Err(error) if is_passing(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(EndReason::Silent)
    }

    fn send(&self, answer: &Answer) -> io::Result<()> {
        let protocol = self.listener.at.protocol;
        let bytes = protocol.write(answer, self.listener.convention);
        (&*self.stream).write_all(&bytes)
    }

    /// Sends the reason and closes the connection. Reads and discards what the client still sends for a moment: closing a
    /// socket with unread bytes resets the connection, and the client might lose the answer.
    fn refuse(&self, why: &BadRequest) -> io::Result<()> {
        let problem = Problem::of(why.reason(), why);
        let at = self.shared.situation();
        self.send(&Answer::turned_away(VerdictCode::BadRequest, problem, &at))?;
        self.stream.shutdown(Shutdown::Write)?;
        let since = Instant::now();
        let mut chunk = [0; CHUNK_BYTES];
        let mut num_discarded = 0;
        while since.elapsed() < LINGER_TIME
            && num_discarded < MAX_DISCARDED_BYTES
            && !self.shared.is_stopping()
        {
            match (&*self.stream).read(&mut chunk) {
                Ok(0) => break,
                Ok(num) => num_discarded += num,
                Err(error) if is_passing(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// True if the other side has closed its connection and all that it sent was read. Must not be called while another thread
/// reads or writes: it makes the socket non-blocking for a moment.
fn is_closed(stream: &TcpStream) -> bool {
    let peeked = stream
        .set_nonblocking(true)
        .and_then(|()| stream.peek(&mut [0]));
    let is_closed = match peeked {
        Ok(num) => num == 0,
        Err(error) => !is_passing(&error),
    };
    // Also if it is closed: a client that has only ended its side can still read why it gets no pose.
    stream.set_nonblocking(false).is_err() || is_closed
}

/// True if the error only means that nothing has arrived yet.
fn is_passing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
    )
}
