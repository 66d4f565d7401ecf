//! The connection to the broker, and the queue of inspections for it.

use std::{
    collections::VecDeque,
    ops::ControlFlow,
    sync::{Arc, Condvar, Mutex, PoisonError},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use jiff::{SignedDuration, Timestamp};
use rumqttc::{Client, Event, LastWill, MqttOptions, NetworkOptions, Outgoing, Packet, QoS};

use super::{
    access::BrokerAccess,
    address::BrokerAddress,
    message::{InspectionMessage, LibraryMessage, MESSAGE_SCHEMA, PoseMessage, StateMessage},
    news::{LinkError, LinkNews, LinkProblem, Unsent},
};
use geometry::error::{guarded, lock};
use records::history::Traceability;
use robot::Convention;
use serve::{Answer, CameraStatus, InspectionRecord, PoseKind};

/// Maximum number of queued inspections; beyond it, the oldest are dropped.
pub const MAX_UNSENT: usize = 1000;

/// The broker considers the cell offline after 1.5 times this long without a packet.
pub(super) const KEEP_ALIVE: Duration = Duration::from_secs(15);
/// Pause after the first failed attempt to connect; each further pause is twice as long, up to the longest.
const FIRST_PAUSE: Duration = Duration::from_millis(500);
const LONGEST_PAUSE: Duration = Duration::from_secs(30);
/// If the broker answers pings but leaves a message unacknowledged for longer than this, the connection is renewed.
const ACK_TIMEOUT: Duration = Duration::from_mins(1);
/// How long queued inspections may still be sent at the end of the program.
const END_TIMEOUT: Duration = Duration::from_secs(3);
/// Capacity of the client library's queue; there is one message in flight at a time.
const CHANNEL: usize = 8;

/// How poses are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoseFormat {
    /// Which pose is sent.
    pub kind: PoseKind,
    /// The convention of its numbers.
    pub convention: Convention,
}

/// What all messages of one start have in common.
#[derive(Clone, Debug)]
pub struct LinkSubject {
    /// Boot number of this start, [`serve::Server::boot`].
    pub boot: u32,
    /// The enrolled parts.
    pub library: LibraryMessage,
    /// How poses are written.
    pub pose: PoseFormat,
}

/// A queued inspection.
struct Waiting {
    record: InspectionRecord,
    trace: Traceability,
    inspected_at: Timestamp,
    captured_at: Option<Timestamp>,
}

/// A message that the broker has not acknowledged yet.
#[expect(clippy::large_enum_variant, reason = "there is one of them")]
enum InFlight {
    State,
    Inspection(Waiting),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Running,
    /// The queue is sent, then the offline state.
    Ending,
    Ended,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Notified {
    Connected,
    Lost,
}

struct Outbox {
    phase: Phase,
    state: StateMessage,
    /// True if the state has to be sent.
    is_state_due: bool,
    waiting: VecDeque<Waiting>,
    in_flight: Option<InFlight>,
    /// When the last message was handed to the client library.
    handed_over_at: Instant,
    /// Set while connected.
    client: Option<Client>,
    /// What was last reported to the operator.
    notified: Option<Notified>,
    news: VecDeque<LinkNews>,
}

impl Outbox {
    fn drop_oldest(&mut self) {
        while self.waiting.len() > MAX_UNSENT {
            self.waiting.pop_front();
            self.state.num_dropped += 1;
            self.is_state_due = true;
        }
    }

