//! The texts of the window in every language, in Mozilla's Fluent format: `assets/language/<language>/<area>.ftl`. Those of
//! the library are in the crate `texts`, see [`described`].
//!
//! `text!` takes a message id and variables. The language is a property of the thread: the window sets it at the start of each
//! frame, and a task's thread inherits it from whoever starts the task. A message missing in a language is shown in English; a
//! test reports it.

/// Formats a message in this thread's language, with the values of its variables: whole numbers, which can select a plural,
/// and strings. Pass numbers with decimals as strings, so that they have a decimal point in every language.
#[macro_export]
macro_rules! text {
    ($id:literal) => {
        $crate::language::plain($id)
    };
    ($id:literal, $($name:ident = $value:expr),+ $(,)?) => {
        $crate::language::with($id, [$((stringify!($name), $crate::language::FluentValue::from($value))),+])
    };
}
pub use crate::text;

mod catalogue;
pub mod parameters;

use texts::Described;

pub use fluent_bundle::FluentValue;
pub use texts::{Language, Message};

pub use self::catalogue::{plain, with};

/// The first language of the system that is supported, else English.
pub fn language_of_system() -> Language {
    let mut locales = sys_locale::get_locales();
    let spoken = locales.find_map(|locale| Language::from_locale(&locale));
    spoken.unwrap_or_default()
}

/// Returns the text of what the library describes.
pub fn described(what: &impl Described) -> String {
    what.message().text(Language::current())
}

/// Returns what to do about what the library describes.
pub fn advised(what: &impl Described) -> String {
    what.message().advice(Language::current())
}

/// Returns the text of what the library describes, and what to do about it.
pub fn what_and_advice(what: &impl Described) -> [String; 2] {
    [described(what), advised(what)]
}

/// Returns another text of what the library describes, such as `short`; its text if it has no such one.
pub fn attribute(what: &impl Described, name: &str) -> String {
    let text = what.message().attribute(Language::current(), name);
    text.unwrap_or_else(|| described(what))
}

/// Returns a text of the library's catalogue that has no variables.
pub fn library_text(id: &str) -> String {
    Message::new(id).text(Language::current())
}

/// Adapts a title for use within a sentence: lower case, except in German, where nouns keep their capitals.
pub fn within_sentence(title: &str) -> String {
    match Language::current() {
        Language::German => title.to_owned(),
        Language::English | Language::Spanish | Language::Chinese => title.to_lowercase(),
    }
}

/// Writes a shortcut such as `Ctrl Shift Z` with the key names of this language.
pub fn keys(shortcut: &str) -> String {
    let named = |key: &str| match key {
        "Ctrl" => text!("shell-key-ctrl"),
        "Shift" => text!("shell-key-shift"),
        "Space" => text!("shell-key-space"),
        "Enter" => text!("shell-key-enter"),
        "Up" => text!("shell-key-up"),
        "Down" => text!("shell-key-down"),
        key => key.to_owned(),
    };
    let named: Vec<String> = shortcut.split(' ').map(named).collect();
    named.join(" ")
}

#[cfg(test)]
mod tests;
