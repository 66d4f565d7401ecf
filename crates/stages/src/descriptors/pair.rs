//! The pair feature of FPFH and VFH: two oriented points as three angles.
//!
//! R. B. Rusu, N. Blodow and M. Beetz, "Fast Point Feature Histograms (FPFH) for 3D registration", ICRA 2009: the
//! normal and the line to the target t define a frame u, v, w at the source point s, in which t's normal is expressed.

use std::f32::consts::{FRAC_PI_2, PI};

use nalgebra::{Point3, Vector3};

/// Orientation of the normal at the target relative to that at the source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PairAngles {
    /// `α = v·n_t`, -1..1.
    pub(super) alpha: f32,
    /// φ = u·(t - s)/|t - s|, -1..1.
    pub(super) phi: f32,
    /// `θ = atan2(w·n_t, u·n_t)`, -π..π.
    pub(super) theta: f32,
}

/// Computes the angles with the source `u = n_s`, v = d × u (unit), w = u × v; `None` if the points coincide or the
/// normal is parallel to the line d between them, so that there is no frame.
#[inline]
pub(super) fn pair_angles(
    source: (&Point3<f32>, &Vector3<f32>),
    target: (&Point3<f32>, &Vector3<f32>),
) -> Option<PairAngles> {
    let line = target.0 - source.0;
    let distance = line.norm();
    if !(distance > f32::MIN_POSITIVE) {
        return None;
    }
    let d = line / distance;
    let (u, n) = (source.1, target.1);
    let across = d.cross(u);
    let width = across.norm();
    // If the angle between d and u is less than a milliradian, rounding determines the direction of v.
    if !(width > 1e-3) {
        return None;
    }
    let v = across / width;
    let w = u.cross(&v);
    Some(PairAngles {
        alpha: v.dot(n),
        phi: u.dot(&d),
        theta: angle_of(w.dot(n), u.dot(n)),
    })
}

/// Approximates `y.atan2(x)` to within 2e-5: the exact function took half the time of a pair, and the angle is only binned.
///
/// M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.47, for the arc tangent up to one.
#[inline]
fn angle_of(y: f32, x: f32) -> f32 {
    let (short, long) = (y.abs().min(x.abs()), y.abs().max(x.abs()));
    if !(long > 0.0) {
        return 0.0;
    }
    let t = short / long;
    let s = t * t;
    let series =
        0.999_866 + s * (-0.330_299_5 + s * (0.180_141 + s * (-0.085_133 + s * 0.020_835_1)));
    let up_to_eighth = t * series;
    let up_to_quarter = if y.abs() > x.abs() {
        FRAC_PI_2 - up_to_eighth
    } else {
        up_to_eighth
    };
    let up_to_half = if x < 0.0 {
        PI - up_to_quarter
    } else {
        up_to_quarter
    };
    up_to_half.copysign(y)
}

/// Returns the bin of `value` among `num` equal ones over `-limit..limit`; values outside go to the outermost bins.
#[inline]
pub(super) fn bin(value: f32, limit: f32, num: usize) -> usize {
    let position = (value / limit + 1.0) * 0.5 * num as f32;
    // The cast clamps negative values and NaN to zero.
    (position as usize).min(num - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_points_of_a_sphere_differ_by_the_angle_between_their_radii() {
        let angle = 0.6_f32;
        let n1 = Vector3::new(0.0, 0.0, 1.0);
        let n2 = Vector3::new(angle.sin(), 0.0, angle.cos());
        let [p1, p2] = [n1, n2].map(|n| Point3::from(n * 0.25));
        let found = pair_angles((&p1, &n1), (&p2, &n2)).expect("a frame");
        assert!(found.alpha.abs() < 1e-6);
        assert!((found.phi + (angle / 2.0).sin()).abs() < 1e-6);
        assert!((found.theta - angle).abs() < 2e-5);
    }

    #[test]
    fn the_quick_arc_tangent_is_the_slow_one() {
        for i in -1800..=1800 {
            let angle = i as f32 * PI / 1800.0;
            for size in [1e-3, 0.4, 1.0] {
                let (y, x) = (size * angle.sin(), size * angle.cos());
                assert!((angle_of(y, x) - y.atan2(x)).abs() < 2e-5, "{angle}");
            }
        }
        assert!(angle_of(0.0, 0.0).abs() < 1e-9);
    }

    #[test]
    fn one_point_twice_and_a_normal_along_the_line_have_no_frame() {
        let (p, q) = (Point3::origin(), Point3::new(0.0, 0.0, 1.0));
        let (x, z) = (Vector3::x(), Vector3::z());
        assert_eq!(pair_angles((&p, &z), (&p, &x)), None);
        assert_eq!(pair_angles((&p, &z), (&q, &x)), None);
        assert_eq!(
            pair_angles((&p, &x), (&Point3::new(f32::NAN, 0.0, 0.0), &x)),
            None
        );
    }

    #[test]
    fn bins_are_even_and_catch_what_lies_outside() {
        assert_eq!(bin(-1.0, 1.0, 11), 0);
        assert_eq!(bin(0.0, 1.0, 11), 5);
        assert_eq!(bin(1.0, 1.0, 11), 10);
        assert_eq!(bin(1.000_01, 1.0, 11), 10);
        assert_eq!(bin(-7.0, 1.0, 11), 0);
        assert_eq!(bin(f32::NAN, 1.0, 11), 0);
    }
}
