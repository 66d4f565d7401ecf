//! Counts and states in Prometheus' text format.
//!
//! Source: Prometheus, *Exposition formats*, text-based format 0.0.4.

use std::fmt::Write as _;

use serve::{Answer, CameraState, LibraryStatus, Tally};

/// Media type of the text format.
pub(super) const MEDIA_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

const CAMERA_STATES: [CameraState; 4] = [
    CameraState::Opening,
    CameraState::Running,
    CameraState::Lost,
    CameraState::Over,
];

/// Writes all metrics. `status` is the answer to a status request; `library` is known if new versions of it are taken.
pub(super) fn text(
    tally: &Tally,
    status: &Answer,
    num_clients: usize,
    library: Option<&LibraryStatus>,
) -> String {
    let mut text = Text::default();
    text.head(
        "inspections_total",
        "counter",
        "Inspected parts since the start, by verdict",
    );
    for (verdict, count) in tally.by_verdict() {
        text.value(
            "inspections_total",
            Some(("verdict", verdict.name())),
            count as f64,
        );
    }
    text.head(
        "trigger_seconds",
        "histogram",
        "Time from a trigger to its verdict, with the wait for others and for the frame",
    );
    for (bound, count) in tally.waited_within() {
        text.value(
            "trigger_seconds_bucket",
            Some(("le", &bound.to_string())),
            count as f64,
        );
    }
    let count = tally.num_triggers() as f64;
    text.value("trigger_seconds_bucket", Some(("le", "+Inf")), count);
    text.value("trigger_seconds_sum", None, tally.waited_s());
    text.value("trigger_seconds_count", None, count);
    text.gauge(
        "last_frame_age_seconds",
        "Age of the last inspected frame",
        status.age_ms.map(|age| f64::from(age) / 1000.0),
    );
    text.head(
        "camera_state",
        "gauge",
        "1 for the state in which the camera is",
    );
    for state in CAMERA_STATES {
        let is_now = f64::from(u8::from(state == status.camera));
        text.value("camera_state", Some(("state", state.name())), is_now);
    }
    text.gauge(
        "clients",
        "Connections of the line protocols, and triggers over HTTP that wait",
        Some(num_clients as f64),
    );
    text.gauge(
        "boot_number",
        "The number of this start of the server",
        Some(f64::from(status.boot)),
    );
    if let Some(library) = library {
        text.gauge(
            "library_version",
            "The version of the library in use",
            library.version.map(f64::from),
        );
        text.gauge(
            "library_take_failed",
            "1 if a newer version of the library could not be taken or used",
            Some(f64::from(u8::from(library.problem.is_some()))),
        );
    }
    text.0
}

#[derive(Default)]
struct Text(String);

impl Text {
    fn head(&mut self, name: &str, kind: &str, help: &str) {
        let lines = format!("# HELP partsight_{name} {help}\n# TYPE partsight_{name} {kind}\n");
        self.0.push_str(&lines);
    }

    /// Writes a gauge without labels; `None` leaves out its value.
    fn gauge(&mut self, name: &str, help: &str, value: Option<f64>) {
        self.head(name, "gauge", help);
        if let Some(value) = value {
            self.value(name, None, value);
        }
    }

    fn value(&mut self, name: &str, label: Option<(&str, &str)>, value: f64) {
        let label = label.map(|(name, value)| format!("{{{name}=\"{value}\"}}"));
        let label = label.unwrap_or_default();
        writeln!(self.0, "partsight_{name}{label} {value}").expect("a string takes everything");
    }
}
