//! A barcode scanner: acts as a keyboard that types a code within milliseconds and ends it with Enter or Tab.
//!
//! In the operator's view no field needs the focus for it. Typed keys are held back for a moment: a code that ends in time is
//! the serial number; anything else was typed by hand and is passed on to the shortcuts. The same holds in front of a dialog,
//! with a shorter moment: a scan does not change its text field, and its Enter does not confirm the dialog. A text field
//! elsewhere keeps all its keys.

use egui::{Context, Event, Id, Key};

/// Maximum time between two keys of a scanner, seconds; typing by hand is slower.
const GAP: f64 = 0.15;
/// The same in a dialog, where keys typed by hand must appear at once; a scanner takes some 10 ms for a key.
const GAP_IN_DIALOG: f64 = 0.05;
/// Minimum number of letters of a code.
const LEAST_LETTERS: usize = 3;

/// What typed keys are for, unless they are a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum KeyTarget {
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
}

impl Holding {
    /// Time after the last key until held keys are passed on, seconds.
    fn gap(self) -> f64 {
        match self {
            Self::Never | Self::OnPage => GAP,
            Self::InDialog => GAP_IN_DIALOG,
        }
    }
}

/// Typed keys that are held back.
#[derive(Clone, Debug, Default)]
struct Held {
    events: Vec<Event>,
    text: String,
    last: f64,
}

/// Returns the code of a scanner once it is complete. Must be called before anything else reads the keys.
pub(in crate::app) fn listen(ctx: &Context, target: KeyTarget) -> Option<String> {
    let id = Id::unique("scanner");
    let mut held: Held = ctx
        .data_mut(|data| data.remove_temp(id))
        .unwrap_or_default();
    let holding = match target {
        KeyTarget::Dialog => Holding::InDialog,
        KeyTarget::Page if ctx.text_edit_focused() => Holding::Never,
        KeyTarget::Page => Holding::OnPage,
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
    fn hold_back(&mut self, events: &mut Vec<Event>, now: f64, holding: Holding) -> Option<String> {
        let (mut code, mut others, mut is_typed) = (None, Vec::new(), false);
        for event in std::mem::take(events) {
            let is_of_code = holding != Holding::Never
                && match &event {
                    Event::Text(text) => {
                        let is_text = !(self.text.is_empty() && text.trim().is_empty());
                        if is_text {
                            self.text.push_str(text);
                        }
                        is_text
                    }
                    Event::Key {
                        key: Key::Enter | Key::Tab,
                        pressed: true,
                        ..
                    } if self.text.chars().count() >= LEAST_LETTERS => {
                        code = Some(std::mem::take(&mut self.text));
                        self.events.clear();
                        continue;
                    }
                    Event::Key {
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
                if holding == Holding::InDialog && acts_on_text(&event) {
                    others.append(&mut self.events);
                    self.text.clear();
                }
                others.push(event);
            }
        }
        if is_typed {
            self.last = now;
        } else if holding == Holding::Never || now - self.last > holding.gap() {
            others.splice(0..0, self.events.drain(..));
            self.text.clear();
        }
        *events = others;
        code
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
fn acts_on_text(event: &Event) -> bool {
    match event {
        // A scanner holds Shift for capital letters.
        Event::Key {
            key: Key::ShiftLeft | Key::ShiftRight,
            ..
        } => false,
        Event::Key { pressed, .. } | Event::PointerButton { pressed, .. } => *pressed,
        Event::Copy | Event::Cut | Event::Paste(_) | Event::Text(_) | Event::Ime(_) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use egui::Modifiers;

    use super::*;

    fn key(key: Key) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        }
    }

    /// The events of a scanner that types a code and Enter.
    fn typed(code: &str) -> Vec<Event> {
        let letters = code.chars().flat_map(|letter| {
            let pressed = Key::from_name(&letter.to_uppercase().to_string()).map(key);
            pressed.into_iter().chain([Event::Text(letter.into())])
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
        delay_after(1.0, vec![key(Key::T), Event::Text("t".into())]);
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
        let mut events = vec![key(Key::L), Event::Text("l".into())];
        let before = events.clone();
        assert_eq!(held.hold_back(&mut events, 1.0, Holding::OnPage), None);
        assert!(events.is_empty());
        assert_eq!(held.hold_back(&mut events, 1.2, Holding::OnPage), None);
        assert_eq!(events, before);
        let mut events = vec![key(Key::Space), Event::Text(" ".into()), key(Key::Enter)];
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
    fn in_a_dialog_a_code_goes_to_no_field_and_keys_of_a_hand_keep_their_order() {
        let mut held = Held::default();
        let mut events = typed("15151");
        let code = held.hold_back(&mut events, 1.0, Holding::InDialog);
        assert_eq!(code.as_deref(), Some("15151"));
        assert!(events.is_empty(), "{events:?}");
        // Backspace and Enter do not overtake the letter before them.
        for last in [Key::Backspace, Key::Enter] {
            let mut events = vec![key(Key::A), Event::Text("a".into()), key(last)];
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
