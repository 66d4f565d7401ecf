//! Enters serial numbers for the part on the screen or for the next one, and draws the fields for them.

use egui::{Context, RichText, Ui, WidgetInfo};

use super::current_trace::{TraceEntry, names_part};
use crate::{
    action::Event,
    inspection::inspected::Inspected,
    notice::{Notice, NoticeTopic},
    session::Session,
};
use geometry::error::lock;
use records::history::{StoredVerdict, Traceability};
use ui::{
    language::text,
    theme::space,
    widgets::{line_edit, sentence, text_button},
};

/// Width of the label before a field, logical pixels.
pub(super) const LABEL_WIDTH_PX: f32 = 76.0;
impl Session {
    /// The part on the screen if it takes the serial number that is entered now; otherwise the number is of the next part.
    fn takes_serial(&self) -> Option<&Inspected> {
        let part = self.current_result()?;
        let is_part = part.entry.record.summary.verdict != StoredVerdict::NoPart;
        let serial = self.trace.of_part(part).serial;
        let is_free = serial.is_empty() && self.trace.movable_until().is_none();
        (is_part && (is_free || self.trace.is_doubtful(&serial))).then_some(part)
    }

    /// True if a part of this shift other than the latest has this serial number.
    fn is_in_shift(&self, serial: &str) -> bool {
        let latest = self.latest(|_| true).map(|part| part.hung());
        let mut rows = self.shift.last.iter();
        !serial.is_empty()
            && rows.any(|row| row.trace.serial == serial && Some(&row.hung) != latest)
    }

    /// Names the serial number of the part on the screen, if it has one, and says whether the number can be moved.
    fn serial_on_screen(&self) -> Option<(String, bool)> {
        let shown = self.shown.as_ref().filter(|shown| !shown.is_past)?;
        if let Some(late) = &lock(&self.trace.0).late
            && late.hung == *shown.inspected.hung()
        {
            let is_there = !late.trace.serial.is_empty();
            return is_there.then(|| (late.says.clone(), late.until.is_some()));
        }
        let part = self.current_result()?;
        let serial = &part.trace().serial;
        (!serial.is_empty()).then(|| (names_part(serial, &part.entry.record.summary), false))
    }

    /// Gives a complete serial number to its part, or keeps it for the next one.
    fn enter_serial(&self, serial: &str, now: f64) {
        let serial = Traceability::cleaned(serial);
        match self.takes_serial() {
            Some(part) => self.trace.give(part, &serial, now),
            None => self.trace.set_serial(&serial),
        }
        let is_doubtful = self.is_in_shift(&serial);
        self.trace.doubt(is_doubtful.then_some(serial));
    }

    /// Enters a scanned serial number, unless the part on the screen has it already. Returns what to tell the user.
    pub fn enter_scanned(&self, code: &str, now: f64) -> Option<Notice> {
        let serial = Traceability::cleaned(code);
        let latest = self.latest(|shown| !shown.is_past);
        if latest.is_some_and(|part| self.trace.of_part(part).serial == serial) {
            return Some(Notice::done(text!(
                "operator-serial-known",
                serial = serial
            )));
        }
        let former = Traceability::cleaned(&self.trace.get().serial);
        let part = self.takes_serial();
        if former == serial {
            // It waited for the next part, and is entered anew.
            self.trace.take_waiting();
        }
        self.enter_serial(&serial, now);
        if self.trace.is_doubtful(&serial) {
            let what = text!("operator-serial-in-shift", serial = serial);
            let notice = Notice::look(what, text!("operator-serial-in-shift-next"));
            return Some(notice.about(NoticeTopic::Serial));
        }
        if part.is_none() && !former.is_empty() && former != serial {
            let what = text!(
                "operator-serial-replaced",
                serial = serial,
                former = former.clone()
            );
            let next = text!("operator-serial-replaced-next", former = former);
            return Some(Notice::look(what, next).about(NoticeTopic::Serial));
        }
        // Other pages do not show to which part it goes.
        let is_seen = self.is_operator_view();
        (!is_seen).then(|| {
            Notice::done(match part {
                Some(part) => names_part(&serial, &part.entry.record.summary),
                None => text!("operator-serial-entered", serial = serial),
            })
        })
    }
}

/// Returns the events that write serial numbers which came after the verdict on their part, or were moved from there.
pub fn settle(session: &Session, now: f64) -> Vec<Event> {
    let latest = session.latest(|_| true).map(|part| part.hung());
    let mut events = Vec::new();
    for (hung, change) in session.trace.settle(latest, now) {
        // Live's next frames of this part have it.
        lock(&session.live.parts).traced(&hung, &change);
        events.push(Event::TracedLate(hung, change));
    }
    events
}

