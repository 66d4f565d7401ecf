//! Enters serial numbers, by hand or with a barcode scanner, for the part on the screen or for the next one, and draws the fields
//! for them.
//!
//! A scanner acts as a keyboard that types a code within milliseconds and ends it with Enter or Tab. In the operator's view no
//! field needs the focus for it. Typed keys are held back for a moment: a code that ends in time is the serial number; anything
//! else was typed by hand and is passed on to the shortcuts. The same holds in front of a dialog, with a shorter moment: a scan
//! does not change its text field, and its Enter does not confirm the dialog. While that field has the focus, only keys that come
//! at a scanner's speed over several frames are a scan: in a slow frame, keys of a hand arrive together. A text field elsewhere
//! keeps all its keys.

use egui::{Context, Id, Key, RichText, Ui, WidgetInfo};

use crate::{
    action::Event,
    inspection::inspected::Inspected,
    notice::{Notice, NoticeTopic},
    session::Session,
    trace::current_trace::{TraceEntry, names_part},
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

/// Maximum time between two keys of a scanner, seconds; typing by hand is slower.
const MAX_KEY_GAP_S: f64 = 0.15;
/// The same in a dialog, where keys typed by hand must appear at once; a scanner takes some 10 ms for a key.
const MAX_KEY_GAP_IN_DIALOG_S: f64 = 0.05;
/// Minimum number of letters of a code.
const LEAST_LETTERS: usize = 3;
/// While a dialog's text field has the focus: minimum number of frames before the end of a code, and maximum time for each of its
/// letters, seconds.
const LEAST_FRAMES: usize = 3;
const MAX_LETTER_TIME_S: f64 = 0.03;

/// What typed keys are for, unless they are a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyTarget {
    /// The page in front, with its shortcuts and text fields.
    Page,
    /// A dialog.
    Dialog,
}

/// Whether typed keys are held back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Holding {
    /// All keys belong to the text field that has the focus.
    Never,
    /// For shortcuts.
    OnPage,
    /// For a dialog: keys typed by hand keep their order.
    InDialog,
    /// For a dialog whose text field has the focus.
    InField,
}

impl Holding {
    /// Time after the last key until held keys are passed on, seconds.
    fn gap(self) -> f64 {
        match self {
            Self::Never | Self::OnPage => MAX_KEY_GAP_S,
            Self::InDialog | Self::InField => MAX_KEY_GAP_IN_DIALOG_S,
        }
    }
}

/// Typed keys that are held back.
#[derive(Clone, Debug, Default)]
struct Held {
    events: Vec<egui::Event>,
    text: String,
    /// When the first and the last of them came, seconds of egui's clock.
    first: f64,
    last: f64,
    /// Number of frames in which they came.
    num_frames: usize,
}

/// Returns the code of a scanner once it is complete. Must be called before anything else reads the keys.
pub fn listen(ctx: &Context, target: KeyTarget) -> Option<String> {
    let id = Id::unique("scanner");
    let mut held: Held = ctx
        .data_mut(|data| data.remove_temp(id))
        .unwrap_or_default();
    let holding = match (target, ctx.text_edit_focused()) {
        (KeyTarget::Page, true) => Holding::Never,
        (KeyTarget::Page, false) => Holding::OnPage,
        (KeyTarget::Dialog, true) => Holding::InField,
        (KeyTarget::Dialog, false) => Holding::InDialog,
    };
    let was_held = !held.events.is_empty();
    let code = ctx.input_mut(|input| held.hold_back(&mut input.events, input.time, holding));
    if code.is_some() {
        // If the code ended with Tab, the focus stays where it is.
        ctx.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
    }
    if was_held && held.events.is_empty() {
        // Request a frame that shows the effect of the keys: egui saw them earlier and does not repaint by itself.
        ctx.request_repaint();
    }
    if !held.events.is_empty() {
        ctx.request_repaint_after_secs(holding.gap() as f32);
        ctx.data_mut(|data| data.insert_temp(id, held));
    }
    code
}

