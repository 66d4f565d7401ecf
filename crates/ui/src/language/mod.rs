//! The texts of the window in every language, in Mozilla's Fluent format: `assets/language/<language>/<area>.ftl`.
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

use std::cell::Cell;

pub use fluent_bundle::FluentValue;
use serde::{Deserialize, Serialize};

pub use self::catalogue::{plain, with};

/// A language of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// English, which has every text.
    #[default]
    English,
    /// German.
    German,
    /// Spanish.
    Spanish,
    /// Chinese in simplified characters.
    Chinese,
}

thread_local! {
    static CURRENT: Cell<Language> = const { Cell::new(Language::English) };
}

impl Language {
    /// All languages, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::English, Self::German, Self::Spanish, Self::Chinese];

    /// The language's own name.
    pub fn own_name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::German => "Deutsch",
            Self::Spanish => "Español",
            Self::Chinese => "中文",
        }
    }

    /// An abbreviation for use where there is no room for the name.
    pub fn sign(self) -> &'static str {
        match self {
            Self::English => "EN",
            Self::German => "DE",
            Self::Spanish => "ES",
            Self::Chinese => "中文",
        }
    }

    /// The ISO 639-1 code, which is also the name of the folder.
    fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
            Self::Spanish => "es",
            Self::Chinese => "zh",
        }
    }

    /// The language of a locale such as `de_AT.UTF-8` or `zh-Hans-CN`; `None` if it is not supported.
    pub fn from_locale(locale: &str) -> Option<Self> {
        let code = locale.split(['-', '_', '.', '@']).next()?;
        let of_code = |language: &Self| language.code().eq_ignore_ascii_case(code);
        match code {
            // The locale without a language, whose messages are English.
            "C" | "POSIX" => Some(Self::English),
            _ => Self::ALL.into_iter().find(of_code),
        }
    }

    /// The first language of the system that is supported, else English.
    pub fn of_system() -> Self {
        let mut locales = sys_locale::get_locales();
        let spoken = locales.find_map(|locale| Self::from_locale(&locale));
        spoken.unwrap_or_default()
    }

    /// The language of this thread.
    pub fn current() -> Self {
        CURRENT.get()
    }

    /// Sets the language of this thread.
    pub fn make_current(self) {
        CURRENT.set(self);
    }
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
