//! The empty cell: what the same camera saw with no part in it.
//!
//! Whatever is as far away as it was then is background: wall and floor, and also what stands there always, such as a
//! stand, a bench or a rail, which no plane describes. A plane of the scene that was not there then is no background,
//! so a large flat part is never taken for a wall.

use nalgebra::Point3;

use super::{PointLabel, SegmentParams};
use crate::{
    error::Advice,
    geometry::{
        cloud::{Grid, PointCloud},
        plane::Plane,
    },
    stages::{field_of_view::FieldOfView, scene::SceneCloud},
    units::Metres,
};

/// Pixels around one in which the nearest reading counts: the edge of a thing wanders by about that from frame to
/// frame.
const REACH: usize = 2;
/// A plane of the scene is one of the cell's if at least this share of its points is no nearer than before.
const LEAST_KNOWN: f64 = 0.5;

/// The depth of the empty cell, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct EmptyCell {
    grid: Grid,
    /// The nearest depth around each pixel, metres; infinite where nothing was read: nothing there is known.
    nearest: Vec<f32>,
    field_of_view: FieldOfView,
}

/// Why a capture cannot be the empty cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EmptyCellError {
    /// It has no rows and columns.
    #[error("the capture of the empty cell is no picture: its points have no rows and columns")]
    NoPicture,
    /// It is of another camera than the scene.
    #[error("the empty cell was captured with other rows and columns, and is left aside")]
    OtherPicture,
}

impl Advice for EmptyCellError {
    fn advice(&self) -> String {
        "Capture the empty cell as an organised PCD or a depth PNG, with the camera that captures the parts".into()
    }
}

impl EmptyCell {
    /// Of a capture with nothing but the cell in it.
    pub fn of(scene: &SceneCloud) -> Result<Self, EmptyCellError> {
        let grid = scene.cloud.grid.ok_or(EmptyCellError::NoPicture)?;
        let depths: Vec<f32> = scene.cloud.points.iter().map(depth_of).collect();
        // Rows first, then columns: the least of a square.
        let along = least_around(&depths, grid.width, 1, grid.width);
        let nearest = least_around(&along, grid.height, grid.width, 1);
        Ok(Self::new(grid, nearest))
    }

    /// What is known of it as a cloud, to be written and read back by [`of_cloud`](Self::of_cloud): rows and columns, and
    /// the nearest depth around each pixel, metres; no reading where nothing is known.
    pub fn to_cloud(&self) -> PointCloud {
        let point = |z: &f32| {
            if z.is_finite() {
                Point3::new(0.0, 0.0, *z)
            } else {
                Point3::new(f32::NAN, f32::NAN, f32::NAN)
            }
        };
        PointCloud {
            points: self.nearest.iter().map(point).collect(),
            grid: Some(self.grid),
            ..PointCloud::default()
        }
    }

    /// The cell that [`to_cloud`](Self::to_cloud) told of; `None` if the cloud has no rows and columns.
    pub fn of_cloud(cloud: &PointCloud) -> Option<Self> {
        let grid = cloud.grid?;
        let nearest: Vec<f32> = cloud.points.iter().map(depth_of).collect();
        (grid.width * grid.height == nearest.len()).then(|| Self::new(grid, nearest))
    }

    fn new(grid: Grid, nearest: Vec<f32>) -> Self {
        let is_reading = |i: usize| nearest.get(i).is_some_and(|z| z.is_finite());
        Self {
            field_of_view: FieldOfView::of(grid, is_reading, None),
            grid,
            nearest,
        }
    }

    /// Where in the picture the camera could deliver readings.
    pub fn field_of_view(&self) -> &FieldOfView {
        &self.field_of_view
    }

    /// True if a scene has the same rows and columns, as every frame of one camera has.
    pub fn fits(&self, scene: &SceneCloud) -> bool {
        scene.cloud.grid == Some(self.grid)
    }

    /// True if a reading is as far away as the cell was there.
    fn holds(&self, pixel: usize, z: f32, base: f32, noise: f32) -> bool {
        z > self.nearest[pixel] - base - noise * z * z
    }

    /// True if a plane of the scene was there before the part came.
    pub(super) fn knows(
        &self,
        plane: &Plane,
        scene: &SceneCloud,
        noise_at_1m: Metres,
        params: &SegmentParams,
    ) -> bool {
        /// Every so many readings one is looked at.
        const STEP: usize = 37;
        let (base, noise) = reach(noise_at_1m, params);
        let on_plane = scene.cloud.finite().step_by(STEP).filter(|(_, p)| {
            let off = plane.signed_distance(&p.cast()).abs();
            off < f64::from(base + noise * p.z * p.z)
        });
        let (mut num_known, mut num) = (0.0, 0.0_f64);
        for (i, p) in on_plane {
            num += 1.0;
            num_known += f64::from(u8::from(self.holds(i, p.z, base, noise)));
        }
        num_known >= LEAST_KNOWN * num
    }

