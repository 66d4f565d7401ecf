//! A coat: all that a spray path and its film depend on beside the part. Lengths in metres, angles in radians.
//!
//! The table in `coat/table.rs` declares every parameter once, as the recipe of an inspection does; settings (`--set`),
//! files and the guide follow from it.

mod folder;
mod table;

use std::f64::consts::FRAC_PI_4;

use serde::{Deserialize, Serialize};

use super::error::PaintError;
use crate::pipeline::parameters::{Kind, Parameters as _};

pub use self::{
    folder::{BUILT_IN_COATS, CoatError, CoatFolder, built_in_coat},
    table::CoatGroup,
};

/// How the rows of a path run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pattern {
    /// Rows side by side, there and back.
    Raster,
    /// Two rasters, the second across the first.
    CrossHatch,
    /// Closed rings along the outline and around wide openings, from the outside in.
    Contour,
}

/// Which way the rows of a raster run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowDirection {
    /// Along the part's longest principal axis.
    Principal,
    /// At the coat's angle from the part's x axis.
    Angle,
}

/// How the paint is spread over the jet of a gun.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// An elliptical Gaussian.
    Gaussian,
    /// Beta: (1 - r²)^(β-1) within an ellipse.
    Beta,
}

/// A spray gun; what it deposits is in `gun.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Gun {
    /// How the paint is spread over the jet.
    pub profile: Profile,
    /// Length of the pattern across the way of travel, metres, at `distance`: 4σ of a Gaussian, all of a beta profile.
    pub width: f64,
    /// Length of the pattern along the way of travel, likewise.
    pub depth: f64,
    /// β, the exponent of a beta profile plus one.
    pub beta: f64,
    /// At which distance from the mouth width and depth were measured, metres.
    pub distance: f64,
    /// Paint, cubic metres a second.
    pub flow: f64,
    /// Share of the paint that flies to the part.
    pub transfer: f64,
    /// Share of the paint's volume that stays as film.
    pub solids: f64,
}

/// A coat, by its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Coat {
    /// The gun.
    pub gun: Gun,
    /// How the rows run.
    pub pattern: Pattern,
    /// Which way they run.
    pub direction: RowDirection,
    /// Angle of the rows from the part's x axis, used with [`RowDirection::Angle`].
    pub angle: f64,
    /// Distance between rows along the surface.
    pub spacing: f64,
    /// From the mouth to the surface along the jet.
    pub stand_off: f64,
    /// Speed of the jet over the surface, m/s.
    pub speed: f64,
    /// How far beyond the edge the gun still sprays.
    pub overrun: f64,
    /// Further way with the gun off at both ends of a row.
    pub lead: f64,
    /// Openings narrower than this are crossed with the gun on.
    pub opening: f64,
    /// How far around a keep-out region the gun is off.
    pub margin: f64,
    /// Width over which the surface is smoothed before the gun follows it.
    pub smoothing: f64,
    /// Furthest that the gun leans from the direction that the part is painted from.
    pub tilt_limit: f64,
    /// Distance between the points of the path.
    pub point_spacing: f64,
    /// Wanted thickness of the dry film, metres.
    pub target: f64,
    /// How far from it is still right, as a share of it.
    pub tolerance: f64,
}

impl Default for Gun {
    fn default() -> Self {
        Self {
            profile: Profile::Gaussian,
            width: 0.2,
            depth: 0.06,
            beta: 2.5,
            distance: 0.15,
            flow: 250.0 / 6e7,
            transfer: 0.65,
            solids: 0.4,
        }
    }
}

impl Default for Coat {
    fn default() -> Self {
        Self {
            gun: Gun::default(),
            pattern: Pattern::Raster,
            direction: RowDirection::Principal,
            angle: 0.0,
            spacing: 0.07,
            stand_off: 0.15,
            speed: 0.4,
            overrun: 0.08,
            lead: 0.05,
            opening: 0.16,
            margin: 0.02,
            smoothing: 0.06,
            tilt_limit: FRAC_PI_4,
            point_spacing: 0.025,
            target: 40e-6,
            tolerance: 0.2,
        }
    }
}

impl Coat {
    /// Refuses a coat that deposits nothing, or that a path cannot be made of; files and settings check the ranges.
    pub(super) fn check(&self) -> Result<(), PaintError> {
        for parameter in Self::ALL {
            if let Kind::Number(number) = &parameter.kind {
                let value = (number.get)(self) * number.unit.per_inner();
                let [least, most] = number.range;
                let room = 1e-9 * most;
                if !(value >= least - room && value <= most + room) {
                    let name = parameter.key;
                    return Err(PaintError::BadCoat { name, value });
                }
            }
        }
        Ok(())
    }

    /// Thickness far from every edge of a flat plate, metres: what lands on a strip as wide as the spacing.
    pub fn flat_thickness(&self) -> f64 {
        let passes = if self.pattern == Pattern::CrossHatch {
            2.0
        } else {
            1.0
        };
        passes * self.gun.film_rate() / (self.spacing * self.speed)
    }

    /// Share of the pattern's width that two rows have in common.
    pub fn overlap(&self) -> f64 {
        1.0 - self.spacing / (self.gun.width * self.stand_off / self.gun.distance)
    }
}
