//! Access to a server for protocols other than those of its listeners.

use std::{
    net::SocketAddr,
    sync::{Arc, mpsc::SyncSender},
};

use serde_json::{Map, Value};

use super::{
    answer::{Answer, LibraryStatus, PathStep, Problem, VerdictCode},
    request::Request,
    server::{
        ClientMemory, ClientNews, ClientSlot, Job, ServerSettings, Shared, answer_to,
        inspection_of, triggered,
    },
    tally::Tally,
};
use geometry::error::lock;

/// Fields of an inspection's JSON line that contain poses, or data from which a pose follows.
const POSE_FIELDS: [&str; 4] = ["pose", "robot", "scan", "on_line"];

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
        let mut client = ClientMemory::new(&self.shared);
        answer_to(request, &self.shared, &self.jobs, &mut client, is_withdrawn)
    }

    /// Inspects a frame for a [`Request::Trigger`], and answers about each of its parts, or what there is instead of one. It
    /// blocks as [`answer`](Self::answer) does.
    pub fn trigger(
        &self,
        request: &Request,
        is_withdrawn: impl Fn() -> bool + Send + 'static,
    ) -> Vec<Answer> {
        let inspected = triggered(request, &self.jobs, Box::new(is_withdrawn));
        let at = self.shared.situation();
        match inspected {
            Ok(inspected) => inspected.answers(request, &at),
            Err((verdict, problem)) => vec![Answer {
                request: Some(request.clone()),
                ..Answer::turned_away(verdict, problem, &at)
            }],
        }
    }

    /// Answers about each part of the last inspection, or what there is instead of one.
    pub fn last(&self) -> Vec<Answer> {
        let at = self.shared.situation();
        self.shared.last().answers(&Request::Last, &at)
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
        let (inspected, index) = match inspection_of(Some(sequence), None, &self.shared) {
            Ok(found) => found,
            Err(problem) => {
                let refused = Answer::turned_away(VerdictCode::BadRequest, problem, &at);
                return (refused, Vec::new());
            }
        };
        let answer = Answer::of(&Request::Last, &inspected, index, &at);
        let found = inspected.found.get(index);
        let path = found.filter(|_| answer.verdict == VerdictCode::Accepted);
        let path = path.map_or_else(Vec::new, |found| found.path.clone());
        (answer, path)
    }

    /// The parts of the last inspection, or what there is instead of one, and its JSON line, if there is one. The line has
    /// the poses of those parts alone whose pose may be used.
    pub fn report(&self) -> (Vec<Answer>, Option<Map<String, Value>>) {
        let last = self.shared.last();
        let answers = last.answers(&Request::Last, &self.shared.situation());
        let mut report = serde_json::from_str::<Map<String, Value>>(&last.found.first.report).ok();
        if let Some(line) = &mut report {
            if let Some(Value::Array(parts)) = line.get_mut("parts") {
                for (i, part) in parts.iter_mut().enumerate() {
                    remove_pose(part.as_object_mut(), answers.get(i));
                }
            }
            remove_pose(Some(line), answers.first());
        }
        (answers, report)
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

/// Removes the poses of a part, unless its answer has one.
fn remove_pose(line: Option<&mut Map<String, Value>>, answer: Option<&Answer>) {
    let may_be_used = answer.is_some_and(|answer| answer.verdict == VerdictCode::Accepted);
    if let Some(line) = line.filter(|_| !may_be_used) {
        for field in POSE_FIELDS {
            line.remove(field);
        }
    }
}
