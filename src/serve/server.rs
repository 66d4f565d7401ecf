//! The server: listeners, clients, and the one inspection at a time.

use std::{
    collections::VecDeque,
    fmt,
    io::{self, Write as _},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc::{self, Receiver, SyncSender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use jiff::Timestamp;
use thiserror::Error;

use super::{
    answer::{
        Answer, CameraStatus, Found, Inspected, MAX_COUNT, Request, Situation, Trouble,
        VerdictCode, judged,
    },
    camera::NoFrame,
    client::Client,
    handle::ServerHandle,
    listen::{ListenAddress, Listener},
    protocol::bad_request::BadRequest,
    record::InspectionRecord,
    tally::Tally,
};
use crate::{
    error::{Advice, guarded, lock},
    files::words_of,
};

/// How often the thread that inspects looks up.
const TURN: Duration = Duration::from_millis(100);
/// How often a listener looks whether somebody connects: std's accept cannot be interrupted.
const ACCEPT_TURN: Duration = Duration::from_millis(10);
/// A connection that was turned away stays open for so long, so that its client can read why.
pub(super) const LINGER: Duration = Duration::from_secs(1);
/// At most so many of them.
const MAX_TURNED_AWAY: usize = 64;
/// A client that does not take its answer for so long is let go.
pub(super) const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// The answer to a client that is turned away fits into an empty buffer.
const TURN_AWAY_TIMEOUT: Duration = Duration::from_millis(100);

/// A trigger came then.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// By the clock that only runs forwards.
    pub at: Instant,
    /// By the clock of files.
    pub by_clock: Timestamp,
}

impl Asked {
    /// Now.
    pub fn now() -> Self {
        Self {
            at: Instant::now(),
            by_clock: Timestamp::now(),
        }
    }
}

/// What takes frames and inspects them; lives on the thread of [`Server::run`].
pub trait Inspector {
    /// Takes a frame that was captured after the trigger, and inspects it.
    fn inspect(&mut self, asked: &Asked) -> Found;

    /// The last inspection with its number, for others than the client that asked. Called right after its answer was sent;
    /// has to return soon.
    fn recorded(&mut self, _record: InspectionRecord) {}

    /// The answer to the last inspection is on its way: time for what nobody waits for.
    fn answered(&mut self);

    /// Called before every inspection and about ten times a second in between; `Break` ends the service.
    fn turn(&mut self) -> ControlFlow<()>;
}

/// Limits of a server.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServerSettings {
    /// An accepted pose from an older frame is stale.
    pub max_age: Duration,
    /// Connections at a time, of all listeners together, at least 1.
    pub max_clients: usize,
    /// A client that asks for nothing for so long is let go.
    pub idle_timeout: Duration,
    /// A request that has begun has to be complete within this time.
    pub request_timeout: Duration,
}

impl Default for ServerSettings {
    fn default() -> Self {
        Self {
            max_age: Duration::from_secs(30),
            max_clients: 16,
            idle_timeout: Duration::from_mins(10),
            request_timeout: Duration::from_secs(5),
        }
    }
}

/// Something about a client, for the person at the screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClientEvent {
    /// Whose connection.
    pub peer: SocketAddr,
    /// The name of its protocol.
    pub protocol: &'static str,
    /// What.
    pub news: ClientNews,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClientNews {
    /// It connected.
    Connected,
    /// Its connection is over.
    Left,
    /// As many as are allowed were connected already.
    TurnedAway,
    /// It sent this, was told so and let go.
    BadRequest(BadRequest),
    /// It sent no token or a wrong one, and was told so.
    WrongToken,
}

/// Why a server cannot start.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The system does not let it listen there.
    #[error("cannot listen at {at}: {}", words_of_bind(source))]
    Bind {
        /// Where, as it was given.
        at: String,
        /// The option that gives it.
        option: &'static str,
        /// What the system says.
        source: io::Error,
    },
    /// The system gives no thread for a listener.
    #[error("the listener's thread cannot be started: {source}")]
    NoThread {
        /// What the system says.
        source: io::Error,
    },
}

fn words_of_bind(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => "another program listens at this port".into(),
        io::ErrorKind::AddrNotAvailable => "this computer does not have this address".into(),
        io::ErrorKind::PermissionDenied => "this port is kept for the system".into(),
        _ => words_of(error),
    }
}

