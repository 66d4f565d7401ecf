//! The fender: the panel around the front wheel arch, from the head lamp to the narrow tail at the door.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::region::{Region, bend, smooth_step};
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Builds the left fender; the front of the car is at negative x.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let half = vary.overall(0.455);
    let arch_centre = (-0.045 + vary.shift(0.012), 0.285 + vary.shift(0.01));
    let arch_radius = vary.of(0.325);
    let sill = vary.overall(0.315);
    let door_edge = 0.375 + vary.shift(0.01);
    let lamp_top = -vary.of(0.155);
    let tail_top = -vary.of(0.315);
    let bumper_joint = vary.of(0.040);
    let outline = Region::outline(&[
        // Along the bonnet, back to the tip beside the windscreen.
        (-half + 0.10, lamp_top, 0.02),
        (-0.12, -0.235, 0.50),
        (half - 0.09, tail_top + 0.012, 0.10),
        (half, tail_top, 0.01),
        (half - 0.01, tail_top + 0.035, 0.02),
        // Down the door's edge.
        (door_edge + 0.015, tail_top + 0.130, 0.10),
        (door_edge, 0.05, 0.30),
        (door_edge - 0.02, sill, 0.02),
        (arch_centre.0, sill, 0.0),
        // The short foot in front of the wheel, the bumper's joint, the lamp.
        (-half + 0.12, 0.5 * (sill + bumper_joint), 0.03),
        (-half + 0.01, bumper_joint + 0.02, 0.02),
        (-half, bumper_joint - 0.025, 0.02),
        (-half + 0.15, bumper_joint - 0.075, 0.03),
        (-half + 0.155, lamp_top + 0.055, 0.04),
    ]);
    let arch = Region::disc(arch_centre, arch_radius);
    let blinker_x = 0.295 + vary.shift(0.012);
    let blinker = Region::slot(
        (blinker_x, -0.085 + vary.shift(0.012)),
        (vary.of(0.075), 0.034),
        0.016,
    );
    let crown = -0.150 + vary.shift(0.012);
    let line = -0.045 + vary.shift(0.015);
    let nose_radius = vary.of(0.55);
    let flare = vary.of(0.020);

    let lift = |x: f64, y: f64| {
        // Over the top towards the bonnet, around the nose, a line from lamp to door, a flared wheel arch.
        let over_top = 1.15 * bend(crown - y - 0.12 * (0.3 - x).max(0.0), 0.06);
        let nose = (-(x + 0.10)).max(0.0).powi(2) / (2.0 * nose_radius);
        let off_line = y - line - 0.06 * x;
        let ridge = (1.0 - off_line.abs() / 0.06).max(0.0).powi(2) * 0.007;
        let from_arch = ((x - arch_centre.0).hypot(y - arch_centre.1) - arch_radius) / 0.055;
        let lip = flare * (1.0 - smooth_step(from_arch));
        let bow = (y - 0.05).powi(2) / (2.0 * 1.8) + (x - 0.1).powi(2) / 8.0;
        Point3::new(x, y, bow + over_top + nose - ridge - lip)
    };
    Sheet {
        region: &outline.minus(arch).minus(blinker),
        u_range: (-vary.reach(0.50), vary.reach(0.50)),
        v_range: (-vary.reach(0.36), vary.reach(0.36)),
        spacing: 0.0075,
        lift: &lift,
        fold: &|x, y| {
            // The flange is narrower along the bonnet.
            if y < crown && x < 0.35 { 0.020 } else { 0.024 }
        },
    }
    .pressed()
}