impl Held {
    fn hold_back(
        &mut self,
        events: &mut Vec<egui::Event>,
        now: f64,
        holding: Holding,
    ) -> Option<String> {
        let (mut code, mut others, mut is_typed) = (None, Vec::new(), false);
        if holding == Holding::InField && now - self.last > holding.gap() {
            self.pass_on(&mut others);
        }
        for event in std::mem::take(events) {
            let is_of_code = holding != Holding::Never
                && match &event {
                    egui::Event::Text(text) => {
                        let is_text = !(self.text.is_empty() && text.trim().is_empty());
                        if is_text {
                            self.text.push_str(text);
                        }
                        is_text
                    }
                    egui::Event::Key {
                        key: Key::Enter | Key::Tab,
                        pressed: true,
                        ..
                    } if self.is_code(now, holding) => {
                        code = Some(std::mem::take(&mut self.text));
                        self.events.clear();
                        self.num_frames = 0;
                        continue;
                    }
                    egui::Event::Key {
                        key,
                        pressed: true,
                        modifiers,
                        ..
                    } => is_letter(*key, &self.text) && !modifiers.command && !modifiers.alt,
                    _ => false,
                };
            if is_of_code {
                self.events.push(event);
                is_typed = true;
            } else {
                let keeps_order = matches!(holding, Holding::InDialog | Holding::InField);
                if keeps_order && acts_on_text(&event) {
                    self.pass_on(&mut others);
                }
                others.push(event);
            }
        }
        if is_typed {
            if self.num_frames == 0 {
                self.first = now;
            }
            self.num_frames += 1;
            self.last = now;
        } else if holding == Holding::Never || now - self.last > holding.gap() {
            let later = std::mem::take(&mut others);
            self.pass_on(&mut others);
            others.extend(later);
        }
        *events = others;
        code
    }

    /// True if the held keys are a code, which ends now.
    fn is_code(&self, now: f64, holding: Holding) -> bool {
        let num = self.text.chars().count();
        let is_fast =
            self.num_frames >= LEAST_FRAMES && now - self.first <= MAX_LETTER_TIME_S * num as f64;
        num >= LEAST_LETTERS && (is_fast || holding != Holding::InField)
    }

    /// Passes on the held keys: they were typed by hand.
    fn pass_on(&mut self, others: &mut Vec<egui::Event>) {
        others.append(&mut self.events);
        self.text.clear();
        self.num_frames = 0;
    }
}

/// True for a key that types a character; a blank counts only within a code.
fn is_letter(key: Key, text: &str) -> bool {
    match key {
        Key::Space => !text.is_empty(),
        key => key.symbol_or_name().chars().count() == 1,
    }
}

