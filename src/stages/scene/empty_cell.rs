//! The empty cell: what the same camera saw with no part in it.
//!
//! Whatever is as far away as it was then is background: wall and floor, and also what stands there always, such as a
//! stand, a bench or a rail, which no plane describes. A plane of the scene that was not there then is no background,
//! so a large flat part is never taken for a wall.

use nalgebra::Point3;

use super::SceneCloud;
use crate::{
    error::Advice,
    geometry::cloud::{Grid, PointCloud},
    stages::field_of_view::FieldOfView,
};

/// Pixels around one in which the nearest reading counts: the edge of a thing wanders by about that from frame to
/// frame.
const REACH: usize = 2;

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

    /// The nearest depth around a pixel, metres; infinite where nothing is known.
    pub(in crate::stages) fn nearest(&self, pixel: usize) -> f32 {
        self.nearest[pixel]
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
    use super::*;

    #[test]
    fn a_heap_of_points_is_no_empty_cell() {
        assert_eq!(
            EmptyCell::of(&SceneCloud::default()),
            Err(EmptyCellError::NoPicture)
        );
    }
}
