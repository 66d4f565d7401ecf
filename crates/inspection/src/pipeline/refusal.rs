//! Why a scene was not accepted, as the history stores it and statistics count it.
//!
//! Its JSON is that of the [`Rejection`] or the [`Unrecognisable`].

use std::fmt;

use serde::{Deserialize, Serialize};

use super::rejection::{Rejection, Unrecognisable};
use texts::{Described, Message};

/// Why a scene was not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Refusal {
    /// The best guess was rejected.
    Rejected(#[from] Rejection),
    /// Nothing could be recognised.
    Unrecognisable(#[from] Unrecognisable),
}

/// The kind of a [`Rejection`] or [`Unrecognisable`], without its figures: its name in the JSON. A history may hold kinds of
/// later versions.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RefusalKind(String);

impl RefusalKind {
    /// The kind of this name.
    pub fn named(name: impl Into<String>) -> Self {
        Self(name.into())
    }

    /// Returns the name as in the JSON.
    pub fn name(&self) -> &str {
        &self.0
    }

    /// True if it says nothing about the part: too few of its frames were inspected.
    pub fn is_unjudged(&self) -> bool {
        matches!(self.name(), "few_frames" | "too_slow")
    }

    /// Returns the message of a refusal of this kind, without figures.
    pub fn message(&self) -> Message {
        Message::new(format!("refusal-{}", self.0.replace('_', "-")))
    }
}

impl fmt::Display for RefusalKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Described for Refusal {
    fn message(&self) -> Message {
        match self {
            Self::Rejected(why) => why.message(),
            Self::Unrecognisable(why) => why.message(),
        }
    }
}

texts::display!(Refusal);

impl Refusal {
    /// The kind, by which statistics count refusals.
    pub fn kind(&self) -> RefusalKind {
        let json = serde_json::to_value(self).unwrap_or_default();
        RefusalKind::named(json["kind"].as_str().unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::{Value, from_value, json, to_value};

    use super::*;
    use crate::fixtures::{rejections, unrecognisables};
    use geometry::{
        error::{Advice as _, guarded},
        units::Metres,
    };
    use stages::{
        pose::{Axis, CloudRole, FreeMotion, PoseError},
        segment::NoPart,
    };
    use texts::Language;

    /// A refusal of every kind.
    fn refusals() -> Vec<Refusal> {
        let rejected = rejections().into_iter().map(Refusal::Rejected);
        let fault = guarded(|| panic!("no ray at all")).expect_err("a panic");
        let others = unrecognisables().into_iter();
        let others = others.chain([Unrecognisable::Fault(fault)]);
        rejected
            .chain(others.map(Refusal::Unrecognisable))
            .collect()
    }

    #[test]
    fn every_refusal_comes_back_as_it_was_written() {
        let mut kinds = BTreeSet::new();
        for why in refusals() {
            let json = serde_json::to_string(&why).expect("written");
            let back: Refusal = serde_json::from_str(&json).expect(&json);
            assert_eq!(back, why, "{json}");
            let written: Value = serde_json::from_str(&json).expect("JSON");
            let kind = why.kind();
            assert_eq!(written["kind"], kind.to_string(), "{json}");
            kinds.insert(kind.to_string());
        }
        // serde's error for an unknown kind lists those that a part can be rejected for.
        let unknown = from_value::<Rejection>(json!({"kind": ""})).expect_err("no kind");
        let unknown = unknown.to_string();
        let all: BTreeSet<String> = unknown
            .split('`')
            .skip(3)
            .step_by(2)
            .map(str::to_owned)
            .collect();
        assert!(all.contains("low_score"), "{all:?}");
        assert!(kinds.is_superset(&all), "{all:?} and {kinds:?}");
        let texts = texts::LIBRARY.files(Language::English).iter();
        let texts = texts.flat_map(|(_, text)| text.lines());
        let described = texts.filter_map(|line| line.strip_prefix("refusal-")?.split_once(" ="));
        let described: BTreeSet<String> =
            described.map(|(kind, _)| kind.replace('-', "_")).collect();
        assert_eq!(kinds, described);
        let guide = include_str!("../../../../docs/guide/files.md");
        for kind in kinds {
            assert!(guide.contains(&format!("`{kind}`")), "{kind} in the guide");
        }
    }

    #[test]
    fn a_part_of_which_too_few_frames_were_inspected_is_not_judged() {
        let kinds = refusals().into_iter().map(|why| why.kind());
        let unjudged: BTreeSet<String> = kinds
            .filter(RefusalKind::is_unjudged)
            .map(|kind| kind.to_string())
            .collect();
        let expected = ["few_frames", "too_slow"].map(str::to_owned);
        assert_eq!(unjudged, BTreeSet::from(expected));
    }

    #[test]
    fn every_refusal_has_its_texts_in_every_language() {
        for why in refusals() {
            let message = why.message().with("nearest", "fender");
            for language in Language::ALL {
                assert!(!message.text(language).is_empty());
                assert!(!message.advice(language).is_empty(), "{why:?}");
                let has = |name| message.attribute(language, name).is_some();
                assert!(has("short"), "{why:?}");
                assert!(!(has("step") && has("next")), "{why:?}");
                assert_eq!(has("kind"), matches!(why, Refusal::Rejected(_)), "{why:?}");
                // Checks its variables.
                has("otherwise");
                has("compared");
            }
            assert_eq!(why.to_string(), why.message().text(Language::English));
            assert_eq!(why.advice(), why.message().command_advice());
        }
    }

    /// Histories store these names: they become unreadable if one changes.
    #[test]
    fn refusals_are_written_with_units_in_their_names() {
        let written = |why| to_value(Refusal::Rejected(why)).expect("written");
        assert_eq!(
            written(Rejection::AnotherModel {
                part: "fender".into(),
                relief: Metres(0.0042),
                outline: Metres(0.0119),
                missing: 0.0123,
            }),
            json!({"kind": "another_model", "part": "fender", "relief_m": 0.0042, "outline_m": 0.0119, "missing": 0.0123})
        );
        assert_eq!(
            written(Rejection::Unconstrained {
                part: "fender".into(),
                freedom: FreeMotion::Slide(Axis::Long),
            }),
            json!({"kind": "unconstrained", "part": "fender", "freedom": {"motion": "slide", "axis": "long"}})
        );
        let no_pose = PoseError::Degenerate {
            which: CloudRole::Source,
            width: 0.25,
        };
        assert_eq!(
            written(no_pose.into()),
            json!({"kind": "no_pose", "cause": "degenerate", "which": "source", "width_m": 0.25})
        );
        let background = NoPart::OnlyBackground {
            planes: 2,
            found: 0.01,
            needed: 0.02,
            knows_cell: true,
        };
        assert_eq!(
            to_value(Refusal::Unrecognisable(background.into())).expect("written"),
            json!({"kind": "only_background", "planes": 2, "found_m2": 0.01, "needed_m2": 0.02, "knows_cell": true})
        );
    }

    #[test]
    fn a_later_kind_is_an_error_and_a_later_field_is_not() {
        let read = from_value::<Refusal>;
        read(json!({"kind": "bewitched", "part": "fender"})).expect_err("unknown");
        read(json!({"part": "fender"})).expect_err("no kind");
        let why = json!({"kind": "not_steady", "part": "fender", "swing_m": 0.1});
        let expected = Rejection::NotSteady {
            part: "fender".into(),
        };
        assert_eq!(read(why).expect("read"), Refusal::Rejected(expected));
    }
}
