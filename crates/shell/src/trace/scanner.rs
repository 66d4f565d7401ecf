//! A barcode scanner: acts as a keyboard that types a code within milliseconds and ends it with Enter or Tab.
//!
//! In the operator's view no field needs the focus for it. Typed keys are held back for a moment: a code that ends in time is
//! the serial number; anything else was typed by hand and is passed on to the shortcuts. The same holds in front of a dialog,
//! with a shorter moment: a scan does not change its text field, and its Enter does not confirm the dialog. While that field has
//! the focus, only keys that come at a scanner's speed over several frames are a scan: in a slow frame, keys of a hand arrive
//! together. A text field elsewhere keeps all its keys.

use egui::{Context, Event, Id, Key};

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
    events: Vec<Event>,
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
    fn hold_back(&mut self, events: &mut Vec<Event>, now: f64, holding: Holding) -> Option<String> {
        let (mut code, mut others, mut is_typed) = (None, Vec::new(), false);
        if holding == Holding::InField && now - self.last > holding.gap() {
            self.pass_on(&mut others);
        }
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
                    } if self.is_code(now, holding) => {
                        code = Some(std::mem::take(&mut self.text));
                        self.events.clear();
                        self.num_frames = 0;
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
    fn pass_on(&mut self, others: &mut Vec<Event>) {
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
