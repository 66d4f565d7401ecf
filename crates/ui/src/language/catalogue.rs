//! The messages of each language, parsed when its first text is requested.

use std::sync::OnceLock;

use fluent_bundle::{FluentArgs, FluentResource, FluentValue, concurrent::FluentBundle};
use unic_langid::LanguageIdentifier;

use super::Language;

/// The areas of a language with the contents of their files.
pub(super) type Files = &'static [(&'static str, &'static str)];

macro_rules! files {
    ($language:literal) => {
        files!($language: "align" "coat" "compare" "enrol" "history" "inspect" "live" "operator" "paint" "program" "results" "robot" "shell" "shots" "view")
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

type Bundle = FluentBundle<FluentResource>;

/// Returns the parsed messages of a language.
fn bundle(language: Language) -> &'static Bundle {
    static BUNDLES: [OnceLock<Bundle>; Language::ALL.len()] =
        [const { OnceLock::new() }; Language::ALL.len()];
    BUNDLES[language as usize].get_or_init(|| parsed(language))
}

fn parsed(language: Language) -> Bundle {
    // Plural rules depend on it.
    let identifier: LanguageIdentifier = language.code().parse().unwrap_or_default();
    let mut bundle = Bundle::new_concurrent(vec![identifier]);
    // Our fonts lack the isolation marks for right-to-left text.
    bundle.set_use_isolating(false);
    for (_, file) in files(language) {
        // Keep the other messages; a test fails if one cannot be parsed.
        let resource = FluentResource::try_new((*file).to_owned()).unwrap_or_else(|(rest, _)| rest);
        let _ = bundle.add_resource(resource);
    }
    bundle
}

/// Formats a message without variables.
pub fn plain(id: &str) -> String {
    formatted(id, None)
}

/// Formats a message with the values of its variables.
pub fn with<const N: usize>(id: &str, variables: [(&'static str, FluentValue<'_>); N]) -> String {
    formatted(id, Some(&FluentArgs::from_iter(variables)))
}

fn formatted(id: &str, variables: Option<&FluentArgs<'_>>) -> String {
    let in_language = |language| {
        let bundle = bundle(language);
        let pattern = bundle.get_message(id)?.value()?;
        let text = bundle.format_pattern(pattern, variables, &mut Vec::new());
        Some(text.into_owned())
    };
    in_language(Language::current())
        .or_else(|| in_language(Language::English))
        .unwrap_or_else(|| id.to_owned())
}
