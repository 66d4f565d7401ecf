//! The messages of the window.

use fluent_bundle::{FluentArgs, FluentValue};
use texts::{Catalogue, Files, Language};

macro_rules! files {
    ($language:literal) => {
        files!($language: "align" "coat" "compare" "enrol" "expect" "help" "history" "inspect" "live" "operator" "paint" "program" "rack" "results" "robot" "servoing" "shell" "shots" "view")
    };
    ($language:literal: $($area:literal)+) => {
        &[$(($area, include_str!(concat!("../../../../assets/language/", $language, "/", $area, ".ftl")))),+]
    };
}

/// Returns the files of a language.
pub(super) fn files(language: Language) -> Files {
    match language {
        Language::English => files!("en"),
        Language::German => files!("de"),
        Language::Spanish => files!("es"),
        Language::Chinese => files!("zh"),
    }
}

static WINDOW: Catalogue = Catalogue::new(files);

/// Formats a message without variables.
pub fn plain(id: &str) -> String {
    formatted(id, None)
}

/// Returns a text that the library has in English.
pub(super) fn translated(id: &str, english: &str) -> String {
    let text = WINDOW.text(Language::current(), id, None, None);
    text.unwrap_or_else(|| english.to_owned())
}

/// Formats a message with the values of its variables.
pub fn with<const N: usize>(id: &str, variables: [(&'static str, FluentValue<'_>); N]) -> String {
    formatted(id, Some(&FluentArgs::from_iter(variables)))
}

fn formatted(id: &str, variables: Option<&FluentArgs<'_>>) -> String {
    let text = |language| WINDOW.text(language, id, None, variables);
    text(Language::current())
        .or_else(|| text(Language::English))
        .unwrap_or_else(|| id.to_owned())
}
