//! Lens distortion: maps a ray to where the lens shows it, and back.
//!
//! The model is the one that `OpenCV` documents for `calibrateCamera` (Brown, "Close-Range Camera Calibration",
//! Photogrammetric Engineering 37(8), 1971, with the rational radial part of Claus and Fitzgibbon, CVPR 2005). With
//! x, y the ray's coordinates at z = 1 and r² = x² + y²:
//!
//! ```text
//! f  = (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶)
//! x' = x f + 2 p1 x y + p2 (r² + 2 x²)        column = fx x' + cx
//! y' = y f + p1 (r² + 2 y²) + 2 p2 x y        row    = fy y' + cy
//! ```
//!
//! With k4 = k5 = k6 = 0 it is the Brown-Conrady model. The inverse has no closed form: Newton's method follows the ray
//! outwards from the axis, and every step must stay where the model is one-to-one.

use serde::{Deserialize, Serialize};

/// Coefficients of the lens distortion, with `OpenCV`'s names; all 0 for a pinhole camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Distortion {
    /// Radial, coefficient of r².
    #[serde(skip_serializing_if = "is_zero")]
    pub k1: f64,
    /// Radial, coefficient of r⁴.
    #[serde(skip_serializing_if = "is_zero")]
    pub k2: f64,
    /// Tangential, mostly along the columns.
    #[serde(skip_serializing_if = "is_zero")]
    pub p1: f64,
    /// Tangential, mostly along the rows.
    #[serde(skip_serializing_if = "is_zero")]
    pub p2: f64,
    /// Radial, coefficient of r⁶.
    #[serde(skip_serializing_if = "is_zero")]
    pub k3: f64,
    /// Radial, coefficient of r² in the denominator.
    #[serde(skip_serializing_if = "is_zero")]
    pub k4: f64,
    /// Radial, coefficient of r⁴ in the denominator.
    #[serde(skip_serializing_if = "is_zero")]
    pub k5: f64,
    /// Radial, coefficient of r⁶ in the denominator.
    #[serde(skip_serializing_if = "is_zero")]
    pub k6: f64,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(coefficient: &f64) -> bool {
    *coefficient == 0.0
}

/// x and y of a ray with z = 1.
type Ray = [f64; 2];

/// Largest error of an undistorted ray, relative to z: less than a millionth of a pixel for any camera.
const MAX_RAY_ERROR: f64 = 1e-10;
/// Newton's method doubles the number of correct digits per step; beyond this many steps it does not converge.
const MAX_STEPS: usize = 24;
/// Steps in which `undistort` follows a ray outwards from the axis.
const NUM_STAGES: usize = 8;

impl Distortion {
    /// No distortion: a pinhole camera.
    pub const NONE: Self = Self {
        k1: 0.0,
        k2: 0.0,
        p1: 0.0,
        p2: 0.0,
        k3: 0.0,
        k4: 0.0,
        k5: 0.0,
        k6: 0.0,
    };

    /// Returns true if there is no distortion.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Creates the distortion from a list in `OpenCV`'s order, k1 k2 p1 p2 k3 k4 k5 k6; missing entries are 0. `None`
    /// if entries beyond these differ from 0.
    pub fn from_list(list: &[f64]) -> Option<Self> {
        let mut all = [0.0; 8];
        for (index, coefficient) in list.iter().enumerate() {
            match all.get_mut(index) {
                Some(slot) => *slot = *coefficient,
                None if *coefficient == 0.0 => {}
                None => return None,
            }
        }
        let [k1, k2, p1, p2, k3, k4, k5, k6] = all;
        Some(Self {
            k1,
            k2,
            p1,
            p2,
            k3,
            k4,
            k5,
            k6,
        })
    }

    /// All coefficients, in the order of [`Self::from_list`].
    fn to_list(self) -> [f64; 8] {
        let Self {
            k1,
            k2,
            p1,
            p2,
            k3,
            k4,
            k5,
            k6,
        } = self;
        [k1, k2, p1, p2, k3, k4, k5, k6]
    }

    pub fn is_finite(&self) -> bool {
        self.to_list().iter().all(|k| k.is_finite())
    }

    /// Returns where the lens shows a ray; `None` outside the range in which the model is one-to-one.
    pub(super) fn distort(&self, ray: Ray) -> Option<Ray> {
        self.at(ray).map(|(seen, _)| seen)
    }

    /// Returns the ray that the lens shows at `seen`; `None` if there is none.
    pub(super) fn undistort(&self, seen: Ray) -> Option<Ray> {
        let mut ray = [0.0; 2];
        for stage in 1..=NUM_STAGES {
            let share = stage as f64 / NUM_STAGES as f64;
            ray = self.undistort_from(seen.map(|x| x * share), ray)?;
        }
        Some(ray)
    }

    /// Like [`Self::undistort`], but starts from a ray nearby.
    pub(super) fn undistort_from(&self, seen: Ray, near: Ray) -> Option<Ray> {
        let mut ray = near;
        let off = |at: &Ray| [at[0] - seen[0], at[1] - seen[1]];
        let (mut at, mut slopes) = self.at(ray)?;
        for _ in 0..MAX_STEPS {
            let [dx, dy] = off(&at);
            let error = dx.hypot(dy);
            if error < MAX_RAY_ERROR {
                return Some(ray);
            }
            let [xx, xy, yy] = slopes;
            let determinant = xx * yy - xy * xy;
            let step = [
                (yy * dx - xy * dy) / determinant,
                (xx * dy - xy * dx) / determinant,
            ];
            // Halve a step that leaves the one-to-one range or increases the error.
            let mut share = 1.0;
            loop {
                let next = [ray[0] - share * step[0], ray[1] - share * step[1]];
                if let Some((there, slopes_there)) = self.at(next) {
                    let [dx, dy] = off(&there);
                    if dx.hypot(dy) < error {
                        (ray, at, slopes) = (next, there, slopes_there);
                        break;
                    }
                }
                share *= 0.5;
                if share < 1e-3 {
                    return None;
                }
            }
        }
        None
    }

