//! Access to a server for protocols other than those of its listeners.

use std::{
    net::SocketAddr,
    sync::{Arc, mpsc::SyncSender},
};

use serde_json::{Map, Value};

use super::{
    answer::{Answer, LibraryStatus, PathStep, Problem, Request, VerdictCode},
    server::{ClientNews, ClientSlot, Job, ServerSettings, Shared, answer_to, path_of},
    tally::Tally,
};
use geometry::error::lock;

/// Fields of an inspection's JSON line that contain poses, or data from which a pose follows.
const POSE_FIELDS: [&str; 3] = ["pose", "robot", "scan"];

/// Queries a server: the same inspections, rules and limits as for its listeners.
#[derive(Clone)]
pub struct ServerHandle {
    pub(super) shared: Arc<Shared>,
    pub(super) jobs: SyncSender<Job>,
}

impl ServerHandle {
    /// The server's limits.
    pub fn settings(&self) -> ServerSettings {
        self.shared.settings
    }

    /// The present boot number.
    pub fn boot(&self) -> u32 {
        lock(&self.shared.inspections).boot()
    }

    /// True once the service is ending.
    pub fn is_stopping(&self) -> bool {
        self.shared.is_stopping()
    }

    /// Number of connected clients of all protocols.
    pub fn num_clients(&self) -> usize {
        self.shared.num_clients()
    }

    /// Takes a client place; none if all are taken. Whoever triggers has to hold one until the answer arrives: this bounds
    /// the number of waiting triggers.
    pub fn slot(&self) -> Option<ClientSlot> {
        ClientSlot::take(&self.shared)
    }

    /// The answer to a client for which there is no place.
    pub fn full(&self) -> Answer {
        let problem = Problem::full(self.settings().max_clients);
        Answer::turned_away(VerdictCode::Full, problem, &self.shared.situation())
    }

    /// Answers a request of a client that is known by no connection; for a trigger it blocks until the inspection is done. A
    /// trigger whose client is gone before its turn, so that `is_withdrawn` returns true, is not inspected.
    pub fn answer(
        &self,
        request: Request,
        is_withdrawn: impl Fn() -> bool + Send + 'static,
    ) -> Answer {
        answer_to(request, &self.shared, &self.jobs, &mut None, is_withdrawn)
    }

    /// The state of the camera, and the last verdict without its numbers.
    pub fn status(&self) -> Answer {
        self.answer(Request::Status, || false)
    }

    /// Refuses the last inspection from now on, and those before it, if they were accepted: their poses and paths do not go
    /// out any more.
    pub fn refuse_last(&self, problem: &Problem) {
        lock(&self.shared.inspections).revoke(problem);
    }

    /// Draws a new boot number and drops the inspections so far. Call it whenever the same numbers come to mean another pose:
    /// another calibration, convention or kind of pose.
    pub fn renew(&self) {
        lock(&self.shared.inspections).renew();
    }

    /// The inspection with this sequence number and its whole path, which is empty unless the pose may be used.
    pub fn path(&self, sequence: u32) -> (Answer, Vec<PathStep>) {
        let at = self.shared.situation();
        let inspected = match path_of(Some(sequence), None, &self.shared) {
            Ok(inspected) => inspected,
            Err(problem) => {
                let refused = Answer::turned_away(VerdictCode::BadRequest, problem, &at);
                return (refused, Vec::new());
            }
        };
        let answer = Answer::of(Request::Last, &inspected, &at);
        let path = match answer.verdict {
            VerdictCode::Accepted => inspected.found.path.clone(),
            _ => Vec::new(),
        };
        (answer, path)
    }

    /// The last inspection and its JSON line, if there is one. Unless the pose may be used, all poses are removed from the
    /// line.
    pub fn report(&self) -> (Answer, Option<Map<String, Value>>) {
        let last = self.shared.last();
        let answer = Answer::of(Request::Last, &last, &self.shared.situation());
        let mut report = serde_json::from_str::<Map<String, Value>>(&last.found.report).ok();
        if let Some(line) = &mut report
            && answer.verdict != VerdictCode::Accepted
        {
            for field in POSE_FIELDS {
                line.remove(field);
            }
        }
        (answer, report)
    }

    /// Counts since the start.
    pub fn tally(&self) -> Tally {
        lock(&self.shared.tally).clone()
    }

    /// The library, if the service takes new versions of it while it runs.
    pub fn library(&self) -> Option<LibraryStatus> {
        lock(&self.shared.library).clone()
    }

    /// Replaces the library's status.
    pub fn set_library(&self, status: LibraryStatus) {
        *lock(&self.shared.library) = Some(status);
    }

    /// Reports a client's event to the operator.
    pub fn tell(&self, peer: SocketAddr, protocol: &'static str, news: ClientNews) {
        self.shared.tell(peer, protocol, news);
    }
}
