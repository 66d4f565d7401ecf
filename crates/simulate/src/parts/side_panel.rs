//! Common to both doors: the curved side of the car, its lines, and the pressing of a door.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::region::{Region, bend};
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Height (y) at which a car's side bulges most.
const BULGE_MIDDLE: f64 = 0.12;

/// The outer surface of a car's side, as depth over (x, y).
pub(super) struct SidePanel {
    /// Height (y) of the waistline, the lower edge of the window.
    pub(super) waist: f64,
    /// Slope of the window frame above the waist, in metres of depth per metre of height.
    pub(super) tumblehome: f64,
    /// Radius of the panel's bulge below the waist.
    pub(super) bulge_radius: f64,
    /// Radius of the panel's bow along the car.
    pub(super) bow_radius: f64,
    /// The character line: its y at x = 0, and its slope.
    pub(super) line: (f64, f64),
    /// Height of the character line above the surface, in metres.
    pub(super) line_height: f64,
    /// Height (y) of the lower scallop.
    pub(super) scallop: f64,
}

impl SidePanel {
    /// Draws the side of a car model; `waist` is given by the door.
    pub(super) fn new(vary: &mut Variation, waist: f64) -> Self {
        Self {
            waist,
            tumblehome: vary.of(0.25),
            bulge_radius: vary.curvature(1.7),
            bow_radius: vary.curvature(4.5),
            line: (0.075 + vary.shift(0.02), -0.05 + vary.shift(0.02)),
            line_height: vary.of(0.011),
            scallop: 0.33 + vary.shift(0.02),
        }
    }

    /// Returns the depth of the surface; smaller is nearer to the viewer.
    pub(super) fn depth(&self, x: f64, y: f64) -> f64 {
        let above = bend(self.waist - y, 0.04);
        // The bulge ends at the waist; the window frame continues straight.
        let off_middle = y.max(self.waist) - BULGE_MIDDLE;
        let onwards = (y - self.waist).min(0.0) * (self.waist - BULGE_MIDDLE);
        let bulge = (0.5 * off_middle * off_middle + onwards) / self.bulge_radius;
        let bow = x * x / (2.0 * self.bow_radius);
        // The character line: a sharp ridge that runs out over 8 cm below and 5 cm above.
        let off_line = y - (self.line.0 + self.line.1 * x);
        let reach = if off_line > 0.0 { 0.08 } else { 0.05 };
        let ridge = (1.0 - off_line.abs() / reach).max(0.0).powi(2) * self.line_height;
        let tuck = 0.35 * bend(y - self.scallop, 0.015);
        bulge + bow - ridge + tuck + self.tumblehome * above
    }
}

/// A door: its outline without the window, its panel, and what is pressed into it.
pub(super) struct Door<'a> {
    pub(super) region: &'a Region,
    pub(super) panel: &'a SidePanel,
    /// The recess behind the handle.
    pub(super) handle: &'a Region,
    /// A recessed patch such as the flat triangle for the mirror.
    pub(super) patch: Option<&'a Region>,
}

impl Door<'_> {
    /// Builds the door.
    pub(super) fn build(&self) -> Assembly {
        let lift = |x: f64, y: f64| {
            let mut z = self.panel.depth(x, y) + 0.022 * self.handle.pressing(x, y, 0.014);
            if let Some(patch) = self.patch {
                z += 0.008 * patch.pressing(x, y, 0.018);
            }
            Point3::new(x, y, z)
        };
        Sheet {
            region: self.region,
            u_range: (-0.62, 0.62),
            v_range: (-0.62, 0.62),
            spacing: 0.0095,
            lift: &lift,
            fold: &|_, _| 0.024,
        }
        .pressed()
    }
}
