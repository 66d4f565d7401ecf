//! The back door: upright B-pillar edge in front, slanted C-pillar edge and wheel-arch cut-out at the rear.

use super::side_panel::{Door, SidePanel};
use crate::assembly::Assembly;
use crate::region::Region;
use crate::variation::Variation;

/// Builds the left back door; the front of the car is at negative x.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let half = vary.overall(0.505);
    let roof = -vary.overall(0.525);
    let sill = vary.overall(0.505);
    let waist = -vary.of(0.100);
    let frame = vary.of(0.050);
    let roof_end = vary.of(0.13);
    let shoulder = waist - vary.of(0.055);
    let outline = Region::outline(&[
        (-half + 0.022, sill, 0.05),
        (-half, 0.10, 0.40),
        (-half + 0.006, waist, 0.30),
        (-half + 0.050, roof + 0.006, 0.05),
        (-0.10, roof, 0.50),
        (roof_end, roof + 0.022, 0.22),
        (half - 0.055, shoulder, 0.10),
        (half, 0.02, 0.12),
        (half - 0.012, 0.16, 0.05),
        (half - 0.11, sill + 0.10, 0.0),
        (-0.10, sill + 0.010, 0.60),
    ]);
    let arch_centre = (half + vary.of(0.045), vary.of(0.440));
    let arch = Region::disc(arch_centre, vary.of(0.345));
    let lower_edge = Region::outline(&[
        (-1.0, -1.0, 0.0),
        (1.0, -1.0, 0.0),
        (1.0, sill + 0.008, 0.0),
        (-1.0, sill + 0.004, 0.0),
    ]);
    let window = Region::outline(&[
        (-half + 0.010 + frame, waist, 0.03),
        (-half + 0.046 + frame, roof + 0.006 + frame, 0.05),
        (roof_end - 0.02, roof + 0.022 + frame, 0.12),
        (half - 0.115 - 0.6 * frame, shoulder - 0.010, 0.05),
        (half - 0.135 - 0.6 * frame, waist - 0.010, 0.03),
    ]);
    // The bar in front of the fixed quarter window.
    let bar_x = roof_end + vary.of(0.025);
    let bar = Region::outline(&[
        (bar_x - 0.016, roof, 0.0),
        (bar_x + 0.014, roof, 0.0),
        (bar_x + 0.040, 0.0, 0.0),
        (bar_x + 0.010, 0.0, 0.0),
    ]);
    let handle_x = half - vary.of(0.150);
    let handle_y = -0.010 + vary.shift(0.012);
    let handle = Region::slot(
        (handle_x, handle_y),
        (vary.of(0.150), vary.of(0.062)),
        0.030,
    );
    Door {
        region: &outline.and(lower_edge).minus(arch).minus(window.minus(bar)),
        panel: &SidePanel::new(vary, waist),
        handle: &handle,
        patch: None,
    }
    .build()
}
