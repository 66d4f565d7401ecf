//! Letters on a picture, in the font of the window.
//!
//! `skrifa` gives the outlines of the glyphs and `vello_cpu` fills them, as egui does for the window.
//!
//! Known limits: one line of text from left to right, no kerning.

use image::{Pixel as _, Rgb, RgbImage};
use skrifa::{
    FontRef, MetadataProvider as _,
    instance::{LocationRef, Size},
    outline::{DrawSettings, OutlinePen},
};
use vello_cpu::{
    Pixmap, RenderContext, Resources,
    color::{OpaqueColor, Srgb},
    kurbo::{Affine, BezPath, Point, Shape as _, Vec2},
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
        let left = at[0] - self.offset(text, anchor);
        let place = Affine::translate(Vec2::new(left.round(), at[1].round()));
        fill(image, &(place * self.outline(text)), colour);
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
        let bottom = at[1] + self.offset(text, anchor);
        let place = Affine::translate(Vec2::new(at[0].round(), bottom.round()));
        let upwards = Affine::rotate(-std::f64::consts::FRAC_PI_2);
        fill(image, &(place * upwards * self.outline(text)), colour);
    }

    fn offset(&self, text: &str, anchor: Anchor) -> f64 {
        let width = f64::from(self.width(text));
        match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::Right => width,
        }
    }

    /// The outlines of a text that begins at the origin, y down.
    fn outline(&self, text: &str) -> BezPath {
        let size = Size::new(self.size);
        let (charmap, outlines) = (self.font.charmap(), self.font.outline_glyphs());
        let metrics = self.font.glyph_metrics(size, LocationRef::default());
        let mut pen = Pen::default();
        for glyph in text.chars().filter_map(|letter| charmap.map(letter)) {
            if let Some(outline) = outlines.get(glyph) {
                let settings = DrawSettings::unhinted(size, LocationRef::default());
                // A glyph that cannot be drawn leaves a gap.
                let _ = outline.draw(settings, &mut pen);
            }
            pen.left += metrics.advance_width(glyph).unwrap_or(0.0);
        }
        pen.path
    }
}

/// Fills outlines, pixels of the picture; what lies outside is left out.
fn fill(image: &mut RgbImage, path: &BezPath, colour: Rgb<u8>) {
    let picture = [image.width(), image.height()].map(f64::from);
    let bounds = path.bounding_box();
    let (left, top) = (bounds.x0.floor().max(0.0), bounds.y0.floor().max(0.0));
    let width = bounds.x1.ceil().min(picture[0]) - left;
    let height = bounds.y1.ceil().min(picture[1]) - top;
    if !(width >= 1.0 && height >= 1.0) {
        return;
    }
    let mut context = RenderContext::new(width as u16, height as u16);
    context.set_transform(Affine::translate((-left, -top)));
    context.set_paint(OpaqueColor::<Srgb>::WHITE);
    context.fill_path(path);
    let mut covered = Pixmap::new(width as u16, height as u16);
    context.render(&mut covered, &mut Resources::new());
    let rows = covered.data_as_u8_slice().chunks(4 * width as usize);
    for (v, row) in (top as u32..).zip(rows) {
        for (u, covered) in (left as u32..).zip(row.chunks(4)) {
            let share = f32::from(covered[3]) / 255.0;
            let pixel = image.get_pixel_mut(u, v);
            *pixel = pixel.map2(&colour, |under, over| {
                let (under, over) = (f32::from(under), f32::from(over));
                (under + (over - under) * share).round() as u8
            });
        }
    }
}

/// Follows the outline of a glyph; the font's y is up.
#[derive(Default)]
struct Pen {
    path: BezPath,
    /// Where the glyph stands.
    left: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> Point {
        Point::new(f64::from(self.left + x), f64::from(-y))
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.at(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.at(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.path.quad_to(self.at(cx, cy), self.at(x, y));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.path
            .curve_to(self.at(cx0, cy0), self.at(cx1, cy1), self.at(x, y));
    }

    fn close(&mut self) {
        self.path.close_path();
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
