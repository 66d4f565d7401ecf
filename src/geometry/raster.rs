//! A binary image and the morphology over it.

use nalgebra::{Matrix2x3, Point2};

/// Rows of pixels that are set (1) or not (0).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BinaryImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 0, row by row from the top left; `width` × `height` of them.
    pub pixels: Vec<u8>,
}

impl BinaryImage {
    /// An image with no pixel set.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![0; width * height],
        }
    }

    /// True if the pixel is set; pixels outside the image are not.
    pub fn is_set(&self, column: i64, row: i64) -> bool {
        column >= 0
            && row >= 0
            && (column as usize) < self.width
            && (row as usize) < self.height
            && self.pixels[row as usize * self.width + column as usize] != 0
    }

    /// Every `step`th pixel of every `step`th row in an eighth of the memory, to look at in many places; a step of 0
    /// counts as 1.
    pub fn packed(&self, step: usize) -> PackedImage {
        let step = step.max(1);
        // A border of unset pixels: what lies outside is moved onto it and needs no question of its own.
        let (width, height) = (
            self.width.div_ceil(step) + 2,
            self.height.div_ceil(step) + 2,
        );
        let mut bits = vec![0; (width * height).div_ceil(64)];
        for row in (0..self.height).step_by(step) {
            for column in (0..self.width).step_by(step) {
                if self.pixels[row * self.width + column] != 0 {
                    let place = (row / step + 1) * width + column / step + 1;
                    bits[place / 64] |= 1 << (place % 64);
                }
            }
        }
        PackedImage {
            width,
            height,
            step: step as f32,
            bits,
        }
    }

    /// The number of set pixels.
    pub fn num_set(&self) -> usize {
        self.pixels.iter().map(|&p| usize::from(p)).sum()
    }

    /// Fills gaps that a square of 2·`radius` + 1 pixels does not fit into (morphological closing).
    ///
    /// The image must keep `radius` unset pixels along its edge, or shapes grow into the edge.
    pub fn close(&mut self, radius: usize) {
        if radius == 0 || self.pixels.is_empty() {
            return;
        }
        let mut scratch = vec![0; self.pixels.len()];
        self.spread(radius, &mut scratch, u8::max);
        self.spread(radius, &mut scratch, u8::min);
    }

    /// The largest (dilation) or smallest (erosion) value of a square neighbourhood, rows first, then columns.
    fn spread(&mut self, radius: usize, scratch: &mut [u8], pick: impl Fn(u8, u8) -> u8 + Copy) {
        let (width, height) = (self.width, self.height);
        let reach = radius.min(width - 1);
        for (row, out) in self
            .pixels
            .chunks_exact(width)
            .zip(scratch.chunks_exact_mut(width))
        {
            out.copy_from_slice(row);
            for shift in 1..=reach {
                for (o, r) in out[shift..].iter_mut().zip(row) {
                    *o = pick(*o, *r);
                }
                for (o, r) in out.iter_mut().zip(&row[shift..]) {
                    *o = pick(*o, *r);
                }
            }
        }
        self.pixels.copy_from_slice(scratch);
        let reach = radius.min(height - 1);
        for shift in 1..=reach {
            let offset = shift * width;
            for (o, r) in self.pixels[offset..].iter_mut().zip(&*scratch) {
                *o = pick(*o, *r);
            }
            for (o, r) in self.pixels.iter_mut().zip(&scratch[offset..]) {
                *o = pick(*o, *r);
            }
        }
    }
}

/// A binary image of one bit per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedImage {
    /// Columns, with a border of one pixel on either side.
    width: usize,
    /// Rows, likewise.
    height: usize,
    /// Pixels of the whole image from one to the next.
    step: f32,
    /// Row by row from the top left, the lowest bit first.
    bits: Vec<u64>,
}

