//! The server: listeners, clients, and one inspection at a time.

use std::{
    collections::VecDeque,
    fmt,
    io::{self, Write as _},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering},
        mpsc::{self, Receiver, SyncSender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use jiff::Timestamp;
use thiserror::Error;

use super::{
    answer::{
        Answer, CameraStatus, Found, FrameParts, Inspected, LibraryStatus, Problem, Situation,
        VerdictCode, judged,
    },
    client::Client,
    handle::ServerHandle,
    inspections::Inspections,
    listen::{ListenAddress, Listener},
    protocol::bad_request::BadRequest,
    record::InspectionRecord,
    request::{AskedOrder, ExpectedNumbers, Request, ServoRequest},
    tally::Tally,
};
use files::words_of;
use geometry::error::{Advice, guarded, lock};

/// How long the inspecting thread waits for a trigger before it calls [`Inspector::turn`] again.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// How often a listener polls for connections: std's `accept` cannot be interrupted.
const ACCEPT_INTERVAL: Duration = Duration::from_millis(10);
/// How long a refused connection stays open, so that its client can read why.
pub(super) const LINGER_TIME: Duration = Duration::from_secs(1);
/// Most refused connections that are kept open at a time.
const MAX_TURNED_AWAY: usize = 64;
/// How long a connection without a request keeps its place while others wait: a robot sends its request right away.
const MAX_SILENCE: Duration = Duration::from_secs(1);
/// How long a client may take to accept its answer before it is disconnected.
pub(super) const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// Short, because the answer to a refused client fits into the socket's empty send buffer.
const TURN_AWAY_TIMEOUT: Duration = Duration::from_millis(100);

/// When a trigger came, and what it expects.
#[derive(Clone, Debug)]
pub struct Asked {
    /// By the monotonic clock.
    pub at: Instant,
    /// By the wall clock, for comparison with file times.
    pub by_clock: Timestamp,
    /// Numbers of the parts that should hang there, and zeros.
    pub expected: ExpectedNumbers,
    /// What the encoder of the line showed, if it was sent.
    pub count: Option<u32>,
    /// How long before the trigger the count was read.
    pub count_age: Duration,
    /// The order that it names.
    pub order: AskedOrder,
}

impl Asked {
    /// Returns the present time on both clocks, no expectation and no count.
    pub fn now() -> Self {
        Self {
            at: Instant::now(),
            by_clock: geometry::clock::now(),
            expected: ExpectedNumbers::default(),
            count: None,
            count_age: Duration::ZERO,
            order: AskedOrder::default(),
        }
    }

    /// When its count was read; when it came, without one.
    pub fn counted_at(&self) -> Instant {
        self.at.checked_sub(self.count_age).unwrap_or(self.at)
    }

    /// A request that has just come.
    fn by(request: &Request) -> Self {
        match request.clone() {
            Request::Trigger {
                expected,
                count,
                count_age,
                order,
            } => Self {
                expected,
                count,
                count_age,
                order,
                ..Self::now()
            },
            _ => Self::now(),
        }
    }
}

/// Captures and inspects frames, on the thread that calls [`Server::run`].
pub trait Inspector {
    /// Captures a frame after the trigger and inspects it.
    fn inspect(&mut self, asked: &Asked) -> FrameParts;

    /// Looks at the part while the robot is at rest, and says where it should go next. `client` is the number of the
    /// connection: a run of servoing belongs to one, and ends with it.
    fn servo(&mut self, _request: &ServoRequest, _client: u64, _asked: &Asked) -> Found {
        Found::error(Problem::no_servoing())
    }

    /// Passes on a part of the last inspection with its number, for receivers other than the client. Called for each part
    /// right after the answer was sent; has to return soon.
    fn recorded(&mut self, _record: InspectionRecord) {}

    /// Called after the answer to the last inspection was sent, for work that nobody waits for.
    fn answered(&mut self);

    /// Called before every inspection and about ten times a second in between; `Break` ends the service.
    fn turn(&mut self) -> ControlFlow<()>;
}

/// Limits of a server.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServerSettings {
    /// Maximum age of the frame of an accepted pose; beyond it the pose is stale.
    pub max_age: Duration,
    /// Maximum number of simultaneous connections of all listeners together, at least 1.
    pub max_clients: usize,
    /// How long a client may send no request before it is disconnected.
    pub idle_timeout: Duration,
    /// How long a request may take from its first byte to its end.
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

/// A client's event, to be shown to the operator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClientEvent {
    /// The client's address.
    pub peer: SocketAddr,
    /// The name of its protocol.
    pub protocol: &'static str,
    /// What happened.
    pub news: ClientNews,
}