impl Advice for ServeError {
    fn advice(&self) -> String {
        match self {
            Self::Bind { source, option, .. } => match source.kind() {
                io::ErrorKind::AddrInUse => {
                    format!("End the other program, or choose another port with {option}")
                }
                io::ErrorKind::AddrNotAvailable => {
                    "Give the address of a network card of this computer, or the port alone".into()
                }
                io::ErrorKind::PermissionDenied => "Choose a port from 1024 up".into(),
                _ => format!("Choose another address with {option}"),
            },
            Self::NoThread { .. } => "Close other programs and start again".into(),
        }
    }
}

/// What all threads of a server share.
pub(super) struct Shared {
    pub(super) settings: ServerSettings,
    pub(super) boot: u32,
    is_stopping: AtomicBool,
    num_clients: AtomicUsize,
    last: Mutex<Arc<Inspected>>,
    pub(super) tally: Mutex<Tally>,
    camera: Box<dyn Fn() -> CameraStatus + Send + Sync>,
    on_event: Box<dyn Fn(ClientEvent) + Send + Sync>,
}

impl Shared {
    pub(super) fn is_stopping(&self) -> bool {
        self.is_stopping.load(Ordering::SeqCst)
    }

    pub(super) fn num_clients(&self) -> usize {
        self.num_clients.load(Ordering::SeqCst)
    }

    pub(super) fn last(&self) -> Arc<Inspected> {
        Arc::clone(&lock(&self.last))
    }

    pub(super) fn situation(&self) -> Situation {
        Situation {
            boot: self.boot,
            max_age: self.settings.max_age,
            camera: (self.camera)(),
            now: Instant::now(),
        }
    }

    pub(super) fn tell(&self, peer: SocketAddr, protocol: &'static str, news: ClientNews) {
        (self.on_event)(ClientEvent {
            peer,
            protocol,
            news,
        });
    }
}

/// One of the clients that are allowed at a time, until it is dropped.
pub struct ClientSlot {
    shared: Arc<Shared>,
}

impl ClientSlot {
    pub(super) fn take(shared: &Arc<Shared>) -> Option<Self> {
        let num_before = shared.num_clients.fetch_add(1, Ordering::SeqCst);
        // Dropped, it is given back.
        let slot = Self {
            shared: Arc::clone(shared),
        };
        (num_before < shared.settings.max_clients).then_some(slot)
    }
}

impl Drop for ClientSlot {
    fn drop(&mut self) {
        self.shared.num_clients.fetch_sub(1, Ordering::SeqCst);
    }
}

/// A trigger that waits for its turn.
pub(super) struct Job {
    pub(super) asked: Asked,
    pub(super) reply: SyncSender<Arc<Inspected>>,
}

/// A server that listens. Dropped, it lets its clients go and waits for its threads.
pub struct Server {
    shared: Arc<Shared>,
    hand_over: SyncSender<Job>,
    jobs: Option<Receiver<Job>>,
    threads: Vec<JoinHandle<()>>,
    addresses: Vec<ListenAddress>,
}

impl Server {
    /// Listens; triggers are inspected once [`Self::run`] is called. `camera` and `on_event` are called by the threads of
    /// the clients and have to return soon.
    pub fn start(
        listeners: &[Listener],
        settings: ServerSettings,
        camera: impl Fn() -> CameraStatus + Send + Sync + 'static,
        on_event: impl Fn(ClientEvent) + Send + Sync + 'static,
    ) -> Result<Self, ServeError> {
        let bound = listeners.iter().map(|listener| bind(*listener));
        let bound = bound.collect::<Result<Vec<_>, ServeError>>()?;
        // A client waits for its answer before it asks again, so no more than that ever wait.
        let (hand_over, jobs) = mpsc::sync_channel(settings.max_clients);
        let mut server = Self {
            shared: Arc::new(Shared {
                settings,
                boot: boot_number(Timestamp::now()),
                is_stopping: AtomicBool::new(false),
                num_clients: AtomicUsize::new(0),
                last: Mutex::default(),
                tally: Mutex::default(),
                camera: Box::new(camera),
                on_event: Box::new(on_event),
            }),
            hand_over,
            jobs: Some(jobs),
            threads: Vec::new(),
            addresses: bound.iter().map(|(listener, _)| listener.at).collect(),
        };
        for (listener, socket) in bound {
            let (shared, jobs) = (Arc::clone(&server.shared), server.hand_over.clone());
            let thread = thread::Builder::new()
                .name("listener".into())
                .spawn(move || listen(listener, &socket, &shared, &jobs))
                .map_err(|source| ServeError::NoThread { source })?;
            server.threads.push(thread);
        }
        Ok(server)
    }

