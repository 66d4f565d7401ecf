//! Why no path can be planned or no film computed.

use crate::{error::Advice, library::MAX_PATH_POINTS};

/// Why no path can be planned or no film computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PaintError {
    /// The enrolled part has no normals.
    #[error("the enrolled part has no surface with normals")]
    NoNormals,
    /// Points or normals that are no numbers.
    #[error("{num_bad} points of the surface have no finite place and unit normal")]
    NotFinite {
        /// How many.
        num_bad: usize,
    },
    /// Too few points to follow.
    #[error("the surface has {found} points, too few to lay rows on")]
    TooFew {
        /// Points that face the side to be painted.
        found: usize,
    },
    /// No part has this size.
    #[error("the surface spans {:.0} mm, expected 30 mm to 10 m", metres * 1000.0)]
    Extent {
        /// Its largest extent.
        metres: f64,
    },
    /// Normals that cancel out, or points above each other.
    #[error("the surface has no side that faces one way: it is folded or closed")]
    Folded,
    /// A coat that deposits nothing or divides by nothing.
    #[error("the coat's {name} is {value}, which no path can be made of")]
    BadCoat {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// No row meets the surface outside the keep-out regions.
    #[error("no row lies over the surface")]
    NoRows,
    /// More points than a stored path holds.
    #[error("the path would have {found} points, at most {MAX_PATH_POINTS} are stored")]
    TooLong {
        /// How many.
        found: usize,
    },
    /// A region that encloses nothing.
    #[error("a keep-out region is empty: {what}")]
    BadRegion {
        /// Why.
        what: &'static str,
    },
    /// A path that never sprays.
    #[error("the path never sprays")]
    NeverSprays,
}

impl Advice for PaintError {
    fn advice(&self) -> String {
        match self {
            Self::NoNormals | Self::NotFinite { .. } => {
                "Enrol the part again from a capture, a scan or a mesh".into()
            }
            Self::TooFew { .. } => {
                "Enrol the part with the side to be painted towards the camera, nearer or from a mesh".into()
            }
            Self::Extent { .. } => {
                "Check the unit the part was enrolled in, for example partsight enrol part.stl --units mm".into()
            }
            Self::Folded => "Enrol the side to be painted from one capture in front of it".into(),
            Self::BadCoat { name, .. } => {
                format!("Give {name} a value within the range that docs/guide/paint.md lists")
            }
            Self::NoRows => {
                "Make the keep-out regions smaller, or the overrun and the row spacing fit the part".into()
            }
            Self::TooLong { .. } => "Raise point_spacing or spacing: --set point_spacing=50".into(),
            Self::BadRegion { .. } => {
                "Give a sphere a radius above 0, a polygon three corners that are not on one line".into()
            }
            Self::NeverSprays => "Plan a path, or give the points of the stored one gun_on = 1".into(),
        }
    }
}
