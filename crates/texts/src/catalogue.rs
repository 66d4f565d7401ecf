//! The messages of each language, parsed when the first text of it is asked for.

use std::sync::OnceLock;

use fluent_bundle::{FluentArgs, FluentResource, concurrent::FluentBundle};
use unic_langid::LanguageIdentifier;

use crate::{Language, functions};

/// The areas of a language with the contents of their files.
pub type Files = &'static [(&'static str, &'static str)];

type Bundle = FluentBundle<FluentResource>;

/// Messages in all languages.
pub struct Catalogue {
    files: fn(Language) -> Files,
    bundles: [OnceLock<Bundle>; Language::ALL.len()],
}

/// The messages of the library.
pub static LIBRARY: Catalogue = Catalogue::new(files);

macro_rules! files {
    ($language:literal) => {
        files!($language: "cell" "convention" "doubt" "enrol" "expected" "orders" "point" "pose" "rack" "recipe" "refusal" "result" "scan" "serve" "servo" "surface" "unchecked")
    };
    ($language:literal: $($area:literal)+) => {
        &[$(($area, include_str!(concat!("../language/", $language, "/", $area, ".ftl")))),+]
    };
}

fn files(language: Language) -> Files {
    match language {
        Language::English => files!("en"),
        Language::German => files!("de"),
        Language::Spanish => files!("es"),
        Language::Chinese => files!("zh"),
    }
}

impl Catalogue {
    /// The catalogue of these files.
    pub const fn new(files: fn(Language) -> Files) -> Self {
        Self {
            files,
            bundles: [const { OnceLock::new() }; Language::ALL.len()],
        }
    }

    /// Returns the files of a language.
    pub fn files(&self, language: Language) -> Files {
        (self.files)(language)
    }

    /// Formats a message, or this attribute of it, in this very language. `None` if the language lacks it.
    pub fn text(
        &self,
        language: Language,
        id: &str,
        attribute: Option<&str>,
        variables: Option<&FluentArgs<'_>>,
    ) -> Option<String> {
        let bundle = self.bundles[language as usize].get_or_init(|| self.parsed(language));
        let message = bundle.get_message(id)?;
        let pattern = match attribute {
            Some(name) => message.get_attribute(name)?.value(),
            None => message.value()?,
        };
        let mut faults = Vec::new();
        let text = bundle.format_pattern(pattern, variables, &mut faults);
        debug_assert!(faults.is_empty(), "{id} in {language:?}: {faults:?}");
        Some(text.into_owned())
    }

    fn parsed(&self, language: Language) -> Bundle {
        // Plural rules depend on it.
        let identifier: LanguageIdentifier = language.code().parse().unwrap_or_default();
        let mut bundle = Bundle::new_concurrent(vec![identifier]);
        // Our fonts lack the isolation marks for right-to-left text.
        bundle.set_use_isolating(false);
        functions::add_to(&mut bundle);
        for (_, file) in self.files(language) {
            // Keep the other messages; a test fails if one cannot be parsed.
            let resource = FluentResource::try_new((*file).to_owned());
            let _ = bundle.add_resource(resource.unwrap_or_else(|(rest, _)| rest));
        }
        bundle
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    /// Messages and attributes of the files with their variables.
    fn messages(files: Files) -> BTreeMap<String, BTreeSet<String>> {
        let mut messages: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let (mut id, mut key) = (String::new(), String::new());
        for line in files.iter().flat_map(|(_, file)| file.lines()) {
            if line.starts_with(|c: char| c.is_ascii_alphabetic()) {
                let (name, _) = line.split_once(" =").expect("a message");
                name.clone_into(&mut id);
                key.clone_from(&id);
                assert!(!messages.contains_key(&key), "{key} twice");
            } else if let Some((name, _)) = line
                .trim_start()
                .strip_prefix('.')
                .and_then(|rest| rest.split_once(" ="))
            {
                key = format!("{id}.{name}");
            }
            if key.is_empty() || line.starts_with('#') {
                continue;
            }
            let variables = line.split('$').skip(1).map(|rest| {
                let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let end = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
                rest[..end].to_owned()
            });
            messages.entry(key.clone()).or_default().extend(variables);
        }
        messages
    }

    #[test]
    fn every_language_has_every_text_with_the_same_variables() {
        // Commands speak English only.
        let is_of_window = |key: &String| !key.ends_with(".command-advice") && key != "put-right";
        let mut english = messages(LIBRARY.files(Language::English));
        english.retain(|key, _| is_of_window(key));
        assert!(english.len() > 150, "{}", english.len());
        for language in Language::ALL {
            let mut messages = messages(LIBRARY.files(language));
            messages.retain(|key, _| is_of_window(key));
            assert_eq!(messages, english, "{language:?}");
        }
    }

    /// The texts of one line that have words of their own, by message and attribute.
    fn sentences(language: Language) -> BTreeMap<String, String> {
        let mut sentences = BTreeMap::new();
        let mut id = "";
        for line in LIBRARY
            .files(language)
            .iter()
            .flat_map(|(_, file)| file.lines())
        {
            let Some((key, text)) = line.split_once(" = ") else {
                continue;
            };
            let key = if let Some(attribute) = key.trim_start().strip_prefix('.') {
                format!("{id}.{attribute}")
            } else {
                id = key;
                key.to_owned()
            };
            if text
                .split(['{', '}'])
                .step_by(2)
                .any(|words| words.contains(' '))
            {
                sentences.insert(key, text.to_owned());
            }
        }
        sentences
    }

    #[test]
    fn every_other_language_has_its_own_words() {
        let english = sentences(Language::English);
        assert!(english.len() > 100, "{}", english.len());
        for language in [Language::German, Language::Spanish, Language::Chinese] {
            for (key, text) in sentences(language) {
                assert_ne!(Some(&text), english.get(&key), "{key} in {language:?}");
            }
        }
    }

    #[test]
    fn every_file_is_read_without_a_fault() {
        for language in Language::ALL {
            let mut bundle = Bundle::new_concurrent(Vec::new());
            for (area, file) in LIBRARY.files(language) {
                let resource = FluentResource::try_new((*file).to_owned());
                let resource = resource
                    .unwrap_or_else(|(_, faults)| panic!("{language:?}, {area}: {faults:?}"));
                let added = bundle.add_resource(resource);
                added.unwrap_or_else(|faults| panic!("{language:?}, {area}: {faults:?}"));
            }
        }
    }
}
