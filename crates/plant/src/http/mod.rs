//! HTTP with JSON: the same inspections and answers as the line protocols, for programs.
//!
//! ```text
//! TcpStream ─► TLS ─► connection ─► access ─► routes ─► ServerHandle
//!                     limits        token     axum
//! ```
//!
//! A current-thread runtime on its own thread serves all connections. A trigger blocks: it waits on a thread of the
//! runtime's pool and holds one of the server's client places. All other requests are answered at once.
//!
//! A client without a token costs a bounded amount of memory and time: head, body, connections and waiting times are
//! limited, and if there are too many connections, the oldest without a token is dropped. HTTP/1.1 only.
//!
//! `docs/guide/http.md` describes the interface for users, `GET /v1/openapi.json` for programs.

mod access;
mod body;
mod connection;
mod error;
mod metrics;
mod openapi;
mod refusal;
mod routes;
mod server;
mod tls;

pub use self::{
    access::Tokens,
    error::HttpError,
    server::{HttpServer, HttpSettings, TokenInTheOpen},
    tls::Tls,
};
