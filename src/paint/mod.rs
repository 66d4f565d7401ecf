//! Paint: spray paths over enrolled parts, and the film that they leave.
//!
//! ```text
//! Reference ─► PaintSurface ─┬─► plan (Coat) ─► SprayPath ─► simulate (Coat) ─► Film
//!                            └───────────────────────────────────┘
//! ```
//!
//! Everything is in part space, metres and radians, and nothing is random: the same part and coat give the same path and
//! film, to the bit.

mod coat;
mod error;
mod film;
mod gun;
mod height_map;
mod plan;
mod propose;
mod region;
mod rows;
mod surface;

pub use self::{
    coat::{
        BUILT_IN_COATS, Coat, CoatError, CoatFolder, CoatGroup, Gun, Pattern, Profile, RowDirection,
    },
    error::PaintError,
    film::{Film, FilmFigures, PathFigures, simulate},
    plan::plan,
    propose::{Proposal, propose},
    region::KeepOut,
    surface::PaintSurface,
};