/// What happened to a client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClientNews {
    /// It connected.
    Connected,
    /// Its connection ended.
    Left,
    /// It was refused because the maximum number of clients was connected.
    TurnedAway,
    /// It sent a bad request, got an answer and was disconnected.
    BadRequest(BadRequest),
    /// It sent no token or a wrong one, and got an answer.
    WrongToken,
}

/// Why a server cannot start.
#[derive(Debug, Error, Advice)]
pub enum ServeError {
    /// The system refuses to listen at the address.
    #[error("cannot listen at {at}: {}", words_of_bind(source))]
    #[advice(match source.kind() {
        io::ErrorKind::AddrInUse => format!("End the other program, or choose another port with {option}"),
        io::ErrorKind::AddrNotAvailable => {
            "Give the address of a network card of this computer, or the port alone".into()
        }
        io::ErrorKind::PermissionDenied => "Choose a port from 1024 up".into(),
        _ => format!("Choose another address with {option}"),
    })]
    Bind {
        /// The address as given.
        at: String,
        /// The command-line option that sets the address.
        option: &'static str,
        /// The underlying error.
        source: io::Error,
    },
    /// The system refuses a thread for a listener.
    #[error("the listener's thread cannot be started: {source}")]
    #[advice = "Close other programs and start again"]
    NoThread {
        /// The underlying error.
        source: io::Error,
    },
}

/// Why a trigger was not inspected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error, Advice)]
pub enum Unanswered {
    /// The service is ending.
    #[error("the service is stopping")]
    #[advice = "Connect again once the service is running"]
    Stopping,
    /// Nobody waits for the answer any more.
    #[error("the client closed the connection before it was its turn")]
    #[advice = "TRIGGER again, and keep the connection open, for sending too, until the answer has come"]
    Withdrawn,
}

impl Unanswered {
    /// The reason word in an answer.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Stopping => "stopping",
            Self::Withdrawn => "withdrawn",
        }
    }
}

fn words_of_bind(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => "another program listens at this port".into(),
        io::ErrorKind::AddrNotAvailable => "this computer does not have this address".into(),
        io::ErrorKind::PermissionDenied => "this port is reserved for the system".into(),
        _ => words_of(error),
    }
}

/// State shared by all threads of a server.
pub(super) struct Shared {
    pub(super) settings: ServerSettings,
    is_stopping: AtomicBool,
    num_clients: AtomicUsize,
    /// Number of clients since the start.
    num_known: AtomicU64,
    /// Connections without a request so far, and since when, the oldest first.
    silent: Mutex<VecDeque<(Instant, Arc<TcpStream>)>>,
    pub(super) inspections: Mutex<Inspections>,
    pub(super) tally: Mutex<Tally>,
    pub(super) library: Mutex<Option<LibraryStatus>>,
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

    /// Called once a connection has sent a request, and when it ends.
    pub(super) fn forget_silent(&self, stream: &Arc<TcpStream>) {
        lock(&self.silent).retain(|(_, other)| !Arc::ptr_eq(other, stream));
    }

    /// Closes the oldest connection without a request so far; false if there is none, or only since a moment ago.
    fn close_silent(&self) -> bool {
        let oldest = lock(&self.silent).pop_front_if(|(since, _)| since.elapsed() > MAX_SILENCE);
        // Its thread reads the end of the stream and ends. If this fails, the client has closed the connection.
        let closed = oldest.map(|(_, stream)| stream.shutdown(Shutdown::Both));
        closed.is_some()
    }

    pub(super) fn last(&self) -> Arc<Inspected> {
        lock(&self.inspections).last()
    }

