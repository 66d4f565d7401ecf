//! The front bumper: U-shaped seen from above, cut low in the middle for the grille, with plate recess, lower intake and
//! fog lamp openings, and the front edge of the wheel arch at either end.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::plan_curve::{PlanCurve, PlanShape};
use crate::region::{Region, bend};
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Builds the front bumper, seen from in front of the car.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let curve = PlanCurve::new(&PlanShape {
        half_width: vary.overall(0.700),
        front_radius: vary.curvature(1.5),
        corner_radius: vary.of(0.27),
        end_heading: 1.40 + vary.shift(0.06),
        wrap: vary.of(0.32),
    });
    let end = curve.half_length();
    let grille_half = vary.of(0.40);
    let grille_edge = -vary.of(0.105);
    let shoulder = -vary.of(0.215);
    let bottom = vary.of(0.235);
    let outline = Region::symmetric_outline(&[
        (grille_half, grille_edge, 0.03),
        (grille_half + 0.055, shoulder, 0.03),
        (grille_half + 0.13, shoulder - 0.005, 0.05),
        (0.66 * end, -0.135, 0.08),
        (0.82 * end, -0.145, 0.10),
        (end - 0.004, -0.190, 0.02),
        (end - 0.004, -0.02, 0.02),
        (end - 0.075, 0.045, 0.10),
        (end - 0.14, bottom - 0.02, 0.05),
        (0.66 * end, bottom, 0.20),
    ]);
    let intake = Region::symmetric_outline(&[
        (vary.of(0.36), 0.075 + vary.shift(0.01), 0.025),
        (vary.of(0.30), 0.180 + vary.shift(0.01), 0.030),
    ]);
    let intake_bar = Region::slot((0.0, 0.128), (1.0, 0.018), 0.001);
    let fog_u = 0.575 * end + vary.shift(0.02);
    let fog = Region::slot(
        (fog_u, 0.085 + vary.shift(0.012)),
        (vary.of(0.150), vary.of(0.092)),
        0.044,
    )
    .on_both_sides();
    let plate = Region::slot((0.0, -0.022), (0.53, 0.115), 0.010);
    let fog_bay = Region::slot((fog_u, 0.085), (0.25, 0.155), 0.05).on_both_sides();
    let crease = -0.055 + vary.shift(0.012);
    let lip = 0.195 + vary.shift(0.008);
    let lean = vary.of(0.55);

    let lift = |u: f64, v: f64| {
        // Outwards from the plan curve: leaning back above the crease, hollow below it, a lip at the bottom.
        let outwards = 0.035 - lean * bend(crease - v, 0.012) - 0.16 * bend(v - crease, 0.03)
            + 0.75 * bend(v - lip + 0.02, 0.015)
            - 0.016 * plate.pressing(u, v, 0.012)
            - 0.022 * fog_bay.pressing(u, v, 0.022);
        let (x, z) = curve.at(u, outwards);
        Point3::new(x, v, z)
    };
    Sheet {
        region: &outline.minus(intake.minus(intake_bar)).minus(fog),
        u_range: (-end - 0.01, end + 0.01),
        v_range: (-vary.reach(0.26), vary.reach(0.26)),
        spacing: 0.0088,
        lift: &lift,
        fold: &|u, _| if u.abs() > end - 0.015 { 0.0 } else { 0.026 },
    }
    .pressed()
}