    /// True if the message in flight should have been acknowledged by `now`.
    fn is_overdue(&self, now: Instant) -> bool {
        let waited = now.saturating_duration_since(self.handed_over_at);
        self.in_flight.is_some() && waited > ACK_TIMEOUT
    }
}

struct Shared {
    broker: BrokerAddress,
    subject: LinkSubject,
    outbox: Mutex<Outbox>,
    phase_changed: Condvar,
}

/// The connection to a broker. Dropping it is the same as [`Self::end`].
pub struct MqttLink {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl MqttLink {
    /// Starts a thread that connects, and reconnects whenever the connection is lost.
    pub fn start(access: &BrokerAccess, subject: LinkSubject) -> Result<Self, LinkError> {
        let state = StateMessage {
            schema: MESSAGE_SCHEMA,
            program: format!("Partsight {}", env!("CARGO_PKG_VERSION")),
            boot: subject.boot,
            since: geometry::clock::now(),
            online: true,
            camera: Some(CameraStatus::default()),
            library: subject.library.clone(),
            num_dropped: 0,
        };
        let shared = Arc::new(Shared {
            broker: access.broker.clone(),
            subject,
            outbox: Mutex::new(Outbox {
                phase: Phase::Running,
                state,
                is_state_due: true,
                waiting: VecDeque::new(),
                in_flight: None,
                handed_over_at: Instant::now(),
                client: None,
                notified: None,
                news: VecDeque::new(),
            }),
            phase_changed: Condvar::new(),
        });
        let theirs = Arc::clone(&shared);
        let options = access.options();
        let thread = thread::Builder::new()
            .name("mqtt".into())
            .spawn(move || theirs.run(&options))
            .map_err(|source| LinkError { source })?;
        Ok(Self {
            shared,
            thread: Some(thread),
        })
    }

    /// Queues an inspection for publication, with what it is traced by.
    pub fn inspected(&self, record: InspectionRecord, trace: &Traceability) {
        let inspected_at = geometry::clock::now();
        let age = record.answer().age_ms;
        let age = age.map(|age| SignedDuration::from_millis(age.into()));
        let waiting = Waiting {
            record,
            trace: trace.clone(),
            inspected_at,
            captured_at: age.and_then(|age| inspected_at.checked_sub(age).ok()),
        };
        let mut outbox = lock(&self.shared.outbox);
        outbox.waiting.push_back(waiting);
        outbox.drop_oldest();
        self.shared.send_next(&mut outbox);
    }

    /// Publishes the camera's status if it has changed.
    pub fn set_camera(&self, camera: CameraStatus) {
        let mut outbox = lock(&self.shared.outbox);
        if outbox.state.camera.as_ref() != Some(&camera) {
            outbox.state.camera = Some(camera);
            outbox.is_state_due = true;
            self.shared.send_next(&mut outbox);
        }
    }

    /// Publishes that the cell has another library from now on.
    pub fn set_library(&self, library: LibraryMessage) {
        let mut outbox = lock(&self.shared.outbox);
        outbox.state.library = library;
        outbox.is_state_due = true;
        self.shared.send_next(&mut outbox);
    }

    /// Takes the oldest event that was not taken yet.
    pub fn news(&self) -> Option<LinkNews> {
        lock(&self.shared.outbox).news.pop_front()
    }

    /// Sends what is queued, for at most 3 s, then the offline state, and disconnects.
    pub fn end(mut self) -> Result<(), Unsent> {
        self.take_leave()
    }

