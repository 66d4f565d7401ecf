//! A point cloud: positions with optional grid, normals, colours and labels.

use nalgebra::{Point3, Vector3};

/// The rows and columns of an organised cloud, in the camera's order: row by row from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Points in one row, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
}

impl Grid {
    /// The number of cells, which is the number of points of an organised cloud.
    pub fn num_cells(self) -> usize {
        self.width * self.height
    }

    /// Splits ascending indices of cells by row; gives each row's number, its first index and its share of the indices. A
    /// division for every index would take most of the time.
    pub fn by_row(self, mut indices: &[u32]) -> impl Iterator<Item = (usize, usize, &[u32])> {
        std::iter::from_fn(move || {
            let row = *indices.first()? as usize / self.width;
            let start = row * self.width;
            let most = self.width.min(indices.len());
            let is_in_row = |i: &u32| (*i as usize) < start + self.width;
            let (of_row, others) = indices.split_at(indices[..most].partition_point(is_in_row));
            indices = others;
            Some((row, start, of_row))
        })
    }
}

/// Maximum share of a capture's points that may be stray, for example lie behind the camera.
pub const MAX_STRAY_SHARE: f64 = 0.001;

/// Points in metres. The owner of the cloud states their space (camera or part).
///
/// Storage is `f32`: 24 bits resolve 0.1 µm at 1 m, far below any depth camera, at half the memory traffic.
/// Sums and fits over the points are done in `f64`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Positions, metres. In an organised cloud, a cell without a reading holds three NaN; an unorganised cloud
    /// holds finite points only.
    pub points: Vec<Point3<f32>>,
    /// Unit surface normals, one per point, if known. NaN where the point is NaN.
    pub normals: Option<Vec<Vector3<f32>>>,
    /// Red, green, blue, one per point, if known.
    pub colours: Option<Vec<[u8; 3]>>,
    /// Labels from the file, one per point, if any.
    pub labels: Option<Vec<u32>>,
    /// Rows and columns if the cloud is organised; `points.len()` is then their product.
    pub grid: Option<Grid>,
    /// True if the points are simulated, according to the file or the source, and not measured by a camera.
    pub is_simulated: bool,
    /// Bytes after the last point in the file, 0 if none or not from a file. If above 0, the header does not match the
    /// content and the points may be wrong.
    pub surplus_bytes: u64,
}

impl PointCloud {
    /// Creates an unorganised cloud of bare positions; drops points that are not finite.
    pub fn from_points(points: impl IntoIterator<Item = Point3<f32>>) -> Self {
        Self {
            points: points.into_iter().filter(is_finite).collect(),
            ..Self::default()
        }
    }

    /// Iterates over the finite points with their indices.
    pub fn finite(&self) -> impl Iterator<Item = (usize, &Point3<f32>)> + Clone {
        self.points.iter().enumerate().filter(|(_, p)| is_finite(p))
    }

    /// The number of finite points.
    pub fn num_finite(&self) -> usize {
        self.finite().count()
    }

    /// Returns the share of the finite points that lie behind a camera at the origin looking along z, 0..1. Points at
    /// the origin do not count as behind: they often stand for "no reading".
    pub fn share_behind(&self) -> f64 {
        let is_behind = |p: &&Point3<f32>| p.z < 0.0 || (p.z == 0.0 && **p != Point3::origin());
        let num_behind = self.points.iter().filter(is_behind).count();
        if num_behind == 0 {
            return 0.0;
        }
        num_behind as f64 / self.num_finite().max(1) as f64
    }

    /// Returns the smallest and largest coordinates of the finite points; `None` if there are none.
    pub fn bounds(&self) -> Option<(Point3<f32>, Point3<f32>)> {
        let mut finite = self.finite().map(|(_, p)| *p);
        let first = finite.next()?;
        Some(finite.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p))))
    }
}

/// True when all three coordinates are finite.
#[inline]
pub fn is_finite(point: &Point3<f32>) -> bool {
    point.x.is_finite() && point.y.is_finite() && point.z.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascending_indices_are_split_at_the_ends_of_rows() {
        let grid = Grid {
            width: 7,
            height: 9,
        };
        let indices: Vec<u32> = (3..60).filter(|i| i % 7 != 2 && i / 14 != 1).collect();
        let mut joined: Vec<u32> = Vec::new();
        for (row, start, of_row) in grid.by_row(&indices) {
            assert!(!of_row.is_empty());
            assert!(of_row.iter().all(|i| *i as usize / 7 == row) && start == 7 * row);
            joined.extend(of_row);
        }
        assert_eq!(joined, indices);
        assert_eq!(grid.by_row(&[]).count(), 0);
    }
}
