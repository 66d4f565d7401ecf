//! The empty cell: a capture by the same camera without a part.
//!
//! Everything at the depth of the empty cell is background: wall and floor, and also fixed objects that no plane
//! describes, such as a stand, a bench or a rail. A plane that was not there in the empty cell is not background, so a
//! large flat part is never taken for a wall.

use nalgebra::Point3;

use super::SceneCloud;
use crate::field_of_view::FieldOfView;
use geometry::{
    cloud::{Grid, PointCloud},
    error::Advice,
};

/// Radius in pixels over which the nearest reading counts: object edges move by about that much from frame to frame.
const REACH: usize = 2;

/// The depth of the empty cell per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct EmptyCell {
    grid: Grid,
    /// Nearest depth around each pixel, metres; infinite where there was no reading.
    nearest: Vec<f32>,
    field_of_view: FieldOfView,
}

/// Reason why a capture cannot be the empty cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[advice = "Capture the empty cell as an organised PCD or a depth PNG, with the camera that captures the parts"]
pub enum EmptyCellError {
    /// The capture has no rows and columns.
    #[error("the capture of the empty cell is not a picture: its points have no rows and columns")]
    NoPicture,
    /// The capture has other rows and columns than the scene, so it is from another camera.
    #[error("the empty cell was captured with another number of rows or columns, and is not used")]
    OtherPicture,
}

impl SceneCloud {
    /// The empty cell, if there is one that was captured with the scene's camera; another one is an error, and is not used.
    pub fn fitting_empty_cell(&self) -> Result<Option<&EmptyCell>, EmptyCellError> {
        match self.empty_cell.as_deref() {
            Some(cell) if !cell.fits(self) => Err(EmptyCellError::OtherPicture),
            cell => Ok(cell),
        }
    }
}

impl EmptyCell {
    /// Creates the empty cell from a capture without a part.
    pub fn from_scene(scene: &SceneCloud) -> Result<Self, EmptyCellError> {
        let grid = scene.cloud.grid.ok_or(EmptyCellError::NoPicture)?;
        let depths: Vec<f32> = scene.cloud.points.iter().map(depth_of).collect();
        // The minimum over a square: rows first, then columns.
        let along = least_around(&depths, grid.width, 1, grid.width);
        let nearest = least_around(&along, grid.height, grid.width, 1);
        Ok(Self::new(grid, nearest))
    }

    /// Returns the empty cell as a cloud for storage, to be read back by [`of_cloud`](Self::of_cloud): rows and
    /// columns, and the nearest depth around each pixel as z, metres; NaN where it is unknown.
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

    /// Restores the empty cell from [`to_cloud`](Self::to_cloud); `None` if the cloud has no rows and columns.
    pub fn of_cloud(cloud: &PointCloud) -> Option<Self> {
        let grid = cloud.grid?;
        let nearest: Vec<f32> = cloud.points.iter().map(depth_of).collect();
        (grid.width * grid.height == nearest.len()).then(|| Self::new(grid, nearest))
    }

    fn new(grid: Grid, nearest: Vec<f32>) -> Self {
        let is_reading = |i: usize| nearest.get(i).is_some_and(|z| z.is_finite());
        Self {
            field_of_view: FieldOfView::from_readings(grid, is_reading, None),
            grid,
            nearest,
        }
    }

    /// Returns the field of view of the capture.
    pub fn field_of_view(&self) -> &FieldOfView {
        &self.field_of_view
    }

    /// Returns true if the scene has the same rows and columns.
    fn fits(&self, scene: &SceneCloud) -> bool {
        scene.cloud.grid == Some(self.grid)
    }

    /// Returns the nearest depth around a pixel, metres; infinite where it is unknown.
    pub fn nearest(&self, pixel: usize) -> f32 {
        self.nearest[pixel]
    }
}

/// Returns a point's depth; infinite without a reading.
fn depth_of(point: &Point3<f32>) -> f32 {
    if point.z.is_finite() {
        point.z
    } else {
        f32::INFINITY
    }
}

/// Returns the minimum within [`REACH`] along one direction: runs of `length` values `step` apart, with the starts of
/// the runs `apart` from one another.
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
            EmptyCell::from_scene(&SceneCloud::default()),
            Err(EmptyCellError::NoPicture)
        );
    }
}
