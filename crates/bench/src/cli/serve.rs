//! `partsight-bench serve`: the overhead of each protocol over a bare exchange of equally many bytes, and of serving
//! over a direct inspection.
//!
//! Server and clients run on this computer, so no network is measured. The compared sides take turns, so that both see
//! the computer in the same state. No camera is involved: a trigger inspects the current frame instead of waiting for
//! the next one.

mod client;
mod http;
mod service;

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use anyhow::Context as _;
use serde::Serialize;

use self::{
    client::{Client, busy_rate},
    service::{Inspections, ServedProtocol, Service},
};
use super::{FrameChoice, write_json};
use crate::suites::{MEASURING_SEED, Suite};
use geometry::statistics::quantile;
use partsight::cli::{
    Outcome,
    console::{Console, Table, advised_error},
};

/// Default number of poses per part; each frame is triggered once in every protocol.
const NUM_POSES: u64 = 25;
/// Number of status requests of each protocol over one connection, and over each of several.
const NUM_STATUS: usize = 5_000;
/// Number of requests in a row before as many bare exchanges.
const BLOCK: usize = 100;
/// Number of blocks that are not counted.
const WARM_UP: usize = 5;
/// Number of simultaneous connections.
const NUM_CONNECTIONS: usize = 4;
/// Number of triggers over each of them.
const NUM_BUSY_TRIGGERS: usize = 5;

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct ServeFile {
    schema: u32,
    simulated: bool,
    num_connections: usize,
    status: Vec<StatusTimes>,
    /// Inspections called directly.
    direct: Times,
    triggers: Vec<TriggerTimes>,
}

/// Times of requests one after the other over one connection.
#[derive(Clone, Copy, Debug, Serialize)]
struct Times {
    num: usize,
    median_ms: f64,
    p99_ms: f64,
    per_s: f64,
    /// Rate over several connections at once.
    busy_per_s: f64,
}

/// Ratios of times to those of the compared side.
#[derive(Clone, Copy, Debug, Serialize)]
struct Ratios {
    median: f64,
    p99: f64,
    per_s: f64,
    busy_per_s: f64,
}

/// Status requests of a protocol compared with bare exchanges of equally many bytes.
#[derive(Debug, Serialize)]
struct StatusTimes {
    protocol: &'static str,
    request_bytes: usize,
    answer_bytes: usize,
    times: Times,
    bare: Times,
    ratios: Ratios,
}

/// Triggers of a protocol compared with the same inspections called directly.
#[derive(Debug, Serialize)]
struct TriggerTimes {
    protocol: &'static str,
    times: Times,
    ratios: Ratios,
}

impl Times {
    fn of(times: &[Duration], busy_per_s: f64) -> Self {
        let ms = || times.iter().map(|time| time.as_secs_f64() * 1e3);
        let of = |share| quantile(ms(), share).unwrap_or(0.0);
        Self {
            num: times.len(),
            median_ms: of(0.5),
            p99_ms: of(0.99),
            per_s: times.len() as f64 * 1e3 / ms().sum::<f64>(),
            busy_per_s,
        }
    }

    fn over(&self, other: &Self) -> Ratios {
        Ratios {
            median: self.median_ms / other.median_ms,
            p99: self.p99_ms / other.p99_ms,
            per_s: self.per_s / other.per_s,
            busy_per_s: self.busy_per_s / other.busy_per_s,
        }
    }
}

