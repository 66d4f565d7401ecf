//! A depth image and the camera that took it.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::distortion::Distortion;
use crate::{error::Advice, units::Radians};

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
    #[inline]
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
    #[inline]
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

/// Why the numbers of a camera are probably wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, Advice)]
pub enum CameraDoubt {
    /// The optical axis is far from the middle of the picture.
    #[error(
        "the camera's centre ({:.0}, {:.0}) lies {:.0} pixels from the middle of the picture", centre[0], centre[1], off
    )]
    #[advice = "Check cx and cy, and whether the picture was cut, mirrored or turned after they were measured: an error of 10 pixels moves a part by 2 cm"]
    OffCentre {
        /// cx and cy, pixels.
        centre: [f64; 2],
        /// Distance from the middle of the picture, pixels.
        off: f64,
    },
    /// The focal lengths differ as no camera's do.
    #[error("the camera's focal lengths differ: fx = {fx:.1} and fy = {fy:.1} pixels")]
    #[advice = "Check fx and fy, and whether the picture was stretched: parts would have the wrong width or height"]
    FocalLengthsDiffer {
        /// Along the rows, pixels.
        fx: f64,
        /// Along the columns, pixels.
        fy: f64,
    },
    /// No depth camera sees so much or so little.
    #[error(
        "the camera would see {:.0}° of its surroundings (fx = {fx:.1} pixels at {width} columns)",
        field.degrees()
    )]
    #[advice = "Check that fx and fy are in pixels of a picture of this size"]
    FieldOfView {
        /// Field of view along the longer side.
        field: Radians,
        /// Focal length along the rows, pixels.
        fx: f64,
        /// Columns of the picture.
        width: usize,
    },
}

/// Pictures of fewer pixels come from no camera, but are made up to try something.
const MIN_PIXELS: usize = 1000;
/// Largest distance of the optical axis from the middle, as a share of the picture's diagonal. Depth cameras come up to
/// 0.053 (the narrow field of an Azure Kinect, which is cut out of a larger picture), most to 0.03.
const MAX_OFF_CENTRE_SHARE: f64 = 0.06;
/// Largest ratio of the focal lengths: pixels of depth cameras are square.
const MAX_FOCAL_RATIO: f64 = 1.05;
/// Fields of view along the longer side: long lenses of structured-light cameras have 25°, the widest time-of-flight
/// cameras 120°.
const FIELDS_OF_VIEW: std::ops::RangeInclusive<f64> = 15.0..=130.0;

impl Intrinsics {
    /// Returns why the numbers are probably wrong, if they are. Numbers are never changed: an unusual camera works.
    pub fn doubt(&self) -> Option<CameraDoubt> {
        let Self {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            ..
        } = *self;
        if width.saturating_mul(height) < MIN_PIXELS {
            return None;
        }
        let sides = [width as f64, height as f64];
        let off = (cx - (sides[0] - 1.0) / 2.0).hypot(cy - (sides[1] - 1.0) / 2.0);
        if off > MAX_OFF_CENTRE_SHARE * sides[0].hypot(sides[1]) {
            return Some(CameraDoubt::OffCentre {
                centre: [cx, cy],
                off,
            });
        }
        if fx.max(fy) > MAX_FOCAL_RATIO * fx.min(fy) {
            return Some(CameraDoubt::FocalLengthsDiffer { fx, fy });
        }
        let half = (sides[0] / fx).max(sides[1] / fy) / 2.0;
        let field = Radians(2.0 * half.atan());
        let is_usual = FIELDS_OF_VIEW.contains(&field.degrees());
        (!is_usual).then_some(CameraDoubt::FieldOfView { field, fx, width })
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
    fn cameras_that_exist_are_not_doubted() {
        // Kinect, booth camera, Azure Kinect (narrow and wide field), Femto Bolt, RealSense D435, L515, D405, Zivid 2,
        // Kinect v2, Structure, a low-resolution time-of-flight camera.
        for (width, height, fx, fy, cx, cy) in [
            (640, 480, 525.0, 525.0, 319.5, 239.5),
            (640, 480, 594.2, 591.0, 339.5, 242.7),
            (640, 480, 468.3, 469.4, 327.5, 228.9),
            (640, 576, 504.1, 504.2, 319.9, 330.6),
            (512, 512, 252.4, 252.4, 257.3, 258.0),
            (640, 576, 505.2, 505.1, 325.6, 331.9),
            (848, 480, 423.4, 423.4, 421.9, 238.6),
            (1024, 768, 731.3, 731.9, 506.5, 377.8),
            (1280, 720, 649.6, 649.6, 644.1, 354.2),
            (1944, 1200, 1776.5, 1776.6, 967.6, 601.2),
            (512, 424, 365.5, 365.5, 254.9, 205.4),
            (320, 240, 288.0, 288.0, 158.0, 121.0),
            (224, 172, 210.4, 210.4, 114.7, 87.6),
        ] {
            let camera = Intrinsics {
                width,
                height,
                fx,
                fy,
                cx,
                cy,
                distortion: Distortion::NONE,
            };
            assert_eq!(camera.doubt(), None, "{width} {fx}");
            for side in 2..5 {
                assert_eq!(camera.in_blocks(side).doubt(), None, "{width} in {side}");
            }
            assert_eq!(camera.turned_clockwise().mirrored().doubt(), None);
        }
    }

    #[test]
    fn cameras_that_cannot_be_are_doubted() {
        let doubt = |change: fn(&mut Intrinsics)| {
            let mut camera = Intrinsics::KINECT;
            change(&mut camera);
            camera.doubt()
        };
        for off_centre in [
            doubt(|camera| camera.cx += 60.0),
            doubt(|camera| camera.cy -= 60.0),
            // The centre of a picture twice as large.
            doubt(|camera| (camera.cx, camera.cy) = (639.5, 479.5)),
        ] {
            assert!(
                matches!(off_centre, Some(CameraDoubt::OffCentre { .. })),
                "{off_centre:?}"
            );
        }
        let differ = doubt(|camera| camera.fy = 394.0);
        assert!(matches!(
            differ,
            Some(CameraDoubt::FocalLengthsDiffer { .. })
        ));
        for field in [
            // Millimetres instead of pixels, and a lens of a much larger picture.
            doubt(|camera| (camera.fx, camera.fy) = (3.6, 3.6)),
            doubt(|camera| (camera.fx, camera.fy) = (4200.0, 4200.0)),
        ] {
            assert!(
                matches!(field, Some(CameraDoubt::FieldOfView { .. })),
                "{field:?}"
            );
        }
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
