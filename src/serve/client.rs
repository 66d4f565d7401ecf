//! One client: reads its requests one after the other and answers each.

use std::{
    io::{self, Read as _, Write as _},
    net::{Shutdown, SocketAddr, TcpStream},
    sync::{Arc, mpsc::SyncSender},
    time::{Duration, Instant},
};

use super::{
    answer::{Answer, Trouble, VerdictCode},
    listen::Listener,
    protocol::bad_request::BadRequest,
    server::{ClientNews, Job, LINGER, Shared, WRITE_TIMEOUT, answer_to},
};

/// How often a client that is silent is looked after.
const TURN: Duration = Duration::from_millis(100);
/// Bytes read at once. No protocol keeps more than a request of its own, so this and that is all the memory a client has.
const CHUNK: usize = 512;

/// A connection and what it needs to be answered.
pub(super) struct Client {
    pub(super) stream: TcpStream,
    pub(super) peer: SocketAddr,
    pub(super) listener: Listener,
    pub(super) shared: Arc<Shared>,
    pub(super) jobs: SyncSender<Job>,
}

/// Why a connection is closed.
enum EndReason {
    /// The client hung up, was silent for too long, or the service ends.
    Silent,
    /// The client is told what was wrong.
    Told(BadRequest),
}

impl Client {
    /// Until one of the two ends the connection.
    pub(super) fn serve(mut self) {
        let protocol = self.listener.at.protocol.name();
        self.shared.tell(self.peer, protocol, ClientNews::Connected);
        let news = match self.talk() {
            Ok(EndReason::Told(why)) => {
                // Who hung up need not be told.
                let _ = self.refuse(&why);
                ClientNews::BadRequest(why)
            }
            // A connection that breaks is one that ends.
            Ok(EndReason::Silent) | Err(_) => ClientNews::Left,
        };
        self.shared.tell(self.peer, protocol, news);
    }

    fn talk(&mut self) -> io::Result<EndReason> {
        self.stream.set_nonblocking(false)?;
        self.stream.set_nodelay(true)?;
        self.stream.set_read_timeout(Some(TURN))?;
        self.stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        let settings = self.shared.settings;
        let mut bytes: Vec<u8> = Vec::new();
        let mut chunk = [0; CHUNK];
        let mut last_answer = Instant::now();
        // When the request began whose end has not come yet.
        let mut begun: Option<Instant> = None;
        while !self.shared.is_stopping() {
            let parsed = self.listener.at.protocol.parse(&bytes);
            if parsed.used > 0 {
                bytes.drain(..parsed.used);
                begun = (!bytes.is_empty()).then(Instant::now);
            }
            match parsed.request {
                Some(Ok(request)) => {
                    let answer = answer_to(request, &self.shared, &self.jobs);
                    self.send(&answer)?;
                    last_answer = Instant::now();
                    continue;
                }
                Some(Err(why)) => return Ok(EndReason::Told(why)),
                None => {}
            }
            if begun.is_some_and(|begun| begun.elapsed() > settings.request_timeout) {
                let seconds = settings.request_timeout.as_secs();
                return Ok(EndReason::Told(BadRequest::Incomplete { seconds }));
            }
            if begun.is_none() && last_answer.elapsed() > settings.idle_timeout {
                return Ok(EndReason::Silent);
            }
            match self.stream.read(&mut chunk) {
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

    fn send(&mut self, answer: &Answer) -> io::Result<()> {
        let protocol = self.listener.at.protocol;
        let bytes = protocol.write(answer, self.listener.convention);
        self.stream.write_all(&bytes)
    }

    /// Tells the client what was wrong, and closes the connection. What it still sends is read over for a moment: closed
    /// with unread bytes, a connection is reset, and the client may not get to read the answer.
    fn refuse(&mut self, why: &BadRequest) -> io::Result<()> {
        let trouble = Trouble::of(why.reason(), why);
        let at = self.shared.situation();
        self.send(&Answer::turned_away(VerdictCode::BadRequest, trouble, &at))?;
        self.stream.shutdown(Shutdown::Write)?;
        let since = Instant::now();
        let mut chunk = [0; CHUNK];
        while since.elapsed() < LINGER && !self.shared.is_stopping() {
            match self.stream.read(&mut chunk) {
                Ok(0) => break,
                Ok(_) => {}
                Err(error) if is_passing(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// True of an error that says that nothing came yet.
fn is_passing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
    )
}
