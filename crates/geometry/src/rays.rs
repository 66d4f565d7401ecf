//! The ray of every pixel of a camera, computed once per camera.

use std::sync::{Arc, Mutex};

use nalgebra::Point3;

use super::depth_frame::Intrinsics;
use crate::error::lock;

/// x/z and y/z of every pixel's ray.
#[derive(Clone, Debug)]
pub struct Rays {
    width: usize,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// A pinhole camera: x/z per column and y/z per row.
    Pinhole { columns: Vec<f32>, rows: Vec<f32> },
    /// A camera with lens distortion: x/z and y/z per pixel, row by row; NaN where no ray maps to the pixel.
    Lens(Table),
}

type Table = Arc<Vec<[f32; 2]>>;

/// Cached tables by camera, most recently used first: a cell has one or two cameras.
static KNOWN: Mutex<Vec<(Intrinsics, Table)>> = Mutex::new(Vec::new());
/// Maximum number of cached tables; one of 0.3 million pixels takes 2.5 MB.
const MAX_TABLES: usize = 4;

impl Rays {
    /// Returns the rays of a camera. With lens distortion the first call takes tens of milliseconds; later calls
    /// use the cached table.
    pub fn of(camera: &Intrinsics) -> Self {
        let kind = if camera.distortion.is_none() {
            let ratio =
                |pixel: usize, centre: f64, focal: f64| ((pixel as f64 - centre) / focal) as f32;
            Kind::Pinhole {
                columns: (0..camera.width)
                    .map(|u| ratio(u, camera.cx, camera.fx))
                    .collect(),
                rows: (0..camera.height)
                    .map(|v| ratio(v, camera.cy, camera.fy))
                    .collect(),
            }
        } else {
            Kind::Lens(known(camera))
        };
        Self {
            width: camera.width,
            kind,
        }
    }

    /// Appends the camera points of row `v` from its depths, left to right; NaN means no reading.
    pub fn append_row(
        &self,
        v: usize,
        depths: impl Iterator<Item = f32>,
        points: &mut Vec<Point3<f32>>,
    ) {
        match &self.kind {
            Kind::Pinhole { columns, rows } => {
                let y = rows[v];
                points.extend(
                    depths
                        .zip(columns)
                        .map(|(z, x)| Point3::new(x * z, y * z, z)),
                );
            }
            Kind::Lens(table) => {
                let row = &table[v * self.width..(v + 1) * self.width];
                points.extend(depths.zip(row).map(|(z, [x, y])| {
                    // Without a ray there is no point, whatever the reading.
                    let z = if x.is_nan() { f32::NAN } else { z };
                    Point3::new(x * z, y * z, z)
                }));
            }
        }
    }
}

fn known(camera: &Intrinsics) -> Table {
    let lock = || lock(&KNOWN);
    let mut tables = lock();
    if let Some(index) = tables.iter().position(|(of, _)| of == camera) {
        tables[..=index].rotate_right(1);
        return Arc::clone(&tables[0].1);
    }
    // Compute without blocking other cameras; two threads may compute the same table.
    drop(tables);
    let table = Arc::new(table_of(camera));
    let mut tables = lock();
    tables.truncate(MAX_TABLES - 1);
    tables.insert(0, (*camera, Arc::clone(&table)));
    table
}

fn table_of(camera: &Intrinsics) -> Vec<[f32; 2]> {
    let lens = &camera.distortion;
    let mut table = Vec::with_capacity(camera.width * camera.height);
    let mut row_start = None;
    for v in 0..camera.height {
        // The neighbour's ray is a good initial guess: two Newton steps suffice.
        let mut near = row_start;
        for u in 0..camera.width {
            let seen = camera.seen_at(u as f64, v as f64);
            let ray = near
                .and_then(|near| lens.undistort_from(seen, near))
                .or_else(|| lens.undistort(seen));
            near = ray;
            if u == 0 {
                row_start = ray;
            }
            table.push(ray.map_or([f32::NAN; 2], |ray| ray.map(|x| x as f32)));
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distortion::Distortion;

    #[test]
    fn every_pixel_has_the_ray_that_the_lens_shows_there() {
        let camera = Intrinsics {
            distortion: Distortion {
                k1: -0.28,
                k2: 0.07,
                p1: 0.0007,
                p2: -0.0003,
                ..Distortion::NONE
            },
            ..Intrinsics::KINECT
        };
        let rays = Rays::of(&camera);
        for v in [0, 1, 239, 479] {
            let mut points = Vec::new();
            rays.append_row(v, (0..640).map(|_| 2.0), &mut points);
            assert_eq!(points.len(), 640);
            for (u, p) in points.iter().enumerate() {
                let exact = camera.point_at(u as f64, v as f64, 2.0);
                assert!((p.cast::<f64>() - exact).norm() < 1e-6);
                let (column, row) = camera.pixel_of(&exact).expect("in front");
                assert!((column - u as f64).hypot(row - v as f64) < 1e-6);
            }
        }
        // The table is reused, and not confused with another camera's.
        let Kind::Lens(first) = Rays::of(&camera).kind else {
            panic!("a lens");
        };
        let Kind::Lens(again) = Rays::of(&camera).kind else {
            panic!("a lens");
        };
        assert!(Arc::ptr_eq(&first, &again));
        let Kind::Lens(other) = Rays::of(&Intrinsics {
            fx: 530.0,
            ..camera
        })
        .kind
        else {
            panic!("a lens");
        };
        assert!(!Arc::ptr_eq(&first, &other) && first != other);
    }
}
