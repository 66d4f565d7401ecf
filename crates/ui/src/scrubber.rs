//! A position along a line, moved by keys and by a screen reader: the timeline of Paint, the iterations of Align.

use egui::{Button, EventFilter, Key, Modifiers, Response, RichText, Ui, accesskit};

use super::widgets::labelled;
use crate::language::text;

/// Whether the position moves by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Playback {
    /// It stands still.
    #[default]
    Paused,
    /// It moves.
    Playing,
}

impl Playback {
    /// Draws the button that plays or pauses; true if it was pressed.
    pub fn button(self, ui: &mut Ui) -> bool {
        let text = match self {
            Self::Paused => text!("view-play"),
            Self::Playing => text!("view-pause"),
        };
        let button = Button::new(&text).shortcut_text(RichText::new("P").small().weak());
        labelled(ui, button, &text).clicked()
    }
}

/// The name of a scrubber and its position.
pub struct Scrubber {
    /// Name for a screen reader.
    pub label: String,
    /// Description of the keys, for a screen reader.
    pub keys: String,
    /// Position, 0..=`last`.
    pub position: f64,
    /// The end of the line.
    pub last: f64,
}

/// A motion requested by the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScrubberInput {
    /// Go to the beginning.
    First,
    /// Go to the end.
    Last,
    /// Move by steps (arrow keys); negative moves back.
    Steps(i32),
    /// Move by pages (Page Up, Page Down); negative moves back.
    Pages(i32),
    /// Play or pause.
    TogglePlay,
}

impl Scrubber {
    /// Describes it for a screen reader and returns the requested motions. Keys count only while it has the focus, requests of
    /// a screen reader always.
    pub fn input(&self, ui: &Ui, response: &Response) -> Vec<ScrubberInput> {
        let id = response.id;
        ui.accesskit_node_builder(id, |node| {
            node.set_role(accesskit::Role::Slider);
            node.set_label(self.label.clone());
            node.set_description(self.keys.clone());
            node.set_min_numeric_value(0.0);
            node.set_max_numeric_value(self.last);
            node.set_numeric_value(self.position);
            node.add_action(accesskit::Action::Increment);
            node.add_action(accesskit::Action::Decrement);
        });
        let mut steps = ui.input(|input| {
            let times = |asked| input.num_accesskit_action_requests(id, asked) as i32;
            times(accesskit::Action::Increment) - times(accesskit::Action::Decrement)
        });
        let mut asked = Vec::new();
        if response.has_focus() {
            // The scrubber uses the horizontal arrow keys; Tab still leaves it.
            let arrows = EventFilter {
                tab: false,
                horizontal_arrows: true,
                vertical_arrows: false,
                escape: false,
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
            let pressed = |key| {
                ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as i32
            };
            steps += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            let pages = pressed(Key::PageUp) - pressed(Key::PageDown);
            if pages != 0 {
                asked.push(ScrubberInput::Pages(pages));
            }
            for (key, input) in [
                (Key::Home, ScrubberInput::First),
                (Key::End, ScrubberInput::Last),
                (Key::Space, ScrubberInput::TogglePlay),
            ] {
                if pressed(key) > 0 {
                    asked.push(input);
                }
            }
        }
        if steps != 0 {
            asked.push(ScrubberInput::Steps(steps));
        }
        asked
    }
}
