//! HTTP beside the other protocols, in builds with the feature `plant`.

use serve::ServerHandle;

#[cfg(feature = "plant")]
pub(super) use plant::http::HttpServer;

/// Starts to answer at any port.
#[cfg(feature = "plant")]
pub(super) fn start(server: ServerHandle) -> anyhow::Result<Option<HttpServer>> {
    use partsight::cli::console::Advised as _;
    use plant::http::{HttpSettings, Tokens};
    use robot::Convention;
    use serve::parse_address;

    let settings = HttpSettings {
        address: parse_address("0").advised()?,
        convention: Convention::Kuka,
        tokens: Tokens::default(),
        tls: None,
    };
    HttpServer::start(settings, server).advised().map(Some)
}

/// A server that does not exist.
#[cfg(not(feature = "plant"))]
pub(super) enum HttpServer {}

#[cfg(not(feature = "plant"))]
impl HttpServer {
    pub(super) fn address(&self) -> std::net::SocketAddr {
        match *self {}
    }
}

/// Starts nothing.
#[cfg(not(feature = "plant"))]
#[expect(clippy::unnecessary_wraps, reason = "with the feature, it may fail")]
pub(super) fn start(_: ServerHandle) -> anyhow::Result<Option<HttpServer>> {
    Ok(None)
}
