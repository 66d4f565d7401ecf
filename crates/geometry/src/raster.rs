//! Binary images and their morphology.

use nalgebra::{Matrix2x3, Point2};

/// An image of pixels that are set (1) or not (0).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BinaryImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 0, row by row from the top left; `width` × `height` values.
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

    /// Returns true if the pixel is set; pixels outside the image are not.
    pub fn is_set(&self, column: i64, row: i64) -> bool {
        column >= 0
            && row >= 0
            && (column as usize) < self.width
            && (row as usize) < self.height
            && self.pixels[row as usize * self.width + column as usize] != 0
    }

    /// Packs every `step`th pixel of every `step`th row into one bit each, for fast lookup of many points; a step
    /// of 0 counts as 1.
    pub fn packed(&self, step: usize) -> PackedImage {
        let step = step.max(1);
        // Add a border of unset pixels: points outside are clamped to it, so no bounds check is needed.
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

    /// Returns the number of set pixels.
    pub fn num_set(&self) -> usize {
        self.pixels.iter().map(|&p| usize::from(p)).sum()
    }

    /// Fills gaps too small for a square of 2·`radius` + 1 pixels (morphological closing).
    ///
    /// The image must have `radius` unset pixels along its edge, or shapes grow into the edge.
    pub fn close(&mut self, radius: usize) {
        if radius == 0 || self.pixels.is_empty() {
            return;
        }
        let mut scratch = vec![0; self.pixels.len()];
        self.spread(radius, &mut scratch, u8::max);
        self.spread(radius, &mut scratch, u8::min);
    }

    /// Replaces each pixel by the largest (dilation) or smallest (erosion) value of a square around it, rows first,
    /// then columns.
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

/// A binary image with one bit per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedImage {
    /// Columns, including a border of one pixel on either side.
    width: usize,
    /// Rows, including the border.
    height: usize,
    /// Spacing of the packed pixels, in pixels of the whole image.
    step: f32,
    /// Row by row from the top left, lowest bit first.
    bits: Vec<u64>,
}

impl PackedImage {
    /// Counts the points that fall on set pixels; points outside the image do not count.
    ///
    /// `pixel_from_point` maps a point to column and row of the whole image; pixel centres are at whole numbers.
    pub fn num_set_at(&self, points: &PointBlocks, pixel_from_point: &Matrix2x3<f32>) -> usize {
        // Adding 2^23 to a float from 0 to 2^23 leaves the nearest integer in its lowest bits. A cast would do the
        // same, but its saturation and the overflow checks keep the compiler from vectorising the loop.
        const WHOLE: f32 = (1 << 23) as f32;
        let m = pixel_from_point / self.step;
        let (last_column, last_row) = ((self.width - 1) as f32, (self.height - 1) as f32);
        let whole = |x: f32, last: f32| (x.max(0.0).min(last) + WHOLE).to_bits() & 0x7f_ffff;
        let mut num = 0;
        for [x, y] in &points.blocks {
            let mut places = [0; BLOCK_POINTS];
            for i in 0..BLOCK_POINTS {
                // Add 1 for the border.
                let column = m.m11 * x[i] + m.m12 * y[i] + (m.m13 + 1.0);
                let row = m.m21 * x[i] + m.m22 * y[i] + (m.m23 + 1.0);
                let (column, row) = (whole(column, last_column), whole(row, last_row));
                // Never wraps: the place lies within the image.
                places[i] = row.wrapping_mul(self.width as u32).wrapping_add(column);
            }
            for place in places {
                num += self.bits[place as usize / 64] >> (place % 64) & 1;
            }
        }
        num as usize
    }
}

/// A binary image as the lengths of its runs of equal pixels, in a fraction of the memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunLengthImage {
    width: usize,
    height: usize,
    /// Alternately of unset and set pixels, row by row. A run of more than 65 535 is split by an empty one of the other kind.
    runs: Box<[u16]>,
}

impl RunLengthImage {
    /// Compresses an image.
    pub fn new(image: &BinaryImage) -> Self {
        let mut runs = Vec::new();
        let mut is_set = false;
        for run in image.pixels.chunk_by(|a, b| (*a != 0) == (*b != 0)) {
            if (run[0] != 0) != is_set {
                runs.push(0);
            }
            is_set = run[0] == 0;
            let mut left = run.len();
            while left > usize::from(u16::MAX) {
                runs.extend([u16::MAX, 0]);
                left -= usize::from(u16::MAX);
            }
            runs.push(left as u16);
        }
        Self {
            width: image.width,
            height: image.height,
            runs: runs.into(),
        }
    }

    /// Returns the size of the runs.
    pub fn num_bytes(&self) -> usize {
        size_of_val(&*self.runs)
    }

    /// Returns the image.
    pub fn unpacked(&self) -> BinaryImage {
        let runs = self.runs.iter().zip([0, 1].into_iter().cycle());
        let pixels =
            runs.flat_map(|(length, pixel)| std::iter::repeat_n(pixel, usize::from(*length)));
        BinaryImage {
            width: self.width,
            height: self.height,
            pixels: pixels.collect(),
        }
    }
}

/// Points of a plane, stored in blocks for vectorised code.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointBlocks {
    /// x and y coordinates; the last block is padded with points outside of any image.
    blocks: Vec<[[f32; BLOCK_POINTS]; 2]>,
    num: usize,
}

/// Points per block.
const BLOCK_POINTS: usize = 16;

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
            let place = all.num % BLOCK_POINTS;
            if place == 0 {
                all.blocks.push([[f32::INFINITY; BLOCK_POINTS]; 2]);
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
        fn a_compressed_image_unpacks_to_itself(
            rows in 1_usize..500,
            runs in prop::collection::vec((0_u8..2, 1_usize..200_000), 0..6),
        ) {
            let pixels = runs.iter().flat_map(|(pixel, num)| std::iter::repeat_n(*pixel, *num));
            let mut pixels: Vec<u8> = pixels.collect();
            pixels.truncate(pixels.len() / rows * rows);
            let image = BinaryImage { width: pixels.len() / rows, height: rows, pixels };
            prop_assert_eq!(RunLengthImage::new(&image).unpacked(), image);
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
                    // Off the pixel's centre.
                    let off = 0.4 * step as f32;
                    let point = Point2::new(column as f32 + off, row as f32 - off);
                    let num = packed.num_set_at(&[point].into_iter().collect(), &Matrix2x3::identity());
                    prop_assert_eq!(num, usize::from(expected));
                }
            }
        }
    }
}
