//! What both doors share: the barrel of the car's side, its lines, and how a door is pressed.

use nalgebra::Point3;

use crate::simulate::assembly::Assembly;
use crate::simulate::region::{Region, bend};
use crate::simulate::sheet::Sheet;
use crate::simulate::variation::Variation;

/// Height at which a car's side bulges out farthest, y.
const BULGE_MIDDLE: f64 = 0.12;

/// The outer surface of a car's side, as depth over (x, y).
pub(super) struct SidePanel {
    /// Height of the waistline (lower edge of the window), y.
    pub(super) waist: f64,
    /// Slope that the window frame adds at the waist, metres of depth per metre of height.
    pub(super) tumblehome: f64,
    /// Radius of the panel's bulge below the waist.
    pub(super) bulge_radius: f64,
    /// Radius of the panel's bow along the car.
    pub(super) bow_radius: f64,
    /// Height of the character line, y at x = 0, and its slope.
    pub(super) line: (f64, f64),
    /// How far the line stands out, metres.
    pub(super) line_height: f64,
    /// Height of the lower scallop, y.
    pub(super) scallop: f64,
}

impl SidePanel {
    /// The side of the car model; `waist` is the door's own.
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

    /// Depth of the surface; smaller is nearer to the viewer.
    pub(super) fn depth(&self, x: f64, y: f64) -> f64 {
        let above = bend(self.waist - y, 0.04);
        // The bulge ends at the waist; the window frame goes on straight.
        let off_middle = y.max(self.waist) - BULGE_MIDDLE;
        let onwards = (y - self.waist).min(0.0) * (self.waist - BULGE_MIDDLE);
        let bulge = (0.5 * off_middle * off_middle + onwards) / self.bulge_radius;
        let bow = x * x / (2.0 * self.bow_radius);
        // The character line: a ridge, sharp on top, running out over 8 cm below and 5 cm above.
        let off_line = y - (self.line.0 + self.line.1 * x);
        let reach = if off_line > 0.0 { 0.08 } else { 0.05 };
        let ridge = (1.0 - off_line.abs() / reach).max(0.0).powi(2) * self.line_height;
        let tuck = 0.35 * bend(y - self.scallop, 0.015);
        bulge + bow - ridge + tuck + self.tumblehome * above
    }
}

/// A door: its outline with the window taken out, its panel, and what is pressed into it.
pub(super) struct Door<'a> {
    pub(super) region: &'a Region,
    pub(super) panel: &'a SidePanel,
    /// The bowl behind the handle.
    pub(super) handle: &'a Region,
    /// The flat triangle that carries the mirror, or any other patch set in.
    pub(super) patch: Option<&'a Region>,
}

impl Door<'_> {
    /// Presses the door.
    pub(super) fn build(&self) -> Assembly {
        let lift = |x: f64, y: f64| {
            let mut z = self.panel.depth(x, y) + 0.022 * self.handle.pressing(x, y, 0.014);
            if let Some(patch) = self.patch {
                z += 0.008 * patch.pressing(x, y, 0.018);
            }
            Point3::new(x, y, z)
        };
        let mut door = Assembly::default();
        Sheet {
            region: self.region,
            u_range: (-0.62, 0.62),
            v_range: (-0.62, 0.62),
            spacing: 0.0095,
            lift: &lift,
            fold: &|_, _| 0.024,
        }
        .press_into(&mut door);
        door
    }
}
