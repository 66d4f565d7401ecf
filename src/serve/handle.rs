//! What another protocol than those of the listeners asks the server by.

use std::{
    net::SocketAddr,
    sync::{Arc, mpsc::SyncSender},
};

use serde_json::{Map, Value};

use super::{
    answer::{Answer, PathStep, Request, Trouble, VerdictCode},
    server::{ClientNews, ClientSlot, Job, ServerSettings, Shared, answer_to},
    tally::Tally,
};
use crate::error::lock;

/// Fields of an inspection's line of JSON that hold poses or what a pose follows from.
const POSE_FIELDS: [&str; 3] = ["pose", "robot", "scan"];

/// Asks a server: the same inspections, rules and limits as for its listeners.
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

    /// The number of this start.
    pub fn boot(&self) -> u32 {
        self.shared.boot
    }

    /// True once the service ends.
    pub fn is_stopping(&self) -> bool {
        self.shared.is_stopping()
    }

    /// Clients of all protocols that are being served.
    pub fn num_clients(&self) -> usize {
        self.shared.num_clients()
    }

    /// A place among the clients; none if as many are served as are allowed. Whoever triggers has to hold one until the
    /// answer is there: only as many triggers may wait as there are places.
    pub fn slot(&self) -> Option<ClientSlot> {
        ClientSlot::take(&self.shared)
    }

    /// The answer to a client for which there is no place.
    pub fn full(&self) -> Answer {
        let trouble = Trouble::full(self.settings().max_clients);
        Answer::turned_away(VerdictCode::Full, trouble, &self.shared.situation())
    }

    /// The answer to a request. For a trigger it blocks until the inspection is over.
    pub fn answer(&self, request: Request) -> Answer {
        answer_to(request, &self.shared, &self.jobs)
    }

    /// The last inspection with the whole path, which is empty unless the pose may be used.
    pub fn path(&self) -> (Answer, Vec<PathStep>) {
        let last = self.shared.last();
        let answer = Answer::of(Request::Last, &last, &self.shared.situation());
        let path = match answer.verdict {
            VerdictCode::Accepted => last.found.path.clone(),
            _ => Vec::new(),
        };
        (answer, path)
    }

    /// The last inspection with its line of JSON, if there is one. Unless the pose may be used, the line has none either.
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

    /// Tells the person at the screen something about a client.
    pub fn tell(&self, peer: SocketAddr, protocol: &'static str, news: ClientNews) {
        self.shared.tell(peer, protocol, news);
    }
}
