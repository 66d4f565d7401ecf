//! Keys, and what they do.

use egui::{Key, Modifiers};

/// A key, and how the list of shortcuts names it.
#[derive(Clone, Copy, Debug)]
pub struct KeyBinding {
    /// Keys held down with it.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// Both, for a person.
    pub keys: fn() -> String,
    /// What it does, for a person.
    pub does: fn() -> String,
}

/// A key and the action that it causes.
pub struct Shortcut<A> {
    /// Keys held down with it.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// Both, for a person.
    pub keys: fn() -> String,
    /// What it does, for a person.
    pub does: fn() -> String,
    /// Makes the action.
    pub action: fn() -> A,
}

impl<A> Shortcut<A> {
    /// The key alone.
    pub fn binding(&self) -> KeyBinding {
        KeyBinding {
            modifiers: self.modifiers,
            key: self.key,
            keys: self.keys,
            does: self.does,
        }
    }
}
