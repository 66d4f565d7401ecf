//! Errors of planning a path or computing a film.

use geometry::error::Advice;
use inspection::library::{MAX_PATH_POINTS, Side};
use texts::Message;

/// Why a path cannot be planned, or a film not be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum PaintError {
    /// The enrolled part has no normals.
    #[error("the enrolled part has no surface with normals")]
    #[advice(ENROL_AGAIN)]
    NoNormals,
    /// Some points are not finite, or have no unit normal.
    #[error("{num_bad} points of the surface have no finite place and unit normal")]
    #[advice(ENROL_AGAIN)]
    NotFinite {
        /// Number of such points.
        num_bad: usize,
    },
    /// Too few points face the side to be painted.
    #[error("the surface has {found} points, too few to lay rows on")]
    #[advice = "Enrol the part with the side to be painted towards the camera, from closer or from a mesh"]
    TooFew {
        /// Number of points that do.
        found: usize,
    },
    /// The surface is smaller or larger than any part.
    #[error("the surface spans {:.0} mm, expected 30 mm to 10 m", metres * 1000.0)]
    #[advice = "Check the unit the part was enrolled in, for example partsight enrol part.stl --units mm"]
    Extent {
        /// Largest extent, metres.
        metres: f64,
    },
    /// The normals cancel out, so there is no side to be painted.
    #[error("the surface has no side that faces one way: it is folded or closed")]
    #[advice = "Enrol the side to be painted from one capture in front of it"]
    Folded,
    /// A part that is known all around may be painted from either side.
    #[error("{}", Message::new("enrol-side-unclear"))]
    #[advice("Give the side to be painted: --side {} or --side {}", sides[0].name(), sides[1].name())]
    SideUnclear {
        /// The two sides of its thinnest extent.
        sides: [Side; 2],
    },
    /// A parameter of the coat is out of its range.
    #[error("the coat's {name} is {value}, with which no path can be planned")]
    #[advice = "Give {name} a value within the range that docs/guide/paint.md lists"]
    BadCoat {
        /// Key of the parameter.
        name: &'static str,
        /// Its value, in the unit in which it is shown.
        value: f64,
    },
    /// No row meets the surface outside the keep-out regions.
    #[error("no row lies over the surface")]
    #[advice = "Make the keep-out regions smaller, or adapt the overrun and the row spacing to the part"]
    NoRows,
    /// The path has more points than can be stored.
    #[error("the path would have more than {MAX_PATH_POINTS} points, the most that are stored")]
    #[advice = "Raise point_spacing or spacing: --set point_spacing=50"]
    TooLong,
    /// A keep-out region, or area to be painted, encloses nothing.
    #[error("a keep-out region is empty: {what}")]
    #[advice = "Give a sphere a radius above 0, a polygon three corners that are not on one line"]
    BadRegion {
        /// What is wrong with it.
        what: &'static str,
    },
    /// The gun is never on along the path.
    #[error("the path never sprays")]
    #[advice = "Plan a path, or give the points of the stored one gun_on = 1"]
    NeverSprays,
}

const ENROL_AGAIN: &str = "Enrol the part again from a capture, a scan or a mesh";
