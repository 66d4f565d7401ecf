//! Traceability of the inspections: serial number, production order and operator, typed in the operator's view or sent by a
//! scanner.
//!
//! A serial number belongs to the part on the screen if its verdict counts and it has no number yet, else to the part that is
//! inspected next. This suits operators who scan each label after the verdict as well as those who scan it before. A number
//! that came after the verdict is written at once. For a while it can be moved to the next part, which takes it from the row
//! again. A number that another part of the shift has is in doubt: the next one replaces it.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex},
};

use crate::{inspection::inspected::Inspected, language::inspection_title};
use geometry::error::lock;
use records::history::{HungId, Summary, TraceChange, Traceability};
use ui::language::text;

/// How long a serial number that came after the verdict can be moved to the next part, seconds.
pub(super) const MOVABLE: f64 = 30.0;
/// Maximum number of earlier parts whose late serial number is kept, for their inspections that are still in memory.
const MAX_EARLIER: usize = 100;

/// Traceability of the next inspection. Clones share it; whoever inspects takes it when the verdict counts.
#[derive(Clone, Debug, Default)]
pub struct CurrentTrace(pub(super) Arc<Mutex<EnteredTrace>>);

#[derive(Debug, Default)]
pub(super) struct EnteredTrace {
    trace: Traceability,
    /// True unless the serial number is still being typed.
    is_complete: bool,
    /// The serial number entered last, if another part of the shift has it.
    doubtful: Option<String>,
    /// The last serial number that came after the verdict on its part.
    pub(super) late: Option<LateSerial>,
    /// Traceability of earlier parts whose serial number came after the verdict, newest first.
    earlier: VecDeque<(HungId, Traceability)>,
    /// Changes that are not written yet.
    changes: Vec<(HungId, TraceChange)>,
}

/// A serial number that came after the verdict on its part.
#[derive(Debug)]
pub(super) struct LateSerial {
    pub(super) hung: HungId,
    /// Traceability of the part, with the number unless it was moved to the next part.
    pub(super) trace: Traceability,
    /// Names number and part to the user.
    pub(super) says: String,
    /// Until when the number can be moved to the next part, seconds of egui's clock; `None` once it stays.
    pub(super) until: Option<f64>,
}

impl CurrentTrace {
    /// Starts with these values.
    pub fn starting(trace: Traceability) -> Self {
        Self(Arc::new(Mutex::new(EnteredTrace {
            trace,
            ..EnteredTrace::default()
        })))
    }

    /// The current values.
    pub fn get(&self) -> Traceability {
        lock(&self.0).trace.clone()
    }

    /// The values kept from one start to the next: all but the serial number.
    pub fn remembered(&self) -> Traceability {
        Traceability {
            serial: String::new(),
            ..self.get()
        }
    }

    /// The values of the next part, without a serial number that is still being typed.
    pub(crate) fn of_next(&self) -> Traceability {
        let entered = lock(&self.0);
        let mut trace = entered.trace.clone();
        if !entered.is_complete {
            trace.serial.clear();
        }
        trace
    }

    /// Sets the serial number of the next part.
    pub fn set_serial(&self, serial: &str) {
        let mut entered = lock(&self.0);
        entered.trace.serial = Traceability::cleaned(serial);
        entered.is_complete = true;
    }

    /// Returns the serial number that the user has just typed; leaves one that was complete before.
    pub(super) fn take_typed(&self) -> Option<String> {
        let mut entered = lock(&self.0);
        let was_complete = std::mem::replace(&mut entered.is_complete, true);
        let is_typed = !was_complete && !entered.trace.serial.trim().is_empty();
        is_typed.then(|| std::mem::take(&mut entered.trace.serial))
    }

    /// Returns the serial number that waits for the next part, which then has none.
    pub(super) fn take_waiting(&self) -> String {
        Traceability::cleaned(&std::mem::take(&mut lock(&self.0).trace.serial))
    }

    /// True if a complete serial number waits for its part.
    pub(crate) fn has_complete_serial(&self) -> bool {
        let entered = lock(&self.0);
        entered.is_complete && !Traceability::cleaned(&entered.trace.serial).is_empty()
    }

    /// Gives this part a serial number after its verdict, in place of a doubtful one.
    pub(super) fn give(&self, part: &Inspected, serial: &str, now: f64) {
        let former = self.of_part(part);
        let trace = Traceability {
            serial: Traceability::cleaned(serial),
            ..former.clone()
        };
        let hung = part.hung();
        let mut entered = lock(&self.0);
        if !former.serial.is_empty() {
            let change = TraceChange::ClearSerial(former.serial);
            entered.changes.push((hung.clone(), change));
        }
        let change = TraceChange::Fill(trace.clone());
        entered.changes.push((hung.clone(), change));
        entered.late = Some(LateSerial {
            hung: hung.clone(),
            says: names_part(&trace.serial, &part.entry.record.summary),
            trace,
            until: Some(now + MOVABLE),
        });
    }

    /// Moves the serial number that came last after a verdict to the next part, unless its time is over.
    pub(super) fn move_to_next(&self) {
        let entered = &mut *lock(&self.0);
        if let Some(late) = &mut entered.late
            && late.until.take().is_some()
        {
            let serial = std::mem::take(&mut late.trace.serial);
            let change = TraceChange::ClearSerial(serial.clone());
            entered.changes.push((late.hung.clone(), change));
            entered.trace.serial = serial;
            entered.is_complete = true;
        }
    }

