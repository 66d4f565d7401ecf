//! The dialog that asks for a PIN: a keypad for gloved hands, and keyboard input.

use egui::{Button, Context, Event, Key, RichText, Ui, vec2};

use super::{RoleAction, RoleQuestion, question::MOST_DIGITS};
use crate::{action::Action, state::State};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::{self, text_button},
};

/// Width and height of a digit's button, logical pixels.
const DIGIT: [f32; 2] = [76.0, 52.0];

/// Draws the dialog while something is asked.
pub fn dialog(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ctx);
    let Some(asked) = &state.roles.asked else {
        return;
    };
    let asks_pin = match asked.question {
        RoleQuestion::MayI(_) => state.roles.pin.is_some(),
        RoleQuestion::NewPin | RoleQuestion::NewPinAgain(_) => true,
        RoleQuestion::RemovePin => false,
    };
    let (title, says, done) = match asked.question {
        RoleQuestion::MayI(_) if asks_pin => (
            text!("shell-engineers-view"),
            text!("shell-enter-pin"),
            text!("shell-unlock"),
        ),
        RoleQuestion::MayI(_) => (
            text!("shell-engineers-view"),
            text!("shell-may-change"),
            text!("shell-switch"),
        ),
        RoleQuestion::NewPin => (
            text!("shell-new-pin"),
            text!("shell-new-pin-says"),
            text!("shell-next"),
        ),
        RoleQuestion::NewPinAgain(_) => (
            text!("shell-new-pin"),
            text!("shell-same-digits"),
            text!("shell-set-the-pin"),
        ),
        RoleQuestion::RemovePin => (
            text!("shell-engineers-view"),
            text!("shell-remove-pin-asked"),
            text!("shell-remove-pin"),
        ),
    };
    if asks_pin {
        // Before the Enter of the same frame.
        typed(ctx, actions);
    }
    let modal = widgets::dialog(ctx, "role", |ui| {
        ui.set_max_width(3.0 * DIGIT[0] + 2.0 * ui.spacing().item_spacing.x);
        ui.heading(title);
        ui.weak(says);
        if asks_pin {
            pad(ui, &asked.digits, actions);
        }
        ui.add_space(space::SMALL);
        if let Some(wrong) = &asked.wrong {
            let text = RichText::new(wrong).font(font::body_strong());
            ui.label(text.color(theme.warning));
            if matches!(asked.question, RoleQuestion::MayI(_)) {
                let forgotten = text!("shell-pin-forgotten");
                ui.label(RichText::new(forgotten).small().weak());
            }
            ui.add_space(space::SMALL);
        }
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &done, true) {
                actions.push(Action::Role(RoleAction::Enter));
            }
            if text_button(ui, &text!("shell-cancel")).clicked() {
                actions.push(Action::Role(RoleAction::Close));
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::Role(RoleAction::Close));
    }
}

/// Draws the digits typed so far as dots, and the keypad.
fn pad(ui: &mut Ui, digits: &str, actions: &mut Vec<Action>) {
    ui.add_space(space::MEDIUM);
    let dots = "●".repeat(digits.len()) + &"·".repeat(MOST_DIGITS - digits.len());
    let shown = ui.label(RichText::new(dots).font(font::title()));
    shown.widget_info(|| {
        let says = text!("shell-num-digits", num = digits.len());
        egui::WidgetInfo::labeled(egui::Role::Label, true, says)
    });
    for row in ["123", "456", "789", " 0<"] {
        ui.horizontal(|ui| {
            for key in row.chars() {
                let (text, says, action) = match key {
                    ' ' => {
                        ui.add_space(DIGIT[0] + ui.spacing().item_spacing.x);
                        continue;
                    }
                    '<' => (
                        text!("shell-erase"),
                        text!("shell-erase"),
                        RoleAction::Erase,
                    ),
                    digit => (
                        digit.into(),
                        text!("shell-digit", digit = digit.to_string()),
                        RoleAction::Digit(digit),
                    ),
                };
                let button = ui.add_sized(vec2(DIGIT[0], DIGIT[1]), Button::new(text));
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &says));
                if button.clicked() {
                    actions.push(Action::Role(action));
                }
            }
        });
    }
}

/// Reads digits and keys from the keyboard.
fn typed(ctx: &Context, actions: &mut Vec<Action>) {
    ctx.input(|input| {
        for event in &input.events {
            match event {
                Event::Text(text) => {
                    let digits = text.chars().filter(char::is_ascii_digit);
                    actions.extend(digits.map(|d| Action::Role(RoleAction::Digit(d))));
                }
                Event::Key {
                    key: Key::Backspace,
                    pressed: true,
                    ..
                } => actions.push(Action::Role(RoleAction::Erase)),
                _ => {}
            }
        }
    });
}
