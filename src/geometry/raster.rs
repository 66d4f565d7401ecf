//! A binary image and the morphology over it.

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

    /// The same in an eighth of the memory, to look at in many places.
    pub fn packed(&self) -> PackedImage {
        let mut bits = vec![0; self.pixels.len().div_ceil(64)];
        for i in (0..self.pixels.len()).filter(|i| self.pixels[*i] != 0) {
            bits[i / 64] |= 1 << (i % 64);
        }
        PackedImage {
            width: self.width,
            height: self.height,
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
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedImage {
    width: usize,
    height: usize,
    /// Row by row from the top left, the lowest bit first.
    bits: Vec<u64>,
}

impl PackedImage {
    /// True if the pixel is set; pixels outside the image are not.
    pub fn is_set(&self, column: i32, row: i32) -> bool {
        // What is below 0 is beyond the other end.
        let (column, row) = (column as u32 as usize, row as u32 as usize);
        column < self.width && row < self.height && {
            let i = row * self.width + column;
            self.bits[i / 64] >> (i % 64) & 1 == 1
        }
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
            seed in prop::collection::vec(0_u8..2, 400),
        ) {
            let image = BinaryImage { width, height, pixels: seed[..width * height].to_vec() };
            let packed = image.packed();
            for row in -2..height as i32 + 2 {
                for column in -2..width as i32 + 2 {
                    let expected = image.is_set(i64::from(column), i64::from(row));
                    prop_assert_eq!(packed.is_set(column, row), expected);
                }
            }
        }
    }
}
