//! What a verdict calls what hangs there.

use super::{AcceptParams, Refusal, RefusalKind, Verdict, rejection::is_like};
use texts::{Language, Message};

/// What hangs there, by the verdict on a scene. Front ends only put it into words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Identification {
    /// Certainly this part, whether or not it is accepted: its pose may be in doubt, or a robot must not act on it.
    Part,
    /// A part of this type, but of another make.
    AnotherMake,
    /// A part of this type, but of another model.
    AnotherModel,
    /// The mirror image of this part.
    MirrorImage,
    /// The mirror image of the piece that was enrolled of this part.
    OtherHalf,
    /// Not recognised: this part is only the nearest.
    NotRecognised,
    /// Nothing enrolled.
    Unknown {
        /// True if it is like the nearest part, so that this is worth naming.
        is_like: bool,
    },
    /// Nothing hangs there.
    NoPart,
}

impl Identification {
    /// Identifies what hangs there by why it was refused and by the score and margin of the best match; `None` stands for an
    /// accepted part, and for no part. The recipe that refused it is not asked, since a row of the history does not have it:
    /// where score or margin are the reason, they were too low, and else the limits of the built-in recipe decide.
    pub fn new(refused: Option<&RefusalKind>, score: Option<[f64; 2]>) -> Self {
        let Some([score, margin]) = score else {
            return Self::NoPart;
        };
        let usual = AcceptParams::default();
        let refused = refused.map(RefusalKind::name);
        let is_low = score < usual.min_score
            || margin < usual.min_margin
            || matches!(
                refused,
                Some("low_score" | "piece" | "hardly_seen" | "small_margin")
            );
        match refused {
            Some("another_make") => Self::AnotherMake,
            Some("another_model") => Self::AnotherModel,
            Some("mirrored" | "mirrored_image") => Self::MirrorImage,
            Some("other_half") => Self::OtherHalf,
            Some("unknown") => Self::Unknown {
                is_like: is_like(score),
            },
            Some(_) if is_low => Self::NotRecognised,
            Some(_) | None => Self::Part,
        }
    }

    /// Returns what to call it, with the title or the name of the part; `None` if that may not be called by the name of any.
    pub fn name(self, part: &str, language: Language) -> Option<String> {
        let message = match self {
            Self::Part => return Some(part.to_owned()),
            Self::AnotherMake => "another-make",
            Self::AnotherModel => "another-model",
            Self::MirrorImage => "mirror-image",
            Self::OtherHalf => "other-half",
            Self::NotRecognised | Self::Unknown { .. } | Self::NoPart => return None,
        };
        Some(Message::new(message).with("part", part).text(language))
    }

    /// Returns what to call it in a heading: [`name`](Self::name) with a capital, unless it begins with what the part is called.
    pub fn heading(self, part: &str, language: Language) -> Option<String> {
        let name = self.name(part, language)?;
        if name.starts_with(part) {
            return Some(name);
        }
        let mut letters = name.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        Some(first.chain(letters).collect())
    }

    /// States it in English, for terminals and programs: its name or, if it has none, that it is not recognised, unknown or
    /// nothing, with the nearest part.
    pub fn in_english(self, part: &str) -> String {
        let name = self.name(part, Language::English);
        name.unwrap_or_else(|| match self {
            Self::NotRecognised => format!("not recognised, nearest {part}"),
            Self::Unknown { is_like: true } => format!("unknown, nearest {part}"),
            Self::NoPart => "none".to_owned(),
            _ => "unknown".to_owned(),
        })
    }

    /// True if its type is certain: it can be compared with the part.
    pub fn is_of_type(self) -> bool {
        matches!(self, Self::Part | Self::AnotherMake | Self::AnotherModel)
    }

    /// True if the part is to be named as the nearest enrolled one.
    pub fn names_nearest(self) -> bool {
        matches!(self, Self::NotRecognised | Self::Unknown { is_like: true })
    }
}

impl Verdict {
    /// Says what hangs there.
    pub fn identification(&self) -> Identification {
        let refused = self.refusal().as_ref().map(Refusal::kind);
        Identification::new(refused.as_ref(), self.score())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixtures::rejections,
        pipeline::{Rejection, Unrecognisable},
    };

    fn identified(rejected: Option<Rejection>, [score, margin]: [f64; 2]) -> Identification {
        let verdict = Verdict::Part {
            part: "fender".into(),
            score,
            margin,
            rejected,
            is_approximate: false,
        };
        verdict.identification()
    }

    #[test]
    fn every_refusal_says_what_hangs_there() {
        let clear = [0.97, 0.97];
        for why in rejections() {
            let expected = match &why {
                Rejection::AnotherMake { .. } => Identification::AnotherMake,
                Rejection::AnotherModel { .. } => Identification::AnotherModel,
                Rejection::Mirrored { .. } | Rejection::MirroredImage { .. } => {
                    Identification::MirrorImage
                }
                Rejection::OtherHalf { .. } => Identification::OtherHalf,
                Rejection::Unknown { .. } => Identification::Unknown { is_like: true },
                // Whatever its recipe asks for, it had too little.
                Rejection::LowScore { .. }
                | Rejection::Piece { .. }
                | Rejection::HardlySeen { .. }
                | Rejection::SmallMargin { .. } => Identification::NotRecognised,
                _ => Identification::Part,
            };
            assert_eq!(identified(Some(why.clone()), clear), expected, "{why:?}");
            // A low score or margin says only that the part is not certain.
            let unclear = match expected {
                Identification::Part => Identification::NotRecognised,
                other => other,
            };
            for score in [[0.89, 0.97], [0.97, 0.43]] {
                assert_eq!(identified(Some(why.clone()), score), unclear, "{why:?}");
            }
        }
        assert_eq!(identified(None, [0.5, 0.0]), Identification::Part);
        let nothing = Verdict::NoPart(Unrecognisable::EmptyLibrary);
        assert_eq!(nothing.identification(), Identification::NoPart);
    }

    #[test]
    fn the_nearest_part_is_named_only_if_it_is_like_it() {
        for (score, is_like) in [(0.3, true), (0.01, false)] {
            let nearest = "fender".into();
            let found = identified(Some(Rejection::Unknown { nearest, score }), [score; 2]);
            assert_eq!(found, Identification::Unknown { is_like });
            assert_eq!(found.names_nearest(), is_like);
        }
        assert!(Identification::NotRecognised.names_nearest());
        assert!(!Identification::MirrorImage.names_nearest());
    }

    #[test]
    fn whatever_is_not_the_part_itself_has_no_name_that_reads_as_if_it_were() {
        let name = |found: Identification| found.name("Front bumper", Language::English);
        let named = |found| name(found).expect("a name");
        assert_eq!(named(Identification::Part), "Front bumper");
        assert_eq!(
            named(Identification::AnotherMake),
            "Front bumper, another make"
        );
        assert_eq!(
            named(Identification::MirrorImage),
            "mirror image of Front bumper"
        );
        assert_eq!(
            named(Identification::OtherHalf),
            "mirror image of the enrolled piece of Front bumper"
        );
        let heading = |found: Identification, part| found.heading(part, Language::English);
        let expected = Some("Mirror image of fender".to_owned());
        assert_eq!(heading(Identification::MirrorImage, "fender"), expected);
        let expected = Some("fender, another model".to_owned());
        assert_eq!(heading(Identification::AnotherModel, "fender"), expected);
        for found in [
            Identification::NotRecognised,
            Identification::Unknown { is_like: true },
            Identification::NoPart,
        ] {
            assert_eq!(name(found), None);
        }
    }
}
