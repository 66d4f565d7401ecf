//! One connection: serves its requests one after the other, within limits.

use std::{
    convert::Infallible,
    future::poll_fn,
    io,
    net::SocketAddr,
    pin::Pin,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use axum::{
    Router,
    body::{Body, Bytes, HttpBody as _, to_bytes},
    http::Request,
    response::Response,
};
use hyper::{
    body::Incoming,
    server::conn::http1,
    service::{Service as _, service_fn},
};
use hyper_util::{
    rt::{TokioIo, TokioTimer},
    service::TowerToHyperService,
};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _},
    net::TcpStream,
    select,
    sync::watch,
    time::{interval, timeout},
};

use super::{
    refusal::{MAX_BODY_BYTES, Refusal},
    routes::{Api, HEALTH},
    tls::Tls,
};
use geometry::{clock, error::lock};
use serve::ClientNews;

/// Maximum size of a request head, bytes, and of a connection's read buffer; hyper's minimum is 8 KiB.
const MAX_HEAD_BYTES: usize = 16 * 1024;
/// Maximum number of header fields.
const MAX_HEAD_FIELDS: usize = 64;
/// How long a client may take to accept its answer before it is disconnected.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);
/// How often that is checked.
const POLL_INTERVAL: Duration = Duration::from_secs(1);
/// How long the remaining input is read and discarded before the connection is closed.
pub(super) const LINGER: Duration = Duration::from_secs(1);

/// State shared by all connections.
#[derive(Clone)]
pub(super) struct Service {
    pub(super) api: Arc<Api>,
    pub(super) router: TowerToHyperService<Router>,
    pub(super) tls: Option<Tls>,
    /// Its sender is dropped when the service ends.
    pub(super) stopping: watch::Receiver<()>,
}

/// State of one connection.
pub(super) struct ConnectionState {
    pub(super) peer: SocketAddr,
    /// True once one of its requests passed the token check.
    is_known: AtomicBool,
    /// When the last answer was ready; `None` while a request is being answered.
    answered: Mutex<Option<Instant>>,
}

impl ConnectionState {
    pub(super) fn new(peer: SocketAddr) -> Self {
        Self {
            peer,
            is_known: AtomicBool::new(false),
            answered: Mutex::new(Some(Instant::now())),
        }
    }

    pub(super) fn is_known(&self) -> bool {
        self.is_known.load(Ordering::SeqCst)
    }

    /// True if only an answer that the client does not accept can still keep the connection open.
    fn is_stuck(&self, request_timeout: Duration) -> bool {
        lock(&self.answered).is_some_and(|at| at.elapsed() > request_timeout + WRITE_TIMEOUT)
    }
}

impl Service {
    /// Serves the connection until the client hangs up or is silent for too long, or the service ends.
    pub(super) async fn serve(self, stream: TcpStream, state: Arc<ConnectionState>) {
        // If this fails, answers only come a little later.
        let _ = stream.set_nodelay(true);
        let Some(tls) = &self.tls else {
            return self.talk(stream, state).await;
        };
        let limit = self.api.server.settings().request_timeout;
        let agreed = timeout(limit, tls.acceptor.accept(stream)).await;
        if let Ok(Ok(stream)) = agreed {
            self.talk(stream, state).await;
        }
    }

    async fn talk<S>(self, stream: S, state: Arc<ConnectionState>)
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        let request_timeout = self.api.server.settings().request_timeout;
        let mut stopping = self.stopping.clone();
        let seen = Arc::clone(&state);
        let service = service_fn(move |request| {
            let (service, state) = (self.clone(), Arc::clone(&seen));
            let answer: Pin<Box<dyn Future<Output = _> + Send>> = Box::pin(async move {
                *lock(&state.answered) = None;
                let response = service.respond(request, &state).await;
                *lock(&state.answered) = Some(Instant::now());
                Ok::<Response, Infallible>(response)
            });
            answer
        });
        let mut connection = http1::Builder::new()
            .timer(TokioTimer::new())
            // Beyond the year 9999 there is no date to send.
            .auto_date_header(clock::now() < clock::LAST)
            // Runs from the previous answer, and thus also limits how long a connection may be idle.
            .header_read_timeout(request_timeout)
            .max_buf_size(MAX_HEAD_BYTES)
            .max_headers(MAX_HEAD_FIELDS)
            .serve_connection(TokioIo::new(stream), service);
        let mut poll = interval(POLL_INTERVAL);
        let mut is_stopping = false;
        loop {
            select! {
                over = poll_fn(|cx| connection.poll_without_shutdown(cx)) => {
                    // A broken connection counts as ended.
                    drop(over);
                    break;
                }
                _ = stopping.changed(), if !is_stopping => {
                    is_stopping = true;
                    Pin::new(&mut connection).graceful_shutdown();
                }
                _ = poll.tick() => {
                    if state.is_stuck(request_timeout) {
                        return;
                    }
                }
            }
        }
        // Closing a socket with unread bytes resets the connection, and the client might lose its answer.
        let mut stream = connection.into_parts().io.into_inner();
        let read_over = async {
            stream.shutdown().await?;
            let mut chunk = [0; 4096];
            while stream.read(&mut chunk).await? > 0 {}
            Ok::<(), io::Error>(())
        };
        let _ = timeout(LINGER, read_over).await;
    }

    async fn respond(&self, request: Request<Incoming>, state: &ConnectionState) -> Response {
        let api = &self.api;
        let (head, body) = request.into_parts();
        if head.uri.path() != HEALTH {
            if let Err(refusal) = api.tokens.check(&head.headers) {
                if let Refusal::WrongToken = refusal {
                    let server = &api.server;
                    server.tell(state.peer, api.protocol, ClientNews::WrongToken);
                }
                return api.refuse(refusal);
            }
            state.is_known.store(true, Ordering::SeqCst);
        }
        let body = match self.read(body).await {
            Ok(body) => body,
            Err(refusal) => return api.refuse(refusal),
        };
        let request = Request::from_parts(head, Body::from(body));
        let Ok(response) = self.router.call(request).await;
        response
    }

    /// Reads the body, also of a request that needs none, to get to the next request.
    async fn read(&self, body: Incoming) -> Result<Bytes, Refusal> {
        if body.size_hint().lower() > MAX_BODY_BYTES as u64 {
            return Err(Refusal::TooLong);
        }
        let limit = self.api.server.settings().request_timeout;
        let read = timeout(limit, to_bytes(Body::new(body), MAX_BODY_BYTES)).await;
        match read {
            Ok(Ok(body)) => Ok(body),
            Ok(Err(_)) => Err(Refusal::TooLong),
            Err(_) => Err(Refusal::Incomplete {
                seconds: limit.as_secs(),
            }),
        }
    }
}
