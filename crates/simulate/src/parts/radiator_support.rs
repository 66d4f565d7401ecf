//! The radiator support: upper and lower beam, two uprights and a central brace around two large openings, with a
//! head-lamp bracket on either side.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::region::Region;
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Builds the radiator support, seen from in front of the car.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let half = vary.overall(0.575);
    let top = -vary.overall(0.250);
    let bottom = vary.overall(0.250);
    let upright = vary.of(0.385);
    let upper_beam = vary.of(0.070);
    let lower_beam = vary.of(0.075);
    let post = vary.of(0.055);
    let brace = vary.of(0.050);
    let outline = Region::symmetric_outline(&[
        (0.30, top, 0.20),
        (half - 0.14, top + 0.016, 0.10),
        (half, top + 0.050, 0.025),
        (half - 0.006, top + 0.125, 0.025),
        // The lamp bracket runs down to the upright in a hollow curve.
        (half - 0.050, 0.015, 0.05),
        (upright + 0.050, 0.110, 0.06),
        (upright + 0.030, bottom - 0.02, 0.03),
        (0.24, bottom, 0.10),
    ]);
    let opening_top = top + upper_beam;
    let opening_bottom = bottom - lower_beam;
    let opening = Region::outline(&[
        (0.5 * brace, opening_top + 0.045, 0.03),
        (0.5 * brace + 0.05, opening_top + 0.006, 0.03),
        (upright - post + 0.01, opening_top + 0.012, 0.04),
        (upright - post, opening_bottom, 0.05),
        (0.5 * brace, opening_bottom, 0.03),
    ])
    .on_both_sides();
    // The lamp sits in a round seat, so that the bracket is a ring.
    let lamp = Region::disc(
        (
            half - 0.094 + vary.shift(0.006),
            top + 0.155 + vary.shift(0.006),
        ),
        vary.of(0.056),
    )
    .on_both_sides();
    let latch = Region::slot((0.0, top + 0.045), (0.075, 0.030), 0.012);
    let slots = Region::slot(
        (0.20 + vary.shift(0.02), bottom - 0.5 * lower_beam),
        (0.13, 0.026),
        0.012,
    )
    .on_both_sides();
    let beads = Region::slot((0.22, top + 0.5 * upper_beam), (0.24, 0.036), 0.016).on_both_sides();
    let lower_beads = Region::slot((0.0, bottom - 0.5 * lower_beam), (0.20, 0.036), 0.016);
    let post_beads =
        Region::slot((upright - 0.5 * post + 0.006, 0.01), (0.026, 0.26), 0.012).on_both_sides();
    let bow = vary.curvature(1.8);
    let lamp_set_back = vary.of(0.055);

    let lift = |x: f64, y: f64| {
        // The upper beam stands in front of the lower one; the lamp brackets are behind both.
        let lean = 0.10 * y;
        let bracket = lamp_set_back * ((x.abs() - upright) / 0.10).clamp(0.0, 1.0);
        let pressed = beads.pressing(x, y, 0.012) + lower_beads.pressing(x, y, 0.012)
            - post_beads.pressing(x, y, 0.010);
        let z = x * x / (2.0 * bow) + lean + bracket + 0.012 * pressed;
        Point3::new(x, y, z)
    };
    Sheet {
        region: &outline.minus(opening).minus(lamp).minus(latch).minus(slots),
        u_range: (-vary.reach(0.62), vary.reach(0.62)),
        v_range: (-vary.reach(0.30), vary.reach(0.30)),
        spacing: 0.0065,
        lift: &lift,
        // Deep flanges: the beams are open channels.
        fold: &|_, _| 0.032,
    }
    .pressed()
}
