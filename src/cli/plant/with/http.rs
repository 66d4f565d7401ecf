//! HTTP options of `partsight serve`.

use std::{net::SocketAddr, path::PathBuf};

use clap::Args;

use crate::cli::console::{Advised as _, Console, with_advice};
use plant::http::{HttpError, HttpServer, HttpSettings, Tls, Tokens};
use robot::Convention;
use serve::{ServerHandle, parse_address};

#[derive(Debug, Args)]
pub(crate) struct HttpArgs {
    /// Answer HTTP requests, with JSON: a port, or IP address and port; poses in the convention of --as. Other protocols are
    /// answered only with --listen
    #[arg(long, value_name = "[IP:]PORT", value_parser = parse_http)]
    http: Option<SocketAddr>,
    /// File with tokens, one per line, one of which an HTTP client must send; needed with an IP address that other
    /// computers can reach
    #[arg(long, value_name = "FILE", requires = "http")]
    http_token_file: Option<PathBuf>,
    /// PEM file with the HTTPS certificate and its chain
    #[arg(long, value_name = "FILE", requires_all = ["http", "http_key"])]
    http_cert: Option<PathBuf>,
    /// PEM file with the certificate's private key
    #[arg(long, value_name = "FILE", requires = "http_cert")]
    http_key: Option<PathBuf>,
}

fn parse_http(text: &str) -> Result<SocketAddr, String> {
    parse_address(text).map_err(|error| with_advice(&error))
}

impl HttpArgs {
    /// True if HTTP is requested.
    pub(crate) fn is_wanted(&self) -> bool {
        self.http.is_some()
    }

    /// Returns the HTTP settings, if HTTP is requested; reads the files.
    pub(super) fn settings(
        &self,
        convention: Option<Convention>,
    ) -> anyhow::Result<Option<HttpSettings>> {
        let Some(address) = self.http else {
            return Ok(None);
        };
        let convention = convention.ok_or(HttpError::NoConvention).advised()?;
        let tokens = match &self.http_token_file {
            Some(path) => Tokens::load(path).advised()?,
            None => Tokens::default(),
        };
        let files = self.http_cert.as_ref().zip(self.http_key.as_ref());
        let tls = files.map(|(certificate, key)| Tls::load(certificate, key).advised());
        Ok(Some(HttpSettings {
            address,
            convention,
            tokens,
            tls: tls.transpose()?,
        }))
    }
}

/// Serves HTTP, if requested, and shows its address.
pub(super) fn start(
    settings: Option<HttpSettings>,
    server: ServerHandle,
    console: &Console,
) -> anyhow::Result<Option<HttpServer>> {
    let Some(settings) = settings else {
        return Ok(None);
    };
    let convention = settings.convention.title();
    let doubt = settings.doubt();
    let http = HttpServer::start(settings, server).advised()?;
    console.note(&format_args!(
        "Listening: {}, poses as {convention}",
        http.url()
    ));
    if let Some(doubt) = doubt {
        console.warn(&doubt, &doubt);
    }
    Ok(Some(http))
}