/// As [`settle`], in each frame of the window.
pub fn update(session: &Session, ctx: &Context) -> Vec<Event> {
    let now = ctx.input(|input| input.time);
    let events = settle(session, now);
    if let Some(until) = session.trace.movable_until() {
        ctx.request_repaint_after_secs((until - now).max(0.0) as f32);
    }
    events
}

/// Draws the input fields, and to which part the serial number goes.
pub fn fields(ui: &mut Ui, session: &Session) {
    first_fields(ui, session, 3);
}

/// Draws the input fields that a table of orders asks for: serial number and order.
pub fn fields_of_order(ui: &mut Ui, session: &Session) {
    first_fields(ui, session, 2);
}

fn first_fields(ui: &mut Ui, session: &Session, num: usize) {
    let trace = &session.trace;
    let hint = match session.takes_serial() {
        Some(_) => text!("operator-serial-hint-this"),
        None => text!("operator-serial-hint-next"),
    };
    let entries: [(String, String, TraceEntry); 3] = [
        (text!("operator-serial"), hint, |trace| &mut trace.serial),
        (sentence(&text!("inspect-order")), String::new(), |trace| {
            &mut trace.order
        }),
        (
            sentence(&text!("inspect-operator")),
            String::new(),
            |trace| &mut trace.operator,
        ),
    ];
    for (index, (name, says, entry)) in entries.into_iter().enumerate().take(num) {
        let before = std::mem::take(entry(&mut trace.get()));
        let mut text = before.clone();
        let field = ui.horizontal(|ui| {
            ui.set_min_height(space::TARGET);
            let from = ui.cursor().left();
            let label = ui.label(RichText::new(&name).weak());
            ui.add_space((from + LABEL_WIDTH_PX - ui.cursor().left()).max(0.0));
            let field =
                line_edit(&mut text, says, f32::INFINITY).char_limit(Traceability::MAX_LETTERS);
            let field = ui.add(field).labelled_by(label.id);
            field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &name));
            field
        });
        if text != before {
            trace.edit(entry, &before, text);
        }
        if field.inner.lost_focus()
            && let Some(typed) = trace.take_typed()
        {
            session.enter_serial(&typed, ui.input(|input| input.time));
        }
        if index == 0 {
            serial_goes_to(ui, session);
        }
    }
}

