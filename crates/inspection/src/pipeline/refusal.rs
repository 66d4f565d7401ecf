//! Why a scene was not accepted, as the history stores it and statistics count it.
//!
//! Its JSON is that of the [`Rejection`] or the [`Unrecognisable`].

use std::fmt;

use serde::{
    Deserialize, Serialize,
    de::value::{Error, StrDeserializer},
};

use super::rejection::{Rejection, Unrecognisable};
use geometry::error::Advice;
use stages::{
    contour::ContourError, project::ProjectError, segment::NoPart, signature::SignatureError,
};

/// Why a scene was not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Refusal {
    /// The best guess was rejected.
    #[error(transparent)]
    Rejected(#[from] Rejection),
    /// Nothing could be recognised.
    #[error(transparent)]
    Unrecognisable(#[from] Unrecognisable),
}

/// The kind of a [`Rejection`] or [`Unrecognisable`], without its figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the variants of both have them")]
pub enum RefusalKind {
    LowScore,
    Piece,
    HardlySeen,
    AnotherModel,
    AnotherMake,
    AmbiguousPose,
    Unconstrained,
    Uncertain,
    Unknown,
    Mirrored,
    MirroredImage,
    SmallMargin,
    Unconfirmed,
    OutOfRange,
    BehindCamera,
    SurplusBytes,
    NoPose,
    NotSteady,
    FewFrames,
    Undecided,
    PosesApart,
    TooFewPoints,
    TooWide,
    OnlyBackground,
    NoPlane,
    TooLarge,
    NoShape,
    NoOutline,
    EmptyLibrary,
    Fault,
}

impl RefusalKind {
    /// The kind of this name; `None` if this version of the program does not know it.
    pub fn named(name: &str) -> Option<Self> {
        Self::deserialize(StrDeserializer::<Error>::new(name)).ok()
    }
}

impl fmt::Display for RefusalKind {
    /// Writes the name as in the JSON.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

impl Refusal {
    /// Replaces the names of the parts, for instance by their titles.
    #[must_use]
    pub fn renamed(self, word_of: impl Fn(&str) -> String) -> Self {
        match self {
            Self::Rejected(why) => Self::Rejected(why.renamed(word_of)),
            Self::Unrecognisable(_) => self,
        }
    }

    /// The kind, by which statistics count refusals.
    pub fn kind(&self) -> RefusalKind {
        match self {
            Self::Rejected(why) => match why {
                Rejection::LowScore { .. } => RefusalKind::LowScore,
                Rejection::Piece { .. } => RefusalKind::Piece,
                Rejection::HardlySeen { .. } => RefusalKind::HardlySeen,
                Rejection::AnotherModel { .. } => RefusalKind::AnotherModel,
                Rejection::AnotherMake { .. } => RefusalKind::AnotherMake,
                Rejection::AmbiguousPose { .. } => RefusalKind::AmbiguousPose,
                Rejection::Unconstrained { .. } => RefusalKind::Unconstrained,
                Rejection::Uncertain { .. } => RefusalKind::Uncertain,
                Rejection::Unknown { .. } => RefusalKind::Unknown,
                Rejection::Mirrored { .. } => RefusalKind::Mirrored,
                Rejection::MirroredImage { .. } => RefusalKind::MirroredImage,
                Rejection::SmallMargin { .. } => RefusalKind::SmallMargin,
                Rejection::Unconfirmed { .. } => RefusalKind::Unconfirmed,
                Rejection::OutOfRange { .. } => RefusalKind::OutOfRange,
                Rejection::BehindCamera { .. } => RefusalKind::BehindCamera,
                Rejection::SurplusBytes { .. } => RefusalKind::SurplusBytes,
                Rejection::NoPose(_) => RefusalKind::NoPose,
                Rejection::NotSteady { .. } => RefusalKind::NotSteady,
                Rejection::FewFrames { .. } => RefusalKind::FewFrames,
                Rejection::Undecided { .. } => RefusalKind::Undecided,
                Rejection::PosesApart { .. } => RefusalKind::PosesApart,
            },
            Self::Unrecognisable(why) => match why {
                Unrecognisable::EmptyLibrary => RefusalKind::EmptyLibrary,
                Unrecognisable::Fault(_) => RefusalKind::Fault,
                Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => RefusalKind::TooFewPoints,
                Unrecognisable::NoPart(NoPart::TooWide { .. }) => RefusalKind::TooWide,
                Unrecognisable::NoPart(NoPart::OnlyBackground { .. }) => {
                    RefusalKind::OnlyBackground
                }
                Unrecognisable::Project(ProjectError::NoPlane { .. }) => RefusalKind::NoPlane,
                Unrecognisable::Project(ProjectError::TooLarge { .. }) => RefusalKind::TooLarge,
                Unrecognisable::Contour(ContourError::NoShape { .. }) => RefusalKind::NoShape,
                Unrecognisable::Signature(SignatureError::NoOutline { .. }) => {
                    RefusalKind::NoOutline
                }
            },
        }
    }
}

impl Advice for Refusal {
    fn advice(&self) -> String {
        match self {
            Self::Rejected(why) => why.advice(),
            Self::Unrecognisable(why) => why.advice(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::{Value, from_value, json, to_value};

    use super::*;
    use crate::fixtures::{rejections, unrecognisables};
    use geometry::{error::guarded, units::Metres};
    use stages::pose::{Axis, CloudRole, FreeMotion, PoseError};

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
            assert_eq!(RefusalKind::named(&kind.to_string()), Some(kind));
            kinds.insert(kind.to_string());
        }
        // serde's error for an unknown kind lists all kinds.
        let unknown = serde_json::from_str::<RefusalKind>("\"\"").expect_err("no kind");
        let unknown = unknown.to_string();
        let all: BTreeSet<String> = unknown
            .split('`')
            .skip(3)
            .step_by(2)
            .map(str::to_owned)
            .collect();
        assert!(
            all.contains("low_score") && all.contains("fault"),
            "{all:?}"
        );
        assert_eq!(kinds, all);
        let guide = include_str!("../../../../docs/guide/files.md");
        for kind in all {
            assert!(guide.contains(&format!("`{kind}`")), "{kind} in the guide");
        }
        assert_eq!(RefusalKind::named("bewitched"), None);
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
