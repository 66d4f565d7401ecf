//! The front door: slanted A-pillar edge in front, mirror triangle, open window, handle recess at the back.

use super::side_panel::{Door, SidePanel};
use crate::assembly::Assembly;
use crate::region::Region;
use crate::variation::Variation;

/// Builds the left front door; the front of the car is at negative x.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let half = vary.overall(0.53);
    let roof = -vary.overall(0.53);
    let sill = vary.overall(0.51);
    let waist = -vary.of(0.085);
    // Where the slanted pillar meets roof and waist.
    let pillar_top = -half + vary.of(0.47);
    let pillar_foot = waist + 0.02 + vary.shift(0.01);
    let b_pillar = half - vary.of(0.045);
    let frame = vary.of(0.050);
    let outline = Region::outline(&[
        (-half + 0.035, sill, 0.06),
        (-half + 0.008, 0.24, 0.30),
        (-half, 0.10, 0.20),
        (-half + 0.004, pillar_foot, 0.03),
        (-half + 0.13, pillar_foot - 0.145, 0.40),
        (pillar_top, roof + 0.018, 0.16),
        (0.5 * (pillar_top + b_pillar), roof, 0.60),
        (b_pillar, roof + 0.012, 0.05),
        (half - 0.008, waist, 0.30),
        (half, 0.12, 0.30),
        (half - 0.018, 0.36, 0.25),
        (half - 0.045, sill + 0.005, 0.07),
        (0.0, sill + 0.012, 1.0),
    ]);
    // The mirror triangle closes the front corner of the window.
    let window_front = -half + vary.of(0.215);
    let window = Region::outline(&[
        (window_front, waist, 0.025),
        (window_front + 0.035, waist - 0.155, 0.05),
        (pillar_top + 0.035, roof + 0.018 + frame, 0.09),
        (b_pillar - 0.9 * frame, roof + 0.012 + frame, 0.05),
        (half - 0.008 - 1.1 * frame, waist - 0.012, 0.03),
    ]);
    let mirror = Region::outline(&[
        (-half + 0.060, pillar_foot - 0.040, 0.01),
        (window_front + 0.004, waist - 0.165, 0.01),
        (window_front - 0.022, waist - 0.012, 0.012),
        (-half + 0.055, waist - 0.005, 0.012),
    ]);
    let handle_x = half - vary.of(0.125);
    let handle_y = 0.015 + vary.shift(0.012);
    let handle = Region::slot(
        (handle_x, handle_y),
        (vary.of(0.150), vary.of(0.062)),
        0.030,
    );
    Door {
        region: &outline.minus(window),
        panel: &SidePanel::new(vary, waist),
        handle: &handle,
        patch: Some(&mirror),
    }
    .build()
}