/// True for an event that must not overtake text typed before it, such as Backspace, Enter or a click.
fn acts_on_text(event: &egui::Event) -> bool {
    match event {
        // A scanner holds Shift for capital letters.
        egui::Event::Key {
            key: Key::ShiftLeft | Key::ShiftRight,
            ..
        } => false,
        egui::Event::Key { pressed, .. } | egui::Event::PointerButton { pressed, .. } => *pressed,
        egui::Event::Copy
        | egui::Event::Cut
        | egui::Event::Paste(_)
        | egui::Event::Text(_)
        | egui::Event::Ime(_) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use egui::Modifiers;

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
                TraceChange::Fill(trace) | TraceChange::Set(trace) => {
                    (hung, format!("+{}", trace.serial))
                }
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

    fn key(key: Key) -> egui::Event {
        egui::Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        }
    }

    /// The events of a scanner that types a code and Enter.
    fn typed(code: &str) -> Vec<egui::Event> {
        let letters = code.chars().flat_map(|letter| {
            let pressed = Key::from_name(&letter.to_uppercase().to_string()).map(key);
            pressed
                .into_iter()
                .chain([egui::Event::Text(letter.into())])
        });
        letters.chain([key(Key::Enter)]).collect()
    }

    #[test]
    fn a_code_that_comes_over_several_frames_is_one_and_no_key_of_it_goes_on() {
        let all = typed("TL-4711 B");
        for size in [1, 2, 5, 100] {
            let mut held = Held::default();
            let mut codes = Vec::new();
            for (frame, events) in all.chunks(size).enumerate() {
                let mut events = events.to_vec();
                codes.extend(held.hold_back(&mut events, 0.02 * frame as f64, Holding::OnPage));
                assert!(events.is_empty(), "{events:?}");
            }
            assert_eq!(codes, ["TL-4711 B"]);
        }
    }

    #[test]
    fn what_keys_of_a_hand_do_is_drawn_without_another_event() {
        let ctx = Context::default();
        let delay_after = |time, events| {
            let input = egui::RawInput {
                time: Some(time),
                events,
                ..egui::RawInput::default()
            };
            let mut output = ctx.run_ui(input, |ui| {
                listen(ui.ctx(), KeyTarget::Page);
            });
            let delay = output.viewport_output[&egui::ViewportId::ROOT].repaint_delay;
            output.viewport_output.clear();
            output.drop_without_applying_deltas();
            delay
        };
        for time in [0.1, 0.2, 0.3, 0.4] {
            delay_after(time, Vec::new());
        }
        assert!(!delay_after(0.5, Vec::new()).is_zero());
        delay_after(1.0, vec![key(Key::T), egui::Event::Text("t".into())]);
        // egui draws a few frames after any input.
        for time in [1.02, 1.04, 1.06] {
            delay_after(time, Vec::new());
        }
        assert!(!delay_after(1.08, Vec::new()).is_zero(), "held back");
        assert!(delay_after(1.2, Vec::new()).is_zero());
    }

    #[test]
    fn keys_of_a_hand_go_on_after_a_moment_and_blank_and_enter_at_once() {
        let mut held = Held::default();
        let mut events = vec![key(Key::L), egui::Event::Text("l".into())];
        let before = events.clone();
        assert_eq!(held.hold_back(&mut events, 1.0, Holding::OnPage), None);
        assert!(events.is_empty());
        assert_eq!(held.hold_back(&mut events, 1.2, Holding::OnPage), None);
        assert_eq!(events, before);
        let mut events = vec![
            key(Key::Space),
            egui::Event::Text(" ".into()),
            key(Key::Enter),
        ];
        let before = events.clone();
        assert_eq!(held.hold_back(&mut events, 2.0, Holding::OnPage), None);
        assert_eq!(events, before);
        // While the user types into a field, all keys belong to the field.
        let mut events = typed("4711");
        let before = events.clone();
        assert_eq!(held.hold_back(&mut events, 3.0, Holding::Never), None);
        assert_eq!(events, before);
    }
    #[test]
    fn in_a_field_only_what_comes_like_a_scanner_over_several_frames_is_a_code() {
        let all = typed("15151");
        let heard = |num_events: usize, frame_time: f64| {
            let mut held = Held::default();
            let (mut codes, mut passed) = (Vec::new(), Vec::new());
            for (frame, events) in all.chunks(num_events).enumerate() {
                let mut events = events.to_vec();
                let now = 1.0 + frame_time * frame as f64;
                codes.extend(held.hold_back(&mut events, now, Holding::InField));
                passed.extend(events);
            }
            (codes, passed)
        };
        // One key in each frame, and at last Enter.
        assert_eq!(heard(2, 0.012), (vec!["15151".to_owned()], Vec::new()));
        // All in one frame, two keys in each slow frame, and quick fingers.
        for (num_events, frame_time) in [(100, 0.0), (4, 0.3), (2, 0.15), (2, 0.045)] {
            let nothing = Vec::<String>::new();
            assert_eq!(heard(num_events, frame_time), (nothing, all.clone()));
        }
    }

    #[test]
    fn in_a_dialog_a_code_is_held_back_and_keys_of_a_hand_keep_their_order() {
        let mut held = Held::default();
        let mut events = typed("15151");
        let code = held.hold_back(&mut events, 1.0, Holding::InDialog);
        assert_eq!(code.as_deref(), Some("15151"));
        assert!(events.is_empty(), "{events:?}");
        // Backspace and Enter do not overtake the letter before them.
        for last in [Key::Backspace, Key::Enter] {
            let mut events = vec![key(Key::A), egui::Event::Text("a".into()), key(last)];
            let before = events.clone();
            assert_eq!(held.hold_back(&mut events, 2.0, Holding::InDialog), None);
            assert_eq!(events, before);
        }
        // Three letters by hand, one at a time, and then Enter.
        let mut passed = Vec::new();
        let by_hand = typed("csv");
        for (number, events) in by_hand.chunks(2).enumerate() {
            for (after, mut events) in [(0.0, events.to_vec()), (0.06, Vec::new())] {
                let now = 3.0 + 0.1 * number as f64 + after;
                assert_eq!(held.hold_back(&mut events, now, Holding::InDialog), None);
                passed.extend(events);
            }
        }
        assert_eq!(passed, by_hand);
    }
}
