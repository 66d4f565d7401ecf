//! The field of view of a depth picture registered to a colour picture: a quadrilateral within the picture.
//!
//! Its sides are slightly skew, its corners may be rounded, its borders are ragged by a pixel or two. The left border is
//! where the projector's light ends: it moves with the disparity, so that near surfaces end further inside.

use rand::{Rng as _, RngExt as _};
use rand_pcg::Pcg64;

use crate::sensor::BASELINE_M;
use geometry::depth_frame::Intrinsics;

/// The region of the picture in which the sensor delivers readings; `None` for the whole picture.
pub(super) struct FieldOfView(Option<Borders>);

struct Borders {
    /// Left, right, top, bottom.
    sides: [Border; 4],
    /// In pixels.
    corner_radius: f64,
    /// Focal length times baseline: pixels that the left border moves per 1/m beyond [`BORDER_DEPTH_M`].
    focal_baseline: f64,
}

/// A point (u, v) is inside if `across[0] · u + across[1] · v + offset` exceeds the border's raggedness there.
struct Border {
    across: [f64; 2],
    offset: f64,
    /// Deviation of the border from a straight line in pixels, by position along it.
    ragged: Vec<f64>,
}

/// The depth at which the left border is where it was drawn, in metres.
const BORDER_DEPTH_M: f64 = 2.2;
/// Share of frames that have readings up to the picture's edge.
const NO_BORDER: f64 = 0.15;

impl FieldOfView {
    pub(super) fn draw(camera: &Intrinsics, random: &mut Pcg64) -> Self {
        if random.random_bool(NO_BORDER) {
            return Self(None);
        }
        let (width, height) = (camera.width as f64, camera.height as f64);
        let widest = if random.random_bool(0.6) { 0.11 } else { 0.2 };
        // Some cameras are mounted with less care.
        let turned = if random.random_bool(0.75) {
            0.015
        } else {
            0.08
        };
        let turn = random.random_range(-turned..turned);
        let corner_radius = if random.random_bool(0.3) {
            random.random_range(10.0..90.0)
        } else {
            0.0
        };
        let middle = [0.5 * width, 0.5 * height];
        let inwards = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let sides = inwards.map(|[x, y]| {
            let angle: f64 = turn + random.random_range(-0.02..0.02);
            let (sin, cos) = angle.sin_cos();
            let across = [x * cos - y * sin, x * sin + y * cos];
            let extent = if y == 0.0 { width } else { height };
            let half = extent * (0.5 - random.random_range(0.03..widest));
            let num_places = if y == 0.0 {
                camera.height
            } else {
                camera.width
            };
            Border {
                across,
                offset: half - across[0] * middle[0] - across[1] * middle[1],
                ragged: ragged(num_places, random),
            }
        });
        Self(Some(Borders {
            sides,
            corner_radius,
            focal_baseline: camera.fx * BASELINE_M,
        }))
    }

    /// Returns true if a surface at this depth yields a reading in column `u`, row `v`.
    pub(super) fn contains(&self, u: f64, v: f64, depth: f64) -> bool {
        let Some(borders) = &self.0 else {
            return true;
        };
        let Borders {
            sides: [left, right, top, bottom],
            corner_radius,
            focal_baseline,
        } = borders;
        let moved = focal_baseline * (1.0 / depth - 1.0 / BORDER_DEPTH_M);
        let aside = left.distance(u, v, v) - moved;
        let aside = aside.min(right.distance(u, v, v));
        let upright = top.distance(u, v, u).min(bottom.distance(u, v, u));
        if aside < *corner_radius && upright < *corner_radius {
            return (corner_radius - aside).hypot(corner_radius - upright) < *corner_radius;
        }
        aside > 0.0 && upright > 0.0
    }

    /// Returns the middle of the field of view as column and row.
    pub(super) fn middle(&self, camera: &Intrinsics) -> [f64; 2] {
        let middle = [0.5 * camera.width as f64, 0.5 * camera.height as f64];
        let Some(Borders { sides, .. }) = &self.0 else {
            return middle;
        };
        let inside =
            |side: &Border| side.offset + side.across[0] * middle[0] + side.across[1] * middle[1];
        let [left, right, top, bottom] = sides;
        [
            middle[0] + 0.5 * (inside(right) - inside(left)),
            middle[1] + 0.5 * (inside(bottom) - inside(top)),
        ]
    }
}

impl Border {
    /// Returns the distance inside the border in pixels, with the raggedness at position `along`.
    fn distance(&self, u: f64, v: f64, along: f64) -> f64 {
        let index = (along.max(0.0) as usize).min(self.ragged.len() - 1);
        self.across[0] * u + self.across[1] * v + self.offset - self.ragged[index]
    }
}

/// Draws correlated noise of up to about two pixels.
fn ragged(num_places: usize, random: &mut Pcg64) -> Vec<f64> {
    let amplitude = random.random_range(0.2..0.8);
    let mut value = 0.0;
    (0..num_places)
        .map(|_| {
            let draw = f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5;
            value = 0.85 * value + 1.8 * amplitude * draw;
            value
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;

    use super::*;
    use crate::booth::CAMERA;

    fn fields() -> impl Iterator<Item = FieldOfView> {
        (0..60).map(|seed| FieldOfView::draw(&CAMERA, &mut Pcg64::seed_from_u64(seed)))
    }

    #[test]
    fn most_fields_leave_a_border_on_all_sides_and_some_none() {
        let edges = [(0.0, 240.0), (639.0, 240.0), (320.0, 0.0), (320.0, 479.0)];
        let num_bordered = fields()
            .filter(|field| edges.iter().all(|&(u, v)| !field.contains(u, v, 2.2)))
            .count();
        let num_whole = fields().filter(|field| field.0.is_none()).count();
        assert!((40..60).contains(&num_bordered), "{num_bordered}");
        assert_eq!(num_bordered + num_whole, 60);
        assert!(fields().all(|field| field.contains(320.0, 240.0, 2.2)));
    }

    #[test]
    fn about_a_third_of_the_picture_has_no_reading() {
        let bordered = fields().filter(|field| field.0.is_some());
        let shares: Vec<f64> = bordered
            .map(|field| {
                let pixels = (0..480).flat_map(|v| (0..640).map(move |u| (u, v)));
                let num = pixels.filter(|&(u, v)| !field.contains(f64::from(u), f64::from(v), 2.0));
                num.count() as f64 / (640.0 * 480.0)
            })
            .collect();
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        assert!((0.2..0.4).contains(&mean), "{mean}");
    }

    #[test]
    fn near_surfaces_end_farther_inside_on_the_left() {
        let first_column = |field: &FieldOfView, depth: f64| {
            (0..640).find(|&u| field.contains(f64::from(u), 240.0, depth))
        };
        for field in fields().filter(|field| field.0.is_some()) {
            let (near, far) = (first_column(&field, 0.8), first_column(&field, 2.2));
            // 468 px · 0.075 m · (1/0.8 m - 1/2.2 m) = 28 px.
            let moved = near.zip(far).map(|(near, far)| near - far);
            assert!(moved.is_some_and(|px| (27..=29).contains(&px)), "{moved:?}");
        }
    }
}
