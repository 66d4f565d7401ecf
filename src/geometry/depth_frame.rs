//! A depth image and the camera that took it.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::distortion::Distortion;

/// A pinhole camera with lens distortion, in pixels. Camera space is x right, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intrinsics {
    /// Columns, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
    /// Focal length along the rows, pixels, above 0.
    pub fx: f64,
    /// Focal length along the columns, pixels, above 0.
    pub fy: f64,
    /// Column of the optical axis; pixel centres are at whole numbers.
    pub cx: f64,
    /// Row of the optical axis.
    pub cy: f64,
    /// Lens distortion. In JSON and TOML its coefficients are fields of the intrinsics; zeros are omitted.
    #[serde(flatten)]
    pub distortion: Distortion,
}

impl Intrinsics {
    /// The 640×480 camera of the simulated cell, with a Kinect's field of view.
    pub const KINECT: Self = Self {
        width: 640,
        height: 480,
        fx: 525.0,
        fy: 525.0,
        cx: 319.5,
        cy: 239.5,
        distortion: Distortion::NONE,
    };

    /// Returns the camera point seen at column `u`, row `v` with depth `z` (metres along the optical axis). NaN where no
    /// ray maps to the pixel, which never happens inside the image of a camera that [`is_invertible`](Self::is_invertible).
    pub fn point_at(&self, u: f64, v: f64, z: f64) -> Point3<f64> {
        let seen = self.seen_at(u, v);
        let [x, y] = if self.distortion.is_none() {
            seen
        } else {
            self.distortion.undistort(seen).unwrap_or([f64::NAN; 2])
        };
        Point3::new(x * z, y * z, z)
    }

    /// Returns the column and row at which a camera point is seen, inside the image or not; `None` if the point is
    /// behind the camera or the lens shows it nowhere.
    pub fn pixel_of(&self, point: &Point3<f64>) -> Option<(f64, f64)> {
        if point.z <= 0.0 {
            return None;
        }
        let ray = [point.x / point.z, point.y / point.z];
        let pixel = |[x, y]: [f64; 2]| (x * self.fx + self.cx, y * self.fy + self.cy);
        if self.distortion.is_none() {
            return Some(pixel(ray));
        }
        match self.distortion.distort(ray) {
            Some(seen) => Some(pixel(seen)),
            // Beyond the range in which the model is one-to-one. Keep the pinhole pixel if it is outside the image.
            None => Some(pixel(ray)).filter(|(u, v)| !self.is_inside(*u, *v)),
        }
    }

    /// Returns true if every pixel sees its own ray, so the distortion does not fold inside the image.
    pub fn is_invertible(&self) -> bool {
        /// Sample points along each side of the image.
        const NUM_PLACES: usize = 16;
        let (right, bottom) = (self.width as f64 - 0.5, self.height as f64 - 0.5);
        let shows = |u: f64, v: f64| self.distortion.undistort(self.seen_at(u, v)).is_some();
        // `undistort` follows the ray from the axis outwards, so testing the border covers the inside.
        self.distortion.is_none()
            || (0..=NUM_PLACES).all(|k| {
                let share = k as f64 / NUM_PLACES as f64;
                let (u, v) = ((right + 0.5) * share - 0.5, (bottom + 0.5) * share - 0.5);
                shows(u, -0.5) && shows(u, bottom) && shows(-0.5, v) && shows(right, v)
            })
    }

