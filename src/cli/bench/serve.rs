//! `partsight bench serve`: the overhead of each protocol over a bare exchange of equally many bytes, and of serving
//! over a direct inspection.
//!
//! Server and clients run on this computer, so no network is measured. The compared sides take turns, so that both see
//! the computer in the same state. No camera is involved: a trigger inspects the frame at hand instead of waiting for
//! the next.

mod client;

use std::{
    net::SocketAddr,
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use anyhow::Context as _;
use serde::Serialize;

use self::client::{Client, Framing, busy_rate};
use super::{BenchArgs, write_json};
#[cfg(feature = "plant")]
use crate::plant::http::{HttpServer, HttpSettings, Tokens};
use crate::{
    bench::{
        quantile,
        suites::{MEASURING_SEED, Suite, enrol_standard_parts},
    },
    cli::{
        Outcome,
        console::{Advised as _, Console, Table, advised_error},
    },
    error::lock,
    geometry::{depth_frame::DepthFrame, rigid::RigidTransform},
    library::{EnrolParams, Library},
    pipeline::{self, NamedRecipe, Unwatched},
    report::InspectionLine,
    robot::{Convention, RobotFrame},
    serve::{
        ANSWER_BYTES, Asked, ByteOrder, CameraStatus, Found, FrameOrigin, Inspector, ListenAddress,
        Listener, NumberedPart, PartFinder, PoseKind, Protocol, Request, Server, ServerSettings,
        binary_request, parse_address,
    },
    simulate::{CellSetup, PartKind, Side, frame, frame_of_mesh},
    stages::scene::scene_from_frame,
};

/// Default number of poses per part; each frame is triggered once in every protocol.
const NUM_POSES: u64 = 25;
/// Number of status requests of each protocol over one connection, and over each of several.
const NUM_STATUS: usize = 5_000;
/// Number of requests in a row before as many bare exchanges.
const BLOCK: usize = 100;
/// Number of blocks that are not counted.
const WARM_UP: usize = 5;
/// Number of simultaneous connections.
const NUM_CONNECTIONS: usize = 4;
/// Number of triggers over each of them.
const NUM_BUSY_TRIGGERS: usize = 5;
/// Longer than any connection waits for its turn.
const PATIENCE: Duration = Duration::from_mins(10);

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct ServeFile {
    schema: u32,
    simulated: bool,
    num_connections: usize,
    status: Vec<StatusTimes>,
    /// Inspections called directly.
    direct: Times,
    triggers: Vec<TriggerTimes>,
}

/// Times of requests one after the other over one connection.
#[derive(Clone, Copy, Debug, Serialize)]
struct Times {
    num: usize,
    median_ms: f64,
    p99_ms: f64,
    per_s: f64,
    /// Rate over several connections at once.
    busy_per_s: f64,
}

/// Ratios of times to those of the compared side.
#[derive(Clone, Copy, Debug, Serialize)]
struct Ratios {
    median: f64,
    p99: f64,
    per_s: f64,
    busy_per_s: f64,
}

/// Status requests of a protocol compared with bare exchanges of equally many bytes.
#[derive(Debug, Serialize)]
struct StatusTimes {
    protocol: &'static str,
    request_bytes: usize,
    answer_bytes: usize,
    times: Times,
    bare: Times,
    ratios: Ratios,
}

/// Triggers of a protocol compared with the same inspections called directly.
#[derive(Debug, Serialize)]
struct TriggerTimes {
    protocol: &'static str,
    times: Times,
    ratios: Ratios,
}

impl Times {
    fn of(times: &[Duration], busy_per_s: f64) -> Self {
        let ms = || times.iter().map(|time| time.as_secs_f64() * 1e3);
        let of = |share| quantile(ms(), share).unwrap_or(0.0);
        Self {
            num: times.len(),
            median_ms: of(0.5),
            p99_ms: of(0.99),
            per_s: times.len() as f64 * 1e3 / ms().sum::<f64>(),
            busy_per_s,
        }
    }

    fn over(&self, other: &Self) -> Ratios {
        Ratios {
            median: self.median_ms / other.median_ms,
            p99: self.p99_ms / other.p99_ms,
            per_s: self.per_s / other.per_s,
            busy_per_s: self.busy_per_s / other.busy_per_s,
        }
    }
}

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let frames = Suite::Placed.frames(
        args.poses.unwrap_or(NUM_POSES),
        args.seed.unwrap_or(MEASURING_SEED),
    );
    let inspections = Arc::new(Inspections::new()?);
    let service = Service::start(&inspections)?;
    console.line(&format_args!(
        "The server on this computer, over one connection and over {NUM_CONNECTIONS}, under its present load."
    ));
    // Before the first inspection, so that all answers have the same length.
    let status = service.protocols.iter().map(status_times);
    let status = status.collect::<anyhow::Result<Vec<_>>>()?;

    console.start_progress(frames.len());
    let mut clients = Vec::new();
    for protocol in &service.protocols {
        let mut client = protocol.connect()?;
        // The server takes a while to notice a connection.
        asked(&mut client, protocol, &protocol.status)?;
        clients.push((protocol, client, Vec::with_capacity(frames.len())));
    }
    let mut direct = Vec::with_capacity(frames.len());
    for frame in &frames {
        let shot = frame_of_mesh(&frame.setup, &frame.setup.subject.mesh());
        inspections.show(shot.frame);
        // The first inspection of a frame is slower than later ones, so it is not timed.
        inspections.inspect();
        direct.push(timed(|| drop(inspections.inspect())));
        for (protocol, client, times) in &mut clients {
            times.push(asked(client, protocol, &protocol.trigger)?);
        }
        console.done();
    }
    console.end_progress();
    let num_busy = NUM_CONNECTIONS * NUM_BUSY_TRIGGERS;
    let busy = timed(|| (0..num_busy).for_each(|_| drop(inspections.inspect())));
    let direct = Times::of(&direct, num_busy as f64 / busy.as_secs_f64());
    let mut triggers = Vec::new();
    for (protocol, _, times) in &clients {
        let busy = protocol.busy_rate(&protocol.trigger, NUM_BUSY_TRIGGERS)?;
        let times = Times::of(times, busy);
        triggers.push(TriggerTimes {
            protocol: protocol.name,
            times,
            ratios: times.over(&direct),
        });
    }
    // Including the first request of each connection.
    let of_each = frames.len() + num_busy + NUM_CONNECTIONS;
    check_triggers(&service, of_each * clients.len())?;
    show_status(&status, console);
    show_triggers(&direct, &triggers, console);
    if let Some(path) = &args.json {
        let file = ServeFile {
            schema: 1,
            simulated: true,
            num_connections: NUM_CONNECTIONS,
            status,
            direct,
            triggers,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

/// Checks the number of inspections: a trigger answered without one would count as a very fast one.
fn check_triggers(service: &Service, num_triggers: usize) -> anyhow::Result<()> {
    let num_inspected = service.num_inspected.load(Ordering::SeqCst);
    if num_inspected == num_triggers as u64 {
        return Ok(());
    }
    Err(advised_error(
        format!("{num_triggers} triggers led to {num_inspected} inspections"),
        "Report this as a bug",
    ))
}

fn timed(work: impl FnOnce()) -> Duration {
    let begun = Instant::now();
    work();
    begun.elapsed()
}

/// Sends a request and returns the time until its answer.
fn asked(
    client: &mut Client,
    protocol: &ServedProtocol,
    request: &[u8],
) -> anyhow::Result<Duration> {
    let begun = Instant::now();
    client
        .ask(request)
        .with_context(|| format!("{} gave no answer", protocol.name))?;
    Ok(begun.elapsed())
}

fn status_times(protocol: &ServedProtocol) -> anyhow::Result<StatusTimes> {
    let request = protocol.status.as_slice();
    let mut client = protocol.connect()?;
    let answer_bytes = client.ask(request)?;
    let connect_bare = || Client::connect_bare(request.len(), answer_bytes);
    let mut bare_client = connect_bare()?;
    let (mut times, mut bare) = (Vec::new(), Vec::new());
    for block in 0..WARM_UP + NUM_STATUS / BLOCK {
        if block == WARM_UP {
            times.clear();
            bare.clear();
        }
        for (client, times) in [(&mut client, &mut times), (&mut bare_client, &mut bare)] {
            for _ in 0..BLOCK {
                times.push(asked(client, protocol, request)?);
            }
        }
    }
    let times = Times::of(&times, protocol.busy_rate(request, NUM_STATUS)?);
    let busy_bare = busy_rate(connect_bare, NUM_CONNECTIONS, request, NUM_STATUS)?;
    let bare = Times::of(&bare, busy_bare);
    Ok(StatusTimes {
        protocol: protocol.name,
        request_bytes: request.len(),
        answer_bytes,
        times,
        bare,
        ratios: times.over(&bare),
    })
}

/// Inspects the frame at hand as the server does, without camera, display and history.
struct Inspections {
    library: Library,
    recipe: NamedRecipe,
    finder: PartFinder,
    frame: Mutex<Arc<DepthFrame>>,
}

impl Inspections {
    fn new() -> anyhow::Result<Self> {
        let library = enrol_standard_parts(&EnrolParams::default()).advised()?;
        let first = frame(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1));
        let parts = (1..).zip(&library.references);
        let parts = parts.map(|(number, _)| NumberedPart {
            number,
            path: None,
            is_simulated: true,
        });
        let finder = PartFinder {
            parts: parts.collect(),
            robot: RobotFrame {
                robot_from_camera: RigidTransform::identity(),
                name: String::new(),
            },
            kind: PoseKind::RobotFromPart,
        };
        Ok(Self {
            library,
            recipe: NamedRecipe::default(),
            finder,
            frame: Mutex::new(Arc::new(first.frame)),
        })
    }

    fn show(&self, frame: DepthFrame) {
        *lock(&self.frame) = Arc::new(frame);
    }

    fn inspect(&self) -> Found {
        let frame = Arc::clone(&lock(&self.frame));
        let origin = FrameOrigin {
            captured: Instant::now(),
            is_simulated: true,
        };
        let scene = scene_from_frame(&frame);
        let recipe = &self.recipe;
        let inspection =
            pipeline::run(&scene, &self.library, recipe, &Unwatched).expect("nobody cancels");
        let mut found = self.finder.found(&inspection, recipe, origin);
        found.report = InspectionLine::of("simulated frame", &inspection)
            .by(recipe)
            .in_robot(Some(&self.finder.robot), &inspection)
            .to_json();
        found
    }
}

/// The same inspections, run on the server's thread.
struct ServedInspections {
    inspections: Arc<Inspections>,
    num_inspected: Arc<AtomicU64>,
    is_ending: Arc<AtomicBool>,
}

impl Inspector for ServedInspections {
    fn inspect(&mut self, _asked: &Asked) -> Found {
        self.num_inspected.fetch_add(1, Ordering::SeqCst);
        self.inspections.inspect()
    }

    fn answered(&mut self) {}

    fn turn(&mut self) -> ControlFlow<()> {
        if self.is_ending.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Address and requests of a protocol.
struct ServedProtocol {
    name: &'static str,
    address: SocketAddr,
    framing: Framing,
    status: Vec<u8>,
    trigger: Vec<u8>,
}

impl ServedProtocol {
    fn of(at: ListenAddress) -> Self {
        let lines = || [b"STATUS\n".to_vec(), b"TRIGGER\n".to_vec()];
        let element =
            |word: &str| format!("<Robot><Request>{word}</Request><Point>0</Point></Robot>");
        let (framing, [status, trigger]) = match at.protocol {
            Protocol::Ascii | Protocol::UrScript => (Framing::Line, lines()),
            Protocol::Binary(order) => {
                let frames = [Request::Status, Request::Trigger];
                let frames = frames.map(|request| binary_request(request, order));
                (Framing::Bytes(ANSWER_BYTES), frames)
            }
            Protocol::Eki => {
                let elements = ["STATUS", "TRIGGER"].map(|word| element(word).into_bytes());
                (Framing::Line, elements)
            }
        };
        Self {
            name: at.protocol.name(),
            address: at.address,
            framing,
            status,
            trigger,
        }
    }

    #[cfg(feature = "plant")]
    fn http(address: SocketAddr) -> Self {
        let head = |first: &str| format!("{first} HTTP/1.1\r\nHost: {address}\r\n");
        Self {
            name: "http",
            address,
            framing: Framing::Http,
            status: format!("{}\r\n", head("GET /v1/status")).into_bytes(),
            trigger: format!("{}Content-Length: 0\r\n\r\n", head("POST /v1/trigger")).into_bytes(),
        }
    }

    fn connect(&self) -> anyhow::Result<Client> {
        Client::connect(self.address, self.framing)
            .with_context(|| format!("cannot connect to {}", self.name))
    }

    fn busy_rate(&self, request: &[u8], num_each: usize) -> anyhow::Result<f64> {
        let connect = || Client::connect(self.address, self.framing);
        busy_rate(connect, NUM_CONNECTIONS, request, num_each)
            .with_context(|| format!("{} gave no answer", self.name))
    }
}

/// A running server; dropping it stops it.
struct Service {
    protocols: Vec<ServedProtocol>,
    num_inspected: Arc<AtomicU64>,
    is_ending: Arc<AtomicBool>,
    #[cfg(feature = "plant")]
    _http: HttpServer,
    thread: Option<JoinHandle<()>>,
}

impl Service {
    fn start(inspections: &Arc<Inspections>) -> anyhow::Result<Self> {
        let protocols = [
            Protocol::Ascii,
            Protocol::Binary(ByteOrder::Little),
            Protocol::Eki,
            Protocol::UrScript,
        ];
        let any_port = parse_address("0").advised()?;
        let listeners = protocols.map(|protocol| {
            let address = any_port;
            Listener::new(ListenAddress { protocol, address }, Some(Convention::Kuka))
        });
        let listeners = listeners.into_iter().collect::<Result<Vec<_>, _>>();
        let settings = ServerSettings {
            // HTTP closes a connection that is silent for this long, such as one that waits for its turn here.
            request_timeout: PATIENCE,
            ..ServerSettings::default()
        };
        let server = Server::start(
            &listeners.advised()?,
            settings,
            CameraStatus::default,
            |_| (),
        );
        let mut server = server.advised()?;
        #[cfg(feature = "plant")]
        let http = HttpSettings {
            address: any_port,
            convention: Convention::Kuka,
            tokens: Tokens::default(),
            tls: None,
        };
        #[cfg(feature = "plant")]
        let http = HttpServer::start(http, server.handle()).advised()?;
        let protocols = server.addresses().iter().map(|at| ServedProtocol::of(*at));
        #[cfg(feature = "plant")]
        let protocols = protocols.chain([ServedProtocol::http(http.address())]);
        let protocols = protocols.collect();
        let is_ending = Arc::new(AtomicBool::new(false));
        let num_inspected = Arc::new(AtomicU64::new(0));
        let mut served = ServedInspections {
            inspections: Arc::clone(inspections),
            num_inspected: Arc::clone(&num_inspected),
            is_ending: Arc::clone(&is_ending),
        };
        let thread = thread::Builder::new().name("server".into());
        let thread = thread.spawn(move || server.run(&mut served))?;
        Ok(Self {
            protocols,
            num_inspected,
            is_ending,
            #[cfg(feature = "plant")]
            _http: http,
            thread: Some(thread),
        })
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A failed server has already shown up as missing answers.
            let _ = thread.join();
        }
    }
}

fn show_status(status: &[StatusTimes], console: &mut Console) {
    console.line(&"");
    let mut table = Table::new(&[
        "status",
        "bytes",
        "median",
        "99 %",
        "a second",
        "by several",
        "bare: median",
        "99 %",
        "median ×",
        "99 % ×",
        "a second ×",
        "by several ×",
    ]);
    for row in status {
        let mut cells = vec![
            row.protocol.to_owned(),
            format!("{} + {}", row.request_bytes, row.answer_bytes),
        ];
        cells.extend(cells_of(&row.times, 3));
        let [median, p99, ..] = cells_of(&row.bare, 3);
        cells.extend([median, p99]);
        cells.extend(ratio_cells(&row.ratios));
        table.row(cells);
    }
    table.show(console);
    console.line(
        &"Bytes of request and answer; bare: a thread that reads and writes as many, and does nothing else.",
    );
}

fn show_triggers(direct: &Times, triggers: &[TriggerTimes], console: &mut Console) {
    console.line(&"");
    let mut table = Table::new(&[
        "trigger",
        "median",
        "99 %",
        "a second",
        "by several",
        "median ×",
        "99 % ×",
        "a second ×",
        "by several ×",
    ]);
    let name = "called directly".to_owned();
    table.row([name].into_iter().chain(cells_of(direct, 2)));
    for row in triggers {
        let mut cells = vec![row.protocol.to_owned()];
        cells.extend(cells_of(&row.times, 2));
        cells.extend(ratio_cells(&row.ratios));
        table.row(cells);
    }
    table.show(console);
    console.line(&format_args!(
        "{} inspections of simulated frames each, one at a time, also by several: they wait for each other.",
        direct.num
    ));
}

fn cells_of(times: &Times, decimals: usize) -> [String; 4] {
    let ms = |ms: f64| format!("{ms:.decimals$} ms");
    let rate = |rate: f64| {
        let decimals = usize::from(rate < 1000.0);
        format!("{rate:.decimals$}")
    };
    [
        ms(times.median_ms),
        ms(times.p99_ms),
        rate(times.per_s),
        rate(times.busy_per_s),
    ]
}

fn ratio_cells(ratios: &Ratios) -> [String; 4] {
    let Ratios {
        median,
        p99,
        per_s,
        busy_per_s,
    } = ratios;
    [median, p99, per_s, busy_per_s].map(|ratio| format!("{ratio:.2}"))
}