pub(super) fn run(args: &FrameChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let frames = Suite::Placed.frames(
        args.poses.unwrap_or(NUM_POSES),
        args.seed.unwrap_or(MEASURING_SEED),
    );
    let inspections = Arc::new(Inspections::new()?);
    let service = Service::start(&inspections)?;
    console.line(&format_args!(
        "The server on this computer, over one connection and over {NUM_CONNECTIONS}, under its present load."
    ));
    // Before the first inspection, so that all answers have the same length.
    let status = service.protocols.iter().map(status_times);
    let status = status.collect::<anyhow::Result<Vec<_>>>()?;

    console.start_progress(frames.len());
    let mut clients = Vec::new();
    for protocol in &service.protocols {
        let mut client = protocol.connect()?;
        // The server takes a while to notice a connection.
        asked(&mut client, protocol, &protocol.status)?;
        clients.push((protocol, client, Vec::with_capacity(frames.len())));
    }
    let mut direct = Vec::with_capacity(frames.len());
    for frame in &frames {
        inspections.show(simulate::frame(frame.cell()).frame);
        // The first inspection of a frame is slower than later ones, so it is not timed.
        inspections.inspect();
        direct.push(timed(|| drop(inspections.inspect())));
        for (protocol, client, times) in &mut clients {
            times.push(asked(client, protocol, &protocol.trigger)?);
        }
        console.done();
    }
    console.end_progress();
    let num_busy = NUM_CONNECTIONS * NUM_BUSY_TRIGGERS;
    let busy = timed(|| (0..num_busy).for_each(|_| drop(inspections.inspect())));
    let direct = Times::of(&direct, num_busy as f64 / busy.as_secs_f64());
    let mut triggers = Vec::new();
    for (protocol, _, times) in &clients {
        let busy = protocol.busy_rate(NUM_CONNECTIONS, &protocol.trigger, NUM_BUSY_TRIGGERS)?;
        let times = Times::of(times, busy);
        triggers.push(TriggerTimes {
            protocol: protocol.name,
            times,
            ratios: times.over(&direct),
        });
    }
    // Including the first request of each connection.
    let of_each = frames.len() + num_busy + NUM_CONNECTIONS;
    check_triggers(&service, of_each * clients.len())?;
    show_status(&status, console);
    show_triggers(&direct, &triggers, console);
    if let Some(path) = &args.file.json {
        let file = ServeFile {
            schema: 1,
            simulated: true,
            num_connections: NUM_CONNECTIONS,
            status,
            direct,
            triggers,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

/// Checks the number of inspections: a trigger answered without one would count as a very fast one.
fn check_triggers(service: &Service, num_triggers: usize) -> anyhow::Result<()> {
    let num_inspected = service.num_inspected();
    if num_inspected == num_triggers as u64 {
        return Ok(());
    }
    Err(advised_error(
        format!("{num_triggers} triggers led to {num_inspected} inspections"),
        "Report this as a bug",
    ))
}

fn timed(work: impl FnOnce()) -> Duration {
    let begun = Instant::now();
    work();
    begun.elapsed()
}

/// Sends a request and returns the time until its answer.
fn asked(
    client: &mut Client,
    protocol: &ServedProtocol,
    request: &[u8],
) -> anyhow::Result<Duration> {
    let begun = Instant::now();
    client
        .ask(request)
        .with_context(|| format!("{} gave no answer", protocol.name))?;
    Ok(begun.elapsed())
}

fn status_times(protocol: &ServedProtocol) -> anyhow::Result<StatusTimes> {
    let request = protocol.status.as_slice();
    let mut client = protocol.connect()?;
    let answer_bytes = client.ask(request)?;
    let connect_bare = || Client::connect_bare(request.len(), answer_bytes);
    let mut bare_client = connect_bare()?;
    let (mut times, mut bare) = (Vec::new(), Vec::new());
    for block in 0..WARM_UP + NUM_STATUS / BLOCK {
        if block == WARM_UP {
            times.clear();
            bare.clear();
        }
        for (client, times) in [(&mut client, &mut times), (&mut bare_client, &mut bare)] {
            for _ in 0..BLOCK {
                times.push(asked(client, protocol, request)?);
            }
        }
    }
    let busy = protocol.busy_rate(NUM_CONNECTIONS, request, NUM_STATUS)?;
    let times = Times::of(&times, busy);
    let busy_bare = busy_rate(connect_bare, NUM_CONNECTIONS, request, NUM_STATUS)?;
    let bare = Times::of(&bare, busy_bare);
    Ok(StatusTimes {
        protocol: protocol.name,
        request_bytes: request.len(),
        answer_bytes,
        times,
        bare,
        ratios: times.over(&bare),
    })
}

fn show_status(status: &[StatusTimes], console: &mut Console) {
    console.line(&"");
    let mut table = Table::new(&[
        "status",
        "bytes",
        "median",
        "99 %",
        "a second",
        "by several",
        "bare: median",
        "99 %",
        "median ×",
        "99 % ×",
        "a second ×",
        "by several ×",
    ]);
    for row in status {
        let mut cells = vec![
            row.protocol.to_owned(),
            format!("{} + {}", row.request_bytes, row.answer_bytes),
        ];
        cells.extend(cells_of(&row.times, 3));
        let [median, p99, ..] = cells_of(&row.bare, 3);
        cells.extend([median, p99]);
        cells.extend(ratio_cells(&row.ratios));
        table.row(cells);
    }
    console.table(&table);
    console.line(
        &"Bytes of request and answer; bare: a thread that reads and writes as many, and does nothing else.",
    );
}

fn show_triggers(direct: &Times, triggers: &[TriggerTimes], console: &mut Console) {
    console.line(&"");
    let mut table = Table::new(&[
        "trigger",
        "median",
        "99 %",
        "a second",
        "by several",
        "median ×",
        "99 % ×",
        "a second ×",
        "by several ×",
    ]);
    let name = "called directly".to_owned();
    table.row([name].into_iter().chain(cells_of(direct, 2)));
    for row in triggers {
        let mut cells = vec![row.protocol.to_owned()];
        cells.extend(cells_of(&row.times, 2));
        cells.extend(ratio_cells(&row.ratios));
        table.row(cells);
    }
    console.table(&table);
    console.line(&format_args!(
        "{} inspections of simulated frames each, one at a time, also by several: they wait for each other.",
        direct.num
    ));
}

fn cells_of(times: &Times, decimals: usize) -> [String; 4] {
    let ms = |ms: f64| format!("{ms:.decimals$} ms");
    let rate = |rate: f64| {
        let decimals = usize::from(rate < 1000.0);
        format!("{rate:.decimals$}")
    };
    [
        ms(times.median_ms),
        ms(times.p99_ms),
        rate(times.per_s),
        rate(times.busy_per_s),
    ]
}

fn ratio_cells(ratios: &Ratios) -> [String; 4] {
    let Ratios {
        median,
        p99,
        per_s,
        busy_per_s,
    } = ratios;
    [median, p99, per_s, busy_per_s].map(|ratio| format!("{ratio:.2}"))
}