    pub(super) fn situation(&self) -> Situation {
        Situation {
            boot: lock(&self.inspections).boot(),
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

/// One of the limited number of client places; dropping it frees the place.
pub struct ClientSlot {
    shared: Arc<Shared>,
}

impl ClientSlot {
    /// Takes a place; if all are taken, that of a connection without a request so far, whose thread then ends in a moment.
    pub(super) fn take(shared: &Arc<Shared>) -> Option<Self> {
        let num_before = shared.num_clients.fetch_add(1, Ordering::SeqCst);
        // If it is not returned, its drop undoes the count.
        let slot = Self {
            shared: Arc::clone(shared),
        };
        (num_before < shared.settings.max_clients || shared.close_silent()).then_some(slot)
    }
}

impl Drop for ClientSlot {
    fn drop(&mut self) {
        self.shared.num_clients.fetch_sub(1, Ordering::SeqCst);
    }
}

/// What the server knows of a client from one request to the next.
pub(super) struct ClientMemory {
    /// Its number, which no other client has.
    number: u64,
    /// What its last trigger led to.
    own: Option<Arc<Inspected>>,
}

impl ClientMemory {
    pub(super) fn new(shared: &Shared) -> Self {
        Self {
            number: shared.num_known.fetch_add(1, Ordering::SeqCst),
            own: None,
        }
    }
}

/// A trigger that waits for its inspection, or a robot for its next move.
pub(super) struct Job {
    asked: Asked,
    /// The robot that servoes, and the number of its client.
    servo: Option<(ServoRequest, u64)>,
    /// True once the client has closed its connection: nobody reads the answer.
    is_withdrawn: Box<dyn Fn() -> bool + Send>,
    reply: SyncSender<Result<Arc<Inspected>, Unanswered>>,
}

/// A listening server. Dropping it disconnects its clients and joins its threads.
pub struct Server {
    shared: Arc<Shared>,
    hand_over: SyncSender<Job>,
    jobs: Option<Receiver<Job>>,
    threads: Vec<JoinHandle<()>>,
    addresses: Vec<ListenAddress>,
}

impl Server {
    /// Binds the listeners and starts to accept clients; triggers wait until [`Self::run`] is called. `camera` and
    /// `on_event` are called on the clients' threads and have to return soon.
    pub fn start(
        listeners: &[Listener],
        settings: ServerSettings,
        camera: impl Fn() -> CameraStatus + Send + Sync + 'static,
        on_event: impl Fn(ClientEvent) + Send + Sync + 'static,
    ) -> Result<Self, ServeError> {
        let bound = listeners.iter().map(|listener| bind(*listener));
        let bound = bound.collect::<Result<Vec<_>, ServeError>>()?;
        // A client waits for its answer before it asks again, so there are never more jobs than clients.
        let (hand_over, jobs) = mpsc::sync_channel(settings.max_clients);
        let mut server = Self {
            shared: Arc::new(Shared {
                settings,
                is_stopping: AtomicBool::new(false),
                num_clients: AtomicUsize::new(0),
                num_known: AtomicU64::new(0),
                silent: Mutex::default(),
                inspections: Mutex::new(Inspections::start()),
                tally: Mutex::default(),
                library: Mutex::default(),
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

    /// The addresses listened at, in the order of the listeners, with the ports that the system chose.
    pub fn addresses(&self) -> &[ListenAddress] {
        &self.addresses
    }

    /// The present boot number, 1..=[`MAX_COUNT`](super::MAX_COUNT).
    pub fn boot(&self) -> u32 {
        lock(&self.shared.inspections).boot()
    }

    /// Returns a handle by which other protocols query the server.
    pub fn handle(&self) -> ServerHandle {
        ServerHandle {
            shared: Arc::clone(&self.shared),
            jobs: self.hand_over.clone(),
        }
    }

    /// Inspects trigger by trigger until the inspector ends the service. Returns at once if called again.
    pub fn run(&mut self, inspector: &mut dyn Inspector) {
        let Some(jobs) = self.jobs.take() else {
            return;
        };
        while inspector.turn().is_continue() {
            // A timeout is the only error: the server itself keeps a sender.
            if let Ok(job) = jobs.recv_timeout(POLL_INTERVAL) {
                self.inspect(&job, inspector);
            }
        }
        // Answer waiting clients that the service ends.
        drop(jobs);
        self.stop();
    }

    fn inspect(&self, job: &Job, inspector: &mut dyn Inspector) {
        // Or clients that give up would hold up those that wait.
        if (job.is_withdrawn)() {
            let _ = job.reply.send(Err(Unanswered::Withdrawn));
            return;
        }
        if let Some((request, client)) = &job.servo {
            let found = guarded(|| inspector.servo(request, *client, &job.asked));
            let found = found.unwrap_or_else(|fault| Found::error(Problem::of("fault", &fault)));
            let inspected = lock(&self.shared.inspections).number(found.into());
            // The run ends with a client that has disconnected.
            let _ = job.reply.send(Ok(inspected));
            inspector.answered();
            return;
        }
        let found = guarded(|| inspector.inspect(&job.asked));
        let found = found.unwrap_or_else(|fault| Found::error(Problem::of("fault", &fault)).into());
        let verdicts = found.iter().map(|part| {
            let age = part.captured.map(|captured| captured.elapsed());
            judged(part, age, self.shared.settings.max_age).0
        });
        lock(&self.shared.tally).add(verdicts, job.asked.at.elapsed());
        let inspected = lock(&self.shared.inspections).add(found);
        // Keep it as the last inspection even if the client has disconnected.
        let _ = job.reply.send(Ok(Arc::clone(&inspected)));
        // `situation` calls the camera's callback; if that panics, lose one record and not the service.
        let records = guarded(|| InspectionRecord::of_all(&inspected, &self.shared.situation()));
        for record in records.into_iter().flatten() {
            inspector.recorded(record);
        }
        inspector.answered();
    }

    fn stop(&mut self) {
        self.shared.is_stopping.store(true, Ordering::SeqCst);
        self.jobs = None;
        for thread in self.threads.drain(..) {
            // A thread that panicked has only lost its connections.
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

/// Binds a non-blocking listening socket. Returns it with its address, including the port that the system chose. `at` and
/// `option` name the address and its command-line option in an error.
pub fn bound(
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

/// Accepts connections until the server stops, then joins their threads.
fn listen(listener: Listener, socket: &TcpListener, shared: &Arc<Shared>, jobs: &SyncSender<Job>) {
    let mut clients: Vec<JoinHandle<()>> = Vec::new();
    let mut turned_away: VecDeque<(TcpStream, Instant)> = VecDeque::new();
    while !shared.is_stopping() {
        turned_away.retain(|(_, since)| since.elapsed() < LINGER_TIME);
        let Ok((stream, peer)) = socket.accept() else {
            // No connection, one that is gone again, or the system has no sockets left.
            thread::sleep(ACCEPT_INTERVAL);
            continue;
        };
        clients.retain(|client| !client.is_finished());
        let Some(slot) = ClientSlot::take(shared) else {
            shared.tell(peer, listener.at.protocol.name(), ClientNews::TurnedAway);
            // A fault in it must not end the listener.
            let _ = guarded(|| turn_away(&stream, listener, shared));
            if turned_away.len() == MAX_TURNED_AWAY {
                turned_away.pop_front();
            }
            turned_away.push_back((stream, Instant::now()));
            continue;
        };
        let stream = Arc::new(stream);
        lock(&shared.silent).push_back((Instant::now(), Arc::clone(&stream)));
        let client = Client {
            stream: Arc::clone(&stream),
            peer,
            listener,
            shared: Arc::clone(shared),
            jobs: jobs.clone(),
        };
        let thread = thread::Builder::new().name("client".into()).spawn(move || {
            client.serve();
            drop(slot);
        });
        match thread {
            Ok(thread) => clients.push(thread),
            // The connection is dropped, and the client may try again.
            Err(_) => shared.forget_silent(&stream),
        }
    }
    for client in clients {
        let _ = client.join();
    }
}

/// Tells a client that the server is full.
fn turn_away(mut stream: &TcpStream, listener: Listener, shared: &Shared) {
    let problem = Problem::full(shared.settings.max_clients);
    let answer = Answer::turned_away(VerdictCode::Full, problem, &shared.situation());
    let bytes = listener.at.protocol.write(&answer, listener.convention);
    let written = stream
        .set_nonblocking(false)
        .and_then(|()| stream.set_write_timeout(Some(TURN_AWAY_TIMEOUT)))
        .and_then(|()| stream.write_all(&bytes))
        .and_then(|()| stream.shutdown(Shutdown::Write));
    // The connection is dropped whether or not that succeeded.
    drop(written);
}

/// Answers a client's request; for one that needs a frame it blocks until the inspection is done. `is_withdrawn` returns true
/// once the client does not wait for an answer any more.
pub(super) fn answer_to(
    request: Request,
    shared: &Shared,
    jobs: &SyncSender<Job>,
    client: &mut ClientMemory,
    is_withdrawn: impl Fn() -> bool + Send + 'static,
) -> Answer {
    let inspected = match request {
        Request::Trigger { .. } => {
            let triggered = triggered(&request, jobs, Box::new(is_withdrawn));
            client.own = triggered.as_ref().ok().map(Arc::clone);
            triggered.map(|inspected| (inspected, 0))
        }
        Request::Servo(servo) => {
            let servo = Some((servo, client.number));
            let looked = inspected_for(Asked::now(), servo, jobs, Box::new(is_withdrawn));
            looked.map(|inspected| (inspected, 0))
        }
        Request::Status | Request::Last => Ok((shared.last(), 0)),
        Request::Path { sequence, .. } | Request::Part { sequence, .. } => {
            let known = inspection_of(sequence, client.own.as_ref(), shared);
            known.map_err(|problem| (VerdictCode::BadRequest, problem))
        }
    };
    let at = shared.situation();
    match inspected {
        Ok((inspected, index)) => {
            let index = match request {
                Request::Part { number, .. } => number.saturating_sub(1) as usize,
                _ => index,
            };
            Answer::of(&request, &inspected, index, &at)
        }
        Err((verdict, problem)) => Answer {
            request: Some(request),
            ..Answer::turned_away(verdict, problem, &at)
        },
    }
}

/// The inspection whose path or parts a client gets: its own, or the one that it names. Never the last one of any other client.
/// Also returns the index of the part in its frame.
pub(super) fn inspection_of(
    sequence: Option<u32>,
    own: Option<&Arc<Inspected>>,
    shared: &Shared,
) -> Result<(Arc<Inspected>, usize), Problem> {
    let Some(sequence) = sequence else {
        let own = own.map(|own| (Arc::clone(own), 0));
        return own.ok_or_else(Problem::no_trigger);
    };
    let known = lock(&shared.inspections).find(sequence);
    known.ok_or_else(|| Problem::no_such_inspection(sequence))
}

/// Requests an inspection of a frame captured from now on, and waits for it. An error is a verdict with its reason.
pub(super) fn triggered(
    request: &Request,
    jobs: &SyncSender<Job>,
    is_withdrawn: Box<dyn Fn() -> bool + Send>,
) -> Result<Arc<Inspected>, (VerdictCode, Problem)> {
    inspected_for(Asked::by(request), None, jobs, is_withdrawn)
}

/// As [`triggered`], also for a robot that servoes.
fn inspected_for(
    asked: Asked,
    servo: Option<(ServoRequest, u64)>,
    jobs: &SyncSender<Job>,
    is_withdrawn: Box<dyn Fn() -> bool + Send>,
) -> Result<Arc<Inspected>, (VerdictCode, Problem)> {
    let (reply, inspected) = mpsc::sync_channel(1);
    let job = Job {
        asked,
        servo,
        is_withdrawn,
        reply,
    };
    // Both fail once the service ends.
    let sent = jobs.send(job).ok().ok_or(Unanswered::Stopping);
    let inspected = sent.and_then(|()| inspected.recv().ok().ok_or(Unanswered::Stopping)?);
    inspected.map_err(|why| (VerdictCode::Error, Problem::of(why.reason(), &why)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{answer::PathStep, protocol::Protocol};
    use geometry::rigid::RigidTransform;

    #[test]
    fn once_the_last_inspection_is_refused_its_numbers_do_not_go_out_any_more() {
        let settings = ServerSettings::default();
        let server = Server::start(&[], settings, CameraStatus::default, |_| ());
        let server = server.expect("nothing to bind");
        let step = PathStep {
            robot_from_nozzle: RigidTransform::identity(),
            marks: Answer::GUN_ON,
            speed: None,
        };
        let own = lock(&server.shared.inspections).add(
            Found {
                verdict: VerdictCode::Accepted,
                captured: Some(Instant::now()),
                part: "fender".into(),
                marks: Answer::APPROXIMATE | Answer::SIMULATED,
                pose: Some(RigidTransform::identity()),
                path: vec![step],
                ..Found::default()
            }
            .into(),
        );
        let path = |sequence| Request::Path { point: 1, sequence };
        let handle = server.handle();
        let answer = |request| {
            let mut client = ClientMemory::new(&server.shared);
            client.own = Some(Arc::clone(&own));
            let (shared, jobs) = (&server.shared, &server.hand_over);
            answer_to(request, shared, jobs, &mut client, || false)
        };
        let with_numbers = [Request::Last, path(None), path(Some(1))];
        for request in with_numbers.clone() {
            let words = format!("{request:?}");
            assert!(answer(request).pose.is_some(), "{words}");
        }
        handle.refuse_last(&Problem::reported_wrong());
        for request in with_numbers.into_iter().chain([Request::Status]) {
            let words = format!("{request:?}");
            let answer = answer(request);
            assert_eq!(answer.verdict, VerdictCode::Refused, "{words}");
            assert_eq!((answer.pose, answer.points), (None, 0));
            assert_eq!(answer.flags(), Answer::SIMULATED);
            assert_eq!((answer.sequence, &*answer.part), (1, "fender"));
            assert_eq!(answer.problem.reason, "reported_wrong");
        }
        let boot = handle.boot();
        handle.renew();
        assert_ne!(handle.boot(), boot);
        let last = answer(Request::Last);
        assert_eq!(
            (last.verdict, last.boot),
            (VerdictCode::None, handle.boot())
        );
        let before = answer(path(None));
        assert_eq!((before.verdict, before.boot), (VerdictCode::Refused, boot));
        let named = answer(path(Some(1)));
        assert_eq!(named.problem.reason, "no_such_inspection");
        assert_eq!((named.sequence, named.pose), (0, None));
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
