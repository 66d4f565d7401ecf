//! A message with the values of its variables.

use fluent_bundle::{FluentArgs, FluentValue};
use serde::Serialize;

use crate::{LIBRARY, Language};

/// Value of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A word, or `true` or `false`.
    Text(String),
    /// A number, which can select a plural.
    Number(f64),
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<bool> for Value {
    fn from(is: bool) -> Self {
        Self::Text(is.to_string())
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// Variables that hold the name of a part.
const PART_VARIABLES: [&str; 4] = ["part", "other", "nearest", "expected"];

/// A message of the library's catalogue with the values of its variables.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Message {
    id: String,
    values: Vec<(String, Value)>,
    /// What the message reports as its cause, in the variable `why`.
    cause: Option<Box<Message>>,
}

impl Message {
    /// The message of this id.
    pub fn new(id: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            ..Self::default()
        }
    }

    /// The message of a value that is serialised with a tag: its id is `family-variant`, with hyphens, and its variables
    /// are the fields, those of nested values too.
    pub fn tagged(family: &str, tag: &str, value: &impl Serialize) -> Self {
        let message = Self::default().with_fields(value);
        let variant = message.values.iter().find(|(name, _)| name == tag);
        let id = match variant {
            Some((_, Value::Text(variant))) => format!("{family}-{}", variant.replace('_', "-")),
            _ => family.to_owned(),
        };
        Self { id, ..message }
    }

    /// Adds the fields of a serialised value as variables.
    #[must_use]
    pub fn with_fields(mut self, value: &impl Serialize) -> Self {
        self.take(serde_json::to_value(value).unwrap_or_default());
        self
    }

    fn take(&mut self, fields: serde_json::Value) {
        let serde_json::Value::Object(fields) = fields else {
            return;
        };
        for (name, field) in fields {
            match field {
                serde_json::Value::String(text) => self.set(name, Value::Text(text)),
                serde_json::Value::Bool(is) => self.set(name, is.into()),
                serde_json::Value::Number(number) => {
                    self.set(name, Value::Number(number.as_f64().unwrap_or(f64::NAN)));
                }
                nested => self.take(nested),
            }
        }
    }

    fn set(&mut self, name: String, value: Value) {
        self.values.retain(|(known, _)| *known != name);
        self.values.push((name, value));
    }

    /// Sets a variable.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.set(name.to_owned(), value.into());
        self
    }

    /// Replaces the names of parts by what `title_of` returns for them.
    #[must_use]
    pub fn with_titles(mut self, title_of: impl Fn(&str) -> String) -> Self {
        for (name, value) in &mut self.values {
            if let Value::Text(part) = value
                && PART_VARIABLES.contains(&name.as_str())
            {
                *part = title_of(part);
            }
        }
        self
    }

    /// Makes `cause` the variable `why`, and its attributes those that this message lacks.
    #[must_use]
    pub fn caused_by(self, cause: Self) -> Self {
        Self {
            cause: Some(Box::new(cause)),
            ..self
        }
    }

    /// Returns the text in this language.
    pub fn text(&self, language: Language) -> String {
        self.formatted(language, None)
            .unwrap_or_else(|| self.id.clone())
    }

    /// Returns an attribute in this language; `None` if neither the message nor its cause has it.
    pub fn attribute(&self, language: Language, name: &str) -> Option<String> {
        let of_cause = || self.cause.as_ref()?.attribute(language, name);
        self.formatted(language, Some(name)).or_else(of_cause)
    }

    /// Returns what to do, in this language and in a window.
    pub fn advice(&self, language: Language) -> String {
        self.attribute(language, "advice").unwrap_or_default()
    }

    /// Returns what to do, in English and on the command line.
    pub fn command_advice(&self) -> String {
        let advice = |name| self.attribute(Language::English, name);
        advice("command-advice")
            .or_else(|| advice("advice"))
            .unwrap_or_default()
    }

    fn formatted(&self, language: Language, attribute: Option<&str>) -> Option<String> {
        let why = self.cause.as_ref().map(|cause| cause.text(language));
        let why = why.map(|why| ("why", FluentValue::from(why)));
        let values = self.values.iter().map(|(name, value)| {
            let value = match value {
                Value::Text(text) => FluentValue::from(text.as_str()),
                Value::Number(number) => FluentValue::from(*number),
            };
            (name.as_str(), value)
        });
        let variables: FluentArgs<'_> = values.chain(why).collect();
        let text = |language| LIBRARY.text(language, &self.id, attribute, Some(&variables));
        text(language).or_else(|| text(Language::English))
    }
}

/// A refusal, an error or a finding whose texts are in the catalogue.
pub trait Described {
    /// Returns its message.
    fn message(&self) -> Message;
}

impl Described for Message {
    fn message(&self) -> Message {
        self.clone()
    }
}

crate::display!(Message);

/// Implements `Display` for [`Described`] types: the message in English.
#[macro_export]
macro_rules! display {
    ($($type:ty),+ $(,)?) => {$(
        impl ::std::fmt::Display for $type {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                let message = $crate::Described::message(self);
                f.write_str(&message.text($crate::Language::English))
            }
        }
    )+};
}

/// Describes a type by its serialised form, see [`Message::tagged`], and implements `Display` for it.
#[macro_export]
macro_rules! described {
    ($($type:ty: $family:literal by $tag:literal),+ $(,)?) => {$(
        impl $crate::Described for $type {
            fn message(&self) -> $crate::Message {
                $crate::Message::tagged($family, $tag, self)
            }
        }
        $crate::display!($type);
    )+};
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn another_model(relief: f64, outline: f64, missing: f64) -> Message {
        Message::tagged(
            "refusal",
            "kind",
            &json!({"kind": "another_model", "part": "door", "relief_m": relief, "outline_m": outline, "missing": missing}),
        )
    }

    #[test]
    fn fields_are_variables_and_the_cause_has_the_advice() {
        let pose = json!({"cause": "degenerate", "which": "source", "width_m": 0.25});
        let pose = Message::tagged("pose", "cause", &pose);
        let why = Message::new("refusal-no-pose").caused_by(pose);
        assert_eq!(
            why.text(Language::English),
            "no pose was found: the source cloud does not determine the pose: its points lie on a line or a spot (0.25000 m wide)"
        );
        assert!(why.text(Language::German).contains("(Quelle)"));
        assert!(why.command_advice().starts_with("Use a cloud"));
        assert_eq!(why.attribute(Language::English, "next"), None);
    }

    #[test]
    fn differences_that_round_to_zero_are_left_out_in_every_language() {
        let german = |message: Message| message.text(Language::German);
        assert_eq!(
            german(another_model(0.0042, 0.0119, 0.0123)),
            "ähnlich wie door, aber nicht gleich: Die Oberfläche weicht um 4.2 mm ab, der Umriss um 11.9 mm, und 1.2 % fehlen; \
             anderes Modell, die Pose ist nur ungefähr"
        );
        assert_eq!(
            german(another_model(0.0, 0.0119, 0.0)),
            "ähnlich wie door, aber nicht gleich: Der Umriss weicht um 11.9 mm ab; anderes Modell, die Pose ist nur ungefähr"
        );
        let chinese = another_model(0.0, 0.0, 0.0).text(Language::Chinese);
        assert_eq!(
            chinese,
            "与“door”相似但不相同：属于其他车型，位姿仅为近似值"
        );
    }
}
