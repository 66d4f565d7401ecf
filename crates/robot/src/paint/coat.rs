//! A coat: everything besides the part that a spray path and its film depend on. Lengths in metres, angles in radians.
//!
//! The table in `coat/table.rs` declares each parameter once, as for the recipe of an inspection; settings (`--set`),
//! files and the guide are derived from it.

mod folder;
mod table;

use std::f64::consts::FRAC_PI_4;

use serde::{Deserialize, Serialize};

use super::error::PaintError;
use inspection::{
    library::SprayPath,
    pipeline::parameters::{Kind, Parameters as _},
};

pub(super) use self::table::{BETA_RANGE, TRANSFER_RANGE_PERCENT, WIDTH_RANGE_MM};
pub use self::{
    folder::{BUILT_IN_COATS, CoatError, CoatFolder, built_in_coat},
    table::CoatGroup,
};

/// Arrangement of a path's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pattern {
    /// Parallel rows, there and back.
    Raster,
    /// Two rasters, the second across the first.
    CrossHatch,
    /// Closed rings along the outline and around wide openings, from the outside in.
    Contour,
}

/// Direction of a raster's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowDirection {
    /// Along the part's longest principal axis.
    Principal,
    /// At the coat's angle from the part's x axis.
    Angle,
}

/// Distribution of the paint over the jet of a gun.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// An elliptical Gaussian.
    Gaussian,
    /// Beta: (1 - r²)^(β-1) within an ellipse.
    Beta,
}

/// A spray gun; `gun.rs` computes what it deposits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Gun {
    /// Distribution of the paint over the jet.
    pub profile: Profile,
    /// Length of the pattern across the direction of travel, metres, at `distance`: 4σ of a Gaussian, all of a beta
    /// profile.
    pub width: f64,
    /// Length of the pattern along the direction of travel, likewise.
    pub depth: f64,
    /// β of a beta profile: its exponent plus one.
    pub beta: f64,
    /// Distance from the mouth at which width and depth were measured, metres.
    pub distance: f64,
    /// Flow of paint, cubic metres per second.
    pub flow: f64,
    /// Share of the paint that reaches the part.
    pub transfer: f64,
    /// Share of the paint's volume that remains as film.
    pub solids: f64,
}

/// The parameters of a coat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Coat {
    /// The gun.
    pub gun: Gun,
    /// Arrangement of the rows.
    pub pattern: Pattern,
    /// Direction of the rows.
    pub direction: RowDirection,
    /// Angle of the rows from the part's x axis, used with [`RowDirection::Angle`].
    pub angle: f64,
    /// Distance between rows along the surface.
    pub spacing: f64,
    /// Distance from the mouth to the surface along the jet.
    pub stand_off: f64,
    /// Speed of the jet over the surface, m/s.
    pub speed: f64,
    /// Distance beyond the edge up to which the gun sprays.
    pub overrun: f64,
    /// Way with the gun off at both ends of a row, beyond the overrun.
    pub lead: f64,
    /// Openings narrower than this are crossed with the gun on.
    pub opening: f64,
    /// Distance around a keep-out region within which the gun is off.
    pub margin: f64,
    /// Width over which the surface is smoothed before the gun follows it.
    pub smoothing: f64,
    /// Largest angle of the gun from the direction that the part is painted from.
    pub tilt_limit: f64,
    /// Largest acceleration of the gun where its speed changes along a stroke, m/s²; 0 keeps the speed constant.
    pub acceleration: f64,
    /// Angle from the side by which the gun leans towards steep flanks in added strokes; 0 adds none.
    pub flank_lean: f64,
    /// Distance between the points of the path.
    pub point_spacing: f64,
    /// Target thickness of the dry film, metres.
    pub target: f64,
    /// Accepted deviation from the target, as a share of it.
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
            acceleration: 4.0,
            flank_lean: 40.0_f64.to_radians(),
            point_spacing: 0.025,
            target: 40e-6,
            tolerance: 0.2,
        }
    }
}

impl Coat {
    /// The coat that a path was planned with; none if the path names none, or one that is out of range.
    pub fn of_path(path: &SprayPath) -> Option<Self> {
        let coat: Self = serde_json::from_str(path.coat()?).ok()?;
        coat.check().ok()?;
        Some(coat)
    }

    /// Names the coat in a path planned with it.
    pub(super) fn name_in(&self, path: SprayPath) -> SprayPath {
        path.with_coat(serde_json::to_string(self).ok())
    }

    /// Acceleration that a path was planned for, m/s²; none if it is unknown, or if the speed was planned constant.
    pub fn acceleration_of(path: &SprayPath) -> Option<f64> {
        let acceleration = Self::of_path(path)?.acceleration;
        (acceleration > 0.0).then_some(acceleration)
    }

    /// Refuses a coat with a parameter out of its range; files and settings are checked when they are read.
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

    /// Thickness on a flat plate far from its edges, metres: the volume sprayed on a strip as wide as the spacing, over
    /// its area.
    #[cfg(test)]
    pub(super) fn flat_thickness(&self) -> f64 {
        let passes = if self.pattern == Pattern::CrossHatch {
            2.0
        } else {
            1.0
        };
        passes * self.gun.film_rate() / (self.spacing * self.speed)
    }

    /// Overlap of two neighbouring rows, as a share of the pattern's width.
    pub fn overlap(&self) -> f64 {
        1.0 - self.spacing / (self.gun.width * self.stand_off / self.gun.distance)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::paint::{PathEdit, edited, plan, surface::tests::grid};
    use stages::reference::Coverage;

    #[test]
    fn a_planned_path_names_its_coat_and_keeps_it_when_it_is_edited() {
        let surface = grid(41, 41, Coverage::OneSide, |i, j| {
            (Point3::new(0.4 * i, 0.4 * j, 0.0), Vector3::z())
        });
        let coat = Coat {
            acceleration: 2.5,
            ..Coat::default()
        };
        let path = plan(&surface, &coat, &[]).expect("planned");
        assert_eq!(Coat::of_path(&path), Some(coat));
        assert_eq!(Coat::acceleration_of(&path), Some(2.5));
        let shift = PathEdit::Stroke {
            stroke: 0,
            by: Vector3::new(0.01, 0.0, 0.0),
        };
        let moved = edited(path.clone(), &[shift], coat.stand_off);
        assert_eq!(Coat::of_path(&moved), Some(coat));
        // A coat out of range, or a line that a spreadsheet changed, is none.
        for broken in ["{\"speed\":-1.0}", "{\"speed\""] {
            let path = path.clone().with_coat(Some(broken.into()));
            assert_eq!(Coat::of_path(&path), None);
        }
        let constant = plan(
            &surface,
            &Coat {
                acceleration: 0.0,
                ..coat
            },
            &[],
        );
        assert_eq!(Coat::acceleration_of(&constant.expect("planned")), None);
    }
}
