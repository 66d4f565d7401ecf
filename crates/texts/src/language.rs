//! The languages of the window.

use std::cell::Cell;

use serde::{Deserialize, Serialize};

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
    pub fn code(self) -> &'static str {
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

    /// The language of this thread: English, unless it was set. The window sets it at the start of each frame, and a task's
    /// thread inherits it from whoever starts the task.
    pub fn current() -> Self {
        CURRENT.get()
    }

    /// Sets the language of this thread.
    pub fn make_current(self) {
        CURRENT.set(self);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_locale_names_a_language_or_none() {
        let of = |locale: &str| Language::from_locale(locale);
        for locale in ["de", "de_DE.UTF-8", "de-AT", "DE_ch@euro"] {
            assert_eq!(of(locale), Some(Language::German), "{locale}");
        }
        assert_eq!(of("es_MX.UTF-8"), Some(Language::Spanish));
        assert_eq!(of("zh-Hans-CN"), Some(Language::Chinese));
        for locale in ["C", "POSIX", "C.UTF-8", "en_GB"] {
            assert_eq!(of(locale), Some(Language::English), "{locale}");
        }
        for locale in ["fr_FR", "", "den_CA", "d"] {
            assert_eq!(of(locale), None, "{locale}");
        }
    }
}
