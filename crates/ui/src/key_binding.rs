//! Keys and their effects.

use egui::{Key, Modifiers};

/// A key, with its texts in the list of shortcuts.
#[derive(Clone, Copy, Debug)]
pub struct KeyBinding {
    /// Modifiers held down with the key.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// Name of key and modifiers for the user.
    pub keys: fn() -> String,
    /// Description of the effect for the user.
    pub does: fn() -> String,
}

/// A key and the action that it causes.
pub struct Shortcut<A> {
    /// Modifiers held down with the key.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// Name of key and modifiers for the user.
    pub keys: fn() -> String,
    /// Description of the effect for the user.
    pub does: fn() -> String,
    /// Makes the action.
    pub action: fn() -> A,
}

impl<A> Shortcut<A> {
    /// The key without the action.
    pub fn binding(&self) -> KeyBinding {
        KeyBinding {
            modifiers: self.modifiers,
            key: self.key,
            keys: self.keys,
            does: self.does,
        }
    }
}
