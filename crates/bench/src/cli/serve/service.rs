//! The measured server: every protocol on a port of its own, over inspections of a simulated frame.

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

use super::{
    client::{Client, Framing, busy_rate},
    http::{self, HttpServer},
};
use geometry::{depth_frame::DepthFrame, error::lock, rigid::RigidTransform};
use inspection::{
    library::{EnrolParams, Library, enrol_standard_parts},
    pipeline::{self, NamedRecipe, Unwatched},
};
use partsight::cli::console::Advised as _;
use records::history::Traceability;
use robot::{Convention, RobotFrame};
use serve::{
    ANSWER_BYTES, Asked, ByteOrder, CameraStatus, FrameParts, Inspector, ListenAddress, Listener,
    PoseKind, Protocol, Request, Server, ServerSettings, binary_request, parse_address,
};
use simulate::{CellSetup, PartKind, Side, frame};
use stages::scene::scene_from_frame;
use station::{Inspected, NumberedPart, PartFinder, Subject};

/// Longer than any connection waits for its turn.
const PATIENCE: Duration = Duration::from_mins(10);

/// Inspects the current frame as the server does, without camera, display and history.
pub(super) struct Inspections {
    library: Library,
    recipe: NamedRecipe,
    finder: PartFinder,
    frame: Mutex<Arc<DepthFrame>>,
}

impl Inspections {
    pub(super) fn new() -> anyhow::Result<Self> {
        let library = enrol_standard_parts(&EnrolParams::default()).advised()?;
        let first = frame(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1));
        let parts = (1..).zip(&library.references);
        let parts = parts.map(|(number, _)| NumberedPart {
            number,
            path: None,
            off: None,
            is_simulated: true,
        });
        let finder = PartFinder {
            parts: parts.collect(),
            robot: RobotFrame {
                robot_from_camera: RigidTransform::identity(),
                name: "".into(),
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

    /// Makes this the current frame.
    pub(super) fn show(&self, frame: DepthFrame) {
        *lock(&self.frame) = Arc::new(frame);
    }

    pub(super) fn inspect(&self) -> FrameParts {
        let frame = Arc::clone(&lock(&self.frame));
        let captured = Instant::now();
        let scene = Arc::new(scene_from_frame(&frame));
        let recipe = &self.recipe;
        let inspection =
            pipeline::run(&scene, &self.library, recipe, &Unwatched).expect("not cancelled");
        let inspected = Inspected {
            subject: &Subject::of_scene("simulated frame".into(), "simulated".into(), true),
            scene: &scene,
            inspection: &inspection,
            recipe,
            robot: Some(&self.finder.robot),
            is_forced: false,
            on_line: None,
        };
        let mut found = self.finder.found(&inspected, captured);
        found.report = inspected.line(&Traceability::default());
        found.into()
    }
}

/// The same inspections, run on the server's thread.
struct ServedInspections {
    inspections: Arc<Inspections>,
    num_inspected: Arc<AtomicU64>,
    is_ending: Arc<AtomicBool>,
}

impl Inspector for ServedInspections {
    fn inspect(&mut self, _asked: &Asked) -> FrameParts {
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
pub(super) struct ServedProtocol {
    pub(super) name: &'static str,
    address: SocketAddr,
    framing: Framing,
    pub(super) status: Vec<u8>,
    pub(super) trigger: Vec<u8>,
}

impl ServedProtocol {
    fn of(at: ListenAddress) -> Self {
        let lines = || [b"STATUS\n".to_vec(), b"TRIGGER\n".to_vec()];
        let element =
            |word: &str| format!("<Robot><Request>{word}</Request><Point>0</Point></Robot>");
        let (framing, [status, trigger]) = match at.protocol {
            Protocol::Ascii | Protocol::UrScript => (Framing::Line, lines()),
            Protocol::Binary(order) => {
                let frames = [Request::Status, Request::TRIGGER];
                let frames = frames.map(|request| binary_request(&request, order));
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

    pub(super) fn connect(&self) -> anyhow::Result<Client> {
        Client::connect(self.address, self.framing)
            .with_context(|| format!("cannot connect to {}", self.name))
    }

    pub(super) fn busy_rate(
        &self,
        num_connections: usize,
        request: &[u8],
        num_each: usize,
    ) -> anyhow::Result<f64> {
        let connect = || Client::connect(self.address, self.framing);
        busy_rate(connect, num_connections, request, num_each)
            .with_context(|| format!("{} gave no answer", self.name))
    }
}

/// A running server; dropping it stops it.
pub(super) struct Service {
    pub(super) protocols: Vec<ServedProtocol>,
    num_inspected: Arc<AtomicU64>,
    is_ending: Arc<AtomicBool>,
    _http: Option<HttpServer>,
    thread: Option<JoinHandle<()>>,
}

impl Service {
    pub(super) fn start(inspections: &Arc<Inspections>) -> anyhow::Result<Self> {
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
        let http = http::start(server.handle())?;
        let protocols = server.addresses().iter().map(|at| ServedProtocol::of(*at));
        let over_http = http
            .as_ref()
            .map(|http| ServedProtocol::http(http.address()));
        let protocols = protocols.chain(over_http);
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
            _http: http,
            thread: Some(thread),
        })
    }

    /// Returns the number of inspections since the start.
    pub(super) fn num_inspected(&self) -> u64 {
        self.num_inspected.load(Ordering::SeqCst)
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
