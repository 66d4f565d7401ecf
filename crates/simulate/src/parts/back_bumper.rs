//! The back bumper: smooth face under a broad loading ledge, high shoulders under the tail lamps, diffuser cut-out,
//! one exhaust opening and two reflector slots.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::plan_curve::{PlanCurve, PlanShape};
use crate::region::{Region, bend};
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Builds the back bumper, seen from behind the car.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let curve = PlanCurve::new(&PlanShape {
        half_width: vary.overall(0.700),
        front_radius: vary.curvature(2.6),
        corner_radius: vary.of(0.16),
        end_heading: 1.47 + vary.shift(0.04),
        wrap: vary.of(0.36),
    });
    let end = curve.half_length();
    let lid_half = vary.of(0.47);
    let lid_edge = -vary.of(0.150);
    let shoulder = -vary.of(0.250);
    let bottom = vary.of(0.215);
    let outline = Region::symmetric_outline(&[
        (lid_half, lid_edge, 0.03),
        (lid_half + 0.035, lid_edge - 0.01, 0.02),
        (lid_half + 0.080, shoulder, 0.04),
        (0.80 * end, shoulder - 0.004, 0.06),
        (end - 0.004, shoulder + 0.055, 0.03),
        (end - 0.004, -0.02, 0.02),
        (end - 0.10, 0.03, 0.12),
        (end - 0.20, bottom - 0.01, 0.06),
        (0.60 * end, bottom, 0.10),
    ]);
    let diffuser = Region::symmetric_outline(&[
        (vary.of(0.25), bottom - vary.of(0.085), 0.025),
        (vary.of(0.31), bottom + 0.05, 0.0),
    ]);
    let exhaust = Region::slot(
        (vary.of(0.43), bottom - 0.005),
        (vary.of(0.150), vary.of(0.120)),
        0.035,
    );
    let reflectors = Region::slot(
        (0.66 * end + vary.shift(0.02), 0.105 + vary.shift(0.01)),
        (vary.of(0.150), 0.036),
        0.012,
    )
    .on_both_sides();
    let ledge = -0.075 + vary.shift(0.012);
    let ledge_slope = vary.of(0.95);
    let skirt = 0.085 + vary.shift(0.01);

    let lift = |u: f64, v: f64| {
        // The ledge: above its edge the face turns inwards, then upwards again to the shoulders.
        let ledge_depth = ledge_slope * (bend(ledge - v, 0.012) - bend(ledge - 0.065 - v, 0.012));
        let outwards = 0.03
            - ledge_depth
            - 0.10 * bend(ledge - 0.065 - v, 0.01)
            - 0.55 * bend(v - skirt, 0.03)
            - 0.30 * (v - 0.01) * (v - 0.01);
        let (x, z) = curve.at(u, outwards);
        Point3::new(x, v, z)
    };
    Sheet {
        region: &outline.minus(diffuser).minus(exhaust).minus(reflectors),
        u_range: (-end - 0.01, end + 0.01),
        v_range: (-vary.reach(0.28), vary.reach(0.26)),
        spacing: 0.0088,
        lift: &lift,
        fold: &|u, _| if u.abs() > end - 0.015 { 0.0 } else { 0.024 },
    }
    .pressed()
}
