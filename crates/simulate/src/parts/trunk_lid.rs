//! The trunk lid: a deck and a rear face that meet in a bend with a spoiler lip; plate recess and lamp cut-ins.

use nalgebra::Point3;

use crate::assembly::Assembly;
use crate::region::Region;
use crate::sheet::Sheet;
use crate::variation::Variation;

/// The side view: two lines joined by an arc, parametrised by arc length from the middle of the bend.
struct Profile {
    /// Directions of the deck and of the rear face relative to straight down, in radians, positive towards the viewer.
    deck: f64,
    face: f64,
    bend_radius: f64,
}

impl Profile {
    /// Returns (y, z) and the outward normal at arc length `v` from the middle of the bend, positive down the rear face.
    fn at(&self, v: f64) -> ((f64, f64), (f64, f64)) {
        let half_arc = 0.5 * (self.deck - self.face) * self.bend_radius;
        let middle = 0.5 * (self.deck + self.face);
        let on_arc = v.clamp(-half_arc, half_arc);
        let heading = middle - on_arc / self.bend_radius;
        // The arc about its centre: its normal points up and towards the viewer.
        let normal = (-heading.sin(), -heading.cos());
        let tangent = (heading.cos(), -heading.sin());
        let straight = v - on_arc;
        (
            (
                self.bend_radius * normal.0 + tangent.0 * straight,
                self.bend_radius * normal.1 + tangent.1 * straight,
            ),
            normal,
        )
    }
}

/// Builds the trunk lid, seen from behind the car and a little above.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let profile = Profile {
        deck: 1.02 + vary.shift(0.06),
        face: -0.20 + vary.shift(0.05),
        bend_radius: vary.of(0.055),
    };
    let half = vary.overall(0.525);
    let deck = -vary.overall(0.300);
    let face = vary.overall(0.345);
    let lamp_inner = half - vary.of(0.120);
    let lamp_top = vary.of(0.070);
    let lamp_bottom = vary.of(0.185);
    let outline = Region::symmetric_outline(&[
        (0.25, deck - 0.012, 0.40),
        (half - 0.055, deck, 0.07),
        (half - 0.008, -0.06, 0.20),
        (half, 0.02, 0.05),
        (half - 0.004, lamp_top, 0.015),
        (lamp_inner, lamp_top + 0.014, 0.035),
        (lamp_inner - 0.006, lamp_bottom, 0.035),
        (half - 0.045, lamp_bottom + 0.022, 0.02),
        (half - 0.075, face - 0.01, 0.06),
        (0.25, face, 0.40),
    ]);
    let plate = Region::slot((0.0, vary.of(0.215)), (vary.of(0.56), vary.of(0.135)), 0.02);
    let badge = Region::disc((0.0, vary.of(0.098)), 0.042);
    let crown = vary.curvature(2.6);
    let bow = vary.curvature(2.2);
    let lip = vary.of(0.012);

    let lift = |u: f64, v: f64| {
        let ((y, z), (normal_y, normal_z)) = profile.at(v);
        let outwards = lip * (1.0 - (v.abs() / 0.05).min(1.0)).powi(2)
            - 0.024 * plate.pressing(u, v, 0.018)
            - 0.010 * badge.pressing(u, v, 0.016);
        let x_sq = u * u / 2.0;
        Point3::new(
            u,
            y + normal_y * outwards + x_sq / crown,
            z + normal_z * outwards + x_sq / bow,
        )
    };
    Sheet {
        region: &outline,
        u_range: (-vary.reach(0.58), vary.reach(0.58)),
        v_range: (-vary.reach(0.34), vary.reach(0.38)),
        spacing: 0.0085,
        lift: &lift,
        fold: &|_, _| 0.022,
    }
    .pressed()
}
