//! The parts that hang before the source that is followed. Live sees them; who inspects one of its frames beside Live is
//! told which part that frame shows.

use std::{
    mem,
    sync::{
        Arc,
        mpsc::{Receiver, Sender, channel},
    },
    time::Instant,
};

use crate::{inspection::inspected::Inspected, trace::current_trace::CurrentTrace};
use capture::SourceSpec;
use inspection::library::Truth;
use records::history::{HungId, HungRows, TraceChange, Traceability};

/// The parts before a source, one after the other.
#[derive(Debug, Default)]
pub(crate) struct FollowedParts {
    source: String,
    pub(super) rows: HungRows<Arc<Inspected>>,
    /// The part whose verdict counted last, and its traceability.
    pub(super) counted: Option<(HungId, Traceability)>,
    /// The last part with a true label.
    labelled: Option<(HungId, Truth)>,
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
    /// Starts over if this is not the same source as before. Returns the inspection of the part that hangs before the
    /// former source, if its verdict does not count yet.
    pub(super) fn begin(&mut self, source: &SourceSpec) -> Option<Arc<Inspected>> {
        let source = source.to_string();
        if self.source == source {
            return None;
        }
        // Live sees none of the former source's frames any more.
        let part = self.rows.id_of_frame(false);
        self.asked.retain(|frame| {
            let is_former = frame.source == self.source;
            if is_former {
                // The receiver may be gone.
                let _ = frame.tell.send(part.clone());
            }
            !is_former
        });
        let left = self.rows.take_best();
        *self = Self {
            source,
            // They may be of this source: whoever asks may be faster than Live.
            asked: mem::take(&mut self.asked),
            ..Self::default()
        };
        left
    }

    /// Asks which part a frame of this source shows. The answer comes once Live has seen that frame or a later one, or goes
    /// on to another source; none comes, and the sender is dropped, if Live follows another source already.
    pub(crate) fn part_of_frame(&mut self, source: String, arrived: Instant) -> Receiver<HungId> {
        let (tell, part) = channel();
        self.asked.push(AskedFrame {
            source,
            arrived,
            tell,
        });
        part
    }

    /// The part that a frame of this source shows as far as is known now, without waiting for Live; a new one if Live follows
    /// another source.
    pub(crate) fn part_now(&self, source: &str, shows_part: bool) -> HungId {
        if self.source == source {
            self.rows.id_of_frame(shows_part)
        } else {
            HungId::new()
        }
    }

    /// The traceability of the part that hangs there, if its verdict has counted.
    pub(super) fn trace_of_hanging(&self) -> Option<&Traceability> {
        let hanging = self.rows.id_of_frame(false);
        let (part, trace) = self.counted.as_ref()?;
        (*part == hanging).then_some(trace)
    }

    /// The traceability of this part changed after its verdict.
    pub(crate) fn traced(&mut self, part: &HungId, change: &TraceChange) {
        if let Some((counted, known)) = &mut self.counted
            && *counted == *part
        {
            *known = mem::take(known).changed(change);
        }
    }

    /// Takes over the true label of a part, or that it has none.
    pub(crate) fn label(&mut self, part: &HungId, label: Option<&Truth>) {
        match label {
            Some(label) => self.labelled = Some((part.clone(), label.clone())),
            None => {
                self.labelled.take_if(|(known, _)| known == part);
            }
        }
    }

    /// What this part really is, if a person has reported that it is none of this name.
    pub(crate) fn reported_as(&self, part: &HungId, name: &str) -> Option<Truth> {
        let (known, label) = self.labelled.as_ref()?;
        let is_wrong = known == part && label.part() != Some(name);
        is_wrong.then(|| label.clone())
    }

