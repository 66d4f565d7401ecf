//! Letters on a picture, in the font of the window.
//!
//! The outline of each glyph is cut into short lines, and what every line covers to its right is summed up per pixel;
//! a running sum over the row then is the coverage. The method is the one of R. Levien's font-rs, 2016.
//!
//! Known limits: one line of text from left to right, no kerning, and contours of a glyph that lie over each other are
//! counted twice; those of the font used here do not.

use image::{Pixel as _, Rgb, RgbImage};
use skrifa::{
    FontRef, MetadataProvider as _,
    instance::{LocationRef, Size},
    outline::{DrawSettings, OutlinePen},
};

/// The font: Inter, under the licence in `assets/fonts`.
const FONT: &[u8] = include_bytes!("../../assets/fonts/Inter-Regular.otf");

/// Where a text stands to its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// It begins there.
    Left,
    /// Its middle is there.
    Middle,
    /// It ends there.
    Right,
}

/// Letters of one size.
pub(super) struct Lettering {
    font: FontRef<'static>,
    size: f32,
}

impl Lettering {
    /// Letters of so many pixels from line to line, about.
    pub(super) fn new(size: f32) -> Self {
        Self {
            font: FontRef::new(FONT).expect("our own font is one"),
            size,
        }
    }

    /// Width of a text, pixels.
    pub(super) fn width(&self, text: &str) -> f32 {
        let metrics = self
            .font
            .glyph_metrics(Size::new(self.size), LocationRef::default());
        let charmap = self.font.charmap();
        text.chars()
            .filter_map(|letter| metrics.advance_width(charmap.map(letter)?))
            .sum()
    }

    /// Writes a text; `at` is on the line that the letters stand on.
    pub(super) fn write(
        &self,
        image: &mut RgbImage,
        text: &str,
        at: [f64; 2],
        anchor: Anchor,
        colour: Rgb<u8>,
    ) {
        let coverage = self.coverage(text);
        let left = at[0] - self.offset(text, anchor);
        coverage.paint(
            image,
            |u, v| {
                (
                    left.round() as i64 + u,
                    at[1].round() as i64 + v - coverage.baseline,
                )
            },
            colour,
        );
    }

    /// Writes a text from bottom to top; `at` is on the line that the letters stand on.
    pub(super) fn write_upwards(
        &self,
        image: &mut RgbImage,
        text: &str,
        at: [f64; 2],
        anchor: Anchor,
        colour: Rgb<u8>,
    ) {
        let coverage = self.coverage(text);
        let bottom = at[1] + self.offset(text, anchor);
        coverage.paint(
            image,
            |u, v| {
                (
                    at[0].round() as i64 + v - coverage.baseline,
                    bottom.round() as i64 - u,
                )
            },
            colour,
        );
    }

    fn offset(&self, text: &str, anchor: Anchor) -> f64 {
        let width = f64::from(self.width(text));
        match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::Right => width,
        }
    }

    fn coverage(&self, text: &str) -> Coverage {
        let size = Size::new(self.size);
        let (charmap, outlines) = (self.font.charmap(), self.font.outline_glyphs());
        let metrics = self.font.glyph_metrics(size, LocationRef::default());
        let baseline = (self.size * 1.1).ceil();
        let mut pen = Pen {
            coverage: Coverage {
                width: self.width(text).ceil() as usize + 3,
                height: (self.size * 1.5).ceil() as usize,
                baseline: baseline as i64,
                sums: Vec::new(),
            },
            origin: [1.0, baseline],
            start: [0.0; 2],
            last: [0.0; 2],
        };
        pen.coverage.sums = vec![0.0; pen.coverage.width * pen.coverage.height];
        for glyph in text.chars().filter_map(|letter| charmap.map(letter)) {
            if let Some(outline) = outlines.get(glyph) {
                let settings = DrawSettings::unhinted(size, LocationRef::default());
                // A glyph that cannot be drawn leaves a gap.
                let _ = outline.draw(settings, &mut pen);
            }
            pen.origin[0] += metrics.advance_width(glyph).unwrap_or(0.0);
        }
        pen.coverage
    }
}

/// How much of every pixel is covered, as differences along the rows.
struct Coverage {
    width: usize,
    height: usize,
    /// Row of the line that the letters stand on.
    baseline: i64,
    sums: Vec<f32>,
}

