//! Paths and their handlers.

use std::sync::Arc;

use axum::{
    Router,
    body::Bytes,
    extract::State,
    http::{
        HeaderValue, StatusCode, Uri,
        header::{CACHE_CONTROL, CONTENT_TYPE, WWW_AUTHENTICATE},
    },
    response::{IntoResponse as _, Response},
    routing::{get, post},
};
use serde::Serialize;
use tokio::task::spawn_blocking;

use super::{
    access::Tokens,
    body::{AnswerBody, FrameBody, HealthBody, PathBody, ReportBody, StatusBody, TriggerBody},
    metrics, openapi,
    refusal::Refusal,
};
use geometry::error::guarded;
use robot::Convention;
use serve::{Answer, Problem, ServerHandle, VerdictCode};

/// The only path that needs no token.
pub(super) const HEALTH: &str = "/v1/healthz";

/// What every handler needs.
pub(super) struct Api {
    pub(super) server: ServerHandle,
    pub(super) convention: Convention,
    pub(super) tokens: Tokens,
    /// `http` or `https`.
    pub(super) protocol: &'static str,
}

impl Api {
    /// Runs a handler; a panic becomes an error response.
    fn answered(&self, work: impl FnOnce(&Self) -> Response) -> Response {
        guarded(|| work(self)).unwrap_or_else(|fault| {
            let problem = Problem::of("fault", &fault);
            self.without_inspection(
                StatusCode::INTERNAL_SERVER_ERROR,
                VerdictCode::Error,
                problem,
            )
        })
    }

    pub(super) fn refuse(&self, refusal: Refusal) -> Response {
        let problem = Problem::of(refusal.reason(), &refusal);
        let mut response =
            self.without_inspection(refusal.status(), VerdictCode::BadRequest, problem);
        if let Refusal::WrongToken = refusal {
            let scheme = HeaderValue::from_static("Bearer");
            response.headers_mut().insert(WWW_AUTHENTICATE, scheme);
        }
        response
    }

    fn without_inspection(
        &self,
        status: StatusCode,
        verdict: VerdictCode,
        problem: Problem,
    ) -> Response {
        let body = AnswerBody::without_inspection(verdict, self.server.boot(), problem);
        json(status, &body)
    }

    /// A response with these answers, one at least.
    fn ok(&self, answers: &[Answer]) -> Response {
        json(StatusCode::OK, &FrameBody::of(answers, self.convention))
    }

    /// The response to a trigger: a success if something was inspected, whatever the verdict.
    fn triggered(&self, answers: &[Answer]) -> Response {
        let mut response = self.ok(answers);
        if matches!(answers[0].verdict, VerdictCode::Error | VerdictCode::Full) {
            *response.status_mut() = StatusCode::SERVICE_UNAVAILABLE;
        }
        response
    }
}

pub(super) fn router(api: Arc<Api>) -> Router {
    Router::new()
        .route("/v1/trigger", post(trigger))
        .route("/v1/status", get(status))
        .route("/v1/last", get(last))
        .route("/v1/path", get(path))
        .route("/v1/report", get(report))
        .route(HEALTH, get(health))
        .route("/v1/metrics", get(metrics))
        .route("/v1/openapi.json", get(description))
        .fallback(no_such_path)
        .method_not_allowed_fallback(wrong_method)
        .with_state(api)
}

async fn trigger(State(api): State<Arc<Api>>, body: Bytes) -> Response {
    let Some(request) = TriggerBody::request_in(&body) else {
        return api.refuse(Refusal::BadBody);
    };
    let Some(slot) = api.server.slot() else {
        return api.answered(|api| api.triggered(&[api.server.full()]));
    };
    // If the client hangs up, this future is dropped. An inspection that has begun continues, and holds its place until it is
    // done.
    let waits = Arc::new(());
    let waiting = Arc::downgrade(&waits);
    let work = spawn_blocking(move || {
        let is_withdrawn = move || waiting.strong_count() == 0;
        let response =
            api.answered(|api| api.triggered(&api.server.trigger(&request, is_withdrawn)));
        drop(slot);
        response
    });
    // It fails only if the runtime is shutting down.
    let ending = StatusCode::SERVICE_UNAVAILABLE;
    let response = work.await.unwrap_or_else(|_| ending.into_response());
    drop(waits);
    response
}

async fn status(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| {
        let answer = api.server.status();
        let body = StatusBody {
            answer: AnswerBody::of(&answer, api.convention),
            library: api.server.library(),
        };
        json(StatusCode::OK, &body)
    })
}

async fn last(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| api.ok(&api.server.last()))
}

/// The sequence number in the query of a request, if there is one.
fn sequence_in(uri: &Uri) -> Option<u32> {
    let mut pairs = uri.query()?.split('&');
    let number = pairs.find_map(|pair| pair.strip_prefix("sequence="))?;
    number.parse().ok()
}

async fn path(State(api): State<Arc<Api>>, uri: Uri) -> Response {
    let sequence = sequence_in(&uri);
    api.answered(|api| {
        let Some(sequence) = sequence else {
            return api.refuse(Refusal::NoSequence);
        };
        let (answer, path) = api.server.path(sequence);
        if answer.verdict == VerdictCode::BadRequest {
            let body = AnswerBody::of(&answer, api.convention);
            return json(StatusCode::NOT_FOUND, &body);
        }
        json(
            StatusCode::OK,
            &PathBody::of(&answer, &path, api.convention),
        )
    })
}

async fn report(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| {
        let (answers, report) = api.server.report();
        let frame = FrameBody::of(&answers, api.convention);
        json(StatusCode::OK, &ReportBody { frame, report })
    })
}

async fn health(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| {
        let body = HealthBody {
            boot: api.server.boot(),
            camera: api.server.status().camera,
        };
        json(StatusCode::OK, &body)
    })
}

async fn metrics(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| {
        let status = api.server.status();
        let server = &api.server;
        let text = metrics::text(
            &server.tally(),
            &status,
            server.num_clients(),
            server.library().as_ref(),
        );
        written(StatusCode::OK, metrics::MEDIA_TYPE, text)
    })
}

async fn description(State(api): State<Arc<Api>>) -> Response {
    api.answered(|api| json(StatusCode::OK, &openapi::document(!api.tokens.is_empty())))
}

async fn no_such_path(State(api): State<Arc<Api>>) -> Response {
    api.refuse(Refusal::NoSuchPath)
}

async fn wrong_method(State(api): State<Arc<Api>>) -> Response {
    api.refuse(Refusal::WrongMethod)
}

fn json(status: StatusCode, body: &impl Serialize) -> Response {
    let text = serde_json::to_string(body).expect("numbers and text have a JSON form");
    written(status, "application/json", text)
}

/// Writes a response that must not be cached: a pose is valid only for a short time.
fn written(status: StatusCode, media: &'static str, text: String) -> Response {
    let head = [(CONTENT_TYPE, media), (CACHE_CONTROL, "no-store")];
    (status, head, text).into_response()
}