    /// Marks what was there before the part came; `label` says so.
    pub(super) fn mark(
        &self,
        points: &[Point3<f32>],
        labels: &mut [PointLabel],
        label: PointLabel,
        noise_at_1m: Metres,
        params: &SegmentParams,
    ) {
        let (base, noise) = reach(noise_at_1m, params);
        for (i, (p, known)) in points.iter().zip(labels).enumerate() {
            if *known == PointLabel::Rest && self.holds(i, p.z, base, noise) {
                *known = label;
            }
        }
    }
}

/// A point's depth; without a reading infinite.
fn depth_of(point: &Point3<f32>) -> f32 {
    if point.z.is_finite() {
        point.z
    } else {
        f32::INFINITY
    }
}

/// How much nearer a reading may be and still be of the cell: both captures are noisy.
fn reach(noise_at_1m: Metres, params: &SegmentParams) -> (f32, f32) {
    let noise = params.noise_factor * noise_at_1m.0 * std::f64::consts::SQRT_2;
    (params.plane_distance.0 as f32, noise as f32)
}

/// The least value within reach along one direction: `length` values `step` apart, in runs that begin `apart` from
/// one another.
fn least_around(values: &[f32], length: usize, step: usize, apart: usize) -> Vec<f32> {
    let mut least = values.to_vec();
    for run in 0..values.len() / length.max(1) {
        let at = |i: usize| run * apart + i * step;
        for i in 0..length {
            let around = i.saturating_sub(REACH)..=(i + REACH).min(length - 1);
            least[at(i)] = around.map(|k| values[at(k)]).fold(f32::INFINITY, f32::min);
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        simulate::{CellSetup, Clutter, PartKind, SensorNoise, Side, SurfaceLabel, frame},
        stages::{scene::scene_from_frame, segment::segment},
    };

    #[test]
    fn what_stood_in_the_empty_cell_is_not_the_part() {
        let mut setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 4);
        setup.clutter = Clutter::OnFloor;
        let shot = frame(&setup);
        // The same cell without the part: what showed the part then shows nothing.
        setup.noise = SensorNoise::kinect(99);
        let mut empty = frame(&setup);
        for (depth, label) in empty.frame.depth.iter_mut().zip(&empty.truth.labels) {
            if *label == SurfaceLabel::Part {
                *depth = 12_000;
            }
        }
        let mut scene = scene_from_frame(&shot.frame);
        let empty = EmptyCell::of(&scene_from_frame(&empty.frame)).expect("a picture");
        scene.empty_cell = Some(Arc::new(empty));
        let found = segment(&scene, &SegmentParams::default());
        let num_clutter = found
            .labels
            .iter()
            .zip(&shot.truth.labels)
            .filter(|(found, truth)| {
                **truth == SurfaceLabel::Clutter
                    && matches!(found, PointLabel::Rest | PointLabel::Part)
            })
            .count();
        let num_cluttered = shot
            .truth
            .labels
            .iter()
            .filter(|l| **l == SurfaceLabel::Clutter);
        assert!(
            num_clutter * 50 < num_cluttered.count(),
            "{num_clutter} points of the clutter are left"
        );
        assert!(found.part.is_ok());
    }

    #[test]
    fn a_flat_part_that_fills_the_picture_is_no_wall_where_the_cell_is_known() {
        let scene_at = |z: u16| {
            let mut shot =
                frame(&CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 4)).frame;
            shot.depth.fill(z);
            scene_from_frame(&shot)
        };
        let mut scene = scene_at(6_000);
        let alone = segment(&scene, &SegmentParams::default());
        assert!(alone.part.is_err(), "without knowing the cell it is a wall");
        let empty = EmptyCell::of(&scene_at(12_000)).expect("a picture");
        scene.empty_cell = Some(Arc::new(empty));
        let found = segment(&scene, &SegmentParams::default());
        assert_eq!(found.part.expect("a part").indices.len(), 640 * 480);
    }

    #[test]
    fn a_heap_of_points_is_no_empty_cell() {
        assert_eq!(
            EmptyCell::of(&SceneCloud::default()),
            Err(EmptyCellError::NoPicture)
        );
    }
}
