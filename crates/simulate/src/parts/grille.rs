//! The grille: a bowed frame, wider on top, with horizontal slats and the maker's badge in the middle.

use nalgebra::{Point3, Vector3};

use crate::assembly::Assembly;
use crate::beam::{Section, sweep};
use crate::region::Region;
use crate::sheet::Sheet;
use crate::variation::Variation;

/// Builds the grille, seen from in front of the car.
pub(super) fn build(vary: &mut Variation) -> Assembly {
    let half_top = vary.overall(0.450);
    let half_bottom = vary.of(0.330);
    let half_height = vary.overall(0.140);
    let rim = vary.of(0.026);
    let bow = vary.curvature(1.9);
    let surface = |x: f64, y: f64| x * x / (2.0 * bow) + 0.16 * y + y * y / 1.6;

    let frame = Region::symmetric_outline(&[
        (0.20, -half_height, 0.30),
        (half_top, -half_height + 0.022, 0.045),
        (half_bottom + 0.05, half_height - 0.05, 0.06),
        (half_bottom - 0.03, half_height, 0.05),
    ]);
    let opening = Region::symmetric_outline(&[
        (0.20, -half_height + rim, 0.30),
        (half_top - 1.9 * rim, -half_height + 0.018 + rim, 0.030),
        (
            half_bottom + 0.05 - 1.1 * rim,
            half_height - 0.05 - 0.5 * rim,
            0.045,
        ),
        (half_bottom - 0.04, half_height - rim, 0.04),
    ]);
    let badge_radius = vary.of(0.058);
    let badge = Region::disc((0.0, 0.0), badge_radius);

    let mut grille = Assembly::default();
    let num_slats = 5;
    let pitch = (2.0 * half_height - 2.0 * rim) / f64::from(num_slats + 1);
    let slat = Section::Bar {
        width: vary.of(0.013),
        depth: vary.of(0.020),
    };
    for k in 1..=num_slats {
        let y = -half_height + rim + pitch * f64::from(k);
        let reach = slat_reach(&opening, y);
        let path: Vec<Point3<f64>> = (-24..=24)
            .map(|step| {
                let x = (reach + 0.006) * f64::from(step) / 24.0;
                Point3::new(x, y, surface(x, y) + 0.016)
            })
            .collect();
        sweep(&mut grille, &path, slat, -Vector3::z());
    }
    Sheet {
        region: &frame.minus(opening),
        u_range: (-vary.reach(0.50), vary.reach(0.50)),
        v_range: (-vary.reach(0.17), vary.reach(0.17)),
        spacing: 0.0060,
        lift: &|x, y| Point3::new(x, y, surface(x, y)),
        fold: &|_, _| 0.028,
    }
    .press_into(&mut grille);
    Sheet {
        region: &badge,
        u_range: (-vary.reach(0.08), vary.reach(0.08)),
        v_range: (-vary.reach(0.08), vary.reach(0.08)),
        spacing: 0.0050,
        // A shallow dome in front of the slats.
        lift: &|x, y| Point3::new(x, y, surface(0.0, y) - 0.010 + (x * x + y * y) * 3.0),
        fold: &|_, _| 0.014,
    }
    .press_into(&mut grille);
    grille
}

/// Returns half the width of the opening at height `y`.
fn slat_reach(opening: &Region, y: f64) -> f64 {
    let (mut inside, mut outside) = (0.0, 0.6);
    for _ in 0..20 {
        let middle = 0.5 * (inside + outside);
        if opening.distance(middle, y) < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}
