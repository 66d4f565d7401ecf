//! Paint: spray paths over enrolled parts, and the film that they leave.
//!
//! ```text
//! Reference ─► PaintSurface ─┬─► plan (Coat) ─► SprayPath ─► simulate (Coat) ─► Film
//!                            └───────────────────────────────────┘
//! SprayPath ─► FilmRoom (`robot::arm`)
//! SprayPath ─► Program (`robot::program`) ─► WrittenFilm
//! ```
//!
//! Everything is in part space, metres and radians, and nothing is random: the same part and coat give bit-identical
//! paths and films.

mod coat;
mod dwell;
mod edit;
mod error;
mod even;
mod film;
mod film_room;
mod fit;
mod gun;
mod height_map;
mod plan;
mod propose;
mod region;
mod rings;
mod rows;
mod shadow;
mod surface;
mod travel;
mod written;

#[cfg(test)]
pub(crate) use self::propose::tests::proposed;
pub use self::{
    coat::{
        BUILT_IN_COATS, Coat, CoatError, CoatFolder, CoatGroup, Gun, Pattern, Profile,
        RowDirection, built_in_coat,
    },
    edit::{PathEdit, edited},
    error::PaintError,
    film::{Film, FilmFigures, PathFigures, simulate},
    fit::{StripeError, StripeFit, StripeSample, fit_stripe, read_stripe},
    plan::plan,
    propose::{Proposal, best_speed, propose},
    region::KeepOut,
    surface::PaintSurface,
    written::{FilmOffPlan, LEAST_WITHIN, WrittenFilm},
};