    /// Returns where a ray is seen and the derivatives xx, xy = yx and yy; `None` outside the range in which the
    /// model is one-to-one.
    fn at(&self, [x, y]: Ray) -> Option<(Ray, [f64; 3])> {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = self.to_list();
        let r2 = x * x + y * y;
        let over = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let under = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        let factor = over / under;
        // The derivative with respect to r².
        let over_slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
        let under_slope = k4 + r2 * (2.0 * k5 + r2 * 3.0 * k6);
        let slope = (over_slope - factor * under_slope) / under;
        let seen = [
            x * factor + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * factor + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ];
        let xx = factor + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
        let xy = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
        let yy = factor + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
        let is_one_to_one = under > 0.0 && factor > 0.0 && xx > 0.0 && xx * yy > xy * xy;
        is_one_to_one.then_some((seen, [xx, xy, yy]))
    }

    /// Returns the distortion of the mirrored image, with x reversed.
    #[must_use]
    pub(super) fn mirrored(self) -> Self {
        Self {
            p2: -self.p2,
            ..self
        }
    }

    /// Returns the distortion of the image turned by 90° clockwise.
    #[must_use]
    pub(super) fn turned_clockwise(self) -> Self {
        Self {
            p1: self.p2,
            p2: -self.p1,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // A wide-angle lens and a time-of-flight camera.
    const BROWN: Distortion = Distortion {
        k1: -0.28,
        k2: 0.07,
        p1: 0.0007,
        p2: -0.0003,
        k3: 0.01,
        ..Distortion::NONE
    };
    const RATIONAL: Distortion = Distortion {
        k1: 5.21,
        k2: 3.37,
        p1: -4.0e-5,
        p2: 2.5e-5,
        k3: 0.176,
        k4: 5.55,
        k5: 5.18,
        k6: 0.902,
    };

    #[test]
    #[expect(clippy::unreadable_literal, reason = "as OpenCV prints them")]
    fn rays_are_seen_where_opencv_projects_them() {
        // cv2.projectPoints of OpenCV 5.0.0: fx 525, fy 531, cx 319.5, cy 239.5.
        let expected = [
            (BROWN, [0.0, 0.0], [319.5000000000, 239.5000000000]),
            (BROWN, [0.3, 0.2], [471.4520577750, 342.0212288140]),
            (BROWN, [-0.6, 0.45], [46.1746661133, 446.9786655537]),
            (BROWN, [0.55, -0.4], [575.1362889404, 51.5762583203]),
            (BROWN, [0.02, -0.44], [329.4209201053, 18.1375723136]),
            (RATIONAL, [0.0, 0.0], [319.5000000000, 239.5000000000]),
            (RATIONAL, [0.3, 0.2], [470.3586298833, 341.2179073070]),
            (RATIONAL, [-0.6, 0.45], [52.0414079282, 442.3800991622]),
            (RATIONAL, [0.55, -0.4], [570.9232908317, 54.5515872765]),
            (RATIONAL, [0.02, -0.44], [329.3605399380, 20.1414370340]),
        ];
        for (model, ray, [u, v]) in expected {
            let [x, y] = model.distort(ray).expect("within the field");
            let off = (525.0 * x + 319.5 - u).hypot(531.0 * y + 239.5 - v);
            assert!(off < 1e-7, "{ray:?}: off by {off} pixels");
        }
    }

    #[test]
    fn the_way_back_ends_at_the_ray() {
        for model in [BROWN, RATIONAL] {
            for i in 0..41 {
                for j in 0..31 {
                    let ray = [f64::from(i) * 0.03 - 0.6, f64::from(j) * 0.03 - 0.45];
                    let seen = model.distort(ray).expect("within the field");
                    let back = model.undistort(seen).expect("it converges");
                    let off = (back[0] - ray[0]).hypot(back[1] - ray[1]);
                    assert!(off < 1e-9, "{ray:?}: off by {off}");
                }
            }
        }
    }

    #[test]
    fn what_a_folding_model_shows_nowhere_is_not_found() {
        let folds = Distortion {
            k1: -0.5,
            ..Distortion::NONE
        };
        // r - 0.5 r³ is largest at r² = 2/3.
        let fold = (2.0_f64 / 3.0).sqrt();
        let farthest = fold * (1.0 - 0.5 * fold * fold);
        assert!(folds.undistort([farthest - 1e-4, 0.0]).is_some());
        assert_eq!(folds.undistort([farthest + 1e-4, 0.0]), None);
        assert!(folds.distort([fold - 1e-4, 0.0]).is_some());
        assert_eq!(folds.distort([fold + 1e-4, 0.0]), None);
        // Beyond the second turning point, the slope of the model has its original sign again.
        assert_eq!(folds.distort([2.0, 0.0]), None);
    }

    #[test]
    fn a_list_has_opencvs_order_and_no_more_than_is_known() {
        let five = Distortion::from_list(&[-0.28, 0.07, 0.0007, -0.0003, 0.01]);
        assert_eq!(five, Some(BROWN));
        assert_eq!(Distortion::from_list(&[]), Some(Distortion::NONE));
        let mut twelve = [0.0; 12];
        assert_eq!(Distortion::from_list(&twelve), Some(Distortion::NONE));
        // A coefficient of the thin prism model.
        twelve[9] = 0.1;
        assert_eq!(Distortion::from_list(&twelve), None);
    }
}
