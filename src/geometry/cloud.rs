//! A point cloud: positions with, where the source has them, a grid, normals, colours and labels.

use nalgebra::{Point3, Vector3};

/// The rows and columns of an organised cloud, as the camera read them: row by row from the top left.
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
}

/// Points in metres. The space (camera or part) is named by whatever holds the cloud.
///
/// Storage is `f32`: 24 bits resolve 0.1 µm at 1 m, far below any depth camera, at half the memory traffic.
/// Sums and fits over the points are done in `f64`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Positions, metres. In an organised cloud a cell without a reading holds three NaN; an unorganised cloud
    /// holds finite points only.
    pub points: Vec<Point3<f32>>,
    /// Unit surface normals, one per point, if known. NaN where the point is.
    pub normals: Option<Vec<Vector3<f32>>>,
    /// Red, green, blue, one per point, if known.
    pub colours: Option<Vec<[u8; 3]>>,
    /// A label per point as the file gave it, if any.
    pub labels: Option<Vec<u32>>,
    /// Rows and columns if the cloud is organised; `points.len()` is then their product.
    pub grid: Option<Grid>,
    /// True if no camera read these points: they are simulated, and the file or the source says so.
    pub is_simulated: bool,
    /// Bytes that follow the last point in the file, if it was read from one: with any, its header does not describe what
    /// is in it, and the points may be wrong.
    pub surplus_bytes: u64,
}

impl PointCloud {
    /// An unorganised cloud of bare positions; points that are not finite are dropped.
    pub fn from_points(points: impl IntoIterator<Item = Point3<f32>>) -> Self {
        Self {
            points: points.into_iter().filter(is_finite).collect(),
            ..Self::default()
        }
    }

    /// The finite points with their index.
    pub fn finite(&self) -> impl Iterator<Item = (usize, &Point3<f32>)> + Clone {
        self.points.iter().enumerate().filter(|(_, p)| is_finite(p))
    }

    /// The number of finite points.
    pub fn num_finite(&self) -> usize {
        self.finite().count()
    }

    /// The share of the finite points that lie behind a camera at the origin that looks along z, 0..1. The origin itself
    /// is not counted: it often stands for "no reading".
    pub fn share_behind(&self) -> f64 {
        let is_behind = |p: &&Point3<f32>| p.z < 0.0 || (p.z == 0.0 && **p != Point3::origin());
        let num_behind = self.points.iter().filter(is_behind).count();
        if num_behind == 0 {
            return 0.0;
        }
        num_behind as f64 / self.num_finite().max(1) as f64
    }

    /// Smallest and largest coordinate of the finite points; `None` without any.
    pub fn bounds(&self) -> Option<(Point3<f32>, Point3<f32>)> {
        let mut finite = self.finite().map(|(_, p)| *p);
        let first = finite.next()?;
        Some(finite.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p))))
    }
}

/// True when all three coordinates are finite.
pub fn is_finite(point: &Point3<f32>) -> bool {
    point.x.is_finite() && point.y.is_finite() && point.z.is_finite()
}