/// Draws to which part the serial number goes or went, with a button that moves it to the other one.
fn serial_goes_to(ui: &mut Ui, session: &Session) {
    let trace = &session.trace;
    let is_free = trace.get().serial.trim().is_empty();
    if let Some((says, is_movable)) = session.serial_on_screen() {
        ui.label(RichText::new(says).small().weak());
        // Only one number can wait for the next part.
        if is_movable && is_free && text_button(ui, &text!("operator-serial-move-next")).clicked() {
            trace.move_to_next();
        }
    }
    if trace.has_complete_serial() {
        ui.label(
            RichText::new(text!("operator-serial-for-next"))
                .small()
                .weak(),
        );
        let can_move = session.takes_serial().is_some();
        if can_move && text_button(ui, &text!("operator-serial-move-this")).clicked() {
            let now = ui.input(|input| input.time);
            session.enter_serial(&trace.take_waiting(), now);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::Shown,
        trace::current_trace::MOVABLE,
    };
    use records::history::{HungId, TraceChange};

    /// A session that shows a new inspection.
    fn showing(session: Session, choice: CellChoice) -> Session {
        let generation = session
            .shown
            .as_ref()
            .map_or(1, |shown| shown.generation + 1);
        Session {
            shown: Some(Shown::new(generation, Arc::new(inspected_cell(choice, 1)))),
            ..session
        }
    }

    /// What is to be written now: to which part a serial number is added (`+`), and from which one it is taken (`-`).
    fn written(session: &Session, now: f64) -> Vec<(HungId, String)> {
        let changes = settle(session, now).into_iter().map(|event| {
            let Event::TracedLate(hung, change) = event else {
                panic!("{event:?}");
            };
            match change {
                TraceChange::Fill(trace) => (hung, format!("+{}", trace.serial)),
                TraceChange::ClearSerial(serial) => (hung, format!("-{serial}")),
            }
        });
        changes.collect()
    }

    fn hung(session: &Session) -> HungId {
        let shown = session.shown.as_ref().expect("shown");
        shown.inspected.hung().clone()
    }

    #[test]
    fn a_serial_number_is_of_the_part_on_the_screen_unless_that_has_one() {
        let session = showing(Session::default(), CellChoice::InTurn);
        session.enter_scanned("4711", 0.0);
        assert_eq!(session.trace.get().serial, "");
        let known = session.enter_scanned("4711", 1.0).expect("said");
        assert!(known.what.contains("already"), "{known:?}");
        session.enter_scanned("4712", 2.0);
        assert_eq!(session.trace.get().serial, "4712");
        // It is written at once.
        let first = hung(&session);
        assert_eq!(
            written(&session, 3.0),
            [(first.clone(), "+4711".to_owned())]
        );
        let session = showing(session, CellChoice::InTurn);
        assert!(written(&session, 4.0).is_empty(), "once");
        // An inspection that is still in memory shows it.
        let inspected = Arc::clone(&session.shown.as_ref().expect("shown").inspected);
        session.enter_scanned("4713", 5.0);
        let mut before = inspected_cell(CellChoice::InTurn, 1);
        before.entry.record.summary.hung = first;
        assert_eq!(session.trace.of_part(&before).serial, "4711");
        assert_eq!(session.trace.of_part(&inspected).serial, "4713");
        // An empty cell, or a result that does not count any more, takes none.
        let empty = showing(Session::default(), CellChoice::Empty);
        let mut past = showing(Session::default(), CellChoice::InTurn);
        past.shown.as_mut().expect("shown").is_past = true;
        let mut failed = showing(Session::default(), CellChoice::InTurn);
        failed.failed = Some(ui::user_error::UserError {
            what: "no frame".into(),
            advice: String::new(),
        });
        for session in [empty, past, failed] {
            session.enter_scanned("4713", 0.0);
            assert_eq!(session.trace.get().serial, "4713");
        }
    }

    #[test]
    fn a_late_serial_number_is_written_at_once_and_moves_to_the_next_part_and_back_for_a_while() {
        let session = showing(Session::default(), CellChoice::InTurn);
        session.enter_scanned("4711", 0.0);
        let (says, is_movable) = session.serial_on_screen().expect("given");
        assert!(
            says.contains("4711") && says.contains("Front door"),
            "{says}"
        );
        assert!(is_movable);
        session.trace.move_to_next();
        assert!(session.serial_on_screen().is_none());
        assert_eq!(session.trace.get().serial, "4711");
        // The row has it no longer.
        let part = hung(&session);
        let moved = ["+4711", "-4711"].map(|change| (part.clone(), change.to_owned()));
        assert_eq!(written(&session, 0.5), moved);
        session.enter_serial(&session.trace.take_waiting(), 1.0);
        assert!(session.trace.is_late_of(&part));
        assert_eq!(
            written(&session, 1.0 + MOVABLE),
            [(part, "+4711".to_owned())]
        );
        session.trace.move_to_next();
        assert_eq!(session.trace.get().serial, "", "it stays");
        assert!(
            session
                .serial_on_screen()
                .is_some_and(|(_, is_movable)| !is_movable)
        );
    }

    #[test]
    fn the_scan_after_a_number_of_another_part_replaces_it_on_its_part() {
        let mut row = inspected_cell(CellChoice::InTurn, 1).entry.record.summary;
        row.trace.serial = "A-001".into();
        let in_shift = || {
            let mut session = Session::default();
            session.shift.last.push(row.clone());
            session
        };
        // Scanned after the verdict, however long that was ago.
        let session = showing(in_shift(), CellChoice::InTurn);
        let warning = session.enter_scanned("A-001", 0.0).expect("said");
        assert!(warning.what.contains("A-001 is already"), "{warning:?}");
        let part = hung(&session);
        assert_eq!(
            written(&session, 99.0),
            [(part.clone(), "+A-001".to_owned())]
        );
        session.enter_scanned("A-002", 100.0);
        let changes = ["-A-001", "+A-002"].map(|change| (part.clone(), change.to_owned()));
        assert_eq!(written(&session, 101.0), changes);
        assert_eq!(session.trace.get().serial, "", "none is for the next part");
        let shown = session.shown.as_ref().expect("shown");
        assert_eq!(session.trace.of_part(&shown.inspected).serial, "A-002");
        // The one after that is for the next part again.
        session.enter_scanned("A-003", 102.0);
        assert_eq!(session.trace.get().serial, "A-003");

        // Scanned before the verdict.
        let session = in_shift();
        session.enter_scanned("A-001", 0.0);
        let mut session = showing(session, CellChoice::InTurn);
        let trace = session.trace.take(true);
        let shown = session.shown.as_mut().expect("shown");
        shown.parts.clear();
        let inspected = Arc::get_mut(&mut shown.inspected).expect("not shared");
        inspected.entry.record.summary.trace = trace;
        shown.parts = vec![Arc::clone(&shown.inspected)];
        session.enter_scanned("A-002", 1.0);
        let shown = session.shown.as_ref().expect("shown");
        assert_eq!(session.trace.of_part(&shown.inspected).serial, "A-002");
        assert_eq!(session.trace.get().serial, "");
    }
}