    /// Where it listens, with the ports that the system chose, in the order of the listeners.
    pub fn addresses(&self) -> &[ListenAddress] {
        &self.addresses
    }

    /// The number of this start, 1..=[`MAX_COUNT`].
    pub fn boot(&self) -> u32 {
        self.shared.boot
    }

    /// What another protocol than those of the listeners asks the server by.
    pub fn handle(&self) -> ServerHandle {
        ServerHandle {
            shared: Arc::clone(&self.shared),
            jobs: self.hand_over.clone(),
        }
    }

    /// Inspects what is asked for, until the inspector ends the service. Once only.
    pub fn run(&mut self, inspector: &mut dyn Inspector) {
        let Some(jobs) = self.jobs.take() else {
            return;
        };
        while inspector.turn().is_continue() {
            // Nothing else ends the wait: the server itself keeps a sender.
            if let Ok(job) = jobs.recv_timeout(TURN) {
                self.inspect(&job, inspector);
            }
        }
        // Whoever waits is told that the service ends.
        drop(jobs);
        self.stop();
    }

    fn inspect(&self, job: &Job, inspector: &mut dyn Inspector) {
        let found = guarded(|| inspector.inspect(&job.asked));
        let found = found.unwrap_or_else(|fault| Found::error(Trouble::of("fault", &fault)));
        let age = found.captured.map(|captured| captured.elapsed());
        let (verdict, _) = judged(&found, age, self.shared.settings.max_age);
        lock(&self.shared.tally).add(verdict, job.asked.at.elapsed());
        let inspected = Arc::new(Inspected {
            sequence: self.shared.last().next_sequence(),
            found,
        });
        *lock(&self.shared.last) = Arc::clone(&inspected);
        // Of a client that went away meanwhile it is the last inspection all the same.
        let _ = job.reply.send(Arc::clone(&inspected));
        // The camera is asked for it, whose fault costs one record and not the service.
        if let Ok(record) = guarded(|| InspectionRecord::of(&inspected, self.shared.situation())) {
            inspector.recorded(record);
        }
        inspector.answered();
    }

