//! How the store's client speaks HTTP: over hyper and rustls, as the rest of the program does.

use std::{fmt, time::Duration};

use async_trait::async_trait;
use http_body_util::{BodyExt as _, Collected, Limited};
use hyper::{Response, StatusCode, body::Incoming};
use hyper_rustls::{HttpsConnector, HttpsConnectorBuilder};
use hyper_util::{
    client::legacy::{Client, connect::HttpConnector as TcpConnector},
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

use super::store_error::StoreError;
use crate::credentials::{client_config, system_roots};

/// How long a connection may take to open.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);
/// How long an answer may take to begin, beside the time that it takes to send the request.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(30);
/// The slowest network that bundles go over, in bytes per second.
const SLOWEST: u64 = 1 << 16;
/// The largest answer that is read for the code of an error, in bytes.
const MAX_ERROR_BYTES: usize = 1 << 16;
/// Where a machine in Amazon's cloud gets its credentials, if the environment has none.
const CREDENTIALS_HOST: &str = "169.254.169.254";

/// How long a request may take that transfers this number of bytes.
pub(super) fn patience(bytes: u64) -> Duration {
    ANSWER_TIMEOUT + Duration::from_secs(bytes / SLOWEST)
}

/// Makes clients for HTTPS, and for HTTP if `AWS_ALLOW_HTTP` permits it.
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
        let mut tcp = TcpConnector::new();
        // The connector around it opens both.
        tcp.enforce_http(false);
        tcp.set_connect_timeout(Some(CONNECT_TIMEOUT));
        let client = Client::builder(TokioExecutor::new());
        let https = HttpsConnectorBuilder::new().with_tls_config(config);
        // The service refuses what is not allowed: its error is in words.
        let client = client.build(https.https_or_http().enable_http1().wrap_connector(tcp));
        Ok(HttpClient::new(Service {
            client,
            is_http_allowed,
        }))
    }
}

struct Service {
    client: Client<HttpsConnector<TcpConnector>, HttpRequestBody>,
    is_http_allowed: bool,
}

impl fmt::Debug for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Service")
    }
}

#[async_trait]
impl HttpService for Service {
    async fn call(&self, request: HttpRequest) -> Result<HttpResponse, HttpError> {
        let uri = request.uri();
        if uri.scheme_str() == Some("http") && !self.is_http_allowed {
            let error = StoreError::Unencrypted;
            return Err(HttpError::new(HttpErrorKind::Unknown, error));
        }
        let host = uri.authority().map(ToString::to_string).unwrap_or_default();
        let is_for_credentials = uri.host() == Some(CREDENTIALS_HOST);
        let answer = self.send(request, &host).await;
        if !is_for_credentials {
            return in_words(answer?, host).await;
        }
        match answer {
            Ok(answer) if answer.status() != StatusCode::NOT_FOUND => Ok(passed_on(answer, host)),
            // Not tried again: whoever has set no credentials waits for a message.
            _ => Err(HttpError::new(
                HttpErrorKind::Unknown,
                StoreError::NoCredentials,
            )),
        }
    }
}

impl Service {
    async fn send(
        &self,
        request: HttpRequest,
        host: &str,
    ) -> Result<Response<Incoming>, HttpError> {
        let patience = patience(request.body().content_length() as u64);
        let answer = timeout(patience, self.client.request(request)).await;
        let answer = answer.map_err(|late| HttpError::new(HttpErrorKind::Timeout, late))?;
        answer.map_err(|error| {
            let kind = if error.is_connect() {
                HttpErrorKind::Connect
            } else {
                HttpErrorKind::Interrupted
            };
            HttpError::new(kind, StoreError::of_connection(host, &error))
        })
    }
}

/// The answer, or an error in words where the client has none of its own.
async fn in_words(answer: Response<Incoming>, host: String) -> Result<HttpResponse, HttpError> {
    if answer.status().is_success() {
        return Ok(passed_on(answer, host));
    }
    let (head, body) = answer.into_parts();
    // What cannot be read of it says no more than the status.
    let body = Limited::new(body, MAX_ERROR_BYTES).collect().await;
    let body = body.map(Collected::to_bytes).unwrap_or_default();
    match StoreError::of_answer(head.status, &body) {
        // The client tries again.
        Some(error) if head.status.is_server_error() => {
            Err(HttpError::new(HttpErrorKind::Request, error))
        }
        Some(error) => Err(HttpError::new(HttpErrorKind::Unknown, error)),
        None => Ok(HttpResponse::from_parts(head, body.into())),
    }
}

fn passed_on(answer: Response<Incoming>, host: String) -> HttpResponse {
    let (head, body) = answer.into_parts();
    let broken = move |error: hyper::Error| {
        let error = StoreError::of_connection(&host, &error);
        HttpError::new(HttpErrorKind::Interrupted, error)
    };
    HttpResponse::from_parts(head, HttpResponseBody::new(body.map_err(broken)))
}
