//! HTTP with JSON: the same inspections and answers as the line protocols, for programs.
//!
//! ```text
//! TcpStream ─► TLS ─► connection ─► access ─► routes ─► ServerHandle
//!                     limits        token     axum
//! ```
//!
//! A current-thread runtime on a thread of its own serves all connections. Triggers block, so each waits on a thread of the
//! runtime's pool and holds one of the server's places meanwhile. Everything else is answered at once.
//!
//! Whoever has not shown a token yet costs a bounded amount of memory and time: head, body, connections and waiting times are
//! limited, and of more connections than are allowed the oldest without a token makes room. HTTP/1.1 only.
//!
//! `docs/guide/robots_that_ask.md` describes it for users, `GET /v1/openapi.json` for programs.

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
