//! Mapping of the input's points to the pixels of its picture.

use nalgebra::Point3;

use geometry::cloud::{Grid, PointCloud};

/// Mapping of points to the pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PicturePlane {
    /// As read by the camera, one pixel per point.
    Camera(Grid),
    /// Seen from the front, the z axis pointing away from the viewer, without perspective.
    Front {
        /// Width and height, pixels.
        size: [usize; 2],
        /// Smallest x and y, metres.
        low: [f32; 2],
        /// Pixels per metre.
        per_metre: f32,
    },
}

impl PicturePlane {
    /// Longer side of a front picture, pixels; points of a reference cloud then lie about side by side.
    const LONGER: f32 = 320.0;

    /// Empty margin of a front picture, pixels.
    const MARGIN: f32 = 8.0;

    pub(super) fn of(cloud: &PointCloud) -> Self {
        if let Some(grid) = cloud.grid {
            return Self::Camera(grid);
        }
        let (low, high) = cloud
            .bounds()
            .unwrap_or((Point3::origin(), Point3::origin()));
        let extent = [0, 1].map(|axis| high[axis] - low[axis]);
        let room = Self::LONGER - 2.0 * Self::MARGIN - 1.0;
        let per_metre = room / extent[0].max(extent[1]).max(1e-6);
        let margin = Self::MARGIN / per_metre;
        Self::Front {
            size: extent.map(|length| ((length + 2.0 * margin) * per_metre).round() as usize + 1),
            low: [low.x - margin, low.y - margin],
            per_metre,
        }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [usize; 2] {
        match self {
            Self::Camera(grid) => [grid.width, grid.height],
            Self::Front { size, .. } => *size,
        }
    }

    /// Radius of a drawn point, pixels; without it, a picture not read by a camera would have gaps.
    pub fn spread(&self) -> usize {
        match self {
            Self::Camera(_) => 0,
            Self::Front { .. } => 1,
        }
    }

    /// Returns column and row of a point, given its index and coordinates.
    pub fn pixel(&self, index: usize, point: &Point3<f32>) -> [usize; 2] {
        match self {
            Self::Camera(grid) => [index % grid.width, index / grid.width],
            Self::Front {
                size,
                low,
                per_metre,
            } => [0, 1].map(|axis| {
                let at = ((point[axis] - low[axis]) * per_metre).round() as usize;
                at.min(size[axis] - 1)
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_picture_from_the_front_lie_where_they_are_seen() {
        let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 1.0], [3.0, 1.0]];
        let points = points.map(|[x, y]| Point3::new(x, y, 3.0));
        let plane = PicturePlane::of(&PointCloud::from_points(points));
        assert_eq!(plane.size(), [320, 118]);
        let pixels = [0, 1, 2, 3].map(|i| plane.pixel(i, &points[i]));
        assert_eq!(pixels, [[8, 8], [311, 8], [8, 109], [311, 109]]);
    }
}
