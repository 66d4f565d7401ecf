//! Thumbnails of parts: the surface shaded by its normals on a transparent background.
//!
//! Points are drawn as discs into a depth buffer with several samples per pixel, lit from the upper left, and darkened
//! where they lie behind their neighbours in the picture (C. Boucheny, "Visualisation scientifique de grands volumes de
//! données: pour une approche perceptive", 2009: eye-dome lighting), so that the shape of an uncoloured part is
//! visible.

use image::{Rgba, RgbaImage};
use nalgebra::{UnitQuaternion, Vector3};

use stages::reference::{Coverage, Reference};

/// Size of the picture, pixels.
const SIZE_PIXELS: [usize; 2] = [160, 120];
/// Margin around the part, pixels.
const MARGIN_PIXELS: f64 = 6.0;
/// Samples per pixel along each axis.
const SAMPLES_PER_PIXEL: usize = 3;
/// Colour of primer, visible in a dark and in a light window.
const COLOUR: Vector3<f64> = Vector3::new(0.56, 0.66, 0.76);

/// Draws a prepared reference: as the camera saw it if enrolled from one side, else in its standard view.
pub(super) fn render(reference: &Reference, coverage: Coverage) -> RgbaImage {
    let drawn = SplatBuffer::new(reference, coverage);
    let samples = drawn.map(|s| s.shaded());
    RgbaImage::from_fn(SIZE_PIXELS[0] as u32, SIZE_PIXELS[1] as u32, |u, v| {
        let Some(samples) = &samples else {
            return Rgba([0; 4]);
        };
        let mut sum = Vector3::zeros();
        let mut num_set = 0.0;
        for row in 0..SAMPLES_PER_PIXEL {
            for column in 0..SAMPLES_PER_PIXEL {
                let at = (v as usize * SAMPLES_PER_PIXEL + row) * WIDTH
                    + u as usize * SAMPLES_PER_PIXEL
                    + column;
                if let Some(colour) = samples[at] {
                    sum += colour;
                    num_set += 1.0;
                }
            }
        }
        let byte = |x: f64| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let mean = if num_set > 0.0 { sum / num_set } else { sum };
        let alpha = num_set / (SAMPLES_PER_PIXEL * SAMPLES_PER_PIXEL) as f64;
        Rgba([byte(mean.x), byte(mean.y), byte(mean.z), byte(alpha)])
    })
}

const WIDTH: usize = SIZE_PIXELS[0] * SAMPLES_PER_PIXEL;
const HEIGHT: usize = SIZE_PIXELS[1] * SAMPLES_PER_PIXEL;

/// Depth (in samples, increasing away from the viewer) and normal of each sample. Picture space: x right, y down, z
/// away.
struct SplatBuffer {
    depths: Vec<f64>,
    normals: Vec<Vector3<f64>>,
}

impl SplatBuffer {
    fn new(reference: &Reference, coverage: Coverage) -> Option<Self> {
        let cloud = &reference.cloud;
        let view = reference.views.first()?;
        let normals = cloud.normals.as_ref()?;
        let picture_from_part = match coverage {
            Coverage::OneSide => UnitQuaternion::identity(),
            Coverage::AllAround | Coverage::SeveralSides => {
                UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
                    * view.plane_from_part.rotation
            }
        };
        let turned: Vec<(Vector3<f64>, Vector3<f64>)> = cloud
            .points
            .iter()
            .zip(normals)
            .map(|(p, n)| {
                (
                    picture_from_part * p.coords.cast(),
                    picture_from_part * n.cast(),
                )
            })
            .collect();
        let first = turned.first()?.0;
        let (low, high) = turned
            .iter()
            .fold((first, first), |(l, h), (p, _)| (l.inf(p), h.sup(p)));
        let extent = (high - low).map(|x| x.max(1e-3));
        let room = |size: usize| {
            (size * SAMPLES_PER_PIXEL) as f64 - 2.0 * MARGIN_PIXELS * SAMPLES_PER_PIXEL as f64
        };
        let per_metre = (room(SIZE_PIXELS[0]) / extent.x).min(room(SIZE_PIXELS[1]) / extent.y);
        let centre = (low + high) / 2.0;
        // Overlapping discs: each point covers about its share of the part's area.
        let area_each = view.contour().area * num_sides(coverage) / turned.len() as f64;
        let radius = (1.1 * area_each.sqrt() * per_metre).clamp(1.0, 0.1 * HEIGHT as f64);
        let mut splats = Self {
            depths: vec![f64::INFINITY; WIDTH * HEIGHT],
            normals: vec![Vector3::zeros(); WIDTH * HEIGHT],
        };
        for (point, normal) in &turned {
            let at = (point - centre) * per_metre
                + Vector3::new(WIDTH as f64 / 2.0, HEIGHT as f64 / 2.0, 0.0);
            if normal.z < 0.0 {
                splats.draw(&at, normal, radius);
            }
        }
        Some(splats)
    }

