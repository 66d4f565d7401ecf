//! The parts that hang before the source that is followed. Live sees them; who inspects one of its frames beside Live is
//! told which part that frame shows.

use std::{
    mem,
    sync::mpsc::{Receiver, Sender, channel},
    time::Instant,
};

use crate::{
    capture::SourceSpec,
    history::{HungId, HungRows, NewEntry, Traceability},
};

/// The parts before a source, one after the other.
#[derive(Debug, Default)]
pub(in crate::app) struct FollowedParts {
    source: String,
    pub(super) rows: HungRows,
    /// Of the part whose verdict counted last.
    pub(super) trace: Traceability,
    /// Frames whose part is asked for, until Live has seen one as new.
    asked: Vec<AskedFrame>,
}

#[derive(Debug)]
struct AskedFrame {
    source: String,
    arrived: Instant,
    tell: Sender<HungId>,
}

impl FollowedParts {
    /// Those before this source: before another one nothing is known yet.
    pub(super) fn before(&mut self, source: &SourceSpec) -> &mut Self {
        let source = source.to_string();
        if self.source != source {
            *self = Self {
                source,
                // They may be of this source: whoever asks may be faster than Live.
                asked: mem::take(&mut self.asked),
                ..Self::default()
            };
        }
        self
    }

    /// Asks which part a frame of this source shows. The answer comes once Live has seen that frame or a later one; none
    /// comes, and the sender is dropped, if Live follows another source by then.
    pub(in crate::app) fn part_of_frame(
        &mut self,
        source: String,
        arrived: Instant,
    ) -> Receiver<HungId> {
        let (tell, part) = channel();
        self.asked.push(AskedFrame {
            source,
            arrived,
            tell,
        });
        part
    }

    /// The part that hangs before this source as far as is known now, for whoever does not wait for Live; else another
    /// one.
    pub(in crate::app) fn part_now(&self, source: &str) -> HungId {
        if self.source == source {
            self.rows.id_of_frame(false)
        } else {
            HungId::new()
        }
    }

    /// Live has seen a frame that came then, after [`HungRows::see`].
    pub(super) fn seen(&mut self, arrived: Instant, shows_part: bool) {
        let part = self.rows.id_of_frame(shows_part);
        self.answer(arrived, |_| Some(part.clone()));
    }

    /// Live has inspected a capture that stands for itself, under this id.
    pub(super) fn seen_alone(&mut self, arrived: Instant, id: &HungId) {
        self.answer(arrived, |frame| {
            (frame.arrived == arrived).then(|| id.clone())
        });
    }

    /// The source has ended: the inspection of a part that still hangs there without a verdict that counts.
    pub(super) fn end(&mut self) -> Option<NewEntry> {
        self.seen(Instant::now(), false);
        self.rows.end()
    }

    /// Answers for all frames that came until then.
    fn answer(&mut self, until: Instant, part_of: impl Fn(&AskedFrame) -> Option<HungId>) {
        let source = &self.source;
        self.asked.retain(|frame| {
            let is_due = frame.arrived <= until;
            if is_due
                && frame.source == *source
                && let Some(part) = part_of(frame)
            {
                // Whoever asked may have gone.
                let _ = frame.tell.send(part);
            }
            !is_due
        });
    }
}

#[cfg(test)]
mod tests {
    use std::{sync::mpsc::TryRecvError, time::Duration};

    use super::*;

    fn sources() -> [SourceSpec; 2] {
        ["simulated", "simulated:empty"].map(|text| text.parse().expect("a source"))
    }

    #[test]
    fn the_part_of_a_frame_is_told_once_a_frame_of_the_same_source_is_as_new() {
        let [one, other] = sources();
        let begun = Instant::now();
        let later = begun + Duration::from_secs(1);
        let mut parts = FollowedParts::default();
        // Before Live has seen anything.
        let part = parts.part_of_frame(one.to_string(), later);
        let of_other = parts.part_of_frame(other.to_string(), later);
        parts.before(&one).seen(begun, true);
        assert_eq!(part.try_recv(), Err(TryRecvError::Empty));
        parts.before(&one).seen(later, true);
        assert_eq!(part.try_recv(), Ok(parts.rows.id_of_frame(true)));
        assert_eq!(of_other.try_recv(), Err(TryRecvError::Disconnected));

        // Live goes on to another source, and whoever asks is still at the one before.
        parts.before(&other).seen(later, true);
        let late = parts.part_of_frame(one.to_string(), later);
        parts.before(&other).seen(later, true);
        assert_eq!(late.try_recv(), Err(TryRecvError::Disconnected));
    }

    #[test]
    fn of_captures_that_stand_for_themselves_each_is_a_part() {
        let [one, _] = sources();
        let first = Instant::now();
        let second = first + Duration::from_secs(1);
        let mut parts = FollowedParts::default();
        let [of_first, of_second] =
            [first, second].map(|arrived| parts.part_of_frame(one.to_string(), arrived));
        let id = HungId::new();
        parts.before(&one).seen_alone(first, &id);
        assert_eq!(of_first.try_recv(), Ok(id));
        assert_eq!(of_second.try_recv(), Err(TryRecvError::Empty));
        // One that Live could not inspect.
        let after = second + Duration::from_secs(1);
        parts.before(&one).seen_alone(after, &HungId::new());
        assert_eq!(of_second.try_recv(), Err(TryRecvError::Disconnected));
    }

    #[test]
    fn without_waiting_an_inspection_is_of_no_part_before_another_source() {
        let [one, other] = sources();
        let mut parts = FollowedParts::default();
        let part = parts.part_of_frame(one.to_string(), Instant::now());
        assert!(parts.before(&one).end().is_none());
        part.try_recv().expect("told at the end");
        let now = [&one, &other, &one].map(|source| parts.part_now(&source.to_string()));
        assert_ne!(now[0], now[1]);
        assert_ne!(now[0], now[2], "nothing hangs there");
    }
}
