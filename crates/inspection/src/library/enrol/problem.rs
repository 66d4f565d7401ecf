//! What a mesh was found to be, warnings about an enrolled part, and errors of enrolling.

use crate::library::Side;
use geometry::units::Metres;
use stages::{
    pose::FreeMotion,
    reference::ReferenceError,
    segment::{BackgroundSign, NoPart},
};
use texts::{Described, Message};

/// A warning about an enrolled part.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "warning", rename_all = "snake_case")]
pub enum EnrolWarning {
    /// The part reaches the border of the field of view.
    TouchesEdge,
    /// The chosen surface may be background.
    Background(BackgroundSign),
    /// Some of the selected points lie on a plane that segmentation removed.
    OnBackground {
        /// Share of the selected points, rounded.
        percent: u8,
    },
    /// The selected points are in separate pieces.
    Apart {
        /// Share of the selected points outside the largest piece, rounded.
        percent: u8,
    },
    /// Not even an inspection of this same view would accept it.
    TooLittle {
        /// Score of the reference in its own standard view, 0..1.
        score: f64,
        /// Score that inspections need.
        needed: f64,
    },
    /// The shape does not fix the pose.
    Unconstrained(FreeMotion),
    /// The part looks the same in another pose.
    Symmetric {
        /// Angle between the two poses, rounded.
        degrees: u16,
    },
    /// The part is as open from both sides, or bulges against the winding of an open sheet.
    SideUnclear {
        /// The two sides of its thinnest extent.
        sides: [Side; 2],
    },
    /// The surface of a scan continues beyond the view of every frame.
    GoesOnUnseen {
        /// Share of the outline, rounded.
        percent: u8,
    },
}

impl Described for EnrolWarning {
    fn message(&self) -> Message {
        let message = Message::tagged("enrol", "warning", self);
        match self {
            Self::SideUnclear {
                sides: [one, other],
            } => message.with("one", one.name()).with("other", other.name()),
            _ => message,
        }
    }
}

/// What a mesh was found to be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "finding", rename_all = "snake_case")]
pub enum EnrolFinding {
    /// The two skins of a sheet.
    ClosedSheet {
        /// Mean distance of the skins.
        thickness_m: Metres,
    },
    /// A surface without thickness, which is known from both sides.
    OpenSurface {
        /// Share of the surface, rounded.
        percent: u8,
    },
    /// Triangles that faced inwards, or the other way than their neighbours.
    Turned {
        /// Share of the surface, rounded.
        percent: u8,
    },
    /// Surface that no camera can see, and that is left out.
    Hidden {
        /// Share of the surface, rounded.
        percent: u8,
    },
}

impl Described for EnrolFinding {
    fn message(&self) -> Message {
        Message::tagged("enrolled", "finding", self)
    }
}

/// Why a part could not be enrolled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "error", rename_all = "snake_case")]
pub enum EnrolError {
    /// There is no part in the scene.
    NoPart(#[from] NoPart),
    /// The surface found is more likely background.
    Background(BackgroundSign),
    /// There is no surface with this number.
    NoSuchSurface {
        /// The number asked for, from 1.
        wanted: usize,
        /// Number of surfaces found.
        found: usize,
    },
    /// The cloud cannot be used as a reference.
    Reference(#[from] ReferenceError),
    /// The cloud has too few points.
    TooFewPoints {
        /// Number of finite points.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
    /// Too few points were selected.
    TooFewKept {
        /// Number of selected points.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
    /// No frame of a scan shows a part.
    NoPartInScan {
        /// Number of frames used.
        num_frames: usize,
    },
    /// The mesh has no surface.
    NoArea {
        /// Number of triangles.
        num_triangles: usize,
    },
}

impl Described for EnrolError {
    fn message(&self) -> Message {
        match self {
            Self::NoPart(why) => why.message(),
            Self::Reference(why) => why.message(),
            _ => Message::tagged("not-enrolled", "error", self),
        }
    }
}

texts::display!(EnrolFinding, EnrolWarning, EnrolError);

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{error::Advice as _, units::Metres};
    use stages::fixtures::FREEDOMS;
    use texts::Language;

    fn warnings() -> Vec<EnrolWarning> {
        let signs = [
            BackgroundSign::Behind { share: 0.4 },
            BackgroundSign::Cut { sides: 3 },
            BackgroundSign::Flat { area: 0.5 },
        ];
        let mut all: Vec<EnrolWarning> = signs.map(EnrolWarning::Background).into();
        all.extend(FREEDOMS.map(EnrolWarning::Unconstrained));
        all.extend([
            EnrolWarning::TouchesEdge,
            EnrolWarning::OnBackground { percent: 12 },
            EnrolWarning::Apart { percent: 7 },
            EnrolWarning::TooLittle {
                score: 0.7,
                needed: 0.9,
            },
            EnrolWarning::Symmetric { degrees: 180 },
            EnrolWarning::SideUnclear {
                sides: [Side::Top, Side::Bottom],
            },
            EnrolWarning::GoesOnUnseen { percent: 21 },
        ]);
        all
    }

    fn errors() -> Vec<EnrolError> {
        let (found, needed) = (5, 200);
        vec![
            NoPart::TooFewPoints { found, needed }.into(),
            ReferenceError::NoOutline { num_points: 9 }.into(),
            ReferenceError::TooLarge {
                found: Metres(1732.0),
                limit: Metres(5.0),
            }
            .into(),
            EnrolError::Background(BackgroundSign::Cut { sides: 3 }),
            EnrolError::NoSuchSurface {
                wanted: 3,
                found: 2,
            },
            EnrolError::TooFewPoints { found, needed },
            EnrolError::TooFewKept { found, needed },
            EnrolError::NoPartInScan { num_frames: 4 },
            EnrolError::NoArea { num_triangles: 3 },
        ]
    }

    #[test]
    fn every_warning_and_error_has_its_texts_in_every_language() {
        let warnings = warnings().into_iter().map(|warning| warning.message());
        let errors = errors().into_iter().map(|error| error.message());
        for message in warnings.chain(errors) {
            for language in Language::ALL {
                assert!(
                    message.attribute(language, "advice").is_some(),
                    "{message:?}"
                );
                // Checks its variables.
                assert!(message.text(language).len() > 5);
            }
        }
    }

    #[test]
    fn commands_name_their_options_and_figures_are_rounded() {
        let unclear = EnrolWarning::SideUnclear {
            sides: [Side::Top, Side::Bottom],
        };
        assert_eq!(
            unclear.advice(),
            "Give the side to be painted: --side top or --side bottom"
        );
        let background = EnrolWarning::Background(BackgroundSign::Behind { share: 0.4 });
        assert_eq!(
            background.to_string(),
            "this may be background: it lies behind other surfaces along 40 % of its border"
        );
        let large = EnrolError::from(ReferenceError::TooLarge {
            found: Metres(1732.04),
            limit: Metres(5.0),
        });
        assert_eq!(
            large.to_string(),
            "the part spans 1732.0 m, expected at most 5 m"
        );
    }
}
