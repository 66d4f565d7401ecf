//! Recognition by 3-D descriptors: established methods, for comparison on our own frames.
//!
//! A segmented part is thinned and given normals (`surface`), described, and matched against the described references
//! (`matching`). Three descriptors are local: one row of numbers per keypoint, computed from the surface within a
//! radius. One is global: a single row for everything that a camera sees.
//!
//! | descriptor | numbers | what is counted |
//! | --- | --- | --- |
//! | `fpfh` | 33 | angles between pairs of normals, averaged over the neighbourhood |
//! | `shot` | 352 | angles of the normals to the keypoint's axis, in 32 sectors of a sphere |
//! | `spin_image` | 225 | points by their distance from the normal's line and from the tangent plane |
//! | `vfh` | 308 | angles between all normals, the mean normal and the viewing direction |
//!
//! All four are invariant to moving camera and part together, and all need normals that point to the camera.

pub mod fpfh;
pub mod local;
pub mod matching;
mod pair;
pub mod shot;
pub mod spin_image;
pub mod surface;
pub mod vfh;

/// One row of numbers per described keypoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Descriptors {
    /// Numbers per row.
    pub width: usize,
    /// The rows one after the other; `width` times the number of keypoints, all finite.
    pub values: Vec<f32>,
    /// Index of each row's keypoint among the surface's points, ascending. Keypoints with too few neighbours are left out.
    pub keypoints: Vec<u32>,
}

impl Descriptors {
    /// Iterates over the rows.
    pub fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.keypoints.len()
    }

    /// Returns true if there are no rows.
    pub fn is_empty(&self) -> bool {
        self.keypoints.is_empty()
    }
}

/// Scales a row to length one; returns false if it is all zero.
fn normalise(row: &mut [f32]) -> bool {
    let length = row.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length > 0.0 {
        for x in row {
            *x /= length;
        }
    }
    length > 0.0
}
