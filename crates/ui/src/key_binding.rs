//! Keys and their effects.

use egui::{Key, Modifiers};

use crate::language;

/// Ctrl and Shift together.
pub const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// A key, with its texts in the list of shortcuts.
#[derive(Clone, Copy, Debug)]
pub struct KeyBinding {
    /// Modifiers held down with the key.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// Description of the effect for the user.
    pub does: fn() -> String,
    /// Text that names another key with the same effect, too.
    keys_as: Option<fn() -> String>,
}

impl KeyBinding {
    /// Name of key and modifiers for the user.
    pub fn keys(&self) -> String {
        if let Some(keys_as) = self.keys_as {
            return keys_as();
        }
        let key = match self.key {
            // Their symbols are in none of our typefaces.
            Key::ArrowUp | Key::ArrowDown => self.key.name(),
            Key::Escape => "Esc",
            key => key.symbol_or_name(),
        };
        let ctrl = self.modifiers.command.then_some("Ctrl");
        let shift = self.modifiers.shift.then_some("Shift");
        let names: Vec<&str> = ctrl.into_iter().chain(shift).chain([key]).collect();
        language::keys(&names.join(" "))
    }
}

/// A key and the action that it causes.
pub struct Shortcut<A> {
    /// The key.
    pub binding: KeyBinding,
    /// Makes the action.
    pub action: fn() -> A,
}

impl<A> Shortcut<A> {
    /// `key` held down with `modifiers` causes `action`, which `does` describes to the user.
    pub const fn new(
        modifiers: Modifiers,
        key: Key,
        does: fn() -> String,
        action: fn() -> A,
    ) -> Self {
        let binding = KeyBinding {
            modifiers,
            key,
            does,
            keys_as: None,
        };
        Self { binding, action }
    }

    /// Lists the shortcut with this name of its keys, because another key has the same effect.
    #[must_use]
    pub const fn keys_as(mut self, keys: fn() -> String) -> Self {
        self.binding.keys_as = Some(keys);
        self
    }
}