    /// The part that a capture of this source shows, which is taken in place of Live, and the traceability of that
    /// inspection. A part whose verdict has counted keeps its own serial number: the waiting one is of the next part.
    pub(crate) fn of_capture(
        &self,
        source: &str,
        shows_part: bool,
        current: &CurrentTrace,
    ) -> (HungId, Traceability) {
        let part = self.part_now(source, shows_part);
        let trace = match &self.counted {
            Some((counted, trace))
                if *counted == part && (!trace.serial.is_empty() || current.is_late_of(&part)) =>
            {
                trace.clone()
            }
            _ => current.take(shows_part),
        };
        (part, trace)
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
    pub(super) fn end(&mut self) -> Option<Arc<Inspected>> {
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
                // The receiver may be gone.
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
        assert!(parts.begin(&one).is_none());
        parts.seen(begun, true);
        assert_eq!(part.try_recv(), Err(TryRecvError::Empty));
        parts.seen(later, true);
        assert_eq!(part.try_recv(), Ok(parts.rows.id_of_frame(true)));
        assert_eq!(of_other.try_recv(), Err(TryRecvError::Disconnected));

        // Live goes on to another source before it has seen a frame as new, and whoever asks is still at the one before.
        let last = parts.part_of_frame(one.to_string(), later);
        assert!(parts.begin(&other).is_none());
        last.try_recv().expect("told at the change");
        let late = parts.part_of_frame(one.to_string(), later);
        parts.seen(later, true);
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
        assert!(parts.begin(&one).is_none());
        parts.seen_alone(first, &id);
        assert_eq!(of_first.try_recv(), Ok(id));
        assert_eq!(of_second.try_recv(), Err(TryRecvError::Empty));
        // One that Live could not inspect.
        let after = second + Duration::from_secs(1);
        parts.seen_alone(after, &HungId::new());
        assert_eq!(of_second.try_recv(), Err(TryRecvError::Disconnected));
    }

    #[test]
    fn without_waiting_an_inspection_is_of_no_part_before_another_source() {
        let [one, other] = sources();
        let mut parts = FollowedParts::default();
        let part = parts.part_of_frame(one.to_string(), Instant::now());
        assert!(parts.begin(&one).is_none() && parts.end().is_none());
        part.try_recv().expect("told at the end");
        let now = [&one, &other, &one].map(|source| parts.part_now(&source.to_string(), false));
        assert_ne!(now[0], now[1]);
        assert_ne!(now[0], now[2], "nothing hangs there");
    }

    #[test]
    fn a_part_is_reported_as_wrong_while_its_label_names_another_part_or_none() {
        let mut parts = FollowedParts::default();
        let [part, next] = [HungId::new(), HungId::new()];
        for (label, is_reported) in [
            (Some(Truth::NotEnrolled), true),
            (Some(Truth::Part("fender".into())), false),
            (Some(Truth::Part("grille".into())), true),
            (None, false),
            (Some(Truth::Nothing), true),
        ] {
            parts.label(&part, label.as_ref());
            let expected = label.filter(|_| is_reported);
            assert_eq!(parts.reported_as(&part, "fender"), expected);
            assert_eq!(parts.reported_as(&next, "fender"), None);
        }
        // The next part has no label.
        parts.label(&next, None);
        assert!(parts.reported_as(&part, "fender").is_some());
    }

    #[test]
    fn a_capture_in_place_of_live_takes_the_serial_number_unless_its_part_has_one() {
        let [one, other] = sources();
        let mut parts = FollowedParts::default();
        assert!(parts.begin(&one).is_none());
        let current = CurrentTrace::default();
        let capture = |parts: &FollowedParts, source: &SourceSpec| {
            current.set_serial("4712");
            let (part, trace) = parts.of_capture(&source.to_string(), true, &current);
            (part, trace.serial, current.get().serial)
        };
        let (part, taken, left) = capture(&parts, &one);
        assert_eq!(
            (part, &*taken, &*left),
            (parts.rows.id_of_frame(true), "4712", "")
        );
        let its_own = Traceability {
            serial: "4711".into(),
            ..Traceability::default()
        };
        parts.counted = Some((parts.rows.id_of_frame(true), its_own));
        let (_, taken, left) = capture(&parts, &one);
        assert_eq!((&*taken, &*left), ("4711", "4712"));
        let (part, taken, left) = capture(&parts, &other);
        assert_ne!(part, parts.rows.id_of_frame(true));
        assert_eq!((&*taken, &*left), ("4712", ""));
    }
}
