//! The deposition of a gun: a jet of straight rays from its mouth, spread over an ellipse.
//!
//! At the distance d₀ at which the pattern was measured, the density of the paint over a plate perpendicular to the jet
//! is g(x, y), with ∫g = 1: an elliptical Gaussian, or a beta profile over an ellipse. For a point of a surface with
//! normal n, let r be the vector from the mouth to it, and z its component along the jet. The point receives
//!
//! ```text
//! film rate = V · g(x d₀/z, y d₀/z) · (d₀/z)² · (-r·n)/z        V = flow · transfer efficiency · solids
//! ```
//!
//! This preserves volume: all paint that leaves the mouth lands on whatever the rays meet, at any distance and slope.
//!
//! Sources: M. A. S. Arikan and T. Balkan, "Process modeling, simulation, and paint thickness measurement for robotic
//! spray painting", Journal of Robotic Systems 17(9), 2000 (beta profile of a stripe); D. C. Conner, A. Greenfield, P.
//! N. Atkar, A. A. Rizzi and H. Choset, "Paint deposition modeling for trajectory planning on automotive surfaces",
//! IEEE Transactions on Automation Science and Engineering 2(4), 2005 (Gaussian film on a plane, projected onto the
//! surface). Both fit the profile to measured stripes. Ours is one Gaussian or beta profile over the whole jet; Conner
//! et al. add an offset second Gaussian for rotary bells.
//!
//! Known limits: no drifting overspray, no electrostatics, no bounce off corners.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::coat::{Gun, Profile};

/// Where a Gaussian jet is cut off, in standard deviations: a three-thousandth of the paint lies beyond.
const GAUSSIAN_CUT_OFF_SIGMAS: f64 = 4.0;

impl Gun {
    /// Volume of film that the gun deposits, cubic metres per second.
    pub fn film_rate(&self) -> f64 {
        self.flow * self.transfer * self.solids
    }

    /// Share of the paint per square metre at the measured distance, at x across and y along the direction of travel,
    /// metres.
    pub fn density(&self, x: f64, y: f64) -> f64 {
        match self.profile {
            Profile::Gaussian => {
                let (a, b) = (self.width / 4.0, self.depth / 4.0);
                let e = (x / a).powi(2) + (y / b).powi(2);
                if e > GAUSSIAN_CUT_OFF_SIGMAS * GAUSSIAN_CUT_OFF_SIGMAS {
                    return 0.0;
                }
                (-0.5 * e).exp() / (2.0 * PI * a * b)
            }
            Profile::Beta => {
                let (a, b) = (self.width / 2.0, self.depth / 2.0);
                let within = 1.0 - (x / a).powi(2) - (y / b).powi(2);
                if within <= 0.0 {
                    return 0.0;
                }
                self.beta / (PI * a * b) * within.powf(self.beta - 1.0)
            }
        }
    }

    /// Half extent of the jet, where it is cut off, across and along the direction of travel, per distance from the
    /// mouth.
    pub(super) fn spread(&self) -> [f64; 2] {
        let ends = match self.profile {
            Profile::Gaussian => GAUSSIAN_CUT_OFF_SIGMAS / 4.0,
            Profile::Beta => 0.5,
        };
        [self.width, self.depth].map(|extent| extent * ends / self.distance)
    }

    /// Growth of the film, m/s, at `r` from the mouth: x along the fan, y across it, z along the jet. `facing` is -r·n.
    pub(super) fn film_growth(&self, r: &Vector3<f64>, facing: f64) -> f64 {
        if r.z <= 0.0 || facing <= 0.0 {
            return 0.0;
        }
        let scale = self.distance / r.z;
        self.film_rate() * self.density(r.x * scale, r.y * scale) * scale * scale * facing / r.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guns() -> [Gun; 3] {
        let beta = Gun {
            profile: Profile::Beta,
            ..Gun::default()
        };
        [Gun::default(), beta, Gun { beta: 1.5, ..beta }]
    }

    #[test]
    fn all_the_paint_lands_on_a_plate_at_any_distance_and_tilt() {
        for gun in guns() {
            for (distance, tilt) in [(0.15, 0.0_f64), (0.1, 0.0), (0.25, 0.5)] {
                // A plate through (0, 0, distance), tilted about x, cut into cells of 1 mm.
                let (along, normal) = (
                    Vector3::new(0.0, tilt.cos(), tilt.sin()),
                    Vector3::new(0.0, tilt.sin(), -tilt.cos()),
                );
                let step = 0.001;
                let mut sum = 0.0;
                for i in -500..500 {
                    for j in -300..300 {
                        let at = Vector3::new(0.0, 0.0, distance)
                            + Vector3::x() * (f64::from(i) + 0.5) * step
                            + along * (f64::from(j) + 0.5) * step;
                        sum += gun.film_growth(&at, -at.dot(&normal)) * step * step;
                    }
                }
                let share = sum / gun.film_rate();
                assert!(
                    (share - 1.0).abs() < 2e-3,
                    "{gun:?} {distance} {tilt}: {share}"
                );
            }
        }
    }

    #[test]
    fn nothing_lands_behind_the_mouth_or_on_a_back() {
        let gun = Gun::default();
        assert!(gun.film_growth(&Vector3::new(0.0, 0.0, 0.15), 0.15) > 0.0);
        assert!(gun.film_growth(&Vector3::new(0.0, 0.0, -0.15), 0.15) <= 0.0);
        assert!(gun.film_growth(&Vector3::new(0.0, 0.0, 0.15), -0.15) <= 0.0);
    }
}
