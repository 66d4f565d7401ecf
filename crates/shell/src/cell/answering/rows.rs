//! What goes into the history of triggers: an inspection of the part that hangs before the source, beside the one that
//! Live writes of it.

use std::sync::{
    Arc, Mutex,
    mpsc::{Receiver, TryRecvError},
};

use crate::source::live::FollowedParts;
use geometry::error::lock;
use records::history::{HungId, NewEntry, Writer};

/// Inspections that wait for Live at most, 4 MB each; usually one does, for as long as Live needs for a frame.
const MAX_WAITING: usize = 4;
/// First number of these inspections for the history, beyond those of the window's own inspections.
const FIRST_TICKET: u64 = 1 << 63;

/// Passes inspections to the history, each once Live knows which part it shows. Dropping it passes on all of them and waits
/// until they are written.
pub(super) struct TriggerRows {
    writer: Writer,
    parts: Arc<Mutex<FollowedParts>>,
    waiting: Vec<WaitingRow>,
    num_written: u64,
}

struct WaitingRow {
    entry: NewEntry,
    part: Receiver<HungId>,
}

impl TriggerRows {
    pub(super) fn new(writer: Writer, parts: Arc<Mutex<FollowedParts>>) -> Self {
        Self {
            writer,
            parts,
            waiting: Vec::new(),
            num_written: 0,
        }
    }

    /// Adds an inspection, with the answer of [`FollowedParts::part_of_frame`] about its frame.
    pub(super) fn add(&mut self, entry: NewEntry, part: Receiver<HungId>) {
        self.waiting.push(WaitingRow { entry, part });
        self.write(MAX_WAITING);
    }

    /// Passes on the inspections whose part is known; without Live, all of them.
    pub(super) fn update(&mut self, is_followed: bool) {
        self.write(if is_followed { MAX_WAITING } else { 0 });
    }

    /// Passes on all inspections except the newest ones whose part is not known yet, up to `max_waiting`.
    fn write(&mut self, max_waiting: usize) {
        let waiting = std::mem::take(&mut self.waiting);
        let num_over = waiting.len().saturating_sub(max_waiting);
        for (place, WaitingRow { mut entry, part }) in waiting.into_iter().enumerate() {
            let summary = &mut entry.record.summary;
            match part.try_recv() {
                Ok(hung) => summary.hung = hung,
                Err(TryRecvError::Empty) if place >= num_over => {
                    self.waiting.push(WaitingRow { entry, part });
                    continue;
                }
                Err(TryRecvError::Empty) => {
                    summary.hung = lock(&self.parts).part_now(&summary.source, false);
                }
                // Live follows another source by now: it keeps its own.
                Err(TryRecvError::Disconnected) => {}
            }
            self.writer.add(FIRST_TICKET + self.num_written, entry);
            self.num_written += 1;
        }
    }

    /// As [`Writer::take_dropped`].
    pub(super) fn take_dropped(&self) -> [usize; 2] {
        self.writer.take_dropped()
    }
}

impl Drop for TriggerRows {
    fn drop(&mut self) {
        self.write(0);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;
    use records::{
        fixtures::history_entry,
        history::{Filter, HistoryBuffer, StoredVerdict},
    };

    fn entry(seconds: i64) -> NewEntry {
        history_entry(seconds, StoredVerdict::Accepted, "fender")
    }

    /// The parts in the history, the newest first.
    fn written(history: &HistoryBuffer) -> Vec<HungId> {
        let page = history.page(&Filter::default(), 0, 100).expect("asked");
        page.rows.into_iter().map(|row| row.hung).collect()
    }

    #[test]
    fn an_inspection_waits_to_be_told_its_part_and_none_is_lost_whatever_happens() {
        let history = Arc::new(HistoryBuffer::new(None));
        let writer = Writer::start(Arc::clone(&history), || ()).expect("a thread");
        let mut rows = TriggerRows::new(writer, Arc::default());
        let (tell, part) = channel();
        rows.add(entry(1), part);
        rows.update(true);
        rows.writer.finish();
        assert!(written(&history).is_empty());
        let first = HungId::new();
        tell.send(first.clone()).expect("waited for");
        rows.update(true);
        rows.writer.finish();
        assert_eq!(written(&history), std::slice::from_ref(&first));

        // Live follows another source.
        let (tell, part) = channel();
        drop(tell);
        rows.add(entry(2), part);
        rows.writer.finish();
        assert_eq!(written(&history).len(), 2);
        // It follows none any more, before it has told.
        let (_told_late, part) = channel();
        rows.add(entry(3), part);
        rows.update(false);
        rows.writer.finish();
        assert_eq!(written(&history).len(), 3);

        // It is slow: what was waited for longest waits no more.
        let (_tells, parts): (Vec<_>, Vec<_>) = (0..=MAX_WAITING).map(|_| channel()).unzip();
        for (seconds, part) in (4..).zip(parts) {
            rows.add(entry(seconds), part);
        }
        rows.writer.finish();
        assert_eq!(written(&history).len(), 4);
        // The server ends.
        drop(rows);
        let all = written(&history);
        assert_eq!(all.len(), 4 + MAX_WAITING);
        assert_eq!(all.last(), Some(&first));
    }
}