    fn stop(&mut self) {
        self.shared.is_stopping.store(true, Ordering::SeqCst);
        self.jobs = None;
        for thread in self.threads.drain(..) {
            // A fault of a thread has cost its connections.
            let _ = thread.join();
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop();
    }
}

fn bind(listener: Listener) -> Result<(Listener, TcpListener), ServeError> {
    let at = listener.at;
    let (address, socket) = bound(at.address, &at, "--listen")?;
    let at = ListenAddress { address, ..at };
    Ok((Listener { at, ..listener }, socket))
}

/// A socket that listens without blocking, and its address with the port that the system chose. `at` and `option` say in an
/// error what was given and by which option.
pub(crate) fn bound(
    address: SocketAddr,
    at: &dyn fmt::Display,
    option: &'static str,
) -> Result<(SocketAddr, TcpListener), ServeError> {
    let bound = TcpListener::bind(address).and_then(|socket| {
        socket.set_nonblocking(true)?;
        Ok((socket.local_addr()?, socket))
    });
    bound.map_err(|source| ServeError::Bind {
        at: at.to_string(),
        option,
        source,
    })
}

/// The number of a start: another one every second, for half a year.
pub(super) fn boot_number(now: Timestamp) -> u32 {
    let seconds = now.as_second().rem_euclid(i64::from(MAX_COUNT));
    u32::try_from(seconds).unwrap_or(0) + 1
}

/// Takes connections until the server stops, and then waits for their threads.
fn listen(listener: Listener, socket: &TcpListener, shared: &Arc<Shared>, jobs: &SyncSender<Job>) {
    let mut clients: Vec<JoinHandle<()>> = Vec::new();
    let mut turned_away: VecDeque<(TcpStream, Instant)> = VecDeque::new();
    while !shared.is_stopping() {
        turned_away.retain(|(_, since)| since.elapsed() < LINGER);
        let Ok((stream, peer)) = socket.accept() else {
            // Nobody there, gone again, or no more connections in this computer.
            thread::sleep(ACCEPT_TURN);
            continue;
        };
        clients.retain(|client| !client.is_finished());
        let Some(slot) = ClientSlot::take(shared) else {
            shared.tell(peer, listener.at.protocol.name(), ClientNews::TurnedAway);
            turn_away(&stream, listener, shared);
            if turned_away.len() == MAX_TURNED_AWAY {
                turned_away.pop_front();
            }
            turned_away.push_back((stream, Instant::now()));
            continue;
        };
        let client = Client {
            stream,
            peer,
            listener,
            shared: Arc::clone(shared),
            jobs: jobs.clone(),
        };
        let thread = thread::Builder::new().name("client".into()).spawn(move || {
            client.serve();
            drop(slot);
        });
        // Without a thread the connection is closed, and its client may try again.
        clients.extend(thread);
    }
    for client in clients {
        let _ = client.join();
    }
}

/// Tells a client that there is no room for it.
fn turn_away(mut stream: &TcpStream, listener: Listener, shared: &Shared) {
    let trouble = Trouble::full(shared.settings.max_clients);
    let answer = Answer::turned_away(VerdictCode::Full, trouble, &shared.situation());
    let bytes = listener.at.protocol.write(&answer, listener.convention);
    let told = stream
        .set_nonblocking(false)
        .and_then(|()| stream.set_write_timeout(Some(TURN_AWAY_TIMEOUT)))
        .and_then(|()| stream.write_all(&bytes))
        .and_then(|()| stream.shutdown(Shutdown::Write));
    // It is let go either way.
    drop(told);
}

/// The answer to a request of a client; for a trigger it waits.
pub(super) fn answer_to(request: Request, shared: &Shared, jobs: &SyncSender<Job>) -> Answer {
    let inspected = match request {
        Request::Trigger => triggered(jobs),
        Request::Status | Request::Last | Request::Path(_) => Ok(shared.last()),
    };
    let at = shared.situation();
    match inspected {
        Ok(inspected) => Answer::of(request, &inspected, &at),
        Err(why) => Answer {
            request: Some(request),
            ..Answer::turned_away(VerdictCode::Error, Trouble::of(why.reason(), &why), &at)
        },
    }
}

/// An inspection of a frame from now on.
fn triggered(jobs: &SyncSender<Job>) -> Result<Arc<Inspected>, NoFrame> {
    let (reply, inspected) = mpsc::sync_channel(1);
    let job = Job {
        asked: Asked::now(),
        reply,
    };
    // Both fail once the service ends.
    jobs.send(job).ok().ok_or(NoFrame::Stopping)?;
    inspected.recv().ok().ok_or(NoFrame::Stopping)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::protocol::Protocol;

    #[test]
    fn each_start_has_another_number_that_is_never_zero() {
        let at = |second| boot_number(Timestamp::from_second(second).expect("a time"));
        assert_ne!(at(1_800_000_000), at(1_800_000_001));
        for second in [
            -1,
            0,
            i64::from(MAX_COUNT) - 1,
            i64::from(MAX_COUNT),
            1 << 35,
        ] {
            assert!((1..=MAX_COUNT).contains(&at(second)), "{second}");
        }
    }

    #[test]
    fn a_port_that_is_taken_is_an_error_with_its_advice() {
        let taken = TcpListener::bind("127.0.0.1:0").expect("bound");
        let address = taken.local_addr().expect("an address");
        let at = ListenAddress {
            protocol: Protocol::UrScript,
            address,
        };
        let listener = Listener::new(at, None).expect("spoken");
        let started = Server::start(
            &[listener],
            ServerSettings::default(),
            CameraStatus::default,
            |_| (),
        );
        let Err(error) = started else {
            panic!("the port is taken");
        };
        assert!(error.to_string().contains("another program"), "{error}");
        assert!(error.advice().contains("--listen"));
    }
}
