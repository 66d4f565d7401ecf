//! What goes into the history of triggers: an inspection of each part that hangs before the source, beside the one that
//! Live writes of it.

use std::sync::{
    Arc, Mutex,
    mpsc::{Receiver, TryRecvError},
};

use crate::source::live::FollowedParts;
use geometry::error::lock;
use inspection::pipeline::{Inspection, NamedRecipe};
use records::history::{HungId, NewEntry, SpotIds, Writer};
use stages::scene::SceneCloud;

/// Frames that wait for Live at most, about 10 MB each; usually one does, for as long as Live needs for a frame.
const MAX_WAITING: usize = 4;
/// First number of these inspections for the history, beyond those of the window's own inspections.
const FIRST_TICKET: u64 = 1 << 63;

/// Passes inspections to the history, each once Live knows which part it shows. Dropping it passes on all of them and waits
/// until they are written.
pub(super) struct TriggerRows {
    writer: Writer,
    parts: Arc<Mutex<FollowedParts>>,
    waiting: Vec<WaitingFrame>,
    num_written: u64,
}

/// A frame that was inspected for a trigger.
pub(super) struct AnsweredScene {
    pub(super) scene: Arc<SceneCloud>,
    /// Its parts, at least one.
    pub(super) inspections: Vec<Inspection>,
    pub(super) recipe: NamedRecipe,
}

impl AnsweredScene {
    /// Which hung part each of its parts is.
    pub(super) fn hung(&self, ids: &SpotIds) -> Vec<HungId> {
        ids.of(&self.inspections, &self.scene, &self.recipe)
    }
}

struct WaitingFrame {
    /// One for each part.
    entries: Vec<NewEntry>,
    frame: Arc<AnsweredScene>,
    parts: Receiver<SpotIds>,
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

    /// Adds the entries of the parts of a frame, with the answer of [`FollowedParts::parts_of_frame`] about it.
    pub(super) fn add(
        &mut self,
        entries: Vec<NewEntry>,
        frame: Arc<AnsweredScene>,
        parts: Receiver<SpotIds>,
    ) {
        self.waiting.push(WaitingFrame {
            entries,
            frame,
            parts,
        });
        self.write(MAX_WAITING);
    }

    /// Passes on the inspections whose part is known; without Live, all of them.
    pub(super) fn update(&mut self, is_followed: bool) {
        self.write(if is_followed { MAX_WAITING } else { 0 });
    }

    /// Passes on all inspections except the newest frames whose parts are not known yet, up to `max_waiting`.
    fn write(&mut self, max_waiting: usize) {
        let waiting = std::mem::take(&mut self.waiting);
        let num_over = waiting.len().saturating_sub(max_waiting);
        for (place, mut waiting) in waiting.into_iter().enumerate() {
            let ids = match waiting.parts.try_recv() {
                Ok(ids) => Some(ids),
                Err(TryRecvError::Empty) if place >= num_over => {
                    self.waiting.push(waiting);
                    continue;
                }
                Err(TryRecvError::Empty) => {
                    let source = &waiting.entries[0].record.summary.source;
                    lock(&self.parts).ids_now(source, false)
                }
                // Live follows another source by now: each keeps its own.
                Err(TryRecvError::Disconnected) => None,
            };
            if let Some(ids) = ids {
                let hung = waiting.frame.hung(&ids);
                for (entry, hung) in waiting.entries.iter_mut().zip(hung) {
                    entry.record.summary.hung = hung;
                }
            }
            for entry in waiting.entries {
                self.writer.add(FIRST_TICKET + self.num_written, entry);
                self.num_written += 1;
            }
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
    use inspection::pipeline::live::nothing_there;
    use records::{
        fixtures::history_entry,
        history::{Filter, HistoryBuffer, HungSpots, StoredVerdict},
    };

    fn frame() -> Arc<AnsweredScene> {
        Arc::new(AnsweredScene {
            scene: Arc::default(),
            inspections: vec![nothing_there()],
            recipe: NamedRecipe::default(),
        })
    }

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
        rows.add(vec![entry(1)], frame(), part);
        rows.update(true);
        rows.writer.finish();
        assert!(written(&history).is_empty());
        let ids = HungSpots::<NewEntry>::default().ids(None);
        let first = ids.all().next().expect("a spot").clone();
        tell.send(ids).expect("waited for");
        rows.update(true);
        rows.writer.finish();
        assert_eq!(written(&history), std::slice::from_ref(&first));

        // Live follows another source.
        let (tell, part) = channel();
        drop(tell);
        rows.add(vec![entry(2)], frame(), part);
        rows.writer.finish();
        assert_eq!(written(&history).len(), 2);
        // It follows none any more, before it has told.
        let (_told_late, part) = channel();
        rows.add(vec![entry(3)], frame(), part);
        rows.update(false);
        rows.writer.finish();
        assert_eq!(written(&history).len(), 3);

        // It is slow: what was waited for longest waits no more.
        let (_tells, parts): (Vec<_>, Vec<_>) = (0..=MAX_WAITING).map(|_| channel()).unzip();
        for (seconds, part) in (4..).zip(parts) {
            rows.add(vec![entry(seconds)], frame(), part);
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
