//! The published `OpenAPI` 3.1 description, with schemas generated from the types that are written.

use axum::http::StatusCode;
use schemars::{JsonSchema, generate::SchemaSettings};
use serde_json::{Map, Value, json};

use super::{
    body::{AnswerBody, FrameBody, HealthBody, PathBody, ReportBody, StatusBody, TriggerBody},
    metrics,
};

const JSON: &str = "application/json";

/// Builds the description. `has_tokens`: clients have to send a token.
pub(super) fn document(has_tokens: bool) -> Value {
    let mut settings = SchemaSettings::draft2020_12().for_serialize();
    settings.definitions_path = "/components/schemas".into();
    let mut generator = settings.into_generator();
    let answer = schema_of::<AnswerBody>(&mut generator);
    let body = schema_of::<TriggerBody>(&mut generator);
    let frame = schema_of::<FrameBody>(&mut generator);
    let status = schema_of::<StatusBody>(&mut generator);
    let path = schema_of::<PathBody>(&mut generator);
    let report = schema_of::<ReportBody>(&mut generator);
    let health = schema_of::<HealthBody>(&mut generator);
    let operation = |summary: &str, media: &str, schema: &Value, refused: &[StatusCode]| {
        let refusals = refused.iter().map(|status| {
            let why = status.canonical_reason().unwrap_or_default();
            let response = described(why, JSON, &answer);
            (status.as_str().to_owned(), response)
        });
        let mut responses: Map<String, Value> = refusals.collect();
        responses.insert("200".into(), described("The answer", media, schema));
        json!({ "summary": summary, "responses": responses })
    };
    let refused = [
        StatusCode::UNAUTHORIZED,
        StatusCode::FORBIDDEN,
        StatusCode::REQUEST_TIMEOUT,
        StatusCode::PAYLOAD_TOO_LARGE,
        StatusCode::INTERNAL_SERVER_ERROR,
    ];
    let get = |summary: &str, media: &str, schema: &Value| json!({ "get": operation(summary, media, schema, &refused) });
    let text = json!({ "type": "string" });
    let mut trigger = operation(
        "Take a frame that is captured from now on, and inspect it",
        JSON,
        &frame,
        &[
            &refused[..],
            &[StatusCode::BAD_REQUEST, StatusCode::SERVICE_UNAVAILABLE],
        ]
        .concat(),
    );
    let without = StatusCode::SERVICE_UNAVAILABLE;
    let why = without.canonical_reason().unwrap_or_default();
    trigger["responses"][without.as_str()] = described(why, JSON, &frame);
    trigger["requestBody"] = json!({ "content": { JSON: { "schema": body } } });
    let mut path = operation(
        "The inspection with this sequence number, with every point of the part's spray path",
        JSON,
        &path,
        &[
            &refused[..],
            &[StatusCode::BAD_REQUEST, StatusCode::NOT_FOUND],
        ]
        .concat(),
    );
    path["parameters"] = json!([{
        "name": "sequence",
        "in": "query",
        "required": true,
        "description": "Of the answer to the client's trigger",
        "schema": { "type": "integer", "minimum": 1 },
    }]);
    let mut health = operation(
        "Whether the service answers; needs no token",
        JSON,
        &health,
        &refused[2..],
    );
    health["security"] = json!([]);
    let security = if has_tokens {
        json!([{ "token": [] }])
    } else {
        json!([])
    };
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "Partsight",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "Which car body part hangs before the camera, and where. Fields are only ever added.",
        },
        "security": security,
        "paths": {
            "/v1/trigger": { "post": trigger },
            "/v1/status": get("How camera and library are, and the last verdict without its numbers", JSON, &status),
            "/v1/last": get("The last inspection again", JSON, &frame),
            "/v1/path": { "get": path },
            "/v1/report": get("The last inspection with its line of JSON", JSON, &report),
            "/v1/healthz": { "get": health },
            "/v1/metrics": get("Counts and states for Prometheus", metrics::MEDIA_TYPE, &text),
            "/v1/openapi.json": get("This description", JSON, &json!({ "type": "object" })),
        },
        "components": {
            "schemas": generator.take_definitions(true),
            "securitySchemes": { "token": { "type": "http", "scheme": "bearer" } },
        },
    })
}

fn schema_of<T: JsonSchema>(generator: &mut schemars::SchemaGenerator) -> Value {
    generator.subschema_for::<T>().to_value()
}

fn described(what: &str, media: &str, schema: &Value) -> Value {
    json!({ "description": what, "content": { media: { "schema": schema } } })
}