    /// Notes that the serial number entered last is in doubt, or that none is.
    pub(super) fn doubt(&self, serial: Option<String>) {
        lock(&self.0).doubtful = serial;
    }

    /// True if this serial number is the one in doubt.
    pub(super) fn is_doubtful(&self, serial: &str) -> bool {
        lock(&self.0).doubtful.as_deref() == Some(serial)
    }

    /// True if this part's serial number came after its verdict, also if it was then moved to the next part.
    pub(crate) fn is_late_of(&self, part: &HungId) -> bool {
        let entered = lock(&self.0);
        entered.late.as_ref().is_some_and(|late| late.hung == *part)
    }

    /// Traceability of a part, with its serial number also if that came after the verdict.
    pub fn of_part(&self, part: &Inspected) -> Traceability {
        let own = part.trace().clone();
        let entered = lock(&self.0);
        let late = entered.late.iter().map(|late| (&late.hung, &late.trace));
        let earlier = entered.earlier.iter().map(|(hung, trace)| (hung, trace));
        let mut all = late.chain(earlier);
        match all.find(|(hung, _)| *hung == part.hung()) {
            Some((_, late)) => late.clone(),
            None => own,
        }
    }

    /// Time until the serial number that came last after a verdict can be moved, seconds of egui's clock.
    pub(super) fn movable_until(&self) -> Option<f64> {
        lock(&self.0).late.as_ref()?.until
    }

    /// Returns the changes to be written. A serial number can no longer be moved once its time is over or another part is on
    /// the screen.
    pub(super) fn settle(&self, shown: Option<&HungId>, now: f64) -> Vec<(HungId, TraceChange)> {
        let entered = &mut *lock(&self.0);
        if let Some(late) = &mut entered.late
            && let Some(until) = late.until
            && (now >= until || shown != Some(&late.hung))
        {
            late.until = None;
            let earlier = (late.hung.clone(), late.trace.clone());
            entered.earlier.push_front(earlier);
            entered.earlier.truncate(MAX_EARLIER);
        }
        std::mem::take(&mut entered.changes)
    }

    /// Replaces an entry by an edited text, unless it has changed since the user saw it as `before`: a serial number that was
    /// taken meanwhile must not come back for the next part.
    pub(super) fn edit(&self, entry: TraceEntry, before: &str, text: String) {
        let mut entered = lock(&self.0);
        let serial = entered.trace.serial.clone();
        let known = entry(&mut entered.trace);
        if *known == before {
            *known = text;
        }
        if entered.trace.serial != serial {
            entered.is_complete = false;
        }
    }

    /// Takes the values for an inspection. Uses up the serial number, so that the next part never gets it; if no part was
    /// found, or while the number is still being typed, it waits.
    pub fn take(&self, is_part: bool) -> Traceability {
        let EnteredTrace {
            trace, is_complete, ..
        } = &mut *lock(&self.0);
        let serial = if is_part && *is_complete {
            std::mem::take(&mut trace.serial)
        } else {
            String::new()
        };
        Traceability {
            serial: Traceability::cleaned(&serial),
            order: Traceability::cleaned(&trace.order),
            operator: Traceability::cleaned(&trace.operator),
        }
    }
}

/// One of the entries.
pub(super) type TraceEntry = fn(&mut Traceability) -> &mut String;

/// Names a serial number and the part that it went to.
pub(super) fn names_part(serial: &str, part: &Summary) -> String {
    let at = part.at.to_zoned(jiff::tz::TimeZone::system());
    text!(
        "operator-serial-of-part",
        serial = serial,
        part = inspection_title(part),
        time = at.strftime("%H:%M").to_string()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_serial_number_is_entered_when_its_field_is_left() {
        let trace = CurrentTrace::default();
        trace.edit(|trace| &mut trace.serial, "", "47".into());
        // Live does not take half of it.
        assert_eq!(trace.take(true).serial, "");
        assert_eq!(trace.take_typed().as_deref(), Some("47"));
        trace.set_serial("4712");
        assert_eq!(trace.take_typed(), None, "it waits for the next part");
    }

    #[test]
    fn a_serial_number_that_is_taken_while_a_field_is_edited_does_not_come_back() {
        let current = CurrentTrace::default();
        current.set_serial("4711");
        assert_eq!(current.take(true).serial, "4711");
        // Both fields were drawn before that.
        current.edit(|trace| &mut trace.serial, "4711", "47112".into());
        current.edit(|trace| &mut trace.order, "", "A 17".into());
        let left = current.get();
        assert_eq!((&*left.serial, &*left.order), ("", "A 17"));
    }

    #[test]
    fn a_serial_number_is_of_one_part_and_order_and_operator_of_many() {
        let current = CurrentTrace::starting(Traceability {
            serial: String::new(),
            order: "A 17".into(),
            operator: "Kim".into(),
        });
        current.set_serial(" 4711\n");
        assert_eq!(current.take(false).serial, "");
        let first = current.take(true);
        assert_eq!((&*first.serial, &*first.order), ("4711", "A 17"));
        let second = current.take(true);
        assert_eq!((&*second.serial, &*second.operator), ("", "Kim"));
    }
}