impl PackedImage {
    /// How many of the points fall on set pixels; none outside the image does.
    ///
    /// `pixel_from_point` takes a point to column and row of the whole image, whole numbers at the middles of pixels.
    pub fn num_set_at(&self, points: &PointBlocks, pixel_from_point: &Matrix2x3<f32>) -> usize {
        // Added to a float from 0 to as much, it leaves the nearest whole number in the last bits. A cast would do the
        // same, but it saturates, and overflow is checked for: both keep the compiler from making vector code of this.
        const WHOLE: f32 = (1 << 23) as f32;
        let m = pixel_from_point / self.step;
        let (last_column, last_row) = ((self.width - 1) as f32, (self.height - 1) as f32);
        let whole = |x: f32, last: f32| (x.max(0.0).min(last) + WHOLE).to_bits() & 0x7f_ffff;
        let mut num = 0;
        for [x, y] in &points.blocks {
            let mut places = [0; BLOCK];
            for i in 0..BLOCK {
                // One more for the border.
                let column = m.m11 * x[i] + m.m12 * y[i] + (m.m13 + 1.0);
                let row = m.m21 * x[i] + m.m22 * y[i] + (m.m23 + 1.0);
                let (column, row) = (whole(column, last_column), whole(row, last_row));
                // Of a place within the image nothing is cut off.
                places[i] = row.wrapping_mul(self.width as u32).wrapping_add(column);
            }
            for place in places {
                num += self.bits[place as usize / 64] >> (place % 64) & 1;
            }
        }
        num as usize
    }
}

/// Points of a plane in the order that vector code wants them in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointBlocks {
    /// Abscissas and ordinates; the last block is filled up with points outside of any image.
    blocks: Vec<[[f32; BLOCK]; 2]>,
    num: usize,
}

/// Points handled at once.
const BLOCK: usize = 16;

impl PointBlocks {
    /// The number of points.
    pub fn num(&self) -> usize {
        self.num
    }
}

impl FromIterator<Point2<f32>> for PointBlocks {
    fn from_iter<I: IntoIterator<Item = Point2<f32>>>(points: I) -> Self {
        let mut all = Self::default();
        for point in points {
            let place = all.num % BLOCK;
            if place == 0 {
                all.blocks.push([[f32::INFINITY; BLOCK]; 2]);
            }
            if let Some([x, y]) = all.blocks.last_mut() {
                (x[place], y[place]) = (point.x, point.y);
            }
            all.num += 1;
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn slow_spread(image: &BinaryImage, radius: i64, any: bool) -> BinaryImage {
        let mut out = BinaryImage::new(image.width, image.height);
        for row in 0..image.height as i64 {
            for column in 0..image.width as i64 {
                let mut seen = (-radius..=radius)
                    .flat_map(|dv| (-radius..=radius).map(move |du| (column + du, row + dv)))
                    .filter(|&(u, v)| {
                        u >= 0 && v >= 0 && u < image.width as i64 && v < image.height as i64
                    })
                    .map(|(u, v)| image.is_set(u, v));
                let set = if any {
                    seen.any(|s| s)
                } else {
                    seen.all(|s| s)
                };
                out.pixels[row as usize * image.width + column as usize] = u8::from(set);
            }
        }
        out
    }

    proptest! {
        #[test]
        fn closing_is_a_dilation_and_an_erosion_by_definition(
            width in 1_usize..20,
            height in 1_usize..20,
            radius in 0_usize..4,
            seed in prop::collection::vec(0_u8..2, 400),
        ) {
            let mut image = BinaryImage { width, height, pixels: seed[..width * height].to_vec() };
            let slow = slow_spread(&slow_spread(&image, radius as i64, true), radius as i64, false);
            image.close(radius);
            prop_assert_eq!(image, slow);
        }

        #[test]
        fn a_packed_image_has_the_same_pixels_set(
            width in 1_usize..20,
            height in 1_usize..20,
            step in 1_usize..4,
            seed in prop::collection::vec(0_u8..2, 400),
        ) {
            let image = BinaryImage { width, height, pixels: seed[..width * height].to_vec() };
            let packed = image.packed(step);
            for row in (-4..height as i64 + 4).filter(|row| row % step as i64 == 0) {
                for column in (-4..width as i64 + 4).filter(|column| column % step as i64 == 0) {
                    let expected = image.is_set(column, row);
                    // Anywhere in the pixel.
                    let off = 0.4 * step as f32;
                    let point = Point2::new(column as f32 + off, row as f32 - off);
                    let num = packed.num_set_at(&[point].into_iter().collect(), &Matrix2x3::identity());
                    prop_assert_eq!(num, usize::from(expected));
                }
            }
        }
    }
}
