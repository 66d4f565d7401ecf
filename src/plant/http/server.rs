//! Takes connections and serves them until the server ends.

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
use crate::{
    error::Advice,
    robot::Convention,
    serve::{ClientNews, ServeError, ServerHandle, bound},
};

/// Connections at a time. Each costs some 50 kB with TLS.
const MAX_CONNECTIONS: usize = 256;
/// How often the listener looks whether the service ends.
const TURN: Duration = Duration::from_millis(100);
/// How long it waits when the system has no more connections.
const ACCEPT_PAUSE: Duration = Duration::from_millis(10);

/// Where and to whom HTTP is served.
pub struct HttpSettings {
    /// The address; port 0 is any free port.
    pub address: SocketAddr,
    /// The convention of poses.
    pub convention: Convention,
    /// Of which clients have to send one; without any, only this computer may be listened to.
    pub tokens: Tokens,
    /// Certificate and key; none for plain HTTP.
    pub tls: Option<Tls>,
}

impl HttpSettings {
    /// A doubt, if tokens go over the network without encryption.
    pub fn doubt(&self) -> Option<TokenInTheOpen> {
        let is_open = !self.address.ip().is_loopback() && self.tls.is_none();
        is_open.then_some(TokenInTheOpen {
            address: self.address,
        })
    }
}

/// Others than this computer may listen to what HTTP sends, the tokens included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "http={address} is open to the network without encryption: whoever listens there reads the token and the poses"
)]
pub struct TokenInTheOpen {
    address: SocketAddr,
}

impl Advice for TokenInTheOpen {
    fn advice(&self) -> String {
        "Give a certificate with --http-cert and --http-key, or use a network of the cell's own"
            .into()
    }
}

/// HTTP beside a server's listeners. It ends with the server, or when it is dropped; then it waits for its thread.
pub struct HttpServer {
    address: SocketAddr,
    protocol: &'static str,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl HttpServer {
    /// Listens, and asks that server.
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
            // Every trigger holds one of the server's places.
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
            // A trigger that still waits is answered by the server that ends, or by nobody.
            runtime.shutdown_timeout(LINGER);
        });
        Ok(Self {
            address,
            protocol,
            is_ending,
            thread: Some(thread.map_err(no_thread)?),
        })
    }

    /// Where it listens, with the port that the system chose.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where its paths begin, such as `https://127.0.0.1:30180/v1`.
    pub fn url(&self) -> String {
        format!("{}://{}/v1", self.protocol, self.address)
    }
}

impl Drop for HttpServer {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A fault of the thread has cost its connections.
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
    let mut turn = interval(TURN);
    while !is_ending.load(Ordering::SeqCst) && !service.api.server.is_stopping() {
        select! {
            accepted = listener.accept() => match accepted {
                Ok((stream, peer)) => {
                    connections.add(stream, peer, &service);
                    // Those that are open get their turn before the next: else a flood of new ones would count as silent,
                    // and good ones among them make room before they were read.
                    task::yield_now().await;
                }
                Err(_) => sleep(ACCEPT_PAUSE).await,
            },
            _ = turn.tick() => {}
        }
    }
    drop(stop);
    let all_ended = async {
        for connection in connections.0 {
            // One that was let go is over, too.
            let _ = connection.task.await;
        }
    };
    let _ = timeout(2 * LINGER, all_ended).await;
}

/// Those that are open, from the oldest to the newest.
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