    fn take_leave(&mut self) -> Result<(), Unsent> {
        let Some(thread) = self.thread.take() else {
            return Ok(());
        };
        let shared = &self.shared;
        let mut outbox = lock(&shared.outbox);
        outbox.phase = Phase::Ending;
        outbox.state = outbox.state.offline();
        outbox.is_state_due = true;
        shared.send_next(&mut outbox);
        shared.phase_changed.notify_all();
        let waited = (shared.phase_changed)
            .wait_timeout_while(outbox, END_TIMEOUT, |outbox| outbox.phase != Phase::Ended);
        let outbox = waited.unwrap_or_else(PoisonError::into_inner).0;
        let is_in_flight = matches!(outbox.in_flight, Some(InFlight::Inspection(_)));
        let num = outbox.waiting.len() as u64 + u64::from(is_in_flight) + outbox.state.num_dropped;
        let has_ended = outbox.phase == Phase::Ended;
        drop(outbox);
        if has_ended {
            // A panic of the thread has been reported.
            let _ = thread.join();
        }
        // Otherwise it waits for the network, which cannot be interrupted; it ends with the program.
        if num > 0 {
            let broker = shared.broker.clone();
            return Err(Unsent { num, broker });
        }
        Ok(())
    }
}

impl Drop for MqttLink {
    fn drop(&mut self) {
        // The receiver is gone.
        let _ = self.take_leave();
    }
}

impl Shared {
    fn run(&self, options: &MqttOptions) {
        let mut pause = FIRST_PAUSE;
        loop {
            let begun = Instant::now();
            let ended = guarded(|| self.connection(options.clone()));
            let Err(problem) = ended.unwrap_or_else(|fault| Err(fault.into())) else {
                break;
            };
            // If connections keep breaking right away, keep increasing the pause.
            if begun.elapsed() > LONGEST_PAUSE {
                pause = FIRST_PAUSE;
            }
            if self.lost(problem, pause).is_break() {
                break;
            }
            pause = (pause * 2).min(LONGEST_PAUSE);
        }
        lock(&self.outbox).phase = Phase::Ended;
        self.phase_changed.notify_all();
    }

    /// Runs one connection until it breaks or the program disconnects.
    fn connection(&self, mut options: MqttOptions) -> Result<(), LinkProblem> {
        let will = lock(&self.outbox).state.offline().to_json();
        options.set_last_will(LastWill::new(
            self.topic("state"),
            will,
            QoS::AtLeastOnce,
            true,
        ));
        // Use a new client for every connection: this type tracks the message in flight, not the client.
        let (client, mut connection) = Client::new(options, CHANNEL);
        // Without this, the end of a message of several packets is held back until the broker has acknowledged the first
        // ones.
        let mut network = NetworkOptions::new();
        network.set_tcp_nodelay(true);
        connection.eventloop.set_network_options(network);
        for event in connection.iter() {
            match event.map_err(|error| LinkProblem::from_connection(error, &self.broker))? {
                Event::Incoming(Packet::ConnAck(_)) => self.connected(client.clone()),
                Event::Incoming(Packet::PubAck(_)) => {
                    let mut outbox = lock(&self.outbox);
                    outbox.in_flight = None;
                    self.send_next(&mut outbox);
                }
                // Arrives every few seconds while the broker is there.
                Event::Incoming(Packet::PingResp)
                    if lock(&self.outbox).is_overdue(Instant::now()) =>
                {
                    return Err(LinkProblem::Broken {
                        broker: self.broker.clone(),
                        cause: "it acknowledges no message".into(),
                    });
                }
                Event::Outgoing(Outgoing::Disconnect) => break,
                _ => {}
            }
        }
        Ok(())
    }

    fn connected(&self, client: Client) {
        let mut outbox = lock(&self.outbox);
        outbox.client = Some(client);
        // The broker may have lost the state, or published the last will.
        outbox.is_state_due = true;
        if outbox.notified != Some(Notified::Connected) {
            outbox.notified = Some(Notified::Connected);
            let news = LinkNews::Connected {
                num_waiting: outbox.waiting.len(),
                num_dropped: outbox.state.num_dropped,
            };
            outbox.news.push_back(news);
        }
        self.send_next(&mut outbox);
    }

    /// Requeues the message in flight, reports the loss once, and waits before the next attempt; `Break` if there is none.
    fn lost(&self, problem: LinkProblem, pause: Duration) -> ControlFlow<()> {
        let mut outbox = lock(&self.outbox);
        outbox.client = None;
        if let Some(InFlight::Inspection(waiting)) = outbox.in_flight.take() {
            outbox.waiting.push_front(waiting);
            outbox.drop_oldest();
        }
        if outbox.phase != Phase::Running {
            return ControlFlow::Break(());
        }
        if outbox.notified != Some(Notified::Lost) {
            outbox.notified = Some(Notified::Lost);
            outbox.news.push_back(LinkNews::Lost(problem));
        }
        let is_running = |outbox: &mut Outbox| outbox.phase == Phase::Running;
        drop(
            self.phase_changed
                .wait_timeout_while(outbox, pause, is_running),
        );
        ControlFlow::Continue(())
    }

