//! Accepts connections and serves them until the server ends.

use std::{
    collections::VecDeque,
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use hyper_util::service::TowerToHyperService;
use thiserror::Error;
use tokio::{
    net::{TcpListener, TcpStream},
    runtime, select,
    sync::watch,
    task,
    time::{interval, sleep, timeout},
};

use super::{
    access::Tokens,
    connection::{ConnectionState, LINGER, Service},
    error::HttpError,
    routes::{Api, router},
    tls::Tls,
};
use geometry::error::Advice;
use robot::Convention;
use serve::{ClientNews, ServeError, ServerHandle, bound};

/// Maximum number of connections. Each takes about 50 kB with TLS.
const MAX_CONNECTIONS: usize = 256;
/// How often the listener checks whether the service is ending.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Pause before the next attempt if the system has no sockets left.
const ACCEPT_PAUSE: Duration = Duration::from_millis(10);

/// Settings of the HTTP server.
pub struct HttpSettings {
    /// The address; port 0 means any free port.
    pub address: SocketAddr,
    /// The convention of poses.
    pub convention: Convention,
    /// Accepted tokens; if empty, the address has to be a loopback address.
    pub tokens: Tokens,
    /// Certificate and key for HTTPS; none for plain HTTP.
    pub tls: Option<Tls>,
}

impl HttpSettings {
    /// Returns a warning if tokens go over the network without encryption.
    pub fn doubt(&self) -> Option<TokenInTheOpen> {
        let is_open = !self.address.ip().is_loopback() && self.tls.is_none();
        is_open.then_some(TokenInTheOpen {
            address: self.address,
        })
    }
}

/// Others on the network can read what HTTP sends, including the tokens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error, Advice)]
#[error(
    "http={address} is open to the network without encryption: anyone along the network path can read the token and \
     the poses"
)]
#[advice = "Give a certificate with --http-cert and --http-key, or use a separate network for the cell"]
pub struct TokenInTheOpen {
    address: SocketAddr,
}

/// An HTTP server beside an inspection server's listeners. It ends with that server or when it is dropped, which joins its
/// thread.
pub struct HttpServer {
    address: SocketAddr,
    protocol: &'static str,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl HttpServer {
    /// Starts to listen; requests are answered by `server`.
    pub fn start(settings: HttpSettings, server: ServerHandle) -> Result<Self, HttpError> {
        let HttpSettings {
            address,
            convention,
            tokens,
            tls,
        } = settings;
        if tokens.is_empty() && !address.ip().is_loopback() {
            return Err(HttpError::OpenWithoutToken { address });
        }
        let (address, socket) = bound(address, &address, "--http")?;
        let no_thread = |source| ServeError::NoThread { source };
        let runtime = runtime::Builder::new_current_thread()
            .enable_all()
            // Every trigger holds one of the server's places, so no more threads are needed.
            .max_blocking_threads(server.settings().max_clients.max(1))
            .thread_name("http trigger")
            .build()
            .map_err(no_thread)?;
        let listener = {
            let _entered = runtime.enter();
            TcpListener::from_std(socket).map_err(no_thread)?
        };
        let protocol = if tls.is_some() { "https" } else { "http" };
        let is_ending = Arc::new(AtomicBool::new(false));
        let ending = Arc::clone(&is_ending);
        let api = Arc::new(Api {
            server,
            convention,
            tokens,
            protocol,
        });
        let thread = thread::Builder::new().name("http".into());
        let thread = thread.spawn(move || {
            runtime.block_on(listen(&listener, api, tls, &ending));
            // A trigger still waiting is answered by the ending server within this time, or not at all.
            runtime.shutdown_timeout(LINGER);
        });
        Ok(Self {
            address,
            protocol,
            is_ending,
            thread: Some(thread.map_err(no_thread)?),
        })
    }

    /// The address listened at, with the port that the system chose.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Base URL of the paths, such as `https://127.0.0.1:30180/v1`.
    pub fn url(&self) -> String {
        format!("{}://{}/v1", self.protocol, self.address)
    }
}

impl Drop for HttpServer {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has only lost its connections.
            let _ = thread.join();
        }
    }
}

async fn listen(listener: &TcpListener, api: Arc<Api>, tls: Option<Tls>, is_ending: &AtomicBool) {
    let (stop, stopping) = watch::channel(());
    let service = Service {
        router: TowerToHyperService::new(router(Arc::clone(&api))),
        api,
        tls,
        stopping,
    };
    let mut connections = Connections::default();
    let mut poll = interval(POLL_INTERVAL);
    while !is_ending.load(Ordering::SeqCst) && !service.api.server.is_stopping() {
        select! {
            accepted = listener.accept() => match accepted {
                Ok((stream, peer)) => {
                    connections.add(stream, peer, &service);
                    // Let open connections run before the next is accepted. Otherwise a flood of new ones would count as
                    // lacking a token before their requests were read, and valid ones among them would be dropped.
                    task::yield_now().await;
                }
                Err(_) => sleep(ACCEPT_PAUSE).await,
            },
            _ = poll.tick() => {}
        }
    }
    drop(stop);
    let all_ended = async {
        for connection in connections.0 {
            // An aborted task has ended too.
            let _ = connection.task.await;
        }
    };
    let _ = timeout(2 * LINGER, all_ended).await;
}

/// Open connections, from the oldest to the newest.
#[derive(Default)]
struct Connections(VecDeque<Connection>);

struct Connection {
    task: task::JoinHandle<()>,
    state: Arc<ConnectionState>,
}

impl Connections {
    fn add(&mut self, stream: TcpStream, peer: SocketAddr, service: &Service) {
        self.0.retain(|connection| !connection.task.is_finished());
        if self.0.len() >= MAX_CONNECTIONS {
            let mut states = self.0.iter().map(|connection| &connection.state);
            let unknown = states.position(|state| !state.is_known());
            let Some(unknown) = unknown.and_then(|place| self.0.remove(place)) else {
                let api = &service.api;
                api.server.tell(peer, api.protocol, ClientNews::TurnedAway);
                return;
            };
            unknown.task.abort();
        }
        let state = Arc::new(ConnectionState::new(peer));
        let task = task::spawn(service.clone().serve(stream, Arc::clone(&state)));
        self.0.push_back(Connection { task, state });
    }
}