    /// Returns the camera of the mirrored image: left and right exchanged.
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self {
            cx: self.width as f64 - 1.0 - self.cx,
            distortion: self.distortion.mirrored(),
            ..self
        }
    }

    /// Returns the camera of the image turned by 90° clockwise.
    #[must_use]
    pub fn turned_clockwise(self) -> Self {
        Self {
            width: self.height,
            height: self.width,
            fx: self.fy,
            fy: self.fx,
            cx: self.height as f64 - 1.0 - self.cy,
            cy: self.cx,
            distortion: self.distortion.turned_clockwise(),
        }
    }

    /// Returns the camera that combines blocks of `side` × `side` pixels into one; incomplete blocks are dropped.
    #[must_use]
    pub fn in_blocks(self, side: usize) -> Self {
        let k = side as f64;
        // Pixel centres are at whole numbers.
        let middle = |centre: f64| (centre - (k - 1.0) / 2.0) / k;
        Self {
            width: self.width / side,
            height: self.height / side,
            fx: self.fx / k,
            fy: self.fy / k,
            cx: middle(self.cx),
            cy: middle(self.cy),
            ..self
        }
    }

    /// Converts a pixel to ray coordinates, with the distortion still applied.
    pub(super) fn seen_at(&self, u: f64, v: f64) -> [f64; 2] {
        [(u - self.cx) / self.fx, (v - self.cy) / self.fy]
    }

    fn is_inside(&self, u: f64, v: f64) -> bool {
        u >= -0.5 && v >= -0.5 && u < self.width as f64 - 0.5 && v < self.height as f64 - 0.5
    }
}

/// One depth image as the sensor delivers it.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthFrame {
    /// The camera; its width × height is the length of `depth`.
    pub intrinsics: Intrinsics,
    /// Metres per unit of `depth`, above 0.
    pub metres_per_unit: f64,
    /// Depth along the optical axis, row by row from the top left. 0 means "no reading", as the sensor delivers it.
    pub depth: Vec<u16>,
    /// True if the depths are simulated.
    pub is_simulated: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    const BENT: Intrinsics = Intrinsics {
        width: 640,
        height: 480,
        fx: 525.0,
        fy: 531.0,
        cx: 301.0,
        cy: 250.0,
        distortion: Distortion {
            k1: -0.28,
            k2: 0.07,
            p1: 0.004,
            p2: -0.003,
            ..Distortion::NONE
        },
    };

    #[test]
    fn a_mirrored_or_turned_picture_shows_the_same_thing_at_its_new_place() {
        let point = Point3::new(0.5, -0.35, 1.3);
        let (u, v) = BENT.pixel_of(&point).expect("in front");
        let there = BENT.mirrored().pixel_of(&Point3::new(-0.5, -0.35, 1.3));
        let (across, down) = there.expect("in front");
        assert!((across - (639.0 - u)).hypot(down - v) < 1e-9);
        // A quarter turn clockwise maps right to down and down to left.
        let there = BENT
            .turned_clockwise()
            .pixel_of(&Point3::new(0.35, 0.5, 1.3));
        let (across, down) = there.expect("in front");
        assert!((across - (479.0 - v)).hypot(down - u) < 1e-9);
        let around = (0..4).fold(BENT, |camera, _| camera.turned_clockwise());
        assert_eq!(around, BENT);
    }

    #[test]
    fn the_middle_of_a_block_has_the_blocks_ray() {
        let coarse = BENT.in_blocks(4);
        assert_eq!((coarse.width, coarse.height), (160, 120));
        for (column, row) in [(0.0, 0.0), (159.0, 3.0), (80.0, 119.0)] {
            let fine = BENT.point_at(4.0 * column + 1.5, 4.0 * row + 1.5, 2.0);
            assert!((coarse.point_at(column, row, 2.0) - fine).norm() < 1e-9);
        }
    }

    #[test]
    fn a_lens_that_folds_inside_the_picture_is_known() {
        assert!(Intrinsics::KINECT.is_invertible() && BENT.is_invertible());
        let folds = |k1: f64| Intrinsics {
            distortion: Distortion {
                k1,
                ..Distortion::NONE
            },
            ..Intrinsics::KINECT
        };
        // The corner lies at 0.762 focal lengths from the axis; r + k1 r³ reaches that if k1 > -0.2551.
        assert!(folds(-0.25).is_invertible());
        assert!(!folds(-0.26).is_invertible());
    }

    #[test]
    fn what_the_lens_cannot_show_is_never_inside_the_picture() {
        // Far beyond the fold the bare formula would give a pixel.
        for x in [1.2, 2.0, 3.0] {
            let pixel = BENT.pixel_of(&Point3::new(x, 0.0, 1.0));
            assert!(pixel.is_none_or(|(u, _)| u > 640.0), "{x}: {pixel:?}");
        }
    }
}