impl Coverage {
    fn paint(&self, image: &mut RgbImage, place: impl Fn(i64, i64) -> (i64, i64), colour: Rgb<u8>) {
        for (v, row) in self.sums.chunks(self.width).enumerate() {
            let mut sum = 0.0;
            for (u, change) in row.iter().enumerate() {
                sum += change;
                let share = sum.abs().min(1.0);
                let (x, y) = place(u as i64, v as i64);
                let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
                    continue;
                };
                if share > 0.0
                    && let Some(pixel) = image.get_pixel_mut_checked(x, y)
                {
                    *pixel = pixel.map2(&colour, |under, over| {
                        let (under, over) = (f32::from(under), f32::from(over));
                        (under + (over - under) * share).round() as u8
                    });
                }
            }
        }
    }

    /// What a line covers to its right, row by row.
    fn add_line(&mut self, from: [f32; 2], to: [f32; 2]) {
        let (sign, top, bottom) = if from[1] < to[1] {
            (1.0, from, to)
        } else {
            (-1.0, to, from)
        };
        let slope = (bottom[0] - top[0]) / (bottom[1] - top[1]);
        let first = top[1].max(0.0);
        let last = bottom[1].min(self.height as f32);
        let mut y = first;
        while y < last {
            let row = y as usize;
            let until = (row as f32 + 1.0).min(last);
            let x_at = |y: f32| top[0] + (y - top[1]) * slope;
            self.add_span(row, [x_at(y), x_at(until)], sign * (until - y));
            y = until;
        }
    }

    /// A piece of a line within one row, from x to x, over a height with a sign.
    fn add_span(&mut self, row: usize, [a, b]: [f32; 2], height: f32) {
        let (left, right) = (a.min(b), a.max(b));
        let steps = ((right - left).ceil() as usize).clamp(1, self.width);
        for step in 0..steps {
            // A slice no wider than a pixel: its share of the pixel is that of its middle.
            let x = left + (right - left) * (step as f32 + 0.5) / steps as f32;
            let x = x.clamp(0.0, self.width as f32 - 2.0);
            let cell = row * self.width + x as usize;
            let (part, beside) = (height / steps as f32, x.fract());
            self.sums[cell] += part * (1.0 - beside);
            self.sums[cell + 1] += part * beside;
        }
    }
}

/// Follows the outline of a glyph; y up, in pixels from the place where it stands.
struct Pen {
    coverage: Coverage,
    origin: [f32; 2],
    start: [f32; 2],
    last: [f32; 2],
}

/// Lines that stand for a curve: less than a tenth of a pixel off at these sizes.
const STEPS: usize = 6;

impl Pen {
    fn place(&self, x: f32, y: f32) -> [f32; 2] {
        [self.origin[0] + x, self.origin[1] - y]
    }

    fn line(&mut self, to: [f32; 2]) {
        if (to[1] - self.last[1]).abs() > f32::EPSILON {
            self.coverage.add_line(self.last, to);
        }
        self.last = to;
    }

    fn curve(&mut self, at: impl Fn(f32) -> [f32; 2]) {
        for step in 1..=STEPS {
            self.line(at(step as f32 / STEPS as f32));
        }
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.start = self.place(x, y);
        self.last = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        self.line(to);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let [a, b, c] = [self.last, self.place(cx, cy), self.place(x, y)];
        self.curve(|t| {
            let s = 1.0 - t;
            [0, 1].map(|i| s * s * a[i] + 2.0 * s * t * b[i] + t * t * c[i])
        });
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let (a, b) = (self.last, self.place(cx0, cy0));
        let (c, d) = (self.place(cx1, cy1), self.place(x, y));
        self.curve(|t| {
            let s = 1.0 - t;
            let [wa, wb, wc, wd] = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
            [0, 1].map(|i| wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i])
        });
    }

    fn close(&mut self) {
        self.line(self.start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> RgbImage {
        let mut image = RgbImage::new(120, 30);
        let lettering = Lettering::new(16.0);
        lettering.write(&mut image, text, [10.0, 20.0], Anchor::Left, Rgb([255; 3]));
        image
    }

    fn ink(image: &RgbImage) -> f64 {
        image.pixels().map(|p| f64::from(p[0]) / 255.0).sum()
    }

    #[test]
    fn a_full_stop_covers_as_much_as_its_square_and_a_letter_is_no_blot() {
        // An em dash is a bar; its ink is its area whatever the place.
        let dash = ink(&written("—"));
        assert!((10.0..40.0).contains(&dash), "{dash}");
        let letters = written("Fender 8");
        assert!((60.0..260.0).contains(&ink(&letters)), "{}", ink(&letters));
        // Nothing leaks out of a glyph to the right, as an outline that is not closed would.
        assert!(
            letters
                .rows()
                .all(|mut row| row.nth(110).expect("wide")[0] == 0)
        );
        assert!(ink(&written("")) < 0.5);
    }

    #[test]
    fn a_text_beyond_the_picture_is_left_out() {
        let mut image = RgbImage::new(20, 20);
        let lettering = Lettering::new(14.0);
        for at in [[-500.0, 10.0], [10.0, -90.0], [19.0, 19.0], [1e6, 1e6]] {
            lettering.write(&mut image, "door", at, Anchor::Middle, Rgb([255; 3]));
            lettering.write_upwards(&mut image, "door", at, Anchor::Right, Rgb([255; 3]));
        }
    }

    #[test]
    fn a_text_upwards_has_the_ink_of_the_same_text_across() {
        let mut image = RgbImage::new(30, 120);
        let lettering = Lettering::new(16.0);
        lettering.write_upwards(
            &mut image,
            "Fender",
            [20.0, 110.0],
            Anchor::Left,
            Rgb([255; 3]),
        );
        let across = ink(&written("Fender"));
        assert!((ink(&image) - across).abs() < 0.02 * across);
    }
}