    /// Hands the next message to the client library, unless one is still unacknowledged.
    fn send_next(&self, outbox: &mut Outbox) {
        let Some(client) = &outbox.client else {
            return;
        };
        if outbox.in_flight.is_some() {
            return;
        }
        let is_ending = outbox.phase != Phase::Running;
        // When ending, send the queue before the offline state.
        let is_state_next = outbox.is_state_due && (!is_ending || outbox.waiting.is_empty());
        // Errors are ignored: publishing fails only after the connection is lost, and then `lost` requeues the message.
        if is_state_next {
            outbox.is_state_due = false;
            outbox.in_flight = Some(InFlight::State);
            outbox.handed_over_at = Instant::now();
            let json = outbox.state.to_json();
            let _ = client.try_publish(self.topic("state"), QoS::AtLeastOnce, true, json);
        } else if let Some(waiting) = outbox.waiting.pop_front() {
            let json = self.message(&waiting).to_json();
            outbox.in_flight = Some(InFlight::Inspection(waiting));
            outbox.handed_over_at = Instant::now();
            let _ = client.try_publish(self.topic("inspection"), QoS::AtLeastOnce, false, json);
        } else if is_ending {
            let _ = client.try_disconnect();
            outbox.client = None;
        }
    }

    fn topic(&self, name: &str) -> String {
        format!("{}/{name}", self.broker.prefix)
    }

    fn message(&self, waiting: &Waiting) -> InspectionMessage {
        let answer = waiting.record.answer();
        let PoseFormat { kind, convention } = self.subject.pose;
        let has = |mark| answer.marks & mark != 0;
        InspectionMessage {
            schema: MESSAGE_SCHEMA,
            boot: answer.boot,
            sequence: answer.sequence,
            inspected_at: waiting.inspected_at,
            captured_at: waiting.captured_at,
            age_ms: answer.age_ms,
            verdict: answer.verdict,
            simulated: has(Answer::SIMULATED),
            approximate: has(Answer::APPROXIMATE),
            motion_checked: !has(Answer::MOTION_UNCHECKED),
            index: answer.index,
            num_parts: answer.num_parts,
            on_line: answer.on_line_now(),
            place: answer.place,
            facts: (*answer.facts).clone(),
            number: (answer.number > 0).then_some(answer.number),
            pose: answer.pose.map(|pose| PoseMessage {
                transform: kind,
                in_convention: convention.write(&pose),
            }),
            part: Some(answer.part).filter(|part| !part.is_empty()),
            problem: Some(answer.problem).filter(|problem| !problem.reason.is_empty()),
            traceability: waiting.trace.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_that_stays_unacknowledged_is_overdue() {
        let start = Instant::now();
        let mut outbox = Outbox {
            phase: Phase::Running,
            state: StateMessage {
                schema: MESSAGE_SCHEMA,
                program: "Partsight 0".into(),
                boot: 7,
                since: Timestamp::UNIX_EPOCH,
                online: true,
                camera: Some(CameraStatus::default()),
                library: LibraryMessage {
                    identity: "0123abcd".into(),
                    num_parts: 8,
                },
                num_dropped: 0,
            },
            is_state_due: false,
            waiting: VecDeque::new(),
            in_flight: Some(InFlight::State),
            handed_over_at: start,
            client: None,
            notified: None,
            news: VecDeque::new(),
        };
        let late = start + ACK_TIMEOUT + Duration::from_millis(1);
        assert!(!outbox.is_overdue(start + ACK_TIMEOUT));
        assert!(outbox.is_overdue(late));
        outbox.in_flight = None;
        assert!(!outbox.is_overdue(late));
    }
}