    fn draw(&mut self, at: &Vector3<f64>, normal: &Vector3<f64>, radius: f64) {
        let span = |centre: f64, size: usize| {
            let low = (centre - radius).ceil().max(0.0) as usize;
            low..((centre + radius).floor().max(-1.0) + 1.0).min(size as f64) as usize
        };
        for row in span(at.y, HEIGHT) {
            for column in span(at.x, WIDTH) {
                let (dx, dy) = (column as f64 - at.x, row as f64 - at.y);
                let from_centre = dx.hypot(dy) / radius;
                // Cones instead of discs: the nearest point wins, so borders run half-way between points.
                let depth = at.z + from_centre * radius;
                let i = row * WIDTH + column;
                if from_centre <= 1.0 && depth < self.depths[i] {
                    self.depths[i] = depth;
                    self.normals[i] = *normal;
                }
            }
        }
    }

    /// Returns the colour of every sample that shows the part.
    fn shaded(&self) -> Vec<Option<Vector3<f64>>> {
        let light = Vector3::new(-0.45, -0.65, -0.6).normalize();
        (0..WIDTH * HEIGHT)
            .map(|i| {
                self.depths[i].is_finite().then(|| {
                    let normal = self.smooth_normal(i);
                    let lit = normal.dot(&light).max(0.0);
                    let gloss = (2.0 * normal.dot(&light) * normal.z - light.z)
                        .min(0.0)
                        .abs();
                    let brightness = (0.32 + 0.78 * lit) * (0.35 + 0.65 * self.openness(i));
                    COLOUR * brightness + Vector3::repeat(0.22 * gloss.powi(12))
                })
            })
            .collect()
    }

    /// Averages the normals of a sample and its neighbours at the same depth, which hides the borders between discs.
    fn smooth_normal(&self, i: usize) -> Vector3<f64> {
        let sum: Vector3<f64> = Self::around(i, 4)
            .filter(|&j| (self.depths[j] - self.depths[i]).abs() < 12.0)
            .map(|j| self.normals[j])
            .sum();
        (sum + self.normals[i])
            .try_normalize(1e-6)
            .unwrap_or(self.normals[i])
    }

    /// Returns 1 for a sample with nothing in front of it on any side, less in a groove or behind an edge.
    fn openness(&self, i: usize) -> f64 {
        let reach = 6;
        let before: f64 = Self::around(i, reach)
            .map(|j| ((self.depths[i] - self.depths[j]) / reach as f64 - 0.8).clamp(0.0, 3.0))
            .sum();
        (-0.12 * before).exp()
    }

    /// Returns the samples `reach` steps away in eight directions, as far as they are in the picture.
    fn around(i: usize, reach: i64) -> impl Iterator<Item = usize> {
        let (column, row) = ((i % WIDTH) as i64, (i / WIDTH) as i64);
        (-1..=1_i64)
            .flat_map(|dv| (-1..=1_i64).map(move |du| (du, dv)))
            .filter(|&d| d != (0, 0))
            .map(move |(du, dv)| (column + reach * du, row + reach * dv))
            .filter(|&(u, v)| (0..WIDTH as i64).contains(&u) && (0..HEIGHT as i64).contains(&v))
            .map(|(u, v)| v as usize * WIDTH + u as usize)
    }
}

fn num_sides(coverage: Coverage) -> f64 {
    match coverage {
        Coverage::OneSide | Coverage::SeveralSides => 1.0,
        Coverage::AllAround => 2.0,
    }
}
