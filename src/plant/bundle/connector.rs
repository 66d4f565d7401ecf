//! How the store's client speaks HTTP: over hyper and rustls, as the rest of the program does.

use std::{fmt, io, time::Duration};

use async_trait::async_trait;
use http_body_util::BodyExt as _;
use hyper_rustls::{HttpsConnector, HttpsConnectorBuilder};
use hyper_util::{
    client::legacy::{self, Client, connect::HttpConnector as TcpConnector},
    rt::TokioExecutor,
};
use object_store::{
    ClientConfigKey, ClientOptions,
    client::{
        HttpClient, HttpConnector, HttpError, HttpErrorKind, HttpRequest, HttpRequestBody,
        HttpResponse, HttpResponseBody, HttpService,
    },
};
use tokio::time::timeout;

use crate::plant::credentials::{client_config, system_roots};

/// How long a connection may take to open.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);
/// How long an answer may take to begin, beside the time that it takes to send the request.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(30);
/// The slowest network that bundles go over, in bytes per second.
const SLOWEST: u64 = 1 << 16;

/// How long so many bytes may take.
pub(super) fn patience(bytes: u64) -> Duration {
    ANSWER_TIMEOUT + Duration::from_secs(bytes / SLOWEST)
}

/// Makes clients over HTTPS, or over HTTP too where `AWS_ALLOW_HTTP` says so.
#[derive(Debug)]
pub(super) struct Connector;

impl HttpConnector for Connector {
    fn connect(&self, options: &ClientOptions) -> object_store::Result<HttpClient> {
        let config =
            client_config(system_roots()).map_err(|error| object_store::Error::Generic {
                store: "HTTP client",
                source: Box::new(error),
            })?;
        let allowed = options.get_config_value(&ClientConfigKey::AllowHttp);
        let is_http_allowed = allowed.is_some_and(|value| {
            let yes = ["1", "true", "on", "yes", "y"];
            yes.contains(&value.to_lowercase().as_str())
        });
        let https = HttpsConnectorBuilder::new().with_tls_config(config);
        let https = if is_http_allowed {
            https.https_or_http()
        } else {
            https.https_only()
        };
        let mut tcp = TcpConnector::new();
        // The one around it says which of both are allowed.
        tcp.enforce_http(false);
        tcp.set_connect_timeout(Some(CONNECT_TIMEOUT));
        let client = Client::builder(TokioExecutor::new());
        let client = client.build(https.enable_http1().wrap_connector(tcp));
        Ok(HttpClient::new(Service { client }))
    }
}

struct Service {
    client: Client<HttpsConnector<TcpConnector>, HttpRequestBody>,
}

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Service")
    }
}

#[async_trait]
impl HttpService for Service {
    async fn call(&self, request: HttpRequest) -> Result<HttpResponse, HttpError> {
        let patience = patience(request.body().content_length() as u64);
        let answer = timeout(patience, self.client.request(request)).await;
        let answer = answer.map_err(|late| HttpError::new(HttpErrorKind::Timeout, late))?;
        let (head, body) = answer.map_err(|error| wrong(&error))?.into_parts();
        let body = body.map_err(|error| HttpError::new(HttpErrorKind::Interrupted, error));
        Ok(HttpResponse::from_parts(head, HttpResponseBody::new(body)))
    }
}

/// What went wrong, in the words of its cause: those around it say no more than that something did.
fn wrong(error: &legacy::Error) -> HttpError {
    let kind = if error.is_connect() {
        HttpErrorKind::Connect
    } else {
        HttpErrorKind::Interrupted
    };
    let mut cause: &dyn std::error::Error = error;
    while let Some(deeper) = cause.source() {
        cause = deeper;
    }
    HttpError::new(kind, io::Error::other(cause.to_string()))
}
